//! Compares with published results of others in `validation/published/tensor-models`.

use super::{SHEAR, matrix, turned};
use crate::tensors::{Closure, Equation, Model, at, isotropic, steady};
use nalgebra::Matrix3;

const TABLE: &str = include_str!("../../../../published/tensor-models/values.csv");

struct Row {
    source: String,
    model: String,
    closure: Closure,
    /// C_I, then the model's other parameters, each with half a unit of its last printed digit.
    parameters: Vec<(f64, f64)>,
    /// The strain; `None` for the steady state.
    strain: Option<f64>,
    place: (usize, usize),
    value: (f64, f64),
}

fn printed(text: &str) -> (f64, f64) {
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    (text.parse().unwrap(), 0.5 * 0.1f64.powi(decimals as i32))
}

fn rows() -> Vec<Row> {
    let row = |line: &str| {
        let f: Vec<_> = line.split(',').collect();
        let index = |at: usize| usize::from(f[6].as_bytes()[at] - b'1');
        Row {
            source: f[0].into(),
            model: f[1].into(),
            closure: Closure::ALL.into_iter().find(|c| c.name().to_lowercase() == f[2]).unwrap(),
            parameters: std::iter::once(f[3])
                .chain(f[4].split(';').filter(|text| !text.is_empty()))
                .map(printed)
                .collect(),
            strain: f[5].parse().ok(),
            place: (index(1), index(2)),
            value: printed(f[7]),
        }
    };
    TABLE.lines().skip(1).map(row).collect()
}

impl Row {
    fn found(&self, p: &[f64]) -> f64 {
        let model = match self.model.as_str() {
            "folgar-tucker" => Model::FolgarTucker { c_i: p[0] },
            "iard" => Model::Iard { c_i: p[0], c_m: p[1] },
            "pard" => Model::Pard { c_i: p[0], omega: p[1] },
            "mrd" => Model::Mrd { c_i: p[0], d: [p[1], p[2], p[3]] },
            other => panic!("{other}"),
        };
        let equation = Equation { gradient_per_s: matrix(SHEAR), shape_factor: 1.0, closure: self.closure, model };
        // An isotropic a has no axes of its own: MRD and pARD start slightly off it.
        let start = match model {
            Model::Mrd { .. } | Model::Pard { .. } => isotropic() * 0.99 + turned([0.6, 0.3, 0.1]) * 0.01,
            _ => isotropic(),
        };
        let found: Matrix3<f64> = match self.strain {
            Some(strain) => at(&equation, &start, &[strain], 1e-13).unwrap()[0],
            None => steady(&equation, &start).unwrap(),
        };
        found[self.place]
    }
}

/// Tolerances: 10⁻⁹ for rows of ten digits, half a unit for seven digits, 10⁻⁴ for drifting rows; for fitted rows, what
/// the printed digits of parameters and value allow.
#[test]
fn results_of_others_are_met() {
    let mut seen = 0;
    for row in rows() {
        let p: Vec<f64> = row.parameters.iter().map(|(value, _)| *value).collect();
        let found = row.found(&p);
        let allowed = match (row.source.as_str(), row.model.as_str()) {
            ("nimasam", "folgar-tucker") if row.value.1 < 1e-9 => 1e-9,
            ("nimasam", "folgar-tucker") => row.value.1,
            ("nimasam", _) => 1e-4,
            _ => {
                let moved = |k: usize| {
                    let mut other = p.clone();
                    other[k] += row.parameters[k].1;
                    (row.found(&other) - found).abs()
                };
                row.value.1 + (0..p.len()).map(moved).sum::<f64>()
            }
        };
        let off = (found - row.value.0).abs();
        let name = format!("{} {:?} {:?} {p:?}", row.model, row.closure, row.place);
        assert!(off <= allowed, "{name}: {found} off by {off:e}, allowed {allowed:e}");
        // A mistake: C_I off by 2 %.
        let mut wrong = p.clone();
        wrong[0] *= 1.02;
        let strict = row.source == "nimasam";
        assert!(!strict || (row.found(&wrong) - row.value.0).abs() > allowed, "{name}");
        seen += 1;
    }
    assert_eq!(seen, 28);
}
