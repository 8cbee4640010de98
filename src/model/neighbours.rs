//! The search for every rod's nearest neighbour in the control volume.

mod branchless;
mod grid;
mod pairs;

use crate::model::work::Counters;
use grid::Grid;
pub(crate) use grid::bytes;
use pairs::Pairs;

/// A rod and its nearest neighbour within its reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Index of the rod that searches.
    pub rod: u32,
    /// Index of the nearest other rod; the lowest index if several are equally near.
    pub other: u32,
    /// The square of the distance between the two rods.
    pub square: f64,
}

/// Searches for nearest neighbours in a volume [0, H₁) × [0, H₂) × [0, H₃). Allocates nothing after the first step.
#[derive(Clone, Debug)]
pub struct Neighbours(Search);

#[derive(Clone, Debug)]
enum Search {
    Pairs(Pairs),
    Grid(Grid),
}

/// Up to this number of rods, testing all pairs is faster than sorting rods into cells.
const FEW: usize = 256;

impl Neighbours {
    /// A search for `count` rods in a volume with these `sides`.
    pub fn new(sides: [f64; 3], count: usize) -> Self {
        Self(if count <= FEW { Search::Pairs(Pairs::new(sides)) } else { Search::Grid(Grid::new(sides, count)) })
    }

    /// Calls `found` with every rod that has another rod closer than its reach, rounded up, and with the nearest one.
    /// `positions` are three arrays of coordinates in the volume; `reaches` gives those of the rods from a given one
    /// on; `work` counts the cells and distances.
    pub fn each_nearest<R: Iterator<Item = f64>>(
        &mut self,
        positions: &[Vec<f64>; 3],
        reaches: impl Fn(usize) -> R + Sync,
        work: &mut Counters,
        found: impl FnMut(Nearest),
    ) {
        match &mut self.0 {
            Search::Pairs(pairs) => pairs.each_nearest(positions, reaches(0), work, found),
            Search::Grid(grid) => grid.each_nearest(positions, reaches, work, found),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::RngExt;

    fn brute(positions: &[Vec<f64>; 3], rod: usize, reach: f64) -> Option<Nearest> {
        (0..positions[0].len())
            .filter(|other| *other != rod)
            .map(|other| Nearest {
                rod: rod as u32,
                other: other as u32,
                square: (0..3).map(|k| (positions[k][other] - positions[k][rod]).powi(2)).sum::<f64>(),
            })
            .filter(|nearest| nearest.square < reach * reach)
            .min_by(|a, b| a.square.total_cmp(&b.square).then(a.other.cmp(&b.other)))
    }

    /// What `search` finds, in the order of rods. A search may report rods a little beyond the reach; they are removed
    /// here by the exact reach.
    fn found(search: Search, positions: &[Vec<f64>; 3], reach: &[f64]) -> Vec<Nearest> {
        let mut all = Vec::new();
        Neighbours(search).each_nearest(
            positions,
            |first| reach[first..].iter().copied(),
            &mut Counters::default(),
            |nearest| all.push(nearest),
        );
        all.retain(|nearest| nearest.square < reach[nearest.rod as usize].powi(2));
        all.sort_by_key(|nearest| nearest.rod);
        all
    }

    fn searches(sides: [f64; 3], count: usize) -> [Search; 2] {
        [Search::Pairs(Pairs::new(sides)), Search::Grid(Grid::new(sides, count))]
    }

    proptest! {
        #![proptest_config(crate::fixed_seed(512))]

        #[test]
        fn both_searches_find_what_a_full_search_finds(
            points in prop::collection::vec(prop::array::uniform3(0u8..40), 1..300),
            reaches in prop::collection::vec(prop_oneof![
                0.0f64..2e-7, 0.0f64..0.02, 0.0f64..0.2, 0.2f64..1.0, 1.0f64..40.0, Just(f64::INFINITY)
            ], 300),
            side in prop_oneof![Just(4.0), Just(1e-3), Just(3e5)],
            // The least are below what single precision tells apart.
            fine in prop_oneof![Just(0.0), 0.0f64..1.0, Just(1e-5), Just(1e-6)],
            shape in prop::sample::select(vec![[1.0, 1.0, 1.0], [4.0, 0.5, 0.5], [0.5, 1.0, 2.0], [1.0, 1e-4,
                1.0], [1e-3, 1.0, 1e-3]]),
        ) {
            // Coordinates on a coarse lattice, so that ties and coincident rods occur; or shifted off it by `fine`.
            let place = |k: usize, i: usize, x: u8| {
                let off = fine * ((i * 3 + k) as f64 * 0.618_033_988_749).fract();
                (f64::from(x) + off) * shape[k] * side / 40.0
            };
            let positions: [Vec<f64>; 3] = std::array::from_fn(|k| {
                points.iter().enumerate().map(|(i, p)| place(k, i, p[k])).collect()
            });
            let reach: Vec<f64> = reaches.iter().map(|reach| reach * side / 4.0).collect();
            let expected: Vec<_> =
                (0..points.len()).filter_map(|rod| brute(&positions, rod, reach[rod])).collect();
            for search in searches(shape.map(|share: f64| share * side), points.len()) {
                prop_assert_eq!(&found(search, &positions, &reach), &expected);
            }
        }
    }

    #[test]
    fn many_rods_on_many_threads_find_what_a_full_search_finds() {
        let count = 2 * crate::model::chunks::CHUNK + 100;
        let volume = crate::model::volume::ControlVolume::holding(count, 0.02);
        let stream = |purpose| crate::model::random::stream(8, 0, purpose);
        let positions = volume.draw_positions(count, &stream(crate::model::random::Purpose::Positions));
        let mut draws = stream(crate::model::random::Purpose::Collisions);
        let reach: Vec<f64> = (0..count).map(|_| draws.random::<f64>().powi(-2) / 4.0 - 0.25).collect();
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| found(Search::Grid(Grid::new(volume.sides(), count)), &positions, &reach))
        };
        let all = on(3);
        assert_eq!(all, on(1));
        for rod in (0..count).step_by(997) {
            let own = all.binary_search_by_key(&(rod as u32), |nearest| nearest.rod).ok();
            assert_eq!(own.map(|k| all[k]), brute(&positions, rod, reach[rod]));
        }
    }

    #[test]
    fn who_is_near_in_the_next_cell_but_beyond_the_window_is_found() {
        // Cells are 1 wide. Rod 0 is close to a cell's face; four others in its cell and one in the next lie between it
        // and its partner, all of them farther than the reach.
        let far = [0.05, 0.05];
        let row =
            [(0.5, 0.95), (far[0], 0.5), (far[0], 0.5), (far[0], 0.5), (far[0], 0.5), (far[1], 1.95), (0.5, 1.05)];
        for mirrored in [false, true] {
            let mut points: Vec<[f64; 3]> = row.map(|(x, z)| [x, x, z]).into();
            if mirrored {
                points.iter_mut().for_each(|p| p[2] = 10.0 - p[2]);
                points.reverse();
            }
            let positions: [Vec<f64>; 3] = std::array::from_fn(|k| points.iter().map(|p| p[k]).collect());
            let reach = points.iter().map(|p| if p[0] == 0.5 { 0.2 } else { 0.0 }).collect::<Vec<_>>();
            let all = found(Search::Grid(Grid::new([10.0; 3], 1000)), &positions, &reach);
            let pairs: Vec<_> = all.iter().map(|nearest| (nearest.rod, nearest.other)).collect();
            assert_eq!(pairs, [(0, 6), (6, 0)]);
        }
    }

    #[test]
    fn rods_at_the_walls_are_found() {
        // Of a coordinate just below a side the quotient by a cell's width may round to the number of cells.
        for side in [10.0_f64, 3.7, 7.3, 9.9, 11.1, 271.441_761_659_490_6] {
            pairs_at_the_walls(side, side - 1e-9);
            pairs_at_the_walls(side, side.next_down());
        }
    }

    fn pairs_at_the_walls(side: f64, last: f64) {
        // Eight corners, and for each a partner 0.1 away along axis 1, 2 or 3.
        let corners: Vec<[f64; 3]> =
            (0..8).map(|k| [k & 1, k & 2, k & 4].map(|bit| if bit > 0 { last } else { 0.0 })).collect();
        for axis in 0..3 {
            let mut points = corners.clone();
            points.extend(corners.iter().map(|corner| {
                let mut partner = *corner;
                partner[axis] = (partner[axis] - 0.1).abs();
                partner
            }));
            let positions: [Vec<f64>; 3] = std::array::from_fn(|k| points.iter().map(|p| p[k]).collect());
            for search in searches([side; 3], 1000) {
                let all = found(search, &positions, &[0.2; 16]);
                assert_eq!(all.len(), 16);
                assert!(all.iter().all(|nearest| nearest.rod.abs_diff(nearest.other) == 8));
            }
        }
    }

    #[test]
    fn who_is_barely_within_reach_is_found() {
        for k in 1..200 {
            let x = |by: f64| f64::from(k) * 0.047 + by;
            let by = f64::from(k).sqrt() * 0.007;
            let positions = [vec![x(0.0), x(by)], vec![x(0.0), x(0.3 * by)], vec![x(0.0), x(0.1 * by)]];
            let square: f64 = positions.iter().map(|axis| (axis[1] - axis[0]).powi(2)).sum();
            let barely = [square.sqrt().next_up().next_up(); 2];
            for search in searches([10.0; 3], 1000) {
                assert_eq!(found(search, &positions, &barely).len(), 2, "{k}");
            }
        }
    }

    #[test]
    fn a_short_reach_computes_few_distances() {
        let n = 1000;
        let positions: [Vec<f64>; 3] = std::array::from_fn(|k| {
            (0..n).map(|i| ((i as f64 + 0.5) * [0.618_033_99, 0.754_877_67, 0.569_840_29][k]).fract() * 10.0).collect()
        });
        for search in searches([10.0; 3], n) {
            let mut work = Counters::default();
            Neighbours(search).each_nearest(&positions, |_| std::iter::repeat(0.1), &mut work, |_| ());
            assert!(work.distances < n as u64, "{work:?} for {n} rods");
        }
    }
}
