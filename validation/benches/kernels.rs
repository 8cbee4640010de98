//! Throughput of the core's kernels and of whole steps, beside the naive reference: `cargo bench`.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use shearbed::ensemble;
use shearbed::propagator::{Phase, couette};
use std::hint::black_box;
use validation::cases::lab;
use validation::oracle::naive::Naive;
use validation::readings::paper;

/// One exact step of a rod, and the phase it takes where aspect ratios differ.
fn motion(c: &mut Criterion) {
    let mut group = c.benchmark_group("motion");
    group.throughput(Throughput::Elements(1));
    let phase = Phase::of_turns(0.37);
    group.bench_function("couette", |b| {
        b.iter(|| couette(black_box([0.6, 0.48, 0.64]), 11.6, phase))
    });
    group.bench_function("phase", |b| b.iter(|| Phase::of_turns(black_box(17.37))));
    group.finish();
}

/// Free rods straight to their outputs: per rod and output.
fn free(c: &mut Criterion) {
    let mut group = c.benchmark_group("free rods, per rod and output");
    for sd in [0.0, 3.6] {
        let mut scene = lab::free_scene();
        scene.particles.count = 10_000;
        scene.particles.aspect_ratio_sd_percent = sd;
        let plan = lab::plan(&scene);
        group.throughput(Throughput::Elements(10_000 * plan.outputs() as u64));
        group.bench_function(format!("sd {sd} %"), |b| b.iter(|| ensemble::run(&plan, || ())));
    }
    group.finish();
}

/// One step of interacting rods at Fig. 4's density, core and naive: per rod.
fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("step, per rod");
    for count in [100, 10_000] {
        let mut scene = lab::interacting_scene();
        scene.particles.count = count;
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(format!("core, {count} rods"), |b| {
            let start = lab::suspension(&scene, 0);
            b.iter_batched_ref(
                || start.clone(),
                |s| s.step().map(<[_]>::len),
                BatchSize::LargeInput,
            );
        });
    }
    group.throughput(Throughput::Elements(100));
    group.bench_function("naive, 100 rods", |b| {
        let mut naive = Naive::new(paper(0));
        b.iter(|| naive.step());
    });
    group.finish();
}

criterion_group!(benches, motion, free, steps);
criterion_main!(benches);
