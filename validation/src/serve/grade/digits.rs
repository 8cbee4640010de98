//! Answers with few digits: single precision, or few printed ones.

use super::Graded;
use super::answer::Answer;

/// The range of digits that are recognised: fewer are labels, more are a double's.
const DIGITS: std::ops::RangeInclusive<usize> = 4..=12;

/// The largest error in units of the last digit that rounding on the way explains, if the steps are fewer: each rounds
/// once.
const ROUNDINGS: f64 = 100.0;

/// The same for printed digits of a double, which round once.
const PRINTINGS: f64 = 2.0;

/// A sentence if answers have single precision and nothing else says so.
pub fn single(graded: &[Graded]) -> Option<String> {
    let said = |graded: &Graded| graded.note.as_ref().is_some_and(|note| note.contains("single precision"));
    let has = |graded: &&Graded| !said(graded) && graded.answer.as_ref().is_some_and(is_single);
    match graded.iter().filter(has).count() {
        0 => None,
        1 => Some("an answer has single precision: each step rounds by 1e-7".to_owned()),
        many => Some(format!("{many} answers have single precision: each step rounds by 1e-7")),
    }
}

/// A value in so many digits.
pub(super) fn printed(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap_or(f64::NAN)
}

/// The number of digits that all values of an answer have, if they are few.
fn few(answer: &Answer) -> Option<usize> {
    DIGITS.into_iter().find(|digits| values(answer).all(|x| printed(x, *digits) == x))
}

fn values(answer: &Answer) -> impl Iterator<Item = f64> {
    answer.rows.iter().flatten().copied()
}

fn has_more_than(answer: &Answer, digits: usize) -> bool {
    values(answer).any(|x| printed(x, digits) != x)
}

fn is_single(answer: &Answer) -> bool {
    let digits = few(answer);
    // Fewer than nine digits say nothing: they round to numbers of single precision and back.
    let is_single = |x: f64| {
        let single = f64::from(x as f32);
        single == x || digits.is_some_and(|digits| digits > 8 && printed(single, digits) == x)
    };
    has_more_than(answer, 8) && values(answer).all(is_single)
}

/// A sentence if the answer by so many steps has few digits, and its `error` is no more than these explain.
pub(super) fn remark(answer: &Answer, error: f64, steps: Option<u64>) -> Option<String> {
    if !error.is_finite() || values(answer).any(|x| !x.is_finite()) {
        return None;
    }
    let size = values(answer).fold(0.0, |size: f64, x| size.max(x.abs()));
    let roundings = ROUNDINGS.max(steps.unwrap_or_default() as f64);
    if error <= roundings * f64::from(f32::EPSILON) * size && is_single(answer) {
        return Some("your answer has single precision, whose rounding explains this error".to_owned());
    }
    // Zeros and ones are numbers of any precision.
    let digits = few(answer).filter(|_| has_more_than(answer, 3))?;
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
        // An answer that passes has it said too.
        let problem = &crate::serve::problems::loaded("mid-flip-2");
        let with = |rows: Vec<Vec<f64>>| Graded { answer: Some(of(rows)), ..Graded::without_answer(problem) };
        let [single_one, double] = [f64::from(0.1f32), 0.1].map(|x| with(vec![vec![x, f64::from(0.7f32), 1.0 / 2.0]]));
        assert!(self::single(&[single_one.clone(), double.clone()]).unwrap().starts_with("an answer has single"));
        assert!(self::single(&[single_one.clone(), single_one]).unwrap().starts_with("2 answers have single"));
        assert_eq!(self::single(&[double]), None);
        // Labels, and other errors than rounding.
        assert_eq!(remark(&of(vec![vec![0.0, 1.0, 0.5]]), 1e-6, None), None);
        assert_eq!(remark(&of(vec![vec![f64::NAN]]), f64::NAN, None), None);
    }
}
