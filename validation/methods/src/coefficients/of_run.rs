//! C_I of a run, from its means of ⟨pp⟩ and ⟨pppp⟩ against time.

use super::Means;
use crate::derived::{Estimate, jackknife};
use crate::tensors::closures::Closure;
use crate::tensors::fourth::{Fourth, PAIRS};
use crate::tensors::models::{Equation, Model};
use nalgebra::Matrix3;
use shearbed::model::jeffery::{shape_factor, strain_per_period};
use shearbed::run::ensemble::{Column, Results};

/// The components of ⟨pp⟩, and those of ⟨pp p₁p₂⟩, both in the order of [`PAIRS`].
const COLUMNS: [(&str, &str); 6] =
    [("a11", "a1112"), ("a22", "a1222"), ("a33", "a1233"), ("a12", "a1122"), ("a13", "a1123"), ("a23", "a1223")];

/// The longest strain between two outputs: at it the sum over outputs misses e^(−2π), 0.2 %, of a flip, whose
/// components are functions of 1 + γ².
const FARTHEST: f64 = 1.0;

/// C_I over the last whole periods of a run in plane Couette flow, at most its second half, of rods of one aspect ratio
/// r_e: J = Δa/Δγ less the mean of what Jeffery's equation alone gives da/dγ, which needs no step of a single rod.
/// `None` without both orientation tensors, for a run of less than two periods, and for outputs farther apart than a
/// strain of 1.
pub fn of_run(results: &Results, aspect_ratio: f64, shear_rate_per_s: f64, replicas: u64) -> Option<Estimate> {
    let columns: Option<Vec<_>> = COLUMNS.iter().map(|(a, b)| Some([results.column(a)?, results.column(b)?])).collect();
    let (columns, strain) = (columns?, results.elapsed.iter().map(|elapsed| elapsed.strain).collect::<Vec<_>>());
    let (first, last, period) = (*strain.first()?, *strain.last()?, strain_per_period(aspect_ratio));
    // A last output that rounding puts before the end of a period still ends it.
    let periods = (0.5 * (last - first) / period + 1e-9).floor();
    let from = strain.partition_point(|at| *at < last - periods * period - 1e-9 * period);
    if periods < 1.0 || strain[from..].windows(2).any(|pair| pair[1] - pair[0] > FARTHEST) {
        return None;
    }
    // Without collisions, and per unit of strain.
    let mut gradient_per_s = Matrix3::zeros();
    gradient_per_s[(1, 0)] = shear_rate_per_s.signum();
    let (closure, model) = (Closure::Linear, Model::FolgarTucker { c_i: 0.0 });
    let free = Equation { gradient_per_s, shape_factor: shape_factor(aspect_ratio), closure, model };
    let of = |mean: &dyn Fn(&'_ Column) -> &'_ [f64]| {
        let columns = columns.iter().map(|pair| pair.map(|column| &mean(column)[from..])).collect::<Vec<_>>();
        over(&strain[from..], &columns, &free).coefficient()
    };
    let value = of(&|column| &column.mean);
    let groups = columns[0][0].without.len();
    let without: Vec<f64> = (0..groups).map(|group| of(&|column| &column.without[group])).collect();
    Some(Estimate { value, se: jackknife(value, &without, replicas) }).filter(|found| found.value.is_finite())
}

/// ⟨pp⟩ and J over all these outputs, from the components [`COLUMNS`] at each, beside rods that turn by `free`.
fn over(strain: &[f64], columns: &[[&[f64]; 2]], free: &Equation) -> Means {
    let second = |k: usize| {
        let mut a = Matrix3::zeros();
        for ((i, j), column) in PAIRS.iter().zip(columns) {
            (a[(*i, *j)], a[(*j, *i)]) = (column[0][k], column[0][k]);
        }
        a
    };
    // Shear asks for no other component of ⟨pppp⟩.
    let sheared = |k: usize| {
        let mut fourth = Fourth::default();
        (0..6).for_each(|row| fourth.0[(row, 3)] = columns[row][1][k]);
        fourth
    };
    let last = strain.len() - 1;
    let all = strain[last] - strain[0];
    let mean = |of: &dyn Fn(usize) -> Matrix3<f64>| -> Matrix3<f64> {
        let areas = (0..last).map(|k| (of(k) + of(k + 1)) * (0.5 * (strain[k + 1] - strain[k])));
        areas.sum::<Matrix3<f64>>() / all
    };
    let gain = (second(last) - second(0)) / all - mean(&|k| free.rate_with(&second(k), &sheared(k)));
    Means { second: mean(&second), gain, ..Means::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coefficients::{Diffusing, Diffusion};
    use shearbed::plan::Elapsed;
    use shearbed::run::ensemble::{self, Series};
    use shearbed::{Observable, Plan, Scene};

    const R_E: f64 = 3.0;

    /// Means against time of synthetic rods with this C_I, every eight steps for four periods.
    fn diffusing(c_i: f64) -> Results {
        let period = strain_per_period(R_E);
        let (outputs, replicas) = (4 * 100, 16);
        let diffusion = Diffusion::isotropic(shape_factor(R_E), c_i, period / 800.0);
        let names = COLUMNS.map(|(a, b)| [a, b]).concat();
        let mut all = vec![vec![vec![0.0; outputs + 1]; replicas]; names.len()];
        for replica in 0..replicas {
            let mut rods = Diffusing::isotropic(200, diffusion, replica as u64);
            for k in 0..=outputs {
                for (name, all) in names.iter().zip(&mut all) {
                    let axes = name[1..].bytes().map(|axis| usize::from(axis - b'1'));
                    let of = |p: &nalgebra::Vector3<f64>| axes.clone().map(|axis| p[axis]).product::<f64>();
                    all[replica][k] = rods.rods.iter().map(of).sum::<f64>() / 200.0;
                }
                (0..8).for_each(|_| rods.step());
            }
        }
        let mean = |curves: &[&Vec<f64>]| -> Vec<f64> {
            (0..=outputs).map(|k| curves.iter().map(|curve| curve[k]).sum::<f64>() / curves.len() as f64).collect()
        };
        let column = |(name, all): (&&str, Vec<Vec<f64>>)| {
            let others =
                |out: usize| all.iter().enumerate().filter(|(k, _)| *k != out).map(|(_, c)| c).collect::<Vec<_>>();
            let without = (0..replicas).map(|out| mean(&others(out))).collect();
            Column { name: name.to_string(), mean: mean(&all.iter().collect::<Vec<_>>()), se: Vec::new(), without }
        };
        let columns = names.iter().zip(all).map(column).collect();
        let times: Vec<f64> = (0..=outputs).map(|k| k as f64 / 100.0).collect();
        Results {
            time_name: "t_over_T",
            elapsed: times.iter().map(|t| Elapsed { seconds: *t, strain: period * t }).collect(),
            times,
            series: vec![Series { observable: Observable::OrientationTensor, columns }],
            snapshots: Vec::new(),
            counters: Default::default(),
            collisions: [0.0; 2],
        }
    }

    /// C_I of rods whose C_I is known, to five standard errors; a factor on Λ that moves it by more is the control.
    #[test]
    fn the_coefficient_of_diffusing_rods_is_found() {
        let results = diffusing(0.01);
        let found = of_run(&results, R_E, 0.5, 16).unwrap();
        let se = found.se.unwrap();
        assert!((found.value - 0.01).abs() < 5.0 * se && se < 2e-4, "{found:?}");
        let of_other = of_run(&results, 1.2 * R_E, 0.5, 16).unwrap();
        assert!((of_other.value - 0.01).abs() > 5.0 * se, "{of_other:?} {se}");
        // In the other direction these tensors are those of other rods.
        assert!((of_run(&results, R_E, -0.5, 16).unwrap().value - 0.01).abs() > 5.0 * se);
    }

    fn free_scene(periods: f64, outputs: u64) -> Scene {
        let mut scene = Scene::default();
        scene.output.observables = vec![Observable::OrientationTensor, Observable::OrientationTensor4];
        (scene.time.duration, scene.time.outputs_per_unit) = (periods, Some(outputs));
        scene
    }

    /// The core's free rods gain nothing; of too short runs, or too few outputs, nothing is said.
    #[test]
    fn free_rods_have_none() {
        let scene = free_scene(2.0, 200);
        let results = ensemble::run(&Plan::new(&scene).unwrap()).unwrap();
        let found = of_run(&results, scene.particles.aspect_ratio, 0.5, 1).unwrap();
        // What a sum over a strain of 0.4 misses of a flip.
        assert!(found.value.abs() < (-std::f64::consts::TAU / 0.4).exp(), "{found:?}");
        for scene in [free_scene(1.9, 200), free_scene(2.0, 50)] {
            let results = ensemble::run(&Plan::new(&scene).unwrap()).unwrap();
            assert_eq!(of_run(&results, scene.particles.aspect_ratio, 0.5, 1), None);
        }
    }
}
