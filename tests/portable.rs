//! The same scene and seed give the same bits on every machine: no function that rounds as it likes is used, and what
//! runs give is what is written down here.

use shearbed::run::ensemble;
use shearbed::scene;
use shearbed::{Plan, Results};

/// Name, digest of the means, flow, rods, and the other tables.
type Row = (&'static str, u64, &'static str, &'static str, &'static str);

/// Scenes that use every function of `libm` that the core does, and the digest of their means: the same on every
/// machine, so one that differs is a mistake of that machine's build, or a change of the model that has to be said.
#[rustfmt::skip]
const SCENES: [Row; 8] = [
    ("kicks", 0x1ae6_99bd_1c37_a312, SHEAR, UNEQUAL, "interaction = { concentration_per_cm3 = 50, alpha = 0.5 }
        output = { observables = ['projections', 'mean_angle', 'orbit_constant', 'orientation_tensor_4'] }"),
    ("collisions", 0x125f_da1f_a124_4adc, SHEAR, UNEQUAL,
     "interaction = { concentration_per_cm3 = 50, alpha = 0.5, update = 'rotation' }
        output = { observables = ['projections', 'mean_angle', 'orbit_constant', 'orientation_tensor_4'] }"),
    ("angles", 0x3e8a_a383_9ab0_c1ff, SHEAR,
     "count = 100, length_mm = 0.72, physical_aspect_ratio = 20, shape_correlation = 'cox', orientation = { \
        phi_deg = 10, theta_deg = 80 }",
     "interaction = { concentration_per_cm3 = 50, alpha = 0.5, m = 2.5, update = 'angles' }
        output = { observables = ['particle_stress'] }"),
    ("many", 0xff9d_cc2c_154a_4064, "shear_rate_per_s = 2",
     "count = 3000, length_mm = 0.72, physical_aspect_ratio = 20, shape_correlation = 'harris-pittman'",
     "interaction = { concentration_per_cm3 = 500, alpha = 0.5, update = 'rotation' }
        time = { periods = 0.1, outputs_per_period = 50 }"),
    // Some twenty of the rods are drawn from the tail of the Gaussian.
    ("unequal", 0xf74a_64b4_9f1f_e7c1, "shear_rate_per_s = 1",
     "count = 70000, length_mm = 1, aspect_ratio = 5, aspect_ratio_sd_percent = 7.2",
     "time = { periods = 1, outputs_per_period = 4 }"),
    ("turning", 0x8409_5374_c301_2bad, "gradient_per_s = [[0.1, -1, 0.3], [2, -0.3, 0], [0.2, 0, 0.2]]",
     "count = 300, length_mm = 1, aspect_ratio = 3, aspect_ratio_sd_percent = 10", "time = { strain = 20 }"),
    ("growing", 0x512f_f4de_ca3a_c9f1, GROWING,
     "count = 300, length_mm = 1, aspect_ratio = 30, aspect_ratio_sd_percent = 10", "time = { strain = 20 }"),
    ("a short time", 0xbd7c_a8ee_8f82_0b1a, GROWING, "count = 10, length_mm = 1, aspect_ratio = 30",
     "time = { strain = 0.3 }"),
];

const SHEAR: &str = "shear_rate_per_s = 0.5";
const GROWING: &str = "gradient_per_s = [[1, 0.5, 0], [0.2, -0.7, 0.1], [0, 0, -0.3]]";
const UNEQUAL: &str = "count = 100, length_mm = 0.72, aspect_ratio = 11.6, aspect_ratio_sd_percent = 3.6";

/// FNV-1a of every mean, bit by bit.
fn digest(results: &Results) -> u64 {
    let columns = results.series.iter().flat_map(|series| &series.columns);
    let values = columns.flat_map(|column| &column.mean);
    let bytes = values.flat_map(|value| value.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// Directions are isotropic, and ten replicas run for a period, unless a scene says otherwise.
fn run((name, _, flow, rods, tables): Row) -> Results {
    let start = if rods.contains("orientation") { "" } else { ", orientation = 'isotropic'" };
    let time = if tables.contains("time") {
        ""
    } else {
        "time = { periods = 1, outputs_per_period = 10 }\nensemble = { replicas = 10 }"
    };
    let text = format!("title = '{name}'\nflow = {{ {flow} }}\nparticles = {{ {rods}{start} }}\n{tables}\n{time}");
    ensemble::run(&Plan::new(&scene::parse(name, &text).unwrap()).unwrap()).unwrap()
}

#[test]
fn results_have_the_bits_that_are_written_down() {
    let digests = SCENES.map(|row| (row.0, row.1, digest(&run(row))));
    for (name, expected, found) in digests {
        assert_eq!(found, expected, "{name}: {found:#018x}; of all {digests:#x?}");
    }
}

#[test]
fn one_bit_of_one_result_changes_the_digest() {
    let mut results = run(SCENES[6]);
    let before = digest(&results);
    let value = &mut results.series[0].columns[2].mean[1];
    *value = f64::from_bits(value.to_bits() ^ 1);
    assert_ne!(digest(&results), before);
}

/// glibc chooses its sines and exponentials by the processor: here it is given one without fused operations.
#[test]
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
fn another_choice_of_the_system_s_functions_changes_no_bit() {
    // The control: the system's own functions do change, or this machine can show nothing.
    let own = format!("sum of the system's sines: {:#x}", system_sines());
    let theirs = in_child("the_system_s_functions_have_a_sum");
    assert!(theirs.status.success());
    if String::from_utf8_lossy(&theirs.stdout).contains(&own) {
        println!("not tested: glibc has one choice on this machine");
        return;
    }
    let ended = in_child("results_have_the_bits_that_are_written_down");
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stdout));
}

/// The output of a test of this program in a process of its own, which is killed after ten minutes.
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
fn in_child(test: &str) -> std::process::Output {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--nocapture"])
        .env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-AVX512F")
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let end = Instant::now() + Duration::from_secs(600);
    while child.try_wait().unwrap().is_none() {
        if Instant::now() > end {
            child.kill().unwrap();
            panic!("{test} has not ended after ten minutes");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    child.wait_with_output().unwrap()
}

#[test]
fn the_system_s_functions_have_a_sum() {
    println!("sum of the system's sines: {:#x}", system_sines());
}

/// A sum of bits, which one other last bit changes.
fn system_sines() -> u64 {
    let points = (1..100_000).map(|k| f64::from(k) * 1e-4);
    points.fold(0, |sum: u64, x| sum.wrapping_mul(31).wrapping_add((x.sin() + x.exp()).to_bits()))
}

/// Functions that round as the platform likes are clippy's to refuse (clippy.toml); here it is seen to.
#[test]
#[expect(clippy::disallowed_methods, reason = "clippy must know the functions of clippy.toml")]
fn clippy_finds_what_rounds_as_the_platform_likes() {
    assert!((1e-3_f64.sin() - libm::sin(1e-3)).abs() < 1e-18);
}
