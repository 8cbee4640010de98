//! The legend: rows above the axes, where it covers no data; with more than five entries, labels beside the axes, each
//! as near to the end of its curve as the others allow. Shades are shown in a bar above.

use super::style::{
    BAR_WIDTH, BARS, FINE, FITTED, MARGIN, MARKER, ROW, SMALL_MARKER, TEXT, colour, curve, is_shade, looks, marker,
};
use super::texts::{cut, in_rows, text, text_width, wrap};
use super::{Backend, Drawn, Figure};
use plotters::coord::Shift;
use plotters::prelude::*;

const SAMPLE: i32 = 34 * FINE;
const GAP: i32 = 6 * FINE;
/// Size of letters beside the axes, height of their lines, and length of the samples before them.
const SMALL: f64 = 13.0;
const LINE: i32 = 16 * FINE;
const SHORT: i32 = 18 * FINE;
/// Largest number of entries above the axes.
const MOST: usize = 5;
/// Least width of a picture with labels beside its axes.
const LEAST: i32 = 360 * FINE;

/// The sample that an entry shows beside its label.
#[derive(Clone, Copy)]
enum Mark {
    /// A curve's sample; true with a marker.
    Curve(usize, bool),
    Points(usize),
    Band,
    /// The bar of a point.
    Bar,
}

/// A sample and the lines of its label.
type Entry = (Mark, Vec<String>);

/// A bar of shades, from left to right: the quantity's name, and each shade with its value.
struct Bar {
    name: String,
    shades: Vec<(usize, String)>,
    width: i32,
}

pub(super) struct Legend {
    bar: Option<Bar>,
    /// Samples and the lines of their labels above the axes, with their left edges.
    rows: Vec<Vec<(Entry, i32)>>,
    /// Entries beside the axes: index of the series, its sample, and the lines of its label.
    beside: Vec<(usize, Mark, Vec<String>)>,
}

impl Legend {
    pub(super) fn of(figure: &Figure, width: i32) -> Self {
        let looks = looks(figure);
        let names = figure.names();
        let mark = |series: usize| {
            if series < figure.curves.len() {
                Mark::Curve(looks[series], figure.curves[series].is_marked())
            } else {
                Mark::Points(looks[series])
            }
        };
        let mut series: Vec<_> = (names.iter().enumerate())
            .filter(|(series, name)| !name.is_empty() && !is_shade(looks[*series]))
            .map(|(series, name)| (series, mark(series), (*name).clone()))
            .collect();
        let (of_curves, of_points) = looks.split_at(figure.curves.len());
        // Several curves, each with its points: one entry for both, and what is which is said once.
        let mut kinds = String::new();
        if figure.legend.is_empty() && of_points.len() > 1 && of_points.iter().all(|look| of_curves.contains(look)) {
            series.retain(|(series, ..)| *series < figure.curves.len());
            for (series, mark, label) in series.iter_mut().filter(|(series, ..)| of_points.contains(&looks[*series])) {
                *mark = Mark::Curve(looks[*series], true);
                *label = label.strip_suffix(FITTED).unwrap_or(label).to_owned();
            }
            let fitted = figure.curves.iter().any(|curve| curve.label.ends_with(FITTED));
            let bars = figure.points.iter().all(|points| points.y_error.is_some());
            kinds = format!(
                "{}; markers: measured{}",
                if fitted { " of the best fit" } else { "" },
                if bars { " ± u" } else { "" }
            );
        }
        // Bars of several simulated points are named once, and those of points with names of their own.
        let simulated = figure.points.iter().filter(|points| points.label.ends_with(BARS)).count();
        let bars = simulated > usize::from(figure.legend.is_empty());
        for (.., label) in series.iter_mut().filter(|_| bars) {
            *label = label.strip_suffix(BARS).unwrap_or(label).to_owned();
        }
        let beside = if series.len() > MOST && width >= LEAST { std::mem::take(&mut series) } else { Vec::new() };
        let beside = (beside.into_iter())
            .map(|(series, mark, label)| (series, mark, wrap(&label, 2 * width / 5, SMALL)))
            .collect();
        let band = figure.curves.iter().any(|curve| curve.half_band.is_some());
        let above = series.into_iter().map(|(_, mark, label)| (mark, label));
        let above = above.chain(band.then(|| (Mark::Band, format!("95 % band{kinds}"))));
        let above = above.chain(bars.then(|| (Mark::Bar, "simulated, 95 %".to_owned())));
        let sized = |(mark, label): (Mark, String)| {
            let lines = wrap(&label, width - 2 * MARGIN - SAMPLE - GAP, TEXT);
            let own = SAMPLE + GAP + widest(&lines, TEXT) + 2 * GAP;
            ((mark, lines), own)
        };
        let mut rows = in_rows(above.map(sized), width);
        rows.retain(|row| !row.is_empty());
        let shades = names.iter().zip(&looks).filter(|(_, look)| is_shade(**look));
        let shades = shades.map(|(name, look)| (*look, (*name).clone())).collect();
        let bar = figure.shaded_by.clone().map(|name| Bar { name, shades, width: width - 2 * MARGIN });
        Self { bar, rows, beside }
    }

    pub(super) fn height(&self) -> i32 {
        self.height_of_rows() + if self.bar.is_some() { 2 * ROW } else { 0 }
    }

    fn height_of_rows(&self) -> i32 {
        self.rows.iter().map(|row| row_height(row)).sum()
    }

    pub(super) fn height_beside(&self) -> i32 {
        self.beside.len() as i32 * self.entry_height()
    }

    /// The height of an entry beside the axes, as for the one with most lines.
    fn entry_height(&self) -> i32 {
        self.beside.iter().map(|(_, _, lines)| lines.len()).max().unwrap_or(1) as i32 * LINE
    }

    /// The width needed right of the axes.
    pub(super) fn width(&self) -> i32 {
        let widths = self.beside.iter().map(|(_, _, lines)| widest(lines, SMALL));
        widths.max().map_or(0, |width| width + SHORT + 2 * GAP)
    }

    /// Draws the rows above the axes, with the top at `top`.
    pub(super) fn draw<DB: Backend>(&self, canvas: &DrawingArea<DB, Shift>, top: i32) -> Drawn {
        if let Some(bar) = &self.bar {
            bar.draw(canvas, top + self.height_of_rows())?;
        }
        let mut y = top;
        for row in &self.rows {
            for ((mark, lines), x) in row {
                sample(canvas, *mark, (*x, y + 9 * FINE), SAMPLE)?;
                for (k, line) in (0..).zip(lines) {
                    let place = (x + SAMPLE + GAP, y + 3 * FINE + k * ROW);
                    canvas.draw(&Text::new(line.as_str(), place, text(TEXT)))?;
                }
            }
            y += row_height(row);
        }
        Ok(())
    }

    /// Draws the labels beside the axes, from `left` and within `height`; `end` gives the height at which a series
    /// ends.
    pub(super) fn draw_beside<DB: Backend>(
        &self,
        canvas: &DrawingArea<DB, Shift>,
        left: i32,
        height: (i32, i32),
        end: impl Fn(usize) -> i32,
    ) -> Drawn {
        let mut wanted: Vec<_> =
            (self.beside.iter()).map(|(series, mark, lines)| (end(*series), *mark, lines)).collect();
        let ends = || wanted.iter().map(|entry| entry.0);
        let apart_by = ends().max().unwrap_or(0) - ends().min().unwrap_or(0);
        // If most ends are closer than their labels can be, the given order is more useful.
        if 2 * apart_by > self.height_beside() {
            wanted.sort_by_key(|entry| entry.0);
        }
        let places = apart(
            wanted.iter().map(|entry| entry.0).collect(),
            self.entry_height(),
            (height.0, height.1 - self.entry_height() + LINE),
        );
        for ((_, mark, lines), y) in wanted.into_iter().zip(places) {
            sample(canvas, mark, (left + GAP, y), SHORT)?;
            for (k, line) in lines.iter().enumerate() {
                let place = (left + GAP + SHORT + GAP / 2, y - 6 * FINE + k as i32 * LINE);
                canvas.draw(&Text::new(line.as_str(), place, text(SMALL)))?;
            }
        }
        Ok(())
    }
}

impl Bar {
    /// Draws the name and the shades, and below these their values, of which those are left out that would meet.
    fn draw<DB: Backend>(&self, canvas: &DrawingArea<DB, Shift>, top: i32) -> Drawn {
        let name = cut(&self.name, self.width / 3, TEXT);
        canvas.draw(&Text::new(name.as_str(), (MARGIN, top + 3 * FINE), text(TEXT)))?;
        let count = self.shades.len().max(1) as i32;
        let left = MARGIN + text_width(&name, TEXT) + 2 * GAP;
        // Half of the last value extends beyond its shade.
        let widest = self.shades.iter().map(|(_, value)| text_width(value, SMALL)).max().unwrap_or(0);
        let across = MARGIN + self.width - left - widest / 2;
        let edge = |k: i32| left + across * k / count;
        let every = (widest + GAP) * count / across.max(1) + 1;
        for (k, (look, value)) in (0..).zip(&self.shades) {
            let corners = [(edge(k), top + 4 * FINE), (edge(k + 1), top + 18 * FINE)];
            canvas.draw(&Rectangle::new(corners, colour(*look).filled()))?;
            if k % every == 0 {
                let middle = (edge(k) + edge(k + 1)) / 2 - text_width(value, SMALL) / 2;
                canvas.draw(&Text::new(value.as_str(), (middle, top + 21 * FINE), text(SMALL)))?;
            }
        }
        Ok(())
    }
}

fn widest(lines: &[String], size: f64) -> i32 {
    lines.iter().map(|line| text_width(line, size)).max().unwrap_or(0)
}

/// The height of a row of entries above the axes, as for the one with most lines.
fn row_height(row: &[(Entry, i32)]) -> i32 {
    row.iter().map(|((_, lines), _)| lines.len() as i32).max().unwrap_or(0) * ROW
}

/// The places, moved such that they ascend, are at least `least` apart, and stay inside.
fn apart(mut places: Vec<i32>, least: i32, (top, bottom): (i32, i32)) -> Vec<i32> {
    let mut next = top;
    for place in &mut places {
        *place = (*place).max(next);
        next = *place + least;
    }
    let mut next = bottom;
    for place in places.iter_mut().rev() {
        *place = (*place).min(next);
        next = *place - least;
    }
    places
}

fn sample<DB: Backend>(canvas: &DrawingArea<DB, Shift>, mark: Mark, (x, y): (i32, i32), width: i32) -> Drawn {
    match mark {
        Mark::Curve(look, marked) => {
            canvas.draw(&PathElement::new(vec![(x, y), (x + width, y)], curve(look)))?;
            if marked {
                let middle = EmptyElement::at((x + width / 2, y));
                canvas.draw(&(middle + marker(look, SMALL_MARKER)))?;
            }
        }
        Mark::Points(look) => canvas.draw(&(EmptyElement::at((x + width / 2, y)) + marker(look, MARKER)))?,
        Mark::Band => {
            let corners = [(x, y - 6 * FINE), (x + width, y + 6 * FINE)];
            canvas.draw(&Rectangle::new(corners, BLACK.mix(0.2).filled()))?;
        }
        Mark::Bar => {
            let (middle, [low, high]) = (x + width / 2, [y + 7 * FINE, y - 7 * FINE]);
            let cap = |y: i32| vec![(middle - 4 * FINE, y), (middle + 4 * FINE, y)];
            for line in [vec![(middle, low), (middle, high)], cap(low), cap(high)] {
                canvas.draw(&PathElement::new(line, BLACK.stroke_width(BAR_WIDTH)))?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_kept_apart_and_inside() {
        assert_eq!(apart(vec![5, 6, 50], 10, (0, 100)), [5, 15, 50]);
        assert_eq!(apart(vec![95, 96, 97], 10, (0, 100)), [80, 90, 100]);
        assert_eq!(apart(vec![-20, -20], 10, (0, 100)), [0, 10]);
    }
}
