//! What `shearbed fit` says where it is open what the points' uncertainties contain.

use super::json;
use crate::common::{folder, shearbed};
use std::fs;

/// The mean over the rods of one suspension with its standard error, as an experimenter has it.
#[test]
fn the_scatter_of_rods_in_u_is_asked_for_and_its_effect_said() {
    let dir = folder();
    let run = shearbed(
        dir.path(),
        "run small.toml --set interaction.alpha=0.8 --set particles.count=100 --set time.outputs_per_period=20 --seed \
         7 --replicas 1 --out one",
    );
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let mut csv = csv::Reader::from_path(dir.path().join("one/projections.csv")).unwrap();
    let mut text = "t_over_T,x1,x1_u\n".to_owned();
    for row in csv.records().skip(1) {
        let row = row.unwrap();
        text += &format!("{},{},{}\n", &row[0], &row[3], &row[4]);
    }
    fs::write(dir.path().join("points.csv"), text).unwrap();
    let fit = |flags: &str| {
        let done = shearbed(
            dir.path(),
            &format!(
                "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 50 --out fit --force \
                 {flags}"
            ),
        );
        assert_eq!(done.code, Some(0), "{flags}: {}", done.stderr);
        let record = json(&dir.path().join("fit/fit.json"));
        let u = record["parameters"]["interaction.alpha"]["standard_uncertainty"].as_f64().unwrap();
        (done.stderr.split_whitespace().collect::<Vec<_>>().join(" "), u)
    };
    let (unsaid, taken) = fit("");
    let (independent, least) = fit("--u-contains reading");
    let (said, right) = fit("--rods 100 --u-contains rods");
    let (twice, most) = fit("--rods 100");
    for named in [
        "--rods is not given, so the points count as independent: alpha = ",
        "if u contains that scatter, which by the residuals is ",
        "if u is the reading alone, and as many rods as the scene has were measured: alpha = ",
        "Give --rods N if u is the reading alone",
    ] {
        assert!(unsaid.contains(named), "{unsaid}");
    }
    assert!(twice.contains("times the scatter of 100 rods, but counts as the error of reading alone"), "{twice}");
    assert!(!independent.contains("u is") && !said.contains("u is"), "{independent}\n{said}");
    // What moves all points together is not averaged away by their number.
    assert!(1.5 * least < right && 1.5 * least < most && least == taken, "{least} {taken} {right} {most}");
    let (small, _) = fit("--rods 10 --u-contains rods");
    assert!(small.contains("times the scatter of 10 rods, and cannot contain it"), "{small}");
    let refused = shearbed(
        dir.path(),
        "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --u-contains rods --out no",
    );
    assert!(refused.code == Some(2) && refused.stderr.contains("--rods <N>"), "{}", refused.stderr);
}
