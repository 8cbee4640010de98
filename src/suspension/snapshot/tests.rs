//! Tests that rods read from a checkpoint or another rank are refused unless they fit the plan.

use super::*;
use crate::scene::{Interaction, Scene};

fn plan(interaction: Option<Interaction>, count: usize) -> Plan {
    let mut scene = Scene { interaction, ..Scene::default() };
    scene.particles.count = count;
    scene.time.outputs_per_unit = Some(4);
    scene.output.rods_at = vec![0.5, 1.0];
    Plan::new(&scene).unwrap()
}

type Damage = fn(&mut Snapshot);

#[test]
fn rods_that_are_not_the_plan_s_are_refused() {
    let damages: [(&str, Damage); 10] = [
        ("a direction less", |s| _ = s.p[1].pop()),
        ("a direction that is no number", |s| s.p[2][3] = f64::NAN),
        ("an aspect ratio less", |s| _ = s.aspect_ratio.pop()),
        ("an aspect ratio that is infinite", |s| {
            s.aspect_ratio[0] = f64::INFINITY;
        }),
        ("a collision less", |s| _ = s.collided.pop()),
        ("a collision more", |s| s.collided.push(false)),
        ("an output that is not asked for", |s| s.output = 1),
        ("a replica that is not asked for", |s| s.replica = 1),
        ("a place less, or places of free rods", |s| match &mut s.place_in_lengths {
            Some(places) => _ = places[0].pop(),
            None => s.place_in_lengths = Some([(); 3].map(|()| vec![0.0; 20])),
        }),
        ("a place that is no number, or none of free rods", |s| match &mut s.place_in_lengths {
            Some(places) => places[2][7] = f64::NAN,
            None => s.place_in_lengths = Some(Default::default()),
        }),
    ];
    for interaction in [None, Some(Interaction::default())] {
        let plan = plan(interaction.clone(), 20);
        let whole = crate::run::run_replica(&plan, 0).unwrap().snapshots;
        assert!(Snapshot::all_fit(&whole, 2, &plan));
        assert!(!Snapshot::all_fit(&whole, 3, &plan) && !Snapshot::all_fit(&whole[..1], 2, &plan));
        for (what, damage) in &damages {
            let mut damaged = whole.clone();
            damage(&mut damaged[1]);
            assert!(!Snapshot::all_fit(&damaged, 2, &plan), "{what}");
        }
        let mut without = whole.clone();
        without[0].place_in_lengths = None;
        assert_eq!(Snapshot::all_fit(&without, 2, &plan), interaction.is_none());
    }
}

#[test]
fn a_rod_that_meets_none_has_no_place() {
    let alone = plan(Some(Interaction::default()), 1);
    // Neither plan has positions in its snapshots, even if the stage of positions is asked for by the caller.
    for plan in [&alone, &alone.with_stage(Stage::Positions).unwrap()] {
        let whole = crate::run::run_replica(plan, 0).unwrap().snapshots;
        assert_eq!(whole[0].place_in_lengths, None);
        assert!(Snapshot::all_fit(&whole, 2, plan));
    }
}
