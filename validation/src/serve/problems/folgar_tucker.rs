//! Problems of means over infinitely many rods with rotary diffusion D_r = C_I γ̇ (Folgar & Tucker 1984), without a
//! closure.

use super::asked::{ASKEW, COUETTE, NEEDLE, SECOND, SHEAR_RATE_PER_S, UNIAXIAL};
use super::table::twelve_decimals;
use super::{Built, Kind, Problem, ProblemDef};
use crate::files::csv::split;

/// A time at which every distribution here is steady, s: e^{−6D_r t} is below e^{−1000}.
const LATE_S: f64 = 1e8;
const PLANAR: [[f64; 3]; 3] = [[-0.25, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0; 3]];
/// Shear with an extension along the vorticity axis.
const STRETCHED: [[f64; 3]; 3] = [[-0.0625, 0.0, 0.0], [0.5, -0.0625, 0.0], [0.0, 0.0, 0.125]];

const DOUBLED: &[f64] = &[0.5, 1.0, 2.0, 4.0, 8.0];

/// A flow, rods, and the times of the answer in units of 1/G, G = 0.5/s; no times for the steady distribution.
pub(super) struct DiffusionProblem {
    pub name: &'static str,
    pub title: &'static str,
    pub gradient_per_s: [[f64; 3]; 3],
    pub aspect_ratio: f64,
    pub diffusion: Diffusion,
    pub planar_start: bool,
    /// The period of a flow that oscillates, in units of 1/G.
    pub oscillation: Option<f64>,
    pub times: &'static [f64],
}

/// The rotary diffusivity.
#[derive(Clone, Copy)]
pub(super) enum Diffusion {
    /// C_I = D_r/γ̇.
    Ci(f64),
    /// D_r in 1/s.
    PerS(f64),
}

#[rustfmt::skip]
const PROBLEMS: [DiffusionProblem; 14] = [
    ft("folgar-tucker-shear-0.1", "a_ij(t) in shear", COUETTE, NEEDLE, 0.1, DOUBLED),
    ft("folgar-tucker-shear-0.0311", "a_ij(t) in shear", COUETTE, NEEDLE, 0.0311, &[1.0, 2.0, 4.0, 6.25, 10.0, 65.0]),
    ft("folgar-tucker-shear-0.01", "a_ij(t) in shear", COUETTE, NEEDLE, 0.01, &[1.0, 2.0, 4.0, 7.0, 12.0, 20.0]),
    ft("folgar-tucker-shear-0.001", "a_ij(t) in shear", COUETTE, NEEDLE, 0.001, &[1.0, 3.0, 6.0, 10.0]),
    ft("folgar-tucker-rods-5", "a_ij(t) in shear, r_e = 5", COUETTE, 5.0, 0.01, &[1.0, 4.0, 8.0, 16.0, 32.0]),
    ft("folgar-tucker-discs", "a_ij(t) in shear, r_e = 0.2", COUETTE, 0.2, 0.02, &[1.0, 4.0, 8.0, 16.0]),
    ft("folgar-tucker-planar-extension", "a_ij(t) in planar extension", PLANAR, NEEDLE, 0.01, DOUBLED),
    ft("folgar-tucker-uniaxial-extension", "a_ij(t) in uniaxial extension", UNIAXIAL, 11.6, 0.05, DOUBLED),
    ft("folgar-tucker-mixed", "a_ij(t) in a flow without symmetry", ASKEW, 3.0, 0.02, DOUBLED),
    ft("folgar-tucker-steady-shear-0.01", "Steady a_ij in shear", COUETTE, NEEDLE, 0.01, &[]),
    ft("folgar-tucker-steady-shear-0.001", "Steady a_ij in shear", COUETTE, NEEDLE, 0.001, &[]),
    ft("folgar-tucker-steady-weak", "Steady a_ij in shear, r_e = 11.6", COUETTE, 11.6, 1e-4, &[]),
    ft("folgar-tucker-steady-stretched", "Steady a_ij in stretched shear", STRETCHED, 20.0, 0.005, &[]),
    ft("folgar-tucker-steady-mixed", "Steady a_ij in a flow without symmetry", ASKEW, 3.0, 0.02, &[]),
];

/// Further problems of the fourth moments: name, title, and the problem with the same rods.
const OF_FOURTH: [(&str, &str, &str); 3] = [
    ("folgar-tucker-fourth-shear-0.01", "a_ijkl(t) in shear, C_I = 0.01", "folgar-tucker-shear-0.01"),
    ("folgar-tucker-fourth-mixed", "a_ijkl(t) in a flow without symmetry, C_I = 0.02", "folgar-tucker-mixed"),
    ("folgar-tucker-fourth-steady", "Steady a_ijkl in shear, C_I = 0.01", "folgar-tucker-steady-shear-0.01"),
];

const fn ft(
    name: &'static str,
    title: &'static str,
    gradient_per_s: [[f64; 3]; 3],
    aspect_ratio: f64,
    c_i: f64,
    times: &'static [f64],
) -> DiffusionProblem {
    let (diffusion, planar_start, oscillation) = (Diffusion::Ci(c_i), false, None);
    DiffusionProblem { name, title, gradient_per_s, aspect_ratio, diffusion, planar_start, oscillation, times }
}

impl DiffusionProblem {
    pub fn times_s(&self) -> Vec<f64> {
        match self.times {
            [] => vec![LATE_S],
            times => times.iter().map(|time| time / SHEAR_RATE_PER_S).collect(),
        }
    }

    fn oscillation_s(&self) -> Option<f64> {
        self.oscillation.map(|period| period / SHEAR_RATE_PER_S)
    }
}

/// The columns of fourth moments.
#[rustfmt::skip]
pub(super) const FOURTH: [&str; 15] = [
    "a1111", "a1112", "a1113", "a1122", "a1123", "a1133", "a1222", "a1223", "a1233", "a1333", "a2222", "a2223", "a2233",
    "a2333", "a3333",
];

/// The certified answers, written by `examples/certify.rs`: a table is the same on every machine.
pub(super) const TABLE: &str = include_str!("data/folgar-tucker.csv");

/// The table of the problems of second moments, which has the fourth ones too.
pub(super) fn certified(problems: &[ProblemDef]) -> Result<String, String> {
    let mut table = format!("setting,time_s,{},{}\n", SECOND.join(","), FOURTH.join(","));
    for problem in problems.iter().map(|def| &def.built().problem).filter(|problem| problem.columns[1..] == SECOND) {
        let motion = problem.diffusing().ok_or("these rods diffuse")?;
        let solved = problem.distribution(&motion, problem.times_s.len(), problem.oscillation());
        for (time, means) in problem.times_s.iter().zip(solved.map_err(|why| why.to_string())?) {
            let values = twelve_decimals(means.second.iter().chain(&means.fourth).copied());
            table += &format!("{},{time:?},{values}\n", problem.name);
        }
    }
    Ok(table)
}

pub(super) fn problems() -> Vec<ProblemDef> {
    let second = PROBLEMS.iter().map(|problem| {
        let Diffusion::Ci(c_i) = problem.diffusion else { unreachable!("these rods have a C_I") };
        let title: &'static str = Box::leak(format!("{}, C_I = {c_i}", problem.title).into());
        ProblemDef::new(problem.name, title, |def| built(def, problem, TABLE, false))
    });
    let fourth = OF_FOURTH.iter().flat_map(|(name, title, of)| {
        let problem = PROBLEMS.iter().filter(|problem| problem.name == *of);
        problem.map(|problem| ProblemDef::new(name, title, |def| built(def, problem, TABLE, true)))
    });
    second.chain(fourth).collect()
}

/// The problem of the second or the fourth moments in the table's rows.
pub(super) fn built(def: &ProblemDef, problem: &DiffusionProblem, table: &str, fourth: bool) -> Built {
    let values = if fourth { 8..23 } else { 2..8 };
    let rows = table.lines().map(split).filter(|row| row[0] == problem.name);
    let certified = rows.map(|row| [&row[1..2], &row[values.clone()]].concat()).collect();
    let rods = match problem.aspect_ratio {
        NEEDLE => "Λ = 1 (r_e = 1e100)".to_owned(),
        r => format!("r_e = {r}"),
    };
    let moments = if fourth { "a_ijkl = ⟨p_i p_j p_k p_l⟩" } else { "a_ij = ⟨p_i p_j⟩" };
    let when = if problem.times.is_empty() {
        "once the distribution is steady: the row's time stands for any that is late enough"
    } else if problem.planar_start {
        "in time, from directions at random in the plane of axes 1 and 2 at t = 0: a = diag(½, ½, 0)"
    } else {
        "in time, from all directions alike at t = 0"
    };
    let flow = match problem.oscillation_s() {
        Some(period) => format!(" The flow oscillates: it is `gradient_per_s` times cos 2πt/T, T = {period} s."),
        None => String::new(),
    };
    let (c_i, d_r_per_s, diffusivity) = match problem.diffusion {
        Diffusion::Ci(c_i) => (Some(c_i), None, format!("D_r = C_I γ̇, C_I = {c_i}, γ̇ = (2D:D)^½")),
        Diffusion::PerS(d_r) => (None, Some(d_r), format!("D_r = {d_r}/s")),
    };
    let problem = Problem {
        summary: format!(
            "{moments} of infinitely many rods of {rods} with the rotary diffusivity {diffusivity}, {when}.{flow} The \
             answer is that of the distribution, ∂ψ/∂t = D_r∇²ψ − ∇·(ṗψ) on the sphere with Jeffery's ṗ, and not of a \
             closure: a code with a closure of a_ijkl misses it by what the closure costs."
        ),
        gradient_per_s: problem.gradient_per_s,
        aspect_ratio: problem.aspect_ratio,
        c_i,
        d_r_per_s,
        planar_start: problem.planar_start,
        oscillation_period_s: problem.oscillation_s(),
        times_s: problem.times_s(),
        tolerance: 1e-9,
        because: "Diffusion makes every error on the way fade, so a fourth-order method comes to about 10 ε^(4/5) = \
            3e-12 per unit of strain, 2e-10 in the longest of these problems; five times that is left for the number \
            of harmonics or cells. Certified values are good to 4e-12. Closures miss by 1e-3 to 1e-1."
            .into(),
        equations: vec![
            "Folgar & Tucker 1984, J. Reinf. Plast. Comp. 3, 98: the Fokker–Planck equation, by even spherical \
             harmonics; A.1 for ṗ"
                .into(),
        ],
        ..Problem::new(def, Kind::Tensor, if fourth { &FOURTH } else { &SECOND })
    };
    Built::new(problem, certified)
}

#[cfg(test)]
mod tests {
    use super::super::table::certified_row;
    use super::*;

    /// Steady a_ij and a_ijkl satisfy the moment equation, written here a second time from the problem's file alone.
    #[test]
    fn steady_tables_stand_still_by_the_equation_of_second_moments() {
        let residual = |problem: &DiffusionProblem, c_i: f64, transposed: bool| {
            let line = TABLE.lines().find(|line| line.starts_with(&format!("{},", problem.name))).unwrap();
            let (_, values) = certified_row(line);
            let at = |columns: &[&str], name: String| columns.iter().position(|column| *column == name).unwrap();
            let sorted = |mut indices: Vec<usize>| {
                indices.sort_unstable();
                format!("a{}", indices.iter().map(|i| (i + 1).to_string()).collect::<String>())
            };
            let two = |i: usize, j: usize| values[1 + at(&SECOND, sorted(vec![i, j]))];
            let four = |i, j, k, l| values[7 + at(&FOURTH, sorted(vec![i, j, k, l]))];
            let l = |i: usize, j: usize| {
                if transposed { problem.gradient_per_s[j][i] } else { problem.gradient_per_s[i][j] }
            };
            let r = problem.aspect_ratio;
            let shape = (r * r - 1.0) / (r * r + 1.0);
            let w = |i, j| 0.5 * (l(i, j) - l(j, i));
            let d = |i, j| 0.5 * (l(i, j) + l(j, i));
            let pairs = || (0..9).map(|n| (n / 3, n % 3));
            let rate = pairs().map(|(i, j)| 2.0 * d(i, j) * d(i, j)).sum::<f64>().sqrt();
            let of = |(i, j): (usize, usize)| {
                let turned = (0..3).map(|k| {
                    w(i, k) * two(k, j) - two(i, k) * w(k, j) + shape * (d(i, k) * two(k, j) + two(i, k) * d(k, j))
                });
                let stretched = pairs().map(|(k, n)| four(i, j, k, n) * d(k, n)).sum::<f64>();
                let one = if i == j { 1.0 } else { 0.0 };
                turned.sum::<f64>() - 2.0 * shape * stretched + 2.0 * c_i * rate * (one - 3.0 * two(i, j))
            };
            crate::oracle::worst(pairs().map(of).map(f64::abs))
        };
        let steady = PROBLEMS.iter().filter(|problem| problem.times.is_empty());
        for problem in steady {
            let Diffusion::Ci(c_i) = problem.diffusion else { panic!() };
            // Twelve decimals, times rates of about 1.
            let right = residual(problem, c_i, false);
            assert!(right < 1e-11, "{}: {right:e}", problem.name);
            assert!(residual(problem, 1.01 * c_i, false) > 1e-6, "{}", problem.name);
            assert!(residual(problem, c_i, true) > 1e-3, "{}", problem.name);
        }
    }
}
