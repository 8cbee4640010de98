//! The suite's rooms need each other one way.

use super::{File, files, oracle, suite};
use std::collections::{BTreeMap, BTreeSet};
use syn::UseTree;
use syn::visit::{self, Visit};

/// The rooms that code mentions, as `crate::room`.
#[derive(Default)]
struct Needs(BTreeSet<String>);

impl Needs {
    fn of_tree(&mut self, tree: &UseTree) {
        match tree {
            UseTree::Path(path) => _ = self.0.insert(path.ident.to_string()),
            UseTree::Name(name) => _ = self.0.insert(name.ident.to_string()),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.of_tree(tree)),
            UseTree::Rename(name) => _ = self.0.insert(name.ident.to_string()),
            UseTree::Glob(_) => {}
        }
    }
}

impl<'a> Visit<'a> for Needs {
    fn visit_item_mod(&mut self, module: &'a syn::ItemMod) {
        if !super::reach::of_tests(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_use_path(&mut self, path: &'a syn::UsePath) {
        if path.ident == "crate" {
            self.of_tree(&path.tree);
        }
        visit::visit_use_path(self, path);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let mut names = path.segments.iter().map(|segment| segment.ident.to_string());
        if names.next().as_deref() == Some("crate") {
            self.0.extend(names.next());
        }
        visit::visit_path(self, path);
    }
}

/// Which rooms each room needs.
fn needs(files: &[File]) -> BTreeMap<&str, BTreeSet<String>> {
    let mut of: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for file in files.iter().filter(|file| !file.of_tests && file.room != "lib") {
        let mut needs = Needs::default();
        needs.visit_file(&syn::parse_file(&file.text).expect("Rust"));
        needs.0.remove(&file.room);
        of.entry(&file.room).or_default().append(&mut needs.0);
    }
    of
}

/// The rooms of circles, and those that need one.
fn circles(mut needs: BTreeMap<&str, BTreeSet<String>>) -> BTreeSet<&str> {
    loop {
        let above: BTreeSet<&str> = needs.keys().copied().collect();
        needs.retain(|_, needed| needed.iter().any(|room| above.contains(room.as_str())));
        if needs.len() == above.len() {
            return above;
        }
    }
}

#[test]
fn no_room_needs_one_that_needs_it() {
    for (folder, least) in [(suite(), 35), (oracle(), 9)] {
        let files = files(&folder);
        let needs = needs(&files);
        assert!(needs.len() >= least, "{needs:?}");
        assert_eq!(circles(needs), BTreeSet::new());
    }
    // A study that the contract of studies would need is found, with what lies between.
    let files = files(&suite());
    let mut needs = needs(&files);
    needs.get_mut("study").unwrap().insert("kicks".into());
    let circles = circles(needs);
    assert!(
        circles.contains("study") && circles.contains("kicks") && !circles.contains("statistics"),
        "{circles:?}"
    );
}
