//! Orthotropic closures with fitted coefficients: a_1111, a_2222, a_3333 in the axes of a as polynomials of its two
//! largest eigenvalues; the other components follow from a_iikk = a_ii (Cintra & Tucker 1995).
//!
//! The coefficients were read in `closeA4.m` of charlestucker3/Fiber-Orientation-Tools, commit 266a6ee (MIT); they are
//! checked by results that others published with them (`published/tensor-models`).

use super::fourth::{Fourth, principal};
use nalgebra::{Matrix3, Vector3};
use std::sync::LazyLock;

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

/// The exponents (of x, of y) of each row of [`ORE`] and of each column of [`ORW`].
#[rustfmt::skip]
pub(super) const ORE_POWERS: [(i32, i32); 15] = [
    (0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (3, 0), (0, 3), (2, 2), (3, 1), (1, 3), (4, 0),
    (0, 4),
];
const ORW_POWERS: [(i32, i32); 6] = [(0, 0), (1, 0), (2, 0), (0, 1), (0, 2), (1, 1)];

/// How a closure of this kind is formed: the polynomials and which eigenvalue, axis and polynomial stands where.
#[derive(Clone)]
pub(super) struct Fit {
    pub(super) powers: &'static [(i32, i32)],
    /// The coefficients of a_1111, a_2222, a_3333, one after the other.
    pub(super) coefficients: Vec<f64>,
    /// The places of the eigenvalues and of their axes, from the largest.
    pub(super) values: [usize; 3],
    pub(super) axes: [usize; 3],
    /// The polynomial of each axis, and the eigenvalues that are x and y.
    pub(super) polynomials: [usize; 3],
    pub(super) arguments: [usize; 2],
    /// a_2233, a_3311, a_1122 as they are used.
    pub(super) mixed: fn([f64; 3]) -> [f64; 3],
    /// R of a = R diag(x, y, z) Rᵀ as it is used.
    pub(super) turn: fn(Matrix3<f64>) -> Matrix3<f64>,
}

impl Fit {
    fn new(powers: &'static [(i32, i32)], coefficients: Vec<f64>) -> Self {
        let [values, axes, polynomials] = [[0, 1, 2]; 3];
        let (mixed, turn) = (|mixed| mixed, |axes| axes);
        Self { powers, coefficients, values, axes, polynomials, arguments: [0, 1], mixed, turn }
    }

    /// a_ijkl of a.
    pub(super) fn fourth(&self, a: &Matrix3<f64>) -> Fourth {
        let (values, axes) = principal(a);
        let values = Vector3::from(self.values.map(|k| values[k]));
        let axes = (self.turn)(Matrix3::from_columns(&self.axes.map(|k| axes.column(k).into_owned())));
        let [x, y] = self.arguments.map(|k| values[k]);
        let mut most = [0.0; ORE_POWERS.len()];
        let powers = &mut most[..self.powers.len()];
        powers.iter_mut().zip(self.powers).for_each(|(value, (m, n))| *value = x.powi(*m) * y.powi(*n));
        let row = |k: usize| &self.coefficients[k * powers.len()..][..powers.len()];
        let fourth = Vector3::from(self.polynomials.map(|k| row(k).iter().zip(&*powers).map(|(c, x)| c * x).sum()));
        // a_jjkk = ½(a_jj + a_kk − a_ii − a_jjjj − a_kkkk + a_iiii) by the three equations a_iikk = a_ii.
        let left = values - fourth;
        let mixed = (self.mixed)([0, 1, 2].map(|i| 0.5 * (left.sum() - 2.0 * left[i])));
        Fourth::in_axes(&axes, |i, j| if i == j { fourth[i] } else { mixed[3 - i - j] })
    }
}

pub(super) static ORE_FIT: LazyLock<Fit> =
    LazyLock::new(|| Fit::new(&ORE_POWERS, (0..3).flat_map(|k| ORE.map(|row| row[k])).collect()));
pub(super) static ORW_FIT: LazyLock<Fit> = LazyLock::new(|| Fit::new(&ORW_POWERS, ORW.concat()));
pub(super) static ORF_FIT: LazyLock<Fit> = LazyLock::new(|| Fit::new(&ORW_POWERS, ORF.concat()));
