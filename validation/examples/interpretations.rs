//! Prints what other interpretations of the paper change as a Markdown table; with `-- full`, from as many replicas as
//! `--full`.

use shearbed_validation::judge::case::{Effort, GATE_SEED};
use shearbed_validation::studies::interpretations::{measure, table};

fn main() {
    let full = std::env::args().any(|argument| argument == "full");
    let rows = measure(&Effort { full, seed: GATE_SEED, data: None });
    print!("{}", table(&rows.unwrap_or_default()).markdown());
}
