//! Tables as instruments and spreadsheets write them.

use super::*;

#[test]
fn blanks_separate_where_nothing_else_does() {
    let read = |text: &str| {
        let mut table = Table::new(Path::new("a.csv"), text.as_bytes()).unwrap();
        let names = table.names().join("|");
        (names, table.next_row().unwrap().unwrap().cells.join("|"))
    };
    for text in ["t x1\n1 2\n", "# t,x1\n1 2\n", "# t x1\n1   2\n", "t,x1\n 1  2\n", "t;x1\n1 2", "\"t\",x1\n1,2\n"] {
        assert_eq!(read(text), ("t|x1".into(), "1|2".into()), "{text:?}");
    }
    assert_eq!(read("t, x1\n1, 2\n"), ("t|x1".into(), "1|2".into()));
    assert_eq!(read("a name,x1\na b,2\n"), ("a name|x1".into(), "a b|2".into()));
}

#[test]
fn words_for_no_value_are_missing_and_typeset_numbers_are_numbers() {
    let mut table = Table::new(Path::new("a.csv"), "a,b,c,d,e\n--,#N/A,None,−1.5e−3,- 2\n".as_bytes()).unwrap();
    let row = table.next_row().unwrap().unwrap();
    let missing: Vec<usize> = (0..5).filter(|place| row.is_missing(*place)).collect();
    assert_eq!(missing, [0, 1, 2]);
    assert_eq!(row.finite(3).unwrap(), -1.5e-3);
    assert!(row.finite(4).unwrap_err().to_string().contains("column e: `- 2` is not allowed"));
}

#[test]
fn no_value_in_the_first_cell_begins_no_comment() {
    let read = |text: &str| {
        let mut table = Table::new(Path::new("a.csv"), text.as_bytes()).unwrap();
        table.next_row().unwrap().unwrap().cells.join("|")
    };
    assert_eq!(read("a;b\n#N/A;2\n3;4\n"), "#N/A|2");
    assert_eq!(read("a;b\n#N/A was written here;2\n3;4\n"), "3|4");
}

#[test]
fn rows_may_end_with_a_separator_and_numbers_have_one_decimal_mark() {
    let read = |text: &str| {
        let mut table = Table::new(Path::new("a.csv"), text.as_bytes()).unwrap();
        std::iter::from_fn(move || table.next_row().transpose().map(|row| row.map(|row| row.cells.join("|"))))
            .collect::<Result<Vec<_>, _>>()
            .map_err(|error| error.to_string())
    };
    assert_eq!(read("a;b\n1;2;\n3;4\n").unwrap(), ["1|2", "3|4"]);
    assert_eq!(read("a;b\n1;;\n").unwrap(), ["1|"]);
    assert!(read("a;b\n1;2;3\n").unwrap_err().contains("3 cells; the header has 2"));
    assert_eq!(read("a;b\n1;0,5\n2;1,5\n").unwrap(), ["1|0.5", "2|1.5"]);
    for text in ["a;b\n1.234;0,5\n", "a;b\n1;0,5\n1.234;2\n"] {
        assert!(read(text).unwrap_err().contains("`1.234` has a decimal point and `0,5` a decimal comma"), "{text}");
    }
}
