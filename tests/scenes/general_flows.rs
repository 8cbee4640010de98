//! Scenes of free rods in any velocity gradient: each ends with numbers, or is refused with a reason.

mod uncoupled;

use crate::{file_of, parsed, planned, refusal};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use shearbed::Plan;
use shearbed::model::flow::VelocityGradient;
use shearbed::model::orientation::from_degrees;
use shearbed::motion::{Moved, Propagator, Span};
use shearbed::nalgebra::{Matrix3, UnitVector3};
use shearbed::run::ensemble;
use std::cell::Cell;

fn scene(rows: [[f64; 3]; 3], r: f64, sd: f64, orientation: &str, time: &str) -> String {
    format!(
        "title = \"t\"\n[flow]\ngradient_per_s = {rows:?}\n[particles]\ncount = 3\nlength_mm = 1\naspect_ratio = \
            {r:e}\n\
         aspect_ratio_sd_percent = {sd}\norientation = {orientation}\n[time]\n{time}\n[output]\n\
         observables = [\"projections\", \"orientation_tensor\"]\n"
    )
}

/// The end of a rod of aspect ratio `r` that starts along `p`.
fn moved(rows: [[f64; 3]; 3], r: f64, p: &UnitVector3<f64>, strain: f64) -> Moved {
    let flow = VelocityGradient::new(Matrix3::from_fn(|i, j| rows[i][j])).unwrap();
    Propagator::new(&flow, r).moved(p, Span::Strain(strain, 1.0)).unwrap()
}

/// The sine and cosine of 135°, in doubles.
fn slanted() -> (f64, f64) {
    135f64.to_radians().sin_cos()
}

/// Finite means with ⟨pp⟩ of trace 1, or a refusal that says why; whether it was not refused.
fn ends_or_is_refused(text: &str) -> bool {
    let plan = match Plan::parse("s.toml", text) {
        Ok(plan) => plan,
        Err(error) => {
            let error = error.to_string();
            assert!(error.contains("is not allowed: ") && error.len() > 60, "{error}\n{text}");
            return false;
        }
    };
    assert!(plan.error_rad().is_none_or(|error| error <= 1e-6), "{text}");
    let results = ensemble::run(&plan).unwrap();
    let mean = |name: &str, k: usize| results.column(name).unwrap().mean[k];
    for k in 0..results.times.len() {
        let trace = mean("a11", k) + mean("a22", k) + mean("a33", k);
        // |p|² of three rods: 2 · 4 ulp each, and the roundings of their mean.
        assert!((trace - 1.0).abs() <= 64.0 * f64::EPSILON, "{trace} at {k}\n{text}");
        assert!(mean("x2", k).is_finite(), "x2 at {k}\n{text}");
    }
    true
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

/// Runs 500 scenes with such components. A tenth at least must end with numbers: where all are refused, nothing was
/// tried.
fn end_or_are_refused(component: impl Strategy<Value = f64>) {
    let config = Config { rng_seed: RngSeed::Fixed(1982), failure_persistence: None, cases: 500, ..Config::default() };
    let ended = Cell::new(0);
    TestRunner::new(config)
        .run(&scenes(component), |scene| {
            ended.set(ended.get() + u32::from(ends_or_is_refused(&scene)));
            Ok(())
        })
        .unwrap();
    assert!(ended.get() >= 50, "{} of 500 ended", ended.get());
}

#[test]
fn any_gradient_ends_or_is_refused() {
    end_or_are_refused((-3i32..=3).prop_map(f64::from));
    end_or_are_refused(component());
}

/// Stretched along (1, 1, 0), a rod that starts at a right angle to it is on one side of the dividing plane or on the
/// other by a rounding.
#[test]
fn a_start_on_a_dividing_plane_is_refused_however_it_is_given() {
    let rows = [[0.25, 0.75, 0.0], [0.75, 0.25, 0.0], [0.0, 0.0, -0.5]];
    let text = |sd: f64, start: &str, strain: f64| {
        let time = format!("strain = {strain}\noutputs_per_strain = 1");
        scene(rows, 11.6, sd, start, &time)
    };
    let start = "{ phi_deg = 135, theta_deg = 90 }";
    for sd in [0.0, 1.0] {
        // Far beyond the limit, and a little.
        for strain in [100.0, 27.0] {
            let error = refusal(&text(sd, start, strain));
            let cause = "this flow amplifies the rounding of the start beyond 1e-6 rad";
            assert!(error.contains(cause), "{sd}: {error}");
        }
        planned(&parsed(&text(sd, start, 5.0)));
        // Random starts are the doubles that were drawn.
        let mut given = parsed(&text(sd, "\"isotropic\"", 100.0));
        assert!(ensemble::run(&planned(&given)).is_ok(), "{sd}");
        let (sine, cosine) = slanted();
        given.particles.rods = file_of([vec![cosine; 3], vec![sine; 3], vec![0.0; 3]]);
        let refused = Plan::new(&given).map(|plan| ensemble::run(&plan));
        assert!(!matches!(refused, Ok(Ok(_))), "{sd}");
    }
}

/// The rounding of a start grows by the longer of r_e and 1/r_e in plane Couette flow.
#[test]
fn a_rounded_start_of_extreme_rods_is_answered_as_far_as_it_is_known() {
    let rows = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
    for (r, known) in [(1e8, true), (1e-8, true), (1e10, false), (1e-10, false)] {
        let text = scene(rows, r, 0.0, "\"isotropic\"", "strain = 2\noutputs_per_strain = 2");
        let mut scene = parsed(&text);
        scene.particles.rods = file_of([vec![0.6; 3], vec![0.0; 3], vec![0.8; 3]]);
        assert_eq!(ensemble::run(&planned(&scene)).is_ok(), known, "{r:e}");
    }
}

/// A start or a period that a flow does not have, and flows next to these that are answered.
#[test]
fn what_a_flow_does_not_have_is_refused_with_its_reason() {
    // Rates that are 200 orders apart: it is not the start that is at fault. Where they are not coupled, each is known.
    let far_apart = |coupling: f64| [[0.0, 1e200, 0.0], [0.0, 0.0, 0.0], [coupling, 0.0, 1.0]];
    // The flow on which an eigenvalue solver hung: three real rates.
    let real = [[-1.0, -1.0, 0.0], [-2.0, 2.0, -1.0], [0.0, -2.0, -1.0]];
    // Couette flow along (1, 2, 3), gradient along (4, 1, −2), to 16 digits: neither det L nor tr L² is quite 0. How
    // far it then is from periodic is worked out, not guessed.
    let (along, across) = ([1.0, 2.0, 3.0], [4.0, 1.0, -2.0]);
    let rotated = along.map(|flow: f64| across.map(|gradient: f64| flow / 14f64.sqrt() * (gradient / 21f64.sqrt())));
    for (rows, r, periods, why) in [
        (far_apart(1.0), 1e91, 2, "the flow's rates cancel, or differ"),
        (far_apart(0.0), 1e91, 2, ""),
        (real, 2.0, 1, "have no period in this flow: give strain"),
        ([[0.0; 3]; 3], 2.0, 1, "have no period in this flow: give seconds"),
        (rotated, 11.6, 10, ""),
        (rotated, 1e8, 10, "have no exact period in this flow: over this time the rotating part grows by e^"),
    ] {
        let refusal = refusal(&scene(rows, r, 0.0, "\"isotropic\"", &format!("periods = {periods}")));
        assert!(if why.is_empty() { refusal.starts_with("accepted") } else { refusal.contains(why) }, "{refusal}");
    }
}

/// A rod exactly on an axis of the flow is not thrown off it by round-off, however unstable the axis.
#[test]
fn a_rod_on_an_axis_of_the_flow_stays_there() {
    for theta_deg in [0.0, 180.0] {
        let start = from_degrees(37.0, theta_deg);
        let moved = moved([[1.0, 0.3, 0.0], [-0.2, -0.5, 0.0], [0.0, 0.0, -0.5]], 11.6, &start, 1e6);
        // Else e^{−5·10⁵} beside e^{10⁶} is no direction at all.
        assert!(moved.p == start && moved.error < 1e-14, "{moved:?}");
    }
}

/// Of rods that come back, one period is worked out; the next are the same bits.
#[test]
fn what_comes_back_is_the_same_in_every_period() {
    let turned = [[0.0; 3], [0.0; 3], [0.0, 0.5, 0.0]];
    for orientation in ["\"isotropic\"", "{ phi_deg = 20, theta_deg = 70 }"] {
        let text = scene(turned, 5.0, 0.0, orientation, "periods = 3\noutputs_per_period = 8");
        let results = crate::run(&parsed(&text));
        let x2 = &results.column("x2").unwrap().mean;
        assert_eq!(x2.len(), 25);
        assert_eq!((&x2[..8], &x2[..8]), (&x2[8..16], &x2[16..24]));
        // Half a period turns a rod round; within it no two are alike.
        let mut half = x2[..4].to_vec();
        half.sort_by(f64::total_cmp);
        assert!(half.windows(2).all(|pair| pair[1] - pair[0] > 1e-6), "{x2:?}");
    }
}
