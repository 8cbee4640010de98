//! Second methods for the values of many digits. They share the arithmetic of `dashu-float` with the first ones, and
//! what their doc comments name.

use super::big::{Big, Bits, length};
use super::isotropic::{Covariance, PAIRS, QUADRUPLES};
use super::motion::{Matrix, image, matrix, product};

/// Precision of these computations: they are good to about 80 bits.
const BITS: Bits = Bits(160);

fn dot(a: &[Big; 3], b: &[Big; 3]) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &[Big; 3], b: &[Big; 3]) -> [Big; 3] {
    [0, 1, 2].map(|i| &a[(i + 1) % 3] * &b[(i + 2) % 3] - &a[(i + 2) % 3] * &b[(i + 1) % 3])
}

/// p at each of `times_s`, which ascend, from the unit vector `start`, by Taylor's series of Jeffery's equation
/// ṗ = Wp + Λ(Dp − p p·Dp) itself (A.1): no exponential, no linear equation and no closed form.
///
/// `gradient_per_s` has ∂u_i/∂x_j in row i and column j. For |L| t up to some hundreds. In a flow that turns by
/// ω = `rotation_rad_per_s`, ṗ has L(t) = M + S with S p = ω × p, and M obeys Ṁ = SM − MS: its series too are taken,
/// without a rotation.
pub fn directions(
    gradient_per_s: &[[f64; 3]; 3],
    rotation_rad_per_s: [f64; 3],
    aspect_ratio: f64,
    start: &[Big; 3],
    times_s: &[f64],
) -> Vec<[Big; 3]> {
    const TERMS: usize = 32;
    let squares = gradient_per_s.as_flattened().iter().chain(&rotation_rad_per_s).map(|x| x * x);
    let norm = squares.sum::<f64>().sqrt();
    let square = BITS.of(aspect_ratio).sqr();
    let shape = (&square - BITS.of(1.0)) / (&square + BITS.of(1.0));
    let l = |i: usize, j: usize| BITS.of(0.5 * gradient_per_s[i][j]);
    // W + ΛD of M, which turns as M does.
    let mut pull = matrix(|i, j| l(i, j) - l(j, i) + &shape * (l(i, j) + l(j, i)));
    let turns = rotation_rad_per_s != [0.0; 3];
    let [x, y, z] = rotation_rad_per_s.map(|x| BITS.of(x));
    let zero = || BITS.of(0.0);
    let spin: Matrix = [[zero(), -&z, y.clone()], [z, zero(), -&x], [-y, x, zero()]];
    let (mut p, mut now) = (start.clone(), zero());
    let mut step = |h: &Big| {
        // The coefficients of p, of Wp + ΛDp and of Λ p·Dp, times powers of h.
        let (mut series, mut pulls, mut stretches) = (vec![p.clone()], Vec::new(), Vec::new());
        let mut turning = vec![pull.clone()];
        for k in 0..TERMS {
            let scale = h / BITS.of((k + 1) as f64);
            let pulled = turning.iter().enumerate().map(|(j, turning)| image(turning, &series[k - j]));
            let spun = image(&spin, &series[k]);
            pulls.push(pulled.fold(spun, |[x, y, z], [a, b, c]| [x + a, y + b, z + c]));
            if turns {
                let [before, after] = [product(&spin, &turning[k]), product(&turning[k], &spin)];
                turning.push(matrix(|i, j| (&before[i][j] - &after[i][j]) * &scale));
            }
            stretches.push((0..=k).fold(BITS.of(0.0), |sum, j| sum + dot(&series[j], &pulls[k - j])));
            let entry = |i: usize| {
                let taken = (0..=k).fold(BITS.of(0.0), |sum, j| sum + &stretches[j] * &series[k - j][i]);
                (&pulls[k][i] - taken) * &scale
            };
            series.push([0, 1, 2].map(entry));
        }
        pull = matrix(|i, j| turning.iter().rev().fold(zero(), |sum, term| sum + &term[i][j]));
        let sum = |i: usize| series.iter().rev().fold(BITS.of(0.0), |sum, term| sum + &term[i]);
        p = [0, 1, 2].map(sum);
        p.clone()
    };
    let at = |time_s: &f64| {
        let span = BITS.of(*time_s) - &now;
        now = BITS.of(*time_s);
        let steps = (16.0 * norm * super::big::double(&span).abs()).ceil().max(1.0);
        let h = span / BITS.of(steps);
        (0..steps as usize).map(|_| step(&h)).last().unwrap_or_else(|| start.clone())
    };
    times_s.iter().map(at).collect()
}

/// Nodes and weights of the double-exponential rule on (0, 1) (Takahasi & Mori 1974), with steps of `1/per_unit`.
fn double_exponential(per_unit: usize) -> Vec<(Big, Big)> {
    let h = BITS.of(1.0) / BITS.of(per_unit as f64);
    // Beyond |t| = 4 the weights are below e^{−80}.
    let most = 4 * per_unit as i64;
    let node = |k: i64| {
        let t = &h * BITS.of(k as f64);
        let (up, down) = (t.exp(), (-t).exp());
        let half_pi = BITS.pi() / BITS.of(2.0);
        let e = (&half_pi * (&up - &down)).exp();
        let x = &e / (&e + BITS.of(1.0));
        let weight = &h * half_pi * (up + down) * &x / (e + BITS.of(1.0));
        (x, weight)
    };
    (-most..=most).map(node).collect()
}

/// ⟨|p_i|⟩ for i = `axis`, ⟨p_j p_k⟩ in the order of [`PAIRS`] and fourth moments in that of [`QUADRUPLES`] over
/// isotropic starts: a sum over the starts p₀ themselves, with p the direction of F p₀. The map F is the only thing
/// that it shares with the first method.
///
/// `around` azimuths, and steps of the rule in cos θ₀ of `1/per_unit`: some 25 times the ratio of F's largest to its
/// smallest stretch, and half that.
pub fn isotropic(map: &Matrix, axis: usize, around: usize, per_unit: usize) -> (Big, Vec<Big>) {
    // The pole of the starts is the axis on whose equator p_i changes its sign.
    let pole = map[axis].clone();
    let size = length(&pole);
    let z = pole.map(|x| x / &size);
    let least = (0..3).min_by(|i, j| z[*i].sqr().cmp(&z[*j].sqr())).unwrap_or_default();
    let other = [0, 1, 2].map(|i| BITS.of(if i == least { 1.0 } else { 0.0 }));
    let x = cross(&z, &other);
    let size = length(&x);
    let x = x.map(|entry| entry / &size);
    let axes = [x.clone(), cross(&z, &x), z].map(|axis| image(map, &axis));
    let turn = BITS.pi() * BITS.of(2.0) / BITS.of(around as f64);
    let azimuths: Vec<_> = (0..around).map(|k| (&turn * BITS.of(k as f64)).sin_cos()).collect();
    let mut modulus = BITS.of(0.0);
    let mut sums = vec![BITS.of(0.0); PAIRS.len() + QUADRUPLES.len()];
    for (height, weight) in double_exponential(per_unit) {
        let radius = (BITS.of(1.0) - height.sqr()).sqrt();
        for (sine, cosine) in &azimuths {
            let (x, y) = (cosine * &radius, sine * &radius);
            let q = [0, 1, 2].map(|i| &axes[0][i] * &x + &axes[1][i] * &y + &axes[2][i] * &height);
            let squared = BITS.of(1.0) / dot(&q, &q);
            modulus += &weight * &q[axis] * squared.sqrt();
            let share = &weight * squared.sqr();
            let products = PAIRS.map(|(i, j)| &q[i] * &q[j]);
            let whole = &weight * &squared;
            for (sum, product) in sums.iter_mut().zip(&products) {
                *sum += product * &whole;
            }
            for (sum, n) in sums[PAIRS.len()..].iter_mut().zip(QUADRUPLES) {
                *sum += &q[n[0] - 1] * &q[n[1] - 1] * (&q[n[2] - 1] * &q[n[3] - 1]) * &share;
            }
        }
    }
    let count = BITS.of(around as f64);
    (modulus / &count, sums.into_iter().map(|sum| sum / &count).collect())
}

/// ⟨|p₁|⟩, ⟨|p₂|⟩, ⟨|p₃|⟩ of rods of Gaussian r_e (eq. 11), isotropic at t = 0, by the double-exponential rule over
/// 11.5 deviations to each side. It shares the means at one r_e with the first method; [`isotropic`] is the second one
/// for them.
pub fn unequal(rate_per_s: f64, aspect_ratio: f64, sd_percent: f64, time_s: f64, per_unit: usize) -> [Big; 3] {
    let deviation = BITS.of(aspect_ratio) * BITS.of(sd_percent) / BITS.of(100.0);
    let mut sums = [0; 4].map(|_| BITS.of(0.0));
    for (x, weight) in double_exponential(per_unit) {
        let off = (x - BITS.of(0.5)) * BITS.of(23.0);
        let weight = weight * (-off.sqr() / BITS.of(2.0)).exp();
        let r = BITS.of(aspect_ratio) + off * &deviation;
        // A.4 and A.5 with ω = G/(r + 1/r).
        let (sine, cosine) = (BITS.of(rate_per_s * time_s) / (&r + BITS.of(1.0) / &r)).sin_cos();
        let map = |sine: Big| {
            let [zero, one] = [0.0, 1.0].map(|x| BITS.of(x));
            [
                [cosine.clone(), -(&sine / &r), zero.clone()],
                [&r * &sine, cosine.clone(), zero.clone()],
                [zero.clone(), zero, one],
            ]
        };
        let transposed = |m: &Matrix| matrix(|i, j| m[j][i].clone());
        let (forth, back) = (map(sine.clone()), map(-sine));
        let rods =
            Covariance { sigma: product(&forth, &transposed(&forth)), inverse: product(&transposed(&back), &back) };
        let [x1, x2, x3] = rods.projections();
        for (sum, value) in sums.iter_mut().zip([x1, x2, x3, BITS.of(1.0)]) {
            *sum += &weight * value;
        }
    }
    let [x1, x2, x3, whole] = sums;
    [x1, x2, x3].map(|sum| sum / &whole)
}

/// ṗ′ of two rods in contact in u_2 = G x_1, from what the rule demands instead of its formulas: ṗ′ = ṗ + λℓ for each,
/// with λ_a and λ_b such that both contact points have one velocity along ℓ and the sum of both velocities along ℓ
/// stays.
///
/// `pair` has centre (mm), axis and r_e of a, then of b.
pub fn contact(shear_rate_per_s: f64, pair: &[f64; 14]) -> [[Big; 3]; 2] {
    let big = |at: usize| BITS.of(pair[at]);
    let axis = |at: usize| {
        let p = [0, 1, 2].map(|i| big(at + i));
        let size = length(&p);
        p.map(|x| x / &size)
    };
    let [a, b] = [axis(3), axis(10)];
    // The lines' nearest points: (x_b + t p_b − x_a − s p_a) is normal to both.
    let apart = [0, 1, 2].map(|i| big(7 + i) - big(i));
    let cosine = dot(&a, &b);
    let [to_a, to_b] = [dot(&apart, &a), dot(&apart, &b)];
    let sine_squared = BITS.of(1.0) - cosine.sqr();
    let arms = [(&to_a - &cosine * &to_b) / &sine_squared, (&cosine * &to_a - &to_b) / &sine_squared];
    let line = cross(&a, &b).map(|x| x / sine_squared.sqrt());
    let rate = BITS.of(shear_rate_per_s);
    let free = |p: &[Big; 3], r: Big| {
        // W and D of u_2 = G x_1, Λ.
        let shape = (r.sqr() - BITS.of(1.0)) / (r.sqr() + BITS.of(1.0));
        let half = &rate / BITS.of(2.0);
        let stretched = &rate * &p[0] * &p[1];
        [
            &half * &p[1] * (&shape - BITS.of(1.0)) - &shape * &stretched * &p[0],
            &half * &p[0] * (&shape + BITS.of(1.0)) - &shape * &stretched * &p[1],
            -(&shape * stretched * &p[2]),
        ]
    };
    let rates = [free(&a, big(6)), free(&b, big(13))];
    let along = [0, 1].map(|rod| &line[1] * &rate * big(7 * rod) + &arms[rod] * dot(&line, &rates[rod]));
    // r_a λ_a − r_b λ_b = v_b − v_a and r_a λ_a + r_b λ_b = 0, by Cramer's rule.
    let determinant = &arms[0] * &arms[1] * BITS.of(2.0);
    let difference = &along[1] - &along[0];
    let change = [&difference * &arms[1] / &determinant, -(&difference * &arms[0] / &determinant)];
    [0, 1].map(|rod| [0, 1, 2].map(|i| &rates[rod][i] + &line[i] * &change[rod]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::big::double;

    /// A third of a mean period, by a rule in doubles.
    #[test]
    fn means_of_unequal_rods_are_the_known_ones() {
        let apart = |found: [Big; 3], known: [f64; 3]| {
            crate::worst(found.iter().zip(known).map(|(a, b)| (double(a) - b).abs()))
        };
        assert!(apart(unequal(0.5, 11.6, 3.6, 0.0, 12), [0.5; 3]) < 1e-15);
        let time_s = std::f64::consts::TAU * (3.0 + 1.0 / 3.0) / 0.5 / 3.0;
        let off = |sd_percent| {
            let known = crate::isotropic::mean_projections_polydisperse(3.0, sd_percent, 1.0 / 3.0);
            apart(unequal(0.5, 3.0, 10.0, time_s, 24), known)
        };
        assert!(off(10.0) < 1e-10 && off(11.0) > 1e-4);
    }
}
