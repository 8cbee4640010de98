//! Grading answers made by a test: the exported problems, answers as rows of text, and what `shearbed grade` says.

use crate::bounded::Bounded;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use tempfile::TempDir;

/// The exported problems, once for all tests of a program.
pub static REFERENCE: LazyLock<TempDir> = LazyLock::new(|| {
    let dir = tempfile::tempdir().unwrap();
    let exported =
        Command::new(env!("CARGO_BIN_EXE_shearbed")).args(["problems", "export", "--force"]).arg(dir.path()).ended();
    assert!(exported.status.success());
    dir
});

/// How `shearbed grade` ended.
pub struct Graded {
    pub code: Option<i32>,
    pub words: String,
    /// grade.json, where it was written.
    pub grade: Option<Value>,
    /// grade.html, where it was written.
    pub html: Option<String>,
}

/// `shearbed grade` with these arguments, in a folder of its own.
pub fn graded(arguments: &[&str]) -> Graded {
    let out = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(["grade", "--out"])
        .arg(out.path())
        .args(arguments)
        .envs(crate::programs::ONE_THREAD)
        .ended();
    let words = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let text = |name: &str| fs::read_to_string(out.path().join(name)).ok();
    let files = ["grade.json", "grade.html", "grade.md", "junit.xml"].map(|name| text(name).is_some());
    assert!(files == [true; 4] || files == [false; 4], "all files or none");
    Graded {
        code: output.status.code(),
        words: words.concat(),
        grade: text("grade.json").map(|text| serde_json::from_str(&text).unwrap()),
        html: text("grade.html"),
    }
}

/// Answers in a folder against the exported problems that it answers. All of them would take twenty times as long to
/// read.
pub fn answers(mine: &Path) -> Graded {
    let entries = fs::read_dir(mine).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let names: Vec<String> = entries.collect();
    let reference = tempfile::tempdir().unwrap();
    files(&some(reference.path(), &names), mine)
}

/// Answers in files against problems in a folder.
pub fn files(reference: &Path, mine: &Path) -> Graded {
    graded(&[reference, mine].map(|path| path.to_str().unwrap()))
}

impl Graded {
    /// What is said of a problem.
    pub fn of(&self, name: &str) -> &Value {
        let grade = self.grade.as_ref().unwrap_or_else(|| panic!("{}", self.words));
        let problems = grade["problems"].as_array().unwrap();
        let of = problems.iter().find(|graded| graded["name"] == name);
        of.unwrap_or_else(|| panic!("{name}: {}", self.words))
    }

    pub fn verdict(&self, name: &str) -> &str {
        self.of(name)["verdict"].as_str().unwrap()
    }

    pub fn order(&self, name: &str) -> f64 {
        self.of(name)["observed_order"].as_f64().unwrap_or(f64::NAN)
    }

    pub fn diagnosis(&self, name: &str) -> &str {
        self.of(name)["diagnosis"].as_str().unwrap_or_default()
    }
}

/// The names of all problems.
pub fn names() -> Vec<String> {
    let entries = fs::read_dir(REFERENCE.path()).unwrap().map(Result::unwrap);
    // Beside them is the record of the export.
    let folders = entries.filter(|entry| entry.path().is_dir());
    folders.map(|entry| entry.file_name().into_string().unwrap()).collect()
}

/// problem.json, and the certified rows with their header.
pub fn problem(name: &str) -> (Value, Vec<Vec<String>>) {
    let dir = REFERENCE.path().join(name);
    let text = fs::read_to_string(dir.join("certified.csv")).unwrap();
    let rows = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
    (serde_json::from_str(&fs::read_to_string(dir.join("problem.json")).unwrap()).unwrap(), rows.collect())
}

/// Rows as CSV.
pub fn text(rows: &[Vec<String>]) -> String {
    rows.iter().map(|row| row.join(",") + "\n").collect()
}

/// Writes a file of an answer.
pub fn write(mine: &Path, name: &str, file: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let dir = mine.join(name);
    fs::create_dir_all(&dir).unwrap();
    fs::write(dir.join(file), text).unwrap();
    dir.join(file)
}

/// Some of the exported problems in a folder of their own.
pub fn some(to: &Path, names: &[impl AsRef<Path>]) -> PathBuf {
    for name in names {
        fs::create_dir_all(to.join(name)).unwrap();
        for entry in fs::read_dir(REFERENCE.path().join(name)).unwrap() {
            let from = entry.unwrap().path();
            fs::copy(&from, to.join(name).join(from.file_name().unwrap())).unwrap();
        }
    }
    to.to_owned()
}
