//! `shearbed problems`.

use super::{Failure, Writing, ending_in, print};
use shearbed_validation::files::output;
use shearbed_validation::files::text::{Shown, left_aligned};
use shearbed_validation::serve::problems;
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed problems export ref")]
pub(super) struct Args {
    #[command(subcommand)]
    what: Option<What>,
}

#[derive(clap::Subcommand)]
enum What {
    /// Write every problem as a folder: problem.json, start.csv, inputs.csv, certified.csv, README.md
    Export {
        /// The folder; it may hold an earlier export
        #[arg(required_unless_present = "archive")]
        dir: Option<PathBuf>,
        /// Write all problems into this tar file, with checksums, licence and citation, as a data repository takes it
        #[arg(long, value_name = "FILE.tar", value_parser = tar)]
        archive: Option<PathBuf>,
        #[command(flatten)]
        writing: Writing,
    },
    /// Print the JSON Schema of problem.json
    Schema,
}

impl Args {
    pub(super) fn only_prints(&self) -> bool {
        !matches!(self.what, Some(What::Export { .. }))
    }
}

fn tar(text: &str) -> Result<PathBuf, String> {
    ending_in(&["tar"], ".tar", text)
}

/// Lists the problems, exports them, or prints their schema.
pub(super) fn problems(args: &Args) -> Result<(), Failure> {
    match &args.what {
        None => print(&list()),
        Some(What::Schema) => print(problems::SCHEMA),
        Some(What::Export { dir, archive, writing }) => {
            let mut said = String::new();
            if let Some(file) = archive {
                // Checked before the folder is written.
                output::may_write(file, &problems::archive(), writing.force)?;
            }
            if let Some(dir) = dir {
                let names = problems::export(dir, writing.force)?;
                said += &format!("in {}: {} problems\n", dir.shown(), names.len());
            }
            if let Some(file) = archive {
                output::write_one(file, &problems::archive(), writing.force)?;
                said += &format!("{}: {} problems\n", file.shown(), problems::all().len());
            }
            writing.print(&said)
        }
    }
}

fn list() -> String {
    let row = |def: &problems::ProblemDef| vec![def.name.to_owned(), def.title.to_owned()];
    left_aligned(&problems::all().iter().map(row).collect::<Vec<_>>())
}
