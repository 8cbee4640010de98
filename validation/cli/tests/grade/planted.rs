//! Copies of the NumPy code with one planted mistake each, which must be named; `examples/graded_tensors` has more.

use crate::grading::{files, some};
use crate::programs::{peers, python, run, skipped};
use rayon::prelude::*;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;

/// Rows of `planted.toml`: a line of the NumPy code, what it is replaced by, the problem that shows it, and its name.
fn planted() -> Vec<[String; 4]> {
    let tables: BTreeMap<String, Vec<[String; 4]>> = toml::from_str(include_str!("planted.toml")).unwrap();
    tables.into_values().flatten().collect()
}

/// Runs scripts in one interpreter, each on the problems of its folder: importing NumPy takes longer than most of them.
const DRIVER: &str = "
import runpy, sys
for line in open(sys.argv[1]).read().splitlines():
    sys.argv = line.split('\\t')
    runpy.run_path(sys.argv[0], run_name='__main__')
";

#[test]
fn each_planted_mistake_gets_its_own_name_and_the_unspoilt_code_none() {
    let Some(python) = python("numpy") else {
        return skipped("planted mistakes in numpy_rk4.py", "no python3 with numpy");
    };
    let dir = tempfile::tempdir().unwrap();
    let code = fs::read_to_string(peers().join("numpy_rk4.py")).unwrap();
    // Rods, tensors and contacts that show the mistakes, and no more.
    let all = ["mid-flip-2", "mid-flip-11.6", "disc-0.1", "isotropic-3", "pdot-rod", "contact-rule", "contact-angles"];
    let mut jobs = vec![("unspoilt".to_owned(), code.clone(), &all[..])];
    let planted = planted();
    let shown: Vec<[&str; 1]> = planted.iter().map(|[_, _, shows, _]| [shows.as_str()]).collect();
    for (k, [line, mistake, ..]) in planted.iter().enumerate() {
        assert!(code.contains(line), "{line}");
        let spoilt = code.replace(line, mistake);
        jobs.push((format!("spoilt-{k}"), spoilt, &shown[k][..]));
    }
    let place = |name: &str, part: &str| dir.path().join(name).join(part);
    let mut list = String::new();
    for (name, code, problems) in &jobs {
        some(&place(name, "ref"), problems);
        fs::write(place(name, "code.py"), code).unwrap();
        let words = ["code.py", "ref", "mine"].map(|part| place(name, part).display().to_string());
        list += &(words.join("\t") + "\n");
    }
    let (driver, jobs_file) = (dir.path().join("driver.py"), dir.path().join("jobs"));
    fs::write(&driver, DRIVER).unwrap();
    fs::write(&jobs_file, list).unwrap();
    run(&python, &[&driver, &jobs_file]);

    let judge = |name: &str| files(&place(name, "ref"), &place(name, "mine"));
    let unspoilt = judge("unspoilt");
    assert_eq!(unspoilt.code, Some(0), "{}", unspoilt.words);
    for name in all {
        assert_eq!(unspoilt.of(name)["diagnosis"], Value::Null);
    }
    planted.par_iter().enumerate().for_each(|(k, [_, mistake, shows, expected])| {
        let spoilt = judge(&format!("spoilt-{k}"));
        assert_eq!((spoilt.code, spoilt.verdict(shows)), (Some(1), "FAIL"), "{mistake}: {}", spoilt.words);
        let diagnosis = spoilt.diagnosis(shows);
        assert!(
            diagnosis.contains(expected) && diagnosis.is_empty() == expected.is_empty(),
            "{mistake}: {diagnosis:?} for {expected}: {}",
            spoilt.words
        );
        let several = |text: &str| text.contains(" or of ");
        assert_eq!(several(diagnosis), several(expected), "{mistake}: {diagnosis}");
    });
}
