//! Tests the oracle against closed forms.

use super::*;
use std::f64::consts::{PI, TAU};

fn near(found: [f64; 3], expected: [f64; 3], within: f64) {
    let length = expected.iter().map(|x| x * x).sum::<f64>().sqrt();
    for k in 0..3 {
        assert!((found[k] - expected[k] / length).abs() <= within, "{found:?} {expected:?}");
    }
}

#[test]
fn couette_flow_is_a4_and_a5() {
    let gradient_per_s = [[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]];
    let p = [0.3, -0.5, 0.8];
    for r in [0.25, 1.0, 2.0, 11.6] {
        let rod = Rod { gradient_per_s, aspect_ratio: r, p };
        for eighths in [1.0, 3.0, 8.0, 13.0] {
            let (sin, cos) = (TAU * eighths / 8.0).sin_cos();
            let expected = [p[0] * cos - p[1] / r * sin, r * p[0] * sin + p[1] * cos, p[2]];
            let within = 32.0 * f64::EPSILON * r.max(1.0 / r) * eighths;
            near(rod.after(Span::CouettePeriods(eighths, 8.0, 0.5)), expected, within);
            let time_s = eighths / 8.0 * TAU * (r + 1.0 / r) / 0.5;
            near(rod.after(Span::Seconds(time_s)), expected, within);
            near(rod.after(Span::Strain(0.5 * time_s)), expected, within);
        }
    }
}

#[test]
fn couette_flow_comes_back_at_any_aspect_ratio() {
    // r_e = 10¹⁰⁰ needs more bits than the first computation has.
    let p = [0.6, 0.0, 0.8];
    for r in [1e-100, 1e100] {
        let rod = Rod { gradient_per_s: [[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]], aspect_ratio: r, p };
        near(rod.after(Span::CouettePeriods(7.0, 1.0, 0.5)), p, 2.0 * f64::EPSILON);
        near(rod.after(Span::CouettePeriods(1.0, 2.0, 0.5)), [-0.6, 0.0, 0.8], 2.0 * f64::EPSILON);
    }
}

#[test]
fn a_rotation_turns_by_half_the_vorticity() {
    let rod =
        Rod { gradient_per_s: [[0.0, -0.5, 0.0], [0.5, 0.0, 0.0], [0.0; 3]], aspect_ratio: 7.0, p: [1.0, 0.0, 1.0] };
    near(rod.after(Span::Seconds(PI)), [0.0, 1.0, 1.0], 2.0 * f64::EPSILON);
    // The time of 10⁶ turns is a double; the phase follows from its rounding.
    let time_s = 1e6 * 2.0 * TAU;
    let phase = -1e6f64.mul_add(TAU, -0.5 * time_s);
    let off = -1e6 * 2.449_293_598_294_706_4e-16;
    near(rod.after(Span::Seconds(time_s)), [1.0, phase + off, 1.0], 4.0 * f64::EPSILON);
}

#[test]
fn an_extension_stretches_each_axis_and_does_not_mind_its_trace() {
    let p: [f64; 3] = [1.0, 2.0, 3.0];
    for trace in [0.0, 0.7] {
        let gradient_per_s = [[1.0 + trace, 0.0, 0.0], [0.0, -0.25 + trace, 0.0], [0.0, 0.0, -0.75 + trace]];
        let shape = 0.6f64;
        let rod = Rod { gradient_per_s, aspect_ratio: 2.0, p };
        let expected = [p[0] * (2.0 * shape).exp(), p[1] * (-0.5 * shape).exp(), p[2] * (-1.5 * shape).exp()];
        near(rod.after(Span::Seconds(2.0)), expected, 4.0 * f64::EPSILON);
    }
    // A rod on an axis stays there for any time.
    let rod = Rod {
        gradient_per_s: [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]],
        aspect_ratio: 1e100,
        p: [0.0, 0.0, 1.0],
    };
    near(rod.after(Span::Strain(1e6)), [0.0, 0.0, 1.0], 0.0);
}

#[test]
fn a_chain_of_shears_is_a_polynomial() {
    // r_e = 10¹⁰⁰ in u_1 = x_2, u_2 = x_3: exp is 1 + Lt + L²t²/2.
    let rod =
        Rod { gradient_per_s: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]], aspect_ratio: 1e100, p: [0.0, 0.0, 1.0] };
    near(rod.after(Span::Seconds(3.0)), [4.5, 3.0, 1.0], 2.0 * f64::EPSILON);
}

/// This flow keeps p₂ = p₃ for ever, but any rounding leaves it.
#[test]
fn what_more_bits_than_there_are_would_settle_is_not_answered() {
    let rod = Rod {
        gradient_per_s: [[-1.0, -3.0, -3.0], [3.0, -1.0, -2.0], [3.0, -2.0, -1.0]],
        aspect_ratio: 1750.9182217714006,
        p: [0.47627719711573724, -0.6217555916546216, -0.6217555916546216],
    };
    assert_eq!(rod.settled(Span::Strain(34924.47400069361)), None);
    let soon = rod.settled(Span::Strain(10.0)).unwrap();
    assert_eq!(soon[1], soon[2]);
}
