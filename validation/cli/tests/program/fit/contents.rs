//! What `shearbed fit` says where it is open what the points' uncertainties contain.

use crate::common::folder;

/// The mean over the rods of one suspension with its standard error, as an experimenter has it.
#[test]
fn the_scatter_of_rods_in_u_is_asked_for_and_its_effect_said() {
    let dir = folder();
    let set = "--set interaction.alpha=0.8 --set particles.count=100 --set time.outputs_per_period=20";
    dir.runs(&format!("run small.toml {set} --seed 7 --replicas 1 --out one"));
    let mut csv = csv::Reader::from_path(dir.at("one/projections.csv")).unwrap();
    let mut text = "t_over_T,x1,x1_u\n".to_owned();
    for row in csv.records().skip(1) {
        let row = row.unwrap();
        text += &format!("{},{},{}\n", &row[0], &row[3], &row[4]);
    }
    dir.write("points.csv", text);
    let fit = |flags: &str| {
        let fit = "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 50";
        let done = dir.runs(&format!("{fit} --out fit --force {flags}"));
        let record = dir.json("fit/fit.json");
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
}
