//! The study of closures: their error over C_I and flow, and their work compared with the exact solver's.

use super::measure::{FLOWS, Fitted, Off, Work, errors, fitted, work};
use super::*;
use crate::methods::tensors::Closure;

pub const STUDY: Study = Study {
    name: "closures",
    title: "Closures against the exact distribution",
    question: "What does a closure cost, and is it worth its error beside the exact solution?",
    cases: &["closures", "diffusing-rods"],
    command: "cargo run --release -- bench --case closures",
    parts: &["closures"],
    shared: false,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let c_i: &[f64] =
        request.effort.pick(&[1e-3, 0.0053, 0.0311, 0.1], &[1e-4, 3e-4, 1e-3, 0.0053, 0.01, 0.0311, 0.1, 0.3, 1.0]);
    let (rows, work, fitted) = (errors(c_i)?, work()?, fitted());
    let curve = |closure: Closure| {
        let of = rows.iter().filter(move |row| row.closure == closure.name() && row.flow == FLOWS[0].0);
        Curve::of(closure.name(), of, |row| (row.c_i, row.error))
    };
    let map = ReportFigure::new(
        ["closures-error", "What a closure costs in steady shear"],
        "The largest error of the steady a_ij, Λ = 1. No closure is exact with diffusion; the table has the other \
         flows.",
        ["log C_I", "log largest error of a_ij"],
    )
    .curves(Closure::ALL.map(curve))
    .judged("Folgar & Tucker 1984", STUDY.cases);
    let beside = |closure: Closure| {
        let of = work.iter().filter(move |row| row.method == closure.name());
        Curve::of(closure.name(), of, |row| (1e3 * row.seconds, row.error))
    };
    let price = ReportFigure::new(
        ["closures-work-precision", "Work and precision: closures and the exact solution"],
        "a_ij at strains of 1 to 20 from isotropic rods, shear, C_I = 0.01. Tolerances of 10⁻² to 10⁻⁸ of Dormand & \
         Prince's method; the exact solution with its stated error. Smaller tolerances do not lower the error of a \
         closure.",
        ["log time (ms)", "log largest error of a_ij"],
    )
    .curves(Closure::ALL.map(beside))
    .points([Points::of("exact", &work[..1], |row| (1e3 * row.seconds, row.error))])
    .judged("Folgar & Tucker 1984", STUDY.cases);
    let table = ReportTable::new(
        [STUDY.name, "Steady tensors by closures"],
        "Λ = 1. A closure is left out where no steady state of it was found: the linear one leaves the possible \
         tensors where a flow stretches.",
        rows.iter().copied(),
        vec![
            words("flow", |row: &Off| row.flow),
            field("C_I", |row: &Off| row.c_i),
            words("closure", |row: &Off| row.closure),
            number("a_22", decimals(4), |row: &Off| row.a22),
            number("exact", decimals(4), |row: &Off| row.exact_a22),
            number("largest error of a_ij", powers(1), |row: &Off| row.error),
        ],
    );
    let times = ReportTable::new(
        ["closures-work-precision-times", "Times of closures and of the exact solution"],
        "The shortest of three; on this machine.",
        work.iter().copied(),
        vec![
            words("method", |row: &Work| row.method),
            number("tolerance", powers(0), |row: &Work| row.tolerance),
            number("time (ms)", decimals(2), |row: &Work| 1e3 * row.seconds),
            number("largest error of a_ij", powers(1), |row: &Work| row.error),
        ],
    );
    let through = ReportTable::new(
        ["closures-fitted", "C_I fitted through a closure"],
        "C_I by which the steady a_22 in shear is 0.8261, measured in polycarbonate with 30 % of glass by weight \
         (charlestucker3/Fiber-Orientation-Tools). Closures without one in 10⁻³ to 10⁻¹ are left out.",
        fitted.iter().copied(),
        vec![words("method", |row: &Fitted| row.method), number("C_I", decimals(5), |row: &Fitted| row.c_i)],
    );
    let files = [
        ("closures-fitted.csv", rows_csv(fitted.iter().copied())?),
        ("closures.csv", rows_csv(rows.iter().copied())?),
        ("closures-work-precision.csv", rows_csv(work.iter().copied())?),
        ("closures.json", build::json(&serde_json::json!({ "errors": rows, "work": work, "fitted": fitted }))?),
    ];
    Ok(Some(Findings::new(
        answer(&work, &fitted),
        vec![Exhibit::both(map, table), Exhibit::both(price, times), through.into()],
        files,
    )))
}

fn answer(work: &[Work], fitted: &[Fitted]) -> String {
    let closures = || work[1..].iter();
    let least = closures().map(|row| row.error).fold(f64::INFINITY, f64::min);
    let quickest = closures().map(|row| row.seconds).fold(f64::INFINITY, f64::min);
    let of = |method: &str| fitted.iter().find(|row| row.method == method).map_or(f64::NAN, |row| row.c_i);
    format!(
        "In the start-up of shear at C_I = 0.01 no closure comes nearer to a_ij than {least:.1e}, whatever its \
         tolerance. The quickest takes {:.2} ms, the exact solution {:.0} ms: affordable for single histories, not for \
         each cell of a flow solver. A C_I fitted through a closure is not D_r/γ̇: {:.4} by IBOF where the \
         distribution has {:.4}.",
        1e3 * quickest,
        1e3 * work[0].seconds,
        of("IBOF"),
        of("exact"),
    )
}
