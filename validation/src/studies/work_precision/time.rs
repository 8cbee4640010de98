//! Run times.

use super::*;
use std::hint::black_box;

/// Limits of the time for measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// The last setting that is tried is one whose run takes half of this.
    pub seconds_per_run: f64,
    /// Measurements of each setting, after one for warming up; at most three for long runs.
    pub runs: usize,
}

impl Budget {
    /// The budget for `shearbed bench`.
    pub const FULL: Self = Self { seconds_per_run: 0.1, runs: 9 };
    /// The budget for daily reports.
    pub const QUICK: Self = Self { seconds_per_run: 0.01, runs: 5 };
}

/// The time of a run, in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Seconds {
    /// The least of all measurements, which is the time of the work itself.
    pub least: f64,
    /// The largest; with the least it shows the scatter due to the machine.
    pub most: f64,
    /// Number of measurements.
    pub measurements: usize,
}

/// The shortest measurement in s: a hundred times the clock's own step and cost.
const SHORTEST: f64 = 2e-5;

/// Times `run` on this thread.
pub(crate) fn measure<T>(budget: Budget, run: impl Fn() -> T) -> Seconds {
    let once = clock(1, &run);
    let repeats = (SHORTEST / once.max(1e-9)).ceil().clamp(1.0, 1e4) as u32;
    let runs = if once > 0.1 * budget.seconds_per_run { budget.runs.min(3) } else { budget.runs };
    let times: Vec<_> = (0..runs.max(1)).map(|_| clock(repeats, &run)).collect();
    Seconds {
        least: times.iter().copied().fold(f64::INFINITY, f64::min),
        most: crate::oracle::worst(times.iter().copied()),
        measurements: times.len(),
    }
}

/// Seconds per run, over `repeats` runs.
fn clock<T>(repeats: u32, run: &impl Fn() -> T) -> f64 {
    seconds(|| (0..repeats).for_each(|_| _ = black_box(run()))) / f64::from(repeats)
}

/// Seconds of one run.
pub(crate) fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}
