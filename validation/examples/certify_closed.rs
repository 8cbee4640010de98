//! Writes the certified answers of the problems `closed-*`, `src/serve/problems/data/closed.csv`, to standard output: a table is
//! the same on every machine.
//!
//!     cargo run -p shearbed --example certify_closed > closed.csv

use validation::serve::problems::closed::certify;

fn main() {
    match certify() {
        Ok(table) => print!("{table}"),
        Err(why) => {
            eprintln!("{why}");
            std::process::exit(1);
        }
    }
}
