//! Which items of the core a run reaches, read off its source: names that are called, passed, matched or held, from the
//! functions that a run starts with. Names are told apart by their type or module, so a test alone reaches nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprMethodCall, Item, ItemImpl, Member, Pat, PatIdent, Token, Type};

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
    /// Every file below a folder.
    pub fn read(folder: &Path) -> Self {
        let mut found = Self::default();
        found.read_folder(folder, None);
        found
    }

    fn read_folder(&mut self, folder: &Path, module: Option<&str>) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
            let module = module.unwrap_or(&stem);
            if path.is_dir() {
                self.read_folder(&path, Some(module));
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                self.add(module, &std::fs::read_to_string(&path).expect("text"));
            }
        }
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
                let name = s.ident.to_string();
                self.node(
                    module,
                    None,
                    name.clone(),
                    is_public(&s.vis),
                    Names::of(None, |names| names.visit_item_struct(s)),
                );
                for field in s.fields.iter().filter_map(|field| field.ident.as_ref()) {
                    self.node(module, Some(&name), field.to_string(), false, Names::default());
                }
            }
            Item::Enum(e) => {
                let name = e.ident.to_string();
                self.node(
                    module,
                    None,
                    name.clone(),
                    is_public(&e.vis),
                    Names::of(None, |names| names.visit_item_enum(e)),
                );
                for variant in &e.variants {
                    self.node(
                        module,
                        Some(&name),
                        variant.ident.to_string(),
                        false,
                        Names::default(),
                    );
                }
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

fn of_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Path>()
                .is_ok_and(|path| path.is_ident("test"))
    })
}

/// The names in a function's body or a type's definition, but for its own variables.
#[derive(Default)]
struct Names {
    owner: Option<String>,
    bound: BTreeSet<String>,
    /// Of these, parameters and closures: a call of theirs is no call of a function of that name.
    callable: BTreeSet<String>,
    calls: Vec<String>,
    found: Vec<Mention>,
}

impl Names {
    fn of(owner: Option<String>, visit: impl Fn(&mut Self)) -> Self {
        let mut names = Self {
            owner,
            ..Self::default()
        };
        visit(&mut names);
        let bound = std::mem::take(&mut names.bound);
        let callable = std::mem::take(&mut names.callable);
        names
            .found
            .retain(|mention| !matches!(mention, Mention::Path(None, name) if bound.contains(name)));
        let calls = std::mem::take(&mut names.calls).into_iter();
        let others = calls.filter(|name| !callable.contains(name));
        names.found.extend(others.map(|name| Mention::Path(None, name)));
        names
    }
}

impl<'a> Visit<'a> for Names {
    fn visit_path(&mut self, path: &'a syn::Path) {
        let mut names = path
            .segments
            .iter()
            .rev()
            .map(|segment| segment.ident.to_string());
        if let Some(last) = names.next() {
            let before = names.next().map(|name| match &self.owner {
                Some(owner) if name == "Self" => owner.clone(),
                _ => name,
            });
            // A path through a type mentions the type too.
            self.found
                .extend(before.clone().map(|before| Mention::Path(None, before)));
            self.found.push(Mention::Path(before, last));
        }
        visit::visit_path(self, path);
    }

    fn visit_pat_ident(&mut self, pattern: &'a PatIdent) {
        self.bound.insert(pattern.ident.to_string());
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_local(&mut self, local: &'a syn::Local) {
        if let (Pat::Ident(pattern), Some(init)) = (&local.pat, &local.init)
            && matches!(init.expr.as_ref(), Expr::Closure(_))
        {
            self.callable.insert(pattern.ident.to_string());
        }
        visit::visit_local(self, local);
    }

    fn visit_pat_type(&mut self, parameter: &'a syn::PatType) {
        if let Pat::Ident(pattern) = parameter.pat.as_ref() {
            self.callable.insert(pattern.ident.to_string());
        }
        visit::visit_pat_type(self, parameter);
    }

    fn visit_expr_call(&mut self, call: &'a syn::ExprCall) {
        match call.func.as_ref() {
            Expr::Path(function) if function.path.segments.len() == 1 => {
                self.calls.push(function.path.segments[0].ident.to_string());
                call.args.iter().for_each(|argument| self.visit_expr(argument));
            }
            _ => visit::visit_expr_call(self, call),
        }
    }

    fn visit_expr_method_call(&mut self, call: &'a ExprMethodCall) {
        self.found.push(Mention::Member(call.method.to_string()));
        visit::visit_expr_method_call(self, call);
    }

    fn visit_member(&mut self, member: &'a Member) {
        if let Member::Named(name) = member {
            self.found.push(Mention::Member(name.to_string()));
        }
    }

    /// A macro's arguments, where they are expressions.
    fn visit_macro(&mut self, call: &'a syn::Macro) {
        if let Ok(arguments) = call.parse_body_with(Punctuated::<Expr, Token![,]>::parse_terminated) {
            let inner = Self::of(self.owner.clone(), |names| {
                for argument in &arguments {
                    names.visit_expr(argument);
                }
            });
            self.found.extend(inner.found);
        }
    }

    /// `#[serde(default = "name")]` calls a function by its name in a string.
    fn visit_attribute(&mut self, attribute: &'a Attribute) {
        let _ = attribute.parse_nested_meta(|meta| {
            if meta.input.peek(Token![=]) {
                let name: syn::LitStr = meta.value()?.parse()?;
                self.found.push(Mention::Path(None, name.value()));
            }
            Ok(())
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_tests_alone_call_is_not_reached() {
        let mut source = Source::default();
        source.add(
            "scene_file",
            "pub fn parse() -> Scene { toml::from_str::<Scene>() }",
        );
        source.add("scene", "pub struct Scene { #[serde(default = \"three\")] m: f64 } fn three() -> f64 { 3.0 } fn four() {}");
        source.add(
            "run",
            "pub fn run_replica(p: &Plan) { let idle = 1; used(idle); let used = used(1.0); let x = p.turned(); other::passed; vec![in_macro(1)];
             let rate = |k| k; rate(1); }
             pub fn used(rate: f64) -> f64 { rate }
             pub fn idle() {}
             fn in_macro(n: u8) {}
             pub struct Plan; impl Plan { pub fn turned(&self) {} pub fn probability(&self) { idle() } }
             #[cfg(test)] mod tests { fn of_tests() { super::idle(); } }",
        );
        source.add(
            "other",
            "pub fn passed() {} pub fn rate() { hidden() } fn hidden() {}",
        );
        for (module, name) in [
            ("scene", "three"),
            ("run", "used"),
            ("run", "turned"),
            ("run", "in_macro"),
            ("other", "passed"),
        ] {
            assert_eq!(source.runs(module, name), Some(true), "{name}");
        }
        // A variable and a parameter of that name are no calls; what is idle calls in vain.
        for (module, name) in [
            ("scene", "four"),
            ("run", "idle"),
            ("run", "probability"),
            ("other", "rate"),
            ("other", "hidden"),
        ] {
            assert_eq!(source.runs(module, name), Some(false), "{name}");
        }
        assert_eq!(source.runs("run", "of_tests"), None);
        assert_eq!(source.runs("other", "used"), None);
        assert_eq!(source.idle("run"), ["idle", "probability"]);
    }
}
