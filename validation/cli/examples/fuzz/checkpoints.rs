//! Checkpoints.

use crate::{Taken, Target};
use serde::Serialize;
use serde_json::json;
use shearbed::Plan;
use shearbed::run::ensemble::Tally;
use shearbed::run::resume::Halfway;
use shearbed::run::{Replica, go_on, run_replica};
use shearbed::scene;
use shearbed_validation::files::checkpoint::{Checkpoint, Replicas, without_replicas};
use shearbed_validation::files::output::Refused;
use std::collections::BTreeMap;
use std::fs;
use std::time::Duration;

/// A scene that is soon run.
pub const RODS: &str = r#"title = "rods"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 5
length_mm = 0.72
aspect_ratio = 11.6
orientation = "isotropic"
[interaction]
concentration_per_cm3 = 500
alpha = 0.5
[time]
periods = 0.05
steps_per_period = 200
outputs_per_period = 20
[ensemble]
replicas = 3
"#;

/// As a checkpoint of a run has it.
#[derive(Serialize)]
struct Kept {
    asked: u64,
    tally: Tally,
    done: BTreeMap<u64, Replica>,
    halfway: BTreeMap<u64, Halfway>,
}

/// Checkpoints of a run, half of them with a checksum that is right: what they say is then to be refused, or gone on
/// from.
pub fn checkpoint() -> Target {
    let scene = scene::parse("rods", RODS).expect("it is a scene");
    let plan = Plan::new(&scene).expect("it can be run");
    // The first replicas added up, one that waits for its turn, and one in the middle.
    let kept = |added: u64| {
        let mut tally = Tally::new(&plan);
        (0..added).for_each(|k| tally.add(run_replica(&plan, k).expect("it runs")));
        let mut states = Vec::new();
        let last = go_on(&plan, 2, None, |state| states.push(state())).expect("it runs");
        let middle = states.swap_remove(states.len() / 2);
        let state = Kept {
            asked: plan.scene().ensemble.replicas,
            tally,
            done: (added == 1).then_some((2, last)).into_iter().collect(),
            halfway: (added == 0).then_some((2, middle)).into_iter().collect(),
        };
        let dir = tempfile::tempdir().expect("the harness has a folder");
        let path = dir.path().join("kept");
        let file = Checkpoint::open(&path, "run", json!({ "scene": without_replicas(plan.scene()) }));
        let file = file.map_err(|Refused(why)| why).expect("a new one");
        file.write(&state).expect("the harness writes");
        vec![("kept", fs::read(&path).expect("it was written"))]
    };
    Target {
        name: "checkpoint",
        corpus: vec![kept(0), kept(1), kept(3)],
        take: Box::new(move |folder, files| {
            let path = folder.join("kept");
            let mut bytes = files[0].1.clone();
            let body = bytes.len().saturating_sub(4);
            if bytes.get(body).is_some_and(|byte| byte % 2 == 0) {
                let sum = crc32fast::hash(&bytes[..body]).to_be_bytes();
                bytes.splice(body.., sum);
            }
            fs::write(&path, bytes).map_err(|error| format!("the harness: {error}"))?;
            match Replicas::open(&plan, &path, Duration::from_secs(3600)) {
                // What all say at the end is left out.
                Err(Refused(why)) => Taken::refused_at("kept: ", why.split(';').next().unwrap_or_default().to_owned()),
                Ok(run) => match run.run(1, || (), |_| ()) {
                    Err(error) => Ok(Taken::Refused(error.to_string())),
                    Ok(results) => {
                        let columns = results.series.iter().flat_map(|series| &series.columns);
                        let mut means = columns.flat_map(|column| &column.mean);
                        Taken::if_finite(means.all(|mean| mean.is_finite()), "a mean")
                    }
                },
            }
        }),
    }
}
