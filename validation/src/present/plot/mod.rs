//! Pictures of curves, points and maps as SVG, PNG or PDF, from plain data.
//!
//! Curves differ by colour (Okabe & Ito's palette, safe for the colour-blind), by dashes and, if they have few points,
//! by markers; points differ by colour and marker. The legend is above the axes, where it covers no data.

mod axes;
mod axis;
#[cfg(test)]
mod boxes;
mod grid;
mod legend;
mod letters;
pub mod names;
mod narrow;
mod pdf;
mod png;
mod sheet;
mod style;
#[cfg(test)]
mod tests;
mod texts;
mod theme;
mod window;

use crate::files::text::{escaped, readable};
pub(crate) use crate::present::markup::power_of_ten;
use crate::present::markup::{lowered, powers};
pub(crate) use grid::decade;
use legend::Legend;
use letters::{LOW, LOW_DROP, LOW_SIZE};
pub(crate) use narrow::narrow;
pub use pdf::pdf;
use plotters::prelude::*;
pub use png::png;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use style::{AXES_HEIGHT, BELOW, FINE, MARGIN, ROW, TITLE, WIDTH};
pub use style::{BARS, FITTED, MEASURED, REFERENCE, WITHOUT_BARS};
pub use theme::Theme;

/// A curve, optionally with its 95 % band.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Abscissas.
    #[serde(deserialize_with = "numbers")]
    pub x: Vec<f64>,
    /// Ordinates; the curve is interrupted at values that are not finite.
    #[serde(deserialize_with = "numbers")]
    pub y: Vec<f64>,
    /// Half the width of the 95 % band around the curve, drawn as a translucent area.
    #[serde(deserialize_with = "some_numbers")]
    pub half_band: Option<Vec<f64>>,
}

impl Curve {
    /// A curve through a point (x, y) of each record.
    pub fn of<R>(
        label: impl Into<String>,
        records: impl IntoIterator<Item = R>,
        point: impl Fn(R) -> (f64, f64),
    ) -> Self {
        let (x, y) = records.into_iter().map(point).unzip();
        Self { label: label.into(), x, y, half_band: None }
    }

    /// A curve through a point (x, y) of each record, with half the width of its 95 % band.
    pub fn with_band<R>(
        label: impl Into<String>,
        records: impl IntoIterator<Item = R>,
        point: impl Fn(R) -> (f64, f64, f64),
    ) -> Self {
        let Points { label, x, y, y_error, .. } = Points::with_bars(label, records, point);
        Self { label, x, y, half_band: y_error }
    }

    /// True if the curve's points are marked: there are few, and each is a result by itself. A line through two points
    /// guides the eye, and theory has no points.
    fn is_marked(&self) -> bool {
        let is_exact = self.label.ends_with(", theory") || self.label.ends_with(REFERENCE);
        (3..=40).contains(&self.x.len()) && !is_exact
    }
}

/// Single points, optionally with error bars.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Points {
    /// Their name in the legend.
    pub label: String,
    /// Abscissas.
    #[serde(deserialize_with = "numbers")]
    pub x: Vec<f64>,
    /// Ordinates; points with values that are not finite are left out.
    #[serde(deserialize_with = "numbers")]
    pub y: Vec<f64>,
    /// Half the length of the horizontal error bars.
    #[serde(deserialize_with = "some_numbers")]
    pub x_error: Option<Vec<f64>>,
    /// Half the length of the vertical error bars.
    #[serde(deserialize_with = "some_numbers")]
    pub y_error: Option<Vec<f64>>,
}

impl Points {
    /// A point (x, y) for each record.
    pub fn of<R>(
        label: impl Into<String>,
        records: impl IntoIterator<Item = R>,
        point: impl Fn(R) -> (f64, f64),
    ) -> Self {
        let Curve { label, x, y, .. } = Curve::of(label, records, point);
        Self { label, x, y, ..Default::default() }
    }

    /// A point (x, y) for each record, with half the length of its vertical error bar.
    pub fn with_bars<R>(
        label: impl Into<String>,
        records: impl IntoIterator<Item = R>,
        point: impl Fn(R) -> (f64, f64, f64),
    ) -> Self {
        let (places, halves): (Vec<_>, Vec<_>) =
            (records.into_iter().map(point)).map(|(x, y, half)| ((x, y), half)).unzip();
        Self { y_error: Some(halves), ..Self::of(label, places, |place| place) }
    }
}

/// A map: the class in each row and column.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Title of the map.
    pub title: String,
    /// Index of the class in each cell, row by row.
    pub cells: Vec<Vec<usize>>,
    /// A line of theory, in units of columns and rows: 0 is the centre of the first.
    pub limit: Vec<(f64, f64)>,
}

/// Maps with the same rows and columns, side by side.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Names of the classes.
    pub classes: Vec<String>,
    /// The columns' names; empty if there is no space for one.
    pub columns: Vec<String>,
    /// The values of the columns, for the data files.
    pub values: Vec<String>,
    /// The rows' names.
    pub rows: Vec<String>,
    /// The maps.
    pub maps: Vec<Map>,
    /// Name of the line of theory.
    pub limit_name: String,
    /// True if the classes are steps of one quantity: shades from light to dark, without glyphs.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shades: bool,
}

/// A second panel of a picture, such as that of residuals. Its curves and points look as those at the same place of the
/// first, whose legend names them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Name of its vertical axis; a short word fits.
    pub y_name: String,
    /// Curves, drawn beneath the points.
    pub curves: Vec<Curve>,
    /// Points.
    pub points: Vec<Points>,
}

/// A picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Title of the figure.
    pub title: String,
    /// Name of the horizontal axis, with its unit.
    pub x_name: String,
    /// Name of the vertical axis, with its unit; about 40 letters fit.
    pub y_name: String,
    /// Curves, drawn beneath the points.
    pub curves: Vec<Curve>,
    /// Points.
    pub points: Vec<Points>,
    /// True for a logarithmic horizontal axis; values that are not positive are left out.
    pub x_log: bool,
    /// True for a logarithmic vertical axis.
    pub y_log: bool,
    /// Range that the horizontal axis covers at least; data beyond it widen it.
    pub x_span: Option<(f64, f64)>,
    /// Range that the vertical axis covers at least.
    pub y_span: Option<(f64, f64)>,
    /// Exact range of the horizontal axis: data beyond it are cut off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_range: Option<(f64, f64)>,
    /// Exact range of the vertical axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_range: Option<(f64, f64)>,
    /// Maps, in place of curves and points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<Grid>,
    /// A quantity that grows from curve to curve, whose values are their labels: they are coloured from dark to light,
    /// and a bar with the values stands in place of the legend.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shaded_by: Option<String>,
    /// Where it has several channels of several runs, the channels, with which labels begin: a colour is a channel, and
    /// dashes and a marker are a run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub channels: Vec<String>,
    /// Names in the legend in place of the labels of curves and then of all points, which give them their looks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub legend: Vec<String>,
    /// A panel below, with the same horizontal axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub below: Option<Panel>,
    /// Width and height of the whole picture in pixels of 1/96 inch; `None` for the size that it needs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<(u32, u32)>,
    /// Width in print, in mm, in place of `size`: the axes' letters have 8 points there, at any width.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_mm: Option<f64>,
    /// The background for which it is drawn.
    #[serde(default, skip_serializing_if = "is_light")]
    pub theme: Theme,
}

/// Numbers of a record: JSON has null for values that are not finite.
fn numbers<'de, D: Deserializer<'de>>(record: D) -> Result<Vec<f64>, D::Error> {
    some_numbers(record).map(Option::unwrap_or_default)
}

fn some_numbers<'de, D: Deserializer<'de>>(record: D) -> Result<Option<Vec<f64>>, D::Error> {
    let read: Option<Vec<Option<f64>>> = Deserialize::deserialize(record)?;
    Ok(read.map(|all| all.into_iter().map(|number| number.unwrap_or(f64::NAN)).collect()))
}

fn is_light(theme: &Theme) -> bool {
    *theme == Theme::Light
}

impl Figure {
    /// The labels of curves and then of all points.
    pub fn labels(&self) -> impl Iterator<Item = &String> {
        self.curves.iter().map(|curve| &curve.label).chain(self.points.iter().map(|points| &points.label))
    }

    /// Their names in the legend.
    fn names(&self) -> Vec<&String> {
        if self.legend.is_empty() { self.labels().collect() } else { self.legend.iter().collect() }
    }
}

/// A picture as a file that needs no fonts.
pub struct Drawing {
    /// Contents of the file.
    pub bytes: Vec<u8>,
    /// Characters that the fonts lack; each is drawn as an empty box.
    pub missing: BTreeSet<char>,
}

type Drawn = Result<(), Box<dyn Error>>;

/// A canvas of plotters whose errors can be boxed.
trait Backend: DrawingBackend<ErrorType: 'static> {}

impl<DB: DrawingBackend<ErrorType: 'static>> Backend for DB {}

/// The figure as an SVG document, which may also be embedded in HTML. Texts are typeset: x_1 becomes x₁.
pub fn svg(figure: &Figure) -> Result<String, String> {
    let figure = &typeset(figure);
    let parts = Parts::of(figure);
    let mut drawing = String::new();
    let size = (parts.width as u32, parts.height as u32);
    let drawn = parts.draw(figure, SVGBackend::with_string(&mut drawing, size));
    drawn.map_err(|error| format!("cannot draw the figure '{}': {error}", figure.title))?;
    Ok(figure.theme.svg(finish(figure, &drawing, (parts.width, parts.height))))
}

/// Smallest height of the axes, whatever size is requested.
const LEAST_AXES: i32 = 180 * FINE;

/// Pixels in an inch of a picture whose width in print is given: the axes' letters, 16 high, have 8 points.
const IN_PRINT: f64 = 144.0;

/// Inches of a picture that is `width` wide in the units of the view box, by unit.
fn inches(figure: &Figure, width: f64) -> f64 {
    figure.width_mm.map_or(1.0 / (96.0 * f64::from(FINE)), |mm| mm / 25.4 / width)
}

/// The parts above the axes, and the size of the picture.
struct Parts {
    title: Vec<String>,
    legend: Legend,
    grid: Option<grid::Layout>,
    width: i32,
    height: i32,
}

impl Parts {
    fn of(figure: &Figure) -> Self {
        let in_print = figure.width_mm.map(|mm| (mm / 25.4 * IN_PRINT * f64::from(FINE)).round() as i32);
        let width = in_print.or(figure.size.map(|(width, _)| width as i32 * FINE)).unwrap_or(WIDTH);
        // The height of maps follows from their cells.
        let asked = figure.size.filter(|_| figure.grid.is_none() && in_print.is_none());
        let title = texts::wrap(&figure.title, width - 2 * MARGIN, TITLE);
        let legend = Legend::of(figure, width);
        let grid = figure.grid.as_ref().map(|grid| grid::Layout::of(grid, width));
        let head = MARGIN + title.len() as i32 * ROW + if grid.is_some() { 0 } else { legend.height() };
        let below = if figure.below.is_some() { BELOW } else { 0 };
        let own = asked.map_or(AXES_HEIGHT, |(_, height)| height as i32 * FINE - head - below);
        let axes = own.max(LEAST_AXES).max(legend.height_beside() + style::AXES_FRAME) + below;
        let body = grid.as_ref().map_or(axes, |layout| layout.height);
        Self { title, legend, grid, width, height: head + body }
    }

    fn draw<DB: Backend>(&self, figure: &Figure, backend: DB) -> Drawn {
        let canvas = backend.into_drawing_area();
        canvas.fill(&WHITE)?;
        for (row, line) in self.title.iter().enumerate() {
            let place = (MARGIN, MARGIN + row as i32 * ROW);
            canvas.draw(&Text::new(line.as_str(), place, texts::bold(TITLE)))?;
        }
        let head = MARGIN + self.title.len() as i32 * ROW;
        if let (Some(grid), Some(layout)) = (&figure.grid, &self.grid) {
            grid::draw(&canvas, figure, grid, layout, head)?;
        } else {
            self.legend.draw(&canvas, head)?;
            let area = canvas.split_vertically(head + self.legend.height()).1;
            axes::draw(figure, &self.legend, &area)?;
        }
        Ok(canvas.present()?)
    }
}

/// Like [`svg`], with the first curve in bold black and the others in grey.
pub fn svg_of_one(figure: &Figure) -> Result<String, String> {
    let drawn = svg(figure)?;
    let looks = style::looks(figure);
    let (own, grey) = (style::curve_stroke(looks[0]), "stroke=\"#9A9A9A\" stroke-width=\"4\"");
    let bold = format!("stroke=\"#000000\" stroke-width=\"{}\"", 3 * style::CURVE_WIDTH);
    let others = looks[1..figure.curves.len()].iter().map(|look| style::curve_stroke(*look));
    Ok(others.fold(drawn.replace(&own, &bold), |drawn, stroke| drawn.replace(&stroke, grey)))
}

fn typeset(figure: &Figure) -> Figure {
    let mut figure = figure.clone();
    let curves = figure.curves.iter_mut().map(|curve| &mut curve.label);
    let points = figure.points.iter_mut().map(|points| &mut points.label);
    let below = figure.below.iter_mut().map(|panel| &mut panel.y_name).chain(&mut figure.shaded_by);
    let texts = [&mut figure.title, &mut figure.x_name, &mut figure.y_name].into_iter().chain(below);
    let maps = figure.grid.iter_mut().flat_map(|grid| {
        let titles = grid.maps.iter_mut().map(|map| &mut map.title);
        let names = grid.rows.iter_mut().chain(&mut grid.columns).chain(&mut grid.classes);
        titles.chain(names)
    });
    for text in texts.chain(curves).chain(points).chain(maps).chain(&mut figure.channels).chain(&mut figure.legend) {
        // XML does not allow some characters, not even escaped.
        let text_alone = powers(text).replace(LOW, "");
        let below = |part: &str| part.chars().flat_map(|letter| [LOW, letter]).collect();
        *text = readable(&lowered(&text_alone, below)).into_owned();
    }
    figure
}

/// Puts subscripts below the line. A shift moves all that follows, and counts in the size of the letters that it stands
/// at.
fn below_the_line(drawing: &str) -> String {
    let mut parts = drawing.split(LOW);
    let mut all = parts.next().unwrap_or_default().to_owned();
    let mut is_low = false;
    for part in parts {
        let (letter, rest) = part.split_at(part.chars().next().map_or(0, char::len_utf8));
        let down = if is_low { String::new() } else { format!(" dy=\"{:.3}em\"", LOW_DROP / LOW_SIZE) };
        all += &format!("<tspan{down} font-size=\"{}%\">{letter}</tspan>", 100.0 * LOW_SIZE);
        is_low = rest.is_empty();
        let (same, after) = rest.split_at(rest.find(['\n', '<']).unwrap_or(rest.len()));
        if !same.is_empty() {
            all += &format!("<tspan dy=\"-{LOW_DROP}em\">{same}</tspan>");
        }
        all += after;
    }
    all
}

/// Sets the document's size, adds names for screen readers, and adds dashes, which plotters lacks.
fn finish(figure: &Figure, drawing: &str, (width, height): (i32, i32)) -> String {
    let labels: Vec<_> = (figure.names().into_iter().map(String::as_str))
        .chain(figure.grid.iter().flat_map(|grid| &grid.maps).map(|map| map.title.as_str()))
        .collect();
    let spoken = |text: &str| escaped(&text.replace(LOW, ""));
    let (across, down) = match figure.width_mm {
        Some(mm) => (format!("{mm}mm"), format!("{:.2}mm", mm * f64::from(height) / f64::from(width))),
        None => ((width / FINE).to_string(), (height / FINE).to_string()),
    };
    let open = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{across}\" height=\"{down}\" viewBox=\"0 0 \
         {width} {height}\">\n<title>{}</title>\n<desc>{}</desc>",
        spoken(&figure.title),
        spoken(&format!("{} against {}: {}", figure.y_name, figure.x_name, labels.join(", "))),
    );
    let body = drawing.split_once('>').map_or("", |(_, body)| body);
    let looks = style::looks(figure);
    // Of many shades some may be equal.
    let strokes: BTreeMap<_, _> =
        looks[..figure.curves.len()].iter().map(|look| (style::curve_stroke(*look), style::dashes(*look))).collect();
    let dashed = strokes.into_iter().fold(body.to_string(), |body, (stroke, dashes)| {
        body.replace(&stroke, &format!("{stroke} stroke-linejoin=\"round\"{dashes}"))
    });
    open + &below_the_line(&dashed)
}
