//! Whole scenes that once gave wrong results: overflowing spirals, extreme shapes, near-parabolic flows, Couette flow
//! rotated by 45°, a weak strain in a strong rotation.

use super::*;
use crate::oracle::exponential::Span;
use shearbed::model::orientation::from_degrees;

/// A function that runs a scene of one rod: |p_i| at its end and the bound on its error, `None` if the scene is
/// refused.
pub type Run = fn(&Scene) -> Option<([f64; 3], f64)>;

/// ∂u_i/∂x_j, r_e, φ and θ in degrees, strain or (with Couette flow of the shear rate 1 1/s) eighths of a period.
type Listed = ([[f64; 3]; 3], f64, [f64; 2], Result<f64, f64>);

const TURNED: [[f64; 3]; 3] = [[-0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [0.0; 3]];

const LISTED: [Listed; 16] = [
    ([[1.0, 0.0, 0.001], [0.0, -0.5, -0.001], [0.0, 0.001, -0.5]], 11.6, [20.0, 70.0], Ok(640.0)),
    ([[-0.5, -0.001, 0.0], [0.001, -0.5, 0.0], [0.0, 0.0, 1.0]], 11.6, [20.0, 70.0], Ok(2000.0)),
    ([[-0.5, -1e-5, 0.0], [1e-5, -0.5, 0.0], [0.0, 0.0, 1.0]], 11.6, [20.0, 90.0], Ok(625.0)),
    ([[0.5, -0.001, 0.0], [0.001, 0.5, 0.0], [0.0, 0.0, -1.0]], 11.6, [20.0, 70.0], Ok(1249.0)),
    ([[0.5, -0.001, 0.0], [0.001, 0.5, 0.0], [0.0, 0.0, -1.0]], 11.6, [20.0, 70.0], Ok(3e3)),
    ([[0.0, 1.0, 0.0], [-1.0, 0.0, -1.0], [0.0, -1.0, 0.0]], 1e100, [0.0, 0.0], Ok(3.0)),
    ([[0.0, 1.0, 0.0], [-1.0, 0.0, -1.0], [0.0, -1.0, 0.0]], 1e100, [0.0, 0.0], Ok(3e3)),
    ([[0.0; 3], [1.0, 0.0, 0.0], [-1.0, -1.0, 0.0]], 1e-100, [0.0, 0.0], Ok(3.0)),
    ([[1.5e-7, 0.0, 0.0], [1.0, 1.5e-7, 0.0], [0.0, 0.0, -3e-7]], 1e4, [90.0, 45.0], Ok(3e3)),
    ([[1.5e-5, 0.0, 0.0], [1.0, 1.5e-5, 0.0], [0.0, 0.0, -3e-5]], 1e6, [90.0, 45.0], Ok(3e3)),
    (TURNED, 1e6, [20.0, 70.0], Err(11.0)),
    (TURNED, 1e8, [20.0, 70.0], Err(11.0)),
    (TURNED, 1e8, [20.0, 70.0], Ok(3e3)),
    // On the way back to its start, where numbers of 10⁸ cancel.
    (TURNED, 1e8, [20.0, 70.0], Err(16.0)),
    ([[0.0, -1.0, 0.0], [1.0 + 2e-13, 0.0, 0.0], [0.0; 3]], 11.6, [20.0, 70.0], Ok(1000.0)),
    ([[-1.0, -1.0, 0.0], [-2.0, 2.0, -1.0], [0.0, -2.0, -1.0]], 2.0, [20.0, 70.0], Ok(10.0)),
];

fn scene(&(gradient, r, [phi_deg, theta_deg], time): &Listed) -> Scene {
    let mut scene = lab::free_scene(&Effort::gate());
    scene.particles.count = 1;
    scene.particles.aspect_ratio = r;
    scene.particles.orientation = Orientation::Given { phi_deg, theta_deg };
    scene.flow = Flow::Gradient { gradient_per_s: gradient };
    scene.time = match time {
        Ok(strain) => Time { outputs_per_unit: Some(1), ..Time::strain(strain) },
        Err(eighths) => Time { outputs_per_unit: Some(8), ..Time::periods(eighths / 8.0) },
    };
    scene.output.observables = vec![Observable::Projections];
    scene
}

/// Runs a scene as the program does.
pub fn program(scene: &Scene) -> Option<([f64; 3], f64)> {
    let plan = Plan::new(scene).ok()?;
    let results = ensemble::run(&plan).ok()?;
    let last = results.times.len() - 1;
    let end = ["x1", "x2", "x3"].map(|name| results.column(name).map_or(f64::NAN, |x| x.mean[last]));
    Some((end, plan.error_rad()?))
}

pub fn listed_scenes(run: &Run, _: &Effort) -> Vec<Evidence> {
    let (mut refused, mut unknown, mut share) = (0.0, 0.0, 0.0f64);
    for listed in &LISTED {
        let &(gradient_per_s, aspect_ratio, [phi_deg, theta_deg], time) = listed;
        let Some((end, error)) = run(&scene(listed)) else {
            refused += 1.0;
            continue;
        };
        let p = from_degrees(phi_deg, theta_deg).into_inner().into();
        let rod = Rod { gradient_per_s, aspect_ratio, p };
        let truth = rod.after(match time {
            Ok(strain) => Span::Strain(strain),
            Err(eighths) => Span::CouettePeriods(eighths, 8.0, 1.0),
        });
        let off = (0..3).map(|k| (end[k] - truth[k].abs()).powi(2)).sum::<f64>().sqrt();
        unknown += f64::from(!off.is_finite());
        share = share.max(off / (error + 2.0 * f64::EPSILON));
    }
    let a_period = |listed| lab::changed(scene(listed), |scene| scene.time = Time::periods(1.0));
    let no_period = LISTED.last().is_some_and(|listed| run(&a_period(listed)).is_none());
    vec![
        Evidence::on("largest error of |p_i| at the end over the bound that the plan states", "× its bound")
            .within(share, 1.0)
            .because("what a bound is: the start's rounding and the map's"),
        Evidence::on("scenes refused, or with an end that is no number", "scenes").exact(refused + unknown),
        Evidence::on("a flow of three real rates, on which an eigenvalue solver hung, that is given a period", "flows")
            .exact(f64::from(!no_period)),
    ]
}
