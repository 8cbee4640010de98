//! Requests and answers as lines of JSON (`docs/src/user/grading.md`), and the form of lines that a program uses.

use super::pipe::excerpt;
use super::request::{Asked, Request, Turned};
use super::text;
use crate::files::text::start;
use serde::Deserialize;
use serde_json::Value;

/// The form of the lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Protocol {
    /// One JSON object per line.
    #[default]
    Json,
    /// Numbers separated by blanks.
    Text,
}

impl std::str::FromStr for Protocol {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        match word {
            "json" => Ok(Self::Json),
            "text" => Ok(Self::Text),
            _ => Err("json and text are allowed".to_owned()),
        }
    }
}

impl Protocol {
    /// The value of `--protocol`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Text => "text",
        }
    }

    pub(super) fn write(self, request: &Request) -> Result<String, String> {
        match self {
            Self::Json => serde_json::to_string(request).map_err(|error| error.to_string()),
            Self::Text => text::write(request),
        }
    }

    /// Parses the answer to request `id` about `rods` rods. `Err` says what is wrong with the line.
    pub(super) fn read(self, line: &str, id: u64, rods: usize) -> Result<Turned, Asked> {
        match self {
            Self::Json => read(line, id, rods),
            Self::Text => text::read(line, id, rods),
        }
    }

    /// The answer of a program that returns the start directions.
    pub(super) fn echo(self, line: &str) -> Result<String, String> {
        match self {
            Self::Json => {
                let request: Value = serde_json::from_str(line).map_err(|error| error.to_string())?;
                Ok(serde_json::json!({"id": request["id"], "p": request["start"]}).to_string())
            }
            Self::Text => {
                let words: Vec<_> = line.split_ascii_whitespace().collect();
                let (id, start) = words.split_first().ok_or("an empty line")?;
                Ok([&[*id], start.get(14..).unwrap_or_default()].concat().join(" "))
            }
        }
    }
}

/// Parses the answer to request `id` about `rods` rods. `Err` says what is wrong with the line.
pub fn read(line: &str, id: u64, rods: usize) -> Result<Turned, Asked> {
    let (found, evaluations) = content(line, id, "p", |answer| Some((answer.p?, answer.evaluations)))?;
    let evaluations =
        match evaluations.filter(|found| !found.is_null()) {
            None => None,
            Some(found) => Some(found.as_u64().ok_or_else(|| {
                format!("\"evaluations\" is {}; a whole number is allowed", excerpt(&found.to_string()))
            })?),
        };
    match found {
        Value::Array(found) if found.len() == rods => {
            let p: Result<_, _> = found.iter().enumerate().map(|(k, p)| direction(k, p)).collect();
            Ok(Turned { p: p?, evaluations })
        }
        Value::Array(found) => Err(format!("{} rods where {rods} were asked", found.len()).into()),
        other => Err(format!("\"p\" is {}; a list of directions is allowed", excerpt(&other.to_string())).into()),
    }
}

/// A table of numbers, row by row.
pub type Rows = Vec<Vec<f64>>;

/// Parses the table of so many rows and columns in the answer to request `id`, with that of the standard errors if it
/// has one, or the program's own error. `Err` says what is wrong with the line.
pub fn table(line: &str, id: u64, size: [usize; 2]) -> Result<(Rows, Option<Rows>), Asked> {
    let (found, errors) = content(line, id, "rows", |answer| Some((answer.rows?, answer.rows_se)))?;
    let errors = errors.filter(|errors| !errors.is_null()).map(|errors| rows("rows_se", &errors, size)).transpose()?;
    Ok((rows("rows", &found, size)?, errors))
}

/// The numbers of the key `name`.
fn rows(name: &str, found: &Value, [rows, columns]: [usize; 2]) -> Result<Rows, String> {
    let table = found.as_array().filter(|found| found.len() == rows);
    let table = table.ok_or_else(|| format!("\"{name}\" must be a list of {rows} rows"))?;
    let row = |(k, row): (usize, &Value)| {
        let found = row.as_array().filter(|found| found.len() == columns);
        let numbers = found.and_then(|found| found.iter().map(number).collect());
        let wrong =
            || format!("row {k} of \"{name}\" is {}; {columns} numbers are asked for", excerpt(&row.to_string()));
        numbers.ok_or_else(wrong)
    };
    table.iter().enumerate().map(row).collect()
}

/// The value of an answer's key `name`, or the program's own error.
fn content<T>(line: &str, id: u64, name: &str, of: impl Fn(Line) -> Option<T>) -> Result<T, Asked> {
    let answer = parse(line)?;
    let found = answer.id.as_ref().ok_or_else(|| format!("it has no \"id\": {}", excerpt(line)))?;
    if found.as_u64() != Some(id) {
        return Err(format!("it answers id {} where {id} was asked", start(&found.to_string(), 60)).into());
    }
    let error = answer.error.clone();
    let wrong = match (error, of(answer)) {
        (Some(Value::Null) | None, Some(found)) => return Ok(found),
        (Some(Value::String(reason)), None) => return Err(Asked::Says(reason)),
        (Some(Value::String(_)), Some(_)) => format!("both \"{name}\" and \"error\": {}", excerpt(line)),
        (Some(Value::Null) | None, None) => format!("neither \"{name}\" nor \"error\": {}", excerpt(line)),
        (Some(other), _) => format!("\"error\" is {}; a text is allowed", excerpt(&other.to_string())),
    };
    Err(wrong.into())
}

/// A number, NaN where it is null.
fn number(value: &Value) -> Option<f64> {
    if value.is_null() { Some(f64::NAN) } else { value.as_f64() }
}

fn direction(rod: usize, value: &Value) -> Result<[f64; 3], String> {
    let wrong = || format!("rod {rod} is {}; three numbers are allowed", excerpt(&value.to_string()));
    let numbers = value.as_array().and_then(|found| found.iter().map(number).collect::<Option<Vec<_>>>());
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(wrong)
}

/// The keys of an answer, each at most once; others are ignored.
#[derive(Deserialize)]
struct Line {
    id: Option<Value>,
    error: Option<Value>,
    p: Option<Value>,
    evaluations: Option<Value>,
    rows: Option<Value>,
    rows_se: Option<Value>,
}

/// Parses JSON that may also contain the texts of Python and JavaScript for NaN and infinities.
fn parse(line: &str) -> Result<Line, String> {
    if !line.trim_start().starts_with('{') {
        return match serde_json::from_str::<Value>(line) {
            Ok(_) => Err(format!("not a JSON object: {}", excerpt(line))),
            Err(error) => Err(format!("not JSON ({error}): {}", excerpt(line))),
        };
    }
    serde_json::from_str(line).or_else(|error| {
        // Longer words first, as they contain the shorter ones.
        let words = ["-Infinity", "Infinity", "-inf", "inf", "-NaN", "NaN", "-nan", "nan"];
        let without = words.iter().fold(line.to_owned(), |text, word| text.replace(word, "null"));
        serde_json::from_str(&without).map_err(|_| format!("not JSON ({error}): {}", excerpt(line)))
    })
}

#[cfg(test)]
mod tests {
    use super::super::request::Question;
    use super::*;

    #[test]
    fn a_request_is_one_line_in_the_documented_form() {
        let gradient_per_s = [[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]];
        let question = Question { gradient_per_s, ..Question::couette(11.6, vec![[1.0, 0.0, 0.0]], 2.0) };
        let request = Request { id: 7, question, steps: Some(64), tolerance: None };
        let expected = concat!(
            r#"{"id":7,"gradient_per_s":[[0.0,0.0,0.0],[0.5,0.0,0.0],[0.0,0.0,0.0]],"aspect_ratio":11.6,"#,
            r#""start":[[1.0,0.0,0.0]],"end_s":2.0,"steps":64}"#
        );
        assert_eq!(serde_json::to_string(&request).unwrap(), expected);
    }

    #[test]
    fn answers_are_read() {
        for (more, evaluations) in [(r#", "more": {}"#, None), (r#", "evaluations": 40"#, Some(40))] {
            let found = read(&format!(r#"{{"id": 3, "p": [[1, 0.0, -2.5]]{more}}}"#), 3, 1);
            assert_eq!(found, Ok(Turned { p: vec![[1.0, 0.0, -2.5]], evaluations }));
        }
        assert_eq!(read(r#"{"id": 3, "error": "too stiff"}"#, 3, 1), Err(Asked::Says("too stiff".into())));
        for line in [r#"{"id":3,"p":[[NaN,0,1]]}"#, r#"{"id":3,"p":[[-Infinity,0,1]]}"#, r#"{"id":3,"p":[[null,0,1]]}"#]
        {
            let p = read(line, 3, 1).unwrap().p;
            assert!(p[0][0].is_nan() && p[0][2] == 1.0);
        }
    }

    #[test]
    fn tables_are_read_and_others_refused() {
        let line = r#"{"id": 3, "rows": [[1, null], [0.5, -2]]}"#;
        let (found, errors) = table(line, 3, [2, 2]).unwrap();
        assert!(found[0][1].is_nan() && found[1] == [0.5, -2.0] && errors.is_none());
        let with_errors = r#"{"id": 3, "rows": [[1, 2]], "rows_se": [[0.1, 0.2]]}"#;
        assert_eq!(table(with_errors, 3, [1, 2]), Ok((vec![vec![1.0, 2.0]], Some(vec![vec![0.1, 0.2]]))));
        let short = r#"{"id": 3, "rows": [[1, 2]], "rows_se": [[0.1]]}"#;
        assert!(
            table(short, 3, [1, 2]).unwrap_err().to_string().contains("row 0 of \"rows_se\" is `[0.1]`; 2 numbers")
        );
        assert_eq!(table(r#"{"id": 3, "error": "no"}"#, 3, [2, 2]), Err(Asked::Says("no".into())));
        for (size, reason) in [([3, 2], "a list of 3 rows"), ([2, 3], "row 0 of \"rows\" is `[1,null]`; 3 numbers")] {
            assert!(table(line, 3, size).unwrap_err().to_string().contains(reason), "{reason}");
        }
        assert!(table(r#"{"id": 3, "p": [[1,0,0]]}"#, 3, [1, 3]).unwrap_err().to_string().contains("neither \"rows\""));
    }

    #[test]
    fn whatever_else_is_refused_with_its_reason() {
        for (line, reason) in [
            ("step 1 of 10", "not JSON"),
            ("", "not JSON"),
            ("[1, 2]", "not a JSON object"),
            (r#"{"p": [[1,0,0]]}"#, "no \"id\""),
            (r#"{"id": 4, "p": [[1,0,0]]}"#, "answers id 4 where 3 was asked"),
            (r#"{"id": "3", "p": [[1,0,0]]}"#, "answers id \"3\" where 3"),
            (r#"{"id": 3}"#, "neither"),
            (r#"{"id": 3, "p": []}"#, "0 rods where 1"),
            (r#"{"id": 3, "p": [[1,0,0],[1,0,0]]}"#, "2 rods where 1"),
            (r#"{"id": 3, "p": 1}"#, "a list of directions is allowed"),
            (r#"{"id": 3, "p": [[1,0]]}"#, "rod 0 is `[1,0]`; three numbers"),
            (r#"{"id": 3, "p": [["1",0,0]]}"#, "three numbers"),
            (r#"{"id": 3, "p": [[1e400,0,0]]}"#, "not JSON"),
            (r#"{"id": 3, "p": [[1,0,0]], "evaluations": 0.5}"#, "\"evaluations\" is `0.5`; a whole number"),
            (r#"{"id": 3, "error": 5}"#, "a text is allowed"),
            (r#"{"id": 4, "p": [[0,0,1]], "id": 3}"#, "duplicate field `id`"),
            (r#"{"id": 3, "p": [[0,0,1]], "p": [[1,0,0]]}"#, "duplicate field `p`"),
            (r#"{"id": 3, "error": "x", "p": [[1,0,0]]}"#, "both"),
        ] {
            let found = read(line, 3, 1).unwrap_err().to_string();
            assert!(found.contains(reason), "{line}: {found}");
        }
    }
}
