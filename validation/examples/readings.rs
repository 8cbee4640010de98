//! Prints what the open readings change as a Markdown table; with `-- full`, from as many replicas as `--full`.

use validation::judge::case::Effort;
use validation::studies::readings::{measure, table};

fn main() {
    let effort = Effort {
        full: std::env::args().any(|argument| argument == "full"),
        seed: validation::judge::case::GATE_SEED,
        data: None,
    };
    let table = table(&measure(&effort).unwrap_or_default());
    println!("{}\n", table.caption);
    println!("| {} |", table.columns.join(" | "));
    println!("|{}", " --- |".repeat(table.columns.len()));
    for row in table.rows {
        println!("| {} |", row.join(" | "));
    }
}
