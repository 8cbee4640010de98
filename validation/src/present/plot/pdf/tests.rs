//! Tests the page and its paths as a reader finds them, unpacked by another crate than the one that packs them.

use super::super::boxes::boxes;
use super::super::letters::face;
use super::super::style::FINE;
use super::super::style::{CURVE_WIDTH, colour, looks};
use super::super::svg;
use super::super::tests::{fitted, many, maps, synthetic};
use super::*;
use plotters::style::RGBColor;

/// The file's header as text, and the operators of its page.
fn read(bytes: &[u8]) -> (String, String) {
    assert!(bytes.starts_with(b"%PDF-1.") && bytes.trim_ascii_end().ends_with(b"%%EOF"));
    let text = String::from_utf8_lossy(bytes).into_owned();
    let find = |what: &[u8]| bytes.windows(what.len()).position(|part| part == what).unwrap();
    let (from, to) = (find(b"stream\n") + 7, find(b"\nendstream"));
    let operators = miniz_oxide::inflate::decompress_to_vec_zlib(&bytes[from..to]).unwrap();
    (text, String::from_utf8(operators).unwrap())
}

/// The number of strokes with the colour of a look and a curve's width.
fn strokes(operators: &str, look: usize) -> usize {
    let RGBColor(red, green, blue) = colour(look);
    let mut wanted = Content::new();
    let [red, green, blue] = [red, green, blue].map(|part| f32::from(part) / 255.0);
    wanted.set_stroke_rgb(red, green, blue).set_line_width(CURVE_WIDTH as f32);
    let wanted = String::from_utf8(wanted.finish().to_vec()).unwrap();
    operators.matches(wanted.trim_end()).count()
}

#[test]
fn a_pdf_shows_what_the_svg_does() {
    let in_print = Figure { width_mm: Some(85.0), ..fitted() };
    for figure in [synthetic(), many(), maps(), in_print] {
        let drawing = svg(&figure).unwrap();
        let file = pdf(&figure).unwrap();
        assert!(file.missing.is_empty());
        let (text, operators) = read(&file.bytes);
        let page: Vec<f32> = (text.split("/MediaBox [").nth(1).unwrap().split(']').next().unwrap())
            .split_whitespace()
            .map(|number| number.parse().unwrap())
            .collect();
        // In print 85 mm are 1928 units.
        let points = if figure.width_mm.is_some() { 85.0 / 25.4 * 72.0 / 1928.0 } else { 0.75 / FINE as f32 };
        let (width, height) = (page[2] / points, page[3] / points);
        assert!(drawing.contains(&format!("viewBox=\"0 0 {} {}\"", width.round(), height.round())));
        for look in &looks(&figure)[..figure.curves.len()] {
            // The curve and its sample in the legend.
            assert!(strokes(&operators, *look) >= 2, "{}: look {look}", figure.title);
            let stripped: String =
                operators.lines().filter(|line| !line.ends_with(" RG")).map(|line| format!("{line}\n")).collect();
            // Control: a page without colours.
            assert_eq!(strokes(&stripped, *look), 0);
        }
        // Every path is painted, and no state is saved: nothing is left open.
        let count = |operator: &str| operators.lines().filter(|line| line.trim() == operator).count();
        let starts = operators.lines().filter(|line| line.ends_with(" m")).count();
        assert!(count("f") + count("S") > 20 && starts >= count("f") + count("S"));
        assert!(count("BT") > 10 && count("BT") == count("ET"));
    }
}

/// What shows a text's letters in a font, and the entries that say which letters these are.
fn shown(text: &str, bold: bool) -> Option<(String, Vec<String>)> {
    let glyph = |letter: char| Some((face(bold)?.glyph_index(letter)?.0, u32::from(letter)));
    let glyphs: Vec<_> = text.chars().map(glyph).collect::<Option<_>>()?;
    let mut content = Content::new();
    content.show(Str(&glyphs.iter().flat_map(|(glyph, _)| glyph.to_be_bytes()).collect::<Vec<_>>()));
    let entries = glyphs.iter().map(|(glyph, letter)| format!("<{glyph:04X}> <{letter:04X}>")).collect();
    Some((String::from_utf8_lossy(&content.finish()).trim().to_owned(), entries))
}

#[test]
fn texts_are_texts_whose_letters_the_file_says() {
    for figure in [synthetic(), many(), fitted()] {
        let (text, operators) = read(&pdf(&figure).unwrap().bytes);
        // A bar over a letter is shown by itself.
        let texts: Vec<_> = boxes(&svg(&figure).unwrap()).into_iter().map(|text| text.text).collect();
        let whole: Vec<_> = texts.iter().filter(|text| !text.is_empty() && !text.contains('\u{304}')).collect();
        assert!(whole.len() > 10);
        for whole in whole {
            let found = [false, true].into_iter().filter_map(|bold| shown(whole, bold));
            let found = found.filter(|(shows, _)| operators.contains(shows)).collect::<Vec<_>>();
            assert!(!found.is_empty(), "{whole} is not there");
            assert!(found.iter().any(|(_, entries)| entries.iter().all(|entry| text.contains(entry))), "{whole}");
        }
        // Control: a text that is not in the picture.
        let (shows, _) = shown("another text", false).unwrap();
        assert!(!operators.contains(&shows));
        // Both fonts, of some 50 kB, are in the file once, packed.
        assert_eq!(text.matches("/FontFile2").count(), 2);
    }
}

#[test]
fn a_pdf_names_letters_that_it_lacks_and_has_its_title() {
    let titled = |title: &str| pdf(&Figure { title: title.into(), ..Figure::default() }).unwrap();
    assert_eq!(titled("стержни").missing.len(), 7);
    let (text, _) = read(&titled("damped rods").bytes);
    assert!(text.contains("/Title (damped rods)"), "{text}");
    assert_ne!(titled("x1").bytes, titled("x2").bytes);
}

/// The letters' curves are quadratic; a page has only cubic curves.
#[test]
fn a_quadratic_curve_keeps_its_middle() {
    let mut path = tiny_skia::PathBuilder::new();
    path.move_to(0.0, 0.0);
    path.quad_to(3.0, 6.0, 6.0, 0.0);
    let mut page = Page::new([10, 10], 1.0);
    page.draw(&path.finish().unwrap());
    let drawn = String::from_utf8(page.content.finish().to_vec()).unwrap();
    let curve = drawn.lines().find(|line| line.ends_with(" c")).unwrap();
    let c: Vec<f32> = curve.trim_end_matches(" c").split(' ').map(|n| n.parse().unwrap()).collect();
    // At t = 1/2: a quarter of the ends and half of the middle point; an eighth of the ends and 3/8 of the two.
    let middle = (3.0 * c[0] + 3.0 * c[2] + c[4]) / 8.0;
    assert_eq!((middle, (3.0 * c[1] + 3.0 * c[3] + c[5]) / 8.0), (3.0, 3.0));
    // Control: using the single middle point for both gives another curve.
    assert_ne!((3.0 * 6.0 + 3.0 * 6.0) / 8.0, 3.0);
}
