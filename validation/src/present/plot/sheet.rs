//! Draws what plotters would write as SVG as paths on another canvas, and letters of DejaVu Sans.

use super::letters::Line;
use super::style::{self, CURVE_WIDTH};
use super::theme::Theme;
use super::{Figure, Parts, typeset};
use plotters::style::RGBColor;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};
use std::collections::BTreeSet;
use std::convert::Infallible;
use tiny_skia::{Path, PathBuilder, Rect, Transform};

/// A canvas that fills and strokes paths in the units of the view box, with y downwards.
pub(super) trait Canvas {
    fn fill(&mut self, path: &Path, color: BackendColor);
    /// Strokes with round joins; `dashes` are the lengths of dashes and gaps, if any.
    fn stroke(&mut self, path: &Path, color: BackendColor, width: f32, dashes: &[f32]);
    /// Writes a line of text; its letters are outlines where a canvas has no fonts.
    fn write(&mut self, line: &Line, place: Transform, color: BackendColor) {
        if let Some(outline) = line.outline().finish().and_then(|outline| outline.transform(place)) {
            self.fill(&outline, color);
        }
    }
}

/// Draws a figure on the canvas that `make` returns for a width and a height. Returns the characters that the fonts
/// lack, which are drawn as empty boxes.
pub(super) fn draw<C: Canvas>(
    figure: &Figure,
    make: impl FnOnce(u32, u32) -> Option<C>,
) -> Result<(C, BTreeSet<char>), String> {
    let cannot = |error: String| format!("cannot draw the figure '{}': {error}", figure.title);
    let figure = &typeset(figure);
    let parts = Parts::of(figure);
    let size = (parts.width as u32, parts.height as u32);
    let canvas = make(size.0, size.1).ok_or_else(|| cannot("it has no height".into()))?;
    let mut sheet = Sheet { canvas, size, dashes: dashes(figure), theme: figure.theme, missing: BTreeSet::new() };
    parts.draw(figure, &mut sheet).map_err(|error| cannot(error.to_string()))?;
    Ok((sheet.canvas, sheet.missing))
}

/// The colours of dashed curves, with their dashes and gaps.
fn dashes(figure: &Figure) -> Vec<((u8, u8, u8), Vec<f32>)> {
    let looks = style::looks(figure);
    let dashed = looks[..figure.curves.len()].iter().map(|look| {
        let RGBColor(red, green, blue) = style::colour(*look);
        let lengths = style::dash_lengths(*look).split(' ');
        ((red, green, blue), lengths.flat_map(str::parse).collect())
    });
    dashed.collect()
}

struct Sheet<C> {
    canvas: C,
    size: (u32, u32),
    dashes: Vec<((u8, u8, u8), Vec<f32>)>,
    theme: Theme,
    missing: BTreeSet<char>,
}

type Done = Result<(), DrawingErrorKind<Infallible>>;

fn path(points: impl IntoIterator<Item = BackendCoord>) -> PathBuilder {
    let mut path = PathBuilder::new();
    for (x, y) in points {
        if path.is_empty() { path.move_to(x as f32, y as f32) } else { path.line_to(x as f32, y as f32) }
    }
    path
}

impl<C: Canvas> Sheet<C> {
    fn fill(&mut self, path: Option<Path>, color: BackendColor) -> Done {
        // A path without area has nothing to fill.
        if let Some(path) = path {
            self.canvas.fill(&path, self.theme.of(color));
        }
        Ok(())
    }

    fn stroke<S: BackendStyle>(&mut self, path: Option<Path>, style: &S) -> Done {
        let color = style.color();
        let dashed = self.dashes.iter().find(|(rgb, _)| *rgb == color.rgb);
        let dashes = dashed.filter(|_| style.stroke_width() == CURVE_WIDTH);
        let dashes = dashes.map_or(&[][..], |(_, lengths)| lengths);
        if let Some(path) = path {
            (self.canvas).stroke(&path, self.theme.of(color), style.stroke_width() as f32, dashes);
        }
        Ok(())
    }
}

impl<C: Canvas> DrawingBackend for &mut Sheet<C> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Done {
        let pixel = Rect::from_xywh(x as f32, y as f32, 1.0, 1.0);
        self.fill(pixel.map(PathBuilder::from_rect), color)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Done {
        self.stroke(path([from, to]).finish(), style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Done {
        let outline = Rect::from_ltrb(left as f32, top as f32, right as f32, bottom as f32);
        let outline = outline.map(PathBuilder::from_rect);
        if fill { self.fill(outline, style.color()) } else { self.stroke(outline, style) }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, points: I, style: &S) -> Done {
        self.stroke(path(points).finish(), style)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, corners: I, style: &S) -> Done {
        let mut outline = path(corners);
        outline.close();
        self.fill(outline.finish(), style.color())
    }

    fn draw_circle<S: BackendStyle>(&mut self, (x, y): BackendCoord, radius: u32, style: &S, fill: bool) -> Done {
        let outline = PathBuilder::from_circle(x as f32, y as f32, radius as f32);
        if fill { self.fill(outline, style.color()) } else { self.stroke(outline, style) }
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Done {
        let line = Line::of(text, matches!(style.style(), FontStyle::Bold));
        self.missing.extend(&line.missing);
        // As in the SVG: plotters divides by 1.24, and an ex is 0.55 of an em.
        let size = style.size() as f32 / 1.24;
        let along = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -0.5 * size * line.width,
            HPos::Right => -size * line.width,
        };
        let down = size
            * match style.anchor().v_pos {
                VPos::Top => 0.76,
                VPos::Center => 0.27,
                VPos::Bottom => -0.27,
            };
        let turn = match style.transform() {
            FontTransform::None => 0.0,
            FontTransform::Rotate90 => 90.0,
            FontTransform::Rotate180 => 180.0,
            FontTransform::Rotate270 => 270.0,
        };
        let (x, y) = (x as f32, y as f32);
        let place = Transform::from_rotate_at(turn, x, y).pre_translate(x + along, y + down).pre_scale(size, -size);
        self.canvas.write(&line, place, self.theme.of(style.color()));
        Ok(())
    }
}
