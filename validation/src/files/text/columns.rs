//! Numbers and aligned columns for people.

/// A number with four decimals, or as a power of ten where it would have hundreds of digits.
pub fn four_decimals(x: f64) -> String {
    if x.abs() < 1e12 { format!("{x:.4}") } else { format!("{x:.4e}") }
}

/// Rows of cells as lines of columns that are aligned on the left.
pub fn left_aligned(rows: &[Vec<String>]) -> String {
    aligned(rows, |cell, width| format!("{cell:<width$}"))
}

/// Rows of cells as lines of columns that are aligned on the right.
pub fn right_aligned(rows: &[Vec<String>]) -> String {
    aligned(rows, |cell, width| format!("{cell:>width$}"))
}

fn aligned(rows: &[Vec<String>], pad: impl Fn(&str, usize) -> String) -> String {
    let widths = widths(rows);
    let line = |row: &Vec<String>| {
        let cells: Vec<_> = row.iter().zip(&widths).map(|(cell, width)| pad(cell, *width)).collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// The width of each column of rows of cells, in letters.
pub(crate) fn widths(rows: &[Vec<String>]) -> Vec<usize> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    (0..columns).map(width).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_has_hundreds_of_digits() {
        let shown = [0.0, -2.5, 1e11, 1e12, -1e300].map(four_decimals);
        assert_eq!(shown, ["0.0000", "-2.5000", "100000000000.0000", "1.0000e12", "-1.0000e300"]);
    }
}
