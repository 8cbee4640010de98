//! The start and the decay of oscillations, in the paper's words.
//!
//! The amplitude follows Fig. 7's ordinate as far as the text defines it: peak to trough of X̄₁, taken here as
//! X̄₁(t) − X̄₁(t + T/4) at t = 0, T/2, T, …, where free rods peak. Effects and deviations come from pilots at seed 99,
//! each effect three standard errors below its pilot's mean, unless a closed form is named.

use super::interpretations::LINE;
use super::*;
use std::f64::consts::E;

/// Values of a parameter, in the order in which the paper says that oscillations decay faster.
#[derive(Clone, Copy)]
struct Order {
    set: fn(&mut Scene, f64),
    values: [f64; 3],
    /// The least fall of the amplitude at t/T = 1½ from one value to the next, and its scatter.
    design: Design,
}

/// The scenes for X̄_1, and for X̄_2 and X̄_3: equal, except in a control.
type Axes = [Change; 2];

pub fn cases() -> Vec<Case> {
    // The closed form falls by 0.105 and 0.150; a pilot of 4,000 replicas scattered by 0.013 and 0.017.
    let spread = Order {
        set: |scene, sd| scene.particles.aspect_ratio_sd_percent = sd,
        values: [1.8, 3.6, 7.2],
        design: Design::new(0.1, 0.02),
    };
    // A pilot of 300 replicas: 0.087 ± 0.028 and 0.109 ± 0.038 (mean and deviation).
    let concentration = Order {
        set: |scene, n| lab::paper_interaction(scene).concentration_per_cm3 = Some(n),
        values: [10.0, 50.0, 250.0],
        design: Design::new(0.08, 0.043),
    };
    // A pilot of 300 replicas: 0.103 ± 0.029 and 0.142 ± 0.040 (mean and deviation).
    let length = Order {
        set: |scene, length_mm| {
            lab::paper_interaction(scene);
            scene.particles.length_mm = length_mm;
        },
        values: [0.36, 0.72, 1.44],
        design: Design::new(0.095, 0.045),
    };
    vec![
        Case::of(Judges::Statement, "free-amplitude")
            .claim(
                "\"The amplitude of oscillations is approximately half the particle length and is constant\" for free \
                 uniform rods.",
            )
            .source("eq. 4; Results, before Fig. 6; Fig. 6 (top)")
            .under_test((|_| {}) as Change)
            .mistake("nearly round: r_e = 3", |scene| scene.particles.aspect_ratio = 3.0)
            .mistake("unequal aspect ratios", |scene| scene.particles.aspect_ratio_sd_percent = 7.2)
            .mistake("rods in collision", |scene| lab::paper_interaction(scene).concentration_per_cm3 = Some(100.0))
            .check(free_amplitude),
        Case::of(Judges::Statement, "faster-with-spread")
            .claim("\"The oscillations decay faster … as the differences in the aspect ratios become larger\".")
            .source("eq. 4; Results, before Fig. 7; Fig. 9")
            .under_test(spread)
            .mistake(
                "σ shifts all rods alike",
                Order {
                    set: |scene, factor| scene.particles.aspect_ratio *= factor,
                    values: [1.018, 1.036, 1.072],
                    ..spread
                },
            )
            .check(faster),
        Case::of(Judges::Statement, "faster-with-concentration")
            .claim(
                "\"The oscillations decay faster as the concentration (and consequently the number of collisions) \
                 increases\".",
            )
            .source("eq. 4; Results, before Fig. 7; Fig. 7")
            .under_test(concentration)
            .mistake(
                "a volume with the side (N n)^⅓ in place of (N/n)^⅓, right at 50 per cm³",
                Order { values: [250.0, 50.0, 10.0], ..concentration },
            )
            .check(faster),
        Case::of(Judges::Statement, "faster-with-length")
            .claim("\"The oscillations decay faster … as the particles become longer\" at fixed r_e.")
            .source("eq. 4; Results, before Fig. 7; Fig. 8")
            .under_test(length)
            .mistake(
                "rods per a³ taken as n/a³ in place of n a³, right at 0.72 mm",
                Order { set: concentration.set, values: [400.0, 50.0, 6.25], ..length },
            )
            .check(faster),
        Case::of(Judges::Statement, "faster-with-collisions")
            .claim(
                "\"The amplitude decays much faster when collisions occur than in the absence of particle-particle \
                 interactions\".",
            )
            .source("eq. 4; Results, after Fig. 10; Figs 6 and 10")
            .under_test((|scene| _ = lab::paper_interaction(scene)) as Change)
            .mistake("α a tenth", |scene| lab::paper_interaction(scene).alpha *= 0.1)
            .check(collisions_damp),
        Case::of(Judges::Statement, "dies-out")
            .claim(
                "\"The oscillations die out … after a few rotations, in contrast to the undamped oscillations\": with \
                 collisions and σ = 3.6 % to less than 1/e in four rotations, where less is left than with σ = 3.6 % \
                 alone; with collisions alone they are smaller after one, two and four rotations each time.",
            )
            .source("eqs 4, 16; Results, after Fig. 6")
            .under_test((|_| {}) as Change)
            .mistake("collisions without effect", |scene| lab::interaction(scene).alpha = 0.0)
            .mistake("rods of one aspect ratio", |scene| scene.particles.aspect_ratio_sd_percent = 0.0)
            .check(dies_out),
        Case::of(Judges::Statement, "other-axes-decay")
            .claim(
                "\"The amplitudes of X̄_2 and X̄_3 decay in similar manner\" as that of X̄_1: at rates that differ by \
                 less than a factor of two.",
            )
            .source("eqs 4, 16; Results, after Fig. 10")
            .under_test([damped as Change; 2] as Axes)
            .mistake("X̄_2 and X̄_3 not damped", [damped, undamped])
            .mistake("X̄_1 not damped", [undamped, damped])
            .check(on_all_axes),
    ]
}

/// |X̄_i(kT/2) − X̄_i(kT/2 + T/4)|, with a sign that is positive for free rods; for four outputs per period.
fn swing(mean: &dyn Fn(Channel, usize) -> f64, half_periods: usize, axis: usize) -> f64 {
    let fall = mean(Channel::X[axis], 2 * half_periods) - mean(Channel::X[axis], 2 * half_periods + 1);
    if axis == 1 { -fall } else { fall }
}

/// The amplitudes of X̄₁ at t = kT/2, for each replica.
fn amplitudes(scene: &Scene, replicas: u64, half_periods: &[usize]) -> Vec<Vec<f64>> {
    let last = half_periods.iter().max().copied().unwrap_or(0);
    let swings = per_replica(&quarters(scene.clone(), last), replicas, |mean| {
        half_periods.iter().map(|&k| swing(mean, k, 0)).collect::<Vec<_>>()
    });
    (0..half_periods.len()).map(|k| swings.iter().map(|swings| swings[k]).collect()).collect()
}

/// The scene up to the quarter period after t = kT/2, with outputs at quarter periods.
fn quarters(mut scene: Scene, half_periods: usize) -> Scene {
    scene.time = Time { outputs_per_unit: Some(4), ..Time::periods((2 * half_periods + 1) as f64 / 4.0) };
    scene
}

fn free_amplitude(change: &Change, effort: &Effort) -> Vec<Evidence> {
    let scene = lab::changed(lab::free_scene(effort), change);
    // A pilot of 2,000 replicas scattered by 0.031, and by 0.042 with r_e = 3.
    let design = Design::new(0.09, 0.045);
    let amplitudes = amplitudes(&scene, effort.samples(design), &[0, 8]);
    let half = "\"approximately half\": 0.5 to one digit; r_e = 3 has 0.35 by the closed form";
    let changes = amplitudes[1].iter().zip(&amplitudes[0]).map(|(late, first)| (late - first).abs());
    vec![
        Evidence::on("amplitude at t = 0", "rod lengths")
            .is(Sample::of(&amplitudes[0]), 0.5, 0.05, design.effect)
            .because(half),
        Evidence::on("its largest change by t/T = 4", "rod lengths")
            .within(worst(changes), 1e-12)
            .because("constant: the same phases come back to round-off, in each replica"),
    ]
}

fn faster(order: &Order, effort: &Effort) -> [Evidence; 2] {
    let replicas = effort.samples(order.design);
    let amplitudes = order.values.map(|value| {
        let scene = lab::changed(lab::free_scene(effort), |scene| (order.set)(scene, value));
        self::amplitudes(&scene, replicas, &[3]).remove(0)
    });

    [(0, 1, "first less second"), (1, 2, "second less third")].map(|(a, b, which)| {
        let fall = Sample::of_differences(&amplitudes[a], &amplitudes[b]);
        Evidence::on(format!("fall of the amplitude at t/T = 1½, {which}"), "rod lengths")
            .exceeds(fall, 0.0, order.design.effect)
            .because("an order without a number; the same seeds in all three")
    })
}

fn collisions_damp(change: &Change, effort: &Effort) -> [[Evidence; 2]; 2] {
    // Pilots of 300 replicas at t/T = 1 and 2: 0.112 ± 0.025 and 0.178 ± 0.030 for σ = 0 (mean and deviation), 0.054 ±
    // 0.022 and 0.051 ± 0.026 for σ = 3.6 %.
    [(0.0, Design::new(0.09, 0.035)), (3.6, Design::new(0.036, 0.029))].map(|(sd, design)| {
        let mut free = lab::free_scene(effort);
        free.particles.aspect_ratio_sd_percent = sd;
        let interacting = lab::changed(free.clone(), change);
        let replicas = effort.samples(design);
        let without = amplitudes(&free, replicas, &[2, 4]);
        let with = amplitudes(&interacting, replicas, &[2, 4]);
        [(0, "1"), (1, "2")].map(|(k, when)| {
            let fall = Sample::of_differences(&without[k], &with[k]);
            let because = "\"much\" has no number in the paper: two curves as far apart as twice the width of a line";
            Evidence::on(format!("amplitude without less with collisions at t/T = {when}, σ = {sd} %"), "rod lengths")
                .exceeds(fall, 2.0 * LINE, design.effect)
                .because(because)
        })
    })
}

fn dies_out(change: &Change, effort: &Effort) -> Vec<Evidence> {
    let scene = |sd| {
        let mut scene = lab::paper_scene(effort);
        scene.particles.aspect_ratio_sd_percent = sd;
        change(&mut scene);
        scene
    };
    let measured = |scene: &Scene, design| amplitudes(scene, effort.samples(design), &[0, 2, 4, 8]);
    // Pilots of 300 replicas: 0.136 ± 0.035 (mean and deviation); 0.017 ± 0.033; 0.107 ± 0.024, 0.066 ± 0.023 and 0.080
    // ± 0.028.
    let (both, added, alone) = (Design::new(0.13, 0.042), Design::new(0.013, 0.036), Design::new(0.06, 0.032));
    let spread = measured(&scene(3.6), both);
    let margin = spread[0].iter().zip(&spread[3]).map(|(first, last)| first / E - last);
    // The spread of r_e alone brings the amplitude below 1/e: the effect of collisions is judged against that.
    let free = Scene { interaction: None, ..scene(3.6) };
    let (without, with) = (measured(&free, added), measured(&scene(3.6), added));
    let uniform = measured(&scene(0.0), alone);
    let falls = [(1, "0 and 1"), (2, "1 and 2"), (3, "2 and 4")].map(|(k, which)| {
        let fall = Sample::of_differences(&uniform[k - 1], &uniform[k]);
        Evidence::on(format!("fall of the amplitude between t/T = {which}, n = 50 per cm³, σ = 0"), "rod lengths")
            .exceeds(fall, 0.0, alone.effect)
            .because("an order without a number")
    });
    let of_spread = [
        Evidence::on("1/e of the first amplitude less that at t/T = 4, n = 50 per cm³, σ = 3.6 %", "rod lengths")
            .exceeds(Sample::of(margin), 0.0, both.effect)
            .because("\"a few\" is read as four, \"die out\" as below 1/e, where a decay has its time"),
        Evidence::on(
            "amplitude at t/T = 4 without collisions less that with them, n = 50 per cm³, σ = 3.6 %",
            "rod lengths",
        )
        .exceeds(Sample::of_differences(&without[3], &with[3]), 0.0, added.effect)
        .because("an order without a number"),
    ];
    of_spread.into_iter().chain(falls).collect()
}

fn damped(scene: &mut Scene) {
    lab::paper_interaction(scene);
    scene.particles.aspect_ratio_sd_percent = 3.6;
}

fn undamped(_: &mut Scene) {}

/// The remaining share of the amplitudes after two periods: b for X̄_i or X̄_1, and a for the other. X̄_i decays less
/// than twice as fast as X̄_j if a_i > a_j².
fn on_all_axes(axes: &Axes, effort: &Effort) -> [Evidence; 4] {
    // A pilot of 200 replicas: a − b² of 0.127 ± 0.039 (mean and deviation), 0.213 ± 0.055, 0.284 ± 0.046, 0.234 ±
    // 0.051.
    let narrow = Design::new(0.11, 0.046);
    let wide = Design::new(0.2, 0.065);
    let replicas = effort.samples(narrow).max(effort.samples(wide));
    let swings = |change: Change| {
        let scene = lab::changed(lab::free_scene(effort), change);
        per_replica(&quarters(scene, 4), replicas, |mean| {
            [0, 1, 2].map(|axis| [swing(mean, 0, axis), swing(mean, 4, axis)])
        })
    };
    let [first, others] = axes.map(swings);
    // The ratio of the means, plus each replica's deviation to first order: a replica's own ratio is noisy and
    // therefore biased.
    let left = [0, 1, 2].map(|axis| {
        let swings = if axis == 0 { &first } else { &others };
        let mean = |k: usize| swings.iter().map(|s| s[axis][k]).sum::<f64>() / swings.len() as f64;
        let (start, share) = (mean(0), mean(1) / mean(0));
        let value = |s: &[[f64; 2]; 3]| share + (s[axis][1] - share * s[axis][0]) / start;
        swings.iter().map(value).collect::<Vec<_>>()
    });
    [(1, 0, narrow), (2, 0, wide), (0, 1, wide), (0, 2, wide)].map(|(i, j, design)| {
        let mean = Sample::of(&left[j]).mean;
        // a − b² to first order in each replica's deviation, so that its mean is a − b² of the means.
        let difference = left[i].iter().zip(&left[j]).map(|(a, b)| a - 2.0 * mean * b + mean * mean);
        let what =
            format!("share of the amplitude left at t/T = 2, X̄_{} less the square of that of X̄_{}", i + 1, j + 1);
        Evidence::on(what, "–")
            .exceeds(Sample::of(difference), 0.0, design.effect)
            .because("\"similar\" has no number in the paper: rates within a factor of two")
    })
}
