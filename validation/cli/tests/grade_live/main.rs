//! `shearbed grade --command` with programs that behave, and with programs that do not: a verdict in bounded time, and
//! nobody left behind. The programs are this test itself, started with `--program NAME`.

mod acting;
#[path = "../common/bounded.rs"]
mod bounded;
mod cases;
mod tensors;

use bounded::{ANSWER_S, Bounded, PATIENCE, end};
use cases::{CASES, Case, EXTRAPOLATED, TURNING};
use libtest_mimic::{Arguments, Failed, Trial};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

fn main() -> ExitCode {
    let words: Vec<_> = std::env::args().collect();
    if let Some(at) = words.iter().position(|word| word == "--program") {
        return acting::program(&words[at + 1], words.get(at + 2).map(String::as_str));
    }
    let trial = |program: String, verdict: &'static str, words: &'static [&str]| {
        Trial::test(format!("program_that_{program}"), move || judge((&program, verdict, words)))
    };
    let turning = |case: &'static Case| {
        Trial::test(format!("program_in_a_flow_that_turns_{}", case.0), move || {
            judge_on(&["turning-axes-5"], &["--order", "4"], *case)
        })
    };
    let mut trials: Vec<_> =
        CASES.iter().map(|(program, verdict, words)| trial((*program).into(), verdict, words)).collect();
    trials.extend(TURNING.iter().map(turning));
    for order in 1..=8 {
        let words = if order == 1 { EXTRAPOLATED } else { &[] };
        trials.extend(["", "_normalised"].map(|end| trial(format!("rk_{order}{end}"), "PASS", words)));
    }
    trials.push(Trial::test("program_with_axes_of_its_own", || ends_with(&AXES_OF_ITS_OWN)));
    trials.push(Trial::test("program_for_tensors", || ends_with(&FOR_TENSORS)));
    trials.push(Trial::test("programs_of_two_orders_in_one_picture", two_in_one_picture));
    trials.push(Trial::test("program_ends_with_shearbed", ends_with_shearbed));
    #[cfg(target_os = "linux")]
    trials.push(Trial::test("program_of_another_user_is_named", another_user_s_is_named));
    let mut arguments = Arguments::from_args();
    // They mostly wait.
    arguments.test_threads = arguments.test_threads.or(Some(trials.len()));
    libtest_mimic::run(&arguments, trials).exit_code()
}

/// Problems of which the first is seen in the same direction at all its times, and others are not.
const PROBLEMS: [&str; 3] = ["mid-flip-2", "sphere", "spiral"];

/// `shearbed grade` of a program on problems, with further arguments: its exit code and what it prints.
fn shearbed(command: &str, out: &Path, timeout_s: &str, problems: &[&str], more: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(["grade", "--brief", "--timeout", timeout_s, "--command", command, "--out"])
        .arg(out)
        .args(more)
        .args(problems.iter().flat_map(|name| ["--problem", name]))
        .ended();
    let words = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (output.status.code(), words.concat())
}

/// The command of this test as a program that notes its processes.
fn acting_as(program: &str, pids: &Path) -> std::io::Result<String> {
    Ok(format!("'{}' --program {program} '{}'", std::env::current_exe()?.display(), pids.display()))
}

fn judge(case: Case) -> Result<(), Failed> {
    // One problem shows what is wrong; several that all is right, and that a program is given up.
    let several = case.1 == "PASS" || case.0.starts_with("hangs");
    judge_on(if several { &PROBLEMS } else { &PROBLEMS[..1] }, &[], case)
}

fn judge_on(problems: &[&str], more: &[&str], (program, verdict, words): Case) -> Result<(), Failed> {
    let dir = tempfile::tempdir()?;
    let pids = dir.path().join("pids");
    let command = acting_as(program, &pids)?;
    // Those that answer have time to, however busy the machine is; the others must run out of it.
    let runs_out = verdict == "NOT REACHED";
    let timeout_s = if runs_out { "1" } else { ANSWER_S };
    let (code, printed) = shearbed(&command, dir.path(), timeout_s, problems, more);
    let grade: Value = serde_json::from_str(&fs::read_to_string(dir.path().join("grade.json"))?)?;
    let found = &grade["problems"][0];
    let check = |holds: bool, what: &str| {
        if holds { Ok(()) } else { Err(Failed::from(format!("{what}: {grade:#}\n{printed}"))) }
    };
    check(found["name"] == problems[0], "the name")?;
    check(found["verdict"] == verdict, "the verdict")?;
    check(code == Some(i32::from(verdict != "PASS")), "the exit code")?;
    if verdict == "PASS" {
        for found in grade["problems"].as_array().unwrap() {
            check(found["verdict"] == "PASS", "every problem")?;
            // Two in a row within the tolerance, or one after errors that fall at one order: the error may cross zero
            // by chance.
            let errors = found["errors"].as_array().unwrap().iter().rev().take(4);
            let errors: Vec<_> = errors.map(|error| error[1].as_f64().unwrap()).collect();
            let within = |k: usize| errors[k] <= found["tolerance"].as_f64().unwrap();
            let order = |k: usize| (errors[k + 1] / errors[k]).log2();
            let steady = || (1..3).all(|k| (order(k) - order(0)).abs() < 0.1);
            let extrapolated =
                found["note"].as_str().is_some_and(|note| note.starts_with("converges to the certified"));
            let right = within(0) && (within(1) || errors.len() == 4 && steady());
            check(right || extrapolated && errors.len() == 4 && steady(), "the last ones")?;
        }
    }
    let said = format!("{} {} {}", found["note"], found["diagnosis"], grade["remarks"]);
    for words in words {
        check(said.contains(words), words)?;
    }
    check(!printed.contains("panicked"), "no panic")?;
    let pids = fs::read_to_string(pids)?;
    check(!pids.is_empty(), "it ran")?;
    for pid in pids.split_whitespace() {
        check(gone(pid.parse()?), &format!("process {pid} is left"))?;
    }
    Ok(())
}

/// Waits until something is so. False when it is not within [`PATIENCE`].
fn comes(is: impl Fn() -> bool) -> bool {
    let begun = Instant::now();
    while !is() {
        if begun.elapsed() > PATIENCE {
            return false;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    true
}

/// Whether no process with this number runs. A grandchild that was killed is the system's to reap, in its own time; a
/// zombie of ours would be a child of shearbed, which has ended.
fn gone(pid: i32) -> bool {
    let id = rustix::process::Pid::from_raw(pid).unwrap();
    let dead = || {
        let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
        rustix::process::test_kill_process(id).is_err() || stat.contains(") Z ")
    };
    comes(dead)
}

/// A program on a problem with further arguments, and how it ends.
type Ends = (&'static str, &'static str, &'static [&'static str], i32);

const FLOW_FIRST: &[&str] = &["--axes", "flow,gradient,vorticity"];

/// The flow along the program's first axis, its gradient along the second: right with `--axes`, at rest without.
const AXES_OF_ITS_OWN: [Ends; 2] = [
    ("flows_along_1", PROBLEMS[0], FLOW_FIRST, 0),
    ("flows_along_1", PROBLEMS[0], &["--axes", "gradient,flow,vorticity"], 1),
];

/// Right codes for tensors pass in their own ways: by steps that end at each time, by a tolerance alone where steps are
/// refused, and with axes of their own if these are said.
const FOR_TENSORS: [Ends; 9] = [
    ("tensors_random", "brownian-relaxation", &[], 0),
    ("tensors_random_slow", "brownian-relaxation", &[], 1),
    ("tensors_random_few", "brownian-relaxation", &[], 1),
    ("tensors_by_equal_steps", "closed-ft-quadratic-0.01", &[], 0),
    ("tensors_lose_an_odd_step", "closed-ft-quadratic-0.01", &[], 1),
    ("tensors_by_tolerance", "closed-ft-quadratic-0.01", &[], 0),
    ("tensors_by_tolerance", "closed-ft-quadratic-0.01", FLOW_FIRST, 1),
    ("tensors_flow_along_1", "closed-ft-quadratic-0.01", FLOW_FIRST, 0),
    ("tensors_flow_along_1", "closed-ft-quadratic-0.01", &[], 1),
];

fn ends_with(all: &[Ends]) -> Result<(), Failed> {
    let dir = tempfile::tempdir()?;
    for (k, (name, problem, more, expected)) in all.iter().enumerate() {
        let command = acting_as(name, &dir.path().join("pids"))?;
        let (code, words) = shearbed(&command, &dir.path().join(k.to_string()), ANSWER_S, &[problem], more);
        if code != Some(*expected) {
            return Err(format!("{name} {more:?}: {code:?} {words}").into());
        }
    }
    Ok(())
}

/// Two methods share one picture: each run is in the table and in the CSV beside the picture, with the order of its
/// own.
fn two_in_one_picture() -> Result<(), Failed> {
    let dir = tempfile::tempdir()?;
    let out = dir.path().join("out");
    let [second, fourth] = [2, 4].map(|order| acting_as(&format!("rk_{order}"), &dir.path().join("pids")));
    let [second, fourth] = [format!("of-2={}", second?), format!("of-4={}", fourth?)];
    let (code, words) = shearbed(&second, &out, "5", &PROBLEMS[..1], &["--command", &fourth]);
    let read = |file: &str| fs::read_to_string(out.join(file));
    let (runs, programs, picture) = (read("runs.csv")?, read("programs.csv")?, read("steps.csv")?);
    for order in [2, 4] {
        let rows = runs.lines().filter(|line| line.contains(&format!(",of-{order},")));
        let run = |line: &str| -> Vec<String> { line.split(',').map(String::from).collect() };
        let of: Vec<_> = rows.map(run).map(|run| [run[3].clone(), run[9].clone()]).collect();
        let drawn = |[steps, error]: &[String; 2]| picture.contains(&format!("of-{order},{steps}.0,{error},"));
        // 64 and 128 steps, long before round-off.
        let error = |steps: &str| of.iter().find(|run| run[0] == steps).map(|run| run[1].parse::<f64>());
        let (Some(coarse), Some(fine)) = (error("64"), error("128")) else { return Err(runs.into()) };
        let seen = ((coarse? / fine?).log2() - f64::from(order)).abs() < 0.2;
        let said = programs.contains(&format!("of-{order},{order},"));
        if code != Some(0) || of.len() < 4 || !of.iter().all(drawn) || !seen || !said {
            return Err(format!("order {order}: {words}\n{programs}\n{runs}\n{picture}").into());
        }
    }
    let drawing = read("steps.svg")?;
    if drawing.contains("of-2") && drawing.contains("of-4") { Ok(()) } else { Err(drawing.into()) }
}

/// Asked to end while it waits, shearbed leaves nobody behind.
fn ends_with_shearbed() -> Result<(), Failed> {
    let dir = tempfile::tempdir()?;
    let pids = dir.path().join("pids");
    let command = acting_as("hangs_with_a_child", &pids)?;
    let mut shearbed = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(["grade", "--timeout", "1000", "--quiet", "--command", &command, "--out"])
        .arg(dir.path().join("out"))
        .stderr(Stdio::null())
        .spawn()?;
    let started = || fs::read_to_string(&pids).unwrap_or_default().split_whitespace().count() == 2;
    if !comes(started) {
        shearbed.kill()?;
        return Err("the program's child has not started".into());
    }
    let id = rustix::process::Pid::from_child(&shearbed);
    rustix::process::kill_process(id, rustix::process::Signal::TERM)?;
    let status = end("shearbed grade", shearbed).status;
    if status.code() != Some(128 + 15) || dir.path().join("out").exists() {
        return Err(format!("{status}").into());
    }
    for pid in fs::read_to_string(&pids)?.split_whitespace() {
        if !gone(pid.parse()?) {
            return Err(format!("process {pid} is left").into());
        }
    }
    Ok(())
}

/// A process that shearbed may not kill keeps it from nothing, and is named. Made by root alone, with `setpriv`.
#[cfg(target_os = "linux")]
fn another_user_s_is_named() -> Result<(), Failed> {
    use std::os::unix::fs::PermissionsExt;
    use std::os::unix::process::CommandExt;
    const NOBODY: u32 = 65534;
    let setpriv = Path::new("/usr/bin/setpriv");
    if !rustix::process::geteuid().is_root() || !setpriv.is_file() {
        eprintln!("skipped: a process of another user is made by root with setpriv alone");
        return Ok(());
    }
    let dir = tempfile::tempdir()?;
    let [root, own] = ["root", "shearbed"].map(|name| dir.path().join(name));
    fs::copy(setpriv, &root)?;
    fs::copy(env!("CARGO_BIN_EXE_shearbed"), &own)?;
    for (path, mode) in [(dir.path(), 0o777), (&root, 0o4755), (&own, 0o755)] {
        fs::set_permissions(path, fs::Permissions::from_mode(mode))?;
    }
    let pids = dir.path().join("pids");
    let script = format!("echo $$ >> {}; exec sleep 1000", pids.display());
    let command = format!("{} --reuid 0 --regid 0 --clear-groups sh -c '{script}'", root.display());
    let output = Command::new(&own)
        .args(["grade", "--brief", "--timeout", "1", "--problem", "mid-flip-2", "--command", &command])
        .current_dir(dir.path())
        .uid(NOBODY)
        .gid(NOBODY)
        .ended();
    let words = String::from_utf8_lossy(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
    let pids = fs::read_to_string(pids)?;
    for id in pids.split_whitespace() {
        let id = rustix::process::Pid::from_raw(id.parse()?).unwrap();
        rustix::process::kill_process(id, rustix::process::Signal::KILL)?;
    }
    let [id] = pids.split_whitespace().collect::<Vec<_>>()[..] else {
        return Err(format!("it was started again: {pids} {words}").into());
    };
    let named = format!("process {id} (sleep, user id 0) cannot be stopped: Operation not permitted");
    if output.status.code() == Some(1) && words.contains(&named) {
        Ok(())
    } else {
        Err(format!("{}: {words}", output.status).into())
    }
}
