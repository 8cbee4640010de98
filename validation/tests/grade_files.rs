//! `shearbed grade REF MINE`: what passes, what fails, and what is refused, on answers made from the certified ones.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use tempfile::TempDir;

/// The exported problems.
static REFERENCE: LazyLock<TempDir> = LazyLock::new(|| {
    let dir = tempfile::tempdir().unwrap();
    let exported = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(["problems", "export", "--force"])
        .arg(dir.path())
        .status();
    assert!(exported.unwrap().success());
    dir
});

struct Ended {
    code: Option<i32>,
    words: String,
    /// grade.json, where it was written.
    grade: Option<Value>,
}

fn grade(reference: &Path, mine: &Path, more: &[&str]) -> Ended {
    let out = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .arg("grade")
        .args([reference, mine, Path::new("--out"), out.path()])
        .args(more)
        .output()
        .unwrap();
    let words = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let text = fs::read_to_string(out.path().join("grade.json")).ok();
    assert_eq!(
        text.is_some(),
        out.path().join("junit.xml").exists(),
        "all files or none"
    );
    Ended {
        code: output.status.code(),
        words: words.concat(),
        grade: text.map(|text| serde_json::from_str(&text).unwrap()),
    }
}

impl Ended {
    fn of(&self, name: &str) -> &Value {
        let problems = self.grade.as_ref().unwrap_or_else(|| panic!("{}", self.words))["problems"].as_array();
        problems
            .unwrap()
            .iter()
            .find(|graded| graded["name"] == name)
            .unwrap()
    }
}

fn names() -> Vec<String> {
    let entries = fs::read_dir(REFERENCE.path()).unwrap();
    entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

/// problem.json, and the certified rows with their header.
fn problem(name: &str) -> (Value, Vec<Vec<String>>) {
    let dir = REFERENCE.path().join(name);
    let text = fs::read_to_string(dir.join("certified.csv")).unwrap();
    let rows = text
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect());
    (
        serde_json::from_str(&fs::read_to_string(dir.join("problem.json")).unwrap()).unwrap(),
        rows.collect(),
    )
}

fn text(rows: &[Vec<String>]) -> String {
    rows.iter().map(|row| row.join(",") + "\n").collect()
}

fn write(mine: &Path, name: &str, file: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let dir = mine.join(name);
    fs::create_dir_all(&dir).unwrap();
    fs::write(dir.join(file), text).unwrap();
    dir.join(file)
}

/// The certified rows, each with an error of `part` of the tolerance in the problem's own metric.
fn off_by(name: &str, part: f64) -> Vec<Vec<String>> {
    let (problem, mut rows) = problem(name);
    let tolerance = problem["tolerance"].as_f64().unwrap() * part;
    let columns = rows[0].clone();
    for row in rows.iter_mut().skip(1) {
        let number = |k: usize| row[k].parse::<f64>().unwrap();
        match problem["metric"].as_str().unwrap() {
            "angle" => {
                // Turned by the angle towards the axis that is farthest off.
                let p = [number(2), number(3), number(4)];
                let axis = (0..3).min_by(|a, b| p[*a].abs().total_cmp(&p[*b].abs())).unwrap();
                let mut across = [0.0; 3];
                across[axis] = 1.0;
                let along: f64 = p[axis];
                let length = (1.0 - along * along).sqrt();
                for i in 0..3 {
                    let towards = (across[i] - along * p[i]) / length;
                    row[2 + i] = format!("{:e}", p[i] * tolerance.cos() + towards * tolerance.sin());
                }
            }
            "absolute" => row[1] = format!("{:e}", number(1) + tolerance),
            "relative" => {
                let of_a: Vec<_> = (0..columns.len())
                    .filter(|k| columns[*k].starts_with("a_"))
                    .collect();
                let length = of_a.iter().map(|k| number(*k).powi(2)).sum::<f64>().sqrt();
                row[of_a[0]] = format!("{:e}", number(of_a[0]) + tolerance * length);
            }
            "standard-errors" => row[1] = format!("{:e}", number(1) + tolerance * number(2) * 2f64.sqrt()),
            other => panic!("{other}"),
        }
    }
    rows
}

#[test]
fn half_the_tolerance_passes_and_twice_fails_in_every_problem_and_metric() {
    let dir = tempfile::tempdir().unwrap();
    let names = names();
    assert!(names.len() > 15, "{names:?}");
    for (part, verdict, code) in [(0.0, "PASS", 0), (0.5, "PASS", 0), (2.0, "FAIL", 1)] {
        let mine = dir.path().join(verdict);
        for name in &names {
            write(&mine, name, "answer.csv", text(&off_by(name, part)));
        }
        let ended = grade(REFERENCE.path(), &mine, &["--all"]);
        assert_eq!(ended.code, Some(code), "{part}: {}", ended.words);
        for name in &names {
            let found = ended.of(name);
            assert_eq!(found["verdict"], verdict, "{part}: {found:#}");
            assert_eq!(found["diagnosis"], Value::Null, "{found:#}");
            let ratio = found["error"].as_f64().unwrap() / found["tolerance"].as_f64().unwrap();
            assert!(
                (ratio - part).abs() < 0.02 + 0.01 * part,
                "{part} {ratio}: {found:#}"
            );
        }
    }
}

#[test]
fn heads_order_line_ends_and_digits_of_labels_change_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let (_, mut rows) = problem("shear-plane");
    let head = rows.remove(0);
    rows.reverse();
    for (k, row) in rows.iter_mut().enumerate() {
        if k % 2 == 0 {
            for value in &mut row[2..] {
                *value = format!("{:e}", -value.parse::<f64>().unwrap());
            }
        }
        row[0] = format!("{:.4}", row[0].parse::<f64>().unwrap());
        row.swap(0, 4);
    }
    let mut head = head;
    head.swap(0, 4);
    rows.insert(0, head);
    let windows = format!("\u{feff}{}\r\n\r\n", text(&rows).replace('\n', "\r\n"));
    let blanks = format!("# {}", text(&rows).replace(',', " "));
    let headless = text(&rows[1..]);
    let columns = ["--columns", "p3,rod,p1,p2,time_s"];
    for (text, more) in [(windows, &[][..]), (blanks, &[]), (headless, &columns)] {
        write(dir.path(), "shear-plane", "answer.csv", text);
        let ended = grade(REFERENCE.path(), dir.path(), more);
        assert_eq!(ended.of("shear-plane")["verdict"], "PASS", "{}", ended.words);
        assert_eq!(ended.of("mid-flip-2")["verdict"], "MISSING");
        assert_eq!(ended.code, Some(0), "{}", ended.words);
        assert_eq!(
            grade(REFERENCE.path(), dir.path(), &[more, &["--all"]].concat()).code,
            Some(1)
        );
    }
}

#[test]
fn axes_in_another_order_are_put_back() {
    let dir = tempfile::tempdir().unwrap();
    for (name, file) in [
        ("couette-turned", "time_s,rod,p2,-p1,p3"),
        ("isotropic-11.6", "time_s,a22,a11,a33,-a12,a23,-a13"),
    ] {
        let (_, rows) = problem(name);
        let place = |wanted: &str| rows[0].iter().position(|name| name == wanted).unwrap();
        let mut told: Vec<Vec<String>> = vec![rows[0].clone()];
        for row in &rows[1..] {
            let value = |column: &str| match column.strip_prefix('-') {
                Some(column) => format!("{:e}", -row[place(column)].parse::<f64>().unwrap()),
                None => row[place(column)].clone(),
            };
            told.push(file.split(',').map(value).collect());
        }
        // The program's axes are the flow, against the gradient, and the vorticity.
        write(dir.path(), name, "answer.csv", text(&told));
        let only = ["--problem", name];
        let wrong = grade(REFERENCE.path(), dir.path(), &only);
        assert_eq!(wrong.of(name)["verdict"], "FAIL");
        let right = grade(
            REFERENCE.path(),
            dir.path(),
            &[&only[..], &["--axes", "flow,-gradient,vorticity"]].concat(),
        );
        assert_eq!(right.of(name)["verdict"], "PASS", "{}", right.words);
    }
}

#[test]
fn bad_answers_are_refused_with_file_line_and_column() {
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
    let cases: Vec<(Vec<u8>, &str, &str)> = vec![
        (
            lines[..lines.len() - 1].join("\n").into(),
            ":16:1",
            "ends without time_s = ",
        ),
        (
            with(5, lines[3]).into(),
            ":5:2",
            "the same time_s and rod as in line 4",
        ),
        (
            field(3, 4, "1e400").into(),
            ":3:4",
            "1e400 is too large for a double",
        ),
        (field(3, 4, "0.5x").into(), ":3:4", "\"0.5x\" is no number"),
        (field(3, 4, "").into(), ":3:4", "\"\" is no number"),
        (field(3, 1, "nan").into(), ":3:1", "nan is no finite number"),
        (
            field(3, 1, "1.0").into(),
            ":3:1",
            "time_s = 1 is not asked for; the nearest",
        ),
        (
            field(3, 2, "4").into(),
            ":3:2",
            "rod = 4; whole numbers from 0 to 3",
        ),
        (field(3, 2, "0.5").into(), ":3:2", "rod = 0.5; whole numbers"),
        (
            with(3, "1,2,3,4").into(),
            ":3:5",
            "4 fields; the first line has 5",
        ),
        (
            with(3, "1,2,3,4,5,6").into(),
            ":3:5",
            "6 fields; the first line has 5",
        ),
        (
            with(1, "time_s,rod,p1,p2,q").into(),
            ":1:5",
            "column \"q\" is not asked for",
        ),
        (
            with(1, "time_s,rod,p1,p2,p2").into(),
            ":1:5",
            "column \"p2\" is there twice",
        ),
        (
            with(1, "time_s,rod,p1,p2,-").into(),
            ":1",
            "column \"p3\" is missing",
        ),
        (lines[1..].join("\n").into(), ":1", "there is no header"),
        (other.into(), ":2:1", "is not asked for"),
        (Vec::new(), ":1:1", "the file is empty"),
        (b"time_s,rod,p1,p2,p3\n\xff\n".to_vec(), ":2", "no UTF-8 text"),
        ("1".repeat(1 << 20).into(), ":1", "longer than 65536 bytes"),
    ];
    for (text, place, reason) in cases {
        let dir = tempfile::tempdir().unwrap();
        let file = write(dir.path(), "shear-plane", "answer.csv", text);
        let ended = grade(REFERENCE.path(), dir.path(), &[]);
        assert_eq!(ended.code, Some(2), "{reason}: {}", ended.words);
        let place = format!("{}{place}: ", file.display());
        assert!(
            ended.words.contains(&place) && ended.words.contains(reason),
            "{place}{reason}: {}",
            ended.words
        );
        assert!(ended.grade.is_none(), "nothing is written");
    }
}

#[test]
fn what_is_not_finite_is_an_answer_that_fails() {
    for word in ["nan", "NaN", "inf", "-Infinity"] {
        let dir = tempfile::tempdir().unwrap();
        let (_, mut rows) = problem("mid-flip-2");
        rows[2][3] = word.into();
        let file = write(dir.path(), "mid-flip-2", "answer.csv", text(&rows));
        let ended = grade(REFERENCE.path(), dir.path(), &[]);
        let found = ended.of("mid-flip-2");
        let expected = format!("{}:3: a value is not finite", file.display());
        assert_eq!(
            (ended.code, &found["verdict"], &found["error"]),
            (Some(1), &"FAIL".into(), &Value::Null)
        );
        assert_eq!(found["note"], expected);
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
    assert_eq!(grade(&reference, &mine, &[]).code, Some(0));
    write(&mine, "mid-flip-2", "answer.txt", "");
    assert!(
        grade(&reference, &mine, &[])
            .words
            .contains("one of them is allowed")
    );
    fs::remove_file(mine.join("mid-flip-2/answer.txt")).unwrap();
    write(&mine, "mid-flip-2", "steps-0.csv", "");
    assert!(
        grade(&reference, &mine, &[])
            .words
            .contains("a whole number from 1 is allowed")
    );
    fs::remove_file(mine.join("mid-flip-2/steps-0.csv")).unwrap();
    let json = reference.join("mid-flip-2/problem.json");
    let changed = fs::read_to_string(&json)
        .unwrap()
        .replace("\"format\": 1", "\"format\": 2");
    fs::write(&json, changed).unwrap();
    let ended = grade(&reference, &mine, &[]);
    assert!(
        ended.code == Some(2) && ended.words.contains("problem.json:2"),
        "{}",
        ended.words
    );
    for (reference, mine, more, reason) in [
        (REFERENCE.path(), Path::new("/no/such"), &[][..], "no folder"),
        (Path::new("/no/such"), &mine, &[], "/no/such"),
        (
            REFERENCE.path(),
            &mine,
            &["--problem", "mid-flip-3"],
            "no problem has this name; there are",
        ),
        (
            REFERENCE.path(),
            &mine,
            &["--axes", "up"],
            "gradient, flow and vorticity are allowed",
        ),
        (REFERENCE.path(), &mine, &["--order", "-1"], "a positive number"),
    ] {
        let ended = grade(reference, mine, more);
        assert!(
            ended.code == Some(2) && ended.words.contains(reason),
            "{reason}: {}",
            ended.words
        );
    }
}

/// Ten million rows that nobody asked for, in 1 GB of address space: read in time and memory that do not grow with them.
#[test]
fn ten_million_rows_need_no_memory() {
    let dir = tempfile::tempdir().unwrap();
    let (_, rows) = problem("mid-flip-2");
    let many = "0,0,0,0,1\n".repeat(10_000_000);
    let good = text(&rows);
    let (head, rest) = good.split_once('\n').unwrap();
    write(
        dir.path(),
        "mid-flip-2",
        "answer.csv",
        format!("{head}\n{many}{rest}"),
    );
    let command = format!(
        "ulimit -v 1000000; '{}' grade '{}' '{}' --out '{}'",
        env!("CARGO_BIN_EXE_shearbed"),
        REFERENCE.path().display(),
        dir.path().display(),
        dir.path().join("out").display()
    );
    let output = Command::new("sh").args(["-c", &command]).output().unwrap();
    let words =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && words.contains("1 of"), "{words}");
}

#[test]
fn orders_are_read_from_steps_and_judged_against_a_claim() {
    let dir = tempfile::tempdir().unwrap();
    // Errors of 4096, 256, 16 tolerances, and one below it.
    for (steps, part) in [(100, 4096.0), (200, 256.0), (400, 16.0), (800, 0.9)] {
        let file = format!("steps-{steps}.csv");
        write(
            dir.path(),
            "mid-flip-100",
            &file,
            text(&off_by("mid-flip-100", part)),
        );
    }
    let ended = grade(REFERENCE.path(), dir.path(), &["--order", "4"]);
    let found = ended.of("mid-flip-100");
    assert_eq!(
        (&found["verdict"], &found["steps"]),
        (&"PASS".into(), &800.into()),
        "{found:#}"
    );
    assert!((found["observed_order"].as_f64().unwrap() - 4.0).abs() < 1e-3);
    let ended = grade(REFERENCE.path(), dir.path(), &["--order", "3"]);
    assert_eq!(
        ended.of("mid-flip-100")["note"],
        "observed order +4.00 where 3 is claimed"
    );
    assert_eq!(ended.code, Some(1));
    // It diverges.
    for (steps, part) in [(100, 16.0), (200, 256.0), (400, 4096.0)] {
        let file = format!("steps-{steps}.csv");
        write(dir.path(), "mid-flip-2", &file, text(&off_by("mid-flip-2", part)));
    }
    let ended = grade(REFERENCE.path(), dir.path(), &[]);
    let order = ended.of("mid-flip-2")["observed_order"].as_f64().unwrap();
    assert!((order + 4.0).abs() < 1e-3, "{order}");
}

#[test]
fn too_little_data_does_not_pass() {
    let dir = tempfile::tempdir().unwrap();
    let (problem, mut rows) = problem("lee-springer");
    let allowed = problem["ensemble"]["largest_standard_error"].as_f64().unwrap();
    for (se, verdict) in [
        (0.9 * allowed, "PASS"),
        (1.1 * allowed, "FAIL"),
        (-0.5 * allowed, "FAIL"),
    ] {
        rows[3][2] = se.to_string();
        write(dir.path(), "lee-springer", "answer.csv", text(&rows));
        let ended = grade(REFERENCE.path(), dir.path(), &[]);
        let found = ended.of("lee-springer");
        assert_eq!(found["verdict"], verdict, "{found:#}");
        assert_eq!(
            found["note"]
                .as_str()
                .is_some_and(|note| note.contains("too little data")),
            verdict == "FAIL"
        );
    }
}
