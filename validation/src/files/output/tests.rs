use super::*;
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

fn contents(dir: &Path) -> BTreeMap<String, Option<String>> {
    fs::read_dir(dir)
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read_to_string(entry.path()).ok()))
        .collect()
}

fn outputs(names: &[&str], text: &str) -> Vec<Output> {
    names.iter().map(|name| ((*name).to_owned(), text.to_owned())).collect()
}

fn folder(dir: &Path, force: bool) -> ResultFolder {
    ResultFolder::new(dir, "test", json!({}), force)
}

/// A process that is killed between two moves leaves a record of both sets. No reader takes any of its files, and the
/// same command goes on.
#[test]
fn half_a_replacement_is_seen_and_completed() {
    let dir = tempfile::tempdir().unwrap();
    let own = folder(dir.path(), false);
    own.write(&outputs(&["a", "b", "gone"], "old")).unwrap();
    let claim = Claim::open(dir.path(), PATIENCE).unwrap().unwrap();
    let begun = Record::new(own.origin(), &outputs(&["a", "b"], "new"));
    let begun = begun.replacing(own.earlier(&claim));
    drop(claim);
    fs::write(dir.path().join(RECORD), begun.file().1).unwrap();
    fs::write(dir.path().join("a"), "new").unwrap();
    let read = Record::read(dir.path()).unwrap().unwrap();
    for (name, text) in [("a", "new"), ("b", "old")] {
        let why = read.check(name, &Sum::of(text.as_bytes())).unwrap_err();
        assert!(why.contains("`shearbed test` was stopped while it replaced files there"), "{why}");
    }
    // A file that was edited meanwhile stays.
    fs::write(dir.path().join("b"), "mine").unwrap();
    let Refused(why) = own.write(&outputs(&["a", "b"], "new")).unwrap_err();
    assert!(why.contains("b: was changed after"), "{why}");
    fs::write(dir.path().join("b"), "old").unwrap();
    own.write(&outputs(&["a", "b"], "new")).unwrap();
    let found = contents(dir.path());
    assert_eq!(found.keys().collect::<Vec<_>>(), ["a", "b", "shearbed.json"]);
    assert_eq!(found["b"].as_deref(), Some("new"));
    assert!(Record::read(dir.path()).unwrap().unwrap().check("b", &Sum::of(b"new")).is_ok());
}

/// Threads make and replace one folder independently. A reader finds at any moment one whole set, or a record that says
/// that it is none.
#[test]
fn a_reader_finds_one_whole_set_or_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let shared = &dir.path().join("shared");
    let names: Vec<_> = (10..50).map(|k| format!("f{k}")).collect();
    let set = |text: &str| names.iter().map(|name| (name.clone(), text.to_owned())).collect::<Vec<_>>();
    let left = &AtomicUsize::new(3);
    let looked = std::thread::scope(|scope| {
        for writer in 0..3 {
            let set = &set;
            scope.spawn(move || {
                for round in 0..10 {
                    folder(shared, true).write(&set(&format!("{writer} {round}"))).unwrap();
                }
                left.fetch_sub(1, Ordering::Relaxed);
            });
        }
        let mut looked = 0;
        while left.load(Ordering::Relaxed) > 0 {
            let record = || fs::read(shared.join(RECORD)).unwrap_or_default();
            let before = record();
            let found = ["f10", "f49"].map(|name| fs::read(shared.join(name)).unwrap_or_default());
            // No two sets have the same record.
            if !before.is_empty() && before == record() {
                let record: Record = serde_json::from_slice(&before).unwrap();
                let whole = ["f10", "f49"].iter().zip(&found).all(|(name, text)| record.files[*name] == Sum::of(text));
                assert!(whole || record.is_complete().is_err(), "{found:?}");
                looked += usize::from(whole);
            }
        }
        looked
    });
    assert!(looked > 0);
    assert_eq!(contents(shared).len(), names.len() + 1);
}

/// A file that is edited while a command works stays, and so does the command's work.
#[test]
fn an_edit_meanwhile_costs_no_results() {
    let above = tempfile::tempdir().unwrap();
    let dir = above.path().join("out");
    let own = folder(&dir, false);
    own.write(&outputs(&["a", "b"], "old")).unwrap();
    fs::write(dir.join("a"), "mine").unwrap();
    fs::write(above.path().join("out-2"), "mine too").unwrap();
    let Refused(why) = own.write(&outputs(&["a", "b"], "new")).unwrap_err();
    assert!(why.contains("out/a: was changed after"), "{why}");
    assert_eq!(own.write_beside(&outputs(&["a", "b"], "new")), Some(above.path().join("out-3")));
    let [kept, new] = ["out", "out-3"].map(|name| contents(&above.path().join(name)));
    assert_eq!([&kept["a"], &kept["b"]].map(Option::as_deref), [Some("mine"), Some("old")]);
    assert_eq!([&new["a"], &new["b"]].map(Option::as_deref), [Some("new"), Some("new")]);
    let record = Record::read(&above.path().join("out-3")).unwrap().unwrap();
    assert!(record.check("a", &Sum::of(b"new")).is_ok());
}

/// What another process wrote from other inputs since a command began is not replaced by it; a command that begins now
/// replaces it.
#[test]
fn results_of_another_process_meanwhile_stay() {
    let above = tempfile::tempdir().unwrap();
    let dir = above.path().join("out");
    let begun = |alpha: f64| ResultFolder::new(&dir, "run", json!({ "alpha": alpha }), false);
    let [first, second, same] = [begun(1.0), begun(2.0), begun(1.0)];
    first.write(&outputs(&["a"], "1")).unwrap();
    same.write(&outputs(&["a"], "1")).unwrap();
    let Refused(why) = second.write(&outputs(&["a"], "2")).unwrap_err();
    assert!(why.contains("`shearbed run` from other input are here since: alpha was 1.0 and is 2.0 now"), "{why}");
    assert_eq!(second.write_beside(&outputs(&["a"], "2")), Some(above.path().join("out-2")));
    assert_eq!(contents(&dir)["a"].as_deref(), Some("1"));
    begun(2.0).write(&outputs(&["a"], "2")).unwrap();
    assert_eq!(contents(&dir)["a"].as_deref(), Some("2"));
}

/// Read-only results of a command stay, except by force.
#[test]
fn read_only_results_stay() {
    let above = tempfile::tempdir().unwrap();
    let dir = above.path().join("out");
    folder(&dir, false).write(&outputs(&["a"], "old")).unwrap();
    let mut permissions = fs::metadata(dir.join("a")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(dir.join("a"), permissions).unwrap();
    let Refused(why) = folder(&dir, false).write(&outputs(&["a"], "new")).unwrap_err();
    assert!(why.contains("out/a: is read-only"), "{why}");
    assert_eq!(contents(&dir)["a"].as_deref(), Some("old"));
    folder(&dir, true).write(&outputs(&["a"], "new")).unwrap();
    assert_eq!(contents(&dir)["a"].as_deref(), Some("new"));
}

/// A hidden folder is one that a killed process left if it is not locked, holds something and still has its name.
#[test]
fn what_another_process_is_writing_is_not_taken_for_left_over() {
    let above = tempfile::tempdir().unwrap();
    let dir = Dir::open_ambient_dir(above.path(), ambient_authority()).unwrap();
    let name = ".shearbed-0123456789abcdef";
    dir.create_dir(name).unwrap();
    let found = dir.open_dir(name).unwrap();
    let is_left = || stage::is_left(&dir, name, &found);
    assert!(!is_left());
    let lock = stage::lock(&found, PATIENCE).unwrap();
    dir.write(format!("{name}/a"), "half").unwrap();
    assert!(!is_left());
    drop(lock);
    assert!(is_left());
    dir.rename(name, &dir, "out").unwrap();
    assert!(!is_left());
}

#[cfg(unix)]
#[test]
fn no_link_below_the_folder_is_followed() {
    use std::os::unix::fs::symlink;
    let dir = tempfile::tempdir().unwrap();
    let [out, home] = ["out", "home"].map(|name| dir.path().join(name));
    for name in [&out, &home] {
        fs::create_dir(name).unwrap();
    }
    fs::write(home.join("keys"), "mine").unwrap();
    fs::write(out.join("kept"), "mine").unwrap();
    symlink("../home", out.join("sub")).unwrap();
    symlink("../home/keys", out.join("a")).unwrap();
    let own = folder(&out, true);
    let listed = [outputs(&["sub/keys"], "mine"), outputs(&["a"], "mine")].concat();
    fs::write(out.join(RECORD), Record::new(own.origin(), &listed).file().1).unwrap();
    let Refused(why) = own.write(&outputs(&["sub/keys"], "new")).unwrap_err();
    assert!(why.contains("sub/keys: cannot be written: sub is a link, which is not followed here"), "{why}");
    let claim = Claim::open(&out, PATIENCE).unwrap().unwrap();
    assert!(claim.write_folder("sub/new", &outputs(&["x"], "")).is_err());
    assert!(claim.remove("sub/keys").is_err());
    drop(claim);
    // In place of a link a file is written; what it led to stays, also as a listed file that is no longer written.
    own.write(&outputs(&["a"], "new")).unwrap();
    assert!(!out.join("a").is_symlink() && out.join("sub").is_symlink());
    assert_eq!(contents(&home), BTreeMap::from([("keys".to_owned(), Some("mine".to_owned()))]));
}
