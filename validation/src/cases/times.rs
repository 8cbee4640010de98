//! The units of a run's times: seconds and strain.

use super::*;
use crate::judge::lab::{changed, free_scene, plan};

/// A function that returns the seconds and the strain of one unit of a run's times.
type UnitOf = fn(&Scene) -> [f64; 2];

fn unit(scene: &Scene) -> [f64; 2] {
    let unit = plan(scene).elapsed(1.0);
    [unit.seconds, unit.strain]
}

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "times-of-a-run")
            .claim(
                "The seconds and the strain beside each t/T of a run are those of T = 2π(r_e + 1/r_e)/|G| in plane \
                 Couette flow, of 2π/ω in other flows in a plane that turn rods at ω, and of (2D:D)^½ where times are \
                 given in strain or in seconds.",
            )
            .source("eqs 15, A.6")
            .under_test(unit as UnitOf)
            .mistake("r_e for r_e + 1/r_e", |scene| {
                let r = scene.particles.aspect_ratio;
                unit(scene).map(|of_period| of_period * r / (r + 1.0 / r))
            })
            .mistake("half a turn for a period", |scene| unit(scene).map(|of_period| 0.5 * of_period))
            .mistake("strain for seconds", |scene| [unit(scene)[1]; 2])
            .mistake("the shear rate with its sign", |scene| {
                let [seconds, strain] = unit(scene);
                let sign = scene.flow.gradient_per_s().map_or(1.0, |l| l[1][0].signum());
                [seconds * sign, strain]
            })
            .mistake("(D:D)^½ for the rate of strain", |scene| {
                let [seconds, strain] = unit(scene);
                match scene.time.unit {
                    TimeUnit::Strain => [seconds * 2f64.sqrt(), strain],
                    TimeUnit::Second => [seconds, strain / 2f64.sqrt()],
                    TimeUnit::Period => [seconds, strain / 2f64.sqrt()],
                }
            })
            .check(units),
    ]
}

/// A scene, and its unit by closed forms.
type Expected = (Scene, [f64; 2]);

fn units(unit: &UnitOf, effort: &Effort) -> Vec<Evidence> {
    let worst = |scenes: Vec<Expected>| {
        let errors = scenes.iter().flat_map(|(scene, expected)| {
            let times = unit(scene);
            std::array::from_fn::<_, 2, _>(|i| (times[i] / expected[i] - 1.0).abs())
        });
        worst(errors)
    };
    let because = "sums, products and a root, each rounded: eight roundings on both sides";
    let within = |what, scenes| Evidence::on(what, "–").within(worst(scenes), 8.0 * f64::EPSILON).because(because);
    vec![
        within("relative error in plane Couette flow, both directions, r_e from 10⁻³ to 10⁶", couette(effort)),
        within("relative error in flows in a plane that turn rods along ellipses", elliptic(effort)),
        within("relative error of seconds and strain per unit of each in extension and shear", strained(effort)),
    ]
}

fn couette(effort: &Effort) -> Vec<Expected> {
    let each = |shear_rate_per_s: f64, r: f64| {
        let scene = changed(free_scene(effort), |scene| {
            // A scene's shear rate is positive; the opposite one is a gradient.
            scene.flow = if shear_rate_per_s > 0.0 {
                Flow::Shear { shear_rate_per_s }
            } else {
                Flow::Gradient { gradient_per_s: [[0.0; 3], [shear_rate_per_s, 0.0, 0.0], [0.0; 3]] }
            };
            scene.particles.aspect_ratio = r;
        });
        let period_s = closed_form::period_s(shear_rate_per_s.abs(), r);
        (scene, [period_s, shear_rate_per_s.abs() * period_s])
    };
    let rates = [0.5, -0.5, 3e-5, -2e7];
    let ratios = [1e-3, 0.5, 1.0, 1.0001, 11.6, 1e6];
    rates.iter().flat_map(|&g| ratios.map(|r| each(g, r))).collect()
}

/// u_1 = −a x_2, u_2 = b x_1: with Λ, rods turn at ω² = ((a + b)/2)² − Λ²((b − a)/2)².
fn elliptic(effort: &Effort) -> Vec<Expected> {
    let each = |[a, b]: [f64; 2], r: f64| {
        let scene = changed(free_scene(effort), |scene| {
            scene.flow = Flow::Gradient { gradient_per_s: [[0.0, -a, 0.0], [b, 0.0, 0.0], [0.0; 3]] };
            scene.particles.aspect_ratio = r;
        });
        let (spin, shear) = (0.5 * (a + b), 0.5 * (b - a));
        let turned = shear * (r * r - 1.0) / (r * r + 1.0);
        let period_s = TAU / (spin * spin - turned * turned).sqrt();
        (scene, [period_s, 2.0 * shear.abs() * period_s])
    };
    let flows = [[1.0, 2.0], [3.0, 0.5], [2e-4, 1e-3]];
    let ratios = [0.1, 2.0, 11.6, 1e3];
    flows.iter().flat_map(|&flow| ratios.map(|r| each(flow, r))).collect()
}

fn strained(effort: &Effort) -> Vec<Expected> {
    let extension = |e: f64| [[e, 0.0, 0.0], [0.0, -0.5 * e, 0.0], [0.0, 0.0, -0.5 * e]];
    let shear = |g: f64| [[0.0; 3], [0.0, 0.0, g], [0.0; 3]];
    [(extension(0.5), 0.5 * 3f64.sqrt()), (extension(-7.0), 7.0 * 3f64.sqrt()), (shear(0.3), 0.3)]
        .into_iter()
        .flat_map(|(gradient_per_s, rate_per_s)| {
            [(Time::strain(2.0), [1.0 / rate_per_s, 1.0]), (Time::seconds(2.0), [1.0, rate_per_s])].map(
                |(time, unit)| {
                    let scene = changed(free_scene(effort), |scene| {
                        scene.flow = Flow::Gradient { gradient_per_s };
                        scene.time = time;
                    });
                    (scene, unit)
                },
            )
        })
        .collect()
}
