//! The nodes in a box of parameters at which the model runs, and the polynomials fitted to its results.

use nalgebra::{DMatrix, DVector};

/// The largest number of parameters that can be fitted at once: the number of runs grows as a power of it.
pub const MOST_PARAMETERS: usize = 3;

/// Chebyshev–Lobatto nodes along each axis, and the total degree of the polynomials, by the number of parameters. There
/// are fewer coefficients than nodes, so that the polynomials smooth the noise of the runs instead of following it.
const DESIGNS: [(usize, usize); MOST_PARAMETERS] = [(7, 4), (7, 6), (8, 6)];

/// From so many parameters on, nodes are those whose numbers along the axes are all even or all odd: 128 of 512, which
/// are enough for degree 6 (S. De Marchi, M. Vianello & Y. Xu, BIT 49 (2009) 55).
const THINNED: usize = 3;

/// The degree of a term in each parameter, 0 beyond the last one.
type Degrees = [usize; MOST_PARAMETERS];

/// Chebyshev polynomials over the box [−1, 1]^p and the nodes to which they are fitted (least squares).
#[derive(Clone, Debug)]
pub struct Basis {
    degrees: Vec<Degrees>,
    /// All nodes, each with its coordinates.
    pub nodes: Vec<Vec<f64>>,
    /// Indices of the nodes in the inner half of the box.
    pub inner: Vec<usize>,
    /// Maps values at the nodes to coefficients: a row for each coefficient, a column for each node.
    pub project: DMatrix<f64>,
    /// Maps coefficients to those of the residual that polynomials of one degree less leave at the nodes: terms ×
    /// terms. It measures how good the polynomials are.
    pub missed: DMatrix<f64>,
}

impl Basis {
    /// The basis for `parameters` parameters, 1 to [`MOST_PARAMETERS`].
    pub fn new(parameters: usize) -> Self {
        let (along, degree) = DESIGNS[parameters.clamp(1, MOST_PARAMETERS) - 1];
        let nodes = nodes(parameters, along, parameters >= THINNED);
        let degrees: Vec<Degrees> = (grid(parameters, degree + 1).into_iter())
            .filter(|degrees| degrees.iter().sum::<usize>() <= degree)
            .map(|degrees| std::array::from_fn(|k| degrees.get(k).copied().unwrap_or(0)))
            .collect();
        let project = projection(&degrees, &nodes);
        let highest = |degrees: &Degrees| degrees.iter().sum::<usize>() == degree;
        let lower: Vec<_> = degrees.iter().filter(|d| !highest(d)).copied().collect();
        // Terms below the highest degree leave no residual; from each of the others, the best fit by lower terms is
        // subtracted.
        let nearest = projection(&lower, &nodes) * design(&degrees, &nodes);
        let mut missed = DMatrix::identity(degrees.len(), degrees.len());
        let kept = (0..degrees.len()).filter(|k| !highest(&degrees[*k]));
        for (row, term) in kept.enumerate() {
            let less = missed.row(term) - nearest.row(row);
            missed.set_row(term, &less);
        }
        let is_inner = |k: &usize| nodes[*k].iter().all(|place| place.abs() < 0.6);
        Self { missed, project, degrees, inner: (0..nodes.len()).filter(is_inner).collect(), nodes }
    }

    /// The value of every term at a place of the box.
    pub fn terms(&self, place: &[f64]) -> DVector<f64> {
        terms(&self.degrees, place)
    }

    /// The derivative of every term by every parameter: a row for each term, a column for each parameter.
    pub fn slopes_of_all(&self, place: &[f64]) -> DMatrix<f64> {
        let all: [usize; MOST_PARAMETERS] = std::array::from_fn(|k| k);
        self.slopes(place, &all[..place.len()])
    }

    /// The derivative of every term by the parameters `axes`: a row for each term, a column for each of them.
    pub fn slopes(&self, place: &[f64], axes: &[usize]) -> DMatrix<f64> {
        let values = values(place);
        DMatrix::from_fn(self.degrees.len(), axes.len(), |term, by| {
            let factor =
                |(k, degree): (usize, &usize)| if k == axes[by] { values[k][*degree].1 } else { values[k][*degree].0 };
            self.degrees[term].iter().enumerate().map(factor).product()
        })
    }
}

/// The nodes, `along` each axis; if `thinned`, those whose numbers are all even or all odd.
fn nodes(parameters: usize, along: usize, thinned: bool) -> Vec<Vec<f64>> {
    let place = |k: usize| -(std::f64::consts::PI * k as f64 / (along - 1) as f64).cos();
    let alike = |index: &Vec<usize>| !thinned || index.iter().all(|k| k % 2 == index[0] % 2);
    let nodes = grid(parameters, along).into_iter().filter(alike);
    nodes.map(|index| index.into_iter().map(place).collect()).collect()
}

/// All combinations of `axes` numbers from 0 to `along` − 1, of which the first varies fastest.
pub fn grid(axes: usize, along: usize) -> Vec<Vec<usize>> {
    (0..along.pow(axes as u32))
        .map(|mut k| {
            let digit = |_| {
                let digit = k % along;
                k /= along;
                digit
            };
            (0..axes).map(digit).collect()
        })
        .collect()
}

fn terms(degrees: &[Degrees], place: &[f64]) -> DVector<f64> {
    let values = values(place);
    let term = |degrees: &Degrees| (degrees.iter().zip(&values)).map(|(degree, of)| of[*degree].0).product();
    DVector::from_iterator(degrees.len(), degrees.iter().map(term))
}

/// The polynomials at each coordinate of a place, and at 0 beyond the last one.
fn values(place: &[f64]) -> [[(f64, f64); 7]; MOST_PARAMETERS] {
    std::array::from_fn(|k| chebyshev(place.get(k).copied().unwrap_or(0.0)))
}

/// T_k(x) and its derivative for all degrees in use.
fn chebyshev(x: f64) -> [(f64, f64); 7] {
    let mut all = [(1.0, 0.0); 7];
    all[1] = (x, 1.0);
    for k in 2..all.len() {
        let ((before, slope_before), (last, slope)) = (all[k - 2], all[k - 1]);
        all[k] = (2.0 * x * last - before, 2.0 * last + 2.0 * x * slope - slope_before);
    }
    all
}

/// The terms at the nodes, with a row for each node.
fn design(degrees: &[Degrees], nodes: &[Vec<f64>]) -> DMatrix<f64> {
    let rows: Vec<_> = nodes.iter().map(|node| terms(degrees, node).transpose()).collect();
    DMatrix::from_rows(&rows)
}

/// The pseudo-inverse of `design`; NaN if it has none.
fn projection(degrees: &[Degrees], nodes: &[Vec<f64>]) -> DMatrix<f64> {
    let design = design(degrees, nodes);
    let normal = design.tr_mul(&design).cholesky();
    normal.map_or_else(
        || DMatrix::from_element(degrees.len(), nodes.len(), f64::NAN),
        |normal| normal.solve(&design.transpose()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polynomial of total degree 3 in up to three parameters, and its derivatives.
    fn cubic(place: &[f64]) -> (f64, Vec<f64>) {
        let [x, y, z] = std::array::from_fn(|k| place.get(k).copied().unwrap_or(0.0));
        let value = 1.0 + x - 2.0 * y + x * y * z + 0.5 * x.powi(3) - y * y * x;
        let slopes = [1.0 + y * z + 1.5 * x * x - y * y, -2.0 + x * z - 2.0 * y * x, x * y];
        (value, slopes[..place.len()].to_vec())
    }

    #[test]
    fn a_cubic_is_met_with_its_slopes_in_one_to_three_parameters() {
        for parameters in 1..=MOST_PARAMETERS {
            let basis = Basis::new(parameters);
            let values = DVector::from_iterator(basis.nodes.len(), basis.nodes.iter().map(|node| cubic(node).0));
            let coefficients = &basis.project * values;
            for place in [[0.3, -0.7, 0.1], [-1.0, 1.0, 1.0], [0.0, 0.0, 0.0]] {
                let place = &place[..parameters];
                let (value, slopes) = cubic(place);
                let found = basis.terms(place).dot(&coefficients);
                // The rounding of sums of about twenty terms of order 1.
                assert!((found - value).abs() < 1e-13, "{found} {value}");
                let found = basis.slopes_of_all(place).tr_mul(&coefficients);
                for (found, slope) in found.iter().zip(slopes) {
                    assert!((found - slope).abs() < 1e-12, "{found} {slope}");
                }
            }
        }
    }

    #[test]
    fn the_lower_degree_misses_what_only_the_higher_can_have() {
        let basis = Basis::new(1);
        let missed = |of: fn(&[f64]) -> f64| {
            let values = DVector::from_iterator(7, basis.nodes.iter().map(|node| of(node)));
            &basis.missed * &basis.project * &values
        };
        let quartic = missed(|node| 8.0 * node[0].powi(4) - 8.0 * node[0].powi(2) + 1.0);
        assert!((quartic[4] - 1.0).abs() < 1e-14, "{quartic}");
        let cubic = missed(|node| cubic(node).0);
        assert!(cubic.amax() < 1e-14, "{cubic}");
    }

    /// The largest sum of |weights| by which a place depends on the nodes, over a grid that has the corners.
    fn amplified(terms_at: impl Fn(&[f64]) -> DVector<f64>, project: &DMatrix<f64>, parameters: usize) -> f64 {
        let place = |k: usize| -1.0 + 0.2 * k as f64;
        let places = grid(parameters, 11).into_iter().map(|index| index.into_iter().map(place).collect::<Vec<_>>());
        shearbed_oracle::worst(places.map(|place| project.tr_mul(&terms_at(&place)).lp_norm(1)))
    }

    /// Polynomials through a quarter of the nodes follow errors at the nodes hardly more than through all of them; the
    /// control: through the 91 of the next coarser grid, which cannot tell T₆ of one parameter from T₆ of another.
    #[test]
    fn a_quarter_of_the_nodes_is_enough_in_three_parameters() {
        let basis = Basis::new(3);
        let of = |along: usize, thinned: bool| {
            let nodes = nodes(3, along, thinned);
            (nodes.len(), amplified(|place| basis.terms(place), &projection(&basis.degrees, &nodes), 3))
        };
        let own = amplified(|place| basis.terms(place), &basis.project, 3);
        let ((all, of_all), (quarter, of_quarter), (too_few, of_too_few)) = (of(8, false), of(8, true), of(7, true));
        assert_eq!((all, quarter, too_few, basis.nodes.len()), (512, 128, 91, 128));
        assert!((own - of_quarter).abs() < 1e-9 && own < 2.0 * of_all, "{own} {of_all}");
        assert!(of_too_few.is_nan() || of_too_few > 10.0 * own, "{of_too_few}");
    }
}
