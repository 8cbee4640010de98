//! Writes the certified answers of problems to standard output: a table is the same on every machine. `unequal-rods`
//! takes minutes.
//!
//!     cargo run --release -p shearbed-validation --example certify -- folgar-tucker >
//!     validation/src/serve/problems/data/folgar-tucker.csv

use shearbed_validation::oracle::reference::big::digits;
use shearbed_validation::oracle::reference::unequal::means_to_22_digits;
use shearbed_validation::serve::problems::{self, TABLES};

fn main() {
    let name = std::env::args().nth(1).unwrap_or_default();
    let contact = |name: &str| problems::certify_contacts().into_iter().find(|(of, _)| *of == name);
    let table = match TABLES.iter().find(|(of, _)| *of == name) {
        Some((_, certify)) => certify(),
        None if name == "unequal-rods" => Ok(unequal_rods()),
        None => contact(&name).map(|(_, table)| table).ok_or_else(|| {
            "brownian, closed, contact-angles, contact-rule, folgar-tucker, formulas or unequal-rods is allowed".into()
        }),
    };
    match table {
        Ok(table) => print!("{table}"),
        Err(why) => {
            eprintln!("{why}");
            std::process::exit(1);
        }
    }
}

fn unequal_rods() -> String {
    let problem = &problems::named("unequal-rods").expect("it is there").problem;
    let end_s = problem.times_s.last().copied().unwrap_or_default();
    let mut table = problem.columns.join(",") + "\n";
    for time_s in &problem.times_s {
        // The last time is 3 T: steps of T/(10·2π t) or less.
        let halvings = (20.0 * std::f64::consts::PI * 3.0 * time_s / end_s).log2().ceil() as i32;
        let rate = problem.gradient_per_s[1][0];
        let (r, sd_percent) = (problem.aspect_ratio, problem.aspect_ratio_sd_percent);
        let means = means_to_22_digits(rate, r, sd_percent, *time_s, halvings);
        let finer = means_to_22_digits(rate, r, sd_percent, *time_s, halvings + 1);
        let [means, finer] = [means, finer].map(|means| means.map(|x| digits(&x, 22)));
        assert_eq!(means, finer, "the rule has converged");
        table += &format!("{time_s:?},{}\n", means.join(","));
    }
    table
}
