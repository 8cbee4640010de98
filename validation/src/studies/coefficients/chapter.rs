//! The study of the effective coefficients.

use super::jumps::{self, Compared, Quantity, above};
use super::{Amount, rows, show};
use crate::files::build;
use crate::judge::statistics::{Sample, slope};
use crate::present::study::{Exhibit, Extent, Found, Study};

/// C_I, and the rods' stress.
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
    ],
    command: "cargo run --release -- bench --case folgar-tucker",
    benches: || vec!["folgar-tucker".to_owned()],
    shared: false,
    run,
};

fn run(extent: &Extent) -> Result<Option<Found>, String> {
    if !(extent.wanted)("folgar-tucker") {
        return Ok(None);
    }
    let amount = extent.effort.pick(Amount::QUICK, Amount::FULL);
    let rows = rows(amount, extent.effort);
    let base: Vec<_> = show::base(&rows, amount.finer);
    let logarithms: Vec<_> = (base.iter()).map(|row| (row.setting.n_a3.ln(), row.c_i.value.ln())).collect();
    let answer = base.iter().find(|row| row.setting.n_a3 == 0.2).map_or(String::new(), |row| {
        format!(
            "C_I = {:.5} ± {:.5} at n a³ = 0.2, r_e = 11.6, α = 0.5 with {} times the default's steps, growing as (n a³)^{:.2}; a \
             single C_I leaves {:.0} % of what collisions do to the mean of p_i p_j.",
            row.c_i.value,
            row.c_i.se,
            amount.finer,
            slope(&logarithms),
            100.0 * row.misfit.value
        )
    });
    let table = show::coefficients(&rows);
    let compared = jumps::compared(&show::of_n(&rows, 0.2), extent.effort);
    let finest = compared.iter().find(|one| one.setting.finer == amount.finer);
    let [tail, apart] = jumps::tables(&compared, extent.effort);
    let files = vec![
        ("folgar-tucker.csv".into(), table.csv()?),
        ("kicks-and-diffusion.csv".into(), tail.csv()?),
        ("steady-orbits.csv".into(), apart.csv()?),
        ("folgar-tucker.json".into(), build::json(&serde_json::json!({ "rows": rows }))?),
    ];
    let [jumped, orbits] = finest.map(jumps::figures).map_or([None, None], |both| both.map(Some));
    Ok(Some(Found {
        answer: answer + &finest.map_or(String::new(), told),
        exhibits: vec![
            Exhibit::both(show::against_concentration(&rows, amount.finer), table),
            show::figure(&rows, amount.finer).into(),
            Exhibit { figure: jumped, table: Some(tail) },
            Exhibit { figure: orbits, table: Some(apart) },
            show::stress(&rows).into(),
        ],
        files,
        ..Default::default()
    }))
}

/// What becomes of rods at equal C_I, in a sentence.
fn told(one: &Compared) -> String {
    let per_cent = |all, edge| 100.0 * Sample::of(&above(all, Quantity::Angle, edge)).mean;
    format!(
        " Kicks are no diffusion: over a strain of {:.1}, diffusion of the same C_I turns {:.0} % of the rods off Jeffery's motion by \
         more than 0.01 rad and {:.2} % by more than 0.2 rad, kicks {:.0} % and {:.2} %.",
        one.strain,
        per_cent(&one.diffusion, 0.01),
        per_cent(&one.diffusion, 0.2),
        per_cent(&one.kicks, 0.01),
        per_cent(&one.kicks, 0.2),
    )
}
