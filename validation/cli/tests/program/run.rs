//! A run as a user meets it: what it prints and writes.

use crate::common::{UNEQUAL, names, unequal};

#[test]
fn a_run_lists_its_files() {
    let dir = unequal();
    dir.runs("run small.toml");
    let out = dir.at("out/small");
    let record = dir.json("out/small/run.json");
    let files: Vec<_> = record["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert!(files.iter().all(|name| out.join(name).is_file()));
    // And run.json and shearbed.json.
    assert_eq!(files.len() + 2, names(&out).len());
}

#[test]
fn what_a_run_prints_is_in_its_tables() {
    let dir = unequal();
    let printed = dir.runs("run small.toml").stdout;
    let table = dir.read("out/small/projections.csv");
    let x1: Vec<f64> = (table.lines().skip(1)).map(|line| line.split(',').nth(3).unwrap().parse().unwrap()).collect();
    let line = printed.lines().find(|line| line.starts_with("x1 ")).unwrap();
    let least = x1.iter().copied().fold(f64::INFINITY, f64::min);
    for number in [x1[0], x1[4], least] {
        assert!(line.contains(&format!("{number:.4}")), "{number} in {line}");
    }
    // Five outputs: the one with the least mean is a quarter of a period in.
    assert!(line.contains(&format!("{least:.4} at 0.25")), "{line}");
    let record = dir.json("out/small/run.json");
    assert_eq!(record["facts"]["regime"], "dilute");
}

#[test]
fn the_scene_in_run_json_gives_the_same_bits() {
    let dir = unequal();
    dir.runs("run small.toml --replicas 4 --seed 7 --threads 2 --out a");
    let record = dir.json("a/run.json");
    assert_eq!((&record["seed"], &record["threads"]), (&7.into(), &2.into()));
    let scene: shearbed::Scene = serde_json::from_value(record["scene"].clone()).unwrap();
    let plan = shearbed::Plan::new(&scene).unwrap();
    assert_eq!(record["plan_text"], plan.to_string());
    let results = shearbed::run::ensemble::run(&plan).unwrap();
    assert_eq!(record["counters"]["collisions"], results.counters.collisions);
    // Every number of the tables reads back as the same bits.
    for series in &results.series {
        let file = dir.path().join(format!("a/{}.csv", series.observable.name()));
        let mut reader = csv::Reader::from_path(file).unwrap();
        for (k, row) in reader.deserialize::<Vec<f64>>().enumerate() {
            let channels = series.columns.iter().flat_map(|channel| [channel.mean[k], channel.se[k]]);
            let time = results.times[k];
            // T = 2π(r_e + 1/r_e)/G.
            let period_s = 2.0 * std::f64::consts::TAU * (11.6 + 1.0 / 11.6);
            let times = [time, time * period_s, time * period_s * 0.5];
            let expected: Vec<_> = times.into_iter().chain(channels).collect();
            assert_eq!(row.unwrap(), expected, "{} {k}", series.observable.name());
        }
    }
}

/// What is put in place of what in [`UNEQUAL`], one extreme a scene.
#[rustfmt::skip]
const EXTREMES: &[&[(&str, &str)]] = &[
    &[("= 0.5\n[particles]", "= 1e-30\n[particles]")],
    &[("= 0.5\n[particles]", "= 1e30\n[particles]")],
    &[("= 11.6", "= 1e8"), ("= 3.6", "= 33.3")],
    &[("= 11.6", "= 1.000000000001"), ("= 3.6", "= 0")],
    &[("= 11.6", "= 1.2"), ("= 3.6", "= 5.555")],
    &[("count = 20", "count = 1")],
    &[("count = 20", "count = 2"), ("alpha = 0.5", "alpha = 1e300")],
    &[("= 50", "= 1e30"), ("alpha = 0.5", "alpha = 1e3")],
    &[("= 50", "= 1e-30"), ("alpha = 0.5", "alpha = 1e3")],
    &[("alpha = 0.5", "alpha = 0")],
    &[("alpha = 0.5", "alpha = 1e300\nupdate = \"angles\"")],
    &[("alpha = 0.5", "alpha = 0.5\nm = 0.1")],
    &[("alpha = 0.5", "alpha = 1e3\nm = 50")],
    &[("alpha = 0.5", "alpha = 1e3\nmin_contact_arm = 2.2250738585072014e-308")],
    &[("\"isotropic\"", "{ phi_deg = 0, theta_deg = 180 }"), ("alpha = 0.5", "alpha = 1e3")],
    &[("\"isotropic\"", "{ phi_deg = 0, theta_deg = 1e-300 }"), ("alpha = 0.5", "alpha = 1e3\nupdate = \"angles\"")],
    &[("steps_per_period = 200", "steps_per_period = 1"), ("outputs_per_period = 4", "outputs_per_period = 1")],
    &[("periods = 1", "periods = 1e-5"), ("steps_per_period = 200", "steps_per_period = 10000000"),
      ("outputs_per_period = 4", "outputs_per_period = 100000")],
    &[("shear_rate_per_s = 0.5", "gradient_per_s = [[1e30, 0, 0], [0, -1e30, 0], [0, 0, 0]]"), ("= 11.6", "= 1e8"),
      ("\"orbit_constant\", ", ""),
      ("[interaction]\nconcentration_per_cm3 = 50\nalpha = 0.5\n", ""),
      ("periods = 1\nsteps_per_period = 200\noutputs_per_period = 4", "strain = 1e4\noutputs_per_strain = 1")],
];

#[test]
fn extreme_scenes_end_well_with_finite_tables() {
    let dir = unequal();
    for (k, changes) in EXTREMES.iter().enumerate() {
        let text = (changes.iter()).fold(UNEQUAL.clone(), |text, (old, new)| {
            assert!(text.contains(old), "{old}");
            text.replace(old, new)
        });
        dir.write("extreme.toml", text);
        let ended = dir.runs(&format!("run extreme.toml --threads 1 --quiet --out {k}"));
        let known = [
            "warning: extreme.toml: time.steps_per_period ",
            "warning: extreme.toml: interaction has no effect: one rod has no neighbour",
            "warning: extreme.toml: particles.aspect_ratio = 1",
            "warning: extreme.toml: interaction.concentration_per_cm3 and particles.length_mm give n a³ = ",
        ];
        assert!(
            (ended.stderr.lines()).all(|line| known.iter().any(|start| line.starts_with(start))),
            "{changes:?}: {}",
            ended.stderr
        );
        for name in names(&dir.path().join(k.to_string())) {
            if name.ends_with(".csv") {
                let mut reader = csv::Reader::from_path(dir.path().join(format!("{k}/{name}"))).unwrap();
                let rows: Vec<Vec<f64>> = reader.deserialize().map(Result::unwrap).collect();
                assert!(rows.iter().flatten().all(|value| value.is_finite()), "{name}: {changes:?}");
            }
        }
    }
}
