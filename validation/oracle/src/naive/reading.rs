//! How the paper is read where it leaves something open. The default of each is the reading of the simulator.
//!
//! None of these is a mistake: each is a model that the paper's words allow.

/// One way to read the paper; `Update` and `min_contact_arm` of the problem are part of it too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Which candidates collide.
    pub who: Who,
    /// How far a contact line reaches.
    pub lines: Lines,
    /// Whether the volume is repeated.
    pub images: Images,
    /// Where a rod that left comes back.
    pub replacement: Replacement,
    /// The length that distances are measured by.
    pub length: Length,
}

/// Which candidates collide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Who {
    /// Every rod draws for itself and its nearest neighbour, so that mutual neighbours have two draws; closest first.
    #[default]
    EachDraws,
    /// Two rods that are each other's nearest have one draw, that of the lower index; all else as `EachDraws`.
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
    /// A contact point beyond an end of either rod, |r| > a/2, is no contact.
    CutAtEnds,
}

/// Whether the volume is repeated: every rod is then seen at the image that is nearest.
///
/// A rod's own images are never its neighbour. The liquid moves an image as it moves whatever is at that place, so
/// one across the faces of x_1 is faster or slower by G H. Images across x_1 are not shifted along x_2 as time goes
/// (Lees and Edwards), because no rod keeps its place along x_2 for long: it leaves and comes back elsewhere.
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

/// The length a that s is taken over in eq. 7, where rods are of unequal length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Length {
    /// That of the rod that draws.
    #[default]
    Own,
    /// Its neighbour's.
    Partners,
    /// The mean of both.
    MeanOfBoth,
}

/// Where a rod that left comes back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Replacement {
    /// As deep in the volume as it overshot (eq. 14).
    #[default]
    Overshoot,
    /// As deep as its new x_1 would have taken it since it left: the overshoot times x_1(new)/x_1(old).
    ScaledOvershoot,
}
