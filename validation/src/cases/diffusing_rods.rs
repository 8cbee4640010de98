//! The distribution of rods with rotary diffusion, against results that need no harmonics.

use super::*;
use crate::oracle::diffusion::orbits::{mean_over_orbits, second_moments_of_orbit};
use crate::oracle::diffusion::{Means, Motion, NoAnswer, Start, at, steady};
use crate::oracle::reference::big::{Bits, double};
use crate::oracle::reference::isotropic::{Covariance, PAIRS, QUADRUPLES};
use crate::oracle::reference::motion::{Motion as Free, Unit};

type Asked = ([[f64; 3]; 3], f64, f64);
type Model = fn(Asked) -> Motion;

pub fn cases() -> Vec<Case> {
    vec![
        Case::oracle("diffusing-rods")
            .claim(
                "The distribution of rods with rotary diffusion is exp(p·ΛD·p/2D_r) in extension, fulfils the \
                 equation of its second moments in any flow, is that of free rods for C_I = 0, and has the known \
                 orbits as C_I → 0.",
            )
            .source("eqs 13, A.1; Folgar & Tucker 1984; Leal & Hinch 1971")
            .under_test((|(l, r, c)| Motion::new(l, r, c)) as Model)
            .mistake("the vorticity with the other sign", |(l, r, c)| {
                let motion = Motion::new(l, r, c);
                Motion { spin: -motion.spin, ..motion }
            })
            .mistake("D_r = 2 C_I γ̇", |(l, r, c)| Motion::new(l, r, 2.0 * c))
            .mistake("γ̇ = (D:D)^½", |(l, r, c)| Motion::new(l, r, c * 0.5f64.sqrt()))
            .mistake("Λ left out", |(l, _, c)| Motion::new(l, f64::INFINITY, c))
            .mistake("a thousandth of the spin left out", |(l, r, c)| {
                let motion = Motion::new(l, r, c);
                Motion { spin: 0.999 * motion.spin, ..motion }
            })
            .check(distribution),
    ]
}

fn distribution(model: &Model, effort: &Effort) -> Result<Vec<Evidence>, NoAnswer> {
    const ROUNDING: &str = "both solutions are refined to 4e-12";
    Ok(vec![
        Evidence::on("a_33 and a_3333 in uniaxial extension, off the closed form")
            .within(extension(*model)?, 1e-11)
            .because(ROUNDING),
        Evidence::on("rate of a_ij by its own equation, steady, in flows of all kinds")
            .within(standing(*model, effort)?, 1e-10)
            .because("a_ijkl and a_ij to 4e-12, times rates of up to 10"),
        Evidence::on("a_ij and a_ijkl of C_I = 0, off the elliptic integrals")
            .within(without_diffusion(*model)?, 1e-11)
            .because(ROUNDING),
        Evidence::on("a_ii as C_I → 0, off the mean over orbits")
            .within(weak(*model)?, 1e-7)
            .because("extrapolated from C_I = 2.5e-4 and 5e-4, where the fourth power is left"),
    ])
}

/// ⟨z²⟩ and ⟨z⁴⟩ of the density e^{kz²}, by the trapezoid rule in x with z = tanh x.
fn extension(model: Model) -> Result<f64, NoAnswer> {
    let mut worst = 0.0;
    for (rate, aspect_ratio, c_i) in [(1.0, 5.0, 0.05), (-0.5, 3.0, 0.02)] {
        let gradient = [[-0.5 * rate, 0.0, 0.0], [0.0, -0.5 * rate, 0.0], [0.0, 0.0, rate]];
        let means = steady(&model((gradient, aspect_ratio, c_i)))?;
        let shape = (aspect_ratio * aspect_ratio - 1.0) / (aspect_ratio * aspect_ratio + 1.0);
        // p·Dp = rate (3z² − 1)/2 and γ̇ = 3^½ |rate|.
        let k = 0.75 * shape * rate / (c_i * 3f64.sqrt() * f64::abs(rate));
        const NODES: usize = 400;
        let mut sums = [0.0; 3];
        for node in 0..NODES {
            // Cut where the slope of z is below 1e-16: the sum converges geometrically.
            let x = 20.0 * ((node as f64 + 0.5) / NODES as f64 * 2.0 - 1.0);
            let z = x.tanh();
            let weight = x.cosh().powi(-2) * (k * z * z - k.max(0.0)).exp();
            (0..3).for_each(|power| sums[power] += weight * z.powi(2 * power as i32));
        }
        worst = larger(worst, (means.second[2] - sums[1] / sums[0]).abs());
        worst = larger(worst, (means.fourth[14] - sums[2] / sums[0]).abs());
    }
    Ok(worst)
}

/// The largest component of W a − a W + Λ(D a + a D − 2 D:a₄) + 2D_r(1 − 3a) of steady densities, computed from the
/// gradient.
fn standing(model: Model, effort: &Effort) -> Result<f64, NoAnswer> {
    let couette = |rate: f64| [[0.0; 3], [rate, 0.0, 0.0], [0.0; 3]];
    let mut asked = vec![(couette(1.0), 11.6, 1e-3), (couette(-0.5), 0.3, 0.05), (couette(2.0), 4.0, 1.0)];
    let mut random = Pcg64Dxsm::seed_from_u64(effort.seed(33));
    for _ in 0..effort.pick(3, 30) {
        let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let gradient = [0; 3].map(|_| [0; 3].map(|_| between(-1.0, 1.0)));
        asked.push((gradient, 30f64.powf(between(-0.5, 1.0)), 10f64.powf(between(-2.0, 0.0))));
    }
    let mut worst = 0.0;
    for asked in asked {
        worst = larger(worst, rate(asked, &steady(&model(asked))?).amax());
    }
    Ok(worst)
}

fn rate((gradient, r, c_i): Asked, means: &Means) -> Matrix3<f64> {
    let l = Matrix3::from_fn(|i, j| gradient[i][j]);
    let (d, w) = ((l + l.transpose()) * 0.5, (l - l.transpose()) * 0.5);
    let shape = (r * r - 1.0) / (r * r + 1.0);
    let diffusivity = c_i * (2.0 * d.norm_squared()).sqrt();
    let second = |i: usize, j: usize| {
        let pair = (i.min(j), i.max(j));
        PAIRS.iter().zip(means.second).find(|(name, _)| **name == pair).map_or(f64::NAN, |(_, value)| value)
    };
    let fourth = |i: usize, j: usize, k: usize, l: usize| {
        let mut indices = [i + 1, j + 1, k + 1, l + 1];
        indices.sort_unstable();
        QUADRUPLES.iter().zip(means.fourth).find(|(name, _)| **name == indices).map_or(f64::NAN, |(_, value)| value)
    };
    let a = Matrix3::from_fn(second);
    let stretched = Matrix3::from_fn(|i, j| (0..9).map(|n| fourth(i, j, n / 3, n % 3) * d[(n / 3, n % 3)]).sum());
    w * a - a * w + (d * a + a * d - stretched * 2.0) * shape + (Matrix3::identity() - a * 3.0) * (2.0 * diffusivity)
}

fn without_diffusion(model: Model) -> Result<f64, NoAnswer> {
    let gradient = [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]];
    let free = Free { gradient_per_s: gradient, aspect_ratio: 4.0 };
    let solution = at(&model((gradient, 4.0, 0.0)), Start::Isotropic, &[1.5])?;
    let Some(exact) = Covariance::at(&free, &Bits(64).of(1.5), Unit::Second) else {
        return Err(NoAnswer::Unsettled);
    };
    let mut worst = 0.0;
    for means in solution {
        let second = means.second.iter().zip(exact.second());
        let fourth = means.fourth.iter().zip(exact.fourth());
        worst = second.chain(fourth).fold(worst, |worst, (value, due)| larger(worst, (value - double(&due)).abs()));
    }
    Ok(worst)
}

fn weak(model: Model) -> Result<f64, NoAnswer> {
    const R: f64 = 3.0;
    let of = |c_i: f64| steady(&model(([[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]], R, c_i)));
    let (near, far) = (of(2.5e-4)?, of(5e-4)?);
    let off = |i: usize| {
        let limit = near.second[i] + (near.second[i] - far.second[i]) / 3.0;
        (limit - mean_over_orbits(R, |c| second_moments_of_orbit(c, R)[i])).abs()
    };
    Ok((0..3).map(off).fold(0.0, larger))
}
