//! The contact line of two rods: the shortest line between the lines through their axes (Fig. 2).

use nalgebra::{UnitVector3, Vector3};

/// The contact line of two rods A and B: where the lines through their axes come closest.
///
/// ```
/// use shearbed::model::contact::contact;
/// use shearbed::nalgebra::Vector3;
/// let met = contact(&Vector3::new(2.0, 3.0, 5.0), &Vector3::x(), &Vector3::y(), [0.0; 2]).expect("not parallel");
/// assert_eq!((met.line, met.arms), (Vector3::z_axis(), [2.0, -3.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The unit vector ℓ along the contact line, ∝ p_A × p_B.
    pub line: UnitVector3<f64>,
    /// The signed arms r_A and r_B from each centre to its contact point, in the unit of the separation.
    /// They may lie beyond the rods' ends: the paper's lines are infinite. Neither is 0.
    pub arms: [f64; 2],
}

/// The contact of two rods with directions `p_a`, `p_b` and `separation` = x_B − x_A.
///
/// `None` if there is no unique contact line (parallel rods), or if an arm is exactly 0 or shorter than
/// `min_arms`: turning such a rod could not move its contact point.
pub fn contact(
    separation: &Vector3<f64>,
    p_a: &Vector3<f64>,
    p_b: &Vector3<f64>,
    min_arms: [f64; 2],
) -> Option<Contact> {
    let normal = p_a.cross(p_b);
    let square = normal.norm_squared();
    // x_A + r_A p_A + c ℓ = x_B + r_B p_B, solved by triple products: they keep their digits where the
    // rods are nearly parallel, and do not change sign with p → −p except through the arm itself.
    let arms = [separation.dot(&p_b.cross(&normal)) / square, separation.dot(&p_a.cross(&normal)) / square];
    let line = UnitVector3::try_new(normal, 0.0)?;
    let usable = |(r, min): (f64, f64)| r.is_finite() && r != 0.0 && r.abs() >= min;
    let all_usable = arms.into_iter().zip(min_arms).all(usable);
    all_usable.then_some(Contact { line, arms })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_contact_for_parallel_rods_or_too_short_an_arm() {
        let (x, y) = (Vector3::x(), Vector3::y());
        let minus_x = -x;
        let none = |d: [f64; 3], a, b, min| contact(&Vector3::from(d), a, b, [min; 2]).is_none();
        assert!(none([2.0, 3.0, 1.0], &x, &x, 0.0));
        assert!(none([2.0, 3.0, 1.0], &x, &minus_x, 0.0));
        assert!(none([0.0, 3.0, 1.0], &x, &y, 0.0), "arm of A is 0");
        assert!(none([2.0, 3.0, 1.0], &x, &y, 2.5));
        assert!(!none([2.0, 3.0, 1.0], &x, &y, 2.0), "an arm equal to the bound is kept");
        assert!(!none([f64::MIN_POSITIVE, 3.0, 1.0], &x, &y, 0.0));
    }
}
