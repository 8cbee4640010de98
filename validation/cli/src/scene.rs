//! Loads the scene that the command line names, with the keys that it sets.

use super::{Failure, refuse, whole};
use shearbed::scene::document::Document;
use shearbed::scene::{MAX_REPLICAS, MAX_SEED, SceneProblem, of_document, set};
use shearbed::{Error, Plan, Scene};
use shearbed_validation::files::text::{Shown, complain, line};
use shearbed_validation::files::{bounded, cluster};
use shearbed_validation::input::scenes;
use shearbed_validation::input::start::Starts;
use shearbed_validation::present::plot::names;
use shearbed_validation::serve::sweep::{self, Axis, KeyValue};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use toml::Value;

/// Which scene, and with which keys set.
#[derive(clap::Args)]
pub(super) struct Chosen {
    /// A scene file, or the name of a built-in scene (`shearbed scenes` lists them)
    scene: OsString,
    /// A key of the scene and its value, as interaction.alpha=0.3; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = KeyValue::parse)]
    settings: Vec<KeyValue>,
}

/// Keys that have flags of their own.
#[derive(clap::Args, Default)]
pub(super) struct Ensemble {
    /// Replicas, independent runs of the scene, in place of the scene's own number
    #[arg(long, value_name = "N", value_parser = whole(1, MAX_REPLICAS), allow_negative_numbers = true)]
    pub(super) replicas: Option<u64>,
    /// The seed of all random numbers, in place of the scene's own
    #[arg(long, value_name = "S", value_parser = whole(0, MAX_SEED), allow_negative_numbers = true)]
    seed: Option<u64>,
}

impl Ensemble {
    fn settings(&self) -> impl Iterator<Item = (&'static str, KeyValue)> {
        let given = [("--replicas", "ensemble.replicas", self.replicas), ("--seed", "ensemble.seed", self.seed)];
        given.into_iter().filter_map(|(flag, key, value)| {
            Some((flag, KeyValue { key: key.to_owned(), value: Value::Integer(value? as i64) }))
        })
    }
}

impl Chosen {
    /// The scene with its keys set, each by one flag. `over` are the keys that a sweep sets.
    pub(super) fn load(&self, ensemble: &Ensemble, over: &[Axis]) -> Result<Named, Failure> {
        let set = self.settings.iter().map(|setting| ("--set", setting.clone()));
        let given: Vec<_> = set.chain(ensemble.settings()).collect();
        let swept = over.iter().map(|axis| ("--over", axis.key.as_str()));
        let others = given.iter().map(|(flag, setting)| (*flag, setting.key.as_str()));
        one_owner(&swept.chain(others).collect::<Vec<_>>())?;
        load(&self.scene, given.into_iter().map(|(_, setting)| setting).collect())
    }
}

/// Checks that no two flags set the same key; a table owns every key in it. An error says which two.
pub(super) fn one_owner(flags: &[(&str, &str)]) -> Result<(), Failure> {
    let within = |inner: &str, outer: &str| {
        inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    // Other flags than these take no key.
    let takes_key = |flag: &str| ["--over", "--set"].contains(&flag);
    let given = |flag: &str, key: &str| if takes_key(flag) { format!("{flag} {key}") } else { flag.to_owned() };
    for (k, (flag, key)) in flags.iter().enumerate() {
        let clash = flags[..k].iter().find(|(_, other)| within(other, key) || within(key, other));
        refuse(clash, |(first, other)| {
            let longer = if key.len() > other.len() { key } else { other };
            let both = if other == key && takes_key(flag) && takes_key(first) { "it" } else { longer };
            format!("{} and {}: both set {both}; one of the two is allowed", given(flag, key), given(first, other))
        })?;
    }
    Ok(())
}

/// A scene with its source, and a name for results made from it.
pub(super) struct Named {
    pub(super) scene: Scene,
    pub(super) text: String,
    /// The text as a document, with the keys that were set.
    document: Document,
    /// The keys that replace those of the text.
    pub(super) settings: Vec<KeyValue>,
    /// The file as given, or the built-in scene's name: for messages.
    pub(super) source: String,
    /// The initial directions from files beside the scene.
    pub(super) starts: Starts,
    /// The stem of the file's name, or the built-in scene's name.
    pub(super) stem: String,
}

impl Named {
    /// The files of rods that were read and the scene's; in place of a built-in scene's, a path with its name.
    pub(super) fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.starts.files().chain([PathBuf::from(&self.source)])
    }

    /// The scene's plan; an error names the line of the key, or the keys that were set.
    pub(super) fn plan(&self) -> Result<Plan, Failure> {
        Plan::new(&self.scene).map_err(|error| wrong(&self.source, &self.settings, &self.document.located(error)))
    }
}

/// The failure for an invalid scene: faults of the file have lines, those of `--set` have the flag.
fn wrong(source: &str, settings: &[KeyValue], error: &Error) -> Failure {
    let Error::Text { problems, .. } = error else {
        return refused(source, &error.to_string());
    };
    let set = |setting: &KeyValue| format!(" --set {}={}", setting.key, sweep::shown(&setting.value));
    let set: String = settings.iter().map(set).collect();
    let line = |problem: &SceneProblem| match problem.line {
        Some(line) => format!("{source}:{line}: {}", problem.message),
        None => format!("{source}{set}: {}", problem.message),
    };
    Failure::Input(problems.iter().map(line).collect::<Vec<_>>().join("\n"))
}

fn refused(source: &str, error: &str) -> Failure {
    Failure::Input(format!("{source}: {error}"))
}

/// Reads the file `given`, or if there is none the built-in scene of that name, with the keys `settings`.
pub(super) fn load(given: &OsStr, settings: Vec<KeyValue>) -> Result<Named, Failure> {
    let path = Path::new(given);
    let source = path.shown();
    let built_in = scenes::find(&source).filter(|_| !path.exists() || path.is_dir());
    let (text, stem, mut starts) = match built_in {
        Some(built_in) => (built_in.text.to_owned(), source.clone(), Starts::default()),
        None => (read(path)?, stem_of(path), Starts::beside(path.parent().unwrap_or(Path::new("")))),
    };
    let at = |error: Error| wrong(&source, &settings, &error);
    let mut document = Document::parse(&source, &text).map_err(at)?;
    for KeyValue { key, value } in &settings {
        set(&mut document, key, value.clone()).map_err(at)?;
    }
    let mut scene = of_document(&document).map_err(at)?;
    let pair = |setting: &KeyValue| (setting.key.clone(), sweep::shown(&setting.value));
    scene.title = names::title_with(&scene.title, &settings.iter().map(pair).collect::<Vec<_>>());
    starts.fill(&mut scene).map_err(|error| refused(&source, &error))?;
    warn(&source, starts.warnings());
    Ok(Named { scene, text, document, settings, source, starts, stem })
}

/// The stem of a scene file's name as a folder's: without the dots before it, which would hide the folder or lead out
/// of its place.
fn stem_of(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    match stem.trim_start_matches('.') {
        "" => "scene".to_owned(),
        stem => stem.to_owned(),
    }
}

/// Prints warnings about the results on standard error, on the root only.
pub(super) fn warn<'a>(source: &str, warnings: impl IntoIterator<Item = &'a String>) {
    if !cluster::is_root() {
        return;
    }
    for warning in warnings {
        complain(&format!("{}\n", line(&format!("warning: {source}: {warning}"))));
    }
}

/// The largest size of a scene file, in bytes: 200,000 times of outputs. A parsed text takes up to a hundred times its
/// size.
const MOST_BYTES: u64 = 4_000_000;

fn read(path: &Path) -> Result<String, Failure> {
    let source = path.shown();
    bounded::text(path, MOST_BYTES).map_err(|error| {
        let known = if path.exists() { String::new() } else { built_in_names(&source.to_string()) };
        Failure::Input(format!("{source}: cannot be read: {error}{known}"))
    })
}

fn built_in_names(name: &str) -> String {
    let close = scenes::near(name, scenes::ALL.iter().map(|scene| scene.name));
    let close = if close.is_empty() { String::new() } else { format!(" (close names: {})", close.join(", ")) };
    format!("; nor is it a built-in scene{close}: `shearbed scenes` lists them")
}
