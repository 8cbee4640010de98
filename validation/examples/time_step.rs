//! Prints the tables of docs/src/theory/time-step.md as Markdown; with `-- full`, from as many replicas as `--full`.

use validation::judge::case::Effort;
use validation::studies::kicks::study::measure;
use validation::studies::kicks::tables::tables;

fn main() -> Result<(), String> {
    let effort = Effort {
        full: std::env::args().any(|argument| argument == "full"),
        seed: validation::judge::case::GATE_SEED,
        data: None,
    };
    for table in tables(&measure(&effort)?) {
        println!("{}\n", table.caption);
        println!("| {} |", table.columns.join(" | "));
        println!("|{}", " --- |".repeat(table.columns.len()));
        for row in table.rows {
            println!("| {} |", row.join(" | "));
        }
        println!();
    }
    Ok(())
}
