//! `shearbed fit --design`, and fits of rods that start as a file says.

use super::points;
use crate::common::{folder, shearbed};
use serde_json::Value;
use std::fs;

#[test]
fn a_design_lists_what_each_further_point_would_leave() {
    let dir = folder();
    points(&dir);
    let fit = "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 60 --out own";
    let done = dir.runs(&format!("{fit} --design"));
    assert!(done.stdout.contains("best next point: x1 at t_over_T = "), "{}", done.stdout);
    let record = dir.json("own/fit.json");
    let steps = record["design"].as_array().unwrap();
    let u = |step: &Value| step["u"][0].as_f64().unwrap();
    // One standard deviation of the likelihood, near that of the linear theory.
    let now = u(&steps[0]);
    let linear = record["parameters"]["interaction.alpha"]["standard_uncertainty"].as_f64().unwrap();
    assert!((now / linear - 1.0).abs() < 0.2, "{now} {linear}");
    let mut csv = csv::Reader::from_path(dir.at("own/design.csv")).unwrap();
    let head = csv.headers().unwrap().clone();
    let (mut best, mut concentrations, mut rows) = ((f64::INFINITY, 0.0), Vec::new(), 0);
    let mut spreads = Vec::new();
    for row in csv.records() {
        let row = row.unwrap();
        let cell = |name: &str| &row[head.iter().position(|own| own == name).unwrap()];
        let number = |name: &str| cell(name).parse::<f64>().unwrap();
        let (left, spread) = (number("u_alpha_with_it"), number("spread"));
        // Never more than before, and never less than by a point that follows α alone.
        let least = now * (1.0 - spread.powi(2) / (spread.powi(2) + number("u").powi(2))).sqrt();
        assert!(left <= now && left >= least * (1.0 - 1e-9), "{row:?} {now} {least}");
        if left < best.0 {
            best = (left, number("time"));
        }
        concentrations.push(cell("concentration_per_cm3").to_owned());
        spreads.push(spread);
        rows += 1;
    }
    assert_eq!(rows, 3 * 300);
    // What collisions do is the more uncertain the more there are.
    let of_third = |k: usize| spreads[300 * k..300 * (k + 1)].iter().sum::<f64>();
    assert!(of_third(0) < of_third(1) && of_third(1) < of_third(2));
    concentrations.dedup();
    assert_eq!(concentrations, ["25", "50", "100"]);
    assert_eq!(steps.len(), 1 + 3 + 6);
    // Sets count from 1 in every file, as in `--over 1:KEY`.
    assert_eq!((&steps[1]["added"]["set"], &steps[4]["added"]["set"]), (&1.into(), &1.into()));
    assert_eq!(record["residuals"][0]["set"], 1);
    assert_eq!((u(&steps[4]), steps[4]["added"]["time"].as_f64().unwrap()), best);
    // Points that are means over as many rods as the scene has scatter as its replicas do, more at some times than at
    // others.
    dir.runs(&format!("{} --design --rods 20", fit.replace("out own", "out rods")));
    let mut csv = csv::Reader::from_path(dir.at("rods/design.csv")).unwrap();
    let of_rods: Vec<f64> = csv.records().map(|row| row.unwrap()[5].parse().unwrap()).collect();
    let ends = of_rods.iter().fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), u| (a.min(*u), b.max(*u)));
    assert!(ends.1 > 1.5 * ends.0 && ends.0 > 0.01, "{ends:?}");
    // The same fit without a list of points takes it away.
    dir.runs(fit);
    assert!(!dir.at("own/design.csv").exists());
}

#[test]
fn rods_that_start_as_a_file_says_are_fitted() {
    let dir = folder();
    let scene = dir.read("small.toml");
    let count: usize = 20;
    assert!(scene.contains("orientation = \"isotropic\""), "{scene}");
    let scene = scene.replace("orientation = \"isotropic\"", "rods = { file = \"start.csv\" }");
    dir.write("small.toml", &scene);
    let mut rows = "p1,p2,p3\n".to_owned();
    for k in 0..count {
        // Evenly over the sphere, by the golden angle.
        let (z, angle) = (1.0 - (2 * k + 1) as f64 / count as f64, 2.399_963 * k as f64);
        let r = (1.0 - z * z).sqrt();
        rows += &format!("{},{},{z}\n", r * angle.cos(), r * angle.sin());
    }
    dir.write("start.csv", &rows);
    points(&dir);
    // The file is beside the scene, wherever the program is started.
    fs::create_dir(dir.at("scenes")).unwrap();
    for name in ["small.toml", "start.csv"] {
        fs::rename(dir.path().join(name), dir.at("scenes").join(name)).unwrap();
    }
    let fit = "fit scenes/small.toml --data points.csv --over interaction.alpha=0.1:5 --replicas 60";
    dir.runs(&format!("{fit} --out own"));
    let record = dir.json("own/fit.json");
    let alpha = &record["parameters"]["interaction.alpha"];
    let number = |key: &str| alpha[key].as_f64().unwrap();
    // Correct code is outside four standard uncertainties at one seed in 16 000.
    assert!((number("estimate") - 0.8).abs() < 4.0 * number("standard_uncertainty"), "{alpha}");
    // Twice the rods would need twice the rows.
    assert_eq!(record["shifts"].as_array().unwrap().len(), 1);

    // Another file of starts is another fit.
    dir.write("scenes/start.csv", rows.replace("p1,p2,p3", "p2,p1,p3"));
    let other = shearbed(dir.path(), &format!("{fit} --out own"));
    assert_eq!(other.code, Some(2));
    assert!(other.stderr.contains("start"), "{}", other.stderr);
    // A file that is not as the scene needs it, with what is wrong.
    dir.write("scenes/start.csv", rows.lines().take(count).collect::<Vec<_>>().join("\n"));
    dir.refuses(&format!("{fit} --out other"), "has 19 rows");
    assert!(!dir.at("other").exists());
}
