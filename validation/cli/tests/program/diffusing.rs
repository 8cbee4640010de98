//! What the problems of diffusing rods are worth: a code that knows nothing of harmonics passes, and wrong ones fail.

use shearbed_validation::serve::problems;

/// The largest power p₁^a p₂^b.
const DEGREE: usize = 36;
const STEP_S: f64 = 0.005;

/// A code that follows the mean powers ⟨p₁^a p₂^b⟩ in plane flow by RK4; those beyond the largest are as in isotropic
/// rods.
struct Powers {
    powers: Vec<(usize, usize)>,
    rates: Vec<Vec<(usize, f64)>>,
    constants: Vec<f64>,
    means: Vec<f64>,
}

/// ⟨p₁^a p₂^b⟩ of isotropic rods: (a − 1)!!(b − 1)!!/(a + b + 1)!! for even a and b.
fn isotropic((a, b): (usize, usize)) -> f64 {
    let odd = |n: usize| (1..=n).step_by(2).map(|k| k as f64).product::<f64>();
    if a.is_multiple_of(2) && b.is_multiple_of(2) {
        odd(a.saturating_sub(1)) * odd(b.saturating_sub(1)) / odd(a + b + 1)
    } else {
        0.0
    }
}

impl Powers {
    /// ṗ = g p − p p·gp with the in-plane `g` = W + ΛD, and diffusion.
    fn new(g: [[f64; 2]; 2], diffusivity: f64) -> Self {
        let powers: Vec<_> = (0..=DEGREE).step_by(2).flat_map(|n| (0..=n).map(move |a| (a, n - a))).collect();
        let (mut rates, mut constants) = (Vec::new(), Vec::new());
        for (a, b) in powers.iter().copied() {
            let (x, y) = (a as f64, b as f64);
            let n = x + y;
            let terms = [
                ((0, 0), x * g[0][0] + y * g[1][1] - diffusivity * n * (n + 1.0)),
                ((-1, 1), x * g[0][1]),
                ((1, -1), y * g[1][0]),
                ((2, 0), -n * g[0][0]),
                ((0, 2), -n * g[1][1]),
                ((1, 1), -n * (g[0][1] + g[1][0])),
                ((-2, 0), diffusivity * x * (x - 1.0)),
                ((0, -2), diffusivity * y * (y - 1.0)),
            ];
            let (mut row, mut constant) = (Vec::new(), 0.0);
            for ((da, db), factor) in terms.into_iter().filter(|(_, factor)| *factor != 0.0) {
                let other = (a.wrapping_add_signed(da), b.wrapping_add_signed(db));
                match powers.iter().position(|power| *power == other) {
                    Some(at) => row.push((at, factor)),
                    None => constant += factor * isotropic(other),
                }
            }
            rates.push(row);
            constants.push(constant);
        }
        let means = powers.iter().map(|power| isotropic(*power)).collect();
        Self { powers, rates, constants, means }
    }

    fn rate(&self, means: &[f64]) -> Vec<f64> {
        let row = |(row, constant): (&Vec<(usize, f64)>, &f64)| {
            row.iter().map(|(at, factor)| factor * means[*at]).sum::<f64>() + constant
        };
        self.rates.iter().zip(&self.constants).map(row).collect()
    }

    fn advance(&mut self, time_s: f64) {
        let steps = (time_s / STEP_S).ceil();
        let h = time_s / steps;
        for _ in 0..steps as u64 {
            let ahead =
                |k: &[f64], h: f64| -> Vec<f64> { self.means.iter().zip(k).map(|(mean, k)| mean + h * k).collect() };
            let first = self.rate(&self.means);
            let second = self.rate(&ahead(&first, 0.5 * h));
            let third = self.rate(&ahead(&second, 0.5 * h));
            let fourth = self.rate(&ahead(&third, h));
            for (at, mean) in self.means.iter_mut().enumerate() {
                *mean += h / 6.0 * (first[at] + 2.0 * (second[at] + third[at]) + fourth[at]);
            }
        }
    }

    /// a11, a22, a33, a12, a13, a23.
    fn second(&self) -> [f64; 6] {
        let of = |power| self.means[self.powers.iter().position(|other| *other == power).unwrap()];
        let (a11, a22) = (of((2, 0)), of((0, 2)));
        [a11, a22, 1.0 - a11 - a22, of((1, 1)), 0.0, 0.0]
    }
}

#[test]
fn a_code_of_power_moments_passes_and_wrong_ones_fail() {
    let built = problems::named("folgar-tucker-shear-0.1").unwrap().loaded("folgar-tucker-shear-0.1".into());
    let (problem, rows) = (&built.problem, &built.certified.rows);
    let (rate, c_i) = (problem.gradient_per_s[1][0], problem.c_i.unwrap());
    let error = |g: [[f64; 2]; 2], diffusivity: f64| {
        let mut code = Powers::new(g, diffusivity);
        let (mut now, mut worst) = (0.0, 0.0_f64);
        for row in rows {
            code.advance(row[0] - now);
            now = row[0];
            let found = code.second();
            worst = found.iter().zip(&row[1..]).fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
        }
        worst
    };
    // Λ = 1: W + D = L. γ̇ = G.
    let right = error([[0.0, 0.0], [rate, 0.0]], c_i * rate);
    assert!(right <= problem.tolerance, "{right:e}");
    for (mistake, wrong) in [
        ("transposed", error([[0.0, rate], [0.0, 0.0]], c_i * rate)),
        ("C_I for D_r", error([[0.0, 0.0], [rate, 0.0]], c_i)),
        ("γ̇ = (D:D)^½", error([[0.0, 0.0], [rate, 0.0]], c_i * rate / 2f64.sqrt())),
        ("r_e = 100", error([[0.0, -1e-4 * rate], [(1.0 - 1e-4) * rate, 0.0]], c_i * rate)),
    ] {
        assert!(wrong > 2.0 * problem.tolerance, "{mistake}: {wrong:e}");
    }
}
