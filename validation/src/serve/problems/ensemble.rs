//! Problems of suspensions with collisions after Lee & Springer (1982).
//!
//! The means are a reference of this program, not certified, and a shipped table: they take 20 000 replicas and
//! minutes, and a table is the same on every machine. `shearbed run fig7-n50 --set interaction.update=rotation
//! --replicas 20000 --seed 1982` wrote `data/fig7-n50.csv`, and the same with fig4-n50 wrote `data/fig4-n50.csv`; rows
//! at other times are left out.

use super::asked::periods_s;
use super::{Built, Ensemble, Kind, Problem, ProblemDef};
use crate::files::csv::split;
use crate::judge::statistics::student;

/// Columns `t_over_T,x1,x1_se,x2,x2_se,x3,x3_se`.
const EQUAL: &str = include_str!("data/fig7-n50.csv");
const UNEQUAL: &str = include_str!("data/fig4-n50.csv");

const REPLICAS: u64 = 20_000;
/// The smallest number of replicas of an answer.
const LEAST: u64 = 1000;
const ASPECT_RATIO: f64 = 11.6;

pub(super) fn problems() -> Vec<ProblemDef> {
    vec![
        ProblemDef::new("lee-springer", "Colliding rods of one aspect ratio, 50 per cm³", |def| {
            built(def, 0.0, EQUAL)
        }),
        ProblemDef::new("lee-springer-unequal", "Colliding rods of unequal aspect ratios, 50 per cm³", |def| {
            built(def, 3.6, UNEQUAL)
        }),
    ]
}

/// The probability that a correct answer fails by chance, over both problems.
const FALSE_ALARM_RATE: f64 = 5e-3;

/// The largest difference in standard errors of a right answer with so many `comparisons`.
pub(super) fn tolerance(comparisons: usize) -> f64 {
    (100.0 * student(FALSE_ALARM_RATE / comparisons as f64, LEAST)).ceil() / 100.0
}

/// The reason for [`tolerance`].
pub(super) fn because(comparisons: usize, of: &str) -> String {
    format!(
        "Student's t with {} degrees of freedom ({LEAST} replicas, the fewest allowed) at the level at which a right \
         answer fails one of the {comparisons} comparisons of {of} with a probability of {FALSE_ALARM_RATE:e}; rounded \
         up to hundredths.",
        LEAST - 1
    )
}

fn built(def: &ProblemDef, sd_percent: f64, table: &str) -> Built {
    let mut certified: Vec<Vec<String>> = table.lines().skip(1).map(split).collect();
    let turns = certified.iter().map(|row| row[0].parse().expect("a shipped table has numbers"));
    let times_s = periods_s(ASPECT_RATIO, &turns.collect::<Vec<_>>());
    certified.iter_mut().zip(&times_s).for_each(|(row, time)| row[0] = format!("{time:?}"));
    // Two problems, three means per time.
    let comparisons = 2 * 3 * certified.len();
    let problem = Problem {
        summary: "The model of Lee & Springer (1982) with the paper's rods in plane Couette flow: free rods turn by \
            Jeffery's equation, neighbours collide at random, and the mean projections x_i = ⟨|p_i|⟩ oscillate and die \
            out. Your answer is an average over replicas with standard errors, and is compared within both errors."
            .into(),
        aspect_ratio: ASPECT_RATIO,
        aspect_ratio_sd_percent: sd_percent,
        tolerance: tolerance(comparisons),
        because: because(comparisons, "both such problems"),
        equations: vec![format!(
            "the model of Lee & Springer (1982), eqs 4 to 14 and A.1 to A.13; in the step of a collision a rod turns \
             about p × ṗ′ by |ṗ′|Δt. {REPLICAS} replicas of this project's simulator with update = \"rotation\", seed \
             1982, judged by the independent naive reference"
        )],
        ensemble: Some(Ensemble {
            count: 100,
            length_mm: 0.72,
            concentration_per_cm3: 50.0,
            alpha: 0.5,
            m: 3.0,
            steps_per_period: 200,
            certified_replicas: REPLICAS,
            // A replica's means spread by up to 0.0322: `LEAST` replicas give 0.00102, known to 2.2 %. With this and
            // the tolerance of 3.83 such errors, a bias of 0.008 fails with a probability of 99.9 %.
            largest_standard_error: 0.0011,
        }),
        times_s,
        ..Problem::new(def, Kind::Ensemble, &["x1", "x1_se", "x2", "x2_se", "x3", "x3_se"])
    };
    Built::new(problem, certified)
}
