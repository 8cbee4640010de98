//! What a run holds in memory, counted by the allocator.

use peak_alloc::PeakAlloc;
use shearbed::run::run_replica;
use shearbed::{Plan, Suspension, memory, scene_file};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn plan(count: usize, tables: &str) -> Plan {
    let text = format!(
        r#"
title = "many rods"
[flow]
shear_rate_per_s = 0.5
[particles]
count = {count}
length_mm = 0.72
aspect_ratio = 11.6
aspect_ratio_sd_percent = 3.6
orientation = "isotropic"
[time]
periods = 0.05
outputs_per_period = 20
{tables}
"#
    );
    Plan::new(&scene_file::parse("scene.toml", &text).unwrap()).unwrap()
}

/// Bytes held at most while one replica runs.
fn peak(plan: &Plan) -> f64 {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    run_replica(plan, 0).unwrap();
    (ALLOCATOR.peak_usage() - before) as f64
}

/// What is allocated in 100 steps, once the first 400 have set up the buffers.
fn allocated_in_steps(count: usize) -> usize {
    let plan = plan(count, &interaction(50.0));
    let mut suspension = Suspension::new(&plan, 0).unwrap();
    let mut steps = |count| (0..count).for_each(|_| assert!(suspension.step().is_ok()));
    steps(400);
    ALLOCATOR.reset_peak_usage();
    let before = ALLOCATOR.current_usage();
    steps(100);
    ALLOCATOR.peak_usage() - before
}

fn interaction(concentration_per_cm3: f64) -> String {
    format!("[interaction]\nconcentration_per_cm3 = {concentration_per_cm3}\nalpha = 0.5")
}

/// One test, so that no other allocates beside it.
#[test]
fn a_run_holds_what_it_says_and_its_steps_allocate_nothing() {
    assert_eq!(allocated_in_steps(100), 0);
    assert_eq!(allocated_in_steps(2000), 0);
    let count = 200_000;
    for (tables, most_per_rod) in [
        (interaction(50.0), 120.0),
        (interaction(1e-3), 120.0),
        // So dense that nearly every rod is on every list.
        (interaction(1e6), 270.0),
        (String::new(), 33.0),
    ] {
        let plan = plan(count, &tables);
        let (held, said) = (peak(&plan), memory::bytes(&plan, 1) as f64);
        assert!(
            held <= most_per_rod * count as f64,
            "{} bytes a rod: {tables}",
            held / count as f64
        );
        assert!(
            held <= 1.02 * said && said <= 1.25 * held,
            "{held} bytes, said {said}: {tables}"
        );
    }
}
