//! What a fit says where its points tell less than is asked of them.

use super::points_of;
use crate::common::{folder, shearbed};

/// Twenty synthetic points of `fig4-n50` with α = 0.8 and m = 3, noise 0.01 (400 replicas of seed 7). A fit whose inner
/// minima stayed in one valley answered here with low_68 = low_95 = 0.057 for α, inside its range, and m = 6.
#[test]
fn two_parameters_have_intervals_that_end_apart_or_no_answer() {
    let dir = folder();
    let values = [
        0.11383, 0.03341, 0.05129, 0.10746, 0.36955, 0.11839, 0.0717, 0.06302, 0.16152, 0.28924, 0.16126, 0.07255,
        0.06969, 0.16231, 0.23793, 0.16313, 0.09786, 0.09364, 0.15912, 0.24259,
    ];
    let mut text = "t_over_T,x1,x1_u\n".to_owned();
    for (k, value) in values.iter().enumerate() {
        text += &format!("{},{value},0.01\n", (k + 1) as f64 / 10.0);
    }
    dir.write("twenty.csv", text);
    let done = shearbed(
        dir.path(),
        "fit fig4-n50 --data twenty.csv --over interaction.alpha=0.05:5 --over interaction.m=1:6 --set \
         particles.count=50 --out out --quiet",
    );
    if done.code == Some(2) {
        assert!(done.stderr.contains("--over "), "{}", done.stderr);
        assert!(!dir.at("out").exists());
        return;
    }
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let record = dir.json("out/fit.json");
    for (key, planted) in [("interaction.alpha", 0.8), ("interaction.m", 3.0)] {
        let found = &record["parameters"][key];
        let number = |key: &str| found[key].as_f64().unwrap();
        assert!(number("low_95") < planted && planted < number("high_95"), "{found}");
        let edge = |k: usize| found["ends_at_edge"][k].as_bool().unwrap();
        assert!(edge(0) || number("low_95") < number("low_68"), "{found}");
        assert!(edge(1) || number("high_68") < number("high_95"), "{found}");
    }
}

/// Points of rods of one r_e, fitted by rods whose r_e scatters: they dephase without a collision, so that α comes out
/// small.
#[test]
fn a_spread_that_is_taken_as_known_is_said_where_it_counts() {
    let dir = folder();
    points_of(&dir, "interaction.alpha=0.8", "points.csv");
    let fit = "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 100";
    let spread = "--set particles.aspect_ratio_sd_percent=";
    let done = dir.runs(&format!("{fit} {spread}3.6 --out one"));
    assert!(
        done.stderr.contains("interaction.alpha: with rods of one r_e it would be about")
            && done.stderr.contains("larger"),
        "{}",
        done.stderr
    );
    let record = dir.json("one/fit.json");
    assert_eq!(record["shifts"][2]["change"], "rods of one r_e");
    // The control: nothing to be said of.
    let done = dir.runs(&format!("{fit} {spread}0 --out none"));
    assert!(!done.stderr.contains("one r_e"), "{}", done.stderr);
}
