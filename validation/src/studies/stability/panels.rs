//! Panels of what was found, as a picture.

use super::map::{Cell, Found};
use crate::present::plot::{Figure, Grid, Map};
use crate::present::study::ReportFigure;

/// What was found of one subject, or at one aspect ratio: a row and a column for each cell.
pub(super) struct Panel {
    pub(super) title: String,
    pub(super) cells: Vec<Vec<Cell>>,
    pub(super) limit: Vec<(f64, f64)>,
}

/// A picture of panels with the same rows and columns.
pub(super) struct Panels<'a> {
    pub(super) words: [&'a str; 2],
    pub(super) caption: String,
    pub(super) axes: [&'a str; 2],
    pub(super) columns: Vec<String>,
    pub(super) values: Vec<String>,
    pub(super) rows: Vec<String>,
    pub(super) panels: Vec<Panel>,
}

impl Panels<'_> {
    pub(super) fn figure(self) -> ReportFigure {
        let [name, title] = self.words;
        let map = |panel: Panel| Map {
            title: panel.title,
            cells: (panel.cells.iter())
                .map(|row| row.iter().map(|cell| cell.found.class()).collect())
                .collect(),
            limit: panel.limit,
        };
        ReportFigure {
            name: name.into(),
            figure: Figure {
                title: title.into(),
                x_name: self.axes[0].into(),
                y_name: self.axes[1].into(),
                grid: Some(Grid {
                    classes: Found::CLASSES.map(String::from).into(),
                    columns: self.columns,
                    values: self.values,
                    rows: self.rows,
                    maps: self.panels.into_iter().map(map).collect(),
                    limit_name: "theory: the longest step without overtaking".into(),
                }),
                ..Default::default()
            },
            caption: self.caption,
            source: "A.1 to A.5".into(),
            cases: vec!["stability-map".into()],
        }
    }
}

impl Found {
    /// What a map tells apart.
    const CLASSES: [&'static str; 6] =
        ["right", "stable but wrong", "length lost", "not finite", "refused", "not run"];

    /// Its place among [`Self::CLASSES`].
    fn class(self) -> usize {
        match self {
            Self::RoundOff | Self::Accurate => 0,
            Self::Wrong => 1,
            Self::LengthLost => 2,
            Self::NotFinite => 3,
            Self::Refused => 4,
            Self::NotRun => 5,
        }
    }
}
