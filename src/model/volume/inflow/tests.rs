use super::*;
use crate::model::random::{Purpose, stream};

/// Velocity gradients and sides of volumes: shear along other axes and oblique, extension of either sign, a rotation,
/// all components.
fn flows() -> Vec<(Matrix3<f64>, [f64; 3])> {
    let of = |rows: [f64; 9]| Matrix3::from_row_slice(&rows);
    vec![
        (of([0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), [2.0, 3.0, 5.0]),
        (of([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]), [4.0; 3]),
        (of([0.5, -0.5, 0.0, 0.5, -0.5, 0.0, 0.0, 0.0, 0.0]), [4.0, 2.0, 2.0]),
        (of([1.0, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, -0.5]), [4.0; 3]),
        (of([-1.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5]), [1.0, 4.0, 4.0]),
        (of([0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), [4.0; 3]),
        (of([0.3, -0.5, 0.1, 0.8, 0.1, -0.2, 0.4, 0.6, -0.4]), [3.0, 4.0, 5.0]),
    ]
}

/// Deviation of the counts of points in 4 × 4 × 4 cells from the expected ones: χ² over its mean, less one, in standard
/// deviations.
fn off(points: &[Vector3<f64>], expected: &[f64], sides: [f64; 3]) -> f64 {
    let mut found = vec![0.0; 64];
    points.iter().for_each(|x| found[cell(x, sides)] += 1.0);
    let terms = found.iter().zip(expected).filter(|(_, expected)| **expected > 5.0);
    let (square, cells) = terms.fold((0.0, 0.0), |(square, cells), (found, expected)| {
        (square + (found - expected).powi(2) / expected, cells + 1.0)
    });
    (square - cells) / f64::sqrt(2.0 * cells)
}

fn cell(x: &Vector3<f64>, sides: [f64; 3]) -> usize {
    (0..3).fold(0, |cell, axis| 4 * cell + (4.0 * x[axis] / sides[axis]) as usize)
}

fn points(positions: &[Vec<f64>; 3]) -> Vec<Vector3<f64>> {
    let [x1, x2, x3] = positions;
    (0..x1.len()).map(|rod| Vector3::new(x1[rod], x2[rod], x3[rod])).collect()
}

/// Rods that come in have the distribution of those points of the volume that were outside a step ago, found by
/// sampling.
#[test]
fn what_comes_in_is_evenly_distributed_over_what_was_outside() {
    for (gradient, sides) in flows() {
        let volume = ControlVolume::of(sides);
        let inflow = Inflow::new(&volume, gradient, 0.2);
        let rng = stream(3, 0, Purpose::Positions);
        let all = points(&volume.draw_positions(1_000_000, &rng));
        let outside = all.iter().filter(|x| !inflow.holds(&(inflow.back * **x)));
        let mut expected = vec![0.0; 64];
        outside.for_each(|x| expected[cell(x, sides)] += 1.0);
        let fresh = expected.iter().sum::<f64>();
        assert!(fresh > 1e4, "{gradient}");
        const COUNT: u64 = 30_000;
        expected.iter_mut().for_each(|cell| *cell *= COUNT as f64 / fresh);
        let rng = stream(3, 0, Purpose::Replacements);
        let come = |rod: u64| inflow.come_in(ahead(&rng, NUMBERS * u128::from(rod)));
        let found: Vec<_> = (0..COUNT).map(come).collect();
        let off = off(&found, &expected, sides);
        // The expected counts are random too, with a scatter of the same order where few points are outside.
        assert!(off.abs() < 12.0, "{off}: {gradient}");
        let wrong: Vec<_> = found.iter().map(|x| (x + Vector3::from(sides) / 2.0) / 2.0).collect();
        assert!(self::off(&wrong, &expected, sides) > 100.0);
    }
}

/// Uniformly distributed rods stay so, and are all inside.
#[test]
fn an_even_suspension_stays_even() {
    const COUNT: usize = 100_000;
    for (gradient, sides) in flows() {
        let volume = ControlVolume::of(sides);
        let inflow = Inflow::new(&volume, gradient, 0.1);
        let mut positions = volume.draw_positions(COUNT, &stream(4, 0, Purpose::Positions));
        let mut rng = stream(4, 0, Purpose::Replacements);
        let replaced: u64 = (0..30).map(|_| inflow.advance(&mut positions, &mut rng)).sum();
        let found = points(&positions);
        assert!(found.iter().all(|x| inflow.holds(x)));
        assert!(replaced > COUNT as u64 / 2, "{replaced}: {gradient}");
        let off = off(&found, &[COUNT as f64 / 64.0; 64], sides);
        assert!(off < 6.0, "{off}: {gradient}");
    }
}

/// Rods that come in were outside when the step began, in a flow that takes liquid out and back in through a face
/// within a long step.
#[test]
fn what_comes_in_was_outside() {
    let (gradient, sides) = flows().pop().unwrap();
    let inflow = Inflow::new(&ControlVolume::of(sides), gradient, 2.0);
    let rng = stream(6, 0, Purpose::Replacements);
    for rod in 0..30_000u64 {
        let x = inflow.come_in(ahead(&rng, NUMBERS * u128::from(rod)));
        assert!(inflow.holds(&x) && !inflow.holds(&(inflow.back * x)), "{x}");
    }
}

#[test]
fn many_rods_are_carried_as_one_after_the_other() {
    let (gradient, sides) = flows().pop().unwrap();
    let volume = ControlVolume::of(sides);
    let inflow = Inflow::new(&volume, gradient, 0.3);
    crate::model::volume::tests::in_parts(volume, |positions, rng| inflow.advance(positions, rng));
}

#[test]
fn liquid_moves_by_the_exponential() {
    for (gradient, _) in flows() {
        for time in [0.0, 1e-3, 0.4, -0.4, 3.0] {
            let expected = (gradient * time).exp();
            let off = (exponential(&gradient, time) - expected).norm() / expected.norm();
            assert!(off < 1e-14, "{time}: {gradient} {off:e}");
        }
    }
}
