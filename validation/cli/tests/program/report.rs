//! A real report, with the figures of a few replicas, as its reader gets it.

use crate::common::folder;
use shearbed_validation::cases;
use shearbed_validation::cases::catalogue;
use shearbed_validation::files::output::ResultFolder;
use shearbed_validation::judge::case::Effort;
use shearbed_validation::present::report::{self, Report, ReportStudy, Sections};
use shearbed_validation::studies::figures::{self, Replicas};
use std::sync::LazyLock;

/// Names of cases that are quick, of which some are cited by figures.
const CHOSEN: [&str; 3] = ["jeffery-period", "planar-projections", "free-half-period"];

static REPORT: LazyLock<Report> = LazyLock::new(|| {
    let effort: Effort = Effort::gate();
    let few = Replicas { interacting: 12, free: 6 };
    let finished = std::sync::atomic::AtomicU64::new(0);
    let count = || {
        finished.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let drawn = figures::draw(&effort, few, &count).unwrap().unwrap();
    assert_eq!(finished.into_inner(), figures::work(few).unwrap());
    let chosen = cases::all().into_iter().filter(|case| CHOSEN.contains(&case.about.name));
    let mut sections = Sections { equations: catalogue::equations(), ..Default::default() };
    sections.add(ReportStudy::new(&figures::STUDY, drawn, 0.0));
    catalogue::name_judges(&mut sections);
    let outcomes = chosen.map(|case| case.run(&effort)).collect();
    report::build(outcomes, sections, &effort, "shearbed validate".into())
});

/// `plot` draws a picture of a report's folder, and says which there are.
#[test]
fn a_picture_of_a_report_is_drawn_again() {
    let dir = folder();
    let folder = ResultFolder::new(&dir.at("report"), "validate", serde_json::json!({}), false);
    folder.write(&[("report.json".into(), REPORT.json())]).unwrap();
    dir.runs("plot report --y fig11 --out f.svg --title Mine");
    let svg = dir.read("f.svg");
    assert!(svg.contains("Mine") && svg.contains("aspect ratio"), "{svg}");
    dir.refuses("plot report --y fig13 --out g.svg", "has no such picture; there are fig4-differences, fig4, fig5");
    dir.runs("validate --case jeffery-period --quiet --out one");
    dir.refuses("plot one --out g.svg", "one: has no picture");
}

#[test]
fn a_real_report_is_whole() {
    let report = &*REPORT;
    let html = report.html().unwrap();

    // Anchors are unique, and every link leads to one.
    let anchors: Vec<&str> = quoted(&html, " id=\"");
    for anchor in &anchors {
        assert_eq!(anchors.iter().filter(|other| *other == anchor).count(), 1, "{anchor}");
    }
    let links = quoted(&html, "href=\"");
    let files = report.data().unwrap();
    for link in &links {
        let known = match link.strip_prefix('#') {
            Some(anchor) => anchors.contains(&anchor),
            None => files.iter().any(|(name, _)| name == link),
        };
        assert!(known, "{link}");
    }
    for load in ["<script ", "<link", "<img", "src=", "@import", "url("] {
        assert!(!html.contains(load), "{load}");
    }

    // From row to figure and equation, and back.
    for (link, least) in [
        ("#figure-fig12", 2),
        ("#case-planar-projections", 3),
        ("#equation-21", 2),
        ("#equation-15", 2),
        ("#case-jeffery-period", 3),
    ] {
        let found = links.iter().filter(|other| **other == link).count();
        assert!(found >= least, "{found} links to {link}");
    }
    for figure in 4..=12 {
        let start = format!("figure-fig{figure}");
        assert!(anchors.iter().any(|anchor| anchor.starts_with(&start)), "{start}");
    }
    assert!(html.contains(&report.alarms()));
    assert!(html.contains("keep") && html.contains("drop neighbours"), "plans");
    assert!(report.markdown().contains("| A.13 |"));
}

#[test]
fn every_figure_has_its_numbers() {
    let report = &*REPORT;
    let figures: Vec<_> = report.sections.figures().collect();
    let data = report.data().unwrap();
    assert_eq!(data.len(), 2 * figures.len(), "each has a table beside it");
    for ((name, csv), figure) in data.iter().zip(&figures) {
        assert_eq!(*name, format!("curves/{}.csv", figure.name));
        let picture = &figure.figure;
        // An amplitude has a point for each maximum beyond noise.
        let least = if picture.y_name.contains("A₁") { 4 } else { 20 };
        assert!(csv.lines().count() > least && !csv.contains("NaN"), "{name}");
        assert!(!picture.title.is_empty() && !figure.caption.is_empty(), "{name}");
        assert!(picture.x_name.ends_with(')') && picture.y_name.ends_with(')'), "{name}: units");
        for case in &figure.cases {
            assert!(cases::all().iter().any(|known| known.about.name == case), "{case}");
        }
    }
    // Free rods of one size keep their amplitude, and it is about 1/2.
    let fig9 = figures.iter().find(|figure| figure.name == "fig9").unwrap();
    let amplitude = &fig9.figure.curves[0].y;
    assert!(amplitude.len() == 12 && amplitude.iter().all(|a| (a - 0.48).abs() < 0.02), "{amplitude:?}");
}

/// What stands between `before` and the next quote, everywhere.
fn quoted<'a>(html: &'a str, before: &str) -> Vec<&'a str> {
    let parts = html.split(before).skip(1);
    parts.filter_map(|part| part.split('"').next()).collect()
}
