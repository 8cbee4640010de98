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
            estimate("y", |y, se| format!("{y} ± {se}"), |r: &Row| r.1.map(|x| (2.0, x))),
            words("said", |r: &Row| if r.0 == 1 { "=1" } else { "a, b" }),
        ],
    );
    assert_eq!(table.columns, ["n", "x (s)", "y", "said"]);
    assert_eq!(table.rows[1], ["2", "–", "–", "a, b"]);
    assert_eq!(
        table.csv().unwrap(),
        "n,x (s),y,± y,said\n1,0.30000000000000004,2.0,0.30000000000000004,'=1\n2,,,,\"a, b\"\n"
    );
    assert!(table.text().starts_with("Synthetic\n\nn  x (s)  y"));
    assert!(table.markdown().contains("| 1 | 0.3 | 2 ± 0.30000000000000004 | =1 |"));
}
