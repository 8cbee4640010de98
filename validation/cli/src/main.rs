//! The program `shearbed`.

use std::process::ExitCode;
use std::thread::Builder;

/// Bytes of stack for the program's work, whatever the shell's limit on that of the first thread.
const STACK: usize = 8 << 20;

fn main() -> ExitCode {
    let work = Builder::new().name("main".to_owned()).stack_size(STACK);
    match work.spawn(shearbed_cli::main).map(|work| work.join()) {
        Ok(Ok(code)) => code,
        Ok(Err(_)) => ExitCode::from(shearbed_cli::code_of_panic()),
        Err(error) => {
            eprintln!("error: no thread to work on: {error}");
            ExitCode::from(2)
        }
    }
}
