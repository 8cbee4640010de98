//! The polynomials of fitted closures as text, to compare coefficients.

use super::orthotropic::{ORE_FIT, ORW_FIT};
use super::{Closure, ibof};

const EIGENVALUES: &str = "in the axes of a, with its eigenvalues x ≥ y ≥ z, three components are polynomials, and the \
    others follow from a_iikk = a_ii";
const INVARIANTS: &str = "a_ijkl = β1 S(δ δ) + β2 S(δ a) + β3 S(a a) + β4 S(δ a·a) + β5 S(a a·a) + β6 S(a·a a·a), \
    S the symmetric part; three β are polynomials in II = (1 − a:a)/2 and III = det a, and the others follow from \
    a_ijkk = a_ij";

impl Closure {
    /// How a fitted closure is formed, and its three polynomials with all digits of the coefficients; empty of others.
    pub fn polynomials(self) -> Vec<String> {
        let [eigenvalues, invariants] = [["a_1111", "a_2222", "a_3333"], ["β3", "β4", "β6"]];
        let (words, names, coefficients, terms) = match self {
            Self::Ore => (EIGENVALUES, eigenvalues, &ORE_FIT.coefficients, terms(ORE_FIT.powers, XY)),
            Self::Orw => (EIGENVALUES, eigenvalues, &ORW_FIT.coefficients, terms(ORW_FIT.powers, XY)),
            Self::Ibof => (INVARIANTS, invariants, &ibof::FIT.coefficients, terms(&ibof::POWERS, INVARIANT)),
            _ => return Vec::new(),
        };
        let rows = names.into_iter().zip(coefficients.chunks(terms.len()));
        let lines = rows.map(|(name, row)| format!("{name} = {}", polynomial(row, &terms)));
        std::iter::once(words.to_owned()).chain(lines).collect()
    }
}

/// The arguments of ORE and ORW.
pub(super) const XY: [&str; 2] = ["x", "y"];
/// The arguments of IBOF.
pub(super) const INVARIANT: [&str; 2] = ["II", "III"];

/// The products of powers of two arguments as text; the first is empty.
pub(super) fn terms(powers: &[(i32, i32)], [x, y]: [&str; 2]) -> Vec<String> {
    powers.iter().map(|(m, n)| format!("{}{}", power(x, *m), power(y, *n)).trim_end().to_owned()).collect()
}

fn power(name: &str, exponent: i32) -> String {
    match exponent {
        0 => String::new(),
        1 => format!("{name} "),
        _ => format!("{name}^{exponent} "),
    }
}

fn polynomial(coefficients: &[f64], terms: &[String]) -> String {
    let mut text = String::new();
    for (c, term) in coefficients.iter().zip(terms) {
        let sign = match (text.is_empty(), *c < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text += format!("{sign}{} {}", c.abs(), term).trim_end();
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
