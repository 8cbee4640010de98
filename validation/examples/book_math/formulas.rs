//! Formulas and commands in Markdown.

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{ParserError, Storage, push_mathml};

/// `page` with MathML for each `$…$` and `$$…$$` outside of code, and with options that a line does not break, except
/// in headings, whose anchors are made from their text.
///
/// # Errors
/// The first formula that is not LaTeX, and why.
pub fn replaced(page: &str) -> Result<String, String> {
    let options = Options::ENABLE_MATH | Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES;
    let mut text = String::new();
    let (mut end, mut in_heading) = (0, false);
    for (event, place) in Parser::new_ext(page, options).into_offset_iter() {
        let formula = |formula, mode| mathml(formula, mode).map_err(|error| format!("${formula}$: {error}"));
        let html = match &event {
            Event::InlineMath(text) => formula(text, DisplayMode::Inline)?,
            Event::DisplayMath(text) => formula(text, DisplayMode::Block)?,
            Event::Code(code) if !in_heading && code.contains('-') => unbroken(code),
            Event::Start(Tag::Heading { .. }) | Event::End(TagEnd::Heading(_)) => {
                in_heading = !in_heading;
                continue;
            }
            _ => continue,
        };
        text += &page[end..place.start];
        text += &html;
        end = place.end;
    }
    Ok(text + &page[end..])
}

/// Code as HTML whose lines break at blanks, and not after a hyphen; a word that is wider than a phone breaks anywhere.
fn unbroken(code: &str) -> String {
    const MOST: usize = 36;
    let sign = |sign: char| if sign.is_ascii_punctuation() { format!("&#{};", u32::from(sign)) } else { sign.into() };
    let word = |word: &str| {
        let html: String = word.chars().map(sign).collect();
        // Styled by docs/formulas.css.
        if word.chars().count() > MOST { html } else { format!("<span class=\"word\">{html}</span>") }
    };
    format!("<code>{}</code>", code.split(' ').map(word).collect::<Vec<_>>().join(" "))
}

fn mathml(formula: &str, display_mode: DisplayMode) -> Result<String, String> {
    let storage = Storage::new();
    let parsed: Result<Vec<_>, _> = pulldown_latex::Parser::new(formula, &storage).collect();
    let events = parsed.map_err(|error| error.to_string())?;
    let mut mathml = String::new();
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    push_mathml(&mut mathml, events.into_iter().map(Ok::<_, ParserError>), config)
        .map_err(|error| error.to_string())?;
    let plain = plain(&mathml);
    Ok(match display_mode {
        DisplayMode::Inline => plain,
        // Styled by docs/formulas.css.
        DisplayMode::Block => format!("<span class=\"formula\">{plain}</span>"),
    })
}

/// The same on one line, with no sign between its tags that Markdown reads: a `*` or `|` of a formula is neither
/// emphasis nor the end of a cell. Attributes are parted by blanks, which pulldown-latex 0.8 leaves out after
/// `stretchy="true"`.
fn plain(mathml: &str) -> String {
    let (mut text, mut in_tag, mut in_value) = (String::new(), false, false);
    for sign in mathml.chars() {
        match sign {
            '<' => in_tag = true,
            '>' if in_tag => in_tag = false,
            '"' if in_tag => in_value = !in_value,
            // Of what is already written as `&lt;`.
            '&' | ';' | '#' => {}
            '\n' => {
                text.push(' ');
                continue;
            }
            _ if !in_tag && sign.is_ascii_punctuation() => {
                text += &format!("&#{};", u32::from(sign));
                continue;
            }
            _ if in_tag && !in_value && sign.is_ascii_alphabetic() && text.ends_with('"') => text.push(' '),
            _ => {}
        }
        text.push(sign);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_become_mathml_and_code_stays() {
        let page = "A rod has $\\Lambda = 1$ or `$5` and\n\n$$q = \\exp(A t)\\,p$$\n\n```sh\necho $HOME $PATH\n```\n";
        let text = replaced(page).unwrap();
        assert!(text.starts_with("A rod has <math") && text.contains(">Λ</mi>"), "{text}");
        assert!(text.contains("or `$5` and") && text.contains("display=\"block\""), "{text}");
        assert!(text.ends_with("\n```sh\necho $HOME $PATH\n```\n"), "{text}");
    }

    #[test]
    fn a_page_without_formulas_stays() {
        let page = "It costs 5 $ or 6 $.\n\n| a | b |\n| --- | --- |\n| `$x$` | 1 |\n";
        assert_eq!(replaced(page).unwrap(), page);
    }

    #[test]
    fn options_are_words_except_in_headings() {
        let text = replaced("# The `--out`\n\n| [`run --set a\\|b`](c.md) | `_x_` |\n| --- | --- |\n").unwrap();
        let words = "<code><span class=\"word\">run</span> <span class=\"word\">&#45;&#45;set</span> \
                     <span class=\"word\">a&#124;b</span></code>";
        assert_eq!(text, format!("# The `--out`\n\n| [{words}](c.md) | `_x_` |\n| --- | --- |\n"));
        let long = "a-".repeat(30);
        assert!(!replaced(&format!("`{long}`")).unwrap().contains("span"));
    }

    /// The rest of a page reads on as Markdown: what stands between tags is only text to it.
    #[test]
    fn no_sign_of_a_formula_is_markdown() {
        let text = replaced("| a |\n| --- |\n| $\\lvert p_1 \\rvert * a * b_1 < c_{ij}$ |\n").unwrap();
        let row = text.lines().nth(2).unwrap();
        assert_eq!(row.matches('|').count(), 2, "{row}");
        let parsed: Vec<_> = Parser::new_ext(&text, Options::ENABLE_TABLES).collect();
        let of_markdown = |event: &Event| matches!(event, Event::Start(pulldown_cmark::Tag::Emphasis) | Event::Code(_));
        assert!(!parsed.iter().any(of_markdown));
        // The control: the same formula as the library writes it.
        let raw = format!("<math>{}</math>", "<mi>a</mi><mo>*</mo><mi>b</mi><mo>*</mo>");
        assert!(Parser::new(&raw).any(|event| of_markdown(&event)));
        assert!(!Parser::new(&plain(&raw)).any(|event| of_markdown(&event)));
    }

    #[test]
    fn tags_are_tags_to_markdown() {
        let tags = |page: &str| Parser::new(page).filter(|event| matches!(event, Event::InlineHtml(_))).count();
        let text = replaced("a $\\Big[ x > 1 \\Big]$ b").unwrap();
        assert_eq!(tags(&text), text.matches('<').count(), "{text}");
        assert_eq!(text.matches('<').count(), text.matches('>').count(), "{text}");
        // The control: what the library writes.
        let raw = r#"a <mo stretchy="true"minsize="1.8em">[</mo>"#;
        assert!(tags(raw) < 2 && tags(&plain(raw)) == 2);
    }

    #[test]
    fn what_is_no_formula_is_refused_with_its_text() {
        for (formula, wrong) in [("\\frac{1}", true), ("\\nosuchcommand x", true), ("\\frac{1}{2}", false)] {
            let found = replaced(&format!("a ${formula}$ b"));
            assert_eq!(found.is_err(), wrong, "{formula}");
            assert!(!wrong || found.unwrap_err().contains(formula));
        }
    }
}
