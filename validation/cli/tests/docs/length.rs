//! A book that is read has an end.

use crate::pages::{readmes, under};

/// Words of a part of the book, tables too. Marks of numbers do not count.
fn words(part: &str) -> usize {
    let word = |word: &&str| word.contains(char::is_alphanumeric) && !word.starts_with("<!--");
    under(&format!("docs/src/{part}")).iter().map(|page| page.text.split_whitespace().filter(word).count()).sum()
}

#[test]
fn the_parts_keep_to_their_length() {
    let parts = ["user", "theory", "reference", "verification", "validation"].map(|part| (part, words(part)));
    assert!(parts.iter().all(|(_, words)| *words > 500), "{parts:?}");
    let total: usize = parts.iter().map(|(_, words)| words).sum();
    assert!(total <= 22_000, "{total} words: {parts:?}");
    for (part, most) in [("", 24_000), ("reference", 5_000), ("verification", 2_500)] {
        assert!(words(part) <= most, "{part}: {} words", words(part));
    }
}

#[test]
fn the_readme_is_read_in_five_minutes() {
    let lines = readmes()[0].text.lines().count();
    assert!(lines <= 120, "README.md has {lines} lines");
}
