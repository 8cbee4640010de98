//! The effort and the random streams of cases.

use crate::judge::accept::Design;
use std::path::PathBuf;

/// The effort and the random streams of a case.
#[derive(Clone, Debug)]
pub struct Effort {
    /// True for more replicas and samples in the same cases.
    pub full: bool,
    /// The seed from which all seeds of cases are derived.
    pub seed: u64,
    /// A folder with measured points, if the user has one.
    pub data: Option<PathBuf>,
}

/// The seed of the gate.
pub const GATE_SEED: u64 = 1;

impl Effort {
    /// The effort of `cargo test`.
    pub fn gate() -> Self {
        Self { full: false, seed: GATE_SEED, data: None }
    }

    /// `quick` for the gate, `full` with `--full`.
    pub fn pick<T>(&self, quick: T, full: T) -> T {
        if self.full { full } else { quick }
    }

    /// The number of values that a sample needs; four times as many in a full run.
    pub fn samples(&self, design: Design) -> u64 {
        self.pick(1, 4) * design.samples()
    }

    /// The seed of one of a case's streams, different for every `stream` and every seed of the run.
    pub fn seed(&self, stream: u64) -> u64 {
        // SplitMix64's output function on both; 63 bits, as scenes allow.
        let mix = |z: u64| {
            let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^ (z >> 31)
        };
        const STEP: u64 = 0x9E37_79B9_7F4A_7C15;
        mix(mix(self.seed.wrapping_add(STEP)) ^ stream.wrapping_add(STEP)) >> 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_stream_of_every_seed_has_a_seed_of_its_own() {
        let of = |seed: u64| (0..100).map(move |stream| Effort { seed, ..Effort::gate() }.seed(stream));
        let seeds: BTreeSet<_> = (0..100).flat_map(of).collect();
        assert_eq!(seeds.len(), 10_000);
        assert!(seeds.iter().all(|seed| *seed < 1 << 63));
    }
}
