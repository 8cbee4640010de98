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
/// That of simulated points.
pub const BARS: &str = ", bars: 95 %";
/// That of an exact curve over those of runs.
pub const REFERENCE: &str = ", exact";

/// The looks of exact curves begin here: black, as what they are compared with has a colour, and dashed.
const EXACT: usize = 2 * THEORY;

/// The looks of several channels of several runs begin here: a colour is a channel, and dashes and a marker are a run,
/// or the other way round where only so there are enough of them. The look of the next dashes is this much above.
const PAIRS: usize = 200;
const NEXT_DASHES: usize = PALETTE.len();

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
    let named = |label: &String| {
        let (name, theory) = match label.strip_suffix(", theory") {
            Some(name) => (name, THEORY),
            None => (label.as_str(), 0),
        };
        NAMED.iter().position(|known| *known == name).map(|look| look + theory)
    };
    let mut known: Vec<_> = figure.labels().map(named).collect();
    let pairs: Vec<_> = figure.labels().map(|label| parts(&figure.channels, label)).collect();
    let mut runs: Vec<&str> = Vec::new();
    for (_, run) in pairs.iter().flatten() {
        runs.extend((!runs.contains(run)).then_some(*run));
    }
    if let Some(look_of) = look_of_pair(figure.channels.len(), runs.len()) {
        let run = |name: &str| runs.iter().position(|known| *known == name).unwrap_or(0);
        for (look, pair) in known.iter_mut().zip(&pairs) {
            *look = pair.map(|(channel, name)| look_of(channel, run(name))).or(*look);
        }
    }
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

/// The channel and the run of a label `<channel>, <run>`, in a figure of several of both.
fn parts<'a>(channels: &[String], label: &'a str) -> Option<(usize, &'a str)> {
    channels.iter().enumerate().find_map(|(k, channel)| {
        let run = label.strip_prefix(channel.as_str())?.strip_prefix(", ")?;
        Some((k, run.strip_suffix(BARS).unwrap_or(run)))
    })
}

/// The looks of pairs of a channel and a run, in a figure with labels of so many runs; `None` if they are too many.
fn look_of_pair(channels: usize, runs: usize) -> Option<fn(usize, usize) -> usize> {
    if channels <= PALETTE.len() && runs <= DASHES.len() {
        Some(|channel, run| PAIRS + run * NEXT_DASHES + channel)
    } else if channels <= DASHES.len() && runs <= PALETTE.len() {
        Some(|channel, run| PAIRS + channel * NEXT_DASHES + run)
    } else {
        None
    }
}

/// The number of the dashes of a look of a pair.
fn pair_dashes(index: usize) -> Option<usize> {
    (PAIRS..SHADES).contains(&index).then(|| (index - PAIRS) / NEXT_DASHES)
}

/// The colour of a look. All differ, if only in the last bits, so that `curve_stroke` identifies one curve.
pub(super) fn colour(index: usize) -> RGBColor {
    if is_shade(index) {
        return plasma(index - SHADES);
    }
    if let Some(dashes) = pair_dashes(index) {
        let RGBColor(red, green, blue) = PALETTE[(index - PAIRS) % NEXT_DASHES];
        let bits = |from: usize| ((dashes + 1) >> from & 3) as u8;
        return RGBColor(red ^ bits(0), green ^ bits(2), blue);
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
        PAIRS.. => DASHES[pair_dashes(index).unwrap_or(0) % DASHES.len()],
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
    let (corners, first) =
        [(16, 0.0), (4, 0.0), (3, 0.75), (4, 0.125), (3, 0.25)][pair_dashes(index).unwrap_or(index) % 5];
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
    fn a_colour_is_a_channel_and_dashes_are_a_run_where_there_are_several_of_both() {
        let label = |k: usize| format!("{}, {}", ["x1", "x3"][k % 2], ["one", "two"][k / 2]);
        let curves: Vec<_> = (0..3).map(|k| Curve { label: label(k), ..Curve::default() }).collect();
        let ends = [label(3) + BARS, format!("x3{MEASURED}")];
        let points = ends.map(|label| Points { label, ..Points::default() }).to_vec();
        let figure = Figure { channels: vec!["x1".into(), "x3".into()], curves, points, ..Figure::default() };
        let looks = looks(&figure);
        let near = |a: usize, b: usize| {
            let (RGBColor(r, g, b1), RGBColor(s, h, b2)) = (colour(looks[a]), colour(looks[b]));
            r.abs_diff(s).max(g.abs_diff(h)).max(b1.abs_diff(b2)) < 4
        };
        assert!(near(0, 2) && near(1, 3) && near(1, 4) && !near(0, 1) && !near(2, 3));
        let dashes = |k: usize| dash_lengths(looks[k]);
        assert!(dashes(0) == dashes(1) && dashes(2) == dashes(3) && dashes(0) != dashes(2));
        let markers: std::collections::BTreeSet<_> = [0, 2, 4].map(|k| pair_dashes(looks[k])).into();
        assert!(markers.len() == 3 && pair_dashes(looks[2]) == pair_dashes(looks[3]));
        // The strokes differ nevertheless, also from those of other looks.
        let pairs = PAIRS..PAIRS + DASHES.len() * NEXT_DASHES;
        let strokes: std::collections::BTreeSet<_> = pairs.chain(0..2 * THEORY).map(curve_stroke).collect();
        assert_eq!(strokes.len(), DASHES.len() * NEXT_DASHES + 2 * THEORY);
    }

    /// Whatever their numbers, no two curves of channels and runs have the same colour and dashes, as far as there are
    /// enough of both.
    #[test]
    fn no_two_channels_or_runs_look_the_same() {
        for (channels, runs) in [(1, 1), (2, 2), (2, 6), (2, 7), (6, 11), (11, 6), (12, 2), (2, 12)] {
            let names: Vec<_> = (0..channels).map(|k| format!("x_{k}")).collect();
            let label = |k: usize| format!("{}, run {}", names[k % channels], k / channels);
            let curves = (0..channels * runs).map(|k| Curve { label: label(k), ..Curve::default() }).collect();
            let figure = super::super::typeset(&Figure { channels: names.clone(), curves, ..Figure::default() });
            let looks = looks(&figure);
            let eye = |look: usize| {
                let pair = pair_dashes(look).map(|dashes| ((look - PAIRS) % NEXT_DASHES, dashes));
                pair.unwrap_or((NEXT_DASHES + look, 0))
            };
            let seen: std::collections::BTreeSet<_> = looks.iter().map(|look| eye(*look)).collect();
            assert_eq!(seen.len(), channels * runs, "{channels} channels of {runs} runs");
            let pairs = looks.iter().filter(|look| pair_dashes(**look).is_some()).count();
            assert!(pairs == looks.len() || channels.max(runs) > PALETTE.len(), "{channels} channels of {runs} runs");
        }
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
}
