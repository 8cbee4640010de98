//! Nearest neighbours of a few rods, by testing all pairs.

use super::Nearest;
use super::branchless::nearest_u32;
use crate::model::widest::widest;
use crate::model::work::Counters;

/// Separates the rods that have a near neighbour from those that have none, over all pairs, in integers of a small
/// unit.
///
/// The buffers are reused in every step.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    per_length: f64,
    /// The rods' coordinates in units, stored twice over: the partners `k` places ahead are a slice.
    units: [Vec<i16>; 3],
    /// For each rod the smallest distance (largest of the three components) to the partners ahead, and behind.
    ahead: Vec<i16>,
    behind: Vec<i16>,
    /// The squared distances of one rod.
    squares: Vec<f64>,
}

impl Pairs {
    pub fn new(sides: [f64; 3]) -> Self {
        Self {
            per_length: f64::from(i16::MAX) / sides.into_iter().fold(0.0, f64::max),
            units: [const { Vec::new() }; 3],
            ahead: Vec::new(),
            behind: Vec::new(),
            squares: Vec::new(),
        }
    }

    /// Like [`super::Neighbours::each_nearest`], in the order of rods.
    pub fn each_nearest(
        &mut self,
        positions: &[Vec<f64>; 3],
        reaches: impl Iterator<Item = f64>,
        work: &mut Counters,
        mut found: impl FnMut(Nearest),
    ) {
        let count = positions[0].len();
        self.find_least(positions);
        work.pairs_screened += (self.ahead.len() * (count / 2)) as u64;
        for (rod, reach) in (0..count).zip(reaches) {
            let least = self.ahead[rod].min(self.behind[rod]).min(self.behind[rod + count]);
            // Both coordinates were rounded, so their difference has an error of at most one unit.
            if f64::from(least) > reach * self.per_length + 1.0 {
                continue;
            }
            work.distances += count as u64;
            if let Some(nearest) = nearest(positions, rod, reach, &mut self.squares) {
                found(nearest);
            }
        }
    }

    fn find_least(&mut self, positions: &[Vec<f64>; 3]) {
        let count = positions[0].len();
        // Whole lanes: the places beyond the last rod repeat the first rods.
        let whole = count.next_multiple_of(LANES);
        for (units, x) in self.units.iter_mut().zip(positions) {
            units.clear();
            units.extend(x.iter().map(|x| nearest_u32(x * self.per_length) as i16));
            while units.len() < whole + count {
                units.extend_from_within(..count);
            }
        }
        self.ahead.clear();
        self.ahead.resize(whole, i16::MAX);
        self.behind.clear();
        self.behind.resize(whole + count, i16::MAX);
        let Self { units, ahead, behind, .. } = self;
        let units = units.each_ref().map(|units| &units[..]);
        widest(
            #[inline(always)]
            || least_apart(units, count, ahead, behind),
        );
    }
}

/// Lowers every rod's smallest distance to the partners ahead (`least`) and `behind`, over all pairs.
#[inline(always)]
fn least_apart([u1, u2, u3]: [&[i16]; 3], count: usize, least: &mut [i16], behind: &mut [i16]) {
    let whole = least.len();
    for ahead in 1..=count / 2 {
        let other = ahead..ahead + whole;
        closer(
            [&u1[..whole], &u2[..whole], &u3[..whole]],
            [&u1[other.clone()], &u2[other.clone()], &u3[other.clone()]],
            least,
            &mut behind[other],
        );
    }
}

#[inline(always)]
fn closer(own: [&[i16]; 3], other: [&[i16]; 3], ahead: &mut [i16], behind: &mut [i16]) {
    for rod in 0..ahead.len() {
        let apart = |axis: usize| {
            let difference = own[axis][rod].wrapping_sub(other[axis][rod]);
            difference.max(difference.wrapping_neg())
        };
        let apart = apart(0).max(apart(1)).max(apart(2));
        ahead[rod] = ahead[rod].min(apart);
        behind[rod] = behind[rod].min(apart);
    }
}

/// How many numbers of 16 bits one instruction handles on every machine.
const LANES: usize = 8;

/// The nearest other rod closer than `reach`; the lowest index if several are equally near.
fn nearest(positions: &[Vec<f64>; 3], rod: usize, reach: f64, squares: &mut Vec<f64>) -> Option<Nearest> {
    squares.resize(positions[0].len(), 0.0);
    let axes = positions.each_ref().map(|axis| &axis[..]);
    let own = axes.map(|axis| axis[rod]);
    let all = &mut squares[..];
    widest(
        #[inline(always)]
        move || squared(axes, own, all),
    );
    squares[rod] = f64::INFINITY;
    let (least, reach_square) = (least(squares), reach * reach);
    if least >= reach_square {
        return None;
    }
    let other = squares.iter().position(|square| *square == least)?;
    Some(Nearest { rod: rod as u32, other: other as u32, square: least })
}

/// The squared distance of every place to `own`.
#[inline(always)]
fn squared([x1, x2, x3]: [&[f64]; 3], own: [f64; 3], squares: &mut [f64]) {
    let count = squares.len();
    let (x1, x2, x3) = (&x1[..count], &x2[..count], &x3[..count]);
    for k in 0..count {
        squares[k] = (x1[k] - own[0]).powi(2) + (x2[k] - own[1]).powi(2) + (x3[k] - own[2]).powi(2);
    }
}

fn least(squares: &[f64]) -> f64 {
    let mut lanes = [f64::INFINITY; LANES];
    let chunks = squares.chunks_exact(LANES);
    let rest = chunks.remainder();
    let lower = |lane: &mut f64, square: f64| *lane = if square < *lane { square } else { *lane };
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, square)| lower(lane, *square));
    }
    lanes.iter_mut().zip(rest).for_each(|(lane, square)| lower(lane, *square));
    lanes.into_iter().fold(f64::INFINITY, f64::min)
}
