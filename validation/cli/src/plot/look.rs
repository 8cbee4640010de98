//! How a picture looks: what the flags change in it.

use crate::{Failure, number, refuse};
use clap::builder::PossibleValuesParser;
use shearbed_validation::oracle::reference::big::finite;
use shearbed_validation::present::plot::{Figure, Theme};

/// Flags of a picture's look.
#[derive(clap::Args)]
pub(super) struct Look {
    /// The title, in place of the scene's
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// The name of the horizontal axis
    #[arg(long, value_name = "TEXT")]
    x_label: Option<String>,
    /// The name of the vertical axis
    #[arg(long, value_name = "TEXT")]
    y_label: Option<String>,
    /// A name in the legend; once for each curve, then for each set of points
    #[arg(long, value_name = "TEXT")]
    legend: Vec<String>,
    /// What the horizontal axis covers
    #[arg(long, value_name = "FROM:TO", value_parser = range, allow_hyphen_values = true)]
    x_range: Option<(f64, f64)>,
    /// What the vertical axis covers
    #[arg(long, value_name = "FROM:TO", value_parser = range, allow_hyphen_values = true)]
    y_range: Option<(f64, f64)>,
    /// Width and height in 1/96 inch, as 800x500
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Width in print, as 85 or 170, with letters of 8 points
    #[arg(long, value_name = "MM", value_parser = width_mm, conflicts_with = "size")]
    width_mm: Option<f64>,
    /// A logarithmic horizontal axis
    #[arg(long)]
    log_x: bool,
    /// A logarithmic vertical axis
    #[arg(long)]
    log_y: bool,
    /// Dark ink on white, or light ink on a dark ground
    #[arg(long, value_name = "THEME", default_value = "light",
        value_parser = PossibleValuesParser::new(["light", "dark"]))]
    theme: String,
}

fn range(text: &str) -> Result<(f64, f64), String> {
    let ends = text.split_once(':').and_then(|(from, to)| Some((finite(from)?, finite(to)?)));
    ends.filter(|(from, to)| from < to)
        .ok_or_else(|| "FROM:TO is allowed, two finite numbers of which the second is larger".to_owned())
}

/// The range of a side in pixels: the axes with letters of 16 pixels need the least, and a page is no larger than the
/// most.
const SIZES: std::ops::RangeInclusive<u32> = 240..=4000;

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let inside = sides.filter(|(width, height)| SIZES.contains(width) && SIZES.contains(height));
    inside.ok_or_else(|| format!("WIDTHxHEIGHT is allowed, as 800x500, each from {} to {}", SIZES.start(), SIZES.end()))
}

/// The range of a width in print: axes with letters of 8 points need the least, and a page is no wider than the most.
const WIDTHS: std::ops::RangeInclusive<f64> = 45.0..=420.0;

fn width_mm(text: &str) -> Result<f64, String> {
    number(text, |width| WIDTHS.contains(&width), &format!("a width from {} to {} mm", WIDTHS.start(), WIDTHS.end()))
}

/// The coordinates of all curves and points, along and up.
fn values(figure: &Figure) -> [Vec<f64>; 2] {
    let curves = figure.curves.iter().map(|curve| (&curve.x, &curve.y));
    let series = curves.chain(figure.points.iter().map(|points| (&points.x, &points.y)));
    let (x, y): (Vec<_>, Vec<_>) = series.unzip();
    [x, y].map(|all| all.into_iter().flatten().copied().collect())
}

/// Refuses a range that begins at or below 0 on a logarithmic axis, or that no curve and no point reaches.
fn check(flag: &str, range: Option<(f64, f64)>, log: bool, all: &[f64]) -> Result<(), Failure> {
    refuse(range.filter(|(from, _)| log && *from <= 0.0), |(from, to)| {
        format!("{flag} {from}:{to}: a logarithmic axis begins above 0; a positive FROM is allowed")
    })?;
    let finite = all.iter().copied().filter(|value| value.is_finite());
    let (least, most) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| (v.min(least), v.max(most)));
    refuse(range.filter(|(from, to)| least <= most && (*to < least || most < *from)), |(from, to)| {
        format!("{flag} {from}:{to}: nothing lies there; the picture goes from {least} to {most}")
    })
}

/// What a logarithmic axis leaves out.
fn left_out(flag: &str, log: bool, all: &[f64]) -> Option<String> {
    let count = all.iter().filter(|value| **value <= 0.0).count();
    (log && count > 0).then(|| format!("{flag}: values at or below 0 are not drawn: {count}"))
}

impl Look {
    /// Warnings about what the flags leave out of a figure.
    pub(super) fn warnings(&self, figure: &Figure) -> Vec<String> {
        let [x, y] = values(figure);
        let x = left_out("--log-x", self.log_x, &x);
        x.into_iter().chain(left_out("--log-y", self.log_y, &y)).collect()
    }

    /// Gives curves and points the names of --legend; `order` has the place among these of each, in order where it is
    /// empty.
    pub(super) fn name(&self, figure: &mut Figure, order: &[usize]) -> Result<(), Failure> {
        let (asked, there) = (self.legend.len(), figure.curves.len() + figure.points.len());
        let place = |k: usize| order.get(k).copied().unwrap_or(k);
        let mut own: Vec<_> = figure.labels().enumerate().map(|(k, label)| (place(k), label.as_str())).collect();
        own.sort_unstable();
        refuse((asked != 0 && asked != there).then_some(own), |own| {
            let own: Vec<_> = own.into_iter().map(|(_, label)| label).collect();
            format!(
                "--legend: given {asked} times; the picture has {there} curves and sets of points, for which as many \
                 are needed in this order: {}",
                own.join("; ")
            )
        })?;
        let name = |k: usize| self.legend[place(k)].clone();
        figure.legend = (0..asked).map(name).collect();
        Ok(())
    }

    /// Applies the flags to a figure.
    pub(super) fn apply(&self, figure: &mut Figure) -> Result<(), Failure> {
        let set = |text: &mut String, asked: &Option<String>| asked.iter().for_each(|asked| text.clone_from(asked));
        set(&mut figure.title, &self.title);
        set(&mut figure.x_name, &self.x_label);
        set(&mut figure.y_name, &self.y_label);
        if figure.grid.is_some() && (self.size.is_some() || self.x_range.is_some() || self.y_range.is_some()) {
            return Err(Failure::Input(
                "--size, --x-range, --y-range: this picture is a map, whose cells say how large it is; --title and \
                 --theme are allowed"
                    .into(),
            ));
        }
        figure.x_log |= self.log_x;
        figure.y_log |= self.log_y;
        figure.x_range = self.x_range.or(figure.x_range);
        figure.y_range = self.y_range.or(figure.y_range);
        let [x, y] = values(figure);
        check("--x-range", self.x_range, figure.x_log, &x)?;
        check("--y-range", self.y_range, figure.y_log, &y)?;
        figure.size = self.size.or(figure.size);
        figure.width_mm = self.width_mm.or(figure.width_mm);
        if self.theme == "dark" {
            figure.theme = Theme::Dark;
        }
        Ok(())
    }
}
