//! The effect of other interpretations of the paper: the naive reference runs each alternative alone and the
//! interpretation that the project uses, with the same random numbers.
//!
//! The scene is that of Fig. 7 at 50 per cm³. Seeds are shared, and places do not depend on directions: with the same
//! time step and replacement, two interpretations have the same rods at the same places with the same draws, and
//! differ only in the effect of collisions. The errors of the differences rely on that.

use super::*;
use crate::files::cluster;
use crate::oracle::naive::{Images, Length, Lines, Replacement, Update, Who};
use std::convert::Infallible;
use std::iter::once;

/// The study of the paper's open choices.
pub const STUDY: Study = Study {
    name: "interpretations",
    title: "What the paper leaves open",
    question: "What would other interpretations of the paper change?",
    cases: &[
        "interpretation-who-draws",
        "interpretation-order",
        "interpretation-update",
        "interpretation-shortest-arm",
        "interpretation-contact-lines",
        "faces-cost-collisions",
    ],
    command: "cargo run --release -p shearbed-validation --example interpretations",
    parts: &[],
    shared: true,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let Some(rows) = measure(request.effort) else {
        return Ok(None);
    };
    let change = |row: &InterpretationRow| row.changes.as_ref().map_or(0.0, |changes| changes[0].value.abs());
    let largest = rows.iter().max_by(|a, b| change(a).total_cmp(&change(b)));
    let answer = largest.map_or(String::new(), |row| {
        format!("X̄₁ at t/T = 1 changes most, by {:.3}, with {}: {}.", change(row), row.open, row.interpretation)
    });
    Ok(Some(Findings::new(answer, vec![table(&rows).into()], [])))
}

/// A row for each interpretation; for each quantity a column of its value and one of its change.
pub fn table(rows: &[InterpretationRow]) -> ReportTable {
    let replicas = rows.iter().map(|row| row.replicas).min().unwrap_or(0);
    let mut columns = vec![
        words("left open", |row: &InterpretationRow| row.open),
        words("alternative", |row: &InterpretationRow| row.interpretation),
    ];
    for (k, (name, _)) in QUANTITIES.iter().enumerate() {
        columns.push(estimate(*name, move |row: &InterpretationRow| row.values[k]));
        columns.push(difference("change", move |row: &InterpretationRow| {
            row.changes.as_ref().map(|changes| changes[k].into())
        }));
    }
    ReportTable::new(
        ["interpretations", "What the alternatives change"],
        format!(
            "The rods of Fig. 7 at 50 per cm³ (N = 100, σ = 0, r_e = 11.6, α = 0.5, 200 steps a period): each \
             alternative alone against this project's interpretation, then two of them with half the step. Mean ± \
             standard error of {replicas} replicas, seed {SEED}, by the naive reference. A change is from pairs of \
             replicas with the same random numbers. The damping rate is minus the slope, by least squares over four \
             half periods, of ln A; A is the mean of two neighbouring maxima of X̄₁ (t/T = 0, ½, 1, 1½, 2) less the \
             minimum between."
        ),
        rows,
        columns,
    )
}

/// The seed of all replicas.
pub const SEED: u64 = 1;

/// Quarters of a period in a run: free rods have maxima of X̄₁ at even quarters, and minima between them.
const QUARTERS: usize = 8;

/// The means of one replica: X̄₁ at every quarter of a period, then collisions per rod and period.
pub type Trace = [f64; QUARTERS + 2];

/// The results of one interpretation.
#[derive(Clone, Debug, PartialEq)]
pub struct InterpretationRow {
    pub(crate) open: &'static str,
    pub(crate) interpretation: &'static str,
    pub(crate) replicas: u64,
    pub(crate) values: Vec<Estimate>,
    /// Each value less that of the default, from pairs of replicas; none for the default itself.
    pub changes: Option<Vec<Estimate>>,
}

/// A function that computes a quantity from a mean trace.
pub type Quantity = fn(&Trace) -> f64;

/// The measured quantities, by name.
pub const QUANTITIES: [(&str, Quantity); 4] = [
    ("X̄₁ at t/T = 1", |x| x[4]),
    ("X̄₁ at t/T = 2", |x| x[8]),
    ("damping rate per period", damping_rate),
    ("collisions per rod and period", |x| x[QUARTERS + 1]),
];

/// A change of the problem.
pub type Change = fn(&mut NaiveProblem);

/// The alternatives: the open choice, the interpretation, and the change of the default for it. The effect of the last
/// two depends on the time step.
#[rustfmt::skip]
const ALTERNATIVES: [(&str, &str, Change); 17] = [
    ("who collides", "one draw per mutual pair", |p| p.reading.who = Who::PairDraws),
    ("who collides", "index order, not closest first", |p| p.reading.who = Who::IndexOrder),
    ("update", "angles: exactly A.14", |p| p.update = Update::Angles),
    ("update", "exact step plus kick", |p| p.update = Update::ExactStepAndKick),
    ("shortest arm", "the rod's radius, 1/(2r_e)", |p| p.min_contact_arm = 0.5 / p.aspect_ratio),
    ("contact lines", "cut at the rods' ends", |p| p.reading.lines = Lines::CutAtEnds),
    ("images", "along x_2 and x_3", |p| p.reading.images = Images::FlowAndVorticity),
    ("images", "along all axes", |p| p.reading.images = Images::All),
    ("replacement", "overshoot times x_1(new)/x_1(old)", |p| p.reading.replacement = Replacement::ScaledOvershoot),
    ("lengths", "scatter by 30 %", |p| p.length_sd_percent = 30.0),
    ("lengths", "30 %, P_c by the partner's", |p| (p.length_sd_percent, p.reading.length) = (30.0, Length::Partners)),
    ("lengths", "30 %, P_c by the mean of both", |p| {
        (p.length_sd_percent, p.reading.length) = (30.0, Length::MeanOfBoth);
    }),
    ("box", "4 : ½ : ½ of the cube's sides", |p| p.box_mm = Some([4.0, 0.5, 0.5].map(|side| side * p.edges_mm()[0]))),
    ("time step", "halved: 400 steps a period", |p| p.steps_per_period *= 2),
    ("time step", "doubled: 100 steps a period", |p| p.steps_per_period /= 2),
    ("update and step", "angles, 400 steps a period", |p| (p.update, p.steps_per_period) = (Update::Angles, 400)),
    ("arm and step", "the rod's radius, 400 steps a period", |p| {
        (p.min_contact_arm, p.steps_per_period) = (0.5 / p.aspect_ratio, 400);
    }),
];

/// This project's interpretation, then the alternatives.
pub fn all() -> impl Iterator<Item = (&'static str, &'static str, Change)> {
    let default: Change = |_| ();
    once(("–", "this project", default)).chain(ALTERNATIVES)
}

/// The rows of the default and of every alternative, run over all ranks; `None` except on the root.
pub fn measure(effort: &Effort) -> Option<Vec<InterpretationRow>> {
    let replicas = effort.pick(40, 2000);
    let interpretations: Vec<_> = all().collect();
    let job = |k: usize| Ok::<_, Infallible>(traces(interpretations[k].2, replicas));
    let Ok(shared) = cluster::share(interpretations.len(), job, |_, _| Ok(()));
    let traces = shared?;
    let default = traces.first()?;
    let each = |estimate: &dyn Fn(Quantity) -> Estimate| QUANTITIES.map(|(_, q)| estimate(q)).to_vec();
    let row = |k: usize| InterpretationRow {
        open: interpretations[k].0,
        interpretation: interpretations[k].1,
        replicas,
        values: each(&|quantity| value(quantity, &traces[k])),
        changes: (k > 0).then(|| each(&|quantity| change(quantity, default, &traces[k]))),
    };
    Some((0..interpretations.len()).map(row).collect())
}

/// The traces of the first `replicas` replicas of the paper's problem with `change`.
pub fn traces(change: Change, replicas: u64) -> Vec<Trace> {
    lab::replicas(replicas, |replica| {
        let mut problem = NaiveProblem::paper(SEED, replica);
        change(&mut problem);
        trace(problem)
    })
}

/// Runs two periods of a problem whose number of steps per period is a multiple of four.
fn trace(problem: NaiveProblem) -> Trace {
    let (steps, rods) = (problem.steps_per_period / 4, problem.count as f64);
    let mut naive = Naive::new(problem);
    let mut trace = [0.0; QUARTERS + 2];
    trace[0] = mean_projections(&naive.orientations)[0];
    for x1 in &mut trace[1..=QUARTERS] {
        (0..steps).for_each(|_| naive.step());
        *x1 = mean_projections(&naive.orientations)[0];
    }
    // Each collision turns two rods.
    trace[QUARTERS + 1] = 2.0 * naive.collisions as f64 / rods / (QUARTERS as f64 / 4.0);
    trace
}

/// The decay rate of the oscillation of a mean X̄₁, 1/T: minus the slope, by least squares over four half
/// periods, of ln A. A, at the minimum between two maxima, is the mean of these maxima less the minimum.
/// Maxima and minima are taken at the times of those of free rods.
pub fn damping_rate(x1: &Trace) -> f64 {
    let ln_a = [1, 3, 5, 7].map(|k| (0.5 * (x1[k - 1] + x1[k + 1]) - x1[k]).ln());
    let t: [f64; 4] = [-0.75, -0.25, 0.25, 0.75];
    let slope = |t: &[f64; 4]| (0..4).map(|k| t[k] * ln_a[k]).sum::<f64>() / t.map(|t| t * t).iter().sum::<f64>();
    -slope(&t)
}

/// The estimate of a quantity of the mean trace, with an error by the jackknife.
pub fn value(quantity: Quantity, traces: &[Trace]) -> Estimate {
    let without: Vec<_> = means_without_one(traces).iter().map(quantity).collect();
    Estimate::jackknife(quantity(&mean(traces)), &without)
}

/// A quantity of the mean of `traces` less that of `default`, from pairs of replicas with the same random numbers.
pub fn change(quantity: Quantity, default: &[Trace], traces: &[Trace]) -> Estimate {
    let less = |after: &Trace, before: &Trace| quantity(after) - quantity(before);
    let (after, before) = (means_without_one(traces), means_without_one(default));
    let without: Vec<_> = after.iter().zip(&before).map(|(a, b)| less(a, b)).collect();
    Estimate::jackknife(less(&mean(traces), &mean(default)), &without)
}

fn mean(traces: &[Trace]) -> Trace {
    std::array::from_fn(|i| traces.iter().map(|trace| trace[i]).sum::<f64>() / traces.len() as f64)
}

/// For each replica, the mean of all other traces.
fn means_without_one(traces: &[Trace]) -> Vec<Trace> {
    let (n, mean) = (traces.len() as f64, mean(traces));
    let without = |trace: &Trace| std::array::from_fn(|i| (n * mean[i] - trace[i]) / (n - 1.0));
    traces.iter().map(without).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_an_exponential_is_exact() {
        // Maxima at 0.4; each minimum lies below them by an amplitude A ∝ exp(−0.3 t/T).
        let mut x1 = [0.4; QUARTERS + 2];
        for k in [1, 3, 5, 7] {
            x1[k] -= 0.2 * (-0.3 * k as f64 / 4.0).exp();
        }
        assert!((damping_rate(&x1) - 0.3).abs() < 1e-14);
        // A linear drift, such as that of a changing plateau, does not count as damping.
        let mut drifting = x1;
        (0..=QUARTERS).for_each(|k| drifting[k] += 0.01 * k as f64);
        assert!((damping_rate(&drifting) - 0.3).abs() < 1e-13);
    }

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        // 1, 2, 6: mean 3, variance 7, standard error √(7/3)
        let traces = [1.0, 2.0, 6.0].map(|x| [x; QUARTERS + 2]);
        let default = [1.0, 1.0, 1.0].map(|x| [x; QUARTERS + 2]);
        for (estimate, mean) in [(value(|x| x[4], &traces), 3.0), (change(|x| x[4], &default, &traces), 2.0)] {
            assert!((estimate.value - mean).abs() < 1e-14);
            assert!((estimate.se - (7.0f64 / 3.0).sqrt()).abs() < 1e-14);
        }
        let same = change(damping_rate, &default, &default);
        assert!(same.value.is_nan(), "no oscillation has no rate");
    }

    #[test]
    fn the_problem_is_that_of_fig_7() {
        let scene = crate::input::scenes::find("fig7-n50").expect("built in").scene().expect("valid");
        // But for the update and the seed.
        let theirs = NaiveProblem { update: Update::Rotation, seed: SEED, ..lab::problem(&scene, 0, None) };
        assert_eq!(NaiveProblem::paper(SEED, 0), theirs);
    }
}
