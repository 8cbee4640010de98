//! The study of Brownian rods: start-up, relaxation, and the angle that birefringence measures.

use super::*;
use crate::oracle::diffusion::{FlowStep, Means, Motion, Start, at, steady, through};
use shearbed::scene::Flow;
use shearbed::{Observable, Results};

pub const STUDY: Study = Study {
    name: "brownian",
    title: "Brownian rods",
    question: "How do rods that diffuse start up in shear, relax at rest, and lie in the end?",
    cases: &["brownian-rods", "diffusing-rods"],
    command: "cargo run --release -- bench --case brownian",
    parts: &["brownian"],
    shared: false,
    run,
};

/// D_r in 1/s of all rods here; Λ = 1.
const D_R: f64 = 1.0;
const REST: [[f64; 3]; 3] = [[0.0; 3]; 3];

fn shear(peclet: f64) -> [[f64; 3]; 3] {
    [[0.0; 3], [peclet * D_R, 0.0, 0.0], [0.0; 3]]
}

fn motion(gradient_per_s: [[f64; 3]; 3]) -> Motion {
    Motion::diffusing(gradient_per_s, 1e100, D_R)
}

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let angles = angles().map_err(|why| why.to_string())?;
    let relaxed = relaxation().map_err(|why| why.to_string())?;
    let (curves, points) = start_up(request.effort)?;
    let start_up = ReportFigure::new(
        ["brownian-start-up", "Brownian rods: start-up of shear"],
        "From isotropic rods, Λ = 1. Lines: the distribution itself; points: random rods with their 95 % intervals.",
        ["strain Gt", "a_12"],
    )
    .curves(curves)
    .points(points)
    .judged("Doi & Edwards 1986", STUDY.cases);
    let of = |name: &str, at: usize| Points::of(name, &relaxed, |row| (row[0], row[at]));
    let due = |name: &str, rate: f64| {
        Curve::of(format!("e^(−{name} D_r t), theory"), &relaxed, |row| (row[0], (-rate * row[0]).exp()))
    };
    let relaxation = ReportFigure::new(
        ["brownian-relaxation", "Brownian rods: relaxation after shear"],
        "At rest after a strain of 20 at Pe = 20: ⟨P_2(p_2)⟩ and ⟨P_4(p_2)⟩ over their values when the flow stops.",
        ["D_r t", "log share that is left"],
    )
    .curves([due("6", 6.0), due("20", 20.0)])
    .points([of("second moments", 1), of("fourth moments", 2)])
    .judged("Doi & Edwards 1986", STUDY.cases);
    let last = angles[angles.len() - 1];
    let angle = ReportFigure::new(
        ["brownian-angle", "Brownian rods: the extinction angle of steady shear"],
        "Λ = 1. Weak flows: tan 2χ = 6/Pe, from the equation of second moments. Strong ones: a layer of the width \
         Pe^(−1/3) (Hinch & Leal 1972), drawn through the last point.",
        ["log Pe", "log extinction angle (°)"],
    )
    .curves([
        Curve::of("weak, theory", angles.iter().filter(|row| row[0] <= 30.0), |row| (row[0], weak_deg(row[0]))),
        Curve::of("strong, theory", angles.iter().filter(|row| row[0] >= 100.0), |row| {
            (row[0], last[1] * (last[0] / row[0]).cbrt())
        }),
    ])
    .points([Points::of("exact", &angles, |row| (row[0], row[1]))])
    .judged("Hinch & Leal 1972", STUDY.cases);
    let answer = format!(
        "The exact distribution joins both limits: at Pe = {:.0} χ is {:.2}°, and falls as Pe^({:.3}) there; −1/3 is \
         reached slowly.",
        last[0],
        last[1],
        exponent(&angles)
    );
    let exhibits = [start_up, relaxation, angle].map(Exhibit::from);
    Ok(Some(Findings::new(answer, exhibits.into(), [])))
}

/// χ of weak flows in degrees.
fn weak_deg(peclet: f64) -> f64 {
    0.5 * (6.0 / peclet).atan().to_degrees()
}

/// The slope of log χ between the last two Péclet numbers.
fn exponent(angles: &[[f64; 2]]) -> f64 {
    let [.., before, last] = angles else { return f64::NAN };
    (last[1] / before[1]).ln() / (last[0] / before[0]).ln()
}

/// Péclet numbers and the extinction angle of steady shear in degrees.
fn angles() -> Result<Vec<[f64; 2]>, crate::oracle::diffusion::NoAnswer> {
    let peclet = (-2..=16).map(|k| 10f64.powf(0.25 * f64::from(k))).collect::<Vec<_>>();
    let of = |peclet: &f64| Ok([*peclet, steady(&motion(shear(*peclet)))?.extinction_angle_deg()]);
    peclet.par_iter().map(of).collect()
}

/// D_r t, and what is left of ⟨P₂(p₂)⟩ and ⟨P₄(p₂)⟩ since the flow stopped.
fn relaxation() -> Result<Vec<[f64; 3]>, crate::oracle::diffusion::NoAnswer> {
    let flows = [(shear(20.0), 1.0), (REST, f64::INFINITY)];
    let flows = flows.map(|(gradient, duration_s)| FlowStep { motion: motion(gradient), duration_s });
    let times: Vec<f64> = (0..=12).map(|k| 1.0 + 0.05 * f64::from(k)).collect();
    let all = through(&flows, Start::Isotropic, &times)?;
    let left = |means: &Means| {
        let (a22, a2222) = (means.second[1], means.fourth[FOURTH_22]);
        [1.5 * a22 - 0.5, (35.0 * a2222 - 30.0 * a22 + 3.0) / 8.0]
    };
    let begun = left(&all[0]);
    let row = |(time, means): (&f64, &Means)| {
        let now = left(means);
        [time - 1.0, now[0] / begun[0], now[1] / begun[1]]
    };
    Ok(times.iter().zip(&all).map(row).collect())
}

/// The place of a_2222 among the fourth moments.
const FOURTH_22: usize = 10;

/// a_12 over strain at three Péclet numbers: the distribution, and random rods at a few times.
fn start_up(effort: &Effort) -> Result<(Vec<Curve>, Vec<Points>), String> {
    let (mut curves, mut points) = (Vec::new(), Vec::new());
    for peclet in [1.0, 10.0, 100.0] {
        let strains: Vec<f64> = (0..=60).map(|k| 0.2 * f64::from(k)).collect();
        let seconds: Vec<f64> = strains.iter().map(|strain| strain / (peclet * D_R)).collect();
        let all = at(&motion(shear(peclet)), Start::Isotropic, &seconds).map_err(|why| why.to_string())?;
        let name = format!("Pe = {peclet}");
        curves.push(Curve::of(name.clone(), strains.iter().zip(&all), |(strain, means)| (*strain, means.second[3])));
        let strains = [0.5, 1.0, 2.0, 4.0, 8.0, 12.0];
        let results = at_random(peclet * D_R, D_R, effort.pick(500, 2000), 10, &strains)?;
        let a12 = results.column("a12").ok_or("no a12")?;
        let rows = strains.iter().zip(a12.mean.iter().zip(&a12.se));
        points.push(Points::with_bars(format!("{name}, random rods"), rows, |(strain, (mean, se))| {
            (*strain, *mean, 2.26 * se)
        }));
    }
    Ok((curves, points))
}

/// a_ij at these strains of shear, of isotropic rods that turn at random with D_r; Λ = 1 to 2·10⁻¹².
pub(super) fn at_random(
    shear_rate_per_s: f64,
    d_r_per_s: f64,
    count: usize,
    replicas: u64,
    strains: &[f64],
) -> Result<Results, String> {
    let flow = Flow::Shear { shear_rate_per_s };
    let mut scene = Scene { flow, time: Time::strain(strains[strains.len() - 1]), ..Scene::default() };
    (scene.particles.aspect_ratio, scene.particles.rotary_diffusion_per_s) = (1e6, d_r_per_s);
    (scene.particles.count, scene.ensemble.replicas) = (count, replicas);
    scene.output.times = strains.to_vec();
    scene.output.observables = vec![Observable::OrientationTensor];
    let plan = Plan::new(&scene).map_err(|why| why.to_string())?;
    ensemble::run(&plan).map_err(|why| why.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The limits that others found, and the closed form of the relaxation.
    #[test]
    fn both_limits_and_the_relaxation_hold() {
        let angles = angles().unwrap();
        let [peclet, first] = angles[0];
        // tan 2χ has terms of Pe² beyond 6/Pe.
        assert!((first / weak_deg(peclet) - 1.0).abs() < 0.01 && (first / weak_deg(0.9 * peclet) - 1.0).abs() > 1e-3);
        // The next term is smaller by Pe^(−1/3), the layer's width: a decade of Pe takes 0.54 of it away.
        let [at_1e3, at_1e4] = [4, 0].map(|less| exponent(&angles[..angles.len() - less]));
        let limit = at_1e4 + (at_1e4 - at_1e3) / (10f64.cbrt() - 1.0);
        assert!((limit + 1.0 / 3.0).abs() < 0.01 && (at_1e4 + 1.0 / 3.0).abs() > 0.02, "{limit} {at_1e4}");
        for [time, second, fourth] in relaxation().unwrap() {
            assert!((second - (-6.0 * time).exp()).abs() < 1e-9 && (fourth - (-20.0 * time).exp()).abs() < 1e-9);
        }
    }
}
