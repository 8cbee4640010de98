//! Means over rods with rotary diffusion, as a table.

use super::big::Bits;
use super::motion::{Motion, Unit};
use super::table::{Column, NoValue, Table, of_means, of_time, times};
use crate::diffusion::{self, Means, Start};

/// Rods with rotary diffusion, and the values requested for them.
#[derive(Clone, Copy, Debug)]
pub struct Diffusing {
    /// The flow and r_e, which may be ∞.
    pub motion: Motion,
    /// D_r in 1/s; above 0, and ∞ for isotropic rods.
    pub diffusivity: f64,
    /// The rods at t = 0.
    pub start: Start<'static>,
    /// True for a_4 in place of ⟨|p_i|⟩ and a_ij.
    pub fourth: bool,
    /// True for the steady distribution too, after the times.
    pub steady: bool,
}

impl Diffusing {
    /// The columns of the table.
    pub fn columns(&self) -> Vec<Column> {
        let sources = [
            "4: mean of |p_i| over the density",
            "mean of p_i p_j over the density",
            "mean of p_i p_j p_k p_l over the density",
        ];
        [of_time(), of_means(self.fourth, sources)].concat()
    }

    /// A table of values at `at` ≥ 0, ascending doubles in `unit`, followed by the steady values at the time ∞ if
    /// requested.
    ///
    /// Each value is rounded to as many decimals as its stated error allows, eleven at most.
    pub fn table(&self, at: &[f64], unit: Unit) -> Result<Table, NoValue> {
        if at.iter().any(|time| *time < 0.0) {
            return Err(NoValue::Past);
        }
        let rods = self.rods();
        let mut rows = Vec::new();
        let heads = at.iter().map(|time| times(&self.motion, &Bits(64).of(*time), unit));
        let heads = heads.collect::<Result<Vec<_>, _>>()?;
        let seconds: Vec<f64> = heads.iter().filter_map(|head| head[0]).collect();
        let all = diffusion::at(&rods, self.start, &seconds).map_err(NoValue::Diffusion)?;
        for (mut head, means) in heads.into_iter().zip(&all) {
            head.extend(self.values(means));
            rows.push(head);
        }
        if self.steady {
            let means = diffusion::steady(&rods).map_err(NoValue::Steady)?;
            let period = self.motion.couette().map(|_| f64::INFINITY);
            let strains = diffusion::strain_rate_per_s(self.motion.gradient_per_s) > 0.0;
            let mut row = vec![Some(f64::INFINITY), period, Some(if strains { f64::INFINITY } else { 0.0 })];
            row.extend(self.values(&means));
            rows.push(row);
        }
        Ok(Table { columns: self.columns(), rows })
    }

    fn rods(&self) -> diffusion::Motion {
        diffusion::Motion::diffusing(self.motion.gradient_per_s, self.motion.aspect_ratio, self.diffusivity)
    }

    fn values(&self, means: &Means) -> Vec<Option<f64>> {
        let certain = |x: &f64| Some(means.certain(*x));
        if self.fourth {
            means.fourth.iter().map(certain).collect()
        } else {
            means.projections.iter().chain(&means.second).map(certain).collect()
        }
    }
}
