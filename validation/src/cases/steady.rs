//! The steady state of interacting rods (Fig. 11).

use super::*;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Statement, "steady-mean-angle")
            .claim("The steady mean angle of interacting rods agrees closely with ⟨φ⟩ of a single rod.")
            .source("eqs 18, 19; Fig. 11")
            .under_test((|_| {}) as Change)
            .mistake("r_e 20 % longer", |scene| scene.particles.aspect_ratio *= 1.2)
            .check(steady_angle),
    ]
}

/// φ̄ over the last two of six periods, for each replica. The suspension is ten times denser than Fig. 4's, so
/// that four periods reach the steady state; the steady value does not depend on n as long as rods are mostly free.
fn steady_angle(change: &Change, effort: &Effort) -> [Evidence; 3] {
    // ⟨φ⟩ of the control is off by 0.037 for r_e = 5 (eq. 19). A pilot of 40 replicas of 100 rods scattered by 0.0018
    // there.
    let design = Design::new(0.02, 0.003);
    [5.0, 11.6, 30.0].map(|r| {
        let mut scene = lab::crowded_scene(effort, 50, 500.0);
        scene.particles.aspect_ratio = r;
        (scene.time.duration, scene.time.outputs_per_unit) = (6.0, Some(50));
        scene.output.observables = vec![Observable::MeanAngle];
        change(&mut scene);
        let outputs = 6 * 50;
        let means = lab::per_replica(&scene, effort.samples(design), |mean| {
            (outputs - 100..outputs).map(|output| mean(Channel::PHI, output)).sum::<f64>() / 100.0
        });
        let because = "\"agree closely\": 0.01 rad, the width of a line on an axis from 0 to π/2; collisions bias the \
                       phase a little";
        Evidence::on(format!("steady φ̄, r_e = {r}"), "rad")
            .is(Sample::of(&means), closed_form::mean_angle(r), 0.01, design.effect)
            .because(because)
    })
}
