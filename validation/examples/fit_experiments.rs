//! Whole fits of experiments by another simulator: how often the intervals hold the planted α, and whether p-values are
//! uniform.
//!
//!     cargo run --release -p shearbed-validation --example fit_experiments -- 300 rods 300
//!
//! Each of 300 experiments is one suspension of 300 rods by the naive reference, with a reading error of 0.003. The
//! model has as many rods.
//!
//! | second argument | the points' u | the fit |
//! | --- | --- | --- |
//! | rods | reading | `--rods N` |
//! | within | reading and the scatter over the rods | `--rods N --u-contains rods` |
//! | within-independent | the same | `--u-contains reading` |
//! | infinite | an error of 0.01 of the mean of all experiments | `--u-contains reading` |

use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use shearbed_validation::judge::lab::problem;
use shearbed_validation::methods::least_squares::Datum;
use shearbed_validation::methods::least_squares::likelihood::{RODS, Reading, Rods};
use shearbed_validation::oracle::naive::Naive;
use shearbed_validation::serve::fit::Range;
use shearbed_validation::serve::fit::data::TimeColumn;
use shearbed_validation::serve::fit::report::report;
use shearbed_validation::serve::fit::scenes::{AS_WRITTEN, Scenes, Set};
use shearbed_validation::serve::fit::search::{FitProblem, Watch, search};
use shearbed_validation::serve::sweep;

const PLANTED: f64 = 0.8;
const TIMES: usize = 20;
const STEPS: usize = 40;
const READING: f64 = 0.003;

fn set(count: usize, seed: u64) -> Result<Set, String> {
    let settings = [
        "time.periods=1".into(),
        format!("time.steps_per_period={STEPS}"),
        format!("time.outputs_per_period={STEPS}"),
        "interaction.update=\"kick\"".into(),
        format!("interaction.alpha={PLANTED}"),
        format!("particles.count={count}"),
    ];
    Set::built_in("fig4-n50", &settings, seed, TimeColumn::Periods)
}

/// Mean and standard deviation over the rods of |p₁| at each time.
fn experiment(rods: usize, k: u64) -> Result<Vec<[f64; 2]>, String> {
    let own = set(rods, 0)?;
    let mut scene = sweep::scene_with(&own.text, &own.settings)?;
    scene.ensemble.seed = 1;
    let mut naive = Naive::new(problem(&scene, k, None));
    let mut next = |_| {
        (0..STEPS / TIMES).for_each(|_| naive.step());
        let all = DVector::from_iterator(rods, naive.orientations.iter().map(|p| p[0].abs()));
        [all.mean(), all.variance().sqrt()]
    };
    Ok((0..TIMES).map(&mut next).collect())
}

fn main() -> Result<(), String> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let sets: u64 = args.first().map_or(Ok(20), |text| text.parse()).map_err(|error| format!("{error}"))?;
    let way = args.get(1).map_or("rods", String::as_str);
    let rods: usize = args.get(2).map_or(Ok(100), |text| text.parse()).map_err(|error| format!("{error}"))?;
    let all: Vec<_> = (0..sets).into_par_iter().map(|k| experiment(rods, k)).collect::<Result<_, _>>()?;
    let mean = |time: usize| all.iter().map(|one| one[time][0]).sum::<f64>() / sets as f64;
    let truth: Vec<f64> = (0..TIMES).map(mean).collect();
    let range = vec![Range::parse("interaction.alpha=0.05:5")?];
    let over_measured = vec![1.0];
    let rods_of_fit = match way {
        "rods" => Rods { over_measured, reading: Reading::Share(1.0) },
        "within" => Rods { over_measured, reading: Reading::Rest((2.0 / rods as f64).sqrt()) },
        "within-independent" | "infinite" => Rods::none(1),
        _ => {
            return Err(format!("{way}: rods, within, within-independent and infinite are allowed"));
        }
    };
    let one = |k: u64| -> Result<_, String> {
        let mut rng = Pcg64Dxsm::seed_from_u64(1000 + k);
        let mut noise = || rng.sample::<f64, _>(StandardNormal);
        let point = |time: usize| {
            let [value, sd] = all[k as usize][time];
            let (value, u) = match way.split('-').next() {
                Some("infinite") => (truth[time] + 0.01 * noise(), 0.01),
                Some("within") => (value + READING * noise(), READING.hypot(sd / (rods as f64).sqrt())),
                _ => (value + READING * noise(), READING),
            };
            Datum { value, u, ..Datum::place(0, "x1", (time + 1) as f64 / TIMES as f64) }
        };
        let data: Vec<Datum> = (0..TIMES).map(point).collect();
        let scenes = Scenes::new(vec![set(rods, 5000 + k)?], range.clone())?;
        let model = |values: &[f64]| scenes.model(&data, AS_WRITTEN, values).map_err(String::from);
        let (ranges, rods) = (&range, &rods_of_fit);
        let problem = FitProblem { data: &data, ranges, rods, model: &model, most_replicas: 1000 };
        let fit = search(&problem, &Watch::SILENT)?;
        let report = report(&fit, &data, Vec::new());
        let ends = &report.parameters["interaction.alpha"];
        let inside = [(ends.low_68, ends.high_68), (ends.low_95, ends.high_95)]
            .map(|(low, high)| (low..=high).contains(&PLANTED));
        println!(
            "{k},{:.2},{:.4},{},{:.3},{:.3},{:.4},{:.4},{:.4},{:.4},{:.4}",
            report.chi2,
            report.p_value,
            report.replicas,
            fit.best.goodness.excess,
            fit.best.causes[RODS].trace() / data.iter().map(|datum| datum.u.powi(2)).sum::<f64>(),
            ends.estimate,
            ends.low_68,
            ends.high_68,
            ends.low_95,
            ends.high_95
        );
        Ok((inside, report.chi2 / report.degrees_of_freedom as f64, report.p_value))
    };
    let fits: Vec<_> = (0..sets).into_par_iter().map(one).collect::<Result<_, _>>()?;
    let n = fits.len() as f64;
    let share = |count: usize| {
        let share = count as f64 / n;
        format!("{:.1} ± {:.1} %", 100.0 * share, 100.0 * (share * (1.0 - share) / n).sqrt())
    };
    for (which, level) in ["68", "95"].into_iter().enumerate() {
        println!("# {level} % intervals hold α in {}", share(fits.iter().filter(|fit| fit.0[which]).count()));
    }
    let chi = DVector::from_iterator(fits.len(), fits.iter().map(|fit| fit.1));
    println!("# χ² per degree of freedom {:.3} ± {:.3}", chi.mean(), (chi.variance() / n).sqrt());
    println!("# p < 0.05 in {}", share(fits.iter().filter(|fit| fit.2 < 0.05).count()));
    let mut p: Vec<f64> = fits.iter().map(|fit| fit.2).collect();
    p.sort_by(f64::total_cmp);
    let distance = shearbed_validation::oracle::worst(
        (p.iter().enumerate()).map(|(k, p)| (p - k as f64 / n).max((k as f64 + 1.0) / n - p)),
    );
    // Kolmogorov's law with Stephens' correction for small samples.
    let x = distance * (n.sqrt() + 0.12 + 0.11 / n.sqrt());
    let tail = (1..50).map(|k| 2.0 * (-1f64).powi(k - 1) * (-2.0 * f64::from(k * k) * x * x).exp()).sum::<f64>();
    println!("# p uniform: Kolmogorov–Smirnov distance {distance:.3}, probability {:.2e}", tail.min(1.0));
    Ok(())
}
