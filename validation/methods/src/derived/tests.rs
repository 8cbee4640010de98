use super::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use shearbed_oracle::larger;
use std::f64::consts::TAU;

/// Times from 0 to 4 at unequal distances.
fn times() -> Vec<f64> {
    (0..=800).map(|k| f64::from(k) / 200.0 + 1e-3 * f64::from(k % 3) * f64::from(k.min(1))).collect()
}

/// The mean of `replicas` curves, its standard errors, and the means without one group each, all by definition.
fn column(curves: &[Vec<f64>]) -> Column {
    let average = |curves: &[&Vec<f64>]| -> Vec<f64> {
        let sum = |k: usize| curves.iter().map(|curve| curve[k]).sum::<f64>();
        (0..curves[0].len()).map(|k| sum(k) / curves.len() as f64).collect()
    };
    let mean = average(&curves.iter().collect::<Vec<_>>());
    let n = curves.len() as f64;
    let se = |k: usize| {
        let squares: f64 = curves.iter().map(|curve| (curve[k] - mean[k]).powi(2)).sum();
        (squares / (n - 1.0) / n).sqrt()
    };
    let others = |group: usize| {
        let others: Vec<_> = (0..curves.len()).filter(|k| k % 16 != group).map(|k| &curves[k]).collect();
        average(&others)
    };
    let without = if curves.len() > 1 { (0..curves.len().min(16)).map(others).collect() } else { Vec::new() };
    Column { name: "x1".into(), se: (0..mean.len()).map(se).collect(), mean, without }
}

/// Replicas of a damped oscillation with the period ½ about 0.3, each with an amplitude, a damping rate, a level and a
/// phase of its own.
fn damped(replicas: usize, seed: u64, scatter: f64) -> Vec<Vec<f64>> {
    let mut random = Pcg64Dxsm::seed_from_u64(seed);
    let mut normal = move || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let mut curve = || {
        let [amplitude, rate, level] = [0.2, 0.4, 0.3].map(|mean| mean * (1.0 + scatter * normal()));
        let phase = 2.0 * scatter * normal();
        let at = |t: &f64| level + amplitude * (-rate * t).exp() * (2.0 * TAU * t + phase).cos();
        times().iter().map(at).collect()
    };
    (0..replicas).map(|_| curve()).collect()
}

/// A rate of replicas that differ is one of amplitudes that fall by e^(−0.4t), and none of such as fall by e^(−0.1t²).
#[test]
fn amplitudes_that_fall_otherwise_have_no_single_rate() {
    let exponential = |bends: bool| {
        let curves = (1..=20).map(|seed| {
            let mut curves = damped(32, seed, 0.05);
            let bend = |(value, t): (&mut f64, f64)| *value = 0.3 + (*value - 0.3) * (0.4 * t - 0.1 * t * t).exp();
            curves.iter_mut().filter(|_| bends).for_each(|curve| curve.iter_mut().zip(times()).for_each(bend));
            Derived::new(&times(), &column(&curves), 32).damping.unwrap().is_exponential
        });
        curves.filter(|is| *is).count()
    };
    assert_eq!([false, true].map(exponential), [20, 0]);
}

/// The extremes of 0.3 + 0.2 e^(−0.4t) cos 4πt lie where tan 4πt = −0.4/4π.
#[test]
fn a_damped_oscillation_has_its_extremes_amplitudes_and_rate() {
    let Derived { extremes, damping, steady } = Derived::new(&times(), &column(&damped(1, 1, 0.0)), 1);
    let damping = damping.unwrap();
    assert!(damping.is_exponential);
    let late = (0.4 / (2.0 * TAU)).atan() / (2.0 * TAU);
    assert_eq!(extremes.len(), 17);
    for (k, extreme) in extremes.iter().enumerate() {
        assert_eq!((extreme.is_maximum, extreme.amplitude.is_some()), (k % 2 == 0, k % 2 == 0));
        let time = if k == 0 { 0.0 } else { k as f64 / 4.0 - late };
        let curve = |t: f64| 0.3 + 0.2 * (-0.4 * t).exp() * (2.0 * TAU * t).cos();
        // The parabola is off by what is left of the fourth order: (4π·0.006)⁴/24 of the amplitude.
        assert!((extreme.time.value - time).abs() < 2e-4, "{k} {:?}", extreme.time);
        assert!((extreme.value.value - curve(time)).abs() < 2e-7, "{k} {:?}", extreme.value);
        assert_eq!(extreme.value.se, None);
    }
    let rate = damping.rate;
    assert_eq!(damping.between, [2, 14].map(|k: usize| extremes[k].time.value));
    // Parabolas miss 2e-7 of amplitudes from 0.1 on.
    assert!((rate.value - 0.4).abs() < 1e-5, "{rate:?}");
    assert_eq!(steady, None);
}

/// Departures from a straight line with weights e^(−2λt), of the fourth less 0.04, that leave its slope λ.
#[test]
fn a_decay_that_is_not_exponential_has_the_rate_of_its_own_weights() {
    let (slope, times) = (0.5_f64, [1.0, 2.0, 3.0, 3.5]);
    let weight = |k: usize| (-2.0 * slope * (times[k] - 1.0)).exp() - if k == 3 { 0.04 } else { 0.0 };
    for off in [[1.0, -2.0, 1.0, 0.0], [0.0, 1.0, -3.0, 2.0]] {
        let logarithm = |k: usize| 2.0 - slope * times[k] + 0.01 * off[k] / weight(k);
        let found = rate(&times, &[0, 1, 2, 3].map(logarithm)).unwrap();
        assert!((found - slope).abs() < 1e-12, "{off:?} {found}");
    }
}

/// Those maxima count that are above a fifth of the first, at t = ½, and three at least.
#[test]
fn small_amplitudes_count_for_no_rate() {
    let last = |rate: f64| {
        let curve = |t: &f64| 0.3 + 0.2 * (-rate * t).exp() * (2.0 * TAU * t).cos();
        let damping = Derived::new(&times(), &column(&[times().iter().map(curve).collect()]), 1).damping.unwrap();
        assert!((damping.rate.value / rate - 1.0).abs() < 0.02, "{damping:?}");
        damping.between.map(|time| (2.0 * time).round() / 2.0)
    };
    // e^(−1.2) = 0.30 a time of 1 after the first, and e^(−1.8) = 0.17 after 1½; free of noise, maxima go on to 3½.
    assert_eq!([1.2, 4.0, 0.4].map(last), [[0.5, 1.5], [0.5, 1.5], [0.5, 3.5]]);
}

/// The errors of a single replica are over its rods: they hide turns, but not all.
#[test]
fn the_turns_of_one_replica_are_those_beyond_the_scatter_of_its_rods() {
    let extremes = |se: f64| {
        let curve = column(&damped(1, 1, 0.0));
        let column = Column { se: vec![se; curve.mean.len()], ..curve };
        Derived::new(&times(), &column, 1).extremes.len()
    };
    // From turn k to the next the mean moves by 0.2 (e^(−0.1k) + e^(−0.1(k + 1))), more than 2 · 4.4 standard errors
    // of 0.01 up to k = 14; after the last turn, at the end, it moves by less than those of 0.001.
    assert_eq!([0.0, 1e-3, 0.01, 0.1].map(extremes), [17, 16, 15, 0]);
}

/// Errors of 600 experiments: values less the truth, over the stated standard errors, have the spread 1; a control with
/// replicas that are not independent has not.
#[test]
fn errors_are_as_large_as_they_are_said_to_be() {
    // E e^(−λt) and E cos(4πt + φ) for Gaussian λ and φ.
    let mean = |t: &f64| 0.3 + 0.2 * (-0.4 * t + (0.02 * t).powi(2) / 2.0 - 0.005).exp() * (2.0 * TAU * t).cos();
    let truth = Derived::new(&times(), &column(&[times().iter().map(mean).collect()]), 1);
    let spread = |replicas: usize, copies: usize| {
        let mut squares = [0.0; 4];
        for seed in 0..600 {
            let curves = damped(replicas / copies, seed, 0.05);
            let curves: Vec<_> = curves.iter().cycle().take(replicas).cloned().collect();
            let found = Derived::new(&times(), &column(&curves), replicas as u64);
            let pick = |derived: &Derived| {
                let extreme = derived.extremes[3];
                let amplitude = derived.extremes[4].amplitude.unwrap();
                [extreme.time, extreme.value, amplitude, derived.damping.unwrap().rate]
            };
            for (square, (found, truth)) in squares.iter_mut().zip(pick(&found).into_iter().zip(pick(&truth))) {
                *square += ((found.value - truth.value) / found.se.unwrap()).powi(2) / 600.0;
            }
        }
        squares
    };
    // Student's t with 15 degrees of freedom has the variance 15/13; that of 600 is known to 7 %. Groups of unequal
    // sizes as well.
    for replicas in [16, 40] {
        let squares = spread(replicas, 1);
        for square in squares {
            assert!((square / (15.0 / 13.0) - 1.0).abs() < 0.3, "{replicas}: {squares:?}");
        }
    }
    assert!(spread(40, 2).iter().all(|square| *square > 1.6));
}

/// The times of extremes of rough means have errors as large as they are said to be, and are nearer to the truth than
/// the extreme outputs are, whose errors would be said to be twice as large.
#[test]
fn an_extreme_that_noise_moves_has_the_error_that_it_is_said_to_have() {
    let (mut random, mut squares, mut outputs) = (Pcg64Dxsm::seed_from_u64(9), [0.0; 2], 0.0);
    let late = (0.4 / (2.0 * TAU)).atan() / (2.0 * TAU);
    for seed in 0..300 {
        let mut curves = damped(32, seed, 0.05);
        curves.iter_mut().flatten().for_each(|value| *value += 0.02 * (random.random::<f64>() - 0.5));
        let column = column(&curves);
        let found = Derived::new(&times(), &column, 32);
        for (k, extreme) in found.extremes.iter().enumerate().skip(4).take(4) {
            let off = extreme.time.value - (k as f64 / 4.0 - late);
            squares[0] += (off / extreme.time.se.unwrap()).powi(2) / 1200.0;
            squares[1] += off.powi(2) / 1200.0;
            let within = times().partition_point(|t| *t < k as f64 / 4.0 - 0.2)
                ..=times().partition_point(|t| *t < k as f64 / 4.0 + 0.2);
            let top = super::extreme(&column.mean, &Turn { is_maximum: extreme.is_maximum, within, near: None });
            outputs += (times()[top] - (k as f64 / 4.0 - late)).powi(2) / 1200.0;
        }
    }
    assert!((squares[0] / (15.0 / 13.0) - 1.0).abs() < 0.2, "{squares:?}");
    assert!(squares[1] < 0.5 * outputs, "{squares:?} {outputs}");
}

/// Of a single output the jackknife is the standard error over replicas, if each replica is a group.
#[test]
fn the_jackknife_of_a_mean_is_its_standard_error() {
    for replicas in [2, 5, 16] {
        let column = column(&damped(replicas, 7, 0.1));
        let without: Vec<_> = column.without.iter().map(|mean| mean[5]).collect();
        let se = jackknife(column.mean[5], &without, replicas as u64).unwrap();
        assert!((se / column.se[5] - 1.0).abs() < 1e-9, "{replicas}: {se} {}", column.se[5]);
    }
    assert_eq!(jackknife(1.0, &[], 1), None);
}

/// A rate that is missing has a reason: few replicas, or a short run. One that is there, or a mean that only falls, has
/// none.
#[test]
fn a_missing_rate_has_a_reason() {
    let why = |replicas: usize, scatter: f64, until: usize| {
        let mut column = column(&damped(replicas, 1, scatter));
        column.mean.truncate(until);
        column.without.iter_mut().for_each(|mean| mean.truncate(until));
        let derived = Derived::new(&times()[..until], &column, replicas as u64);
        derived.no_rate(replicas as u64).map_or(String::new(), |why| why[..10].to_owned())
    };
    assert_eq!([why(20, 0.05, 801), why(20, 0.05, 40), why(2, 0.05, 40)], ["", "", "no amplitu"]);
    assert_eq!([why(2, 0.05, 801), why(20, 0.05, 250)], ["no amplitu", "no damping"]);
}

#[test]
fn noise_neither_turns_nor_is_unsteady() {
    let mut random = Pcg64Dxsm::seed_from_u64(3);
    let mut noise = || -> Vec<f64> { times().iter().map(|_| 0.3 + 0.1 * (random.random::<f64>() - 0.5)).collect() };
    let curves: Vec<Vec<f64>> = (0..20).map(|_| noise()).collect();
    let found = Derived::new(&times(), &column(&curves), 20);
    assert_eq!((&found.extremes, found.damping, found.no_rate(20)), (&vec![], None, None));
    let steady = found.steady.unwrap();
    assert!(steady.from < 1.0, "{steady:?}");
    // 800 outputs of 20 replicas.
    let expected = 0.1 / 12.0_f64.sqrt() / (800.0 * 20.0_f64).sqrt();
    assert!((steady.value.value - 0.3).abs() < 4.0 * expected, "{steady:?}");
    // The end of a straight line has twice the error of the average.
    assert!((1.2..3.2).contains(&(steady.value.se.unwrap() / expected)), "{steady:?}");
    // A step before half the time: steady from there on, where noise does not seem to drift.
    let mut stepped = || {
        let step = |(value, t): (f64, &f64)| value + if *t < 1.0 { 0.2 } else { 0.0 };
        let curves: Vec<Vec<f64>> = (0..20).map(|_| noise().into_iter().zip(&times()).map(step).collect()).collect();
        Derived::new(&times(), &column(&curves), 20).steady
    };
    let found: Vec<_> = (0..20).filter_map(|_| stepped()).collect();
    assert!(found.len() > 10 && found.iter().all(|steady| (1.0..2.0).contains(&steady.from)), "{found:?}");
    let growing = Derived::new(&times(), &column(&[times()]), 1);
    assert_eq!((growing.extremes.len(), growing.extremes[0].is_maximum, growing.steady), (1, false, None));
}

/// A mean that nears its limit as 0.05 e^(−t/τ), below noise that lasts, is off what is called its steady value by more
/// than three errors in 5 % at most; the average over the second half with its own error, the control, in over 20 %.
/// One that does not drift is mostly steady.
#[test]
fn a_drift_below_noise_is_not_steady() {
    let found = |tau: f64, seed: u64| {
        let mut random = Pcg64Dxsm::seed_from_u64(seed);
        let mut curve = || {
            let mut noise = 0.0;
            let at = |t: f64| {
                noise = 0.98 * noise + 0.01 * (random.random::<f64>() - 0.5);
                0.3 + 0.05 * (-t / tau).exp() + noise
            };
            times().into_iter().map(at).collect()
        };
        let column = column(&(0..32).map(|_| curve()).collect::<Vec<_>>());
        let mean = Mean { times: &times(), column: &column, replicas: 32 };
        let average = mean.estimate(|mean_of| Some(mean.line(mean_of, 400).0)).unwrap();
        (mean.steady().map(|steady| steady.value), average)
    };
    let off = |found: &Estimate| (found.value - 0.3).abs() / found.se.unwrap();
    let all = |tau: f64| (0..200).map(|seed| found(tau, seed)).collect::<Vec<_>>();
    let far = |tau: f64| {
        let all = all(tau);
        let is_far = |found: &Estimate| off(found) > 3.0;
        [
            all.iter().filter_map(|(steady, _)| *steady).filter(is_far).count(),
            all.iter().map(|(_, average)| *average).filter(is_far).count(),
        ]
    };
    for tau in [0.5, 1.0, 2.0] {
        let [steady, average] = far(tau);
        assert!(steady <= 10 && (tau == 0.5 || average > 40), "{tau}: {steady} {average}");
    }
    let level = all(1e-9);
    let squares: Vec<f64> = level.iter().filter_map(|(steady, _)| steady.map(|found| off(&found).powi(2))).collect();
    assert!(squares.len() > 120, "{}", squares.len());
    assert!((0.1..1.0).contains(&(squares.iter().sum::<f64>() / squares.len() as f64)), "{squares:?}");
}

/// A mean that grows turns nowhere but at its beginning, and one output has nothing to derive.
#[test]
fn lawless_means_have_nothing() {
    // A few outputs in a row are alike by chance.
    let of = |outputs: usize| {
        let times: Vec<f64> = (0..outputs).map(|k| k as f64).collect();
        Derived::new(&times, &column(&vec![vec![0.5; outputs]; 8]), 8)
    };
    assert_eq!((of(10).extremes, of(9).steady), (Vec::new(), None));
    let steady = of(10).steady.unwrap();
    assert!(larger((steady.value.value - 0.5).abs(), steady.from) == 0.0 && steady.value.se == Some(0.0));
    let one = Derived::new(&[0.0], &column(&[vec![0.5], vec![0.7]]), 2);
    assert_eq!((one.extremes.len(), one.steady), (0, None));
}

/// Of a curve that falls from its start on, the start is a maximum, and a later first output is none.
#[test]
fn a_first_output_after_the_start_is_no_extreme() {
    let curves = damped(32, 5, 0.01);
    let from = |first: usize| {
        let cut: Vec<Vec<f64>> = curves.iter().map(|curve| curve[first..].to_vec()).collect();
        let derived = Derived::new(&times()[first..], &column(&cut), 32);
        (derived.extremes[0].is_maximum, derived.extremes[0].time.value)
    };
    assert_eq!(from(0), (true, 0.0));
    let (is_maximum, time) = from(20);
    assert!(!is_maximum && (time - 0.25).abs() < 0.02, "{time}");
}
