use super::super::boxes::{TextBox, boxes};
use super::super::style::{self, CURVE_WIDTH, FINE};
use super::super::tests::{fitted, many, maps, synthetic};
use super::super::{Curve, svg};
use super::*;
use crate::present::plot::style::looks;
use plotters::style::RGBColor;

/// Width, height and pixels of the file, as decoded.
fn read(bytes: &[u8]) -> (usize, usize, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(frame.color_type, png::ColorType::Rgb);
    let pixels = pixels[..frame.buffer_size()].as_chunks().0.to_vec();
    (frame.width as usize, frame.height as usize, pixels)
}

/// The share of a text's box that is covered by dark ink.
fn inked(text: &TextBox, width: usize, pixels: &[[u8; 3]]) -> f64 {
    let (columns, rows) = (text.left as usize..text.right as usize, text.top as usize..text.bottom as usize);
    let dark = rows.clone().flat_map(|row| columns.clone().map(move |column| row * width + column));
    let dark = dark.filter(|at| pixels.get(*at).is_some_and(|rgb| rgb.iter().all(|part| *part < 90)));
    dark.count() as f64 / (columns.len() * rows.len()) as f64
}

#[test]
fn a_png_shows_what_the_svg_does() {
    for figure in [synthetic(), many(), maps(), fitted()] {
        let drawing = svg(&figure).unwrap();
        let file = png(&figure).unwrap();
        assert!(file.missing.is_empty(), "{:?}", file.missing);
        let (width, height, pixels) = read(&file.bytes);
        assert!(drawing.contains(&format!("viewBox=\"0 0 {width} {height}\"")), "{width} {height}");
        for look in &looks(&figure)[..figure.curves.len()] {
            let RGBColor(red, green, blue) = style::colour(*look);
            let count = pixels.iter().filter(|rgb| **rgb == [red, green, blue]).count();
            // At least half of the sample beside its label is visible, where no other curve covers it.
            let least = 18 * FINE * CURVE_WIDTH as i32 / 2;
            assert!(count as i32 > least, "{}: {count} pixels of look {look}", figure.title);
        }
        // Where the SVG has a text there is ink, as much as of a text and not of a bar; a single minus has little.
        let mut texts = boxes(&drawing);
        texts.retain(|text| !text.text.is_empty());
        assert!(texts.len() > 10);
        for text in &texts {
            let part = inked(text, width, &pixels);
            assert!((0.02..0.5).contains(&part), "{text:?}: {part}");
        }
        // Control: paper without letters.
        let blank = vec![[255; 3]; width * height];
        assert!(texts.iter().all(|text| inked(text, width, &blank) == 0.0));
    }
}

/// Edges of ink that cross a band's are smoothed otherwise; a row in the wrong place would change more.
#[test]
fn a_picture_in_bands_is_the_whole_but_for_some_edges_of_ink() {
    for figure in [synthetic(), many()] {
        let [whole, bands] = [u32::MAX, 1 << 18].map(|at_once| read(&in_bands(&figure, at_once).unwrap().bytes));
        assert!(whole.0 * whole.1 > 8 << 18, "several bands");
        assert_eq!((whole.0, whole.1), (bands.0, bands.1));
        let differ = |rows: usize| {
            let pairs = whole.2[rows * whole.0..].iter().zip(&bands.2);
            1000 * pairs.filter(|(a, b)| a != b).count()
        };
        let [in_place, shifted] = [0, 1].map(differ);
        assert!(in_place < whole.2.len() && shifted > whole.2.len(), "{in_place} {shifted} of {}", whole.2.len());
    }
    let largest = Band::new(16_000, 16_000, 0, AT_ONCE).unwrap();
    assert!(largest.pixels.pixels().len() <= AT_ONCE as usize);
}

#[test]
fn letters_are_drawn_or_named() {
    let titled = |title: &str| Figure { title: title.into(), ..Figure::default() };
    let drawn = |title: &str| png(&titled(title)).unwrap();
    assert!(drawn("X̄₁ ≤ 3·10⁻⁶ cm⁻³").missing.is_empty());
    assert_eq!(drawn("стержни, 棒").missing.len(), 8);
    // Different letters give different pictures, whatever a font does about missing ones.
    assert_ne!(drawn("x1").bytes, drawn("x2").bytes);
    assert_ne!(drawn("X̄").bytes, drawn("X").bytes);
}

#[test]
fn a_dashed_curve_has_gaps() {
    let level = |label: &str, y: f64| Curve::of(label, [0.0, 1.0], |x| (x, y));
    let figure = Figure { curves: vec![level("whole", 0.2), level("dashed", 0.8)], ..Figure::default() };
    let (_, _, pixels) = read(&png(&figure).unwrap().bytes);
    let looks = looks(&figure);
    let [whole, dashed] = [looks[0], looks[1]].map(|look| {
        let RGBColor(red, green, blue) = style::colour(look);
        pixels.iter().filter(|rgb| **rgb == [red, green, blue]).count() as f64
    });
    // 32 of 46 are ink.
    assert!((0.6..0.8).contains(&(dashed / whole)), "{dashed} of {whole}");
}
