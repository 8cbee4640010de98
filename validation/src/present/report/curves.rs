//! The curves and points of a figure as a table.

use crate::files::csv::written;
use crate::files::text::cell;
use crate::present::plot::{Figure, Grid};
use crate::present::table::{columns_csv, words};

/// A figure as CSV: a row for each point of each curve, with the half widths of its 95 % intervals if it has them.
/// Every number is the shortest text that reads back as the same bits.
pub fn csv(picture: &Figure) -> Result<String, String> {
    if let Some(grid) = &picture.grid {
        return cells(picture, grid);
    }
    let curves = picture.curves.iter().map(|c| (&c.label, &c.x, &c.y, None, c.half_band.as_ref()));
    let points = (picture.points.iter()).map(|p| (&p.label, &p.x, &p.y, p.x_error.as_ref(), p.y_error.as_ref()));
    written(|table| {
        table.write_record(["series", &cell(&picture.x_name), &cell(&picture.y_name), "± x", "± y"])?;
        for (label, x, y, x_half, y_half) in curves.chain(points) {
            let label = cell(label);
            for (k, (x, y)) in x.iter().zip(y).enumerate() {
                let half = |widths: Option<&Vec<f64>>| widths.and_then(|w| w.get(k)).copied();
                table.serialize((&label, x, y, half(x_half), half(y_half)))?;
            }
        }
        Ok(())
    })
}

/// Maps as CSV: a row for each cell, with the class as a number and in words.
fn cells(picture: &Figure, grid: &Grid) -> Result<String, String> {
    type Cell<'a> = (&'a str, usize, &'a str, usize);
    let maps = grid.maps.iter();
    let cells = maps.flat_map(|map| {
        let rows = map.cells.iter().zip(&grid.rows);
        rows.flat_map(move |(cells, row)| {
            let cells = cells.iter().enumerate();
            cells.map(move |(column, class)| (map.title.as_str(), column, row.as_str(), *class))
        })
    });
    let columns = vec![
        words("series", |cell: &Cell| cell.0),
        words(picture.x_name.as_str(), |cell: &Cell| grid.values[cell.1].as_str()),
        words(if picture.y_name.is_empty() { "row" } else { &picture.y_name }, |cell: &Cell| cell.2),
        words("found", |cell: &Cell| grid.classes[cell.3].as_str()),
    ];
    columns_csv(cells, columns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::present::plot::{Curve, Points};

    #[test]
    fn every_point_has_a_row() {
        let figure = Figure {
            x_name: "t/T".into(),
            y_name: "X̄₁, in rod lengths".into(),
            curves: vec![Curve {
                label: "synthetic".into(),
                x: vec![0.0, 0.1],
                y: vec![0.5, f64::NAN],
                half_band: Some(vec![0.01, 0.02]),
            }],
            points: vec![Points { label: "a, b".into(), x: vec![1.0], y: vec![2.0], ..Default::default() }],
            ..Default::default()
        };
        let expected = "series,t/T,\"X̄₁, in rod lengths\",± x,± y\n\
                        synthetic,0.0,0.5,,0.01\nsynthetic,0.1,NaN,,0.02\n\"a, b\",1.0,2.0,,\n";
        assert_eq!(csv(&figure).unwrap(), expected);
    }
}
