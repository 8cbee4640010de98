//! A naive reference for the fibre-collision model of Lee & Springer (J. Reinf. Plast. Compos. 1, 279, 1982).
//!
//! Test against something too simple to be wrong, and test that too: every rod and every pair is visited in every
//! step, all quantities are physical (mm, s, rad), and the arithmetic is the paper's, equation by equation. It shares
//! no code with the simulator it judges, only the written protocol of random numbers and of the order in a step.
//! Axes: 1 gradient, 2 flow, 3 vorticity; u = L x with L_ij = du_i/dx_j; p = (sin th cos ph, sin th sin ph, cos th).

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Dxsm;
use std::f64::consts::TAU;

/// SplitMix64's increment, 2^64 over the golden ratio.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Purposes of the random streams, so that one use of chance never shifts another.
const ASPECT_RATIOS: u64 = 0;
const ORIENTATIONS: u64 = 1;
const POSITIONS: u64 = 2;
const COLLISIONS: u64 = 3;
const REPLACEMENTS: u64 = 4;

/// Orientations at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// phi = 2 pi R4, cos theta = 1 - 2 R5 (eq. 12).
    Isotropic,
    /// Every rod at the same angles.
    Fixed {
        /// From axis 1 towards axis 2, rad.
        phi_rad: f64,
        /// From axis 3, rad.
        theta_rad: f64,
    },
}

/// How a colliding rod is moved over the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Update {
    /// p turns about p x pdot' by |pdot'| dt: A.14 without its pole.
    Rotation,
    /// A.14 to the letter, with the corrected A.13.
    Angles,
}

/// Deliberate errors: a check that a sabotaged model passes too shows nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// The change of a collision is added with the wrong sign (A.10).
    KickSign,
    /// v' = v_A + v_B in place of half of it (A.10).
    SumInsteadOfMean,
    /// The arms of A and B are exchanged.
    ArmsSwapped,
    /// |r| in place of the signed arm r.
    ArmUnsigned,
    /// V_c = V_tr: omega x r is left out of A.7.
    SpinIgnored,
    /// V_tr is not subtracted again (A.12).
    TranslationKept,
    /// A.13 as printed; shows with `Update::Angles` only.
    PrintedA13,
    /// Lambda = 1 in free motion.
    LambdaOne,
    /// T, and so dt, is half of eq. 15.
    PeriodHalved,
    /// cm^-3 converted as if it were cm^-2.
    ConcentrationUnits,
    /// Collides where P_c < R (eqs. 8, 9).
    ProbabilityComplement,
    /// m + 1 in place of m (eq. 7).
    ProbabilityExponent,
    /// Rod i + 1 (mod N) in place of the nearest one.
    AnyNeighbour,
    /// Candidates taken by index, not closest first.
    IndexOrder,
    /// x_1 = H R in place of H sqrt(R) (eq. 14).
    ReplacementUniform,
    /// A leaving rod keeps its x_1 and x_3; nothing is drawn.
    ReplacementNone,
}

impl Mistake {
    /// All of them, for checks that try each.
    #[rustfmt::skip]
    pub const ALL: [Self; 16] = [
        Self::KickSign, Self::SumInsteadOfMean, Self::ArmsSwapped, Self::ArmUnsigned, Self::SpinIgnored,
        Self::TranslationKept, Self::PrintedA13, Self::LambdaOne, Self::PeriodHalved, Self::ConcentrationUnits,
        Self::ProbabilityComplement, Self::ProbabilityExponent, Self::AnyNeighbour, Self::IndexOrder,
        Self::ReplacementUniform, Self::ReplacementNone,
    ];
}

/// One suspension in plane Couette flow, u_2 = G x_1.
#[derive(Clone, Debug)]
pub struct Problem {
    /// N, rods in the control volume.
    pub count: usize,
    /// G, 1/s, not zero.
    pub shear_rate_per_s: f64,
    /// a, the full length of every rod, mm.
    pub length_mm: f64,
    /// Mean of r_e.
    pub aspect_ratio: f64,
    /// Standard deviation of r_e (eq. 11), percent of the mean.
    pub aspect_ratio_sd_percent: f64,
    /// Orientations at t = 0.
    pub orientation: Start,
    /// n, rods per cm^3.
    pub concentration_per_cm3: f64,
    /// alpha of eq. 7; 0: no collision ever.
    pub alpha: f64,
    /// m of eq. 7.
    pub m: f64,
    /// Arms shorter than this, in units of a, are no contact.
    pub min_contact_arm: f64,
    /// How a colliding rod is moved.
    pub update: Update,
    /// dt = T / steps_per_period, T that of the mean r_e.
    pub steps_per_period: usize,
    /// Seed of all streams.
    pub seed: u64,
    /// Number of the replica.
    pub replica: u64,
    /// A deliberate error, or none.
    pub mistake: Option<Mistake>,
}

impl Problem {
    /// T of the mean aspect ratio, s (eq. 15).
    pub fn period_s(&self) -> f64 {
        let factor = either(self.mistake, Mistake::PeriodHalved, 0.5, 1.0);
        let strain = TAU * (self.aspect_ratio + 1.0 / self.aspect_ratio);
        factor * strain / self.shear_rate_per_s.abs()
    }

    /// dt, s.
    pub fn time_step_s(&self) -> f64 {
        self.period_s() / self.steps_per_period as f64
    }

    /// H = (N/n)^(1/3), mm.
    pub fn box_edge_mm(&self) -> f64 {
        let cm3_per_mm3 = either(self.mistake, Mistake::ConcentrationUnits, 1e-2, 1e-3);
        (self.count as f64 / (self.concentration_per_cm3 * cm3_per_mm3)).cbrt()
    }

    /// L_ij = du_i/dx_j, 1/s.
    pub fn gradient_per_s(&self) -> [[f64; 3]; 3] {
        [[0.0; 3], [self.shear_rate_per_s, 0.0, 0.0], [0.0; 3]]
    }
}

/// How a mistake enters an expression.
fn either<T>(made: Option<Mistake>, mistake: Mistake, wrong: T, right: T) -> T {
    if made == Some(mistake) { wrong } else { right }
}

/// SplitMix64's finaliser.
fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The stream of random numbers for one seed, replica and purpose.
pub fn stream(seed: u64, replica: u64, purpose: u64) -> Pcg64Dxsm {
    let key = mix(seed.wrapping_add(GOLDEN));
    let key = mix((key ^ replica).wrapping_add(GOLDEN));
    let key = mix((key ^ purpose).wrapping_add(GOLDEN));
    let mut bytes = [0; 32];
    for k in 0..4 {
        let word = mix(key.wrapping_add(GOLDEN.wrapping_mul(k as u64 + 1)));
        bytes[8 * k..8 * k + 8].copy_from_slice(&word.to_le_bytes());
    }
    Pcg64Dxsm::from_seed(bytes)
}

fn uniform(stream: &mut Pcg64Dxsm) -> f64 {
    stream.random::<f64>()
}

/// P_c (eq. 7) at centre distance s.
pub fn collision_probability(s_mm: f64, a_mm: f64, alpha: f64, m: f64) -> f64 {
    if alpha == 0.0 {
        0.0
    } else {
        (alpha / (s_mm / a_mm + alpha)).powf(m)
    }
}

/// Nearest other rod and its centre distance in mm, no images; the lower index where two are equally near.
pub fn nearest(positions_mm: &[[f64; 3]], i: usize) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for j in (0..positions_mm.len()).filter(|&j| j != i) {
        let s_mm = distance_mm(positions_mm, i, j);
        if best.is_none_or(|(_, least)| s_mm < least) {
            best = Some((j, s_mm));
        }
    }
    best
}

fn distance_mm(positions_mm: &[[f64; 3]], i: usize, j: usize) -> f64 {
    (vector(positions_mm[j]) - vector(positions_mm[i])).norm()
}

fn vector(x: [f64; 3]) -> Vector3<f64> {
    Vector3::from(x)
}

fn matrix(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}

/// W + Lambda D, the matrix that makes Jeffery's equation linear, 1/s.
fn jeffery_matrix(gradient: Matrix3<f64>, lambda: f64) -> Matrix3<f64> {
    let spin = (gradient - gradient.transpose()) / 2.0;
    let strain = (gradient + gradient.transpose()) / 2.0;
    spin + strain * lambda
}

fn shape_factor(aspect_ratio: f64) -> f64 {
    (aspect_ratio * aspect_ratio - 1.0) / (aspect_ratio * aspect_ratio + 1.0)
}

/// Jeffery's pdot = W p + Lambda (D p - p (p.D.p)) of a free rod, 1/s (A.1 for a unit vector).
pub fn jeffery(p: [f64; 3], aspect_ratio: f64, gradient_per_s: [[f64; 3]; 3]) -> [f64; 3] {
    // p.(W + Lambda D).p = Lambda p.D.p because W is antisymmetric.
    let q = jeffery_matrix(matrix(gradient_per_s), shape_factor(aspect_ratio)) * vector(p);
    (q - vector(p) * vector(p).dot(&q)).into()
}

/// Two rods in contact and how they turn because of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Unit contact line L, along p_A x p_B.
    pub line: [f64; 3],
    /// Signed distance from A's centre to its contact point, along p_A, mm.
    pub arm_a_mm: f64,
    /// The same for B.
    pub arm_b_mm: f64,
    /// From A's contact point to B's, along the contact line, signed, mm.
    pub gap_mm: f64,
    /// pdot' of A, 1/s.
    pub pdot_a_per_s: [f64; 3],
    /// pdot' of B, 1/s.
    pub pdot_b_per_s: [f64; 3],
}

/// A rod as a collision sees it: centre (mm), axis, rate of the axis (1/s).
type Rod = [Vector3<f64>; 3];

/// A.7 to A.13 for rods at `xa`, `xb` (mm) along `pa`, `pb`, turning at `pdot_a`, `pdot_b` (1/s) in u = L x (L in 1/s).
///
/// `None` where there is no contact: parallel rods, or an arm of exactly 0.
pub fn collide(
    xa: [f64; 3],
    pa: [f64; 3],
    pdot_a: [f64; 3],
    xb: [f64; 3],
    pb: [f64; 3],
    pdot_b: [f64; 3],
    gradient: [[f64; 3]; 3],
) -> Option<Contact> {
    let (a, b) = ([xa, pa, pdot_a].map(vector), [xb, pb, pdot_b].map(vector));
    contact(a, b, matrix(gradient), None)
}

fn contact(a: Rod, b: Rod, gradient: Matrix3<f64>, made: Option<Mistake>) -> Option<Contact> {
    let ([xa, pa, _], [xb, pb, _]) = (a, b);
    let line = Unit::try_new(pa.cross(&pb), 0.0)?.into_inner();
    // x_A + r_A p_A + c l = x_B + r_B p_B
    let system = Matrix3::from_columns(&[pa, -pb, line]);
    let solution = system.lu().solve(&(xb - xa))?;
    let arms = [solution[0], solution[1]];
    if arms.contains(&0.0) {
        return None;
    }
    let arms = either(made, Mistake::ArmsSwapped, [arms[1], arms[0]], arms);
    let [arm_a, arm_b] = either(made, Mistake::ArmUnsigned, arms.map(f64::abs), arms);
    // A.7
    let velocity = |[x, p, pdot]: Rod, arm: f64| {
        let omega = either(made, Mistake::SpinIgnored, Vector3::zeros(), p.cross(&pdot));
        gradient * x + omega.cross(&(p * arm))
    };
    // A.8
    let (velocity_a, velocity_b) = (velocity(a, arm_a), velocity(b, arm_b));
    let parallel_a = line * line.dot(&velocity_a);
    let parallel_b = line * line.dot(&velocity_b);
    // A.10
    let half = either(made, Mistake::SumInsteadOfMean, 1.0, 0.5);
    let mean = (parallel_a + parallel_b) * half;
    // A.9, A.11, A.12, and the division by the arm in A.13
    let pdot_after = |[x, p, _]: Rod, arm: f64, before: Vector3<f64>, parallel: Vector3<f64>| {
        let parallel_after = either(made, Mistake::KickSign, parallel * 2.0 - mean, mean);
        let after = (before - parallel) + parallel_after;
        let relative = either(made, Mistake::TranslationKept, after, after - gradient * x);
        let normal_to_rod = relative - p * p.dot(&relative);
        normal_to_rod / arm
    };
    Some(Contact {
        line: line.into(),
        arm_a_mm: arm_a,
        arm_b_mm: arm_b,
        gap_mm: solution[2],
        pdot_a_per_s: pdot_after(a, arm_a, velocity_a, parallel_a).into(),
        pdot_b_per_s: pdot_after(b, arm_b, velocity_b, parallel_b).into(),
    })
}

/// sin theta of an axis; exactly 0 at both poles, which sin(acos(p_3)) is not at p_3 = -1.
fn sin_theta(p: [f64; 3]) -> f64 {
    p[0].hypot(p[1])
}

/// phi and theta of an axis, rad.
fn angles_rad(p: [f64; 3]) -> [f64; 2] {
    [p[1].atan2(p[0]), sin_theta(p).atan2(p[2])]
}

/// The axis at phi and theta.
fn axis([phi, theta]: [f64; 2]) -> [f64; 3] {
    let sin = theta.sin();
    [sin * phi.cos(), sin * phi.sin(), theta.cos()]
}

/// Phidot' and thetadot' (A.13), rad/s; `w` is V'_r / r.
fn angle_rates_per_s([phi, theta]: [f64; 2], w: [f64; 3], made: Option<Mistake>) -> [f64; 2] {
    let (sin, cos) = theta.sin_cos();
    // the print exchanges sin and cos, and does not divide by sin
    let (sin, cos, divisor) = either(made, Mistake::PrintedA13, (cos, sin, 1.0), (sin, cos, sin));
    let along = w[0] * phi.cos() + w[1] * phi.sin();
    let across = -w[0] * phi.sin() + w[1] * phi.cos();
    [across / divisor, along * cos - w[2] * sin]
}

/// A.14: phi' = phi + phidot' dt, theta' = theta + thetadot' dt.
fn moved_by_angles(p: [f64; 3], pdot: [f64; 3], dt_s: f64, made: Option<Mistake>) -> [f64; 3] {
    let [phi, theta] = angles_rad(p);
    let [phi_dot, theta_dot] = angle_rates_per_s([phi, theta], pdot, made);
    axis([phi + phi_dot * dt_s, theta + theta_dot * dt_s])
}

/// The axis turned about p x pdot by |pdot| dt.
fn rotated(p: [f64; 3], pdot: [f64; 3], dt_s: f64) -> [f64; 3] {
    let Some(about) = Unit::try_new(vector(p).cross(&vector(pdot)), 0.0) else {
        return p;
    };
    let turn = Rotation3::from_axis_angle(&about, vector(pdot).norm() * dt_s);
    (turn * vector(p)).normalize().into()
}

/// Means of |p_i| (eq. 4; the modulus because p and -p are the same rod).
pub fn mean_projections(orientations: &[[f64; 3]]) -> [f64; 3] {
    let sum = |i: usize| orientations.iter().map(|p| p[i].abs()).sum::<f64>();
    [0, 1, 2].map(|i| sum(i) / orientations.len() as f64)
}

/// The suspension as it is now.
#[derive(Debug)]
pub struct Naive {
    /// Centres of mass, mm.
    pub positions_mm: Vec<[f64; 3]>,
    /// Unit axes.
    pub orientations: Vec<[f64; 3]>,
    /// r_e of every rod.
    pub aspect_ratios: Vec<f64>,
    /// Collisions so far.
    pub collisions: u64,
    /// Rods that have left the volume so far.
    pub replacements: u64,
    /// Aspect ratios drawn again because they were 1 or less.
    pub redraws: u64,
    /// Rods (i, j) that collided in the last step, in the order taken; i is the one whose draw it was.
    pub last_collisions: Vec<(usize, usize)>,
    /// |pdot'| dt of i and of j for each of these, rad: the whole turn, Jeffery's share included.
    pub last_turns_rad: Vec<[f64; 2]>,
    problem: Problem,
    propagators: Vec<Matrix3<f64>>,
    collision_stream: Pcg64Dxsm,
    replacement_stream: Pcg64Dxsm,
}

impl Naive {
    /// The suspension at t = 0 (eqs. 11, 12).
    pub fn new(problem: Problem) -> Self {
        let stream_for = |purpose| stream(problem.seed, problem.replica, purpose);
        let mut redraws = 0;
        let mut aspect_ratios = vec![problem.aspect_ratio; problem.count];
        if problem.aspect_ratio_sd_percent > 0.0 {
            let sd = problem.aspect_ratio * problem.aspect_ratio_sd_percent / 100.0;
            let normal = Normal::new(problem.aspect_ratio, sd).expect("the standard deviation is finite");
            let mut draws = stream_for(ASPECT_RATIOS);
            for aspect_ratio in &mut aspect_ratios {
                *aspect_ratio = normal.sample(&mut draws);
                while *aspect_ratio <= 1.0 {
                    redraws += 1;
                    *aspect_ratio = normal.sample(&mut draws);
                }
            }
        }
        let mut draws = stream_for(ORIENTATIONS);
        let mut orientations = Vec::new();
        for _ in 0..problem.count {
            orientations.push(match problem.orientation {
                Start::Fixed { phi_rad, theta_rad } => axis([phi_rad, theta_rad]),
                Start::Isotropic => {
                    let phi = TAU * uniform(&mut draws);
                    axis([phi, (1.0 - 2.0 * uniform(&mut draws)).acos()])
                }
            });
        }
        let mut draws = stream_for(POSITIONS);
        let mut positions_mm = Vec::new();
        for _ in 0..problem.count {
            positions_mm.push([0; 3].map(|_| problem.box_edge_mm() * uniform(&mut draws)));
        }
        let gradient = matrix(problem.gradient_per_s());
        let propagator = |&aspect_ratio: &f64| {
            let lambda = shape_factor(aspect_ratio);
            let lambda = either(problem.mistake, Mistake::LambdaOne, 1.0, lambda);
            (jeffery_matrix(gradient, lambda) * problem.time_step_s()).exp()
        };
        Self {
            propagators: aspect_ratios.iter().map(propagator).collect(),
            collision_stream: stream_for(COLLISIONS),
            replacement_stream: stream_for(REPLACEMENTS),
            positions_mm,
            orientations,
            aspect_ratios,
            collisions: 0,
            replacements: 0,
            redraws,
            last_collisions: Vec::new(),
            last_turns_rad: Vec::new(),
            problem,
        }
    }

    /// One time step: contacts from the state at its start, then all orientations, then all positions.
    pub fn step(&mut self) {
        let dt_s = self.problem.time_step_s();
        let contacts = self.contacts();
        let old = self.orientations.clone();
        for (p, propagator) in self.orientations.iter_mut().zip(&self.propagators) {
            *p = (propagator * vector(*p)).normalize().into();
        }
        self.last_collisions.clear();
        self.last_turns_rad.clear();
        for (i, j, contact) in contacts {
            for (rod, pdot) in [(i, contact.pdot_a_per_s), (j, contact.pdot_b_per_s)] {
                let (p, made) = (old[rod], self.problem.mistake);
                self.orientations[rod] = match self.problem.update {
                    // phi has no meaning at the pole
                    Update::Angles if sin_theta(p) != 0.0 => moved_by_angles(p, pdot, dt_s, made),
                    _ => rotated(p, pdot, dt_s),
                };
            }
            self.collisions += 1;
            self.last_collisions.push((i, j));
            let turn_rad = |pdot| vector(pdot).norm() * dt_s;
            let turns_rad = [contact.pdot_a_per_s, contact.pdot_b_per_s].map(turn_rad);
            self.last_turns_rad.push(turns_rad);
        }
        self.translate(dt_s);
    }

    /// The collisions of this step: nearest neighbours, eqs. 7 to 9, closest first, one collision per rod at most.
    fn contacts(&mut self) -> Vec<(usize, usize, Contact)> {
        let problem = &self.problem;
        let (n, m, made) = (problem.count, problem.m, problem.mistake);
        let m = either(made, Mistake::ProbabilityExponent, m + 1.0, m);
        let mut candidates = Vec::new();
        for i in 0..n {
            let Some((j, _)) = nearest(&self.positions_mm, i) else {
                continue;
            };
            let j = either(made, Mistake::AnyNeighbour, (i + 1) % n, j);
            let s_mm = distance_mm(&self.positions_mm, i, j);
            // drawn whatever the distance, so that one rod's fate never shifts another's draw
            let draw = uniform(&mut self.collision_stream);
            let p_c = collision_probability(s_mm, problem.length_mm, problem.alpha, m);
            if either(made, Mistake::ProbabilityComplement, p_c < draw, p_c > draw) {
                // the distance to sort by, which index order does without
                candidates.push((i, j, either(made, Mistake::IndexOrder, 0.0, s_mm)));
            }
        }
        // stable: equal distances stay in the order of i
        candidates.sort_by(|one, other| one.2.total_cmp(&other.2));
        let mut taken = vec![false; n];
        let mut contacts = Vec::new();
        for (i, j, _) in candidates {
            if taken[i] || taken[j] {
                continue;
            }
            let gradient = problem.gradient_per_s();
            let rod = |k: usize| {
                let (x, p) = (self.positions_mm[k], self.orientations[k]);
                [x, p, jeffery(p, self.aspect_ratios[k], gradient)].map(vector)
            };
            let Some(contact) = contact(rod(i), rod(j), matrix(gradient), made) else {
                continue;
            };
            // too short an arm is no collision: both rods stay free for a later candidate
            let shorter_mm = contact.arm_a_mm.abs().min(contact.arm_b_mm.abs());
            if shorter_mm / problem.length_mm < problem.min_contact_arm {
                continue;
            }
            (taken[i], taken[j]) = (true, true);
            contacts.push((i, j, contact));
        }
        contacts
    }

    /// x_2 grows by G x_1 dt; whoever leaves the volume comes back by eq. 14, orientation and r_e kept.
    fn translate(&mut self, dt_s: f64) {
        let (edge_mm, made) = (self.problem.box_edge_mm(), self.problem.mistake);
        for x in &mut self.positions_mm {
            x[1] += self.problem.shear_rate_per_s * x[0] * dt_s;
            if (0.0..edge_mm).contains(&x[1]) {
                continue;
            }
            self.replacements += 1;
            x[1] = x[1].rem_euclid(edge_mm);
            if made == Some(Mistake::ReplacementNone) {
                continue;
            }
            // inflow through the face is proportional to u_2, so to x_1: hence the root
            let draw = uniform(&mut self.replacement_stream);
            x[0] = edge_mm * either(made, Mistake::ReplacementUniform, draw, draw.sqrt());
            x[2] = edge_mm * uniform(&mut self.replacement_stream);
        }
    }
}

#[cfg(test)]
mod tests;
