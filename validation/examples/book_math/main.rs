//! The formulas of the book (`docs/src/`) as MathML: a preprocessor of mdBook, so that the pages need no script, font
//! or network.
//!
//! mdBook calls it as `docs/book.toml` says: with the words `supports RENDERER` first, then with `[context, book]` as
//! JSON on standard input. The book comes back on standard output, each `$…$` and `$$…$$` of its pages replaced.
//! A formula that cannot be read ends the build with its page.

mod formulas;

use serde_json::Value;
use std::io::{self, Read};
use std::process::ExitCode;

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        // Any renderer: MathML is HTML in Markdown.
        Some("supports") => ExitCode::SUCCESS,
        _ => match book() {
            Ok(book) => {
                println!("{book}");
                ExitCode::SUCCESS
            }
            Err(message) => {
                eprintln!("error: {message}");
                ExitCode::FAILURE
            }
        },
    }
}

/// The book of standard input with its formulas replaced.
fn book() -> Result<Value, String> {
    let mut input = String::new();
    io::stdin().read_to_string(&mut input).map_err(|error| error.to_string())?;
    let parts: Value = serde_json::from_str(&input).map_err(|error| error.to_string())?;
    match parts {
        Value::Array(parts) if parts.len() == 2 => {
            let mut book = parts.into_iter().nth(1).unwrap_or_default();
            replace(&mut book)?;
            Ok(book)
        }
        _ => Err("standard input must be [context, book], as mdBook writes it".to_owned()),
    }
}

/// Replaces the formulas of every page in `part`: a page is an object with a text `content`.
fn replace(part: &mut Value) -> Result<(), String> {
    match part {
        Value::Object(entries) => {
            let path = entries.get("path").and_then(Value::as_str).unwrap_or("a page without a file").to_owned();
            if let Some(Value::String(content)) = entries.get_mut("content") {
                *content = formulas::replaced(content).map_err(|message| format!("{path}: {message}"))?;
            }
            entries.values_mut().try_for_each(replace)
        }
        Value::Array(parts) => parts.iter_mut().try_for_each(replace),
        _ => Ok(()),
    }
}
