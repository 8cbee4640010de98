//! Equivalent aspect ratios: a cylinder of length over diameter r turns in shear as an ellipsoid of aspect ratio r_e
//! does (Bretherton 1962). The formulas give r_e for r.

use serde::{Deserialize, Serialize};

/// One of [`FORMULAS`], by its name in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Correlation {
    /// Goldsmith & Mason 1967.
    GoldsmithMason,
    /// Cox 1971.
    Cox,
    /// Harris & Pittman 1975.
    HarrisPittman,
    /// Zhang et al. 2011.
    Zhang,
}

impl Correlation {
    /// The names, in the order of [`FORMULAS`].
    pub const NAMES: [&str; 4] = ["goldsmith-mason", "cox", "harris-pittman", "zhang"];

    /// The formula of this correlation.
    pub fn formula(self) -> &'static Formula {
        &FORMULAS[self as usize]
    }

    /// The name of this correlation in a scene.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// A published formula for r_e of a cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Formula {
    /// Authors and year.
    pub name: &'static str,
    /// The formula as text.
    pub formula: &'static str,
    /// Range of validity as stated by the authors.
    pub range: &'static str,
    /// First publication.
    pub source: &'static str,
    /// Where this project read the formula: none of the original sources was at hand.
    pub read_in: &'static str,
    value: fn(f64) -> f64,
}

/// The smallest and the largest r allowed: the formulas are not meant for shorter cylinders, and no experiment has
/// longer ones.
pub const ALLOWED: (f64, f64) = (2.0, 1000.0);

/// All formulas.
pub const FORMULAS: [Formula; 4] = [
    Formula {
        name: "Goldsmith & Mason 1967",
        formula: "0.742 r - 0.0017 r²",
        range: "not stated (called a coarse approximation)",
        source: "H. L. Goldsmith & S. G. Mason, in: Rheology, Theory and Applications 4 (1967)",
        read_in: "nilsmeyerkit/pysph, commit 8d54b3c",
        value: |r| 0.742 * r - 0.0017 * r * r,
    },
    Formula {
        name: "Cox 1971",
        formula: "1.24 r/√(ln r)",
        range: "long slender bodies",
        source: "R. G. Cox, J. Fluid Mech. 45 (1971) 625",
        read_in: "meyer-nils/fiberoripy, aspect_ratios.py",
        value: |r| 1.24 * r / libm::log(r).sqrt(),
    },
    Formula {
        name: "Harris & Pittman 1975",
        formula: "1.14 r^0.844",
        range: "not stated",
        source: "J. B. Harris & J. F. T. Pittman, J. Colloid Interface Sci. 50 (1975)",
        read_in: "a third party's digest only (UNCHECKED)",
        value: |r| 1.14 * libm::pow(r, 0.844),
    },
    Formula {
        name: "Zhang et al. 2011",
        formula: "0.000035 r³ - 0.00467 r² + 0.764 r + 0.404",
        range: "not stated",
        source: "D. Zhang et al., J. Manuf. Sci. Eng. 133 (2011) 051002",
        read_in: "meyer-nils/fiberoripy, aspect_ratios.py",
        value: |r| ((0.000_035 * r - 0.004_67) * r + 0.764) * r + 0.404,
    },
];

impl Formula {
    /// The formula's value at any `r` > 0, meant or not.
    pub fn value(&self, r: f64) -> f64 {
        (self.value)(r)
    }

    /// r_e of a cylinder of aspect ratio `r`; `None` outside the formula's meaning: where r_e exceeds r, which is true
    /// of no long cylinder, or falls as r grows.
    pub fn equivalent(&self, r: f64) -> Option<f64> {
        let value = self.value(r);
        let rises = self.value(1.001 * r) > value;
        (value > 0.0 && value <= r && rises).then_some(value)
    }
}

/// The smallest and the largest r_e that the formulas give for `r`; `None` if no formula gives a value.
pub fn spread(r: f64) -> Option<(f64, f64)> {
    let values: Vec<f64> = FORMULAS.iter().filter_map(|formula| formula.equivalent(r)).collect();
    let least = values.iter().copied().reduce(f64::min)?;
    Some((least, values.iter().copied().fold(least, f64::max)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_a_formula_cannot_mean_it_there_is_none() {
        assert_eq!(FORMULAS[2].value(1.0), 1.14);
        assert!((FORMULAS[2].value(100.0) - 1.14 * 10f64.powf(1.688)).abs() < 1e-12);
        let given = |r: f64| FORMULAS.map(|formula| formula.equivalent(r).is_some());
        // 1.24/√(ln r) > 1 below r = e^1.5376 = 4.65; 1.14 r^−0.156 > 1 below 2.32.
        assert_eq!(given(2.0), [true, false, false, true]);
        assert_eq!(given(4.6), [true, false, true, true]);
        assert_eq!(given(4.7), [true; 4]);
        // The parabola falls from r = 0.742/0.0034 = 218.2 on; the cubic is above r from 172 on.
        assert_eq!(given(171.0), [true; 4]);
        assert_eq!(given(175.0), [true, true, true, false]);
        assert_eq!(given(218.0), [true, true, true, false]);
        assert_eq!(given(219.0), [false, true, true, false]);
    }
}
