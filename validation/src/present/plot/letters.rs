//! Letters of DejaVu Sans: the width of a text, its letters' places, and their outlines.

use std::sync::LazyLock;
use tiny_skia::{PathBuilder, Transform};
use ttf_parser::{Face, GlyphId, OutlineBuilder, Rect};

/// The fonts' files: plain and bold. They have only the letters of our pictures.
pub(super) const FILES: [&[u8]; 2] =
    [include_bytes!("../../../fonts/DejaVuSans.ttf"), include_bytes!("../../../fonts/DejaVuSans-Bold.ttf")];

/// A font, if its file can be read.
pub(super) fn face(bold: bool) -> Option<&'static Face<'static>> {
    static FACES: LazyLock<[Option<Face<'static>>; 2]> = LazyLock::new(|| FILES.map(|file| Face::parse(file, 0).ok()));
    FACES[usize::from(bold)].as_ref()
}

/// Before each letter of a subscript; a character of the private use area, which no font has.
pub(super) const LOW: char = '\u{E000}';

/// The size of a subscript's letters, and how far below the line they stand, in units of the letters' size.
pub(super) const LOW_SIZE: f32 = 0.7;
pub(super) const LOW_DROP: f32 = 0.16;

/// Width of a letter that the fonts lack: as wide as high, as the widest letters are.
const UNKNOWN: f64 = 1.0;

#[derive(Clone, Copy)]
struct Glyph {
    face: &'static Face<'static>,
    bold: bool,
    id: GlyphId,
}

impl Glyph {
    /// The glyph of a letter, plain if there is no bold one; `None` if the fonts lack it.
    fn of(letter: char, bold: bool) -> Option<Self> {
        [bold, !bold].into_iter().find_map(|bold| {
            let face = face(bold)?;
            face.glyph_index(letter).map(|id| Self { face, bold, id })
        })
    }

    /// A length in units of the letters' size.
    fn ems(self, units: f32) -> f32 {
        units / f32::from(self.face.units_per_em())
    }

    fn advance(self) -> f32 {
        self.ems(f32::from(self.face.glyph_hor_advance(self.id).unwrap_or(0)))
    }
}

/// True for combining marks, which are placed on the letter before.
fn is_mark(letter: char) -> bool {
    ('\u{300}'..'\u{370}').contains(&letter)
}

/// The width of a text in units of the letters' size.
pub(super) fn ems(text: &str, bold: bool) -> f64 {
    let width = |letter| Glyph::of(letter, bold).map_or(UNKNOWN, |glyph| f64::from(glyph.advance()));
    let (mut sum, mut size) = (0.0, 1.0);
    for letter in text.chars().filter(|letter| !is_mark(*letter)) {
        if letter == LOW {
            size = f64::from(LOW_SIZE);
            continue;
        }
        sum += size * width(letter);
        size = 1.0;
    }
    sum
}

/// A letter on its line: its place and size in units of the letters' size, with y upwards.
#[derive(Clone, Copy)]
pub(super) struct Letter {
    pub(super) letter: char,
    glyph: Glyph,
    pub(super) size: f32,
    pub(super) x: f32,
    pub(super) y: f32,
}

impl Letter {
    /// The number of its glyph, and true for that of the bold font.
    pub(super) fn glyph(&self) -> (u16, bool) {
        (self.glyph.id.0, self.glyph.bold)
    }

    /// True if this letter stands where the one before ends, on the same line and in the same font.
    pub(super) fn follows(&self, before: &Self) -> bool {
        let end = before.x + before.size * before.glyph.advance();
        (self.glyph.bold, self.size, self.y) == (before.glyph.bold, before.size, before.y)
            && (self.x - end).abs() < 1e-4
    }
}

/// A text's letters from (0, 0) on.
pub(super) struct Line {
    pub(super) letters: Vec<Letter>,
    /// The boxes that stand for letters that the fonts lack.
    pub(super) boxes: PathBuilder,
    pub(super) width: f32,
    /// Letters that the fonts lack.
    pub(super) missing: Vec<char>,
}

impl Line {
    pub(super) fn of(text: &str, bold: bool) -> Self {
        let mut line = Self { letters: Vec::new(), boxes: PathBuilder::new(), width: 0.0, missing: Vec::new() };
        let mut last: Option<(Glyph, f32)> = None;
        let mut low = false;
        for letter in text.chars() {
            if letter == LOW {
                low = true;
                continue;
            }
            let mut put = |glyph, size, x, y| line.letters.push(Letter { letter, glyph, size, x, y });
            match (Glyph::of(letter, bold), last) {
                (Some(mark), Some((base, at))) if is_mark(letter) => {
                    let (x, y) = above(base, mark);
                    put(mark, 1.0, at + x, y);
                }
                (Some(glyph), _) if std::mem::take(&mut low) => {
                    put(glyph, LOW_SIZE, line.width, -LOW_DROP);
                    last = None;
                    line.width += LOW_SIZE * glyph.advance();
                }
                (Some(glyph), _) => {
                    put(glyph, 1.0, line.width, 0.0);
                    last = Some((glyph, line.width));
                    line.width += glyph.advance();
                }
                (None, _) => {
                    line.missing.push(letter);
                    line.draw_box();
                    last = None;
                }
            }
        }
        line
    }

    /// The outlines of all letters and boxes.
    pub(super) fn outline(&self) -> PathBuilder {
        let mut outline = self.boxes.clone();
        for Letter { glyph, size, x, y, .. } in &self.letters {
            let scale = size * glyph.ems(1.0);
            let mut pen = Pen(PathBuilder::new());
            glyph.face.outline_glyph(glyph.id, &mut pen);
            let placed = Transform::from_row(scale, 0.0, 0.0, scale, *x, *y);
            // A letter without an outline, such as a blank, has no path.
            if let Some(path) = pen.0.finish().and_then(|path| path.transform(placed)) {
                outline.push_path(&path);
            }
        }
        outline
    }

    /// Draws an upright box whose inside is white, because the inner outline runs the other way.
    fn draw_box(&mut self) {
        let (left, right) = (self.width + 0.1, self.width + UNKNOWN as f32 - 0.1);
        let (thick, top) = (0.05, 0.7);
        let outer = [(left, 0.0), (right, 0.0), (right, top), (left, top)];
        let (l, r, b, t) = (left + thick, right - thick, thick, top - thick);
        for corners in [outer, [(l, b), (l, t), (r, t), (r, b)]] {
            self.boxes.move_to(corners[0].0, corners[0].1);
            for (x, y) in &corners[1..] {
                self.boxes.line_to(*x, *y);
            }
            self.boxes.close();
        }
        self.width += UNKNOWN as f32;
    }
}

/// The shift that puts a mark over the middle of a letter, without touching it.
fn above(letter: Glyph, mark: Glyph) -> (f32, f32) {
    let extent = |glyph: Glyph| glyph.face.glyph_bounding_box(glyph.id);
    let Some((below, over)) = extent(letter).zip(extent(mark)) else { return (0.0, 0.0) };
    let middle = |extent: Rect| 0.5 * (f32::from(extent.x_min) + f32::from(extent.x_max));
    let clear = letter.ems(f32::from(below.y_max)) + 0.05;
    let up = clear - mark.ems(f32::from(over.y_min));
    (letter.ems(middle(below)) - mark.ems(middle(over)), up.max(0.0))
}

/// Draws a glyph's outline in the units of its font.
struct Pen(PathBuilder);

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_those_of_the_font() {
        // From DejaVu Sans 2.37 by fontTools: advances in units of 1/2048 em.
        for (letter, plain, bold) in [('m', 1995.0, 2134.0), ('i', 569.0, 702.0), ('⁶', 821.0, 897.0)] {
            let text = letter.to_string();
            assert_eq!(ems(&text, false), plain / 2048.0, "{letter}");
            assert_eq!(ems(&text, true), bold / 2048.0, "{letter} bold");
        }
        assert_eq!(ems("X\u{304}", false), ems("X", false));
        assert_eq!(ems("棒", false), UNKNOWN);
        assert!((f64::from(Line::of("mi⁶ X̄", true).width) - ems("mi⁶ X̄", true)).abs() < 1e-5);
    }

    #[test]
    fn a_subscript_is_small_and_low() {
        let low = |text: &str| text.replace('_', &LOW.to_string());
        assert!((ems(&low("C_b"), false) - ems("C", false) - 0.7 * ems("b", false)).abs() < 1e-6);
        assert!((f64::from(Line::of(&low("C_bX"), false).width) - ems(&low("C_bX"), false)).abs() < 1e-5);
        let bounds = |text: &str| Line::of(text, false).outline().finish().unwrap().bounds();
        let (alone, below) = (bounds("b"), bounds(&low("_b")));
        assert!(below.top() < alone.top() - 0.1 && below.height() < 0.75 * alone.height(), "{alone:?} {below:?}");
        assert!(Line::of(&low("C_b"), false).missing.is_empty());
    }

    #[test]
    fn a_mark_stands_over_its_letter_and_clear_of_it() {
        let height = |text: &str| Line::of(text, false).outline().finish().unwrap().bounds();
        let (bare, barred) = (height("X"), height("X\u{304}"));
        assert!(barred.bottom() > bare.bottom() + 0.1, "{bare:?} {barred:?}");
        assert_eq!((bare.left(), bare.right()), (barred.left(), barred.right()));
    }

    #[test]
    fn all_letters_of_our_pictures_are_there() {
        const OURS: &str = "X̄₁₂₃ ≤ 3·10⁻⁶ cm⁻³, ⟨pp⟩, Δt → 0, pᵢ pⱼ, “Ærøå” – ⅓ Λθφαβχ²∞±×−–ṗ≈≥√∂";
        for bold in [false, true] {
            assert!(Line::of(OURS, bold).missing.is_empty());
        }
        assert_eq!(Line::of("стержни, 棒", false).missing.len(), 8);
    }
}
