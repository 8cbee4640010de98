//! The same picture in pixels: what plotters draws as SVG, filled and stroked by tiny-skia, with letters of DejaVu Sans.

#[cfg(test)]
mod tests;

use super::letters::Line;
use super::style::{self, CURVE_WIDTH, FINE};
use super::{Figure, Parts, typeset};
use plotters::style::RGBColor;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};
use std::collections::BTreeSet;
use std::convert::Infallible;
use tiny_skia::{
    Color, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform,
};

/// A picture in pixels.
pub struct Png {
    /// The file: four pixels for one of the SVG in each direction, at 384 an inch.
    pub bytes: Vec<u8>,
    /// Characters that the fonts here do not have; each is drawn as an empty box.
    pub missing: BTreeSet<char>,
}

/// The figure as [`super::svg`] draws it, as a PNG file.
pub fn png(figure: &Figure) -> Result<Png, String> {
    let cannot = |error: String| format!("cannot draw the figure '{}': {error}", figure.title);
    let figure = &typeset(figure);
    let parts = Parts::of(figure);
    let size = (style::WIDTH as u32, parts.height as u32);
    let mut missing = BTreeSet::new();
    let mut sheet = Sheet {
        pixels: Pixmap::new(size.0, size.1).ok_or_else(|| cannot("it has no height".into()))?,
        dashes: dashes(figure),
        missing: &mut missing,
    };
    let drawn = parts.draw(figure, &mut sheet);
    drawn.map_err(|error| cannot(error.to_string()))?;
    let bytes = encoded(&sheet.pixels).map_err(|error| cannot(error.to_string()))?;
    Ok(Png { bytes, missing })
}

fn encoded(pixels: &Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgb);
    // A browser's pixel is 1/96 inch.
    let per_metre = (96.0 * f64::from(FINE) / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    // White is drawn first: no pixel is transparent.
    let rgb: Vec<u8> =
        (pixels.pixels().iter()).flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
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

struct Sheet<'a> {
    pixels: Pixmap,
    dashes: Vec<((u8, u8, u8), Vec<f32>)>,
    missing: &'a mut BTreeSet<char>,
}

type Done = Result<(), DrawingErrorKind<Infallible>>;

fn paint(BackendColor { alpha, rgb }: BackendColor) -> Paint<'static> {
    let alpha = (255.0 * alpha).round() as u8;
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(rgb.0, rgb.1, rgb.2, alpha));
    paint
}

fn path(points: impl IntoIterator<Item = BackendCoord>) -> PathBuilder {
    let mut path = PathBuilder::new();
    for (x, y) in points {
        match path.is_empty() {
            true => path.move_to(x as f32, y as f32),
            false => path.line_to(x as f32, y as f32),
        }
    }
    path
}

impl Sheet<'_> {
    fn fill(&mut self, path: Option<Path>, color: BackendColor, place: Transform) -> Done {
        // A path without an extent has nothing to fill.
        if let Some(path) = path {
            (self.pixels).fill_path(&path, &paint(color), FillRule::Winding, place, None);
        }
        Ok(())
    }

    fn stroke<S: BackendStyle>(&mut self, path: Option<Path>, style: &S) -> Done {
        let color = style.color();
        let dashed = self.dashes.iter().find(|(rgb, _)| *rgb == color.rgb);
        let dashes = dashed.filter(|_| style.stroke_width() == CURVE_WIDTH);
        let stroke = Stroke {
            width: style.stroke_width() as f32,
            line_join: LineJoin::Round,
            dash: dashes.and_then(|(_, lengths)| StrokeDash::new(lengths.clone(), 0.0)),
            ..Stroke::default()
        };
        if let Some(path) = path {
            (self.pixels).stroke_path(&path, &paint(color), &stroke, Transform::identity(), None);
        }
        Ok(())
    }
}

impl DrawingBackend for &mut Sheet<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.pixels.width(), self.pixels.height())
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Done {
        let pixel = Rect::from_xywh(x as f32, y as f32, 1.0, 1.0);
        self.fill(pixel.map(PathBuilder::from_rect), color, Transform::identity())
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
        match fill {
            true => self.fill(outline, style.color(), Transform::identity()),
            false => self.stroke(outline, style),
        }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        points: I,
        style: &S,
    ) -> Done {
        self.stroke(path(points).finish(), style)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Done {
        let mut outline = path(corners);
        outline.close();
        self.fill(outline.finish(), style.color(), Transform::identity())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Done {
        let outline = PathBuilder::from_circle(x as f32, y as f32, radius as f32);
        match fill {
            true => self.fill(outline, style.color(), Transform::identity()),
            false => self.stroke(outline, style),
        }
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Done {
        let line = Line::of(text, matches!(style.style(), FontStyle::Bold));
        self.missing.extend(line.missing);
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
        let place =
            Transform::from_rotate_at(turn, x, y).pre_translate(x + along, y + down).pre_scale(size, -size);
        self.fill(line.outline.finish(), style.color(), place)
    }
}
