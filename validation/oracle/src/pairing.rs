//! The nearest pairs and their probabilities of colliding: the rule's probabilities without its draws.
//!
//! Rods draw independently, so the probability of every pair follows from the positions alone
//! (docs/src/theory/time-step.md). A rod's nearest neighbour is nearer than any rod that has this rod as its nearest
//! neighbour. So a rod is always free when its own draw is considered, unless the two are each other's nearest; only
//! its neighbour may have collided.

use crate::naive::{self, Images};

/// A nearest pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The rod that draws and its nearest neighbour; the lower index first if they are each other's nearest.
    pub rods: [usize; 2],
    /// Their distance, in the unit of the positions.
    pub distance: f64,
    /// The probability that they collide in a step.
    pub chance: f64,
}

/// Every nearest pair of rods at `places`, closest first.
///
/// `probability` is P_c as a function of distance; `contact` is true if two rods make a contact, without which there is
/// no collision and both stay free.
pub fn nearest_pairs(
    places: &[[f64; 3]],
    probability: impl Fn(f64) -> f64,
    contact: impl Fn(usize, usize) -> bool,
) -> Vec<Pair> {
    let nearest: Vec<_> = (0..places.len()).map(|i| nearest(places, i)).collect();
    let mut pairs = Vec::new();
    let mut mutual = Vec::new();
    for (i, found) in nearest.iter().enumerate() {
        let Some((j, distance)) = *found else { continue };
        let both = nearest[j].is_some_and(|(back, _)| back == i);
        if both && j < i {
            continue;
        }
        let single = if contact(i, j) { probability(distance) } else { 0.0 };
        // Two draws for a pair of mutual neighbours.
        let chance = if both { 1.0 - (1.0 - single) * (1.0 - single) } else { single };
        mutual.push(both);
        pairs.push(Pair { rods: [i, j], distance, chance });
    }
    let mut order: Vec<_> = (0..pairs.len()).collect();
    order.sort_by(|a, b| pairs[*a].distance.total_cmp(&pairs[*b].distance));
    let mut free = vec![1.0; places.len()];
    let mut done = Vec::with_capacity(pairs.len());
    for index in order {
        let mut pair = pairs[index];
        let [i, j] = pair.rods;
        let drawn = pair.chance;
        pair.chance *= free[j];
        free[i] = 1.0 - pair.chance;
        free[j] *= 1.0 - drawn;
        done.push(pair);
    }
    done
}

/// The nearest other rod of rod i, and its distance.
fn nearest(places: &[[f64; 3]], i: usize) -> Option<(usize, f64)> {
    let j = naive::nearest(places, i, Images::None, [f64::INFINITY; 3])?;
    Some((j, naive::distance_mm(places[i], places[j])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::naive::stream;
    use rand::RngExt;

    /// The probability that each two rods collide, by trying every outcome of the draws with the rule as worded.
    fn by_enumeration(places: &[[f64; 3]], chance: &[f64], contact: impl Fn(usize, usize) -> bool) -> Vec<Vec<f64>> {
        let count = places.len();
        let mut found = vec![vec![0.0; count]; count];
        for outcome in 0..1usize << count {
            let drawn = |i: usize| outcome >> i & 1 == 1;
            let weight: f64 = (0..count).map(|i| if drawn(i) { chance[i] } else { 1.0 - chance[i] }).product();
            let mut candidates: Vec<_> = (0..count)
                .filter(|i| drawn(*i))
                .map(|i| (nearest(places, i).unwrap(), i))
                .map(|((j, distance), i)| (distance, i, j))
                .collect();
            candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut taken = vec![false; count];
            for (_, i, j) in candidates {
                if !taken[i] && !taken[j] && contact(i, j) {
                    (taken[i], taken[j]) = (true, true);
                    found[i.min(j)][i.max(j)] += weight;
                }
            }
        }
        found
    }

    #[test]
    fn chances_are_those_of_every_outcome() {
        let mut draws = stream(5, 0, 0);
        for trial in 0..40 {
            let places: Vec<_> = (0..8).map(|_| [(); 3].map(|()| draws.random::<f64>())).collect();
            let probability = |s: f64| (0.4 / (s + 0.4)).powi(2);
            let contact = |i: usize, j: usize| trial % 2 == 0 || !(i + j).is_multiple_of(3);
            let single: Vec<_> = (0..8).map(|i| probability(nearest(&places, i).unwrap().1)).collect();
            let mut expected = by_enumeration(&places, &single, contact);
            for pair in nearest_pairs(&places, probability, contact) {
                let [i, j] = pair.rods;
                let left = &mut expected[i.min(j)][i.max(j)];
                *left -= pair.chance;
            }
            let off = expected.iter().flatten().fold(0.0f64, |worst, x| worst.max(x.abs()));
            assert!(off < 1e-13, "{trial}: {off}");
        }
    }

    #[test]
    fn pairs_by_hand() {
        // 0 and 1 are each other's nearest; 2 draws with 1, 3 with 2.
        let places = [0.0, 1.0, 2.5, 4.5].map(|x| [x, 0.0, 0.0]);
        let pairs = nearest_pairs(&places, |_| 0.5, |_, _| true);
        let chances: Vec<_> = pairs.iter().map(|pair| (pair.rods, pair.chance)).collect();
        // ¾; ½ of ¼; ½ of the probability 1 − ⅛ that 2 is free.
        assert_eq!(chances, [([0, 1], 0.75), ([2, 1], 0.125), ([3, 2], 0.4375)]);
        assert_eq!(pairs[1].distance, 1.5);
        assert!(nearest_pairs(&places[..1], |_| 0.5, |_, _| true).is_empty());
    }
}
