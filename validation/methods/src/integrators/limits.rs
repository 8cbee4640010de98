//! The longest step with which a fixed-step integrator keeps a property, by bisection.

use super::{Errors, Failure, Integrator, RodProblem, Setting, Theory};
use nalgebra::{UnitVector3, Vector3};
use serde::Serialize;
use std::f64::consts::PI;
use std::ops::Range;

/// A property that an integrator keeps with short steps and may lose with long ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Property {
    /// In the plane of shear no rod overtakes another within a step.
    Order,
    /// In the plane of shear every rod turns forward within a step by less than half a turn: none rests, as p ≡ −p.
    Turning,
    /// No rod crosses the plane of shear within a step: p_3 keeps its sign.
    Side,
    /// |p| < 1.5 after ten periods, from directions in the plane of shear: the limit found is an upper bound.
    Length,
    /// C_b is within 0.1 of its start after ten periods, from directions 1 rad off the vorticity axis; the limit found
    /// is an upper bound too.
    Orbit,
    /// The step can be taken at all, from every direction.
    Solvable,
}

/// The result of a search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// The property holds up to this GΔt on the ladder and is lost just above.
    At(f64),
    /// It holds on the whole ladder, up to this GΔt.
    Beyond(f64),
    /// It is lost at every step tried, down to this GΔt.
    Below(f64),
}

/// The steps that are tried: a ladder from the shortest up, as a property may come back at longer steps.
#[derive(Clone, Copy, Debug)]
pub struct Ladder {
    /// The shortest GΔt.
    pub least: f64,
    /// The longest.
    pub most: f64,
    /// The ratio of neighbouring rungs.
    pub factor: f64,
}

/// The steps GΔt for properties of a single step.
const ONE_STEP: Ladder = Ladder { least: 0.1, most: 1e3, factor: 1.1 };

/// A search over ten periods: from a few directions, then from many on a finer ladder, from half of the step that is
/// lost with the few on, as some rods lose the property before others, in narrow bands of steps.
struct TwoSearches {
    ladder: Ladder,
    few: u32,
    finer_factor: f64,
    many: u32,
}

const ORBITS: TwoSearches =
    TwoSearches { ladder: Ladder { least: 0.02, most: 20.0, factor: 1.25 }, few: 8, finer_factor: 1.02, many: 16 };

/// A method that keeps |p| is searched with the few alone.
const LENGTHS: TwoSearches =
    TwoSearches { ladder: Ladder { least: 0.5, most: 20.0, factor: 1.05 }, few: 45, finer_factor: 1.002, many: 180 };

/// The number of periods after which length and orbit are judged.
pub const PERIODS: f64 = 10.0;

/// p_3 of a rod just beside the plane of shear.
const NEAR_PLANE: f64 = 1e-9;

const RODS: u32 = 512;

/// Number of rods that are stepped at once.
const PART: u32 = 64;

/// The longest step GΔt with which an integrator keeps a property at this aspect ratio.
pub fn longest(integrator: &Integrator, property: Property, aspect_ratio: f64) -> Limit {
    let search = |ladder, count| bisect(ladder, |strain| holds(integrator, property, aspect_ratio, strain, count));
    let TwoSearches { ladder, few, finer_factor, many } = match property {
        Property::Length => LENGTHS,
        Property::Orbit => ORBITS,
        _ => return search(ONE_STEP, RODS),
    };
    match search(ladder, few) {
        Limit::At(strain) if property == Property::Orbit || !integrator.keeps_length => {
            match search(Ladder { least: 0.5 * strain, most: strain, factor: finer_factor }, many) {
                Limit::Beyond(_) => Limit::At(strain),
                earlier => earlier,
            }
        }
        limit => limit,
    }
}

/// The same on a ladder of one's own, from few directions: for programs that are slow to ask.
pub fn longest_on(ladder: Ladder, integrator: &Integrator, property: Property, aspect_ratio: f64) -> Limit {
    let count = match property {
        Property::Length => LENGTHS.few,
        Property::Orbit => ORBITS.few,
        _ => RODS,
    };
    bisect(ladder, |strain| holds(integrator, property, aspect_ratio, strain, count))
}

/// The longest step up to which `holds` is true on the ladder, refined by bisection between the last rung where it is
/// true and the first where it is false.
fn bisect(ladder: Ladder, holds: impl Fn(f64) -> bool) -> Limit {
    let mut good = ladder.least;
    if !holds(good) {
        return Limit::Below(good);
    }
    loop {
        let next = good * ladder.factor;
        if next > ladder.most {
            return Limit::Beyond(good);
        }
        if !holds(next) {
            let (mut low, mut high) = (good, next);
            while high - low > 1e-7 * low {
                let middle = 0.5 * (low + high);
                if holds(middle) { low = middle } else { high = middle }
            }
            return Limit::At(low);
        }
        good = next;
    }
}

/// True if an integrator keeps a property with steps of GΔt = `strain` at this aspect ratio, from `count` directions.
fn holds(integrator: &Integrator, property: Property, aspect_ratio: f64, strain: f64, count: u32) -> bool {
    let stepped = |p3: f64, more: u32| {
        let parts = (0..count).step_by(PART as usize);
        parts.map(move |first| near_plane(integrator, aspect_ratio, strain, p3, first..first + PART + more))
    };
    match property {
        Property::Order => stepped(0.0, 1).all(|rods| {
            let mut pairs = rods.windows(2);
            pairs.all(|pair| forward(&pair[0].1, &pair[1].1))
        }),
        Property::Turning => stepped(0.0, 0).all(|rods| rods.iter().all(|(before, after)| forward(before, after))),
        Property::Side => stepped(NEAR_PLANE, 0).all(|rods| rods.iter().all(|(_, after)| after.z > 0.0)),
        Property::Length => {
            let starts: Vec<_> = directions(count, 0.5 * PI).collect();
            ten_periods(integrator, aspect_ratio, strain, &starts)
                .is_ok_and(|(_, ends)| ends.iter().all(|end| end.norm() < 1.5))
        }
        Property::Orbit => {
            let starts: Vec<_> = directions(count, 1.0).collect();
            ten_periods(integrator, aspect_ratio, strain, &starts).is_ok_and(|(problem, ends)| {
                let mut rods = starts.iter().zip(&ends);
                rods.all(|(start, end)| Errors::of(end, &problem, start).orbit_constant < 0.1)
            })
        }
        Property::Solvable => (0..=64).all(|i| {
            (0..=16).all(|j| {
                let p = shearbed::model::orientation::from_angles(PI * f64::from(i) / 64.0, PI * f64::from(j) / 16.0);
                let end = integrator.advance(&one_step(aspect_ratio, strain), &p, one(integrator));
                end.is_ok_and(|p| p.iter().all(|component| component.is_finite()))
            })
        }),
    }
}

/// φ of the rod `k` of `count` over half of the vorticity axis. Halfway between two of [`RODS`] is the steepest place
/// of φ̇, φ = π/4.
fn phi(k: u32, count: u32) -> f64 {
    PI * (f64::from(k) + 0.5) / f64::from(count)
}

/// True if b is ahead of a by less than half a turn, or behind it by round-off.
fn forward(a: &Vector3<f64>, b: &Vector3<f64>) -> bool {
    (a.x * b.y - a.y * b.x) / (a.norm() * b.norm()) >= -4.0 * f64::EPSILON
}

/// Pairs of directions before and after one step, which start beside the plane of shear by `p3`; NaN if the step fails.
fn near_plane(
    integrator: &Integrator,
    aspect_ratio: f64,
    strain: f64,
    p3: f64,
    rods: Range<u32>,
) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let start = |k: u32| UnitVector3::new_normalize(Vector3::new(phi(k, RODS).cos(), phi(k, RODS).sin(), p3));
    let starts: Vec<_> = rods.map(start).collect();
    let ends = integrator.advance_all(&one_step(aspect_ratio, strain), &starts, one(integrator));
    let ends = ends.unwrap_or(vec![Vector3::repeat(f64::NAN); starts.len()]);
    starts.into_iter().map(UnitVector3::into_inner).zip(ends).collect()
}

fn one_step(aspect_ratio: f64, strain: f64) -> RodProblem {
    RodProblem::new(aspect_ratio, strain / RodProblem::new(aspect_ratio, 1.0).strain())
}

fn one(integrator: &Integrator) -> Setting {
    match integrator.theory {
        Theory::Exact => Setting::Once,
        _ => Setting::Steps(1),
    }
}

/// Directions at `theta` from the vorticity axis, evenly around half of it.
fn directions(count: u32, theta: f64) -> impl Iterator<Item = UnitVector3<f64>> {
    (0..count).map(move |k| shearbed::model::orientation::from_angles(phi(k, count), theta))
}

/// Ten periods by steps of GΔt = `strain`, rounded up to whole steps.
fn ten_periods(
    integrator: &Integrator,
    aspect_ratio: f64,
    strain: f64,
    starts: &[UnitVector3<f64>],
) -> Result<(RodProblem, Vec<Vector3<f64>>), Failure> {
    let period = RodProblem::new(aspect_ratio, 1.0).strain();
    let steps = (PERIODS * period / strain).ceil();
    let problem = RodProblem::new(aspect_ratio, steps * strain / period);
    let ends = integrator.advance_all(&problem, starts, Setting::Steps(steps as u64))?;
    Ok((problem, ends))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::{own, rk4};

    #[test]
    fn few_directions_find_the_length_lost_late() {
        let all = own();
        let rk4_in_p = all.iter().find(|integrator| integrator.name == "RK4 in p").unwrap();
        let keeps = |strain, count| holds(rk4_in_p, Property::Length, 11.6, strain, count);
        assert!(keeps(1.184, 45) && !keeps(1.184, 720) && keeps(0.592, 720));
        let at = |limit: Limit| match limit {
            Limit::At(strain) => strain,
            other => panic!("{other:?}"),
        };
        let few = at(longest_on(LENGTHS.ladder, rk4_in_p, Property::Length, 11.6));
        // As docs/src/developer/step-limits.md has them.
        let many = [3.0, 11.6, 100.0].map(|r| at(longest(rk4_in_p, Property::Length, r)));
        assert_eq!(many.map(|strain| format!("{strain:.2}")), ["1.30", "1.18", "1.13"]);
        assert!(many[1] < 0.85 * few, "{many:?} {few}");
    }

    #[test]
    fn rods_abreast_take_the_steps_of_one() {
        let step = |problem: &RodProblem, p, h| rk4(|y| problem.rate(&y), p, h);
        let integrator = Integrator::in_p("RK4", 4, step);
        let starts: Vec<_> = directions(11, 1.0).collect();
        let problem = RodProblem::new(5.0, 1.3);
        let together = integrator.advance_all(&problem, &starts, Setting::Steps(100)).unwrap();
        for (start, end) in starts.iter().zip(together) {
            assert_eq!(integrator.advance(&problem, start, Setting::Steps(100)).unwrap(), end);
        }
        let too_long = RodProblem::new(1.5, 1e3);
        assert!(integrator.advance_all(&too_long, &starts, Setting::Steps(100)).is_err());
    }
}
