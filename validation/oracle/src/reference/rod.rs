//! The direction of one free rod.

use super::big::{Big, Bits, double, length};
use super::motion::{Motion, Unit, image};

/// The initial direction of a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// Angles in degrees: φ from axis 1 towards axis 2, θ from axis 3, 0 ≤ θ ≤ 180. Whole quarter turns are exact.
    Angles {
        /// φ in degrees.
        phi_deg: f64,
        /// θ in degrees.
        theta_deg: f64,
    },
    /// The direction p, whose length does not matter.
    Vector([f64; 3]),
}

/// The state of a rod at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Rod {
    /// The direction p, of length 1.
    pub p: [Big; 3],
    /// φ in (−π, π], rad. On the vorticity axis it is the φ of A.4 if the start has one, else `None`.
    pub phi: Option<Big>,
    /// θ in [0, π], rad.
    pub theta: Big,
    /// C/(1 + C) with the orbit constant C of eq. 13; `None` except in plane Couette flow.
    pub c_b: Option<Big>,
}

/// Bits of the answers: 80 more than may be lost.
const PRECISION: usize = 208;

/// Bits of angles, to which 100 and more are good.
const OF_ANGLES: Bits = Bits(128);

/// The rod at `time`; `None` if the unit is undefined in this flow. See [`At::time`].
pub fn at(motion: &Motion, start: Direction, time: &Big, unit: Unit) -> Option<Rod> {
    At::new(motion, start, [double(time)], unit).time(time)
}

/// A rod whose directions at several times are asked for.
pub struct At<'a> {
    motion: &'a Motion,
    start: Start,
    c_b: Option<Big>,
    unit: Unit,
}

impl<'a> At<'a> {
    /// A rod from its start, in the bits that the hardest of `times` needs.
    pub fn new(motion: &'a Motion, start: Direction, times: impl IntoIterator<Item = f64>, unit: Unit) -> Self {
        let needed = times.into_iter().map(|time| motion.bits(time, unit, PRECISION).0);
        let bits = Bits(needed.max().unwrap_or(PRECISION));
        let start = Start::new(start, bits);
        let c_b = motion.couette().map(|_| OF_ANGLES.round(c_b(&start.p, motion.aspect_ratio, bits)));
        Self { motion, start, c_b, unit }
    }

    /// The rod at a time.
    ///
    /// p by A.4 and A.5 in the form p = F p₀/|F p₀| (`motion.rs`), φ and θ by p = (sin θ cos φ, sin θ sin φ, cos θ),
    /// C = (r_e² p₁² + p₂²)^½/(r_e|p₃|) (eq. 13). Every number holds to 100 bits and more.
    pub fn time(&self, time: &Big) -> Option<Rod> {
        let bits = self.motion.bits(double(time), self.unit, PRECISION);
        let map = self.motion.map(time, self.unit, bits)?;
        let q = image(&map, &self.start.p);
        let long = length(&q);
        let p = q.map(|x| OF_ANGLES.round(x / &long));
        let theta = angle(&(p[0].sqr() + p[1].sqr()).sqrt(), &p[2]);
        let phi = match (&self.start.along, self.motion.couette()) {
            (Some(along), Some(_)) => {
                let q = image(&map, along).map(|x| OF_ANGLES.round(x));
                Some(angle(&q[1], &q[0]))
            }
            _ if p[0] == Big::ZERO && p[1] == Big::ZERO => None,
            _ => Some(angle(&p[1], &p[0])),
        };
        Some(Rod { c_b: self.c_b.clone(), p, phi, theta })
    }
}

/// atan2(y, x) to the bits of angles: the double φ next to it is off by atan δ, δ = (y cos φ − x sin φ)/(x cos φ + y
/// sin φ), and δ³ is below these bits. Takes half the time of the crate's own.
fn angle(y: &Big, x: &Big) -> Big {
    let near = OF_ANGLES.of(double(y).atan2(double(x)));
    let (sine, cosine) = near.sin_cos();
    near + (y * &cosine - x * &sine) / (x * &cosine + y * &sine)
}

/// p at t = 0, and C_b, which is constant in plane Couette flow and meaningless in others.
pub fn orbit(motion: &Motion, start: Direction) -> ([Big; 3], Big) {
    let bits = motion.bits(0.0, Unit::Period, PRECISION);
    let start = Start::new(start, bits);
    let c_b = c_b(&start.p, motion.aspect_ratio, bits);
    (start.p, c_b)
}

/// C_b of a rod along p, which is constant in plane Couette flow.
fn c_b(p: &[Big; 3], aspect_ratio: f64, bits: Bits) -> Big {
    let r = bits.of(aspect_ratio);
    let across = ((&r * &p[0]).sqr() + p[1].sqr()).sqrt();
    let along = r * if p[2] < Big::ZERO { -&p[2] } else { p[2].clone() };
    &across / (along + &across)
}

/// A direction in doubles.
pub fn nearest(direction: Direction) -> [f64; 3] {
    Start::new(direction, OF_ANGLES).p.each_ref().map(double)
}

struct Start {
    p: [Big; 3],
    /// (cos φ, sin φ, 0) if the start is given by angles: it turns by A.4 for every θ.
    along: Option<[Big; 3]>,
}

impl Start {
    fn new(direction: Direction, bits: Bits) -> Self {
        match direction {
            Direction::Vector(p) => Self { p: p.map(|x| bits.of(x)), along: None },
            Direction::Angles { phi_deg, theta_deg } => {
                let (sine, cosine) = bits.of(theta_deg).sin_cos_unit(360);
                let (across, along) = bits.of(phi_deg).sin_cos_unit(360);
                Self { p: [&sine * &along, &sine * &across, cosine], along: Some([along, across, bits.of(0.0)]) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{angles_at, orbit_constant_from_angles};
    use crate::quadrature::spread;
    use std::f64::consts::TAU;

    fn couette(aspect_ratio: f64) -> Motion {
        Motion { gradient_per_s: [[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]], aspect_ratio }
    }

    fn rod(aspect_ratio: f64, phi_deg: f64, theta_deg: f64, turns: f64) -> Rod {
        let start = Direction::Angles { phi_deg, theta_deg };
        at(&couette(aspect_ratio), start, &Bits(64).of(turns), Unit::Period).unwrap()
    }

    #[test]
    fn angles_and_orbits_are_those_of_a_4_a_5_and_eq_13() {
        for (u, v) in spread(100) {
            let (r, phi_deg, theta_deg) =
                (100f64.powf(2.0 * u - 1.0), 720.0 * (v - 0.5), 180.0 * (7.0 * u + v).fract());
            let found = rod(r, phi_deg, theta_deg, 3.0 * v);
            let (phi0, theta0) = (phi_deg.to_radians(), theta_deg.to_radians());
            let (phi, theta) = angles_at(phi0, theta0, r, 3.0 * v);
            // The tolerance covers the conditioning of the formula in doubles, and φ₀ up to 4π.
            let tolerance = 2e-14 * r.max(1.0 / r);
            let apart = |phi: f64| {
                let turns = (double(found.phi.as_ref().unwrap()) - phi) / TAU;
                (turns - turns.round()).abs() * TAU
            };
            assert!(apart(phi) < tolerance && (double(&found.theta) - theta).abs() < tolerance, "{r}");
            // Wrong variant: half a turn less.
            assert!(apart(angles_at(phi0, theta0, r, 3.0 * v - 0.5).0) > 1.0);
            let c = orbit_constant_from_angles(phi0, theta0, r);
            let c_b = double(found.c_b.as_ref().unwrap());
            assert!((c_b - c / (1.0 + c)).abs() < 1e-13, "{r}");
            let p = found.p.map(|x| double(&x));
            let from_p = (r * p[0]).hypot(p[1]) / (r * p[2].abs());
            assert!((from_p / (1.0 + from_p) - c_b).abs() < 1e-13);
        }
    }

    #[test]
    fn angles_are_those_of_the_slower_function_to_100_bits() {
        let bits = OF_ANGLES;
        let off = |x: f64, y: f64, change: f64| {
            let (x, y) = (bits.of(x), bits.of(y) / bits.of(3.0));
            let exact = y.atan2(&x);
            let found = angle(&y, &x) * bits.of(1.0 + change);
            double(&((found - &exact) / exact)).abs()
        };
        for (u, v) in spread(50) {
            for (x, y) in
                [(u - 0.5, v - 0.5), (-1.0, 1e-30 * v), (1e-30 * u, -1.0), (1.0, 1e-320), (1e100 * u, 1e90 * v)]
            {
                assert!(off(x, y, 0.0) < 2f64.powi(-110), "{x} {y}");
                // Wrong: a last digit of a double.
                assert!(off(x, y, f64::EPSILON) > 2f64.powi(-110));
            }
        }
    }

    #[test]
    fn poles_planes_and_whole_turns_are_exact() {
        for r in [1e-100, 0.3, 1.0, 1e100] {
            let pole = rod(r, 40.0, 180.0, 0.3);
            assert_eq!(pole.p.map(|x| double(&x)), [0.0, 0.0, -1.0]);
            assert_eq!(double(&pole.c_b.unwrap()), 0.0);
            let plane = rod(r, 90.0, 90.0, 0.25);
            assert_eq!(plane.p.map(|x| double(&x)), [-1.0, 0.0, 0.0]);
            assert_eq!(double(&plane.c_b.unwrap()), 1.0);
            let (start, later) = (rod(r, 33.0, 44.0, 0.0), rod(r, 33.0, 44.0, 1e6));
            assert_eq!(start.p, later.p);
            let other = rod(r, 33.0, 44.0, 1e6 + 0.5);
            assert_eq!(other.p[2], start.p[2]);
            assert_eq!(double(&other.p[0]), -double(&start.p[0]));
        }
    }
}
