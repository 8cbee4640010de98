//! Properties of a scene that are known before a run: its period, its step, its shape factor, and how dilute it is.

use super::{duration, rods};
use serde::Serialize;
use shearbed::Plan;
use shearbed::motion::Propagator;
use shearbed::scene::TimeUnit;
use shearbed_validation::files::text::four_decimals;

/// The key that is n itself.
const GIVES_N: &str = "interaction.concentration_per_cm3";

/// Properties of a scene in numbers; null if a property does not exist.
#[derive(Serialize)]
pub(super) struct Facts {
    /// T, if the flow has a period.
    period_s: Option<f64>,
    /// GΔt, if the run takes steps.
    strain_per_step: Option<f64>,
    /// Λ = (r_e² − 1)/(r_e² + 1) of the mean aspect ratio.
    shape_factor: f64,
    /// n⟨a³⟩ with the full length a, for interacting rods.
    n_a3: Option<f64>,
    /// n, if a box or a volume fraction is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    concentration_per_cm3: Option<f64>,
    /// `dilute`, `semi-dilute` or `concentrated`.
    regime: Option<&'static str>,
    /// r_e with the formula that computed it from a physical aspect ratio; none without such a formula.
    #[serde(skip_serializing_if = "Option::is_none")]
    equivalent: Option<Equivalent>,
    /// The number of rows and the largest size of rods.csv; none without that file.
    #[serde(skip_serializing_if = "Option::is_none")]
    rods: Option<RodsOut>,
}

/// The r_e of a cylinder.
#[derive(Serialize)]
struct Equivalent {
    aspect_ratio: f64,
    formula: &'static str,
    by: &'static str,
}

/// The size of `rods.csv`.
#[derive(Serialize)]
struct RodsOut {
    rows: u64,
    most_bytes: u64,
}

impl Facts {
    pub(super) fn of(plan: &Plan) -> Self {
        let scene = plan.scene();
        let r = scene.particles.aspect_ratio;
        let period_s = Propagator::new(plan.flow(), r).period_s().filter(|_| scene.time.unit != TimeUnit::Strain);
        Self {
            period_s: period_s.filter(|period_s| period_s.is_finite()),
            strain_per_step: (plan.steps() > 0).then(|| plan.elapsed(1.0).strain / scene.steps_per_unit() as f64),
            // r² would be infinite for long rods, so numerator and denominator are divided by r.
            shape_factor: (r - 1.0 / r) / (r + 1.0 / r),
            n_a3: scene.rods_per_cubed_length(),
            concentration_per_cm3: scene.concentration_per_cm3().filter(|_| scene.concentration_key() != GIVES_N),
            regime: scene.regime(),
            equivalent: scene.particles.shape_correlation.map(|correlation| Equivalent {
                aspect_ratio: r,
                formula: correlation.formula().formula,
                by: correlation.formula().name,
            }),
            rods: (plan.rods_out() > 0)
                .then(|| RodsOut { rows: plan.rods_out(), most_bytes: rods::most_bytes(plan, false) }),
        }
    }

    /// The facts on one line.
    pub(super) fn text(&self) -> String {
        let mut parts = Vec::new();
        parts.extend(self.period_s.map(|period| format!("T = {} s", four_decimals(period))));
        parts.extend(self.strain_per_step.map(|strain| format!("GΔt = {}", four_decimals(strain))));
        parts.push(format!("Λ = {:.6}", self.shape_factor));
        parts.extend(self.concentration_per_cm3.map(|n| format!("n = {} per cm³", four_decimals(n))));
        let dilute = self.n_a3.zip(self.regime);
        parts.extend(dilute.map(|(n_a3, regime)| format!("n a³ = {n_a3:.3e} ({regime})")));
        parts.extend(self.equivalent.as_ref().map(|found| {
            let Equivalent { aspect_ratio, formula, by } = found;
            format!("r_e = {} ({by}: {formula})", four_decimals(*aspect_ratio))
        }));
        let rods = self.rods.as_ref().map(|rods| {
            let megabytes = 1e-6 * rods.most_bytes as f64;
            format!("\nrods.csv: {} rows, at most {megabytes:.2} MB", rods.rows)
        });
        parts.join(", ") + &rods.unwrap_or_default() + "\n"
    }
}

/// T, GΔt, n a³ and the cost on one core, as `shearbed plan` prints them.
pub fn facts(plan: &Plan) -> String {
    Facts::of(plan).text() + &duration::of_scene(plan, duration::of_replica(plan, true), None)
}
