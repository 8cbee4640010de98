//! Pictures of the results.

use super::Graded;
use crate::methods::integrators::{Integrator, RodProblem, Setting, Theory};
use crate::present::plot::{Curve, Figure};
use crate::serve::problems::{Kind, LoadedProblem, Metric};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::TAU;

/// The largest number of steps of the project's own integrators, which are only a background.
const MOST_STEPS: u64 = 20_000;

/// The place of an error of 0 on a logarithmic axis.
pub(super) const LEAST: f64 = 1e-17;

/// The program's label in a picture: its own name may be long, and _ would set the next letter as an index.
pub const PROGRAM: &str = "the graded program";

/// The largest number of problems in one picture.
const MOST_CURVES: usize = 8;

/// Error against the number of steps on one problem about rods in plane Couette flow, first for the program, then for
/// the project's own integrators, or else on problems of tensors; `None` if the program answered no such problem with
/// two numbers of steps.
pub fn steps(problems: &[LoadedProblem], graded: &[Graded]) -> Option<Figure> {
    of_rods(problems, graded).or_else(|| of_tensors(graded))
}

fn figure(title: String, y_name: &str, curves: Vec<Curve>) -> Figure {
    Figure {
        title,
        x_name: "steps".into(),
        y_name: y_name.into(),
        curves,
        x_log: true,
        y_log: true,
        ..Figure::default()
    }
}

/// (time / last time, error) of the errors of rows about rods or a tensor; empty at fewer than three times.
pub(super) fn along(loaded: &LoadedProblem, errors: &[f64]) -> Vec<(f64, f64)> {
    let times_s = &loaded.problem.times_s;
    let is_curve = matches!(loaded.problem.metric, Metric::Angle | Metric::Absolute) && times_s.len() > 2;
    let rows = errors.chunks((errors.len() / times_s.len().max(1)).max(1));
    let share = |time_s: &f64| time_s / times_s[times_s.len() - 1];
    let all = times_s.iter().map(share).zip(rows.map(|rows| crate::oracle::worst(rows.iter().copied())));
    all.filter(|_| is_curve).collect()
}

/// Error along the path, a curve for each problem; `None` if no answer has three times.
pub fn path(graded: &[Graded]) -> Option<Figure> {
    let with_path =
        graded.iter().filter(|graded| graded.path.iter().filter(|(_, error)| error.is_finite()).count() > 2);
    let of = |graded: &Graded| {
        let finite = graded.path.iter().filter(|(_, error)| error.is_finite());
        Curve::of(graded.name.clone(), finite, |(share, error)| (*share, error.max(LEAST)))
    };
    let curves: Vec<_> = with_path.take(MOST_CURVES).map(of).collect();
    (!curves.is_empty()).then(|| Figure {
        title: "Error along the path".into(),
        x_name: "time / last time".into(),
        y_name: "error (rad, or of a component)".into(),
        curves,
        y_log: true,
        ..Figure::default()
    })
}

/// A curve for each problem of tensors.
fn of_tensors(graded: &[Graded]) -> Option<Figure> {
    let with_steps = graded.iter().filter(|graded| graded.kind == Kind::Tensor && drawn(graded).len() >= 2);
    let curves: Vec<_> =
        with_steps.take(MOST_CURVES).map(|graded| curve(graded.name.clone(), &drawn(graded))).collect();
    (!curves.is_empty()).then(|| figure("Error against steps, tensors".into(), "largest error of a component", curves))
}

fn of_rods(problems: &[LoadedProblem], graded: &[Graded]) -> Option<Figure> {
    let candidates = problems.iter().filter_map(|loaded| {
        let of = |graded: &&Graded| graded.name == loaded.problem.name && drawn(graded).len() >= 2;
        Some((loaded, graded.iter().find(of)?, couette_per_s(loaded)?))
    });
    // Prefers the paper's aspect ratio.
    let (loaded, graded, rate) = candidates.min_by_key(|(loaded, ..)| loaded.problem.name != "mid-flip-11.6")?;
    let errors = drawn(graded);
    let counts: Vec<_> = errors.iter().map(|(steps, _)| *steps).collect();
    let mut curves = vec![curve(PROGRAM.to_owned(), &errors)];
    for integrator in crate::methods::integrators::own() {
        if matches!(integrator.theory, Theory::Order(_)) {
            let errors = own_errors(&integrator, loaded, rate, &counts);
            curves.push(curve(integrator.name.clone(), &errors));
        }
    }
    Some(figure(format!("Error against steps, {}", loaded.problem.name), "error (rad)", curves))
}

fn drawn(graded: &Graded) -> Vec<(u64, f64)> {
    let finite = graded.errors.iter().filter(|(_, error)| error.is_finite());
    finite.copied().collect()
}

fn curve(label: String, errors: &[(u64, f64)]) -> Curve {
    Curve::of(label, errors, |(steps, error)| (*steps as f64, error.max(LEAST)))
}

/// G in 1/s of a problem about rods in plane Couette flow u_2 = G x_1, G > 0.
fn couette_per_s(loaded: &LoadedProblem) -> Option<f64> {
    let rate = loaded.problem.shear_rate_per_s().filter(|rate| *rate > 0.0)?;
    (loaded.problem.kind == Kind::Rods).then_some(rate)
}

/// The worst rod's error at the last time, for each number of steps.
fn own_errors(integrator: &Integrator, loaded: &LoadedProblem, rate: f64, counts: &[u64]) -> Vec<(u64, f64)> {
    let r = loaded.problem.aspect_ratio;
    let end_s = loaded.problem.times_s.last().copied().unwrap_or_default();
    let problem = RodProblem::new(r, rate * end_s / (TAU * (r + 1.0 / r)));
    let error = |steps: u64| {
        let of_rod = |p: &[f64; 3]| {
            let start = UnitVector3::new_normalize(Vector3::from(*p));
            let errors =
                crate::methods::integrators::grade(integrator, &problem, &start, Setting::Steps(steps)).ok()?;
            Some(errors.orientation_rad)
        };
        let errors: Option<Vec<_>> = loaded.start.iter().map(of_rod).collect();
        Some((steps, crate::oracle::worst(errors?)))
    };
    let few = counts.iter().copied().filter(|steps| *steps <= MOST_STEPS);
    few.filter_map(error).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::problems::loaded;

    #[test]
    fn errors_on_one_problem_are_drawn_with_both_axes_logarithmic() {
        let problems = ["mid-flip-2", "mid-flip-11.6"].map(loaded);
        let of =
            |loaded, error| Graded { errors: vec![(64, error), (128, 0.1 * error)], ..Graded::without_answer(loaded) };
        let figure = steps(&problems, &[of(&problems[0], 1e-2), of(&problems[1], 1e-3)]).unwrap();
        assert!(figure.title.ends_with("mid-flip-11.6") && figure.x_log && figure.y_log);
        assert_eq!(figure.curves[0].y, [1e-3, 1e-4]);
    }

    #[test]
    fn problems_of_tensors_have_a_curve_each() {
        let problems = ["closed-ft-linear-0.1", "closed-ft-hybrid-0.01", "closed-ft-ibof-0.01"].map(loaded);
        let of =
            |(loaded, errors): (&LoadedProblem, Vec<(u64, f64)>)| Graded { errors, ..Graded::without_answer(loaded) };
        let errors = [vec![(20, 1e-2), (40, 1e-3)], vec![(20, 1e-2)], vec![(40, 3e-2), (80, 1e-2)]];
        let graded: Vec<_> = problems.iter().zip(errors).map(of).collect();
        let figure = steps(&problems, &graded).unwrap();
        let labels: Vec<_> = figure.curves.iter().map(|curve| curve.label.as_str()).collect();
        assert_eq!(labels, ["closed-ft-linear-0.1", "closed-ft-ibof-0.01"]);
        assert_eq!((&figure.curves[1].x, &figure.curves[1].y), (&vec![40.0, 80.0], &vec![3e-2, 1e-2]));
        assert!(steps(&problems, &graded[1..2]).is_none());
    }
}
