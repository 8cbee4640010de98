//! Errors of scenes and runs.

/// The reason why a text is not a scene, a scene cannot run, or a run stopped.
///
/// ```
/// use shearbed::{Error, Plan, scene::{Particles, Scene}};
/// let error = shearbed::scene::parse("mine.toml", "title = 1").unwrap_err();
/// assert!(error.to_string().contains("mine.toml:1: title = 1 is not allowed: expected a text in quotes"));
///
/// let scene = Scene { particles: Particles { count: 0, ..Particles::default() }, ..Scene::default() };
/// let Err(Error::Scene(invalid)) = Plan::new(&scene) else { panic!("no rods") };
/// assert_eq!((invalid[0].key, invalid[0].value.as_deref()), ("particles.count", Some("0")));
///
/// let stopped = Error::NonFinite { rod: 7, step: 41, seed: 3, replica: 2, cause: "an arm of 0".into() };
/// assert_eq!(stopped.to_string(), "rod 7 would become non-finite in step 41 of replica 2, seed 3: an arm of 0");
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A scene file with mistakes.
    #[error("{}", with_lines(file, problems))]
    Text {
        /// The file's name as given.
        file: String,
        /// Every mistake found, in the order of lines; at least one.
        problems: Vec<SceneProblem>,
    },
    /// A scene with values that are not allowed or inconsistent; at least one.
    #[error("{}", joined(.0))]
    Scene(Vec<Invalid>),
    /// A rod's direction would have become NaN or infinite.
    #[error("rod {rod} would become non-finite in step {step} of replica {replica}, seed {seed}: {cause}")]
    NonFinite {
        /// The rod's index.
        rod: usize,
        /// The step, from 0.
        step: u64,
        /// The scene's seed.
        seed: u64,
        /// Index of the replica, from 0.
        replica: u64,
        /// The cause, in words.
        cause: String,
    },
    /// A saved state that belongs to another plan.
    #[error("replica {replica} cannot go on from its saved state: {cause}")]
    Misfit {
        /// Index of the replica, from 0.
        replica: u64,
        /// What does not fit, in words.
        cause: &'static str,
    },
    /// A direction or a mean that is not a valid result.
    #[error(
        "{}output {output} ({time_name} = {time}) of replica {replica}, seed {seed}: {cause}",
        rod.map_or(String::new(), |rod| format!("rod {rod}, "))
    )]
    NoResult {
        /// Index of the rod, if a single rod is the cause.
        rod: Option<usize>,
        /// Index of the output, from 0.
        output: usize,
        /// Name of the time column: `t_over_T`, `strain` or `time_s`.
        time_name: &'static str,
        /// Time of the output, in that unit.
        time: f64,
        /// The scene's seed.
        seed: u64,
        /// Index of the replica, from 0.
        replica: u64,
        /// The cause, in words.
        cause: String,
    },
}

impl Error {
    /// All mistakes of a text or a scene, without file and line; other errors have one message.
    pub fn messages(&self) -> Vec<String> {
        match self {
            Self::Text { problems, .. } => problems.iter().map(|problem| problem.message.clone()).collect(),
            Self::Scene(invalid) => invalid.iter().map(Invalid::to_string).collect(),
            other => vec![other.to_string()],
        }
    }
}

fn with_lines(file: &str, problems: &[SceneProblem]) -> String {
    let line = |SceneProblem { line, message }: &SceneProblem| match line {
        Some(line) => format!("{file}:{line}: {message}"),
        None => format!("{file}: {message}"),
    };
    problems.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn joined(invalid: &[Invalid]) -> String {
    invalid.iter().map(Invalid::to_string).collect::<Vec<_>>().join("; ")
}

/// A mistake in a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SceneProblem {
    /// The line, from 1; `None` for a value set over the file's.
    pub line: Option<usize>,
    /// The key, its value and what is allowed.
    pub message: String,
}

/// A value of a scene that is not allowed, with its key and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key}{}: {allowed}", value.as_ref().map_or(" is missing".into(), |x| format!(" = {x} is not allowed")))]
#[non_exhaustive]
pub struct Invalid {
    /// The dotted path of the key, such as `particles.count`.
    pub key: &'static str,
    /// The value; `None` if the key is missing.
    pub value: Option<String>,
    /// The allowed values, in words.
    pub allowed: String,
}

impl Invalid {
    pub(crate) fn new(key: &'static str, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self { key, value: Some(value.to_string()), allowed: allowed.into() }
    }

    pub(crate) fn missing(key: &'static str, allowed: &str) -> Self {
        Self { key, value: None, allowed: allowed.to_owned() }
    }
}
