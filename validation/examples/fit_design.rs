//! What a curve like Fig. 4's says of α and m, and which times and concentrations say most, as Markdown tables:
//! `cargo run --release -p shearbed-suite --example fit_design -- 100` with 100 replicas at each value of the parameters.

use nalgebra::{Matrix2, Vector2};
use validation::fit::Range;
use validation::fit::basis::Basis;
use validation::fit::data::{Datum, TimeColumn};
use validation::fit::emulator::{Emulator, coefficients};
use validation::fit::scenes::{AS_WRITTEN, Scenes, Set};
use validation::scenes;
use validation::sweep::Setting;

const NOISE: f64 = 0.01;
const POINTS: usize = 22;
const NAMES: [&str; 3] = ["fig4-n20", "fig4-n50", "fig4-n100"];
/// Of a table of the best points.
const CHOSEN: usize = 6;

/// A point that could be measured, and by how much X̄₁ there changes with α and m, over its noise.
struct Candidate {
    scene: &'static str,
    time: f64,
    slope: Vector2<f64>,
}

fn candidates(replicas: u64) -> Result<Vec<Candidate>, String> {
    let ranges = vec![
        Range::parse("interaction.alpha=0.35:0.65")?,
        Range::parse("interaction.m=2.4:3.6")?,
    ];
    let place = |set: usize| {
        move |k: usize| Datum {
            set,
            line: 0,
            column: "x1".into(),
            time: 2.0 * (k + 1) as f64 / POINTS as f64,
            value: f64::NAN,
            u_time: 0.0,
            u: NOISE,
        }
    };
    let places: Vec<Datum> = (0..NAMES.len())
        .flat_map(|set| (0..POINTS).map(place(set)))
        .collect();
    let set = |name: &&'static str| {
        Ok(Set {
            source: (*name).into(),
            text: scenes::find(name).ok_or("no scene")?.text.into(),
            settings: vec![Setting::parse("time.steps_per_period=100")?],
            seed: 1,
            time: TimeColumn::Periods,
        })
    };
    let sets: Vec<Set> = NAMES.iter().map(set).collect::<Result<_, String>>()?;
    let scenes = Scenes::new(sets, ranges.clone())?;
    let model = |values: &[f64]| scenes.model(&places, AS_WRITTEN, values);
    let basis = Basis::new(2);
    let half = |range: &Range| 0.5 * (range.to - range.from);
    let value = |node: &[f64]| {
        (ranges.iter().zip(node))
            .map(|(range, u)| range.from + half(range) * (1.0 + u))
            .collect()
    };
    let emulator = Emulator::new(&basis, &coefficients(&basis, &model, value, 0..replicas, &|| ())?);
    let slopes = emulator.slopes(&[0.0, 0.0]);
    let candidate = |(k, datum): (usize, &Datum)| Candidate {
        scene: NAMES[datum.set],
        time: datum.time,
        slope: Vector2::new(
            slopes[(k, 0)] / half(&ranges[0]),
            slopes[(k, 1)] / half(&ranges[1]),
        ) / NOISE,
    };
    Ok(places.iter().enumerate().map(candidate).collect())
}

fn information<'a>(of: impl IntoIterator<Item = &'a Candidate>) -> Matrix2<f64> {
    of.into_iter()
        .map(|candidate| candidate.slope * candidate.slope.transpose())
        .sum()
}

/// Standard uncertainties of α alone, α and m together, and their correlation.
fn row(name: &str, information: &Matrix2<f64>) -> String {
    let alone = information[(0, 0)].sqrt().recip();
    match information.try_inverse() {
        None => format!("| {name} | {alone:.4} | – | – | – |"),
        Some(covariance) => {
            let (a, m) = (covariance[(0, 0)].sqrt(), covariance[(1, 1)].sqrt());
            format!(
                "| {name} | {alone:.4} | {a:.3} | {m:.2} | {:.4} |",
                covariance[(0, 1)] / (a * m)
            )
        }
    }
}

fn main() -> Result<(), String> {
    let replicas: u64 = std::env::args()
        .nth(1)
        .map_or(Ok(100), |text| text.parse())
        .map_err(|error| format!("{error}"))?;
    let all = candidates(replicas)?;
    println!("| points | u(α), m known | u(α) | u(m) | correlation |\n| --- | ---: | ---: | ---: | ---: |");
    for name in NAMES {
        let own = all.iter().filter(|candidate| candidate.scene == name);
        println!(
            "{}",
            row(&format!("22 of {name}, t/T up to 2"), &information(own))
        );
    }
    println!("{}", row("66, all three", &information(&all)));
    println!("\n| added | u(α), m known | u(α) | u(m) | correlation |\n| --- | ---: | ---: | ---: | ---: |");
    // Each next point is the one that makes the determinant of the information largest; a little prior for the first.
    let mut chosen = Matrix2::identity() * 1e-9;
    for _ in 0..CHOSEN {
        let gain =
            |candidate: &&Candidate| (chosen + candidate.slope * candidate.slope.transpose()).determinant();
        let best = all
            .iter()
            .max_by(|a, b| gain(a).total_cmp(&gain(b)))
            .ok_or("no candidates")?;
        chosen += best.slope * best.slope.transpose();
        println!(
            "{}",
            row(&format!("{}, t/T = {:.2}", best.scene, best.time), &chosen)
        );
    }
    Ok(())
}
