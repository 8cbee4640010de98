//! Maps of classes, as small multiples: a cell for each row and column; classes differ by colour and glyph.

use super::power_of_ten;
use super::style::{CLASSES, FINE, MARGIN, ROW, TEXT, class_ink, glyph, shade};
use super::texts::{SMALL_BOLD, in_rows, text, text_width};
use super::{Backend, Drawn, Figure, Grid, Map};
use plotters::coord::Shift;
use plotters::prelude::*;

/// Size of letters inside the panels.
const SMALL: f64 = 13.0;
const CELL_HEIGHT: i32 = 15 * FINE;
const GAP: i32 = 10 * FINE;
const KEY: i32 = 16 * FINE;

pub(super) struct Layout {
    across: usize,
    /// Width of the rows' names, left of each panel.
    names: i32,
    cell_width: i32,
    width: i32,
    /// The rows of the legend: classes with their left edges.
    keys: Vec<Vec<(usize, i32)>>,
    pub(super) height: i32,
}

impl Layout {
    pub(super) fn of(grid: &Grid, width: i32) -> Self {
        let names = grid.rows.iter().map(|name| text_width(name, SMALL)).max();
        let names = names.unwrap_or(0) + GAP;
        let columns = grid.columns.len().max(1) as i32;
        let room = width - 2 * MARGIN;
        // Cells are at least as wide as a glyph and as the columns' names need.
        let widest = |across: usize| (room / across as i32 - names - GAP) / columns;
        let named = grid.columns.iter().filter(|name| !name.is_empty()).count() as i32;
        let name = grid.columns.iter().map(|name| text_width(name, SMALL)).max();
        let least = name.unwrap_or(0) * named / columns;
        let fits = |across: &usize| widest(*across) >= least.max(9 * FINE);
        let across = (1..=3).rev().find(fits).unwrap_or(1).min(grid.maps.len().max(1));
        let cell_width = widest(across).min(36 * FINE);
        let keys = keys(grid, width);
        let lines = grid.maps.len().div_ceil(across) as i32;
        let axes = ROW + keys.len() as i32 * ROW;
        let limit = grid.maps.iter().any(|map| !map.limit.is_empty());
        Self {
            across,
            names,
            cell_width,
            width,
            height: axes + ROW * i32::from(limit) + lines * (Self::panel_height(grid) + GAP) + MARGIN,
            keys,
        }
    }

    /// The height of a panel: title, rows, and the columns' names.
    fn panel_height(grid: &Grid) -> i32 {
        ROW + grid.rows.len() as i32 * CELL_HEIGHT + ROW
    }
}

/// The legend: the classes that occur, in rows no wider than the figure.
fn keys(grid: &Grid, most: i32) -> Vec<Vec<(usize, i32)>> {
    let occurs = |class: &usize| grid.maps.iter().flat_map(|map| map.cells.iter().flatten()).any(|c| c == class);
    let sized = |class: usize| (class, KEY + GAP / 2 + text_width(&grid.classes[class], TEXT) + 2 * GAP);
    in_rows((0..grid.classes.len()).filter(occurs).map(sized), most)
}

/// Draws legend, panels and the axes' names, with the top at `top`.
pub(super) fn draw<DB: Backend>(
    canvas: &DrawingArea<DB, Shift>,
    figure: &Figure,
    grid: &Grid,
    layout: &Layout,
    top: i32,
) -> Drawn {
    let mut y = top;
    for row in &layout.keys {
        for (class, x) in row {
            square(canvas, grid, *class, (*x, y), (KEY, KEY))?;
            let place = (x + KEY + GAP / 2, y + 2 * FINE);
            canvas.draw(&Text::new(grid.classes[*class].as_str(), place, text(TEXT)))?;
        }
        y += ROW;
    }
    if grid.maps.iter().any(|map| !map.limit.is_empty()) {
        let ends = vec![(MARGIN, y + KEY / 2), (MARGIN + KEY, y + KEY / 2)];
        canvas.draw(&PathElement::new(ends, limit_ink()))?;
        let place = (MARGIN + KEY + GAP / 2, y + 2 * FINE);
        canvas.draw(&Text::new(grid.limit_name.as_str(), place, text(TEXT)))?;
        y += ROW;
    }
    let axes = match figure.y_name.as_str() {
        "" => format!("across: {}", figure.x_name),
        name => format!("across: {}; down: {name}", figure.x_name),
    };
    canvas.draw(&Text::new(axes, (MARGIN, y + 3 * FINE), text(0.85 * TEXT)))?;
    y += ROW;
    let across = (layout.width - 2 * MARGIN) / layout.across as i32;
    for (k, map) in grid.maps.iter().enumerate() {
        let left = MARGIN + (k % layout.across) as i32 * across;
        let down = (k / layout.across) as i32 * (Layout::panel_height(grid) + GAP);
        panel(canvas, grid, map, layout, (left, y + down))?;
    }
    Ok(())
}

fn limit_ink() -> ShapeStyle {
    RGBColor(0, 0, 0).stroke_width(3 * FINE as u32 / 2 + 1)
}

fn square<DB: Backend>(
    canvas: &DrawingArea<DB, Shift>,
    grid: &Grid,
    class: usize,
    (x, y): (i32, i32),
    (width, height): (i32, i32),
) -> Drawn {
    let corners = [(x, y), (x + width - FINE / 2, y + height - FINE / 2)];
    let colour = if grid.shades { shade(class, grid.classes.len()) } else { CLASSES[class % CLASSES.len()] };
    canvas.draw(&Rectangle::new(corners, colour.filled()))?;
    if grid.shades {
        return Ok(());
    }
    let centre = (x + width / 2, y + height / 2);
    for stroke in glyph(class) {
        let path: Vec<_> = stroke.iter().map(|(dx, dy)| (centre.0 + dx, centre.1 + dy)).collect();
        canvas.draw(&PathElement::new(path, class_ink(class).stroke_width(FINE as u32)))?;
    }
    Ok(())
}

fn panel<DB: Backend>(
    canvas: &DrawingArea<DB, Shift>,
    grid: &Grid,
    map: &Map,
    layout: &Layout,
    (left, top): (i32, i32),
) -> Drawn {
    canvas.draw(&Text::new(
        map.title.as_str(),
        (left + layout.names, top + 4 * FINE),
        super::texts::bold(SMALL_BOLD),
    ))?;
    let cells = (left + layout.names, top + ROW);
    let at = |column: i32, row: i32| (cells.0 + column * layout.cell_width, cells.1 + row * CELL_HEIGHT);
    for (row, (name, classes)) in grid.rows.iter().zip(&map.cells).enumerate() {
        let (_, y) = at(0, row as i32);
        let x = cells.0 - GAP / 2 - text_width(name, SMALL);
        canvas.draw(&Text::new(name.as_str(), (x.max(left), y + 2 * FINE), text(SMALL)))?;
        for (column, class) in classes.iter().enumerate() {
            let corner = at(column as i32, row as i32);
            square(canvas, grid, *class, corner, (layout.cell_width, CELL_HEIGHT))?;
        }
    }
    let (_, foot) = at(0, grid.rows.len() as i32);
    for (column, name) in grid.columns.iter().enumerate() {
        let (x, _) = at(column as i32, 0);
        let x = x + (layout.cell_width - text_width(name, SMALL)) / 2;
        canvas.draw(&Text::new(name.as_str(), (x, foot + 2 * FINE), text(SMALL)))?;
    }
    // A column's value is at its centre; values beyond the picture are left out.
    let width = grid.columns.len() as f64;
    let inside = map.limit.iter().filter(|(column, _)| (-0.5..=width - 0.5).contains(column));
    let path: Vec<_> = inside
        .map(|(column, row)| {
            let x = f64::from(cells.0) + (column + 0.5) * f64::from(layout.cell_width);
            let y = f64::from(cells.1) + (row + 0.5) * f64::from(CELL_HEIGHT);
            (x.round() as i32, y.round() as i32)
        })
        .collect();
    if path.len() > 1 {
        canvas.draw(&PathElement::new(path, limit_ink()))?;
    }
    Ok(())
}

/// The label of a power of ten on an axis.
pub(crate) fn decade(exponent: i32) -> String {
    match exponent {
        0 => "1".into(),
        1 => "10".into(),
        exponent => power_of_ten(exponent),
    }
}
