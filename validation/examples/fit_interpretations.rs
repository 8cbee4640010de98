//! What α would be under each interpretation of the paper, and what points of two suspensions say of the
//! interpretations, as Markdown tables. With `cargo run --release -p shearbed-validation --example fit_interpretations
//! -- 50 7` each value of α has up to 50 replicas in the first, whose points have noise of seed 7; in the second points
//! and model have 10 000.

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use shearbed_validation::cases::fit_interpretations::{model, one_alpha, points};
use shearbed_validation::judge::case::Effort;
use shearbed_validation::methods::least_squares::Datum;
use shearbed_validation::methods::least_squares::emulator::{Prediction, Replica};
use shearbed_validation::methods::least_squares::likelihood::Rods;
use shearbed_validation::oracle::naive::{self, Naive, mean_projections};
use shearbed_validation::serve::fit::Range;
use shearbed_validation::serve::fit::search::{FitProblem, Watch, search};
use shearbed_validation::studies::interpretations::{self, Change, SEED};
use statrs::distribution::{ChiSquared, ContinuousCDF};

const PLANTED: f64 = 0.8;
const NOISE: f64 = 0.01;
const POINTS: usize = 20;
const TRUTH: u64 = 400;

/// Of the second table: one standard deviation of its points, and replicas behind them and the model.
const SMALL_NOISE: f64 = 0.001;
const REPLICAS: u64 = 10_000;

/// X̄₁ at every twentieth of a period, up to one period.
fn curve(change: Change, alpha: f64, seed: u64, replica: u64) -> Vec<Prediction> {
    let mut problem = naive::NaiveProblem::paper(SEED, replica);
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

/// Fits one α to the points of each reading without noise, by this project's: those of the case `fit-tells-cut-lines`.
fn two_suspensions() -> Result<(), String> {
    let effort = Effort::gate();
    let model = model(&effort, REPLICAS)?;
    println!("\n| points of | α of both | χ² − χ² of this project's | in standard deviations of χ² |");
    println!("| --- | ---: | ---: | ---: |");
    let mut own = None;
    for (open, reading, change) in interpretations::all().filter(|(open, ..)| !open.contains("step")) {
        let points = points(change, &effort, REPLICAS);
        let fit = one_alpha(&points, SMALL_NOISE, REPLICAS, &model)?;
        let chi_square = fit.best.chi_square;
        let more = chi_square - *own.get_or_insert(chi_square);
        println!(
            "| {open}: {reading} | {:.3} | {more:.0} | {:.1} |",
            fit.values(&fit.best.place)[0],
            more / (2.0 * (points.len() - 1) as f64).sqrt(),
        );
    }
    Ok(())
}

fn main() -> Result<(), String> {
    two_suspensions()?;
    let number =
        |k, or| std::env::args().nth(k).map_or(Ok(or), |text| text.parse().map_err(|_| format!("{text}: no number")));
    let [most, noise] = [number(1, 50)?, number(2, 7)?];
    let rows: Vec<_> = (0..TRUTH).into_par_iter().map(|replica| curve(|_| (), PLANTED, 99, replica)).collect();
    let mut rng = Pcg64Dxsm::seed_from_u64(noise);
    let point = |k: usize| {
        let noise: f64 = StandardNormal.sample(&mut rng);
        Datum {
            value: rows.iter().map(|row| row[k][0]).sum::<f64>() / TRUTH as f64 + NOISE * noise,
            u: NOISE,
            ..Datum::place(0, "x1", (k + 1) as f64 / POINTS as f64)
        }
    };
    let data: Vec<Datum> = (0..POINTS).map(point).collect();
    let law = ChiSquared::new((POINTS - 1) as f64).map_err(|error| error.to_string())?;
    println!("| open | reading | α | 95 % interval | χ² of {} | p |", POINTS - 1);
    println!("| --- | --- | ---: | --- | ---: | ---: |");
    for (open, reading, change) in interpretations::all() {
        let model = move |values: &[f64]| -> Result<Replica, String> {
            let alpha = values[0];
            Ok(Replica::whole(move |replica| Ok(curve(change, alpha, 1, replica))))
        };
        let problem = FitProblem {
            data: &data,
            ranges: &[Range::parse("interaction.alpha=0.2:3")?],
            rods: &Rods::none(1),
            model: &model,
            most_replicas: most,
        };
        let fit = search(&problem, &Watch::SILENT)?;
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
