//! When two rods collide and what a collision does (eqs 5 to 10, A.7 to A.14).

use crate::model::contact::Contact;
use crate::model::orientation::{angles, from_angles};
use nalgebra::{UnitVector3, Vector3};

/// The reach s*/a = α(R^{−1/m} − 1) in rod lengths at R = `r`: the separation at which P_c = (α/(s/a + α))^m equals R
/// (eq. 7; eq. 10 with m = 3). P_c > R is the same as s < s* (eqs 8 and 9). `alpha` and `m` are positive. Infinite for
/// R = 0.
#[inline]
pub fn reach(r: f64, alpha: f64, m: f64) -> f64 {
    alpha * libm::expm1(-libm::log(r) / m)
}

/// The reach of eqs 8 and 9 at fixed α and m, with an upper bound that needs no logarithm.
#[derive(Clone, Debug)]
pub(crate) struct Reach {
    alpha: f64,
    m: f64,
    /// Upper bounds of s*(R): entry k holds for all R in [k, k + 1)/BINS.
    bounds: Vec<f64>,
}

const BINS: usize = 256;

impl Reach {
    /// The reach for α > 0 and m > 0.
    pub fn new(alpha: f64, m: f64) -> Self {
        // s* falls with R. The slack covers a logarithm that is not monotonic in its last digits.
        let bound = |bin: usize| reach(bin as f64 / BINS as f64, alpha, m) * (1.0 + 1e-12);
        Self { alpha, m, bounds: (0..BINS).map(bound).collect() }
    }

    /// s*(R) in rod lengths, for R in [0, 1).
    pub fn of(&self, r: f64) -> f64 {
        reach(r, self.alpha, self.m)
    }

    /// An upper bound of s*(R) for R in [0, 1); s*(R) itself in the first bin, where a bound would be loose.
    #[inline]
    pub fn bound(&self, r: f64) -> f64 {
        match (r * BINS as f64) as usize {
            0 => self.of(r),
            bin => self.bounds[bin],
        }
    }
}

/// The direction rates ṗ′ of both rods after a collision, from those before it (eqs 5 and 6, A.7 to A.12).
///
/// `relative_velocity` is u(x_B) − u(x_A), `rates` are ṗ_A and ṗ_B; all in one unit of length and time. The contact
/// points' velocities along ℓ become their mean; the components normal to ℓ do not change. As ℓ is normal to both rods,
/// only ṗ·ℓ changes: ṗ′_A = ṗ_A + ℓ (v̄ − v_A)/r_A.
pub fn share_velocity(
    contact: &Contact,
    relative_velocity: &Vector3<f64>,
    rates: [Vector3<f64>; 2],
) -> [Vector3<f64>; 2] {
    let line = contact.line.as_ref();
    let [arm_a, arm_b] = contact.arms;
    let gap = line.dot(relative_velocity) + arm_b * line.dot(&rates[1]) - arm_a * line.dot(&rates[0]);
    [rates[0] + line * (0.5 * gap / arm_a), rates[1] - line * (0.5 * gap / arm_b)]
}

/// (φ̇′, θ̇′) of a rod with direction `p` whose direction moves at `rate` = V̂′_r/r (A.13, corrected:
/// the printed φ̇′ lacks 1/sin θ, and in the printed θ̇′ sin θ and cos θ are exchanged).
pub fn angle_rates(p: &UnitVector3<f64>, rate: &Vector3<f64>) -> (f64, f64) {
    let (phi, theta) = angles(p);
    let (sin_phi, cos_phi) = libm::sincos(phi);
    let (sin_theta, cos_theta) = libm::sincos(theta);
    (
        (-rate.x * sin_phi + rate.y * cos_phi) / sin_theta,
        rate.x * cos_theta * cos_phi + rate.y * cos_theta * sin_phi - rate.z * sin_theta,
    )
}

/// The direction after turning for `time` at the angular velocity p × `rate`, and the angle turned in rad:
/// A.14 without its pole.
pub fn turn(p: &UnitVector3<f64>, rate: &Vector3<f64>, time: f64) -> (UnitVector3<f64>, f64) {
    let speed = norm(rate);
    if speed == 0.0 {
        return (*p, 0.0);
    }
    let angle = speed * time;
    let (sin, cos) = libm::sincos(angle);
    let turned = p.as_ref() * cos + rate * (sin / speed);
    (UnitVector3::new_normalize(turned), angle)
}

/// The direction after A.14 taken literally, φ′ = φ + φ̇′Δt and θ′ = θ + θ̇′Δt, and the angle |ṗ′|Δt in rad.
///
/// At the pole, where φ is undefined, the rod turns as in [`turn`].
pub fn step_angles(p: &UnitVector3<f64>, rate: &Vector3<f64>, time: f64) -> (UnitVector3<f64>, f64) {
    if p.x == 0.0 && p.y == 0.0 {
        return turn(p, rate, time);
    }
    let (phi, theta) = angles(p);
    let (phi_rate, theta_rate) = angle_rates(p, rate);
    let stepped = from_angles(phi + phi_rate * time, theta + theta_rate * time);
    (stepped, norm(rate) * time)
}

/// The direction after a step with a collision: `end`, where free motion took `p`, turned by |`change`|·`time` about p
/// × `change`.
pub fn kick(end: &Vector3<f64>, p: &Vector3<f64>, change: &Vector3<f64>, time: f64) -> UnitVector3<f64> {
    let speed = norm(change);
    if speed == 0.0 {
        return UnitVector3::new_normalize(*end);
    }
    let (sin, cos) = libm::sincos(speed * time);
    // A change of rate is normal to p, so this has length 1 to round-off.
    let axis = p.cross(&(change / speed)).normalize();
    // Rodrigues' formula.
    let turned = end * cos + axis.cross(end) * sin + axis * (axis.dot(end) * (1.0 - cos));
    UnitVector3::new_normalize(turned)
}

/// |v| without overflow in the squares: a kick ∝ 1/r has no bound.
pub(crate) fn norm(v: &Vector3<f64>) -> f64 {
    let largest = v.amax();
    if largest > 0.0 && largest.is_finite() { largest * (v / largest).norm() } else { largest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_bound_is_above_the_reach_and_not_far() {
        for (alpha, m) in [(0.5, 3.0), (1e-6, 0.1), (7.0, 50.0)] {
            let table = Reach::new(alpha, m);
            for r in (0..10_000).map(|k| f64::from(k) / 10_000.0) {
                let (reach, bound) = (table.of(r), table.bound(r));
                assert!(bound >= reach, "{r}: {bound} < {reach}");
                let next = reach_of_previous_bin(r, alpha, m);
                assert!(bound <= next * (1.0 + 1e-11), "{r}: {bound} > {next}");
            }
        }
    }

    fn reach_of_previous_bin(r: f64, alpha: f64, m: f64) -> f64 {
        reach((r - 1.0 / BINS as f64).max(0.0), alpha, m)
    }

    #[test]
    fn turning_is_by_the_angle_and_towards_the_rate() {
        let (p, angle) = turn(&Vector3::x_axis(), &Vector3::new(0.0, 2.0, 0.0), 0.25);
        assert_eq!(angle, 0.5);
        assert_relative_eq!(p.into_inner(), Vector3::new(0.5f64.cos(), 0.5f64.sin(), 0.0), max_relative = 1e-15);
        let (p, angle) = turn(&Vector3::x_axis(), &Vector3::new(0.0, 1e300, 0.0), 1.0);
        assert!((p.norm() - 1.0).abs() < 1e-15 && angle == 1e300);
    }

    #[test]
    fn a_kick_turns_the_end_of_a_free_step() {
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        // About x × y = z by 0.5: x goes towards y, and z stays.
        let of = |end: Vector3<f64>| kick(&end, &x, &(2.0 * y), 0.25).into_inner();
        let (sin, cos) = 0.5f64.sin_cos();
        assert_relative_eq!(of(x), Vector3::new(cos, sin, 0.0), max_relative = 1e-15);
        assert_relative_eq!(of(y), Vector3::new(-sin, cos, 0.0), max_relative = 1e-15);
        assert_relative_eq!(of(z), z);
        assert_eq!(kick(&y, &x, &Vector3::zeros(), 0.25), Vector3::y_axis());
        // A rod without free motion turns as by its whole rate.
        let (turned, _) = turn(&Vector3::x_axis(), &(2.0 * y), 0.25);
        assert_relative_eq!(of(x), turned.into_inner(), max_relative = 1e-15);
    }

    #[test]
    fn a_length_is_known_from_nothing_to_infinity() {
        assert_eq!(norm(&Vector3::zeros()), 0.0);
        assert_eq!(norm(&Vector3::new(0.0, f64::INFINITY, 1.0)), f64::INFINITY);
        assert_relative_eq!(norm(&Vector3::new(3e300, -4e300, 0.0)), 5e300, max_relative = 1e-15);
        // A rod with rate 0 keeps its direction.
        assert_eq!(turn(&Vector3::x_axis(), &Vector3::zeros(), 1.0), (Vector3::x_axis(), 0.0));
    }

    #[test]
    fn a_step_of_the_angles_is_by_their_rates_but_at_the_pole() {
        let rate = Vector3::new(0.6, 0.0, 0.0);
        assert_eq!(step_angles(&Vector3::z_axis(), &rate, 0.5), turn(&Vector3::z_axis(), &rate, 0.5));
        // By hand, where one of p_1 and p_2 is 0 and θ̇ = 0: φ̇ = −ṗ_1/sin θ at φ = 90°, ṗ_2/sin θ at φ = 0.
        for (phi, rate, phi_rate) in [
            (std::f64::consts::FRAC_PI_2, Vector3::new(0.6, 0.0, 0.0), -0.6 / 0.4f64.sin()),
            (0.0, Vector3::new(0.0, 0.6, 0.0), 0.6 / 0.4f64.sin()),
        ] {
            let mut p = from_angles(phi, 0.4).into_inner();
            // Exactly in the plane: rounding errors are set to 0.
            p.iter_mut().filter(|x| x.abs() < 1e-15).for_each(|x| *x = 0.0);
            let (stepped, angle) = step_angles(&UnitVector3::new_unchecked(p), &rate, 0.5);
            let expected = from_angles(phi + 0.5 * phi_rate, 0.4);
            assert_relative_eq!(stepped.into_inner(), expected.into_inner(), max_relative = 1e-14);
            assert_relative_eq!(angle, 0.3, max_relative = 1e-15);
        }
    }
}
