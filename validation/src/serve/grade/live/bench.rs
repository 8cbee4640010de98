//! Error against run time of a program and of the project's own integrators, and the cost of the pipe itself.

use super::pipe::{LONGEST_LINE, next_line};
use super::program::{Program, Question};
use super::protocol::Protocol;
use crate::methods::integrators::{Setting, Theory};
use crate::present::plot::{Curve, Figure};
use crate::present::table::{ReportTable, of_words};
use crate::serve::grade::figures::{LEAST, PROGRAM};
use crate::studies::integrators;
use crate::studies::work_precision::study::{NOT_REACHED, time};
use crate::studies::work_precision::{Budget, IntegratorCurve, TARGETS_RAD, curve};
use serde::Serialize;
use std::io::{BufRead, Write};
use std::time::Duration;

/// The aspect ratio of the benchmark: the paper's.
pub const ASPECT_RATIO: f64 = 11.6;

/// The direction from which a rod starts.
pub(super) const START: [f64; 3] = [0.36, 0.48, 0.8];

/// Number of requests that measure the pipe's cost, after some for warming up.
const ECHOES: usize = 200;

/// A program's error against its run time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bench {
    /// r_e.
    pub aspect_ratio: f64,
    /// The program's curve; its times include the pipe's cost.
    pub program: IntegratorCurve,
    /// The least time in s of a request to a program that does nothing; tables and pictures subtract it.
    pub pipe_s: Option<f64>,
    /// The curves of the project's own integrators, which need no pipe.
    pub ours: Vec<IntegratorCurve>,
}

/// Why an echo ends before its input.
#[derive(Debug, thiserror::Error)]
pub enum EchoError {
    /// A line that no request has.
    #[error("a line is longer than {LONGEST_LINE} bytes: no request is")]
    TooLong,
    /// Bytes that are not UTF-8.
    #[error("a line is not UTF-8 text")]
    NotText,
    /// No request.
    #[error("{0}")]
    Request(String),
    /// The input or the output fails.
    #[error(transparent)]
    Pipe(#[from] std::io::Error),
}

/// Answers every request with its start until the input ends: this measures the cost of the pipe and the protocol
/// alone.
pub fn echo(protocol: Protocol, mut input: impl BufRead, mut output: impl Write) -> Result<(), EchoError> {
    loop {
        let line = next_line(&mut input)?;
        if line.is_empty() {
            return Ok(());
        }
        if line.len() > LONGEST_LINE {
            return Err(EchoError::TooLong);
        }
        let line = String::from_utf8(line).map_err(|_| EchoError::NotText)?;
        let answer = protocol.echo(line.trim_end_matches(['\n', '\r'])).map_err(EchoError::Request)?;
        writeln!(output, "{answer}").and_then(|()| output.flush())?;
    }
}

/// The least time in s of a request for one rod to the program `echo`.
fn pipe_s(echo: &str, protocol: Protocol, timeout: Duration) -> Option<f64> {
    let program = Program::start(echo, protocol, timeout).ok()?;
    let question = Question::couette(ASPECT_RATIO, vec![START], 1.0);
    let times: Option<Vec<_>> = (0..ECHOES).map(|_| Some(program.ask(&question, Setting::Steps(1)).ok()?.1)).collect();
    times?.into_iter().min().map(|least| least.as_secs_f64())
}

/// Measures the program, the pipe and the project's own integrators on the same rod.
pub fn bench(program: &Program, echo: &str) -> Bench {
    let budget = Budget { seconds_per_run: 0.1, runs: 3 };
    Bench {
        aspect_ratio: ASPECT_RATIO,
        program: curve(&program.integrator(), ASPECT_RATIO, budget),
        pipe_s: pipe_s(echo, program.protocol, program.timeout),
        ours: integrators::all().iter().map(|integrator| curve(integrator, ASPECT_RATIO, Budget::QUICK)).collect(),
    }
}

impl Bench {
    /// The program's curve without the pipe's cost; times that do not exceed a tenth more than it are set to a tenth of
    /// it.
    pub fn without_pipe(&self) -> IntegratorCurve {
        let pipe = self.pipe_s.unwrap_or(0.0);
        let mut program = self.program.clone();
        for point in &mut program.points {
            for seconds in [&mut point.seconds.least, &mut point.seconds.most] {
                *seconds = (*seconds - pipe).max(0.1 * pipe);
            }
        }
        program
    }

    /// The program's curve, then ours. A program that takes no steps has a level line.
    pub fn figure(&self) -> Figure {
        let mut program = self.without_pipe();
        program.integrator = PROGRAM.to_owned();
        let line = |curve: &IntegratorCurve| {
            let points = || curve.points.iter().filter(|point| point.errors.is_some());
            let mut x: Vec<_> = points().map(|point| point.seconds.least).collect();
            let mut y: Vec<_> = points().map(|point| point.error_rad().max(LEAST)).collect();
            if let ([only], [error]) = (&x[..], &y[..]) {
                (x, y) = (vec![*only, 1.5 * only], vec![*error; 2]);
            }
            Curve { label: curve.integrator.clone(), x, y, half_band: None }
        };
        Figure {
            title: format!("Error against run time, one rod, r_e = {}", self.aspect_ratio),
            x_name: "run time (s), without the pipe's".into(),
            y_name: "angle to the closed form (rad)".into(),
            curves: std::iter::once(&program).chain(&self.ours).map(line).collect(),
            x_log: true,
            y_log: true,
            x_span: Some((1e-8, 0.1)),
            y_span: Some((LEAST, 10.0)),
            ..Figure::default()
        }
    }

    /// The times of the program and of our integrators for each target error.
    pub fn table(&self) -> ReportTable {
        let row = |curve: &IntegratorCurve, name: String| {
            let mut row = vec![name];
            row.extend(TARGETS_RAD.map(|target| match curve.cheapest(target) {
                Some(point) => time(point.seconds.least),
                None => NOT_REACHED.into(),
            }));
            let best = curve.best().filter(|point| point.errors.is_some());
            row.push(best.map_or("failed".into(), |point| format!("{:.1e}", point.error_rad())));
            row.push(format!("{}/{}", curve.failures(), curve.points.len()));
            row
        };
        let program = row(&self.without_pipe(), PROGRAM.to_owned());
        let ours = self.ours.iter().map(|curve| row(curve, curve.integrator.clone()));
        let pipe = match self.pipe_s {
            Some(seconds) => {
                format!("The pipe itself, {} a request by an echo program, is taken off.", time(seconds))
            }
            None => "The pipe's own cost could not be measured and is in the program's times.".to_owned(),
        };
        of_words(
            "grade-work-precision",
            &format!("Time for an error, one rod of r_e = {}", self.aspect_ratio),
            &format!(
                "{pipe} Times not longer than the pipe's are not known better than a tenth of it. best: the least \
                 error over all settings. failed: settings without a finite answer, of all that were asked."
            ),
            &["program", "1e-3 rad", "1e-6 rad", "1e-9 rad", "best (rad)", "failed"],
            std::iter::once(program).chain(ours).collect(),
        )
    }
}

/// The assumed theory of the program's error, from an observed order.
pub fn theory(by_tolerance: bool, observed_order: Option<f64>) -> Theory {
    match (by_tolerance, observed_order) {
        (true, _) => Theory::Adaptive,
        (false, Some(order)) if order >= 0.5 => Theory::Order(order.round() as u32),
        (false, _) => Theory::Order(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pipes_time_is_taken_off_and_the_best_error_is_named() {
        let mut program = curve(&integrators::all()[0], ASPECT_RATIO, Budget { seconds_per_run: 1e-4, runs: 1 });
        program.points = vec![program.points[0].clone(); 2];
        program.points.iter_mut().zip([1.0, 3.0]).for_each(|(point, seconds)| point.seconds.least = seconds);
        let best = program.best().unwrap().error_rad();
        let bench = Bench { aspect_ratio: ASPECT_RATIO, program, pipe_s: Some(1.0), ours: Vec::new() };
        let left: Vec<_> = bench.without_pipe().points.iter().map(|point| point.seconds.least).collect();
        assert_eq!(left, [0.1, 2.0]);
        assert_eq!(bench.table().rows[0][4], format!("{best:.1e}"));
    }
}
