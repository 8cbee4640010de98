//! Standard errors over the rods of one replica, beside two passes over its rods.

use crate::{any_gradient, bits, changed, on, run};
use shearbed::Results;
use shearbed::observable::{Block, Observable, Sum};
use shearbed::scene::{Flow, Interaction, Orientation, Scene, Time};
use shearbed::suspension::snapshot::Snapshot;

/// Every observable that any flow has.
const OF_ANY_FLOW: [Observable; 5] = [
    Observable::Projections,
    Observable::PlanarProjections,
    Observable::MeanAngle,
    Observable::OrientationTensor,
    Observable::OrientationTensor4,
];

/// 500 rods of r_e = 5 drawn out by planar extension: nearly all lie along axis 1 after a strain of 30.
fn drawn_out(count: usize) -> Scene {
    changed(|scene| {
        scene.flow = Flow::Gradient { gradient_per_s: any_gradient::STRETCHED };
        scene.time = Time { outputs_per_unit: Some(1), ..Time::strain(40.0) };
        scene.particles.count = count;
        scene.particles.aspect_ratio = 5.0;
        scene.output.observables = OF_ANY_FLOW.to_vec();
        scene.output.rods_at = vec![0.0, 20.0, 30.0, 40.0];
    })
}

/// 500 rods of unequal r_e that start alike, a millionth of a period later.
fn hardly_apart() -> Scene {
    changed(|scene| {
        scene.time = Time { outputs_per_unit: Some(1_000_000), ..Time::periods(2e-6) };
        scene.particles.count = 500;
        scene.particles.aspect_ratio_sd_percent = 3.6;
        scene.particles.orientation = Orientation::Given { phi_deg: 20.0, theta_deg: 60.0 };
        // The stress counts in 1 Pa, as that of a block by itself.
        scene.interaction = Some(Interaction { alpha: 0.0, ..Interaction::default() });
        scene.liquid.viscosity_pa_s = Some(1.0 / (0.5 * 50.0 * 0.072 * 0.072 * 0.072));
        scene.output.observables = Observable::ALL.to_vec();
        scene.output.rods_at = vec![1e-6, 2e-6];
    })
}

/// What each rod of a snapshot adds to the sums of an observable.
fn of_each_rod(observable: Observable, snapshot: &Snapshot) -> Vec<Vec<f64>> {
    let one = |rod: usize| {
        let mut block = Block { len: 1, ..Block::default() };
        block.p.iter_mut().zip(&snapshot.p).for_each(|(axis, p)| axis[0] = p[rod]);
        block.aspect_ratio[0] = snapshot.aspect_ratio[rod];
        let mut sums = vec![Sum::default(); observable.width()];
        observable.add(&block, &mut sums);
        sums.iter().map(|sum| sum.value).collect()
    };
    (0..snapshot.aspect_ratio.len()).map(one).collect()
}

/// By two passes, the second corrected for the rounding of the mean.
fn standard_error(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let (sum, squares) = values
        .fold((0.0, 0.0), |(sum, squares), value| (sum + (value - mean), squares + (value - mean) * (value - mean)));
    ((squares - sum * sum / n) / n / (n - 1.0)).sqrt()
}

/// Every standard error of the results at their snapshots, beside that of two passes: the columns that are off by more
/// than n ε of themselves, with room for the two passes' own rounding.
fn off(results: &Results) -> Vec<String> {
    let mut off = Vec::new();
    for snapshot in &results.snapshots {
        let allowed = 8.0 * snapshot.aspect_ratio.len() as f64 * f64::EPSILON;
        for series in &results.series {
            let values = of_each_rod(series.observable, snapshot);
            for (k, column) in series.columns.iter().enumerate() {
                let (found, expected) =
                    (column.se[snapshot.output], standard_error(values.iter().map(|values| values[k])));
                if (found - expected).abs() > allowed * expected {
                    off.push(format!(
                        "{} at output {}: {found:e}, expected {expected:e}",
                        column.name, snapshot.output
                    ));
                }
            }
        }
    }
    off
}

#[test]
fn errors_of_rods_that_are_nearly_alike_are_those_of_two_passes() {
    for scene in [drawn_out(500), hardly_apart()] {
        let results = run(&scene);
        assert_eq!(off(&results), [""; 0]);
        // The control: a difference of squares, as 1.1e-10 came out as 4.7e-10 before.
        let mut squares = results.clone();
        for snapshot in &results.snapshots {
            let values = of_each_rod(Observable::Projections, snapshot);
            let n = values.len() as f64;
            let (sum, square) = values.iter().fold((0.0, 0.0), |(s, q), v| (s + v[0], q + v[0] * v[0]));
            let variance = (square / n - (sum / n) * (sum / n)).max(0.0);
            squares.series[0].columns[0].se[snapshot.output] = (variance / (n - 1.0)).sqrt();
        }
        assert!(!off(&squares).is_empty());
    }
}

#[test]
fn rods_alike_have_no_error_at_all() {
    let mut scene = hardly_apart();
    scene.particles.aspect_ratio_sd_percent = 0.0;
    scene.time = Time { outputs_per_unit: Some(40), ..Time::periods(1.0) };
    scene.output.rods_at = Vec::new();
    let mut by_strain = scene.clone();
    by_strain.time = Time { outputs_per_unit: Some(2), ..Time::strain(20.0) };
    for scene in [scene, by_strain] {
        let results = run(&scene);
        let columns = results.series.iter().flat_map(|series| &series.columns);
        for column in columns {
            assert!(column.se.iter().all(|se| *se == 0.0), "{}: {:?}", column.name, column.se);
        }
    }
}

/// More rods than one thread takes on alone: parts are added up.
#[test]
fn errors_of_a_large_run_are_those_of_two_passes_on_any_number_of_threads() {
    let scene = drawn_out(150_000);
    let [one, three] = [1, 3].map(|threads| on(threads, || run(&scene)));
    assert_eq!(off(&one), [""; 0]);
    assert_eq!(bits(&one), bits(&three));
}
