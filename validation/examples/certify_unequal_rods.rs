//! Writes the certified answer of the problem `unequal-rods`, `src/problems/data/unequal-rods.csv`, to standard output: it
//! takes minutes, and a table is the same on every machine.
//!
//!     cargo run --release -p shearbed --example certify_unequal_rods > unequal-rods.csv

use validation::oracle::reference::big::digits;
use validation::oracle::reference::unequal::means_to_22_digits;
use validation::serve::problems;

fn main() {
    let problem = &problems::named("unequal-rods").expect("it is there").problem;
    let end_s = problem.times_s.last().copied().unwrap_or_default();
    println!("{}", problem.columns.join(","));
    for time_s in &problem.times_s {
        // The last time is 3 T: steps of T/(10·2π t) or less.
        let halvings = (20.0 * std::f64::consts::PI * 3.0 * time_s / end_s).log2().ceil() as i32;
        let rate = problem.gradient_per_s[1][0];
        let (r, sd_percent) = (problem.aspect_ratio, problem.aspect_ratio_sd_percent);
        let means = means_to_22_digits(rate, r, sd_percent, *time_s, halvings);
        let finer = means_to_22_digits(rate, r, sd_percent, *time_s, halvings + 1);
        let [means, finer] = [means, finer].map(|means| means.map(|x| digits(&x, 22)));
        assert_eq!(means, finer, "the rule has converged");
        println!("{time_s:?},{}", means.join(","));
    }
}
