//! `shearbed shape`.

use super::{Failure, number, print};
use shearbed::model::jeffery::aspect_ratio_of_period;
use shearbed::model::shape::{ALLOWED, Correlation, FORMULAS, spread};

#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("of").required(true)))]
#[command(after_help = "\
Examples:
  shearbed shape --physical 20
  shearbed shape --period-s 147 --period-u 2 --shear-rate-per-s 0.5")]
pub(super) struct Args {
    /// Length over diameter of a cylinder, up to 1000; below 2, and of discs and rings, what is known
    #[arg(long, value_name = "R", value_parser = ratio, allow_negative_numbers = true, group = "of")]
    physical: Option<f64>,
    /// The strain of one turn, in place of T and G
    #[arg(long, value_name = "GT", value_parser = positive, allow_negative_numbers = true, group = "of")]
    strain: Option<f64>,
    /// Its standard uncertainty
    #[arg(long, value_name = "U", value_parser = positive, allow_negative_numbers = true, requires = "strain")]
    #[arg(conflicts_with_all = ["physical", "period_s"])]
    strain_u: Option<f64>,
    /// The time in which a rod turns once, through 360°: r_e of T = 2π(r_e + 1/r_e)/G
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true, group = "of")]
    #[arg(requires = "shear_rate_per_s")]
    period_s: Option<f64>,
    /// One standard uncertainty of that time
    #[arg(long, value_name = "U", value_parser = positive, allow_negative_numbers = true, requires = "period_s")]
    #[arg(conflicts_with_all = ["physical", "strain"])]
    period_u: Option<f64>,
    /// The shear rate G at which it turns
    #[arg(long, value_name = "G", value_parser = positive, allow_negative_numbers = true, requires = "period_s")]
    #[arg(conflicts_with_all = ["physical", "strain"])]
    shear_rate_per_s: Option<f64>,
    /// One standard uncertainty of G
    #[arg(long, value_name = "U", value_parser = positive, allow_negative_numbers = true)]
    #[arg(requires = "shear_rate_per_s")]
    shear_rate_u: Option<f64>,
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, |x| (1e-100..=1e100).contains(&x), "a number from 1e-100 to 1e100")
}

/// The thinnest disc.
const THINNEST: f64 = 0.001;

fn ratio(text: &str) -> Result<f64, String> {
    let (least, most) = (THINNEST, ALLOWED.1);
    number(text, |r| (least..=most).contains(&r), &format!("a number from {least} to {most}"))
}

/// Prints the equivalent aspect ratio of a cylinder by every formula, or that of a period.
pub(super) fn shape(args: &Args) -> Result<(), Failure> {
    match (args.physical, args.strain, args.period_s, args.shear_rate_per_s) {
        (Some(r), ..) if r < ALLOWED.0 => of_flat(r),
        (Some(r), ..) => of_cylinder(r),
        (_, Some(strain), ..) => of_strain(strain, args.strain_u),
        (_, _, Some(period_s), Some(g)) => of_period((period_s, args.period_u), (g, args.shear_rate_u)),
        // The parser refuses it.
        _ => Ok(()),
    }
}

/// The least period times shear rate.
const OF_SPHERE: f64 = 4.0 * std::f64::consts::PI;

/// Prints r_e of a rod that turns once in this strain, with its standard uncertainty if given.
fn of_strain(strain: f64, u: Option<f64>) -> Result<(), Failure> {
    let (given, allowed) = (format!("--strain {strain}"), rounded(OF_SPHERE, 6));
    print(&of_turn(with(strain, u), [strain, u.unwrap_or(0.0)], &given, &format!("a strain of at least {allowed}"))?)
}

/// Prints the same of this period at this shear rate: relative uncertainties, taken as independent, add in squares to
/// that of GT, on which alone r_e depends.
fn of_period((period_s, period_u): (f64, Option<f64>), (g, g_u): (f64, Option<f64>)) -> Result<(), Failure> {
    let strain = g * period_s;
    let u = strain * (period_u.unwrap_or(0.0) / period_s).hypot(g_u.unwrap_or(0.0) / g);
    let allowed = format!("a time of at least {} s at {g} 1/s", rounded(OF_SPHERE / g, 6));
    let text = of_turn(rounded(strain, 6), [strain, u], &format!("--period-s {period_s}"), &allowed)?;
    print(&format!("T = {} s at G = {} 1/s: {text}", with(period_s, period_u), with(g, g_u)))
}

fn with(value: f64, u: Option<f64>) -> String {
    u.map_or(value.to_string(), |u| format!("{value} ± {u}"))
}

/// r_e of a rod, and of a disc, that turns once in a strain with its uncertainty, as text; `shown` is the strain.
fn of_turn(shown: String, [strain, u]: [f64; 2], given: &str, allowed: &str) -> Result<String, Failure> {
    // A measured strain may fall below that of a sphere, by two uncertainties at most.
    let of_sphere = || (strain + 2.0 * u >= OF_SPHERE).then_some(1.0);
    let Some(r) = aspect_ratio_of_period(strain).or_else(of_sphere) else {
        return Err(Failure::Input(format!(
            "{given}: GT = {strain:.4} is less than 4π = {OF_SPHERE:.4}, that of a sphere, and all rods and discs turn \
             more slowly; {allowed} is allowed. T is that of a whole turn: means and pictures of a rod repeat with T/2"
        )));
    };
    let mut text = if strain < OF_SPHERE {
        format!("GT = {shown}, below 4π = {OF_SPHERE:.4} of a sphere by at most two uncertainties\n\n")
    } else {
        format!("GT = {shown} = 2π(r_e + 1/r_e)\n\n")
    };
    let ends = (u > 0.0).then(|| [strain - u, strain + u].map(aspect_ratio_of_period));
    for (whose, of) in [("rod", (|r| r) as fn(f64) -> f64), ("disc of the same period", |r| 1.0 / r)] {
        let (value, ends) = (of(r), ends.map(|ends| ends.map(|end| end.map(of))));
        text += &format!("r_e = {}, of a {whose}\n", with_uncertainty(value, ends));
    }
    let r = if r == 1.0 { "1".into() } else { rounded(r, 6) };
    Ok(text + &format!("\nIn a scene: aspect_ratio = {r}\n"))
}

/// A value with its uncertainty where the values at GT ± U are as far on both sides to a twentieth, else with these;
/// below GT of a sphere the end is that of a sphere.
fn with_uncertainty(value: f64, ends: Option<[Option<f64>; 2]>) -> String {
    let Some(ends) = ends else { return rounded(value, 6) };
    if let [Some(a), Some(b)] = ends {
        let (before, after) = ((value - a).abs(), (b - value).abs());
        let u = 0.5 * (before + after);
        if (before - after).abs() <= 0.05 * u {
            let decimals = decimals(u, 2);
            return format!("{value:.decimals$} ± {u:.decimals$}");
        }
    }
    if ends == [None; 2] {
        return "1, a sphere".into();
    }
    let [a, b] = ends.map(|end| rounded(end.unwrap_or(1.0), 4));
    if value == 1.0 {
        return format!("1, a sphere, to {b} at GT + U");
    }
    format!("{}, {a} at GT - U and {b} at GT + U", rounded(value, 6))
}

/// A number with `digits` digits at least.
fn rounded(x: f64, digits: i32) -> String {
    let decimals = decimals(x, digits);
    format!("{x:.decimals$}")
}

/// The decimals of a positive number of `digits` digits.
fn decimals(x: f64, digits: i32) -> usize {
    (digits - 1 - x.log10().floor() as i32).max(0) as usize
}

fn of_cylinder(r: f64) -> Result<(), Failure> {
    let of_all = spread(r).map_or("no formula gives an r_e".to_owned(), |(least, most)| {
        let percent = 200.0 * (most - least) / (most + least);
        format!("r_e from {least:.3} to {most:.3}, a spread of {percent:.1} %")
    });
    let mut text = format!("a cylinder of r = {r}: {of_all}\n\n");
    for (formula, key) in FORMULAS.iter().zip(Correlation::NAMES) {
        let value = formula.equivalent(r).map_or("none".into(), |value| format!("{value:.3}"));
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

/// Prints what is known of short cylinders, discs and rings: one formula, continued below its rods, and what was
/// measured.
fn of_flat(r: f64) -> Result<(), Failure> {
    let formula = Correlation::HarrisPittman.formula();
    let above = if r > 1.0 && formula.value(r) > r { ", above r, as no formula below r = 2 is checked" } else { "" };
    print(&format!(
        "a body of length over diameter r = {r}: no formula is stated to hold below r = {}\n\n\
         {:>9.3}  {}, used below r = 2: r_e = {}, for a cylinder or a disc{above}\n           \
         valid for: {}\n           quoted from: {}\n     \
         0.07  measured, a disc of r = 0.03 (the formula: {:.3})\n     \
         0.33  measured, a ring of r = 0.45 (the formula: {:.3})\n           \
         source: D. Di Giusto, L. Bergougnoux & É. Guazzelli, J. Fluid Mech. (2025)\n           \
         quoted from: a digest of the paper\n\n\
         What turns once in a known time has a known r_e: --period-s T --shear-rate-per-s G.\n\
         In a scene: aspect_ratio = r_e\n",
        ALLOWED.0,
        formula.value(r),
        formula.name,
        formula.formula,
        formula.range,
        formula.read_in,
        formula.value(0.03),
        formula.value(0.45),
    ))
}
