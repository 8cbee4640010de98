//! The page of commands in the book, made from the parser.

use clap::{Arg, Command, CommandFactory};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Every command with its options, as Markdown.
pub fn commands() -> String {
    let mut program = super::Cli::command().disable_help_subcommand(true);
    program.build();
    let mut page =
        "# Commands\n\nMade from the program's own parser: `shearbed COMMAND --help` prints the same.\n".to_owned();
    let mut said = BTreeSet::new();
    for command in program.get_subcommands().filter(|command| !command.is_hide_set()) {
        add(&mut page, command, "shearbed", &mut said);
    }
    page
}

/// Adds a command and its subcommands to the page; what was `said` of an argument is not said again.
fn add(page: &mut String, command: &Command, above: &str, said: &mut BTreeSet<String>) {
    let name = format!("{above} {}", command.get_name());
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let _ = write!(page, "\n## {}\n\n{}.\n", name.trim_start_matches("shearbed "), plain(&about));
    let shown = |arg: &&Arg| !arg.is_hide_set() && arg.get_id() != "help" && arg.get_id() != "version";
    let mut rows = command.get_arguments().filter(shown).peekable();
    if rows.peek().is_some() {
        page.push('\n');
    }
    let mut again = Vec::new();
    for arg in rows {
        let line = format!("- `{}`: {}\n", written(arg), plain(&meaning(arg)));
        if said.insert(line.clone()) {
            page.push_str(&line);
        } else {
            again.push(format!("`{}`", written(arg)));
        }
    }
    if !again.is_empty() {
        let _ = writeln!(page, "- {}: as above", again.join(", "));
    }
    if let Some(words) = command.get_after_help() {
        let words = words.to_string();
        let _ = write!(page, "\n```text\n{}\n```\n", words.trim().trim_start_matches("Example:").trim());
    }
    for below in command.get_subcommands().filter(|below| !below.is_hide_set()) {
        add(page, below, &name, said);
    }
}

/// An argument in the form of the command line.
fn written(arg: &Arg) -> String {
    let values = arg.get_value_names().unwrap_or_default();
    let values: Vec<_> = values.iter().map(ToString::to_string).collect();
    let flag = arg.get_long().map(|long| format!("--{long}"));
    let takes_value = arg.get_action().takes_values() && !values.is_empty();
    flag.into_iter().chain(takes_value.then(|| values.join(" "))).collect::<Vec<_>>().join(" ")
}

/// The help of an argument, with its possible values and its default.
fn meaning(arg: &Arg) -> String {
    let mut text = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let takes_values = arg.get_action().takes_values();
    let values = arg.get_possible_values();
    let values: Vec<_> =
        values.iter().filter(|_| takes_values).map(|value| format!("`{}`", value.get_name())).collect();
    if !values.is_empty() {
        let _ = write!(text, " ({})", values.join(", "));
    }
    let defaults: Vec<_> = arg.get_default_values().iter().map(|value| value.to_string_lossy()).collect();
    if takes_values && !defaults.is_empty() {
        let _ = write!(text, " (default `{}`)", defaults.join(" "));
    }
    text
}

/// The text on one line, with `<` escaped for HTML.
fn plain(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('<', "&lt;")
}
