//! Tests of contacts and of the rates after them.

use super::*;

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
