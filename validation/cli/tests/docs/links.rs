//! Links and pictures that stay in the repository.

use crate::pages::{Page, anchors, events, files, readmes, root, under};
use pulldown_cmark::{Event, Tag};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// What is wrong with the links of a page. A page of the book may lead to other files of the book only: the rest is not
/// built.
fn broken(page: &Page) -> Vec<String> {
    let mut wrong = Vec::new();
    for event in events(&page.text) {
        let (Event::Start(Tag::Link { dest_url, .. }) | Event::Start(Tag::Image { dest_url, .. })) = event else {
            continue;
        };
        if dest_url.contains("://") || dest_url.starts_with("mailto:") {
            continue;
        }
        let (file, anchor) = dest_url.split_once('#').unwrap_or((&dest_url, ""));
        let path = match file {
            "" => PathBuf::from(&page.path),
            _ => plain(&Path::new(&page.path).parent().unwrap().join(file)),
        };
        let in_book = !page.path.starts_with("docs/src/") || path.starts_with("docs/src");
        let text = fs::read_to_string(root().join(&path)).unwrap_or_default();
        if !in_book {
            wrong.push(format!("{}: {dest_url} leaves the book", page.path));
        } else if !root().join(&path).exists() {
            wrong.push(format!("{}: {dest_url} is not there", page.path));
        } else if !anchor.is_empty() && !anchors(&text).iter().any(|id| id == anchor) {
            wrong.push(format!("{}: {dest_url} has no such heading", page.path));
        }
    }
    wrong
}

/// The path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut found = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(found.pop()),
            Component::CurDir => {}
            part => found.push(part),
        }
    }
    found
}

#[test]
fn every_link_leads_somewhere() {
    let wrong: Vec<_> = under("docs/src").iter().chain(&readmes()).flat_map(broken).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_link_that_leads_nowhere_is_seen() {
    let number = |path: &str, text: &str| broken(&Page { path: path.into(), text: text.into() }).len();
    let book = "docs/src/reference/keys.md";
    assert_eq!(
        number(book, "[a](axes.md) [b](axes.md#axes-and-units) [c](../README.md) [d](https://example.org/x)"),
        0
    );
    for text in
        ["[a](no.md)", "![a](no.svg)", "[a](axes.md#no)", "[a](#no)", "[a]\n\n[a]: no.md", "[a](../../../README.md)"]
    {
        assert_eq!(number(book, text), 1, "{text}");
    }
    assert_eq!(number("README.md", "[a](docs/src/README.md)"), 0);
    assert_eq!(number("README.md", "`[a](no.md)`"), 0);
}

/// mdBook builds what SUMMARY.md names, and nothing else.
#[test]
fn the_table_of_contents_has_every_page_once() {
    let pages = under("docs/src");
    let (summary, pages): (Vec<_>, Vec<_>) = pages.into_iter().partition(|page| page.path == "docs/src/SUMMARY.md");
    let mut listed: Vec<_> = (events(&summary[0].text))
        .filter_map(|event| match event {
            Event::Start(Tag::Link { dest_url, .. }) => Some(format!("docs/src/{dest_url}")),
            _ => None,
        })
        .collect();
    assert_eq!(listed.first().map(String::as_str), Some("docs/src/README.md"));
    let number = listed.len();
    listed.sort();
    let listed: BTreeSet<_> = listed.into_iter().collect();
    assert_eq!(listed.len(), number, "a page is listed twice");
    let there: BTreeSet<_> = pages.into_iter().map(|page| page.path).collect();
    assert_eq!(listed, there);
}

/// Pictures that no page shows are left over.
#[test]
fn every_picture_of_the_book_is_shown() {
    let pages: String = under("docs/src").into_iter().chain(readmes()).map(|page| page.text).collect();
    for entry in fs::read_dir(root().join("docs/src/images")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(pages.contains(&format!("images/{name})")), "{name}");
    }
}

/// The pages that sources, scripts and messages name, as `docs/src/theory/fits.md`.
fn named(text: &str) -> impl Iterator<Item = &str> {
    text.match_indices("docs/").filter_map(|(start, _)| {
        let rest = &text[start..];
        let end =
            rest.find(|sign: char| !(sign.is_ascii_alphanumeric() || "/._-".contains(sign))).unwrap_or(rest.len());
        let path = rest[..end].trim_end_matches('.');
        path.rsplit_once('.').filter(|(_, kind)| ["md", "svg", "sh", "tsv", "py"].contains(kind)).map(|_| path)
    })
}

#[test]
fn pages_named_in_the_sources_are_there() {
    let (mut wrong, mut number) = (Vec::new(), 0);
    let paths = ["src", "tests", "validation", ".ci", ".cargo"].map(|folder| files(&root().join(folder))).concat();
    // But the controls of these tests.
    for path in paths.iter().filter(|path| !path.parent().unwrap().ends_with("tests/docs")) {
        for page in named(&fs::read_to_string(path).unwrap_or_default()) {
            number += 1;
            if !root().join(page).exists() {
                wrong.push(format!("{}: {page}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(number > 20, "{number}");
    let seen: Vec<_> =
        named("see docs/src/no.md, (docs/numbers.sh) and docs/src/a/b.md. In docs/src/ no more").collect();
    assert_eq!(seen, ["docs/src/no.md", "docs/numbers.sh", "docs/src/a/b.md"]);
}
