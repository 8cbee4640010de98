//! What α would be under each open reading of the paper, and what points of two suspensions tell of the readings, as Markdown
//! tables. `cargo run --release -p shearbed-suite --example fit_readings -- 50` gives each value of α up to 50 replicas in the
//! first; in the second points and model have 10 000.

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::iter::once;
use validation::fit::Range;
use validation::fit::basis::Basis;
use validation::fit::data::Datum;
use validation::fit::emulator::{Prediction, Replica, coefficients};
use validation::fit::search::{Problem, Watch, fitted, search};
use validation::oracle::naive::{Naive, mean_projections};
use validation::readings::{ALTERNATIVES, Change, paper};

const PLANTED: f64 = 0.8;
const NOISE: f64 = 0.01;
const POINTS: usize = 20;
const TRUTH: u64 = 400;

/// Of the second table: two suspensions with one α, points of X̄₁ to X̄₃ up to half a period.
const CONCENTRATIONS: [f64; 2] = [20.0, 2000.0];
const TIMES: usize = 10;
const STEPS_PER_PERIOD: usize = 100;
const RODS: usize = 50;
const SMALL_NOISE: f64 = 0.001;
const REPLICAS: u64 = 10_000;

/// X̄₁ at every twentieth of a period, up to one period.
fn curve(change: Change, alpha: f64, seed: u64, replica: u64) -> Vec<Prediction> {
    let mut problem = paper(replica);
    change(&mut problem);
    (problem.alpha, problem.seed) = (alpha, seed);
    let steps = problem.steps_per_period / POINTS;
    let mut naive = Naive::new(problem);
    let mut next = || {
        (0..steps).for_each(|_| naive.step());
        [mean_projections(&naive.orientations)[0]; 3]
    };
    (0..POINTS).map(|_| next()).collect()
}

/// One replica of both suspensions: X̄₁ to X̄₃ at each time.
fn curves(change: Change, alpha: f64, seed: u64, replica: u64) -> Vec<Prediction> {
    let mut values = Vec::new();
    for (k, concentration_per_cm3) in CONCENTRATIONS.into_iter().enumerate() {
        let mut problem = paper(replica);
        change(&mut problem);
        (problem.alpha, problem.seed) = (alpha, seed + 1000 * k as u64);
        (problem.concentration_per_cm3, problem.count) = (concentration_per_cm3, RODS);
        problem.steps_per_period = STEPS_PER_PERIOD;
        let mut naive = Naive::new(problem);
        for _ in 0..TIMES {
            (0..STEPS_PER_PERIOD / 2 / TIMES).for_each(|_| naive.step());
            values.extend(mean_projections(&naive.orientations).map(|x| [x; 3]));
        }
    }
    values
}

/// Fits one α to the points of each reading without noise, by this project's.
fn two_suspensions() -> Result<(), String> {
    let default: Change = |_| ();
    let all = once(("–", "this project", default)).chain(ALTERNATIVES);
    println!("\n| points of | α of both | χ² − χ² of this project's | in standard deviations of χ² |");
    println!("| --- | ---: | ---: | ---: |");
    let mut own = None;
    let model = |values: &[f64]| -> Result<Replica, String> {
        let alpha = values[0];
        Ok(Box::new(move |replica| Ok(curves(default, alpha, 1, replica))))
    };
    let range = [Range::parse("interaction.alpha=0.4:1.2")?];
    let basis = Basis::new(1);
    let value = |node: &[f64]| vec![0.8 + 0.4 * node[0]];
    let nodes = coefficients(&basis, &model, value, 0..REPLICAS, &|| ())?;
    for (open, reading, change) in all.filter(|(open, ..)| !open.contains("step")) {
        let rows: Vec<_> = (0..REPLICAS)
            .into_par_iter()
            .map(|replica| curves(change, PLANTED, 99, replica))
            .collect();
        let datum = |k: usize| Datum {
            set: k / (3 * TIMES),
            line: 0,
            column: "x1".into(),
            time: 0.0,
            value: rows.iter().map(|row| row[k][0]).sum::<f64>() / REPLICAS as f64,
            u_time: 0.0,
            u: SMALL_NOISE,
        };
        let data: Vec<Datum> = (0..rows[0].len()).map(datum).collect();
        let problem = Problem {
            data: &data,
            ranges: &range,
            rods_over_measured: &[1.0 / REPLICAS as f64; CONCENTRATIONS.len()],
            model: &model,
            most_replicas: REPLICAS,
        };
        let fit = fitted(&problem, &basis, &vec![(range[0].from, range[0].to)], &nodes)?;
        let found = fit.best.chi_square;
        let more = found - *own.get_or_insert(found);
        println!(
            "| {open}: {reading} | {:.3} | {more:.0} | {:.1} |",
            fit.values(&fit.best.place)[0],
            more / (2.0 * (data.len() - 1) as f64).sqrt(),
        );
    }
    Ok(())
}

fn main() -> Result<(), String> {
    two_suspensions()?;
    let most: u64 = std::env::args()
        .nth(1)
        .map_or(Ok(50), |text| text.parse())
        .map_err(|error| format!("{error}"))?;
    let default: Change = |_| ();
    let rows: Vec<_> = (0..TRUTH)
        .into_par_iter()
        .map(|replica| curve(default, PLANTED, 99, replica))
        .collect();
    let mut rng = Pcg64Dxsm::seed_from_u64(7);
    let point = |k: usize| {
        let noise: f64 = StandardNormal.sample(&mut rng);
        Datum {
            set: 0,
            line: 0,
            column: "x1".into(),
            time: (k + 1) as f64 / POINTS as f64,
            value: rows.iter().map(|row| row[k][0]).sum::<f64>() / TRUTH as f64 + NOISE * noise,
            u_time: 0.0,
            u: NOISE,
        }
    };
    let data: Vec<Datum> = (0..POINTS).map(point).collect();
    let law = ChiSquared::new((POINTS - 1) as f64).map_err(|error| error.to_string())?;
    println!(
        "| open | reading | α | 95 % interval | χ² of {} | p |",
        POINTS - 1
    );
    println!("| --- | --- | ---: | --- | ---: | ---: |");
    let all = once(("–", "this project", default)).chain(ALTERNATIVES);
    for (open, reading, change) in all {
        let model = move |values: &[f64]| -> Result<Replica, String> {
            let alpha = values[0];
            Ok(Box::new(move |replica| Ok(curve(change, alpha, 1, replica))))
        };
        let problem = Problem {
            data: &data,
            ranges: &[Range::parse("interaction.alpha=0.2:3")?],
            rods_over_measured: &[0.0],
            model: &model,
            most_replicas: most,
        };
        let fit = search(
            &problem,
            &Watch {
                planned: &|_| (),
                done: &|| (),
            },
        )?;
        let ends = fit.interval(0, 0.95);
        println!(
            "| {open} | {reading} | {:.3} | {:.3} to {:.3} | {:.1} | {:.2} |",
            fit.values(&fit.best.place)[0],
            ends.low,
            ends.high,
            fit.best.chi_square,
            law.sf(fit.best.chi_square)
        );
    }
    Ok(())
}
