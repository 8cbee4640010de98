//! A rod at a place of its orbit, from the poles to the plane of shear, without angles: every component keeps all its
//! digits at any aspect ratio.

use super::*;

/// A place on an orbit: p ∝ (c cos κ, r_e c sin κ, z), with κ growing by 2π in a period (A.4, A.5; C = c/|z|, eq. 13).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    c: f64,
    z: f64,
    cos: f64,
    sin: f64,
}

impl Place {
    /// The place on the orbit C = `c`/|`z`| at the azimuth of (`x`, `y`), which need not be a unit vector.
    pub fn new(c: f64, z: f64, [x, y]: [f64; 2], aspect_ratio: f64) -> Self {
        let (cos, sin) = (x, y / aspect_ratio);
        let length = cos.hypot(sin);
        Self { c, z, cos: cos / length, sin: sin / length }
    }

    /// The place φ = 1 and θ = 1: in the flip of a rod, and of a disc.
    pub fn mid_flip(aspect_ratio: f64) -> Self {
        let (sin, cos) = 1f64.sin_cos();
        Self::new(1f64.tan() * cos.hypot(sin / aspect_ratio), 1.0, [cos, sin], aspect_ratio)
    }

    /// The place `turns` periods earlier. Whole periods change nothing, and are removed exactly.
    pub fn before(&self, turns: f64) -> Self {
        let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
        Self { cos: self.cos * cos + self.sin * sin, sin: self.sin * cos - self.cos * sin, ..*self }
    }

    pub fn direction(&self, aspect_ratio: f64) -> UnitVector3<f64> {
        let p = Vector3::new(self.c * self.cos, aspect_ratio * self.c * self.sin, self.z);
        // Scaled first: no square overflows or vanishes.
        UnitVector3::new_normalize(p / p.amax())
    }

    /// How far a direction of any length has left this orbit: the change of C_b.
    pub fn orbit_error(&self, p: &Vector3<f64>, aspect_ratio: f64) -> f64 {
        let in_plane = p.x.hypot(p.y / aspect_ratio);
        (in_plane / (in_plane + p.z.abs()) - self.bounded_orbit_constant()).abs()
    }

    pub fn bounded_orbit_constant(&self) -> f64 {
        self.c / (self.c + self.z.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poles_and_the_plane_of_shear() {
        let at = |c, z, xy| Place::new(c, z, xy, 1e8).direction(1e8).into_inner();
        assert_eq!(at(0.0, -1.0, [1.0, 0.0]), -Vector3::z());
        assert_eq!(at(1.0, 0.0, [1.0, 0.0]), Vector3::x());
        // p_3/p_2 = |z|/(r_e c).
        let along = at(1.0, 1e-290, [0.0, 1.0]);
        assert!(along.y == 1.0 && (along.z / 1e-298 - 1.0).abs() < 1e-15);
        let thin = at(1e-300, 1.0, [1.0, 0.0]);
        assert_eq!((thin.x, thin.z), (1e-300, 1.0));
        assert_eq!(Place::new(1.0, 0.0, [1.0, 1.0], 3.0).bounded_orbit_constant(), 1.0);
    }
}
