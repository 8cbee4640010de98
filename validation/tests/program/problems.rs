//! Reference problems as files.

use crate::common::files;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use validation::serve::problems;

/// The files of every problem, by `NAME/FILE`: built once.
static FILES: LazyLock<BTreeMap<String, String>> = LazyLock::new(|| {
    let files = problems::built().into_iter().flat_map(|built| {
        let files = problems::files(built).into_iter();
        files.map(move |(file, text)| (format!("{}/{file}", built.problem.name), text))
    });
    files.collect()
});

fn write(dir: &Path) {
    for (name, text) in FILES.iter() {
        let path = dir.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

#[test]
fn an_export_is_what_is_read_and_is_not_written_over_what_it_did_not_write() {
    let dir = tempfile::tempdir().unwrap();
    let reference = dir.path().join("a/ref");
    let names = problems::export(&reference, false).unwrap();
    for name in ["mid-flip-2", "mid-flip-11.6", "mid-flip-100", "mid-flip-10000"] {
        assert!(names.contains(&name));
    }
    let expected: BTreeMap<_, _> =
        FILES.iter().map(|(name, text)| (name.clone(), text.clone().into_bytes())).collect();
    let mut found = files(&reference);
    let record: Value = serde_json::from_slice(&found.remove("shearbed.json").unwrap()).unwrap();
    assert_eq!(record["command"], "problems export");
    assert_eq!(record["files"].as_object().unwrap().len(), expected.len());
    assert_eq!(found, expected);
    assert_eq!(problems::read(&reference).unwrap().len(), names.len());
    // Over its own export: the same again.
    problems::export(&reference, false).unwrap();
    // What nobody exported stays where it is, and what was changed is replaced by force alone.
    let start = reference.join("poles/start.csv");
    for foreign in ["sphere/answer.csv", "notes.txt"] {
        fs::write(reference.join(foreign), "mine").unwrap();
        problems::export(&reference, false).unwrap();
        fs::write(&start, "changed").unwrap();
        let error = problems::export(&reference, false).unwrap_err().to_string();
        assert!(error.contains("poles/start.csv: was changed") && error.contains("--force"), "{error}");
        assert_eq!(fs::read_to_string(&start).unwrap(), "changed");
        problems::export(&reference, true).unwrap();
        assert_eq!(fs::read_to_string(reference.join(foreign)).unwrap(), "mine");
        assert_eq!(fs::read_to_string(&start).unwrap(), FILES["poles/start.csv"]);
    }
    // Without the record nobody knows who wrote the problems.
    fs::remove_file(reference.join("shearbed.json")).unwrap();
    let error = problems::export(&reference, false).unwrap_err().to_string();
    assert!(error.contains("problem.json: is here already") && error.contains("another folder"), "{error}");
}

#[test]
fn every_problem_holds_to_the_schema_and_spoilt_ones_do_not() {
    let schema: Value = serde_json::from_str(problems::SCHEMA).unwrap();
    let schema = jsonschema::validator_for(&schema).unwrap();
    let mut count = 0;
    for (name, text) in FILES.iter().filter(|(name, _)| name.ends_with("problem.json")) {
        let problem: Value = serde_json::from_str(text).unwrap();
        assert!(schema.is_valid(&problem), "{name}: {:?}", schema.iter_errors(&problem).next());
        count += 1;
        let spoilt: [(&str, Value); 7] = [
            ("format", 2.into()),
            ("kind", "rod".into()),
            ("tolerance", 0.into()),
            ("aspect_ratio", (-1).into()),
            ("extra", 1.into()),
            ("gradient_per_s", vec![vec![0.0; 3]; 2].into()),
            ("ensemble", 1.into()),
        ];
        for (key, value) in spoilt {
            let mut wrong = problem.clone();
            wrong[key] = value;
            assert!(!schema.is_valid(&wrong), "{name}: {key}");
        }
        for key in ["because", "times_s", "columns"] {
            let mut wrong = problem.clone();
            wrong.as_object_mut().unwrap().remove(key);
            assert!(!schema.is_valid(&wrong), "{name}: without {key}");
        }
    }
    assert_eq!(count, problems::all().len());
}

#[test]
fn spoilt_folders_are_refused_with_their_place() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path());
    let (start, certified) = (&FILES["poles/start.csv"], &FILES["poles/certified.csv"]);
    let json = &FILES["poles/problem.json"];
    let row = certified.lines().nth(2).unwrap();
    for (file, spoilt, place, words) in [
        ("problem.json", json.replace("\"format\": 1", "\"format\": 2"), ":2:", "reads 1"),
        ("problem.json", json.replace("\"title\"", "\"titel\""), ":4:", "titel"),
        ("problem.json", json[..json.len() / 2].into(), ":", "EOF"),
        ("problem.json", json.replace("\"tolerance\": ", "\"tolerance\": -"), "", "tolerance"),
        ("start.csv", start.replace("rod,p1", "rod,p"), ":1:", "header"),
        ("start.csv", start.replace("\n1,", "\n2,"), ":3:1:", "rod 1 is next"),
        ("start.csv", start.replacen("1.0", "1.1", 1), ":2:2:", "|p|"),
        ("start.csv", start.replacen("1.0", "1e400", 1), ":2:4:", "1e400"),
        ("certified.csv", certified.replace(&format!("{row}\n"), ""), ":3:2:", "rod"),
        ("certified.csv", certified.replace(row, &format!("{row},1")), ":3:", "fields"),
        ("certified.csv", format!("{certified}{row}\n"), "", "rows"),
        ("certified.csv", certified.replacen("e-1", "x", 1), ":", "no finite number"),
        ("certified.csv", String::new(), ":1:", "header"),
    ] {
        let path = dir.path().join("poles").join(file);
        fs::write(&path, &spoilt).unwrap();
        let error = problems::read(dir.path()).unwrap_err().to_string();
        let expected = format!("{}{place}", path.display());
        assert!(error.starts_with(&expected) && error.contains(words), "{error} | {expected} | {words}");
        fs::write(&path, &FILES[&format!("poles/{file}")]).unwrap();
    }
    problems::read(dir.path()).unwrap();
    let empty = tempfile::tempdir().unwrap();
    let error = problems::read(empty.path()).unwrap_err().to_string();
    assert!(error.contains("no problems here"));
}

#[test]
fn exact_answers_have_more_digits_than_a_double() {
    for def in problems::all() {
        let table = &FILES[&format!("{}/certified.csv", def.name)];
        let digits = table.lines().skip(1).flat_map(|row| row.split(',').skip(1)).map(|field| {
            let mantissa = field.split('e').next().unwrap_or_default();
            mantissa.chars().filter(char::is_ascii_digit).count()
        });
        let most = digits.max().unwrap();
        match def.name {
            "log-rolling" => assert_eq!(most, 1),
            name if name.starts_with("lee-springer") => assert!(most >= 15),
            name => assert!(most >= 20, "{name}: {most}"),
        }
    }
}
