//! The arguments of `shearbed grade`.

use super::tolerances::Tolerance;
use crate::{Writing, number};
use clap::builder::PossibleValue;
use shearbed_validation::serve::grade::live::Protocol;
use shearbed_validation::serve::grade::{Axes, Foreign};
use shearbed_validation::serve::problems::Kind;
use std::path::PathBuf;

/// The values of `--layout`.
fn layouts() -> [PossibleValue; 3] {
    [
        ("fiberoripy", "Without a header: t, then A row by row (nine numbers), as fiberoripy's and PySPH's tables"),
        ("fiberpy", "Without a header: t, then A in the order 11, 22, 33, 12, 23, 13 of fiberpy's Mat2"),
        (
            "openfoam",
            "time, A2_0 to A2_5: OpenFOAM's symmTensor xx, xy, xz, yy, yz, zz; a file of its probes is read without \
             this flag",
        ),
    ]
    .map(|(name, help)| PossibleValue::new(name).help(help))
}

impl Args {
    /// The layout of a known program.
    pub(super) fn foreign(&self) -> Option<Foreign> {
        self.layout.as_deref().map(|name| match name {
            "fiberoripy" => Foreign::Fiberoripy,
            "fiberpy" => Foreign::Fiberpy,
            _ => Foreign::Openfoam,
        })
    }
}

#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  shearbed grade ref mine --out graded
  shearbed grade --command 'python3 mine.py' --order 4")]
pub(crate) struct Args {
    /// The folder with the problems, as `problems export` writes it
    #[arg(value_name = "REF", required_unless_present_any = ["command", "echo"])]
    pub(super) reference: Option<PathBuf>,
    /// The folder with the answers: MINE/NAME/answer.csv or MINE/NAME/steps-N.csv
    #[arg(value_name = "MINE", required_unless_present_any = ["command", "echo"], conflicts_with = "command")]
    pub(super) mine: Option<PathBuf>,
    /// Start this program once and ask it line by line, in place of answers in files. Repeated, as NAME=PROGRAM ARGS,
    /// it compares programs on one problem
    #[arg(long, value_name = "PROGRAM ARGS")]
    pub(super) command: Vec<String>,
    /// The form of a program's lines: json, or text (numbers separated by blanks, for C and Fortran) [default: json,
    /// and text if the first answer is none]
    #[arg(long, value_name = "json|text", conflicts_with = "mine")]
    pub(super) protocol: Option<Protocol>,
    /// The folder for grade.html, grade.json, grade.md, junit.xml and pictures
    #[arg(long, value_name = "DIR", default_value = "out/grade")]
    pub(super) out: PathBuf,
    /// Grade this problem only, or those of a pattern as 'pdot-*'; repeatable
    #[arg(long = "problem", value_name = "NAME")]
    pub(super) problems: Vec<String>,
    /// Grade problems of this kind only: rods, tensor, formula, contact or ensemble
    #[arg(long, value_name = "KIND", value_parser = kind)]
    pub(super) kind: Option<Kind>,
    /// Grade problems in this flow only: couette, u_2 = G x_1
    #[arg(long, value_name = "couette",
        value_parser = [PossibleValue::new("couette").help("Plane Couette flow, u_2 = G x_1")])]
    pub(super) flow: Option<String>,
    /// The answer's columns in the order of the file, - for one to leave out: time_s,rod,p3,p1,p2
    #[arg(long, value_name = "NAMES", value_delimiter = ',', allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["layout", "command"])]
    pub(super) columns: Option<Vec<String>>,
    /// What the program's axes 1, 2, 3 are, as flow,gradient,vorticity; -flow is against the flow
    #[arg(long, value_name = "AXES", default_value = "gradient,flow,vorticity", allow_hyphen_values = true)]
    pub(super) axes: Axes,
    /// The layout of a known program's tables
    #[arg(long, value_name = "PROGRAM", value_parser = layouts(), conflicts_with = "command")]
    pub(super) layout: Option<String>,
    /// Accept CR LF at line ends and a byte order mark; without this flag they are refused
    #[arg(long, conflicts_with = "command")]
    pub(super) windows_text: bool,
    /// The largest error that passes, where the problems' own is smaller: a production code's target. NAME=X for one
    /// problem; repeatable
    #[arg(long = "tolerance", value_name = "X|NAME=X", allow_hyphen_values = true)]
    pub(super) tolerances: Vec<Tolerance>,
    /// The order of accuracy that the program claims; an observed order that is lower by whole orders fails, or higher
    /// on all problems
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    pub(super) order: Option<f64>,
    /// LAMMPS dumps: the length of a time step in s, where the dump has no ITEM: TIME
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true, conflicts_with = "command")]
    pub(super) timestep_s: Option<f64>,
    /// LAMMPS dumps: the rod's axis in the body's frame, where columns shapex, shapey, shapez are missing
    #[arg(long, value_name = "x|y|z", value_parser = body_axis, conflicts_with = "command")]
    pub(super) rod_axis: Option<usize>,
    /// With --command: the most seconds for one answer, and for the answers to one problem together
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true, default_value = "10",
          conflicts_with = "mine")]
    pub(super) timeout: f64,
    /// With --command: verdicts only, without work–precision, longest steps and the stability map
    #[arg(long, conflicts_with = "mine")]
    pub(super) brief: bool,
    /// Answer each request with its own start, to measure the cost of the pipe
    #[arg(long, conflicts_with_all = ["reference", "command"])]
    pub(super) echo: bool,
    /// A missing answer is a failure
    #[arg(long)]
    pub(super) all: bool,
    #[command(flatten)]
    pub(super) writing: Writing,
}

fn kind(text: &str) -> Result<Kind, String> {
    serde_json::from_value(text.into())
        .map_err(|_| "rods, tensor, formula, contact and ensemble are allowed".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    number(text, |number| number > 0.0 && number < 1e9, "a positive number below 1e9")
}

fn body_axis(text: &str) -> Result<usize, String> {
    ["x", "y", "z"].iter().position(|axis| *axis == text).ok_or_else(|| "x, y and z are allowed".to_owned())
}
