//! A replica that was stopped and gone on from gives the bits of one that was not.

use crate::{any_gradient, parsed, planned};
use serde_json::{Value, json};
use shearbed::run::ensemble::Tally;
use shearbed::run::resume::Halfway;
use shearbed::run::{Replica, go_on, run_replica};
use shearbed::{Error, Plan};

/// A plan of `count` rods, with tables and keys put in.
fn plan(count: usize, flow: &str, interaction: &str, time: &str, replicas: u64) -> Plan {
    let text = format!(
        "title = \"t\"\n[flow]\n{flow}\n[particles]\ncount = {count}\nlength_mm = 0.72\naspect_ratio = 11.6\n\
         aspect_ratio_sd_percent = 3.6\norientation = \"isotropic\"\n{interaction}\n[time]\n{time}\n\
         [ensemble]\nreplicas = {replicas}\nseed = 5\n[output]\nobservables = [\"projections\", \
         \"orientation_tensor\"]\n"
    );
    planned(&parsed(&text))
}

const COUETTE: &str = "gradient_per_s = [[0,0,0],[-0.5,0,0],[0,0,0]]";
const STEPS: &str = "periods = 0.5\nsteps_per_period = 100\noutputs_per_period = 10";
const DENSE: &str = "[interaction]\nconcentration_per_cm3 = 500\nalpha = 0.5";
const ANGLES: &str = "[interaction]\nconcentration_per_cm3 = 500\nalpha = 0.5\nupdate = \"angles\"";

type Spoil = fn(&mut Value);

/// The same with every rod at some times.
fn with_rods(plan: Plan, rods_at: Vec<f64>) -> Plan {
    let mut scene = plan.scene().clone();
    scene.output.rods_at = rods_at;
    planned(&scene)
}

/// The time of free rods.
const FREE: &str = "periods = 3\noutputs_per_period = 50";

/// Scenes that keep something different each, and how often they are looked at in one replica.
fn scenes() -> Vec<(Plan, usize)> {
    let general = format!("gradient_per_s = {}", any_gradient::GENERAL);
    let mut sized = crate::sizes::scene("length_mm = 0.72\nlength_sd_percent = 30", "box_mm = [12, 5, 5]");
    (sized.output.rods_at, sized.ensemble.replicas) = (vec![0.0, 0.2], 3);
    let mut diffusing = crate::diffusion::scene(0.1);
    diffusing.particles.count = 70_000;
    let mut scenes = vec![
        (plan(40, COUETTE, DENSE, STEPS, 3), 50),
        (plan(40, COUETTE, ANGLES, STEPS, 3), 50),
        // Standard errors over rods.
        (plan(40, COUETTE, DENSE, STEPS, 1), 50),
        // The search by cells, and numbers that are drawn by chunks.
        (plan(700, COUETTE, DENSE, STEPS, 3), 50),
        (plan(70_000, COUETTE, DENSE, "periods = 0.03\noutputs_per_period = 100\nsteps_per_period = 200", 3), 6),
        // Every rod at some outputs.
        (with_rods(plan(40, COUETTE, DENSE, STEPS, 3), vec![0.1, 0.3, 0.5]), 50),
        (with_rods(plan(40, COUETTE, "", FREE, 3), vec![0.0, 2.0]), 3),
        // Free rods, more outputs than are made at once.
        (plan(40, COUETTE, "", FREE, 3), 3),
        (
            plan(40, "gradient_per_s = [[0.5,0,0],[0,-0.5,0],[0.1,0,0]]", "", "strain = 8\noutputs_per_strain = 20", 3),
            3,
        ),
        // Steps by maps, unequal lengths in a box, and steps of diffusion.
        (plan(100, &general, DENSE, "strain = 2\nsteps_per_strain = 10", 3), 20),
        (planned(&sized), 40),
        (planned(&diffusing), 11),
    ];
    // Outputs at times that the scene gives.
    for mut scene in crate::times::every_motion() {
        scene.time.steps_per_unit = scene.interaction.as_ref().map(|_| 50);
        scene.output.times = vec![0.2, 0.3, 0.7];
        scenes.push((planned(&scene), if scene.interaction.is_some() { 35 } else { 1 }));
    }
    scenes
}

/// The states at all looks of a replica, and its end.
fn watched(plan: &Plan, from: Option<Halfway>) -> (Vec<Halfway>, Replica) {
    let mut states = Vec::new();
    let end = go_on(plan, 2, from, |state| states.push(state())).unwrap();
    (states, end)
}

#[test]
fn a_replica_goes_on_bit_for_bit_from_wherever_it_was() {
    for (plan, looks) in scenes() {
        let alone = run_replica(&plan, 2).unwrap();
        let (states, end) = watched(&plan, None);
        assert_eq!((states.len(), &end), (looks, &alone), "{plan}");
        assert_eq!(alone.counters.collisions > 0, plan.scene().interaction.is_some(), "{plan}");
        for (k, state) in states.iter().enumerate().filter(|(k, _)| k % 7 == 0 || k + 2 > looks) {
            assert_eq!(state.check(&plan), Ok(()), "{plan}");
            let (rest, end) = watched(&plan, Some(state.clone()));
            assert_eq!(end, alone, "{plan} from look {k}");
            assert_eq!(rest, states[k + 1..], "{plan} from look {k}");
        }
    }
}

#[test]
fn what_is_of_no_replica_of_the_plan_is_refused() {
    let plans = [plan(40, COUETTE, DENSE, STEPS, 3), plan(40, COUETTE, "", FREE, 3)];
    let [interacting, free] = plans.each_ref().map(|plan| {
        let (states, _) = watched(plan, None);
        serde_json::to_value(&states[states.len() / 2]).unwrap()
    });
    let refused = |plan: &Plan, state: Value| {
        let state: Halfway = serde_json::from_value(state).unwrap();
        let cause = state.check(plan).unwrap_err();
        let error = go_on(plan, 2, Some(state), |_| ()).unwrap_err();
        assert_eq!(error, Error::Misfit { replica: 2, cause });
        cause
    };
    assert!(refused(&plans[1], interacting.clone()).contains("has saved rods"));
    let mut without = interacting.clone();
    without["rods"] = Value::Null;
    assert!(refused(&plans[0], without).contains("has saved rods"));
    assert!(refused(&plans[0], free).contains("sums"));
    // Three replicas: none keeps standard errors over its rods.
    let spread = json!({ "rods": 40, "first": 0.5, "differences": 0.0, "squares": 0.0 });
    let mut with_errors = interacting.clone();
    with_errors["sums"][0]["spread"] = spread;
    assert!(refused(&plans[0], with_errors).contains("sums"));
    let spoilt: [(&str, Spoil); 13] = [
        ("sums", |s| drop(s["sums"].as_array_mut().unwrap().pop())),
        ("sums", |s| s["sums"] = json!(vec![json!({ "value": 0.0, "spread": null }); 10_000])),
        ("outputs", |s| s["rods"]["counters"]["steps"] = json!(5)),
        ("outputs", |s| s["rods"]["counters"]["steps"] = json!(u64::MAX)),
        ("numbers", |s| s["rods"]["counters"]["draws"] = json!(7)),
        ("numbers", |s| s["rods"]["counters"]["replacements"] = json!(u64::MAX)),
        ("number of rods", |s| drop(s["rods"]["since"].as_array_mut().unwrap().pop())),
        ("number of rods", |s| drop(s["rods"]["positions"][1].as_array_mut().unwrap().pop())),
        ("number of rods", |s| s["rods"]["directions"][2] = json!([])),
        ("length is not 1", |s| s["rods"]["directions"][2][7] = json!(2.0)),
        ("collision", |s| s["rods"]["since"][3] = json!(49)),
        ("control volume", |s| s["rods"]["positions"][0][3] = json!(-1e-3)),
        ("control volume", |s| s["rods"]["positions"][2][3] = json!(1e300)),
    ];
    for (word, spoil) in spoilt {
        let mut state = interacting.clone();
        spoil(&mut state);
        let cause = refused(&plans[0], state);
        assert!(cause.contains(word), "{word}: {cause}");
    }
}

#[test]
fn replicas_and_tallies_of_other_scenes_are_refused() {
    let plan = plan(40, COUETTE, DENSE, STEPS, 3);
    let shorter: Spoil = |sums| drop(sums.as_array_mut().unwrap().pop());

    // The sums of a single replica say over how many rods they are.
    let of_three: [(&str, Spoil); 3] =
        [("sums", shorter), ("rods", |rods| *rods = json!(41)), ("observables", |all| *all = json!(["projections"]))];
    let of_one: [(&str, Spoil); 2] =
        [("sums", |sums| sums[7]["spread"]["rods"] = json!(41)), ("sums", |sums| sums[7]["spread"] = Value::Null)];
    let one = self::plan(40, COUETTE, "", "periods = 3", 1);
    for (plan, spoilt) in [(&plan, &of_three[..]), (&one, &of_one[..])] {
        let replica = run_replica(plan, 0).unwrap();
        assert_eq!(replica.check(plan), Ok(()));
        for (key, spoil) in spoilt {
            let mut other = serde_json::to_value(&replica).unwrap();
            spoil(&mut other[key]);
            let other: Replica = serde_json::from_value(other).unwrap();
            assert_eq!(other.check(plan), Err("its sums are not those of this scene"), "{key}");
        }
    }

    let mut tally = Tally::new(&plan);
    (0..3).for_each(|k| tally.add(run_replica(&plan, k).unwrap()));
    assert_eq!(tally.check(&plan), Ok(()));
    let lengths = "its means are not those of this scene";
    let spoilt: [(&str, Spoil, &str); 6] = [
        ("mean", shorter, lengths),
        ("deviation", shorter, lengths),
        ("over_rods", shorter, lengths),
        ("groups", shorter, lengths),
        ("replicas", |replicas| *replicas = json!(4), lengths),
        ("deviation", |all| all[3] = json!(-1.0), "it has a mean that is not finite, or a negative deviation"),
    ];
    for (key, spoil, cause) in spoilt {
        let mut other = serde_json::to_value(&tally).unwrap();
        // What the scene has no use for is NaN, which JSON does not hold.
        other["over_rods"] = json!(vec![0.0; other["mean"].as_array().unwrap().len()]);
        spoil(&mut other[key]);
        let other: Tally = serde_json::from_value(other).unwrap();
        assert_eq!(other.check(&plan), Err(cause), "{key}");
    }
}

/// A replica of a plan of one, whole or halfway, is one of a plan of several where it has dropped the errors over its
/// rods.
#[test]
fn a_single_replica_becomes_the_first_of_several() {
    for (one, _) in scenes() {
        let (one, several) = (one.with_replicas(1), one.with_replicas(3));
        let [(states, mut whole), (others, other)] = [&one, &several].map(|plan| watched(plan, None));
        assert!(whole.check(&several).is_err());
        whole.drop_rod_errors();
        assert_eq!(whole.check(&several), Ok(()));
        assert_eq!(whole, other);
        for (mut state, other) in states.into_iter().zip(others) {
            state.drop_rod_errors();
            assert_eq!(state.check(&several), Ok(()));
            assert_eq!(state, other);
        }
    }
}
