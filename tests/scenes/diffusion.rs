//! Free rods with rotary diffusion: their limit without it, and default steps.

use crate::{planned, run};
use shearbed::Observable;
use shearbed::scene::{Flow, Orientation, Scene, Time};

pub(crate) fn scene(diffusivity: f64) -> Scene {
    let mut scene = Scene { time: Time::strain(1.0), ..Scene::default() };
    scene.particles.rotary_diffusion_per_s = diffusivity;
    scene.particles.count = 300;
    scene.ensemble.replicas = 3;
    scene.output.rods_at = vec![0.5];
    scene
}

/// From one start of all rods only the diffusion differs between replicas.
#[test]
fn replicas_diffuse_apart() {
    let mut scene = scene(0.1);
    scene.particles.orientation = Orientation::Given { phi_deg: 30.0, theta_deg: 60.0 };
    let rods = run(&scene).snapshots;
    assert!(rods.len() == 3 && rods[0].p != rods[1].p && rods[1].p != rods[2].p);
}

/// Steps of 0.1 in strain, and of 0.02 in D_r t; and none without diffusion.
#[test]
fn steps_resolve_flow_and_diffusion() {
    let of = |diffusivity: f64| planned(&scene(diffusivity));
    let rate = of(0.0).flow().magnitude_per_s();
    assert_eq!(of(0.0).steps(), 0);
    assert_eq!(of(1e-3 * rate).steps(), 10);
    assert_eq!((of(rate).steps(), run(&scene(rate)).counters.steps), (50, 3 * 50));
    let mut coarse = scene(rate);
    coarse.time.steps_per_unit = Some(10);
    assert!(planned(&coarse).warnings()[0].contains("does not resolve"));
    coarse.particles.rotary_diffusion_per_s = 0.01 * rate;
    assert!(planned(&coarse).warnings().is_empty());
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
            run(&scene)
        };
        let (free, diffusing) = (means(0.0), means(1e-30));
        for name in ["x1", "x2", "x3"] {
            let [free, diffusing] = [&free, &diffusing].map(|results| &results.column(name).unwrap().mean);
            let off = shearbed_oracle::apart(free, diffusing);
            assert!(off < 1e-12 && free.len() == 41 && diffusing.len() == 41, "{name}: {off:e}");
            let moved = shearbed_oracle::worst(free.iter().map(|x| (x - free[0]).abs()));
            assert!(moved > 0.01, "{name} {moved}");
        }
    }
}

/// In a liquid at rest a_33 of rods that start along axis 3 relaxes as 1/3 + 2/3 e^(−6 D_r t).
#[test]
fn rods_at_rest_relax() {
    let mut scene = scene(0.05);
    scene.flow = Flow::Gradient { gradient_per_s: [[0.0; 3]; 3] };
    scene.time = Time { outputs_per_unit: Some(1), ..Time::seconds(4.0) };
    scene.particles.orientation = Orientation::Given { phi_deg: 0.0, theta_deg: 0.0 };
    scene.ensemble.replicas = 30;
    scene.output.rods_at = Vec::new();
    scene.output.observables = vec![Observable::OrientationTensor];
    let results = run(&scene);
    let a33 = results.column("a33").unwrap();
    for (time_s, (mean, se)) in a33.mean.iter().zip(&a33.se).enumerate() {
        let due = (1.0 + 2.0 * (-0.3 * time_s as f64).exp()) / 3.0;
        assert!((mean - due).abs() <= 5.0 * se + 1e-15 && *se < 0.01, "{time_s} s: {mean} ± {se}, {due} is due");
    }
}
