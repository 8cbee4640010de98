//! `shearbed completions` and `shearbed man`: scripts for shells and manual pages, made from the parser of the command
//! line.

use super::{Cli, Failure, Writing, print};
use clap::CommandFactory;
use clap_complete::Shell;
use serde_json::json;
use shearbed_validation::files::output::{Output, ResultFolder};
use shearbed_validation::files::text::Shown;
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed completions bash > shearbed.bash")]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed man man1")]
pub(super) struct Man {
    /// The folder for shearbed.1 and a page for each command
    dir: PathBuf,
    #[command(flatten)]
    writing: Writing,
}

pub(super) fn completions(args: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "shearbed", &mut script);
    print(&String::from_utf8_lossy(&script))
}

pub(super) fn man(args: &Man) -> Result<(), Failure> {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    add_pages(&command, &mut pages).map_err(|error| Failure::Failed(error.to_string()))?;
    let names: Vec<_> = pages.iter().map(|(name, _)| name.clone()).collect();
    let folder = ResultFolder::new(&args.dir, "man", json!({}), args.writing.force).as_argument();
    folder.write(&pages)?;
    args.writing.print(&format!("in {}: {}\n", args.dir.shown(), names.join(", ")))
}

/// Adds the page of a command, then those of its subcommands.
fn add_pages(command: &clap::Command, pages: &mut Vec<Output>) -> std::io::Result<()> {
    let page = clap_mangen::Man::new(command.clone());
    let mut text = Vec::new();
    page.render(&mut text)?;
    pages.push((page.get_filename(), String::from_utf8_lossy(&text).into_owned()));
    command.get_subcommands().filter(|below| !below.is_hide_set()).try_for_each(|below| add_pages(below, pages))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[test]
    fn every_command_has_an_example_that_parses() {
        for command in Cli::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let start = format!("  shearbed {}", command.get_name());
            let lines: Vec<_> = help.lines().filter(|line| line.starts_with(&start)).collect();
            assert!(!lines.is_empty(), "{} has no example", command.get_name());
            for line in lines {
                // Text after > is for the shell.
                let mut words = shlex::split(line.split(" >").next().unwrap()).unwrap();
                let parsed = Cli::try_parse_from(&words);
                assert!(parsed.is_ok(), "{line}: {:?}", parsed.err().map(|error| error.to_string()));
                words.push("--no-such-flag".to_owned());
                assert!(Cli::try_parse_from(words).is_err(), "{line}");
            }
        }
    }
}
