//! The axes and the data in them.

use super::axis::{Axis, place};
use super::legend::Legend;
use super::style::{
    AXES_HEIGHT, BAR_WIDTH, FINE, MARKER, SMALL_MARKER, TEXT, WIDTH, colour, curve, cut, is_coloured, looks,
    marker, text, text_width,
};
use super::{Drawn, Figure};
use plotters::coord::Shift;
use plotters::prelude::*;

type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<Axis, Axis>>;

/// A point in placed values, with the ends of its error bars; NaN for what it does not have.
struct Placed {
    x: f64,
    y: f64,
    left: f64,
    right: f64,
    low: f64,
    high: f64,
}

impl Placed {
    fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

type Errors<'a> = Option<&'a [f64]>;

fn placed(figure: &Figure, x: &[f64], y: &[f64], x_error: Errors, y_error: Errors) -> Vec<Placed> {
    let half = |errors: Errors, k: usize| errors.and_then(|e| e.get(k)).map_or(f64::NAN, |half| half.abs());
    let (px, py) = (|v| place(v, figure.x_log), |v| place(v, figure.y_log));
    (x.iter().zip(y).enumerate())
        .map(|(k, (x, y))| {
            let (dx, dy) = (half(x_error, k), half(y_error, k));
            Placed {
                x: px(*x),
                y: py(*y),
                left: px(x - dx),
                right: px(x + dx),
                low: py(y - dy),
                high: py(y + dy),
            }
        })
        .collect()
}

/// Draws axes and data so that all of it is in the area.
pub(super) fn draw<DB: DrawingBackend>(
    figure: &Figure,
    legend: &Legend,
    area: &DrawingArea<DB, Shift>,
) -> Drawn
where
    DB::ErrorType: 'static,
{
    let looks = looks(figure);
    let curves: Vec<_> =
        (figure.curves.iter()).map(|c| placed(figure, &c.x, &c.y, None, c.half_band.as_deref())).collect();
    let points: Vec<_> = (figure.points.iter())
        .map(|p| placed(figure, &p.x, &p.y, p.x_error.as_deref(), p.y_error.as_deref()))
        .collect();
    let shown = || (curves.iter().chain(&points).flatten()).filter(|p| p.is_finite());
    let span = |ends: Option<(f64, f64)>, log| {
        (ends.into_iter()).flat_map(move |(a, b)| [place(a, log), place(b, log)])
    };
    let x = shown().flat_map(|p| [p.x, p.left, p.right]);
    let x = x.chain(span(figure.x_span, figure.x_log));
    // A curve may end at the frame, half a marker may not.
    let marked = figure.curves.iter().any(super::Curve::is_marked);
    let margin = if points.is_empty() && !marked { 0.0 } else { 0.04 };
    let x = Axis::over(x, figure.x_log, margin);
    let y = shown().flat_map(|p| [p.y, p.low, p.high]);
    let y = y.chain(span(figure.y_span, figure.y_log));
    let y = Axis::over(y, figure.y_log, 0.05);

    let foot = (x.low, y.low);
    let centre = (0.5 * (x.low + x.high), 0.5 * (y.low + y.high));
    let (along, up) = (x.between.clone(), y.between.clone());
    let mut chart = mesh(figure, legend, area, x, y)?;
    let along = along.iter().map(|x| ((*x, foot.1), (0, 2 * FINE)));
    let up = up.iter().map(|y| ((foot.0, *y), (-2 * FINE, 0)));
    for (place, end) in along.chain(up) {
        let tick = PathElement::new(vec![(0, 0), end], axis_ink());
        chart.draw_series([EmptyElement::at(place) + tick])?;
    }
    if shown().next().is_none() {
        chart.draw_series([Text::new("no data", centre, text(TEXT))])?;
    }
    // What is grey lies beneath.
    let mut order: Vec<_> = (0..curves.len()).collect();
    order.sort_by_key(|series| is_coloured(looks[*series]));
    for series in &order {
        band(&mut chart, &curves[*series], looks[*series], foot.1)?;
    }
    for series in &order {
        line(&mut chart, &curves[*series], looks[*series])?;
    }
    let marked = (figure.curves.iter().zip(&curves).zip(&looks)).filter(|((curve, _), _)| curve.is_marked());
    for ((_, placed), look) in marked {
        for p in placed.iter().filter(|p| p.is_finite()) {
            chart.draw_series([EmptyElement::at((p.x, p.y)) + marker(*look, SMALL_MARKER)])?;
        }
    }
    for (points, look) in points.iter().zip(&looks[curves.len()..]) {
        scatter(&mut chart, points, *look, foot)?;
    }
    let (right, height) = chart.plotting_area().get_pixel_range();
    let origin = area.get_base_pixel();
    let end = |series: usize| {
        let placed = curves.iter().chain(&points).nth(series);
        let last = placed.and_then(|placed| placed.iter().rfind(|p| p.is_finite()));
        last.map_or(height.end, |p| chart.backend_coord(&(p.x, p.y)).1) - origin.1
    };
    let inside = (height.start - origin.1, height.end - origin.1);
    legend.draw_beside(area, right.end - origin.0, inside, end)
}

fn axis_ink() -> ShapeStyle {
    RGBColor(85, 85, 85).stroke_width(FINE as u32)
}

fn mesh<'a, DB: DrawingBackend + 'a>(
    figure: &Figure,
    legend: &Legend,
    area: &DrawingArea<DB, Shift>,
    x: Axis,
    y: Axis,
) -> Result<Chart<'a, DB>, Box<dyn std::error::Error>>
where
    DB::ErrorType: 'static,
{
    let widest = y.ticks.iter().map(|(_, label)| text_width(label, TEXT)).max();
    let (left, bottom) = (widest.unwrap_or(0) + 40 * FINE, 50 * FINE);
    // Smaller where a name is long, but not so small that nobody reads it.
    let fit = |name: &str, room: i32| {
        let size = TEXT * f64::from(room) / f64::from(text_width(name, TEXT));
        size.clamp(0.7 * TEXT, TEXT)
    };
    let right = (24 * FINE).max(legend.width());
    let (across, up) = (WIDTH - left - right - 16 * FINE, AXES_HEIGHT - bottom);
    let name_size = fit(&figure.x_name, across).min(fit(&figure.y_name, up));
    let (x_name, y_name) = (cut(&figure.x_name, across, name_size), cut(&figure.y_name, up, name_size));
    let mut chart = ChartBuilder::on(area)
        .margin_top(10 * FINE)
        .margin_right(right)
        .margin_bottom(8 * FINE)
        .margin_left(8 * FINE)
        .x_label_area_size(bottom)
        .y_label_area_size(left)
        .build_cartesian_2d(x, y)?;
    (chart.configure_mesh())
        .bold_line_style(RGBColor(224, 224, 224).stroke_width(FINE as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(axis_ink())
        .label_style(text(TEXT))
        .axis_desc_style(text(name_size))
        .set_all_tick_mark_size(4 * FINE)
        .x_desc(x_name)
        .y_desc(y_name)
        .draw()?;
    Ok(chart)
}

/// The translucent band, cut at the foot of a logarithmic axis.
fn band<DB: DrawingBackend>(chart: &mut Chart<DB>, curve: &[Placed], index: usize, foot: f64) -> Drawn
where
    DB::ErrorType: 'static,
{
    for run in curve.split(|p| !p.is_finite() || !p.high.is_finite()) {
        let above = run.iter().map(|p| (p.x, p.high));
        let below = run.iter().rev().map(|p| (p.x, p.low.max(foot)));
        let outline: Vec<_> = above.chain(below).collect();
        if run.len() > 1 {
            chart.draw_series([Polygon::new(outline, colour(index).mix(0.2).filled())])?;
        }
    }
    Ok(())
}

fn line<DB: DrawingBackend>(chart: &mut Chart<DB>, points: &[Placed], index: usize) -> Drawn
where
    DB::ErrorType: 'static,
{
    for run in points.split(|p| !p.is_finite()) {
        match run {
            [] => {}
            [single] => {
                let dot = Circle::new((single.x, single.y), MARKER / 2, colour(index).filled());
                chart.draw_series([dot])?;
            }
            run => {
                let path: Vec<_> = run.iter().map(|p| (p.x, p.y)).collect();
                chart.draw_series([PathElement::new(path, curve(index))])?;
            }
        }
    }
    Ok(())
}

fn scatter<DB: DrawingBackend>(
    chart: &mut Chart<DB>,
    points: &[Placed],
    index: usize,
    foot: (f64, f64),
) -> Drawn
where
    DB::ErrorType: 'static,
{
    let bar = |from, to| PathElement::new(vec![from, to], colour(index).stroke_width(BAR_WIDTH));
    for p in points.iter().filter(|p| p.is_finite()) {
        if p.right.is_finite() {
            chart.draw_series([bar((p.left.max(foot.0), p.y), (p.right, p.y))])?;
        }
        if p.high.is_finite() {
            chart.draw_series([bar((p.x, p.low.max(foot.1)), (p.x, p.high))])?;
        }
        chart.draw_series([EmptyElement::at((p.x, p.y)) + marker(index, MARKER)])?;
    }
    Ok(())
}
