//! A suspension that is written and restarted from the file: every rod's length, r_e, direction and place.

use super::*;
use shearbed::scene::{OwnRods, RodsFile};

type Way = fn(&mut OwnRods);

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "continued-run")
            .claim(
                "Unequal rods that continue at t = T with the length, r_e, direction and place that they had go \
                 on, in law, as the suspension that they were.",
            )
            .source("eqs 11, 12; the method of solution: what a suspension is")
            .under_test((|_| ()) as Way)
            .mistake("r_e drawn again", (|own| own.aspect_ratio = None) as Way)
            .mistake(
                "each direction to the next rod",
                (|own| own.p.iter_mut().flatten().for_each(|axis| axis.rotate_right(1))) as Way,
            )
            .mistake("isotropic again", (|own| own.p = None) as Way)
            .check(continues),
    ]
}

const STEPS_PER_PERIOD: u64 = 100;
/// Pilot of 600 replicas at seed 99: the differences scatter by 0.0126.
const SD: f64 = 0.013;
const EFFECT: f64 = 0.01;

fn continues(way: &Way, effort: &Effort) -> Evidence {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.aspect_ratio_sd_percent = 8.5;
    scene.particles.length_sd_percent = 20.0;
    scene.time = Time { steps_per_unit: Some(STEPS_PER_PERIOD), ..Time::periods(2.0) };
    // 100 rods at 50 per cm³.
    lab::set_box_mm(&mut scene, [20.0, 10.0, 10.0]);
    let replicas = effort.samples(Design { effect: EFFECT, sd: SD });
    let differences: Vec<f64> = lab::replicas(replicas, |replica| again_less_straight(&scene, *way, replica));
    Evidence::on("X̄₁ at t/T = 1½, continued at t = T less straight on", "rod lengths")
        .is(Sample::of(&differences), 0.0, 0.0, EFFECT)
        .because("the same rods, with other collisions; with r_e drawn again they fall out of step more slowly")
}

fn again_less_straight(scene: &Scene, way: Way, replica: u64) -> f64 {
    let mut straight = lab::suspension(scene, replica);
    let Some(_) = lab::x1_after(&mut straight, STEPS_PER_PERIOD) else {
        return f64::NAN;
    };
    let mut own = written(&straight, scene.particles.length_mm);
    way(&mut own);
    let mut scene = scene.clone();
    scene.particles.rods = Some(RodsFile::with("rods.csv", own));
    // Random numbers that no uninterrupted run uses.
    let mut again = lab::suspension(&scene, u64::MAX / 2 + replica);
    let x1 = |suspension: &mut Suspension| lab::x1_after(suspension, STEPS_PER_PERIOD / 2).unwrap_or(f64::NAN);
    x1(&mut again) - x1(&mut straight)
}

fn written(suspension: &Suspension, length_mm: f64) -> OwnRods {
    let directions = suspension.directions();
    let in_mm = |axis: &Vec<f64>| axis.iter().map(|x| x * length_mm).collect::<Vec<f64>>();
    OwnRods {
        p: Some([0, 1, 2].map(|axis| directions.iter().map(|p| p[axis]).collect())),
        aspect_ratio: Some(suspension.aspect_ratios()),
        length_mm: Some(in_mm(&suspension.lengths())),
        place_mm: Some(suspension.positions_in_lengths().each_ref().map(in_mm)),
    }
}
