//! Scenes of free rods in any velocity gradient: each ends with numbers, or is refused with a reason.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use shearbed::flow::VelocityGradient;
use shearbed::orientation::from_degrees;
use shearbed::propagator::{Propagator, Span};
use shearbed::scene::Orientation;
use shearbed::{Plan, ensemble, scene_file};
use std::sync::Arc;

fn scene(rows: [[f64; 3]; 3], r: f64, sd: f64, orientation: &str, time: &str) -> String {
    format!(
        "title = \"t\"\n[flow]\ngradient_per_s = {rows:?}\n[particles]\ncount = 3\nlength_mm = 1\naspect_ratio = {r:e}\n\
         aspect_ratio_sd_percent = {sd}\norientation = {orientation}\n[time]\n{time}\n[output]\n\
         observables = [\"projections\", \"orientation_tensor\"]\n"
    )
}

/// Finite means with ⟨pp⟩ of trace 1, or a refusal that says why.
fn ends_or_is_refused(text: &str) {
    let scene = match scene_file::parse("s.toml", text) {
        Ok(scene) => scene,
        Err(error) => {
            let error = error.to_string();
            assert!(
                error.contains("is not allowed: ") && error.len() > 60,
                "{error}\n{text}"
            );
            return;
        }
    };
    let plan = Plan::new(&scene).unwrap();
    assert!(plan.error_rad().is_none_or(|error| error <= 1e-6), "{text}");
    let results = ensemble::run(&plan).unwrap();
    let mean = |name: &str, k: usize| results.column(name).unwrap().mean[k];
    for k in 0..results.times.len() {
        let trace = mean("a11", k) + mean("a22", k) + mean("a33", k);
        // |p|² of three rods: 2 · 4 ulp each, and the roundings of their mean.
        assert!(
            (trace - 1.0).abs() <= 64.0 * f64::EPSILON,
            "{trace} at {k}\n{text}"
        );
        assert!(mean("x2", k).is_finite(), "x2 at {k}\n{text}");
    }
}

fn component() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-3i32..=3).prop_map(f64::from),
        -1.0f64..1.0,
        (-300.0f64..300.0).prop_map(|e| 10f64.powf(e)),
        Just(0.0),
    ]
}

/// Scenes with these components of the gradient.
fn scenes(component: impl Strategy<Value = f64>) -> impl Strategy<Value = String> {
    let rows = prop::array::uniform9(component);
    let r = prop_oneof![-100.0f64..100.0, -2.0f64..2.0];
    let sd = prop_oneof![Just(0.0), Just(1.0)];
    let start = prop::sample::select(vec![
        "\"isotropic\"",
        "{ phi_deg = 0, theta_deg = 0 }",
        "{ phi_deg = 90, theta_deg = 90 }",
        "{ phi_deg = 20, theta_deg = 70 }",
        "{ phi_deg = 45, theta_deg = 90 }",
    ]);
    let time = prop::sample::select(vec![
        "strain = 2\noutputs_per_strain = 2",
        "strain = 1000\noutputs_per_strain = 1",
        "periods = 2\noutputs_per_period = 3",
        "periods = 100\noutputs_per_period = 1",
    ]);
    (rows, r, sd, start, time).prop_map(|(rows, r, sd, start, time)| {
        let rows = [0, 3, 6].map(|k| [rows[k], rows[k + 1], rows[k + 2]]);
        scene(rows, 10f64.powf(r), sd, start, time)
    })
}

proptest! {
    #![proptest_config(Config { rng_seed: RngSeed::Fixed(1982), failure_persistence: None, cases: 500, ..Config::default() })]

    #[test]
    fn any_gradient_of_whole_numbers_ends_or_is_refused(scene in scenes((-3i32..=3).prop_map(f64::from))) {
        ends_or_is_refused(&scene);
    }

    #[test]
    fn any_gradient_of_mixed_sizes_ends_or_is_refused(scene in scenes(component())) {
        ends_or_is_refused(&scene);
    }
}

/// Stretched along (1, 1, 0), a rod that starts at a right angle to it is on one side of the dividing plane or on the other by a
/// rounding.
#[test]
fn a_start_on_a_dividing_plane_is_refused_however_it_is_given() {
    let rows = [[0.25, 0.75, 0.0], [0.75, 0.25, 0.0], [0.0, 0.0, -0.5]];
    let told = |sd: f64, start: &str, strain: f64| {
        let time = format!("strain = {strain}\noutputs_per_strain = 1");
        scene_file::parse("s.toml", &scene(rows, 11.6, sd, start, &time))
    };
    let start = "{ phi_deg = 135, theta_deg = 90 }";
    for sd in [0.0, 1.0] {
        // Far beyond the limit, and a little.
        for strain in [100.0, 27.0] {
            let error = told(sd, start, strain).unwrap_err().to_string();
            let cause = "this flow amplifies the rounding of the start beyond 1e-6 rad";
            assert!(error.contains(cause), "{sd}: {error}");
        }
        assert!(told(sd, start, 5.0).is_ok(), "{sd}");
        // Random starts are the doubles that were drawn.
        let random = Plan::new(&told(sd, "\"isotropic\"", 100.0).unwrap()).unwrap();
        assert!(ensemble::run(&random).is_ok(), "{sd}");

        let mut given = told(sd, "\"isotropic\"", 100.0).unwrap();
        let (sine, cosine) = (135f64.to_radians().sin(), 135f64.to_radians().cos());
        given.particles.orientation = Orientation::Each {
            file: "start.csv".into(),
            crc32: None,
            p: Some(Arc::new([vec![cosine; 3], vec![sine; 3], vec![0.0; 3]])),
        };
        let refused = Plan::new(&given).map(|plan| ensemble::run(&plan));
        assert!(!matches!(refused, Ok(Ok(_))), "{sd}");
    }
}

/// The rounding of a start grows by the longer of r_e and 1/r_e in plane Couette flow.
#[test]
fn a_rounded_start_of_extreme_rods_is_answered_as_far_as_it_is_known() {
    let rows = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
    for (r, known) in [(1e8, true), (1e-8, true), (1e10, false), (1e-10, false)] {
        let text = scene(
            rows,
            r,
            0.0,
            "\"isotropic\"",
            "strain = 2\noutputs_per_strain = 2",
        );
        let mut scene = scene_file::parse("s.toml", &text).unwrap();
        scene.particles.orientation = Orientation::Each {
            file: "start.csv".into(),
            crc32: None,
            p: Some(Arc::new([vec![0.6; 3], vec![0.0; 3], vec![0.8; 3]])),
        };
        let plan = Plan::new(&scene).unwrap();
        assert_eq!(ensemble::run(&plan).is_ok(), known, "{r:e}");
    }
}

/// Rates that are 200 orders apart: it is not the start that is at fault. Where they are not coupled, each is known.
#[test]
fn rates_beyond_all_digits_are_refused_as_such() {
    let parsed = |coupling: f64| {
        let rows = [[0.0, 1e200, 0.0], [0.0, 0.0, 0.0], [coupling, 0.0, 1.0]];
        let text = scene(rows, 1e91, 0.0, "\"isotropic\"", "periods = 2");
        scene_file::parse("s.toml", &text).map_err(|error| error.to_string())
    };
    let error = parsed(1.0).unwrap_err();
    assert!(
        error.contains("the flow's rates cancel, or grow apart"),
        "{error}"
    );
    assert!(parsed(0.0).is_ok());
}

/// The flow on which an eigenvalue solver hung.
#[test]
fn three_real_rates_have_no_period() {
    let rows = [[-1.0, -1.0, 0.0], [-2.0, 2.0, -1.0], [0.0, -2.0, -1.0]];
    let error =
        scene_file::parse("s.toml", &scene(rows, 2.0, 0.0, "\"isotropic\"", "periods = 1")).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("have no period in this flow: give strain"),
        "{error}"
    );
}

/// A rotation in space is rounded: how far Couette flow then is from periodic is told, not guessed.
#[test]
fn a_rounded_rotation_of_couette_flow_has_a_period_for_as_long_as_it_has() {
    // Flow along (1, 2, 3), gradient along (4, 1, −2), to 16 digits: neither det L nor tr L² is quite 0.
    let (along, across) = ([1.0, 2.0, 3.0], [4.0, 1.0, -2.0]);
    let rows =
        along.map(|flow: f64| across.map(|gradient: f64| flow / 14f64.sqrt() * (gradient / 21f64.sqrt())));
    let told = |r: f64, time: &str| scene_file::parse("s.toml", &scene(rows, r, 0.0, "\"isotropic\"", time));
    assert!(
        told(11.6, "periods = 10").is_ok(),
        "{:?}",
        told(11.6, "periods = 10")
    );
    let error = told(1e8, "periods = 10").unwrap_err().to_string();
    assert!(
        error.contains("have no period in this flow") && error.contains("give strain"),
        "{error}"
    );
}

/// Next to parabolic: |det A| < 16 ε, and a strain of 10⁶. Digits from 80-digit arithmetic (issue 9).
#[test]
fn a_nearly_parabolic_flow_is_not_taken_as_planar() {
    let flow = VelocityGradient::new(nalgebra::Matrix3::new(
        1.5e-7, 0.0, 0.0, 1.0, 1.5e-7, 0.0, 0.0, 0.0, -3e-7,
    ))
    .unwrap();
    let moved = Propagator::new(&flow, 1e4)
        .moved(&from_degrees(90.0, 45.0), Span::Strain(1e6, 1.0))
        .unwrap();
    assert!(
        (moved.p.y.abs() - 0.804).abs() < 5e-4 && (moved.p.z - 0.595).abs() < 5e-4,
        "{moved:?}"
    );
    assert!(moved.error < 1e-12, "{moved:?}");
}

/// A rod exactly on an axis of the flow is not thrown off it by round-off, however unstable the axis.
#[test]
fn a_rod_on_an_axis_of_the_flow_stays_there() {
    for theta_deg in [0.0, 180.0] {
        let flow = VelocityGradient::new(nalgebra::Matrix3::new(
            1.0, 0.3, 0.0, -0.2, -0.5, 0.0, 0.0, 0.0, -0.5,
        ))
        .unwrap();
        let start = from_degrees(37.0, theta_deg);
        let moved = Propagator::new(&flow, 11.6)
            .moved(&start, Span::Strain(1e6, 1.0))
            .unwrap();
        // Else e^{−5·10⁵} beside e^{10⁶} is no direction at all.
        assert!(moved.p == start && moved.error < 1e-14, "{moved:?}");
    }
}

/// Of rods that come back, one period is worked out; the next are the same bits.
#[test]
fn what_comes_back_is_the_same_in_every_period() {
    let turned = [[0.0; 3], [0.0; 3], [0.0, 0.5, 0.0]];
    for orientation in ["\"isotropic\"", "{ phi_deg = 20, theta_deg = 70 }"] {
        let text = scene(
            turned,
            5.0,
            0.0,
            orientation,
            "periods = 3\noutputs_per_period = 8",
        );
        let plan = Plan::new(&scene_file::parse("s.toml", &text).unwrap()).unwrap();
        let results = ensemble::run(&plan).unwrap();
        let x2 = &results.column("x2").unwrap().mean;
        assert_eq!(x2.len(), 25);
        assert_eq!((&x2[..8], &x2[..8]), (&x2[8..16], &x2[16..24]));
        // Half a period turns a rod round; within it no two are alike.
        let mut half = x2[..4].to_vec();
        half.sort_by(f64::total_cmp);
        assert!(half.windows(2).all(|pair| pair[1] - pair[0] > 1e-6), "{x2:?}");
    }
}

/// ∂u_i/∂x_j, r_e, start, strain and the direction there.
type Answered = ([[f64; 3]; 3], f64, [f64; 3], f64, [f64; 3]);

/// The double next to 1.
const NEXT: f64 = 1.0 + f64::EPSILON;

/// Starts of which little lies in the coordinates that the flow draws out, where N couples these with no others, so that no digit of
/// the end is lost. The ends are exp(At)p/|exp(At)p| of the doubles given, in arithmetic of 1400 digits (mpmath 1.3: Taylor's series,
/// scaled and squared; at a strain of 3e16 the exponentials of the diagonal), rounded to doubles.
const UNCOUPLED: [Answered; 13] = [
    // Nearly equal rates, equal ones, and other orders of the axes.
    (
        [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, NEXT]],
        100.0,
        [7.06e-16, 1.0, -5.4e-15],
        1861.0,
        [0.12963747943857756, 0.0, -0.9915614574623262],
    ),
    (
        [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 1.0]],
        100.0,
        [7.06e-16, 1.0, -5.4e-15],
        2550.0,
        [0.12963747943859275, 0.0, -0.9915614574623242],
    ),
    (
        [[-2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, NEXT]],
        100.0,
        [1.0, -5.4e-15, 7.06e-16],
        1e5,
        [0.0, -0.9915614574622174, 0.1296374794394096],
    ),
    (
        [[NEXT, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -2.0]],
        100.0,
        [7.06e-16, -5.4e-15, 1.0],
        1861.0,
        [0.12963747943860796, -0.9915614574623222, 0.0],
    ),
    // So long that the nearly equal rates come apart.
    (
        [[NEXT, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -2.0]],
        100.0,
        [7.06e-16, -5.4e-15, 1.0],
        3e16,
        [0.6665225509932107, -0.7454848684027751, 0.0],
    ),
    // The other sign: a disc that moves as the rod of 1/r_e above, and a rod.
    (
        [[-1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -NEXT]],
        0.01,
        [7.06e-16, 1.0, -5.4e-15],
        1861.0,
        [0.12963747943857756, 0.0, -0.9915614574623262],
    ),
    (
        [[-1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -NEXT]],
        100.0,
        [0.6, 1e-200, -0.8],
        531.9,
        [0.4179019797048527, 0.717553589479119, -0.5572026396064513],
    ),
    // A start below the normal numbers.
    (
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]],
        100.0,
        [5e-320, 0.6, 0.8],
        1475.0,
        [0.9955530888533654, 0.0, 0.09420216172956544],
    ),
    // A slow rotation of two axes that grows against the third, on other axes, of a disc; and as fast as the third to a rounding.
    (
        [[0.5, -0.001, 0.0], [0.001, 0.5, 0.0], [0.0, 0.0, -1.0]],
        11.6,
        [3e-16, 1e-16, 1.0],
        3e3,
        [-0.46444253748300623, 0.8856032573203118, 0.0],
    ),
    (
        [[-1.0, 0.0, 0.0], [0.0, 0.5, 0.001], [0.0, -0.001, 0.5]],
        11.6,
        [1.0, 1e-16, -3e-16],
        3e3,
        [0.0, -0.9871481283460531, -0.1598079244057821],
    ),
    (
        [[1.0, 0.0, 0.0], [0.0, -0.5, -0.001], [0.0, 0.001, -0.5]],
        0.08,
        [1.0, 1e-16, -3e-16],
        3e3,
        [0.0, 0.8856032573203118, 0.46444253748300623],
    ),
    (
        [[1.0, -2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, NEXT]],
        11.6,
        [1e-14, -2e-14, 1.0],
        1e4,
        [-9.324567374151727e-15, 2.0323691674595243e-14, 1.0],
    ),
    // Two coupled axes beside one of its own.
    (
        [[1.0, 0.0, 0.25], [0.0, -2.0, 0.0], [0.25, 0.0, 1.0]],
        100.0,
        [7e-16, 1.0, -5e-15],
        1861.0,
        [
            -std::f64::consts::FRAC_1_SQRT_2,
            0.0,
            -std::f64::consts::FRAC_1_SQRT_2,
        ],
    ),
];

#[test]
fn coordinates_that_are_not_coupled_keep_their_digits() {
    let mut lost = Vec::new();
    for (rows, r, p, strain, expected) in UNCOUPLED {
        let flow = VelocityGradient::new(nalgebra::Matrix3::from_fn(|i, j| rows[i][j])).unwrap();
        let start = nalgebra::UnitVector3::new_unchecked(p.into());
        let moved = Propagator::new(&flow, r)
            .moved(&start, Span::Strain(strain, 1.0))
            .unwrap();
        let off = (moved.p.into_inner() - nalgebra::Vector3::from(expected)).norm();
        // The end is rounded to 4 ε; 106 bits of the largest exponent, 3e16, leave 1e-14. Terms of one block may cancel a little.
        if !(off <= moved.error && moved.error < 1e-13 && moved.condition < 1.5) {
            lost.push((rows, r, p, strain, off, moved));
        }
    }
    assert!(lost.is_empty(), "{} of 13: {lost:#?}", lost.len());
}

/// A scene whose rods start in a file, as read.
fn from_file(rows: [[f64; 3]; 3], r: f64, strain: f64, p: [f64; 3]) -> shearbed::Scene {
    let time = format!("strain = {strain}\noutputs_per_strain = 1");
    let text = scene(rows, r, 0.0, "\"isotropic\"", &time);
    let mut scene = scene_file::parse("s.toml", &text).unwrap();
    scene.particles.orientation = Orientation::Each {
        file: "start.csv".into(),
        crc32: None,
        p: Some(Arc::new(p.map(|component| vec![component; 3]))),
    };
    scene
}

#[test]
fn a_scene_of_rates_that_nearly_meet_ends() {
    let (rows, r, p, strain, expected) = UNCOUPLED[0];
    let plan = Plan::new(&from_file(rows, r, strain, p)).unwrap();
    let results = ensemble::run(&plan).unwrap();
    for (name, expected) in ["x1", "x2", "x3"].iter().zip(expected) {
        let last = *results.column(name).unwrap().mean.last().unwrap();
        assert!(
            (last - expected.abs()).abs() <= 8.0 * f64::EPSILON,
            "{name}: {last}"
        );
    }
}

/// On a dividing plane to a rounding: the bound first exceeds 1e-6 rad at some output on the way.
#[test]
fn a_refused_rod_is_named_with_its_bound_and_the_time() {
    let rows = [[0.25, 0.75, 0.0], [0.75, 0.25, 0.0], [0.0, 0.0, -0.5]];
    let (sine, cosine) = (135f64.to_radians().sin(), 135f64.to_radians().cos());
    let mut scene = from_file(rows, 11.6, 100.0, [cosine, sine, 0.0]);
    // The first rod lies on the flow's axis.
    let p = [
        vec![0.5f64.sqrt(), cosine],
        vec![0.5f64.sqrt(), sine],
        vec![0.0; 2],
    ];
    scene.particles.count = 2;
    let Orientation::Each { p: starts, .. } = &mut scene.particles.orientation else {
        unreachable!("from a file");
    };
    *starts = Some(Arc::new(p));
    let error = ensemble::run(&Plan::new(&scene).unwrap())
        .unwrap_err()
        .to_string();
    // The start's rounding, 4 ε, grows by e^{1.5Λ strain/√3}, which is 1e-6/4 ε = 1.1e9 at a strain of 24.4.
    assert!(
        error.starts_with("rod 1, output 25 (strain = 25) of replica 0, seed "),
        "{error}"
    );
    for part in [
        " rad, more than the 1e-6 rad allowed",
        "r_e = 11.6",
        "this flow amplifies the rounding of the start",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
    assert!(!error.contains("NaN"), "{error}");
}
