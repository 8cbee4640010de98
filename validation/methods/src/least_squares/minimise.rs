//! The minimum of χ² in a box of one to three parameters.

use super::basis::grid;
use super::likelihood::{ChiSquare, Places};
use nalgebra::{DMatrix, DVector};

/// Grid points along each free axis, by the number of free axes; the search starts at the best of them.
const STARTS: [usize; 4] = [1, 33, 13, 9];

/// Largest number of Levenberg–Marquardt steps: a few suffice, except in flat valleys.
const STEPS: usize = 100;

/// The points of a grid over the axes without a value in `fixed`, where a search may start.
pub struct Grid {
    fixed: Vec<Option<f64>>,
    points: Vec<Vec<f64>>,
    places: Places,
}

impl Grid {
    /// The grid for surfaces that differ from `surface` in their points alone.
    pub fn new(surface: &ChiSquare, fixed: &[Option<f64>]) -> Self {
        let free = free(fixed);
        let along = STARTS[free.len()];
        let point = |indices: Vec<usize>| {
            let mut place: Vec<f64> = fixed.iter().map(|fixed| fixed.unwrap_or(0.0)).collect();
            for (axis, index) in free.iter().zip(indices) {
                place[*axis] = -1.0 + 2.0 * index as f64 / (along - 1) as f64;
            }
            place
        };
        let points: Vec<_> = grid(free.len(), along).into_iter().map(point).collect();
        Self { fixed: fixed.to_vec(), places: surface.places(&points), points }
    }

    /// The place with the smallest χ² in the box [−1, 1]^p, and that χ². Parameters with a value in `fixed` keep it.
    /// The search descends from the best point of the grid and from each of `starts`, to find the deepest of several
    /// valleys.
    pub fn minimise(&self, surface: &ChiSquare, starts: &[&[f64]]) -> (Vec<f64>, f64) {
        let start = self.points[surface.at_all(&self.places).imin()].clone();
        let mut best = descend(surface, &self.fixed, start);
        for start in starts.iter().filter(|_| self.points.len() > 1) {
            let found = descend(surface, &self.fixed, start.to_vec());
            if found.1 < best.1 {
                best = found;
            }
        }
        best
    }
}

/// [`Grid::minimise`] of one surface.
pub fn minimise(surface: &ChiSquare, fixed: &[Option<f64>], starts: &[&[f64]]) -> (Vec<f64>, f64) {
    Grid::new(surface, fixed).minimise(surface, starts)
}

fn free(fixed: &[Option<f64>]) -> Vec<usize> {
    (0..fixed.len()).filter(|k| fixed[*k].is_none()).collect()
}

/// Descends from `start` to the bottom of its valley.
pub fn descend(surface: &ChiSquare, fixed: &[Option<f64>], start: Vec<f64>) -> (Vec<f64>, f64) {
    let (free, mut place) = (free(fixed), start);
    for (place, fixed) in place.iter_mut().zip(fixed) {
        *place = fixed.unwrap_or(*place);
    }
    let mut value = surface.at(&place);
    let mut damping = 1e-3;
    if free.is_empty() {
        return (place, value);
    }
    for _ in 0..STEPS {
        let (gradient, curvature) = surface.slopes(&place, &free);
        // A parameter at an edge is held there if χ² falls outwards.
        let inwards = |k: &usize| place[free[*k]].abs() < 1.0 || gradient[*k] * place[free[*k]] > 0.0;
        let moving: Vec<usize> = (0..free.len()).filter(inwards).collect();
        if moving.is_empty() {
            break;
        }
        let slope = DVector::from_iterator(moving.len(), moving.iter().map(|k| gradient[*k]));
        let damped = DMatrix::from_fn(moving.len(), moving.len(), |i, j| {
            let own = curvature[(moving[i], moving[j])];
            if i == j { own * (1.0 + damping) + f64::MIN_POSITIVE } else { own }
        });
        let Some(step) = damped.cholesky().map(|solver| solver.solve(&slope)) else {
            damping *= 10.0;
            continue;
        };
        let mut next = place.clone();
        for (k, step) in moving.iter().zip(step.iter()) {
            next[free[*k]] = (next[free[*k]] - step).clamp(-1.0, 1.0);
        }
        let moved = shearbed_oracle::apart(&next, &place);
        let found = surface.at(&next);
        if found < value {
            (place, value) = (next, found);
            damping *= 0.1;
        } else {
            damping *= 10.0;
        }
        // Far below any uncertainty, which is about a tenth of a box: χ² then changes by 1e-11.
        if moved < 1e-6 {
            break;
        }
    }
    (place, value)
}
