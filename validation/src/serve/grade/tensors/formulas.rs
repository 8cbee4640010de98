//! Diagnosis of answers to formulas, row by row: the same mistakes as in curves, without an integration.

use super::estimate::{self, Quantity};
use super::{CLOSURES, Near, Stand, apart, index, near_of};
use crate::methods::least_squares::by_svd;
use crate::methods::tensors::fourth::PAIRS;
use crate::methods::tensors::wrong::closures::{Numbered, WITH_OTHERS, numbered};
use crate::methods::tensors::wrong::{MISTAKES, Mistake, shaped};
use crate::methods::tensors::{Closure, Equation, Fourth, Model, Parts};
use crate::serve::grade::answer::Answer;
use crate::serve::grade::mistakes::ORDERS;
use crate::serve::grade::nearness::{Diagnosis, NEARER, VALUES, said};
use crate::serve::problems::formula::{components, equation, tensor};
use crate::serve::problems::{Formula, LoadedProblem};
use nalgebra::{DVector, Vector3};
use std::collections::BTreeMap;

type Rows = Vec<Vec<f64>>;

/// Names the mistake whose values the answer has, given its `error`.
pub(in crate::serve::grade) fn diagnose(loaded: &LoadedProblem, answer: &Answer, error: f64) -> Diagnosis {
    let most = NEARER * error;
    let (Some(formula), Some(rows)) = (&loaded.problem.formula, inputs(loaded)) else {
        return Diagnosis::default();
    };
    let mut near = super::in_other_layouts(&[super::certified(loaded)], answer, most);
    // a_ij in another order is another question.
    let voigt = |row: &Vec<f64>| [&[0, 1, 2, 5, 4, 3].map(|k| row[k])[..], &row[6..]].concat();
    if let Some(found) = right(formula, &rows.iter().map(voigt).collect()) {
        near.extend(within(Near::new(0.0, "a_ij read in Voigt's order 11, 22, 33, 23, 13, 12"), answer, &found, most));
    }
    near.extend(match *formula {
        Formula::Pdot => of_rods(&rows, answer, most),
        Formula::Closure { closure } => of_closures(&rows, answer, closure, most),
        Formula::Dadt { closure, model } => of_rates(&rows, answer, closure, model, most),
    });
    said(VALUES, near, loaded.problem.tolerance, "")
}

/// How far the certified values are from those of a code with this mistake, or in this layout; `None` if the mistake
/// is unknown here or makes no difference.
pub(in crate::serve::grade) fn off(loaded: &LoadedProblem, name: &str) -> Option<f64> {
    let (right, rows) = (Answer::certified(loaded), inputs(loaded)?);
    let of_mistake = || match loaded.problem.formula? {
        Formula::Pdot => of_rods(&rows, &right, f64::INFINITY).into_iter().find(|n| n.name == name).map(|n| n.distance),
        Formula::Closure { .. } => None,
        Formula::Dadt { closure, model } => {
            let mistake = MISTAKES.iter().find(|mistake| mistake.name == name)?;
            Some(apart(&right.rows, &dadt(&rows, closure, model, Some(mistake))?))
        }
    };
    super::of_layout(&right.rows, name).or_else(of_mistake)
}

/// The rows that are asked about, without their numbers.
fn inputs(loaded: &LoadedProblem) -> Option<Rows> {
    Some(loaded.inputs.as_ref()?.rows.iter().map(|row| row[1..].to_vec()).collect())
}

/// The right values of a formula of a_ij.
fn right(formula: &Formula, rows: &Rows) -> Option<Rows> {
    match *formula {
        Formula::Pdot => None,
        Formula::Closure { closure } => {
            Some(rows.iter().map(|row| components(&closure.fourth(&tensor(row)))).collect())
        }
        Formula::Dadt { closure, model } => dadt(rows, closure, model, None),
    }
}

fn within(near: Near, answer: &Answer, rows: &Rows, most: f64) -> Option<Near> {
    let distance = apart(&answer.rows, rows);
    (distance <= most).then_some(Near { distance, ..near })
}

fn of_closures(rows: &Rows, answer: &Answer, closure: Closure, most: f64) -> Vec<Near> {
    let values = |_, stand: &Stand| rows.iter().map(|row| components(&stand.fourth(&tensor(row)))).collect();
    let near = of_stands(closure, answer, most, values);
    if near.is_empty() { of_numbers(closure, rows, answer, most, |_, fourth| components(fourth)) } else { near }
}

/// The closures, and mistakes inside this one, whose values the answer has; `values` gives those of each, by its index.
/// Those of one name are interchangeable.
fn of_stands(closure: Closure, answer: &Answer, most: f64, values: impl Fn(usize, &Stand) -> Rows) -> Vec<Near> {
    let tried: Vec<_> = tried(closure).collect();
    let of_name = |alike: &[(usize, &Stand)]| {
        let found = nearest(alike.iter().map(|(k, stand)| values(*k, stand)).collect(), answer);
        within(near_of("", "", alike[0].0, index(closure)), answer, &found, most)
    };
    tried.chunk_by(|a, b| a.1.name == b.1.name).filter_map(of_name).collect()
}

/// The nearest to the answer of interchangeable values, row by row.
fn nearest(mut all: Vec<Rows>, answer: &Answer) -> Rows {
    let Some(mut best) = all.pop() else { return Rows::new() };
    for other in all {
        for ((best, other), found) in best.iter_mut().zip(other).zip(&answer.rows) {
            if crate::oracle::apart(&other, found) < crate::oracle::apart(best, found) {
                *best = other;
            }
        }
    }
    best
}

/// The closures that may stand for this one.
fn tried(closure: Closure) -> impl Iterator<Item = (usize, &'static Stand)> {
    CLOSURES.iter().enumerate().filter(move |(_, stand)| stand.of.is_none_or(|of| of == closure))
}

/// Up to three wrong numbers in the closure that explain the answer; `answered` gives that of a row, by its place, from
/// a_ijkl.
fn of_numbers(
    closure: Closure,
    rows: &Rows,
    answer: &Answer,
    most: f64,
    answered: impl Fn(usize, &Fourth) -> Vec<f64>,
) -> Vec<Near> {
    const MOST_NUMBERS: usize = 3;
    let numbered = numbered(closure);
    let all = |others: &[(usize, f64)]| -> Rows {
        let of = |(at, row): (usize, &Vec<f64>)| answered(at, &numbered.fourth(others, &tensor(row)));
        rows.iter().enumerate().map(of).collect()
    };
    let right = DVector::from_vec(all(&[]).concat());
    let found = DVector::from_vec(answer.rows.concat()) - &right;
    let slope =
        |(k, (_, value)): (usize, &(String, f64))| DVector::from_vec(all(&[(k, value + 1.0)]).concat()) - &right;
    let slopes: Vec<_> = numbered.numbers.iter().enumerate().map(slope).collect();
    // By how much these numbers are off by least squares, and what that leaves.
    let solved = |chosen: &[usize]| by_svd(&chosen.iter().map(|k| slopes[*k].clone()).collect::<Vec<_>>(), &found);
    let tried = |chosen: &[usize]| {
        let mut chosen = chosen.to_vec();
        chosen.sort_unstable();
        let (off, _) = solved(&chosen)?;
        // One that was chosen on the way may turn out to be right.
        let wrong = |(k, off): &(&usize, &f64)| off.abs() > 1e-9 * (1.0 + numbered.numbers[**k].1.abs());
        let others: Vec<_> =
            (chosen.iter().zip(&off).filter(wrong)).map(|(k, off)| (*k, numbered.numbers[*k].1 + off)).collect();
        within(Near::new(0.0, &with_numbers(closure, &numbered, &others)), answer, &all(&others), most)
    };
    // A number that explains all, then the best beside those that explain most.
    let mut chosen: Vec<usize> = Vec::new();
    let mut near: Vec<_> = (0..slopes.len()).filter_map(|k| tried(&[k])).collect();
    while near.is_empty() && chosen.len() < MOST_NUMBERS {
        let left = |k: usize| Some((k, solved(&[&chosen[..], &[k]].concat())?.1));
        let others = (0..slopes.len()).filter(|k| !chosen.contains(k) && slopes[*k].norm() > 0.0);
        let Some(best) = others.filter_map(left).min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        chosen.push(best.0);
        near.extend(tried(&chosen));
    }
    near
}

/// The name of a closure in which these numbers have these values.
pub(super) fn with_numbers(closure: Closure, numbered: &Numbered, others: &[(usize, f64)]) -> String {
    let of = |(k, value): &(usize, f64)| {
        let (before, right) = &numbered.numbers[*k];
        let [value, right] = apart_in_digits(*value, *right);
        format!("{value} for {right} {before}")
    };
    format!("the {} closure with {}", closure.name(), others.iter().map(of).collect::<Vec<_>>().join(" and "))
}

/// The x at which one + x (two − one) is nearest to what is found by least squares; `None` if it is the same for all.
pub(super) fn along(one: &[f64], two: &[f64], found: &[f64]) -> Option<f64> {
    let pairs = || one.iter().zip(two).zip(found);
    let along: f64 = pairs().map(|((one, two), found)| (two - one) * (found - one)).sum();
    let square: f64 = pairs().map(|((one, two), _)| (two - one).powi(2)).sum();
    (square > 0.0).then(|| along / square)
}

/// 1/n, if the value is that.
fn fraction(value: f64) -> Option<String> {
    let whole = value.recip().round();
    let is_it = (2.0..1000.0).contains(&whole.abs()) && (value * whole - 1.0).abs() < 1e-8;
    is_it.then(|| format!("{}1/{}", if whole < 0.0 { "-" } else { "" }, whole.abs()))
}

/// A value and the right one as fractions, or in as many decimals as tell them apart, and four digits at least.
fn apart_in_digits(value: f64, right: f64) -> [String; 2] {
    // For a fraction a whole number is written by hand too.
    let whole = || ((value - value.round()).abs() < 1e-8).then(|| value.round().to_string());
    if let (Some(right), Some(value)) = (fraction(right), fraction(value).or_else(whole)) {
        return [value, right];
    }
    let place = |x: f64| x.abs().max(1e-15).log10().floor();
    let decimals = (2.0 - place(value - right)).max(3.0 - place(right.abs().max(value.abs()))).max(0.0) as usize;
    [value, right].map(|x| {
        let text = if x.abs() < 1e12 { format!("{x:.decimals$}") } else { format!("{x:.3e}") };
        let text = if text.contains('.') && !text.contains('e') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            &text
        };
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    })
}

#[test]
fn a_value_and_the_right_one_have_the_digits_that_tell_them_apart() {
    assert_eq!(apart_in_digits(50.27561, -50.27564), ["50.28", "-50.28"]);
    assert_eq!(apart_in_digits(-1.874_663, -1.872_663), ["-1.87466", "-1.87266"]);
    assert_eq!(apart_in_digits(-1e-15, 1.0), ["0", "1"]);
    assert_eq!(apart_in_digits(1e100, 1.0), ["1.000e100", "1"]);
    assert_eq!(apart_in_digits(1.0 / 15.0, 1.0 / 35.0), ["1/15", "1/35"]);
    assert_eq!(apart_in_digits(-1.0, -1.0 / 35.0), ["-1", "-1/35"]);
    assert_eq!(apart_in_digits(0.4, 1.0 / 7.0), ["0.4", "0.1429"]);
    assert_eq!(apart_in_digits(-485_213.0, -48_521.0), ["-485213", "-48521"]);
}

/// The parts of each row with a mistake, or without one; `None` if it makes no difference in any row.
fn spoilt(all: &[Parts], mistake: Option<&Mistake>) -> Option<Vec<Parts>> {
    let Some(mistake) = mistake else { return Some(all.to_vec()) };
    let changed: Vec<_> = all.iter().map(|parts| mistake.of(parts)).collect();
    changed.iter().any(Option::is_some).then(|| all.iter().zip(changed).map(|(own, new)| new.unwrap_or(*own)).collect())
}

/// da_ij/dt of each row with a mistake, or without one; `None` if it makes no difference.
fn dadt(rows: &Rows, closure: Closure, model: Model, mistake: Option<&Mistake>) -> Option<Rows> {
    let parts = spoilt(&parts_of(rows, closure, model), mistake)?;
    Some(rates(rows, &parts, &fourths(rows, &CLOSURES[index(closure)?])))
}

fn parts_of(rows: &Rows, closure: Closure, model: Model) -> Vec<Parts> {
    rows.iter().map(|row| equation(closure, model, row)).map(|e: Equation| e.parts()).collect()
}

/// a_ijkl of each row by a closure.
fn fourths(rows: &Rows, closure: &Stand) -> Vec<Fourth> {
    rows.iter().map(|row| closure.fourth(&tensor(row))).collect()
}

/// da_ij/dt of each row with these parts and these a_ijkl.
fn rates(rows: &[Vec<f64>], parts: &[Parts], fourths: &[Fourth]) -> Rows {
    rows.iter().zip(parts.iter().zip(fourths)).map(|(row, (parts, fourth))| rate(row, parts, fourth)).collect()
}

fn rate(row: &[f64], parts: &Parts, fourth: &Fourth) -> Vec<f64> {
    let rate = parts.rate(&tensor(row), fourth);
    PAIRS.map(|place| rate[place]).to_vec()
}

fn of_rates(rows: &Rows, answer: &Answer, closure: Closure, model: Model, most: f64) -> Vec<Near> {
    let own = index(closure);
    let parts = parts_of(rows, closure, model);
    let fourths: BTreeMap<_, _> = tried(closure).map(|(k, stand)| (k, fourths(rows, stand))).collect();
    let rates = |parts: &[Parts], k: usize| rates(rows, parts, &fourths[&k]);
    let mut near = Vec::new();
    for mistake in std::iter::once(None).chain(MISTAKES.iter().map(Some)) {
        let Some(parts) = spoilt(&parts, mistake) else { continue };
        let (name, advice) = mistake.map_or(("", ""), |mistake| (mistake.name, mistake.advice));
        // Saves time: most are far already in the first row.
        let begins = |k: &usize| {
            let first = self::rates(&rows[..1], &parts[..1], &fourths[k][..1]);
            apart(&answer.rows[..1], &first) <= most
        };
        let of = |k: usize| within(near_of(name, advice, k, own), answer, &rates(&parts, k), most);
        if mistake.is_none() {
            near.extend(of_stands(closure, answer, most, |k, _| rates(&parts, k)));
        } else {
            near.extend((0..WITH_OTHERS).filter(begins).filter_map(of));
        }
    }
    if near.is_empty() {
        near = of_numbers(closure, rows, answer, most, |at, fourth| rate(&rows[at], &parts[at], fourth));
    }
    if near.is_empty() {
        near = of_quantities(&parts, answer, most, |parts, k| rates(parts, k), model, own);
    }
    if let (true, Some(own)) = (near.is_empty(), own) {
        let of = |at: usize, parts: &Parts| rate(&rows[at], parts, &fourths[&own][at]);
        near.extend(of_each_row(rows, &parts, answer, most, of));
    }
    near
}

/// One quantity times a factor, in every row; the rate is linear in each.
fn of_quantities(
    parts: &[Parts],
    answer: &Answer,
    most: f64,
    rates: impl Fn(&[Parts], usize) -> Rows,
    model: Model,
    own: Option<usize>,
) -> Vec<Near> {
    let of = |((name, change), k): (&Quantity, usize)| {
        let scaled = |factor: f64| parts.iter().map(|parts| change(*parts, factor)).collect::<Option<Vec<_>>>();
        let [one, two] = [1.0, 2.0].map(|factor| Some(rates(&scaled(factor)?, k).concat()));
        let factor = Some(1.0 + along(&one?, &two?, &answer.rows.concat())?).filter(|factor| factor.abs() < 1e6)?;
        within(estimate::near(name, factor, model, k, own), answer, &rates(&scaled(factor)?, k), most)
    };
    estimate::tried(own).filter_map(of).collect()
}

/// A quantity that a code takes from the row by another formula: its name, where it is, and the parts with a value.
type OfRow = (&'static str, fn(&Parts) -> f64, fn(Parts, f64) -> Option<Parts>);

const OF_ROW: [OfRow; 2] = [
    ("Λ", |parts| parts.of_strain, |parts, value| Some(shaped(parts, value))),
    ("γ̇", |parts| parts.speed, |parts, value| Some(Parts { speed: value, ..parts })),
];

/// Λ or γ̇ by another formula: each row has a value with which it is right.
fn of_each_row(
    rows: &Rows,
    parts: &[Parts],
    answer: &Answer,
    most: f64,
    rate: impl Fn(usize, &Parts) -> Vec<f64>,
) -> Option<Near> {
    OF_ROW.iter().find_map(|(name, right, change)| {
        let of = |(at, own): (usize, &Parts)| {
            let with = |value: f64| Some(rate(at, &change(*own, value)?));
            let value = along(&with(0.0)?, &with(1.0)?, &answer.rows[at]).unwrap_or(right(own));
            Some((value, with(value)?))
        };
        let (values, found): (Vec<_>, Rows) =
            parts.iter().enumerate().map(of).collect::<Option<Vec<_>>>()?.into_iter().unzip();
        let words = |(at, (value, own)): (usize, (&f64, &Parts))| {
            let right = right(own);
            let r = rows[at].last()?;
            let differs = (value - right).abs() > most.max(1e-9) * (1.0 + right.abs());
            let [value, right] = apart_in_digits(*value, right);
            differs.then(|| format!("{value} for {right} at r_e = {r} (row {at})"))
        };
        let words: Vec<_> = values.iter().zip(parts).enumerate().filter_map(words).take(3).collect();
        let suspect = format!("another formula for {name}");
        let name = format!("{suspect}: {}", words.join(", "));
        let near = Near { suspects: vec![suspect], ..Near::new(0.0, &name) };
        within(near, answer, &found, most)
    })
}

fn of_rods(rows: &Rows, answer: &Answer, most: f64) -> Vec<Near> {
    let model = Model::FolgarTucker { c_i: 0.0 };
    let parts = parts_of(rows, Closure::Linear, model);
    let rates = |parts: &[Parts]| -> Rows { rows.iter().zip(parts).map(|(row, parts)| pdot(row, parts)).collect() };
    let near = |name: &str, advice| Near { advice, ..Near::new(0.0, name) };
    let mut all = Vec::new();
    for mistake in &MISTAKES {
        if let Some(parts) = spoilt(&parts, Some(mistake)) {
            let name = mistake.name.replace("𝔸:D", "p(p·Dp)").replace("Da + aD", "Dp");
            let advice = if name == mistake.name { mistake.advice } else { "ṗ = Wp + Λ(Dp − p(p·Dp))" };
            all.extend(within(near(&name, advice), answer, &rates(&parts), most));
        }
    }
    let right = rates(&parts);
    all.extend(ORDERS.iter().filter_map(|(order, name)| {
        let turned = right.iter().map(|rate| order.map(|k| rate[k]).to_vec()).collect();
        within(near(name, ""), answer, &turned, most)
    }));
    all.extend((0..3).filter_map(|k| {
        let mut mirrored = right.clone();
        mirrored.iter_mut().for_each(|rate| rate[k] = -rate[k]);
        within(near(&format!("ṗ_{} with the wrong sign", k + 1), ""), answer, &mirrored, most)
    }));
    if all.is_empty() {
        all = of_quantities(&parts, answer, most, |parts, _| rates(parts), model, Some(0));
        all.retain(|near| near.changes == 1);
    }
    if all.is_empty() {
        all.extend(of_each_row(rows, &parts, answer, most, |at, parts| pdot(&rows[at], parts)));
    }
    all
}

/// ṗ with these parts: pp stands for a and pppp for 𝔸, the same terms.
fn pdot(row: &[f64], Parts { spin, strain, of_strain, of_fourth, .. }: &Parts) -> Vec<f64> {
    let p = Vector3::from_row_slice(&row[..3]);
    let pull = strain * p;
    let rate = spin * p + pull * *of_strain - p * (p.dot(&pull) * 0.5 * of_fourth);
    rate.as_slice().to_vec()
}
