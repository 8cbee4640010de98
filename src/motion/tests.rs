//! Tests of the propagator alone; the validation suite compares it with an oracle in high precision.

use super::*;

use crate::model::orientation;
use proptest::prelude::*;

fn flow(rows: [[f64; 3]; 3]) -> VelocityGradient {
    VelocityGradient::new(Matrix3::from_fn(|i, j| rows[i][j])).unwrap()
}

fn apart(a: &UnitVector3<f64>, b: &UnitVector3<f64>) -> f64 {
    a.cross(b).norm()
}

/// Any gradient of components up to 1, a direction and an aspect ratio.
fn rod() -> impl Strategy<Value = (VelocityGradient, UnitVector3<f64>, f64)> {
    (prop::array::uniform9(-1.0f64..1.0), 0.0f64..6.2, 0.0f64..3.1, 0.05f64..20.0).prop_map(|(l, phi, theta, r)| {
        let flow = VelocityGradient::new(Matrix3::from_row_slice(&l)).unwrap();
        (flow, orientation::from_angles(phi, theta), r)
    })
}

proptest! {
    #![proptest_config(crate::fixed_seed(256))]

    /// One flow in three parts equals that flow; a flow there and back returns the rod, whatever comes between.
    #[test]
    fn flows_one_after_another_are_their_product(
        (flow, p, r) in rod(), strains in prop::array::uniform3(0.1f64..20.0), at in 0.0f64..1.0
    ) {
        let [all, part] = [strains.iter().sum::<f64>(), at * strains.iter().sum::<f64>()];
        let steps = Propagator::of_steps(&strains.map(|strain| (flow, strain)), r);
        let once = Propagator::general(&flow, r);
        let back = VelocityGradient::new(-flow.per_s()).unwrap();
        let there_and_back = Propagator::of_steps(&[(flow, all), (back, all)], r);
        for (rods, strain) in [(&steps, part), (&steps, all), (&there_and_back, part), (&there_and_back, all)] {
            let [one, other] = [&once, rods].map(|rods| rods.moved(&p, Span::Strain(strain, 1.0)).unwrap());
            prop_assert!(apart(&one.p, &other.p) <= one.error + other.error + 4.0 * f64::EPSILON);
        }
        let moved = there_and_back.moved(&p, Span::Strain(2.0 * all, 1.0)).unwrap();
        prop_assert!(apart(&p, &moved.p) <= moved.error + 4.0 * f64::EPSILON && moved.error < 1e-8);
        let (end, error) = there_and_back.direction_beside(&once, [p.x, p.y, p.z], Span::Strain(2.0 * all,
            1.0)).unwrap();
        prop_assert_eq!((Vector3::from(end), error), (moved.p.into_inner(), moved.error));
        let (map, _) = there_and_back.map(Span::Strain(2.0 * all, 1.0)).unwrap();
        prop_assert!((map / map.amax() - Matrix3::identity()).amax() < 1e-8);
    }

    /// Also for tiny or huge seconds, with a trace, and by the map. Rounded times move a rod by 1e-11 at most here.
    #[test]
    fn a_time_is_the_same_in_seconds_strain_and_periods(
        (flow, p, r) in rod(), power in -150i32..150, trace in -3.0f64..3.0
    ) {
        let scale = 10f64.powi(power);
        let per_s = scale * flow.per_s();
        let flow = VelocityGradient::new(per_s).unwrap();
        let rods = Propagator::general(&flow, r);
        let time_s = 3.0 / scale;
        let moved = rods.moved(&p, Span::Seconds(time_s, 1.0)).unwrap();
        prop_assert!(moved.error < 1e-15, "{}", moved.error);
        let by_strain = rods.moved(&p, Span::Strain(flow.magnitude_per_s() * time_s, 1.0)).unwrap();
        prop_assert!(apart(&moved.p, &by_strain.p) < 1e-9);
        if let Some(period_s) = rods.period_s() {
            let by_periods = rods.moved(&p, Span::Periods(time_s / period_s, 1.0)).unwrap();
            prop_assert!(apart(&moved.p, &by_periods.p) < 1e-9);
        }
        let swelling = VelocityGradient::new(per_s + trace * scale * Matrix3::identity()).unwrap();
        let in_swelling = Propagator::general(&swelling, r).moved(&p, Span::Seconds(time_s, 1.0)).unwrap();
        prop_assert!(apart(&moved.p, &in_swelling.p) < 1e-9);
        let (map, error) = rods.map(Span::Seconds(time_s, 1.0)).unwrap();
        let by_map = UnitVector3::new_normalize(map * p.as_ref());
        prop_assert!(apart(&moved.p, &by_map) < 1e-9);
        // The map's largest component is about 1, and its error is that of 106 bits.
        prop_assert!((0.5..=2.0).contains(&map.amax()) && error < 1e-24, "{} {error}", map.amax());
    }

    #[test]
    fn plane_couette_flow_by_either_way(phi in 0.0f64..6.2, theta in 0.0f64..3.1, r in 0.05f64..50.0,
        turns in 0.0f64..3.0) {
        let p = orientation::from_angles(phi, theta);
        let flow = VelocityGradient::plane_couette(-0.5).unwrap();
        let (closed, general) = (Propagator::new(&flow, r), Propagator::general(&flow, r));
        let strain = turns * jeffery::strain_per_period(r);
        for span in [
            Span::Periods(turns, 1.0),
            Span::Periods(7.0 * turns, 7.0),
            Span::Strain(3.0 * strain, 3.0),
            Span::Seconds(strain / 0.5, 1.0),
        ] {
            let by_form = closed.moved(&p, span).unwrap();
            let by_modes = general.moved(&p, span).unwrap();
            prop_assert!(apart(&by_form.p, &by_modes.p) <= by_form.error + by_modes.error, "{span:?}");
            prop_assert!(by_modes.error < 1e-14);
            // The larger of r_e and 1/r_e is the condition, and the factor from a phase's error to a direction's.
            let longer = r.max(1.0 / r);
            prop_assert_eq!(by_form.condition, longer);
            let (_, of_phase) = closed.map(span).unwrap();
            prop_assert_eq!(by_form.error, of_phase * longer);
        }
    }

    /// Rods of another aspect ratio are observed at the mean rods' periods.
    #[test]
    fn periods_are_those_of_the_mean(phi in 0.0f64..6.2, theta in 0.0f64..3.1, r in 2.0f64..30.0,
        turns in 0.0f64..5.0) {
        let p = orientation::from_angles(phi, theta);
        // Shear u_3 = x_2/2, alone and with an extension that leaves a rotating part.
        for rows in [
            [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.5, 0.0]],
            [[-0.2, 0.0, 0.0], [0.0, 0.1, -0.5], [0.0, 0.5, 0.1]],
        ] {
            let [mean, rods] = [11.6, r].map(|r| Propagator::new(&flow(rows), r));
            let span = Span::Periods(turns * 4.0, 4.0);
            let seconds = Span::Seconds(turns * mean.period_s().unwrap(), 1.0);
            let moved = rods.moved_beside(&mean, &p, span).unwrap();
            prop_assert!(apart(&moved.p, &rods.moved(&p, seconds).unwrap().p) < 1e-9);
            let (direction, error) = rods.direction_beside(&mean, (*p).into(), span).unwrap();
            prop_assert_eq!(error, moved.error);
            prop_assert!(apart(&moved.p, &UnitVector3::new_normalize(direction.into())) < 1e-9);
            for (rods, mean) in [(&rods, &mean), (&rods, &rods)] {
                let (map, _) = rods.map_beside(mean, span).unwrap();
                let seconds = Span::Seconds(turns * mean.period_s().unwrap(), 1.0);
                let by_map = UnitVector3::new_normalize(map * p.as_ref());
                prop_assert!(apart(&rods.moved(&p, seconds).unwrap().p, &by_map) < 1e-9);
            }
            let (own, _) = rods.map(Span::Periods(turns, 1.0)).unwrap();
            let by_map = UnitVector3::new_normalize(own * p.as_ref());
            prop_assert!(apart(&rods.after_turns(&p, turns).unwrap(), &by_map) < 1e-9);
        }
    }
}

/// Turns are rounded once; turns computed from seconds or strain have four roundings.
#[test]
fn the_error_of_a_phase_grows_with_its_turns() {
    let flow = VelocityGradient::plane_couette(0.5).unwrap();
    let propagator = Propagator::new(&flow, 11.6);
    let strain = 1e6 * jeffery::strain_per_period(11.6);
    for (span, roundings) in
        [(Span::Periods(1e6, 1.0), 1.0), (Span::Strain(strain, 1.0), 4.0), (Span::Seconds(2.0 * strain, 1.0), 5.0)]
    {
        let (_, error) = propagator.map(span).unwrap();
        let expected = roundings * TAU * 1e6 * f64::EPSILON;
        assert!((error / expected - 1.0).abs() < 1e-5, "{error} {expected}");
    }
    let (_, of_nothing) = propagator.map(Span::Seconds(0.0, 1.0)).unwrap();
    assert_eq!(of_nothing, 16.0 * f64::EPSILON);
}

#[test]
fn a_direction_and_a_map_have_no_size() {
    let ball = |hi: f64, error: f64| Ball { hi, lo: 0.0, error };
    for size in [1e-5, 1.0, 3e7] {
        let q = [ball(3.0 * size, 3e-6 * size), ball(-4.0 * size, 4e-6 * size), Ball::ZERO];
        let (p, error) = normalized(&q);
        let expected = [0.6, -0.8, 0.0];
        assert!((0..3).all(|k| (p[k] - expected[k]).abs() < 1e-15), "{p:?}");
        // The error has the length 5e-6 · size, the vector 5 · size.
        assert!((error / 1.01e-6 - 1.0).abs() < 1e-9, "{error}");

        let map = [0, 1, 2].map(|i| [0, 1, 2].map(|j| ball(if i == j { 4.0 * size } else { 0.0 }, 4e-20 * size)));
        let (_, error) = general::rounded(&map);
        // Nine components have that error, three have that size.
        assert!((error / (3f64.sqrt() * 1e-20) - 1.0).abs() < 1e-12, "{error}");
        let moved = moved(&map, &q, [0.6, -0.8, 0.0]);
        // The map multiplies by 4, and the rod has grown to 5.
        assert!((moved.condition - 0.8).abs() < 1e-12, "{}", moved.condition);
    }
    let exact = [3.0, 4.0, 0.0].map(Ball::exact);
    assert_eq!(normalized(&exact).1, 4.0 * f64::EPSILON);
}

/// The flow leads from this axis nowhere else, though it leads other axes there: L_21 = ρL_12, to the bit at r_e = 2.
#[test]
fn a_rod_stays_on_an_axis_that_other_axes_lead_to() {
    let flow = flow([[-1.0, 1.0, 0.0], [0.25, 0.5, 0.3], [0.0, -0.2, 0.5]]);
    let moved = Propagator::new(&flow, 2.0).moved(&Vector3::x_axis(), Span::Seconds(1e3, 1.0)).unwrap();
    assert!(moved.p == Vector3::x_axis() && moved.error < 1e-15, "{moved:?}");
}

#[test]
fn a_spiral_keeps_its_phase_over_many_turns() {
    // Rotation about axis 3 with compression along it: p falls into the plane and turns there at ½.
    let spiral = flow([[0.1, -0.5, 0.0], [0.5, 0.1, 0.0], [0.0, 0.0, -0.2]]);
    let propagator = Propagator::new(&spiral, 5.0);
    // Λ times a growth at 0.1 against −0.2, while the rod turns at ½.
    let drift = propagator.drift_per_period().unwrap();
    let expected = 0.3 * jeffery::shape_factor(5.0) * 2.0 * TAU;
    assert!((drift / expected - 1.0).abs() < 1e-12, "{drift}");
    let p = orientation::from_angles(0.3, 1.0);
    let turns = 1e6;
    let end = propagator.after(&p, turns * 2.0 * TAU);
    let expected = orientation::from_angles(0.3, std::f64::consts::FRAC_PI_2);
    // The time 1.3·10⁷ s is rounded to 2·10⁻⁹ s.
    assert!(apart(&end, &expected) < 1e-8, "{end:?}");
}

/// A rod is drawn into the plane of axes 1 and 2 and turns in it by 1.5 rad, ever more slowly. If all axes are coupled,
/// however weakly, cancellation hides the turning in the eigenvalues, until it is unknown.
#[test]
fn the_bound_on_a_slow_spiral_is_kept() {
    let p = UnitVector3::new_normalize(Vector3::new(0.6, 0.0, 0.8));
    let expected = UnitVector3::new_normalize(Vector3::new(libm::cos(1.5), libm::sin(1.5), 0.0));
    let spirals: Vec<_> = (6..56)
        .map(|k| {
            let turning = 0.3 * libm::exp2(-f64::from(k));
            let moved = |coupling: f64| {
                let flow = flow([[0.7, -turning, coupling], [turning, 0.7, 0.0], [0.0, 0.0, -1.4]]);
                let rods = Propagator::new(&flow, 3.3);
                rods.moved(&p, Span::Seconds(1.5 / turning, 1.0)).unwrap()
            };
            // The bound allows a hundred roundings of 2⁻¹⁰² in the exponent; a bound as wide as double precision's
            // would fail.
            let exponent = 1.05 / turning;
            let uncoupled = moved(0.0);
            assert!(
                apart(&uncoupled.p, &expected) <= uncoupled.error + 4.0 * f64::EPSILON
                    && uncoupled.error <= 4.0 * f64::EPSILON + 100.0 * libm::exp2(-102.0) * exponent,
                "{k}: {uncoupled:?}"
            );
            let moved = moved(1e-290);
            let off = apart(&moved.p, &expected);
            assert!(off <= moved.error + 4.0 * f64::EPSILON, "{k}: {off:e} beyond {:e}", moved.error);
            moved.error
        })
        .collect();
    assert!(spirals[0] < 1e-15 && spirals.last().unwrap() > &1e-3, "{spirals:?}");
}

#[test]
fn a_pure_rotation_has_the_period_of_its_vorticity() {
    let rotation = flow([[0.0, -0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0]]);
    let period = Propagator::new(&rotation, 7.0).period_s().unwrap();
    assert!((period / (2.0 * TAU) - 1.0).abs() < 1e-14);
}

/// A sphere turns by Gt/2; the library's sine and cosine of it are right to the last digit.
#[test]
fn the_bound_on_a_phase_is_kept_and_nearly_reached() {
    let propagator = Propagator::new(&VelocityGradient::plane_couette(1.0).unwrap(), 1.0);
    let start = orientation::from_degrees(0.0, 90.0);
    let (mut worst, mut least_room) = (0.0f64, f64::INFINITY);
    for k in 0..1000 {
        let time_s = 1e7 * (1.0 + 0.618_033_988_749_895 * f64::from(k));
        let moved = propagator.moved(&start, Span::Seconds(time_s, 1.0)).unwrap();
        let (sine, cosine) = (0.5 * time_s).sin_cos();
        let off = (moved.p.x * sine - moved.p.y * cosine).abs();
        worst = worst.max(off / moved.error);
        least_room = least_room.min(moved.error - off);
    }
    assert!(least_room >= 0.0 && worst > 0.05, "{least_room:e} {worst}");
}

#[test]
fn a_phase_of_1e8_periods_is_not_lost() {
    let p = orientation::from_angles(0.2, 0.9);
    let rotated = flow([[0.0, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, 0.0]]);
    for flow in [VelocityGradient::plane_couette(0.5).unwrap(), rotated] {
        let propagator = Propagator::new(&flow, 11.6);
        let near = propagator.after_turns(&p, 0.125).unwrap();
        let far = propagator.after_turns(&p, 1e8 + 0.125).unwrap();
        // 10⁸ + ⅛ turns is a double; but only the general method keeps turns in 106 bits.
        assert!(apart(&near, &far) < 4.0 * f64::EPSILON);
    }
}

/// Fifty stretches there and back: no number overflows, though each map shrinks what the one before it stretched.
#[test]
fn many_flows_one_after_another_keep_their_size() {
    let there = flow([[2.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]);
    let back = flow([[-2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let rods = Propagator::of_steps(&[(there, 10.0), (back, 10.0)].repeat(50), 11.6);
    let p = orientation::from_angles(0.3, 1.2);
    let moved = rods.moved(&p, Span::Strain(1000.0, 1.0)).unwrap();
    assert!(moved.error < 1e-10 && apart(&p, &moved.p) <= moved.error + 4.0 * f64::EPSILON, "{moved:?}");
}
