//! Folders of anybody's making in which a command writes: hidden names, links, records, the user's own files.

use crate::{Taken, Target};
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use serde_json::json;
use shearbed_validation::files::checkpoint::Checkpoint;
use shearbed_validation::files::output::{RECORD, Record, Refused, ResultFolder, probe, write_one};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

/// What the command writes, or wrote.
const NAMES: [&str; 5] = ["a.csv", "b.csv", "sub/c.csv", "sub/d.csv", "points/1/e.csv"];
/// Names that programs take for hidden files, and folders.
const OTHERS: &str = ".shearbed-lock .shearbed-ready .shearbed-ready/a.csv .shearbed-ready/sub/keys \
    .shearbed-part/b.csv .shearbed-0123456789abcdeg .shearbed-0123456789abcdeg/a.csv .shearbed-mine \
    .checkpoint-kept.lock .checkpoint-kept.part kept sub sub/keys points points/1 notes.txt";
/// Places to which a link leads from the folder, inside it and outside.
const TARGETS: [&str; 7] = ["../home", "../home/keys", "../made", "user", "user/keys", ".", "a.csv"];

/// Everything below a folder: the bytes of files, the targets of links; of a folder nothing.
type Tree = BTreeMap<String, Vec<u8>>;

fn tree(dir: &Path) -> Tree {
    let mut found = Tree::new();
    for entry in fs::read_dir(dir).into_iter().flatten().flatten() {
        let (name, path) = (entry.file_name().to_string_lossy().into_owned(), entry.path());
        let kind = entry.file_type().expect("it is there");
        if kind.is_dir() {
            found.extend(tree(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
            found.insert(name + "/", Vec::new());
        } else if kind.is_symlink() {
            let target = fs::read_link(&path).expect("a link");
            found.insert(name, format!("-> {}", target.display()).into_bytes());
        } else {
            found.insert(name, fs::read(&path).expect("a file"));
        }
    }
    found
}

/// One of several.
fn any<'a>(random: &mut Pcg64Dxsm, of: &[&'a str]) -> &'a str {
    of[random.random_range(0..of.len())]
}

/// Puts files, folders and links of these names into a folder, as far as they fit together.
fn scatter(random: &mut Pcg64Dxsm, out: &Path) {
    let names: Vec<_> = NAMES.into_iter().chain(OTHERS.split_whitespace()).collect();
    for _ in 0..random.random_range(0..14) {
        let name = any(random, &names);
        let path = out.join(name);
        if let Some(above) = path.parent().filter(|above| above.symlink_metadata().is_err()) {
            let _ = fs::create_dir_all(above);
        }
        // Not through a link: that would be this harness's own doing.
        if !path.parent().is_some_and(|above| above.symlink_metadata().is_ok_and(|found| found.is_dir())) {
            continue;
        }
        let _ = match random.random_range(0..6) {
            0 => fs::create_dir(&path),
            1 | 2 => symlink(any(random, &TARGETS), &path),
            // As long as what the command wrote.
            3 => fs::write(&path, format!("own {name}")),
            _ => fs::write(&path, format!("old {name}")),
        };
    }
}

/// A record of these files, of which some lie behind links, some were changed and some are not there.
fn record(random: &mut Pcg64Dxsm, command: &str) -> String {
    let mut names: Vec<_> = NAMES.into_iter().filter(|_| random.random_bool(0.7)).collect();
    names.extend(
        ["sub/keys", "../home/keys", "/etc/hostname", "link/keys"].into_iter().filter(|_| random.random_bool(0.3)),
    );
    let old = |name: &str| if name.ends_with("keys") { "mine".to_owned() } else { format!("old {name}") };
    let files: Vec<_> = names.into_iter().map(|name| (name.to_owned(), old(name))).collect();
    let origin = ResultFolder::new(Path::new("."), command, json!({}), false).origin().clone();
    let text = Record::new(&origin, &files).file().1;
    match random.random_range(0..4) {
        0 => text.replacen("\"files\"", "\"replaces\": {}, \"files\"", 1),
        1 => text.replacen("\"files\"", "\"files\": {}, \"replaces\"", 1),
        _ => text,
    }
}

/// One folder, one command, and what must hold of them.
fn tried(case: &Path, random: &mut Pcg64Dxsm, mutated: &str) -> Result<Taken, String> {
    let (home, real) = (case.join("home"), case.join("real"));
    for dir in [&home, &real, &real.join("user")] {
        fs::create_dir_all(dir).expect("the harness makes a folder");
    }
    fs::write(home.join("keys"), "mine").expect("the harness writes");
    fs::write(real.join("user/keys"), "mine").expect("the harness writes");
    let out = case.join("out");
    match random.random_range(0..6) {
        // A folder that a link leads to is the user's choice.
        0 => symlink("real", &out).expect("a link"),
        1 => fs::create_dir(&out).expect("a folder"),
        2 => scatter(random, case),
        _ => fs::rename(&real, &out).expect("it moves"),
    }
    if out.exists() {
        scatter(random, &out);
        let command = if random.random_bool(0.8) { "run" } else { "fit" };
        let text = match random.random_range(0..5) {
            0 => None,
            1 => Some(mutated.to_owned()),
            _ => Some(record(random, command)),
        };
        if let (Some(text), false) = (text, out.join(RECORD).exists()) {
            let _ = fs::write(out.join(RECORD), text);
        }
    }
    let before = tree(case);
    let force = random.random_bool(0.4);
    let mut names: Vec<_> = NAMES.into_iter().filter(|_| random.random_bool(0.6)).collect();
    if names.is_empty() {
        names.push("a.csv");
    }
    let files: Vec<_> = names.iter().map(|name| ((*name).to_owned(), format!("new {name}"))).collect();
    let refused = |why: Refused| why.to_string();
    let (done, written) = match random.random_range(0..6) {
        0 => (write_one(&out.join(names[0]), b"new", force).map(drop).map_err(refused), None),
        1 => (probe(&out, 10, []).map_err(|error| error.to_string()), Some(vec![])),
        2 => {
            let kept = Checkpoint::open(&out.join("kept"), "run", json!({}));
            let done = kept.map_err(refused).and_then(|kept| {
                kept.read::<u8>().map_err(refused)?;
                kept.write(&7_u8).map_err(|error| error.to_string())
            });
            (done, None)
        }
        _ => (ResultFolder::new(&out, "run", json!({}), force).write(&files).map(drop).map_err(refused), Some(files)),
    };
    let after = tree(case);
    judged(&before, &after, &done, written.as_deref(), force)?;
    Ok(done.map_or_else(Taken::Refused, |()| Taken::Accepted))
}

/// Fails if a file is lost or changed that a command must leave.
fn judged(
    before: &Tree,
    after: &Tree,
    done: &Result<(), String>,
    written: Option<&[(String, String)]>,
    force: bool,
) -> Result<(), String> {
    if let Some(name) = after.keys().find(|name| !before.contains_key(*name) && name.contains(".shearbed-")) {
        return Err(format!("{name} is left"));
    }
    if done.is_err() && before != after {
        let changed = before.iter().find(|(name, bytes)| after.get(*name) != Some(bytes));
        let made = after.keys().find(|name| !before.contains_key(*name));
        return Err(format!("refused, but {changed:?} is changed, {made:?} made: {done:?}"));
    }
    let Some(written) = written.filter(|_| done.is_ok()) else {
        // One file, also where a link of its name leads: no other is changed.
        let changed = before.iter().filter(|(name, bytes)| after.get(*name) != Some(bytes)).count();
        let made = after.keys().filter(|name| !before.contains_key(*name) && !name.ends_with('/')).count();
        return if changed + made <= 1 { Ok(()) } else { Err(format!("{changed} files changed, {made} made")) };
    };
    for (name, bytes) in before {
        let inside = name.strip_prefix("out/").or(name.strip_prefix("real/"));
        let is_own = inside.is_some_and(|name| {
            let new = name == RECORD || written.iter().any(|(own, _)| own == name);
            let old = bytes == format!("old {name}").as_bytes();
            new && (force || old || name == RECORD) || old && !written.is_empty()
        });
        if after.get(name) != Some(bytes) && !is_own {
            return Err(format!("{name} was {:?} and is {:?}", lossy(Some(bytes)), lossy(after.get(name))));
        }
    }
    let outside = |name: &&String| !name.starts_with("out/") && !name.starts_with("real/") && *name != "out/";
    if let Some(name) = after.keys().filter(outside).find(|name| !before.contains_key(*name)) {
        return Err(format!("{name} is made"));
    }
    for (name, text) in written {
        let found = after.get(&format!("out/{name}")).or(after.get(&format!("real/{name}")));
        if found.map(Vec::as_slice) != Some(text.as_bytes()) {
            return Err(format!("{name} is not written: {:?}", lossy(found)));
        }
    }
    Ok(())
}

fn lossy(bytes: Option<&Vec<u8>>) -> Option<String> {
    bytes.map(|bytes| String::from_utf8_lossy(bytes).into_owned())
}

/// Folders in which a command writes. The mutated file is a record; its bytes also choose everything else.
pub fn folders() -> Target {
    let text = record(&mut Pcg64Dxsm::seed_from_u64(1), "run");
    Target {
        name: "folders",
        corpus: vec![vec![(RECORD, text.into_bytes())]],
        take: Box::new(|folder, files| {
            let bytes = &files[0].1;
            let mut random = Pcg64Dxsm::seed_from_u64(u64::from(crc32fast::hash(bytes)));
            let case = folder.join(format!("{:016x}", random.next_u64()));
            let taken = tried(&case, &mut random, &String::from_utf8_lossy(bytes));
            fs::remove_dir_all(&case).map_err(|error| error.to_string())?;
            taken
        }),
    }
}
