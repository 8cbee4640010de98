//! The curves and points of a figure as a table.

use crate::files::csv::written;
use crate::files::text::cell;
use crate::present::plot::{Figure, Grid};

/// A figure as CSV: a row for each point of each curve, with the half widths of its 95 % intervals if it has them.
/// Every number is the shortest text that reads back as the same bits.
pub fn csv(picture: &Figure) -> Result<String, String> {
    if let Some(grid) = &picture.grid {
        return cells(picture, grid);
    }
    let curves = picture.curves.iter().map(|c| (&c.label, &c.x, &c.y, None, c.half_band.as_ref()));
    let points = (picture.points.iter()).map(|p| (&p.label, &p.x, &p.y, p.x_error.as_ref(), p.y_error.as_ref()));
    written(|table| {
        table.write_record([
            "series",
            &cell(&picture.x_name),
            &cell(&picture.y_name),
            "95 % half width of x",
            "95 % half width of y",
        ])?;
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

/// Maps as CSV: a row for each cell, with its class in words.
fn cells(picture: &Figure, grid: &Grid) -> Result<String, String> {
    let y_name = if picture.y_name.is_empty() { "row" } else { &picture.y_name };
    written(|table| {
        table.write_record(["series", &picture.x_name, y_name, "found"].map(cell))?;
        for map in &grid.maps {
            for (classes, row) in map.cells.iter().zip(&grid.rows) {
                for (class, value) in classes.iter().zip(&grid.values) {
                    table.write_record([&map.title, value, row, &grid.classes[*class]].map(|text| cell(text)))?;
                }
            }
        }
        Ok(())
    })
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
            curves: vec![Curve::with_band("synthetic", [(0.0, 0.5, 0.01), (0.1, f64::NAN, 0.02)], |point| point)],
            points: vec![Points::of("a, b", [(1.0, 2.0)], |point| point)],
            ..Default::default()
        };
        let expected = "series,t/T,\"X̄₁, in rod lengths\",95 % half width of x,95 % half width of y\n\
                        synthetic,0.0,0.5,,0.01\nsynthetic,0.1,NaN,,0.02\n\"a, b\",1.0,2.0,,\n";
        assert_eq!(csv(&figure).unwrap(), expected);
    }
}
