//! The propagator against Dormand–Prince 8(5,3) of `ode_solvers`.

use super::*;

pub(super) fn integrated_motion(motion: &Motion, _: &Effort) -> [Evidence; 6] {
    [
        ("plane Couette flow", [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        ("planar extension", [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]]),
        ("uniaxial extension", [[-0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -0.5]]),
        ("elliptic planar flow", [[0.0, -1.0, 0.0], [0.4, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        ("spiral, all nine components", [[0.1, -0.9, 0.3], [0.8, 0.2, -0.4], [-0.2, 0.5, -0.3]]),
        ("three real rates, all nine components", [[0.9, 0.3, 0.1], [0.4, -0.2, 0.2], [0.1, 0.3, -0.7]]),
    ]
    .map(|(name, rows)| {
        let flow = VelocityGradient::new(Matrix3::from_fn(|i, j| rows[i][j])).expect("finite components");
        let rods = pairs([0.2, 1.0, 3.0, 11.6], starts());
        let off = pairs(rods, [0.3, 2.0, 30.0]).map(|((r, start), time)| {
            let (expected, steps) = integrate(rows, r, &start, time);
            apart(&motion(&flow, r, &start, time), &expected) / (f64::from(steps) * 2.0 * TOLERANCE * GROWTH)
        });
        let because = "each step is off by atol + rtol |p| = 2·10⁻¹³, and grows r_e² = 135-fold at most, from \
                       along the flow to the flip";
        Evidence::on(
            format!("angle to the integrator's direction up to strain 30, over its own error, {name}"),
            "× the integrator's error",
        )
        .within(worst(off), 1.0)
        .because(because)
    })
}

/// Jeffery's equation written independently, in the form that the integrator needs.
struct Jeffery {
    rows: [[f64; 3]; 3],
    shape: f64,
}

impl System<f64, SVector<f64, 3>> for Jeffery {
    fn system(&self, _: f64, p: &SVector<f64, 3>, rate: &mut SVector<f64, 3>) {
        let l = &self.rows;
        let stretch = |i: usize, j: usize| 0.5 * (l[i][j] + l[j][i]);
        let spin = |i: usize, j: usize| 0.5 * (l[i][j] - l[j][i]);
        let mut along = 0.0;
        for i in 0..3 {
            for j in 0..3 {
                along += p[i] * stretch(i, j) * p[j];
            }
        }
        for i in 0..3 {
            rate[i] = -self.shape * along * p[i];
            for j in 0..3 {
                rate[i] += (spin(i, j) + self.shape * stretch(i, j)) * p[j];
            }
        }
    }
}

/// rtol and atol of the integrator.
const TOLERANCE: f64 = 1e-13;

/// The factor by which the motion of the longest rod, r_e = 11.6, stretches a difference.
const GROWTH: f64 = 11.6 * 11.6;

/// The final direction, and the number of steps.
fn integrate(rows: [[f64; 3]; 3], r: f64, start: &UnitVector3<f64>, time: f64) -> (UnitVector3<f64>, u32) {
    let system = Jeffery { rows, shape: (r * r - 1.0) / (r * r + 1.0) };
    let mut solver = Dop853::new(system, 0.0, time, time, start.into_inner(), TOLERANCE, TOLERANCE);
    // Steps, not dense output: the last step ends at `time`.
    solver.set_output(OutputType::Sparse);
    let steps = solver.integrate().map_or(0, |stats| stats.accepted_steps);
    let last = solver.y_out().last().copied();
    let end = last.filter(|_| steps > 0).unwrap_or(Vector3::repeat(f64::NAN));
    (UnitVector3::new_normalize(end), steps)
}
