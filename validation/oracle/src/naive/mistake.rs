//! The deliberate mistakes that checks must catch.

/// Deliberate mistakes: a check that also passes on a model with a mistake shows nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// The change of a collision is added with the wrong sign (A.10).
    KickSign,
    /// v' = v_A + v_B in place of half of it (A.10).
    SumInsteadOfMean,
    /// The arms of A and B are exchanged.
    ArmsSwapped,
    /// |r| in place of the signed arm r.
    ArmUnsigned,
    /// V_c = V_tr: omega x r is left out of A.7.
    SpinIgnored,
    /// V_tr is not subtracted again (A.12).
    TranslationKept,
    /// A.13 as in the text at hand; shows only with `Update::Angles`.
    PrintedA13,
    /// Lambda = 1 in free motion.
    LambdaOne,
    /// T, and so dt, is half of eq. 15.
    PeriodHalved,
    /// cm^-3 converted as if it were cm^-2.
    ConcentrationUnits,
    /// Collisions where P_c < R (eqs. 8, 9).
    ProbabilityComplement,
    /// m + 1 in place of m (eq. 7).
    ProbabilityExponent,
    /// Rod i + 1 (mod N) in place of the nearest one.
    AnyNeighbour,
    /// Candidates are taken by index, not closest first.
    IndexOrder,
    /// x_1 = H R in place of H sqrt(R) (eq. 14).
    ReplacementUniform,
    /// A leaving rod keeps its x_1 and x_3; nothing is drawn.
    ReplacementNone,
    /// s over the partner's length in place of the own (eq. 7).
    PartnersLength,
    /// s over the mean length in place of the own (eq. 7).
    MeanLength,
    /// The shortest arm in units of the mean length in place of the own.
    ArmsOverMeanLength,
    /// A cube of the same volume in place of the box.
    CubeForBox,
    /// x_1 = H_2 sqrt(R) in place of H_1 sqrt(R) (eq. 14).
    ReplacementAlongFlow,
    /// In other flows: L transposed.
    GradientTransposed,
    /// In other flows: rods come in uniformly over a face, not in proportion to the inflow.
    InflowUniform,
    /// In other flows: a face is chosen by its area alone.
    FacesByArea,
    /// In other flows: all rods come in at the beginning of the step.
    InflowAtOnce,
}

impl Mistake {
    /// All mistakes, for checks that try each.
    #[rustfmt::skip]
    pub const ALL: [Self; 25] = [
        Self::KickSign, Self::SumInsteadOfMean, Self::ArmsSwapped, Self::ArmUnsigned, Self::SpinIgnored,
        Self::TranslationKept, Self::PrintedA13, Self::LambdaOne, Self::PeriodHalved, Self::ConcentrationUnits,
        Self::ProbabilityComplement, Self::ProbabilityExponent, Self::AnyNeighbour, Self::IndexOrder,
        Self::ReplacementUniform, Self::ReplacementNone, Self::PartnersLength, Self::MeanLength,
        Self::ArmsOverMeanLength, Self::CubeForBox, Self::ReplacementAlongFlow, Self::GradientTransposed,
        Self::InflowUniform, Self::FacesByArea, Self::InflowAtOnce,
    ];
}

/// `wrong` if the mistake `mistake` is made, else `right`.
pub(super) fn either<T>(made: Option<Mistake>, mistake: Mistake, wrong: T, right: T) -> T {
    if made == Some(mistake) { wrong } else { right }
}
