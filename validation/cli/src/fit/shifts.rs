//! The shifts of a fit by changes of the model.

use super::advice::{self, of_scene};
use super::input::Input;
use shearbed::scene::Scene;
use shearbed_validation::methods::least_squares::emulator::Model;
use shearbed_validation::serve::fit::budget::{self, Shift};
use shearbed_validation::serve::fit::report::Report;
use shearbed_validation::serve::fit::scenes::{AS_WRITTEN, Variant};
use shearbed_validation::serve::fit::search::{Fit, Watch};

/// The key of the scatter of r_e.
const SPREAD: &str = "particles.aspect_ratio_sd_percent";

/// The name of the shift by removing that scatter.
const ONE_ASPECT_RATIO: &str = "rods of one r_e";

/// The shifts by half the step, twice the rods, and rods of one r_e; empty if no rods interact.
pub(super) fn shifts(input: &Input, fit: &Fit, own: &Model<'_>, watch: &Watch<'_>) -> Result<Vec<Shift>, String> {
    let values = fit.values(&fit.best.place);
    let scenes = &input.scenes;
    let best: Vec<Scene> = (0..scenes.sets.len())
        .map(|set| scenes.scene(set, &values).map_err(|error| of_scene(&error)))
        .collect::<Result<_, _>>()?;
    if best.iter().all(|scene| scene.interaction.is_none()) {
        return Ok(Vec::new());
    }
    let from_a_file = best.iter().any(|scene| scene.particles.rods.is_some());
    let is_fitted = fit.ranges.iter().any(|range| range.key == SPREAD);
    let scatters = best.iter().any(|scene| scene.particles.aspect_ratio_sd_percent > 0.0);
    let variants = [
        (true, "half the time step", Variant { steps: 2, ..AS_WRITTEN }),
        // The number of rods cannot exceed the rows of a file.
        (!from_a_file, "twice the rods", Variant { rods: 2, ..AS_WRITTEN }),
        (!is_fitted && scatters, ONE_ASPECT_RATIO, Variant { one_aspect_ratio: true, ..AS_WRITTEN }),
    ];
    let shift = |(_, change, variant): (bool, &'static str, Variant)| {
        let changed = |values: &[f64]| advice::model(scenes, &input.data, variant, values);
        budget::shift(fit, change, own, &changed, watch)
    };
    variants.into_iter().filter(|(applies, ..)| *applies).map(shift).collect()
}

/// Warnings that the assumed spread of r_e affects a parameter as much as the points do: if the spread is wrong, a
/// fitted key compensates for it, and χ² hardly shows the error.
pub(super) fn taken_as_known(report: &Report) -> Vec<String> {
    let without = (report.shifts.iter()).filter(|shift| shift.change == ONE_ASPECT_RATIO);
    let large = |shift: &Shift| {
        let one = |(k, key): (usize, &String)| {
            let own = report.parameters[key].standard_uncertainty;
            let (moved, se) = (shift.shift[k], shift.se[k]);
            (moved.abs() > own && moved.abs() > CERTAIN * se).then(|| {
                format!(
                    "{key}: with rods of one r_e it would be about {:.1} of its standard uncertainty {}, and χ² tells \
                     little of that: --over {SPREAD}=0:10 beside it lets the points say how far r_e scatters",
                    moved.abs() / own,
                    if moved > 0.0 { "larger" } else { "smaller" },
                )
            })
        };
        report.order.iter().enumerate().filter_map(one).collect::<Vec<_>>()
    };
    without.flat_map(large).collect()
}

/// A shift beyond this number of standard errors is more than the noise of its replicas.
const CERTAIN: f64 = 3.0;
