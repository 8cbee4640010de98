//! Intervals by profile likelihood: the range of one parameter while the others are re-optimised.

use super::best::Best;
use super::minimise::minimise;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Number of places of a profile between the edges of the box.
const PLACES: usize = 61;

/// Number of halvings to find where a profile crosses a level between two places: to 3e-8 of half a box.
const HALVINGS: usize = 20;

/// An interval of one parameter, on the scale of the box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// True, below and above, if the profile does not reach the level before the edge of the box.
    pub open: [bool; 2],
    /// True if the profile jumps over the level at an end: the inner minima on both sides belong to different valleys.
    #[serde(skip)]
    pub jumps: [bool; 2],
}

/// The rise of χ² along one parameter, with the others at their best.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The parameter's places in the box, ascending.
    pub place: Vec<f64>,
    /// The rise of χ², reduced for the noise of the replicas.
    pub rise: Vec<f64>,
    /// The average contribution of that noise, which is subtracted.
    pub noise: Vec<f64>,
    /// The share of the parameter's variance that χ² shows; the rise is multiplied by it.
    pub shown: f64,
    /// All parameters at each place.
    pub at: Vec<Vec<f64>>,
}

/// The rise of χ² at the ends of an interval of this confidence for one parameter.
pub fn rise_of(confidence: f64) -> f64 {
    rise_of_several(confidence, 1)
}

/// The rise of χ² at the edge of a joint region of this confidence for several parameters.
pub fn rise_of_several(confidence: f64, parameters: usize) -> f64 {
    ChiSquared::new(parameters as f64).map_or(f64::NAN, |law| law.inverse_cdf(confidence))
}

/// The rise of χ² from the best place to another.
struct Rise {
    /// All parameters at the other place.
    at: Vec<f64>,
    /// χ² − χ²_min.
    own: f64,
    /// The average contribution of the replicas' noise, which is subtracted.
    noise: f64,
}

impl Rise {
    /// The rise from the best place to the smallest χ² with some parameters fixed.
    fn to(best: &Best, fixed: &[Option<f64>], starts: &[&[f64]]) -> Self {
        let (at, chi_square) = minimise(&best.surface, fixed, starts);
        Self {
            own: (chi_square - best.chi_square).max(0.0),
            noise: best.surface.noise_between(&at, &best.place),
            at,
        }
    }

    /// The rise with the parameter `axis` fixed at `place`.
    fn along(best: &Best, axis: usize, place: f64, starts: &[&[f64]]) -> Self {
        let mut fixed = vec![None; best.place.len()];
        fixed[axis] = Some(place);
        Self::to(best, &fixed, starts)
    }

    /// The rise that counts for an interval. Noise in the slopes makes the variance of an estimate larger than the curvature of χ² shows,
    /// by the factor (own + noise) / own: χ² has to rise that much further.
    fn beside_noise(&self) -> f64 {
        match self.own > 0.0 {
            true => self.own * (self.own / (self.own + self.noise)),
            false => 0.0,
        }
    }
}

/// The profile of one parameter over the box, with its best place among the places. The inner minima are searched from a grid,
/// from the best place, and from the minima of the neighbours on both sides.
pub fn profile(best: &Best, axis: usize) -> Profile {
    let even = (0..PLACES).map(|k| -1.0 + 2.0 * k as f64 / (PLACES - 1) as f64);
    let mut place: Vec<f64> = even.chain([best.place[axis]]).collect();
    place.sort_by(f64::total_cmp);
    let mut found: Vec<Rise> =
        (place.iter()).map(|place| Rise::along(best, axis, *place, &[&best.place])).collect();
    let last = place.len() - 1;
    let pairs = (0..last).map(|k| (k, k + 1)).chain((0..last).rev().map(|k| (k + 1, k)));
    for (from, to) in pairs.filter(|_| best.place.len() > 1) {
        let next = Rise::along(best, axis, place[to], &[&found[from].at]);
        if next.own < found[to].own {
            found[to] = next;
        }
    }
    let shown = best.shown(&[axis]);
    Profile {
        place,
        shown,
        rise: found.iter().map(|rise| shown * rise.beside_noise()).collect(),
        noise: found.iter().map(|rise| rise.noise).collect(),
        at: found.into_iter().map(|rise| rise.at).collect(),
    }
}

impl Profile {
    /// The larger share of the replicas' noise in the rise at the two ends of an interval; 0 if the profile does not reach
    /// `level`.
    pub fn feigned(&self, level: f64) -> f64 {
        let outside = |k: &usize| self.rise[*k] > level;
        let inside: Vec<usize> = (0..self.place.len()).filter(|k| !outside(k)).collect();
        let next = [
            inside.first().and_then(|k| k.checked_sub(1)),
            inside.last().map(|k| k + 1).filter(|k| *k < self.place.len()),
        ];
        let share = |k: usize| {
            let (rise, noise) = (self.rise[k] / self.shown, self.noise[k]);
            // rise = own² / (own + noise).
            let own = 0.5 * (rise + (rise * (rise + 4.0 * noise)).sqrt());
            noise / (own + noise)
        };
        next.into_iter().flatten().map(share).fold(0.0, f64::max)
    }
}

/// If the profile does not jump at an end, which is found to 3e-8 of half a box, χ² on its two sides differs by less than this:
/// else it would rise by 1e5 over half a box, where four standard deviations, 16, reach the edge of a box.
const JUMP: f64 = 0.01;

/// The interval in which a profile is below `level`, between the outermost crossings, so that a second valley is included.
pub fn interval(best: &Best, axis: usize, profile: &Profile, level: f64) -> Interval {
    let inside: Vec<usize> = (0..profile.place.len()).filter(|k| profile.rise[*k] <= level).collect();
    let last = profile.place.len() - 1;
    let (first_in, last_in) = match (inside.first(), inside.last()) {
        (Some(first), Some(last)) => (*first, *last),
        _ => (0, last),
    };
    // The crossing between a place inside and one outside, and whether the profile jumps there.
    let crossing = |inside: usize, outside: usize| {
        let (mut inner, mut outer) = (profile.place[inside], profile.place[outside]);
        let starts = [&best.place[..], &profile.at[inside], &profile.at[outside]];
        let mut rises = [profile.rise[inside], profile.rise[outside]];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inner + outer);
            let found = profile.shown * Rise::along(best, axis, middle, &starts).beside_noise();
            match found <= level {
                true => (inner, rises[0]) = (middle, found),
                false => (outer, rises[1]) = (middle, found),
            }
        }
        (0.5 * (inner + outer), rises[1] - rises[0] > JUMP)
    };
    let open = [first_in == 0, last_in == last];
    let (low, low_jumps) = match open[0] {
        true => (-1.0, false),
        false => crossing(first_in, first_in - 1),
    };
    let (high, high_jumps) = match open[1] {
        true => (1.0, false),
        false => crossing(last_in, last_in + 1),
    };
    Interval { low, high, open, jumps: [low_jumps, high_jumps] }
}

/// The rise of χ², reduced for the noise of the replicas, with some parameters fixed and the others re-optimised.
pub fn rise_to(best: &Best, fixed: &[Option<f64>]) -> f64 {
    let axes: Vec<usize> = (0..fixed.len()).filter(|axis| fixed[*axis].is_some()).collect();
    best.shown(&axes) * Rise::to(best, fixed, &[&best.place]).beside_noise()
}

/// The boundary of the joint region of two parameters, `axes`, as a closed curve around the best place, cut at the edges of the box. The
/// directions are uniform in the scale where the covariance is a circle, so that they resolve a long thin region. Other parameters are
/// at their best.
pub fn contour(best: &Best, axes: [usize; 2], level: f64) -> Vec<[f64; 2]> {
    const DIRECTIONS: usize = 144;
    let [a, b] = axes;
    let rise = |point: [f64; 2]| {
        let mut fixed = vec![None; best.place.len()];
        (fixed[a], fixed[b]) = (Some(point[0]), Some(point[1]));
        rise_to(best, &fixed)
    };
    let spread = best.covariance();
    let (along_a, shared) = (spread[(a, a)].sqrt(), spread[(a, b)] / spread[(a, a)].sqrt());
    let along_b = (spread[(b, b)] - shared * shared).max(0.0).sqrt();
    let centre = [best.place[a], best.place[b]];
    let end = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
        let way = [along_a * cos, shared * cos + along_b * sin];
        let to_edge = |k: usize| match way[k].abs() < 1e-12 {
            true => f64::INFINITY,
            false => (way[k].signum() - centre[k]) / way[k],
        };
        let most = to_edge(0).min(to_edge(1)).max(0.0);
        let point = |reach: f64| [0, 1].map(|k| (centre[k] + reach * way[k]).clamp(-1.0, 1.0));
        if rise(point(most)) <= level {
            return point(most);
        }
        let (mut inner, mut outer) = (0.0, most);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inner + outer);
            *(if rise(point(middle)) <= level { &mut inner } else { &mut outer }) = middle;
        }
        point(inner)
    };
    (0..=DIRECTIONS).map(end).collect()
}
