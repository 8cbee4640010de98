//! The pages, read as mdBook and GitHub read them.

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A Markdown file of the repository.
pub struct Page {
    /// From the root of the repository, with `/`.
    pub path: String,
    pub text: String,
}

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Every file under a folder but built ones.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let paths = paths.filter(|path| !path.ends_with("target"));
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// Every Markdown file under a folder of the repository, ordered by its path.
pub fn under(folder: &str) -> Vec<Page> {
    let files = files(&root().join(folder)).into_iter();
    let pages = files.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let mut found: Vec<_> = pages.map(|path| page(&path)).collect();
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// The pages outside of the book.
pub fn readmes() -> Vec<Page> {
    let mut found: Vec<_> = ["README.md", "CONTRIBUTING.md", "src/README.md", "validation/README.md"]
        .map(|path| page(&root().join(path)))
        .into();
    for folder in ["validation/data", "validation/peers", "validation/published"] {
        found.extend(under(folder));
    }
    found.push(page(&root().join("validation/python/README.md")));
    found
}

fn page(path: &Path) -> Page {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Page { path: path.strip_prefix(root()).unwrap().to_str().unwrap().replace('\\', "/"), text }
}

/// The Markdown of a page.
pub fn events(text: &str) -> impl Iterator<Item = Event<'_>> {
    places(text).map(|(event, _)| event)
}

/// The same, each with its place in `text`.
pub fn places(text: &str) -> impl Iterator<Item = (Event<'_>, Range<usize>)> {
    Parser::new_ext(text, Options::ENABLE_TABLES | Options::ENABLE_MATH | Options::ENABLE_FOOTNOTES).into_offset_iter()
}

/// The fenced code blocks of a page: what follows the fence, and the text.
pub fn blocks(text: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    let mut inside = false;
    for event in events(text) {
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                found.push((info.to_string(), String::new()));
                inside = true;
            }
            Event::End(TagEnd::CodeBlock) => inside = false,
            Event::Text(text) if inside => found.last_mut().unwrap().1 += &text,
            _ => {}
        }
    }
    found
}

/// The anchors of a page's headings, as mdBook and GitHub make them.
pub fn anchors(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut heading: Option<String> = None;
    let mut before = BTreeMap::new();
    for event in events(text) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::Text(text) | Event::Code(text) | Event::InlineMath(text) => {
                heading.as_mut().into_iter().for_each(|heading| heading.push_str(&text));
            }
            Event::End(TagEnd::Heading(_)) => {
                let id = anchor(&heading.take().unwrap());
                let same: &mut usize = before.entry(id.clone()).or_default();
                found.push(if *same == 0 { id } else { format!("{id}-{same}") });
                *same += 1;
            }
            _ => {}
        }
    }
    found
}

fn anchor(heading: &str) -> String {
    let sign = |sign: char| match sign {
        _ if sign.is_alphanumeric() || sign == '_' || sign == '-' => Some(sign.to_lowercase().next().unwrap()),
        _ if sign.is_whitespace() => Some('-'),
        _ => None,
    };
    heading.trim().chars().filter_map(sign).collect()
}
