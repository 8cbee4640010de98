//! Answers with few digits: single precision, or few printed ones.

use super::answer::Answer;

/// The range of digits that are recognised: fewer are labels, more are a double's.
const DIGITS: std::ops::RangeInclusive<usize> = 4..=12;

/// The largest error in units of the last digit that rounding on the way explains, if the steps are fewer: each rounds
/// once.
const ROUNDINGS: f64 = 100.0;

/// The same for printed digits of a double, which round once.
const PRINTINGS: f64 = 2.0;

/// A sentence if the answer by so many steps has few digits, and its `error` is no more than these explain.
pub(super) fn remark(answer: &Answer, error: f64, steps: Option<u64>) -> Option<String> {
    let all = || answer.rows.iter().flatten().copied();
    if !error.is_finite() || all().any(|x| !x.is_finite()) {
        return None;
    }
    let size = all().fold(0.0, |size: f64, x| size.max(x.abs()));
    let printed = |x: f64, digits: usize| format!("{x:.*e}", digits - 1).parse::<f64>();
    let digits = DIGITS.into_iter().find(|digits| all().all(|x| printed(x, *digits) == Ok(x)));
    // Fewer than nine digits say nothing: they round to numbers of single precision and back.
    let is_single = |x: f64| {
        let single = f64::from(x as f32);
        single == x || digits.is_some_and(|digits| digits > 8 && printed(single, digits) == Ok(x))
    };
    let roundings = ROUNDINGS.max(steps.unwrap_or_default() as f64);
    let have_more_than = |few: usize| all().any(|x| printed(x, few) != Ok(x));
    if have_more_than(8) && error <= roundings * f64::from(f32::EPSILON) * size && all().all(is_single) {
        return Some("your answer has single precision, whose errors of 1e-7 and more explain this one".to_owned());
    }
    // Zeros and ones are numbers of any precision.
    let digits = digits.filter(|_| have_more_than(3))?;
    let last = 10f64.powi(1 - digits as i32) * size;
    (error <= PRINTINGS * last).then(|| {
        format!(
            "its numbers have {digits} digits, which explains this error: 17 make a double, or a larger tolerance does"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_digits_are_seen_where_they_explain_the_error() {
        let of = |rows: Vec<Vec<f64>>| Answer { path: "answer.csv".into(), rows, lines: vec![2] };
        let single = of(vec![vec![f64::from(0.1f32), f64::from(0.7f32)]]);
        assert!(remark(&single, 1e-7, None).unwrap().contains("single precision"));
        assert!(remark(&single, 1e-3, Some(80_000)).unwrap().contains("single precision"));
        assert_eq!((remark(&single, 1e-3, None), remark(&single, 1e-3, Some(1000))), (None, None));
        let nine = |x: f32| format!("{x:.8e}").parse().unwrap();
        let single = of(vec![vec![nine(0.1), nine(0.7), nine(1.0 / 3.0)]]);
        assert!(remark(&single, 1e-7, None).unwrap().contains("single precision"));
        let printed = of(vec![vec![0.123_456_789, 0.7, 0.333_333_333]]);
        assert!(remark(&printed, 1e-8, None).unwrap().contains("9 digits"));
        assert_eq!(remark(&printed, 1e-7, None), None);
        let printed = of(vec![vec![0.123_456_78, -0.5, 0.0]]);
        assert!(remark(&printed, 1e-8, None).unwrap().contains("8 digits"));
        assert_eq!(remark(&printed, 1e-3, None), None);
        assert_eq!(remark(&of(vec![vec![0.1 + 0.2, 1.0 / 3.0]]), 1e-8, None), None);
        // Labels, and other errors than rounding.
        assert_eq!(remark(&of(vec![vec![0.0, 1.0, 0.5]]), 1e-6, None), None);
        assert_eq!(remark(&of(vec![vec![f64::NAN]]), f64::NAN, None), None);
    }
}
