//! A check of XML for tests of pictures and reports.

/// True if all tags are closed in order, no text has a bare `<`, `>` or `&`, and XML 1.0 allows every character.
pub(crate) fn is_well_formed(xml: &str) -> bool {
    let allowed = |c: char| !c.is_control() || matches!(c, '\t' | '\n' | '\r');
    if !xml.chars().all(|c| allowed(c) && !matches!(c, '\u{fffe}' | '\u{ffff}')) {
        return false;
    }
    let mut open = Vec::new();
    for part in xml.split('<').skip(1) {
        let Some((tag, text)) = part.split_once('>') else {
            return false;
        };
        let entity = |rest: &str| {
            let name = rest.split(';').next().unwrap_or("");
            ["amp", "lt", "gt", "quot"].contains(&name) || name.starts_with('#')
        };
        if text.contains('>') || !text.split('&').skip(1).all(entity) {
            return false;
        }
        let name = tag.split_whitespace().next().unwrap_or("");
        match name.strip_prefix('/') {
            Some(name) if open.pop() != Some(name) => return false,
            None if !tag.ends_with('/') && !tag.starts_with(['!', '?']) => open.push(name),
            _ => {}
        }
    }
    open.is_empty()
}

#[test]
fn broken_documents_are_seen() {
    assert!(is_well_formed("<!doctype html><a b=\"c\"><d/>x &lt; y</a>"));
    for broken in
        ["<a>", "<a><b></a></b>", "<a>x & y</a>", "<a>x > y</a>", "</a>", "<a", "<a>\u{1b}</a>", "<a>\u{fffe}</a>"]
    {
        assert!(!is_well_formed(broken), "{broken}");
    }
}
