//! The axes and the data in them.

use super::axis::{Axis, STEPS, place};
use super::legend::Legend;
use super::style::{BAR_WIDTH, BELOW, FINE, MARKER, SMALL_MARKER, TEXT, colour, curve, is_coloured, looks, marker};
use super::texts::{cut, text, text_width};
use super::window::Window;
use super::{Backend, Curve, Drawn, Figure, Points};
use plotters::coord::Shift;
use plotters::prelude::*;

/// Half the length of an error bar's cap, and the width of a band's edge; both differ from a curve's, so that neither
/// is dashed.
const CAP: i32 = 4 * FINE;
const EDGE_WIDTH: u32 = 3;

/// The height below the axes for labels and name.
const BOTTOM: i32 = 50 * FINE;

/// Steps between the ticks of the vertical axis of a panel below, which is low.
const STEPS_BELOW: f64 = 4.0;

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

fn placed([x_log, y_log]: [bool; 2], x: &[f64], y: &[f64], x_error: Errors, y_error: Errors) -> Vec<Placed> {
    let half = |errors: Errors, k: usize| errors.and_then(|e| e.get(k)).map_or(f64::NAN, |half| half.abs());
    let (px, py) = (|v| place(v, x_log), |v| place(v, y_log));
    (x.iter().zip(y).enumerate())
        .map(|(k, (x, y))| {
            let (dx, dy) = (half(x_error, k), half(y_error, k));
            Placed { x: px(*x), y: py(*y), left: px(x - dx), right: px(x + dx), low: py(y - dy), high: py(y + dy) }
        })
        .collect()
}

/// The curves and points of a panel, in placed values.
struct Series {
    curves: Vec<Vec<Placed>>,
    points: Vec<Vec<Placed>>,
    /// True for curves whose points are marked.
    marked: Vec<bool>,
}

impl Series {
    fn of(curves: &[Curve], points: &[Points], logs: [bool; 2]) -> Self {
        let of_curve = |c: &Curve| placed(logs, &c.x, &c.y, None, c.half_band.as_deref());
        let of_points = |p: &Points| placed(logs, &p.x, &p.y, p.x_error.as_deref(), p.y_error.as_deref());
        Self {
            curves: curves.iter().map(of_curve).collect(),
            points: points.iter().map(of_points).collect(),
            marked: curves.iter().map(Curve::is_marked).collect(),
        }
    }

    fn shown(&self) -> impl Iterator<Item = &Placed> {
        self.curves.iter().chain(&self.points).flatten().filter(|p| p.is_finite())
    }

    /// True if markers are drawn: a curve may end at the frame, but a marker must not be cut.
    fn has_markers(&self) -> bool {
        !self.points.is_empty() || self.marked.contains(&true)
    }
}

type Ends = Option<(f64, f64)>;

/// The axis over these placed values that covers `span` at least, or exactly `range`.
fn axis(placed: impl Iterator<Item = f64>, log: bool, [span, range]: [Ends; 2], margin: f64, steps: f64) -> Axis {
    let ends = |(from, to)| (place(from, log), place(to, log));
    let exact = range.map(ends).filter(|(from, to)| from < to).map(|ends| Axis::exactly(ends, log));
    let span = span.map(ends).into_iter().flat_map(<[f64; 2]>::from);
    exact.unwrap_or_else(|| Axis::over(placed.chain(span), log, margin, steps))
}

fn vertical(series: &Series, log: bool, ends: [Ends; 2], steps: f64) -> Axis {
    axis(series.shown().flat_map(|p| [p.y, p.low, p.high]), log, ends, 0.05, steps)
}

pub(super) fn draw<DB: Backend>(figure: &Figure, legend: &Legend, area: &DrawingArea<DB, Shift>) -> Drawn {
    let looks = looks(figure);
    let looks = looks.split_at(figure.curves.len());
    let upper = Series::of(&figure.curves, &figure.points, [figure.x_log, figure.y_log]);
    let below = figure.below.as_ref();
    let lower = below.map(|below| Series::of(&below.curves, &below.points, [figure.x_log, false]));
    let all = || std::iter::once(&upper).chain(&lower);
    let margin = if all().any(Series::has_markers) { 0.04 } else { 0.0 };
    let along = all().flat_map(Series::shown).flat_map(|p| [p.x, p.left, p.right]);
    let x = axis(along, figure.x_log, [figure.x_span, figure.x_range], margin, STEPS);
    let y = vertical(&upper, figure.y_log, [figure.y_span, figure.y_range], STEPS);
    let y_below = lower.as_ref().map(|lower| vertical(lower, false, [None; 2], STEPS_BELOW));

    let widest = |axis: &Axis| axis.ticks.iter().map(|(_, label)| text_width(label, TEXT)).max().unwrap_or(0);
    // Half of the last label extends beyond the end of the axis.
    let right = (24 * FINE).max(legend.width()).max(widest(&x) / 2 + FINE);
    let sides = [widest(&y).max(y_below.as_ref().map_or(0, widest)) + 40 * FINE, right];
    let names = |y_name| [figure.x_name.as_str(), y_name];
    let chart = match (below, lower, y_below) {
        (Some(below), Some(lower), Some(y_below)) => {
            let (_, height) = area.dim_in_pixel();
            let (top, foot) = area.split_vertically(height as i32 - BELOW - BOTTOM);
            let labelled = Frame { x: x.clone(), y: y_below, names: names(&below.y_name), sides, bottom: BOTTOM };
            panel(&lower, looks, labelled, &foot)?;
            let bare = Frame { x: x.unlabelled(), y, names: ["", &figure.y_name], sides, bottom: 4 * FINE };
            panel(&upper, looks, bare, &top)?
        }
        _ => panel(&upper, looks, Frame { x, y, names: names(&figure.y_name), sides, bottom: BOTTOM }, area)?,
    };
    let (right, height) = chart.plotting_area().get_pixel_range();
    let origin = area.get_base_pixel();
    let (x, y) = (chart.x_range(), chart.y_range());
    let window = Window { x: (x.start, x.end), y: (y.start, y.end) };
    let end = |series: usize| {
        let placed = upper.curves.iter().chain(&upper.points).nth(series);
        let last = placed.and_then(|placed| placed.iter().rfind(|p| window.has((p.x, p.y))));
        last.map_or(height.end, |p| chart.backend_coord(&(p.x, p.y)).1) - origin.1
    };
    let inside = (height.start - origin.1, height.end - origin.1);
    legend.draw_beside(area, right.end - origin.0, inside, end)
}

/// The axes of a panel, their names, the widths left and right of them, and the height below for labels.
struct Frame<'a> {
    x: Axis,
    y: Axis,
    names: [&'a str; 2],
    sides: [i32; 2],
    bottom: i32,
}

/// Draws a panel. The looks are those of its curves, then of its points.
fn panel<'a, DB: Backend + 'a>(
    Series { curves, points, marked }: &Series,
    looks: (&[usize], &[usize]),
    frame: Frame,
    area: &DrawingArea<DB, Shift>,
) -> Result<Chart<'a, DB>, Box<dyn std::error::Error>> {
    let Frame { x, y, .. } = &frame;
    let window = Window { x: (x.low, x.high), y: (y.low, y.high) };
    let foot = (x.low, y.low);
    let centre = (0.5 * (x.low + x.high), 0.5 * (y.low + y.high));
    let (along, up) = (x.between.clone(), y.between.clone());
    let mut chart = mesh(frame, area)?;
    let along = along.iter().map(|x| ((*x, foot.1), (0, 2 * FINE)));
    let up = up.iter().map(|y| ((foot.0, *y), (-2 * FINE, 0)));
    for (place, end) in along.chain(up) {
        let tick = PathElement::new(vec![(0, 0), end], axis_ink());
        chart.draw_series([EmptyElement::at(place) + tick])?;
    }
    if !curves.iter().chain(points).flatten().any(|p| window.has((p.x, p.y))) {
        chart.draw_series([Text::new("no data", centre, text(TEXT))])?;
    }
    // Grey series are drawn first, below the others.
    let mut order: Vec<_> = curves.iter().zip(looks.0).collect();
    order.sort_by_key(|(_, look)| is_coloured(**look));
    for (curve, look) in &order {
        band(&mut chart, curve, **look, &window)?;
    }
    for (curve, look) in &order {
        line(&mut chart, curve, **look, &window)?;
    }
    for ((placed, look), _) in curves.iter().zip(looks.0).zip(marked).filter(|(_, marked)| **marked) {
        for p in placed.iter().filter(|p| window.has((p.x, p.y))) {
            chart.draw_series([EmptyElement::at((p.x, p.y)) + marker(*look, SMALL_MARKER)])?;
        }
    }
    for (points, look) in points.iter().zip(looks.1) {
        scatter(&mut chart, points, *look, &window)?;
    }
    Ok(chart)
}

fn axis_ink() -> ShapeStyle {
    RGBColor(85, 85, 85).stroke_width(FINE as u32)
}

fn mesh<'a, DB: Backend + 'a>(
    Frame { x, y, names: [x_name, y_name], sides: [left, right], bottom }: Frame,
    area: &DrawingArea<DB, Shift>,
) -> Result<Chart<'a, DB>, Box<dyn std::error::Error>> {
    // Smaller letters for a long name, but not too small to read.
    let fit = |name: &str, room: i32| {
        let size = TEXT * f64::from(room) / f64::from(text_width(name, TEXT).max(1));
        size.clamp(0.7 * TEXT, TEXT)
    };
    let (width, height) = area.dim_in_pixel();
    let (across, up) = (width as i32 - left - right - 16 * FINE, height as i32 - bottom);
    let name_size = fit(x_name, across).min(fit(y_name, up));
    let (x_name, y_name) = (cut(x_name, across, name_size), cut(y_name, up, name_size));
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
        let above = window.thinned(run.iter().map(|p| (p.x, p.high)));
        // A logarithmic axis has no place for values below 0.
        let below = window.thinned(run.iter().map(|p| (p.x, if p.low.is_nan() { window.y.0 } else { p.low })));
        if run.len() > 1 {
            let outline = window.area(above.iter().chain(below.iter().rev()).copied().collect());
            if outline.len() > 2 {
                chart.draw_series([Polygon::new(outline, colour(index).mix(0.25).filled())])?;
            }
            for edge in [above, below].into_iter().flat_map(|edge| window.lines(edge)) {
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
                for path in window.lines(window.thinned(run.iter().map(|p| (p.x, p.y)))) {
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
