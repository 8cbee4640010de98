//! Observables of one's own, beside those that a scene file can name.

#[cfg(test)]
mod tests;

use crate::observable::Sum;
use crate::observable::fault::Fault;
use crate::plan::Plan;
use crate::run::ensemble::{Column, Tally, in_batches};
use crate::run::{each_block, refused};
use crate::suspension::RunError;
use rayon::prelude::*;

/// What is observed of each rod; what comes out is its mean over rods and replicas against time, with its standard error.
///
/// ```
/// use shearbed::run::own::{OwnObservable, observe};
///
/// /// Hermans' orientation factor along the flow, ⟨(3p₂² − 1)/2⟩.
/// struct Hermans;
/// impl OwnObservable for Hermans {
///     fn columns(&self) -> Vec<String> {
///         vec!["f_hermans".into()]
///     }
///     fn values(&self, p: [f64; 3], _aspect_ratio: f64, values: &mut [f64]) {
///         values[0] = 0.5 * (3.0 * p[1] * p[1] - 1.0);
///     }
/// }
/// let plan = shearbed::Plan::new(&shearbed::Scene::default())?;
/// let columns = observe(&plan, &Hermans)?;
/// // Of isotropic rods it is 0.
/// assert!(columns[0].mean[0].abs() < 4.0 * columns[0].se[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait OwnObservable: Sync {
    /// The names of its columns; at least one.
    fn columns(&self) -> Vec<String>;

    /// Puts the values of one rod, one for each column, into `values`: of its direction p, |p| = 1, which is the same as −p, and
    /// its aspect ratio r_e.
    fn values(&self, p: [f64; 3], aspect_ratio: f64, values: &mut [f64]);
}

/// Runs every replica of the plan, as [`crate::run::ensemble::run`] does, and returns the columns of an observable of one's own, one value
/// for each of [`Plan::times`]. The bits are the same for any number of threads.
///
/// # Errors
///
/// As [`crate::run::ensemble::run`], and a value that is not finite.
pub fn observe(plan: &Plan, own: &impl OwnObservable) -> Result<Vec<Column>, RunError> {
    let names = own.columns();
    let width = names.len();
    let mut tally = Tally::of(plan.outputs() * width);
    in_batches(plan, width, |replicas| {
        let run = replicas.into_par_iter();
        let run = run.map(|replica| one(plan, own, &names, replica));
        for sums in run.collect::<Result<Vec<_>, _>>()? {
            tally.add_sums(plan.scene().particles.count, &sums);
        }
        Ok(())
    })?;
    Ok(names.into_iter().enumerate().map(|(place, name)| tally.column(name, place, width)).collect())
}

/// The sums of one replica, output by output.
fn one(plan: &Plan, own: &impl OwnObservable, names: &[String], replica: u64) -> Result<Vec<Sum>, RunError> {
    let mut sums = vec![Sum::none(true); plan.outputs() * names.len()];
    let mut values = vec![0.0; names.len()];
    each_block(plan, replica, |output, first, block| {
        let here = &mut sums[output * names.len()..][..names.len()];
        for rod in 0..block.len {
            let p = block.p.map(|axis| axis[rod]);
            own.values(p, block.aspect_ratio[rod], &mut values);
            for ((sum, value), name) in here.iter_mut().zip(&values).zip(names) {
                if !value.is_finite() {
                    let cause = format!("its {name} came out as {value}");
                    let fault = Fault { rod: Some(rod), cause };
                    return Err(refused(plan, replica, first, output, fault));
                }
                sum.add_one(*value);
            }
        }
        Ok(())
    })?;
    Ok(sums)
}
