//! Reference values at many times, as a table.

use super::big::{Big, Bits, number};
use super::isotropic::{Covariance, PAIRS, QUADRUPLES};
use super::motion::{LARGEST_STRAIN, Motion, Unit};
use super::planar;
use super::rod::{At, Direction};
use super::unequal;
use crate::diffusion::NoAnswer;
use rayon::prelude::*;

/// The rods at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// Infinitely many free rods with isotropic directions (eq. 12), for means over them.
    Isotropic {
        /// Standard deviation of a Gaussian r_e (eq. 11), percent of the mean.
        aspect_ratio_sd_percent: f64,
        /// True for a_4 in place of ⟨|p_i|⟩ and a_ij.
        fourth: bool,
    },
    /// Infinitely many free rods with random directions in the plane of axes 1 and 2, for means over them.
    Planar {
        /// True for a_4 in place of ⟨|p_i|⟩ and a_ij.
        fourth: bool,
    },
    /// One free rod.
    Rod(Direction),
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the column.
    pub name: String,
    /// Unit, `1` for pure numbers.
    pub unit: &'static str,
    /// Source: equation numbers are Lee & Springer's (1982).
    pub equation: &'static str,
}

/// Times and values, one row per time. Undefined values are `None`: t/T and C_b in flows without them, φ on axis 3.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The columns of the table.
    pub columns: Vec<Column>,
    /// The rows of the table.
    pub rows: Vec<Vec<Option<f64>>>,
}

/// The reason why there is no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoValue {
    /// The flow has no period, or no strain.
    Unit,
    /// |L|t is above [`LARGEST_STRAIN`] in a flow that is not plane Couette flow.
    Strain,
    /// A time in another unit is not a finite double.
    Time,
    /// Rods of unequal r_e with a deviation eight times which reaches r_e = 1, in a flow other than plane Couette flow,
    /// for more than a thousand periods, or with a_4.
    Unequal,
    /// A time before the start, with diffusion.
    Past,
    /// The distribution of rods with diffusion at these times was not found.
    Diffusion(NoAnswer),
    /// Their steady distribution was not found.
    Steady(NoAnswer),
}

/// The columns that give the time in several units.
pub(super) fn of_time() -> Vec<Column> {
    let column = |name: &str, unit, equation| Column { name: name.into(), unit, equation };
    vec![
        column("time_s", "s", "time"),
        column("t_over_T", "1", "15: T = 2π(r_e + 1/r_e)/|G|, of the mean r_e"),
        column("strain", "1", "∫(2D:D)^½ dt; in steady plane Couette flow |G| t"),
    ]
}

/// The columns of a_4, or of ⟨|p_i|⟩ and a_ij, with the sources of ⟨|p_i|⟩, a_ij and a_4.
pub(super) fn of_means(fourth: bool, [projection, moment, of_four]: [&'static str; 3]) -> Vec<Column> {
    let column = |name: String, equation| Column { name, unit: "1", equation };
    if fourth {
        return QUADRUPLES.map(|[i, j, k, l]| column(format!("a{i}{j}{k}{l}"), of_four)).into();
    }
    let projections = [1, 2, 3].map(|i| column(format!("x{i}"), projection));
    let moments = PAIRS.map(|(i, j)| column(format!("a{}{}", i + 1, j + 1), moment));
    projections.into_iter().chain(moments).collect()
}

/// The columns for a start.
pub fn columns(start: Start) -> Vec<Column> {
    let column = |name: &str, unit, equation| Column { name: name.into(), unit, equation };
    let mut columns = of_time();
    match start {
        Start::Rod(_) => {
            let motion = "A.4, A.5 (A.1): p = q/|q|, q = exp((W + ΛD)t) p(0)";
            columns.extend(["p1", "p2", "p3"].map(|name| column(name, "1", motion)));
            columns.push(column("phi_rad", "rad", "A.4: from axis 1 towards axis 2, in (−π, π]"));
            columns.push(column("theta_rad", "rad", "A.5: from axis 3, in [0, π]"));
            columns.push(column("c_b", "1", "13, 18: C/(1 + C), C = (r_e²p_1² + p_2²)^½/(r_e|p_3|)"));
        }
        Start::Isotropic { fourth, .. } => columns.extend(of_means(
            fourth,
            [
                "4, A.4, A.5, 12: mean of |p_i|; a complete elliptic integral in plane Couette flow",
                "A.4, A.5, 12: mean of p_i p_j; an incomplete elliptic integral in plane Couette flow",
                "A.1, 12: mean of p_i p_j p_k p_l, by quadrature",
            ],
        )),
        Start::Planar { fourth } => columns.extend(of_means(
            fourth,
            ["4, A.1: mean of |p_i|", "A.1: mean of p_i p_j", "A.1: mean of p_i p_j p_k p_l"],
        )),
    }
    columns
}

/// Values at `times`, doubles in `unit`; each is correctly rounded except for means over unequal rods (`unequal.rs`).
/// `done` is called after each row.
pub fn table(
    motion: &Motion,
    start: Start,
    times: &[f64],
    unit: Unit,
    done: impl Fn() + Sync,
) -> Result<Table, NoValue> {
    if motion.couette().is_none() && times.iter().any(|time| motion.strain(*time, unit) > LARGEST_STRAIN) {
        // A unit that the flow does not have has no strain either.
        return Err(self::times(motion, &Bits(64).of(times[0]), unit).err().unwrap_or(NoValue::Strain));
    }
    let rod = match start {
        Start::Rod(direction) => Some(At::new(motion, direction, times.iter().copied(), unit)),
        Start::Isotropic { .. } | Start::Planar { .. } => None,
    };
    let rows = times.par_iter().map(|time| {
        let row = row(motion, start, rod.as_ref(), *time, unit);
        done();
        row
    });
    Ok(Table { columns: columns(start), rows: rows.collect::<Result<_, _>>()? })
}

fn row(
    motion: &Motion,
    start: Start,
    rod: Option<&At<'_>>,
    time: f64,
    unit: Unit,
) -> Result<Vec<Option<f64>>, NoValue> {
    let exact = Bits(64).of(time);
    let mut row = times(motion, &exact, unit)?;
    match start {
        Start::Rod(_) => {
            let rod = rod.and_then(|rod| rod.time(&exact)).ok_or(NoValue::Unit)?;
            row.extend(rod.p.iter().map(|x| Some(number(x))));
            row.extend([rod.phi, Some(rod.theta), rod.c_b].map(|x| x.as_ref().map(number)));
        }
        Start::Isotropic { aspect_ratio_sd_percent, fourth } if aspect_ratio_sd_percent != 0.0 => {
            let turns = row[1].filter(|_| !fourth).ok_or(NoValue::Unequal)?;
            let sense = motion.couette().ok_or(NoValue::Unequal)?.signum();
            let means = unequal::means(motion.aspect_ratio, aspect_ratio_sd_percent, sense * turns);
            row.extend(means.ok_or(NoValue::Unequal)?.map(Some));
        }
        Start::Planar { fourth } => {
            let bits = motion.bits(time, unit, planar::PRECISION);
            let map = motion.map(&exact, unit, bits).ok_or(NoValue::Unit)?;
            row.extend(planar::Means::of(&map, bits).values(fourth).into_iter().map(|x| Some(number(&x))));
        }
        Start::Isotropic { fourth, .. } => {
            let covariance = Covariance::at(motion, &exact, unit).ok_or(NoValue::Unit)?;
            if fourth {
                row.extend(covariance.nearest_fourth().map(Some))
            } else {
                row.extend(covariance.nearest().into_iter().map(Some))
            }
        }
    }
    Ok(row)
}

/// A time in seconds, periods and strain; `None` for units that the flow does not have.
pub(super) fn times(motion: &Motion, time: &Big, unit: Unit) -> Result<Vec<Option<f64>>, NoValue> {
    if motion.convert(time, unit, Unit::Second, Bits(64)).is_none() {
        return Err(NoValue::Unit);
    }
    let each = [Unit::Second, Unit::Period, Unit::Strain].map(|other| {
        let value = motion.convert(time, unit, other, Bits(128)).map(|value| number(&value));
        if value.is_some_and(|value| !value.is_finite()) { Err(NoValue::Time) } else { Ok(value) }
    });
    each.into_iter().collect()
}
