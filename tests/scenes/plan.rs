//! Plans, printed; and that no stage, where it is left out, would have changed a bit of the results.

use crate::{changed, parsed, planned, refusal, run, run_plan};
use shearbed::plan::Stage;
use shearbed::scene::{Flow, MAX_REPLICAS, OwnRods, RodsFile, resolved_strain};
use shearbed::{Observable, Plan, Results};

const FREE: &str = r#"
title = "rods in plane Couette flow"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 150
length_mm = 0.72
aspect_ratio = 11.6
orientation = "isotropic"
[time]
periods = 2
"#;

const ALPHA_0: &str = "[interaction]\nconcentration_per_cm3 = 50\nalpha = 0\n";
const INTERACTING: &str = "[interaction]\nconcentration_per_cm3 = 50\nalpha = 0.5\n[ensemble]\nreplicas = 3\n";
const ALL_OBSERVABLES: &str = r#"
[output]
observables = ["orbit_constant", "projections", "orientation_tensor", "mean_angle", "cos_2phi", "planar_projections",
    "orientation_tensor_4", "particle_stress"]
"#;

const EXTENSION: &str = r#"
title = "planar extension"
[flow]
gradient_per_s = [[1, 0, 0], [0, -1, 0], [0, 0, 0]]
[particles]
count = 1
length_mm = 1
aspect_ratio = 0.5
orientation = { phi_deg = 10, theta_deg = 90 }
[time]
strain = 4
"#;

fn plan(text: &str) -> Plan {
    planned(&parsed(text))
}

#[test]
fn plans_say_what_is_kept_and_dropped() {
    let unequal = FREE
        .replace("= 11.6", "= 11.6\naspect_ratio_sd_percent = 3.6")
        .replace("\"isotropic\"", "{ phi_deg = 0, theta_deg = 45 }");
    let interacting = format!("{FREE}{INTERACTING}");
    for (name, text) in [
        ("a_free_scene_takes_no_steps", FREE),
        ("rods_of_many_aspect_ratios_at_given_angles", &(unequal + ALL_OBSERVABLES)),
        ("an_interacting_scene_needs_every_stage", &interacting),
        ("rods_that_cannot_collide_are_free", &format!("{FREE}{ALPHA_0}")),
        ("one_rod_is_free", &interacting.replace("count = 150", "count = 1")),
        ("extension_counts_strain", EXTENSION),
        ("a_coarse_step_is_warned_of_and_a_finer_one_is_not", &turning(50.0, "steps_per_period = 200")),
    ] {
        insta::assert_snapshot!(name, plan(text));
    }
}

/// The channels of `part`, found in `whole` with the same bits.
fn assert_same_bits(part: &Results, whole: &Results, what: &str) {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&part.times), bits(&whole.times), "{what}");
    for channel in part.series.iter().flat_map(|series| &series.columns) {
        let other = whole.column(&channel.name).expect("the whole has every channel of the part");
        assert_eq!(bits(&channel.mean), bits(&other.mean), "{what}: {}", channel.name);
        assert_eq!(bits(&channel.se), bits(&other.se), "{what}: standard errors of {}", channel.name);
    }
}

fn stages() -> impl Iterator<Item = Stage> {
    [
        Stage::AspectRatios,
        Stage::Orientations,
        Stage::Positions,
        Stage::Translation,
        Stage::Neighbours,
        Stage::CollisionDraws,
        Stage::Contacts,
        Stage::RodErrors,
    ]
    .into_iter()
    .chain(Observable::ALL.map(Stage::Observe))
}

#[test]
fn keeping_a_stage_that_is_left_out_changes_no_bit() {
    let polydisperse = "= 11.6\naspect_ratio_sd_percent = 3.6";
    for sizes in ["= 11.6", polydisperse] {
        for orientation in ["\"isotropic\"", "{ phi_deg = 20, theta_deg = 60 }"] {
            for replicas in [1, 3] {
                let text = format!("{FREE}{ALPHA_0}[ensemble]\nreplicas = {replicas}\n")
                    .replace("= 11.6", sizes)
                    .replace("\"isotropic\"", orientation);
                let plan = plan(&text);
                let without = run_plan(&plan);
                for stage in stages().filter(|stage| !plan.runs(*stage)) {
                    let with = plan.with_stage(stage).expect("the scene has a control volume");
                    assert!(with.runs(stage));
                    assert_same_bits(&without, &run_plan(&with), &format!("{stage} in {text}"));
                }
            }
        }
    }
}

#[test]
fn a_stage_kept_by_request_does_run() {
    let plan = plan(&format!("{FREE}{ALPHA_0}"));
    let counters = |stage| run_plan(&plan.with_stage(stage).unwrap()).counters;
    assert_eq!(run_plan(&plan).counters.steps, 0);
    assert_eq!(counters(Stage::Translation).steps, 400);
    assert!(counters(Stage::Translation).replacements > 0);
    assert_eq!(counters(Stage::CollisionDraws).draws, 400 * 150);
    assert_eq!(counters(Stage::Contacts).collisions, 0);
}

#[test]
fn a_stage_without_what_it_works_on_cannot_be_kept() {
    assert!(plan(FREE).with_stage(Stage::Neighbours).is_none());
    assert!(plan(EXTENSION).with_stage(Stage::Positions).is_none());
    assert!(plan(FREE).with_stage(Stage::Observe(Observable::MeanAngle)).is_some());
}

#[test]
fn leaving_out_an_observable_changes_no_bit_of_the_others() {
    for interaction in [ALPHA_0, INTERACTING] {
        let mut all = parsed(&format!("{FREE}{interaction}"));
        all.liquid.viscosity_pa_s = Some(2.0);
        all.output.observables = Observable::ALL.to_vec();
        let whole = run(&all);
        for left_out in Observable::ALL {
            let mut fewer = all.clone();
            fewer.output.observables.retain(|observable| *observable != left_out);
            let part = run(&fewer);
            assert_eq!(part.series.len(), Observable::ALL.len() - 1);
            assert_same_bits(&part, &whole, left_out.name());
        }
    }
}

#[test]
fn writing_the_defaults_out_changes_nothing() {
    for text in [FREE, &format!("{FREE}{INTERACTING}"), EXTENSION] {
        let (given, resolved) = (plan(text), planned(&parsed(text).resolved()));
        assert_eq!(resolved.to_string(), given.to_string());
        assert_same_bits(&run_plan(&given), &run_plan(&resolved), text);
    }
}

/// An interacting scene of one period with an aspect ratio and more lines in `[time]`.
fn turning(aspect_ratio: f64, time: &str) -> String {
    let text = FREE.replace("= 11.6", &format!("= {aspect_ratio:e}"));
    text.replace("periods = 2", &format!("periods = 1\n{time}")) + INTERACTING
}

#[test]
fn steps_resolve_the_motion_by_default() {
    // 2π(r_e + 1/r_e) over 0.37, 0.37, 4.4/17, 0.09 and 0.09 is 71.5, 198.5, 414.1, 3492.1 and 6982.0.
    // Over 0.4, in even divisors of the steps: 66.2, 183.6, 267.9, 785.7 and at most 1000 outputs at the least.
    for (r, steps, outputs) in
        [(3.96, 100, 100), (11.6, 200, 200), (17.0, 450, 450), (50.0, 3500, 1750), (100.0, 7000, 1000)]
    {
        let plan = plan(&turning(r, ""));
        assert_eq!((plan.steps(), plan.outputs()), (steps, outputs + 1), "{r}");
        assert_eq!(plan.scene().resolved().time.steps_per_unit, Some(steps));
        assert_eq!(plan.warnings().len(), usize::from(r < 10.0), "{r}");
    }
    // Outputs that are given fall on steps.
    for (r, outputs, steps) in [(50.0, 4, 3500), (50.0, 8, 3600), (11.6, 40, 200), (11.6, 7, 350), (11.6, 1000, 1000)] {
        let plan = plan(&turning(r, &format!("outputs_per_period = {outputs}")));
        assert_eq!((plan.steps(), plan.outputs()), (steps, outputs + 1), "{r} {outputs}");
    }
}

#[test]
fn the_default_is_the_fewest_steps_that_will_do() {
    for k in 1..3900 {
        let r = 1.0 + (0.003 * f64::from(k)).exp_m1();
        let scene = parsed(&turning(r, ""));
        let (steps, strain) = (scene.steps_per_unit(), scene.motion_per_step());
        assert!(strain <= resolved_strain(r) && steps.is_multiple_of(50), "{r}");
        let fewer = strain * steps as f64 / (steps - 50) as f64;
        assert!(steps == 50 || fewer > resolved_strain(r), "{r}");
    }
}

#[test]
fn doubtful_results_trigger_a_warning() {
    let steps = |steps: u64| turning(11.6, &format!("steps_per_period = {steps}\noutputs_per_period = 1"));
    let free = |text: String| text.replace("alpha = 0.5", "alpha = 0");
    let none = |text: String| (text, String::new());
    let stepless = turning(20.0, "steps_per_period = 100\n");
    let mut rows = vec![
        // Free rods take no steps.
        none(free(turning(50.0, "steps_per_period = 200"))),
        (
            stepless.split("[interaction]").next().unwrap().to_owned(),
            "time.steps_per_period has no effect: free rods take no steps".to_owned(),
        ),
        (
            turning(20.0, "").replace("count = 150", "count = 1"),
            "interaction has no effect: one rod has no neighbour".to_owned(),
        ),
    ];
    // 73.424/198 = 0.3708 and 73.424/199 = 0.36897.
    rows.extend([1, 198].map(|k| (steps(k), format!("time.steps_per_period = {k} does not resolve the motion"))));
    rows.extend([199, 10_000].map(|k| none(steps(k))));
    let of = |r: f64, output: &str| FREE.replace("= 11.6", &format!("= {r:?}")) + output;
    let stress = "[output]\nobservables = [\"particle_stress\"]\n";
    for (r, slender) in [(0.5, false), (3.0, false), (29.9, false), (30.0, true), (1e3, true)] {
        let said = format!("particles.aspect_ratio = {r}: particle_stress is the limit of slender rods");
        rows.extend([none(of(r, "")), (of(r, stress), if slender { String::new() } else { said })]);
    }
    for (r, thin) in [(1.01, false), (9.99, false), (10.0, true), (11.6, true)] {
        let said = format!("particles.aspect_ratio = {r}: the collision rule is for slender rods, r_e ≫ 1.");
        rows.extend([none(free(turning(r, ""))), (turning(r, ""), if thin { String::new() } else { said })]);
    }
    for (text, said) in rows {
        let plan = plan(&text);
        let warnings = plan.warnings();
        assert_eq!(warnings.len(), usize::from(!said.is_empty()), "{text}\n{warnings:?}");
        assert!(warnings.iter().all(|warning| warning.starts_with(&said)), "{said}\n{warnings:?}");
        assert_eq!(plan.to_string().contains(&format!("\nwarning: {said}")), !said.is_empty());
    }
}

#[test]
fn long_rods_need_more_steps_than_there_may_be_and_say_what_to_set() {
    assert_eq!(
        refusal(&turning(1e6, "")),
        "dir/s.toml:10: time.steps_per_period is missing: at aspect_ratio = 1000000 some 7.0e7 steps a period resolve \
         the motion (GΔt ≤ 0.09), and at most 10000000 are allowed; set steps_per_period to take fewer, which do not \
         resolve it, or a smaller aspect_ratio"
    );
    assert!(refusal(&turning(1e100, "")).contains("some 7.0e101 steps a period"));
    let set = plan(&turning(1e6, "steps_per_period = 10000"));
    assert_eq!(set.warnings().len(), 1);
    // The limit of all steps counts the default too.
    let long = turning(1e5, "").replace("periods = 1", "periods = 1000");
    let refusal = refusal(&long);
    assert!(
        refusal.contains("at most 1e9 steps in all, not 6.98") && refusal.contains("6981350 a period by default"),
        "{refusal}"
    );
}

#[test]
fn a_stage_that_is_kept_brings_what_it_needs() {
    let all = [Stage::Positions, Stage::Translation, Stage::Neighbours, Stage::CollisionDraws, Stage::Contacts];
    let plan = plan(&format!("{FREE}{ALPHA_0}"));
    assert!(!all.iter().any(|stage| plan.runs(*stage)));
    for (stage, brought) in all.into_iter().zip([1, 2, 3, 3, 5]) {
        let with = plan.with_stage(stage).unwrap();
        assert!(with.runs(stage), "{stage}");
        let kept = all.iter().filter(|other| with.runs(**other)).count();
        assert_eq!(kept, brought, "{stage}");
        // Who moves with the liquid has a place.
        assert!(with.runs(Stage::Positions), "{stage}");
    }
}

#[test]
fn the_error_of_free_rods_is_known_and_small_but_where_the_form_is_closed() {
    assert_eq!(plan(FREE).error_rad(), None);
    let error = plan(EXTENSION).error_rad().unwrap();
    // Some roundings to double.
    assert!(error > 0.0 && error < 16.0 * f64::EPSILON, "{error}");
    let unit = plan(EXTENSION).elapsed(1.0);
    // 2 D:D = 4 in this flow.
    assert!((unit.seconds - 0.5).abs() < 2.0 * f64::EPSILON && unit.strain == 1.0, "{unit:?}");
}

/// Shear is shear, whichever axes it has: a general flow's period in seconds and strain.
#[test]
fn the_unit_of_a_period_is_the_same_in_any_axes() {
    let straight = plan(FREE);
    let mut turned = straight.scene().clone();
    let shear_rate_per_s = turned.flow.shear_rate_per_s().unwrap();
    turned.flow = Flow::Gradient { gradient_per_s: [[0.0; 3], [0.0; 3], [0.0, shear_rate_per_s, 0.0]] };
    let (unit, of_turned) = (straight.elapsed(1.0), planned(&turned).elapsed(1.0));
    assert!((of_turned.seconds / unit.seconds - 1.0).abs() < 1e-14, "{of_turned:?}");
    assert!((of_turned.strain / unit.strain - 1.0).abs() < 1e-14, "{of_turned:?}");
}

/// A flow so slow that one period is a number of seconds, and many are not.
#[test]
fn a_duration_is_a_number_of_seconds() {
    let of = |periods: f64| {
        Plan::new(&changed(|scene| {
            scene.flow = Flow::Shear { shear_rate_per_s: 1e-304 };
            (scene.time.duration, scene.time.outputs_per_unit) = (periods, Some(1));
        }))
    };
    assert!(of(1.0).is_ok());
    let refused = of(1e5).unwrap_err().to_string();
    assert!(refused.contains("finite number of seconds"), "{refused}");
}

#[test]
fn a_control_volume_has_a_side() {
    for (length_mm, concentration_per_cm3) in [(1e100, 1e100), (1e-100, 1e-100)] {
        let mut scene = parsed(&format!("{FREE}{ALPHA_0}"));
        scene.particles.length_mm = length_mm;
        let interaction = scene.interaction.as_mut().unwrap();
        interaction.concentration_per_cm3 = Some(concentration_per_cm3);
        let refused = Plan::new(&scene).unwrap_err();
        assert!(refused.to_string().starts_with("interaction.concentration_per_cm3 = "), "{refused}");
    }
}

/// The plan of another number of replicas is that of a scene that asks for it.
#[test]
fn a_plan_of_another_number_of_replicas_is_that_of_such_a_scene() {
    for (from, to) in [(1, 40), (40, 1), (3, 5)] {
        let of = |replicas: u64| planned(&changed(|scene| scene.ensemble.replicas = replicas));
        let (changed, expected) = (of(from).with_replicas(to), of(to));
        assert_eq!((changed.scene(), changed.entries()), (expected.scene(), expected.entries()));
    }
    assert_eq!(plan(FREE).with_replicas(0).scene().ensemble.replicas, 1);
    assert_eq!(plan(FREE).with_replicas(u64::MAX).scene().ensemble.replicas, MAX_REPLICAS);
}

#[test]
fn replicas_that_share_the_directions_of_a_file_are_warned_of() {
    let p = Some([1.0, 0.0, 0.0].map(|component| vec![component; 150]));
    let own = OwnRods { p, ..OwnRods::default() };
    let sizes = OwnRods { aspect_ratio: Some(vec![11.6; 150]), ..OwnRods::default() };
    let both = OwnRods { aspect_ratio: sizes.aspect_ratio.clone(), ..own.clone() };
    let collide = [FREE, INTERACTING].concat();
    let (scatter, alike) = ("leave out the scatter of these rods", "the 3 replicas are alike");
    for (text, own, replicas, sd_percent, said) in [
        (&collide[..], &own, 3, 0.0, [true, false]),
        (FREE, &own, 3, 5.0, [true, false]),
        (FREE, &own, 3, 0.0, [false, true]),
        (FREE, &both, 3, 5.0, [false, true]),
        (FREE, &sizes, 3, 0.0, [false; 2]),
        (FREE, &own, 1, 0.0, [false; 2]),
        (&collide, &own, 1, 0.0, [false; 2]),
    ] {
        let mut scene = parsed(text);
        scene.particles.rods = Some(RodsFile::with("rods.csv", own.clone()));
        scene.particles.aspect_ratio_sd_percent = sd_percent;
        scene.ensemble.replicas = replicas;
        let warnings = planned(&scene).warnings().join("; ");
        assert_eq!([scatter, alike].map(|words| warnings.contains(words)), said, "{warnings}");
        assert!(!warnings.contains("1 replicas"), "{warnings}");
    }
}
