//! Sizes, colours, dashes and markers. Colours are Okabe & Ito's, safe for the colour-blind.

use super::Figure;
use plotters::prelude::*;

/// Scale of drawing: plotters' SVG has only whole pixels, so figures are drawn this much larger, and scaled by the view
/// box.
pub(super) const FINE: i32 = 4;
pub(super) const WIDTH: i32 = 560 * FINE;
pub(super) const AXES_HEIGHT: i32 = 340 * FINE;
/// The part of that height above and below the axes.
pub(super) const AXES_FRAME: i32 = 76 * FINE;
/// The height that a panel below adds.
pub(super) const BELOW: i32 = 100 * FINE;
pub(super) const ROW: i32 = 23 * FINE;
pub(super) const MARGIN: i32 = 12 * FINE;
/// Sizes of letters.
pub(super) const TEXT: f64 = 16.0;
pub(super) const TITLE: f64 = 17.0;
pub(super) const MARKER: i32 = 5 * FINE;
/// The size of the markers on a curve.
pub(super) const SMALL_MARKER: i32 = 4 * FINE;
/// Differs from a curve's width, so that error bars are not dashed.
pub(super) const BAR_WIDTH: u32 = 6;
pub(super) const CURVE_WIDTH: u32 = 8;

/// Okabe & Ito (2008), without the yellow, which is hard to see on white.
const PALETTE: [RGBColor; 11] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(136, 34, 85),
    RGBColor(51, 34, 136),
    RGBColor(153, 153, 51),
    RGBColor(150, 90, 50),
];

/// Lengths of dashes and gaps.
const DASHES: [&str; 6] = ["", "32 14", "8 12", "44 12 8 12", "18 10", "60 16"];

/// Grey of series beyond the palette, which differ by dashes, marker and the label at their end.
const GREY: u8 = 140;

/// The integrators drawn in many pictures, always with the same colour, dashes and marker.
const NAMED: [&str; 11] = [
    "exact propagator",
    "explicit Euler in angles",
    "RK4 in angles",
    "implicit midpoint in p",
    "A.4 and A.5 in angles",
    "Radau IIA 5",
    "Dormand–Prince 8(5,3)",
    "RK4 in p",
    "Lie-group midpoint",
    "Lie-group RKMK4",
    "projected RK4 in p",
];

/// A theory's line has its method's colour; its look is this much above the method's, and so above all others.
const THEORY: usize = 42;

// The ends of the labels of measured points and of the curve that was fitted to them.
/// That of points.
pub const MEASURED: &str = ", measured ± u";
/// That of points without uncertainties.
pub const WITHOUT_BARS: &str = ", measured";
/// That of a curve.
pub const FITTED: &str = ", best fit";
/// That of an exact curve over those of runs.
pub const REFERENCE: &str = ", exact";

/// The looks of exact curves begin here: black, as what they are compared with has a colour, and dashed.
const EXACT: usize = 2 * THEORY;

/// The looks of shades begin here.
pub(super) const SHADES: usize = 1000;

/// The number of shades.
pub(super) const LEVELS: usize = 256;

/// Shades from dark to light, evenly apart: matplotlib's plasma without its ends, which are hard to see on black or on
/// white.
const PLASMA: [[f64; 3]; 7] = [
    [70.0, 3.0, 159.0],
    [114.0, 1.0, 168.0],
    [156.0, 23.0, 158.0],
    [189.0, 55.0, 134.0],
    [216.0, 87.0, 107.0],
    [237.0, 121.0, 83.0],
    [251.0, 159.0, 58.0],
];

/// The shade at a level.
fn plasma(level: usize) -> RGBColor {
    let place = level as f64 / (LEVELS - 1) as f64 * (PLASMA.len() - 1) as f64;
    let first = (place as usize).min(PLASMA.len() - 2);
    let part = |k: usize| PLASMA[first][k] + (place - first as f64) * (PLASMA[first + 1][k] - PLASMA[first][k]);
    let [red, green, blue] = [0, 1, 2].map(|k| part(k).round() as u8);
    RGBColor(red, green, blue)
}

/// True if a look is a shade, which the legend shows in a bar.
pub(super) fn is_shade(index: usize) -> bool {
    index >= SHADES
}

/// The look of every curve and then of all points: that of the integrator named in the label, or the first that is not
/// used in the figure. Where there are several curves, points look as that of the same name.
pub(super) fn looks(figure: &Figure) -> Vec<usize> {
    let labels = figure.curves.iter().map(|c| &c.label).chain(figure.points.iter().map(|p| &p.label));
    let named = |label: &String| {
        let (name, theory) = match label.strip_suffix(", theory") {
            Some(name) => (name, THEORY),
            None => (label.as_str(), 0),
        };
        NAMED.iter().position(|known| *known == name).map(|look| look + theory)
    };
    let mut known: Vec<_> = labels.map(named).collect();
    let exact = |curve: &super::Curve| curve.label.ends_with(REFERENCE);
    let shaded = figure.curves.iter().filter(|curve| figure.shaded_by.is_some() && !exact(curve)).count();
    for (k, curve) in figure.curves.iter().enumerate() {
        if exact(curve) {
            known[k] = Some(EXACT + figure.curves[..k].iter().filter(|curve| exact(curve)).count());
        } else if shaded > 0 {
            known[k] = Some(SHADES + k * (LEVELS - 1) / (shaded - 1).max(1));
        }
    }
    let mut free = (0..).filter(|look| !known.contains(&Some(*look)));
    let mut looks: Vec<usize> = (known.iter()).map(|look| look.or_else(|| free.next()).unwrap_or(0)).collect();
    let names: Vec<_> = (figure.curves.iter().filter(|curve| !exact(curve)))
        .map(|curve| curve.label.strip_suffix(FITTED).unwrap_or(&curve.label))
        .collect();
    if names.len() > 1 {
        for (k, points) in figure.points.iter().enumerate() {
            let what = [MEASURED, WITHOUT_BARS].iter().find_map(|end| points.label.strip_suffix(end));
            let own = names.iter().position(|curve| Some(*curve) == what);
            own.into_iter().for_each(|curve| looks[figure.curves.len() + k] = looks[curve]);
        }
    }
    looks
}

/// The colour of a look. All differ, if only in the last bits, so that `curve_stroke` identifies one curve.
pub(super) fn colour(index: usize) -> RGBColor {
    if is_shade(index) {
        return plasma(index - SHADES);
    }
    if index >= EXACT {
        return RGBColor((index - EXACT + 1) as u8, 0, 0);
    }
    let (method, theory) = (index % THEORY, (index / THEORY) as u8);
    match PALETTE.get(method) {
        Some(RGBColor(red, green, blue)) => RGBColor(*red, *green, blue ^ theory),
        None => {
            let number = (method - PALETTE.len()) as u8;
            RGBColor(GREY ^ (number & 7), GREY ^ (number >> 3), GREY ^ theory)
        }
    }
}

/// True if a look has a colour of the palette, and is not grey.
pub(super) fn is_coloured(index: usize) -> bool {
    index >= EXACT || index % THEORY < PALETTE.len()
}

/// The colours of a map's classes, from right to not run. They also differ in grey, on a dark page that inverts
/// lightness, and by their glyphs.
pub(super) const CLASSES: [RGBColor; 6] = [
    RGBColor(70, 145, 200),
    RGBColor(245, 232, 110),
    RGBColor(230, 159, 0),
    RGBColor(170, 60, 0),
    RGBColor(204, 121, 167),
    RGBColor(235, 235, 235),
];

/// The shade of a step of a quantity, from light to dark.
pub(super) fn shade(class: usize, count: usize) -> RGBColor {
    let part = class as f64 / count.saturating_sub(1).max(1) as f64;
    let [red, green, blue] = [(240.0, 10.0), (246.0, 45.0), (255.0, 110.0)].map(|(from, to)| from + part * (to - from));
    RGBColor(red as u8, green as u8, blue as u8)
}

/// The colour of a class's glyph.
pub(super) fn class_ink(class: usize) -> RGBColor {
    match class {
        3 => RGBColor(255, 255, 255),
        _ => RGBColor(40, 40, 40),
    }
}

/// The strokes of a class's glyph around the centre of its cell: nothing for right, then a stroke, a cross, two bars, a
/// square, a dot.
pub(super) fn glyph(class: usize) -> Vec<Vec<(i32, i32)>> {
    let r = 3 * FINE;
    match class {
        1 => vec![vec![(-r, 0), (r, 0)]],
        2 => vec![vec![(-r, r), (r, -r)]],
        3 => vec![vec![(-r, r), (r, -r)], vec![(-r, -r), (r, r)]],
        4 => vec![vec![(-r, -r), (r, -r), (r, r), (-r, r), (-r, -r)]],
        5 => vec![vec![(-FINE / 2, 0), (FINE / 2, 0)]],
        _ => Vec::new(),
    }
}

pub(super) fn curve(index: usize) -> ShapeStyle {
    colour(index).stroke_width(CURVE_WIDTH)
}

/// The stroke of a curve as plotters writes it.
pub(super) fn curve_stroke(index: usize) -> String {
    let RGBColor(red, green, blue) = colour(index);
    format!("stroke=\"#{red:02X}{green:02X}{blue:02X}\" stroke-width=\"{CURVE_WIDTH}\"")
}

/// The lengths of a curve's dashes and gaps; empty for a solid curve.
pub(super) fn dash_lengths(index: usize) -> &'static str {
    match index {
        SHADES.. => "",
        EXACT.. => DASHES[1 + (index - EXACT) % (DASHES.len() - 1)],
        _ => DASHES[index % DASHES.len()],
    }
}

/// The SVG attribute for the dashes of a curve.
pub(super) fn dashes(index: usize) -> String {
    match dash_lengths(index) {
        "" => String::new(),
        lengths => format!(" stroke-dasharray=\"{lengths}\""),
    }
}

/// The marker of a point around the origin: a disc, a diamond, a triangle, a square, a triangle on its tip, as a
/// polygon defined by its number of corners and the angle of the first.
pub(super) fn marker(index: usize, size: i32) -> Polygon<(i32, i32)> {
    let (corners, first) = [(16, 0.0), (4, 0.0), (3, 0.75), (4, 0.125), (3, 0.25)][index % 5];
    let radius = f64::from(size) * if corners == 16 { 0.85 } else { 1.1 };
    let outline: Vec<(i32, i32)> = (0..corners)
        .map(|corner| {
            let angle = std::f64::consts::TAU * (first + f64::from(corner) / f64::from(corners));
            let (sin, cos) = angle.sin_cos();
            ((radius * cos).round() as i32, (radius * sin).round() as i32)
        })
        .collect();
    Polygon::new(outline, colour(index).filled())
}

/// The style of dark text of this size, in the units of the view.
pub(super) fn text(size: f64) -> TextStyle<'static> {
    styled(size, FontStyle::Normal)
}

/// The style of bold dark text of this size.
pub(super) fn bold(size: f64) -> TextStyle<'static> {
    styled(size, FontStyle::Bold)
}

fn styled(size: f64, style: FontStyle) -> TextStyle<'static> {
    // Plotters divides by 1.24 when it writes SVG.
    let font = ("sans-serif", size * 1.24 * f64::from(FINE)).into_font();
    font.style(style).color(&RGBColor(34, 34, 34))
}

/// Largest number of lines of a title.
const MOST_LINES: usize = 4;

/// The width of a text in the widest font that a browser or a printer falls back to: DejaVu Sans, bold for sizes that
/// may be bold.
pub(super) fn text_width(text: &str, size: f64) -> i32 {
    let bold = size >= TITLE || size == SMALL_BOLD;
    (super::letters::ems(text, bold) * size * f64::from(FINE)).ceil() as i32
}

/// Size of the letters of a map's title.
pub(super) const SMALL_BOLD: f64 = 13.5;

/// The part of a text that fits into `room`; `…` stands for the rest.
pub(super) fn cut(text: &str, room: i32, size: f64) -> String {
    if text_width(text, size) <= room {
        return text.to_owned();
    }
    let fits = |end: &usize| text_width(&text[..*end], size) + text_width("…", size) <= room;
    let end = text.char_indices().map(|(at, _)| at).take_while(fits).last().unwrap_or(0);
    format!("{}…", &text[..end])
}

/// Items, each with its width, in rows no wider than a figure: at least one row, and the left edge of each item.
pub(super) fn in_rows<T>(items: impl Iterator<Item = (T, i32)>, width: i32) -> Vec<Vec<(T, i32)>> {
    let mut rows = vec![Vec::new()];
    let mut x = MARGIN;
    for (item, own) in items {
        if x + own > width - MARGIN && x > MARGIN {
            rows.push(Vec::new());
            x = MARGIN;
        }
        if let Some(row) = rows.last_mut() {
            row.push((item, x));
        }
        x += own;
    }
    rows
}

/// The words of a text; a number is one with its sign and its unit.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match words.last_mut() {
            Some(last) if last.ends_with(['=', '±']) || ["=", "%", "cm⁻³"].contains(&word) => {
                *last += " ";
                *last += word;
            }
            _ => words.push(word.into()),
        }
    }
    words
}

/// The lines of a text within the width `room`, four at most; a word that is too wide is cut.
pub(super) fn wrap(text: &str, room: i32, size: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words(text) {
        let word = &cut(&word, room, size);
        let full = lines.len() == MOST_LINES;
        match lines.last_mut() {
            Some(line) if text_width(line, size) + text_width(word, size) < room => {
                line.push(' ');
                line.push_str(word);
            }
            Some(last) if full => {
                *last = cut(&format!("{last} {word}"), room, size);
                break;
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::{Curve, Points};
    use super::*;

    #[test]
    fn no_two_curves_look_the_same() {
        // Looks as the eye sees them: a colour, or grey with dashes and marker.
        let looks: std::collections::BTreeSet<_> = (0..37)
            .map(|index| {
                let marker = (index >= PALETTE.len()).then(|| (dashes(index), index % 5));
                (index.min(PALETTE.len()), marker)
            })
            .collect();
        assert_eq!(looks.len(), 37);
        let strokes: std::collections::BTreeSet<_> = (0..2 * THEORY).map(curve_stroke).collect();
        assert_eq!(strokes.len(), 2 * THEORY);
    }

    #[test]
    fn points_look_as_the_curve_that_was_fitted_to_them_where_there_are_several() {
        let figure = |names: &[&str]| Figure {
            curves: (names.iter().map(|name| Curve { label: format!("{name}{FITTED}"), ..Curve::default() })).collect(),
            points: (names.iter().map(|name| Points { label: format!("{name}{MEASURED}"), ..Points::default() }))
                .collect(),
            ..Figure::default()
        };
        assert_eq!(looks(&figure(&["x1"])), [0, 1]);
        assert_eq!(looks(&figure(&["x1", "phi"])), [0, 1, 0, 1]);
        let mut of_runs = figure(&["x1", "phi"]);
        of_runs.curves.iter_mut().for_each(|curve| curve.label = curve.label.replace(FITTED, ""));
        of_runs.curves.push(Curve { label: format!("x1{REFERENCE}"), ..Curve::default() });
        assert_eq!(looks(&of_runs), [0, 1, EXACT, 0, 1]);
        let mut other = figure(&["x1", "phi"]);
        other.points.reverse();
        other.points[1].label = "theirs".into();
        assert_eq!(looks(&other), [0, 1, 1, 3]);
    }

    #[test]
    fn every_integrator_has_a_colour_of_its_own() {
        for (a, b) in (0..NAMED.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
            let (RGBColor(r, g, b1), RGBColor(s, h, b2)) = (colour(a), colour(b));
            let apart = r.abs_diff(s).max(g.abs_diff(h)).max(b1.abs_diff(b2));
            assert!(is_coloured(a) && apart > 50, "{} and {}", NAMED[a], NAMED[b]);
        }
        // Control: a series beyond the palette is grey, and close to other greys.
        assert!(!is_coloured(NAMED.len()));
        let (RGBColor(red, ..), RGBColor(next, ..)) = (colour(NAMED.len()), colour(NAMED.len() + 1));
        assert!(red.abs_diff(next) < 8);
    }

    #[test]
    fn texts_are_wrapped_at_words() {
        let room = text_width("a picture of", TEXT) + 1;
        assert_eq!(wrap("a picture of two words", room, TEXT), ["a picture of", "two words"]);
        assert_eq!(wrap("pictures of σ = 3.6 %", room, TEXT), ["pictures of", "σ = 3.6 %"]);
        assert!(wrap("", room, TEXT).is_empty());
        let cut = &wrap("incomprehensibilities", room, TEXT)[0];
        assert!(cut.starts_with("incomp") && cut.ends_with('…') && text_width(cut, TEXT) <= room);
        let long = wrap(&"word ".repeat(100), room, TEXT);
        assert!(long.len() == MOST_LINES && long[MOST_LINES - 1].ends_with('…'), "{long:?}");
    }
}
