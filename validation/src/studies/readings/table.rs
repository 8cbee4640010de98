//! The measured readings in words.

use super::{QUANTITIES, ReadingRow, SEED};
use crate::present::table::{ReportTable, estimate, words};

/// The rows in words.
pub fn table(rows: &[ReadingRow]) -> ReportTable {
    let replicas = rows.iter().map(|row| row.replicas).min().unwrap_or(0);
    let mut columns = vec![
        words("left open", |row: &&ReadingRow| row.open),
        words("read as", |row: &&ReadingRow| row.reading),
    ];
    for (k, (name, _)) in QUANTITIES.iter().enumerate() {
        columns.push(estimate(
            *name,
            |x, se| format!("{x:.4} ± {se:.4}"),
            move |row: &&ReadingRow| (row.values[k].value, row.values[k].se),
        ));
        let signed = |x: f64, se: f64| format!("{x:+.4} ± {se:.4}").replace('-', "−");
        columns.push(estimate("change", signed, move |row: &&ReadingRow| {
            row.changes.as_ref().map(|changes| (changes[k].value, changes[k].se))
        }));
    }
    ReportTable::new(
        ["readings", "What the open readings change"],
        format!(
            "The rods of Fig. 7 at 50 per cm³ (N = 100, σ = 0, r_e = 11.6, α = 0.5, 200 steps a period): each \
             reading alone against the project's own, then two of them with half the step. Mean ± standard error of \
             {replicas} replicas, seed {SEED}, by the naive reference. A change is from pairs of replicas with the \
             same random numbers. The damping rate is minus the slope, by least squares over four half periods, of \
             ln A; A is the mean of two neighbouring maxima of X̄₁ (t/T = 0, ½, 1, 1½, 2) less the minimum between."
        ),
        rows,
        columns,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::statistics::Estimate;

    #[test]
    fn a_table_has_a_cell_for_every_column() {
        let estimate = Estimate { value: 0.5, se: 0.01 };
        let row =
            |changes| ReadingRow { open: "a", reading: "b", replicas: 7, values: vec![estimate; 4], changes };
        let table = table(&[row(None), row(Some(vec![estimate; 4]))]);
        assert!(table.rows.iter().all(|cells| cells.len() == table.columns.len()));
        assert_eq!(table.rows[1][2..4], ["0.5000 ± 0.0100", "+0.5000 ± 0.0100"]);
        assert!(table.caption.contains("7 replicas"));
    }
}
