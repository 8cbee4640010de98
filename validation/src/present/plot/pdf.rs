//! The figure on a page of a PDF: paths, and letters as text in the fonts that the file brings with it.

mod fonts;

#[cfg(test)]
mod tests;

use super::letters::Line;
use super::sheet::{self, Canvas};
use super::{Drawing, Figure, inches};
use fonts::Fonts;
use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use plotters_backend::BackendColor;
use std::collections::BTreeSet;
use tiny_skia::PathSegment::{Close, CubicTo, LineTo, MoveTo, QuadTo};
use tiny_skia::{Path, Point, Transform};

/// The figure as a PDF page of its size.
pub fn pdf(figure: &Figure) -> Result<Drawing, String> {
    let points = |width| (72.0 * inches(figure, f64::from(width))) as f32;
    let (page, missing) = sheet::draw(figure, |width, height| Some(Page::new([width, height], points(width))))?;
    Ok(Drawing { bytes: page.file(&figure.title), missing })
}

struct Page {
    size: [f32; 2],
    content: Content,
    /// Opacities in use, in 255ths.
    opacities: BTreeSet<u8>,
    fonts: Fonts,
}

impl Page {
    /// A page of so many units, each of so many points.
    fn new(sides: [u32; 2], points: f32) -> Self {
        let size = sides.map(|side| side as f32 * points);
        let mut content = Content::new();
        // y points down in pictures, up on pages.
        content.transform([points, 0.0, 0.0, -points, 0.0, size[1]]);
        content.set_line_join(LineJoinStyle::RoundJoin);
        Self { size, content, opacities: BTreeSet::new(), fonts: Fonts::default() }
    }

    fn draw(&mut self, path: &Path) {
        // Curves in a PDF are cubic: both their middle points are two thirds of the way to a quadratic curve's middle
        // point.
        let towards = |a: Point, b: Point| (a.x + (b.x - a.x) * 2.0 / 3.0, a.y + (b.y - a.y) * 2.0 / 3.0);
        let content = &mut self.content;
        let mut last = Point::zero();
        for segment in path.segments() {
            match segment {
                MoveTo(to) => content.move_to(to.x, to.y),
                LineTo(to) => content.line_to(to.x, to.y),
                QuadTo(by, to) => {
                    let (first, second) = (towards(last, by), towards(to, by));
                    content.cubic_to(first.0, first.1, second.0, second.1, to.x, to.y)
                }
                CubicTo(first, second, to) => content.cubic_to(first.x, first.y, second.x, second.y, to.x, to.y),
                Close => content.close_path(),
            };
            last = match segment {
                MoveTo(to) | LineTo(to) | QuadTo(_, to) | CubicTo(_, _, to) => to,
                Close => last,
            };
        }
    }

    fn set(&mut self, BackendColor { alpha, rgb: (red, green, blue) }: BackendColor) {
        let opacity = (255.0 * alpha).round() as u8;
        self.opacities.insert(opacity);
        self.content.set_parameters(Name(name(opacity).as_bytes()));
        let [red, green, blue] = [red, green, blue].map(|part| f32::from(part) / 255.0);
        self.content.set_fill_rgb(red, green, blue).set_stroke_rgb(red, green, blue);
    }

    fn file(self, title: &str) -> Vec<u8> {
        let [catalog, pages, page, content, info] = [1, 2, 3, 4, 5].map(Ref::new);
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.document_info(info).title(TextStr(title));
        pdf.pages(pages).kids([page]).count(1);
        let mut sheet = pdf.page(page);
        sheet.parent(pages).contents(content).media_box(Rect::new(0.0, 0.0, self.size[0], self.size[1]));
        let mut resources = sheet.resources();
        let mut states = resources.ext_g_states();
        for opacity in &self.opacities {
            let share = f32::from(*opacity) / 255.0;
            (states.insert(Name(name(*opacity).as_bytes())).start::<pdf_writer::writers::ExtGraphicsState>())
                .non_stroking_alpha(share)
                .stroking_alpha(share);
        }
        states.finish();
        self.fonts.list(&mut resources.fonts());
        resources.finish();
        sheet.finish();
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(&self.content.finish(), 6);
        pdf.stream(content, &packed).filter(Filter::FlateDecode);
        self.fonts.embed(&mut pdf);
        pdf.finish()
    }
}

/// The name of an opacity on the page.
fn name(opacity: u8) -> String {
    format!("a{opacity}")
}

impl Canvas for Page {
    fn fill(&mut self, path: &Path, color: BackendColor) {
        self.set(color);
        self.draw(path);
        self.content.fill_nonzero();
    }

    fn stroke(&mut self, path: &Path, color: BackendColor, width: f32, dashes: &[f32]) {
        self.set(color);
        self.content.set_line_width(width).set_dash_pattern(dashes.iter().copied(), 0.0);
        self.draw(path);
        self.content.stroke();
    }

    fn write(&mut self, line: &Line, place: Transform, color: BackendColor) {
        if let Some(boxes) = line.boxes.clone().finish().and_then(|boxes| boxes.transform(place)) {
            self.fill(&boxes, color);
        }
        self.set(color);
        self.content.begin_text();
        for run in line.letters.chunk_by(|before, letter| letter.follows(before)) {
            let first = run[0];
            let at = place.pre_translate(first.x, first.y).pre_scale(first.size, first.size);
            self.content.set_text_matrix([at.sx, at.ky, at.kx, at.sy, at.tx, at.ty]);
            let (name, codes) = self.fonts.codes(run);
            self.content.set_font(Name(name), 1.0).show(Str(&codes));
        }
        self.content.end_text();
    }
}
