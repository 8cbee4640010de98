//! `shearbed shape`.

use super::{Failure, number, print};
use shearbed::model::shape::{ALLOWED, Correlation, FORMULAS, spread};

/// Arguments of `shape`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed shape --physical 20")]
pub(super) struct Args {
    /// Length over diameter of a cylinder, from 2 to 1000
    #[arg(long, value_name = "R", value_parser = ratio, allow_negative_numbers = true)]
    physical: f64,
}

fn ratio(text: &str) -> Result<f64, String> {
    let (least, most) = ALLOWED;
    number(text, |r| (least..=most).contains(&r), &format!("a number from {least} to {most}"))
}

/// Prints the equivalent aspect ratio of a cylinder by every formula.
pub(super) fn shape(args: &Args) -> Result<(), Failure> {
    let r = args.physical;
    let mut text = match spread(r) {
        Some((least, most)) => {
            let percent = 200.0 * (most - least) / (most + least);
            format!("a cylinder of r = {r}: r_e from {least:.3} to {most:.3}, a spread of {percent:.1} %\n\n")
        }
        None => format!("a cylinder of r = {r}: no formula gives an r_e\n\n"),
    };
    for (formula, key) in FORMULAS.iter().zip(Correlation::NAMES) {
        let value = match formula.equivalent(r) {
            Some(value) => format!("{value:.3}"),
            None => "none".into(),
        };
        text += &format!(
            "{value:>9}  {} ({key}): r_e = {}\n           valid for: {}\n           source: {}\n           quoted \
             from: {}\n",
            formula.name, formula.formula, formula.range, formula.source, formula.read_in
        );
    }
    text += &format!(
        "\nNo source was at hand: every formula is as another work quotes it.\n\
         \"none\": there the formula gives an r_e above r, or one that falls as r grows.\n\
         In a scene: aspect_ratio = r_e, or physical_aspect_ratio = {r} with shape_correlation = a name in brackets.\n"
    );
    print(&text)
}
