//! Bartlett's correction of χ² where the model is not linear in its parameters.

use super::best::Best;
use super::emulator::Emulator;
use super::likelihood::ChiSquare;
use super::minimise::{Grid, descend};
use super::profile::fixed;
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;

/// Sets of points that are drawn: the averages are known to some 4 % of a rise.
pub const DRAWS: u64 = 400;

/// For each parameter, the rise of χ² to its true value, the others at their best, over that of a linear model, whose
/// average is 1: the average over points that are drawn about the polynomials at the best place with the covariance V,
/// 1 at least. A rise divided by it follows χ² better (M. S. Bartlett, Proc. R. Soc. A 160 (1937) 268). The same fit
/// gives the same factors.
///
/// Only differences from the linear model's rises at the same points are averaged, as these scatter far less.
pub fn factors(best: &Best, emulator: &Emulator, draws: u64) -> Option<Vec<f64>> {
    let covariance = best.causes.iter().sum::<nalgebra::DMatrix<f64>>();
    let (solver, slopes) = (covariance.cholesky()?, emulator.slopes(&best.place));
    let weighted = solver.solve(&slopes);
    let linear = slopes.tr_mul(&weighted).cholesky()?.inverse();
    let influence = &linear * weighted.transpose();
    // Here the polynomials are the truth: nothing in their slopes is noise.
    let surface = best.surface.with_noise();
    let axes = best.place.len();
    let grid = Grid::new(&surface, &vec![None; axes]);
    let fixed: Vec<_> = (0..axes).map(|axis| fixed(best, &[(axis, best.place[axis])])).collect();
    let terms = emulator.mean();
    let from_origin = terms.tr_mul(&(emulator.basis.terms(&best.place) - surface.origin()));
    let excess = |surface: &mut ChiSquare, draw: u64| {
        let mut rng = Pcg64Dxsm::seed_from_u64(draw);
        let away = solver.l() * DVector::from_fn(slopes.nrows(), |_, _| rng.sample::<f64, _>(StandardNormal));
        surface.take(&(&from_origin + &away), terms, &solver);
        let (place, least) = grid.minimise(surface, &[&best.place]);
        let moved = &influence * &away;
        let of_axis = |axis: usize| {
            let there = |start: &Vec<f64>| descend(surface, &fixed[axis], start.clone()).1;
            let least_there = there(&best.place).min(there(&place));
            least_there - least - moved[axis] * moved[axis] / linear[(axis, axis)]
        };
        DVector::from_fn(axes, |axis, _| of_axis(axis))
    };
    let all: Vec<DVector<f64>> = (0..draws).into_par_iter().map_init(|| surface.clone(), excess).collect();
    let mean = all.iter().sum::<DVector<f64>>() / draws as f64;
    Some(mean.iter().map(|excess| (1.0 + excess).max(1.0)).collect())
}

#[cfg(test)]
mod tests {
    use super::super::Datum;
    use super::super::basis::Basis;
    use super::super::best::best;
    use super::super::emulator::{Replica, coefficients};
    use super::super::likelihood::Rods;
    use super::*;

    const MANY: u64 = 40_000;

    /// Half of the box, in standard deviations of the points.
    const HALF: f64 = 5.0;

    /// The fit of θ if the two points, of this value and standard deviation 1, are θ and bend·θ².
    fn fitted(bend: f64, value: f64) -> (Best, Emulator) {
        let model = move |values: &[f64]| {
            let theta = values[0];
            Ok(Replica::whole(move |_| Ok(vec![[theta; 3], [bend * theta * theta; 3]])))
        };
        let basis = Basis::new(1);
        let runs = coefficients(&basis, &model, &|node| vec![HALF * node[0]], 0..1, &|| ()).unwrap();
        let datum = Datum { value, u: 1.0, ..Datum::place(0, "x1", 0.0) };
        let emulator = Emulator::new(&basis, &runs);
        (best(&[datum.clone(), datum], &emulator, &Rods::none(1)).unwrap(), emulator)
    }

    /// The factor of θ at θ = 0.
    fn found(bend: f64) -> f64 {
        let (best, emulator) = fitted(bend, 0.0);
        factors(&best, &emulator, MANY).unwrap()[0]
    }

    /// The average excess of the rise and its standard deviation by sums over a grid of both points' errors, and over
    /// one of θ.
    fn summed(bend: f64) -> [f64; 2] {
        let places = |half: f64, step: f64| (0..=(2.0 * half / step) as u32).map(move |k| f64::from(k) * step - half);
        let [mut weights, mut sum, mut squares] = [0.0; 3];
        for a in places(5.0, 0.1) {
            for b in places(5.0, 0.1) {
                let left = |theta: f64| (a - theta).powi(2) + (b - bend * theta * theta).powi(2);
                let least = places(HALF, 0.01).map(left).fold(f64::INFINITY, f64::min);
                let (weight, excess) = ((-0.5 * (a * a + b * b)).exp(), left(0.0) - least - a * a);
                weights += weight;
                sum += weight * excess;
                squares += weight * excess * excess;
            }
        }
        [sum / weights, (squares / weights - (sum / weights).powi(2)).sqrt()]
    }

    #[test]
    fn the_factor_is_the_average_rise_of_a_bent_model_and_1_of_a_straight_one() {
        assert!((found(0.0) - 1.0).abs() < 1e-6);
        for bend in [0.2, 0.4] {
            let [excess, deviation] = summed(bend);
            let se = deviation / (MANY as f64).sqrt();
            assert!((found(bend) - 1.0 - excess).abs() < 3.0 * se, "{} {excess} {se}", found(bend));
            // The control: a model half as bent has another factor.
            assert!((found(bend) - 1.0 - summed(0.5 * bend)[0]).abs() > 3.0 * se);
        }
    }

    #[test]
    fn chi_square_of_many_places_is_that_of_each() {
        let surface = fitted(0.4, 1.0).0.surface;
        let places: Vec<_> = (0..9).map(|k| vec![0.25 * f64::from(k) - 1.0]).collect();
        let at_all = surface.at_all(&surface.places(&places));
        for (place, found) in places.iter().zip(&at_all) {
            assert!((found - surface.at(place)).abs() < 1e-12 * (1.0 + found), "{place:?} {found}");
        }
    }
}
