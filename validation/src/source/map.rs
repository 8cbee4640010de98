//! `docs/architecture.md` is a map of these sources.

use super::reach::Source;
use super::{File, core, files, oracle, suite};
use std::collections::BTreeSet;
use std::path::Path;

/// What stands in backquotes.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

fn map() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/architecture.md");
    std::fs::read_to_string(path).unwrap()
}

/// Rooms that no name in the texts is: `lib.rs`, and what a row calls `name.rs` or `name/`.
fn missing<'a>(files: &'a [File], text: &str) -> BTreeSet<&'a str> {
    let named: BTreeSet<&str> = quoted(text)
        .into_iter()
        .map(|name| {
            name.trim_start_matches("src/")
                .trim_end_matches('/')
                .trim_end_matches(".rs")
        })
        .collect();
    let rooms = files.iter().map(|file| &file.room[..]);
    rooms
        .filter(|room| *room != "lib" && !named.contains(room))
        .collect()
}

/// Names `before::name` in backquotes that no crate has.
fn unknown<'a>(sources: &[Source], text: &'a str) -> Vec<&'a str> {
    let names = quoted(text).into_iter().filter(|name| name.contains("::"));
    names
        .filter(|path| {
            let mut parts = path.rsplit("::");
            let (name, before) = (parts.next().unwrap(), parts.next().unwrap());
            !sources.iter().any(|source| source.has(before, name))
        })
        .collect()
}

#[test]
fn every_room_is_on_the_map_and_every_name_on_it_is_there() {
    let text = map();
    let (of_core, rest) = text.split_once("## The oracles").unwrap();
    let (of_oracle, of_suite) = rest.split_once("## The suite").unwrap();
    let [core, oracle, suite] = [core(), oracle(), suite()].map(|folder| files(&folder));
    assert_eq!(missing(&core, of_core), BTreeSet::new());
    assert_eq!(missing(&oracle, of_oracle), BTreeSet::new());
    assert_eq!(missing(&suite, of_suite), BTreeSet::new());
    let sources = [&core, &oracle, &suite].map(|files| Source::of(files));
    assert_eq!(unknown(&sources, &text), [""; 0]);
    // A room or a name that is taken away is found.
    let without = of_core.replace("`border.rs`", "");
    assert_eq!(missing(&core, &without), BTreeSet::from(["border"]));
    assert_eq!(
        unknown(&sources, "`Plan::new` and `Scene::check`"),
        ["Scene::check"]
    );
}
