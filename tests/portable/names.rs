//! No file of the core names a function that rounds as the platform likes.

use proc_macro2::{TokenStream, TokenTree};
use std::path::{Path, PathBuf};

/// Functions of the standard library, and of nalgebra, whose last digits are the platform's.
const INEXACT: &[&str] = &[
    "sin",
    "cos",
    "tan",
    "sin_cos",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "asinh",
    "acosh",
    "atanh",
    "exp",
    "exp2",
    "exp_m1",
    "ln",
    "ln_1p",
    "log",
    "log2",
    "log10",
    "powf",
    "powi",
    "powc",
    "cbrt",
    "hypot",
    "gamma",
    "ln_gamma",
    "erf",
    "erfc",
    "sinc",
    "sinhc",
    "coshc",
    "cosc",
    "sinh_cosh",
    "angle",
    "slerp",
    "from_axis_angle",
    "from_scaled_axis",
    "from_euler_angles",
    "euler_angles",
    "schur",
    "eigenvalues",
    "complex_eigenvalues",
    "symmetric_eigen",
    "symmetric_eigenvalues",
    "svd",
    "singular_values",
    "polar",
];

/// Crates that take functions from the platform, or from where other crates of the build have them.
const CRATES: &[&str] = &["num_traits", "rand_distr"];

/// Where a source names such a crate, calls such a function, or names it with its type, out of tests. `powi` by 2, 3 and −2 has one order of
/// roundings whoever computes it.
fn inexact(source: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    flatten(source.parse().unwrap(), &mut tokens);
    let token = |at: usize| tokens.get(at).map_or("", String::as_str);
    let found = (1..tokens.len()).filter(|&at| {
        let called = token(at - 1) == "." && matches!(token(at + 1), "(" | ":");
        let of_a_type = token(at - 1) == ":" && at >= 3 && token(at - 3) != "libm" && token(at - 2) == ":";
        let exact = token(at) == "powi" && matches!(token(at + 2), "2" | "3") && token(at + 3) == ")"
            || token(at) == "powi" && token(at + 2) == "-" && token(at + 3) == "2" && token(at + 4) == ")";
        CRATES.contains(&token(at)) || INEXACT.contains(&token(at)) && (called && !exact || of_a_type)
    });
    found
        .map(|at| tokens[at.saturating_sub(3)..=at].join(" "))
        .collect()
}

/// All words and signs of a source, without comments and without what is compiled for tests alone.
fn flatten(source: TokenStream, tokens: &mut Vec<String>) {
    let mut trees = source.into_iter().peekable();
    let mut test_item = false;
    while let Some(tree) = trees.next() {
        match tree {
            TokenTree::Punct(sign) if sign.as_char() == '#' => {
                let attribute = trees.next_if(|next| matches!(next, TokenTree::Group(_)));
                test_item |= attribute.is_some_and(|text| text.to_string().replace(' ', "") == "[cfg(test)]");
            }
            // A test item ends with its block or semicolon.
            TokenTree::Group(group) if test_item => {
                test_item = !matches!(group.delimiter(), proc_macro2::Delimiter::Brace);
            }
            TokenTree::Punct(sign) if test_item => test_item = sign.as_char() != ';',
            _ if test_item => {}
            TokenTree::Group(group) => {
                let [open, close] = match group.delimiter() {
                    proc_macro2::Delimiter::Parenthesis => ["(", ")"],
                    proc_macro2::Delimiter::Brace => ["{", "}"],
                    proc_macro2::Delimiter::Bracket => ["[", "]"],
                    proc_macro2::Delimiter::None => ["", ""],
                };
                tokens.push(open.to_owned());
                flatten(group.stream(), tokens);
                tokens.push(close.to_owned());
            }
            other => tokens.push(other.to_string()),
        }
    }
}

/// Files of the core that are not tests.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let files = files.into_iter().filter(|file| {
        file.extension().is_some_and(|of| of == "rs") && file.file_name().unwrap() != "tests.rs"
    });
    files
        .chain(folders.iter().flat_map(|folder| sources(folder)))
        .collect()
}

#[test]
fn the_core_uses_no_function_that_rounds_as_the_platform_likes() {
    let all = sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(all.len() > 40, "{}", all.len());
    for file in all {
        let found = inexact(&std::fs::read_to_string(&file).unwrap());
        assert!(
            found.is_empty(),
            "{}: {found:?}; take it from libm",
            file.display()
        );
    }
}

#[test]
fn such_a_function_is_found_and_others_are_not() {
    for wrong in [
        "fn f(x: f64) -> f64 { x.sin() }",
        "fn f(x: f64) -> f64 { x /* here */ .\n exp_m1 ( ) }",
        "const F: fn(f64) -> f64 = f64::ln;",
        "fn f(x: f64) -> f64 { <f64>::cos(x) }",
        "fn f(x: f64) -> f64 { Float::sqrt(Float::hypot(x, x)) }",
        "pub use num_traits as n;",
        "fn f(r: &mut R) -> f64 { rand_distr::StandardNormal.sample(r) }",
        "fn f(x: f64) -> f64 { twice!(x.sin_cos()) }",
        "fn f(x: f64, n: i32) -> f64 { x.powi(n) + x.powi(2) }",
        "fn f(x: f64) -> f64 { x.powi(20) }",
        "#[cfg(test)] mod tests { fn f() {} } fn g(x: f64) -> f64 { x.powf(0.5) }",
        "#[cfg(test)] use a::b; fn g(x: f64) -> f64 { x.cbrt() }",
        "#[inline] fn g(x: f64) -> f64 { \"// \"; x.atan2(x) }",
    ] {
        assert_eq!(inexact(wrong).len(), 1, "{wrong}");
    }
    for right in [
        "fn f(x: f64) -> f64 { libm::sin(x).sqrt().mul_add(x, x.powi(3)) }",
        "fn f(p: Phase) -> f64 { p.cos * p.sin + exp(p) + x.powi(-2) }",
        "use super::functions::{exp, sin_cos}; /// x.sin()\nfn f() { \"x.sin()\"; }",
        "#[cfg(test)] mod tests { fn f(x: f64) -> f64 { x.sin() } }",
    ] {
        assert_eq!(inexact(right), Vec::<String>::new(), "{right}");
    }
}
