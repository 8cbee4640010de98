//! The study of the effective coefficients.

use super::{QUICK, SETTINGS, rows, show};
use crate::build;
use crate::statistics::slope;
use crate::studies::{Exhibit, Extent, Found, Study};

/// C_I, and the rods' stress.
pub const STUDY: Study = Study {
    name: "folgar-tucker",
    title: "The field's coefficient: C_I and the rods' stress",
    question: "Which Folgar–Tucker coefficient do collisions amount to, and does one describe them?",
    cases: &["effective-ci", "fourth-moments", "particle-stress"],
    command: "cargo run --release -- bench --case folgar-tucker",
    benches: || vec!["folgar-tucker".to_owned()],
    shared: false,
    run,
};

fn run(extent: &Extent) -> Result<Option<Found>, String> {
    if !(extent.wanted)("folgar-tucker") {
        return Ok(None);
    }
    let (settings, replicas) = extent.effort.pick((&QUICK[..], 12), (&SETTINGS[..], 48));
    let rows = rows(settings, replicas, extent.effort);
    let base: Vec<_> = rows
        .iter()
        .filter(|row| row.setting.aspect_ratio == 11.6 && row.setting.alpha == 0.5 && row.setting.finer == 1)
        .collect();
    let logarithms: Vec<_> = (base.iter())
        .map(|row| (row.setting.n_a3.ln(), row.c_i.value.ln()))
        .collect();
    let answer = base.iter().find(|row| row.setting.n_a3 == 0.2).map_or(String::new(), |row| {
        format!(
            "C_I = {:.5} ± {:.5} at n a³ = 0.2, r_e = 11.6, α = 0.5, growing as (n a³)^{:.2}; a single C_I leaves {:.0} % of \
             what collisions do to the mean of p_i p_j.",
            row.c_i.value,
            row.c_i.se,
            slope(&logarithms),
            100.0 * row.misfit.value
        )
    });
    let table = show::coefficients(&rows);
    let files = vec![
        ("folgar-tucker.csv".into(), table.csv()?),
        (
            "folgar-tucker.json".into(),
            build::json(&serde_json::json!({ "rows": rows }))?,
        ),
    ];
    Ok(Some(Found {
        answer,
        exhibits: vec![
            Exhibit::both(show::figure(&rows), table),
            show::stress(&rows).into(),
        ],
        files,
        ..Default::default()
    }))
}
