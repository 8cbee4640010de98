use super::*;

#[test]
fn a_column_is_declared_once_and_written_everywhere() {
    type Row = (u64, Option<f64>);
    let table = ReportTable::new(
        ["synthetic", "Synthetic"],
        "What to see.",
        [(1u64, Some(0.1 + 0.2)), (2, None)],
        vec![
            field("n", |r: &Row| r.0),
            number("x (s)", |x| format!("{x:.1}"), |r: &Row| r.1),
            estimate("y", |r: &Row| r.1.map(|x| (2.0, x))),
            difference("less", |r: &Row| r.1.map(|x| (-2.0, x))),
            words("said", |r: &Row| if r.0 == 1 { "=1" } else { "a, b" }),
        ],
    );
    assert_eq!(table.columns, ["n", "x (s)", "y", "less", "said"]);
    assert_eq!(table.rows[1], ["2", "–", "–", "–", "a, b"]);
    assert_eq!(
        table.csv().unwrap(),
        "n,x (s),y,± y,less,± \
         less,said\n1,0.30000000000000004,2.0,0.30000000000000004,-2.0,0.30000000000000004,'=1\n2,,,,,,\"a, b\"\n"
    );
    // 1, 0.3, 2.00 ± 0.30 with its sign and without, "a, b", and two between columns.
    assert_eq!(table.letters_across(), 1 + 3 + 11 + 12 + 4 + 5 * 2);
    assert!(table.text().starts_with("Synthetic\n\nn  x (s)  y"));
    assert!(table.markdown().contains("| 1 | 0.3 | 2.00 ± 0.30 | −2.00 ± 0.30 | =1 |"));
}

#[test]
fn a_terminal_gets_lines_of_80_letters_and_the_names_of_what_is_left_out() {
    let heads = ["a", "b", "c", "d"].map(|name| format!("{name} {}", "x".repeat(24)));
    let heads = heads.each_ref().map(String::as_str);
    let table = of_words("t", "Title", &"some words ".repeat(20), &heads, vec![vec!["1".into(); 4]]);
    let text = wrapped(&table.text_within(WIDTH));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let left_out = format!("Left out for want of room: {}, {}.", heads[2], heads[3]);
    assert!(text.replace("\n  ", " ").contains(&left_out), "{text}");
    assert!(table.text().contains(&heads.join("  ")));
}

#[test]
fn rows_are_written_by_the_names_of_their_fields() {
    #[derive(Default, Serialize)]
    struct Row {
        text: &'static str,
        x_error: Option<f64>,
        rods: usize,
    }
    let rows = || {
        [
            Row { text: "=1", x_error: Some(0.1 + 0.2), rods: 3 },
            Row { text: "a, b", x_error: None, rods: 0 },
            Row { text: "-1", x_error: Some(-1e-9), rods: 1 },
        ]
    };
    assert_eq!(rows_csv(rows()).unwrap(), "text,x_error,rods\n'=1,0.30000000000000004,3\n\"a, b\",,0\n-1,-1e-9,1\n");
    assert_eq!(rows_csv(rows().into_iter().take(0)).unwrap(), "text,x_error,rods\n");
    assert_eq!(two_digits(0.26154, 0.00842), "0.2615 ± 0.0084");
    assert_eq!(two_digits(83.878, 0.53), "83.88 ± 0.53");
    assert_eq!(two_digits(-0.0, 0.0), "0");
    assert_eq!(two_digits(0.1 + 0.2, 0.0), "0.3");
}

#[test]
fn a_difference_that_rounds_to_zero_has_no_sign() {
    let all = [(-2e-4, 0.011), (2e-4, 0.011), (-0.02, 0.011), (0.02, 0.011)];
    let table = ReportTable::new(["", ""], "", all, vec![difference("d", |pair: &(f64, f64)| *pair)]);
    assert_eq!(table.rows.concat(), ["0.000 ± 0.011", "0.000 ± 0.011", "−0.020 ± 0.011", "+0.020 ± 0.011"]);
}
