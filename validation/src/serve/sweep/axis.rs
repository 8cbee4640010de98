//! `KEY=FROM:TO:COUNT` and `KEY=A,B,C`: a key of a scene and its values.

use crate::oracle::reference::big::finite;
use serde::{Deserialize, Serialize};
use shearbed::scene::{document, keys};
use toml::Value;

/// The largest number of points of a sweep.
pub const MAX_POINTS: usize = 100_000;

/// A key of the scene with its values, at least one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// The key, such as `interaction.alpha`.
    pub key: String,
    /// The values, in the order given.
    pub values: Vec<Value>,
}

impl Axis {
    /// Parses the argument of `--over`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let shape = "KEY=FROM:TO:COUNT or KEY=A,B,C is allowed, as interaction.alpha=0.1:1:10";
        let (key, values) = key_and_text(text, shape)?;
        let range = split(values, ':');
        let values = match range.as_slice() {
            [_] => each_once(split(values, ',').into_iter().map(value).collect::<Result<_, _>>()?)?,
            [from, to, count] => match evenly(from, to, count)? {
                values if values.windows(2).any(|pair| same(&pair[0], &pair[1])) => {
                    return Err(format!("{from}:{to} has no {count} different values"));
                }
                values => values,
            },
            _ => return Err(format!("{values:?} is neither FROM:TO:COUNT nor a list; {shape}")),
        };
        let key = key.to_owned();
        Ok(Self { key, values })
    }
}

/// A key of the scene with a new value.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyValue {
    /// The key, such as `interaction.alpha`.
    pub key: String,
    /// The value that replaces the scene's own.
    pub value: Value,
}

impl KeyValue {
    /// Parses the argument of `--set`: a key, and one value in the form of a list element after `--over`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (key, text) = key_and_text(text, "KEY=VALUE is allowed, as interaction.alpha=0.5")?;
        Ok(Self { key: key.to_owned(), value: value(text)? })
    }

    /// The key with its value.
    pub(super) fn pair(&self) -> (&str, Value) {
        (&self.key, self.value.clone())
    }
}

/// The largest number of parts of a key, as in `particles.orientation.phi_deg`; without a limit a key could nest tables
/// without end.
const DEEPEST: usize = 3;

/// The key that is meant by a name: that key, or the only one that ends so.
fn meant(name: &str) -> &str {
    let ends = |path: &&str| path.rsplit_once('.').is_some_and(|(_, last)| last == name);
    let mut known = keys().map(|key| key.path).filter(ends);
    match (known.next(), known.next()) {
        (Some(only), None) => only,
        _ => name,
    }
}

/// The texts before and after the first `=`; the first must be a key, or its last part where only one key ends so.
pub(crate) fn key_and_text<'a>(text: &'a str, shape: &str) -> Result<(&'a str, &'a str), String> {
    let (key, text) = text.split_once('=').ok_or(shape)?;
    let (key, text) = (key.trim(), text.trim());
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let is_key = |part: &str| !part.is_empty() && part.chars().all(bare);
    match (key.split('.').all(is_key), key.split('.').count()) {
        (true, parts) if parts > DEEPEST => {
            Err(format!("{key:?} is no key of a scene: it has {parts} parts, and at most {DEEPEST} are allowed"))
        }
        (true, _) => Ok((meant(key), text)),
        _ => Err(format!("{key:?} is no key of a scene; {shape}")),
    }
}

/// The text of a value in tables: the shortest form of a number, a text without quotes.
pub fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(number) => number.to_string(),
        other => other.to_string(),
    }
}

/// The parts of `text` between separators that are outside quotes and brackets.
fn split(text: &str, separator: char) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quote) = (Vec::new(), 0, 0_i32, None);
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), _) => quote = Some(open).filter(|open| *open != c),
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, _) if c == separator && depth == 0 => {
                parts.push(text[start..at].trim());
                start = at + c.len_utf8();
            }
            _ => (),
        }
    }
    parts.push(text[start..].trim());
    parts
}

/// Parses a value as in a scene file; words, as of a title, need no quotes.
fn value(text: &str) -> Result<Value, String> {
    let is_text = |c: char| !c.is_control() && !"\"'[]{}#".contains(c);
    let are_words = text.starts_with(char::is_alphabetic) && text.chars().all(is_text);
    let value = document::value(text).or_else(|| are_words.then(|| Value::String(text.to_owned())));
    // TOML has no `.3` and no `1.`.
    let value = value.or_else(|| text.parse().ok().filter(|x: &f64| x.is_finite()).map(Value::Float));
    value.ok_or_else(|| format!("{text:?} is no value; expected a number, words, or what a scene file has behind `=`"))
}

/// The values; an error names one that stands there twice.
fn each_once(values: Vec<Value>) -> Result<Vec<Value>, String> {
    match (1..values.len()).find(|k| values[..*k].iter().any(|earlier| same(earlier, &values[*k]))) {
        Some(k) => Err(format!("{} stands there twice; each value once is allowed", values[k])),
        None => Ok(values),
    }
}

/// True if a scene is the same with either value: 1 is 1.0, and 0 is −0.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Integer(a), Value::Float(b)) | (Value::Float(b), Value::Integer(a)) => *a as f64 == *b,
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Value::Table(a), Value::Table(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| same(a, b)))
        }
        (a, b) => a == b,
    }
}

/// `count` values from `from` to `to`, both included. If both are integers, so are whole values between them.
fn evenly(from: &str, to: &str, count: &str) -> Result<Vec<Value>, String> {
    let refused = |text: &str| format!("{text:?} is no end of a range; a finite number is allowed");
    let number = |text: &str| finite(text).ok_or_else(|| refused(text));
    let (a, b) = (number(from)?, number(to)?);
    let steps = match count.parse::<usize>() {
        Ok(count) if (2..=MAX_POINTS).contains(&count) => count as i128 - 1,
        _ => {
            return Err(format!("{count:?} is no count of values; a whole number from 2 to {MAX_POINTS} is allowed"));
        }
    };
    let places = decimals(from).max(decimals(to));
    let scaled = |text| mantissa(text, places?);
    let exact = scaled(from).zip(scaled(to)).zip(places.map(|p| 10_i128.pow(p)));
    let whole = places == Some(0);
    Ok((0..=steps)
        .map(|k| {
            let inexact = a + (b - a) * (k as f64 / steps as f64);
            let Some(((a, b), unit)) = exact else {
                return Value::Float(if k == steps { b } else { inexact });
            };
            let (above, below) = (a * (steps - k) + b * k, unit * steps);
            match i64::try_from(above / below) {
                Ok(number) if whole && above % below == 0 => Value::Integer(number),
                // Both are exact, so the quotient is the double nearest to the decimal number: 0.3, not
                // 0.30000000000000004.
                _ if above.abs().max(below) < 1 << 53 => Value::Float(above as f64 / below as f64),
                _ => Value::Float(inexact),
            }
        })
        .collect())
}

/// The number of digits after the point; `None` for a number with an exponent or with too many digits.
fn decimals(text: &str) -> Option<u32> {
    let digits = text.split_once('.').map_or("", |(_, digits)| digits);
    let plain = text.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'));
    (plain && digits.len() <= 12).then_some(digits.len() as u32)
}

/// The number times 10^`places`.
fn mantissa(text: &str, places: u32) -> Option<i128> {
    let missing = places - decimals(text)?;
    let digits: i64 = text.replace('.', "").parse().ok()?;
    Some(i128::from(digits) * 10_i128.pow(missing))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown_values(text: &str) -> Vec<String> {
        Axis::parse(text).unwrap().values.iter().map(shown).collect()
    }

    #[test]
    fn a_key_may_be_named_by_its_last_part() {
        let key = |text: &str| KeyValue::parse(text).unwrap().key;
        assert_eq!(key("alpha=0.3"), "interaction.alpha");
        assert_eq!(key("title=a"), "title");
        assert_eq!(key("phi_deg=0"), "phi_deg");
        assert_eq!(Axis::parse("count=1,2").unwrap().key, "particles.count");
        // Two keys that end alike, as flow.steps and time.steps would: neither is meant.
        let ends = |path: &str| path.rsplit('.').next() == Some("x1");
        assert!(!keys().any(|key| ends(key.path)) && key("x1=1") == "x1");
    }

    #[test]
    fn a_range_has_both_ends_and_the_decimals_one_expects() {
        let tenths: Vec<_> = (1..=10).map(|k| (f64::from(k) / 10.0).to_string()).collect();
        assert_eq!(shown_values("interaction.alpha=0.1:1.0:10"), tenths);
        assert_eq!(shown_values("a=-1:1:5"), ["-1", "-0.5", "0", "0.5", "1"]);
        assert_eq!(shown_values("a=1e-3:2e-3:2"), ["0.001", "0.002"]);
        assert_eq!(shown_values("a=1:0:3"), ["1", "0.5", "0"]);
        // Adding steps in floating point misses some of these values.
        let added: Vec<_> = (0..10).map(|k| (0.1 + 0.1 * f64::from(k)).to_string()).collect();
        assert_ne!(added, tenths);
    }

    /// Found by fuzzing: thirty thousand parts overflowed the stack.
    #[test]
    fn a_key_has_three_parts_at_most() {
        let deep = |parts| format!("{}=1", vec!["a"; parts].join("."));
        assert!(Axis::parse(&deep(3)).is_ok() && KeyValue::parse(&deep(3)).is_ok());
        for parts in [4, 30_000] {
            for error in [Axis::parse(&deep(parts)).unwrap_err(), KeyValue::parse(&deep(parts)).unwrap_err()] {
                assert!(error.contains(&format!("it has {parts} parts, and at most 3 are allowed")));
            }
        }
    }

    #[test]
    fn ends_of_a_range_without_a_short_decimal_are_the_numbers_given() {
        for (from, to) in [("1e-300", "1e300"), ("0.1234567890123456", "7.7"), ("12345678901234567", "1e17")] {
            let values = shown_values(&format!("a={from}:{to}:4"));
            let read = |text: &str| text.parse::<f64>().unwrap();
            assert_eq!((read(&values[0]), read(&values[3])), (read(from), read(to)));
        }
    }

    #[test]
    fn whole_numbers_stay_whole() {
        let values = Axis::parse("particles.count=10:25:4").unwrap().values;
        assert_eq!(values, [10, 15, 20, 25].map(Value::Integer));
        let values = Axis::parse("particles.count=10:20:4").unwrap().values;
        assert_eq!((&values[0], &values[1]), (&Value::Integer(10), &Value::Float(40.0 / 3.0)));
    }

    #[test]
    fn lists_hold_numbers_words_and_tables() {
        assert_eq!(shown_values("interaction.update=rotation, angles"), ["rotation", "angles"]);
        assert_eq!(shown_values("a=1,2.50,\"x,y:z\""), ["1", "2.5", "x,y:z"]);
        assert_eq!(shown_values("a=.3,1.,+.5,infinity"), ["0.3", "1", "0.5", "infinity"]);
        let values = Axis::parse("particles.orientation=isotropic,{ phi_deg = 0, theta_deg = 90 }").unwrap();
        assert_eq!(values.values.len(), 2);
        assert!(values.values[1].is_table());
    }
}
