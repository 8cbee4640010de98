use super::*;
use crate::model::stress::Body;
use approx::assert_relative_eq;

/// The sums for one rod worked by hand: p = (2, −3, 6)/7 and r_e = 2.
fn observe(observable: Observable) -> Vec<f64> {
    observe_rod(observable, [2.0, -3.0, 6.0].map(|x| x / 7.0))
}

/// The sums for one rod along `p` with r_e = 2.
fn observe_rod(observable: Observable, p: [f64; 3]) -> Vec<f64> {
    let mut block = Block { len: 1, ..Block::default() };
    block.p.iter_mut().zip(p).for_each(|(axis, x)| axis[0] = x);
    block.aspect_ratio[0] = 2.0;
    let mut sums = vec![Sum::default(); observable.width()];
    observable.add(&block, &mut sums);
    sums.iter().map(|sum| sum.value).collect()
}

/// A rod of twice the mean cubed length adds twice its own stress.
#[test]
fn a_stress_has_the_rod_s_weight() {
    let mut block = Block { len: 1, ..Block::default() };
    block.p.iter_mut().zip([0.6, 0.8, 0.0]).for_each(|(axis, x)| axis[0] = x);
    let mut stress = |weight: f64| {
        block.weight[0] = weight;
        let mut sums = vec![Sum::default(); 3];
        Observable::Stress.add(&block, &mut sums);
        sums[0].value
    };
    assert_eq!(stress(2.0), 2.0 * stress(1.0));
}

#[test]
fn one_rod_by_hand() {
    let sevenths = |v: &[f64]| v.iter().map(|x| x / 7.0).collect::<Vec<_>>();
    let close = |found: Vec<f64>, expected: Vec<f64>| {
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(&expected) {
            assert_relative_eq!(a, b, max_relative = 1e-15);
        }
    };
    close(observe(Observable::Projections), sevenths(&[2.0, 3.0, 6.0]));
    let roots = [13f64, 45.0, 40.0].map(f64::sqrt);
    close(observe(Observable::PlanarProjections), sevenths(&roots));
    close(observe(Observable::MeanAngle), vec![1.5f64.atan()]);
    // By hand: (4 − 9)/(4 + 9).
    close(observe(Observable::Cos2Phi), vec![-5.0 / 13.0]);
    assert_eq!(observe_rod(Observable::Cos2Phi, [0.0, 0.0, 1.0]), [0.0]);
    let tensor = [4.0, 9.0, 36.0, -6.0, 12.0, -18.0].map(|x| x / 49.0);
    close(observe(Observable::OrientationTensor), tensor.to_vec());
    // By exponents of 2/7, −3/7 and 6/7: 1111, 1112, 1113, 1122, 1123, 1133, 1222, 1223, 1233, 1333, 2222, …
    let quads =
        [16.0, -24.0, 48.0, 36.0, -72.0, 144.0, -54.0, 108.0, -216.0, 432.0, 81.0, -162.0, 324.0, -648.0, 1296.0];
    close(observe(Observable::OrientationTensor4), quads.map(|x| x / 2401.0).to_vec());
    // p₁p₂ = −6/49; p₂² − p₁² = 5/49; p₁² − p₃² = −32/49.
    close(observe(Observable::ParticleStress), [36.0, -30.0, 192.0].map(|x| x / 2401.0).to_vec());
    // With k_A, k_B and k_C of r = 2: k_A p₁²p₂² + ½k_B(p₁² + p₂²) + ½k_C, k_A p₁p₂(p₂² − p₁²), p₁p₂(k_A(p₁² − p₃²) +
    // k_B).
    let [a, b, c] = Body::Spheroid.coefficients(2.0);
    let (a, b) = (a / 2401.0, b / 49.0);
    close(observe(Observable::Stress), vec![36.0 * a + 6.5 * b + 0.5 * c, -30.0 * a, 192.0 * a - 6.0 * b]);
    // C = (4·4 + 9)^½/(2·6) = 5/12, so C_b = 5/17 = 0.294.
    let orbit = observe(Observable::OrbitConstant);
    assert_relative_eq!(orbit[0], 5.0 / 17.0, max_relative = 1e-15);
    let filled: Vec<_> = orbit[1..].iter().enumerate().filter(|(_, d)| **d != 0.0).collect();
    assert_eq!(filled, [(5, &20.0)]);
}

/// Against the least and the largest value of a rod over a fine grid of directions: a mean lies between.
#[test]
fn every_column_has_the_range_of_its_formula() {
    const PARTS: i32 = 240;
    let part = |whole: f64, k: i32| whole * f64::from(k) / f64::from(PARTS);
    for observable in Observable::ALL {
        let mut found = vec![[f64::INFINITY, f64::NEG_INFINITY]; observable.width()];
        for (i, j) in (0..=PARTS).flat_map(|i| (0..PARTS).map(move |j| (i, j))) {
            let ((st, ct), (sp, cp)) =
                (part(std::f64::consts::PI, i).sin_cos(), part(std::f64::consts::TAU, j).sin_cos());
            for (found, value) in found.iter_mut().zip(observe_rod(observable, [st * cp, st * sp, ct])) {
                *found = [found[0].min(value), found[1].max(value)];
            }
        }
        for (channel, [least, most]) in observable.channels().zip(found) {
            let range = channel.range();
            if range == [f64::NEG_INFINITY, f64::INFINITY] {
                assert_eq!(observable, Observable::Stress);
                continue;
            }
            // The grid misses an extreme by half a step, (π/240)², times the curvature.
            for (range, found, outward) in [(range[0], least, -1.0), (range[1], most, 1.0)] {
                let beyond = (found - range) * outward;
                assert!((-2e-3..=1e-12).contains(&beyond), "{}: {range} {found}", channel.name());
            }
        }
    }
}

#[test]
fn every_channel_is_found_by_its_name() {
    for observable in Observable::ALL {
        for channel in observable.channels() {
            assert_eq!(Channel::named(&channel.name()), Some(channel));
        }
    }
}

#[test]
fn columns_have_symbols_with_units_or_their_names() {
    let symbol = |name: &str| Channel::named(name).unwrap().symbol();
    assert_eq!(["x1", "x2", "x3"].map(symbol), ["X̄₁", "X̄₂", "X̄₃"]);
    assert_eq!(["phi", "cos_2phi", "c_b"].map(symbol), ["φ̄ (rad)", "⟨cos 2φ⟩", "C_b"]);
    assert_eq!(["a11", "a23", "a1122"].map(symbol), ["a_11", "a_23", "a_1122"]);
    assert_eq!(["s12_pa", "n1_pa", "n2_pa"].map(symbol), ["σ_12 (Pa)", "N_1 (Pa)", "N_2 (Pa)"]);
    let over = ["s12_per_mu_fiber_g", "n1_per_mu_fiber_g", "n2_per_mu_fiber_g"];
    assert_eq!(over.map(symbol), ["σ_12/(μ_fiber G)", "N_1/(μ_fiber G)", "N_2/(μ_fiber G)"]);
    // By default the name, as of projections on planes and of the bins of a density.
    for observable in [Observable::PlanarProjections, Observable::OrbitConstant] {
        for channel in observable.channels().filter(|channel| channel.name() != "c_b") {
            assert_eq!(channel.symbol(), channel.name());
        }
    }
}

#[test]
fn more_rods_than_a_block_has_are_refused() {
    for spread in [false, true] {
        let added = |len| std::panic::catch_unwind(|| Sum::none(spread).add_each(len, |_| 1.0));
        assert!(added(BLOCK).is_ok() && added(BLOCK + 1).is_err(), "{spread}");
    }
}

#[test]
fn lanes_sum_every_rod_once() {
    for len in [0, 1, 7, 8, 9, 100, BLOCK] {
        assert_eq!(lane_sum(len, |i| (i + 1) as f64), (len * (len + 1) / 2) as f64);
    }
    let mut sum = Sum::none(true);
    sum.add_each(1, |_| 1.0);
    sum.add_each(3, |i| i as f64);
    // 1, 0, 1 and 2: squared deviations 0 + 1 + 0 + 1 from their mean of 1, over 4 − 1 and over 4.
    let error = sum.spread.map(|spread| spread.standard_error());
    assert_eq!((sum.value, error), (4.0, Some((2.0f64 / 12.0).sqrt())));
}

/// C/(C + 1) from 0 to 1 in 20 bins, both ends included.
#[test]
fn the_ends_of_the_orbits_are_in_the_first_and_the_last_bin() {
    for (p, bin) in [([0.0, 1.0, 0.0], 19), ([0.0, 0.0, 1.0], 0)] {
        let bins = &observe_rod(Observable::OrbitConstant, p)[1..];
        let filled: Vec<_> = (0..20).filter(|k| bins[*k] != 0.0).collect();
        assert_eq!((filled, bins[bin]), (vec![bin], 20.0));
    }
}

/// A standard error by two passes over all values, the second corrected for the rounding of the mean.
fn by_two_passes(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let (mut sum, mut squares) = (0.0, 0.0);
    for off in values.iter().map(|value| value - mean) {
        sum += off;
        squares += off * off;
    }
    ((squares - sum * sum / n) / n / (n - 1.0)).sqrt()
}

/// Sums in parts of any lengths, wherever the first rod of a part lies: also if it alone is off.
#[test]
fn parts_come_to_the_error_of_all() {
    let near = |k: usize| 1.0 + 1e-13 * libm::sin(k as f64);
    let outlier = |at: usize| move |k: usize| if k == at { 0.25 } else { near(k) };
    let check = |values: &dyn Fn(usize) -> f64, lengths: &[usize]| {
        let all: Vec<f64> = (0..lengths.iter().sum()).map(values).collect();
        let mut whole = Spread::default();
        let mut rest = &all[..];
        for &length in lengths {
            let (part, after) = rest.split_at(length);
            let mut spread = Spread::default();
            part.chunks(BLOCK).for_each(|block| spread.add(block));
            whole.merge(&spread);
            rest = after;
        }
        let (found, expected) = (whole.standard_error(), by_two_passes(&all));
        // The bound is n ε, with a factor for the rounding of both.
        let allowed = 4.0 * all.len() as f64 * f64::EPSILON;
        assert!((found / expected - 1.0).abs() < allowed, "{found:e}, expected {expected:e}");
    };
    for lengths in [&[300][..], &[0, 300], &[1, 299], &[128, 128, 44], &[200, 0, 100]] {
        check(&near, lengths);
        // The first of all, the first of a part, the last.
        for at in [0, 1, 128, 200, 299] {
            check(&outlier(at), lengths);
        }
    }
}
