//! Prints the tables of docs/src/theory/time-step.md as Markdown; with `-- full`, from as many replicas as `--full`.

use shearbed_validation::judge::case::{Effort, GATE_SEED};
use shearbed_validation::present::study::Request;
use shearbed_validation::studies::kicks::study::STUDY;

fn main() -> Result<(), String> {
    let full = std::env::args().any(|argument| argument == "full");
    let effort = Effort { full, seed: GATE_SEED, data: None };
    let findings = STUDY.found(&Request { effort: &effort, wanted: &|_| true, finished: &|| () })?;
    let tables = findings.into_iter().flat_map(|findings| findings.exhibits).filter_map(|exhibit| exhibit.table);
    tables.for_each(|table| println!("{}", table.markdown()));
    Ok(())
}
