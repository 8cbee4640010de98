use super::*;
use crate::input::scenes;
use approx::assert_relative_eq;
use std::fs;
use tempfile::TempDir;

const PROVENANCE: &str = r#"paper = "synthetic"
figure = "Fig. S"
digitised_by = "a test"
tool = "none"
date = "2000-01-01"
csv = "columns"
[x]
quantity = "t_over_T"
calibration = [0, 2]
standard_uncertainty = 0.01
[y]
quantity = "fraction"
calibration = [0.0, 0.6]
standard_uncertainty = 0.005
[[curve]]
scene = "fig4-n50"
observable = "x1"
"#;

const EXPORT: &str = "csv = \"webplotdigitizer\"";

const POINTS: &str = "t_over_T,x1,x1_u\n0.5,0.4,\n0.25,0.1,0.002\n1.5,0.3,\n";

fn folder(provenance: &str, points: impl AsRef<[u8]>) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let source = dir.path().join(OKAGAWA_MASON.folder);
    fs::create_dir(&source).unwrap();
    fs::write(source.join("a.toml"), provenance).unwrap();
    fs::write(source.join("a.csv"), points).unwrap();
    dir
}

fn curves(provenance: &str, points: impl AsRef<[u8]>) -> Vec<MeasuredCurve> {
    read(folder(provenance, points).path(), &OKAGAWA_MASON).unwrap()
}

fn xy(curve: &MeasuredCurve) -> Vec<(f64, f64)> {
    curve.points.iter().map(|point| (point.x, point.y)).collect()
}

#[test]
fn the_measured_rods_may_be_stated_to_be_the_scenes() {
    let stated = PROVENANCE.replace("csv = \"columns\"", "csv = \"columns\"\naspect_ratio = 11.6");
    assert_eq!(curves(&stated, POINTS)[0].points, curves(PROVENANCE, POINTS)[0].points);
}

#[test]
fn columns_are_sorted_and_a_point_may_have_its_own_uncertainty() {
    let found = curves(PROVENANCE, POINTS);
    assert_eq!(found.len(), 1);
    assert_eq!(xy(&found[0]), [(0.25, 0.1), (0.5, 0.4), (1.5, 0.3)]);
    let u: Vec<_> = found[0].points.iter().map(|point| (point.u_x, point.u_y)).collect();
    assert_eq!(u, [(0.01, 0.002), (0.01, 0.005), (0.01, 0.005)]);
    assert_eq!(found[0].points[0].label, "“synthetic”, Fig. S");
}

#[test]
fn several_columns_may_have_blanks() {
    let three = PROVENANCE.to_owned() + "[[curve]]\nscene = \"fig4-n50\"\nobservable = \"x3\"\n";
    let found = curves(&three, "\u{feff}x3,t_over_T,x1,t_over_T_u\r\n0.2,0.5,,0.02\r\n0.3,0.6,0.4,\r\n");
    assert_eq!(xy(&found[0]), [(0.6, 0.4)]);
    assert_eq!(xy(&found[1]), [(0.5, 0.2), (0.6, 0.3)]);
    assert_eq!((found[1].channel, found[1].points[0].u_x, found[1].points[1].u_x), (2, 0.02, 0.01));
}

#[test]
fn other_columns_are_named_and_not_read() {
    let with = folder(PROVENANCE, "t_over_T,x2,x1,note\n0.5,0.3,0.4,a\n");
    assert_eq!(
        read(with.path(), &OKAGAWA_MASON).unwrap()[0].points,
        curves(PROVENANCE, "t_over_T,x1\n0.5,0.4\n")[0].points
    );
    let warnings = check(with.path()).unwrap();
    assert!(warnings[0].ends_with("a.csv: not read: x2, note") && warnings.len() == 1, "{warnings:?}");
    let error = check(folder(PROVENANCE, "t_over_T,x1,x1_se\n0.5,0.4,0.1\n").path()).unwrap_err();
    assert!(error.to_string().contains("`x1_se`"), "{error}");
}

#[test]
fn units_are_turned_into_the_models() {
    let scene = scenes::find("fig4-n50").unwrap().scene().unwrap();
    let r = scene.particles.aspect_ratio;
    // T = 2π(r_e + 1/r_e)/G, eq. 15.
    let strain = 2.0 * std::f64::consts::PI * (r + 1.0 / r);
    let with = |x: &str, calibration: &str| {
        PROVENANCE
            .replace("quantity = \"t_over_T\"\ncalibration = [0, 2]", &format!("{x}\ncalibration = {calibration}"))
            .replace("\"fraction\"", "\"mm\"")
    };
    let in_seconds = with("quantity = \"t_s\"\nshear_rate_per_s = 0.25", "[0, 600]");
    let point = &curves(&in_seconds, "t_s,x1_mm\n100,0.36\n")[0].points[0];
    assert_relative_eq!(point.x, 100.0 * 0.25 / strain, max_relative = 1e-12);
    assert_relative_eq!(point.u_x, 0.01 * 0.25 / strain, max_relative = 1e-12);
    assert_relative_eq!(point.y, 0.5, max_relative = 1e-12);
    assert_relative_eq!(point.u_y, 0.005 / 0.72, max_relative = 1e-12);
    let in_percent = PROVENANCE.replace("\"fraction\"", "\"percent\"").replace("[0.0, 0.6]", "[0, 60]");
    let point = &curves(&in_percent, "t_over_T,x1_percent,x1_percent_u\n0.5,40,2\n")[0].points[0];
    assert_eq!((point.y, point.u_y), (0.4, 0.02));
    let in_strain = with("quantity = \"strain\"", "[0, 150]");
    let point = &curves(&in_strain, "strain,x1_mm\n100,0.36\n")[0].points[0];
    assert_relative_eq!(point.x, 100.0 / strain, max_relative = 1e-12);
}

#[test]
fn exports_of_webplotdigitizer_are_read() {
    let one = PROVENANCE.replace("csv = \"columns\"", EXPORT);
    let found = curves(&one, "0.5, 0.4\n0.25, 1e-1\n");
    assert_eq!(xy(&found[0]), [(0.25, 0.1), (0.5, 0.4)]);
    let two = one.clone()
        + "dataset = \"n = 50\"\n[[curve]]\nscene = \"fig4-n100\"\nobservable = \"x1\"\ndataset = \"n = 100\"\n";
    let found = curves(&two, "n = 100,,n = 50,\nX,Y,X,Y\n0.1,0.2,0.5,0.4\n0.3,0.4,,\n0.2,0.3\n");
    assert_eq!((found[0].scene, xy(&found[0])), ("fig4-n50", vec![(0.5, 0.4)]));
    assert_eq!(found[1].scene, "fig4-n100");
    assert_eq!(xy(&found[1]), [(0.1, 0.2), (0.2, 0.3), (0.3, 0.4)]);
}

#[test]
fn the_scenes_of_every_source_are_there() {
    for scene in SOURCES.iter().flat_map(|source| source.scenes) {
        let scene = scenes::find(scene).unwrap().scene().unwrap();
        assert!(scene.interaction.is_some() && scene.flow.shear_rate_per_s().is_some());
    }
}
