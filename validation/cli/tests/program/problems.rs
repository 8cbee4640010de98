//! Reference problems as files.

use crate::common::bounded::Bounded;
use crate::common::{empty_folder, files};
use serde_json::Value;
use shearbed_validation::serve::problems;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

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
    let dir = empty_folder();
    let reference = dir.at("a/ref");
    let names = problems::export(&reference, false).unwrap();
    for name in ["mid-flip-2", "mid-flip-11.6", "mid-flip-100", "mid-flip-10000"] {
        assert!(names.contains(&name));
    }
    let expected: BTreeMap<_, _> = FILES.iter().map(|(name, text)| (name.clone(), text.clone().into_bytes())).collect();
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
fn spoilt_folders_are_refused_with_their_place() {
    let dir = empty_folder();
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
        ("certified.csv", certified.replace(row, &format!("{row},1")), ":3:", "6 cells; the header has 5"),
        ("certified.csv", format!("{certified}{row}\n"), "", "rows"),
        ("certified.csv", certified.replacen("e-1", "x", 1), ":", "is not allowed: expected a finite number"),
        ("certified.csv", String::new(), ":1:", "the file is empty"),
    ] {
        let path = dir.at("poles").join(file);
        fs::write(&path, &spoilt).unwrap();
        let error = problems::read(dir.path()).unwrap_err().to_string();
        let expected = format!("{}{place}", path.display());
        assert!(error.starts_with(&expected) && error.contains(words), "{error} | {expected} | {words}");
        fs::write(&path, &FILES[&format!("poles/{file}")]).unwrap();
    }
    problems::read(dir.path()).unwrap();
    let empty = empty_folder();
    let error = problems::read(empty.path()).unwrap_err().to_string();
    assert!(error.contains("no problems here"));
}

/// A folder that was exported before its answer was corrected is refused as such, and no answer is graded by it.
#[test]
fn an_answer_that_has_been_corrected_since_is_said_to_have_been_wrong() {
    let dir = empty_folder();
    let folder = dir.at("folgar-tucker-planar-extension");
    fs::create_dir(&folder).unwrap();
    for file in ["problem.json", "certified.csv"] {
        let text = &FILES[&format!("folgar-tucker-planar-extension/{file}")];
        fs::write(folder.join(file), text.replace("  \"version\": 2,\n", "")).unwrap();
    }
    let error = problems::read(dir.path()).unwrap_err().to_string();
    for words in ["problem.json: version = 1: ", "certified a_ij were wrong by up to 1.8e-4", "problems export"] {
        assert!(error.contains(words), "{error}");
    }
    fs::write(folder.join("problem.json"), &FILES["folgar-tucker-planar-extension/problem.json"]).unwrap();
    assert_eq!(problems::read(dir.path()).unwrap().len(), 1);
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
            // Twelve decimals.
            name if ["folgar-tucker", "brownian", "clos", "dadt"].iter().any(|kind| name.starts_with(kind)) => {
                assert!(most >= 12);
            }
            name => assert!(most >= 20, "{name}: {most}"),
        }
    }
}

/// With the tar and sha256sum of the machine, which know nothing of how the archive was made.
#[test]
fn an_archive_has_every_file_with_its_checksum_a_licence_and_a_citation() {
    let dir = empty_folder();
    let file = dir.at("problems.tar");
    let exported = |more: &[&str]| {
        let mut shearbed = std::process::Command::new(env!("CARGO_BIN_EXE_shearbed"));
        shearbed.args(["problems", "export", "--archive"]).arg(&file).args(more).ended()
    };
    let first = exported(&[]);
    assert!(first.status.success(), "{}", String::from_utf8_lossy(&first.stderr));
    let bytes = fs::read(&file).unwrap();
    assert_eq!(problems::archive(), bytes, "the same bytes each time");
    // Something else of this name stays.
    fs::write(&file, "mine").unwrap();
    assert_eq!(exported(&[]).status.code(), Some(2));
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    assert!(exported(&["--force"]).status.success());
    let shell = |command: &str| {
        let ended = std::process::Command::new("sh").args(["-ec", command]).current_dir(dir.path()).ended();
        (ended.status.success(), String::from_utf8_lossy(&ended.stdout).into_owned())
    };
    let folder = format!("shearbed-problems-{}", env!("CARGO_PKG_VERSION"));
    assert!(shell("tar xf problems.tar").0);
    let unpacked = files(&dir.path().join(&folder));
    for (name, text) in FILES.iter() {
        assert_eq!(unpacked[name], text.as_bytes(), "{name}");
    }
    let more: Vec<_> = unpacked.keys().filter(|name| !FILES.contains_key(*name)).collect();
    assert_eq!(more, ["CITATION.cff", "LICENSE", "README.md", "SHA256SUMS"]);
    let (good, said) = shell(&format!("cd {folder} && sha256sum -c SHA256SUMS"));
    assert!(good && said.lines().count() == unpacked.len() - 1, "{said}");
    let licence = fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../LICENSE-MIT")).unwrap();
    assert_eq!(unpacked["LICENSE"], licence);
    // Its folder is a folder of references, and a changed file is seen.
    assert_eq!(problems::read(&dir.path().join(&folder)).unwrap().len(), problems::all().len());
    let start = dir.path().join(&folder).join("poles/start.csv");
    fs::write(&start, fs::read_to_string(&start).unwrap() + "\n").unwrap();
    assert!(!shell(&format!("cd {folder} && sha256sum -c --quiet SHA256SUMS")).0);
}

/// An outsider has not the paper at hand: no source is a bare number.
#[test]
fn sources_are_named_in_words() {
    for built in problems::built() {
        for source in &built.problem.equations {
            let closures = ["Advani & Tucker", "Verleye & Dupret", "Verweyst", "Chung & Kwon"];
            let models = ["O'Gara & Tucker", "Phelps & Tucker", "Tseng, Chang & Hsu", "Bakharev, Yu"];
            let papers = [&["Lee & Springer", "Folgar & Tucker"][..], &closures, &models].concat();
            let named = papers.iter().any(|paper| source.contains(paper));
            assert!(named, "{}: {source}", built.problem.name);
            assert!(source.split(' ').count() > 5, "{}: {source}", built.problem.name);
        }
    }
}
