//! Writes the certified answers of the problems `folgar-tucker-*`, `src/serve/problems/data/folgar-tucker.csv`, to standard
//! output: a table is the same on every machine.
//!
//!     cargo run -p shearbed --example certify_folgar_tucker > folgar-tucker.csv

use validation::serve::problems::folgar_tucker::certify;

fn main() {
    match certify() {
        Ok(table) => print!("{table}"),
        Err(why) => {
            eprintln!("{why}");
            std::process::exit(1);
        }
    }
}
