//! Pages and files that are made from the program are what it would make now.

use crate::bounded::{Bounded, bash};
use crate::pages::root;
use shearbed_validation::cases::catalogue;
use shearbed_validation::input::scene_keys;
use std::fs;

/// Compares a committed file with what is made now, or writes it.
fn fresh(file: &str, expected: &str) {
    let path = root().join(file);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, expected).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(found == expected, "{file} is stale: UPDATE_DOCS=1 cargo test -p shearbed-cli --test docs");
}

#[test]
fn pages_and_the_schema_of_scenes_are_fresh() {
    fresh("docs/src/reference/commands.md", &shearbed_cli::commands());
    fresh("docs/src/verification/equations.md", &catalogue::markdown());
    let head = "# Keys of a scene\n\nMade from the table of keys that the program reads by; `shearbed scenes --keys` \
        prints it. A JSON Schema for editors is `validation/schemas/scene.json`. [Scenes](../user/scenes.md) shows how \
        keys go together.\n\n";
    fresh("docs/src/reference/keys.md", &format!("{head}{}", scene_keys::markdown()));
    let schema = serde_json::to_string_pretty(&scene_keys::schema()).unwrap();
    fresh("validation/schemas/scene.json", &format!("{schema}\n"));
}

/// Those that take seconds (five by Python, where it is here); with DOCS_SLOW also the four of minutes.
/// `closures-error` is compared where its numbers are, by the script of the table `closures`.
#[test]
fn pictures_are_those_of_their_script() {
    let dir = tempfile::tempdir().unwrap();
    let drawn = if bash(dir.path(), "command -v python3").ended().status.success() { 5 } else { 0 };
    let mut count = 7 + drawn;
    let draw = |names: &str| {
        let ended = bash(dir.path(), &format!("bash '{}/docs/pictures.sh' made {names}", root().display())).ended();
        assert!(ended.status.success(), "{names}: {}", String::from_utf8_lossy(&ended.stderr));
    };
    draw("");
    if std::env::var_os("DOCS_SLOW").is_some() {
        draw("orders fit-points folgar-tucker");
        count += 6;
    }
    let pictures: Vec<_> = fs::read_dir(dir.path().join("made")).unwrap().map(|entry| entry.unwrap()).collect();
    assert_eq!(pictures.len(), count);
    for picture in pictures {
        let file = format!("docs/src/images/{}", picture.file_name().display());
        fresh(&file, &fs::read_to_string(picture.path()).unwrap());
    }
}
