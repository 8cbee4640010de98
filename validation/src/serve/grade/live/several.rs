//! Several programs on one problem about rods: error against run time, steps, evaluations and requested tolerance.

use super::ladder::{Mode, printed};
use super::program::{Program, Question};
use super::{last_time, theory};
use crate::methods::integrators::{Errors, Failure};
use crate::oracle::reference::big::{Bits, double};
use crate::oracle::reference::motion::Motion;
use crate::present::plot::{Curve, Figure};
use crate::present::table::{Column, ReportTable, field, number, powers, words};
use crate::serve::grade::compare::compare;
use crate::serve::grade::figures::LEAST;
use crate::serve::grade::order::orders;
use crate::serve::problems::LoadedProblem;
use crate::studies::work_precision::rows::runs_csv;
use crate::studies::work_precision::study::{NOT_REACHED, time};
use crate::studies::work_precision::{Bench, Budget, IntegratorCurve, Point, TARGETS_RAD, curve_of};

/// Programs on one problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Several {
    bench: Bench,
    /// The law of each program's error.
    laws: Vec<Option<Law>>,
}

/// The law of an error in rad: constant · (γ̇Δt)^order, γ̇ = (2D:D)^½, with the coarsest settings left out.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Law {
    order: u32,
    constant: f64,
    /// The run that shows it.
    at: usize,
}

/// Runs of each program on a problem, with more and more steps or at smaller and smaller tolerances: as many as
/// `--timeout` allows.
pub fn several(programs: &[(String, Program, Mode)], problem: &LoadedProblem) -> Several {
    let last = last_time(problem);
    let curves: Vec<_> = programs.iter().map(|(name, program, mode)| curve(name, program, *mode, &last)).collect();
    let laws = curves.iter().map(|curve| law(curve, &last)).collect();
    let of = &last.problem;
    // No period is asked for where there is none.
    let bench = Bench { name: of.name.clone(), aspect_ratio: of.aspect_ratio, turns: f64::NAN, curves };
    Several { bench, laws }
}

fn curve(name: &str, program: &Program, mode: Mode, last: &LoadedProblem) -> IntegratorCurve {
    program.during(&last.problem.name);
    let question = Question::of(last);
    // The times of all runs are about ten times that of the last: one for its error, one for warming up, three
    // measured, and all coarser ones as much again.
    let budget = Budget { seconds_per_run: 0.1 * program.timeout.as_secs_f64(), runs: 3 };
    let graded = |setting| {
        let (found, _) = program.ask(&question, setting).map_err(|asked| Failure::Gave(asked.to_string()))?;
        let rows = found.p.into_iter().map(Vec::from).collect();
        let orientation_rad = compare(last, &printed(rows)).error;
        let none = f64::NAN;
        let errors = Errors { orientation_rad, orbit_constant: none, phase_turns: none, length: none };
        if orientation_rad.is_finite() { Ok((errors, found.evaluations)) } else { Err(Failure::NotFinite) }
    };
    curve_of(name, theory(mode == Mode::Tolerance, None), budget, graded, |setting| program.ask(&question, setting))
}

/// The law that the last runs above round-off show; none for a program that chooses its steps.
fn law(curve: &IntegratorCurve, last: &LoadedProblem) -> Option<Law> {
    let steps = |point: &Point| point.setting.steps().ok();
    let errors: Option<Vec<_>> = curve.points.iter().map(|point| Some((steps(point)?, point.error_rad()))).collect();
    let errors = errors?;
    let (order, error) = orders(&errors, last.tolerances()).whole()?;
    let at = errors.iter().position(|(_, found)| *found == error)?;
    let motion = Motion { gradient_per_s: last.problem.gradient_per_s, aspect_ratio: last.problem.aspect_ratio };
    let strain = double(&motion.strain_rate_per_s(Bits(64))) * last.problem.times_s[0];
    let constant = error * (errors[at].0 as f64 / strain).powi(order.try_into().ok()?);
    constant.is_finite().then_some(Law { order, constant, at })
}

impl Several {
    /// The names of the programs that gave no finite answer.
    pub fn silent(&self) -> Vec<&str> {
        let silent = self.bench.curves.iter().filter(|curve| curve.failures() == curve.points.len());
        silent.map(|curve| curve.integrator.as_str()).collect()
    }

    /// Every run as CSV.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn csv(&self) -> Result<String, String> {
        runs_csv(std::slice::from_ref(&self.bench))
    }

    /// The orders, error constants, and times for errors.
    pub fn table(&self) -> ReportTable {
        type Row<'a> = (&'a IntegratorCurve, &'a Option<Law>);
        let mut columns: Vec<Column<Row>> = vec![
            words("program", |row: &Row| row.0.integrator.clone()),
            field("order", |row: &Row| row.1.map(|law| u64::from(law.order))),
            number("error constant", powers(1), |row: &Row| row.1.map(|law| law.constant)),
            number("error / tolerance", powers(1), |row: &Row| beyond(row.0)),
        ];
        columns.extend(TARGETS_RAD.map(|target| {
            words(format!("{target:.0e} rad"), move |row: &Row| match row.0.cheapest(target) {
                Some(Point { seconds, evaluations: Some(count), .. }) => {
                    format!("{}, {count} evaluations", time(seconds.least))
                }
                Some(point) => time(point.seconds.least),
                None => NOT_REACHED.into(),
            })
        }));
        columns.push(number("best (rad)", powers(1), |row: &Row| row.0.best().map(Point::error_rad)));
        columns.push(words("failed", |row: &Row| format!("{}/{}", row.0.failures(), row.0.points.len())));
        ReportTable::new(
            ["work-precision", &format!("Time for an error on {}", self.bench.name)],
            "The error is that of the worst rod at the last time, about constant · (γ̇Δt)^order with γ̇ = (2D:D)^½; \
             the time of an answer includes the pipe's. error / tolerance: the largest over all requested tolerances. \
             failed: settings without a finite answer.",
            self.bench.curves.iter().zip(&self.laws),
            columns,
        )
    }

    /// The pictures with their names: error against run time, steps, evaluations and requested tolerance, as far as
    /// there are such runs, each with lines of the observed orders.
    pub fn figures(&self) -> Vec<(&'static str, Figure)> {
        type Abscissa = fn(&Point) -> Option<f64>;
        let all: [(&str, &str, Abscissa); 4] = [
            ("work-precision", "run time (s), with the pipe's", |point| Some(point.seconds.least)),
            ("steps", "steps", |point| Some(point.setting.steps().ok()? as f64)),
            ("evaluations", "evaluations of dp/dt for each rod", |point| Some(point.evaluations? as f64)),
            ("tolerance", "requested tolerance", |point| point.setting.tolerance().ok()),
        ];
        let figure = |(name, x_name, x): (&'static str, &str, Abscissa)| Some((name, self.figure(x_name, x)?));
        all.into_iter().filter_map(figure).collect()
    }

    fn figure(&self, x_name: &str, x: impl Fn(&Point) -> Option<f64>) -> Option<Figure> {
        let drawn = |curve: &IntegratorCurve| {
            let place = |point: &Point| Some((x(point)?, point.errors?.orientation_rad.max(LEAST)));
            Curve::of(label(&curve.integrator), curve.points.iter().filter_map(place), |place| place)
        };
        let mut curves: Vec<_> = self.bench.curves.iter().map(drawn).filter(|curve| !curve.x.is_empty()).collect();
        if curves.is_empty() {
            return None;
        }
        let all = || curves.iter().flat_map(|curve| curve.x.iter().copied());
        let ends = [all().fold(f64::INFINITY, f64::min), all().fold(0.0, crate::oracle::larger)];
        if x_name.ends_with("tolerance") {
            curves.push(Curve::of("error = tolerance, theory", ends, |x| (x, x)));
        }
        let mut known = Vec::new();
        for (curve, law) in self.bench.curves.iter().zip(&self.laws) {
            let Some(law) = law.filter(|law| !known.contains(&law.order)) else { continue };
            let point = &curve.points[law.at];
            let Some(through) = x(point) else { continue };
            known.push(law.order);
            let line = |x: f64| (x, point.error_rad() * (through / x).powf(f64::from(law.order)));
            // Within the picture: from an error of 1 to the end of the axis.
            let from = ends[0].max(through * point.error_rad().powf(1.0 / f64::from(law.order)));
            curves.push(Curve::of(format!("order {}, theory", law.order), [from, ends[1]], line));
        }
        Some(Figure {
            title: format!("Error of programs, {}", self.bench.name),
            x_name: x_name.into(),
            y_name: "error (rad)".into(),
            curves,
            x_log: true,
            y_log: true,
            y_span: Some((1e-12, 1.0)),
            ..Figure::default()
        })
    }
}

/// The largest error over the tolerance that was requested; none for a program that takes steps.
fn beyond(curve: &IntegratorCurve) -> Option<f64> {
    let ratio = |point: &Point| Some(point.errors?.orientation_rad / point.setting.tolerance().ok()?);
    curve.points.iter().filter_map(ratio).reduce(crate::oracle::larger)
}

/// A name of a program for a picture, where _ would set the next letter as an index.
fn label(name: &str) -> String {
    crate::files::text::start(&name.replace('_', " "), 40)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::integrators::{Setting, Theory};
    use crate::serve::problems::loaded;
    use crate::studies::work_precision::Seconds;

    fn runs(name: &str, theory: Theory, all: impl IntoIterator<Item = (Setting, f64)>) -> IntegratorCurve {
        let point = |(setting, error): (Setting, f64)| {
            let none = f64::NAN;
            let errors = Errors { orientation_rad: error, orbit_constant: none, phase_turns: none, length: none };
            let count = setting.steps().unwrap_or(100);
            let seconds = Seconds { least: 1e-6 * count as f64, most: 1.0, measurements: 3 };
            let evaluations = setting.steps().ok().map(|steps| 4 * steps);
            Point { setting, errors: error.is_finite().then_some(errors), failure: None, seconds, evaluations }
        };
        IntegratorCurve { integrator: name.into(), theory, points: all.into_iter().map(point).collect() }
    }

    /// Synthetic programs: one of error 3 (γ̇Δt)⁴ down to round-off, and one that is ten times off its tolerance.
    fn synthetic() -> Several {
        let last = last_time(&loaded("mid-flip-2"));
        let strain = 0.5 * last.problem.times_s[0];
        let law_of = |steps: u64| (3.0 * (strain / steps as f64).powi(4)).max(1e-15);
        let steps = (4..=16).map(|power| 1 << power).map(|steps| (Setting::Steps(steps), law_of(steps)));
        let tolerances =
            [1e-2, 1e-4].map(Setting::Tolerance).map(|setting| (setting, 10.0 * setting.tolerance().unwrap()));
        let curves = vec![
            runs("four", Theory::Order(1), steps),
            runs("adaptive", Theory::Adaptive, tolerances),
            runs("silent", Theory::Order(1), [(Setting::Steps(16), f64::NAN)]),
        ];
        let laws = curves.iter().map(|curve| law(curve, &last)).collect();
        Several { bench: Bench { name: "mid-flip-2".into(), aspect_ratio: 2.0, turns: f64::NAN, curves }, laws }
    }

    #[test]
    fn order_constant_and_evaluations_are_found() {
        let found = synthetic();
        let law = found.laws[0].unwrap();
        assert_eq!((law.order, found.laws[1], found.laws[2]), (4, None, None));
        // One rounding of the power and two of the rest.
        assert!((law.constant / 3.0 - 1.0).abs() < 1e-14, "{law:?}");
        assert_eq!(found.silent(), ["silent"]);
        let table = found.table();
        assert_eq!(table.rows[0][1..4], ["4", "3.0e0", "–"]);
        assert_eq!(table.rows[1][3], "1.0e1");
        assert!(table.rows[0][5].ends_with(" evaluations"), "{:?}", table.rows[0]);
        let csv = found.csv().unwrap();
        assert!(csv.lines().next().unwrap().ends_with("length_error,evaluations"), "{csv}");
        assert!(csv.contains(",16,") && csv.lines().nth(1).unwrap().ends_with(",,,,64"), "{csv}");
    }

    #[test]
    fn every_abscissa_has_its_picture_and_its_lines() {
        let figures = synthetic().figures();
        let names: Vec<_> = figures.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["work-precision", "steps", "evaluations", "tolerance"]);
        let labels = |figure: &Figure| figure.curves.iter().map(|curve| curve.label.clone()).collect::<Vec<_>>();
        assert_eq!(labels(&figures[0].1), ["four", "adaptive", "order 4, theory"]);
        assert_eq!(labels(&figures[1].1), ["four", "order 4, theory"]);
        assert_eq!(labels(&figures[3].1), ["adaptive", "error = tolerance, theory"]);
        // The line of order 4 is the law itself.
        let line = &figures[1].1.curves[1];
        let strain = 0.5 * loaded("mid-flip-2").problem.times_s.last().unwrap();
        for (steps, error) in line.x.iter().zip(&line.y) {
            assert!((error / (3.0 * (strain / steps).powi(4)) - 1.0).abs() < 1e-12);
        }
    }
}
