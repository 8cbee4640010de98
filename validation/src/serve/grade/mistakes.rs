//! The curves of known mistakes: the answers of a program that has one of them and is correct otherwise.
//!
//! The exact motion is p = q/|q|, q = exp(At) p(0), A = W + ΛD; in a flow that turns, Q exp((A − S)t) p(0). A mistake
//! changes only flow, r_e, start, map or answer.

mod angles;
mod physical;

use super::Axes;
pub use crate::methods::turning::{Setting, angles_of, by_angles, right_map};
use crate::methods::turning::{finite, halves, in_turn, map_of, rotation, shape};
use crate::serve::problems::Problem;
use nalgebra::{Matrix3, Vector3};
use shearbed::model::flow::VelocityGradient;

impl From<&Problem> for Setting {
    fn from(problem: &Problem) -> Self {
        let spin_per_s = problem.spin();
        Self { gradient_per_s: problem.gradient() + spin_per_s, spin_per_s, aspect_ratio: problem.aspect_ratio }
    }
}

type Curve = Box<dyn Fn(&Setting, &Vector3<f64>, f64) -> Option<Vector3<f64>> + Send + Sync>;
type Map = Box<dyn Fn(&Setting, f64) -> Option<Matrix3<f64>> + Send + Sync>;

/// A known mistake.
pub struct Mistake {
    /// A description, to stand after "this is the curve of".
    pub name: String,
    /// True if the length of the answer is part of the mistake.
    pub has_length: bool,
    kind: Kind,
}

enum Kind {
    /// q = R M S p(0), with another map M, and with R and S for the components of answer and start.
    Linear { map: Map, start: Matrix3<f64>, end: Matrix3<f64> },
    /// Any other mistake.
    Curve(Curve),
}

impl Mistake {
    /// The direction after `time_s` of a rod that starts along `p`, by this mistake; `None` if the mistake does not
    /// apply. The length is 1 except for mistakes with a length of their own.
    pub fn direction(&self, setting: &Setting, p: &Vector3<f64>, time_s: f64) -> Option<Vector3<f64>> {
        let q = match &self.kind {
            Kind::Linear { map, start, end } => in_turn(end, &map(setting, time_s)?, start, p),
            Kind::Curve(curve) => curve(setting, p, time_s)?,
        };
        finite(if self.has_length { q } else { q.normalize() })
    }

    /// The linear map of directions that were isotropic at t = 0, up to a rotation before it; `None` for a mistake that
    /// is not a linear map.
    pub fn map(&self, setting: &Setting, time_s: f64) -> Option<Matrix3<f64>> {
        match &self.kind {
            Kind::Linear { map, end, .. } => Some(end * map(setting, time_s)?),
            Kind::Curve(_) => None,
        }
    }
}

/// The shear rate in 1/s of a flow u_2 = G x_1 with G > 0; `None` for other flows.
fn couette_per_s(setting: &Setting) -> Option<f64> {
    let flow = VelocityGradient::new(setting.gradient_per_s)?;
    flow.shear_rate_per_s().filter(|rate| *rate > 0.0 && setting.spin_per_s == Matrix3::zeros())
}

fn linear(name: &str, map: impl Fn(&Setting, f64) -> Option<Matrix3<f64>> + Send + Sync + 'static) -> Mistake {
    let kind = Kind::Linear { map: Box::new(map), start: Matrix3::identity(), end: Matrix3::identity() };
    Mistake { name: name.to_owned(), has_length: false, kind }
}

/// The correct motion in another flow or with another aspect ratio.
fn moved(name: &str, spoil: impl Fn(Setting) -> Setting + Send + Sync + 'static) -> Mistake {
    linear(name, move |setting, time| right_map(&spoil(*setting), time))
}

/// The motion by another A, computed from W, D and Λ.
fn rate(name: &str, a: fn(Matrix3<f64>, Matrix3<f64>, f64) -> Matrix3<f64>) -> Mistake {
    linear(name, move |setting, time| {
        let (w, d) = halves(&setting.gradient_per_s);
        let a = a(w, d, shape(setting.aspect_ratio));
        Some(rotation(&setting.spin_per_s, time) * map_of(&(a - setting.spin_per_s), time)?)
    })
}

/// The correct motion with components changed in the start and in the answer.
fn components(name: String, start: Matrix3<f64>, end: Matrix3<f64>) -> Mistake {
    Mistake { name, has_length: false, kind: Kind::Linear { map: Box::new(right_map), start, end } }
}

fn curve(
    name: &str,
    of: impl Fn(&Setting, &Vector3<f64>, f64) -> Option<Vector3<f64>> + Send + Sync + 'static,
) -> Mistake {
    Mistake { name: name.to_owned(), has_length: false, kind: Kind::Curve(Box::new(of)) }
}

/// Every known mistake about free rods.
pub fn all() -> Vec<Mistake> {
    let mut all = vec![
        moved("a transposed gradient", |s| Setting { gradient_per_s: s.gradient_per_s.transpose(), ..s }),
        moved("the flow reversed (L with the wrong sign, or time backwards)", |s| Setting {
            gradient_per_s: -s.gradient_per_s,
            ..s
        }),
        moved("Λ without its sign", |s| Setting { aspect_ratio: s.aspect_ratio.max(1.0 / s.aspect_ratio), ..s }),
        // For a disc this is Λ without its sign: both are named.
        moved("Λ with the wrong sign (1/r_e for r_e)", |s| Setting { aspect_ratio: 1.0 / s.aspect_ratio, ..s }),
        rate("no 1/r_e (Λ = 1, an infinitely slender rod)", |w, d, _| w + d),
        // This is Λ of √r_e.
        moved("(r_e − 1)/(r_e + 1) for Λ", |s| Setting { aspect_ratio: s.aspect_ratio.sqrt(), ..s }),
        rate("D without its ½", |w, d, shape| w + 2.0 * shape * d),
        rate("W without its ½", |w, d, shape| 2.0 * w + shape * d),
        rate("W halved twice", |w, d, shape| 0.5 * w + shape * d),
        rate("D halved twice", |w, d, shape| w + 0.5 * shape * d),
        rate("W left out", |_, d, shape| shape * d),
        rate("Λ = 0, D left out", |w, _, _| w),
        rate("1/Λ for Λ", |w, d, shape| w + d / shape),
        rate("the eccentricity (1 − 1/r_e²)^½ for Λ", |w, d, shape| w + (2.0 * shape / (1.0 + shape)).sqrt() * d),
        moved("twice the r_e", |s| Setting { aspect_ratio: 2.0 * s.aspect_ratio, ..s }),
        moved("half the r_e", |s| Setting { aspect_ratio: 0.5 * s.aspect_ratio, ..s }),
        moved("r_e² for r_e", |s| Setting { aspect_ratio: s.aspect_ratio.powi(2), ..s }),
        moved("half the shear rate", |s| scaled(s, 0.5)),
        moved("twice the shear rate", |s| scaled(s, 2.0)),
        linear("T without 1/r_e", |setting, time| {
            let r = setting.aspect_ratio;
            Some(turned(r, 1.0 / r, couette_per_s(setting)? * time / r))
        }),
        linear("T with r_e − 1/r_e", |setting, time| {
            let r = setting.aspect_ratio;
            Some(turned(r, 1.0 / r, couette_per_s(setting)? * time / (r - 1.0 / r)))
        }),
        linear("no 1/r_e at p_2 in the closed form", |setting, time| {
            Some(turned(setting.aspect_ratio, 1.0, right_phase(setting, time)?))
        }),
        moved("degrees for radians in the phase", |s| scaled(s, 1f64.to_degrees())),
        moved("radians for degrees in the phase", |s| scaled(s, 1f64.to_radians())),
        curve("no 1/r_e in the initial phase", |setting, p, time| {
            let phase = p.y.atan2(p.x) + right_phase(setting, time)?;
            let r = setting.aspect_ratio;
            // A.5 conserves C: the component in the plane has the length C r_e p_3 in (r_e p_1, p_2).
            let c = p.x.hypot(p.y / r);
            Some(Vector3::new(c * phase.cos(), r * c * phase.sin(), p.z))
        }),
    ];
    for (name, convert) in
        [("degrees for radians", f64::to_degrees as fn(f64) -> f64), ("radians for degrees", f64::to_radians)]
    {
        all.push(curve(&format!("{name} in the start"), move |setting, p, time| {
            Some(right_map(setting, time)? * by_angles(angles_of(p).map(convert)))
        }));
        all.push(curve(&format!("{name} in the answer"), move |setting, p, time| {
            Some(by_angles(angles_of(&(right_map(setting, time)? * p)).map(convert)))
        }));
    }
    all.push(Mistake { has_length: true, ..linear("p that is not normalised", right_map) });
    all.extend(of_turning_flows());
    all.extend(permuted());
    all.extend(in_other_axes());
    all.extend(angles::all());
    all.extend(physical::all());
    all
}

/// A gradient L(t) = Q L Qᵀ + S that is formed in a wrong way.
fn of_turning_flows() -> [Mistake; 6] {
    let steady = |s: Setting| Setting { spin_per_s: Matrix3::zeros(), ..s };
    let with_spin = |s: Setting, factor: f64| {
        let gradient_per_s = s.gradient_per_s + (factor - 1.0) * s.spin_per_s;
        Setting { gradient_per_s, ..s }
    };
    [
        moved("a flow that does not turn (rotation_rad_per_s left out)", move |s| steady(with_spin(s, 0.0))),
        moved("L(t) taken at t = 0 for ever", steady),
        moved("L(t) without the spin Q̇Qᵀ", move |s| with_spin(s, 0.0)),
        moved("L(t) with Qᵀ for Q", |s| Setting { spin_per_s: -s.spin_per_s, ..s }),
        moved("L(t) with −Q̇Qᵀ for Q̇Qᵀ", move |s| with_spin(s, -1.0)),
        moved("the rotation of the flow with the wrong sign", move |s| {
            let back = with_spin(s, -1.0);
            Setting { spin_per_s: -back.spin_per_s, ..back }
        }),
    ]
}

/// The map of a flow that turns after so many steps, each with the L of its start: any method is of order 1 then.
pub fn frozen(setting: &Setting, time_s: f64, steps: u32) -> Option<Matrix3<f64>> {
    let (spin, step_s) = (&setting.spin_per_s, time_s / f64::from(steps));
    let step = right_map(&Setting { spin_per_s: Matrix3::zeros(), ..*setting }, step_s)?;
    Some(rotation(spin, time_s) * (rotation(spin, -step_s) * step).pow(steps))
}

fn scaled(setting: Setting, factor: f64) -> Setting {
    Setting { gradient_per_s: factor * setting.gradient_per_s, ..setting }
}

/// The phase ωt = Gt/(r_e + 1/r_e) of the correct motion, 2π per period, in plane Couette flow.
pub fn right_phase(setting: &Setting, time_s: f64) -> Option<f64> {
    let r = setting.aspect_ratio;
    Some(couette_per_s(setting)? * time_s / (r + 1.0 / r))
}

/// The map q₁ = p₁ cos − k p₂ sin, q₂ = r_e p₁ sin + p₂ cos, q₃ = p₃.
fn turned(aspect_ratio: f64, k: f64, phase: f64) -> Matrix3<f64> {
    let (sin, cos) = phase.sin_cos();
    Matrix3::new(cos, -k * sin, 0.0, aspect_ratio * sin, cos, 0.0, 0.0, 0.0, 1.0)
}

/// The end of a mistake's name if the start is changed in place of the answer.
pub const IN_THE_START: &str = ", in the start";

/// The components of a vector in another order.
pub const ORDERS: [([usize; 3], &str); 5] = [
    ([1, 0, 2], "p_1 and p_2 exchanged"),
    ([2, 1, 0], "p_1 and p_3 exchanged"),
    ([0, 2, 1], "p_2 and p_3 exchanged"),
    ([1, 2, 0], "components in the order p_2, p_3, p_1"),
    ([2, 0, 1], "components in the order p_3, p_1, p_2"),
];

/// Components in another order or with another sign, in the answer or in the start.
fn permuted() -> Vec<Mistake> {
    let order = |of: [usize; 3]| Matrix3::from_fn(|i, j| f64::from(u8::from(of[i] == j)));
    let mirror = |axis: usize| Matrix3::from_diagonal(&Vector3::from_fn(|i, _| if i == axis { -1.0 } else { 1.0 }));
    let mirrored = |axis: usize| (format!("axis {} reversed (a left-handed frame)", axis + 1), mirror(axis));
    let changes = ORDERS.map(|(of, name)| (name.to_owned(), order(of))).into_iter().chain([2, 1, 0].map(mirrored));
    let none = Matrix3::identity();
    let both = |(name, change): (String, Matrix3<f64>)| {
        let in_the_start = components(format!("{name}{IN_THE_START}"), change, none);
        [components(name, none, change), in_the_start]
    };
    changes.flat_map(both).collect()
}

/// How the names of mistakes of axes begin.
pub const AXES: &str = "L and p in different axes";

/// L in other axes than p.
fn in_other_axes() -> impl Iterator<Item = Mistake> {
    let orders = ["flow,gradient", "vorticity,flow", "gradient,vorticity", "flow,vorticity", "vorticity,gradient"];
    orders.into_iter().map(|two| {
        let third = ["gradient", "flow", "vorticity"].into_iter().find(|name| !two.contains(name)).unwrap_or_default();
        let axes = format!("{two},{third}").parse::<Axes>().unwrap_or_default();
        moved(&format!("{AXES}, one of them in {axes}"), move |s| {
            let l = std::array::from_fn(|i| std::array::from_fn(|j| s.gradient_per_s[(i, j)]));
            let l = axes.tensor_to_theirs(l);
            Setting { gradient_per_s: Matrix3::from_fn(|i, j| l[i][j]), ..s }
        })
    })
}

/// a_ij of directions M p(0)/|M p(0)| where p(0) is isotropic, with det M = 1. In the principal axes of M Mᵀ, whose
/// eigenvalues are s², a_ii = R_D(s_j⁻², s_k⁻², s_i⁻²)/(3 s_1 s_2 s_3) (Carlson's R_D).
pub fn isotropic_tensor(map: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let svd = map.svd(true, false);
    let (u, s) = (svd.u?, svd.singular_values);
    let y = s.map(|s| 1.0 / (s * s));
    let volume = s.product();
    let mut principal = Vector3::zeros();
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        principal[i] = ellip::elliprd(y[j], y[k], y[i]).ok()? / (3.0 * volume);
    }
    Some(u * Matrix3::from_diagonal(&principal) * u.transpose())
}

#[cfg(test)]
mod tests;
