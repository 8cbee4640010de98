//! Free rods with rotary diffusion: their limit without it, determinism, resumed runs, defaults and refusals.

use shearbed::run::ensemble::run;
use shearbed::run::{Replica, go_on, run_replica};
use shearbed::scene::{Flow, Interaction, Scene, Time};
use shearbed::{Plan, Results};

fn scene(diffusivity: f64) -> Scene {
    let mut scene = Scene { time: Time::strain(1.0), ..Scene::default() };
    scene.particles.rotary_diffusion_per_s = diffusivity;
    scene.particles.count = 300;
    scene.ensemble.replicas = 3;
    scene.output.rods_at = vec![0.5];
    scene
}

#[test]
fn threads_and_stops_change_no_bit() {
    let mut scene = scene(0.1);
    scene.particles.count = 140_000;
    let plan = Plan::new(&scene).unwrap();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&plan)).unwrap()
    };
    let one: Results = on(1);
    assert_eq!(one, on(3));
    assert_eq!(one.counters.steps, 3 * plan.steps());
    let (mut kept, mut seen) = (None, 0);
    let whole: Replica = go_on(&plan, 1, None, |state| {
        seen += 1;
        if seen == 4 {
            kept = Some(state());
        }
    })
    .unwrap();
    assert_eq!(go_on(&plan, 1, kept, |_| ()).unwrap(), whole);
    assert_ne!(whole.sums_of_x1(), run_replica(&plan, 2).unwrap().sums_of_x1());
}

/// ⟨|p₁|⟩ at each output.
trait X1 {
    fn sums_of_x1(&self) -> Vec<f64>;
}

impl X1 for Replica {
    fn sums_of_x1(&self) -> Vec<f64> {
        (0..11).map(|output| self.mean(shearbed::observable::Channel::X[0], output).unwrap()).collect()
    }
}

/// Steps of 0.1 in strain, and of 0.02 in D_r t; and none without diffusion.
#[test]
fn steps_resolve_flow_and_diffusion() {
    let of = |diffusivity: f64| Plan::new(&scene(diffusivity)).unwrap();
    let rate = of(0.0).flow().magnitude_per_s();
    assert_eq!(of(0.0).steps(), 0);
    assert_eq!(of(1e-3 * rate).steps(), 10);
    assert_eq!(of(rate).steps(), 50);
    let mut coarse = scene(rate);
    coarse.time.steps_per_unit = Some(10);
    assert!(Plan::new(&coarse).unwrap().warnings()[0].contains("does not resolve"));
    coarse.particles.rotary_diffusion_per_s = 0.01 * rate;
    assert!(Plan::new(&coarse).unwrap().warnings().is_empty());
}

#[test]
fn rods_that_interact_and_flows_in_steps_are_refused() {
    let with = Scene { interaction: Some(Interaction::default()), ..scene(0.1) };
    let refused = Plan::new(&with).unwrap_err().to_string();
    assert!(
        refused.contains("particles.rotary_diffusion_per_s = 0.1") && refused.contains("[interaction]"),
        "{refused}"
    );
}

/// With next to no diffusion the rods move as free rods, at every output: in shear, and in a flow without a closed
/// form.
#[test]
fn rods_that_hardly_diffuse_are_free_rods() {
    for gradient_per_s in [[[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]], [[0.1, -0.3, 0.0], [0.5, 0.2, 0.1], [0.0, 0.2, -0.3]]]
    {
        let means = |diffusivity: f64| {
            let mut scene = scene(diffusivity);
            scene.flow = Flow::Gradient { gradient_per_s };
            scene.output.rods_at = Vec::new();
            scene.time = Time { outputs_per_unit: Some(10), ..Time::strain(4.0) };
            run(&Plan::new(&scene).unwrap()).unwrap()
        };
        let (free, diffusing) = (means(0.0), means(1e-30));
        for name in ["x1", "x2", "x3"] {
            let [free, diffusing] = [&free, &diffusing].map(|results| &results.column(name).unwrap().mean);
            let off = free.iter().zip(diffusing).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-12 && free.len() == 41 && diffusing.len() == 41, "{name}: {off:e}");
            let moved = free.iter().map(|x| (x - free[0]).abs()).fold(0.0, f64::max);
            assert!(moved > 0.01, "{name} {moved}");
        }
    }
}
