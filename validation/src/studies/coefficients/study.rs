//! The study of the effective coefficients: C_I against concentration, shape and α, and how rods move at equal C_I.

use super::jumps::{self, Compared};
use super::*;
use crate::input::published::folgar_tucker;
use crate::judge::statistics::student;
use crate::methods::coefficients::jumps::{Quantity, above};
use crate::oracle::diffusion::orbits::{mean_over_orbits, shear_stress_of_isotropic, shear_stress_of_orbit};

pub const STUDY: Study = Study {
    name: "folgar-tucker",
    title: "The field's coefficient: C_I and the rods' stress",
    question: "Which Folgar–Tucker coefficient do collisions amount to, and does one describe them?",
    cases: &[
        "effective-ci",
        "fourth-moments",
        "particle-stress",
        "folgar-tucker-seven",
        "kicks-are-no-diffusion",
        "orbits-of-collisions",
    ],
    command: "cargo run --release -- bench --case folgar-tucker",
    parts: &["folgar-tucker"],
    shared: false,
    run,
};

const SOURCE: &str = "Folgar & Tucker 1984; eqs 5 to 10";

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let rows = rows(&settings(request.effort.full), request.effort.pick(12, 48), request.effort);
    let base = base(&rows);
    let logarithms: Vec<_> = (base.iter()).map(|row| (row.setting.n_a3.ln(), row.c_i.value.ln())).collect();
    let answer = base.iter().find(|row| row.setting.n_a3 == 0.2).map_or(String::new(), |row| {
        format!(
            "C_I = {:.6} ± {:.6} at n a³ = 0.2, r_e = 11.6, α = 0.5 with update = \"kick\" and {FINER} times the \
             default's steps, growing as (n a³)^{:.2}; a single C_I leaves a relative residual of {:.0} %. With \
             \"rotation\" a colliding rod takes a straight step in place of Jeffery's, whose error hides C_I at the \
             default's step.",
            row.c_i.value,
            row.c_i.se,
            slope(&logarithms),
            100.0 * row.misfit.value
        )
    });
    let same: Vec<_> =
        rows.iter().filter(|row| kicked(row) && kind(row) == (11.6, 0.5) && row.setting.n_a3 == 0.2).collect();
    let compared = jumps::compared(&same, request.effort);
    let finest = compared.iter().find(|one| one.setting.finer == FINER);
    let [tail, apart] = comparison::tables(&compared, request.effort);
    let [jumped, orbits] = finest.map(comparison::figures).map_or([None, None], |both| both.map(Some));
    let [table, koch] = [coefficients(&rows), koch(&rows)];
    let files = [
        ("folgar-tucker.csv", table.csv()?),
        ("koch.csv", koch.csv()?),
        ("kicks-and-diffusion.csv", tail.csv()?),
        ("steady-orbits.csv", apart.csv()?),
        ("folgar-tucker.json", build::json(&serde_json::json!({ "rows": rows }))?),
    ];
    let exhibits = vec![
        Exhibit::both(against_concentration(&rows), table),
        koch.into(),
        beside_measured(&base).into(),
        Exhibit { figure: jumped, table: Some(tail) },
        Exhibit { figure: orbits, table: Some(apart) },
        stress(&rows).into(),
    ];
    Ok(Some(Findings::new(answer + &finest.map_or(String::new(), no_diffusion), exhibits, files)))
}

/// A sentence on the difference between kicks and diffusion of the same C_I.
fn no_diffusion(one: &Compared) -> String {
    let per_cent = |all, edge| 100.0 * Sample::of(above(all, Quantity::Angle, edge)).mean;
    format!(
        " Kicks are no diffusion: over a strain of {:.1}, diffusion of the same C_I turns {:.0} % of the rods off \
         Jeffery's motion by more than 0.01 rad and {:.2} % by more than 0.2 rad, kicks {:.0} % and {:.2} %.",
        one.strain,
        per_cent(&one.diffusion, 0.01),
        per_cent(&one.diffusion, 0.2),
        per_cent(&one.kicks, 0.01),
        per_cent(&one.kicks, 0.2),
    )
}

fn kind(row: &Coefficients) -> (f64, f64) {
    (row.setting.aspect_ratio, row.setting.alpha)
}

/// True if colliding rods take Jeffery's step and then the kick, and keep their places. With the other updates they
/// take a straight step, whose error is as large as C_I at the default time step.
fn kicked(row: &Coefficients) -> bool {
    row.setting.update == Update::Kick && row.setting.places == Places::Carried
}

/// The suspensions of r_e = 11.6 and α = 0.5 with [`FINER`] times the default number of steps.
fn base(rows: &[Coefficients]) -> Vec<&Coefficients> {
    let chosen = |row: &&Coefficients| kicked(row) && kind(row) == (11.6, 0.5) && row.setting.finer == FINER;
    rows.iter().filter(chosen).collect()
}

fn setting_columns<'a>() -> Vec<Column<'a, Coefficients>> {
    vec![
        field("n a³", |row: &Coefficients| row.setting.n_a3),
        field("r_e", |row: &Coefficients| row.setting.aspect_ratio),
        field("α", |row: &Coefficients| row.setting.alpha),
        words("update", |row: &Coefficients| {
            let redrawn = if row.setting.places == Places::Redrawn { ", places redrawn" } else { "" };
            format!("{:?}{redrawn}", row.setting.update).to_lowercase()
        }),
        field("steps ×", |row: &Coefficients| row.setting.finer),
        field("periods", |row: &Coefficients| row.periods),
    ]
}

fn measured<'a>(name: &str, value: impl Fn(&Coefficients) -> Estimate + 'a) -> Column<'a, Coefficients> {
    estimate(name, move |row: &Coefficients| value(row))
}

/// C_I of each suspension, and the residual of a fit by a single C_I.
fn coefficients(rows: &[Coefficients]) -> ReportTable {
    let replicas = rows.first().map_or(0, |row| row.replicas);
    let is_redrawn = rows.iter().any(|row| row.setting.places == Places::Redrawn);
    let redrawn =
        if is_redrawn { " Places redrawn: at random before every step, so that no pair has a past." } else { "" };
    let mut columns = setting_columns();
    columns.push(number("φ r_p", decimals(4), |row: &Coefficients| row.phi_rp));
    columns.push(measured("C_I", |row| row.c_i));
    for (k, name) in ["of 11", "of 22", "of 33"].into_iter().enumerate() {
        columns.push(measured(name, move |row| row.own[k]));
    }
    columns.push(measured("residual", |row| row.misfit));
    columns.push(estimate("X̄₁'s decay per T", |row: &Coefficients| row.damping_per_period.map(Into::into)));
    ReportTable::new(
        ["folgar-tucker", "The effective Folgar–Tucker coefficient"],
        format!(
            "Steady state of 100 rods, m = 3, {replicas} replicas (± a standard error, jackknife). C_I by least \
             squares over all components of J, then by its diagonal components alone: where these differ, no single \
             C_I describes the collisions, and the relative residual is in the next column. steps ×: time steps over \
             those that resolve the motion. periods: before the window and in it. φ r_p: for cylinders, π n a³/(4 \
             r_e). The decay of X̄₁'s oscillation is over the first two periods from isotropic directions.{redrawn}"
        ),
        rows,
        columns,
    )
}

/// Koch's two coefficients, and how much more of J they explain than one C_I.
fn koch(rows: &[Coefficients]) -> ReportTable {
    let mut columns = setting_columns();
    columns.push(measured("β_1", |row| row.koch[0]));
    columns.push(measured("β_2", |row| row.koch[1]));
    columns.push(measured("left by these", |row| row.koch_misfit));
    columns.push(measured("left by one C_I", |row| row.misfit));
    columns.push(measured("J_12", |row| row.j_12));
    ReportTable::new(
        ["koch", "Koch's anisotropic diffusivity in place of C_I"],
        "In the same runs: C = β_1 (D:⟨pppp⟩:D) δ/G² + β_2 D:⟨pppppp⟩:D/G² (Koch 1995) by least squares over all \
         components of J, and the relative residual of that fit beside that of one C_I. Most of what both leave is \
         J_12.",
        rows,
        columns,
    )
}

fn stress(rows: &[Coefficients]) -> ReportTable {
    let mut columns = setting_columns();
    for (k, name) in ["σ_12/(μ_fiber G)", "N_1/(μ_fiber G)", "N_2/(μ_fiber G)"].into_iter().enumerate() {
        columns.push(measured(name, move |row| row.stress[k]));
    }
    columns.push(measured("σ_12/(μ G n a³), spheroids", |row| row.spheroids));
    columns.push(number("σ_12, free from isotropic", decimals(5), |row: &Coefficients| {
        shear_stress_of_isotropic(row.setting.aspect_ratio)
    }));
    columns.push(number("σ_12, weak diffusion", decimals(5), |row: &Coefficients| {
        let r = row.setting.aspect_ratio;
        mean_over_orbits(r, |c| shear_stress_of_orbit(c, r))
    }));
    ReportTable::new(
        ["particle-stress", "What the rods add to the stress, steady"],
        "σ_ij = μ_fiber G ⟨p_i p_j p₁p₂⟩ of slender rods (Batchelor 1970), in the same runs. 1 is the gradient, 2 the \
         flow; N₁ = σ₂₂ − σ₁₁, N₂ = σ₁₁ − σ₃₃. What forces between colliding rods add is not in it. μ_fiber is the \
         leading order for slender rods; the next column has σ_12 of spheroids of that r_e with Jeffery's coefficients \
         and their whole stress. The last two columns are what σ_12 would be without collisions, by closed forms: free \
         rods that started isotropic, in the mean over a period, and rods in the orbits of weak rotary diffusion (Leal \
         & Hinch 1971). Both have N₁ = N₂ = 0, for their phases are even.",
        rows,
        columns,
    )
}

/// C_I of suspensions at these places, with 95 % intervals.
fn points(label: String, rows: &[&Coefficients], x: impl Fn(&Coefficients) -> f64) -> Points {
    Points::with_bars(label, rows, |row| (x(row), row.c_i.value, student(0.05, row.replicas) * row.c_i.se))
}

fn against_concentration(rows: &[Coefficients]) -> ReportFigure {
    let at_step: Vec<_> = rows.iter().filter(|row| kicked(row) && row.setting.finer == FINER).collect();
    let mut kinds: Vec<_> = at_step.iter().map(|row| kind(row)).collect();
    kinds.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    kinds.dedup();
    let of_kind = |own: &(f64, f64)| {
        let these: Vec<_> = at_step.iter().copied().filter(|row| kind(row) == *own).collect();
        points(format!("r_e = {}, α = {}", own.0, own.1), &these, |row| row.setting.n_a3)
    };
    ReportFigure::new(
        ["effective-ci", "The effective Folgar–Tucker coefficient of the model"],
        format!(
            "Steady C_I with 95 % intervals, with `kick` at {FINER} times the default's time steps. It grows about as \
             the square root of n a³, falls with r_e and grows nearly in proportion to α."
        ),
        ["log n a³", "log C_I"],
    )
    .points(kinds.iter().map(of_kind))
    .judged(SOURCE, &["effective-ci", "folgar-tucker-seven"])
}

/// C_I against φ r_p, with measured values of far denser suspensions.
fn beside_measured(base: &[&Coefficients]) -> ReportFigure {
    let seven = "measured: Folgar & Tucker 1984, n a³ > 3";
    ReportFigure::new(
        ["folgar-tucker", "The effective Folgar–Tucker coefficient"],
        "Steady C_I of the model for n a³ up to 1, at the finer time step of its table, with 95 % intervals, beside \
         seven measured values of suspensions that are not dilute (n a³ above 3, second-hand). Nothing is fitted.",
        ["log φ r_p", "log C_I"],
    )
    .points([
        points("this model, r_e = 11.6, α = 0.5".into(), base, |row| row.phi_rp),
        Points::of(seven, &folgar_tucker(), |point| (point.phi_rp, point.c_i)),
    ])
    .judged(SOURCE, &["effective-ci", "folgar-tucker-seven"])
}
