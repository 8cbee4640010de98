//! `shearbed grade`.

mod args;
mod inputs;
mod several;
mod tolerances;

pub(super) use args::Args;

use super::choice::unknown as unknown_name;
use super::{Failure, refuse, spares_inputs, write};
use serde_json::Value;
use shearbed_validation::files::output::{self, RECORD, Record, ResultFolder};
use shearbed_validation::files::text::Shown;
use shearbed_validation::files::{FileError, build};
use shearbed_validation::present::plot::{self, Figure};
use shearbed_validation::present::report::figure_csv;
use shearbed_validation::serve::grade::live::{self, Mode, Program, Protocol};
use shearbed_validation::serve::grade::{self, Axes, DumpOptions, FileOptions, Graded, LineEnds, Options, Report};
use shearbed_validation::serve::problems::{self, Kind, LoadedProblem};
use std::io;
use std::path::Path;
use std::time::Duration;

/// Pictures of the report with their numbers: error against steps, against run time, and along the path.
const PICTURES: [&str; 6] =
    ["steps.svg", "steps.csv", "work-precision.svg", "work-precision.csv", "path.svg", "path.csv"];

/// The report in four formats.
const PAGES: [&str; 4] = ["grade.json", "grade.html", "grade.md", "junit.xml"];

fn echo_failed(error: live::EchoError) -> Failure {
    Failure::Input(match error {
        live::EchoError::TooLong | live::EchoError::NotText => format!("--echo: {error}"),
        error => error.to_string(),
    })
}

/// Grades answers in files, or a running program.
pub(super) fn grade(args: &Args) -> Result<(), Failure> {
    if args.echo {
        return live::echo(args.protocol.unwrap_or_default(), io::stdin().lock(), io::stdout().lock())
            .map_err(echo_failed);
    }
    spares_inputs(&args.out, &PAGES, args.reference.as_ref().map(|dir| dir.join(RECORD)))?;
    if let Some(dir) = &args.reference
        && let Ok(Some(record)) = Record::read(dir)
    {
        record.is_complete().map_err(|why| FileError::whole(dir.join(RECORD), why))?;
    }
    if args.command.len() > 1 {
        return several::compare(args);
    }
    let (mut report, wanted, inputs) = match (args.command.first(), &args.reference, &args.mine) {
        (Some(command), reference, _) => program(args, command, reference.as_deref())?,
        (None, Some(reference), Some(mine)) => files(args, reference, mine)?,
        _ => return Err(Failure::Input("give REF and MINE, or --command".to_owned())),
    };
    report.remarks.extend(axes(args, &report));
    let pictures = pictures(&report, &wanted).map_err(Failure::Failed)?;
    let svg = pictures.iter().filter(|(name, _)| name.ends_with(".svg"));
    let inside: Vec<_> = svg.map(|(_, svg)| svg.as_str()).collect();
    let html = grade::html(&report, report.passes(), &inside).map_err(Failure::Failed)?;
    let pages = [build::json(&report).map_err(Failure::Failed)?, html, grade::markdown(&report), grade::junit(&report)];
    let mut files: Vec<_> = PAGES.map(str::to_owned).into_iter().zip(pages).collect();
    files.extend(pictures);
    let replaced = write(&folder(args, inputs), &files)?;
    let place = args.out.join("grade.html");
    args.writing.print(&format!("{}\nreport: {}\n{replaced}", grade::terminal(&report), place.shown()))?;
    if report.passes() {
        Ok(())
    } else {
        Err(Failure::Failed(format!("not every problem passed: {}", report.counts())))
    }
}

/// The flag for axes in another order, if a diagnosis names one and none is given.
fn axes(args: &Args, report: &Report) -> Option<String> {
    // A formula holds in any axes, and its rows are asked for in these.
    let in_time: Vec<_> = report.problems.iter().filter(|graded| graded.kind != Kind::Formula).collect();
    if in_time.iter().all(|graded| graded.verdict == grade::Verdict::Pass) {
        return None;
    }
    // What is said of all stands for what is said of each.
    let of_problems = in_time.iter().filter_map(|graded| graded.diagnosis.as_ref());
    let of_problems = of_problems.filter(|_| report.diagnosis.is_empty());
    let after = report.diagnosis.iter().chain(of_problems).find_map(|said| said.split_once(grade::LAID_OUT))?;
    if args.axes != Axes::default() {
        return Some("--axes was given: grade without it if the answers are in the problem's own axes".to_owned());
    }
    let axes = after.1.split(|c: char| c != ',' && !c.is_ascii_lowercase()).next()?.trim_end_matches(',');
    Some(format!("if these are your axes: --axes {axes}"))
}

fn folder(args: &Args, inputs: Value) -> ResultFolder {
    ResultFolder::new(&args.out, "grade", inputs, args.writing.force)
}

/// Pictures of the program in bold and of the project's own integrators, as SVG and CSV with file names.
fn pictures(report: &Report, problems: &[LoadedProblem]) -> Result<Vec<output::Output>, String> {
    let bench = report.live.as_ref().and_then(|live| live.work_precision.as_ref());
    let path = report.live.as_ref().and_then(|live| live::path_figure(live.path.as_ref()?, bench?.program.theory));
    let figures = [
        grade::figures::steps(problems, &report.problems),
        bench.map(live::Bench::figure),
        path.or_else(|| grade::figures::path(&report.problems)),
    ];
    let files = |(figure, names): (Option<Figure>, &[&str])| -> Result<Vec<_>, String> {
        let Some(figure) = figure else { return Ok(Vec::new()) };
        // On problems of tensors every curve is the program's.
        let is_of_one = figure.curves.first().is_some_and(|curve| curve.label == grade::figures::PROGRAM);
        let svg = if is_of_one { plot::svg_of_one(&figure) } else { plot::svg(&figure) };
        let contents = [svg?, figure_csv(&figure)?];
        Ok(names.iter().map(|name| (*name).to_owned()).zip(contents).collect())
    };
    let files: Result<Vec<_>, _> = figures.into_iter().zip(PICTURES.chunks(2)).map(files).collect();
    Ok(files?.concat())
}

fn options(args: &Args) -> Options {
    Options {
        file: FileOptions {
            columns: args.columns.clone(),
            foreign: args.foreign(),
            axes: args.axes,
            ends: if args.windows_text { LineEnds::Windows } else { LineEnds::Unix },
        },
        dump: DumpOptions { timestep_s: args.timestep_s, rod_axis: args.rod_axis },
        order: args.order,
    }
}

/// True if a problem of this name should be graded.
fn asked_for(args: &Args, name: &str) -> bool {
    args.problems.is_empty() || args.problems.iter().any(|asked| is_meant(asked, name))
}

/// True if a word after `--problem` is this name, or has a `*` in place of any part of it.
fn is_meant(word: &str, name: &str) -> bool {
    let Some((head, tail)) = word.split_once('*') else { return word == name };
    let rest = |rest: &str| (0..=rest.len()).any(|at| rest.is_char_boundary(at) && is_meant(tail, &rest[at..]));
    name.strip_prefix(head).is_some_and(rest)
}

#[test]
fn a_star_stands_for_any_part_of_a_name() {
    let name = "closed-ft-quadratic-0.01";
    assert!(
        [name, "*", "closed-*", "*quadratic*", "*-0.01", "c*ft*1", "**"].into_iter().all(|word| is_meant(word, name))
    );
    assert!(
        !["", "closed", "quadratic*", "*quadratic", "*ibof*", "c*x*1"].into_iter().any(|word| is_meant(word, name))
    );
}

/// Refuses a word after `--problem` that means none of `names`.
fn check_names(args: &Args, names: &[String]) -> Result<(), Failure> {
    refuse(args.problems.iter().find(|word| !names.iter().any(|name| is_meant(word, name))), |word| {
        unknown_name("--problem", word, "no problem has this name", names, "shearbed problems")
    })
}

/// The problems to grade.
fn chosen(args: &Args, mut all: Vec<LoadedProblem>) -> Result<Vec<LoadedProblem>, Failure> {
    all.retain(|loaded| {
        let of_kind = args.kind.is_none_or(|kind| kind == loaded.problem.kind);
        let of_flow = args.flow.is_none() || loaded.is_couette();
        of_kind && of_flow && asked_for(args, &loaded.problem.name)
    });
    if all.is_empty() {
        Err(Failure::Input("--kind, --flow and --problem leave no problem to grade".to_owned()))
    } else {
        Ok(all)
    }
}

fn names(all: &[LoadedProblem]) -> Vec<String> {
    all.iter().map(|loaded| loaded.problem.name.clone()).collect()
}

/// A report, the problems that it covers, and the inputs on which it depends.
type Done = (Report, Vec<LoadedProblem>, Value);

fn files(args: &Args, reference: &Path, mine: &Path) -> Result<Done, Failure> {
    let all = problems::read(reference)?;
    let names = names(&all);
    check_names(args, &names)?;
    let wanted = tolerances::with(&args.tolerances, chosen(args, all)?)?;
    if !mine.is_dir() {
        return Err(FileError::whole(mine, "no such folder; answers are asked for in MINE/NAME").into());
    }
    output::probe(&args.out, 0, [])?;
    let problems = grade::grade(&wanted, mine, &options(args));
    let mut report = report(args, [reference.shown(), mine.shown()], problems, not_read(mine, &names));
    report.diagnosis = grade::overall(&wanted, &mut report.problems);
    report.remarks.extend(on_all(&wanted, &report.problems, args.order));
    let inputs = inputs::of_files(args, reference, mine, &wanted)?;
    Ok((report, wanted, inputs))
}

/// Remarks on all answers together.
fn on_all(problems: &[LoadedProblem], graded: &[Graded], claimed: Option<f64>) -> impl Iterator<Item = String> {
    let hint = if claimed.is_none() { "; --order claims one" } else { "" };
    let order = grade::remark(graded, claimed).map(|said| format!("{said}{hint}"));
    [order, grade::loose(problems, graded), grade::single(graded)].into_iter().flatten()
}

/// Remarks on folders of answers without a problem, and on files outside a folder with a problem's name.
fn not_read(mine: &Path, names: &[String]) -> Vec<String> {
    let remark = |entry: std::fs::DirEntry| {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        let stem = name.strip_suffix(".csv").filter(|stem| names.iter().any(|known| known == stem));
        match stem {
            _ if path.is_dir() && !names.contains(&name) => {
                Some(format!("{}: no problem has this name; it was not read", path.shown()))
            }
            Some(stem) => {
                let place = mine.join(stem).join("answer.csv");
                Some(format!("{}: it was not read; an answer is read from {}", path.shown(), place.shown()))
            }
            _ => None,
        }
    };
    let entries = std::fs::read_dir(mine).into_iter().flatten().flatten();
    let mut remarks: Vec<_> = entries.filter_map(remark).collect();
    remarks.sort();
    remarks
}

fn report(args: &Args, [reference, answers]: [String; 2], problems: Vec<Graded>, remarks: Vec<String>) -> Report {
    Report {
        all: args.all,
        format: 1,
        shearbed: env!("CARGO_PKG_VERSION").to_owned(),
        reference,
        answers,
        problems,
        live: None,
        diagnosis: Vec::new(),
        remarks,
    }
}

/// Asked for by their names alone: methods of low order, or in a slow language, need minutes for them.
const LONG: [&str; 2] = ["mid-flip-10000", "ten-thousand-periods"];

/// The problems to ask a program: those about single rods, and others that are asked for by name or kind.
fn asked(args: &Args, reference: Option<&Path>) -> Result<Vec<LoadedProblem>, Failure> {
    let own = args.kind.is_none() && args.problems.is_empty();
    let by_name = |name: &String| args.problems.contains(name);
    let is_wanted = |LoadedProblem { problem, .. }: &LoadedProblem| {
        let default = if own {
            problem.kind == Kind::Rods && !LONG.contains(&problem.name.as_str())
        } else {
            live::can_be_asked(problem)
        };
        // A code that does not know of flows that turn would answer another question.
        by_name(&problem.name) || default && problem.rotation_rad_per_s.is_none()
    };
    let mut all = match reference {
        Some(dir) => problems::read(dir)?,
        None => {
            check_names(args, &problems::all().iter().map(|def| def.name.to_owned()).collect::<Vec<_>>())?;
            let rods = problems::free_rods();
            live::built_in(|name| if own { rods.contains(&name) } else { asked_for(args, name) })
        }
    };
    check_names(args, &names(&all))?;
    all.retain(is_wanted);
    let wanted = chosen(args, all)?;
    let refused = |is: &dyn Fn(&LoadedProblem) -> bool, why: &str| {
        refuse(wanted.iter().find(|loaded| is(loaded)), |loaded| format!("--problem {}: {why}", loaded.problem.name))
    };
    let in_files = "a program that runs is not asked about it; answers go into files (grade REF MINE)";
    refused(&|loaded| !live::can_be_asked(&loaded.problem), in_files)?;
    let in_text = args.protocol == Some(Protocol::Text);
    refused(&|loaded| in_text && loaded.problem.kind != Kind::Rods, "it needs lines of JSON")?;
    Ok(wanted)
}

fn started(args: &Args, command: &str) -> Result<Program, Failure> {
    let timeout = Duration::from_secs_f64(args.timeout);
    let mut program = Program::start(command, args.protocol.unwrap_or_default(), timeout)
        .map_err(|error| Failure::Input(format!("--command {error}")))?;
    program.axes = args.axes;
    Ok(program)
}

fn program(args: &Args, command: &str, reference: Option<&Path>) -> Result<Done, Failure> {
    let wanted = tolerances::with(&args.tolerances, asked(args, reference)?)?;
    let inputs = inputs::of_program(args, reference, &wanted)?;
    output::probe(&args.out, 0, [])?;
    folder(args, inputs.clone()).check(&[&PAGES[..], &PICTURES].concat())?;
    let program = started(args, command)?;
    // A code for tensors alone has no first question about a rod.
    let rods = wanted.iter().any(|loaded| loaded.problem.kind == Kind::Rods);
    let (mut program, mode) =
        if rods { live::prepared(program, args.protocol.is_none()) } else { (program, Mode::Steps) };
    let mut problems: Vec<_> = wanted.iter().map(|problem| live::grade(&program, problem, mode, args.order)).collect();
    let last = |loaded: &LoadedProblem| match loaded.problem.kind {
        Kind::Rods => live::last_time(loaded),
        _ => loaded.clone(),
    };
    let asked: Vec<_> = wanted.iter().map(last).collect();
    grade::settle(&wanted, &mut problems, args.order);
    let observed = problems.iter().filter(|graded| graded.verdict == grade::Verdict::Pass);
    program.theory = live::theory(mode == Mode::Tolerance, observed.filter_map(|graded| graded.observed_order).next());
    let answers = problems.iter().any(|graded| graded.error.is_some()) && program.given_up().is_none();
    let studies = (!args.brief && rods && answers).then(|| live::studies(&program, &echo(program.protocol)));
    let left_out: Vec<_> = studies.iter().flat_map(live::Studies::left_out).collect();
    const LEFT_OUT: &str = "not measured, as the program needs longer for it than --timeout, or broke off";
    let mut remarks: Vec<_> =
        (!left_out.is_empty()).then(|| format!("{}: {LEFT_OUT}", left_out.join(", "))).into_iter().collect();
    remarks.extend(on_all(&asked, &problems, args.order));
    remarks.extend(program.breaches());
    remarks.extend(program.given_up().map(|reason| format!("the program was given up: {reason}")));
    if let Err(end) = program.close() {
        remarks.push(format!("the program's end: {end}"));
    }
    let reference = reference.map_or("built-in problems".to_owned(), |dir| dir.shown());
    let mut report = report(args, [reference, command.to_owned()], problems, remarks);
    report.live = studies;
    report.diagnosis = grade::overall(&asked, &mut report.problems);
    Ok((report, wanted, inputs))
}

/// The command line of this program as an echo.
fn echo(protocol: Protocol) -> String {
    let words = super::words::again();
    let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
    let quoted = shlex::try_join(words.iter().map(|word| word.as_ref()));
    let program = quoted.unwrap_or_else(|_| "shearbed".to_owned());
    format!("{program} grade --echo --protocol {}", protocol.word())
}
