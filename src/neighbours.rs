//! Nearest neighbours inside the control volume, by a grid of cells.

/// Rods sorted into the cells of a cubic volume [0, side)³, for one step.
///
/// The buffers are kept from step to step: building allocates nothing after the first time.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    side: f64,
    cells_per_side: usize,
    /// Cells per length.
    per_length: f64,
    /// Where each cell's rods start in `sorted`; one more entry ends the last cell.
    starts: Vec<u32>,
    /// (position, rod) in the order of cells.
    sorted: Vec<([f64; 3], u32)>,
}

impl Grid {
    /// An empty grid for about `count` rods in a volume of the given side: about one rod a cell.
    pub fn new(side: f64, count: usize) -> Self {
        let cells_per_side = ((count as f64).cbrt().floor() as usize).clamp(1, 256);
        Self {
            side,
            cells_per_side,
            per_length: cells_per_side as f64 / side,
            ..Self::default()
        }
    }

    /// Sorts the rods at `positions` (three arrays of coordinates) into cells.
    pub fn build(&mut self, positions: &[Vec<f64>; 3]) {
        let count = positions[0].len();
        let cells = self.cells_per_side.pow(3);
        // Counted two places up, so that filling leaves `starts[cell]` at the start of its cell.
        self.starts.clear();
        self.starts.resize(cells + 2, 0);
        for rod in 0..count {
            let cell = self.cell(at(positions, rod));
            self.starts[cell + 2] += 1;
        }
        for cell in 0..cells {
            self.starts[cell + 2] += self.starts[cell + 1];
        }
        self.sorted.resize(count, ([0.0; 3], 0));
        for rod in 0..count {
            let position = at(positions, rod);
            let cell = self.cell(position);
            self.sorted[self.starts[cell + 1] as usize] = (position, rod as u32);
            self.starts[cell + 1] += 1;
        }
    }

    /// The nearest other rod closer than `reach` to `rod` at `position`, with the square of its distance;
    /// of equally near ones the lowest index. `tested` counts the distances looked at.
    pub fn nearest_within(
        &self,
        rod: usize,
        position: [f64; 3],
        reach: f64,
        tested: &mut u64,
    ) -> Option<(usize, f64)> {
        let reach = reach.min(2.0 * self.side);
        let mut radius = reach.min(1.0 / self.per_length);
        loop {
            let found = self.nearest_in_ball(rod, position, radius, tested);
            if found.is_some() || radius >= reach {
                return found;
            }
            radius = reach.min(2.0 * radius);
        }
    }

    fn nearest_in_ball(
        &self,
        rod: usize,
        position: [f64; 3],
        radius: f64,
        tested: &mut u64,
    ) -> Option<(usize, f64)> {
        let low = position.map(|x| self.index(x - radius));
        let high = position.map(|x| self.index(x + radius));
        let mut best = None;
        let mut best_square = radius * radius;
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                let row = (i * self.cells_per_side + j) * self.cells_per_side;
                // Cells along axis 3 lie one after the other.
                let range = self.starts[row + low[2]] as usize..self.starts[row + high[2] + 1] as usize;
                for &(other, index) in &self.sorted[range] {
                    let index = index as usize;
                    if index == rod {
                        continue;
                    }
                    *tested += 1;
                    let square = (0..3).map(|k| (other[k] - position[k]).powi(2)).sum::<f64>();
                    let closer = square < best_square;
                    let tie = square == best_square && best.is_some_and(|b| index < b);
                    if closer || tie {
                        best = Some(index);
                        best_square = square;
                    }
                }
            }
        }
        best.map(|index| (index, best_square))
    }

    /// The cell index along one axis; a negative coordinate counts to the first cell, as the cast saturates.
    fn index(&self, x: f64) -> usize {
        ((x * self.per_length) as usize).min(self.cells_per_side - 1)
    }

    fn cell(&self, position: [f64; 3]) -> usize {
        let [i, j, k] = position.map(|x| self.index(x));
        (i * self.cells_per_side + j) * self.cells_per_side + k
    }
}

fn at(positions: &[Vec<f64>; 3], rod: usize) -> [f64; 3] {
    [positions[0][rod], positions[1][rod], positions[2][rod]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute(positions: &[Vec<f64>; 3], rod: usize, reach: f64) -> Option<(usize, f64)> {
        (0..positions[0].len())
            .filter(|other| *other != rod)
            .map(|other| {
                let square = (0..3)
                    .map(|k| (positions[k][other] - positions[k][rod]).powi(2))
                    .sum::<f64>();
                (other, square)
            })
            .filter(|(_, square)| *square < reach * reach)
            .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))
    }

    proptest! {
        #[test]
        fn the_grid_finds_what_a_full_search_finds(
            points in prop::collection::vec(prop::array::uniform3(0u8..40), 1..120),
            reach in prop_oneof![0.0f64..1.0, 1.0f64..40.0, Just(f64::INFINITY)]
        ) {
            // Coordinates on a coarse lattice, so that ties and coincident rods occur.
            let side = 4.0;
            let positions: [Vec<f64>; 3] =
                std::array::from_fn(|k| points.iter().map(|p| f64::from(p[k]) * side / 40.0).collect());
            let mut grid = Grid::new(side, points.len());
            grid.build(&positions);
            for rod in 0..points.len() {
                let found = grid.nearest_within(rod, at(&positions, rod), reach, &mut 0);
                prop_assert_eq!(found, brute(&positions, rod, reach.min(1e9)));
            }
        }
    }

    #[test]
    fn a_short_reach_looks_at_few_rods() {
        let n = 1000;
        let positions: [Vec<f64>; 3] = std::array::from_fn(|k| {
            (0..n)
                .map(|i| ((i as f64 + 0.5) * [0.618_033_99, 0.754_877_67, 0.569_840_29][k]).fract() * 10.0)
                .collect()
        });
        let mut grid = Grid::new(10.0, n);
        grid.build(&positions);
        let mut tested = 0;
        (0..n).for_each(|rod| {
            grid.nearest_within(rod, at(&positions, rod), 0.1, &mut tested);
        });
        assert!(tested < 2 * n as u64, "{tested} distances for {n} rods");
    }
}
