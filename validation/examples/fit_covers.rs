//! Repeats whole fits of synthetic points with a planted α, each with a seed and noise of its own, and counts how often the
//! intervals hold it: `cargo run --release -p shearbed-suite --example fit_covers -- 200`.

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use validation::fit::Range;
use validation::fit::data::{Datum, TimeColumn};
use validation::fit::likelihood::{EMULATOR, REPLICAS};
use validation::fit::scenes::{AS_WRITTEN, Scenes, Set};
use validation::fit::search::{Measured, Problem, Watch, search};
use validation::scenes;
use validation::start::Starts;
use validation::sweep::Setting;

const PLANTED: f64 = 0.8;
const NOISE: f64 = 0.01;
const POINTS: usize = 22;
/// Replicas of the curve behind the points: its own error is a tenth of what 22 points of this noise leave in α.
const TRUTH: u64 = 4000;

fn points(value: impl Fn(usize) -> f64) -> Vec<Datum> {
    let point = |k: usize| Datum {
        value: value(k),
        u: NOISE,
        ..Datum::place(0, "x1", (k + 1) as f64 / POINTS as f64)
    };
    (0..POINTS).map(point).collect()
}

/// Fig. 4 at 50 per cm³, one period in a hundred steps: the model judges itself.
fn scenes(seed: u64, over: &Range) -> Result<Scenes, String> {
    let settings = ["time.periods=1", "time.steps_per_period=100"].map(Setting::parse);
    let set = Set {
        source: "fig4-n50".into(),
        text: scenes::find("fig4-n50").ok_or("no scene")?.text.into(),
        starts: Starts::default(),
        settings: settings.into_iter().collect::<Result<_, _>>()?,
        seed,
        time: TimeColumn::Periods,
    };
    Scenes::new(vec![set], vec![over.clone()])
}

fn main() -> Result<(), String> {
    let repeats: u64 = std::env::args()
        .nth(1)
        .map_or(Ok(20), |text| text.parse())
        .map_err(|error| format!("{error}"))?;
    let over = Range::parse("interaction.alpha=0.1:5")?;
    let places = points(|_| f64::NAN);
    let planted = scenes(1, &over)?.model(&places, AS_WRITTEN, &[PLANTED])?;
    let rows: Vec<_> = (0..TRUTH)
        .into_par_iter()
        .map(planted)
        .collect::<Result<_, _>>()?;
    let truth = |k: usize| rows.iter().map(|row| row[k][0]).sum::<f64>() / TRUTH as f64;
    let truth: Vec<f64> = (0..POINTS).map(truth).collect();
    let law = ChiSquared::new((POINTS - 1) as f64).map_err(|error| error.to_string())?;
    println!(
        "repeat,alpha,u,share_of_replicas,share_of_emulator,low_68,high_68,low_95,high_95,p,replicas,runs"
    );
    let (mut inside, mut low_p) = ([0, 0], 0);
    for k in 0..repeats {
        let mut rng = Pcg64Dxsm::seed_from_u64(1000 + k);
        let noise: Vec<f64> = (0..POINTS).map(|_| StandardNormal.sample(&mut rng)).collect();
        let data = points(|k| truth[k] + NOISE * noise[k]);
        let scenes = scenes(2000 + k, &over)?;
        let model = |values: &[f64]| scenes.model(&data, AS_WRITTEN, values);
        let problem = Problem {
            measured: Measured {
                data: &data,
                ranges: std::slice::from_ref(&over),
                rods_over_measured: &[0.0],
            },
            model: &model,
            most_replicas: 1000,
        };
        let fit = search(
            &problem,
            &Watch {
                planned: &|_| (),
                done: &|| (),
            },
        )?;
        let ends = [0.68, 0.95].map(|confidence| fit.interval(0, confidence));
        for (count, ends) in inside.iter_mut().zip(ends) {
            *count += u64::from((ends.low..=ends.high).contains(&PLANTED));
        }
        let p = law.sf(fit.best.chi_square);
        low_p += u64::from(p < 0.05);
        let u = fit.best.covariance()[(0, 0)].sqrt() * fit.scale(0);
        let alpha = fit.values(&fit.best.place)[0];
        let [inner, outer] = ends;
        println!(
            "{k},{alpha:.4},{u:.4},{:.3},{:.3},{:.4},{:.4},{:.4},{:.4},{p:.3},{},{}",
            fit.best.share(REPLICAS),
            fit.best.share(EMULATOR),
            inner.low,
            inner.high,
            outer.low,
            outer.high,
            fit.emulator.replicas(),
            fit.runs
        );
    }
    let share = |count: u64| 100.0 * count as f64 / repeats as f64;
    println!(
        "# of {repeats}: in the 68 % interval {:.1} %, in the 95 % interval {:.1} %, p below 0.05 {:.1} %",
        share(inside[0]),
        share(inside[1]),
        share(low_p)
    );
    Ok(())
}
