//! Which nearest pairs collide, and how likely: the rule's probabilities without its draws.
//!
//! Rods draw independently, so the chance of every pair follows from the places alone (docs/time-step.md). A rod's
//! nearest neighbour is nearer than whoever has that rod for its own nearest neighbour. So a rod is always free
//! when its own draw is looked at, unless the two are each other's nearest; only its neighbour may be taken.

/// A nearest pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The rod that draws and its nearest neighbour; the lower index first where they are each other's nearest.
    pub rods: [usize; 2],
    /// Their distance, in the unit of the places.
    pub distance: f64,
    /// The probability that they collide in a step.
    pub chance: f64,
}

/// Every nearest pair, closest first, of rods at `places`.
///
/// `probability` is P_c of a distance; `contact` says whether two rods make a contact, without which there is no
/// collision and both stay free.
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
        pairs.push(Pair {
            rods: [i, j],
            distance,
            chance,
        });
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

fn nearest(places: &[[f64; 3]], i: usize) -> Option<(usize, f64)> {
    let x = places[i];
    let mut best = None;
    let mut least = f64::INFINITY;
    for (j, y) in places.iter().enumerate() {
        let square = (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2) + (x[2] - y[2]).powi(2);
        if square < least && j != i {
            (best, least) = (Some(j), square);
        }
    }
    best.map(|j| (j, least.sqrt()))
}
