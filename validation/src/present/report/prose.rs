//! Plain text as HTML: escaped, typeset, and with links to parts of the report.

use super::Report;
use crate::files::text::escaped;
use crate::present::markup::{Piece, pieces, powers, subscripts};
use std::collections::BTreeSet;

pub(super) struct Anchors {
    known: BTreeSet<String>,
    /// Names of figures in the report's order: a number links to its first figure.
    figures: Vec<String>,
}

impl Anchors {
    pub(super) fn of(report: &Report) -> Self {
        let sections = &report.sections;
        let figures: Vec<_> = sections.figures().map(|figure| figure.name.clone()).collect();
        let cases = report.cases.iter().map(|row| format!("case-{}", row.name));
        let equations = (sections.equations.iter()).map(|e| format!("equation-{}", e.number));
        Self { known: cases.chain(equations).collect(), figures }
    }

    pub(super) fn html(&self, text: &str) -> String {
        let pieces = pieces(text);
        let linked = |k: usize| match pieces.get(k) {
            Some(Piece::Figure(number)) => self.figure(number),
            _ => None,
        };
        let html = pieces.iter().enumerate().map(|(k, piece)| match piece {
            // The word belongs to the link, as a single digit is hard to hit.
            Piece::Text(text) => match (text.strip_suffix("Fig. "), linked(k + 1)) {
                (Some(before), Some(_)) => typeset(before),
                _ => typeset(text),
            },
            Piece::Code(code) => self.link(&format!("case-{code}"), format!("<code>{}</code>", breakable(code))),
            Piece::Equation(number) => self.link(&format!("equation-{number}"), escaped(number)),
            Piece::Figure(number) => {
                let before = k.checked_sub(1).and_then(|k| pieces.get(k));
                let word = match before {
                    Some(Piece::Text(text)) if text.ends_with("Fig. ") => "Fig.\u{a0}",
                    _ => "",
                };
                match self.figure(number) {
                    Some(name) => anchor(&format!("figure-{name}"), &format!("{word}{}", escaped(number))),
                    None => escaped(number),
                }
            }
        });
        html.collect()
    }

    /// The first figure with this number: `fig4-n20` or `fig5`.
    fn figure(&self, number: &str) -> Option<&String> {
        let is = |name: &&String| {
            let rest = name.strip_prefix("fig").and_then(|name| name.strip_prefix(number));
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
        };
        self.figures.iter().find(is)
    }

    /// A link to this anchor, or the bare text if there is none.
    fn link(&self, target: &str, html: String) -> String {
        if self.known.contains(target) { anchor(target, &html) } else { html }
    }
}

/// Code whose lines break at blanks; a word that is wider than a phone, or in a narrow column, also after `_` and `::`.
pub(super) fn breakable(code: &str) -> String {
    /// Letters of code that fit a line on a phone.
    const MOST: usize = 36;
    let typeset = |part: &str| {
        let word = part.trim_end();
        let html = escaped(word).replace("::", "::<wbr/>").replace('_', "_<wbr/>");
        let breaks = word.contains(['-', '_', ':', '/']) && word.chars().count() <= MOST;
        let html = if breaks { format!("<span>{html}</span>") } else { html };
        html + &part[word.len()..]
    };
    code.split_inclusive(char::is_whitespace).map(typeset).collect()
}

fn anchor(target: &str, html: &str) -> String {
    format!("<a href=\"#{}\">{html}</a>", escaped(target))
}

pub(crate) fn typeset(text: &str) -> String {
    // An error stays with its sign at a line break.
    let text = powers(text).replace("± ", "±\u{a0}");
    let parts = subscripts(&text)
        .into_iter()
        .map(|(below, part)| if below { format!("<sub>{}</sub>", escaped(part)) } else { escaped(part) });
    parts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_there_is_linked() {
        let anchors = Anchors {
            known: ["case-a", "equation-A.7"].map(String::from).into(),
            figures: ["fig4-n20", "fig4-n50", "fig10"].map(String::from).into(),
        };
        for (text, html) in [
            ("`a` & `b`", "<a href=\"#case-a\"><code>a</code></a> &amp; <code>b</code>"),
            ("`a_b::c`", "<code><span>a_<wbr/>b::<wbr/>c</span></code>"),
            ("`run --out a`", "<code>run <span>--out</span> a</code>"),
            ("eqs 5, A.7", "eqs 5, <a href=\"#equation-A.7\">A.7</a>"),
            ("Fig. 4", "<a href=\"#figure-fig4-n20\">Fig.\u{a0}4</a>"),
            ("in Figs 4 and 1", "in Figs <a href=\"#figure-fig4-n20\">4</a> and 1"),
            ("Fig. 1", "Fig. 1"),
            ("0.5 ± 0.1", "0.5 ±\u{a0}0.1"),
            ("r_e < \"5\"", "r<sub>e</sub> &lt; &quot;5&quot;"),
        ] {
            assert_eq!(anchors.html(text), html);
        }
    }
}
