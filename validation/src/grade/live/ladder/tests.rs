use super::*;

const TOLERANCE: f64 = 1e-6;

/// Fifteen rungs, one for each doubling: the angle by which a rod is off, which is its error too, and how long it took.
fn ladder(rungs: impl Fn(i32) -> (f64, f64)) -> Vec<Rung> {
    let rung = |k: i32| {
        let (error, seconds) = rungs(k);
        Rung {
            setting: Setting::Steps(8 << k),
            answer: answer(vec![[error.cos(), error.sin(), 0.0]]),
            compared: Compared {
                error,
                row: 0,
                remark: None,
                length_drift: None,
                orbit_drift: None,
                phase_lost_per_period: None,
                too_little_data: false,
            },
            took: Duration::from_secs_f64(seconds),
        }
    };
    (0..15).map(rung).collect()
}

fn climbed(rungs: impl Fn(i32) -> (f64, f64)) -> Option<String> {
    let rungs = ladder(rungs);
    (1..=rungs.len()).find_map(|k| hopeless(&rungs[..k], TOLERANCE, Duration::from_secs(60)))
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
    // 0.3/16⁵ is within 10⁻⁶: the sixth rung. Where orders wander, one more.
    assert_eq!(asked(&|k| 0.3 * 16f64.powi(-k)), Some(6));
    assert_eq!(
        asked(&|k| 0.3 * 16f64.powi(-k) * if k % 2 == 0 { 1.0 } else { 1.2 }),
        Some(7)
    );
    // Zeros crossed by chance, among coarse and fine steps.
    let crossing = |k: i32| {
        if k == 2 || k == 8 {
            0.0
        } else {
            0.3 * 2f64.powi(-k)
        }
    };
    assert_eq!(asked(&crossing), None);
    assert_eq!(asked(&|_| f64::NAN), None);
}

#[test]
fn what_no_longer_changes_is_not_asked_on() {
    let wrong = climbed(|k| (0.3 + 1e-3 * 16f64.powi(-k), seconds(k)));
    assert_eq!(wrong.as_deref(), Some("finer ones no longer change the answer"));
    let not_a_number = climbed(|k| (f64::NAN, seconds(k)));
    assert_eq!(not_a_number.as_deref(), Some("finer ones are not finite either"));
}

#[test]
fn an_order_too_low_for_the_time_is_told_early() {
    let first = climbed(|k| (0.3 * 2f64.powi(-k), 1000.0 * seconds(k))).unwrap();
    assert!(first.contains("s, which --timeout does not allow"), "{first}");
}

#[test]
fn what_may_yet_come_within_the_tolerance_is_asked_on() {
    let second = |k: i32| 0.3 * 4f64.powi(-k);
    assert_eq!(climbed(|k| (second(k), seconds(k))), None);
    // Coarse steps that are unstable, or miss the motion.
    let unstable = |k: i32| if k < 9 { f64::NAN } else { second(k) };
    assert_eq!(climbed(|k| (unstable(k), seconds(k))), None);
    let missed = |k: i32| {
        if k < 9 {
            1.5 + 1e-4 * f64::from(k)
        } else {
            second(k)
        }
    };
    assert_eq!(climbed(|k| (missed(k), seconds(k))), None);
    // A pause of the machine; what takes long to start.
    let pause = |k: i32| seconds(k) + if k == 10 { 3.0 } else { 0.0 };
    assert_eq!(climbed(|k| (0.3 * 2f64.powi(-k), pause(k))), None);
    let start = |k: i32| if k == 0 { 3.0 } else { 1e-4 };
    assert_eq!(climbed(|k| (second(k), start(k))), None);
}
