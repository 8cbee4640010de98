use super::{EXPORT, POINTS, PROVENANCE, refusal};

#[test]
fn bad_points_are_refused_with_their_line() {
    for (points, expected) in [
        ("", "a.csv:1: the file is empty"),
        (" \n\n", "a.csv:1: the file is empty"),
        ("t_over_T,x1\n", "a.csv:1: `x1` has no points"),
        ("t_over_T,x1\n0.5,0.4\n0.6,0.3O\n", "a.csv:3: column x1: `0.3O` is not allowed: expected a finite number"),
        ("t_over_T,x1\n0.5,NaN\n", "a.csv:2: column x1: `NaN` is not allowed"),
        ("t_over_T,x1\ninf,0.4\n", "a.csv:2: column t_over_T: `inf` is not allowed"),
        ("t_over_T,x1\n,0.4\n", "a.csv:2: column t_over_T: `` is not allowed"),
        ("t_over_T,x1\n0.5\n", "a.csv:2: 1 cells; the header has 2"),
        ("t_over_T,x2\n0.5,0.4\n", "a.csv:1: column `x2` is not in the provenance file: there are t_over_T"),
        ("t,x1\n0.5,0.4\n", "a.csv:1: column `t` is not in the provenance file"),
        ("t_over_T,x1,x1\n0.5,0.4,0.4\n", "a.csv:1: column `x1` is there twice"),
        ("x1\n0.4\n", "a.csv:1: column t_over_T is missing"),
        ("t_over_T,x1_u\n0.5,0.1\n", "a.csv:1: column x1 is missing"),
        ("t_over_T,x1,x1_u\n0.5,0.4,0\n", "a.csv:2: column x1_u: `0` is not allowed: expected one standard deviation"),
        ("t_over_T,x1,x1_u\n0.5,0.4,-0.1\n", "a.csv:2: column x1_u: `-0.1` is not allowed"),
        (
            "t_over_T,x1,x1_u\n0.5,0.4,1e300\n",
            "a.csv:2: column x1_u: `1e300` is not allowed: expected one standard deviation from 6e-13 to 0.6, the \
             width of the axis",
        ),
        ("t_over_T,x1,x1_u\n0.5,0.4,1e-300\n", "a.csv:2: column x1_u: `1e-300` is not allowed"),
        ("t_over_T,x1\n0.5,0.4\n2.1,0.3\n", "a.csv:3: x = 2.1 is not allowed: the axis is calibrated from 0 to 2"),
        ("t_over_T,x1\n0.5,0.7\n", "a.csv:2: y = 0.7 is not allowed: the axis is calibrated from 0 to 0.6"),
        ("t_over_T,x1\n0.5,0.4\n1,0.3\n\n0.5,0.4\n", "a.csv:5: the point (0.5, 0.4) is in line 2 already"),
    ] {
        let found = refusal(PROVENANCE, points);
        assert!(found.starts_with(expected), "{points:?}: {found}");
    }
    let found = refusal(PROVENANCE, b"t_over_T,x1\n0.5,0.4\n0.6,\xff\n");
    assert!(found.starts_with("a.csv: cannot be read: it is not UTF-8 text (line 3)"), "{found}");
}

#[test]
fn what_would_run_for_long_is_refused() {
    // In t/T, a quarter of a period is 0.25.
    let own = |u: &str| format!("t_over_T,x1,t_over_T_u\n0.4,0.3,0.25\n0.5,0.4,{u}\n");
    let found = refusal(PROVENANCE, own("0.26"));
    let expected =
        "a.csv:3: column t_over_T_u: `0.26` is not allowed: expected one standard deviation of at most a quarter";
    assert!(found.starts_with(expected), "{found}");
    let vague = PROVENANCE.replace("standard_uncertainty = 0.01", "standard_uncertainty = 1");
    let found = refusal(&vague, super::POINTS);
    assert!(found.starts_with("a.toml: x.standard_uncertainty = 1 is not allowed"), "{found}");
    let many: String = (0..20_000).map(|k| format!("{},0.3\n", f64::from(k) * 1e-4)).collect();
    let found = refusal(PROVENANCE, format!("t_over_T,x1\n{many}"));
    assert!(found.starts_with("a.csv:20001: more than 20000 lines"), "{found}");
}

#[test]
fn bad_exports_are_refused_with_their_line() {
    let one = PROVENANCE.replace("csv = \"columns\"", EXPORT);
    for (points, expected) in [
        ("0.5,0.4\n0.6\n", "a.csv:2: column  Y: `` is not allowed"),
        ("0.5,0.4,0.1\n", "a.csv:1: 3 cells; two for each dataset are allowed: 2"),
        ("0.5;0.4\n", "a.csv:1: cells are separated by semicolons; commas between cells and points"),
        ("a,,b,\nX,Y,X,Y\n0.5,0.4,0.6,0.3\n", "a.csv:1: 2 datasets (`a`, `b`); the provenance file has 1 [[curve]]"),
        ("a,,a,\nX,Y,X,Y\n0.5,0.4,0.6,0.3\n", "a.csv:1: dataset `a` is there twice"),
        ("a,\nX,Y,X\n0.5,0.4,0.6\n", "a.csv:1: 2 cells of names over 3 of X, Y"),
        ("a,\nX,Y\n0.5,\n", "a.csv:3: column a Y: `` is not allowed"),
    ] {
        let found = refusal(&one, points);
        assert!(found.starts_with(expected), "{points:?}: {found}");
    }
    let named = one + "dataset = \"c\"\n";
    let found = refusal(&named, "a,\nX,Y\n0.5,0.4\n");
    assert!(found.starts_with("a.toml:17: curve.dataset = c is not allowed"), "{found}");
}

#[test]
fn bad_provenance_is_refused_with_its_line() {
    for (before, after, expected) in [
        (
            "csv = \"columns\"",
            "csv = \"columns\"\naspect_ratio = 3.96",
            "a.toml:7: aspect_ratio = 3.96 is not allowed: expected the mean r_e of the measured rods, 11.6 in \
             fig4-n50; the paper leaves",
        ),
        ("\"fraction\"", "\"a\"", "a.toml:12: y.quantity = \"a\" is not allowed: expected \"fraction\""),
        ("quantity = \"t_over_T\"\n", "", "a.toml:7: x.quantity is missing: expected \"t_over_T\""),
        ("quantity = \"fraction\"\n", "", "a.toml:11: y.quantity is missing"),
        ("quantity = \"t_over_T\"", "quantity = \"t_s\"", "a.toml:7: x.shear_rate_per_s is missing"),
        (
            "uncertainty = 0.01",
            "uncertainty = 0",
            "a.toml:10: x.standard_uncertainty = 0 is not allowed: expected one standard",
        ),
        ("uncertainty = 0.005", "uncertainty = -0.1", "a.toml:14: y.standard_uncertainty = -0.1 is not allowed"),
        ("uncertainty = 0.005", "uncertainty = nan", "a.toml:14: y.standard_uncertainty = nan is not allowed"),
        ("standard_uncertainty = 0.005\n", "", "a.toml:11: y.standard_uncertainty is missing"),
        ("standard_uncertainty = 0.01\n", "", "a.toml:7: x.standard_uncertainty is missing"),
        ("[0, 2]", "[2]", "a.toml:9: x.calibration = [2] is not allowed"),
        ("[0, 2]", "[1, 1.0]", "a.toml:9: x.calibration = [1, 1.0] is not allowed"),
        (
            "\"fig4-n50\"",
            "\"fig4\"",
            "a.toml:16: curve.scene = \"fig4\" is not allowed: expected a scene of okagawa-mason-1973",
        ),
        ("\"fig4-n50\"", "\"fig5\"", "a.toml:16: curve.scene = \"fig5\" is not allowed"),
        ("\"x1\"", "\"x4\"", "a.toml:17: curve.observable = \"x4\" is not allowed: expected \"x1\""),
        (
            "observable = \"x1\"",
            "dataset = \"x1\"\nobservable = \"x1\"",
            "a.toml:17: curve.dataset = \"x1\" is not allowed",
        ),
        ("\"2000-01-01\"", "\"yesterday\"", "a.toml:5: date = \"yesterday\" is not allowed"),
        ("\"a test\"", "\" \"", "a.toml:3: digitised_by = \" \" is not allowed"),
        ("tool = \"none\"\n", "", "a.toml:1: tool is missing"),
        ("\"columns\"", "\"excel\"", "a.toml:6: csv = \"excel\" is not allowed"),
        ("[x]", "rods = 0\n[x]", "a.toml:7: rods = 0 is not allowed: expected a whole number ≥ 1"),
        ("[x]", "colour = 1\n[x]", "a.toml:7: colour is an unknown key"),
        ("[[curve]]", "[inputs]\nalpha = 0\n[[curve]]", "a.toml:16: inputs.alpha = 0 is not allowed"),
        (
            "= 0.005",
            "= 1e300",
            "a.toml:14: y.standard_uncertainty = 1e300 is not allowed: expected one standard deviation",
        ),
        ("= 0.005", "= 1e-300", "a.toml:14: y.standard_uncertainty = 1e-300 is not allowed"),
        ("[[curve]]", "[inputs]\nalpha = 1e300\n[[curve]]", "a.toml:16: inputs.alpha = 1e300 is not allowed"),
        ("[[curve]]", "[inputs]\nbeta = 1\n[[curve]]", "a.toml:16: inputs.beta is an unknown key"),
        ("[x]", "[x", "a.toml:7: "),
    ] {
        assert!(PROVENANCE.contains(before), "{before}");
        let found = refusal(&PROVENANCE.replacen(before, after, 1), POINTS);
        assert!(found.starts_with(expected), "{after:?}: {found}");
    }
    let none = PROVENANCE.split("[[curve]]").next().unwrap();
    assert!(refusal(none, POINTS).starts_with("a.toml:1: curve is missing"));
}
