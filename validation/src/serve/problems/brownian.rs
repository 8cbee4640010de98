//! Problems of Brownian rods: a rotary diffusivity D_r in 1/s, also in a liquid at rest. Péclet numbers are γ̇/D_r.

use super::ProblemDef;
use super::asked::COUETTE;
use super::folgar_tucker::{self, Diffusion, DiffusionProblem};

const REST: [[f64; 3]; 3] = [[0.0; 3]; 3];

#[rustfmt::skip]
const PROBLEMS: [DiffusionProblem; 6] = [
    problem("brownian-relaxation", "a_ij(t) of Brownian rods from a plane, at \
        rest", REST, 10.0, 0.25, true, &[0.05, 0.2, 0.5, 1.0, 2.0]),
    problem("brownian-startup-pe-1", "a_ij(t) of Brownian rods in shear, Pe = \
        1", COUETTE, 10.0, 0.5, false, &[0.1, 0.25, 0.5, 1.0, 2.0]),
    problem("brownian-startup-pe-10", "a_ij(t) of Brownian rods in shear, Pe = \
        10", COUETTE, 10.0, 0.05, false, &[0.5, 1.0, 2.0, 4.0, 8.0]),
    problem("brownian-startup-pe-100", "a_ij(t) of Brownian rods in shear, Pe = \
        100", COUETTE, 10.0, 0.005, false, &[1.0, 2.0, 4.0, 6.25, 10.0, 20.0]),
    problem("brownian-disc", "a_ij(t) of Brownian discs from a plane in shear, Pe = \
        10", COUETTE, 0.1, 0.05, true, &[0.5, 1.0, 2.0, 4.0, 8.0]),
    DiffusionProblem { oscillation: Some(4.0), ..problem("brownian-oscillation", "a_ij(t) of Brownian rods in shear \
        that oscillates, Pe = 10", COUETTE, 10.0, 0.05, false, &[0.5, 1.0, 2.0, 3.5, 8.0]) },
];

const fn problem(
    name: &'static str,
    title: &'static str,
    gradient_per_s: [[f64; 3]; 3],
    aspect_ratio: f64,
    d_r_per_s: f64,
    planar_start: bool,
    times: &'static [f64],
) -> DiffusionProblem {
    let diffusion = Diffusion::PerS(d_r_per_s);
    DiffusionProblem { name, title, gradient_per_s, aspect_ratio, diffusion, planar_start, oscillation: None, times }
}

/// The certified answers, written by `examples/certify.rs`.
pub(super) const TABLE: &str = include_str!("data/brownian.csv");

pub(super) fn problems() -> Vec<ProblemDef> {
    let built = |problem: &'static DiffusionProblem| {
        ProblemDef::new(problem.name, problem.title, |def| folgar_tucker::built(def, problem, TABLE, false))
    };
    PROBLEMS.iter().map(built).collect()
}

#[cfg(test)]
mod tests {
    use super::super::table::certified_row;
    use super::*;

    /// At rest a_11 − 1/3 = e^{−6D_r t}/6, and a_1111 has parts of degree 0, 2 and 4.
    #[test]
    fn relaxation_is_the_closed_form() {
        let off = |d_r: f64| {
            let rows = TABLE.lines().filter(|line| line.starts_with("brownian-relaxation,")).map(certified_row);
            let each = rows.map(|(_, row)| {
                let (two, four) = ((-6.0 * d_r * row[0]).exp(), (-20.0 * d_r * row[0]).exp());
                let a = [1.0 / 3.0 + two / 6.0, 1.0 / 3.0 - two / 3.0];
                // Degrees 0, 2 and 4 of 3/8 are 1/5, 1/7 and the rest.
                let fourth = 0.2 + two / 7.0 + (0.375 - 0.2 - 1.0 / 7.0) * four;
                (row[1] - a[0]).abs().max((row[3] - a[1]).abs()).max((row[7] - fourth).abs())
            });
            crate::oracle::worst(each)
        };
        assert!(off(0.25) < 1e-12, "{:e}", off(0.25));
        assert!(off(0.2501) > 1e-5);
    }
}
