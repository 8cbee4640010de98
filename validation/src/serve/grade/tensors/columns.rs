//! The columns of an answer about tensors, by their names.

use crate::methods::tensors::Fourth;
use crate::methods::tensors::wrong::closures::Stand;
use crate::serve::problems::Problem;
use nalgebra::Matrix3;

/// The indices in the name of a component, from 0; `None` for another column.
pub(in crate::serve::grade) fn indices(name: &str) -> Option<Vec<usize>> {
    name.strip_prefix('a')?.chars().map(|digit| (digit.to_digit(10)? as usize).checked_sub(1)).collect()
}

/// The values of the problem's columns for a, with the fourth moments by the closure; `None` for other columns.
pub(super) fn values(problem: &Problem, closure: &Stand, a: &Matrix3<f64>) -> Option<Vec<f64>> {
    let fourth = closure.fourth(a);
    let value = |name: &String| match indices(name)?[..] {
        [i, j] => Some(a[(i, j)]),
        [i, j, k, l] => Some(fourth.at(i, j, k, l)),
        _ => None,
    };
    problem.columns[1..].iter().map(value).collect()
}

/// a_ijkl from a row of all its components; `None` if the problem has other columns.
pub(super) fn fourth_of(problem: &Problem, row: &[f64]) -> Option<Fourth> {
    let sorted = |mut at: Vec<usize>| {
        at.sort_unstable();
        at
    };
    let names = problem.columns[1..].iter().map(|name| indices(name).map(sorted));
    let names: Vec<_> = names.collect::<Option<_>>()?;
    let value = |at: [usize; 4]| Some(row[names.iter().position(|name| *name == sorted(at.to_vec()))?]);
    value([0; 4])?;
    Some(Fourth::from_fn(|i, j, k, l| value([i, j, k, l]).unwrap_or(f64::NAN)))
}

#[test]
fn a_row_of_fourth_moments_is_read_by_its_names() {
    use crate::methods::tensors::wrong::closures::CLOSURES;
    let [second, fourth] = ["folgar-tucker-mixed", "folgar-tucker-fourth-mixed"].map(crate::serve::problems::loaded);
    let a = Matrix3::new(0.5, 0.1, -0.05, 0.1, 0.3, 0.02, -0.05, 0.02, 0.2);
    // The linear closure, whose a_ijkl is symmetric in all indices.
    let row = values(&fourth.problem, &CLOSURES[0], &a).unwrap();
    let found = fourth_of(&fourth.problem, &row).unwrap();
    assert!((found.0 - CLOSURES[0].fourth(&a).0).amax() < 1e-15);
    let row = values(&second.problem, &CLOSURES[0], &a).unwrap();
    assert_eq!((row.len(), fourth_of(&second.problem, &row)), (6, None));
}
