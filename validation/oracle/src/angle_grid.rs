//! Rods with rotary diffusion on a grid of the angles (θ, φ): a second method, which shares nothing with
//! [`crate::diffusion`].
//!
//! The density of directions is a table of values in the laboratory's axes. A meridian and the one opposite make a
//! circle, so that both angles have Fourier's derivatives (Merilees 1973, Orszag 1974); the rates of all values are one
//! dense matrix, and the density in time is its exponential. No harmonic, axis of the flow or size is chosen by the
//! program: the caller says how many rings there are, and harmonics up to a degree just below that are resolved.

use crate::reference::isotropic::{PAIRS, QUADRUPLES};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::f64::consts::PI;

/// Means over a density on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Means {
    /// The integral of the density before it is normalised. No step of the method makes it 1: what it misses is an
    /// error of the method.
    pub mass: f64,
    /// ⟨|p₃|⟩. Exchange axes for the others.
    pub third_projection: f64,
    /// a_ij in the order of [`PAIRS`].
    pub second: [f64; 6],
    /// a_ijkl in the order of [`QUADRUPLES`].
    pub fourth: [f64; 15],
}

/// Means of rods that are isotropic at t = 0, at `time_s` (∞: once they are steady).
///
/// `gradient_per_s` has ∂u_i/∂x_j in row i and column j; `shape` is Λ; `diffusivity_per_s` is D_r. `rings` is even.
/// `None` if the steady density is not unique.
pub fn means(
    gradient_per_s: [[f64; 3]; 3],
    shape: f64,
    diffusivity_per_s: f64,
    rings: usize,
    time_s: f64,
) -> Option<Means> {
    if time_s < f64::INFINITY {
        return Some(through(&[(gradient_per_s, diffusivity_per_s, time_s)], shape, rings));
    }
    let grid = Grid::new(rings, mirrors(&gradient_per_s));
    let rates = grid.rates(&Matrix3::from_fn(|i, j| gradient_per_s[i][j]), shape, diffusivity_per_s, true);
    let one = DVector::from_element(grid.points.len(), 1.0);
    // A ψ = 0 with w·ψ = 1 is (A + D_r 1 wᵀ) ψ = D_r 1.
    let mass = DVector::from_iterator(one.len(), (0..one.len()).map(|class| grid.mass(class)));
    let density = (rates + &one * mass.transpose() * diffusivity_per_s).lu().solve(&(one * diffusivity_per_s))?;
    Some(grid.means(&density))
}

/// Means of rods that are isotropic at t = 0 at the end of flows one after another, each with its gradient in 1/s, its
/// D_r in 1/s and its duration in s.
pub fn through(flows: &[([[f64; 3]; 3], f64, f64)], shape: f64, rings: usize) -> Means {
    let grid = Grid::new(rings, [0, 1, 2].map(|axis| flows.iter().all(|(l, ..)| mirrors(l)[axis])));
    let isotropic = DVector::from_element(grid.points.len(), 1.0 / (4.0 * PI));
    let density = flows.iter().fold(isotropic, |density, (l, diffusivity, duration_s)| {
        let rates = grid.rates(&Matrix3::from_fn(|i, j| l[i][j]), shape, *diffusivity, true);
        (rates * *duration_s).exp() * density
    });
    grid.means(&density)
}

/// Means of rods that are isotropic at t = 0, at `time_s` in the flow L cos 2πt/T, by Taylor's series in steps of
/// `step_s`. The arguments are as in [`means`].
pub fn oscillating(
    gradient_per_s: [[f64; 3]; 3],
    shape: f64,
    diffusivity_per_s: f64,
    rings: usize,
    [period_s, time_s, step_s]: [f64; 3],
) -> Means {
    const TERMS: usize = 30;
    let grid = Grid::new(rings, mirrors(&gradient_per_s));
    let still = grid.rates(&Matrix3::zeros(), shape, diffusivity_per_s, true);
    let flowing = grid.rates(&Matrix3::from_fn(|i, j| gradient_per_s[i][j]), shape, 0.0, true);
    let mut density = DVector::from_element(grid.points.len(), 1.0 / (4.0 * PI));
    let steps = (time_s / step_s).ceil();
    let (step_s, turn) = (time_s / steps, 2.0 * PI / period_s * (time_s / steps));
    for step in 0..steps as u64 {
        // cos(φ + h) = Σ cos(φ + kπ/2) h^k/k!.
        let phase = step as f64 * turn;
        let cosines = (0..TERMS).scan(1.0, |power, k| {
            let now = *power * (phase + k as f64 * PI / 2.0).cos();
            *power *= turn / (k + 1) as f64;
            Some(now)
        });
        let cosines: Vec<f64> = cosines.collect();
        let (mut term, mut moved) = (density.clone(), Vec::new());
        for k in 0..TERMS {
            moved.push(&flowing * &term);
            let flow = moved.iter().rev().zip(&cosines).map(|(moved, cosine)| moved * *cosine);
            term = (&still * &term + flow.fold(DVector::zeros(density.len()), |sum, one| sum + one))
                * (step_s / (k + 1) as f64);
            density += &term;
        }
    }
    grid.means(&density)
}

/// a_ij and a_ijkl of rods that are at random in the plane of axes 1 and 2 at t = 0.
///
/// No grid holds that density. The mean of f(p(t)) over rods that start along p is a smooth function of p, with
/// ∂f/∂t = ṗ·∇f + D_r∇²f (Kolmogorov's backward equation); its mean over the plane is what is asked for.
pub fn planar_moments(
    gradient_per_s: [[f64; 3]; 3],
    shape: f64,
    diffusivity_per_s: f64,
    rings: usize,
    time_s: f64,
) -> ([f64; 6], [f64; 15]) {
    // Products of components have not the mirrors of the flow.
    let grid = Grid::new(rings, [false; 3]);
    let rates = grid.rates(&Matrix3::from_fn(|i, j| gradient_per_s[i][j]), shape, diffusivity_per_s, false);
    let starts = DMatrix::from_fn(grid.points.len(), 6 + 15, |point, k| {
        let (theta, phi) = grid.angles(grid.points[point]);
        let p = direction(theta, phi);
        match PAIRS.get(k) {
            Some((i, j)) => p[*i] * p[*j],
            None => QUADRUPLES[k - 6].iter().map(|i| p[i - 1]).product(),
        }
    });
    let means = (rates * time_s).exp() * starts;
    // Fourier's interpolation along each circle of meridians to θ = π/2, which is between two rings.
    let around = 2 * rings;
    let weight = |j: usize| {
        let x = PI * (j as f64 + 0.5) / rings as f64 - PI / 2.0;
        (rings as f64 * x).sin() / (around as f64 * (0.5 * x).tan())
    };
    let of = |k: usize| {
        let ring = |j: usize| (0..around).map(|at| means[(grid.class(j, at), k)]).sum::<f64>() / around as f64;
        // The opposite meridian's rings have the angles 2π − θ, and the same sums.
        (0..rings).map(|j| (weight(j) + weight(around - 1 - j)) * ring(j)).sum::<f64>()
    };
    // The mean of 1 is 1: as with the mass of a density, what it misses is the rounding of the exponential.
    let one: f64 = (0..3).map(of).sum();
    (std::array::from_fn(|k| of(k) / one), std::array::from_fn(|k| of(6 + k) / one))
}

/// True for each axis whose reflection leaves the flow unchanged.
fn mirrors(l: &[[f64; 3]; 3]) -> [bool; 3] {
    [0, 1, 2].map(|i| (0..3).all(|j| i == j || (l[i][j] == 0.0 && l[j][i] == 0.0)))
}

/// Points at θ = π(j + ½)/N and φ = π(k + ½)/N, j < N, k < 2N; those that p ≡ −p and reflections make equal are one.
struct Grid {
    rings: usize,
    /// (j, k) of one point of each class.
    points: Vec<(usize, usize)>,
    /// The class of the point (j, k), at j·2N + k.
    class: Vec<usize>,
}

impl Grid {
    fn new(rings: usize, mirrors: [bool; 3]) -> Self {
        let around = 2 * rings;
        let images = |(j, k): (usize, usize)| {
            let mut images = vec![(j, k)];
            let mut add = |image: &dyn Fn((usize, usize)) -> (usize, usize)| {
                let more: Vec<_> = images.iter().map(|point| image(*point)).collect();
                images.extend(more);
            };
            add(&|(j, k)| (rings - 1 - j, (k + rings) % around));
            if mirrors[0] {
                add(&|(j, k)| (j, (around + rings - 1 - k) % around));
            }
            if mirrors[1] {
                add(&|(j, k)| (j, around - 1 - k));
            }
            if mirrors[2] {
                add(&|(j, k)| (rings - 1 - j, k));
            }
            images
        };
        let (mut points, mut class) = (Vec::new(), vec![0; rings * around]);
        for point in (0..rings).flat_map(|j| (0..around).map(move |k| (j, k))) {
            let images = images(point);
            if images.iter().all(|image| *image >= point) {
                images.iter().for_each(|(j, k)| class[j * around + k] = points.len());
                points.push(point);
            }
        }
        Self { rings, points, class }
    }

    fn class(&self, j: usize, k: usize) -> usize {
        self.class[j * 2 * self.rings + k]
    }

    fn angles(&self, (j, k): (usize, usize)) -> (f64, f64) {
        let angle = |k: usize| PI * (k as f64 + 0.5) / self.rings as f64;
        (angle(j), angle(k))
    }

    /// For a density, the matrix of ∂ψ/∂t = −θ̇ ∂ψ/∂θ − φ̇ ∂ψ/∂φ − ψ∇·ṗ + D_r∇²ψ, ∇·ṗ = Λ(tr D − 3 p·Dp), else of
    /// ∂f/∂t = θ̇ ∂f/∂θ + φ̇ ∂f/∂φ + D_r∇²f.
    fn rates(&self, l: &Matrix3<f64>, shape: f64, diffusivity: f64, density: bool) -> DMatrix<f64> {
        let (sign, spread) = if density { (1.0, 1.0) } else { (-1.0, 0.0) };
        let around = 2 * self.rings;
        let (strain, turning) = ((l + l.transpose()) * 0.5, (l - l.transpose()) * 0.5);
        let mut rates = DMatrix::zeros(self.points.len(), self.points.len());
        for (row, (j, k)) in self.points.iter().copied().enumerate() {
            let (theta, phi) = self.angles((j, k));
            let p = direction(theta, phi);
            let stretched = strain * p;
            let rate = (turning * p + (stretched - p * p.dot(&stretched)) * shape) * sign;
            let along = direction(theta + PI / 2.0, phi);
            let across = Vector3::new(-phi.sin(), phi.cos(), 0.0);
            let (sine, cotangent) = (theta.sin(), theta.tan().recip());
            rates[(row, row)] += spread * shape * (3.0 * p.dot(&stretched) - strain.trace());
            for i in 0..around {
                let (first, second) = derivatives(around, j, i);
                let opposite = (around - 1 - i, (k + self.rings) % around);
                let (ring, meridian) = if i < self.rings { (i, k) } else { opposite };
                rates[(row, self.class(ring, meridian))] +=
                    (diffusivity * cotangent - rate.dot(&along)) * first + diffusivity * second;
                let (first, second) = derivatives(around, k, i);
                rates[(row, self.class(j, i))] +=
                    -rate.dot(&across) / sine * first + diffusivity / (sine * sine) * second;
            }
        }
        rates
    }

    /// Fejér's weights of ring `j` for ∫∫ dcos θ dφ and ∫∫ |cos θ| dcos θ dφ; the second has the even harmonics of 2θ
    /// alone.
    fn weights(&self, j: usize) -> (f64, f64) {
        let twice = 2.0 * self.angles((j, 0)).0;
        let share = |m: usize, below: f64| (m as f64 * twice).cos() / (below * (m * m) as f64 - 1.0);
        let whole: f64 = (1..self.rings / 2).map(|m| share(m, 4.0)).sum();
        let half: f64 = (2..self.rings / 2).step_by(2).map(|m| share(m, 1.0)).sum();
        let scale = PI / (self.rings * self.rings) as f64;
        (2.0 * scale * (1.0 - 2.0 * whole), scale * (1.0 - 2.0 * half))
    }

    /// The share of a class of points in the integral of the density.
    fn mass(&self, class: usize) -> f64 {
        let all = self.class.iter().enumerate().filter(|(_, other)| **other == class);
        all.map(|(at, _)| self.weights(at / (2 * self.rings)).0).sum()
    }

    fn means(&self, density: &DVector<f64>) -> Means {
        let mut means = Means { mass: 0.0, third_projection: 0.0, second: [0.0; 6], fourth: [0.0; 15] };
        for j in 0..self.rings {
            let (weight, modulus) = self.weights(j);
            for k in 0..2 * self.rings {
                let (theta, phi) = self.angles((j, k));
                let (p, value) = (direction(theta, phi), density[self.class(j, k)]);
                means.mass += weight * value;
                means.third_projection += modulus * value;
                for (mean, (a, b)) in means.second.iter_mut().zip(PAIRS) {
                    *mean += weight * value * p[a] * p[b];
                }
                for (mean, q) in means.fourth.iter_mut().zip(QUADRUPLES) {
                    *mean += weight * value * q.iter().map(|i| p[i - 1]).product::<f64>();
                }
            }
        }
        let sums = means.second.iter_mut().chain(&mut means.fourth).chain([&mut means.third_projection]);
        sums.for_each(|sum| *sum /= means.mass);
        means
    }
}

fn direction(theta: f64, phi: f64) -> Vector3<f64> {
    Vector3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// The entries of the first and second derivative of a periodic function of `count` (even) values, from value `to` to
/// `at`.
fn derivatives(count: usize, at: usize, to: usize) -> (f64, f64) {
    if at == to {
        return (0.0, -((count * count) as f64 + 2.0) / 12.0);
    }
    let half = PI * (at as f64 - to as f64) / count as f64;
    let sign = if (at + to).is_multiple_of(2) { 0.5 } else { -0.5 };
    (sign / half.tan(), -sign / half.sin().powi(2))
}
