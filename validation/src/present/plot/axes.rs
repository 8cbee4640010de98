//! The axes and the data in them.

use super::axis::{Axis, place};
use super::legend::Legend;
use super::style::{
    BAR_WIDTH, FINE, MARKER, SMALL_MARKER, TEXT, colour, curve, cut, is_coloured, looks, marker, text, text_width,
};
use super::window::Window;
use super::{Backend, Drawn, Figure};
use plotters::coord::Shift;
use plotters::prelude::*;

/// Half the length of an error bar's cap, and the width of a band's edge; both differ from a curve's, so that neither
/// is dashed.
const CAP: i32 = 4 * FINE;
const EDGE_WIDTH: u32 = 3;

type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<Axis, Axis>>;

/// A point in placed values, with the ends of its error bars; missing ones are NaN.
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
            Placed { x: px(*x), y: py(*y), left: px(x - dx), right: px(x + dx), low: py(y - dy), high: py(y + dy) }
        })
        .collect()
}

pub(super) fn draw<DB: Backend>(figure: &Figure, legend: &Legend, area: &DrawingArea<DB, Shift>) -> Drawn {
    let looks = looks(figure);
    let curves: Vec<_> =
        (figure.curves.iter()).map(|c| placed(figure, &c.x, &c.y, None, c.half_band.as_deref())).collect();
    let points: Vec<_> = (figure.points.iter())
        .map(|p| placed(figure, &p.x, &p.y, p.x_error.as_deref(), p.y_error.as_deref()))
        .collect();
    let shown = || (curves.iter().chain(&points).flatten()).filter(|p| p.is_finite());
    // A curve may end at the frame, but a marker must not be cut.
    let marked = figure.curves.iter().any(super::Curve::is_marked);
    let margin = if points.is_empty() && !marked { 0.0 } else { 0.04 };
    let axis = |of: fn(&Placed) -> [f64; 3], log, span: Option<(f64, f64)>, range: Option<(f64, f64)>, margin| {
        let ends = |(from, to)| (place(from, log), place(to, log));
        let exact = range.map(ends).filter(|(from, to)| from < to).map(|ends| Axis::exactly(ends, log));
        let span = span.map(ends).into_iter().flat_map(<[f64; 2]>::from);
        exact.unwrap_or_else(|| Axis::over(shown().flat_map(of).chain(span), log, margin))
    };
    let x = axis(|p| [p.x, p.left, p.right], figure.x_log, figure.x_span, figure.x_range, margin);
    let y = axis(|p| [p.y, p.low, p.high], figure.y_log, figure.y_span, figure.y_range, 0.05);
    let window = Window { x: (x.low, x.high), y: (y.low, y.high) };

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
    if !shown().any(|p| window.has((p.x, p.y))) {
        chart.draw_series([Text::new("no data", centre, text(TEXT))])?;
    }
    // Grey series are drawn first, below the others.
    let mut order: Vec<_> = (0..curves.len()).collect();
    order.sort_by_key(|series| is_coloured(looks[*series]));
    for series in &order {
        band(&mut chart, &curves[*series], looks[*series], &window)?;
    }
    for series in &order {
        line(&mut chart, &curves[*series], looks[*series], &window)?;
    }
    let marked = (figure.curves.iter().zip(&curves).zip(&looks)).filter(|((curve, _), _)| curve.is_marked());
    for ((_, placed), look) in marked {
        for p in placed.iter().filter(|p| window.has((p.x, p.y))) {
            chart.draw_series([EmptyElement::at((p.x, p.y)) + marker(*look, SMALL_MARKER)])?;
        }
    }
    for (points, look) in points.iter().zip(&looks[curves.len()..]) {
        scatter(&mut chart, points, *look, &window)?;
    }
    let (right, height) = chart.plotting_area().get_pixel_range();
    let origin = area.get_base_pixel();
    let end = |series: usize| {
        let placed = curves.iter().chain(&points).nth(series);
        let last = placed.and_then(|placed| placed.iter().rfind(|p| window.has((p.x, p.y))));
        last.map_or(height.end, |p| chart.backend_coord(&(p.x, p.y)).1) - origin.1
    };
    let inside = (height.start - origin.1, height.end - origin.1);
    legend.draw_beside(area, right.end - origin.0, inside, end)
}

fn axis_ink() -> ShapeStyle {
    RGBColor(85, 85, 85).stroke_width(FINE as u32)
}

fn mesh<'a, DB: Backend + 'a>(
    figure: &Figure,
    legend: &Legend,
    area: &DrawingArea<DB, Shift>,
    x: Axis,
    y: Axis,
) -> Result<Chart<'a, DB>, Box<dyn std::error::Error>> {
    let widest = y.ticks.iter().map(|(_, label)| text_width(label, TEXT)).max();
    let (left, bottom) = (widest.unwrap_or(0) + 40 * FINE, 50 * FINE);
    // Smaller letters for a long name, but not too small to read.
    let fit = |name: &str, room: i32| {
        let size = TEXT * f64::from(room) / f64::from(text_width(name, TEXT));
        size.clamp(0.7 * TEXT, TEXT)
    };
    // Half of the last label extends beyond the end of the axis.
    let beyond = x.ticks.iter().map(|(_, label)| text_width(label, TEXT) / 2 + FINE).max().unwrap_or(0);
    let right = (24 * FINE).max(legend.width()).max(beyond);
    let (width, height) = area.dim_in_pixel();
    let (across, up) = (width as i32 - left - right - 16 * FINE, height as i32 - bottom);
    let name_size = fit(&figure.x_name, across).min(fit(&figure.y_name, up));
    let (x_name, y_name) = (cut(&figure.x_name, across, name_size), cut(&figure.y_name, up, name_size));
    let mut chart = ChartBuilder::on(area)
        .margin_top(10 * FINE)
        .margin_right(right)
        .margin_bottom(8 * FINE)
        .margin_left(8 * FINE)
        .x_label_area_size(bottom)
        .y_label_area_size(left)
        .build_cartesian_2d(x.legible(across), y)?;
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

/// Draws the translucent band with a thin edge, cut at the frame.
fn band<DB: Backend>(chart: &mut Chart<DB>, curve: &[Placed], index: usize, window: &Window) -> Drawn {
    for run in curve.split(|p| !p.is_finite() || !p.high.is_finite()) {
        let above = run.iter().map(|p| (p.x, p.high));
        // A logarithmic axis has no place for values below 0.
        let below = run.iter().map(|p| (p.x, if p.low.is_nan() { window.y.0 } else { p.low }));
        if run.len() > 1 {
            let outline = above.clone().chain(below.clone().rev()).collect();
            let outline = window.area(outline);
            if outline.len() > 2 {
                chart.draw_series([Polygon::new(outline, colour(index).mix(0.25).filled())])?;
            }
            for edge in window.lines(above).into_iter().chain(window.lines(below)) {
                let style = colour(index).mix(0.5).stroke_width(EDGE_WIDTH);
                chart.draw_series([PathElement::new(edge, style)])?;
            }
        }
    }
    Ok(())
}

fn line<DB: Backend>(chart: &mut Chart<DB>, points: &[Placed], index: usize, window: &Window) -> Drawn {
    for run in points.split(|p| !p.is_finite()) {
        match run {
            [] => {}
            [single] if !window.has((single.x, single.y)) => {}
            [single] => {
                let dot = Circle::new((single.x, single.y), MARKER / 2, colour(index).filled());
                chart.draw_series([dot])?;
            }
            run => {
                for path in window.lines(run.iter().map(|p| (p.x, p.y))) {
                    chart.draw_series([PathElement::new(path, curve(index))])?;
                }
            }
        }
    }
    Ok(())
}

/// The place at an end of an error bar.
type At = fn(&Placed, f64) -> (f64, f64);

fn scatter<DB: Backend>(chart: &mut Chart<DB>, points: &[Placed], index: usize, window: &Window) -> Drawn {
    let ink = || colour(index).stroke_width(BAR_WIDTH);
    for p in points.iter().filter(|p| window.has((p.x, p.y))) {
        let bars = [
            ([p.left, p.right], window.x, (|p, x| (x, p.y)) as At, (0, CAP)),
            ([p.low, p.high], window.y, |p, y| (p.x, y), (CAP, 0)),
        ];
        for (ends, (low, high), at, cap) in bars.into_iter().filter(|(ends, ..)| ends[1].is_finite()) {
            let line = vec![at(p, ends[0].max(low)), at(p, ends[1].min(high))];
            chart.draw_series([PathElement::new(line, ink())])?;
            // Caps are drawn only at ends inside the frame.
            for end in ends.into_iter().filter(|end| (low..=high).contains(end)) {
                let cap = PathElement::new(vec![(-cap.0, -cap.1), cap], ink());
                chart.draw_series([EmptyElement::at(at(p, end)) + cap])?;
            }
        }
        // A smaller one hides less of its bars.
        let size = if p.high.is_finite() || p.right.is_finite() { SMALL_MARKER } else { MARKER };
        chart.draw_series([EmptyElement::at((p.x, p.y)) + marker(index, size)])?;
    }
    Ok(())
}
