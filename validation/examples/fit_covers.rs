//! Repeats whole fits of synthetic points of two thin suspensions, each with a seed and noise of its own, and counts
//! how often the intervals hold the planted values:
//!
//!     cargo run --release -p shearbed-validation --example fit_covers -- 200 interaction.alpha=0.2:3
//!     interaction.m=1.2:6
//!
//! `100..200` goes on where 100 repeats have ended.
//! Keys are `interaction.alpha`, `interaction.m`, `particles.aspect_ratio`, `particles.aspect_ratio_sd_percent` and
//! `interaction.concentration_per_cm3` (of the second suspension).

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use shearbed_validation::judge::statistics::Sample;
use shearbed_validation::methods::least_squares::Datum;
use shearbed_validation::methods::least_squares::likelihood::{EMULATOR, REPLICAS, Rods};
use shearbed_validation::serve::fit::Range;
use shearbed_validation::serve::fit::data::TimeColumn;
use shearbed_validation::serve::fit::elsewhere::best_fit;
use shearbed_validation::serve::fit::scenes::{AS_WRITTEN, Scenes, Set};
use shearbed_validation::serve::fit::search::{Fit, FitProblem, Watch};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::collections::BTreeMap;

/// The values behind the points.
const PLANTED: [(&str, f64); 5] = [
    ("interaction.alpha", 0.8),
    ("interaction.m", 3.0),
    ("particles.aspect_ratio", 18.5),
    ("particles.aspect_ratio_sd_percent", 3.6),
    ("interaction.concentration_per_cm3", 2000.0),
];
const NOISE: f64 = 0.01;
/// Times of each column, evenly up to one period.
const TIMES: usize = 10;
/// Replicas of the curve behind the points.
const TRUTH: u64 = 20_000;

fn points(value: impl Fn(usize) -> f64) -> Vec<Datum> {
    let place = |set| {
        ["x1", "x3"].into_iter().flat_map(move |column| {
            // Half a period of r_e = 18.5 is a strain of 58.
            (0..TIMES).map(move |k| Datum::place(set, column, 116.0 * (k + 1) as f64 / TIMES as f64))
        })
    };
    let places = place(0).chain(place(1)).enumerate();
    let point = |(k, place): (usize, Datum)| Datum { value: value(k), u: NOISE, ..place };
    places.map(point).collect()
}

/// Fig. 4 at 50 and 2000 per cm³ with 20 rods in fifty steps: the model judges itself.
fn scenes(seed: u64, over: &[Range]) -> Result<Scenes, String> {
    let set = |concentration: f64| {
        let settings = [
            "time.periods=1.2".into(),
            "time.steps_per_period=50".into(),
            "time.outputs_per_period=50".into(),
            "particles.count=20".into(),
            format!("interaction.concentration_per_cm3={concentration}"),
        ];
        Set::built_in("fig4-n50", &settings, seed, TimeColumn::Strain)
    };
    Ok(Scenes::new(vec![set(50.0)?, set(2000.0)?], over.to_vec())?)
}

fn planted(range: &Range) -> Result<f64, String> {
    let value = PLANTED.iter().find(|(key, _)| *key == range.key);
    value.map(|(_, value)| *value).ok_or_else(|| format!("{}: no planted value", range.key))
}

/// The noise of the points of one fit, in standard deviations.
fn noise(k: u64, points: usize) -> Vec<f64> {
    let mut rng = Pcg64Dxsm::seed_from_u64(1000 + k);
    (0..points).map(|_| StandardNormal.sample(&mut rng)).collect()
}

/// One fit as `shearbed fit` makes it, or why it is refused.
fn whole_fit(k: u64, truth: &[f64], over: &[Range]) -> Result<Fit, String> {
    let noise = noise(k, truth.len());
    let data = points(|k| truth[k] + NOISE * noise[k]);
    let scenes = scenes(2000 + k, over)?;
    let model = |values: &[f64]| scenes.model(&data, AS_WRITTEN, values).map_err(String::from);
    let problem = FitProblem { data: &data, ranges: over, rods: &Rods::none(2), model: &model, most_replicas: 1000 };
    Ok(best_fit(&problem, &Watch::SILENT)?.0)
}

fn main() -> Result<(), String> {
    let mut args = std::env::args().skip(1);
    let text = args.next().unwrap_or("20".into());
    let (from, to) = text.split_once("..").unwrap_or(("0", &text));
    let number = |text: &str| text.parse::<u64>().map_err(|error| format!("{text}: {error}"));
    let repeats = number(from)?..number(to)?;
    let mut over: Vec<Range> = args.map(|text| Range::parse(&text)).collect::<Result<_, _>>()?;
    if over.is_empty() {
        over.push(Range::parse("interaction.alpha=0.2:3")?);
    }
    for range in &mut over {
        if range.key == "interaction.concentration_per_cm3" {
            range.set = Some(2);
        }
    }
    let behind: Vec<f64> = over.iter().map(planted).collect::<Result<_, _>>()?;
    let model = scenes(1, &over)?.model(&points(|_| f64::NAN), AS_WRITTEN, &behind)?;
    let rows: Vec<_> = (0..TRUTH).into_par_iter().map(|replica| model.run(replica)).collect::<Result<_, _>>()?;
    let truth: Vec<f64> =
        (0..rows[0].len()).map(|k| rows.iter().map(|row| row[k][0]).sum::<f64>() / TRUTH as f64).collect();
    let freedom = (truth.len() - over.len()) as f64;
    let law = ChiSquared::new(freedom).map_err(|error| error.to_string())?;

    let mut inside = vec![[0_u32; 2]; over.len()];
    let (mut answered, mut low_p, mut high_p, mut chi_square) = (0, 0, 0, 0.0);
    // By how much χ² differs from that of the noise alone: due is one less for each parameter: paired, it scatters far
    // less.
    let mut differences: Vec<f64> = Vec::new();
    let mut refused: BTreeMap<String, u32> = BTreeMap::new();
    println!(
        "repeat,chi2,p,replicas,runs,share_of_replicas,share_of_emulator,\
         noise_share,key,estimate,low_68,high_68,low_95,high_95"
    );
    for k in repeats.clone() {
        let fit = match whole_fit(k, &truth, &over) {
            Ok(fit) => fit,
            Err(why) => {
                println!("# {k}: {why}");
                let kind: String = why.chars().filter(|c| !c.is_ascii_digit()).take(90).collect();
                *refused.entry(kind).or_default() += 1;
                continue;
            }
        };
        let chi2 = fit.best.goodness.chi_square_of_points();
        let p = law.sf(chi2);
        differences.push(chi2 - noise(k, truth.len()).iter().map(|noise| noise * noise).sum::<f64>());
        (answered, chi_square) = (answered + 1, chi_square + chi2);
        (low_p, high_p) = (low_p + u32::from(p < 0.05), high_p + u32::from(p > 0.95));
        for (axis, range) in over.iter().enumerate() {
            let ends = [0.68, 0.95].map(|confidence| fit.interval(axis, confidence));
            for (count, ends) in inside[axis].iter_mut().zip(&ends) {
                *count += u32::from((ends.low..=ends.high).contains(&behind[axis]));
            }
            let [inner, outer] = ends;
            println!(
                "{k},{:.2},{p:.3},{},{},{:.3},{:.3},{:.3},{},{:.4},{:.4},{:.4},{:.4},{:.4}",
                chi2,
                fit.emulator.replicas(),
                fit.runs,
                fit.best.share(REPLICAS),
                fit.best.share(EMULATOR),
                fit.noise_share(),
                range.name(),
                fit.values(&fit.best.place)[axis],
                inner.low,
                inner.high,
                outer.low,
                outer.high,
            );
        }
    }
    let share = |count: u32| 100.0 * f64::from(count) / f64::from(answered);
    println!(
        "# answered {answered} of {}; χ² per degree of freedom {:.3}; p below 0.05 in {:.1} %, above 0.95 in {:.1} %",
        repeats.end - repeats.start,
        chi_square / f64::from(answered) / freedom,
        share(low_p),
        share(high_p)
    );
    let Sample { mean, se, .. } = Sample::of(&differences);
    println!("# χ² less that of the drawn noise: {mean:.2} ± {se:.2}, where −{} is due", over.len());
    for (range, [inner, outer]) in over.iter().zip(&inside) {
        println!(
            "# {}: in the 68 % interval {:.1} %, in the 95 % interval {:.1} %",
            range.name(),
            share(*inner),
            share(*outer)
        );
    }
    for (why, count) in refused {
        println!("# {count} refused: {why}");
    }
    Ok(())
}
