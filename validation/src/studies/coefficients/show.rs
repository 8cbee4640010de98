//! The coefficients as tables and pictures.

use super::Coefficients;
use crate::input::published::folgar_tucker;
use crate::judge::statistics::{Estimate, student};
use crate::present::plot::{Figure, Points};
use crate::present::study::ReportFigure;
use crate::present::table::{Column, ReportTable, estimate, field, number};

fn of<'a>(name: &str, value: impl Fn(&Coefficients) -> Estimate + 'a) -> Column<'a, Coefficients> {
    let digits = |x: f64, se: f64| {
        let places = (2.0 - se.log10()).floor().clamp(2.0, 6.0) as usize;
        format!("{x:.places$} ± {se:.places$}")
    };
    estimate(name, digits, move |row: &Coefficients| {
        let Estimate { value, se } = value(row);
        (value, se)
    })
}

/// The suspensions of r_e = 11.6 and α = 0.5 with so many times the steps that resolve the motion.
pub(super) fn base(rows: &[Coefficients], finer: u64) -> Vec<&Coefficients> {
    let base = |row: &&Coefficients| {
        let setting = row.setting;
        setting.aspect_ratio == 11.6 && setting.alpha == 0.5 && setting.finer == finer
    };
    rows.iter().filter(base).collect()
}

/// Those of them with this n a³, at every time step.
pub(super) fn of_n(rows: &[Coefficients], n_a3: f64) -> Vec<&Coefficients> {
    let same = |row: &&Coefficients| {
        let setting = row.setting;
        (setting.n_a3, setting.aspect_ratio, setting.alpha) == (n_a3, 11.6, 0.5)
    };
    rows.iter().filter(same).collect()
}

fn settings<'a>() -> Vec<Column<'a, Coefficients>> {
    vec![
        field("n a³", |row: &Coefficients| row.setting.n_a3),
        field("r_e", |row: &Coefficients| row.setting.aspect_ratio),
        field("α", |row: &Coefficients| row.setting.alpha),
        field("steps ×", |row: &Coefficients| row.setting.finer),
        field("periods", |row: &Coefficients| row.periods),
    ]
}

/// C_I of each suspension, and how well one number does.
pub(super) fn coefficients(rows: &[Coefficients]) -> ReportTable {
    let replicas = rows.first().map_or(0, |row| row.replicas);
    let mut columns = settings();
    columns.push(number("φ r_p", |x| format!("{x:.4}"), |row: &Coefficients| row.phi_rp));
    columns.push(of("C_I", |row| row.c_i));
    for (k, name) in ["of 11", "of 22", "of 33", "of 12"].into_iter().enumerate() {
        columns.push(of(name, move |row| row.own[k]));
    }
    columns.push(of("left over", |row| row.misfit));
    columns.push(estimate(
        "X̄₁'s decay per T",
        |x, se| format!("{x:.2} ± {se:.2}"),
        |row: &Coefficients| row.damping_per_period.map(|found| (found.value, found.se)),
    ));
    ReportTable::new(
        ["folgar-tucker", "The effective Folgar–Tucker coefficient"],
        format!(
            "Steady state of 100 rods, m = 3, {replicas} replicas (± a standard error, jackknife). C_I by least squares over \
             all components of J, then by each component alone: where these differ, no single C_I describes the collisions, \
             and the part of |J| that it leaves is in the next column. steps ×: time steps over those that resolve the motion. \
             periods: before the window and in it. φ r_p: for cylinders, π n a³/(4 r_e). The decay of X̄₁'s oscillation is \
             over the first two periods from isotropic directions."
        ),
        rows.to_vec(),
        columns,
    )
}

/// The rods' steady stress.
pub(super) fn stress(rows: &[Coefficients]) -> ReportTable {
    let mut columns = settings();
    for (k, name) in ["σ_12/(μ_fiber G)", "N_1/(μ_fiber G)", "N_2/(μ_fiber G)"].into_iter().enumerate() {
        columns.push(of(name, move |row| row.stress[k]));
    }
    ReportTable::new(
        ["particle-stress", "What the rods add to the stress, steady"],
        "σ_ij = μ_fiber G ⟨p_i p_j p₁p₂⟩ of slender rods (Batchelor 1970), in the same runs. 1 is the gradient, 2 the flow; N₁ = \
         σ₂₂ − σ₁₁, N₂ = σ₁₁ − σ₃₃. What forces between colliding rods add is not in it.",
        rows.to_vec(),
        columns,
    )
}

/// C_I of suspensions at these places, with 95 % intervals.
fn points(label: String, rows: &[&Coefficients], x: impl Fn(&Coefficients) -> f64) -> Points {
    let half = |row: &&Coefficients| student(0.05, row.replicas) * row.c_i.se;
    Points {
        label,
        x: rows.iter().map(|row| x(row)).collect(),
        y: rows.iter().map(|row| row.c_i.value).collect(),
        x_error: None,
        y_error: Some(rows.iter().map(half).collect()),
    }
}

/// C_I against n a³, for every r_e and α.
pub(super) fn against_concentration(rows: &[Coefficients], finer: u64) -> ReportFigure {
    let at_step: Vec<_> = rows.iter().filter(|row| row.setting.finer == finer).collect();
    let kind = |row: &Coefficients| (row.setting.aspect_ratio, row.setting.alpha);
    let mut kinds: Vec<_> = at_step.iter().map(|row| kind(row)).collect();
    kinds.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    kinds.dedup();
    let of_kind = |own: &(f64, f64)| {
        let these: Vec<_> = at_step.iter().copied().filter(|row| kind(row) == *own).collect();
        points(format!("r_e = {}, α = {}", own.0, own.1), &these, |row| row.setting.n_a3)
    };
    ReportFigure {
        name: "effective-ci".into(),
        figure: Figure {
            title: "The effective Folgar–Tucker coefficient of the model".into(),
            x_name: "n a³".into(),
            y_name: "C_I".into(),
            points: kinds.iter().map(of_kind).collect(),
            x_log: true,
            y_log: true,
            ..Default::default()
        },
        caption: format!(
            "Steady C_I with 95 % intervals, at {finer} times the default's time steps, on which it depends. It grows about as the square root of n a³, falls \
             with r_e and grows nearly in proportion to α."
        ),
        source: "Folgar & Tucker 1984; eqs 5 to 10".into(),
        cases: vec!["effective-ci".into(), "folgar-tucker-seven".into()],
    }
}

/// C_I against φ r_p, beside measured values of far denser suspensions.
pub(super) fn figure(rows: &[Coefficients], finer: u64) -> ReportFigure {
    let model = points("this model, r_e = 11.6, α = 0.5".into(), &base(rows, finer), |row| row.phi_rp);
    let measured = folgar_tucker().rows;
    let seven = Points {
        label: "measured: Folgar & Tucker 1984, n a³ > 3".into(),
        x: measured.iter().map(|point| point.phi_rp).collect(),
        y: measured.iter().map(|point| point.c_i).collect(),
        x_error: None,
        y_error: None,
    };
    ReportFigure {
        name: "folgar-tucker".into(),
        figure: Figure {
            title: "The effective Folgar–Tucker coefficient".into(),
            x_name: "φ r_p".into(),
            y_name: "C_I".into(),
            points: vec![model, seven],
            x_log: true,
            y_log: true,
            ..Default::default()
        },
        caption: "Steady C_I of the model for n a³ up to 1, at the finer time step of its table, with 95 % intervals, beside seven measured values of suspensions that \
                  are not dilute (n a³ above 3, second-hand). Nothing is fitted."
            .into(),
        source: "Folgar & Tucker 1984; eqs 5 to 10".into(),
        cases: vec!["effective-ci".into(), "folgar-tucker-seven".into()],
    }
}
