//! Rods of unequal length, and control volumes with three sides.

use crate::{parsed, planned, run};
use shearbed::plan::Stage;
use shearbed::scene::{OwnRods, RodsFile};
use shearbed::{Results, Scene, Suspension};

fn text(length: &str, interaction: &str) -> String {
    format!(
        "title = \"t\"\n[flow]\nshear_rate_per_s = 0.5\n[particles]\ncount = 300\n{length}\naspect_ratio = 11.6\n\
         orientation = \"isotropic\"\n[interaction]\n{interaction}\nalpha = 0.5\n[time]\nperiods = 0.2\n\
         steps_per_period = 200\noutputs_per_period = 10\n[output]\nobservables = [\"projections\", \
         \"particle_stress\"]\n"
    )
}

pub(crate) fn scene(length: &str, interaction: &str) -> Scene {
    parsed(&text(length, interaction))
}

fn suspension(scene: &Scene) -> Suspension {
    Suspension::new(&planned(scene), 0).unwrap()
}

/// The means of every column: of a stress of unequal lengths one replica has no standard error.
fn means(results: &Results) -> Vec<&[f64]> {
    results.series.iter().flat_map(|series| &series.columns).map(|column| &column.mean[..]).collect()
}

const DENSE: &str = "concentration_per_cm3 = 1000";

/// Twice the size in twice the box is the same suspension, to the bit: nothing but ratios of lengths counts.
#[test]
fn the_unit_of_length_does_not_count() {
    let (short, long) = ("length_mm = 0.5\nlength_sd_percent = 30", "length_mm = 1.0\nlength_sd_percent = 30");
    for (of_short, of_long) in [("box_mm = [8, 4, 2]", "box_mm = [16, 8, 4]"), (DENSE, "concentration_per_cm3 = 125")] {
        let [short, long] = [scene(short, of_short), scene(long, of_long)].map(|scene| run(&scene));
        assert!(short.counters.collisions > 100, "{:?}", short.counters);
        assert_eq!(means(&short), means(&long), "{of_short}");
    }
}

#[test]
fn a_box_of_equal_sides_is_the_cube() {
    // 300 rods at 1000 per cm³ fill 0.3 cm³.
    let side = 300f64.cbrt();
    let sides = |interaction: &str| suspension(&scene("length_mm = 0.72", interaction)).sides_in_lengths();
    let given = format!("box_mm = [{side}, {side}, {side}]");
    for (own, cube) in sides(&given).into_iter().zip(sides(DENSE)) {
        assert!((own / cube - 1.0).abs() < 4.0 * f64::EPSILON, "{own} {cube}");
    }
    // Both, where they agree.
    sides(&format!("{DENSE}\nbox_mm = [12, 5, 5]"));
}

#[test]
fn lengths_have_the_spread_that_is_asked_for_and_move_no_other_draw() {
    let mut unequal = scene("length_mm = 0.72\nlength_sd_percent = 30", DENSE);
    unequal.particles.count = 40_000;
    let mut equal = unequal.clone();
    equal.particles.length_sd_percent = 0.0;
    let [equal, unequal] = [equal, unequal].map(|scene| suspension(&scene));
    assert_eq!(equal.lengths(), vec![1.0; 40_000]);
    assert_eq!(equal.directions(), unequal.directions());
    assert_eq!(equal.positions_in_lengths(), unequal.positions_in_lengths());
    let lengths = unequal.lengths();
    let mean = |power: i32| lengths.iter().map(|length| length.powi(power)).sum::<f64>() / 40_000.0;
    // Five standard errors: 0.3/200, and of the variance 0.09 √(2/40 000).
    assert!((mean(1) - 1.0).abs() < 0.0075, "{}", mean(1));
    assert!((mean(2) - mean(1).powi(2) - 0.09).abs() < 0.0032, "{}", mean(2));
    assert!(lengths.iter().all(|length| *length > 0.0));
}

#[test]
fn the_plan_leaves_the_lengths_of_free_rods_out() {
    let mut free = scene("length_mm = 0.72\nlength_sd_percent = 30", DENSE);
    free.interaction = None;
    free.time.steps_per_unit = None;
    let kept = |scene: &Scene| planned(scene).runs(Stage::Lengths);
    assert!(kept(&free), "for the stress");
    free.output.observables.pop();
    assert!(!kept(&free));
    let mut equal = free.clone();
    equal.particles.length_sd_percent = 0.0;
    assert_eq!(run(&free).series, run(&equal).series);
    free.output.rods_at = vec![0.0];
    assert!(kept(&free), "for rods.csv");
    let lengths = run(&free).snapshots[0].length.clone().unwrap();
    assert!(lengths.len() == 300 && lengths.iter().all(|length| *length > 0.0));
}

/// A rod's stress is proportional to its cubed length, over the mean of these.
#[test]
fn the_stress_of_two_rods_by_hand() {
    let mut scene = scene("length_mm = 0.72\nlength_sd_percent = 30", DENSE);
    scene.particles.count = 2;
    scene.output.rods_at = vec![0.2];
    let results = run(&scene);
    let rods = &results.snapshots[0];
    let cubes: Vec<f64> = rods.length.iter().flatten().map(|length| length.powi(3)).collect();
    assert!((cubes[0] / cubes[1] - 1.0).abs() > 0.1, "{cubes:?}");
    let [p1, p2, _] = &rods.p;
    let stress = |rod: usize| cubes[rod] * (p1[rod] * p2[rod]).powi(2);
    let expected = (stress(0) + stress(1)) / (cubes[0] + cubes[1]);
    let found = *results.column("s12_per_mu_fiber_g").unwrap().mean.last().unwrap();
    assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
}

/// Rods given one by one as they would have been drawn are the same suspension, to the bit.
#[test]
fn rods_of_a_file_are_those_that_it_has() {
    let mut drawn =
        scene("length_mm = 1\nlength_sd_percent = 30\naspect_ratio_sd_percent = 8.5", "concentration_per_cm3 = 400");
    let suspension = suspension(&drawn);
    let directions = suspension.directions();
    let whole = OwnRods {
        p: Some([0, 1, 2].map(|axis| directions.iter().map(|p| p[axis]).collect())),
        aspect_ratio: Some(suspension.aspect_ratios()),
        length_mm: Some(suspension.lengths()),
        // Places in mm are those in lengths.
        place_mm: Some(suspension.positions_in_lengths().clone()),
    };
    let expected = run(&drawn);
    assert!(expected.counters.collisions > 50, "{:?}", expected.counters);
    let of_a_file = |own: OwnRods| {
        let mut scene = drawn.clone();
        scene.particles.rods = Some(RodsFile::with("rods.csv", own));
        run(&scene)
    };
    // Directions of a suspension have been through the motion of no time, which rounds: a collision magnifies that.
    for (found, expected) in of_a_file(whole.clone()).series[0].columns.iter().zip(&expected.series[0].columns) {
        assert!(found.mean.iter().zip(&expected.mean).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    }
    // What it lacks is drawn.
    let whole = OwnRods { p: None, ..whole };
    let parts = [
        whole.clone(),
        OwnRods { aspect_ratio: None, ..whole.clone() },
        OwnRods { length_mm: None, ..whole.clone() },
        OwnRods { place_mm: None, ..whole.clone() },
        OwnRods::default(),
    ];
    for part in parts {
        assert_eq!(means(&of_a_file(part)), means(&expected));
    }
    // What it has is taken.
    let longer = whole.length_mm.clone().unwrap().iter().map(|length| 1.1 * length).collect();
    let other = OwnRods { length_mm: Some(longer), ..whole };
    assert_ne!(means(&of_a_file(other)), means(&expected));
    // Equal rods given one by one are equal rods.
    drawn.particles.length_sd_percent = 0.0;
    drawn.particles.aspect_ratio_sd_percent = 0.0;
    let equal = OwnRods { aspect_ratio: Some(vec![11.6; 300]), length_mm: Some(vec![1.0; 300]), ..OwnRods::default() };
    let mut given = drawn.clone();
    given.particles.rods = Some(RodsFile::with("rods.csv", equal));
    let plan = planned(&given);
    assert!(!plan.runs(Stage::Lengths) && !plan.runs(Stage::AspectRatios));
    assert_eq!(run(&given).series, run(&drawn).series);
}

/// Another number of rods in a volume of the same shape and concentration.
#[test]
fn a_box_grows_with_its_rods() {
    for interaction in ["box_mm = [12, 5, 5]", "concentration_per_cm3 = 1000\nbox_mm = [12, 5, 5]", DENSE] {
        let mut scene = scene("length_mm = 0.72", interaction);
        for count in [25, 300, 2400] {
            scene.set_count(count);
            let (n, sides) = (scene.concentration_per_cm3().unwrap(), scene.sides_mm().unwrap());
            assert!((n / 1000.0 - 1.0).abs() < 1e-14, "{interaction}: {n}");
            let shape = if interaction == DENSE { 1.0 } else { 2.4 };
            assert!((sides[0] / sides[1] - shape).abs() < 1e-14 && (sides[1] / sides[2] - 1.0).abs() < 1e-14);
            planned(&scene);
        }
    }
}
