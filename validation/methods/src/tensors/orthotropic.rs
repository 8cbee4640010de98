//! Orthotropic closures with fitted coefficients: a_1111, a_2222, a_3333 in the axes of a as polynomials of its two
//! largest eigenvalues; the other components follow from a_iikk = a_ii (Cintra & Tucker 1995).
//!
//! The coefficients were read in `closeA4.m` of charlestucker3/Fiber-Orientation-Tools, commit 266a6ee (MIT); they are
//! checked by results that others published with them (`published/tensor-models`).

use super::fourth::{Fourth, principal};
use nalgebra::{Matrix3, Vector3};

/// Rows: a_1111, a_2222, a_3333. Columns: 1, x, x², y, y², xy (Chung & Kwon 2001, Polym. Compos. 22, 636).
pub const ORW: [[f64; 6]; 3] = [
    [0.070055, 0.339376, 0.590331, -0.396796, 0.333693, 0.411944],
    [0.115177, -0.368267, 0.252880, 0.094820, 0.800181, 0.535224],
    [1.249811, -2.148297, 0.898521, -2.290157, 1.044147, 1.934914],
];

/// As [`ORW`]; of Cintra & Tucker 1995, J. Rheol. 39, 1095, as in fiberoripy, commit 08d401d (MIT).
const ORF: [[f64; 6]; 3] = [
    [0.060964, 0.371243, 0.555301, -0.369160, 0.318266, 0.371218],
    [0.124711, -0.389402, 0.258844, 0.086169, 0.796080, 0.544992],
    [1.228982, -2.054116, 0.821548, -2.260574, 1.053907, 1.819756],
];

/// Columns: a_1111, a_2222, a_3333. Rows: 1, x, y, xy, x², y², x²y, xy², x³, y³, x²y², x³y, xy³, x⁴, y⁴ (Verweyst 1998,
/// thesis, University of Illinois).
#[rustfmt::skip]
pub const ORE: [[f64; 3]; 15] = [
    [0.636256796880687, 0.636256796880687, 2.74053289560253],
    [-1.8726629637381, -3.31527229742146, -9.12196509782692],
    [-4.47970873193738, -3.03709939825406, -12.2570587036254],
    [11.9589562332320, 11.8273285968852, 34.3199018916987],
    [3.84459692420086, 6.88153952058044, 13.8294699121940],
    [11.3420924278159, 8.43677746778325, 25.8684755253884],
    [-10.9582626069691, -15.9120667157641, -37.7029118029384],
    [-20.7277994684132, -15.1515872606307, -50.2756431927485],
    [-2.11623214471004, -6.48728933641926, -10.8801761133174],
    [-12.3875632855619, -8.63891419284016, -26.9636915239716],
    [9.81598389716748, 9.32520343452661, 27.3346798054488],
    [3.47901510567439, 7.74683751713295, 15.2650686148651],
    [11.7492911177026, 7.48146870624441, 26.1134914005375],
    [0.508041387366637, 2.28476531637958, 3.4321384033477],
    [4.88366597771489, 3.59772251134254, 10.6117418066060],
];

pub(super) fn ore(a: &Matrix3<f64>) -> Fourth {
    fitted(a, |x, y| {
        let powers = [
            1.0,
            x,
            y,
            x * y,
            x * x,
            y * y,
            x * x * y,
            x * y * y,
            x.powi(3),
            y.powi(3),
            (x * y).powi(2),
            x.powi(3) * y,
            x * y.powi(3),
            x.powi(4),
            y.powi(4),
        ];
        Vector3::from_fn(|m, _| ORE.iter().zip(powers).map(|(row, power)| row[m] * power).sum())
    })
}

pub(super) fn orw(a: &Matrix3<f64>) -> Fourth {
    quadratics(a, &ORW)
}

pub(super) fn orf(a: &Matrix3<f64>) -> Fourth {
    quadratics(a, &ORF)
}

fn quadratics(a: &Matrix3<f64>, coefficients: &[[f64; 6]; 3]) -> Fourth {
    fitted(a, |x, y| {
        let powers = [1.0, x, x * x, y, y * y, x * y];
        Vector3::from_fn(|m, _| coefficients[m].iter().zip(powers).map(|(c, power)| c * power).sum())
    })
}

/// The closure in which `of` gives a_1111, a_2222, a_3333 from the two largest eigenvalues.
fn fitted(a: &Matrix3<f64>, of: impl Fn(f64, f64) -> Vector3<f64>) -> Fourth {
    let (values, axes) = principal(a);
    let fourth = of(values.x, values.y);
    // a_jjkk = ½(a_jj + a_kk − a_ii − a_jjjj − a_kkkk + a_iiii) by the three equations a_iikk = a_ii.
    let left = values - fourth;
    let mixed = Vector3::from_fn(|i, _| 0.5 * (left.sum() - 2.0 * left[i]));
    Fourth::orthotropic(&axes, &values, &mixed)
}
