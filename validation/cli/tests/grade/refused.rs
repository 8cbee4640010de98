//! What is refused, with which place and reason.

use crate::bounded::Bounded;
use crate::grading::{REFERENCE, answers, files, graded, problem, text, write};
use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn bad_answers_fail_their_problem_with_file_line_and_column() {
    let (_, rows) = problem("shear-plane");
    let good = text(&rows);
    let lines: Vec<&str> = good.lines().collect();
    let with = |line: usize, text: &str| {
        let mut lines = lines.clone();
        lines[line - 1] = text;
        lines.join("\n")
    };
    let field = |line: usize, field: usize, text: &str| {
        let mut row = rows[line - 1].clone();
        row[field - 1] = text.to_owned();
        with(line, &row.join(","))
    };
    let other = text(&problem("mid-flip-11.6").1);
    let mut swapped = lines.clone();
    swapped.swap(2, 3);
    let mut shuffled = lines[1..].to_vec();
    shuffled.reverse();
    shuffled.insert(0, lines[0]);
    let by_rod = {
        let mut rows = lines[1..].to_vec();
        rows.sort_by_key(|row| row.split(',').nth(1).unwrap().to_owned());
        rows.insert(0, lines[0]);
        rows.join("\n")
    };
    let cases: Vec<(Vec<u8>, &str, &str)> = vec![
        (lines[..lines.len() - 1].join("\n").into(), ":16:1", "the file ends before time_s = "),
        (
            [&lines[..1], &lines[2..]].concat().join("\n").into(),
            ":2:1",
            "rod = 0 is missing before this one (1 of 16 rows",
        ),
        (with(5, lines[3]).into(), ":5:2", "the same time_s and rod as in line 4"),
        (field(3, 4, "1e400").into(), ":3:4", "1e400 is too large for a double"),
        (field(3, 4, "0.5x").into(), ":3:4", "\"0.5x\" is not a number"),
        (field(3, 4, "").into(), ":3:4", "\"\" is not a number"),
        (field(3, 1, "nan").into(), ":3:1", "nan is no finite number"),
        (field(3, 1, "1.0").into(), ":3:1", "time_s = 1 is not asked for; the nearest"),
        (field(3, 2, "4").into(), ":3:2", "rod = 4; whole numbers from 0 to 3"),
        (field(3, 2, "0.5").into(), ":3:2", "rod = 0.5; whole numbers"),
        (with(3, "1,2,3,4").into(), ":3:5", "4 fields; the first line has 5"),
        (with(3, "1,2,3,4,5,6").into(), ":3:5", "6 fields; the first line has 5"),
        (with(1, "time_s,rod,p1,p2,q").into(), ":1:5", "column \"q\" is not asked for"),
        (with(1, "time_s,rod,p1,p2,p2").into(), ":1:5", "column \"p2\" is there twice"),
        (with(1, "time_s,rod,p1,p2,-").into(), ":1", "column \"p3\" is missing"),
        (lines[1..].join("\n").into(), ":1", "there is no header"),
        (other.into(), ":2:1", "is not asked for"),
        (Vec::new(), ":1:1", "the file is empty"),
        (swapped.join("\n").into(), ":4:2", "out of order: rows must ascend in time_s and rod"),
        (shuffled.join("\n").into(), ":3:2", "out of order"),
        (by_rod.into(), ":6:1", "out of order"),
        (good.replace('\n', "\r\n").into(), ":1:5", "ends in CR LF: write LF alone"),
        (with(7, &format!("{}\r", lines[6])).into(), ":7:5", "--windows-text"),
        (format!("\u{feff}{good}").into(), ":1:1", "begins with a byte order mark"),
        (lines[..2].join("\n").into(), ":2:1", "the file ends before time_s = "),
        (b"time_s,rod,p1,p2,p3\n\xff\n".to_vec(), ":2", "no UTF-8 text"),
        ("1".repeat(1 << 20).into(), ":1", "longer than 65536 bytes"),
    ];
    for (text, place, reason) in cases {
        let dir = tempfile::tempdir().unwrap();
        let file = write(dir.path(), "shear-plane", "answer.csv", text);
        let ended = answers(dir.path(), &[]);
        assert_eq!((ended.code, ended.verdict("shear-plane")), (Some(1), "FAIL"), "{reason}: {}", ended.words);
        let place = format!("{}{place}: ", file.display());
        let note = ended.of("shear-plane")["note"].as_str().unwrap();
        assert!(note.contains(&place) && note.contains(reason), "{place}{reason}: {note}");
    }
}

#[test]
fn another_format_and_wrong_folders_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let reference = dir.path().join("ref");
    fs::create_dir_all(reference.join("mid-flip-2")).unwrap();
    for file in ["problem.json", "start.csv", "certified.csv"] {
        let from = REFERENCE.path().join("mid-flip-2").join(file);
        fs::copy(from, reference.join("mid-flip-2").join(file)).unwrap();
    }
    let mine = dir.path().join("mine");
    write(&mine, "mid-flip-2", "answer.csv", text(&problem("mid-flip-2").1));
    assert_eq!(files(&reference, &mine, &[]).code, Some(0));
    write(&mine, "mid-flip-2", "answer.txt", "");
    assert!(files(&reference, &mine, &[]).line().contains("one of them is allowed"));
    fs::remove_file(mine.join("mid-flip-2/answer.txt")).unwrap();
    write(&mine, "mid-flip-2", "steps-0.csv", "");
    assert!(files(&reference, &mine, &[]).line().contains("a whole number from 1 is allowed"));
    fs::remove_file(mine.join("mid-flip-2/steps-0.csv")).unwrap();
    let json = reference.join("mid-flip-2/problem.json");
    let changed = fs::read_to_string(&json).unwrap().replace("\"format\": 1", "\"format\": 2");
    fs::write(&json, changed).unwrap();
    let ended = files(&reference, &mine, &[]);
    assert!(ended.code == Some(2) && ended.words.contains("problem.json:2"), "{}", ended.words);
    for (reference, mine, more, reason) in [
        (REFERENCE.path(), Path::new("/no/such"), &[][..], "no such folder"),
        (Path::new("/no/such"), &mine, &[], "/no/such"),
        (REFERENCE.path(), &mine, &["--problem", "mid-flip-3"], "no problem has this name; there are"),
        (REFERENCE.path(), &mine, &["--axes", "up"], "gradient, flow and vorticity are allowed"),
        (REFERENCE.path(), &mine, &["--order", "-1"], "a positive number"),
    ] {
        let ended = files(reference, mine, more);
        assert!(ended.code == Some(2) && ended.words.contains(reason), "{reason}: {}", ended.words);
    }
}

#[test]
fn a_program_that_runs_is_not_asked_about_means_and_contacts() {
    for (more, reason) in
        [(["--problem", "isotropic-3"], "is not asked about it"), (["--kind", "contact"], "leave no problem to grade")]
    {
        let ended = graded(&[&["--command", "true", "--brief"][..], &more].concat());
        let said = ended.words.contains(more[0]) && ended.words.contains(reason);
        assert!(ended.code == Some(2) && said && ended.grade.is_none(), "{}", ended.words);
    }
}

/// Ten million rows, in 1 GB of address space and before most of them are read.
#[test]
fn ten_million_rows_are_refused_at_the_first_that_nobody_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let (_, rows) = problem("mid-flip-2");
    let good = text(&rows);
    let (head, rest) = good.split_once('\n').unwrap();
    for (row, place) in [
        // At the start, and once more.
        ("0,0,0,0,1\n", "the same time_s and rod as in line 2"),
        ("1e-3,0,0,0,1\n", "time_s = 0.001 is not asked for"),
    ] {
        let many = format!("{head}\n{}{rest}", row.repeat(10_000_000));
        write(dir.path(), "mid-flip-2", "answer.csv", many);
        let command = format!(
            "ulimit -v 1000000; '{}' grade '{}' '{}' --force --out '{}'",
            env!("CARGO_BIN_EXE_shearbed"),
            REFERENCE.path().display(),
            dir.path().display(),
            dir.path().join("out").display()
        );
        let output = Command::new("sh").args(["-c", &command]).ended();
        let words = String::from_utf8_lossy(&output.stdout);
        let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(output.status.code() == Some(1) && words.contains(place), "{words}");
    }
}
