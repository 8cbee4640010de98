//! Pictures of curves and points as SVG: plain data in, a string out.
//!
//! Curves differ by colour (Okabe & Ito's palette, safe for the colour-blind) and by dashes, points by colour
//! and marker; the legend stands above the axes, where it covers no data.

mod axes;
mod axis;
mod legend;
mod style;

use crate::markup::unicode;
use crate::text::readable;
pub(crate) use axis::power_of_ten;
use plotters::prelude::*;
use serde::Serialize;
use std::error::Error;
use style::{AXES_HEIGHT, FINE, MARGIN, ROW, TITLE, WIDTH};

/// A curve with, perhaps, its 95 % band.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Abscissas.
    pub x: Vec<f64>,
    /// Ordinates; the curve is broken where one is not finite.
    pub y: Vec<f64>,
    /// Half the width of the 95 % band about it, drawn as a translucent area.
    pub half_band: Option<Vec<f64>>,
}

/// Single points with, perhaps, error bars.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Points {
    /// Their name in the legend.
    pub label: String,
    /// Abscissas.
    pub x: Vec<f64>,
    /// Ordinates; a point with one that is not finite is left out.
    pub y: Vec<f64>,
    /// Half the length of the horizontal error bars.
    pub x_error: Option<Vec<f64>>,
    /// Half the length of the vertical error bars.
    pub y_error: Option<Vec<f64>>,
}

/// A picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Figure {
    /// What is shown.
    pub title: String,
    /// The horizontal axis, with its unit.
    pub x_name: String,
    /// The vertical axis, with its unit; some 40 letters fit.
    pub y_name: String,
    /// Curves, drawn beneath the points.
    pub curves: Vec<Curve>,
    /// Points.
    pub points: Vec<Points>,
    /// A logarithmic horizontal axis; what is not positive has no place on it.
    pub x_log: bool,
    /// A logarithmic vertical axis.
    pub y_log: bool,
    /// What the horizontal axis covers at least; data beyond it widen it.
    pub x_span: Option<(f64, f64)>,
    /// What the vertical axis covers at least.
    pub y_span: Option<(f64, f64)>,
}

type Drawn = Result<(), Box<dyn Error>>;

/// The figure as an SVG document, which may also stand inside HTML. Texts are typeset: x_1 is x₁.
pub fn svg(figure: &Figure) -> Result<String, String> {
    let figure = &typeset(figure);
    let title = style::wrap(&figure.title, WIDTH - 2 * MARGIN, TITLE);
    let legend = legend::rows(figure);
    let head = MARGIN + (title.len() + legend.len()) as i32 * ROW;
    let height = head + AXES_HEIGHT;
    let mut drawing = String::new();
    let drawn: Drawn = (|| {
        let size = (WIDTH as u32, height as u32);
        let canvas = SVGBackend::with_string(&mut drawing, size).into_drawing_area();
        canvas.fill(&WHITE)?;
        for (row, line) in title.iter().enumerate() {
            let bold = style::bold(TITLE);
            canvas.draw(&Text::new(
                line.as_str(),
                (MARGIN, MARGIN + row as i32 * ROW),
                bold,
            ))?;
        }
        legend::draw(&canvas, &legend, MARGIN + title.len() as i32 * ROW)?;
        axes::draw(figure, &canvas.split_vertically(head).1)?;
        Ok(canvas.present()?)
    })();
    drawn.map_err(|error| format!("cannot draw the figure '{}': {error}", figure.title))?;
    Ok(finish(figure, &drawing, height))
}

/// As [`svg`], with the first curve in bold black and the others in grey.
pub fn svg_of_one(figure: &Figure) -> Result<String, String> {
    let drawn = svg(figure)?;
    let (own, grey) = (style::curve_stroke(0), "stroke=\"#9A9A9A\" stroke-width=\"4\"");
    let bold = format!("stroke=\"#000000\" stroke-width=\"{}\"", 3 * style::CURVE_WIDTH);
    let others = (1..figure.curves.len()).map(style::curve_stroke);
    Ok(others.fold(drawn.replace(&own, &bold), |drawn, stroke| {
        drawn.replace(&stroke, grey)
    }))
}

fn typeset(figure: &Figure) -> Figure {
    let mut figure = figure.clone();
    let curves = figure.curves.iter_mut().map(|curve| &mut curve.label);
    let points = figure.points.iter_mut().map(|points| &mut points.label);
    let texts = [&mut figure.title, &mut figure.x_name, &mut figure.y_name];
    for text in texts.into_iter().chain(curves).chain(points) {
        // XML has no place for some characters, not even escaped.
        *text = readable(&unicode(text)).into_owned();
    }
    figure
}

/// Sizes the document, names it for those who cannot see it, and adds what plotters lacks: dashes.
fn finish(figure: &Figure, drawing: &str, height: i32) -> String {
    let labels: Vec<_> = (figure.curves.iter().map(|c| c.label.as_str()))
        .chain(figure.points.iter().map(|p| p.label.as_str()))
        .collect();
    let open = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{}\" height=\"{}\" \
         viewBox=\"0 0 {WIDTH} {height}\">\n<title>{}</title>\n<desc>{}</desc>",
        WIDTH / FINE,
        height / FINE,
        escape(&figure.title),
        escape(&format!(
            "{} against {}: {}",
            figure.y_name,
            figure.x_name,
            labels.join(", ")
        )),
    );
    let body = drawing.split_once('>').map_or("", |(_, body)| body);
    let dashed = (0..figure.curves.len()).fold(body.to_string(), |body, index| {
        let stroke = style::curve_stroke(index);
        let dashes = style::dashes(index);
        body.replace(&stroke, &format!("{stroke} stroke-linejoin=\"round\"{dashes}"))
    });
    open + &dashed
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::xml::is_well_formed;

    fn wave(label: &str, phase: f64) -> Curve {
        let x: Vec<f64> = (0..=300).map(|k| 0.02 * f64::from(k)).collect();
        Curve {
            label: label.into(),
            y: x.iter()
                .map(|x| 0.5 + (-0.3 * x).exp() * (6.0 * x + phase).sin() / 3.0)
                .collect(),
            half_band: Some(vec![0.03; x.len()]),
            x,
        }
    }

    fn synthetic() -> Figure {
        Figure {
            title: "Synthetic: a < b & c, for a test of the drawing that has a title of more than one line"
                .into(),
            x_name: "t/T (periods)".into(),
            y_name: "mean axial projection X̄₁ (–)".into(),
            curves: vec![
                wave("n = 20 cm⁻³", 0.0),
                wave("n = 50 cm⁻³", 1.0),
                wave("free", 2.0),
            ],
            points: vec![Points {
                label: "synthetic points".into(),
                x: vec![0.5, 1.5, f64::NAN],
                y: vec![0.3, 0.6, 0.5],
                x_error: Some(vec![0.1, 0.1]),
                y_error: Some(vec![0.05, f64::NAN]),
            }],
            ..Default::default()
        }
    }

    #[test]
    fn a_figure_is_well_formed_and_names_everything() {
        let svg = svg(&synthetic()).unwrap();
        assert!(is_well_formed(&svg), "{svg}");
        for text in [
            "a &lt; b &amp; c",
            "t/T (periods)",
            "mean axial projection",
            "n = 20 cm⁻³",
            "synthetic points",
            "95 % band",
            "viewBox=",
            "role=\"img\"",
            "<desc>",
        ] {
            assert!(svg.contains(text), "no {text} in {svg}");
        }
        assert_eq!(
            svg.matches("<polygon").count(),
            3 + 2 + 1,
            "bands, points, legend"
        );
        assert_eq!(
            svg.matches("stroke-dasharray").count(),
            4,
            "two curves and their legends"
        );
    }

    #[test]
    fn odd_data_draw_what_can_be_drawn() {
        let odd = [
            vec![],
            vec![f64::NAN; 3],
            vec![f64::INFINITY, f64::NEG_INFINITY],
            vec![0.5],
            vec![0.5; 3],
            vec![0.0; 3],
            vec![1e308, -1e308],
            vec![5e-324, 0.0],
            vec![1.0, f64::NAN, 2.0, 3.0],
        ];
        for values in &odd {
            for log in [false, true] {
                for band in [None, Some(vec![f64::NAN]), Some(values.clone())] {
                    let curve = Curve {
                        x: values.clone(),
                        y: values.clone(),
                        half_band: band.clone(),
                        ..Default::default()
                    };
                    let points = Points {
                        x: values.clone(),
                        y: values.clone(),
                        x_error: band.clone(),
                        y_error: band,
                        ..Default::default()
                    };
                    let figure = Figure {
                        curves: vec![curve],
                        points: vec![points],
                        x_log: log,
                        y_log: log,
                        ..Default::default()
                    };
                    let svg = svg(&figure).unwrap();
                    assert!(
                        is_well_formed(&svg) && !svg.contains("NaN"),
                        "{values:?} {log}: {svg}"
                    );
                }
            }
        }
        assert!(svg(&Figure::default()).unwrap().contains("no data"));
    }

    #[test]
    fn a_power_law_is_straight_on_logarithmic_axes() {
        let x: Vec<f64> = (0..=4).map(|k| 10f64.powi(-k)).collect();
        let figure = Figure {
            curves: vec![Curve {
                y: x.iter().map(|x| 3.0 * x * x).collect(),
                x,
                ..Default::default()
            }],
            x_log: true,
            y_log: true,
            ..Default::default()
        };
        let svg = svg(&figure).unwrap();
        let path = svg.lines().find(|line| line.contains("stroke-linejoin")).unwrap();
        let path = path.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let points: Vec<Vec<f64>> = (path.split_whitespace())
            .map(|point| point.split(',').map(|v| v.parse().unwrap()).collect())
            .collect();
        assert_eq!(points.len(), 5);
        for w in points.windows(3) {
            let bend = |axis: usize| w[0][axis] - 2.0 * w[1][axis] + w[2][axis];
            assert!(bend(0).abs() <= 2.0 && bend(1).abs() <= 2.0, "{points:?}");
        }
    }

    #[test]
    fn an_axis_covers_what_it_is_asked_to() {
        let figure = Figure {
            y_span: Some((0.0, 1.0)),
            ..synthetic()
        };
        assert!(svg(&figure).unwrap().contains(">\n1.0\n<"));
    }
}
