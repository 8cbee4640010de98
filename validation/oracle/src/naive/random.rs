//! The protocol of random numbers: one stream per seed, replica and purpose.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;

/// SplitMix64's increment, 2^64 over the golden ratio.
pub(super) const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Purposes of the random streams; each has its own, so that no use of random numbers shifts another.
pub(super) const ASPECT_RATIOS: u64 = 0;
pub(super) const ORIENTATIONS: u64 = 1;
pub(super) const POSITIONS: u64 = 2;
pub(super) const COLLISIONS: u64 = 3;
pub(super) const REPLACEMENTS: u64 = 4;
pub(super) const LENGTHS: u64 = 5;

/// SplitMix64's finaliser.
pub(super) fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The stream of random numbers for one seed, replica and purpose.
pub fn stream(seed: u64, replica: u64, purpose: u64) -> Pcg64Dxsm {
    let key = mix(seed.wrapping_add(GOLDEN));
    let key = mix((key ^ replica).wrapping_add(GOLDEN));
    let key = mix((key ^ purpose).wrapping_add(GOLDEN));
    let mut bytes = [0; 32];
    for k in 0..4 {
        let word = mix(key.wrapping_add(GOLDEN.wrapping_mul(k as u64 + 1)));
        bytes[8 * k..8 * k + 8].copy_from_slice(&word.to_le_bytes());
    }
    Pcg64Dxsm::from_seed(bytes)
}

pub(super) fn uniform(stream: &mut Pcg64Dxsm) -> f64 {
    stream.random::<f64>()
}
