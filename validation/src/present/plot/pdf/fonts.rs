//! The fonts of a PDF, with the letters that its numbers of glyphs stand for, so that a reader finds the text.

use super::super::letters::{FILES, Letter, face};
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Dict, Filter, Name, Pdf, Rect, Ref, Str};
use std::collections::BTreeMap;

/// Names of the plain and the bold font on the page, and of their files.
const NAMES: [&[u8]; 2] = [b"F0", b"F1"];
const FILE_NAMES: [&[u8]; 2] = [b"SHEARB+DejaVuSans", b"SHEARB+DejaVuSans-Bold"];

const SYSTEM: SystemInfo = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// The letters in use of the plain and the bold font, by the numbers of their glyphs.
#[derive(Default)]
pub(super) struct Fonts([BTreeMap<u16, char>; 2]);

impl Fonts {
    /// The font of a run of letters, of which there is at least one, and their codes.
    pub(super) fn codes(&mut self, run: &[Letter]) -> (&'static [u8], Vec<u8>) {
        let font = usize::from(run[0].glyph().1);
        self.0[font].extend(run.iter().map(|letter| (letter.glyph().0, letter.letter)));
        (NAMES[font], run.iter().flat_map(|letter| letter.glyph().0.to_be_bytes()).collect())
    }

    /// The fonts in use, each with the first of its five objects.
    fn used(&self) -> impl Iterator<Item = (usize, i32)> {
        [0, 1].into_iter().filter(|font| !self.0[*font].is_empty()).map(|font| (font, 10 + 5 * font as i32))
    }

    /// Lists the fonts in the page's resources.
    pub(super) fn list(&self, resources: &mut Dict) {
        for (font, first) in self.used() {
            resources.pair(Name(NAMES[font]), Ref::new(first));
        }
    }

    /// Writes the fonts in use into the file.
    pub(super) fn embed(&self, pdf: &mut Pdf) {
        for (font, first) in self.used() {
            let Some(face) = face(font == 1) else { continue };
            let [whole, glyphs, descriptor, file, letters] = [0, 1, 2, 3, 4].map(|k| Ref::new(first + k));
            let name = Name(FILE_NAMES[font]);
            // A PDF counts in thousandths of the letters' size.
            let parts = |units: i16| 1000.0 * f32::from(units) / f32::from(face.units_per_em());
            let advance = |glyph| parts(face.glyph_hor_advance(ttf_parser::GlyphId(glyph)).unwrap_or(0) as i16);
            (pdf.type0_font(whole).base_font(name).encoding_predefined(Name(b"Identity-H")))
                .descendant_font(glyphs)
                .to_unicode(letters);
            let mut cid = pdf.cid_font(glyphs);
            cid.subtype(CidFontType::Type2).base_font(name).system_info(SYSTEM).font_descriptor(descriptor);
            cid.cid_to_gid_map_predefined(Name(b"Identity"));
            cid.widths().consecutive(0, (0..face.number_of_glyphs()).map(advance));
            drop(cid);
            let extent = face.global_bounding_box();
            let [left, low, right, high] = [extent.x_min, extent.y_min, extent.x_max, extent.y_max].map(parts);
            (pdf.font_descriptor(descriptor).name(name).flags(FontFlags::SYMBOLIC))
                .bbox(Rect::new(left, low, right, high))
                .italic_angle(0.0)
                .ascent(parts(face.ascender()))
                .descent(parts(face.descender()))
                .cap_height(parts(face.capital_height().unwrap_or(face.ascender())))
                // Of DejaVu Sans' upright strokes, about.
                .stem_v(if font == 1 { 190.0 } else { 90.0 })
                .font_file2(file);
            let packed = miniz_oxide::deflate::compress_to_vec_zlib(FILES[font], 6);
            (pdf.stream(file, &packed).filter(Filter::FlateDecode)).pair(Name(b"Length1"), FILES[font].len() as i32);
            let mut map = UnicodeCmap::new(Name(b"Letters"), SYSTEM);
            self.0[font].iter().for_each(|(glyph, letter)| map.pair(*glyph, *letter));
            pdf.cmap(letters, &map.finish());
        }
    }
}
