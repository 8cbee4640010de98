//! Means over rods with rotary diffusion, as a table.

use super::big::Bits;
use super::motion::{Motion, Unit};
use super::table::{Column, NoValue, Table, of_means, of_time, times};
use crate::diffusion::{self, FlowStep, MEANS, Means, NoAnswer, Start, strain_rate_per_s};
use nalgebra::{DMatrix, Matrix3};

/// How fast directions spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// C_I: D_r = C_I γ̇ in each flow.
    CI(f64),
    /// D_r in 1/s; ∞ for isotropic rods.
    PerS(f64),
}

/// Rods with rotary diffusion, and the values requested for them.
#[derive(Clone)]
pub struct Diffusing {
    /// The mean r_e, which may be ∞.
    pub aspect_ratio: f64,
    /// Standard deviation of a Gaussian r_e in percent of the mean, up to [`WIDEST_PERCENT`].
    pub aspect_ratio_sd_percent: f64,
    /// Velocity gradients in 1/s one after another, each with its duration in s; the last has no end.
    pub flows: Vec<([[f64; 3]; 3], f64)>,
    /// The period in s of a flow that oscillates as cos 2πt/T; the only flow's gradient is then its amplitude.
    pub oscillation_s: Option<f64>,
    /// The rotary diffusion.
    pub spread: Spread,
    /// The rods at t = 0.
    pub start: Start<'static>,
    /// True for a_4 in place of ⟨|p_i|⟩ and a_ij.
    pub fourth: bool,
    /// True for the order parameter and the extinction angle too.
    pub optics: bool,
    /// True for the steady distribution in the last flow too, after the times.
    pub steady: bool,
}

/// The largest deviation of r_e, so that the outermost node of a quadrature is above 0.
pub const WIDEST_PERCENT: f64 = 12.0;

impl Diffusing {
    /// The columns of the table.
    pub fn columns(&self) -> Vec<Column> {
        let sources = [
            "4: mean of |p_i| over the density",
            "mean of p_i p_j over the density",
            "mean of p_i p_j p_k p_l over the density",
        ];
        let mut columns = [of_time(), of_means(self.fourth, sources)].concat();
        if self.optics {
            let column = |name: &str, unit, equation| Column { name: name.into(), unit, equation };
            columns.push(column("order_parameter", "1", "S = (3λ − 1)/2, λ the largest eigenvalue of a_ij"));
            columns.push(column(
                "extinction_angle_deg",
                "deg",
                "χ = ½ atan2(2a_12, a_22 − a_11): from the flow's axis 2 to the axis of a_ij in the plane of 1 and 2",
            ));
            let source =
                "((a_22 − a_11)² + 4a_12²)^½: what light along axis 3 sees (birefringence over its largest value)";
            columns.push(column("birefringence", "1", source));
        }
        columns
    }

    /// A table of values at `at` ≥ 0, ascending doubles in `unit` (seconds if there are several flows), followed by the
    /// steady values at the time ∞ if requested.
    ///
    /// Each value is rounded to as many decimals as its stated error allows, eleven at most.
    pub fn table(&self, at: &[f64], unit: Unit) -> Result<Table, NoValue> {
        if at.iter().any(|time| *time < 0.0) {
            return Err(NoValue::Past);
        }
        let heads = at.iter().map(|time| self.head(*time, unit)).collect::<Result<Vec<_>, _>>()?;
        let seconds: Vec<f64> = heads.iter().filter_map(|head| head[0]).collect();
        let all = self.over_aspect_ratios(|flows| match self.oscillation_s {
            Some(period_s) => diffusion::oscillating(&flows[0].motion, [period_s, 0.0], self.start, &seconds),
            None => diffusion::through(flows, self.start, &seconds),
        });
        let mut rows = Vec::new();
        for (mut head, means) in heads.into_iter().zip(&all.map_err(NoValue::Diffusion)?) {
            head.extend(self.values(means));
            rows.push(head);
        }
        if self.steady {
            let of = |flows: &[FlowStep]| Ok(vec![diffusion::steady(&flows[flows.len() - 1].motion)?]);
            let means = self.over_aspect_ratios(of).map_err(NoValue::Steady)?;
            let motion = self.last();
            let period = motion.couette().map(|_| f64::INFINITY);
            let strains = strain_rate_per_s(motion.gradient_per_s) > 0.0;
            let mut row = vec![Some(f64::INFINITY), period, Some(if strains { f64::INFINITY } else { 0.0 })];
            row.extend(self.values(&means[0]));
            rows.push(row);
        }
        Ok(Table { columns: self.columns(), rows })
    }

    /// ψ in 1/sr in directions of the laboratory's axes at `times_s` ≥ 0, ascending, and its stated error.
    ///
    /// # Errors
    ///
    /// As [`diffusion::densities`]; r_e has no deviation.
    pub fn densities(&self, times_s: &[f64], directions: &[[f64; 3]]) -> Result<(Vec<Vec<f64>>, f64), NoAnswer> {
        diffusion::densities(&self.steps(self.aspect_ratio), self.start, times_s, directions)
    }

    /// The marginal density of φ per rad at `times_s` for these φ, and its stated error: ψ over each half circle of θ
    /// by Gauss and Legendre's rule, which is exact up to a degree of 399.
    ///
    /// # Errors
    ///
    /// As [`Self::densities`].
    pub fn marginals(&self, times_s: &[f64], phi_rad: &[f64]) -> Result<(Vec<Vec<f64>>, f64), NoAnswer> {
        let rule = diffusion::gauss_legendre(200);
        let direction = |phi: f64, z: f64| {
            let across = (1.0 - z * z).sqrt();
            [across * phi.cos(), across * phi.sin(), z]
        };
        let along = |phi: &f64| rule.iter().map(|(z, _)| direction(*phi, *z)).collect::<Vec<_>>();
        let directions: Vec<_> = phi_rad.iter().flat_map(along).collect();
        let (values, error) = self.densities(times_s, &directions)?;
        let sum = |part: &[f64]| part.iter().zip(&rule).map(|(value, (_, weight))| value * weight).sum();
        let marginal = |values: &Vec<f64>| values.chunks(rule.len()).map(sum).collect();
        Ok((values.iter().map(marginal).collect(), 2.0 * error))
    }

    /// The time in s, in periods and as a strain.
    pub fn head(&self, time: f64, unit: Unit) -> Result<Vec<Option<f64>>, NoValue> {
        if let Some(period_s) = self.oscillation_s.filter(|_| unit == Unit::Second) {
            // ∫|cos| is 2 a half period.
            let turn = std::f64::consts::TAU * time / period_s;
            let halves = (turn / std::f64::consts::PI + 0.5).floor();
            let sine = if halves % 2.0 == 0.0 { turn.sin() } else { -turn.sin() };
            let strain = strain_rate_per_s(self.flows[0].0) * (2.0 * halves + sine) * period_s / std::f64::consts::TAU;
            return Ok(vec![Some(time), None, Some(strain)]);
        }
        if self.flows.len() == 1 && self.oscillation_s.is_none() {
            return times(&self.last(), &Bits(64).of(time), unit);
        }
        if unit != Unit::Second {
            return Err(NoValue::Unit);
        }
        let (mut begun, mut strain) = (0.0, 0.0);
        for (at, (gradient, duration_s)) in self.flows.iter().enumerate() {
            let end = if at + 1 == self.flows.len() { f64::INFINITY } else { begun + duration_s };
            strain += strain_rate_per_s(*gradient) * (time.min(end) - begun).max(0.0);
            begun = end;
        }
        Ok(vec![Some(time), None, Some(strain)])
    }

    /// The last flow.
    fn last(&self) -> Motion {
        let gradient_per_s = self.flows.last().map_or([[0.0; 3]; 3], |(gradient, _)| *gradient);
        Motion { gradient_per_s, aspect_ratio: self.aspect_ratio }
    }

    fn steps(&self, aspect_ratio: f64) -> Vec<FlowStep> {
        let step = |(gradient, duration_s): &([[f64; 3]; 3], f64)| {
            let motion = match self.spread {
                Spread::CI(c_i) => diffusion::Motion::new(*gradient, aspect_ratio, c_i),
                Spread::PerS(d_r) => diffusion::Motion::diffusing(*gradient, aspect_ratio, d_r),
            };
            FlowStep { motion, duration_s: *duration_s }
        };
        self.flows.iter().map(step).collect()
    }

    /// Means over Gaussian r_e by Gauss and Hermite's rule; means are smooth in r_e. Their error is that of the
    /// worst node, and the difference to a rule with fewer nodes.
    fn over_aspect_ratios(
        &self,
        of: impl Fn(&[FlowStep]) -> Result<Vec<Means>, NoAnswer>,
    ) -> Result<Vec<Means>, NoAnswer> {
        let sd = 0.01 * self.aspect_ratio_sd_percent * self.aspect_ratio;
        if self.aspect_ratio_sd_percent == 0.0 {
            return of(&self.steps(self.aspect_ratio));
        }
        let rule = |count: usize| {
            let mut sum: Vec<Means> = Vec::new();
            for (x, weight) in gauss_hermite(count) {
                let means = of(&self.steps(self.aspect_ratio + sd * x))?;
                sum.resize(means.len(), Means::new(&[0.0; MEANS], 0.0));
                sum.iter_mut().zip(&means).for_each(|(sum, means)| sum.add(weight, means));
            }
            Ok::<_, NoAnswer>(sum)
        };
        let (fewer, mut all) = (rule(10)?, rule(15)?);
        for (means, fewer) in all.iter_mut().zip(&fewer) {
            means.error += means.apart(fewer);
        }
        Ok(all)
    }

    fn values(&self, means: &Means) -> Vec<Option<f64>> {
        let certain = |x: &f64| Some(means.certain(*x));
        let mut values: Vec<_> = if self.fourth {
            means.fourth.iter().map(certain).collect()
        } else {
            means.projections.iter().chain(&means.second).map(certain).collect()
        };
        if self.optics {
            values.extend(optics(means));
        }
        values
    }
}

/// The order parameter, the extinction angle in degrees, and the anisotropy in the plane of axes 1 and 2; `None` for
/// the angle where that plane has no axis.
fn optics(means: &Means) -> [Option<f64>; 3] {
    let [a11, a22, a33, a12, a13, a23] = means.second;
    let a = Matrix3::new(a11, a12, a13, a12, a22, a23, a13, a23, a33);
    let order = 1.5 * a.symmetric_eigenvalues().max() - 0.5;
    let anisotropy = (a22 - a11).hypot(2.0 * a12);
    // An eigenvalue is off by three times the error of a component at most, an angle by that over the anisotropy.
    let with = |factor: f64, value: f64| Means { error: factor * means.error.max(1e-12), ..*means }.certain(value);
    let is_known = anisotropy > 1e3 * means.error.max(1e-12);
    let angle = is_known.then(|| with(90.0 / anisotropy, means.extinction_angle_deg()));
    [Some(with(4.5, order)), angle, Some(with(4.0, anisotropy))]
}

/// Nodes and weights of the mean over a Gaussian of mean 0 and deviation 1: eigenvalues of the matrix of the
/// recursion of Hermite's polynomials (Golub & Welsch 1969).
fn gauss_hermite(count: usize) -> Vec<(f64, f64)> {
    let matrix = DMatrix::from_fn(count, count, |i, j| if i.abs_diff(j) == 1 { (i.max(j) as f64).sqrt() } else { 0.0 });
    let eigen = matrix.symmetric_eigen();
    let node = |(x, vector): (&f64, nalgebra::DVectorView<f64>)| (*x, vector[0] * vector[0]);
    eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of a Gaussian: 1, 0, 1, 0, 3, and 945 of degree 10; the rule of 15 nodes is exact up to degree 29.
    #[test]
    fn moments_of_a_gaussian_are_exact() {
        for (count, power, due) in
            [(15, 0, 1.0), (15, 1, 0.0), (15, 2, 1.0), (15, 4, 3.0), (15, 10, 945.0), (10, 4, 3.0)]
        {
            let sum: f64 = gauss_hermite(count).into_iter().map(|(x, weight)| weight * x.powi(power)).sum();
            assert!((sum - due).abs() < 1e-10 * due.max(1.0), "{power}: {sum}");
        }
        assert!(gauss_hermite(15).iter().all(|(x, _)| x.abs() * WIDEST_PERCENT < 100.0));
    }

    /// tan 2χ = 2a₁₂/(a₂₂ − a₁₁); 45° where a weak flow begins; S of a Bingham density along axis 2.
    #[test]
    fn the_extinction_angle_and_the_order_parameter_are_those_of_the_tensor() {
        let of = |second: [f64; 6]| optics(&Means { second, error: 1e-13, ..Means::new(&[0.0; MEANS], 0.0) });
        let third = 1.0 / 3.0;
        assert_eq!(of([third, third, third, 1e-3, 0.0, 0.0])[1], Some(45.0));
        assert_eq!(of([0.1, 0.8, 0.1, 0.0, 0.0, 0.0]), [Some(0.7), Some(0.0), Some(0.7)]);
        assert_eq!(of([0.2, 0.2, 0.6, 0.0, 0.0, 0.0]), [Some(0.4), None, Some(0.0)]);
        let [order, angle, birefringence] = of([0.2, 0.5, 0.3, -0.1, 0.0, 0.0]).map(Option::unwrap);
        assert!(((2.0 * angle.to_radians()).tan() + 2.0 / 3.0).abs() < 1e-9 && angle < 0.0);
        assert!((birefringence - 0.13f64.sqrt()).abs() < 1e-11);
        assert!((order - (1.5 * (0.35 + 0.0325f64.sqrt()) - 0.5)).abs() < 1e-9);
    }

    /// The mean over r_e by the trapezoid rule; and a small deviation changes it by ½σ² of the second derivative.
    #[test]
    fn means_over_aspect_ratios_are_those_of_another_rule() {
        let couette = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];
        let rods = |aspect_ratio: f64, sd: f64| Diffusing {
            aspect_ratio,
            aspect_ratio_sd_percent: sd,
            flows: vec![(couette, f64::INFINITY)],
            oscillation_s: None,
            spread: Spread::PerS(0.1),
            start: Start::Isotropic,
            fourth: false,
            optics: false,
            steady: false,
        };
        let a22 = |rods: &Diffusing| rods.table(&[3.0], Unit::Second).unwrap().rows[0][7].unwrap();
        let found = a22(&rods(3.0, 10.0));
        let nodes = (-160..=160).map(|k| f64::from(k) * 0.05);
        let weighted = nodes.map(|x| ((-0.5 * x * x).exp(), x)).map(|(w, x)| (w, w * a22(&rods(3.0 + 0.3 * x, 0.0))));
        let (weight, sum) = weighted.fold((0.0, 0.0), |(a, b), (w, value)| (a + w, b + value));
        assert!((found - sum / weight).abs() < 2e-11, "{found} {}", sum / weight);
        assert!((found - a22(&rods(3.0, 0.0))).abs() > 1e-4);
    }

    /// Isotropic rods that hardly diffuse: φ moves by itself, tan φ_0 = … of Jeffery's (4), so that its marginal is
    /// |dφ_0/dφ|/2π. And all of it is 1, whatever the start.
    #[test]
    fn the_marginal_is_that_of_free_rods_where_they_hardly_diffuse() {
        let (ratio, strain) = (3.0f64, 2.0f64);
        let rods = |d_r: f64| Diffusing {
            aspect_ratio: ratio,
            aspect_ratio_sd_percent: 0.0,
            flows: vec![([[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]], f64::INFINITY)],
            oscillation_s: None,
            spread: Spread::PerS(d_r),
            start: Start::Isotropic,
            fourth: false,
            optics: false,
            steady: false,
        };
        let phi: Vec<f64> = (0..36).map(|k| f64::from(k) * std::f64::consts::PI / 18.0).collect();
        let found = |d_r: f64, time_s: f64| rods(d_r).marginals(&[time_s], &phi).unwrap().0.remove(0);
        // On the ellipse (r sin φ, cos φ) the angle grows by G r/(r² + 1).
        let due = |phi: f64| {
            let turned = (phi.sin()).atan2(ratio * phi.cos()) - strain * ratio / (ratio * ratio + 1.0);
            let (sine, cosine) = turned.sin_cos();
            let slope = ratio / ((ratio * phi.cos()).powi(2) + phi.sin().powi(2));
            slope * ratio / (cosine * cosine + (ratio * sine).powi(2)) / std::f64::consts::TAU
        };
        let off = |found: &[f64]| crate::worst(found.iter().zip(&phi).map(|(x, phi)| (x - due(*phi)).abs()));
        assert!(off(&found(1e-5, strain)) < 1e-3, "{}", off(&found(1e-5, strain)));
        assert!(off(&found(1e-5, 1.1 * strain)) > 1e-2 && off(&found(1e-2, strain)) > 1e-2);
        let all = found(0.1, strain).iter().sum::<f64>() * std::f64::consts::PI / 18.0;
        assert!((all - 1.0).abs() < 1e-11, "{all}");
    }
}
