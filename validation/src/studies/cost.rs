//! The cost of an answer: seconds to a stated error of X̄₁ at two periods, for this program, for the naive reference,
//! and for a NumPy code as a researcher would write it.

use super::*;
use crate::oracle::naive::Update as NaiveUpdate;
use serde::Deserialize;
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::channel;
use std::thread::spawn;
use std::time::Duration;

pub const STUDY: Study = Study {
    name: "cost-of-accuracy",
    title: "What an answer costs: error against run time",
    question: "How long does X̄₁ at two periods take to a stated error, with this program and with others?",
    cases: &["naive-reference", "default-step-resolves", "hundred-rods-suffice"],
    command: "cargo run --release -- bench --case cost-of-accuracy",
    parts: &["cost-of-accuracy"],
    shared: false,
    run,
};

/// Steps per period that a program may choose from; the error of the step is measured against the last of them.
const STEPS: [u64; 5] = [50, 100, 200, 400, 800];
/// The steps per period of the other programs.
const USUAL: u64 = 200;
const ERRORS: [f64; 5] = [0.02, 0.01, 0.005, 0.002, 0.001];

/// X̄₁ at two periods for one length of the steps.
#[derive(Clone, Copy, Debug, Serialize)]
struct Step {
    steps_per_period: u64,
    x1: f64,
    x1_se: f64,
    /// Standard deviation between replicas.
    sd: f64,
    /// Upper bound of the step's error: its difference from the finest step, plus two standard errors of that.
    step_error: f64,
    /// Time of a replica on one core, s.
    seconds: f64,
}

/// The cost of a stated error for one program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
struct Cost {
    error: f64,
    program: &'static str,
    steps_per_period: u64,
    rods: usize,
    replicas: u64,
    seconds: f64,
}

/// The results of a program's replicas: their mean X̄₁, scatter and time.
struct Measured {
    program: &'static str,
    x1: Sample,
    seconds: f64,
}

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let (replicas, others) = request.effort.pick((200, 4), (36_000, 40));
    let steps = steps(replicas)?;
    let mut measured = vec![naive(others)];
    measured.extend(request.effort.pick(None, numpy(others)));
    let costs: Vec<Cost> = ERRORS.into_iter().flat_map(|error| costs(error, &steps, &measured)).collect();
    let programs = measured.iter().map(|other| other.program);
    let curve = |program: &'static str| {
        let of = costs.iter().filter(move |cost| cost.program == program);
        Curve::of(program, of, |cost| (cost.seconds, cost.error))
    };
    let figure = ReportFigure::new(
        [STUDY.name, "Error of X̄₁ at two periods against run time"],
        "The rods of Fig. 7 at 50 per cm³, one core. Twice the accuracy takes four times the replicas, and steps whose \
         own error is small enough.",
        ["log run time (s)", "log error of X̄₁"],
    )
    .curves(std::iter::once(OWN).chain(programs).map(curve))
    .judged("eqs 5–14", STUDY.cases);
    let own = |cost: &Cost| costs.iter().find(|own| own.program == OWN && own.error == cost.error);
    let table = ReportTable::new(
        [STUDY.name, "Run time to a stated error of X̄₁ at two periods"],
        format!(
            "One core. The error is that of the step and one standard error over replicas, in quadrature. Replicas are \
             independent: the time is theirs times that of one, measured with {USUAL} steps a period where it is not \
             this program's. Steps are those of the table below; other numbers than in `cheapest-split`, which are for \
             one period and any number of steps. {}",
            agreement(&steps, &measured)
        ),
        costs.iter().copied(),
        vec![
            number("error", decimals(3), |cost: &Cost| cost.error),
            words("program", |cost: &Cost| cost.program),
            number("steps per period", decimals(0), |cost: &Cost| cost.steps_per_period as f64),
            number("rods", decimals(0), |cost: &Cost| cost.rods as f64),
            number("replicas", decimals(0), |cost: &Cost| cost.replicas as f64),
            number("run time (s)", decimals(2), |cost: &Cost| cost.seconds),
            number("times this program's", decimals(0), move |cost: &Cost| {
                own(cost).map(|own| cost.seconds / own.seconds)
            }),
        ],
    );
    let by_step = ReportTable::new(
        ["cost-of-accuracy-steps", "The error of the time step"],
        format!(
            "X̄₁ at two periods over {replicas} replicas of 100 rods, by the update `kick`. The error is at most the \
             difference from 800 steps and two of its standard errors."
        ),
        steps.iter().copied(),
        vec![
            number("steps per period", decimals(0), |step: &Step| step.steps_per_period as f64),
            number("X̄₁", decimals(4), |step: &Step| step.x1),
            number("standard error", powers(1), |step: &Step| step.x1_se),
            number("step's error at most", powers(1), |step: &Step| step.step_error),
            number("time of a replica (ms)", decimals(2), |step: &Step| 1e3 * step.seconds),
        ],
    );
    let answer = answer(&costs);
    let files = [
        ("cost-of-accuracy.csv", rows_csv(costs.iter().copied())?),
        ("cost-of-accuracy.json", build::json(&serde_json::json!({ "costs": costs, "steps": steps }))?),
    ];
    Ok(Some(Findings::new(answer, vec![Exhibit::both(figure, table), by_step.into()], files)))
}

const OWN: &str = "shearbed";

/// The lowest cost of a stated error for each program.
fn costs(error: f64, steps: &[Step], others: &[Measured]) -> Vec<Cost> {
    let cost = |program, step: &Step, sd: f64, seconds: f64| {
        let left = error * error - step.step_error * step.step_error;
        let replicas = (left > 0.0).then(|| (sd * sd / left).ceil().max(1.0))?;
        Some(Cost {
            error,
            program,
            steps_per_period: step.steps_per_period,
            rods: 100,
            replicas: replicas as u64,
            seconds: replicas * seconds,
        })
    };
    let cheapest = |costs: &mut dyn Iterator<Item = Cost>| costs.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let own = cheapest(&mut steps.iter().filter_map(|step| cost(OWN, step, step.sd, step.seconds)));
    let others = others.iter().filter_map(|other| {
        // Their steps all take the same time, whatever the length.
        let seconds = |step: &Step| other.seconds * step.steps_per_period as f64 / USUAL as f64;
        cheapest(&mut steps.iter().filter_map(|step| cost(other.program, step, step.sd, seconds(step))))
    });
    own.into_iter().chain(others).collect()
}

fn scene(steps_per_period: u64) -> Scene {
    let mut scene = lab::interacting_scene(&crate::judge::case::Effort::gate());
    lab::interaction(&mut scene).update = Update::Kick;
    scene.time = Time { steps_per_unit: Some(steps_per_period), outputs_per_unit: Some(1), ..Time::periods(2.0) };
    scene
}

/// X̄₁ with steps of each length: replicas run on all cores, the time of a replica is measured on one.
fn steps(replicas: u64) -> Result<Vec<Step>, String> {
    const TIMED: u64 = 32;
    let mut steps = Vec::new();
    for steps_per_period in STEPS {
        let mut scene = scene(steps_per_period);
        scene.ensemble.replicas = replicas;
        let plan = lab::plan(&scene);
        let results = ensemble::run(&plan).map_err(|error| error.to_string())?;
        let column = results.column("x1").ok_or("no x1")?;
        let (x1, x1_se) = column.mean.last().zip(column.se.last()).ok_or("no output")?;
        let start = Instant::now();
        for replica in 0..TIMED {
            run_replica(&plan, replica).map_err(|error| error.to_string())?;
        }
        let seconds = start.elapsed().as_secs_f64() / TIMED as f64;
        let sd = x1_se * (replicas as f64).sqrt();
        steps.push(Step { steps_per_period, x1: *x1, x1_se: *x1_se, sd, step_error: 0.0, seconds });
    }
    // The finest is compared with itself: it has no measurable error.
    let Some(finest) = steps.pop() else { return Ok(steps) };
    for step in &mut steps {
        step.step_error = (step.x1 - finest.x1).abs() + 2.0 * step.x1_se.hypot(finest.x1_se);
    }
    Ok(steps)
}

fn naive(replicas: u64) -> Measured {
    let start = Instant::now();
    let x1 = (0..replicas).map(|replica| {
        let problem = NaiveProblem { update: NaiveUpdate::ExactStepAndKick, ..NaiveProblem::paper(1, replica) };
        let steps = 2 * problem.steps_per_period;
        let mut naive = Naive::new(problem);
        (0..steps).for_each(|_| naive.step());
        mean_projections(&naive.orientations)[0]
    });
    let x1 = Sample::of(x1.collect::<Vec<_>>());
    Measured { program: "naive reference, compiled", x1, seconds: start.elapsed().as_secs_f64() / replicas as f64 }
}

/// The longest wait for the NumPy code.
const PATIENCE: Duration = Duration::from_secs(600);

/// What a process writes to its piped standard output, which must end in time. The process is ended in any case.
fn output_within(patience: Duration, mut child: Child) -> Option<Vec<u8>> {
    let mut stdout = child.stdout.take()?;
    let (sender, written) = channel();
    spawn(move || {
        let mut bytes = Vec::new();
        sender.send(stdout.read_to_end(&mut bytes).map(|_| bytes))
    });
    let bytes = written.recv_timeout(patience);
    // An error says that it has ended already.
    let _ = child.kill();
    let _ = child.wait();
    bytes.ok()?.ok()
}

/// The NumPy code in `peers/`; `None` without a python3 with NumPy, or if it does not end within [`PATIENCE`].
fn numpy(replicas: u64) -> Option<Measured> {
    #[derive(Deserialize)]
    struct Answer {
        x1: Vec<f64>,
        seconds: f64,
    }
    let mut python = Command::new("python3")
        .env("OPENBLAS_NUM_THREADS", "1")
        .args(["-", &replicas.to_string(), &USUAL.to_string(), "1"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let sent = python.stdin.take()?.write_all(include_bytes!("../../peers/numpy_suspension.py"));
    let output = output_within(PATIENCE, python)?;
    sent.ok()?;
    let answer: Answer = serde_json::from_slice(&output).ok()?;
    let seconds = answer.seconds / replicas as f64;
    Some(Measured { program: "NumPy, as people write it", x1: Sample::of(&answer.x1), seconds })
}

/// A sentence that says if the other programs have the same answer: a faster wrong one would be no comparison.
fn agreement(steps: &[Step], others: &[Measured]) -> String {
    let usual = steps.iter().find(|step| step.steps_per_period == USUAL);
    let sentences = others.iter().filter_map(|other| {
        let usual = usual?;
        let off = (other.x1.mean - usual.x1).abs() / usual.x1_se.hypot(other.x1.se);
        Some(format!(
            "{}: X̄₁ = {:.3} ± {:.3}, {off:.1} standard errors from this program's",
            other.program, other.x1.mean, other.x1.se
        ))
    });
    sentences.collect::<Vec<_>>().join("; ") + "."
}

fn answer(costs: &[Cost]) -> String {
    let smallest = costs.iter().filter(|cost| cost.program == OWN).map(|cost| cost.error).fold(f64::INFINITY, f64::min);
    let at: Vec<_> = (costs.iter().filter(|cost| cost.error == smallest))
        .map(|cost| format!("{} {:.2} s", cost.program, cost.seconds))
        .collect();
    format!("To an error of {smallest} on one core: {}.", at.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(steps_per_period: u64, step_error: f64, seconds: f64) -> Step {
        Step { steps_per_period, x1: 0.3, x1_se: 1e-4, sd: 0.04, step_error, seconds }
    }

    #[test]
    fn a_program_is_waited_for_with_a_bound() {
        let run = |script: &str, patience| {
            let child = Command::new("sh").args(["-c", script]).stdout(Stdio::piped()).spawn().unwrap();
            output_within(patience, child)
        };
        assert_eq!(run("echo 1", PATIENCE).as_deref(), Some(&b"1\n"[..]));
        assert_eq!(run("exec sleep 1000", Duration::from_millis(20)), None);
    }

    #[test]
    fn a_program_takes_the_cheapest_step_whose_error_leaves_room() {
        let steps = [step(25, 4e-3, 1e-4), step(50, 8e-4, 2e-4), step(USUAL, 1e-4, 1e-3)];
        let other = Measured { program: "other", x1: Sample::of([0.3, 0.31]), seconds: 0.1 };
        let [own, others] = costs(0.005, &steps, std::slice::from_ref(&other))[..] else { panic!() };
        // 0.04²/(0.005² − 0.0008²) = 65.7 replicas; with 25 steps 177.8, each in half the time.
        assert_eq!((own.steps_per_period, own.replicas), (50, 66));
        // 50 steps take a quarter of the time of 200, and 66 replicas.
        assert_eq!((others.steps_per_period, others.replicas), (50, 66));
        assert!((others.seconds - 66.0 * 0.025).abs() < 1e-12);
        // Near the error of 50 steps, 200 steps are cheaper: 0.04²/(0.00085² − 0.0001²) = 2245.6 replicas.
        let own = costs(8.5e-4, &steps, &[])[0];
        assert_eq!((own.steps_per_period, own.replicas), (USUAL, 2246));
        // An error that no step allows has no cost.
        assert!(costs(5e-5, &steps, &[other]).is_empty());
    }
}
