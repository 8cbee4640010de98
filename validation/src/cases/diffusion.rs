//! Rods with rotary diffusion: closures of their tensors, their orbits, and their distribution against results that
//! need no harmonics.

use super::*;
use crate::methods::coefficients::jumps::{Quantity, Shares, Watch, above};
use crate::methods::tensors::{self, Closure, Equation, Fourth};
use crate::oracle::closed_form::orbit_constant_cdf;
use crate::oracle::diffusion::orbits::{cdf, mean_over_orbits, second_moments_of_orbit};
use crate::oracle::diffusion::{Means, Motion, NoAnswer, Start, at, steady};
use crate::oracle::reference::big::{Bits, double};
use crate::oracle::reference::isotropic::{Covariance, PAIRS, QUADRUPLES};
use crate::oracle::reference::motion::{Motion as Free, Unit};
use crate::studies::coefficients;
use crate::studies::coefficients::jumps::{diffused, kicked};

type Of = fn(Closure, &Matrix3<f64>) -> Fourth;

pub fn cases() -> Vec<Case> {
    let right = Orbits { weak: cdf, collisions: |_| {} };
    vec![
        Case::of(Judges::Program, "closures")
            .claim(
                "Hybrid, ORE and IBOF leave the steady tensors at rest that others published for them; the natural \
                 closure gives a_ijkl of free rods that started isotropic.",
            )
            .source("Folgar & Tucker 1984; docs/src/theory/diffusion.md; validation/published/tensor-models")
            .under_test((|closure, a| closure.fourth(a)) as Of)
            .mistake("f and 1 − f exchanged in the hybrid closure", |closure, a| match closure {
                Closure::Hybrid => {
                    let f = 1.0 - 27.0 * a.determinant();
                    Fourth(Closure::Linear.fourth(a).0 * f + Closure::Quadratic.fourth(a).0 * (1.0 - f))
                }
                _ => closure.fourth(a),
            })
            .mistake("the fit ORE for the natural closure", |closure, a| match closure {
                Closure::Natural => Closure::Ore.fourth(a),
                _ => closure.fourth(a),
            })
            .mistake("the natural closure for its fit ORE", |closure, a| match closure {
                Closure::Ore => Closure::Natural.fourth(a),
                _ => closure.fourth(a),
            })
            .mistake("a_ijkl too large by 10⁻⁷", |closure, a| Fourth(closure.fourth(a).0 * (1.0 + 1e-7)))
            .check(check),
        Case::of(Judges::Interpretation, "orbits-of-collisions")
            .claim(
                "Weak rotary diffusion leaves the closed form's 46.1 % of rods of r_e = 11.6 above C_b = ½; \
                 collisions leave far more there than isotropic directions have, 50.7 %.",
            )
            .source("eq. 13; Leal & Hinch 1971; docs/src/theory/diffusion.md")
            .under_test(right)
            .mistake(
                "the orbits of isotropic directions for those of weak diffusion",
                Orbits { weak: orbit_constant_cdf, ..right },
            )
            .mistake(
                "hardly any collisions: α of 10⁻⁶",
                Orbits { collisions: |scene| lab::interaction(scene).alpha = 1e-6, ..right },
            )
            .check(orbits),
        Case::of(Judges::Oracle, "diffusing-rods")
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

/// a11, a22, a33, a12 at a strain of 65, C_I = 0.0311: `published/tensor-models/values.csv`.
const STEADY: [(Closure, [f64; 4]); 3] = [
    (Closure::Ibof, [0.1312225653, 0.6493761450, 0.2194012897, 0.1133462673]),
    (Closure::Ore, [0.1312992245, 0.6498566623, 0.2188441132, 0.1140796170]),
    (Closure::Hybrid, [0.0946937910, 0.7738101787, 0.1314960304, 0.1409000748]),
];

fn check(of: &Of, _: &Effort) -> Vec<Evidence> {
    let rest = STEADY.map(|(closure, [a11, a22, a33, a12])| {
        let a = Matrix3::new(a11, a12, 0.0, a12, a22, 0.0, 0.0, 0.0, a33);
        let equation = Equation {
            gradient_per_s: Matrix3::new(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            shape_factor: 1.0,
            closure,
            model: tensors::Model::FolgarTucker { c_i: 0.0311 },
        };
        equation.rate_with(&a, &of(closure, &a)).amax()
    });
    vec![
        Evidence::on("rate of the published steady tensors, 1/G = 1", "G")
            .within(worst(rest), 1e-9)
            .because("ten published decimals, times rates below 1, and what tolerances of 1e-12 there leave"),
        Evidence::on("a_ijkl of free rods, off the elliptic integrals", "–")
            .within(worst([0.5, 2.0, 5.0].map(|strain| free(*of, strain))), 1e-12)
            .because("trapezoid rules with 3e-17 of the integrand, some thousand roundings"),
    ]
}

const ASKEW: Free = Free { gradient_per_s: [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]], aspect_ratio: 4.0 };

fn free(of: Of, strain: f64) -> f64 {
    let Some(exact) = Covariance::at(&ASKEW, &Bits(64).of(strain), Unit::Second) else { return f64::NAN };
    let mut a = Matrix3::zeros();
    for (value, (i, j)) in exact.second().iter().zip(PAIRS) {
        (a[(i, j)], a[(j, i)]) = (double(value), double(value));
    }
    let fourth = of(Closure::Natural, &a);
    worst(exact.fourth().iter().zip(QUADRUPLES).map(|(value, q)| {
        let [i, j, k, l] = q.map(|index| index - 1);
        (fourth.at(i, j, k, l) - double(value)).abs()
    }))
}

const ASPECT_RATIO: f64 = 11.6;

/// Weak diffusion: C_I r_e³ is 0.3.
const C_I: f64 = 2e-4;

#[derive(Clone, Copy)]
struct Orbits {
    /// The distribution function of C_b for weak diffusion.
    weak: fn(f64, f64) -> f64,
    collisions: Change,
}

static OF_DIFFUSION: Shared<(), Vec<Shares>> = Shared::new();

fn orbits(orbits: &Orbits, effort: &Effort) -> Vec<Evidence> {
    let (weak, high) = (Design::new(0.031, 0.06), Design::new(0.15, 0.06));
    let setting = coefficients::kick(0.5, ASPECT_RATIO, 0.5, 1);
    let scene = coefficients::scene(setting, effort);
    // C_I times the strain before is 0.07, and A(C)'s r_e²/2 makes that long enough. Diffusing rods turn exactly
    // between coarse steps.
    let watch = Watch::new(&scene, 5.0, 1.0);
    let coarse = Watch { steps: 1, strain: strain_per_period(ASPECT_RATIO) / 50.0, before: 250, jumps: 1 };
    let of_diffusion =
        OF_DIFFUSION.get(effort, (), || diffused(&scene, C_I, coarse, effort.samples(weak), (effort, 1 << 22)));
    let suspension = lab::changed(scene.clone(), orbits.collisions);
    let of_collisions = kicked(&suspension, watch, effort.samples(high));
    let less = |all: &[Shares], share: f64| Sample::of(above(all, Quantity::Orbit, 0.5).iter().map(|own| own - share));
    vec![
        Evidence::on("share of diffusing rods with C_b above ½, less the closed form's", "–")
            .is(less(&of_diffusion, 1.0 - (orbits.weak)(0.5, ASPECT_RATIO)), 0.0, 0.015, weak.effect)
            .because("a third of what isotropic directions differ by, 0.046"),
        Evidence::on("share of colliding rods with C_b above ½, less that of isotropic directions", "–")
            .exceeds(less(&of_collisions, 1.0 - orbit_constant_cdf(0.5, ASPECT_RATIO)), 0.0, high.effect)
            .because("\"far more\": the table of docs/src/theory/coefficients.md has 0.22"),
    ]
}

type Asked = ([[f64; 3]; 3], f64, f64);
type Model = fn(Asked) -> Motion;

fn distribution(model: &Model, effort: &Effort) -> Result<Vec<Evidence>, NoAnswer> {
    const ROUNDING: &str = "both solutions are refined to 4e-12";
    Ok(vec![
        Evidence::on("a_33 and a_3333 in uniaxial extension, off the closed form", "–")
            .within(extension(*model)?, 1e-11)
            .because(ROUNDING),
        Evidence::on("rate of a_ij by its own equation, steady, in flows of all kinds", "1/s")
            .within(standing(*model, effort)?, 1e-10)
            .because("a_ijkl and a_ij to 4e-12, times rates of up to 10"),
        Evidence::on("a_ij and a_ijkl of C_I = 0, off the elliptic integrals", "–")
            .within(without_diffusion(*model)?, 1e-11)
            .because(ROUNDING),
        Evidence::on("a_ii as C_I → 0, off the mean over orbits", "–")
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
    asked.into_iter().try_fold(0.0, |worst, asked| Ok(larger(worst, rate(asked, &steady(&model(asked))?).amax())))
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
    let solution = at(&model((ASKEW.gradient_per_s, ASKEW.aspect_ratio, 0.0)), Start::Isotropic, &[1.5])?;
    let Some(exact) = Covariance::at(&ASKEW, &Bits(64).of(1.5), Unit::Second) else {
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
    Ok(worst((0..3).map(off)))
}
