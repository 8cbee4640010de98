//! The legend: rows above the axes, where it covers no data.

use super::style::{FINE, MARGIN, ROW, TEXT, WIDTH, curve, marker, text, text_width};
use super::{Drawn, Figure};
use plotters::coord::Shift;
use plotters::prelude::*;

const SAMPLE: i32 = 34 * FINE;
const GAP: i32 = 6 * FINE;

/// What an entry shows beside its label.
enum Mark {
    Curve(usize),
    Points(usize),
    Band,
}

/// One entry and where it stands in its row.
pub(super) struct Entry {
    mark: Mark,
    label: String,
    x: i32,
}

/// The entries in rows that are no wider than the figure.
pub(super) fn rows(figure: &Figure) -> Vec<Vec<Entry>> {
    let curves = figure.curves.iter().enumerate();
    let points = figure.points.iter().enumerate();
    let band = figure.curves.iter().any(|curve| curve.half_band.is_some());
    let marks = (curves.map(|(k, curve)| (Mark::Curve(k), curve.label.clone())))
        .chain(points.map(|(k, points)| (Mark::Points(figure.curves.len() + k), points.label.clone())))
        .filter(|(_, label)| !label.is_empty())
        .chain(band.then(|| (Mark::Band, "95 % band".to_string())));
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut x = MARGIN;
    for (mark, label) in marks {
        let width = SAMPLE + GAP + text_width(&label, TEXT) + 2 * GAP;
        if rows.is_empty() || (x + width > WIDTH - MARGIN && x > MARGIN) {
            rows.push(Vec::new());
            x = MARGIN;
        }
        if let Some(row) = rows.last_mut() {
            row.push(Entry { mark, label, x });
        }
        x += width;
    }
    rows
}

/// Draws the rows, the first with its top at `top`.
pub(super) fn draw(canvas: &DrawingArea<SVGBackend, Shift>, rows: &[Vec<Entry>], top: i32) -> Drawn {
    for (row, entries) in rows.iter().enumerate() {
        let y = top + row as i32 * ROW;
        let middle = y + 9 * FINE;
        for Entry { mark, label, x } in entries {
            let ends = vec![(*x, middle), (x + SAMPLE, middle)];
            match mark {
                Mark::Curve(index) => canvas.draw(&PathElement::new(ends, curve(*index)))?,
                Mark::Points(index) => {
                    canvas.draw(&(EmptyElement::at((x + SAMPLE / 2, middle)) + marker(*index)))?
                }
                Mark::Band => {
                    let corners = [(*x, middle - 6 * FINE), (x + SAMPLE, middle + 6 * FINE)];
                    canvas.draw(&Rectangle::new(corners, BLACK.mix(0.2).filled()))?;
                }
            }
            let place = (x + SAMPLE + GAP, y + 3 * FINE);
            canvas.draw(&Text::new(label.as_str(), place, text(TEXT)))?;
        }
    }
    Ok(())
}
