//! The values of the options of `shearbed reference`.

use super::{From, Times};
use crate::{ending_in, number};
use shearbed_validation::oracle::diffusion;
use shearbed_validation::oracle::reference::big::{Bits, decimal, double, finite};
use shearbed_validation::oracle::reference::motion::Unit;
use shearbed_validation::oracle::reference::rod::Direction;
use std::path::PathBuf;

fn number_or_inf(text: &str, allowed: impl Fn(f64) -> bool, words: &str) -> Result<f64, String> {
    if text == "inf" { Ok(f64::INFINITY) } else { number(text, allowed, words) }
}

pub(super) fn aspect_ratio(text: &str) -> Result<f64, String> {
    number_or_inf(text, |r| (1e-100..=1e100).contains(&r), "a number from 1e-100 to 1e100, or inf,")
}

pub(super) fn c_i(text: &str) -> Result<f64, String> {
    let words = "0 (free rods), a number from 1e-9 to 1e9, or inf (all directions alike)";
    number_or_inf(text, |c| c == 0.0 || (1e-9..=1e9).contains(&c), words)
}

pub(super) fn d_r(text: &str) -> Result<f64, String> {
    let words = "0 (free rods), a number from 1e-100 to 1e100, or inf (all directions alike)";
    number_or_inf(text, |d| d == 0.0 || (1e-100..=1e100).contains(&d), words)
}

pub(super) fn density_file(text: &str) -> Result<PathBuf, String> {
    ending_in(&["csv", "svg", "png", "pdf"], ".csv, .svg, .png or .pdf", text)
}

pub(super) fn rate(text: &str) -> Result<f64, String> {
    let words = "a number with a size from 1e-100 to 1e100";
    number(text, |g| (1e-100..=1e100).contains(&g.abs()), words)
}

pub(super) fn deviation(text: &str) -> Result<f64, String> {
    number(text, |sd| (0.0..100.0).contains(&sd), "a number from 0 to below 100")
}

pub(super) fn unit_named(text: &str) -> Result<Unit, String> {
    match text {
        "period" => Ok(Unit::Period),
        "strain" => Ok(Unit::Strain),
        "s" => Ok(Unit::Second),
        _ => Err("period, strain or s is allowed".into()),
    }
}

pub(super) fn start(text: &str) -> Result<From, String> {
    let words = "`isotropic`, `planar`, φ,θ in degrees with θ from 0 to 180 (each 0 or of a size from 5e-324 to \
                 1.8e308), a11,a22,a33,a12,a13,a23, or a FILE.csv";
    match text.split(',').collect::<Vec<_>>()[..] {
        [file] if file.ends_with(".csv") => Ok(From::Directions(file.into())),
        ["isotropic"] => Ok(From::Isotropic),
        ["planar"] => Ok(From::Planar),
        [phi, theta] => Ok(From::Rod(Direction::Angles {
            phi_deg: number(phi, |_| true, words)?,
            theta_deg: number(theta, |theta| (0.0..=180.0).contains(&theta), words)?,
        })),
        [_, _, _, _, _, _] => tensor(text).map(From::Bingham),
        _ => Err(format!("{words} is allowed")),
    }
}

/// How far the trace of a measured tensor may be off 1, as of three values rounded to three digits.
const ROUNDED: f64 = 1.5e-3;

/// K of the density of Bingham with this a_ij, divided by its trace.
fn tensor(text: &str) -> Result<[[f64; 3]; 3], String> {
    let words = "a11,a22,a33,a12,a13,a23 with a11 + a22 + a33 = 1 to three digits and eigenvalues above 0";
    let a: Vec<f64> = text.split(',').map(|part| number(part, |x| x.abs() <= 1.0, words)).collect::<Result<_, _>>()?;
    let trace = a[0] + a[1] + a[2];
    if (trace - 1.0).abs() > ROUNDED {
        return Err(format!("{words} are allowed; the sum is {trace}"));
    }
    diffusion::bingham([0, 1, 2, 3, 4, 5].map(|k| a[k] / trace))
        .map_err(|least| format!("{words}, the least from about 0.01 on, are allowed; the least is {least}"))
}

pub(super) fn gradient(text: &str) -> Result<[[f64; 3]; 3], String> {
    let words = "nine finite numbers with sizes from 1e-100 to 1e100 or 0, separated by commas,";
    let within = |x: f64| x == 0.0 || (1e-100..=1e100).contains(&x.abs());
    let entries = text.split(',').map(|entry| number(entry, within, words));
    let entries: Vec<f64> = entries.collect::<Result<_, _>>()?;
    match <[f64; 9]>::try_from(entries) {
        Ok(l) => Ok([[l[0], l[1], l[2]], [l[3], l[4], l[5]], [l[6], l[7], l[8]]]),
        Err(_) => Err(format!("{words} are allowed")),
    }
}

/// The largest number of times.
const MOST: u64 = 100_000;

pub(super) fn times(text: &str) -> Result<Times, String> {
    let refuse = || {
        format!(
            "FROM:TO:COUNT with finite FROM ≤ TO and a COUNT from 1 to {MOST}, or at most as many rising times \
             T1,T2,…, are allowed; a time is 0 or of a size from 5e-324 to 1.8e308"
        )
    };
    let parts: Vec<_> = text.split(':').collect();
    let [from, to, count] = parts[..] else {
        return listed(text).ok_or_else(refuse);
    };
    let count = count.parse::<u64>().ok().filter(|count| (1..=MOST).contains(count));
    let (Some(from), Some(to), Some(count)) = (decimal(from), decimal(to), count) else {
        return Err(refuse());
    };
    if from > to {
        return Err(refuse());
    }
    // Exact until the end, so that each time is the double nearest to its decimal.
    let gaps = Bits(400).of((count - 1).max(1) as f64);
    let span = to - &from;
    let time = |k: u64| &from + &span * Bits(400).of(k as f64) / &gaps;
    Ok(Times((0..count).map(|k| double(&time(k))).collect()))
}

/// Parses a list of times, which must ascend.
fn listed(text: &str) -> Option<Times> {
    let times: Vec<f64> = text.split(',').map(finite).collect::<Option<_>>()?;
    let rise = times.len() as u64 <= MOST && times.is_sorted_by(|a, b| a < b);
    rise.then_some(Times(times))
}
