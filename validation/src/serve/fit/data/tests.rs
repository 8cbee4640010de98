use super::*;
use std::fs;

fn read_of(text: &str) -> Result<Points, String> {
    read_as(text, &Reading::default())
}

fn read_as(text: &str, reading: &Reading) -> Result<Points, String> {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("points.csv");
    fs::write(&path, text).unwrap();
    read(&path, 3, reading).map_err(|error| error.to_string())
}

#[test]
fn points_are_read_column_by_column_with_blanks_left_out() {
    let found = read_of("t_over_T,t_over_T_u,x1,x1_u,x3,x3_u\n0,,0.5,0.01,,\n0.5,0.02,0.4,0.02,0.6,0.03\n").unwrap();
    assert_eq!(found.time, TimeColumn::Periods);
    let short: Vec<_> =
        (found.points.iter()).map(|p| (p.line, p.column.as_str(), p.time, p.u_time, p.value, p.u)).collect();
    let expected = [(2, "x1", 0.0, 0.0, 0.5, 0.01), (3, "x1", 0.5, 0.02, 0.4, 0.02), (3, "x3", 0.5, 0.02, 0.6, 0.03)];
    assert_eq!(short, expected);
    assert!(found.points.iter().all(|point| point.set == 3));
    assert_eq!(read_of("strain,phi,phi_u\n1,0.7,0.1\n").unwrap().time, TimeColumn::Strain);
}

/// Names of one's own, with or without a header, and one uncertainty for all points, say what the same columns in
/// the file would.
#[test]
fn names_and_an_uncertainty_can_be_given_beside_the_file() {
    let reading = |names: &str, u: Option<f64>| {
        let columns = (!names.is_empty()).then(|| names.split(',').map(str::to_owned).collect());
        Reading { columns, u, without_u: false }
    };
    let expected = read_of("t_s,x1,x1_u\n1,0.5,0.02\n2,0.4,0.02\n").unwrap();
    assert_eq!(expected.u_column.as_deref(), Some("x1_u"));
    for (text, names, u) in [
        ("t_s,x1\n1,0.5\n2,0.4\n", "", Some(0.02)),
        ("time,X,X\n1,0.5,7\n2,0.4,8\n", "t_s,x1,-", Some(0.02)),
        ("run,time,X,T,s\na,1,0.5,20,0.02\nb,2,0.4,21,0.02\n", "-,t_s,x1,-,x1_u", None),
    ] {
        let found = read_as(text, &reading(names, u)).unwrap();
        assert_eq!((&found.points, found.u_column.is_some()), (&expected.points, u.is_none()), "{text}");
    }
    // Without a header, the first point is in the first line.
    let found = read_as("0.5,0.5,1\n0.5,0.4,2\n", &reading("-,x1,t_s", Some(0.02))).unwrap();
    assert!(found.points.iter().zip(&expected.points).all(|(a, b)| a.line + 1 == b.line && a.value == b.value));
    for (text, names, u, expected) in [
        ("a,b,c\n1,2,3\n", "t_s,x1", None, "points.csv:1: 3 cells where 2 columns are named"),
        ("a,b\n1,2\n", "t_s,x4", None, "column `x4` is not allowed"),
        ("a,b,c\n1,2,3\n", "t_s,x1,x1", Some(0.1), "column `x1` is there twice"),
        ("t_s,x1\n1,0.5\n", "", Some(1.5), "points.csv:2: column x1, its uncertainty: `1.5` is not allowed"),
        ("t_s,-\n1,0.5\n", "", Some(0.1), "no column of measured values among t_s, -"),
    ] {
        let error = read_as(text, &reading(names, u)).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
}

/// What the program writes can be fitted.
#[test]
fn every_column_can_have_the_values_of_its_observable() {
    for text in ["cos_2phi,cos_2phi_u\n0,-0.8,0.1", "n1_pa,n1_pa_u\n0,-3e4,0.1", "s12_pa,s12_pa_u\n0,1e5,0.1"] {
        assert_eq!(read_of(&format!("t_s,{text}\n")).unwrap().points.len(), 1);
    }
    for name in shearbed::Observable::ALL.iter().flat_map(|observable| observable.channels()).map(Channel::name) {
        let [least, most] = allowed(&name);
        assert!(least < most && least.is_finite() && most.is_finite(), "{name}");
    }
}

/// What spreadsheets, instruments and numpy write says the same as the plain file.
#[test]
fn files_of_other_programs_are_the_plain_file() {
    let plain = read_of("t_s,x1,x1_u\n1.5,0.5,0.125\n2,0.25,0.125\n").unwrap().points;
    for text in [
        "t_s;x1;x1_u\n1,5;0,5;0,125\n2;0,25;0,125\n;;\n",
        "# t_s,x1,x1_u\n1.5,0.5,0.125\n2,0.25,0.125\n",
        "t_s,x1,x1_u\n1.5,0.5,0.125\n# a pause\n1.7,NaN,NaN\n#N/A,,\n1.8,,\n2,0.25,0.125\n",
        "\"t_s\",\"x1_percent\",\"x1_percent_u\"\n1.5,50,12.5\n2,25,12.5\n",
        "t_s,temperature_C,x1,x1_u,note\n1.5,20,0.5,0.125,a\n2,21,0.25,0.125,b\n",
    ] {
        let found = read_of(text).unwrap();
        let of = |points: &[Datum]| points.iter().map(|p| (p.time, p.column.clone(), p.value, p.u)).collect::<Vec<_>>();
        assert_eq!(of(&found.points), of(&plain), "{text}");
        assert_eq!(found.unread.len(), 2 * usize::from(text.contains("note")), "{text}");
    }
    for time in ["", "#N/A"] {
        let refused = read_of(&format!("t_s,x1,x1_u\n1.5,0.5,0.125\n{time},0.25,0.125\n")).unwrap_err().to_string();
        assert!(refused.contains(":3: column t_s: a measured value without a time"), "{refused}");
    }
}
