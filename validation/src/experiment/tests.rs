use super::*;
use crate::scenes;
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

fn curves(provenance: &str, points: impl AsRef<[u8]>) -> Vec<Curve> {
    read(folder(provenance, points).path(), &OKAGAWA_MASON).unwrap()
}

/// The refusal, without the folders before the file's name.
fn refusal(provenance: &str, points: impl AsRef<[u8]>) -> String {
    let dir = folder(provenance, points);
    let error = check(dir.path()).unwrap_err().to_string();
    let start = dir.path().join(OKAGAWA_MASON.folder).display().to_string();
    error.replace(&format!("{start}/"), "")
}

fn xy(curve: &Curve) -> Vec<(f64, f64)> {
    curve.points.iter().map(|point| (point.x, point.y)).collect()
}

#[test]
fn columns_are_sorted_and_a_point_may_have_its_own_uncertainty() {
    let found = curves(PROVENANCE, POINTS);
    assert_eq!(found.len(), 1);
    assert_eq!(xy(&found[0]), [(0.25, 0.1), (0.5, 0.4), (1.5, 0.3)]);
    let u: Vec<_> = found[0]
        .points
        .iter()
        .map(|point| (point.u_x, point.u_y))
        .collect();
    assert_eq!(u, [(0.01, 0.002), (0.01, 0.005), (0.01, 0.005)]);
    assert_eq!(found[0].points[0].label, "Okagawa & Mason (1973), Fig. S");
    assert_eq!(found[0].provenance.tool, "none");
}

#[test]
fn several_columns_may_have_blanks() {
    let three = PROVENANCE.to_owned() + "[[curve]]\nscene = \"fig4-n50\"\nobservable = \"x3\"\n";
    let found = curves(
        &three,
        "\u{feff}x3,t_over_T,x1,t_over_T_u\r\n0.2,0.5,,0.02\r\n0.3,0.6,0.4,\r\n",
    );
    assert_eq!(xy(&found[0]), [(0.6, 0.4)]);
    assert_eq!(xy(&found[1]), [(0.5, 0.2), (0.6, 0.3)]);
    assert_eq!(
        (found[1].channel, found[1].points[0].u_x, found[1].points[1].u_x),
        (2, 0.02, 0.01)
    );
}

#[test]
fn units_are_turned_into_the_models() {
    let scene = scenes::find("fig4-n50").unwrap().scene().unwrap();
    let r = scene.particles.aspect_ratio;
    // T = 2π(r_e + 1/r_e)/G, eq. 15.
    let strain = 2.0 * std::f64::consts::PI * (r + 1.0 / r);
    let with = |x: &str, calibration: &str| {
        PROVENANCE
            .replace(
                "quantity = \"t_over_T\"\ncalibration = [0, 2]",
                &format!("{x}\ncalibration = {calibration}"),
            )
            .replace("\"fraction\"", "\"mm\"")
    };
    let in_seconds = with("quantity = \"t_s\"\nshear_rate_per_s = 0.25", "[0, 600]");
    let point = &curves(&in_seconds, "t_s,x1_mm\n100,0.36\n")[0].points[0];
    assert_relative_eq!(point.x, 100.0 * 0.25 / strain, max_relative = 1e-12);
    assert_relative_eq!(point.u_x, 0.01 * 0.25 / strain, max_relative = 1e-12);
    assert_relative_eq!(point.y, 0.5, max_relative = 1e-12);
    assert_relative_eq!(point.u_y, 0.005 / 0.72, max_relative = 1e-12);
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
    let found = curves(
        &two,
        "n = 100,,n = 50,\nX,Y,X,Y\n0.1,0.2,0.5,0.4\n0.3,0.4,,\n0.2,0.3\n",
    );
    assert_eq!((found[0].scene, xy(&found[0])), ("fig4-n50", vec![(0.5, 0.4)]));
    assert_eq!(found[1].scene, "fig4-n100");
    assert_eq!(xy(&found[1]), [(0.1, 0.2), (0.2, 0.3), (0.3, 0.4)]);
}

#[test]
fn bad_points_are_refused_with_their_line() {
    for (points, expected) in [
        ("", "a.csv:1: the file is empty"),
        (" \n\n", "a.csv:1: the file is empty"),
        ("t_over_T,x1\n", "a.csv:1: `x1` has no points"),
        (
            "t_over_T,x1\n0.5,0.4\n0.6,0.3O\n",
            "a.csv:3: column x1: `0.3O` is not allowed: a finite number",
        ),
        (
            "t_over_T,x1\n0.5,NaN\n",
            "a.csv:2: column x1: `NaN` is not allowed",
        ),
        (
            "t_over_T,x1\ninf,0.4\n",
            "a.csv:2: column t_over_T: `inf` is not allowed",
        ),
        (
            "t_over_T,x1\n,0.4\n",
            "a.csv:2: column t_over_T: `` is not allowed",
        ),
        ("t_over_T,x1\n0.5\n", "a.csv:2: 1 cells; the header has 2"),
        (
            "t_over_T,x2\n0.5,0.4\n",
            "a.csv:1: column `x2` is not in the provenance file: there are t_over_T",
        ),
        (
            "t,x1\n0.5,0.4\n",
            "a.csv:1: column `t` is not in the provenance file",
        ),
        (
            "t_over_T,x1,x1\n0.5,0.4,0.4\n",
            "a.csv:1: column `x1` is there twice",
        ),
        ("x1\n0.4\n", "a.csv:1: column t_over_T is missing"),
        ("t_over_T,x1_u\n0.5,0.1\n", "a.csv:1: column x1 is missing"),
        (
            "t_over_T,x1,x1_u\n0.5,0.4,0\n",
            "a.csv:2: column x1_u: `0` is not allowed: one standard deviation",
        ),
        (
            "t_over_T,x1,x1_u\n0.5,0.4,-0.1\n",
            "a.csv:2: column x1_u: `-0.1` is not allowed",
        ),
        (
            "t_over_T,x1\n0.5,0.4\n2.1,0.3\n",
            "a.csv:3: x = 2.1 is not allowed: the axis is calibrated from 0 to 2",
        ),
        (
            "t_over_T,x1\n0.5,0.7\n",
            "a.csv:2: y = 0.7 is not allowed: the axis is calibrated from 0 to 0.6",
        ),
        (
            "t_over_T,x1\n0.5,0.4\n1,0.3\n\n0.5,0.4\n",
            "a.csv:5: the point (0.5, 0.4) is in line 2 already",
        ),
    ] {
        let found = refusal(PROVENANCE, points);
        assert!(found.starts_with(expected), "{points:?}: {found}");
    }
    let found = refusal(PROVENANCE, b"t_over_T,x1\n0.5,0.4\n0.6,\xff\n");
    assert!(found.starts_with("a.csv:3: not a text in UTF-8"), "{found}");
}

#[test]
fn bad_exports_are_refused_with_their_line() {
    let one = PROVENANCE.replace("csv = \"columns\"", EXPORT);
    for (points, expected) in [
        ("0.5,0.4\n0.6\n", "a.csv:2: column  Y: `` is not allowed"),
        (
            "0.5,0.4,0.1\n",
            "a.csv:1: 3 cells; two for each dataset are allowed: 2",
        ),
        ("0.5;0.4\n", "a.csv:1: column  X: `0.5;0.4` is not allowed"),
        (
            "a,,b,\nX,Y,X,Y\n0.5,0.4,0.6,0.3\n",
            "a.csv:1: 2 datasets (`a`, `b`); the provenance file has 1 [[curve]]",
        ),
        (
            "a,,a,\nX,Y,X,Y\n0.5,0.4,0.6,0.3\n",
            "a.csv:1: dataset `a` is there twice",
        ),
        (
            "a,\nX,Y,X\n0.5,0.4,0.6\n",
            "a.csv:1: 2 cells of names over 3 of X, Y",
        ),
        ("a,\nX,Y\n0.5,\n", "a.csv:3: column a Y: `` is not allowed"),
    ] {
        let found = refusal(&one, points);
        assert!(found.starts_with(expected), "{points:?}: {found}");
    }
    let named = one + "dataset = \"c\"\n";
    let found = refusal(&named, "a,\nX,Y\n0.5,0.4\n");
    assert!(
        found.starts_with("a.toml:17: curve.dataset = c is not allowed"),
        "{found}"
    );
}

#[test]
fn bad_provenance_is_refused_with_its_line() {
    for (before, after, expected) in [
        (
            "\"fraction\"",
            "\"a\"",
            "a.toml:12: y.quantity = \"a\" is not allowed: \"fraction\"",
        ),
        (
            "quantity = \"t_over_T\"\n",
            "",
            "a.toml:7: x.quantity is missing: \"t_over_T\"",
        ),
        (
            "quantity = \"fraction\"\n",
            "",
            "a.toml:11: y.quantity is missing",
        ),
        (
            "quantity = \"t_over_T\"",
            "quantity = \"t_s\"",
            "a.toml:7: x.shear_rate_per_s is missing",
        ),
        (
            "uncertainty = 0.01",
            "uncertainty = 0",
            "a.toml:10: x.standard_uncertainty = 0 is not allowed: one standard",
        ),
        (
            "uncertainty = 0.005",
            "uncertainty = -0.1",
            "a.toml:14: y.standard_uncertainty = -0.1 is not allowed",
        ),
        (
            "uncertainty = 0.005",
            "uncertainty = nan",
            "a.toml:14: y.standard_uncertainty = nan is not allowed",
        ),
        (
            "standard_uncertainty = 0.005\n",
            "",
            "a.toml:11: y.standard_uncertainty is missing",
        ),
        (
            "standard_uncertainty = 0.01\n",
            "",
            "a.toml:7: x.standard_uncertainty is missing",
        ),
        ("[0, 2]", "[2]", "a.toml:9: x.calibration = [2] is not allowed"),
        (
            "[0, 2]",
            "[1, 1.0]",
            "a.toml:9: x.calibration = [1, 1.0] is not allowed",
        ),
        (
            "\"fig4-n50\"",
            "\"fig4\"",
            "a.toml:16: curve.scene = \"fig4\" is not allowed: a scene of okagawa-mason-1973",
        ),
        (
            "\"fig4-n50\"",
            "\"fig5\"",
            "a.toml:16: curve.scene = \"fig5\" is not allowed",
        ),
        (
            "\"x1\"",
            "\"x4\"",
            "a.toml:17: curve.observable = \"x4\" is not allowed: \"x1\"",
        ),
        (
            "observable = \"x1\"",
            "dataset = \"x1\"\nobservable = \"x1\"",
            "a.toml:17: curve.dataset = \"x1\" is not allowed",
        ),
        (
            "\"2000-01-01\"",
            "\"yesterday\"",
            "a.toml:5: date = \"yesterday\" is not allowed",
        ),
        (
            "\"a test\"",
            "\" \"",
            "a.toml:3: digitised_by = \" \" is not allowed",
        ),
        ("tool = \"none\"\n", "", "a.toml:1: tool is missing"),
        (
            "\"columns\"",
            "\"excel\"",
            "a.toml:6: csv = \"excel\" is not allowed",
        ),
        (
            "[x]",
            "rods = 0\n[x]",
            "a.toml:7: rods = 0 is not allowed: a whole number ≥ 1",
        ),
        ("[x]", "colour = 1\n[x]", "a.toml:7: colour is no key here"),
        (
            "[[curve]]",
            "[inputs]\nalpha = 0\n[[curve]]",
            "a.toml:16: inputs.alpha = 0 is not allowed",
        ),
        (
            "[[curve]]",
            "[inputs]\nbeta = 1\n[[curve]]",
            "a.toml:16: inputs.beta is no key here",
        ),
        ("[x]", "[x", "a.toml:7: "),
    ] {
        assert!(PROVENANCE.contains(before), "{before}");
        let found = refusal(&PROVENANCE.replacen(before, after, 1), POINTS);
        assert!(found.starts_with(expected), "{after:?}: {found}");
    }
    let none = PROVENANCE.split("[[curve]]").next().unwrap();
    assert!(refusal(none, POINTS).starts_with("a.toml:1: curve is missing"));
}

#[test]
fn files_come_in_pairs_and_in_known_folders() {
    let dir = folder(PROVENANCE, POINTS);
    let source = dir.path().join(OKAGAWA_MASON.folder);
    let says = |part: &str| {
        let error = check(dir.path()).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    };
    fs::write(source.join("b.toml"), PROVENANCE).unwrap();
    says("b.toml: it has no ");
    fs::write(source.join("b.csv"), POINTS).unwrap();
    says("b.toml: x1 of fig4-n50 is in another file already");
    fs::remove_file(source.join("b.toml")).unwrap();
    says("b.csv: it has no provenance file");
    fs::rename(source.join("b.csv"), dir.path().join("b.csv")).unwrap();
    says("b.csv: no source has this folder; there are okagawa-mason-1973");
    fs::create_dir(dir.path().join("okagawa")).unwrap();
    fs::rename(dir.path().join("b.csv"), dir.path().join("okagawa/b.csv")).unwrap();
    says("b.csv: no source has this folder");
    fs::remove_file(dir.path().join("okagawa/b.csv")).unwrap();
    assert_eq!(check(dir.path()), Ok(()));
}

#[test]
fn the_scenes_of_every_source_are_there() {
    for scene in SOURCES.iter().flat_map(|source| source.scenes) {
        let scene = scenes::find(scene).unwrap().scene().unwrap();
        assert!(scene.interaction.is_some() && scene.flow.shear_rate_per_s.is_some());
    }
}
