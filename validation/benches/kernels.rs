//! Throughput of the core's kernels, of whole steps beside the naive reference, and of whole scenes: `cargo bench -p
//! shearbed-benches`.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{UnitVector3, Vector3};
use shearbed::model::collision::{share_velocity, step_angles, turn};
use shearbed::model::contact::contact;
use shearbed::model::orientation::from_angles;
use shearbed::model::phase::Phase;
use shearbed::motion::couette;
use shearbed::run::ensemble;
use shearbed::run::run_replica;
use shearbed_validation::input::scenes;
use shearbed_validation::judge::lab;
use shearbed_validation::oracle::naive::{Naive, NaiveProblem};
use std::hint::black_box;

/// One exact step of a rod, and the phase it takes where aspect ratios differ.
fn motion(c: &mut Criterion) {
    let mut group = c.benchmark_group("motion");
    group.throughput(Throughput::Elements(1));
    let phase = Phase::of_turns(0.37);
    group.bench_function("couette", |b| b.iter(|| couette(black_box([0.6, 0.48, 0.64]), 11.6, phase)));
    group.bench_function("phase", |b| b.iter(|| Phase::of_turns(black_box(17.37))));
    group.finish();
}

/// Free rods straight to their outputs: per rod and output.
fn free(c: &mut Criterion) {
    let mut group = c.benchmark_group("free rods, per rod and output");
    for sd in [0.0, 3.6] {
        let mut scene = lab::free_scene(&shearbed_validation::judge::case::Effort::gate());
        scene.particles.count = 10_000;
        scene.particles.aspect_ratio_sd_percent = sd;
        let plan = lab::plan(&scene);
        group.throughput(Throughput::Elements(10_000 * plan.outputs() as u64));
        group.bench_function(format!("sd {sd} %"), |b| b.iter(|| ensemble::run(&plan)));
    }
    group.finish();
}

/// What one collision takes.
fn collision(c: &mut Criterion) {
    let mut group = c.benchmark_group("a collision");
    group.throughput(Throughput::Elements(1));
    let p = [(0.3, 1.1), (2.0, 0.7)].map(|(phi, theta)| from_angles(phi, theta));
    let separation = Vector3::new(0.4, -0.3, 0.2);
    for (name, update) in [("rotation", turn as Turn), ("angles", step_angles)] {
        group.bench_function(name, |b| {
            b.iter(|| {
                let [a, b] = black_box(p);
                let contact = contact(&separation, &a, &b, [0.0; 2])?;
                let rates = share_velocity(
                    &contact,
                    &Vector3::new(0.0, separation.x, 0.0),
                    [Vector3::new(-0.1, 0.4, 0.2), Vector3::new(0.3, 0.1, -0.2)],
                );
                Some([update(&a, &rates[0], 0.37), update(&b, &rates[1], 0.37)])
            })
        });
    }
    group.finish();
}

type Turn = fn(&UnitVector3<f64>, &Vector3<f64>, f64) -> (UnitVector3<f64>, f64);

/// One step of interacting rods at Fig. 4's density, core and naive: per rod.
fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("step, per rod");
    for count in [100, 10_000, 1_000_000] {
        let mut scene = lab::interacting_scene(&shearbed_validation::judge::case::Effort::gate());
        scene.particles.count = count;
        let mut suspension = lab::suspension(&scene, 0);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(format!("core, {count} rods"), |b| b.iter(|| suspension.step().map(<[_]>::len)));
    }
    group.throughput(Throughput::Elements(100));
    group.bench_function("naive, 100 rods", |b| {
        let mut naive = Naive::new(NaiveProblem::paper(1, 0));
        b.iter(|| naive.step());
    });
    group.finish();
}

/// One replica of built-in scenes: per rod and step, or rod and output where no steps are taken.
fn whole_scenes(c: &mut Criterion) {
    let mut group = c.benchmark_group("one replica");
    for name in ["fig4-n50", "fig7-n50", "fig6-uniform", "fig6-polydisperse"] {
        let scene = scenes::find(name).and_then(|scene| scene.scene().ok());
        let plan = lab::plan(&scene.expect("a built-in scene"));
        let times = plan.steps().max(plan.outputs() as u64);
        group.throughput(Throughput::Elements(times * plan.scene().particles.count as u64));
        group.bench_function(name, |b| b.iter(|| run_replica(&plan, 0)));
    }
    group.finish();
}

criterion_group!(benches, motion, free, collision, steps, whole_scenes);
criterion_main!(benches);
