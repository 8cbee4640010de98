//! Interpretations of the paper where it leaves something open. The default of each is that of the simulator.
//!
//! None of them is a mistake: each is a model that the paper's words allow.

/// One interpretation of the paper; `Update` and `min_contact_arm` of the problem belong to it too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Which candidates collide.
    pub who: Who,
    /// How far a contact line reaches.
    pub lines: Lines,
    /// Whether the volume has periodic images.
    pub images: Images,
    /// Where a rod that left comes back.
    pub replacement: Replacement,
    /// The length by which distances are divided.
    pub length: Length,
}

/// Which candidates collide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Who {
    /// Every rod draws for itself and its nearest neighbour, so that mutual neighbours have two draws; closest first.
    #[default]
    EachDraws,
    /// Two rods that are each other's nearest have one draw, that of the lower index; otherwise as `EachDraws`.
    PairDraws,
    /// As `EachDraws`, but candidates are taken in the order of the rods that drew.
    IndexOrder,
}

/// How far a contact line reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lines {
    /// The contact point may lie beyond a rod's end.
    #[default]
    Infinite,
    /// There is no contact if the contact point is beyond an end of either rod, |r| > a/2.
    CutAtEnds,
}

/// Periodic images of the volume: every rod counts at its nearest image.
///
/// A rod's own images are never its neighbours. The liquid moves an image with the velocity at its position, so an
/// image across the faces of x_1 is faster or slower by G H. Images across x_1 are not shifted along x_2 with time
/// (Lees and Edwards), because no rod keeps its position along x_2 for long: it leaves and comes back elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Images {
    /// No images: rods near a face have fewer neighbours.
    #[default]
    None,
    /// Along the flow and the vorticity, with walls across the gradient.
    FlowAndVorticity,
    /// Along all three axes.
    All,
}

impl Images {
    /// The image of `x` that is nearest to `to`, both in the volume.
    pub fn nearest_mm(self, mut x: [f64; 3], to: [f64; 3], edges_mm: [f64; 3]) -> [f64; 3] {
        let repeated = match self {
            Self::None => return x,
            Self::FlowAndVorticity => 1..3,
            Self::All => 0..3,
        };
        for k in repeated {
            // places lie in one volume, so no image is nearer than those next to it
            let away = x[k] - to[k];
            if away.abs() > edges_mm[k] / 2.0 {
                x[k] -= edges_mm[k] * away.signum();
            }
        }
        x
    }
}

/// The length a by which s is divided in eq. 7, if rods have unequal lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Length {
    /// The length of the rod that draws.
    #[default]
    Own,
    /// The length of its neighbour.
    Partners,
    /// The mean of both lengths.
    MeanOfBoth,
}

/// Where a rod that left comes back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Replacement {
    /// At a depth equal to its overshoot (eq. 14).
    #[default]
    Overshoot,
    /// At the depth that its new x_1 would have given since it left: the overshoot times x_1(new)/x_1(old).
    ScaledOvershoot,
}
