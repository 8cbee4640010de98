//! The rods' directions: each rod keeps the direction it had after its last collision, and the exact
//! motion takes it from there to whatever time is asked for. A free rod is never stepped.

use crate::observable::{BLOCK, Block};
use crate::orientation::{from_angles, isotropic};
use crate::plan::{Clock, Plan, Stage};
use crate::propagator::{Phase, Propagator, couette};
use crate::random::{Purpose, stream};
use crate::scene::Orientation;
use nalgebra::{Matrix3, UnitVector3, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, Normal};

/// Directions and aspect ratios of one replica's rods, as structure of arrays.
#[derive(Clone, Debug)]
pub(crate) struct Rods {
    /// Each rod's direction at its tick `since`.
    p: [Vec<f64>; 3],
    /// Empty where no rod can collide: every rod then counts from tick 0.
    since: Vec<u32>,
    shapes: Shapes,
    motion: Motion,
}

#[derive(Clone, Debug)]
enum Shapes {
    Shared(f64),
    Each {
        aspect_ratio: Vec<f64>,
        /// T of the mean aspect ratio over the rod's own T.
        periods: Vec<f64>,
    },
}

#[derive(Clone, Debug)]
enum Motion {
    /// Plane Couette flow: phases from ticks per period; `sign` of G.
    Couette { ticks: u64, sign: f64 },
    /// Any other flow, one aspect ratio: the map to each output.
    Shared(Vec<Matrix3<f64>>),
    /// Any other flow, unequal aspect ratios: a propagator per rod, and the outputs' times in s.
    Each {
        propagators: Vec<Propagator>,
        times_s: Vec<f64>,
    },
}

impl Rods {
    /// Draws the rods of a replica; also returns how many aspect ratios were drawn again.
    pub fn draw(plan: &Plan, replica: u64) -> (Self, u64) {
        let (shapes, redrawn) = draw_shapes(plan, replica);
        let motion = choose_motion(plan, &shapes);
        let since = if plan.keeps(Stage::Contacts) {
            vec![0; plan.scene().particles.count]
        } else {
            Vec::new()
        };
        let rods = Self {
            p: draw_directions(plan, replica),
            since,
            shapes,
            motion,
        };
        (rods, redrawn)
    }

    pub fn count(&self) -> usize {
        self.p[0].len()
    }

    pub fn aspect_ratio(&self, rod: usize) -> f64 {
        match &self.shapes {
            Shapes::Shared(r) => *r,
            Shapes::Each { aspect_ratio, .. } => aspect_ratio[rod],
        }
    }

    /// Whether the rod was turned by a collision in the step that ends after `tick`.
    pub fn turned_after(&self, rod: usize, tick: u64) -> bool {
        u64::from(self.since[rod]) > tick
    }

    /// Puts the rod along `p` at `tick`.
    pub fn set(&mut self, rod: usize, p: &UnitVector3<f64>, tick: u64) {
        for (axis, value) in self.p.iter_mut().zip([p.x, p.y, p.z]) {
            axis[rod] = value;
        }
        self.since[rod] = tick as u32;
    }

    /// The direction of one rod in plane Couette flow at `tick`.
    pub fn direction(&self, rod: usize, tick: u64) -> Vector3<f64> {
        let Motion::Couette { ticks, sign } = self.motion else {
            unreachable!("only rods in plane Couette flow are asked for one by one");
        };
        let (r, periods) = match &self.shapes {
            Shapes::Shared(r) => (*r, 1.0),
            Shapes::Each {
                aspect_ratio,
                periods,
            } => (aspect_ratio[rod], periods[rod]),
        };
        let phase = phase(tick - self.since(rod), ticks, sign * periods);
        couette(self.reference(rod), r, phase).into()
    }

    /// Fills `block` with the directions at `tick` (for flows other than plane Couette flow: at that
    /// output) of up to [`BLOCK`] rods from `first` on.
    pub fn orient(&self, first: usize, tick: u64, block: &mut Block) {
        block.len = BLOCK.min(self.count() - first);
        match &self.shapes {
            Shapes::Shared(r) => block.aspect_ratio[..block.len].fill(*r),
            Shapes::Each { aspect_ratio, .. } => {
                block.aspect_ratio[..block.len].copy_from_slice(&aspect_ratio[first..first + block.len]);
            }
        }
        match (&self.motion, &self.shapes) {
            (Motion::Couette { ticks, sign }, Shapes::Shared(r)) if self.since.is_empty() => {
                let phase = phase(tick, *ticks, *sign);
                self.fill(first, block, |_, p| couette(p, *r, phase));
            }
            (Motion::Couette { ticks, sign }, Shapes::Shared(r)) => {
                self.fill(first, block, |rod, p| {
                    couette(p, *r, phase(tick - self.since(rod), *ticks, *sign))
                });
            }
            (
                Motion::Couette { ticks, sign },
                Shapes::Each {
                    aspect_ratio,
                    periods,
                },
            ) => {
                self.fill(first, block, |rod, p| {
                    let phase = phase(tick - self.since(rod), *ticks, sign * periods[rod]);
                    couette(p, aspect_ratio[rod], phase)
                });
            }
            (Motion::Shared(maps), _) => {
                let map = &maps[tick as usize];
                self.fill(first, block, |_, p| mapped(map, p));
            }
            (Motion::Each { propagators, times_s }, _) => {
                self.fill(first, block, |rod, p| {
                    mapped(&propagators[rod].map_over(times_s[tick as usize]), p)
                });
            }
        }
    }

    fn fill(&self, first: usize, block: &mut Block, move_to: impl Fn(usize, [f64; 3]) -> [f64; 3]) {
        let [p1, p2, p3] = &mut block.p;
        let range = first..first + block.len;
        let [r1, r2, r3] = self.p.each_ref().map(|axis| &axis[range.clone()]);
        for (i, (((p1, p2), p3), ((r1, r2), r3))) in p1
            .iter_mut()
            .zip(p2)
            .zip(p3)
            .zip(r1.iter().zip(r2).zip(r3))
            .enumerate()
        {
            [*p1, *p2, *p3] = move_to(first + i, [*r1, *r2, *r3]);
        }
    }

    fn reference(&self, rod: usize) -> [f64; 3] {
        [self.p[0][rod], self.p[1][rod], self.p[2][rod]]
    }

    fn since(&self, rod: usize) -> u64 {
        self.since.get(rod).copied().map_or(0, u64::from)
    }
}

/// The phase after `ticks` of a rod that turns `periods` times while the mean rod turns once. Whole mean
/// periods and the rest are taken apart, so that no digits of the phase are lost to the number of turns.
#[inline]
fn phase(ticks: u64, per_period: u64, periods: f64) -> Phase {
    let whole = (ticks / per_period) as f64;
    let rest = (ticks % per_period) as f64 / per_period as f64;
    Phase::of_turns((whole * periods).fract() + rest * periods)
}

#[inline]
fn mapped(map: &Matrix3<f64>, p: [f64; 3]) -> [f64; 3] {
    (map * Vector3::from(p)).normalize().into()
}

fn draw_shapes(plan: &Plan, replica: u64) -> (Shapes, u64) {
    let particles = &plan.scene().particles;
    let mean = particles.aspect_ratio;
    if !plan.keeps(Stage::AspectRatios) {
        return (Shapes::Shared(mean), 0);
    }
    let deviation = mean * particles.aspect_ratio_sd_percent / 100.0;
    // The scene's check allows a finite deviation ≥ 0 only.
    let Ok(gaussian) = Normal::new(mean, deviation) else {
        return (Shapes::Shared(mean), 0);
    };
    let mut rng = stream(plan.scene().ensemble.seed, replica, Purpose::AspectRatios);
    let mut redrawn = 0;
    // A rod stays a rod and a disc a disc; a draw across r_e = 1 (or below 0) is drawn again (eq. 11).
    let allowed = |r: f64| {
        if mean > 1.0 {
            r > 1.0
        } else {
            r > 0.0 && (r < 1.0 || mean == 1.0)
        }
    };
    let aspect_ratio: Vec<f64> = (0..particles.count)
        .map(|_| {
            loop {
                let r = gaussian.sample(&mut rng);
                if allowed(r) {
                    return r;
                }
                redrawn += 1;
            }
        })
        .collect();
    let period = |r: f64| Propagator::new(plan.flow(), r).period();
    let periods = match period(mean) {
        Some(mean_period) => aspect_ratio
            .iter()
            .map(|&r| mean_period / period(r).unwrap_or(mean_period))
            .collect(),
        None => Vec::new(),
    };
    (
        Shapes::Each {
            aspect_ratio,
            periods,
        },
        redrawn,
    )
}

fn draw_directions(plan: &Plan, replica: u64) -> [Vec<f64>; 3] {
    let particles = &plan.scene().particles;
    let count = particles.count;
    let mut p = [(); 3].map(|()| Vec::with_capacity(count));
    let mut push = |direction: UnitVector3<f64>| {
        for (axis, value) in p.iter_mut().zip([direction.x, direction.y, direction.z]) {
            axis.push(value);
        }
    };
    let mut rng = plan
        .keeps(Stage::Orientations)
        .then(|| stream(plan.scene().ensemble.seed, replica, Purpose::Orientations));
    for _ in 0..count {
        let drawn = rng.as_mut().map(|rng| {
            let r4 = rng.random();
            isotropic(r4, rng.random())
        });
        push(match (particles.orientation, drawn) {
            (Orientation::Random(_), Some(drawn)) => drawn,
            (Orientation::Given { phi_deg, theta_deg }, _) => {
                from_angles(phi_deg.to_radians(), theta_deg.to_radians())
            }
            (Orientation::Random(_), None) => unreachable!("a plan keeps the draws of random directions"),
        });
    }
    p
}

fn choose_motion(plan: &Plan, shapes: &Shapes) -> Motion {
    let flow = plan.flow();
    if let (Some(g), Clock::Periods { ticks }) = (flow.shear_rate_per_s(), plan.clock()) {
        return Motion::Couette {
            ticks,
            sign: g.signum(),
        };
    }
    let times_s = output_times_s(plan);
    match shapes {
        Shapes::Shared(r) => {
            let propagator = Propagator::new(flow, *r);
            Motion::Shared(match plan.clock() {
                Clock::Periods { ticks } => (0..plan.outputs() as u64)
                    .map(|tick| (tick % ticks) as f64 / ticks as f64)
                    .filter_map(|turns| propagator.map_over_turns(turns))
                    .collect(),
                Clock::Strain { .. } => times_s.iter().map(|&time| propagator.map_over(time)).collect(),
            })
        }
        Shapes::Each { aspect_ratio, .. } => Motion::Each {
            propagators: aspect_ratio.iter().map(|&r| Propagator::new(flow, r)).collect(),
            times_s,
        },
    }
}

fn output_times_s(plan: &Plan) -> Vec<f64> {
    let unit_s = match plan.clock() {
        Clock::Strain { .. } => 1.0 / plan.flow().magnitude_per_s(),
        Clock::Periods { .. } => Propagator::new(plan.flow(), plan.scene().particles.aspect_ratio)
            .period_s()
            .unwrap_or(0.0),
    };
    plan.times().into_iter().map(|time| time * unit_s).collect()
}
