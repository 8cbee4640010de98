//! Two rods at given places, closer to overflow than drawn rods ever are.

use super::*;
use shearbed::model::collision::share_velocity;
use shearbed::model::contact::contact;

pub(super) struct Placed {
    second: UnitVector3<f64>,
    /// A's arm, in rod lengths.
    arm: f64,
}

/// Directions after a step, none if the rods made no contact; or the message of a run that stopped.
type Stepped = Result<Vec<Vector3<f64>>, String>;

pub(super) type Pair = fn(&Scene, &Placed) -> Stepped;

/// The direction of A: between axes 1 and 3.
fn first() -> UnitVector3<f64> {
    UnitVector3::new_normalize(Vector3::new(1.0, 0.0, 1.0))
}

/// The core's step with B at `arm` along A's axis and `BESIDE` along axis 2: A's arm is `arm`, ℓ has a part along the
/// flow's difference.
pub(super) fn step_of_the_core(scene: &Scene, placed: &Placed) -> Stepped {
    let mut suspension = lab::suspension(scene, 0);
    let middle = 0.5 * suspension.sides_in_lengths()[1];
    let along = placed.arm * first().into_inner();
    let at = [vec![0.0, along.x], vec![middle, middle + BESIDE], vec![0.0, along.z]];
    if suspension.place(at, &[first(), placed.second]).is_none() {
        return Ok(Vec::new());
    }
    let collided = !suspension.step().map_err(|error| error.to_string())?.is_empty();
    Ok(if collided { suspension.directions() } else { Vec::new() })
}

/// The distance of B from A along axis 2, in rod lengths.
const BESIDE: f64 = 0.3;

/// The same step with |ṗ| computed by squares, which overflow where the kick does not.
pub(super) fn step_with_squares(scene: &Scene, placed: &Placed) -> Stepped {
    let p = [first(), placed.second];
    let separation = placed.arm * p[0].into_inner() + Vector3::new(0.0, BESIDE, 0.0);
    let Some(contact) = contact(&separation, &p[0], &p[1], [0.0; 2]) else {
        return Ok(Vec::new());
    };
    let shape = shape_factor(scene.particles.aspect_ratio);
    let free = p.map(|p| couette_rate(&p, shape, 1.0));
    let rates = share_velocity(&contact, &Vector3::new(0.0, separation.x, 0.0), free);
    let strain = strain_per_period(scene.particles.aspect_ratio) / scene.steps_per_unit() as f64;
    let turned = [0, 1].map(|k| {
        let speed = rates[k].norm_squared().sqrt();
        let (sin, cos) = (speed * strain).sin_cos();
        (p[k].into_inner() * cos + rates[k] * (sin / speed)).normalize()
    });
    if turned.iter().all(|p| p.sum().is_finite()) { Ok(turned.into()) } else { Err("not finite".into()) }
}

/// Directions after one step of pairs at given places, and the number of pairs that ended wrongly.
pub(super) fn ends(pair: Pair, effort: &Effort) -> (Vec<Vector3<f64>>, f64) {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 2;
    lab::interaction(&mut scene).alpha = 1e300;
    let seed = format!("seed {}", scene.ensemble.seed);
    let ulp = UnitVector3::new_normalize(Vector3::new(1.0, f64::EPSILON, 1.0));
    let y = Vector3::y_axis();
    let mut directions = Vec::new();
    let mut unlike = 0.0;
    for (second, arm, overflows) in [
        (ulp, 0.5, false),
        (ulp, 1e-3, false),
        (y, 1e-3, false),
        (y, 1e-150, false),
        (y, f64::MIN_POSITIVE, false),
        (y, 1e-320, true),
    ] {
        match pair(&scene, &Placed { second, arm }) {
            Ok(turned) if !overflows && !turned.is_empty() => directions.extend(turned),
            Err(text) if overflows => {
                let words = ["rod ", "step 0", &seed, "arm"];
                unlike += f64::from(!words.iter().all(|word| text.contains(word)));
            }
            _ => unlike += 1.0,
        }
    }
    (directions, unlike)
}
