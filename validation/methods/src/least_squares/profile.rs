//! Intervals by profile likelihood: the range of one parameter while the others are re-optimised.

use super::best::Best;
use super::minimise::{descend, minimise};
use statrs::distribution::{ChiSquared, ContinuousCDF};

const PLACES: usize = 61;

/// Number of halvings to find where a profile crosses a level between two places: to 3e-8 of half a box.
const HALVINGS: usize = 20;

/// An interval of one parameter, on the scale of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// True, below and above, if the profile does not reach the level before the edge of the box.
    pub open: [bool; 2],
    /// True if the profile jumps over the level at an end: the inner minima on both sides belong to different valleys.
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
    at: Vec<f64>,
    own: f64,
    /// The average contribution of the replicas' noise, which is subtracted.
    noise: f64,
}

impl Rise {
    /// The rise from the best place to the smallest χ² with some parameters fixed.
    fn to(best: &Best, fixed: &[Option<f64>], starts: &[&[f64]]) -> Self {
        Self::of(best, minimise(&best.surface, fixed, starts))
    }

    /// The rise from the best place to another one with this χ².
    fn of(best: &Best, (at, chi_square): (Vec<f64>, f64)) -> Self {
        Self { own: (chi_square - best.chi_square).max(0.0), noise: best.surface.noise_between(&at, &best.place), at }
    }

    /// The rise with the parameter `axis` fixed at `place`.
    fn along(best: &Best, axis: usize, place: f64, starts: &[&[f64]]) -> Self {
        Self::to(best, &fixed(best, &[(axis, place)]), starts)
    }

    /// The rise with the parameter `axis` fixed at `place`, in the valley of `start`.
    fn from(best: &Best, axis: usize, place: f64, start: &[f64]) -> Self {
        Self::of(best, descend(&best.surface, &fixed(best, &[(axis, place)]), start.to_vec()))
    }

    /// The rise that counts for an interval. Noise in the slopes makes the variance of an estimate larger than the
    /// curvature of χ² shows, by the factor (own + noise) / own: χ² has to rise that much further.
    fn beside_noise(&self) -> f64 {
        if self.own > 0.0 { self.own * (self.own / (self.own + self.noise)) } else { 0.0 }
    }
}

/// The parameters with these fixed at their places.
pub fn fixed(best: &Best, at: &[(usize, f64)]) -> Vec<Option<f64>> {
    let place = |axis: usize| at.iter().find(|(fixed, _)| *fixed == axis).map(|(_, place)| *place);
    (0..best.place.len()).map(place).collect()
}

/// The profile of one parameter over the box, with its best place among the places. The inner minima are searched from
/// a grid, from the best place, and from the minima of the neighbours on both sides.
pub fn profile(best: &Best, axis: usize) -> Profile {
    let even = (0..PLACES).map(|k| -1.0 + 2.0 * k as f64 / (PLACES - 1) as f64);
    let mut place: Vec<f64> = even.chain([best.place[axis]]).collect();
    place.sort_by(f64::total_cmp);
    let mut found: Vec<Rise> = (place.iter()).map(|place| Rise::along(best, axis, *place, &[&best.place])).collect();
    let last = place.len() - 1;
    let pairs = (0..last).map(|k| (k, k + 1)).chain((0..last).rev().map(|k| (k + 1, k)));
    for (from, to) in pairs.filter(|_| best.place.len() > 1) {
        let next = Rise::from(best, axis, place[to], &found[from].at);
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
    /// The larger share of the replicas' noise in the rise at the two ends of an interval; 0 if the profile does not
    /// reach `level`.
    pub fn noise_share(&self, level: f64) -> f64 {
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
        shearbed_oracle::worst(next.into_iter().flatten().map(share))
    }
}

/// If the profile does not jump at an end, which is found to 3e-8 of half a box, χ² on its two sides differs by less
/// than this: else it would rise by 1e5 over half a box, where four standard deviations, 16, reach the edge of a box.
const JUMP: f64 = 0.01;

/// The interval in which a profile is below `level`, between the outermost crossings, so that a second valley is
/// included.
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
            if found <= level { (inner, rises[0]) = (middle, found) } else { (outer, rises[1]) = (middle, found) }
        }
        (0.5 * (inner + outer), rises[1] - rises[0] > JUMP)
    };
    let open = [first_in == 0, last_in == last];
    let (low, low_jumps) = if open[0] { (-1.0, false) } else { crossing(first_in, first_in - 1) };
    let (high, high_jumps) = if open[1] { (1.0, false) } else { crossing(last_in, last_in + 1) };
    Interval { low, high, open, jumps: [low_jumps, high_jumps] }
}

/// The rise of χ², reduced for the noise of the replicas, with some parameters fixed and the others re-optimised.
pub fn rise_to(best: &Best, fixed: &[Option<f64>]) -> f64 {
    let axes: Vec<usize> = (0..fixed.len()).filter(|axis| fixed[*axis].is_some()).collect();
    best.shown(&axes) * Rise::to(best, fixed, &[&best.place]).beside_noise()
}

const COLUMNS: usize = 72;

/// The outlines of the joint region of the parameters `a` and `b`: a closed curve for each of its islands, cut at the
/// edges of the box. Other parameters are at their best. `profile` is that of `a`. The region is cut into columns of
/// equal `a`, which lie close at its two ends; a column reaches on both sides of its deepest place to where χ² has
/// risen to `level`, so a bent valley is followed.
pub fn region(best: &Best, profile: &Profile, [a, b]: [usize; 2], level: f64) -> Vec<Vec<[f64; 2]>> {
    let shown = best.shown(&[a, b]);
    let ends = interval(best, a, profile, level * profile.shown / shown);
    let (middle, half) = (0.5 * (ends.low + ends.high), 0.5 * (ends.high - ends.low));
    let spread = best.covariance();
    let first_step = 0.25 * (spread[(b, b)] - spread[(a, b)].powi(2) / spread[(a, a)]).max(1e-12).sqrt();
    let mut islands: Vec<Vec<[f64; 3]>> = Vec::new();
    let deepest_at = |place: f64| {
        let near = profile.place.partition_point(|other| *other < place).min(profile.at.len() - 1);
        Rise::along(best, a, place, &[&profile.at[near], &profile.at[near.saturating_sub(1)]])
    };
    let is_beyond = |found: &Rise| shown * found.beside_noise() > level;
    // Where an island ends between two columns, the last of which has it.
    let tip = |mut beyond: f64, mut within: f64, mut b_there: f64| {
        for _ in 0..HALVINGS {
            let between = 0.5 * (beyond + within);
            let found = deepest_at(between);
            if is_beyond(&found) {
                beyond = between
            } else {
                (within, b_there) = (between, found.at[b]);
            }
        }
        [within, b_there, b_there]
    };
    // The column before, and its deepest place; the place before, if no island has it.
    let mut last: Option<([f64; 3], Vec<f64>)> = None;
    let mut outside = None;
    for k in 0..=COLUMNS {
        let place = middle - half * (std::f64::consts::PI * k as f64 / COLUMNS as f64).cos();
        let found = deepest_at(place);
        // The ends of the region are known to the halvings of `interval`.
        let is_end = k == 0 || k == COLUMNS;
        if !is_end && is_beyond(&found) {
            if let (Some((column, deepest)), Some(island)) = (last.take(), islands.last_mut()) {
                island.push(tip(place, column[0], deepest[b]));
            }
            outside = Some(place);
            continue;
        }
        let is_inside = |other: f64| {
            let fixed = fixed(best, &[(a, place), (b, other)]);
            shown * Rise::to(best, &fixed, &[&found.at]).beside_noise() <= level
        };
        let [low, high] = [-1.0, 1.0].map(|side| end(found.at[b], side, first_step, is_inside));
        let is_joined = last.as_ref().is_some_and(|([before, below, above], deepest)| {
            // The columns of a steep thin valley do not overlap.
            low <= *above && *below <= high || {
                // Half way from one valley to another the deepest place is in one of them.
                let between = Rise::along(best, a, 0.5 * (before + place), &[&found.at, deepest]).at[b];
                (between - 0.5 * (found.at[b] + deepest[b])).abs() < 0.25 * (found.at[b] - deepest[b]).abs()
            }
        });
        let column = [place, low, high];
        match (islands.last_mut(), outside.take()) {
            (Some(island), _) if is_joined => island.push(column),
            (_, Some(beyond)) => islands.push(vec![tip(beyond, place, found.at[b]), column]),
            _ => islands.push(vec![column]),
        }
        last = Some((column, found.at));
    }
    let outline = |island: Vec<[f64; 3]>| {
        let there = island.iter().map(|[place, low, _]| [*place, *low]);
        let back = island.iter().rev().map(|[place, _, high]| [*place, *high]);
        there.chain(back).chain([[island[0][0], island[0][1]]]).collect()
    };
    islands.into_iter().map(outline).collect()
}

/// Where the inside ends on one side of `centre`, −1 or 1: at the edge of the box at the latest. It is looked for in
/// growing steps.
fn end(centre: f64, side: f64, first_step: f64, is_inside: impl Fn(f64) -> bool) -> f64 {
    let (mut inner, mut step) = (centre, first_step);
    let mut outer = loop {
        let next = (inner + side * step).clamp(-1.0, 1.0);
        if !is_inside(next) {
            break next;
        }
        if next == side {
            return side;
        }
        (inner, step) = (next, 2.0 * step);
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inner + outer);
        *(if is_inside(middle) { &mut inner } else { &mut outer }) = middle;
    }
    inner
}
