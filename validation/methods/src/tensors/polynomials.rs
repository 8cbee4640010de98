//! The polynomials of fitted closures as text, to compare coefficients.

use super::Closure;
use super::ibof;
use super::orthotropic::{ORE, ORW};

#[rustfmt::skip]
const ORE_TERMS: [&str; 15] = [
    "", "x", "y", "x y", "x^2", "y^2", "x^2 y", "x y^2", "x^3", "y^3", "x^2 y^2", "x^3 y", "x y^3", "x^4", "y^4",
];
const ORW_TERMS: [&str; 6] = ["", "x", "x^2", "y", "y^2", "x y"];

const EIGENVALUES: &str = "in the axes of a, with its eigenvalues x ≥ y ≥ z, three components are polynomials, and the \
    others follow from a_iikk = a_ii";
const INVARIANTS: &str = "a_ijkl = β1 S(δ δ) + β2 S(δ a) + β3 S(a a) + β4 S(δ a·a) + β5 S(a a·a) + β6 S(a·a a·a), \
    S the symmetric part; three β are polynomials in II = (1 − a:a)/2 and III = det a, and the others follow from \
    a_ijkk = a_ij";

impl Closure {
    /// How a fitted closure is formed, and its three polynomials with all digits of the coefficients; empty of others.
    pub fn polynomials(self) -> Vec<String> {
        let column = |table: &[[f64; 3]], k: usize| table.iter().map(|row| row[k]).collect::<Vec<_>>();
        let [eigenvalues, invariants] = [["a_1111", "a_2222", "a_3333"], ["β3", "β4", "β6"]];
        let (words, names, of) = match self {
            Self::Ore => (EIGENVALUES, eigenvalues, [0, 1, 2].map(|k| polynomial(&column(&ORE, k), &ORE_TERMS))),
            Self::Orw => (EIGENVALUES, eigenvalues, ORW.map(|row| polynomial(&row, &ORW_TERMS))),
            Self::Ibof => {
                let terms = ibof::POWERS.map(|(m, n)| format!("{}{}", power("II", m), power("III", n)));
                let of = |k: usize| polynomial(&column(&ibof::COEFFICIENTS, k), &terms);
                (INVARIANTS, invariants, [0, 1, 2].map(of))
            }
            _ => return Vec::new(),
        };
        let lines = names.into_iter().zip(of).map(|(name, of)| format!("{name} = {of}"));
        std::iter::once(words.to_owned()).chain(lines).collect()
    }
}

fn power(name: &str, exponent: i32) -> String {
    match exponent {
        0 => String::new(),
        1 => format!("{name} "),
        _ => format!("{name}^{exponent} "),
    }
}

fn polynomial(coefficients: &[f64], terms: &[impl AsRef<str>]) -> String {
    let mut text = String::new();
    for (c, term) in coefficients.iter().zip(terms) {
        let sign = match (text.is_empty(), *c < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text += format!("{sign}{} {}", c.abs(), term.as_ref()).trim_end();
    }
    text
}

/// What is printed gives the closure's own components, and another coefficient does not.
#[test]
fn printed_polynomials_are_the_closures() {
    use nalgebra::Matrix3;
    let (x, y): (f64, f64) = (0.55, 0.3);
    let z = 1.0 - x - y;
    let values = [("x", x), ("y", y), ("II", x * y + y * z + z * x), ("III", x * y * z)];
    let value = |text: &str| -> f64 {
        let factor = |word: &str| -> f64 {
            let (base, exponent) = word.split_once('^').unwrap_or((word, "1"));
            let base = values.iter().find(|(name, _)| *name == base);
            base.map_or_else(|| word.parse().unwrap(), |(_, value)| value.powi(exponent.parse().unwrap()))
        };
        let text = text.replace("- ", "+ -1 ");
        text.trim_start_matches("+ ").split("+ ").map(|term| term.split_whitespace().map(factor).product::<f64>()).sum()
    };
    let lines = |closure: Closure| -> Vec<String> {
        let of = |line: &String| line.split_once(" = ").unwrap().1.to_owned();
        closure.polynomials()[1..].iter().map(of).collect()
    };
    for closure in [Closure::Ore, Closure::Orw] {
        let fourth = closure.fourth(&Matrix3::from_diagonal(&[x, y, z].into()));
        for (k, line) in lines(closure).iter().enumerate() {
            let due = fourth.at(k, k, k, k);
            assert!((value(line) - due).abs() < 1e-12, "{closure:?}: {line}");
            assert!((value(&line.replacen(" x", " y", 1)) - due).abs() > 1e-3);
        }
    }
    // All six β from the six components in the axes of a.
    let (one, a) = ([1.0; 3], [x, y, z]);
    let square = a.map(|x| x * x);
    let parts = [(one, one), (one, a), (a, a), (one, square), (a, square), (square, square)];
    let places = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    let part = |(p, q): ([f64; 3], [f64; 3]), (i, j): (usize, usize)| {
        (p[i] * q[j] + p[j] * q[i]) / if i == j { 2.0 } else { 6.0 }
    };
    let fourth = Closure::Ibof.fourth(&Matrix3::from_diagonal(&a.into()));
    let system = nalgebra::Matrix6::from_fn(|row, column| part(parts[column], places[row]));
    let due =
        nalgebra::Vector6::from_fn(|row, _| fourth.at(places[row].0, places[row].0, places[row].1, places[row].1));
    let betas = system.lu().solve(&due).unwrap();
    for (line, k) in lines(Closure::Ibof).iter().zip([2, 3, 5]) {
        assert!((value(line) / betas[k] - 1.0).abs() < 1e-7, "{line}: {}", betas[k]);
    }
}
