//! Tests of means and standard errors, by hand.

use super::*;
use crate::Scene;

/// A sum without errors over rods.
fn sum(value: f64) -> Sum {
    Sum { value, spread: None }
}

/// A sum with errors over these rods.
fn over(rods: &[f64]) -> Sum {
    let mut sum = Sum::none(true);
    rods.iter().for_each(|value| sum.add_each(1, |_| *value));
    sum
}

#[test]
fn over_replicas_the_error_is_that_of_their_mean() {
    // Two columns at one output; the second is the negative of the first.
    let mut tally = Tally::of(2);
    for value in [1.0, 2.0, 6.0] {
        tally.add_sums(4, &[sum(4.0 * value), sum(-4.0 * value)]);
    }
    // Mean 3, squared deviations 4 + 1 + 9, divided by 3 − 1 and by 3.
    let se = (14.0f64 / 6.0).sqrt();
    for (place, sign) in [(0, 1.0), (1, -1.0)] {
        let column = tally.column("x".to_owned(), place, 2);
        assert_eq!(column.mean.len(), 1);
        assert!((column.mean[0] - 3.0 * sign).abs() < 1e-15, "{column:?}");
        assert!((column.se[0] - se).abs() < 1e-15, "{column:?}");
    }
    assert_eq!(tally.replicas(), 3);
}

#[test]
fn of_one_replica_the_error_is_over_its_rods_if_it_has_more_than_one() {
    let of = |rods: &[f64]| {
        let mut tally = Tally::of(1);
        tally.add_sums(rods.len(), &[over(rods)]);
        let column = tally.column("x".to_owned(), 0, 1);
        (column.mean[0], column.se[0])
    };
    // Mean 2, squared deviations 1 + 1 + 1 + 9, over 4 − 1 and over 4.
    assert_eq!(of(&[1.0, 1.0, 1.0, 5.0]), (2.0, 1.0));
    assert!(of(&[0.5]).1.is_nan());
}

/// The mean without a group is that of the other replicas, run alone: replica k belongs to group k modulo 16.
#[test]
fn each_group_of_replicas_is_left_out_once() {
    let mut scene = Scene::default();
    scene.particles.count = 3;
    for replicas in [2, 16, 21] {
        let plan = Plan::new(&scene).unwrap().with_replicas(replicas);
        let values: Vec<f64> = (replicas_of(&plan, 0..replicas, &|| ()).unwrap().iter())
            .map(|replica| replica.mean(Channel::named("x1").unwrap(), 5).unwrap())
            .collect();
        let results = run(&plan).unwrap();
        let without = &results.column("x1").unwrap().without;
        assert_eq!(without.len(), replicas.min(16) as usize);
        assert_eq!(group_sizes(replicas).sum::<u64>(), replicas);
        for (group, (mean, size)) in without.iter().zip(group_sizes(replicas)).enumerate() {
            let others: Vec<f64> = (0..values.len()).filter(|k| k % 16 != group).map(|k| values[k]).collect();
            assert_eq!(others.len() as u64, replicas - size);
            let expected = others.iter().sum::<f64>() / others.len() as f64;
            assert!((mean[5] - expected).abs() < 1e-14, "{replicas} {group}: {} {expected}", mean[5]);
        }
    }
    assert_eq!(run(&Plan::new(&scene).unwrap().with_replicas(1)).unwrap().column("x1").unwrap().without.len(), 0);
}

/// The collisions of a replica have the mean and the error of those that its replicas counted, by definition.
#[test]
fn collisions_have_an_error_over_replicas() {
    let scene = Scene { interaction: Some(crate::scene::Interaction::default()), ..Scene::default() };
    let of = |replicas: u64| {
        let plan = Plan::new(&scene).unwrap().with_replicas(replicas);
        let counted: Vec<f64> = (replicas_of(&plan, 0..replicas, &|| ()).unwrap().iter())
            .map(|replica| replica.counters.collisions as f64)
            .collect();
        (counted, run(&plan).unwrap().collisions)
    };
    let (counted, [mean, se]) = of(5);
    let due = counted.iter().sum::<f64>() / 5.0;
    let squares: f64 = counted.iter().map(|count| (count - due).powi(2)).sum();
    assert!(due > 100.0 && squares > 0.0, "{counted:?}");
    assert!((mean / due - 1.0).abs() < 1e-14 && (se / (squares / 4.0 / 5.0).sqrt() - 1.0).abs() < 1e-12, "{mean} {se}");
    let (counted, [mean, se]) = of(1);
    assert!(mean == counted[0] && se.is_nan());
}
