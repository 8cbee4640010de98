//! Figures with many series, for tests.

use super::*;

/// As many curves as there are integrators, all ending near each other.
pub fn many() -> Figure {
    let names = [
        "exact propagator",
        "explicit Euler in angles",
        "projected RK4 in p",
        "Dormand–Prince 8(5,3)",
        "implicit midpoint in p",
        "Lie-group RKMK4",
        "Radau IIA 5",
    ];
    let curve = |(k, name): (usize, &&str)| {
        Curve::of(*name, [(1e-7, 1.0), (1e-5, 1e-3), (1e-2, 1e-14 * (1.0 + k as f64))], |point| point)
    };
    Figure {
        title: "Synthetic: many curves".into(),
        x_name: "run time (s)".into(),
        y_name: "angle to the closed form (rad)".into(),
        curves: names.iter().enumerate().map(curve).collect(),
        x_log: true,
        y_log: true,
        ..Default::default()
    }
}

/// Two fitted curves with points, and their residuals below.
pub fn fitted() -> Figure {
    let names = ["X̄₁", "X̄₂"];
    let curve = |label: String, y: f64| Curve::with_band(label, [0.0, 300.0], |x| (x, y, 0.01));
    let points =
        |name: &str, y: f64| Points::with_bars(format!("{name}{MEASURED}"), [0.0, 150.0, 300.0], |x| (x, y, 0.012));
    Figure {
        title: "Synthetic: a fit".into(),
        x_name: "t (s)".into(),
        y_name: names.join(", "),
        curves: names.map(|name| curve(format!("{name}{FITTED}"), 0.5)).into(),
        points: names.map(|name| points(name, 0.51)).into(),
        below: Some(Panel {
            y_name: "residual".into(),
            curves: names.map(|_| curve(String::new(), 0.0)).into(),
            points: names.map(|name| points(name, 0.01)).into(),
        }),
        ..Default::default()
    }
}

pub fn maps() -> Figure {
    let map = |k: usize| Map {
        title: format!("explicit Euler in angles {k}"),
        cells: (0..10).map(|r| (0..17).map(|c| (r + c + k) % 6).collect()).collect(),
        limit: vec![(3.0, 0.0), (4.0, 9.0)],
    };
    Figure {
        title: "Synthetic maps".into(),
        x_name: "step GΔt".into(),
        y_name: "aspect ratio r_e".into(),
        grid: Some(Grid {
            shades: false,
            classes: ["right", "stable but wrong", "length lost", "not finite", "refused", "not run"]
                .map(String::from)
                .into(),
            columns: (0..17).map(|k| if k % 4 == 2 { decade(k / 4 - 1) } else { String::new() }).collect(),
            values: vec![String::new(); 17],
            rows: (0..10).map(|k| power_of_ten(k - 5)).collect(),
            maps: (0..7).map(map).collect(),
            limit_name: "theory".into(),
        }),
        ..Default::default()
    }
}
