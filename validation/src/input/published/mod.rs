//! Published results on related suspensions, shipped in `validation/published` with their provenance.

/// C_I at a volume fraction times physical aspect ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// The volume fraction times the physical aspect ratio, φ r_p.
    pub phi_rp: f64,
    /// The coefficient C_I.
    pub c_i: f64,
}

/// One run: strain and a_11 at each output.
pub type Run = Vec<[f64; 2]>;

/// Seven measured C_I of Folgar & Tucker, J. Reinforced Plastics and Composites 3 (1984) 98, second-hand: as in
/// fiberoripy dc16f7c.
pub fn folgar_tucker() -> Vec<Coefficient> {
    let rows = numbers(include_str!("../../../published/folgar-tucker-1984/ci.csv"));
    rows.map(|row| Coefficient { phi_rp: row[0], c_i: row[1] }).collect()
}

/// Physical aspect ratio of the fibres of [`sph_fibres`].
pub const SPH_ASPECT_RATIO: f64 = 4.431_135;

/// Five simulated runs of fibres at 1 % by volume, all along axis 1 at the start: N. Meyer et al., J. Composites
/// Science 4 (2020) 77, as in fiberoripy 8478bc4.
pub fn sph_fibres() -> Vec<Run> {
    let texts = [
        include_str!("../../../published/sph-fibres/volfrac1-run1.csv"),
        include_str!("../../../published/sph-fibres/volfrac1-run2.csv"),
        include_str!("../../../published/sph-fibres/volfrac1-run3.csv"),
        include_str!("../../../published/sph-fibres/volfrac1-run4.csv"),
        include_str!("../../../published/sph-fibres/volfrac1-run5.csv"),
    ];
    texts.map(|text| numbers(text).map(|row| [row[0], row[1]]).collect()).into()
}

/// The numbers of every row except the header; NaN for cells that are no number, and a test checks that there are none.
fn numbers(text: &'static str) -> impl Iterator<Item = Vec<f64>> {
    let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    text.lines().skip(1).map(move |line| line.split(',').map(number).collect())
}

/// The strain of the first maximum of a_11 after the start: the first half turn of rods along axis 1. It is the largest
/// value between the first rise above 0.3, after a fall below 0.25, and the next such fall, so that ripples do not
/// count.
pub fn first_half_turn(run: &Run) -> Option<f64> {
    let low = run.iter().position(|row| row[1] < 0.25)?;
    let rises = low + run[low..].iter().position(|row| row[1] > 0.3)?;
    let falls = rises + run[rises..].iter().position(|row| row[1] < 0.25).unwrap_or(run.len() - rises);
    run[rises..falls].iter().max_by(|a, b| a[1].total_cmp(&b[1])).map(|row| row[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_sets_are_whole() {
        let measured = folgar_tucker();
        assert_eq!(measured.len(), 7);
        assert_eq!(measured[6], Coefficient { phi_rp: 2.56, c_i: 0.0165 });
        for run in sph_fibres() {
            assert_eq!(run.len(), 1003);
            assert_eq!(run[0], [0.0, 1.0]);
            assert!(run.iter().flatten().all(|number| number.is_finite()));
            assert!(run.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        }
    }

    #[test]
    fn the_first_half_turn_of_a_free_rod_is_half_its_period() {
        // A rod turning in the shear plane from axis 1: a_11 = 1/(1 + r_e² tan² ωt), with ω = 1/(r_e + 1/r_e).
        let r_e: f64 = 4.0;
        let a11 = |t: f64| 1.0 / (1.0 + (r_e * (t / (r_e + 1.0 / r_e)).tan()).powi(2));
        let run: Run = (0..2000).map(|k| 0.01 * f64::from(k)).map(|t| [t, a11(t)]).collect();
        let half = std::f64::consts::PI * 4.25;
        // The outputs are 0.01 apart.
        assert!((first_half_turn(&run).unwrap() - half).abs() <= 0.01);
    }
}
