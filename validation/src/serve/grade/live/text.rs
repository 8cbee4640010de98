//! Requests and answers as lines of numbers separated by blanks, for programs without JSON
//! (`docs/src/user/grading.md`).

use super::pipe::excerpt;
use super::request::{Asked, Request, Turned};
use crate::files::csv;
use shearbed::plan::counted;

/// Begins what is wrong with a line that answers a request in numbers.
pub const AFTER_ID: &str = "after the id";

/// The request as one line: `id`, the nine ∂u_i/∂x_j row by row, r_e, the time in s, the number of steps or 0, the
/// tolerance or 0, the number of rods, and three numbers for each rod. `Err` in a flow that turns, which has no place
/// in it.
pub fn write(Request { id, question, steps, tolerance }: &Request) -> Result<String, String> {
    if question.rotation_rad_per_s.is_some() {
        return Err("a flow that turns needs lines of JSON".to_owned());
    }
    let joined = |numbers: &[f64]| numbers.iter().map(|number| format!(" {number:e}")).collect::<String>();
    let [gradient, start] = [question.gradient_per_s.as_flattened(), question.start.as_flattened()].map(joined);
    let [r_e, end, tolerance] = [question.aspect_ratio, question.end_s, tolerance.unwrap_or(0.0)];
    let (steps, rods) = (steps.unwrap_or(0), question.start.len());
    Ok(format!("{id}{gradient} {r_e:e} {end:e} {steps} {tolerance:e} {rods}{start}"))
}

/// Parses the answer to request `id` about `rods` rods: `id` and three numbers for each rod, or `id error REASON`.
/// `Err` says what is wrong with the line.
pub fn read(line: &str, id: u64, rods: usize) -> Result<Turned, Asked> {
    let mut words = line.split_ascii_whitespace();
    let first = words.next().ok_or_else(|| "it is empty".to_owned())?;
    match first.parse::<u64>() {
        Ok(found) if found == id => {}
        Ok(found) => return Err(format!("it answers id {found} where {id} was asked").into()),
        Err(_) => return Err(format!("it does not begin with the request's id: {}", excerpt(line)).into()),
    }
    let rest: Vec<_> = words.collect();
    if rest.first() == Some(&"error") {
        return Err(Asked::Says(rest[1..].join(" ")));
    }
    if rest.len() != 3 * rods {
        let found = rest.len();
        let [due, rods] = [(3 * rods, "number"), (rods, "rod")].map(|(count, what)| counted(count as u64, what));
        return Err(format!("{AFTER_ID} there are {found} where {due} were asked for {rods}").into());
    }
    let numbers: Result<Vec<_>, _> = rest.iter().map(|word| number(word)).collect();
    let numbers = numbers.map_err(|why| format!("{AFTER_ID}: {why}"))?;
    Ok(Turned { p: numbers.chunks(3).map(|p| [p[0], p[1], p[2]]).collect(), evaluations: None })
}

/// Parses a number as printed by C, C++, Fortran, Julia, Octave or Python. Infinities become NaN.
fn number(word: &str) -> Result<f64, String> {
    let wrong = || format!("{} is not a number", excerpt(word));
    match csv::number(word).ok_or_else(wrong)? {
        number if number.is_finite() => Ok(number),
        _ if word.bytes().any(|byte| byte.is_ascii_digit()) => {
            Err(format!("{} is too large for a double", excerpt(word)))
        }
        _ => Ok(f64::NAN),
    }
}

#[cfg(test)]
mod tests {
    use super::super::request::Question;
    use super::*;

    #[test]
    fn a_request_is_one_line_in_the_documented_form() {
        let question = Question {
            gradient_per_s: [[0.0; 3], [0.5, 0.0, 0.0], [0.0, 0.0, -1e-7]],
            ..Question::couette(11.6, vec![[1.0, 0.0, 0.0], [0.6, 0.8, 0.0]], 2.0)
        };
        let request = Request { id: 7, question: question.clone(), steps: Some(64), tolerance: None };
        let expected = "7 0e0 0e0 0e0 5e-1 0e0 0e0 0e0 0e0 -1e-7 1.16e1 2e0 64 0e0 2 1e0 0e0 0e0 6e-1 8e-1 0e0";
        assert_eq!(write(&request).unwrap(), expected);
        let request = Request { steps: None, tolerance: Some(1e-6), ..request };
        assert_eq!(write(&request).unwrap(), expected.replace(" 64 0e0 ", " 0 1e-6 "));
        let question = Question { rotation_rad_per_s: Some([0.0, 0.0, 1.0]), ..question };
        assert!(write(&Request { question, ..request }).is_err());
    }

    #[test]
    fn answers_are_read_and_whatever_else_is_refused_with_its_reason() {
        let p = |x: f64| Ok(Turned { p: vec![[1.0, x, -2.5]], evaluations: None });
        for line in ["3 1 0.125 -2.5", " 3  1.0\t1.25E-01 -2.5 ", "3 1.D0 0.125d0 -25.0D-1\r"] {
            assert_eq!(read(line, 3, 1), p(0.125), "{line}");
        }
        for word in ["NaN", "nan", "-inf", "Infinity", "-Infinity"] {
            let p = read(&format!("3 1 {word} -2.5"), 3, 1).unwrap().p;
            assert!(p[0][1].is_nan() && p[0][2] == -2.5);
        }
        assert_eq!(read("3 error too stiff", 3, 1), Err(Asked::Says("too stiff".into())));
        for (line, reason) in [
            ("", "empty"),
            ("step 1 of 10", "does not begin with the request's id"),
            ("4 1 0 0", "answers id 4 where 3 was asked"),
            ("3.0 1 0 0", "does not begin with"),
            ("3 1 0", "after the id there are 2 where 3 numbers were asked for 1 rod"),
            ("3 1 0 0 0", "there are 4 where 3"),
            ("3 1 0 x", "`x` is not a number"),
            ("3 1 0 1e400", "too large"),
            ("3 1 0 ********", "not a number"),
        ] {
            let found = read(line, 3, 1).unwrap_err().to_string();
            assert!(found.contains(reason), "{line}: {found}");
        }
    }
}
