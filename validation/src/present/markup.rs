//! Plain text for the writers: finds `code`, cited equations and figures, subscripts.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Piece<'a> {
    /// Plain text, which may have subscripts.
    Text(&'a str),
    /// Text that was in backticks.
    Code(&'a str),
    /// The number of a cited equation, as `15` or `A.7`.
    Equation(&'a str),
    /// The number of a cited figure.
    Figure(&'a str),
}

/// What the numbers after a word such as "eqs" refer to.
#[derive(Clone, Copy, PartialEq)]
enum Citing {
    Nothing,
    Equations,
    Figures,
}

/// The pieces of a text, in order; joined, they are the text without its backticks.
pub(crate) fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    for (k, part) in text.split('`').enumerate() {
        match k % 2 {
            0 => prose(part, &mut pieces),
            _ => pieces.push(Piece::Code(part)),
        }
    }
    pieces.retain(|piece| *piece != Piece::Text(""));
    pieces
}

fn prose<'a>(text: &'a str, pieces: &mut Vec<Piece<'a>>) {
    let mut citing = Citing::Nothing;
    let mut last = "";
    for word in text.split_inclusive(char::is_whitespace) {
        match word.trim().trim_start_matches('(') {
            "eq." | "eqs" | "Eq." | "Eqs" => citing = Citing::Equations,
            // "before Fig. 7" is a place in the text, not a statement about the figure.
            "Fig." | "Figs" if matches!(last, "before" | "after") => citing = Citing::Nothing,
            "Fig." | "Figs" => citing = Citing::Figures,
            // "eqs 5 and 6"
            "and" | "or" | "to" => {}
            _ => {
                let before = pieces.len();
                numbers(word, citing, pieces);
                // "eqs 5, 6: 3 checks" cites two equations.
                let cited = pieces[before..].iter().any(|p| !matches!(p, Piece::Text(_)));
                if !cited || word.trim_end().ends_with(['.', ';', ':', ')']) {
                    citing = Citing::Nothing;
                }
                last = word.trim();
                continue;
            }
        }
        pieces.push(Piece::Text(word));
    }
}

/// The numbers in a word such as "A.7–A.14,", and the text between them.
fn numbers<'a>(word: &'a str, citing: Citing, pieces: &mut Vec<Piece<'a>>) {
    let in_number = |c: char| c.is_ascii_alphanumeric() || c == '.';
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    // Start of the text before the next number, and position from which to search.
    let (mut text, mut at) = (0, 0);
    while let Some(start) = word[at..].find(in_number).map(|start| at + start) {
        let rest = &word[start..];
        let end = rest.find(|c| !in_number(c)).unwrap_or(rest.len());
        let run = rest[..end].trim_end_matches('.');
        let appendix = run.strip_prefix("A.").is_some_and(is_number);
        let number = match citing {
            _ if appendix => Some(Piece::Equation(run)),
            Citing::Equations if is_number(run) => Some(Piece::Equation(run)),
            Citing::Figures if is_number(run) => Some(Piece::Figure(run)),
            _ => None,
        };
        at = start + end;
        if let Some(number) = number {
            pieces.extend([Piece::Text(&word[text..start]), number]);
            text = start + run.len();
        }
    }
    pieces.push(Piece::Text(&word[text..]));
}

/// True if a text cites this figure of the paper, singly or within a range.
pub(crate) fn cites_figure(text: &str, figure: u32) -> bool {
    let (mut last, mut through) = (None, false);
    for piece in pieces(text) {
        match piece {
            Piece::Figure(number) => {
                let number = number.parse::<u32>().ok();
                let from = if through { last } else { number };
                if from.zip(number).is_some_and(|(a, b)| (a..=b).contains(&figure)) {
                    return true;
                }
                (last, through) = (number, false);
            }
            Piece::Text(text) => through = matches!(text.trim(), "–" | "to") || (through && text.trim().is_empty()),
            _ => {}
        }
    }
    false
}

/// Splits a text into parts on the line and subscripts (true), such as the 1 of x_1: an underscore after a single
/// letter, followed by a number or a short word. Names in code have longer words before the underscore.
pub(crate) fn subscripts(text: &str) -> Vec<(bool, &str)> {
    let mut parts = Vec::new();
    let mut start = 0;
    for (at, _) in text.match_indices('_') {
        if at < start {
            continue;
        }
        let base = text[start..at].trim_end_matches(|c| ('\u{300}'..'\u{370}').contains(&c) || c == '²');
        let mut before = base.chars().rev();
        let letter = before.next().is_some_and(char::is_alphabetic);
        let alone = before.next().is_none_or(|c| !c.is_alphabetic() && c != '_');
        let below = below(&text[at + 1..]);
        if letter && alone && !below.is_empty() {
            parts.push((false, &text[start..at]));
            parts.push((true, below));
            start = at + 1 + below.len();
        }
    }
    parts.push((false, &text[start..]));
    parts
}

/// The subscript at the start of a text, or an empty text.
fn below(text: &str) -> &str {
    let end = |inside: fn(&char) -> bool| text.chars().take_while(inside).map(char::len_utf8).sum::<usize>();
    let digits = end(|c| c.is_ascii_digit());
    // Unicode counts a superscript two as numeric, but it does not belong to a subscript.
    let word = end(|c| c.is_alphabetic() || c.is_ascii_digit() || *c == '_');
    match () {
        () if digits > 0 => &text[..digits],
        () if word <= 5 && !text[..word].contains('_') => &text[..word],
        () => "",
    }
}

/// The text with numbers such as 1.2e-3 written as 1.2·10⁻³, 1e-9 as 10⁻⁹, and 4e0 as 4, and with a true minus before
/// negative ones.
pub(crate) fn powers(text: &str) -> String {
    let mut typeset = String::new();
    let text = minus(text);
    let mut rest = &text[..];
    while let Some(at) = rest.find('e') {
        let (before, after) = (&rest[..at], &rest[at + 1..]);
        let mantissa = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
        let (head, mantissa) = before.split_at(mantissa.len());
        let sign = usize::from(after.starts_with('-'));
        let digits = after[sign..].bytes().take_while(u8::is_ascii_digit).count();
        let (exponent, tail) = after.split_at(sign + digits);
        // The number must not be part of a word or a name, such as `a1e2`.
        let alone = !head.ends_with(|c: char| c.is_alphanumeric() || c == '_')
            && !tail.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        match (exponent.parse::<i32>(), mantissa.parse::<f64>().is_ok() && alone) {
            (Ok(exponent), true) => {
                typeset += head;
                typeset += &match (mantissa, exponent) {
                    (mantissa, _) if mantissa.bytes().all(|c| matches!(c, b'0' | b'.')) => "0".into(),
                    (mantissa, 0) => mantissa.to_owned(),
                    ("1", exponent) => power_of_ten(exponent),
                    (mantissa, exponent) => format!("{mantissa}·{}", power_of_ten(exponent)),
                };
                rest = tail;
            }
            _ => {
                typeset += &rest[..=at];
                rest = after;
            }
        }
    }
    typeset + rest
}

/// The text with a minus for each hyphen that is the sign of a number: after nothing, a blank or a bracket.
fn minus(text: &str) -> String {
    let mut before = ' ';
    let mut after = text.chars().skip(1);
    let sign = |c: char| {
        let number = after.next().is_some_and(|c| c.is_ascii_digit());
        let begins = before.is_whitespace() || "([|=".contains(before);
        before = c;
        if c == '-' && number && begins { '−' } else { c }
    };
    text.chars().map(sign).collect()
}

/// 10 with its exponent as a superscript.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    let raised = |c| counterpart(c, "-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹");
    "10".chars().chain(exponent.to_string().chars().filter_map(raised)).collect()
}

/// The character of `to` at the place that `c` has in `from`.
fn counterpart(c: char, from: &str, to: &str) -> Option<char> {
    from.chars().position(|other| other == c).and_then(|at| to.chars().nth(at))
}

/// The text with subscripts as Unicode characters, if there are characters for all of a subscript.
pub(crate) fn unicode(text: &str) -> String {
    lowered(text, |part| format!("_{part}"))
}

/// The same; subscripts without characters of their own are written by `other`.
pub(crate) fn lowered(text: &str, other: impl Fn(&str) -> String) -> String {
    let mut typeset = String::new();
    for (below, part) in subscripts(text) {
        let lowered: Option<String> = part.chars().map(subscript).collect();
        match lowered.filter(|_| below) {
            Some(lowered) => typeset += &lowered,
            None if below => typeset += &other(part),
            None => typeset += part,
        }
    }
    typeset
}

fn subscript(c: char) -> Option<char> {
    counterpart(c, "0123456789aehijklmnoprstuvx", "₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ")
}

/// The text for a Markdown cell: on one line, without markup except for code.
pub(crate) fn markdown(text: &str) -> String {
    escaped(text, str::to_owned)
}

/// The same with a minus where a hyphen is a sign, and raised powers of ten, except in code.
pub(crate) fn typeset_markdown(text: &str) -> String {
    escaped(text, powers)
}

fn escaped(text: &str, numbers: fn(&str) -> String) -> String {
    let mut escaped = String::new();
    // Markdown ends code at as many backticks as it begins with.
    let paired = !text.contains("``") && text.matches('`').count().is_multiple_of(2);
    for piece in if paired { pieces(text) } else { vec![Piece::Text(text)] } {
        match piece {
            Piece::Code(code) => escaped += &format!("`{}`", code.replace('\n', " ").replace('|', "\\|")),
            Piece::Text(text) | Piece::Equation(text) | Piece::Figure(text) => {
                unicode(&numbers(text)).chars().for_each(|c| match c {
                    '\n' => escaped.push(' '),
                    '<' => escaped.push_str("&lt;"),
                    '&' => escaped.push_str("&amp;"),
                    '|' | '*' | '_' | '\\' | '[' | '`' => escaped.extend(['\\', c]),
                    _ => escaped.push(c),
                });
            }
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten_are_raised() {
        for (text, typeset) in [
            ("p = 1.2e-3; at", "p = 1.2·10⁻³; at"),
            ("1e-16, -4e0 ± 2.0e12, 0.0e0", "10⁻¹⁶, −4 ± 2.0·10¹², 0"),
            ("-0.5 (-1) |p|=-2, 1-2, fig-4, 2026-11-28, -x", "−0.5 (−1) |p|=−2, 1-2, fig-4, 2026-11-28, -x"),
            ("the end, e-3, 1e, 3e-x and a1e2", "the end, e-3, 1e, 3e-x and a1e2"),
            ("1e99999999999", "1e99999999999"),
        ] {
            assert_eq!(powers(text), typeset);
        }
    }

    #[test]
    fn citations_are_found() {
        let cited = |text| {
            let marks = pieces(text).into_iter().filter_map(|piece| match piece {
                Piece::Text(_) => None,
                Piece::Code(code) => Some(format!("`{code}")),
                Piece::Equation(number) => Some(number.to_owned()),
                Piece::Figure(number) => Some(format!("F{number}")),
            });
            marks.collect::<Vec<_>>().join(" ")
        };
        for (text, marks) in [
            ("eqs 4, 12, Fig. 6 (top)", "4 12 F6"),
            ("method of solution, eqs 5–9, 11, 14, A.7–A.14", "5 9 11 14 A.7 A.14"),
            ("text after eqs 12 and 13. 5 rods", "12 13"),
            ("(eq. 15): 3 checks of `fig4 eq. 2` at t/T = 2", "15 `fig4 eq. 2"),
            ("Figs 7 to 10, r_e = 11.6; A.4.", "F7 F10 A.4"),
            ("Results, before Fig. 7; Fig. 6 (top)", "F6"),
            ("see A and 7; an odd ` is no harm", "` is no harm"),
            ("", ""),
        ] {
            assert_eq!(cited(text), marks, "{text}");
            let all: String = pieces(text)
                .into_iter()
                .map(|piece| match piece {
                    Piece::Text(t) | Piece::Code(t) | Piece::Equation(t) | Piece::Figure(t) => t,
                })
                .collect();
            assert_eq!(all, text.replace('`', ""));
        }
    }

    #[test]
    fn a_range_cites_what_is_in_it() {
        for (text, figures) in [
            ("eq. 4, Figs 7–9, Fig. 12", vec![7, 8, 9, 12]),
            ("Figs 6, 9 and 10", vec![6, 9, 10]),
            ("Figs 7 to 10", vec![7, 8, 9, 10]),
            ("eqs 4–12", vec![]),
        ] {
            let cited: Vec<u32> = (0..20).filter(|figure| cites_figure(text, *figure)).collect();
            assert_eq!(cited, figures, "{text}");
        }
    }

    #[test]
    fn subscripts_follow_single_letters() {
        for (text, typeset) in [
            ("r_e = 5, X̄_1(t), u_2 = G x_1", "rₑ = 5, X̄₁(t), u₂ = G x₁"),
            ("x_1x_2 and ∂u_i/∂x_j", "x₁x₂ and ∂uᵢ/∂xⱼ"),
            ("P_c > R, 1/(2r_e)", "P_c > R, 1/(2rₑ)"),
            ("r_e² − 1", "rₑ² − 1"),
            ("min_contact_arm, t_over_T, a_, _b, _", "min_contact_arm, t_over_T, a_, _b, _"),
            ("", ""),
        ] {
            assert_eq!(unicode(text), typeset);
        }
        assert_eq!(subscripts("P_c")[1], (true, "c"));
    }
}
