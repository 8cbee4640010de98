//! Tests of contacts and of the rates after them.

use super::*;
use crate::naive::contact::Rod;
use crate::naive::motion::angle_rates_per_s;

#[test]
fn a_contact_worked_by_hand() {
    // u_2 = 2 x_1. A: x = 0, p = e1. B: x = (2,5,3), p = e3. Line: e1 x e3 = -e2.
    // (r_A, -c, 0) = (2, 5, 3 + r_B): r_A = 2, r_B = -3, c = -5.
    // V_A = 2 (0,.5,1) = (0,1,2). V_B = (0,4,0) - 3 (.25,-1,0) = (-.75,7,0). Mean: 4 e2.
    // V_A' = (0,4,2), less 0, over 2: (0,2,1).
    // V_B' = (-.75,4,0), less (0,4,0), over -3: (.25,0,0).
    let gradient = [[0.0; 3], [2.0, 0.0, 0.0], [0.0; 3]];
    let (e1, e3) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let (wa, wb) = ([0.0, 0.5, 1.0], [0.25, -1.0, 0.0]);
    let with = |xb, pb| collide([0.0; 3], e1, wa, xb, pb, wb, gradient);
    let expected = Contact {
        line: [0.0, -1.0, 0.0],
        arm_a_mm: 2.0,
        arm_b_mm: -3.0,
        gap_mm: -5.0,
        pdot_a_per_s: [0.0, 2.0, 1.0],
        pdot_b_per_s: [0.25, 0.0, 0.0],
    };
    assert_eq!(with([2.0, 5.0, 3.0], e3), Some(expected));
    assert_eq!(with([2.0, 5.0, 3.0], e1), None, "parallel");
    assert_eq!(with([0.0, 5.0, 3.0], e3), None, "no arm");
}

/// Largest violation of the geometry, of A.9, of A.10 and of "twice is once" over random pairs.
fn contact_defect(made: Option<Mistake>) -> f64 {
    let mut draws = stream(7, 0, 0);
    let mut cube = || Vector3::from_fn(|_, _| 2.0 * uniform(&mut draws) - 1.0);
    let gradient = Matrix3::new(0.1, 0.2, -0.3, 0.5, -0.4, 0.6, 0.7, -0.8, 0.3);
    let mut worst: f64 = 0.0;
    for _ in 0..200 {
        let [a, b] = [0; 2].map(|_| {
            let (x, p) = (cube(), cube().normalize());
            [x, p, cube().cross(&p)]
        });
        let c = contact(a, b, gradient, made).expect("random rods are in contact");
        let (line, ra, rb) = (vector(c.line), c.arm_a_mm, c.arm_b_mm);
        let after_a = [a[0], a[1], vector(c.pdot_a_per_s)];
        let after_b = [b[0], b[1], vector(c.pdot_b_per_s)];
        let twice = contact(after_a, after_b, gradient, made).expect("the same geometry");
        let v = |rod: Rod, arm: f64| gradient * rod[0] + rod[2] * arm;
        let (va, vb, va2, vb2) = (v(a, ra), v(b, rb), v(after_a, ra), v(after_b, rb));
        for residual in [
            a[0] + a[1] * ra + line * c.gap_mm - b[0] - b[1] * rb,
            line.cross(&(va2 - va)),
            line.cross(&(vb2 - vb)),
            line * line.dot(&(va2 - vb2)),
            line * line.dot(&(va2 + vb2 - va - vb)),
            (vector(twice.pdot_a_per_s) - after_a[2]) * ra,
            (vector(twice.pdot_b_per_s) - after_b[2]) * rb,
        ] {
            worst = worst.max(residual.amax());
        }
    }
    worst
}

#[test]
fn contacts_keep_the_rule_and_sabotaged_ones_break_it() {
    assert!(contact_defect(None) < 1e-9);
    for mistake in &Mistake::ALL[..6] {
        assert!(contact_defect(Some(*mistake)) > 1e-2, "{mistake:?}");
    }
}

#[test]
fn rods_in_the_shear_plane_do_not_disturb_each_other() {
    let gradient = fibres(2, 0.5, |_| ()).gradient_per_s();
    let changed = |theta| {
        let [pa, pb] = [axis([0.3, FRAC_PI_2]), axis([2.0, theta])];
        let [wa, wb] = [pa, pb].map(|p| jeffery(p, 11.6, gradient));
        let contact = collide([0.1, 0.2, 0.3], pa, wa, [0.6, -0.4, 0.9], pb, wb, gradient);
        let c = contact.expect("the rods are not parallel");
        far(&[wa, wb], &[c.pdot_a_per_s, c.pdot_b_per_s])
    };
    assert!(changed(FRAC_PI_2) < 1e-14);
    assert!(changed(1.2) > 1e-3);
}

#[test]
fn a13_is_the_rate_of_the_angles_and_its_print_is_not() {
    let p = axis([0.7, 1.1]);
    let w: [f64; 3] = vector([0.3, -0.5, 0.8]).cross(&vector(p)).into();
    let [after, before] = [1e-5, -1e-5].map(|dt| angles_rad(rotated(p, w, dt)));
    let moved = |made| [moved_by_angles(p, w, 1e-5, made)];
    assert!(far(&moved(None), &[rotated(p, w, 1e-5)]) < 1e-9);
    assert!(far(&moved(Some(Mistake::PrintedA13)), &[rotated(p, w, 1e-5)]) > 1e-7);
    let rates = |made| angle_rates_per_s([0.7, 1.1], w, made);
    for k in 0..2 {
        let rate = (after[k] - before[k]) / 2e-5;
        assert!((rates(None)[k] - rate).abs() < 1e-8);
        assert!((rates(Some(Mistake::PrintedA13))[k] - rate).abs() > 1e-2);
    }
}
