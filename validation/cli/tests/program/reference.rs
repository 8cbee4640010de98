//! `shearbed reference` as a user meets it.

use crate::common::bounded::Bounded;
use std::process::Command;

/// Exit code, standard output and standard error.
fn reference(arguments: &str) -> (Option<i32>, String, String) {
    let output =
        Command::new(env!("CARGO_BIN_EXE_shearbed")).arg("reference").args(arguments.split_whitespace()).ended();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

fn rows(arguments: &str) -> Vec<Vec<String>> {
    let (code, out, error) = reference(arguments);
    assert_eq!(code, Some(0), "{arguments}: {error}");
    let fields = |line: &str| line.split(',').map(str::to_owned).collect();
    out.lines().map(fields).collect()
}

#[test]
fn columns_and_known_values() {
    let rod = rows("--aspect-ratio 2 --start 0,90 --times 0:0.5:3 --shear-rate-per-s 0.5");
    let header = "time_s,t_over_T,strain,p1,p2,p3,phi_rad,theta_rad,c_b";
    assert_eq!(rod[0].join(","), header);
    let half_pi = std::f64::consts::FRAC_PI_2.to_string();
    assert_eq!(rod[1].join(","), format!("0.0,0.0,0.0,1.0,0.0,0.0,0.0,{half_pi},1.0"));
    // A quarter of T = 2π·2.5/0.5.
    assert_eq!(rod[2][0], (2.5 * std::f64::consts::PI).to_string());
    assert_eq!(rod[2][3..], ["0.0", "1.0", "0.0", &half_pi, &half_pi, "1.0"].map(String::from));
    let isotropic = rows("--aspect-ratio 3 --times 0:0:1");
    let header = "time_s,t_over_T,strain,x1,x2,x3,a11,a22,a33,a12,a13,a23";
    assert_eq!(isotropic[0].join(","), header);
    let third = (1.0f64 / 3.0).to_string();
    let halves = ["0.5"; 3];
    assert_eq!(isotropic[1][3..6], halves.map(String::from));
    assert_eq!(isotropic[1][6..], [&third, &third, &third, "0.0", "0.0", "0.0"].map(String::from));
    // Along the flow a sphere's double period and a rod's whole ones are back at the start.
    let late = rows("--aspect-ratio 1e100 --start 30,45 --times 1e6:1e6:1");
    let start = rows("--aspect-ratio 1e100 --start 30,45 --times 0:0:1");
    assert_eq!(late[1][3..], start[1][3..]);
    assert_ne!(late[1][3..], rows("--aspect-ratio 1e100 --start 30,45 --times 0.1:0.1:1")[1][3..]);
}

#[test]
fn units_of_time_give_the_same_rows_and_a_grid_is_decimal() {
    let seconds = rows("--aspect-ratio 7 --start 10,50 --times 0:3:31 --unit s --shear-rate-per-s 2");
    let strain = rows("--aspect-ratio 7 --start 10,50 --times 0:6:31 --unit strain --shear-rate-per-s 2");
    assert_eq!(seconds, strain);
    assert_eq!((seconds[4][0].as_str(), seconds[4][2].as_str()), ("0.3", "0.6"));
    let general = rows("--aspect-ratio 7 --start 10,50 --times 0:3:31 --unit s --gradient-per-s 0,0,0,2,0,0,0,0,0");
    assert_eq!(seconds, general);
    let listed = rows("--aspect-ratio 7 --start 10,50 --times 0.3,1e0,3 --unit s --shear-rate-per-s 2");
    assert_eq!(listed, [0, 4, 11, 31].map(|row| seconds[row].clone()));
    let reversed = rows("--aspect-ratio 7 --start 10,50 --times -3:0:31 --unit s --shear-rate-per-s -2");
    assert_eq!(reversed[1][3..], seconds[31][3..]);
    let extension = rows("--aspect-ratio 7 --times 1:1:1 --unit s --gradient-per-s 1,0,0,0,-1,0,0,0,0");
    assert_eq!(extension[1][..3], ["1.0", "", "2.0"].map(String::from));
}

#[test]
fn unequal_rods_reduce_to_equal_ones_and_discs_mirror_rods() {
    let at = |arguments: &str| -> Vec<f64> {
        let row = rows(&format!("{arguments} --times 0.3:0.3:1"))[1].clone();
        row[3..].iter().map(|field| field.parse().unwrap()).collect()
    };
    for r in ["11.6", "0.1"] {
        let equal = at(&format!("--aspect-ratio {r}"));
        let nearly = at(&format!("--aspect-ratio {r} --aspect-ratio-sd-percent 1e-4"));
        let unequal = at(&format!("--aspect-ratio {r} --aspect-ratio-sd-percent 3"));
        // Of second order: (2π r_e σ)² with σ = 1e-6, and the rounding to eleven decimals.
        assert!(equal.iter().zip(&nearly).all(|(a, b)| (a - b).abs() < 1e-8), "{equal:?} {nearly:?}");
        assert!(equal.iter().zip(&unequal).any(|(a, b)| (a - b).abs() > 1e-4));
    }
}

#[test]
fn diffusing_rods_have_the_columns_of_isotropic_starts_and_known_limits() {
    let numbers = |arguments: &str| -> Vec<Vec<f64>> {
        let rows = rows(arguments);
        let number = |field: &String| if field.is_empty() { -1.0 } else { field.parse().unwrap() };
        rows[1..].iter().map(|row| row.iter().map(number).collect()).collect()
    };
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let arguments = "--aspect-ratio inf --c-i 0.0311 --times 0:1:2 --steady";
    let header = "time_s,t_over_T,strain,x1,x2,x3,a11,a22,a33,a12,a13,a23";
    assert_eq!(rows(arguments)[0].join(","), header);
    let found = numbers(arguments);
    // No period; strain unless asked otherwise; the steady row comes last.
    assert_eq!((found[0][..3].to_vec(), found[1][..3].to_vec()), (vec![0.0, -1.0, 0.0], vec![1.0, -1.0, 1.0]));
    assert_eq!(rows(arguments)[3][..3], ["inf", "", "inf"].map(String::from));
    let third = 1.0 / 3.0;
    assert!(apart(&found[0][3..], &[0.5, 0.5, 0.5, third, third, third, 0.0, 0.0, 0.0]) < 1e-11);
    // Below what closures give for this C_I, 0.649 to 0.774 (shared data `tensor-models`).
    assert!((found[2][7] - 0.62713).abs() < 1e-5, "{:?}", found[2]);
    // Λ of 1e100 is 1 in doubles; a rod of r_e = 5 is another.
    let steady = |arguments: &str| numbers(arguments).pop().unwrap()[3..].to_vec();
    assert_eq!(steady("--aspect-ratio 1e100 --c-i 0.0311 --steady"), found[2][3..]);
    assert!(apart(&steady("--aspect-ratio 5 --c-i 0.0311 --steady"), &found[2][3..]) > 1e-3);
    // The flow the other way round changes the sign of a12 alone.
    let mut mirrored = steady("--aspect-ratio inf --c-i 0.0311 --steady --shear-rate-per-s -2");
    mirrored[6] = -mirrored[6];
    assert_eq!(mirrored, found[2][3..]);
    // C_I = 0 is a free rod to the last digit, a small one nearly, and a large one is isotropic.
    assert_eq!(rows("--aspect-ratio 3 --c-i 0 --times 0:0.2:3"), rows("--aspect-ratio 3 --times 0:0.2:3"));
    let free = numbers("--aspect-ratio 3 --times 0.1:0.1:1");
    let small = numbers("--aspect-ratio 3 --c-i 1e-9 --times 0.1:0.1:1");
    assert!(apart(&free[0], &small[0]) < 1e-7 && free != small);
    for c_i in ["1e9", "inf"] {
        assert!(apart(&steady(&format!("--aspect-ratio 3 --c-i {c_i} --steady")), &found[0][3..]) < 1e-9);
    }
    // The trace of a_ijkl is a_ij.
    let fourth = numbers("--aspect-ratio 5 --c-i 0.05 --times 0.1:0.1:1 --fourth").remove(0);
    let second = numbers("--aspect-ratio 5 --c-i 0.05 --times 0.1:0.1:1").remove(0);
    assert!((fourth[3] + fourth[6] + fourth[8] - second[6]).abs() < 3e-11);
}

/// Brownian rods at rest, against the closed form e^{−6D_r t}, to the digits that are printed; and D_r = C_I γ̇.
#[test]
fn brownian_rods_relax_by_the_closed_form_and_keep_the_units_of_c_i() {
    let at_rest = "--aspect-ratio 5 --gradient-per-s 0,0,0,0,0,0,0,0,0 --unit s";
    let start = |start: &str| rows(&format!("{at_rest} --start {start} --d-r-per-s 0.3 --times 0:2:5 --steady"));
    let off = |found: &[Vec<String>], first: [f64; 6], d_r: f64| {
        let each = found[1..].iter().flat_map(|row| {
            let time: f64 = row[0].parse().unwrap();
            assert_eq!(row[1..3], ["", "0.0"].map(String::from));
            let at = move |k: usize| {
                let whole = if k < 3 { 1.0 / 3.0 } else { 0.0 };
                let due = whole + (first[k] - whole) * (-6.0 * d_r * time).exp();
                (row[6 + k].parse::<f64>().unwrap() - due).abs()
            };
            (0..6).map(at)
        });
        each.fold(0.0, f64::max)
    };
    let planar = [0.5, 0.5, 0.0, 0.0, 0.0, 0.0];
    assert!(off(&start("planar"), planar, 0.3) < 6e-12);
    assert!(off(&start("planar"), planar, 0.301) > 1e-4 && off(&start("planar"), planar, 0.15) > 1e-2);
    assert!(off(&start("90,90"), [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], 0.3) < 6e-12);
    assert_eq!(start("isotropic")[3][3..], start("isotropic")[1][3..]);
    // D_r = C_I γ̇ with γ̇ = 2/s, and the Péclet number.
    let flow = "--aspect-ratio 5 --shear-rate-per-s 2 --times 0:1:3 --unit strain";
    for start in ["isotropic", "planar", "20,70"] {
        let found = rows(&format!("{flow} --start {start} --d-r-per-s 0.25"));
        assert_eq!(found, rows(&format!("{flow} --start {start} --c-i 0.125")));
        assert_ne!(found, rows(&format!("{flow} --start {start} --c-i 0.25")));
    }
    assert_eq!(reference(&format!("{flow} --d-r-per-s 0.25")).2, "note: the Péclet number γ̇/D_r is 8\n");
    // Without diffusion a plane of rods is free, and little changes it little.
    let free = rows(&format!("{flow} --start planar --d-r-per-s 0"));
    let little = rows(&format!("{flow} --start planar --d-r-per-s 1e-3"));
    for (a, b) in free[2][6..].iter().zip(&little[2][6..]) {
        let apart = (a.parse::<f64>().unwrap() - b.parse::<f64>().unwrap()).abs();
        assert!(apart < 3e-3, "{a} {b}");
    }
    for refused in [
        "--start planar --d-r-per-s 1e-6 --times 1:1:1",
        "--start planar --d-r-per-s 1 --times 1e-9:1:2",
        "--d-r-per-s 1 --c-i 1 --times 1:1:1",
        "--d-r-per-s -1 --times 1:1:1",
        "--start planar --constants",
        "--start planar --aspect-ratio-sd-percent 3 --times 1:1:1",
    ] {
        let (code, _, error) = reference(&format!("--aspect-ratio 5 {refused}"));
        assert!(
            code == Some(2) && error.contains("allowed") || error.contains("cannot be used with"),
            "{refused}: {error}"
        );
    }
}
