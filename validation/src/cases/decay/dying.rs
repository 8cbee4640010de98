//! The decay of oscillations on all axes.

use super::*;

pub(super) fn dies_out(change: &Change, effort: &Effort) -> Vec<Evidence> {
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
    let mut evidence = vec![
        Evidence::on("1/e of the first amplitude less that at t/T = 4, n = 50 per cm³, σ = 3.6 %")
            .exceeds(Sample::of(margin), 0.0, both.effect)
            .because("\"a few\" is read as four, \"die out\" as below 1/e, where a decay has its time"),
    ];
    // The spread of r_e alone brings the amplitude below 1/e: the effect of collisions is judged against that.
    let mut free = scene(3.6);
    free.interaction = None;
    let (without, with) = (measured(&free, added), measured(&scene(3.6), added));
    evidence.push(
        Evidence::on("amplitude at t/T = 4 without collisions less that with them, n = 50 per cm³, σ = 3.6 %")
            .exceeds(Sample::of_differences(&without[3], &with[3]), 0.0, added.effect)
            .because("an order without a number"),
    );
    let uniform = measured(&scene(0.0), alone);
    for (k, which) in [(1, "0 and 1"), (2, "1 and 2"), (3, "2 and 4")] {
        let fall = Sample::of_differences(&uniform[k - 1], &uniform[k]);
        evidence.push(
            Evidence::on(format!("fall of the amplitude between t/T = {which}, n = 50 per cm³, σ = 0"))
                .exceeds(fall, 0.0, alone.effect)
                .because("an order without a number"),
        );
    }
    evidence
}

pub(super) fn damped(scene: &mut Scene) {
    lab::paper_interaction(scene);
    scene.particles.aspect_ratio_sd_percent = 3.6;
}

pub(super) fn undamped(_: &mut Scene) {}

/// The remaining share of the amplitudes after two periods: b for X̄_i or X̄_1, and a for the other. X̄_i decays less
/// than twice as fast as X̄_j if a_i > a_j².
pub(super) fn on_all_axes(axes: &Axes, effort: &Effort) -> [Evidence; 4] {
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
        let because = "\"similar\" has no number in the paper: rates within a factor of two";
        Evidence::on(format!(
            "share of the amplitude left at t/T = 2, X̄_{} less the square of that of X̄_{}",
            i + 1,
            j + 1
        ))
        .exceeds(Sample::of(difference), 0.0, design.effect)
        .because(because)
    })
}
