//! The commands in groups, as `shearbed --help` lists them.

use super::Command;
use clap::Subcommand;

/// Headings and the commands below them; all others stand under the last heading.
const GROUPS: [(&str, &[&str]); 3] = [
    ("Start here", &["run", "validate", "scenes"]),
    ("Your own suspension", &["plan", "sweep", "fit", "plot", "converge", "shape"]),
    ("Check a program of your own", &["grade", "problems", "reference"]),
];

/// The template of the program's help.
pub(super) fn help() -> String {
    let all = Command::augment_subcommands(clap::Command::new("shearbed"));
    let line = |command: &clap::Command| {
        let about = command.get_about().map(ToString::to_string).unwrap_or_default();
        format!("  {:<12} {about}\n", command.get_name())
    };
    let mut text = String::from("{about}\n\n{usage-heading} {usage}\n");
    for (heading, names) in GROUPS {
        let lines = names.iter().filter_map(|name| all.find_subcommand(name)).map(line);
        text += &format!("\n{heading}:\n{}", lines.collect::<String>());
    }
    let rest = all.get_subcommands().filter(|one| !GROUPS.iter().any(|(_, names)| names.contains(&one.get_name())));
    text + "\nMore:\n" + &rest.map(line).collect::<String>() + "\nOptions:\n{options}{after-help}\n"
}
