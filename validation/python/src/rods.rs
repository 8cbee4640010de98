//! Every rod at the times that a scene asks for, as arrays.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use shearbed::suspension::snapshot::Snapshot;
use shearbed::{Plan, Results};

/// The columns of `rods.csv`, with NaN where its cells are empty; `None` where no rods are asked for.
pub fn columns<'py>(py: Python<'py>, plan: &Plan, results: &Results) -> PyResult<Option<Bound<'py, PyDict>>> {
    if plan.rods_outputs().is_empty() {
        return Ok(None);
    }
    let all = PyDict::new(py);
    let each = |of: &dyn Fn(&Snapshot, usize) -> f64| {
        let mut values = Vec::new();
        for shot in &results.snapshots {
            values.extend((0..shot.aspect_ratio.len()).map(|rod| of(shot, rod)));
        }
        PyArray1::from_vec(py, values)
    };
    let elapsed = |shot: &Snapshot| results.elapsed[shot.output];
    let scene = plan.scene();
    let place =
        |shot: &Snapshot, axis: usize, rod: usize| shot.place_mm(scene, rod).map_or(f64::NAN, |place| place[axis]);
    all.set_item("replica", each(&|shot, _| shot.replica as f64))?;
    all.set_item("rod", each(&|_, rod| rod as f64))?;
    all.set_item("time_s", each(&|shot, _| elapsed(shot).seconds))?;
    all.set_item("strain", each(&|shot, _| elapsed(shot).strain))?;
    all.set_item("aspect_ratio", each(&|shot, rod| shot.aspect_ratio[rod]))?;
    all.set_item("length_mm", each(&|shot, rod| shot.length_mm(scene, rod)))?;
    for (axis, name) in ["x1_mm", "x2_mm", "x3_mm"].into_iter().enumerate() {
        all.set_item(name, each(&|shot, rod| place(shot, axis, rod)))?;
    }
    for (axis, name) in ["p1", "p2", "p3"].into_iter().enumerate() {
        all.set_item(name, each(&|shot, rod| shot.p[axis][rod]))?;
    }
    all.set_item("collided", each(&|shot, rod| f64::from(u8::from(shot.collided[rod]))))?;
    Ok(Some(all))
}
