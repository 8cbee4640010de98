//! Which items of the core a run reaches, read off its source: names that are called, passed, matched or held, from the
//! functions that a run starts with. Names are told apart by their type or module, so a test alone reaches nothing.

mod names;
#[cfg(test)]
mod tests;

use super::File;
use names::Names;
use std::collections::{BTreeMap, BTreeSet};
use syn::visit::Visit;
use syn::{Attribute, Ident, Item, ItemImpl, Type};

/// Where a run starts: `module::name` or `Type::name`.
pub const ROOTS: [&str; 4] = [
    "scene_file::parse",
    "Plan::new",
    "ensemble::run",
    "run::run_replica",
];

/// A function, a type, a variant or a field, and what it mentions.
#[derive(Debug, Default)]
struct Node {
    module: String,
    /// The type of a method, a variant or a field.
    owner: Option<String>,
    name: String,
    mentions: Vec<Mention>,
    public: bool,
}

#[derive(Debug)]
enum Mention {
    /// The last name of a path, and the one before.
    Path(Option<String>, String),
    /// `.name(…)` or `.name`: of any type.
    Member(String),
}

/// The items of a crate.
#[derive(Default)]
pub struct Source(Vec<Node>);

impl Source {
    /// Those of files.
    pub fn of(files: &[File]) -> Self {
        let mut found = Self::default();
        for file in files {
            found.add(&file.room, &file.text);
        }
        found
    }

    /// Whether there is an item of that name in a module, or of a type.
    pub fn has(&self, before: &str, name: &str) -> bool {
        let is_it = |node: &Node| node.module == before || node.owner.as_deref() == Some(before);
        self.0.iter().any(|node| node.name == name && is_it(node))
    }

    /// The items of one file of a module.
    pub fn add(&mut self, module: &str, text: &str) {
        for item in syn::parse_file(text).expect("Rust").items {
            self.add_item(module, &item);
        }
    }

    fn node(&mut self, module: &str, owner: Option<&str>, name: String, public: bool, names: Names) {
        self.0.push(Node {
            module: module.into(),
            owner: owner.map(String::from),
            name,
            mentions: names.found,
            public,
        });
    }

    fn add_item(&mut self, module: &str, item: &Item) {
        let is_public = |visibility: &syn::Visibility| matches!(visibility, syn::Visibility::Public(_));
        match item {
            Item::Fn(f) if !of_tests(&f.attrs) => {
                let names = Names::of(None, |names| names.visit_item_fn(f));
                self.node(module, None, f.sig.ident.to_string(), is_public(&f.vis), names);
            }
            Item::Struct(s) => {
                let names = Names::of(None, |names| names.visit_item_struct(s));
                let fields = s.fields.iter().filter_map(|field| field.ident.as_ref());
                self.add_type(module, &s.ident, is_public(&s.vis), names, fields);
            }
            Item::Enum(e) => {
                let names = Names::of(None, |names| names.visit_item_enum(e));
                let variants = e.variants.iter().map(|variant| &variant.ident);
                self.add_type(module, &e.ident, is_public(&e.vis), names, variants);
            }
            Item::Impl(implementation) => self.add_impl(module, implementation),
            Item::Mod(inner) if !of_tests(&inner.attrs) => {
                for item in inner.content.iter().flat_map(|(_, items)| items) {
                    self.add_item(module, item);
                }
            }
            _ => {}
        }
    }

    /// A type, and its fields or variants.
    fn add_type<'a>(
        &mut self,
        module: &str,
        name: &Ident,
        public: bool,
        names: Names,
        members: impl Iterator<Item = &'a Ident>,
    ) {
        let name = name.to_string();
        self.node(module, None, name.clone(), public, names);
        for member in members {
            self.node(module, Some(&name), member.to_string(), false, Names::default());
        }
    }

    fn add_impl(&mut self, module: &str, implementation: &ItemImpl) {
        let Type::Path(path) = implementation.self_ty.as_ref() else {
            return;
        };
        let owner = path.path.segments.last().map(|segment| segment.ident.to_string());
        for item in &implementation.items {
            if let syn::ImplItem::Fn(f) = item
                && !of_tests(&f.attrs)
            {
                let names = Names::of(owner.clone(), |names| names.visit_impl_item_fn(f));
                let public = matches!(f.vis, syn::Visibility::Public(_));
                self.node(module, owner.as_deref(), f.sig.ident.to_string(), public, names);
            }
        }
    }

    /// Which nodes the roots reach.
    fn reached(&self) -> BTreeSet<usize> {
        let mut by_name: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (k, node) in self.0.iter().enumerate() {
            by_name.entry(&node.name).or_default().push(k);
        }
        let fits = |node: &Node, mention: &Mention| match (mention, &node.owner) {
            (Mention::Member(_), owner) => owner.is_some(),
            (Mention::Path(None, _), owner) => owner.is_none(),
            (Mention::Path(Some(before), _), Some(owner)) => owner == before,
            (Mention::Path(Some(before), _), None) => {
                node.module == *before || ["crate", "super", "self"].contains(&before.as_str())
            }
        };
        let named = |mention: &Mention| -> Vec<usize> {
            let (Mention::Member(name) | Mention::Path(_, name)) = mention;
            let all = by_name.get(name.as_str()).into_iter().flatten().copied();
            all.filter(|k| fits(&self.0[*k], mention)).collect()
        };
        let mut open: Vec<usize> = ROOTS
            .iter()
            .filter_map(|root| root.split_once("::"))
            .flat_map(|(before, name)| named(&Mention::Path(Some(before.into()), name.into())))
            .collect();
        let mut reached = BTreeSet::new();
        while let Some(k) = open.pop() {
            if reached.insert(k) {
                open.extend(self.0[k].mentions.iter().flat_map(named));
            }
        }
        reached
    }

    /// Whether a run reaches an item of a module; `None` where there is no such item.
    pub fn runs(&self, module: &str, name: &str) -> Option<bool> {
        let reached = self.reached();
        let here = |k: &usize| self.0[*k].module == module && self.0[*k].name == name;
        let all: Vec<usize> = (0..self.0.len()).filter(here).collect();
        (!all.is_empty()).then(|| all.iter().any(|k| reached.contains(k)))
    }

    /// The public functions and types of a module that no run reaches.
    pub fn idle(&self, module: &str) -> Vec<&str> {
        let reached = self.reached();
        let idle = |(k, node): &(usize, &Node)| node.module == module && node.public && !reached.contains(k);
        (self.0.iter().enumerate().filter(idle))
            .map(|(_, node)| node.name.as_str())
            .collect()
    }
}

/// Whether an item is for tests alone.
pub fn of_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Path>()
                .is_ok_and(|path| path.is_ident("test"))
    })
}
