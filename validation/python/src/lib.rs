//! shearbed for Python: the core's runs as NumPy arrays, and the program's commands. Nothing is computed here.

mod rods;

use numpy::PyArray1;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pyo3::{create_exception, wrap_pyfunction};
use rayon::prelude::*;
use shearbed::observable::Channel;
use shearbed::run::ensemble;
use shearbed::run::{Replica, run_replica};
use shearbed::scene::document::{Document, value as value_of};
use shearbed::scene::{Absent, Key, of_document, set};
use shearbed::{Error, Observable, Plan, Results, Scene};
use shearbed_validation::input::{scenes, start::Starts};
use std::ffi::OsString;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

create_exception!(_core, SceneError, PyValueError, "A scene that cannot be run; the message is the program's.");

fn plan(name: &str, text: &str, replicas: Option<i128>, seed: Option<i128>) -> PyResult<Plan> {
    let refused = |error: &dyn std::fmt::Display| SceneError::new_err(error.to_string());
    let mut document = Document::parse(name, text).map_err(|error| refused(&error))?;
    for (key, value) in [("ensemble.replicas", replicas), ("ensemble.seed", seed)] {
        if let Some(value) = value {
            document
                .set(key, i64::try_from(value).map_or(toml::Value::Float(value as f64), toml::Value::Integer))
                .map_err(|error| refused(&error))?;
        }
    }
    let mut scene = of_document(&document).map_err(|error| refused(&error))?;
    let folder = Path::new(name).parent().unwrap_or(Path::new(""));
    Starts::beside(folder).fill(&mut scene).map_err(|error| refused(&format!("{name}: {error}")))?;
    Plan::new(&scene).map_err(|error| refused(&document.located(error)))
}

fn toml_of(scene: &Scene) -> PyResult<String> {
    toml::to_string(scene).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// The keys of a scene file: table, name, meaning, unit, what is allowed, and the default as TOML or in words.
#[pyfunction]
fn keys() -> Vec<(&'static str, &'static str, &'static str, &'static str, String, &'static str)> {
    let row = |key: &'static Key| {
        let (table, name) = key.path.split_once('.')?;
        let absent = match key.absent {
            Absent::Default(value) | Absent::Other(value) => value,
            _ => "required",
        };
        Some((table, name, key.meaning, key.unit, key.holds.to_string(), absent))
    };
    shearbed::scene::keys().filter_map(row).collect()
}

/// Name and text of every built-in scene.
#[pyfunction]
fn built_in_scenes() -> Vec<(&'static str, &'static str)> {
    scenes::ALL.iter().map(|scene| (scene.name, scene.text)).collect()
}

/// The scene with every default written out as TOML, its plan in words, what the reader of its results should know, and
/// the name of the file that its rods start from.
#[pyfunction]
fn describe(name: &str, text: &str) -> PyResult<(String, String, Vec<String>, Option<String>)> {
    let plan = plan(name, text, None, None)?;
    let start = plan.scene().particles.rods.as_ref().map(|rods| rods.file.clone());
    Ok((toml_of(&plan.scene().resolved())?, plan.to_string(), plan.warnings(), start))
}

/// T, GΔt, n a³ and the cost of a scene, as `shearbed plan` prints them.
#[pyfunction]
fn facts(name: &str, text: &str) -> PyResult<String> {
    Ok(shearbed_cli::facts(&plan(name, text, None, None)?))
}

/// The text of a scene with values, which are TOML, at dotted keys; a key without a value is taken out.
#[pyfunction]
fn changed(name: &str, text: &str, values: Vec<(String, Option<String>)>) -> PyResult<String> {
    let refused = |error: &dyn std::fmt::Display| SceneError::new_err(error.to_string());
    let mut document = Document::parse(name, text).map_err(|error| refused(&error))?;
    for (key, value) in values {
        match value {
            Some(value) => {
                let no_value = || refused(&format!("{name}: {key} = {value}: no value of a scene"));
                let value = value_of(&value).ok_or_else(no_value)?;
                set(&mut document, &key, value).map_err(|error| refused(&error))?;
            }
            None => document.remove(&key),
        }
    }
    toml::to_string(&document.root().whole()).map_err(|error| refused(&error))
}

/// The names and symbols of an observable's channels.
type Channels = Vec<(String, String)>;

/// Each observable: its name, its label, and its channels.
#[pyfunction]
fn observables() -> Vec<(&'static str, &'static str, Channels)> {
    let channels = |of: Observable| of.channels().map(|channel| (channel.name(), channel.symbol())).collect();
    Observable::ALL.into_iter().map(|of| (of.name(), of.label(), channels(of))).collect()
}

/// Why a run gave no results.
enum Stopped {
    Asked,
    Failed(Error),
}

/// Runs a scene: a dictionary of arrays and of what was done.
///
/// `progress(done, of)` is called now and then, from the thread that called this.
#[pyfunction]
#[pyo3(signature = (name, text, replicas=None, seed=None, threads=None, progress=None, yes=false))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
fn run<'py>(
    py: Python<'py>,
    name: &str,
    text: &str,
    replicas: Option<i128>,
    seed: Option<i128>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    yes: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let plan = plan(name, text, replicas, seed)?;
    shearbed_cli::may_run(&plan, threads.map(|count| count as u64), name, yes)
        .map_err(|why| SceneError::new_err(why.replace("--yes", "yes=True")))?;
    let pool = threads
        .map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build())
        .transpose()
        .map_err(|error| PyValueError::new_err(format!("threads: {error}")))?;
    let results = py.detach(|| watched(&plan, pool.as_ref(), progress.as_ref()))?;
    let results = results.map_err(|error| PyRuntimeError::new_err(format!("{name}: {error}")))?;
    dictionary(py, &plan, results)
}

/// Runs the plan on other threads, while this one looks for signals and tells how far it is.
fn watched(
    plan: &Plan,
    pool: Option<&rayon::ThreadPool>,
    progress: Option<&Py<PyAny>>,
) -> PyResult<Result<Results, Error>> {
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let all = plan.scene().ensemble.replicas;
    std::thread::scope(|scope| {
        let (ended, end) = mpsc::channel();
        let work = || folded(plan, &stop, &done);
        let worker = scope.spawn(move || {
            let results = pool.map_or_else(work, |pool| pool.install(work));
            // The other side waits for it, or has an error of its own to tell.
            let _ = ended.send(());
            results
        });
        let mut shown = 0;
        let mut look = || -> PyResult<()> {
            Python::attach(|py| {
                py.check_signals()?;
                let now = done.load(Ordering::Relaxed);
                match progress {
                    Some(progress) if now != shown => {
                        shown = now;
                        progress.call1(py, (now, all)).map(drop)
                    }
                    _ => Ok(()),
                }
            })
        };
        let mut interrupted = None;
        while let Err(RecvTimeoutError::Timeout) = end.recv_timeout(Duration::from_millis(50)) {
            if interrupted.is_none()
                && let Err(error) = look()
            {
                stop.store(true, Ordering::Relaxed);
                interrupted = Some(error);
            }
        }
        let results = worker.join();
        match (interrupted, results) {
            (Some(error), _) => Err(error),
            (None, Ok(Ok(results))) => look().map(|()| Ok(results)),
            (None, Ok(Err(Stopped::Failed(error)))) => Ok(Err(error)),
            (None, Ok(Err(Stopped::Asked)) | Err(_)) => {
                Err(PyRuntimeError::new_err("the run failed by a bug in shearbed"))
            }
        }
    })
}

fn folded(plan: &Plan, stop: &AtomicBool, done: &AtomicU64) -> Result<Results, Stopped> {
    let one = |replica: u64| -> Result<Replica, Stopped> {
        if stop.load(Ordering::Relaxed) {
            return Err(Stopped::Asked);
        }
        let replica = run_replica(plan, replica).map_err(Stopped::Failed)?;
        done.fetch_add(1, Ordering::Relaxed);
        Ok(replica)
    };
    ensemble::fold(plan, |replicas: Range<u64>| replicas.into_par_iter().map(one).collect())
}

fn dictionary<'py>(py: Python<'py>, plan: &Plan, results: Results) -> PyResult<Bound<'py, PyDict>> {
    let array = |values: Vec<f64>| PyArray1::from_vec(py, values);
    let channels = PyDict::new(py);
    let observables = PyDict::new(py);
    let (labels, symbols) = (PyDict::new(py), PyDict::new(py));
    let time_s = results.elapsed.iter().map(|elapsed| elapsed.seconds).collect();
    let strain = results.elapsed.iter().map(|elapsed| elapsed.strain).collect();
    let rods = rods::columns(py, plan, &results)?;
    let [extremes, derived] = shearbed_cli::derived(plan, &results).map_err(PyRuntimeError::new_err)?;
    for series in results.series {
        let mut names = Vec::new();
        for channel in series.columns {
            symbols.set_item(&channel.name, Channel::named(&channel.name).map(Channel::symbol))?;
            channels.set_item(&channel.name, (array(channel.mean), array(channel.se)))?;
            names.push(channel.name);
        }
        observables.set_item(series.observable.name(), names)?;
        labels.set_item(series.observable.name(), series.observable.label())?;
    }
    let all = PyDict::new(py);
    all.set_item("time_name", results.time_name)?;
    all.set_item("times", array(results.times))?;
    all.set_item("time_s", array(time_s))?;
    all.set_item("strain", array(strain))?;
    all.set_item("channels", channels)?;
    all.set_item("extremes", extremes)?;
    all.set_item("derived", derived)?;
    all.set_item("observables", observables)?;
    all.set_item("labels", labels)?;
    all.set_item("symbols", symbols)?;
    all.set_item("seed", plan.scene().ensemble.seed)?;
    all.set_item("replicas", plan.scene().ensemble.replicas)?;
    all.set_item("rods", rods)?;
    all.set_item("scene", toml_of(&plan.scene().resolved())?)?;
    all.set_item("warnings", plan.warnings())?;
    Ok(all)
}

/// Runs a command of the program in this process, without a word on the terminal but what the command prints: the exit
/// code, and what went wrong.
#[pyfunction]
fn call(py: Python<'_>, arguments: Vec<OsString>) -> (u8, String) {
    let ended = py.detach(|| std::panic::catch_unwind(|| shearbed_cli::call(arguments)));
    match ended {
        Ok(Ok(())) => (0, String::new()),
        Ok(Err((message, code))) => (code, message),
        Err(_) => (101, "the command failed by a bug in shearbed".to_owned()),
    }
}

/// The program: `program` are the words that start it again. Ends the process.
#[pyfunction]
fn main(py: Python<'_>, program: Vec<OsString>, arguments: Vec<OsString>) {
    py.detach(|| std::process::exit(i32::from(shearbed_cli::main_of(program, arguments))))
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("SceneError", module.py().get_type::<SceneError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(keys, module)?)?;
    module.add_function(wrap_pyfunction!(built_in_scenes, module)?)?;
    module.add_function(wrap_pyfunction!(describe, module)?)?;
    module.add_function(wrap_pyfunction!(facts, module)?)?;
    module.add_function(wrap_pyfunction!(changed, module)?)?;
    module.add_function(wrap_pyfunction!(observables, module)?)?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(call, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)
}
