//! Which layouts of an answer are read, and how.

use crate::grading::{answers, files, problem, some, text, write};
use crate::programs::peers;
use std::fs;

#[test]
fn separators_heads_and_digits_of_labels_change_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let (_, mut rows) = problem("shear-plane");
    for (k, row) in rows.iter_mut().enumerate() {
        if k > 0 {
            // Head or tail.
            for value in &mut row[2..] {
                *value = format!("{:e}", -value.parse::<f64>().unwrap());
            }
            row[0] = format!("{:.4}", row[0].parse::<f64>().unwrap());
        }
        row.swap(0, 4);
    }
    let windows = format!("\u{feff}{}\r\n\r\n", text(&rows).replace('\n', "\r\n"));
    let blanks = format!("# {}", text(&rows).replace(',', " "));
    let headless = text(&rows[1..]);
    // The start, which is not asked for, once for each rod.
    let mut with_start = rows.clone();
    for rod in (0..4).rev() {
        with_start.insert(1, ["0", &rod.to_string(), "0", "0", "0"].map(String::from).into());
    }
    let with_start = text(&with_start);
    let columns = ["--columns", "p3,rod,p1,p2,time_s"];
    for (text, more) in
        [(text(&rows), &[][..]), (windows, &["--windows-text"]), (blanks, &[]), (with_start, &[]), (headless, &columns)]
    {
        write(dir.path(), "shear-plane", "answer.csv", text);
        let only = [more, &["--problem", "shear-plane", "--problem", "mid-flip-2"]].concat();
        let ended = answers(dir.path(), &only);
        assert_eq!(ended.of("shear-plane")["verdict"], "PASS", "{}", ended.words);
        assert_eq!(ended.of("mid-flip-2")["verdict"], "MISSING");
        assert_eq!(ended.code, Some(0), "{}", ended.words);
        let all = answers(dir.path(), &[&only[..], &["--all"]].concat());
        assert_eq!(all.code, Some(1));
    }
}

#[test]
fn axes_in_another_order_are_put_back() {
    let dir = tempfile::tempdir().unwrap();
    for (name, file) in
        [("couette-turned", "time_s,rod,p2,-p1,p3"), ("isotropic-11.6", "time_s,a22,a11,a33,-a12,a23,-a13")]
    {
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
        let wrong = answers(dir.path(), &only);
        assert_eq!(wrong.of(name)["verdict"], "FAIL");
        let right = answers(dir.path(), &[&only[..], &["--axes", "flow,-gradient,vorticity"]].concat());
        assert_eq!(right.of(name)["verdict"], "PASS", "{}", right.words);
    }
}

#[test]
fn layouts_of_other_programs_are_read_as_they_are() {
    let layouts = peers().join("layouts");
    for (sample, problem, more, verdict) in [
        ("fiberoripy.csv", "isotropic-3", &[][..], "FAIL"),
        ("fiberpy.csv", "isotropic-3", &["--layout", "fiberpy"], "FAIL"),
        ("openfoam.csv", "isotropic-3", &[], "PASS"),
        ("lammps.dump", "shear-plane", &[], "PASS"),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let ending = sample.split('.').next_back().unwrap();
        fs::create_dir(dir.path().join(problem)).unwrap();
        fs::copy(layouts.join(sample), dir.path().join(problem).join(format!("answer.{ending}"))).unwrap();
        let found = answers(dir.path(), more);
        assert_eq!(found.verdict(problem), verdict, "{sample}: {}", found.words);
        // A closure is near the truth; columns in a wrong order are not.
        assert!(found.error(problem) < 0.05, "{sample}: {}", found.words);
    }
}

/// A closed equation's own answer, in the layouts of two programs; and where it lies in no folder, that is said.
#[test]
fn layouts_of_other_programs_answer_closed_equations_too() {
    let name = "closed-ft-hybrid-0.01";
    let (_, rows) = problem(name);
    // time, 11, 22, 33, 12, 13, 23 of ours.
    let in_order = |order: &[usize]| {
        let line = |row: &Vec<String>| order.iter().map(|k| row[*k].as_str()).collect::<Vec<_>>().join(" ");
        rows[1..].iter().map(line).collect::<Vec<_>>().join("\n") + "\n"
    };
    for (layout, order) in [("fiberoripy", &[0, 1, 4, 5, 4, 2, 6, 5, 6, 3][..]), ("openfoam", &[0, 1, 4, 5, 2, 6, 3])] {
        let dir = tempfile::tempdir().unwrap();
        write(dir.path(), name, "answer.csv", in_order(order));
        let found = answers(dir.path(), &["--layout", layout]);
        assert_eq!(found.verdict(name), "PASS", "{layout}: {}", found.words);
        fs::rename(dir.path().join(name).join("answer.csv"), dir.path().join(format!("{name}.csv"))).unwrap();
        let reference = some(&dir.path().join("ref"), &[name]);
        let found = files(&reference, dir.path(), &["--layout", layout]);
        assert_eq!(found.verdict(name), "MISSING");
        let words = found.words.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&format!("{name}.csv: it was not read; an answer is read from")), "{words}");
    }
}

/// Programs of a_ij write series with more times than are asked for, and OpenFOAM the file of a probe.
#[test]
fn whole_series_and_files_of_probes_are_read() {
    let name = "closed-ft-hybrid-0.01";
    let (_, rows) = problem(name);
    let answered = |problem: &str, file: &str, text: String| {
        let dir = tempfile::tempdir().unwrap();
        write(dir.path(), problem, file, text);
        answers(dir.path(), &["--problem", problem])
    };
    let probes = |rows: &[Vec<String>]| {
        let row = |row: &Vec<String>| {
            let [time, a11, a22, a33, a12, a13, a23] = [0, 1, 2, 3, 4, 5, 6].map(|k| row[k].as_str());
            let halfway = 0.5 + time.parse::<f64>().unwrap();
            format!("{time:>12}   ({a11} {a12} {a13} {a22} {a23} {a33})\n{halfway}   (0.2 0 0 0.3 0 0.5)\n")
        };
        let head = "# Probe 0 (0 0 0)\n#       Probe             0\n#        Time\n";
        head.to_owned() + &rows.iter().map(row).collect::<String>()
    };
    let whole = answered(name, "answer.csv", probes(&rows[1..]));
    assert_eq!(whole.verdict(name), "PASS", "{}", whole.words);
    // What is asked for must be there, and one probe only.
    let short = answered(name, "answer.csv", probes(&rows[1..rows.len() - 1]));
    let words = short.line();
    assert!(short.code == Some(1) && words.contains("the file ends before time_s ="), "{words}");
    assert!(words.contains("time_s = 2.5 is not asked for; the nearest that is asked for is 2"), "{words}");
    let none = answered(name, "answer.csv", probes(&[]));
    assert!(none.code == Some(1) && none.line().contains("there is no row below the comments"), "{}", none.words);
    let two = probes(&rows[1..]).replace(")\n", ") (0.2 0 0 0.3 0 0.5)\n");
    let two = answered(name, "answer.csv", two);
    assert!(two.code == Some(1) && two.line().contains("13 fields where 7 columns are named"), "{}", two.words);
    // Of a steady state the last row counts, whatever its time.
    let name = "folgar-tucker-steady-shear-0.01";
    let (_, rows) = problem(name);
    let at = |time: &str, row: &[String]| format!("{time},{}\n", row[1..].join(","));
    let wrong: Vec<String> = rows[1].iter().map(|_| "0.1".to_owned()).collect();
    for (late, verdict) in [(&rows[1], "PASS"), (&wrong, "FAIL")] {
        let other = if verdict == "PASS" { &wrong } else { &rows[1] };
        let text = rows[0].join(",") + "\n" + &at("0", other) + &at("1", other) + &at("2000", late);
        let found = answered(name, "answer.csv", text);
        assert_eq!(found.verdict(name), verdict, "{}", found.words);
    }
}

/// Quaternions that turn axis x of the body onto p: w = 1 + p₁, (i, j, k) = x × p. Their conjugates mirror p.
#[test]
fn a_dump_without_times_and_shapes_is_told_what_it_does_not_say() {
    let (_, rows) = problem("shear-plane");
    let mut dump = String::new();
    for snapshot in rows[1..].chunks(4) {
        let time_s: f64 = snapshot[0][0].parse().unwrap();
        let step = (time_s / 1e-5).round();
        dump += &format!("ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp pp pp\n");
        dump += &"0 1\n".repeat(3);
        dump += "ITEM: ATOMS id c_q[1] c_q[2] c_q[3] c_q[4]\n";
        for row in snapshot {
            let number = |k: usize| row[k].parse::<f64>().unwrap();
            let id = row[1].parse::<u32>().unwrap() + 1;
            dump += &format!("{id} {} 0 {} {}\n", 1.0 + number(2), -number(4), number(3));
        }
    }
    let dir = tempfile::tempdir().unwrap();
    let only = ["--problem", "shear-plane"];
    // With its times and shapes, another step or axis contradicts it.
    let whole = dump.replace("c_q[4]\n", "c_q[4] shapex shapey shapez\n");
    let whole: Vec<_> = (whole.lines())
        .map(|line| if line.split(' ').count() == 5 { format!("{line} 2 1 1") } else { line.to_owned() })
        .collect();
    write(dir.path(), "shear-plane", "answer.dump", whole.join("\n") + "\n");
    for (axis, reason) in
        [("x", None), ("y", Some(":10: --rod-axis y, but by shapex shapey shapez the rod lies along x"))]
    {
        let told = ["--timestep-s", "1e-5", "--rod-axis", axis];
        let ended = answers(dir.path(), &[&only[..], &told].concat());
        let said = reason.is_none_or(|reason| ended.line().contains(reason));
        assert!(ended.code == Some(reason.map_or(0, |_| 1)) && said, "{}", ended.words);
    }
    let mut times = rows[1..].iter().step_by(4).map(|row| &row[0]);
    let timed: String = (whole.iter())
        .map(|line| match line.as_str() {
            "ITEM: TIMESTEP" => format!("ITEM: TIME\n{}\n{line}\n", times.next().unwrap()),
            _ => format!("{line}\n"),
        })
        .collect();
    write(dir.path(), "shear-plane", "answer.dump", timed);
    for (length, code, reason) in [("1e-5", 0, ""), ("2e-5", 1, "by --timestep-s it is ")] {
        let ended = answers(dir.path(), &[&only[..], &["--timestep-s", length]].concat());
        assert!(ended.code == Some(code) && ended.line().contains(reason), "{}", ended.words);
    }
    write(dir.path(), "shear-plane", "answer.dump", whole.join("\n").replacen("\n2 ", "\n1 ", 1));
    let ended = answers(dir.path(), &[&only[..], &["--timestep-s", "1e-5"]].concat());
    assert!(ended.code == Some(1) && ended.line().contains(":11:1: atom 1 is there twice"), "{}", ended.words);
    write(dir.path(), "shear-plane", "answer.dump", dump);
    for (more, reason) in [(&["--rod-axis", "x"][..], "--timestep-s"), (&["--timestep-s", "1e-5"], "--rod-axis")] {
        let ended = answers(dir.path(), &[&only[..], more].concat());
        assert!(ended.code == Some(1) && ended.line().contains(reason), "{}", ended.words);
    }
    let told = ["--rod-axis", "x", "--timestep-s", "1e-5"];
    let ended = answers(dir.path(), &[&only[..], &told].concat());
    assert_eq!(ended.verdict("shear-plane"), "PASS", "{}", ended.words);
}

/// fiberpy's a23 and a13 are 0 in the recorded sample: here the program's axes are the vorticity, the gradient and the
/// flow, and its a23 is the problem's a12.
#[test]
fn fiberpy_has_23_before_13() {
    let (_, rows) = problem("isotropic-3");
    let place = |wanted: &str| rows[0].iter().position(|name| name == wanted).unwrap();
    let ours = ["time_s", "a33", "a11", "a22", "a13", "a12", "a23"].map(place);
    let told: Vec<Vec<String>> =
        (rows[1..].iter()).map(|row| ours.iter().map(|at| row[*at].clone()).collect()).collect();
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "isotropic-3", "answer.csv", text(&told));
    let more = ["--layout", "fiberpy", "--axes", "vorticity,gradient,flow", "--problem", "isotropic-3"];
    let ended = answers(dir.path(), &more);
    assert_eq!(ended.verdict("isotropic-3"), "PASS", "{}", ended.words);
}
