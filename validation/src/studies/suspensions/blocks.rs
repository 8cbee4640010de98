//! The standard deviation of a mean against its number of replicas.

use super::*;
use statrs::function::gamma::digamma;

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Block {
    pub replicas: u64,
    pub blocks: u64,
    pub deviation: f64,
}

/// Block means of 1, 2, 4, … replicas, while there are at least eight blocks.
pub fn blocks(x1: &[f64]) -> Vec<Block> {
    let sizes = (0..).map(|power| 1usize << power);
    (sizes.take_while(|size| x1.len() / size >= 8))
        .map(|size| {
            let means: Vec<_> = (x1.chunks_exact(size)).map(|block| block.iter().sum::<f64>() / size as f64).collect();
            Block { replicas: size as u64, blocks: means.len() as u64, deviation: covariance(&means, &means).sqrt() }
        })
        .collect()
}

/// The exponent of M in the standard deviation of a mean over M replicas: the mean and standard error over sixteen
/// groups of the replicas. By theory it is −½, as replicas are independent.
pub fn replicas_exponent(x1: &[f64]) -> Option<Estimate> {
    let size = x1.len() / 16;
    if size < 64 {
        return None;
    }
    Some(Estimate::mean_of(&replicas_exponents(x1, size)))
}

/// The same exponent, one for each group of `size` replicas.
pub fn replicas_exponents(x1: &[f64], size: usize) -> Vec<f64> {
    let of_group = |group: &[f64]| {
        let points: Vec<_> = (blocks(group).iter())
            .map(|block| {
                // The logarithm of a deviation from few blocks is too low on average, for normal means by this much.
                let half = 0.5 * (block.blocks - 1) as f64;
                let low = 0.5 * (digamma(half) - half.ln());
                ((block.replicas as f64).ln(), block.deviation.ln() - low)
            })
            .collect();
        slope(&points)
    };
    x1.chunks_exact(size).map(of_group).collect()
}
