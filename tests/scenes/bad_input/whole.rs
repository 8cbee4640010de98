//! What is wrong with a file as a whole: what it lacks, several mistakes at once, unknown keys, cuts and nesting.

use super::{EXTENSION, INTERACTING};
use crate::{parsed, refusal};
use shearbed::Plan;

/// One mistake of each kind, in the order of lines; the last column is the line.
#[rustfmt::skip]
const MANY: &[(&str, &str, &str)] = &[
    ("shear_rate_per_s = 0.5", "shear_rate_per_s = -0.5", "3: flow.shear_rate_per_s = -0.5 is not allowed: expected a \
        finite number > 0"),
    ("length_mm = 0.72", "lenght_mm = 0.72", "6: lenght_mm = 0.72: unknown key `lenght_mm`, expected one of"),
    ("aspect_ratio = 11.6", "aspect_ratio = \"long\"", "7: particles.aspect_ratio = \"long\" is not allowed: expected \
        a number from"),
    ("alpha = 0.5\n", "", "10: interaction.alpha is missing: expected a finite number ≥ 0"),
    ("update = \"rotation\"", "update = \"turn\"", "13: interaction.update = \"turn\" is not allowed: expected \
        \"rotation\", \"angles\" or \"kick\""),
    ("[ensemble]\nreplicas = 2", "[ensemble]\nreplicas = 0", "20: ensemble.replicas = 0 is not allowed: expected a \
        whole number from 1 to"),
    ("[\"projections\"]", "[\"projection\"]", "23: output.observables = [\"projection\"] is not allowed: expected a \
        list of"),
];

#[test]
fn all_problems_are_told_at_once() {
    let spoil = |text: String, (old, new, _): &(&str, &str, &str)| {
        assert!(text.contains(old), "{old}");
        text.replacen(old, new, 1)
    };
    // All, and each half alone: a mistake that cannot be read hides none that can.
    for chosen in [MANY, &MANY[..2], &MANY[4..]] {
        let refusal = refusal(&chosen.iter().fold(INTERACTING.to_owned(), spoil));
        assert_eq!(refusal.lines().count(), chosen.len(), "{refusal}");
        for (line, (_, _, message)) in refusal.lines().zip(chosen) {
            let message = message.split_once(": ").unwrap().1;
            assert!(line.starts_with("dir/s.toml:") && line.contains(message), "{message}\n{line}");
        }
    }
    let all = refusal(&MANY.iter().fold(INTERACTING.to_owned(), spoil));
    for (line, (_, _, message)) in all.lines().zip(MANY) {
        assert!(line.starts_with(&format!("dir/s.toml:{message}")), "{message}\n{line}");
    }
    for (text, [one, other]) in [
        // What does not go together, in two tables.
        (
            INTERACTING.replace("= 3.6", "= 40").replace("outputs_per_period = 10", "outputs_per_period = 7"),
            ["8: particles.aspect_ratio_sd_percent = 40", "19: time.outputs_per_period = 7"],
        ),
        (
            EXTENSION.replace("[-0.5, 0, 0]", "[nan, 0, 0]").replace("count = 10", "count = 0"),
            ["3: flow.gradient_per_s = [[nan, 0, 0], ", "5: particles.count = 0"],
        ),
    ] {
        let refusal = refusal(&text);
        assert_eq!(refusal.lines().count(), 2, "{refusal}");
        assert!(refusal.starts_with(&format!("dir/s.toml:{one}")), "{refusal}");
        assert!(refusal.contains(&format!("\ndir/s.toml:{other}")), "{refusal}");
    }
}

#[test]
fn no_part_of_a_file_makes_the_reader_panic() {
    for text in [INTERACTING, EXTENSION] {
        for end in 0..=text.len() {
            // A file cut short, and one that starts in the middle.
            let _ = Plan::parse("s.toml", &text[..end]);
            let _ = Plan::parse("s.toml", &text[end..]);
        }
    }
}

#[test]
fn a_table_may_have_a_header_of_its_own() {
    let text = |orientation: &str| {
        format!(
            "title = \"t\"\n[flow]\nshear_rate_per_s = 1\n[particles]\ncount = 1\nlength_mm = 1\naspect_ratio = 2\n\
             {orientation}\n[time]\nperiods = 1\n"
        )
    };
    let inline = text("orientation = { phi_deg = -30, theta_deg = 60 }");
    let header = text("[particles.orientation]\nphi_deg = -30\ntheta_deg = 60.0");
    assert_eq!(parsed(&inline), parsed(&header));
    let wrong = text("[particles.orientation]\nphi_deg = -30\ntheta_deg = 600");
    assert!(Plan::parse("f.toml", &wrong).is_err());
}

/// The reader goes 80 deep; of keys it does not say where it stopped.
#[test]
fn what_is_nested_too_deep_is_refused_with_its_line() {
    let nested = |open: &str, close: &str| format!("x = {}1{}", open.repeat(100), close.repeat(100));
    let key = format!("{}z", "a.".repeat(100));
    for deep in [
        nested("[", "]"),
        nested("{ a = ", " }"),
        nested("[{ a = ", " }]"),
        format!("{key} = 1"),
        format!("[{key}]"),
        format!("[[{key}]]"),
        format!("x = [\n1,\n{{ {key} = 1 }},\n2\n]"),
    ] {
        for before in ["", "title = \"a.b.c\"\n[flow]\n", INTERACTING] {
            for after in ["", "\n", "\n[particles]\ncount = 0\n"] {
                let text = format!("{before}\n{deep}{after}");
                let line = 1 + text.lines().position(|line| line.contains(&deep[deep.len() / 2..][..20])).unwrap();
                let refusal = refusal(&text);
                assert!(refusal.starts_with(&format!("dir/s.toml:{line}: ")), "{line}: {refusal}");
                assert_eq!(refusal.lines().count(), 1);
            }
        }
    }
}
