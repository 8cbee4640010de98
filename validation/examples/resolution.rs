//! Prints the table of docs/src/theory/time-step.md that says which steps resolve the motion, as Markdown.
//!
//! `cargo run --release -p shearbed-validation --example resolution -- REPLICAS [R_E...]`: 50 replicas, and the aspect
//! ratios of the table, where nothing else is asked for.

use shearbed_validation::cases::resolution::{scene, steps, x1};
use shearbed_validation::judge::case::Effort;
use shearbed_validation::judge::statistics::Sample;

/// GΔt of the reference, and of the steps that are compared with it.
const FINE: f64 = 0.023;
const STRAINS: [f64; 7] = [0.092, 0.184, 0.37, 0.45, 0.55, 0.74, 1.5];

/// r_e and σ in percent.
const RODS: [(f64, f64); 6] = [(3.96, 0.0), (11.6, 0.0), (17.0, 0.0), (50.0, 0.0), (100.0, 0.0), (11.6, 30.0)];

fn main() {
    let numbers = std::env::args().skip(1).map(|word| word.parse::<f64>());
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().expect("numbers: REPLICAS [R_E...]");
    let (replicas, asked) = match numbers.split_first() {
        Some((replicas, asked)) => (*replicas as u64, asked),
        None => (50, &[][..]),
    };
    println!("| r_e | σ | n per cm³ | X̄₁ at GΔt = {FINE} | {} |", STRAINS.map(|s| format!("{s}")).join(" | "));
    println!("|{}", " --- |".repeat(4 + STRAINS.len()));
    let rods = match asked {
        [] => RODS.to_vec(),
        asked => asked.iter().map(|r| (*r, 0.0)).collect(),
    };
    for (r, sd) in rods {
        for n in [20.0, 50.0, 100.0] {
            let mut scene = scene(&Effort::gate(), r, n);
            scene.particles.aspect_ratio_sd_percent = sd;
            let fine = x1(&scene, steps(r, FINE), replicas);
            let changes = STRAINS.map(|strain| {
                let change = Sample::of_differences(&x1(&scene, steps(r, strain), replicas), &fine);
                format!("{:+.4} ± {:.4}", change.mean, change.se)
            });
            let fine = Sample::of(&fine);
            println!("| {r} | {sd} % | {n} | {:.4} ± {:.4} | {} |", fine.mean, fine.se, changes.join(" | "));
        }
    }
}
