//! The commands of the program `shearbed`.
//!
//! A command is a file: its arguments, with the texts of `--help`, and a function that calls the parts above, writes
//! through `files::output` and prints. Shared arguments are in `choice`, `scene` and `threads`; errors are `Failure`s.
//!
//! It may use every part. To add a command, write its file, declare it, and add its variant and its call below. Help,
//! manual pages, completions and the page of commands follow (`UPDATE_DOCS=1 cargo test -p shearbed-cli --test docs`).

mod bench;
mod checkpoint;
mod choice;
mod cite;
mod compare;
mod converge;
mod derived;
mod duration;
mod facts;
mod finished;
mod fit;
mod grade;
mod grouped;
mod handed_out;
mod interrupt;
mod manual;
mod memory;
mod pictures;
mod plot;
mod problems;
mod record;
mod reference;
mod rods;
mod run;
mod scene;
mod shape;
mod show;
mod sweep;
mod tables;
mod terminal;
mod threads;
mod until;
mod validate;
mod words;

pub use duration::may_run;
pub use facts::facts;
pub use manual::commands;
pub use threads::code_of_panic;

use clap::error::{ContextKind, ContextValue};
use clap::{Parser, Subcommand};
use serde_json::{Value, json};
use shearbed_validation::files::output::{self, Output, RECORD, Record, ResultFolder};
use shearbed_validation::files::text::{Shown, complain};
use shearbed_validation::files::{cluster, text};
use shearbed_validation::oracle::reference::big::finite;
use shearbed_validation::present::plot::Figure;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use terminal::{log, log_progress, print, progress, progress_of_some};
use threads::{Threads, on_threads};

/// Rigid slender rods in a sheared viscous liquid, after Lee & Springer (1982).
#[derive(Parser)]
#[command(name = "shearbed", version, arg_required_else_help = true, help_template = grouped::help())]
#[command(
    after_help = "Exit codes: 0 all well, 1 a case failed or a target was not reached, 2 bad input or usage, or a run \
        that stopped. The manual: docs/src/README.md of the sources."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a scene: tables (CSV), pictures (SVG) and a record of the run (run.json)
    Run(run::Args),
    /// Show what a scene will run, what it leaves out, and why
    Plan(show::PlanArgs),
    /// List the built-in scenes, or print one to start your own from
    Scenes(show::ScenesArgs),
    /// Run the verification and validation cases and write the report
    Validate(validate::Args),
    /// Measure error against run time: integrators of one free rod, suspensions, and the speed of the core
    Bench(bench::Args),
    /// Run a scene at every point of a grid of its keys' values: one row a point
    Sweep(sweep::Args),
    /// Show how results depend on steps, rods and replicas; of free rods, how integrators converge
    Converge(converge::Args),
    /// Fit keys of a scene to measured points: estimates, intervals, goodness of fit
    Fit(fit::Args),
    /// Grade any program's answers to the reference problems, from files or while it runs
    Grade(grade::Args),
    /// List the reference problems for any program, or export them with their answers
    Problems(problems::Args),
    /// List the aspect ratio r_e of the ellipsoid that turns as a cylinder does, by published formulas
    Shape(shape::Args),
    /// Draw one picture of a channel from several runs, or from the points of a sweep
    Plot(plot::Args),
    /// Show what changed between two reports: verdicts, errors, speed
    Compare(compare::Args),
    /// Print BibTeX for this build
    #[command(after_help = "Example:\n  shearbed cite >> paper.bib")]
    Cite,
    /// Exact values without a simulation: one free rod, or means over isotropic rods, as CSV
    Reference(reference::Args),
    /// Print a script that completes commands and flags in a shell
    Completions(handed_out::Completions),
    /// Write a manual page for each command
    Man(handed_out::Man),
}

#[derive(Debug)]
enum Failure {
    /// Bad input or usage, a scene that cannot be computed, or a file that cannot be read or written.
    Input(String),
    /// A case failed, or the program itself.
    Failed(String),
}

impl Failure {
    fn message_and_code(self) -> (String, u8) {
        match self {
            Self::Failed(message) => (message, 1),
            Self::Input(message) => (message, 2),
        }
    }
}

/// Runs the command given by the process's arguments.
pub fn main() -> ExitCode {
    interrupt::outlive_limits();
    threads::watch();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return print_usage(&error).into(),
    };
    let joined = match cluster::Joined::new() {
        Ok(joined) => joined,
        Err(message) => return cluster::failed(&message, 2),
    };
    if cluster::size() == 1 {
        // In a larger job its starter tells all ranks to end, and says why.
        interrupt::watch();
    }
    match joined.caught(|| command(cli.command)) {
        Ok(Ok(())) => joined.end(),
        Ok(Err(failure)) => {
            terminal::clear();
            let (message, code) = failure.message_and_code();
            joined.fail(&message, code)
        }
        Err(panic) => joined.fail(&panic, code_of_panic()),
    }
}

/// The same inside another program's process, and without ranks: `program` are the words that start that program,
/// `arguments` those that follow. Returns the exit code.
pub fn main_of(program: Vec<OsString>, arguments: Vec<OsString>) -> u8 {
    words::give(program, arguments.clone());
    let cli = match Cli::try_parse_from(with_name(arguments)) {
        Ok(cli) => cli,
        Err(error) => return print_usage(&error),
    };
    interrupt::watch();
    command(cli.command).map_or_else(complained, |()| 0)
}

/// Prints why a command failed; returns the exit code.
fn complained(failure: Failure) -> u8 {
    terminal::clear();
    let (message, code) = failure.message_and_code();
    cluster::failed(&message, code);
    code
}

/// Runs a command, without its name as the first word, inside another program: no signal is watched for. An error has
/// the program's message and its exit code.
pub fn call(arguments: Vec<OsString>) -> Result<(), (String, u8)> {
    let cli =
        Cli::try_parse_from(with_name(arguments)).map_err(|error| (error.to_string(), error.exit_code() as u8))?;
    command(cli.command).map_err(Failure::message_and_code).map_err(|(message, code)| (text::message(&message), code))
}

/// The picture that `shearbed plot` draws for these folders; the error says why there is none.
pub fn figure(dirs: &[PathBuf], channel: Option<&str>) -> Result<Figure, String> {
    let channels: Vec<String> = channel.iter().map(|channel| (*channel).to_owned()).collect();
    plot::figure(dirs, &channels).map_err(|failure| failure.message_and_code().0)
}

fn with_name(arguments: Vec<OsString>) -> Vec<OsString> {
    std::iter::once("shearbed".into()).chain(arguments).collect()
}

/// The tables `extremes.csv` and `derived.csv` of a run.
pub fn derived(plan: &shearbed::Plan, results: &shearbed::Results) -> Result<[String; 2], String> {
    derived::files(plan, results, &derived::of(plan, results)).map(|files| files.map(|(_, text)| text))
}

/// The message with the value that it is about on one line.
fn on_one_line(error: &clap::Error, message: String) -> String {
    match error.get(ContextKind::InvalidValue) {
        Some(ContextValue::String(value)) => message.replacen(value, &text::line(value), 1),
        _ => message,
    }
}

/// Prints what is wrong with the arguments, or the help; returns the exit code.
fn print_usage(error: &clap::Error) -> u8 {
    let (message, code) = (error.to_string(), error.exit_code() as u8);
    if error.use_stderr() {
        complain(&text::message(&on_one_line(error, message)));
        return code;
    }
    print(&message).map_or_else(complained, |()| code)
}

impl Command {
    /// True if the command does nothing but print.
    fn only_prints(&self) -> bool {
        match self {
            Self::Plan(_) | Self::Scenes(_) | Self::Shape(_) | Self::Cite | Self::Completions(_) => true,
            Self::Problems(args) => args.only_prints(),
            Self::Reference(args) => args.only_prints(),
            _ => false,
        }
    }

    /// True if the command may start threads for its work.
    fn takes_threads(&self) -> bool {
        let works = !matches!(self, Self::Plot(_) | Self::Compare(_) | Self::Shape(_) | Self::Scenes(_));
        works && !matches!(self, Self::Cite | Self::Completions(_) | Self::Man(_))
    }

    /// True if ranks share the command's work; such a command checks itself that their inputs agree.
    fn is_shared(&self) -> bool {
        matches!(self, Self::Run(_) | Self::Validate(_) | Self::Sweep(_) | Self::Converge(_))
    }
}

fn command(command: Command) -> Result<(), Failure> {
    threads::check()?;
    if command.only_prints() {
        terminal::is_open()?;
    }
    memory::check_start(command.takes_threads())?;
    if !command.is_shared() {
        agree(&words::command(), json!({}))?;
        if !cluster::is_root() {
            return Ok(());
        }
    }
    match command {
        Command::Run(args) => run::run(&args),
        Command::Validate(args) => validate::validate(args),
        Command::Sweep(args) => sweep::sweep(&args),
        Command::Converge(args) => converge::converge(&args),
        Command::Plan(args) => show::plan(&args),
        Command::Scenes(args) => show::scenes(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Fit(args) => fit::fit(&args),
        Command::Grade(args) => grade::grade(&args),
        Command::Problems(args) => problems::problems(&args),
        Command::Shape(args) => shape::shape(&args),
        Command::Plot(args) => plot::plot(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Cite => cite::cite(),
        Command::Reference(args) => reference::reference(&args),
        Command::Completions(args) => handed_out::completions(&args),
        Command::Man(args) => handed_out::man(&args),
    }
}

/// Options of every command that writes a folder of results.
#[derive(clap::Args)]
struct Writing {
    /// Overwrite whatever files are in the way
    #[arg(long)]
    force: bool,
    /// Print nothing but errors and warnings
    #[arg(long)]
    quiet: bool,
}

impl Writing {
    /// Prints, unless nothing but errors and warnings is wanted.
    fn print(&self, text: &str) -> Result<(), Failure> {
        if self.quiet { Ok(()) } else { print(text) }
    }

    /// Writes the results of a command, and prints `text` with their names.
    fn write(&self, folder: &ResultFolder, files: Vec<Output>, text: &str) -> Result<(), Failure> {
        let names = files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>().join(", ");
        let replaced = write(folder, &files)?;
        self.print(&format!("{text}in {}: {names}\n{replaced}", folder.dir().shown()))
    }
}

/// The folder for a command's results. Before the work the root checks that `bytes` bytes and a little more can be
/// written, and that no other file has one of these names.
fn result_folder<N: AsRef<str>>(
    dir: &Path,
    (command, inputs, force): (&str, Value, bool),
    bytes: u64,
    names: &[N],
) -> Result<ResultFolder, Failure> {
    /// Additional bytes for pictures and records.
    const MORE: u64 = 1 << 20;
    let folder = ResultFolder::new(dir, command, inputs, force);
    if cluster::is_root() {
        output::probe(dir, bytes + MORE, names.iter().map(AsRef::as_ref))?;
        folder.check(names)?;
    }
    Ok(folder)
}

/// Writes the results of a command, whose folder was checked before the work; beside it if that fails. A line for the
/// terminal on those that they replaced, if these had other input.
fn write(folder: &ResultFolder, files: &[Output]) -> Result<String, Failure> {
    let line =
        |difference: String| format!("(replaced earlier results of {}: {difference})\n", folder.origin().command);
    match folder.write(files) {
        Ok(replaced) => Ok(replaced.map(line).unwrap_or_default()),
        Err(refused) => match folder.write_beside(files) {
            Some(dir) => Err(Failure::Failed(format!("{refused}; these results are in {}", dir.shown()))),
            None => Err(refused.into()),
        },
    }
}

/// Refuses a folder in which the results would replace or remove a file that the command reads, also with --force: one
/// of these names, the record, or a file of earlier results that it lists.
fn spares_inputs(
    dir: &Path,
    names: &[impl AsRef<Path>],
    inputs: impl IntoIterator<Item = PathBuf>,
) -> Result<(), Failure> {
    let earlier = Record::read(dir).ok().flatten();
    let earlier = earlier.iter().flat_map(Record::names).map(|name| dir.join(name));
    let new = names.iter().map(|name| dir.join(name));
    spares(dir, new.chain([dir.join(RECORD)]).chain(earlier), inputs)
}

/// Refuses to replace or remove files at `targets` that the command reads; `out` is what it was given to write.
fn spares(
    out: &Path,
    targets: impl IntoIterator<Item = PathBuf>,
    inputs: impl IntoIterator<Item = PathBuf>,
) -> Result<(), Failure> {
    let there = |path: &Path| path.canonicalize().ok();
    let results: Vec<_> = targets.into_iter().filter_map(|target| there(&target)).collect();
    let read = inputs.into_iter().find(|input| there(input).is_some_and(|input| results.contains(&input)));
    refuse(read, |input| {
        let (out, input) = (out.shown(), input.shown());
        format!("{out}: a result would replace {input}, which this command reads; give another")
    })
}

/// Refuses what was found, if anything was; `why` says what it is and what is allowed.
fn refuse<T>(found: Option<T>, why: impl FnOnce(T) -> String) -> Result<(), Failure> {
    found.map_or(Ok(()), |found| Err(Failure::Input(why(found))))
}

/// Refuses ranks whose inputs differ from the root's, before anything runs.
fn agree(command: &str, input: Value) -> Result<(), Failure> {
    cluster::agree(command, input).map_err(Failure::Input)
}

/// A path whose name has one of these endings, which are `said` in the error.
fn ending_in(endings: &[&str], said: &str, text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if path.extension().is_some_and(|own| endings.iter().any(|ending| own == *ending)) {
        Ok(path)
    } else {
        Err(format!("a name that ends in {said} is allowed; no other format is written"))
    }
}

/// The number in the text of an option, if it is allowed; `words` say what is.
fn number(text: &str, allowed: impl Fn(f64) -> bool, words: &str) -> Result<f64, String> {
    finite(text).filter(|x| allowed(*x)).ok_or_else(|| format!("{words} is allowed"))
}

/// A parser of whole numbers from `least` to `most`, whose error states that range.
fn whole(least: u64, most: u64) -> impl Fn(&str) -> Result<u64, String> + Clone + Send + Sync + 'static {
    move |text| match text.parse() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        _ => Err(format!("a whole number from {least} to {most} is allowed")),
    }
}

/// Errors of what the user gave: a scene, a file, a folder.
impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Input(error.to_string())
    }
}
