//! Jeffery's equations one by one: the rate of a run's rods against A.1 to A.3 as printed, and the motion of a whole
//! run against A.4 and A.5.

use super::*;
use crate::methods::integrators::apart_rad;
use crate::oracle::jeffery as printed;
use shearbed::model::jeffery::couette_rate;

/// A function that returns ṗ per unit of strain for direction p, aspect ratio r and the sign of G.
type Rate = fn(&Vector3<f64>, f64, f64) -> Vector3<f64>;

fn rate_in_a_run(p: &Vector3<f64>, r: f64, sign: f64) -> Vector3<f64> {
    couette_rate(p, shape_factor(r), sign)
}

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "angular-velocity")
            .claim("The ṗ that a run's collisions start from is ω × p with ω by A.1 in the body frame, r_e = a/b.")
            .source("eqs 1, A.1")
            .under_test(rate_in_a_run as Rate)
            .mistake("b/a for a/b", |p, r, sign| rate_in_a_run(p, 1.0 / r, sign))
            .mistake("the transposed gradient", |p, r, sign| {
                let swap = |v: &Vector3<f64>| Vector3::new(v.y, v.x, v.z);
                swap(&rate_in_a_run(&swap(p), r, sign))
            })
            .mistake("no vorticity", |p, r, sign| rate_in_a_run(p, r, sign) - rate_in_a_run(p, 1.0, sign))
            .mistake("r_e for r_e² in Λ", |p, r, sign| rate_in_a_run(p, r.sqrt(), sign))
            .mistake("the sign of G left out", |p, r, _| rate_in_a_run(p, r, 1.0))
            .check(body_frame),
        Case::of(Judges::Core, "angle-rates")
            .claim("The angles of a rod that moves at a run's ṗ have the rates of A.2 and A.3.")
            .source("A.2, A.3")
            .under_test(rate_in_a_run as Rate)
            .mistake("a quarter turn of φ", |p, r, sign| {
                let turned = |v: &Vector3<f64>, k: f64| Vector3::new(-k * v.y, k * v.x, v.z);
                turned(&rate_in_a_run(&turned(p, 1.0), r, sign), -1.0)
            })
            .mistake("Λ = 1", |p, _, sign| couette_rate(p, 1.0, sign))
            .mistake("p_3 pulled the other way", |p, r, sign| {
                rate_in_a_run(p, r, sign).component_mul(&Vector3::new(1.0, 1.0, -1.0))
            })
            .check(rates_of_angles),
        Case::of(Judges::Core, "angles-in-closed-form")
            .claim("What a run makes of one rod is A.4 and A.5: its direction, φ and C_b at every output.")
            .source("eqs 13, 18, 20, A.4, A.5")
            .under_test((|_| {}) as Change)
            .mistake("r_e a millionth too long", |scene| scene.particles.aspect_ratio *= 1.0 + 1e-6)
            .mistake("−G for G", |scene| {
                scene.flow = Flow::Gradient { gradient_per_s: [[0.0; 3], [-0.5, 0.0, 0.0], [0.0; 3]] };
            })
            .mistake("φ from axis 2", |scene| {
                if let Orientation::Given { phi_deg, .. } = &mut scene.particles.orientation {
                    *phi_deg = 90.0 - *phi_deg;
                }
            })
            .check(one_rod),
    ]
}

fn rates(r: &Rate, check: impl Fn(Vector3<f64>, &Matrix3<f64>, f64, [f64; 2]) -> f64) -> f64 {
    let rods = pairs([1.0, -1.0], [(11.6, 1.0), (3.0, 2.0), (0.2, 1.0), (5.0, 5.0), (1e4, 1.0)]);
    let angles = [(0.0, 0.4), (0.7, 1.2), (2.0, 0.9), (-1.3, 2.6), (1.5, 1.57)];
    worst(pairs(rods, angles).map(|((sign, (a, b)), (phi, theta))| {
        let p = orientation::from_angles(phi, theta).into_inner();
        let gradient = Matrix3::new(0.0, 0.0, 0.0, sign, 0.0, 0.0, 0.0, 0.0, 0.0);
        check(r(&p, a / b, sign), &gradient, a / b, [phi, theta])
    }))
}

fn body_frame(rate: &Rate, _: &Effort) -> Evidence {
    let worst = rates(rate, |found, gradient, r, [phi, theta]| {
        let p = orientation::from_angles(phi, theta);
        (found - printed::direction_rate_per_s(gradient, r, &p)).norm()
    });
    let because = "some dozens of roundings of numbers up to 1, in the frame of the particle and back";
    Evidence::on("largest difference of ṗ/G", "–").within(worst, 32.0 * f64::EPSILON).because(because)
}

fn rates_of_angles(rate: &Rate, _: &Effort) -> [Evidence; 2] {
    let along_phi = |phi: f64| Vector3::new(-phi.sin(), phi.cos(), 0.0);
    let along_theta =
        |phi: f64, theta: f64| Vector3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), -theta.sin());
    let phi_off = rates(rate, |found, gradient, r, [phi, theta]| {
        let (expected, _) = printed::angle_rates_per_s(gradient[(1, 0)], r, phi, theta);
        (found.dot(&along_phi(phi)) / theta.sin() - expected).abs()
    });
    let theta_off = rates(rate, |found, gradient, r, [phi, theta]| {
        let (_, expected) = printed::angle_rates_per_s(gradient[(1, 0)], r, phi, theta);
        (found.dot(&along_theta(phi, theta)) - expected).abs()
    });
    let because = "a dozen roundings of numbers up to 1, over sin θ ≥ 0.39";
    [("φ̇", phi_off), ("θ̇", theta_off)].map(|(rate, worst)| {
        Evidence::on(format!("largest error of {rate}/G"), "rad").within(worst, 32.0 * f64::EPSILON).because(because)
    })
}

/// Outputs per period, an even number.
const OUTPUTS: usize = 50;

fn one_rod(change: &Change, effort: &Effort) -> Vec<Evidence> {
    let mut worst = [0.0f64; 3];
    for r in [0.5, 1.01, 3.96, 11.6, 100.0] {
        for (phi_deg, theta_deg) in [(0.0, 3.0), (20.0, 34.0), (77.0, 69.0), (45.0, 86.0)] {
            let mut scene = lab::free_scene(effort);
            scene.particles.count = 1;
            scene.particles.aspect_ratio = r;
            scene.particles.orientation = Orientation::Given { phi_deg, theta_deg };
            scene.time = Time { outputs_per_unit: Some(OUTPUTS as u64), ..Time::periods(3.0) };
            scene.output.observables =
                vec![Observable::OrientationTensor, Observable::MeanAngle, Observable::OrbitConstant];
            change(&mut scene);
            let (phi0, theta0) = (f64::to_radians(phi_deg), f64::to_radians(theta_deg));
            let expected = |output: usize| {
                // Whole periods change nothing, and would reduce the precision of the phase.
                let turns = ((output + OUTPUTS / 2) % OUTPUTS) as f64 - (OUTPUTS / 2) as f64;
                let turns = turns / OUTPUTS as f64;
                let (phi, theta) = closed_form::angles_at(phi0, theta0, r, turns);
                Vector3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
            };
            let c = closed_form::orbit_constant_from_angles(phi0, theta0, r);
            for (output, found) in run(&scene).into_iter().enumerate() {
                let expected = expected(output);
                let apart = [
                    apart_rad(&found.direction, &expected),
                    (found.phi - expected.y.abs().atan2(expected.x.abs())).abs() * theta0.sin(),
                ];
                for (worst, apart) in worst.iter_mut().zip(apart) {
                    *worst = larger(*worst, apart / r.max(1.0 / r));
                }
                worst[2] = larger(worst[2], (found.c_b - c / (1.0 + c)).abs());
            }
        }
    }
    let because = "a rounding of the phase, πε, grows by dφ/d(phase) ≤ max(r_e, 1/r_e); so does one of the start";
    vec![
        Evidence::on("largest angle between the two directions over max(r_e, 1/r_e)", "rad")
            .within(worst[0], 16.0 * f64::EPSILON)
            .because(because),
        Evidence::on("largest error of φ times sin θ at the start over max(r_e, 1/r_e)", "rad")
            .within(worst[1], 16.0 * f64::EPSILON)
            .because(because),
        Evidence::on("largest error of C_b", "–").within(worst[2], 16.0 * f64::EPSILON).because(
            "C_b ≤ 1 has slope ≤ ¼ in ln C, which is a ratio of lengths and a tangent known to some sixteen roundings",
        ),
    ]
}

struct Rod {
    direction: Vector3<f64>,
    phi: f64,
    c_b: f64,
}

/// Runs a scene of one rod as the program does; directions are known up to sign.
fn run(scene: &Scene) -> Vec<Rod> {
    let results = ensemble::run(&lab::plan(scene)).expect("free rods do not stop");
    let at = |name: &str, output: usize| {
        let channel = results.column(name);
        channel.map_or(f64::NAN, |channel| channel.mean[output])
    };
    (0..results.times.len())
        .map(|output| {
            let a = |i: usize, j: usize| at(&format!("a{}{}", i.min(j) + 1, i.max(j) + 1), output);
            // The row of the largest component of p keeps the digits of the small ones.
            let largest = (0..3).max_by(|&i, &j| a(i, i).total_cmp(&a(j, j))).unwrap_or(0);
            Rod { direction: Vector3::from_fn(|j, _| a(largest, j)), phi: at("phi", output), c_b: at("c_b", output) }
        })
        .collect()
}
