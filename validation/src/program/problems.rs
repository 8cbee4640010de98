//! `shearbed problems`.

use super::{Failure, print};
use crate::files::output;
use crate::files::text::Shown;
use crate::serve::problems::{self, ExportError};
use std::path::PathBuf;

/// Arguments of `problems`.
#[derive(clap::Args)]
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
        #[arg(long, value_name = "FILE.tar")]
        archive: Option<PathBuf>,
        /// Write even where the folder holds something else, which stays, or over the file
        #[arg(long)]
        force: bool,
        /// Print nothing but errors
        #[arg(long)]
        quiet: bool,
    },
    /// Print the JSON Schema of problem.json
    Schema,
}

/// Lists the problems, exports them, or prints their schema.
pub(super) fn problems(args: &Args) -> Result<(), Failure> {
    match &args.what {
        None => print(&list()),
        Some(What::Schema) => print(problems::SCHEMA),
        Some(What::Export { dir, archive, force, quiet }) => {
            let mut said = String::new();
            if let Some(dir) = dir {
                let names = problems::export(dir, *force)?;
                said += &format!("in {}: {}\n", dir.shown(), names.join(", "));
            }
            if let Some(file) = archive {
                output::write_one(file, &problems::archive(), *force)?;
                said += &format!("{}: {} problems\n", file.shown(), problems::all().len());
            }
            if *quiet { Ok(()) } else { print(&said) }
        }
    }
}

fn list() -> String {
    let width = (problems::all().iter().map(|def| def.name.len())).max().unwrap_or(0);
    let line = |def: &problems::ProblemDef| format!("{:<width$}  {}\n", def.name, def.title);
    problems::all().iter().map(line).collect()
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        Self::Input(error.to_string())
    }
}
