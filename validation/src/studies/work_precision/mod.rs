//! Error against run time of every integrator, and the fall of its error with the step, as plain data. [`study`] shows
//! them.

pub mod order;
pub mod rows;
pub mod study;
mod time;

use super::*;
use crate::methods::integrators::Failure;
pub use time::{Budget, Seconds};
pub(crate) use time::{measure, seconds};

/// The aspect ratios of the benches.
pub const ASPECT_RATIOS: [f64; 4] = [2.0, 11.6, 100.0, 1e4];

/// The names of the benches, as [`name`] returns them.
const PARTS: [&str; 4] = ["re2", "re11.6", "re100", "re10000"];

/// The errors in rad for which the cheapest integrator is sought.
pub const TARGETS_RAD: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// The result of one setting of an integrator.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// The setting.
    pub setting: Setting,
    /// The errors at the end; none if the run failed.
    pub errors: Option<Errors>,
    pub(crate) failure: Option<String>,
    /// The time of a run, failed or not.
    pub seconds: Seconds,
    /// The number of evaluations of ṗ for each rod, if the integrator counts them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evaluations: Option<u64>,
}

/// The error of an integrator against its run time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct IntegratorCurve {
    pub(crate) integrator: String,
    /// The theory of its error.
    pub theory: Theory,
    /// The points, from the coarsest setting to the finest that the budget allows.
    pub points: Vec<Point>,
}

/// The curves of all integrators for one problem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bench {
    /// The bench's name, such as `re11.6`.
    pub name: String,
    pub(crate) aspect_ratio: f64,
    /// t/T at the end.
    pub turns: f64,
    pub(crate) curves: Vec<IntegratorCurve>,
}

/// The name of the bench at an aspect ratio.
pub fn name(aspect_ratio: f64) -> String {
    format!("re{aspect_ratio}")
}

/// Runs every integrator on a rod of this aspect ratio ([`RodProblem::mid_flip`]), on this thread alone.
pub fn run(aspect_ratio: f64, integrators: &[Integrator], budget: Budget) -> Bench {
    let (problem, _) = RodProblem::mid_flip(aspect_ratio);
    Bench {
        name: name(aspect_ratio),
        aspect_ratio,
        turns: problem.turns,
        curves: (integrators.iter()).map(|integrator| curve(integrator, aspect_ratio, budget)).collect(),
    }
}

/// An integrator's curve: settings from coarse to fine until a run takes longer than half the budget, as the next would
/// take twice as long.
pub fn curve(integrator: &Integrator, aspect_ratio: f64, budget: Budget) -> IntegratorCurve {
    let (problem, start) = RodProblem::mid_flip(aspect_ratio);
    let graded = |setting| Ok((grade(integrator, &problem, &start, setting)?, None));
    let run = |setting| integrator.advance(&problem, &start, setting);
    curve_of(&integrator.name, integrator.theory, budget, graded, run)
}

/// A curve of anything that can be run: `graded` returns the errors and the number of evaluations, `run` is timed.
pub(crate) fn curve_of<T>(
    name: &str,
    theory: Theory,
    budget: Budget,
    graded: impl Fn(Setting) -> Result<(Errors, Option<u64>), Failure>,
    run: impl Fn(Setting) -> T,
) -> IntegratorCurve {
    let mut points = Vec::new();
    for setting in settings(theory) {
        let found = graded(setting);
        let seconds = time::measure(budget, || run(setting));
        let (errors, evaluations, failure) = match found {
            Ok((errors, evaluations)) => (Some(errors), evaluations, None),
            Err(failure) => (None, None, Some(failure.to_string())),
        };
        points.push(Point { setting, errors, failure, seconds, evaluations });
        if seconds.least > 0.5 * budget.seconds_per_run {
            break;
        }
    }
    IntegratorCurve { integrator: name.to_owned(), theory, points }
}

/// The settings for a theory: 16, 32, … 2³⁰ steps, tolerances from 10⁻² to 10⁻¹⁴, or a single exact one.
fn settings(theory: Theory) -> Vec<Setting> {
    match theory {
        Theory::Exact => vec![Setting::Once],
        Theory::Order(_) => (4..=30).map(|power| Setting::Steps(1 << power)).collect(),
        Theory::Adaptive => (2..=14).map(|power| Setting::Tolerance(10f64.powi(-power))).collect(),
    }
}

impl Point {
    /// The angle to the closed form in rad; infinite if the run failed.
    pub fn error_rad(&self) -> f64 {
        self.errors.map_or(f64::INFINITY, |errors| errors.orientation_rad)
    }
}

impl IntegratorCurve {
    /// The cheapest point with at most this error. The next finer one must have it too, to exclude accidental
    /// crossings.
    pub fn cheapest(&self, error_rad: f64) -> Option<&Point> {
        let reaches = |k: usize| self.points.get(k).is_none_or(|point| point.error_rad() <= error_rad);
        (0..self.points.len())
            .filter(|k| reaches(*k) && reaches(*k + 1))
            .map(|k| &self.points[k])
            .min_by(|a, b| a.seconds.least.total_cmp(&b.seconds.least))
    }

    /// The point with the smallest error.
    pub fn best(&self) -> Option<&Point> {
        (self.points.iter()).min_by(|a, b| a.error_rad().total_cmp(&b.error_rad()))
    }

    /// The number of settings that failed.
    pub fn failures(&self) -> usize {
        self.points.iter().filter(|point| point.errors.is_none()).count()
    }
}

impl Bench {
    /// The cheapest point with at most this error, and its curve, of the curves whose theory `which` accepts.
    pub fn cheapest(&self, error_rad: f64, which: impl Fn(Theory) -> bool) -> Option<(&IntegratorCurve, &Point)> {
        (self.curves.iter())
            .filter(|curve| which(curve.theory))
            .filter_map(|curve| Some((curve, curve.cheapest(error_rad)?)))
            .min_by(|a, b| a.1.seconds.least.total_cmp(&b.1.seconds.least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUICK: Budget = Budget { seconds_per_run: 1e-4, runs: 1 };

    fn point(error: Option<f64>, seconds: f64) -> Point {
        let errors =
            error.map(|orientation_rad| Errors { orientation_rad, orbit_constant: 0.0, phase_turns: 0.0, length: 0.0 });
        let seconds = Seconds { least: seconds, most: seconds, measurements: 1 };
        Point { setting: Setting::Once, errors, failure: None, seconds, evaluations: None }
    }

    #[test]
    fn a_chance_crossing_does_not_count() {
        let curve = IntegratorCurve {
            integrator: "synthetic".into(),
            theory: Theory::Order(1),
            points: vec![
                point(Some(1e-9), 1.0),
                point(Some(0.1), 2.0),
                point(None, 3.0),
                point(Some(1e-4), 4.0),
                point(Some(1e-5), 5.0),
            ],
        };
        assert_eq!(curve.cheapest(1e-3).map(|p| p.seconds.least), Some(4.0));
        assert_eq!(curve.cheapest(1e-5).map(|p| p.seconds.least), Some(5.0));
        assert_eq!(curve.cheapest(1e-6), None);
        assert_eq!(curve.failures(), 1);
    }

    #[test]
    fn a_failing_integrator_is_shown_and_a_slow_one_stopped() {
        let blows_up = Integrator::in_p("synthetic", 1, |_, p, _| p * f64::INFINITY);
        let measured = curve(&blows_up, 2.0, QUICK);
        assert_eq!(measured.failures(), measured.points.len());
        assert_eq!(measured.points[0].failure.as_deref(), Some("not finite"));
        let idle = Integrator::in_p("synthetic", 1, |_, p, _| std::hint::black_box(p)).keeping_length();
        assert!(curve(&idle, 2.0, QUICK).points.len() < 26, "the budget ends it");
        let refuses = Integrator::new("synthetic", Theory::Adaptive, |_, _, _| Err(Failure::Gave("too stiff".into())));
        let measured = curve(&refuses, 2.0, QUICK);
        assert_eq!((measured.points.len(), measured.failures()), (13, 13));

        // Failed runs appear in every form of output.
        let bench = Bench { name: name(2.0), aspect_ratio: 2.0, turns: 1.0, curves: vec![measured] };
        let benches = [bench];
        let csv = rows::bench_csv(&benches).unwrap();
        assert_eq!(csv.matches(",too stiff,").count(), 13, "{csv}");
        assert!(
            crate::files::build::json(&benches[0].curves[0].points[0]).unwrap().contains("\"failure\": \"too stiff\"")
        );
        let tables = study::cheapest(&benches).text() + &study::every_integrator(&benches[0]).text();
        assert!(tables.contains("not reached") && tables.contains("13 of 13"), "{tables}");
        let figure = &study::figure(&benches[0]).figure;
        assert_eq!(figure.points[0].x.len(), 13);
    }

    #[test]
    fn every_integrator_is_in_every_table() {
        assert_eq!(ASPECT_RATIOS.map(name), PARTS);
        let integrators = crate::studies::integrators::all();
        let bench = run(2.0, &integrators, QUICK);
        let table = study::every_integrator(&bench);
        let names: Vec<_> = table.rows.iter().map(|row| row[0].as_str()).collect();
        assert!(names.iter().copied().eq(integrators.iter().map(|integrator| integrator.name.as_str())));
    }
}
