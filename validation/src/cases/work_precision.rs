//! The error of a suspension's mean against the rods, and runs that share random numbers, as claimed by
//! `docs/src/verification/integrators.md`. Nothing is timed.

use super::*;
use crate::judge::statistics::correlation;
use crate::methods::starts::{self, Start};
use crate::oracle::naive::collision_probability;
use crate::studies::suspensions::coupled::{at, free, free_mean, interacting};
use crate::studies::suspensions::free::{Free, exponents};
use crate::studies::suspensions::job::Job;
use crate::studies::suspensions::{blocks, law};
use statrs::statistics::Statistics;

pub fn cases() -> Vec<Case> {
    let spoiled = |of: usize, lay| vec![Start { lay, ..starts::ALL[of] }];
    let same = Beside { free: |_| {}, other: |_| {}, mean: |_| {} };
    vec![
        Case::of(Judges::Integrator, "free-suspension-rates")
            .claim(
                "The error of a free suspension's X̄₁ falls as N^(−½) for random starts, N^(−1) for stratified ones \
                 and N^(−5/4) for a Fibonacci lattice.",
            )
            .source("eqs 4, 12")
            .under_test(starts::ALL.to_vec())
            .mistake(
                "the generator starts again every 100 rods",
                spoiled(0, |count, unequal, rng| {
                    let seed = rng.random();
                    (0..count.div_ceil(100))
                        .flat_map(|_| (starts::ALL[0].lay)(100, unequal, &mut Pcg64Dxsm::seed_from_u64(seed)))
                        .take(count)
                        .collect()
                }),
            )
            .mistake("cells that are drawn from at random, not each once", spoiled(1, starts::ALL[0].lay))
            .mistake(
                "every rod on a lattice of its own",
                spoiled(2, |count, unequal, rng| {
                    (0..count).flat_map(|_| (starts::ALL[2].lay)(1, unequal, rng)).collect()
                }),
            )
            .check(rates),
        Case::of(Judges::Program, "replicas-are-independent")
            .claim("The scatter of a mean over M replicas of interacting rods falls as M^(−½).")
            .source("eq. 12; section 'Method of solution': runs with other random numbers")
            .under_test((|replica| replica) as Number)
            .mistake("every two replicas are the same", |replica| replica / 2)
            .check(replicas),
        Case::of(Judges::Interpretation, "faces-cost-collisions")
            .claim(
                "What the control volume's faces take from the collisions of a rod falls as N^(−1/3), the share of the \
                 volume near a face, and not as 1/N.",
            )
            .source("eq. 8; 'the number of particles'")
            .under_test(law::FACES)
            .mistake("1/N", -1.0)
            .check(faces),
        Case::of(Judges::Core, "paths-do-not-converge")
            .claim(
                "Halving the time step again and again does not bring a rod's paths together, because \
                 kicks have no bound.",
            )
            .source("A.13, A.14; eq. 8 without Δt")
            .under_test((|_| {}) as Change)
            .mistake("arms below a rod length are no contact, so that kicks are bounded", |scene| {
                lab::interaction(scene).min_contact_arm = 1.0
            })
            .check(paths),
        Case::of(Judges::Program, "shared-random-numbers")
            .claim(
                "The same rods without collisions say more of X̄₁ than a run at half the step, and their \
                 mean is known; for a difference between two α, shared random numbers save a factor of \
                 four at T/4.",
            )
            .source("eqs 4, 7")
            .under_test(same)
            .mistake("free rods of another seed", Beside { free: |scene| scene.ensemble.seed += 1, ..same })
            .mistake("the other α at another seed", Beside { other: |scene| scene.ensemble.seed += 1, ..same })
            .mistake(
                "the closed form of rods a tenth longer",
                Beside { mean: |scene| scene.particles.aspect_ratio *= 1.1, ..same },
            )
            .check(shared),
    ]
}

type Starts = Vec<Start>;

fn rates(starts: &Starts, effort: &Effort) -> Vec<Evidence> {
    // Rods that are stretched little, so that a thousand of them resolve the distribution.
    let free = Free { scene: "a case", aspect_ratio: 1.5, sd_percent: 0.0, turns: 0.2 };
    const TRIALS: usize = 4;
    // Pilot of 100 groups at seed 99: 0.185 for the lattice; 600 at seeds 9001 to 9008: 0.19 for random starts.
    let design = Design::new(0.4, 0.22);
    let groups = effort.samples(design) as usize;
    let exponent = |start: &Start| {
        let errors = |n| free.errors(start, n, TRIALS * groups, effort.seed(0));
        let tried = [1000, 20_000].map(errors);
        Evidence::on(format!("exponent of N, {} starts", start.name), "–")
            .is(Sample::of(exponents(&tried, groups)), start.exponents[0], 0.05, design.effect)
            .because("0.05 for what is left of higher powers at 10³ rods; the controls' exponents are ½ off or more")
    };
    starts.iter().map(exponent).collect()
}

/// A function from the number of a replica to the number that is used in its place.
type Number = fn(u64) -> u64;

fn replicas(number: &Number, effort: &Effort) -> Evidence {
    const GROUP: u64 = 256;
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 10;
    scene.time.steps_per_unit = Some(20);
    // Pilot of 2,360 groups at seeds 9001 to 9010: 0.075; a tenth of room.
    let design = Design::new(0.065, 0.083);
    let x1: Vec<_> = lab::replicas(GROUP * effort.samples(design), |replica| {
        lab::x1_after(&mut lab::suspension(&scene, number(replica)), 2).unwrap_or(f64::NAN)
    });
    Evidence::on("exponent of M in the standard deviation of block means", "–")
        .is(Sample::of(blocks::replicas_exponents(&x1, GROUP as usize)), -0.5, 0.0, design.effect)
        .because("independent replicas, in groups of 256; a deviation that is √2 as large from two on makes 0.07")
}

/// α and m of the interaction whose candidates are counted: a long reach gives many.
const ALPHA_AND_M: f64 = 10.0;

/// P_c averaged over the nearest neighbour's distance among `density` rods per a³ in infinite space:
/// exp(−4πns³/3) of them have no neighbour nearer than s.
fn without_faces(density: f64) -> f64 {
    let at = |empty: f64| {
        let s = (-3.0 * empty.ln() / (4.0 * PI * density)).cbrt();
        collision_probability(s, 1.0, ALPHA_AND_M, ALPHA_AND_M)
    };
    // P_c falls to 0 with the share, so that no end is singular: the midpoint rule is accurate to about 10⁻⁸.
    let count = 10_000;
    let middles = (0..count).map(|k| (f64::from(k) + 0.5) / f64::from(count));
    middles.map(at).sum::<f64>() / f64::from(count)
}

fn faces(exponent: &f64, effort: &Effort) -> Evidence {
    const RODS: [usize; 2] = [64, 512];
    let mut scene = lab::interacting_scene(effort);
    // Steps so short that no rod moves: the rods stay at random places.
    scene.time.steps_per_unit = Some(100_000);
    let interaction = lab::interaction(&mut scene);
    (interaction.alpha, interaction.m) = (ALPHA_AND_M, ALPHA_AND_M);
    let per_mm3 = 1e-3 * scene.concentration_per_cm3().unwrap_or(f64::NAN);
    let density = per_mm3 * scene.particles.length_mm.powi(3);
    let unbounded = without_faces(density);
    // The share of lost candidates, over five draws.
    let lost = |count: usize, replica| {
        let mut scene = scene.clone();
        scene.ensemble.seed = effort.seed(count as u64);
        scene.particles.count = count;
        let mut suspension = lab::suspension(&scene, replica);
        let done = (0..5).all(|_| suspension.step().is_ok());
        let candidates = suspension.counters().candidates as f64 / (5 * count) as f64;
        if done { 1.0 - candidates / unbounded } else { f64::NAN }
    };
    // Pilot of 2,898 replicas at seeds 9001 to 9006: 0.19 where the second loss is doubled; some 0.43 where it counts
    // eight times, as the control has it.
    let design = Design::new(0.22, 0.45);
    // For losses ∝ Nᵉ the ratio is 8⁻ᵉ to 1.
    let ratio = (RODS[1] as f64 / RODS[0] as f64).powf(-exponent);
    let samples = effort.samples(design);
    let differences: Vec<_> = lab::replicas(samples, |replica| lost(RODS[0], replica) - ratio * lost(RODS[1], replica));
    Evidence::on("share of collisions lost at 64 rods, less the loss at 512 times what the exponent asks for", "–")
        .is(Sample::of(&differences), 0.0, 0.02, design.effect)
        .because(
            "63 others are a density of n(1 − 1/64), 0.011 of the candidates; edges, where two faces take the same, ∝ \
             N^(−2/3), 0.002 of them. 1/N would be off by three times the loss of 0.1",
        )
}

/// The changes of the free scene, of the scene with the other α, and of the scene whose closed form gives the mean.
#[derive(Clone, Copy)]
struct Beside {
    free: Change,
    other: Change,
    mean: Change,
}

/// Mean squares of angles between the same rod at two steps, for each replica, at T/4.
fn mean_squares(scene: &Scene, steps: u64, replicas: u64) -> Vec<f64> {
    let run = |steps: u64| {
        let mut job = Job::new(scene, steps, scene.particles.count, replicas, 1);
        job.marks = vec![steps / 4];
        job.followed = replicas;
        job.run(&|| ()).unwrap_or_default()
    };
    let (coarse, fine) = (run(steps), run(2 * steps));
    let pairs = coarse.chunks(1).zip(fine.chunks(1));
    pairs.map(|(one, other)| law::apart(one, other, 0).powi(2)).collect()
}

fn paths(change: &Change, effort: &Effort) -> Evidence {
    let scene = lab::changed(lab::interacting_scene(effort), change);
    // Pilot of 1,716 replicas at seeds 9001 to 9006: 0.0217 ± 0.0005, each 0.0229.
    let design = Design::new(0.018, 0.0255);
    let replicas = effort.samples(design);
    let (coarse, fine) = (mean_squares(&scene, 100, replicas), mean_squares(&scene, 400, replicas));
    let excess = fine.iter().zip(&coarse).map(|(fine, coarse)| fine - 0.5 * coarse);
    let what = "mean square angle between 400 and 800 steps a period, less half of that between 100 and 200";
    Evidence::on(what, "rad²").exceeds(Sample::of(excess), 0.0, design.effect).because(
        "paths that converge with order ½ or more would bring a quarter or less; the mean square is some 0.035",
    )
}

pub(super) fn first(values: Result<Vec<Vec<f64>>, String>, mark: usize) -> Vec<f64> {
    at(&values.unwrap_or_default(), mark)
}

/// One value for each pair, whose mean is the correlation r and whose scatter is that of r: r plus its influence
/// function, xy − r(x² + y²)/2 in standard units.
fn correlations(a: &[f64], b: &[f64]) -> Vec<f64> {
    let standard = |values: &[f64]| {
        let (mean, deviation) = (values.mean(), values.population_std_dev());
        values.iter().map(|x| (x - mean) / deviation).collect::<Vec<_>>()
    };
    let r = correlation(a, b);
    let pairs = standard(a).into_iter().zip(standard(b));
    pairs.map(|(x, y)| r + x * y - 0.5 * r * (x * x + y * y)).collect()
}

fn shared(beside: &Beside, effort: &Effort) -> Vec<Evidence> {
    /// X̄₁ at T/4 of the scene, and of the same scene at half the step.
    static RUNS: Shared<(), [Vec<f64>; 2]> = Shared::new();
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 25;
    let changed = |change: Change| lab::changed(scene.clone(), change);
    // Pilot of 17,106 replicas at seeds 9001 to 9006: 0.219 with a deviation of 0.89, of 1.2 where the free rods are
    // others; ρ = 0.870, whose influence has 0.59, 2.4 in artanh; it has a long tail and came out 2.8 at 2 of 35 seeds;
    // 0.0175 with 0.0076.
    let more = Design::new(0.19, 1.4);
    let common = Design::new(0.33, 3.1);
    let mean = Design::new(0.0016, 0.0085);
    let [of_more, of_common, of_mean] = [more, common, mean].map(|design| effort.samples(design));
    let runs = RUNS.get(effort, (), || {
        let run = |steps, replicas| first(interacting(&scene, steps, 1.0, 1, replicas), 0);
        [run(100, of_more.max(of_common)), run(200, of_more)]
    });
    let [own, finer] = &*runs;
    let other = first(interacting(&changed(beside.other), 100, 0.8, 1, of_common), 0);
    let free = first(free(&changed(beside.free), 1, of_more.max(of_mean)), 0);
    // A change of r changes its square by 2r times as much.
    let squares = |values: &[f64]| {
        let own = &own[..values.len()];
        let r = correlation(own, values);
        let square = move |value: f64| r * r + 2.0 * r * (value - r);
        correlations(own, values).into_iter().map(square).collect::<Vec<_>>()
    };
    let (by_free, by_finer) = (squares(&free[..of_more as usize]), squares(finer));
    let own = &own[..other.len()];
    let rho = correlation(own, &other);
    // Fisher's transform, whose scatter does not depend on ρ.
    let correlations = correlations(own, &other);
    let fisher = correlations.iter().map(|value| rho.atanh() + (value - rho) / (1.0 - rho * rho));
    vec![
        Evidence::on("share of the variance that free rods explain, less the share that half the step does", "–")
            .exceeds(Sample::of_differences(&by_free, &by_finer), 0.0, more.effect)
            .because("the better control variate; the two differ by a fifth of the variance"),
        Evidence::on("artanh of the correlation of X̄₁ between α and 0.8 α at T/4", "–")
            .exceeds(Sample::of(fisher), 0.75f64.atanh(), common.effect)
            .because("1/(1 − ρ) independent runs for each that shares: four at ρ = ¾; there is 0.87"),
        Evidence::on("X̄₁ of the free rods at T/4", "rod lengths")
            .is(Sample::of(&free), free_mean(&changed(beside.mean), 0.25), 0.0, mean.effect)
            .because("the control variate's mean is a closed form; a rod a tenth longer has 10 % less"),
    ]
}
