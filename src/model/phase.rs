//! The phase of a turning rod: sine and cosine, with the same bits for a single rod and for many side by side.

use std::f64::consts::TAU;

/// The sine and cosine of 2π·turns, exact at every quarter turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// cos(2π·turns).
    pub cos: f64,
    /// sin(2π·turns).
    pub sin: f64,
}

impl Phase {
    /// The phase of `turns` (a finite number of periods).
    pub fn of_turns(turns: f64) -> Self {
        Self::of_part(turns.fract())
    }

    /// The phase of `turns`, |turns| < 2⁵¹, without a branch or a call, so that it vectorises over rods: the nearest
    /// quarter turn is removed, and the polynomials of fdlibm (Sun Microsystems 1993, `k_sin.c` and `k_cos.c`), good to
    /// 1 ulp up to π/4, give the rest.
    #[inline(always)]
    pub(crate) fn of_part(turns: f64) -> Self {
        let rest = turns - nearest_whole(turns);
        let quarters = nearest_whole(4.0 * rest);
        let angle = TAU * (rest - 0.25 * quarters);
        let z = angle * angle;
        let (s, c) = (horner(&SIN, z), horner(&COS, z));
        let sin = angle + angle * z * s;
        let half = 0.5 * z;
        let near_one = 1.0 - half;
        let cos = near_one + ((1.0 - near_one) - half + z * z * c);
        // Quarter turns are −2 … 2: odd ones exchange sine and cosine.
        let odd = quarters.abs() == 1.0;
        let (x, y) = (if odd { sin } else { cos }, if odd { cos } else { sin });
        let opposite = quarters.abs() == 2.0;
        Self {
            cos: if opposite | (quarters == 1.0) { -x } else { x },
            sin: if opposite | (quarters == -1.0) { -y } else { y },
        }
    }
}

/// S1 … S6 of fdlibm's `k_sin.c`, and C1 … C6 of its `k_cos.c`.
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// The polynomial Σ cₖ zᵏ.
#[inline(always)]
fn horner(c: &[f64; 6], z: f64) -> f64 {
    c[0] + z * (c[1] + z * (c[2] + z * (c[3] + z * (c[4] + z * c[5]))))
}

/// The nearest whole number (ties to even) for |x| < 2⁵¹: adding 1.5 · 2⁵² leaves no digits for a fraction. Takes two
/// instructions on every machine, unlike `f64::round`.
#[inline(always)]
pub(crate) fn nearest_whole(x: f64) -> f64 {
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    (x + SHIFT) - SHIFT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_and_cosines_are_those_of_the_library() {
        for k in -40_000..=40_000 {
            let turns = f64::from(k) / 16_384.0 + 1e-5 * f64::from(k % 7);
            let phase = Phase::of_turns(turns);
            let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
            // The library's argument is rounded too, by up to π ε/2.
            assert!((phase.sin - sin).abs() <= 4.0 * f64::EPSILON, "{turns}");
            assert!((phase.cos - cos).abs() <= 4.0 * f64::EPSILON, "{turns}");
            assert!((phase.sin.hypot(phase.cos) - 1.0).abs() <= 2.0 * f64::EPSILON, "{turns}");
        }
        let quarters = [(0.0, 1.0, 0.0), (0.25, 0.0, 1.0), (-1e15, 1.0, 0.0), (7.5, -1.0, 0.0), (-2.25, 0.0, -1.0)];
        for (turns, cos, sin) in quarters.into_iter().chain([(1e8 + 0.75, 0.0, -1.0)]) {
            assert_eq!(Phase::of_turns(turns), Phase { cos, sin });
        }
        assert_eq!(Phase::of_turns(1e300), Phase { cos: 1.0, sin: 0.0 });
    }
}
