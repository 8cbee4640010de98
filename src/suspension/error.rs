//! Why a run stopped.

/// Why a run stopped.
///
/// ```
/// use shearbed::suspension::RunError;
/// let stopped = RunError::Misfit { replica: 3, cause: "it has another number of rods" };
/// assert!(stopped.to_string().starts_with("replica 3 cannot go on"));
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A rod's direction would have become NaN or infinite.
    #[error("rod {rod} would become non-finite in step {step} of replica {replica}, seed {seed}: {cause}")]
    NonFinite {
        /// The rod's index.
        rod: usize,
        /// The step, from 0.
        step: u64,
        /// The scene's seed.
        seed: u64,
        /// The replica, from 0.
        replica: u64,
        /// What happened.
        cause: String,
    },
    /// A state to go on from that is of no replica of the plan.
    #[error("replica {replica} cannot go on from where it was kept: {cause}")]
    Misfit {
        /// The replica, from 0.
        replica: u64,
        /// What of it does not fit.
        cause: &'static str,
    },
    /// What would have left the run is no result.
    #[error(
        "{}output {output} ({time_name} = {time}) of replica {replica}, seed {seed}: {cause}",
        rod.map_or(String::new(), |rod| format!("rod {rod}, "))
    )]
    NoResult {
        /// The rod's index, where it is one rod's fault.
        rod: Option<usize>,
        /// The output, from 0.
        output: usize,
        /// `t_over_T` or `strain`.
        time_name: &'static str,
        /// The output's time.
        time: f64,
        /// The scene's seed.
        seed: u64,
        /// The replica, from 0.
        replica: u64,
        /// What is wrong with it.
        cause: String,
    },
}
