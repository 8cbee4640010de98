//! The physical aspect ratio of a cylinder in place of the equivalent one of an ellipsoid.

use super::{Mistake, Setting, linear, right_map};

/// r_p for r_e: the physical aspect ratio of a cylinder in place of the equivalent one of an ellipsoid, by each formula
/// of `docs/src/reference/files.md`, in both directions: r_e = f(r_p) applied twice, and not at all.
pub(super) fn all() -> Vec<Mistake> {
    type Formula = fn(f64) -> f64;
    let formulas: [(&str, Formula); 4] = [
        ("Cox 1971", |r| 1.24 * r / r.ln().sqrt()),
        ("Goldsmith & Mason 1967", |r| 0.742 * r - 0.0017 * r * r),
        ("Harris & Pittman 1975", |r| 1.14 * r.powf(0.844)),
        ("Zhang et al. 2011", |r| 0.404 + r * (0.764 + r * (-0.00467 + r * 0.000035))),
    ];
    (formulas.into_iter())
        .flat_map(|(who, formula)| {
            let twice = move |s: Setting| Setting { aspect_ratio: formula(s.aspect_ratio), ..s };
            let not = move |s: Setting| Setting { aspect_ratio: inverse(formula, s.aspect_ratio), ..s };
            [
                valid(&format!("r_p for r_e (r_e taken as r_p of {who})"), twice),
                valid(&format!("r_p for r_e (r_p whose r_e by {who} was asked)"), not),
            ]
        })
        .collect()
}

/// As [`moved`], if the resulting aspect ratio is valid.
fn valid(name: &str, spoil: impl Fn(Setting) -> Setting + Send + Sync + 'static) -> Mistake {
    linear(name, move |setting, time| {
        let spoilt = spoil(*setting);
        let is_ratio = spoilt.aspect_ratio.is_finite() && spoilt.aspect_ratio > 0.0;
        is_ratio.then(|| right_map(&spoilt, time)).flatten()
    })
}

/// r with f(r) = value between r = 2 and 200, where the formulas rise; NaN if there is no such r.
pub(super) fn inverse(formula: fn(f64) -> f64, value: f64) -> f64 {
    let (mut low, mut high) = (2.0, 200.0);
    if !(formula(low)..=formula(high)).contains(&value) {
        return f64::NAN;
    }
    while high - low > 1e-14 * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if formula(middle) < value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
