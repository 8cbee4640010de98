//! The figure in pixels, drawn by tiny-skia.

#[cfg(test)]
mod tests;

use super::sheet::{self, Canvas};
use super::style::FINE;
use super::{Drawing, Figure};
use plotters_backend::BackendColor;
use tiny_skia::{Color, FillRule, LineJoin, Paint, Path, Pixmap, Stroke, StrokeDash, Transform};

/// The figure as [`super::svg`] draws it, as a PNG file with four pixels per SVG pixel in each direction, 384 an inch.
pub fn png(figure: &Figure) -> Result<Drawing, String> {
    let (pixels, missing) = sheet::draw(figure, Pixmap::new)?;
    let cannot = |error| format!("cannot draw the figure '{}': {error}", figure.title);
    Ok(Drawing { bytes: encoded(&pixels).map_err(cannot)?, missing })
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
    // White is drawn first, so no pixel is transparent.
    let rgb: Vec<u8> =
        (pixels.pixels().iter()).flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}

fn paint(BackendColor { alpha, rgb }: BackendColor) -> Paint<'static> {
    let alpha = (255.0 * alpha).round() as u8;
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(rgb.0, rgb.1, rgb.2, alpha));
    paint
}

impl Canvas for Pixmap {
    fn fill(&mut self, path: &Path, color: BackendColor) {
        self.fill_path(path, &paint(color), FillRule::Winding, Transform::identity(), None);
    }

    fn stroke(&mut self, path: &Path, color: BackendColor, width: f32, dashes: &[f32]) {
        let dash = (!dashes.is_empty()).then(|| StrokeDash::new(dashes.to_vec(), 0.0)).flatten();
        let stroke = Stroke { width, line_join: LineJoin::Round, dash, ..Stroke::default() };
        self.stroke_path(path, &paint(color), &stroke, Transform::identity(), None);
    }
}
