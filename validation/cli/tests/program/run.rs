//! The record of a run.

use crate::common::{UNEQUAL, empty_folder};

#[test]
fn the_scene_in_run_json_gives_the_same_bits() {
    let dir = empty_folder();
    dir.write("unequal.toml", UNEQUAL.as_str());
    dir.runs("run unequal.toml --replicas 4 --seed 7 --threads 2 --out a");
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
