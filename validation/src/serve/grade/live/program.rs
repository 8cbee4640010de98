//! A program that answers requests, kept within its limits, and restarted after a breach of the protocol.

use super::pipe::{Pipe, Trouble};
use super::protocol::{self, Protocol, Rows};
pub use super::request::{Asked, Question};
use super::request::{Request, Turned};
use crate::methods::integrators::{Failure, Integrator, RodProblem, Setting, Theory};
use crate::serve::grade::Axes;
use crate::serve::grade::report::grouped;
use nalgebra::{UnitVector3, Vector3};
use serde_json::Value;
use std::hash::{BuildHasher, RandomState};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The program is not asked again after it was waited for in vain this number of times.
const MOST_HANGS: u32 = 2;

/// The program is not started again after this number of breaches of the protocol.
const MOST_BREACHES: u32 = 20;

/// A program behind the protocol.
#[derive(Clone)]
pub struct Program {
    words: Vec<String>,
    name: String,
    /// The assumed theory of its error.
    pub theory: Theory,
    /// The longest time for one answer.
    pub(super) timeout: Duration,
    /// The form of its lines.
    pub protocol: Protocol,
    /// The axes in which it is asked and understood.
    pub axes: Axes,
    state: Arc<Mutex<State>>,
}

#[derive(Default)]
struct State {
    pipe: Option<Pipe>,
    asked: u64,
    /// Number of answers that were waited for in vain.
    hangs: u32,
    /// True if nothing came to the last of them in time, though the program kept its output open.
    late: bool,
    breaches: u32,
    /// The reason why the program is not asked again.
    given_up: Option<String>,
    /// The current task, for messages.
    during: String,
    /// Every breach: the task, and what was wrong.
    log: Vec<[String; 2]>,
    /// The time at which the current study must end.
    deadline: Option<Instant>,
}

impl Program {
    /// Starts the command. `Err` when it cannot be started at all.
    pub fn start(command: &str, protocol: Protocol, timeout: Duration) -> Result<Self, String> {
        let words = shlex::split(command).ok_or_else(|| format!("{command}: a quote is not closed"))?;
        let pipe = Pipe::start(&words)?;
        Ok(Self {
            words,
            name: command.to_owned(),
            theory: Theory::Order(0),
            timeout,
            protocol,
            axes: Axes::default(),
            state: Arc::new(Mutex::new(State { pipe: Some(pipe), ..State::default() })),
        })
    }

    /// The same program, started again with lines of another form.
    pub fn restarted(&self, protocol: Protocol) -> Self {
        Self { protocol, state: Arc::default(), ..self.clone() }
    }

    /// Sets the task of the following questions, for messages.
    pub fn during(&self, what: &str) {
        self.state().during = what.to_owned();
    }

    /// Every breach of the protocol so far with its tasks; equal ones share a line.
    pub fn breaches(&self) -> Vec<String> {
        together(&self.state().log)
    }

    /// The reason why the program is not asked again; none if it is still asked.
    pub fn given_up(&self) -> Option<String> {
        self.state().given_up.clone()
    }

    /// Asks a question and returns the answer and the time that it took.
    pub fn ask(&self, question: &Question, setting: Setting) -> Result<(Turned, Duration), Asked> {
        let axes = self.axes;
        let question = Question {
            gradient_per_s: axes.tensor_to_theirs(question.gradient_per_s),
            rotation_rad_per_s: question.rotation_rad_per_s.map(|rotation| axes.rotation_to_theirs(rotation)),
            start: question.start.iter().map(|p| axes.to_theirs(*p)).collect(),
            ..*question
        };
        let rods = question.start.len();
        let (steps, tolerance) = (setting.steps().ok(), setting.tolerance().ok());
        let write = |id| self.protocol.write(&Request { id, question, steps, tolerance });
        let (found, took) = self.asked(write, |line, id| self.protocol.read(line, id, rods))?;
        let p = found.p.into_iter().map(|p| axes.to_ours(p)).collect();
        Ok((Turned { p, ..found }, took))
    }

    /// Asks for a table of so many rows and columns, as JSON alone, and returns it, with the standard errors of a
    /// random code, and the time that the answer took. `request` has all keys but the id.
    pub fn ask_table(&self, request: &Value, size: [usize; 2]) -> Result<((Rows, Option<Rows>), Duration), Asked> {
        let mut request = request.clone();
        let write = |id: u64| {
            request["id"] = id.into();
            Ok(request.to_string())
        };
        self.asked(write, |line, id| protocol::table(line, id, size))
    }

    /// Asks unless the program is given up or out of time; `write` gives the request of an id, and `read` its answer.
    fn asked<T>(
        &self,
        write: impl FnOnce(u64) -> Result<String, String>,
        read: impl FnOnce(&str, u64) -> Result<T, Asked>,
    ) -> Result<(T, Duration), Asked> {
        let mut state = self.state();
        if let Some(reason) = &state.given_up {
            let words = format!("not asked: {reason}");
            return Err(if state.late { Asked::Late(words) } else { Asked::Breach(words) });
        }
        if state.deadline.is_some_and(|deadline| Instant::now() > deadline) {
            return Err(Asked::Late("not asked: out of time".to_owned()));
        }
        let asked = Instant::now();
        state.asked = next_id(state.asked);
        let id = state.asked;
        let answer = write(id).map_err(wrong).and_then(|request| state.exchange(self, request));
        let (line, text) = answer.map_err(|breach| state.breached(breach))?;
        match read(&text, id) {
            Err(Asked::Breach(reason)) => {
                Err(state.breached(wrong(format!("line {line} of standard output: {reason}"))))
            }
            answer => answer.map(|answer| (answer, asked.elapsed())),
        }
    }

    /// Runs a study that may ask for as long as one answer may take, and then for the current answer. `None` if that
    /// was too short, the program broke the protocol, or it was given up.
    pub fn within_time<T>(&self, what: &str, study: impl FnOnce() -> T) -> Option<T> {
        self.during(what);
        let deadline = Instant::now() + self.timeout;
        self.state().deadline = Some(deadline);
        let breaches = self.state().breaches;
        let found = study();
        self.state().deadline = None;
        let in_time = Instant::now() <= deadline && self.state().breaches == breaches;
        (in_time && self.given_up().is_none()).then_some(found)
    }

    /// Closes the program's input and waits for its end. `Err` says what was wrong with the end.
    pub fn close(&self) -> Result<(), String> {
        self.state().pipe.take().map_or(Ok(()), Pipe::close)
    }

    /// The program as an integrator of one rod in plane Couette flow with G = 1/s, comparable with the project's own.
    pub fn integrator(&self) -> Integrator {
        let (one, many) = (self.clone(), self.clone());
        Integrator::new(&self.name, self.theory, move |problem, start, setting| {
            Ok(one.turned(problem, std::slice::from_ref(start), setting)?[0])
        })
        .with_many(move |problem, starts, setting| many.turned(problem, starts, setting))
    }

    fn turned(
        &self,
        problem: &RodProblem,
        starts: &[UnitVector3<f64>],
        setting: Setting,
    ) -> Result<Vec<Vector3<f64>>, Failure> {
        let start = starts.iter().map(|p| [p.x, p.y, p.z]).collect();
        let question = Question::couette(problem.aspect_ratio, start, problem.strain());
        let (found, _) = self.ask(&question, setting).map_err(|asked| Failure::Gave(asked.to_string()))?;
        Ok(found.p.into_iter().map(Vector3::from).collect())
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct Breach {
    what: String,
    /// What kept the answer from coming.
    trouble: Option<Trouble>,
}

fn wrong(what: String) -> Breach {
    Breach { what, trouble: None }
}

impl State {
    /// Sends a line and returns the next one with its number.
    fn exchange(&mut self, program: &Program, request: String) -> Result<(u64, String), Breach> {
        let pipe = match &mut self.pipe {
            Some(pipe) => pipe,
            none => none.insert(Pipe::start(&program.words).map_err(wrong)?),
        };
        pipe.nothing_more(Duration::ZERO).map_err(wrong)?;
        pipe.send(request);
        (pipe.line(program.timeout)).map_err(|trouble| Breach { what: trouble.to_string(), trouble: Some(trouble) })
    }

    /// Stops the program, notes the breach with what could not be stopped, and describes it; after too many the program
    /// is given up.
    fn breached(&mut self, Breach { mut what, trouble }: Breach) -> Asked {
        let left = self.pipe.take().map(Pipe::left).unwrap_or_default();
        left.iter().for_each(|left| what += &format!("; {left}"));
        self.breaches += 1;
        self.late = matches!(trouble, Some(Trouble::Hung(..)));
        self.hangs += u32::from(matches!(trouble, Some(Trouble::Hung(..) | Trouble::Closed)));
        self.log.push([self.during.clone(), what.clone()]);
        if self.hangs >= MOST_HANGS {
            self.given_up = Some(format!("{} answers did not come in time", self.hangs));
        } else if !left.is_empty() {
            self.given_up = Some("it cannot be stopped".to_owned());
        } else if self.breaches >= MOST_BREACHES {
            self.given_up = Some(format!("it broke the protocol {} times", self.breaches));
        }
        if self.late { Asked::Late(what) } else { Asked::Breach(what) }
    }
}

/// Ascending ids with unpredictable gaps: an answer written before its request has the wrong id.
fn next_id(last: u64) -> u64 {
    const LARGEST_GAP: u64 = 1000;
    last + 1 + RandomState::new().hash_one(last) % LARGEST_GAP
}

/// A line for each fault, in the order of the first of each, with the tasks in which it occurred and how often.
fn together(log: &[[String; 2]]) -> Vec<String> {
    let line = |(what, mut tasks): (&String, Vec<&str>)| {
        let times = if tasks.len() > 1 { format!(" ({} times)", tasks.len()) } else { String::new() };
        tasks.dedup();
        let tasks = match tasks.len() {
            ..=3 => tasks.join(", "),
            many => format!("{} and {} more", tasks[0], many - 1),
        };
        format!("{tasks}: {what}{times}")
    };
    grouped(log.iter().map(|[during, what]| (what, during.as_str()))).into_iter().map(line).collect()
}

#[test]
fn ids_ascend_and_their_gaps_are_not_all_alike() {
    let ids: Vec<_> = std::iter::successors(Some(0), |id| Some(next_id(*id))).take(100).collect();
    let gaps = ids.windows(2).map(|pair| pair[1] - pair[0]);
    let gaps: std::collections::BTreeSet<_> = gaps.collect();
    assert!(gaps.len() > 50 && gaps.iter().all(|gap| (1..=1000).contains(gap)), "{gaps:?}");
}

#[test]
fn a_fault_that_comes_again_has_one_line() {
    let log = ["a", "a", "b", "c", "d"].map(|during| [during.to_owned(), "broken".to_owned()]);
    assert_eq!(together(&log[..2]), ["a: broken (2 times)"]);
    assert_eq!(together(&log[1..3]), ["a, b: broken (2 times)"]);
    assert_eq!(together(&log), ["a and 3 more: broken (5 times)"]);
    let other = ["a".to_owned(), "late".to_owned()];
    assert_eq!(together(&[log[0].clone(), other, log[0].clone()]), ["a: broken (2 times)", "a: late"]);
}
