//! The commands of the program `shearbed`.

mod bench;
mod choice;
mod converge;
mod grade;
mod kept;
mod memory;
mod pictures;
mod problems;
mod record;
mod reference;
mod run;
mod scene;
mod sections;
mod show;
mod sweep;
mod tables;
mod validate;

use crate::{cluster, output};
use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

/// Rigid slender rods in a sheared viscous liquid, after Lee & Springer (1982).
#[derive(Parser)]
#[command(name = "shearbed", version, arg_required_else_help = true)]
#[command(
    after_help = "Exit codes: 0 all well, 1 a case failed, 2 bad input or usage, or a run that stopped."
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
    /// Measure every integrator's error against its run time for one free rod
    Bench(bench::Args),
    /// Run a scene at every point of a grid of its keys' values: one row a point
    Sweep(sweep::Args),
    /// Show how a scene's results depend on the step, and for interacting rods on their number and the replicas
    Converge(converge::Args),
    /// Grade any program's answers to the reference problems, from files or while it runs
    Grade(grade::Args),
    /// List the reference problems for any program, or export them with their certified answers
    Problems(problems::Args),
    /// Exact values without a simulation: one free rod, or means over isotropic rods, as CSV
    Reference(reference::Args),
}

/// Why a command did not end well.
enum Failure {
    /// Bad input or usage, a scene that cannot be computed, or a file that cannot be read or written.
    Input(String),
    /// A case failed, or the program did.
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

/// Runs the command of the program's arguments.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let joined = match cluster::Joined::new() {
        Ok(joined) => joined,
        Err(message) => return cluster::failed(&message, 2),
    };
    match joined.caught(|| command(cli.command)) {
        Ok(Ok(())) => joined.end(),
        Ok(Err(failure)) => {
            let (message, code) = failure.message_and_code();
            joined.fail(&message, code)
        }
        Err(panic) => joined.fail(&panic, 101),
    }
}

fn command(command: Command) -> Result<(), Failure> {
    match command {
        Command::Run(args) => run::run(&args),
        Command::Validate(args) => validate::validate(args),
        Command::Sweep(args) => sweep::sweep(&args),
        Command::Converge(args) => converge::converge(&args),
        // The others are no work for many.
        _ if !cluster::is_root() => Ok(()),
        Command::Plan(args) => show::plan(&args),
        Command::Scenes(args) => show::scenes(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Grade(args) => grade::grade(&args),
        Command::Problems(args) => problems::problems(&args),
        Command::Reference(args) => reference::reference(&args),
    }
}

/// Prints to standard output. A reader that has gone away, as `head` does, is no error.
fn print(text: &str) -> Result<(), Failure> {
    if !cluster::is_root() {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Input(format!(
            "standard output: cannot be written: {error}"
        ))),
        _ => Ok(()),
    }
}

/// A bar over the steps of a slow part on a terminal, and nothing elsewhere.
fn progress(steps: u64, what: &str, quiet: bool) -> ProgressBar {
    if quiet || !cluster::is_root() || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(&format!(
        "{{wide_bar}} {{pos}}/{{len}} {what}, {{eta}} left {{msg}}"
    ));
    ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr())
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Whether the root can write files into `dir`: known before a long run.
fn probe(dir: &Path) -> Result<(), Failure> {
    match cluster::is_root() {
        true => Ok(output::probe(dir)?),
        false => Ok(()),
    }
}

/// Calls `work` on `threads` threads, or on one for each core.
fn on_threads<T: Send>(threads: Option<u64>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    // 0 stands for one thread a core.
    let count = threads.unwrap_or(0) as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    let pool = pool.map_err(|error| Failure::Input(format!("--threads {count}: {error}")))?;
    Ok(pool.install(work))
}

/// A parser of whole numbers whose error says what is allowed.
fn whole(least: u64, most: u64) -> impl Fn(&str) -> Result<u64, String> + Clone + Send + Sync + 'static {
    move |text| match text.parse() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        _ => Err(format!("a whole number from {least} to {most} is allowed")),
    }
}

/// The most threads that can be asked for.
const MAX_THREADS: u64 = 1024;

impl From<crate::output::OutputError> for Failure {
    fn from(error: crate::output::OutputError) -> Self {
        Self::Input(error.to_string())
    }
}
