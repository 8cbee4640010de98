//! The figure in pixels, drawn by tiny-skia.

#[cfg(test)]
mod tests;

use super::sheet::{self, Canvas};
use super::{Drawing, Figure, inches};
use plotters_backend::BackendColor;
use std::io::Write;
use tiny_skia::{Color, FillRule, LineJoin, Paint, Path, Pixmap, Stroke, StrokeDash, Transform};

/// The most pixels that are drawn at a time: a larger picture is drawn in bands.
const AT_ONCE: u32 = 1 << 24;

/// The figure as [`super::svg`] draws it, as a PNG file with a pixel for each unit of the SVG's view box: 384 an inch,
/// or 576 where the width in print is given.
pub fn png(figure: &Figure) -> Result<Drawing, String> {
    in_bands(figure, AT_ONCE)
}

fn in_bands(figure: &Figure, at_once: u32) -> Result<Drawing, String> {
    let cannot = |error: png::EncodingError| format!("cannot draw the figure '{}': {error}", figure.title);
    let band = |top| sheet::draw(figure, |width, height| Band::new(width, height, top, at_once));
    let (mut band_of_rows, missing) = band(0)?;
    let (width, height) = (band_of_rows.pixels.width(), band_of_rows.height);
    let mut bytes = Vec::new();
    let inches = inches(figure, f64::from(width));
    let mut writer = header(&mut bytes, [width, height], inches).map_err(cannot)?;
    let mut rows = writer.stream_writer().map_err(cannot)?;
    loop {
        let mut rgb = vec![0; 3 * width as usize];
        for row in band_of_rows.pixels.data().chunks(4 * width as usize) {
            // White is drawn first, so no pixel is transparent.
            for (rgb, pixel) in rgb.chunks_exact_mut(3).zip(row.chunks_exact(4)) {
                rgb.copy_from_slice(&pixel[..3]);
            }
            rows.write_all(&rgb).map_err(|error| cannot(error.into()))?;
        }
        let top = band_of_rows.top + band_of_rows.pixels.height();
        if top >= height {
            break;
        }
        band_of_rows = band(top)?.0;
    }
    rows.finish().map_err(cannot)?;
    writer.finish().map_err(cannot)?;
    Ok(Drawing { bytes, missing })
}

/// The file's head; a pixel has so many `inches`.
fn header(
    bytes: &mut Vec<u8>,
    [width, height]: [u32; 2],
    inches: f64,
) -> Result<png::Writer<&mut Vec<u8>>, png::EncodingError> {
    let mut encoder = png::Encoder::new(bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let per_metre = (1.0 / (inches * 0.0254)).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter }));
    encoder.write_header()
}

/// Rows of a picture from `top` on.
struct Band {
    pixels: Pixmap,
    top: u32,
    /// Of the whole picture.
    height: u32,
}

impl Band {
    fn new(width: u32, height: u32, top: u32, at_once: u32) -> Option<Self> {
        let rows = (at_once / width.max(1)).clamp(1, height.saturating_sub(top).max(1));
        Some(Self { pixels: Pixmap::new(width, rows)?, top, height })
    }

    fn place(&self) -> Transform {
        Transform::from_translate(0.0, -(self.top as f32))
    }
}

fn paint(BackendColor { alpha, rgb }: BackendColor) -> Paint<'static> {
    let alpha = (255.0 * alpha).round() as u8;
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(rgb.0, rgb.1, rgb.2, alpha));
    paint
}

impl Canvas for Band {
    fn fill(&mut self, path: &Path, color: BackendColor) {
        self.pixels.fill_path(path, &paint(color), FillRule::Winding, self.place(), None);
    }

    fn stroke(&mut self, path: &Path, color: BackendColor, width: f32, dashes: &[f32]) {
        let dash = (!dashes.is_empty()).then(|| StrokeDash::new(dashes.to_vec(), 0.0)).flatten();
        let stroke = Stroke { width, line_join: LineJoin::Round, dash, ..Stroke::default() };
        self.pixels.stroke_path(path, &paint(color), &stroke, self.place(), None);
    }
}
