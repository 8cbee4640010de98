//! `shearbed grade`.

use super::{Failure, print};
use crate::grade::live::{self, Mode, Program};
use crate::grade::{self, Axes, Claim, Dump, Foreign, Graded, Options, Report, Told};
use crate::output;
use crate::problems::{self, Kind, LoadedProblem};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Arguments of `grade`.
#[derive(clap::Args)]
pub(super) struct Args {
    /// The folder with the problems, as `problems export` writes it
    #[arg(value_name = "REF", required_unless_present_any = ["command", "echo"])]
    reference: Option<PathBuf>,
    /// The folder with the answers: MINE/NAME/answer.csv or MINE/NAME/steps-N.csv
    #[arg(value_name = "MINE", required_unless_present_any = ["command", "echo"], conflicts_with = "command")]
    mine: Option<PathBuf>,
    /// Start this program once and ask it by lines of JSON, in place of answers in files
    #[arg(long, value_name = "PROGRAM ARGS")]
    command: Option<String>,
    /// The folder for grade.json, grade.md, junit.xml and pictures
    #[arg(long, value_name = "DIR", default_value = "out/grade")]
    out: PathBuf,
    /// Grade this problem only; can be given more than once
    #[arg(long = "problem", value_name = "NAME")]
    problems: Vec<String>,
    /// Grade problems of this kind only: rods, tensor, contact or ensemble
    #[arg(long, value_name = "KIND", value_parser = kind)]
    kind: Option<Kind>,
    /// The answer's columns in the order of the file, - for one to leave out: time_s,rod,p3,p1,p2
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        conflicts_with = "layout",
        allow_hyphen_values = true
    )]
    columns: Option<Vec<String>>,
    /// What the program's axes 1, 2, 3 are, as flow,gradient,vorticity; -flow is against the flow
    #[arg(
        long,
        value_name = "AXES",
        default_value = "gradient,flow,vorticity",
        allow_hyphen_values = true
    )]
    axes: Axes,
    /// The layout of a known program's tables
    #[arg(long, value_name = "PROGRAM")]
    layout: Option<Foreign>,
    /// The order that the program's error is said to have: another observed order fails
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    order: Option<f64>,
    /// LAMMPS dumps: the length of a time step in s, where the dump has no ITEM: TIME
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true)]
    timestep_s: Option<f64>,
    /// LAMMPS dumps: the rod's axis in the body's frame, where shapex, shapey, shapez do not tell
    #[arg(long, value_name = "x|y|z", value_parser = body_axis)]
    rod_axis: Option<usize>,
    /// With --command: seconds that an answer may take
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true, default_value = "10")]
    timeout: f64,
    /// With --command: verdicts only, without work–precision, longest steps and the stability map
    #[arg(long)]
    brief: bool,
    /// Answer requests with their own start: what the pipe itself costs
    #[arg(long, conflicts_with_all = ["reference", "command"])]
    echo: bool,
    /// A missing answer is a failure
    #[arg(long)]
    all: bool,
    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

fn kind(text: &str) -> Result<Kind, String> {
    serde_json::from_value(text.into())
        .map_err(|_| "rods, tensor, contact and ensemble are allowed".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number < 1e9 => Ok(number),
        _ => Err("a positive number below 1e9 is allowed".to_owned()),
    }
}

fn body_axis(text: &str) -> Result<usize, String> {
    ["x", "y", "z"]
        .iter()
        .position(|axis| *axis == text)
        .ok_or_else(|| "x, y and z are allowed".to_owned())
}

/// Grades answers in files, or a program.
pub(super) fn grade(args: &Args) -> Result<(), Failure> {
    if args.echo {
        return live::echo(io::stdin().lock(), io::stdout().lock()).map_err(Failure::Input);
    }
    let report = match (&args.command, &args.reference, &args.mine) {
        (Some(command), reference, _) => program(args, command, reference.as_deref())?,
        (None, Some(reference), Some(mine)) => files(args, reference, mine)?,
        _ => {
            return Err(Failure::Input(
                "REF and MINE, or --command, are asked for".to_owned(),
            ));
        }
    };
    let mut written = vec![
        (
            "grade.json".to_owned(),
            grade::json(&report).map_err(Failure::Failed)?,
        ),
        ("grade.md".to_owned(), grade::markdown(&report)),
        ("junit.xml".to_owned(), grade::junit(&report)),
    ];
    if let Some(bench) = report.live.as_ref().and_then(|live| live.work_precision.as_ref()) {
        written.push((
            "work-precision.svg".to_owned(),
            bench.picture().map_err(Failure::Failed)?,
        ));
    }
    output::write_all(&args.out, &written)?;
    if !args.quiet {
        let place = args.out.join("grade.json");
        print(&format!(
            "{}\nreport: {}\n",
            grade::terminal(&report),
            place.display()
        ))?;
    }
    match report.passes(args.all) {
        true => Ok(()),
        false => Err(Failure::Failed(format!(
            "not every problem passed: {}",
            report.headline()
        ))),
    }
}

fn options(args: &Args) -> Options {
    Options {
        told: Told {
            columns: args.columns.clone(),
            foreign: args.layout,
            axes: args.axes,
        },
        dump: Dump {
            timestep_s: args.timestep_s,
            rod_axis: args.rod_axis,
        },
        claim: Claim { order: args.order },
    }
}

/// The problems that are to be graded.
fn chosen(args: &Args, mut all: Vec<LoadedProblem>) -> Result<Vec<LoadedProblem>, Failure> {
    let names: Vec<_> = all.iter().map(|loaded| loaded.problem.name.clone()).collect();
    if let Some(unknown) = args.problems.iter().find(|name| !names.contains(name)) {
        let known = names.join(", ");
        return Err(Failure::Input(format!(
            "--problem {unknown}: no problem has this name; there are {known}"
        )));
    }
    all.retain(|loaded| {
        let named = args.problems.is_empty() || args.problems.contains(&loaded.problem.name);
        named && args.kind.is_none_or(|kind| kind == loaded.problem.kind)
    });
    match all.is_empty() {
        true => Err(Failure::Input(
            "no problem is left to grade: --kind and --problem leave none".to_owned(),
        )),
        false => Ok(all),
    }
}

fn files(args: &Args, reference: &Path, mine: &Path) -> Result<Report, Failure> {
    let all = problems::read(reference).map_err(|error| Failure::Input(error.to_string()))?;
    let names: Vec<_> = all.iter().map(|loaded| loaded.problem.name.clone()).collect();
    let wanted = chosen(args, all)?;
    if !mine.is_dir() {
        return Err(Failure::Input(format!(
            "{}: no folder; answers are asked for in MINE/NAME",
            mine.display()
        )));
    }
    output::probe(&args.out, 0)?;
    let problems = grade::grade(&wanted, mine, &options(args)).map_err(|errors| {
        let lines: Vec<_> = errors.iter().map(ToString::to_string).collect();
        Failure::Input(lines.join("\n"))
    })?;
    Ok(report(
        reference.display().to_string(),
        mine.display().to_string(),
        problems,
        unknown_folders(mine, &names),
    ))
}

/// Folders of answers to problems that there are not.
fn unknown_folders(mine: &Path, names: &[String]) -> Vec<String> {
    let entries = std::fs::read_dir(mine).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.path().is_dir());
    let mut unknown: Vec<_> = folders
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    unknown.retain(|name| !names.contains(name));
    unknown.sort();
    let remark = |name: String| {
        format!(
            "{}: no problem has this name; it was not read",
            mine.join(name).display()
        )
    };
    unknown.into_iter().map(remark).collect()
}

fn report(reference: String, answers: String, problems: Vec<Graded>, remarks: Vec<String>) -> Report {
    Report {
        format: 1,
        shearbed: env!("CARGO_PKG_VERSION").to_owned(),
        reference,
        answers,
        problems,
        live: None,
        remarks,
    }
}

fn program(args: &Args, command: &str, reference: Option<&Path>) -> Result<Report, Failure> {
    let all = match reference {
        Some(dir) => problems::read(dir).map_err(|error| Failure::Input(error.to_string()))?,
        None => live::built_in().map_err(Failure::Failed)?,
    };
    let rods = all
        .into_iter()
        .filter(|loaded| loaded.problem.kind == Kind::Rods)
        .collect();
    let wanted = chosen(args, rods)?;
    output::probe(&args.out, 0)?;
    let timeout = Duration::from_secs_f64(args.timeout);
    let program = Program::start(command, timeout).map_err(Failure::Input)?;
    let mode = live::mode(&program);
    let claim = Claim { order: args.order };
    let problems: Vec<_> = wanted
        .iter()
        .map(|problem| live::grade(&program, problem, mode, claim))
        .collect();
    let observed = problems
        .iter()
        .filter(|graded| graded.verdict == grade::Verdict::Pass);
    let theory = live::theory(
        mode == Mode::Tolerance,
        observed.filter_map(|graded| graded.observed_order).next(),
    );
    let program = program.with_theory(theory);
    let studies = (!args.brief && program.given_up().is_none()).then(|| live::studies(&program, &echo()));
    let mut remarks: Vec<_> = studies.iter().flat_map(live::Studies::left_out).collect();
    remarks.extend(program.breaches());
    remarks.extend(
        program
            .given_up()
            .map(|reason| format!("the program was given up: {reason}")),
    );
    if let Err(end) = program.close() {
        remarks.push(format!("the program's end: {end}"));
    }
    let reference = reference.map_or("built-in problems".to_owned(), |dir| dir.display().to_string());
    let mut report = report(reference, command.to_owned(), problems, remarks);
    report.live = studies;
    Ok(report)
}

/// This program as an echo.
fn echo() -> String {
    let words = super::program::again();
    let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
    let quoted = shlex::try_join(words.iter().map(|word| word.as_ref()));
    format!(
        "{} grade --echo",
        quoted.unwrap_or_else(|_| "shearbed".to_owned())
    )
}
