//! The program `shearbed`.

use std::process::ExitCode;

fn main() -> ExitCode {
    validation::cli::main()
}
