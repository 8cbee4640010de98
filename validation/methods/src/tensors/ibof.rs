//! The invariant-based optimal fitting closure (Chung & Kwon 2002, J. Rheol. 46, 169).
//!
//! a_ijkl = β₁S(δδ) + β₂S(δa) + β₃S(aa) + β₄S(δaa) + β₅S(a aa) + β₆S(aa aa), S the symmetric part. β₃, β₄, β₆ are
//! polynomials of degree 5 in the invariants; the other three follow from a_ijkk = a_ij. The 63 coefficients were read
//! in `closeA4.m` of charlestucker3/Fiber-Orientation-Tools, commit 266a6ee (MIT), and are the same in fiberoripy,
//! commit 08d401d (MIT).

use super::fourth::Fourth;
use nalgebra::Matrix3;
use std::sync::LazyLock;

/// The exponents (of II, of III) of each row of `COEFFICIENTS`.
#[rustfmt::skip]
pub const POWERS: [(i32, i32); 21] = [
    (0, 0), (1, 0), (2, 0), (0, 1), (0, 2), (1, 1), (2, 1), (1, 2), (3, 0), (0, 3), (3, 1),
    (2, 2), (1, 3), (4, 0), (0, 4), (4, 1), (3, 2), (2, 3), (1, 4), (5, 0), (0, 5),
];

/// The coefficients of β₃, β₄, β₆.
#[rustfmt::skip]
pub const COEFFICIENTS: [[f64; 3]; 21] = [
    [0.24940908165786e2, -0.497217790110754e0, 0.234146291570999e2],
    [-0.435101153160329e3, 0.234980797511405e2, -0.412048043372534e3],
    [0.372389335663877e4, -0.391044251397838e3, 0.319553200392089e4],
    [0.703443657916476e4, 0.153965820593506e3, 0.573259594331015e4],
    [0.823995187366106e6, 0.152772950743819e6, -0.485212803064813e5],
    [-0.133931929894245e6, -0.213755248785646e4, -0.605006113515592e5],
    [0.880683515327916e6, -0.400138947092812e4, -0.477173740017567e5],
    [-0.991630690741981e7, -0.185949305922308e7, 0.599066486689836e7],
    [-0.159392396237307e5, 0.296004865275814e4, -0.110656935176569e5],
    [0.800970026849796e7, 0.247717810054366e7, -0.460543580680696e8],
    [-0.237010458689252e7, 0.101013983339062e6, 0.203042960322874e7],
    [0.379010599355267e8, 0.732341494213578e7, -0.556606156734835e8],
    [-0.337010820273821e8, -0.147919027644202e8, 0.567424911007837e9],
    [0.322219416256417e5, -0.104092072189767e5, 0.128967058686204e5],
    [-0.257258805870567e9, -0.635149929624336e8, -0.152752854956514e10],
    [0.214419090344474e7, -0.247435106210237e6, -0.499321746092534e7],
    [-0.449275591851490e8, -0.902980378929272e7, 0.132124828143333e9],
    [-0.213133920223355e8, 0.724969796807399e7, -0.162359994620983e10],
    [0.157076702372204e10, 0.487093452892595e9, 0.792526849882218e10],
    [-0.232153488525298e5, 0.138088690964946e5, 0.466767581292985e4],
    [-0.395769398304473e10, -0.160162178614234e10, -0.128050778279459e11],
];

/// The terms of β₁, β₂, β₅: the place of 1, β₃, β₄ or β₆, the exponents (of II, of III), and the number before them.
type Terms = Vec<(usize, (i32, i32), f64)>;

/// β₁, β₂, β₅ by a_ijkk = a_ij.
#[rustfmt::skip]
fn relations() -> [Terms; 3] {
    const ONE: (i32, i32) = (0, 0);
    const II: (i32, i32) = (1, 0);
    const III: (i32, i32) = (0, 1);
    [
        vec![
            (0, ONE, -0.6 / 7.0),
            (1, ONE, 0.12 / 7.0), (1, II, 0.48 / 7.0), (1, III, 0.32),
            (2, ONE, -0.12), (2, II, 0.32), (2, III, 0.56),
            (3, ONE, -0.6 / 35.0), (3, III, 4.8 / 35.0), (3, II, 2.4 / 35.0), (3, (1, 1), -0.64),
            (3, (2, 0), -4.8 / 35.0),
        ],
        vec![
            (0, ONE, 6.0 / 7.0),
            (1, ONE, -1.2 / 7.0), (1, II, -4.8 / 7.0),
            (2, ONE, 0.2), (2, II, -1.2),
            (3, ONE, 1.2 / 7.0), (3, III, -4.0 / 7.0), (3, II, -4.8 / 7.0), (3, (2, 0), 9.6 / 7.0),
        ],
        vec![(1, ONE, -0.8), (2, ONE, -1.4), (3, ONE, -1.2), (3, II, 1.6)],
    ]
}

/// How this closure is formed.
#[derive(Clone)]
pub(super) struct Fit {
    /// The coefficients of β₃, β₄, β₆, one after the other, and the exponents of all.
    pub(super) coefficients: Vec<f64>,
    pub(super) powers: [(i32, i32); 21],
    pub(super) relations: [Terms; 3],
    /// II and III.
    pub(super) invariants: fn(&Matrix3<f64>) -> [f64; 2],
    /// A number before β₁ to β₆, 1, and the β that stands in each place.
    pub(super) weights: [f64; 6],
    pub(super) places: [usize; 6],
    /// The number of pairings of i, j, k, l that are averaged.
    pub(super) pairings: usize,
}

impl Fit {
    fn new() -> Self {
        Self {
            coefficients: (0..3).flat_map(|k| COEFFICIENTS.map(|row| row[k])).collect(),
            powers: POWERS,
            relations: relations(),
            invariants: |a| [0.5 * (a.trace().powi(2) - (a * a).trace()), a.determinant()],
            weights: [1.0; 6],
            places: [0, 1, 2, 3, 4, 5],
            pairings: 3,
        }
    }

    /// a_ijkl of a.
    pub(super) fn fourth(&self, a: &Matrix3<f64>) -> Fourth {
        let square = a * a;
        let [second, third] = (self.invariants)(a);
        let power = |(m, n): (i32, i32)| second.powi(m) * third.powi(n);
        let powers = self.powers.map(power);
        let row = |k: usize| &self.coefficients[k * powers.len()..][..powers.len()];
        let [b3, b4, b6] = [0, 1, 2].map(|k| row(k).iter().zip(&powers).map(|(c, x)| c * x).sum());
        let fitted: [f64; 4] = [1.0, b3, b4, b6];
        let related = |terms: &Terms| terms.iter().map(|(k, powers, c)| c * fitted[*k] * power(*powers)).sum();
        let [b1, b2, b5] = self.relations.each_ref().map(related);
        let betas = [b1, b2, b3, b4, b5, b6];
        let one = Matrix3::identity();
        let tensors = [(one, one), (one, *a), (*a, *a), (one, square), (*a, square), (square, square)];
        let parts = [0, 1, 2, 3, 4, 5]
            .map(|k| (self.weights[k] * betas[self.places[k]] / (2 * self.pairings) as f64, tensors[k]));
        Fourth::from_fn(|i, j, k, l| {
            let pairings = [[(i, j), (k, l)], [(i, k), (j, l)], [(i, l), (j, k)]];
            let part = |(beta, (p, q)): &(f64, (Matrix3<f64>, Matrix3<f64>))| {
                beta * pairings[..self.pairings].iter().map(|[m, n]| p[*m] * q[*n] + p[*n] * q[*m]).sum::<f64>()
            };
            parts.iter().map(part).sum()
        })
    }
}

pub(super) static FIT: LazyLock<Fit> = LazyLock::new(Fit::new);
