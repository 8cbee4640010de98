//! Models of the rate of a_ij, for a closure of a_ijkl.
//!
//! ȧ = Wa − aW + Λ(Da + aD − 2𝔸:D) + γ̇[2C − 2 tr(C) a − 5(Ca + aC) + 10𝔸:C] with a diffusivity C (1) of the model, γ̇
//! = (2D:D)^½ (Phelps & Tucker 2009, J. Non-Newton. Fluid Mech. 156, 165). C = C_I δ is Folgar & Tucker's.

use super::closures::Closure;
use super::fourth::{Fourth, principal};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// A model with its parameters, all dimensionless.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Model {
    /// C = C_I δ (Folgar & Tucker 1984; Advani & Tucker 1987, eq. 32).
    FolgarTucker {
        /// The coefficient C_I.
        c_i: f64,
    },
    /// Folgar & Tucker's with the eigenvalues' rates times κ (Wang, O'Gara & Tucker 2008, J. Rheol. 52, 1179).
    Rsc {
        /// The coefficient C_I.
        c_i: f64,
        /// The factor κ.
        kappa: f64,
    },
    /// C = b₁δ + b₂a + b₃a² + b₄D/γ̇ + b₅D²/γ̇², with κ as above (Phelps & Tucker 2009).
    PhelpsTucker {
        /// The coefficients b₁ to b₅.
        b: [f64; 5],
        /// The factor κ.
        kappa: f64,
    },
    /// C = C_I(δ − 4C_M D²/γ̇²) (Tseng, Chang & Hsu 2016, J. Rheol. 60, 215).
    Iard {
        /// The coefficient C_I.
        c_i: f64,
        /// The coefficient C_M.
        c_m: f64,
    },
    /// C = C_I diag(1, Ω, 1 − Ω) in the axes of a, from the largest eigenvalue (Tseng, Chang & Hsu 2018, J. Rheol. 62,
    /// 313).
    Pard {
        /// The coefficient C_I.
        c_i: f64,
        /// The parameter Ω.
        omega: f64,
    },
    /// C = C_I diag(d) in the axes of a, from the largest eigenvalue (Bakharev, Yu, Speight & Wang 2018, ANTEC).
    Mrd {
        /// The coefficient C_I.
        c_i: f64,
        /// The coefficients D₁, D₂, D₃.
        d: [f64; 3],
    },
}

/// The names of MRD's parameters and of Phelps & Tucker's.
const NAMED: [(&str, &str); 5] = [("D1", "b1"), ("D2", "b2"), ("D3", "b3"), ("", "b4"), ("", "b5")];

impl Model {
    /// The usual name of the model.
    pub fn name(self) -> &'static str {
        match self {
            Self::FolgarTucker { .. } => "Folgar–Tucker",
            Self::Rsc { .. } => "RSC",
            Self::PhelpsTucker { .. } => "Phelps–Tucker",
            Self::Iard { .. } => "iARD",
            Self::Pard { .. } => "pARD",
            Self::Mrd { .. } => "MRD",
        }
    }

    /// The source of the model, with its equation.
    pub fn source(self) -> &'static str {
        match self {
            Self::FolgarTucker { .. } => {
                "da/dt = Wa − aW + Λ(Da + aD − 2 a_ijkl D_kl) + 2 C_I γ̇ (δ − 3a), γ̇ = (2D:D)^½: Folgar & Tucker \
                 1984; Advani & Tucker 1987"
            }
            Self::Rsc { .. } => {
                "Folgar & Tucker's equation with the rates of a's eigenvalues times κ: Wang, O'Gara & Tucker 2008, J. \
                 Rheol. 52, 1179"
            }
            Self::PhelpsTucker { .. } => {
                "anisotropic diffusion, C = b1 δ + b2 a + b3 a² + b4 D/γ̇ + b5 D²/γ̇²: Phelps & Tucker 2009, J. \
                 Non-Newton. Fluid Mech. 156, 165"
            }
            Self::Iard { .. } => {
                "anisotropic diffusion, C = C_I (δ − 4 C_M D²/γ̇²): Tseng, Chang & Hsu 2016, J. Rheol. 60, 215"
            }
            Self::Pard { .. } => {
                "anisotropic diffusion, C = C_I diag(1, Ω, 1 − Ω) in the axes of a from its largest eigenvalue: Tseng, \
                 Chang & Hsu 2018, J. Rheol. 62, 313"
            }
            Self::Mrd { .. } => {
                "anisotropic diffusion, C = C_I diag(D1, D2, D3) in the axes of a from its largest eigenvalue: \
                 Bakharev, Yu, Speight & Wang 2018, ANTEC"
            }
        }
    }

    /// The diffusivity C.
    fn diffusivity(self, a: &Matrix3<f64>, parts: &Parts) -> Matrix3<f64> {
        let Parts { strain: d, square, speed: rate, .. } = *parts;
        let one = Matrix3::identity();
        let along = |c_i: f64, d: [f64; 3]| {
            let axes = if parts.in_laboratory { one } else { principal(a).1 };
            axes * Matrix3::from_diagonal(&(Vector3::from(d) * c_i)) * axes.transpose()
        };
        match self {
            Self::FolgarTucker { c_i } | Self::Rsc { c_i, .. } => one * c_i,
            Self::PhelpsTucker { b, .. } => {
                one * b[0] + a * b[1] + a * a * b[2] + d * (b[3] / rate) + square * (b[4] / (rate * rate))
            }
            Self::Iard { c_i, c_m } => (one - square * (4.0 * c_m / (rate * rate))) * c_i,
            Self::Pard { c_i, omega } => along(c_i, [1.0, omega, 1.0 - omega]),
            Self::Mrd { c_i, d } => along(c_i, d),
        }
    }

    /// The model with another value of one parameter, C_M, Ω, D1 to D3 or b1 to b5; `None` if it has none.
    pub fn with(mut self, name: &str, of: impl Fn(f64) -> f64) -> Option<Self> {
        let value = match (&mut self, name) {
            (Self::Iard { c_m, .. }, "C_M") => c_m,
            (Self::Pard { omega, .. }, "Ω") => omega,
            (Self::Mrd { d, .. }, _) => d.get_mut(NAMED.iter().position(|(own, _)| *own == name)?)?,
            (Self::PhelpsTucker { b, .. }, _) => b.get_mut(NAMED.iter().position(|(_, own)| *own == name)?)?,
            _ => return None,
        };
        *value = of(*value);
        Some(self)
    }

    /// All parameters of the model.
    pub fn parameters(self) -> Vec<f64> {
        match self {
            Self::FolgarTucker { c_i } => vec![c_i],
            Self::Rsc { c_i: one, kappa: other }
            | Self::Iard { c_i: one, c_m: other }
            | Self::Pard { c_i: one, omega: other } => vec![one, other],
            Self::PhelpsTucker { b, kappa } => [&b[..], &[kappa]].concat(),
            Self::Mrd { c_i, d } => [&[c_i], &d[..]].concat(),
        }
    }

    /// The factor κ; 1 for models without it.
    fn slowness(self) -> f64 {
        match self {
            Self::Rsc { kappa, .. } | Self::PhelpsTucker { kappa, .. } => kappa,
            _ => 1.0,
        }
    }
}

/// A closed equation for a_ij.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equation {
    /// The velocity gradient L in 1/s.
    pub gradient_per_s: Matrix3<f64>,
    /// The shape factor Λ.
    pub shape_factor: f64,
    /// The closure for a_ijkl.
    pub closure: Closure,
    /// The model of the interaction of rods.
    pub model: Model,
}

impl Equation {
    /// The rate da_ij/dt in 1/s, with the fourth moments of the closure.
    pub fn rate(&self, a: &Matrix3<f64>) -> Matrix3<f64> {
        self.rate_with(a, &self.closure.fourth(a))
    }

    /// The rate da_ij/dt in 1/s, with the fourth moments `fourth`.
    pub fn rate_with(&self, a: &Matrix3<f64>, fourth: &Fourth) -> Matrix3<f64> {
        let all = self.parts().rate(a, fourth);
        // tr a = 1 stays by the closure's own trace. Where a closure is not linear, as 𝔸 = aa, rounding would grow: 𝔸:δ
        // = a tr a.
        all - Matrix3::identity() * (all.trace() / 3.0)
    }

    /// The quantities that enter the rate.
    pub fn parts(&self) -> Parts {
        let l = &self.gradient_per_s;
        let (spin, strain) = ((l - l.transpose()) * 0.5, (l + l.transpose()) * 0.5);
        let speed = shear_rate(&strain);
        let shape = self.shape_factor;
        Parts {
            spin,
            strain,
            square: strain * strain,
            by_component: false,
            spun: [1.0, -1.0],
            stretched: [1.0, 1.0],
            of_strain: shape,
            of_fourth: 2.0 * shape,
            pairs: 1.0,
            speed,
            decay: 3.0,
            off_diagonal: 0.0,
            drift: RIGHT,
            kappas: [self.model.slowness(); 2],
            in_laboratory: false,
            model: self.model,
        }
    }
}

/// γ̇ = (2D:D)^½ of D.
pub fn shear_rate(strain: &Matrix3<f64>) -> f64 {
    (2.0 * strain.dot(strain)).sqrt()
}

/// The quantities that enter the rate of a_ij; a wrong implementation has a wrong one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// W in 1/s.
    pub spin: Matrix3<f64>,
    /// D in 1/s.
    pub strain: Matrix3<f64>,
    /// D² of a diffusivity, in 1/s².
    pub square: Matrix3<f64>,
    /// Whether Da and aD are products of each component alone.
    pub by_component: bool,
    /// The 1 before Wa and the −1 before aW.
    pub spun: [f64; 2],
    /// The 1 before Da and before aD.
    pub stretched: [f64; 2],
    /// Λ before Da + aD.
    pub of_strain: f64,
    /// 2Λ before 𝔸:D.
    pub of_fourth: f64,
    /// The weight of off-diagonal pairs k, l in 𝔸:D and 𝔸:C, 1.
    pub pairs: f64,
    /// γ̇ in 1/s.
    pub speed: f64,
    /// The 3 of Folgar & Tucker's δ − 3a.
    pub decay: f64,
    /// What stands off the diagonal of their δ, 0.
    pub off_diagonal: f64,
    /// The 5 before Ca + aC and the 10 before 𝔸:C.
    pub drift: [f64; 2],
    /// κ at 𝔸, and at the diffusion.
    pub kappas: [f64; 2],
    /// Whether C with numbers along the axes of a has them along those of the laboratory.
    pub in_laboratory: bool,
    /// The model.
    pub model: Model,
}

impl Parts {
    /// The rate da_ij/dt in 1/s of the equation with these parts, as it stands: the trace is not corrected.
    pub fn rate(&self, a: &Matrix3<f64>, fourth: &Fourth) -> Matrix3<f64> {
        let Self { spin: w, strain: d, spun, stretched, of_strain, of_fourth, speed, decay, .. } = self;
        let turned = w * a * spun[0] + a * w * spun[1];
        if *d == Matrix3::zeros() {
            return turned;
        }
        let kappa = self.kappas[1];
        let c = self.model.diffusivity(a, self);
        let (fourth, source) = if self.kappas == [1.0; 2] { (*fourth, c) } else { slowed(self.kappas, a, fourth, &c) };
        let by_fourth = |x: &Matrix3<f64>| {
            fourth.contract(&Matrix3::from_fn(|k, l| if k == l { x[(k, l)] } else { self.pairs * x[(k, l)] }))
        };
        let [da, ad] = if self.by_component { [d.component_mul(a); 2] } else { [d * a, a * d] };
        let stretched = (da * stretched[0] + ad * stretched[1]) * *of_strain - by_fourth(d) * *of_fourth;
        let diffused = match self.model {
            Model::FolgarTucker { c_i } | Model::Rsc { c_i, .. } => {
                let ones = Matrix3::from_fn(|i, j| if i == j { 1.0 } else { self.off_diagonal });
                (ones - a * *decay) * (2.0 * kappa * c_i)
            }
            _ => {
                let slowness = (source - c) * 2.0 + a * (2.0 * (1.0 - kappa) * c.trace());
                drifted(a, &c, &by_fourth(&c), self.drift) + slowness
            }
        };
        turned + stretched + diffused * *speed
    }
}

/// 2C − 2 tr(C) a − 5(Ca + aC) + 10𝔸:C.
pub(crate) fn diffusion(a: &Matrix3<f64>, fourth: &Fourth, c: &Matrix3<f64>) -> Matrix3<f64> {
    drifted(a, c, &fourth.contract(c), RIGHT)
}

/// The 5 and the 10 of diffusion.
const RIGHT: [f64; 2] = [5.0, 10.0];

fn drifted(a: &Matrix3<f64>, c: &Matrix3<f64>, by_fourth: &Matrix3<f64>, [five, ten]: [f64; 2]) -> Matrix3<f64> {
    c * 2.0 - a * (2.0 * c.trace()) - (c * a + a * c) * five + by_fourth * ten
}

/// 𝔸 + (1 − κ)(𝕃 − 𝕄:𝔸) and C − (1 − κ)𝕄:C, each with its κ, with 𝕃 = Σλ_i eeee and 𝕄 = Σ eeee over the axes of a.
fn slowed([kappa, at_c]: [f64; 2], a: &Matrix3<f64>, fourth: &Fourth, c: &Matrix3<f64>) -> (Fourth, Matrix3<f64>) {
    let (values, axes) = principal(a);
    let own = fourth.turned(&axes.transpose());
    // In the axes of a, 𝕄 selects the rows of eeee.
    let slow = Fourth::from_fn(|i, j, k, l| {
        if i == j {
            let target = if k == i && l == i { values[i] } else { 0.0 };
            own.at(i, i, k, l) + (1.0 - kappa) * (target - own.at(i, i, k, l))
        } else {
            own.at(i, j, k, l)
        }
    });
    let inner = axes.transpose() * c * axes;
    let kept = axes * Matrix3::from_diagonal(&inner.diagonal()) * axes.transpose();
    (slow.turned(&axes), c - kept * (1.0 - at_c))
}
