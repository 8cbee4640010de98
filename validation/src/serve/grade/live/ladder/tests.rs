use super::climb::{fewest, hopeless, reached, settings, within};
use super::*;
use crate::serve::grade::live::program::Asked;
use crate::serve::grade::mistakes;
use crate::serve::problems::{self, loaded};
use nalgebra::Vector3;
use std::cell::Cell;

pub(super) const TOLERANCE: f64 = 1e-6;

/// Fifteen rungs, one per doubling, each with a rod that is off by its error, and a run time.
pub(super) fn ladder(rungs: impl Fn(i32) -> (f64, f64)) -> Vec<Rung> {
    let rung = |k: i32| {
        let (error, seconds) = rungs(k);
        rung(Setting::Steps(8 << k), error, seconds)
    };
    (0..15).map(rung).collect()
}

pub(super) fn rung(setting: Setting, error: f64, seconds: f64) -> Rung {
    Rung {
        setting,
        answer: Answer { path: "a test".into(), rows: vec![vec![error.cos(), error.sin(), 0.0]], lines: vec![0] },
        compared: Compared { error, errors: vec![error], ..Compared::default() },
        took: Duration::from_secs_f64(seconds),
    }
}

fn climbed(rungs: impl Fn(i32) -> (f64, f64)) -> Option<String> {
    let rungs = ladder(rungs);
    let end = (1..=rungs.len()).find_map(|k| hopeless(&rungs[..k], TOLERANCE, Duration::from_secs(60), false))?;
    match end {
        End::Wrong(words) => Some(words),
        End::NotReached(words) => Some(format!("out of time: {words}")),
        other => panic!("{other:?}"),
    }
}

/// Seconds in proportion to the steps.
fn seconds(k: i32) -> f64 {
    2e-5 * 2f64.powi(k)
}

#[test]
fn a_steady_order_or_a_second_rung_tells_an_answer_from_a_chance_crossing() {
    let asked = |error: &dyn Fn(i32) -> f64| {
        let rungs = ladder(|k| (error(k), seconds(k)));
        (1..=rungs.len()).find(|asked| reached(&rungs[..*asked], TOLERANCE))
    };
    // 0.3/16⁵ is within 10⁻⁶: the sixth rung. If orders wander, one rung more.
    assert_eq!(asked(&|k| 0.3 * 16f64.powi(-k)), Some(6));
    assert_eq!(asked(&|k| 0.3 * 16f64.powi(-k) * if k % 2 == 0 { 1.0 } else { 1.2 }), Some(7));
    // Accidental zeros, at coarse and fine steps.
    let crossing = |k: i32| {
        if k == 2 || k == 8 { 0.0 } else { 0.3 * 2f64.powi(-k) }
    };
    assert_eq!(asked(&crossing), None);
    assert_eq!(asked(&|_| f64::NAN), None);
}

#[test]
fn the_finest_setting_says_whether_an_answer_is_within_the_tolerance() {
    let all = ladder(|k| (0.3 * 4f64.powi(-k), 1.0));
    assert!(within(&all, TOLERANCE) && !within(&all[..5], TOLERANCE) && !within(&[], TOLERANCE));
}

#[test]
fn settings_that_are_not_finite_are_named() {
    let all = ladder(|k| (if k < 2 { f64::NAN } else { 1e-9 }, 1.0));
    assert_eq!(not_finite(&all[2..]), None);
    let words = not_finite(&all).unwrap();
    assert!(words.starts_with("with ") && words.contains('8') && words.contains("16"), "{words}");
    assert!(!words.contains("32"), "{words}");
}

#[test]
fn what_no_longer_changes_is_not_asked_on() {
    let wrong = climbed(|k| (0.3 + 1e-3 * 16f64.powi(-k), seconds(k)));
    assert_eq!(wrong.as_deref(), Some("finer ones no longer change the answer"));
    let off = climbed(|k| (1e-4 + 1e-3 * 16f64.powi(-k), seconds(k)));
    assert_eq!(off.as_deref(), Some("finer ones no longer change the answer"));
    let not_a_number = climbed(|k| (f64::NAN, seconds(k)));
    assert_eq!(not_a_number.as_deref(), Some("finer ones are not finite either"));
}

/// A wrong code for tensors is told after few of its steps, which may be slow.
#[test]
fn tensors_that_no_longer_change_are_told_early() {
    let ends = |smooth: bool, error: &dyn Fn(i32) -> f64| {
        let rungs = ladder(|k| (error(k), seconds(k)));
        (1..=15).find(|k| hopeless(&rungs[..*k], TOLERANCE, Duration::from_secs(60), smooth).is_some())
    };
    let wrong = |k: i32| 0.28 + 1e-3 * 16f64.powi(-k);
    assert_eq!([true, false].map(|smooth| ends(smooth, &wrong)), [Some(7), Some(11)]);
    assert_eq!([true, false].map(|smooth| ends(smooth, &|_| f64::NAN)), [Some(7), Some(11)]);
    // Right ones of any order are asked on.
    for order in [1.0, 2.0, 4.0] {
        assert_eq!(ends(true, &|k| 0.3 * 2f64.powf(-order * f64::from(k))), None, "{order}");
    }
}

#[test]
fn answers_that_converge_to_another_one_are_not_asked_on() {
    // Euler's with a weight of 0.9: changes far above the tolerance, and a wrong limit.
    let elsewhere = climbed(|k| (0.3 + 0.1 * 2f64.powi(-k), seconds(k)));
    assert_eq!(elsewhere.as_deref(), Some("the answers converge, but not to the certified one"));
    // A fourth order soon changes by its rounding alone, which is above a hundredth of the tolerance.
    let rounded = |k: i32| 1.5 + 1e3 * 16f64.powi(-k) + 5e-8 * f64::from(k % 2);
    assert_eq!(climbed(|k| (rounded(k), seconds(k))), elsewhere);
    // Further changes are more than a hundredth of the error; and an error that falls to 0.
    assert_eq!(climbed(|k| (1e-3 + 2f64.powi(-k), 1e-9)), None);
    assert_eq!(climbed(|k| (0.3 * 2f64.powi(-k), 1e-9)), None);
}

#[test]
fn an_order_too_low_for_the_time_is_told_early() {
    let first = climbed(|k| (0.3 * 2f64.powi(-k), 1000.0 * seconds(k))).unwrap();
    assert!(first.starts_with("out of time") && first.contains("s, which --timeout does not allow"), "{first}");
}

#[test]
fn what_may_yet_come_within_the_tolerance_is_asked_on() {
    let second = |k: i32| 0.3 * 4f64.powi(-k);
    assert_eq!(climbed(|k| (second(k), seconds(k))), None);
    // Coarse steps that are unstable, or miss the motion.
    let unstable = |k: i32| if k < 9 { f64::NAN } else { second(k) };
    assert_eq!(climbed(|k| (unstable(k), seconds(k))), None);
    let missed = |k: i32| {
        if k < 9 { 1.5 + 1e-4 * f64::from(k) } else { second(k) }
    };
    assert_eq!(climbed(|k| (missed(k), seconds(k))), None);
    // A rod that is stuck where coarse steps hold it, a little farther each time; changes that end to shrink for a
    // while.
    let stuck = |k: i32| {
        if k < 12 { 1.5 + 1e-10 * 2f64.powi(k) } else { second(k) }
    };
    assert_eq!(climbed(|k| (stuck(k), seconds(k))), None);
    let waits = |k: i32| match k {
        ..8 => 0.306,
        8..12 => 0.302 - 1e-3 * f64::from(k - 8),
        _ => second(k),
    };
    assert_eq!(climbed(|k| (waits(k), seconds(k))), None);
    // A pause of the machine; a program that starts slowly.
    let pause = |k: i32| seconds(k) + if k == 10 { 3.0 } else { 0.0 };
    assert_eq!(climbed(|k| (0.3 * 2f64.powi(-k), pause(k))), None);
    let start = |k: i32| if k == 0 { 3.0 } else { 1e-4 };
    assert_eq!(climbed(|k| (second(k), start(k))), None);
}

/// Climbs on one problem with a timeout of a minute: returns the problem, the rungs, and the end.
fn climbed_in(mode: Mode, claimed: Option<f64>, rungs: impl Fn(i32) -> (f64, f64)) -> (LoadedProblem, Vec<Rung>, End) {
    let problem = loaded("mid-flip-2");
    let asked = Cell::new(0);
    let ask = |setting: Setting| -> Result<Rung, Asked> {
        let (error, seconds) = rungs(asked.replace(asked.get() + 1));
        Ok(rung(setting, error, seconds))
    };
    let (rungs, end) = climb(&problem, mode, Duration::from_secs(60), claimed, ask);
    (problem, rungs, end)
}

#[test]
fn an_order_is_no_answer_and_one_that_is_unclear_is_asked_on_to_round_off() {
    let fourth = |k: i32| (0.05 * 16f64.powi(-k), 0.0);
    for claimed in [None, Some(4.0)] {
        let (problem, rungs, end) = climbed_in(Mode::Steps, claimed, fourth);
        assert_eq!(end, End::Reached);
        let tolerance = problem.problem.tolerance;
        assert!(within(&rungs, tolerance) && !within(&rungs[..rungs.len() - 1], tolerance), "{:?}", errors(&rungs));
    }
    // A program that chooses its steps shows none: it is asked no further than the answer.
    let tenth = |k: i32| (0.05 * 10f64.powi(-k), 0.0);
    let [with, without] = [Some(4.0), None].map(|claimed| climbed_in(Mode::Tolerance, claimed, tenth));
    assert_eq!((with.1.len(), with.2), (without.1.len(), without.2));
    // Neither the claimed order nor lower by a whole order.
    let (problem, rungs, end) = climbed_in(Mode::Steps, Some(4.6), fourth);
    assert_eq!(end, End::Reached);
    assert!(within(&rungs, 0.01 * problem.own_tolerance), "{:?}", errors(&rungs));
}

#[test]
fn what_would_take_too_long_is_not_asked_unless_it_confirms() {
    let end = |error: f64, seconds: f64| climbed_in(Mode::Steps, None, |_| (error, seconds)).2;
    let limit = "finer ones would take longer than --timeout 60 (";
    assert!(matches!(end(0.5, 16.0), End::NotReached(words) if words.contains(limit)));
    // The first answer may hold the program's start.
    let starts = |k: i32| if k == 0 { (0.5, 59.0) } else { (0.5 * 16f64.powi(-k), 0.0) };
    assert_eq!(climbed_in(Mode::Steps, None, starts).2, End::Reached);
    // An answer within the tolerance is confirmed in twice its time.
    assert_eq!(end(1e-15, 29.0), End::Reached);
    assert!(matches!(end(1e-15, 31.0), End::NotReached(words) if words.starts_with("one answer alone is within")));
}

/// Answers that converge to another limit do not pass by the order of their errors, which near it is lower.
#[test]
fn a_wrong_limit_is_seen_by_the_answers_alone() {
    let problem = loaded("closed-ft-linear-0.1");
    let converges = |limit: f64| {
        let answer = |steps: u64| {
            let mut answer = Answer::certified(&problem);
            answer.lines = vec![0; answer.rows.len()];
            answer.rows[1][0] += 1.0 / steps as f64 + limit;
            (steps, answer)
        };
        converging(&problem, &[1000, 2000, 4000, 8000].map(answer)).is_some()
    };
    assert!(converges(0.0));
    assert!(!converges(1e-7) && !converges(-1e-6));
}

/// Rounding that grows is no want of time.
#[test]
fn errors_that_grow_with_the_steps_are_wrong_where_time_ends() {
    let end = |factor: f64| climbed_in(Mode::Steps, None, |k| (1e-4 * factor.powi(k), 1e-3 * 2f64.powi(k))).2;
    assert!(matches!(end(1.5), End::Stays(words) if words == "the error grows with the steps, as rounding does"));
    assert!(matches!(end(0.85), End::NotReached(_)));
}

/// BDF and LSODA: the tolerance of a step is far smaller than the error at the end.
#[test]
fn errors_that_fall_with_the_smallest_tolerances_are_no_failure() {
    let ladder = |error: &dyn Fn(i32) -> f64| {
        let (problem, rungs, end) = climbed_in(Mode::Tolerance, None, |k| (error(k), 0.0));
        (converges(&problem, &rungs).is_some(), end)
    };
    let tolerance = loaded("mid-flip-2").problem.tolerance;
    let falls = |times: f64| move |k: i32| 0.9 * times * tolerance * 6f64.powi(12 - k);
    assert!(matches!(ladder(&falls(100.0)), (true, End::NotReached(_))));
    assert!(matches!(ladder(&falls(150.0)), (false, End::NotReached(_))));
    // A wrong model, and a solver that has no such tolerance.
    let wrong = |k: i32| 50.0 * tolerance + falls(1.0)(k);
    assert!(matches!(ladder(&wrong), (false, End::Wrong(_))));
    let ends = |k: i32| falls(50.0)(k.min(10));
    assert!(matches!(ladder(&ends), (false, End::Wrong(_))));
}

#[test]
fn two_answers_on_the_curve_of_one_mistake_are_wrong_before_time_is_up() {
    let problem = last_time(&loaded("mid-flip-2"));
    let setting = mistakes::Setting::from(&problem.problem);
    let (start, time_s) = (Vector3::from(problem.start[0]), problem.problem.times_s[0]);
    let rung = |steps: u64, p: Vector3<f64>| {
        Rung::of(&problem, Setting::Steps(steps), vec![p.as_slice().to_vec()], Duration::ZERO)
    };
    let of = |name: &str, late: f64| {
        let all = mistakes::all();
        let mistake = all.iter().find(|mistake| mistake.name == name).unwrap();
        mistake.direction(&setting, &start, late * time_s).unwrap()
    };
    let transposed = "a transposed gradient";
    let both = [rung(64, of(transposed, 1.0)), rung(128, of(transposed, 1.0))];
    assert!(stays_on_a_mistake(&problem, &both));
    assert!(!stays_on_a_mistake(&problem, &both[1..]));
    let two = [rung(64, of(transposed, 1.0)), rung(128, of("half the shear rate", 1.0))];
    assert!(!stays_on_a_mistake(&problem, &two));
    // A right code that lags, by less with more steps.
    let right = |late: f64| (mistakes::right_map(&setting, late * time_s).unwrap() * start).normalize();
    assert!(!stays_on_a_mistake(&problem, &[rung(64, right(0.97)), rung(128, right(0.985))]));
}

/// A program whose answers stay on a curve is asked two short steps if the curve has a name, and four if it has none.
#[test]
fn a_curve_with_a_name_is_asked_fewer_steps() {
    let problem = last_time(&loaded("mid-flip-2"));
    let setting = mistakes::Setting::from(&problem.problem);
    let start = Vector3::from(problem.start[0]);
    let asked = |rate: f64| {
        // Its own error falls by an order 4.
        let moved = |steps: u64| {
            let time_s = problem.problem.times_s[0] * rate * (1.0 + (steps as f64).powi(-4));
            (mistakes::right_map(&setting, time_s).unwrap() * start).normalize()
        };
        let ask = |setting: Setting| {
            let p = moved(setting.steps().unwrap());
            Ok(Rung::of(&problem, setting, vec![p.as_slice().to_vec()], Duration::ZERO))
        };
        let (rungs, end) = climb(&problem, Mode::Steps, Duration::from_secs(60), None, ask);
        (rungs.len(), end)
    };
    let no_change = || End::Wrong("finer ones no longer change the answer".to_owned());
    assert_eq!(asked(0.5), (9, no_change()));
    let (without_name, end) = asked(0.83);
    assert!(without_name > 10 && matches!(end, End::Wrong(_)), "{without_name} {end:?}");
    assert_eq!(asked(1.0).1, End::Reached);
}

/// Otherwise a code of equal steps passes no time of the problem but the last.
#[test]
fn steps_of_tensors_end_at_every_time_of_the_problem() {
    let times = |name: &str| loaded(name).problem.times_s;
    for name in problems::all().iter().map(|def| def.name).filter(|name| name.starts_with("closed-")) {
        let problem = loaded(name);
        let coarsest = settings(&problem, Mode::Steps)[0].steps().unwrap();
        for time in times(name) {
            let step = time / times(name).last().unwrap() * coarsest as f64;
            assert!((step - step.round()).abs() < 1e-9, "{name}: {step} of {coarsest}");
        }
    }
    assert_eq!(fewest(&[0.25, 0.75, 2.0]), 8);
    assert_eq!(fewest(&[1.0, std::f64::consts::PI]), 1);
}

#[test]
fn a_ladder_out_of_time_is_not_reached_and_fails_on_the_curve_of_a_mistake() {
    let late = || End::NotReached(String::new());
    assert_eq!([false, true].map(|mistaken| verdict(&late(), mistaken)), [Verdict::NotReached, Verdict::Fail]);
    assert_eq!([End::Reached, End::Lower].map(|end| verdict(&end, false)), [Verdict::Pass, Verdict::Fail]);
}
