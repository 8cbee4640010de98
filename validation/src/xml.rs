//! A small check that tests of pictures and reports share.

/// Every tag is closed, in order, and no text has a bare `<`, `>` or `&`.
pub(crate) fn is_well_formed(xml: &str) -> bool {
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
            None if !tag.ends_with('/') && !tag.starts_with('!') => open.push(name),
            _ => {}
        }
    }
    open.is_empty()
}

#[test]
fn broken_documents_are_seen() {
    assert!(is_well_formed("<!doctype html><a b=\"c\"><d/>x &lt; y</a>"));
    for broken in [
        "<a>",
        "<a><b></a></b>",
        "<a>x & y</a>",
        "<a>x > y</a>",
        "</a>",
        "<a",
    ] {
        assert!(!is_well_formed(broken), "{broken}");
    }
}
