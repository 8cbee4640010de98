//! The core against the naive reference: the same draws, collision by collision.

use super::*;
use crate::judge::lab::problem;
use crate::oracle::naive::{Mistake, Naive};
use shearbed::scene;

pub fn cases() -> Vec<Case> {
    let mistakes = Mistake::ALL.into_iter().map(|mistake| (name(mistake), Some(mistake)));
    vec![
        Case::of(Judges::Core, "naive-reference")
            .claim(
                "The core and a naive O(N²) reference with the same draws have the same collisions and, to round-off, \
                 the same rods, in shear and in other flows.",
            )
            .source("eqs 5–9, 11, 12, 14, A.7–A.14; the method of solution")
            .under_test(None)
            .mistakes(mistakes)
            .check(against_reference),
    ]
}

fn name(mistake: Mistake) -> &'static str {
    match mistake {
        Mistake::KickSign => "the kick with the wrong sign",
        Mistake::SumInsteadOfMean => "the sum in place of the mean",
        Mistake::ArmsSwapped => "arms exchanged",
        Mistake::ArmUnsigned => "arms without their sign",
        Mistake::SpinIgnored => "ω × r left out",
        Mistake::TranslationKept => "the translation not subtracted",
        Mistake::PrintedA13 => "A.13 as in the text",
        Mistake::LambdaOne => "Λ = 1 in free motion",
        Mistake::PeriodHalved => "half the period",
        Mistake::ConcentrationUnits => "cm⁻³ taken as cm⁻²",
        Mistake::ProbabilityComplement => "collisions where P_c < R",
        Mistake::ProbabilityExponent => "m + 1 for m",
        Mistake::AnyNeighbour => "any neighbour for the nearest",
        Mistake::IndexOrder => "candidates in the order of rods",
        Mistake::ReplacementUniform => "x_1 = HR for new rods",
        Mistake::ReplacementNone => "leaving rods keep x_1 and x_3",
        Mistake::PartnersLength => "s over the partner's length",
        Mistake::MeanLength => "s over the mean length",
        Mistake::ArmsOverMeanLength => "shortest arms in mean lengths",
        Mistake::CubeForBox => "a cube for the box",
        Mistake::ReplacementAlongFlow => "x_1 = H₂√R for new rods",
        Mistake::GradientTransposed => "L transposed",
        Mistake::InflowUniform => "rods come in anywhere on a face alike",
        Mistake::FacesByArea => "faces chosen by their area alone",
        Mistake::InflowAtOnce => "rods come in at the step's beginning, all of them",
    }
}

/// The state after a step: places in rod lengths, directions, and colliding pairs.
struct State {
    places: Vec<[f64; 3]>,
    directions: Vec<[f64; 3]>,
    pairs: Vec<(usize, usize)>,
}

/// Takes a step; `None` if the model stopped.
type Step = Box<dyn FnMut() -> Option<State>>;

/// The model that is compared with the reference: the core, or a naive model with a mistake.
fn model(scene: &Scene, replica: u64, mistake: Option<Mistake>) -> Step {
    if mistake.is_some() {
        let (mut naive, length_mm) = (Naive::new(problem(scene, replica, mistake)), scene.particles.length_mm);
        return Box::new(move || {
            naive.step();
            Some(state(&naive, length_mm))
        });
    }
    let mut core = lab::suspension(scene, replica);
    Box::new(move || {
        let pairs = core.step().ok()?.iter().map(|collision| collision.rods.into()).collect();
        let [x1, x2, x3] = core.positions_in_lengths();
        let places = (0..x1.len()).map(|rod| [x1[rod], x2[rod], x3[rod]]).collect();
        Some(State { places, directions: core.directions().into_iter().map(Into::into).collect(), pairs })
    })
}

fn state(naive: &Naive, length_mm: f64) -> State {
    State {
        places: naive.positions_mm.iter().map(|x| x.map(|x| x / length_mm)).collect(),
        directions: naive.orientations.clone(),
        pairs: naive.last_collisions.clone(),
    }
}

#[derive(Default)]
struct Off {
    steps: u64,
    collisions: u64,
    pairs: u64,
    places: f64,
    /// The difference after one step from the same state, over [`condition`].
    step: f64,
}

/// One period of each problem, one step at a time.
fn against_reference(mistake: &Option<Mistake>, effort: &Effort) -> Vec<Evidence> {
    let mut off = Off::default();
    // The last scenes use most of the rules: there a mistake is caught soon, and no further scene is needed.
    for scene in scenes(effort).iter().rev() {
        for replica in 0..effort.pick(1, 8) {
            compare(scene, replica, *mistake, &mut off);
        }
        if mistake.is_some() && off.pairs > 0 {
            break;
        }
    }
    vec![
        Evidence::on(
            format!("problems in which other rods collided, in {} steps with {} collisions", off.steps, off.collisions),
            "problems",
        )
        .exact(off.pairs as f64),
        Evidence::on("largest difference of places after up to one period", "rod lengths")
            .within(off.places, 1e-11)
            .because("round-off of 200 sums of lengths up to 100"),
        Evidence::on(
            "largest difference of directions after one step from the same state, over the condition of its contacts",
            "–",
        )
        .within(off.step, 256.0 * f64::EPSILON)
        .because(
            "some hundred roundings of the reference's tensors and frames; directions off by ε and places x by ε|x| \
             move an arm r by ε(1 + |x|)/sin², and the angle turned, ∝ 1/r, by that over r",
        ),
    ]
}

fn compare(scene: &Scene, replica: u64, mistake: Option<Mistake>, off: &mut Off) {
    let length_mm = scene.particles.length_mm;
    let mut step = model(scene, replica, mistake);
    let mut reference = Naive::new(problem(scene, replica, None));
    let units = match scene.time.unit {
        scene::TimeUnit::Strain | scene::TimeUnit::Second => scene.time.duration as u64,
        scene::TimeUnit::Period => 1,
    };
    for _ in 0..units * scene.steps_per_unit() {
        let before = state(&reference, length_mm);
        reference.step();
        let expected = state(&reference, length_mm);
        let Some(state) = step() else {
            off.pairs += 1;
            return;
        };
        off.steps += 1;
        off.collisions += expected.pairs.len() as u64;
        off.places = larger(off.places, apart(&expected.places, &state.places, [1.0]));
        let directions = apart(&expected.directions, &state.directions, [1.0, -1.0]);
        let turns = reference.last_turns_rad.iter().map(|[a, b]| a.max(*b));
        let condition = (expected.pairs.iter().zip(turns))
            .map(|(pair, turn)| condition(&before, *pair, turn))
            .fold(scene.particles.aspect_ratio, f64::max);
        off.step = larger(off.step, directions / condition);
        if expected.pairs != state.pairs {
            // From here on the rods differ, and further comparison is useless.
            off.pairs += 1;
            return;
        }
        reference.orientations = state.directions;
    }
}

/// The factor by which a collision that turns a rod by up to `turn` rad stretches a difference of ε in places and
/// directions.
fn condition(before: &State, (i, j): (usize, usize), turn: f64) -> f64 {
    let places = [i, j].map(|rod| Vector3::from(before.places[rod]));
    let (d, farthest) = (places[1] - places[0], places[0].norm().max(places[1].norm()));
    let (a, b) = (Vector3::from(before.directions[i]), Vector3::from(before.directions[j]));
    let cos = a.dot(&b);
    let square = a.cross(&b).norm_squared();
    // The contact points on both rods, from the normal equations of the shortest line.
    let arms = [d.dot(&a) - cos * d.dot(&b), cos * d.dot(&a) - d.dot(&b)].map(|r| (r / square).abs());
    let shortest = arms[0].min(arms[1]);
    (1.0 + turn) * (1.0 + (1.0 + farthest) / (square * shortest))
}

/// The largest distance between two lists of vectors, up to the given signs.
fn apart<const K: usize>(a: &[[f64; 3]], b: &[[f64; 3]], signs: [f64; K]) -> f64 {
    let distance =
        |a: &[f64; 3], b: &[f64; 3], sign: f64| (0..3).map(|k| (a[k] - sign * b[k]).powi(2)).sum::<f64>().sqrt();
    let nearest = |(a, b)| signs.iter().map(|&sign| distance(a, b, sign)).fold(f64::INFINITY, f64::min);
    worst(a.iter().zip(b).map(nearest))
}

/// The same concentration in a box with `sides` relative to those of the cube.
fn in_a_box(scene: &mut Scene, sides: [f64; 3]) {
    let per_mm3 = 1e-3 * scene.concentration_per_cm3().unwrap_or(f64::NAN);
    let cube = (scene.particles.count as f64 / per_mm3).cbrt();
    scene.particles.length_sd_percent = 20.0;
    scene.time.steps_per_unit = Some(50);
    lab::set_box_mm(scene, sides.map(|side| side * cube));
}

/// Two units of strain in a flow with this gradient.
fn in_a_flow(scene: &mut Scene, gradient_per_s: [[f64; 3]; 3]) {
    scene.flow = scene::Flow::Gradient { gradient_per_s };
    scene.time = scene::Time { steps_per_unit: Some(10), ..scene::Time::strain(2.0) };
}

/// Scenes of 2 to 400 rods; the small ones are dense enough to collide.
fn scenes(effort: &Effort) -> Vec<Scene> {
    let scene = |count: usize, per_cm3: f64, change: fn(&mut Scene)| {
        let mut scene = lab::crowded_scene(effort, count, per_cm3);
        scene.ensemble.seed = effort.seed(1982 + count as u64);
        change(&mut scene);
        scene
    };
    vec![
        scene(2, 1000.0, |_| {}),
        scene(3, 1000.0, |scene| scene.particles.aspect_ratio_sd_percent = 8.5),
        scene(10, 500.0, |scene| lab::interaction(scene).update = scene::Update::Angles),
        scene(50, 50.0, |scene| lab::interaction(scene).m = 1.7),
        scene(100, 50.0, |scene| scene.particles.aspect_ratio_sd_percent = 3.6),
        scene(100, 100.0, |scene| {
            scene.particles.orientation = Orientation::Given { phi_deg: 30.0, theta_deg: 70.0 };
            lab::interaction(scene).min_contact_arm = 0.1;
            scene.time.steps_per_unit = Some(100);
        }),
        scene(200, 50.0, |_| {}),
        // Enough rods to be sorted into cells, dilute and dense.
        scene(400, 50.0, |scene| scene.time.steps_per_unit = Some(50)),
        scene(300, 1000.0, |scene| {
            lab::interaction(scene).min_contact_arm = 0.1;
            scene.time.steps_per_unit = Some(50);
        }),
        // Rods of unequal length, in a cube and in boxes: small enough for pairs, with cells, and one cell thick.
        scene(100, 1000.0, |scene| {
            scene.particles.length_sd_percent = 30.0;
            lab::interaction(scene).min_contact_arm = 0.3;
        }),
        scene(60, 1000.0, |scene| in_a_box(scene, [2.0, 1.0, 0.5])),
        scene(300, 1000.0, |scene| in_a_box(scene, [4.0, 0.5, 0.5])),
        scene(400, 500.0, |scene| in_a_box(scene, [0.1, 10.0, 1.0])),
        // Other flows: extension, oblique shear in a box, and one with all components.
        scene(100, 1000.0, |scene| in_a_flow(scene, [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]])),
        scene(60, 1000.0, |scene| {
            in_a_box(scene, [2.0, 1.0, 0.5]);
            in_a_flow(scene, [[0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.0; 3]]);
        }),
        scene(300, 1000.0, |scene| {
            scene.particles.aspect_ratio_sd_percent = 3.6;
            lab::interaction(scene).min_contact_arm = 0.1;
            in_a_flow(scene, [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]]);
        }),
        // The exact step and the kick, for both ways of motion.
        scene(100, 100.0, |scene| {
            scene.particles.aspect_ratio_sd_percent = 3.6;
            lab::interaction(scene).update = scene::Update::Kick;
        }),
        scene(100, 500.0, |scene| {
            lab::interaction(scene).update = scene::Update::Kick;
            in_a_flow(scene, [[0.1, -0.5, 0.0], [0.6, -0.1, 0.0], [0.0; 3]]);
        }),
    ]
}
