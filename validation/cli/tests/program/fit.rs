//! `shearbed fit` as a user meets it: synthetic points, files, refusals. No point here is measured.

mod contents;
mod design;
mod several;

use crate::common::{FREE, Folder, folder};
use serde_json::Value;
use shearbed_validation::oracle::closed_form::{angles_at, period_s};
use std::fs;

/// The mean curve of `small.toml` with this key, another seed than the fit's, with noise of 0.01 that is fixed: each
/// point is off by a Gaussian quantile, in an order without a pattern.
fn points_of(dir: &Folder, set: &str, file: &str) {
    let more = "--set time.outputs_per_period=20 --seed 7 --replicas 400 --quiet";
    dir.runs(&format!("run small.toml --set {set} {more} --out truth-{file}"));
    let mut csv = csv::Reader::from_path(dir.at(&format!("truth-{file}/projections.csv"))).unwrap();
    let quantiles =
        [-1.6, -1.1, -0.8, -0.6, -0.5, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.5, 0.6, 0.8, 1.1, 1.6, 0.0, 0.4, -0.4, 0.7];
    let mut text = "t_over_T,x1,x1_u\n".to_owned();
    for (k, row) in csv.records().skip(1).enumerate() {
        let row = row.unwrap();
        let x1: f64 = row[3].parse().unwrap();
        text += &format!("{},{},0.01\n", &row[0], x1 + 0.01 * quantiles[(7 * k + 3) % quantiles.len()]);
    }
    dir.write(file, text);
}

fn points(dir: &Folder) {
    points_of(dir, "interaction.alpha=0.8", "points.csv");
}

#[test]
fn the_planted_alpha_is_found_and_everything_is_written() {
    let dir = folder();
    points(&dir);
    let fit = "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 100";
    let done = dir.runs(&format!("{fit} --out one --threads 1"));
    let first = done.stdout.lines().next().unwrap();
    assert!(
        first.starts_with("alpha = ") && first.contains(", 95 % from ") && first.contains("for 19 degrees of freedom"),
        "{first}"
    );

    let record = dir.json("one/fit.json");
    let alpha = &record["parameters"]["interaction.alpha"];
    let number = |key: &str| alpha[key].as_f64().unwrap();
    let (estimate, u) = (number("estimate"), number("standard_uncertainty"));
    // Correct code is outside four standard uncertainties at one seed in 16 000.
    assert!((estimate - 0.8).abs() < 4.0 * u, "{estimate} ± {u}");
    let rising = ["low_95", "low_68", "estimate", "high_68", "high_95"].map(number);
    assert!(rising.windows(2).all(|pair| pair[0] < pair[1]), "{rising:?}");
    assert!(rising[0] > 0.05 && rising[4] < 5.0, "{rising:?}");
    assert_eq!(record["degrees_of_freedom"], 19);
    assert!(record["chi2"].as_f64().unwrap() > 0.0);
    assert!((0.0..=1.0).contains(&record["p_value"].as_f64().unwrap()));
    assert_eq!(record["residuals"].as_array().unwrap().len(), 20);
    let squares = |rows: &[&Value]| rows.iter().map(|row| row["u"][0].as_f64().unwrap().powi(2)).sum::<f64>();
    let (all, parts) = record["budget"].as_array().unwrap().split_last().unwrap();
    assert!((squares(&[all]) / squares(&parts.iter().collect::<Vec<_>>()) - 1.0).abs() < 1e-9);
    assert!((squares(&[all]).sqrt() / u - 1.0).abs() < 1e-9);
    let shifts = record["shifts"].as_array().unwrap();
    let named: Vec<_> = shifts.iter().map(|shift| shift["change"].as_str().unwrap()).collect();
    assert_eq!(named, ["half the time step", "twice the rods"]);

    let written = dir.files("one");
    let names: Vec<_> = written.keys().map(String::as_str).collect();
    let tables = "profiles.csv residuals.csv residuals.svg shearbed.json";
    assert_eq!(names.join(" "), format!("figures.json fit.json points.svg profile_alpha.svg {tables}"));
    // Letters and units, error bars with caps, and what is drawn about the zero of the residuals.
    let [points, zero] = ["one/points.svg", "one/residuals.svg"].map(|name| dir.read(name));
    for text in ["X̄₁, best fit", "X̄₁, measured ± u", ">\nt/T\n<", "95 % band"] {
        assert!(points.contains(text), "{text}");
    }
    assert!(!points.contains("t_over_T") && zero.contains("X̄₁, best fit") && zero.contains("95 % band"));
    // The same pictures from the folder, in every format.
    for (name, starts) in [("again.svg", &b"<svg"[..]), ("fit.png", b"\x89PNG"), ("fit.pdf", b"%PDF-")] {
        dir.runs(&format!("plot one --y points --out {name}"));
        assert!(fs::read(dir.path().join(name)).unwrap().starts_with(starts), "{name}");
    }
    assert_eq!(dir.read("again.svg"), points);
    dir.refuses("plot one --y nothing --out no.svg", "there are points, residuals, profile_alpha");
    assert_eq!(dir.read("one/residuals.csv").lines().count(), 21);

    // The same bits on another number of threads.
    dir.runs(&format!("{fit} --out two --threads 2"));
    let mut two = dir.files("two");
    let mut one = written;
    for name in ["fit.json", "shearbed.json"] {
        one.remove(name);
        two.remove(name);
    }
    assert_eq!(one, two);
    let other = dir.json("two/fit.json");
    assert_eq!(other["parameters"], record["parameters"]);
}

#[test]
fn what_the_points_do_not_say_is_warned_of() {
    let dir = folder();
    points(&dir);
    let done = dir.runs("fit small.toml --data points.csv --over interaction.alpha=0.05:0.3 --replicas 50 --out out");
    assert!(
        done.stderr.contains("interaction.alpha: its 95 % interval reaches the upper end of its range, 0.3"),
        "{}",
        done.stderr
    );
    let record = dir.json("out/fit.json");
    assert_eq!(record["parameters"]["interaction.alpha"]["high_95"], 0.3);
    assert!(record["warnings"].to_string().contains("upper end"));
}

/// Projections hardly depend on how much lengths differ (docs/src/theory/index.md): the fit says so, and finds α beside
/// it.
#[test]
fn a_spread_of_lengths_is_fitted_and_found_to_be_untold() {
    let dir = folder();
    points_of(&dir, "particles.length_sd_percent=20", "points.csv");
    // Fifty replicas would be too few for the covariance of these points.
    let fit = "fit small.toml --data points.csv --replicas 200 --over interaction.alpha=0.1:2";
    let done = dir.runs(&format!("{fit} --over particles.length_sd_percent=10:30 --out both"));
    assert!(
        done.stderr.contains(
            "particles.length_sd_percent: its 95 % interval is its whole range, 10 to 30: the points say nothing of \
                it there"
        ),
        "{}",
        done.stderr
    );
    assert!(!done.stderr.contains("interaction.alpha: its"), "{}", done.stderr);
    let alpha = &dir.json("both/fit.json")["parameters"]["interaction.alpha"];
    let bound = |name: &str| alpha[name].as_f64().unwrap();
    assert!(bound("low_95") < 0.5 && 0.5 < bound("high_95"), "{alpha}");
}

#[test]
fn two_sets_share_their_parameters() {
    let dir = folder();
    points(&dir);
    points_of(&dir, "interaction.alpha=0.9", "others.csv");
    let args = "fit small.toml --data points.csv --data small.toml=others.csv --over interaction.alpha=0.2:2 \
        --replicas 50 --out both";
    dir.runs(args);
    let record = dir.json("both/fit.json");
    assert_eq!(record["degrees_of_freedom"], 39);
    assert_eq!(record["data"].as_array().unwrap().len(), 2);
    assert!(dir.at("both/points_2.svg").is_file());
}

/// χ² above its least at a value of a parameter, between the places of its profile.
fn rise_at(profiles: &str, parameter: &str, value: f64) -> f64 {
    let own = profiles.lines().filter_map(|line| line.strip_prefix(&format!("{parameter},")));
    let places: Vec<(f64, f64)> = own
        .map(|line| {
            let mut fields = line.split(',').map(|field| field.parse().unwrap());
            (fields.next().unwrap(), fields.next().unwrap())
        })
        .collect();
    let at = places.windows(2).find(|pair| (pair[0].0..=pair[1].0).contains(&value)).expect(profiles);
    at[0].1 + (at[1].1 - at[0].1) * (value - at[0].0) / (at[1].0 - at[0].0)
}

#[test]
fn two_sets_have_values_of_their_own() {
    let dir = folder();
    points(&dir);
    points_of(&dir, "interaction.alpha=2.4", "more.csv");
    let args = "fit small.toml --data points.csv --data small.toml=more.csv --over 1:interaction.alpha=0.4:1.4 \
                --over 2:interaction.alpha=1.2:4.8 --replicas 20 --out own --test \
                1:interaction.alpha=2:interaction.alpha \
                --test 1:interaction.alpha=0.8";
    let done = dir.runs(args);
    assert!(done.stdout.starts_with("alpha_1 = ") && done.stdout.contains("; alpha_2 = "), "{}", done.stdout);
    let record = dir.json("own/fit.json");
    assert_eq!(record["degrees_of_freedom"], 38);
    for (key, planted) in [("1:interaction.alpha", 0.8), ("2:interaction.alpha", 2.4)] {
        // Correct code has χ² 16 above its least there at one seed in 16 000. (α = 2.4 is known badly upwards: no
        // Gaussian.)
        let rise = rise_at(&dir.read("own/profiles.csv"), key, planted);
        assert!(rise < 16.0, "{key}: {rise}, {}", record["parameters"][key]);
    }
    // Each set tells its own value, and the points of one say nothing of the other.
    let apart = record["parameters"]["2:interaction.alpha"]["low_95"].as_f64();
    assert!(apart > record["parameters"]["1:interaction.alpha"]["high_95"].as_f64(), "{record:#}");
    // That both have one value is rejected, that the first has its own is not (at p = 6e-5: χ² 16 above its least).
    let p_value = |k: usize| record["tests"][k]["p_value"].as_f64().unwrap();
    assert!(p_value(0) < 1e-3 && p_value(1) > 6e-5, "{}", record["tests"]);
    let difference = &record["tests"][0]["difference"];
    assert!(difference["high_95"].as_f64() < Some(0.0), "{difference}");
    assert!(done.stdout.contains("\n1:interaction.alpha=2:interaction.alpha: χ² rises by "), "{}", done.stdout);
    assert!(done.stdout.contains("\n    difference -"), "{}", done.stdout);
    for file in ["profile_alpha_1.svg", "profile_alpha_2.svg", "points_2.svg", "region_alpha_1_alpha_2.svg"] {
        assert!(dir.at("own").join(file).is_file(), "{file}");
    }
}

/// All rods at once pass p_1 = 0, where |p_1| has a kink. Exact points: A.4 of r_e = 1.1.
#[test]
fn rods_that_start_alike_are_fitted_through_the_kinks_of_their_projections() {
    let dir = folder();
    let start = "{ phi_deg = 20, theta_deg = 60 }";
    let alike = FREE.replace("= 20\n", "= 1\n").replace("= 3\n", "= 1.1\n").replace("\"isotropic\"", start);
    dir.write("alike.toml", alike.replace("periods = 1", "periods = 4"));
    let mut text = "t_s,x1,x1_u\n".to_owned();
    for k in 0..41 {
        let time_s = 48.979 / 40.0 * f64::from(k);
        let turns = time_s / period_s(0.5, 1.1);
        let (phi, theta) = angles_at(20f64.to_radians(), 60f64.to_radians(), 1.1, turns);
        text += &format!("{time_s},{},0.001\n", (theta.sin() * phi.cos()).abs());
    }
    dir.write("exact.csv", text);
    dir.runs("fit alike.toml --data exact.csv --over particles.aspect_ratio=1.05:1.2 --out out --quiet");
    let record = dir.json("out/fit.json");
    let estimate = record["parameters"]["particles.aspect_ratio"]["estimate"].as_f64();
    assert!((estimate.unwrap() - 1.1).abs() < 3e-4, "{record:#}");
    // A tenth of the points' uncertainty at most: χ² below 40/100.
    assert!(record["chi2"].as_f64().unwrap() < 0.4, "{record:#}");
}
