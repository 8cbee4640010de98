use super::*;
use std::collections::BTreeMap;

fn contents(dir: &Path) -> BTreeMap<String, Option<String>> {
    fs::read_dir(dir)
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read_to_string(entry.path()).ok()))
        .collect()
}

fn output(name: &str, text: &str) -> Output {
    (name.to_owned(), text.to_owned())
}

#[test]
fn all_files_are_written_and_replaced() {
    let dir = tempfile::tempdir().unwrap();
    let inner = dir.path().join("a/b");
    probe(&inner, 1000).unwrap();
    assert!(!inner.exists());
    for text in ["old", "new"] {
        write_all(&inner, &[output("x", text), output("y", "")]).unwrap();
    }
    let expected = [("x", "new"), ("y", "")].map(|(name, text)| (name.to_owned(), Some(text.to_owned())));
    assert_eq!(contents(&inner), BTreeMap::from(expected));
}

#[test]
fn a_target_that_is_a_folder_leaves_everything_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("x"), "old").unwrap();
    fs::create_dir(dir.path().join("y")).unwrap();
    let before = contents(dir.path());
    let error =
        write_all(dir.path(), &[output("x", "new"), output("y", "new"), output("z", "new")]).unwrap_err();
    assert_eq!(error.path, dir.path().join("y"));
    assert_eq!(contents(dir.path()), before);
}

#[test]
fn a_folder_made_for_files_that_fail_is_removed() {
    let dir = tempfile::tempdir().unwrap();
    let made = dir.path().join("made");
    let error = write_all(&made, &[output("no/such/folder", ""), output("a\0b", "")]).unwrap_err();
    assert_eq!(error.path, made.join("no/such/folder"));
    assert!(!made.exists());
}

#[test]
fn a_folder_that_is_a_file_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("file");
    fs::write(&file, "old").unwrap();
    for dir in [file.clone(), file.join("below")] {
        assert_eq!(probe(&dir, 0).unwrap_err().path, dir);
        assert_eq!(write_all(&dir, &[output("x", "")]).unwrap_err().path, dir);
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), "old");
}

/// Threads claim, make and remove one folder independently, without disturbing each other.
#[test]
fn a_folder_that_others_make_and_remove_is_claimed() {
    let dir = tempfile::tempdir().unwrap();
    let shared = dir.path().join("shared");
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..1000 {
                    Claim::new(&shared, Duration::from_secs(600)).unwrap();
                }
            });
        }
    });
}
