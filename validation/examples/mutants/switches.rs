//! The sources with all mutants in them at once, each behind a switch of its own.

mod finder;

use proc_macro2::Span;
use serde::Deserialize;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// A mutant as `cargo mutants --list --json` describes it.
#[derive(Clone, Deserialize)]
pub struct Mutant {
    /// From 1 on.
    #[serde(skip)]
    pub id: usize,
    pub file: String,
    pub name: String,
    pub package: String,
    pub genre: Genre,
    pub replacement: String,
    span: Place,
}

#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum Genre {
    BinaryOperator,
    UnaryOperator,
    FnValue,
    MatchArm,
    MatchArmGuard,
    StructField,
}

/// Lines and columns count from one, columns in characters.
#[derive(Clone, Deserialize)]
struct Place {
    start: Corner,
}

#[derive(Clone, Deserialize)]
struct Corner {
    line: usize,
    column: usize,
}

/// The text that a mutant stands in begins and ends with its number, so that the compiler's complaints find it.
pub fn marked(id: usize, text: &str) -> String {
    format!("/*<{id}*/{text}/*{id}>*/")
}

/// `source` with the given mutants behind `crate::mutant::on(place)`, and the place of each: mutants of one expression share one.
/// A mutant without a place is none that a switch can make.
pub fn switch(source: &str, mutants: &[&Mutant]) -> syn::Result<(String, BTreeMap<usize, usize>)> {
    let starts: Vec<usize> = std::iter::once(0)
        .chain(source.match_indices('\n').map(|(at, _)| at + 1))
        .collect();
    let mut wanted: BTreeMap<usize, Vec<&Mutant>> = BTreeMap::new();
    for mutant in mutants {
        let Corner { line, column } = mutant.span.start;
        let start = starts[line - 1];
        let before: usize = source[start..].chars().take(column - 1).map(char::len_utf8).sum();
        wanted.entry(start + before).or_default().push(mutant);
    }
    let mut finder = Finder {
        source,
        wanted: &wanted,
        sites: Vec::new(),
        constant: 0,
    };
    finder.visit_file(&syn::parse_file(source)?);
    let mut sites = finder.sites;
    // The outer site comes first; a return at the start of a body before the expression that begins there.
    sites.sort_by_key(|site| (site.range.start, !site.range.is_empty(), Reverse(site.range.end)));
    let places = sites.iter().flat_map(|site| {
        let first = site.mutants[0].0;
        let place = move |id| if site.range.is_empty() { id } else { first };
        site.mutants.iter().map(move |(id, _)| (*id, place(*id)))
    });
    Ok((rendered(source, 0..source.len(), &sites), places.collect()))
}

/// A piece of the source that mutants replace; one of no length is where they are put in.
struct Site {
    range: Range<usize>,
    mutants: Vec<(usize, String)>,
    kind: Kind,
}

enum Kind {
    /// One expression for another; a field's shorthand names itself first.
    Expression { field: String },
    /// A return at the start of a function's body.
    Return,
    /// A guard for an arm that has none.
    Arm,
}

impl Site {
    fn rendered(&self, source: &str, inner: &[Site]) -> String {
        let first = self.mutants[0].0;
        let all = |text: &dyn Fn(usize, &str) -> String| -> String {
            self.mutants
                .iter()
                .map(|(id, mutant)| text(*id, mutant))
                .collect()
        };
        match &self.kind {
            // What is there stands first: the mutants must have its type, not it theirs.
            Kind::Expression { field } => format!(
                "{field}(match crate::mutant::on({first}) {{ on if true{} => {{ {} }} {} _ => unreachable!() }})",
                all(&|id, _| format!(" && on != {id}")),
                rendered(source, self.range.clone(), inner),
                all(&|id, mutant| format!("{id} => {}", marked(id, &format!("{{ {mutant} }}")))),
            ),
            Kind::Return => all(&|id, mutant| {
                let text = marked(id, &format!("return {mutant};"));
                format!("if crate::mutant::on({id}) == {id} {{ {text} }} ")
            }),
            Kind::Arm => all(&|id, _| format!(" if crate::mutant::on({id}) != {id}")),
        }
    }
}

fn rendered(source: &str, range: Range<usize>, mut sites: &[Site]) -> String {
    let (mut text, mut at) = (String::new(), range.start);
    while let Some((site, rest)) = sites.split_first() {
        let inside = rest.iter().take_while(|s| s.range.start < site.range.end).count();
        text += &source[at..site.range.start];
        text += &site.rendered(source, &rest[..inside]);
        (at, sites) = (site.range.end, &rest[inside..]);
    }
    text + &source[at..range.end]
}

struct Finder<'a> {
    source: &'a str,
    wanted: &'a BTreeMap<usize, Vec<&'a Mutant>>,
    sites: Vec<Site>,
    /// Within how many constants: what the compiler computes knows no switch.
    constant: usize,
}

impl Finder<'_> {
    fn text(&self, span: Span) -> &str {
        &self.source[span.byte_range()]
    }

    /// The mutants of a genre that begin where a span does, with what they put there.
    fn of(&self, genre: Genre, from: Span, text: impl Fn(&str) -> String) -> Vec<(usize, String)> {
        self.wanted
            .get(&from.byte_range().start)
            .into_iter()
            .flatten()
            .filter(|mutant| mutant.genre == genre && self.constant == 0)
            .map(|mutant| (mutant.id, text(&mutant.replacement)))
            .collect()
    }

    fn add(&mut self, range: Range<usize>, mutants: Vec<(usize, String)>, kind: Kind) {
        if !mutants.is_empty() {
            self.sites.push(Site { range, mutants, kind });
        }
    }

    fn expression(&mut self, span: Span, mutants: Vec<(usize, String)>) {
        self.add(
            span.byte_range(),
            mutants,
            Kind::Expression { field: String::new() },
        );
    }

    fn body(&mut self, sig: &syn::Signature, block: &syn::Block) {
        // An `impl Trait` is one type: that of the first return.
        let opaque =
            matches!(&sig.output, syn::ReturnType::Type(_, of) if matches!(**of, syn::Type::ImplTrait(_)));
        if let Some(first) = block.stmts.first().filter(|_| !opaque) {
            let at = first.span().byte_range().start;
            let mutants = self.of(Genre::FnValue, first.span(), str::to_string);
            self.add(at..at, mutants, Kind::Return);
        }
    }

    fn constant(&mut self, is: bool, visit: impl FnOnce(&mut Self)) {
        self.constant += usize::from(is);
        visit(self);
        self.constant -= usize::from(is);
    }
}

/// What is added to the crate: a place asks which mutant is on; with `MUTANTS_REACHED` it writes there that it was reached.
pub fn module(places: usize) -> String {
    format!(
        r#"
#[doc(hidden)]
#[allow(missing_docs)]
pub mod mutant {{
    use std::io::Write;
    use std::sync::atomic::{{AtomicBool, AtomicU32, Ordering::Relaxed}};
    const UNKNOWN: u32 = u32::MAX;
    const RECORD: u32 = u32::MAX - 1;
    static ON: AtomicU32 = AtomicU32::new(UNKNOWN);
    static REACHED: [AtomicBool; {places}] = [const {{ AtomicBool::new(false) }}; {places}];
    #[inline(always)]
    pub fn on(place: u32) -> u32 {{
        let on = ON.load(Relaxed);
        if on < RECORD {{ on }} else {{ record(place, on) }}
    }}
    #[cold]
    fn record(place: u32, mut on: u32) -> u32 {{
        if on == UNKNOWN {{
            on = match std::env::var("MUTANT") {{
                Ok(id) => id.parse().expect("the number of a mutant"),
                Err(_) if std::env::var_os("MUTANTS_REACHED").is_some() => RECORD,
                Err(_) => 0,
            }};
            ON.store(on, Relaxed);
        }}
        let reached = &REACHED[place as usize];
        if on == RECORD && !reached.load(Relaxed) && !reached.swap(true, Relaxed) {{
            let path = std::env::var_os("MUTANTS_REACHED").expect("set above");
            let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).expect("a file for the reached");
            file.write_all(format!("{{place}}\n").as_bytes()).expect("room for the reached");
        }}
        on
    }}
}}
"#
    )
}
