//! Random streams: one per replica and purpose, so that omitting a draw does not shift any other.

use rand::SeedableRng;
use rand_pcg::Pcg64Dxsm;

/// What a random stream is for. Each purpose has its own stream, created only where it is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Gaussian aspect ratios (eq. 11).
    AspectRatios = 0,
    /// Isotropic starting directions (eq. 12).
    Orientations = 1,
    /// Starting positions (eq. 12).
    Positions = 2,
    /// One R per rod and step (eqs 8 and 9).
    Collisions = 3,
    /// New positions of rods that left the control volume (eq. 14).
    Replacements = 4,
    /// Gaussian lengths.
    Lengths = 5,
    /// Turns of rods with rotary diffusion.
    Diffusion = 6,
}

/// The PCG64-DXSM stream of one replica and purpose.
///
/// The 32 seed bytes are a SplitMix64 hash of (seed, replica, purpose): PCG streams whose states differ in only a few
/// bits would be correlated.
pub fn stream(seed: u64, replica: u64, purpose: Purpose) -> Pcg64Dxsm {
    let key = [replica, purpose as u64]
        .iter()
        .fold(mix(seed.wrapping_add(GOLDEN)), |key, word| mix((key ^ word).wrapping_add(GOLDEN)));
    let mut bytes = [0; 32];
    for (k, word) in bytes.chunks_exact_mut(8).enumerate() {
        let step = GOLDEN.wrapping_mul(k as u64 + 1);
        word.copy_from_slice(&mix(key.wrapping_add(step)).to_le_bytes());
    }
    Pcg64Dxsm::from_seed(bytes)
}

/// A copy of the stream advanced by `count` numbers.
pub(crate) fn ahead(rng: &Pcg64Dxsm, count: impl Into<u128>) -> Pcg64Dxsm {
    let mut rng = rng.clone();
    rng.advance(count.into());
    rng
}

const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// The output function of SplitMix64 (Steele, Lea & Flood 2014).
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mix_is_splitmix64() {
        // First outputs of the published generator for the seed 1234567.
        let published = [6457827717110365317, 3203168211198807973, 9817491932198370423];
        for (k, expected) in published.into_iter().enumerate() {
            let state = 1234567u64.wrapping_add(GOLDEN.wrapping_mul(k as u64 + 1));
            assert_eq!(mix(state), expected);
        }
    }
}
