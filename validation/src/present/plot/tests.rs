//! Tests of pictures on made-up data.

mod figures;

use super::*;
use crate::present::xml::is_well_formed;
pub(super) use figures::{fitted, many, maps};

fn wave(label: &str, phase: f64) -> Curve {
    let x = (0..=300).map(|k| 0.02 * f64::from(k));
    Curve::with_band(label, x, |x| (x, 0.5 + (-0.3 * x).exp() * (6.0 * x + phase).sin() / 3.0, 0.03))
}

pub(super) fn synthetic() -> Figure {
    Figure {
        title: "Synthetic: a < b & c, for a test of the drawing that has a title of more than one line".into(),
        x_name: "t/T (periods)".into(),
        y_name: "mean axial projection X̄₁ (–)".into(),
        curves: vec![wave("n = 20 cm⁻³", 0.0), wave("n = 50 cm⁻³", 1.0), wave("free", 2.0)],
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
    assert_eq!(svg.matches("<polygon").count(), 3 + 2 + 1, "bands, points, legend");
    assert_eq!(svg.matches("stroke-dasharray").count(), 4, "two curves and their legends");
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
                let curve =
                    Curve { x: values.clone(), y: values.clone(), half_band: band.clone(), ..Default::default() };
                let points = Points {
                    x: values.clone(),
                    y: values.clone(),
                    x_error: band.clone(),
                    y_error: band,
                    ..Default::default()
                };
                let figure =
                    Figure { curves: vec![curve], points: vec![points], x_log: log, y_log: log, ..Default::default() };
                let svg = svg(&figure).unwrap();
                assert!(is_well_formed(&svg) && !svg.contains("NaN"), "{values:?} {log}: {svg}");
            }
        }
    }
    assert!(svg(&Figure::default()).unwrap().contains("no data"));
}

/// The numbers of an attribute at its places, as of x in texts or corners in polygons.
fn numbers_of<'a>(svg: &'a str, before: &'a str) -> impl Iterator<Item = f64> + 'a {
    svg.split(before).skip(1).map(|rest| rest.split(['"', ' ', ',']).next().unwrap().parse().unwrap())
}

#[test]
fn residuals_stand_below_their_points_in_their_colours() {
    let drawn = svg(&fitted()).unwrap();
    for name in 0..2 {
        let RGBColor(red, green, blue) = style::colour(name);
        // Three in each panel and one in the legend, at the same three places across.
        let markers = format!("<polygon opacity=\"1\" fill=\"#{red:02X}{green:02X}{blue:02X}\" points=\"");
        let across: Vec<f64> = numbers_of(&drawn, &markers).collect();
        assert_eq!(across.len(), 7, "{name}: {across:?}");
        let places: std::collections::BTreeSet<_> = across.iter().map(|x| *x as i32).collect();
        assert_eq!(places.len(), 4, "{across:?}");
    }
    // One name of the shared axis; residuals have labels on both sides of 0.
    assert_eq!(drawn.matches("t (s)").count(), 2, "axis and description");
    assert!(drawn.contains(">\n−0.01\n<") && drawn.contains(">\n0.01\n<") && drawn.contains("residual"));
    // Control: without the panel its points and its name are gone.
    // One entry for a curve and its points.
    let words: Vec<_> = drawn.lines().filter(|line| !line.starts_with('<')).collect();
    let legend = ["X̄₁", "X̄₂", "95 % band of the best fit; markers: measured ± u"];
    assert!(legend.iter().all(|label| words.contains(label)), "{words:?}");
    assert!(!words.iter().any(|word| word.contains("best fit") && *word != legend[2]));
    let alone = svg(&Figure { below: None, ..fitted() }).unwrap();
    assert!(!alone.contains("residual") && alone.matches("<polygon").count() < drawn.matches("<polygon").count());
}

#[test]
fn a_marker_on_the_frame_is_whole() {
    let point = Points::of("corner", [(0.0, 1.0)], |point| point);
    let ends = Some((0.0, 1.0));
    let figure = Figure { points: vec![point], x_range: ends, y_range: ends, ..Figure::default() };
    let drawn = svg(&figure).unwrap();
    assert!(!drawn.contains("clip"));
    let corners: Vec<&str> = drawn.split("points=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    let marker = corners.iter().filter(|points| points.split_whitespace().count() >= 16);
    let across = |points: &str| {
        let x = points.split_whitespace().map(|point| point.split(',').next().unwrap().parse::<i32>().unwrap());
        (x.clone().min().unwrap(), x.max().unwrap())
    };
    // The sample in the legend and the point, both as wide as a disc.
    let wide: Vec<_> = marker.map(|points| across(points)).map(|(from, to)| to - from).collect();
    assert_eq!(wide, [2 * (0.85 * f64::from(style::SMALL_MARKER + FINE)).round() as i32; 2], "{wide:?}");
}

#[test]
fn shades_go_from_dark_to_light_and_have_their_values() {
    let curve = |k: usize| Curve::of((10 * k).to_string(), [0.0, 1.0], |x| (x, x * k as f64));
    let shaded = |count: usize| Figure {
        title: "Synthetic: a sweep".into(),
        curves: (1..=count).map(curve).collect(),
        shaded_by: Some("n (cm⁻³)".into()),
        ..Figure::default()
    };
    let light = |k: usize| {
        let RGBColor(red, green, blue) = style::colour(k);
        0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
    };
    for count in [1, 2, 9, 300] {
        let figure = shaded(count);
        let looks = style::looks(&figure);
        // Parts of colours are whole numbers, rounded by up to a half.
        assert!(looks.windows(2).all(|pair| light(pair[0]) <= light(pair[1]) + 1.0), "{count}: {looks:?}");
        assert!(count < 2 || light(looks[count - 1]) > light(looks[0]) + 100.0);
        let drawn = svg(&figure).unwrap();
        assert!(is_well_formed(&drawn) && !drawn.contains("dasharray"), "{count}");
        assert!(drawn.contains(">\n10\n<") && drawn.contains("n (cm⁻³)"));
        assert!(boxes::faults(&drawn).is_empty(), "{count}: {:?}", boxes::faults(&drawn));
    }
    // An exact curve beside them is named in the legend, dashed and black.
    let mut figure = shaded(9);
    figure.curves.push(Curve { label: format!("X̄₁{REFERENCE}"), ..curve(5) });
    let drawn = svg(&figure).unwrap();
    assert!(drawn.contains("X̄₁, exact") && drawn.matches("dasharray").count() == 2, "{drawn}");
    // Control: without shades the curves are named one by one.
    let named = svg(&Figure { shaded_by: None, ..shaded(9) }).unwrap();
    assert!(named.contains("dasharray") && !named.contains("n (cm⁻³)"));
}

#[test]
fn a_width_in_print_has_letters_of_eight_points() {
    let size = |figure: &Figure| {
        let svg = svg(figure).unwrap();
        let view = numbers_of(&svg, "viewBox=\"0 0 ").next().unwrap();
        let letters = numbers_of(&svg, "font-size=\"").fold(0.0, crate::oracle::larger);
        let width = svg.split("width=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        (width, letters / view)
    };
    for mm in [45.0, 85.0, 170.0, 420.0] {
        let (width, letters) = size(&Figure { width_mm: Some(mm), title: String::new(), ..fitted() });
        assert_eq!(width, format!("{mm}mm"));
        let points = letters * mm / 25.4 * 72.0;
        // The view box has whole units, of which a letter has 64.
        assert!((points / 8.0 - 1.0).abs() < 0.01, "{mm}: {points}");
    }
    // Control: a width in pixels has letters of 12 points.
    let (width, letters) = size(&Figure { size: Some((321, 300)), title: String::new(), ..fitted() });
    assert!(width == "321" && (letters * 321.0 / 96.0 * 72.0 / 12.0 - 1.0).abs() < 0.01, "{width} {letters}");
}

#[test]
fn a_power_law_is_straight_on_logarithmic_axes() {
    let drawn = |log: bool| {
        let figure = Figure {
            curves: vec![Curve::of("", (0..=4).map(|k| 10f64.powi(-k)), |x| (x, 3.0 * x * x))],
            x_log: log,
            y_log: log,
            ..Default::default()
        };
        let svg = svg(&figure).unwrap();
        let path = svg.lines().find(|line| line.contains("stroke-linejoin")).unwrap();
        path.split("points=\"").nth(1).unwrap().split('"').next().unwrap().split_whitespace().count()
    };
    // Points on a straight line are left out but for its ends; the control: a parabola's are not.
    assert_eq!(drawn(true), 2);
    assert!(drawn(false) > 2);
}

#[test]
fn no_text_leaves_its_picture_or_overlaps_another() {
    let wide = |mm| Figure { width_mm: Some(mm), ..fitted() };
    for figure in [synthetic(), many(), maps(), fitted(), wide(85.0), wide(170.0), Figure::default()] {
        let svg = svg(&figure).unwrap();
        assert!(is_well_formed(&svg), "{svg}");
        let faults = boxes::faults(&svg);
        assert!(faults.is_empty(), "{}: {faults:#?}", figure.title);
    }
    // The label at the end of an axis is wide.
    for x in [[5e-3, 0.5], [2e5, 5e6]] {
        let curve = Curve { x: x.into(), y: vec![1.0, 2.0], ..Default::default() };
        for x_log in [true, false] {
            let figure = Figure { curves: vec![curve.clone()], x_log, ..Default::default() };
            let faults = boxes::faults(&svg(&figure).unwrap());
            assert!(faults.is_empty(), "{x:?}: {faults:#?}");
        }
    }
    // A long label goes on in further lines, also in a picture for a phone.
    let mut figure = Figure { size: Some((310, 380)), ..synthetic() };
    figure.points[0].label =
        "n = 50 cm⁻³, points of “A Paper of Two Authors, J. Synthetic Data 1 (1900) 1”, Fig. 4".into();
    let svg = svg(&figure).unwrap();
    assert!(svg.contains("\nFig. 4\n") && boxes::faults(&svg).is_empty(), "{svg}");
    // Extreme input: endless words, and more runs than fit.
    let long = |name: &str| format!("{name}{}", "unendliches".repeat(20));
    for count in [3, 30] {
        let mut figure = Figure {
            title: format!("{} {}", long("title"), "and more words ".repeat(60)),
            x_name: long("time"),
            y_name: long("mean"),
            ..synthetic()
        };
        figure.points.clear();
        figure.curves = (0..count).map(|k| wave(&long(&k.to_string()), 0.1 * f64::from(k))).collect();
        let faults = boxes::faults(&super::svg(&figure).unwrap());
        assert!(faults.is_empty(), "{count}: {faults:#?}");
    }
    // Controls: a text moved outside, and one moved onto another.
    let svg = super::svg(&many()).unwrap();
    let place = svg.split("<text x=\"").nth(1).unwrap().split('"').next().unwrap();
    let moved = |to: &str| svg.replacen(&format!("<text x=\"{place}\""), &format!("<text x=\"{to}\""), 1);
    assert!(boxes::faults(&moved("2200")).iter().any(|fault| fault.starts_with("outside")));
    let twice = format!("{svg}<text{}", svg.split("<text").nth(1).unwrap());
    assert!(boxes::faults(&twice).iter().any(|fault| fault.starts_with("overlap")));
}

#[test]
fn few_points_are_shown_and_theory_has_none() {
    let markers = |figure: &Figure| svg(figure).unwrap().matches("<polygon").count();
    let mut figure = many();
    // Each has three points and a sample in the legend.
    assert_eq!(markers(&figure), 7 * 4);
    figure.curves[0].label += ", theory";
    assert_eq!(markers(&figure), 6 * 4);
    figure.curves.truncate(2);
    figure.curves[1] = Curve { half_band: None, ..wave("many points", 0.0) };
    assert_eq!(markers(&figure), 0);
}

/// All pictures of the paper's figures, with the titles and names of the report.
#[test]
fn no_text_of_the_papers_figures_leaves_its_picture_or_overlaps_another() {
    let few = crate::studies::figures::Replicas { interacting: 2, free: 2 };
    let drawn = crate::studies::figures::draw(&crate::judge::case::Effort::gate(), few, &|| ()).unwrap().unwrap();
    let figures: Vec<_> = (drawn.exhibits.iter()).filter_map(|exhibit| exhibit.figure.as_ref()).collect();
    assert!(figures.len() > 8);
    for figure in figures {
        let faults = boxes::faults(&svg(&figure.figure).unwrap());
        assert!(faults.is_empty(), "{}: {faults:#?}", figure.name);
    }
}

#[test]
fn an_integrator_looks_the_same_in_every_picture() {
    let alone = Figure { curves: vec![many().curves[3].clone()], ..many() };
    assert_eq!(style::looks(&many())[3], style::looks(&alone)[0]);
    let theory = Figure {
        curves: vec![Curve { label: "explicit Euler in angles, theory".into(), ..Default::default() }],
        points: vec![Points { label: "explicit Euler in angles".into(), ..Default::default() }],
        ..Default::default()
    };
    let looks = style::looks(&theory);
    let hue = |look| {
        let plotters::style::RGBColor(red, green, _) = style::colour(look);
        (red, green)
    };
    assert_eq!(hue(looks[0]), hue(looks[1]));
    // Other curves get looks that are not used.
    let mixed = Figure { curves: vec![many().curves[0].clone(), wave("mine", 0.0)], ..Default::default() };
    assert_eq!(style::looks(&mixed), [0, 1]);
}

#[test]
fn an_axis_covers_what_it_is_asked_to() {
    let figure = Figure { y_span: Some((0.0, 1.0)), ..synthetic() };
    assert!(svg(&figure).unwrap().contains(">\n1.0\n<"));
}

#[test]
fn a_subscript_without_a_character_of_its_own_stands_below_the_line() {
    let curves = vec![wave("C_b < 1 of μ_fiber", 0.0)];
    let svg =
        svg(&Figure { title: "χ²_min\u{E000}".into(), y_name: "a_12".into(), curves, ..Figure::default() }).unwrap();
    let low = |letter: &str, dy: &str| format!("<tspan{dy} font-size=\"70%\">{letter}</tspan>");
    let down = " dy=\"0.229em\"";
    let fiber: String = "iber".chars().map(|letter| low(&letter.to_string(), "")).collect();
    let text = format!("C{}<tspan dy=\"-0.16em\"> &lt; 1 of μ</tspan>{}{fiber}\n", low("b", down), low("f", down));
    assert!(svg.contains(&text), "{svg}");
    assert!(svg.contains("a₁₂") && svg.contains("Cb &lt; 1 of μfiber") && is_well_formed(&svg));
    assert!(!svg.contains('\u{E000}') && boxes::faults(&svg).is_empty(), "{:?}", boxes::faults(&svg));
}
