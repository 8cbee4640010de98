//! Prints the table of docs/time-step.md that says which steps resolve the motion, as Markdown; with `-- full`, from
//! 2000 replicas in place of 50.

use validation::case::Effort;
use validation::cases::resolution::{change, scene, steps, x1};
use validation::statistics::Sample;

/// GΔt of the reference, and of the steps that are compared with it.
const FINE: f64 = 0.023;
const STRAINS: [f64; 7] = [0.092, 0.184, 0.37, 0.45, 0.55, 0.74, 1.5];

fn main() {
    let full = std::env::args().any(|argument| argument == "full");
    let replicas = if full { 2000 } else { 50 };
    println!(
        "| r_e | σ | n per cm³ | X̄₁ at GΔt = {FINE} | {} |",
        STRAINS.map(|s| format!("{s}")).join(" | ")
    );
    println!("|{}", " --- |".repeat(4 + STRAINS.len()));
    let ratios = [3.96, 11.6, 17.0, 50.0, 100.0].map(|r| (r, 0.0));
    for (r, sd) in ratios.into_iter().chain([(11.6, 30.0)]) {
        for n in [20.0, 50.0, 100.0] {
            let mut scene = scene(&Effort::gate(), r, n);
            scene.particles.aspect_ratio_sd_percent = sd;
            let fine = x1(&scene, steps(r, FINE), replicas);
            let changes = STRAINS.map(|strain| {
                let found = change(&x1(&scene, steps(r, strain), replicas), &fine);
                format!("{:+.4} ± {:.4}", found.mean, found.se)
            });
            let fine = Sample::of(&fine);
            println!(
                "| {r} | {sd} % | {n} | {:.4} ± {:.4} | {} |",
                fine.mean,
                fine.se,
                changes.join(" | ")
            );
        }
    }
}
