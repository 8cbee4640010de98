//! What a run holds in memory, counted by the allocator.

use peak_alloc::PeakAlloc;
use shearbed::run::resume::Halfway;
use shearbed::run::{self, run_replica};
use shearbed::run::{ensemble, memory};
use shearbed::scene::{Flow, Interaction, Orientation, Scene, Time};
use shearbed::{Plan, Suspension};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// The bytes held at most while something is done.
fn peak<T>(done: impl FnOnce() -> T) -> f64 {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let _ = done();
    (ALLOCATOR.peak_usage() - before) as f64
}

/// Unequal rods at few outputs, so that the rods are what is held.
fn many_rods(count: usize, concentration_per_cm3: Option<f64>) -> Plan {
    let mut scene = Scene {
        interaction: concentration_per_cm3.map(|concentration_per_cm3| Interaction {
            concentration_per_cm3: Some(concentration_per_cm3),
            ..Interaction::default()
        }),
        ..Scene::default()
    };
    scene.particles.count = count;
    scene.particles.aspect_ratio_sd_percent = 3.6;
    scene.time.duration = 0.05;
    scene.time.outputs_per_unit = Some(20);
    Plan::new(&scene).unwrap()
}

/// What is allocated in 100 steps, once the first 400 have set up the buffers.
fn allocated_in_steps(count: usize) -> usize {
    let plan = many_rods(count, Some(50.0));
    let mut suspension = Suspension::new(&plan, 0).unwrap();
    let mut steps = |count| (0..count).for_each(|_| assert!(suspension.step().is_ok()));
    steps(400);
    ALLOCATOR.reset_peak_usage();
    let before = ALLOCATOR.current_usage();
    steps(100);
    ALLOCATOR.peak_usage() - before
}

/// One test, so that no other allocates beside it.
#[test]
fn a_run_holds_what_it_says_and_its_steps_allocate_nothing() {
    let within = |room: f64| {
        move |held: f64, said: u64, what: &str| {
            let said = said as f64;
            assert!(held <= 1.02 * said && said <= room * held, "{what}: {held} bytes, said {said}");
        }
    };
    let agree = within(1.05);
    let count = 200_000;
    for (concentration_per_cm3, most_per_rod) in [
        (Some(50.0), 90.0),
        (Some(1e-3), 86.0),
        (Some(2e3), 120.0),
        // So dense that nearly every rod is on every list.
        (Some(1e6), 230.0),
        (None, 33.0),
    ] {
        let plan = many_rods(count, concentration_per_cm3);
        let held = peak(|| run_replica(&plan, 0).unwrap());
        let what = format!("{concentration_per_cm3:?} per cm3");
        assert!(held <= most_per_rod * count as f64, "{what}: {} bytes a rod", held / count as f64);
        agree(held, memory::bytes(&plan, 1), &what);
        let mut twice = plan.scene().clone();
        twice.ensemble.replicas = 2;
        let twice = Plan::new(&twice).unwrap();
        agree(2.0 * held, memory::bytes(&twice, 2), "two at a time");
    }
    // Lists grow by doubling, and the room that is stated for them is the most that they may have: where nearly every
    // rod is on every list they seldom have all of it.
    for (count, concentration_per_cm3, room) in [(160_000, 2e3, 1.05), (194_000, 1e6, 1.25)] {
        let plan = many_rods(count, Some(concentration_per_cm3));
        let held = peak(|| run_replica(&plan, 0).unwrap());
        within(room)(held, memory::bytes(&plan, 1), &format!("{count} rods"));
    }
    for (what, scene) in others() {
        let threads = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let mut said = 0;
        let held = peak(|| {
            let plan = Plan::new(&scene).unwrap();
            said = memory::bytes(&plan, 1);
            threads.install(|| ensemble::run(&plan).unwrap())
        });
        agree(held, said, what);
    }
    // Rods, rods that are wanted, and sums are what is held.
    for (count, rods_at) in [(1000, vec![]), (1000, vec![0.0, 0.025]), (2, vec![])] {
        let mut scene = many_rods(count, Some(50.0).filter(|_| count > 2)).scene().clone();
        scene.time.outputs_per_unit = Some(if count > 2 { 40 } else { 40_000 });
        scene.output.rods_at = rods_at;
        let plan = Plan::new(&scene).unwrap();
        let mut held = 0.0f64;
        run::go_on(&plan, 0, None, |state| held = held.max(peak(state))).unwrap();
        agree(held, Halfway::bytes(&plan), "what a run can be gone on from");
    }
    // Last: while the test begins, the harness's own thread allocates beside it.
    assert_eq!(allocated_in_steps(100), 0);
    assert_eq!(allocated_in_steps(2000), 0);
}

type Change = fn(&mut Scene);

/// Scenes of which something else than the rods is what is held.
fn others() -> [(&'static str, Scene); 6] {
    let rows: [(&str, Change); 6] = [
        ("sums", |scene| scene.time.outputs_per_unit = Some(50_000)),
        ("sums of replicas that wait", |scene| {
            (scene.time.outputs_per_unit, scene.ensemble.replicas) = (Some(2000), 100);
        }),
        ("every rod at many outputs", |scene| {
            (scene.time.outputs_per_unit, scene.ensemble.replicas) = (Some(100), 2);
            scene.particles.count = 1000;
            scene.output.rods_at = (0..=100).map(|k| f64::from(k) / 100.0).collect();
        }),
        ("maps", in_extension),
        ("ends", |scene| {
            in_extension(scene);
            scene.particles.orientation = Orientation::Given { phi_deg: 20.0, theta_deg: 80.0 };
        }),
        ("propagators", |scene| {
            in_extension(scene);
            scene.time.outputs_per_unit = Some(5);
            (scene.particles.count, scene.particles.aspect_ratio_sd_percent) = (20_000, 3.6);
        }),
    ];
    rows.map(|(what, change)| {
        let mut scene = Scene::default();
        scene.particles.count = 2;
        change(&mut scene);
        (what, scene)
    })
}

/// Planar extension with 50 000 outputs.
fn in_extension(scene: &mut Scene) {
    scene.flow = Flow::Gradient { gradient_per_s: [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0; 3]] };
    scene.time = Time { outputs_per_unit: Some(50_000), ..Time::strain(1.0) };
}
