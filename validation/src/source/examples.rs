//! Public types of the core have an example in their documentation.

use super::{File, core, files};

/// Public types without an example in their documentation. A type in a module of its own file counts where the module, or the
/// type by its name, is handed on.
fn without_example(sources: &[File]) -> Vec<String> {
    let handed_on = |name: &str, module: &str| {
        let module = format!("pub mod {module};");
        let by_name = |text: &str| {
            let uses = text
                .split("pub use ")
                .skip(1)
                .filter_map(|rest| rest.split(';').next());
            uses.flat_map(|list| list.split(|c: char| !c.is_alphanumeric()))
                .any(|word| word == name)
        };
        sources
            .iter()
            .any(|file| file.text.contains(&module) || by_name(&file.text))
    };
    let mut missing = Vec::new();
    for file in sources {
        for item in syn::parse_file(&file.text).unwrap().items {
            let (attributes, visibility, name) = match &item {
                syn::Item::Struct(item) => (&item.attrs, &item.vis, &item.ident),
                syn::Item::Enum(item) => (&item.attrs, &item.vis, &item.ident),
                _ => continue,
            };
            let is_public = matches!(visibility, syn::Visibility::Public(_));
            let documentation = attributes
                .iter()
                .filter(|attribute| attribute.path().is_ident("doc"));
            let has_example = documentation.into_iter().any(|attribute| match &attribute.meta {
                syn::Meta::NameValue(doc) => match &doc.value {
                    syn::Expr::Lit(syn::ExprLit {
                        lit: syn::Lit::Str(text),
                        ..
                    }) => text.value().contains("```"),
                    // `include_str!`: a whole page.
                    _ => true,
                },
                _ => false,
            });
            if is_public && !has_example && handed_on(&name.to_string(), &file.module) {
                missing.push(format!("{}::{name}", file.module));
            }
        }
    }
    missing
}

#[test]
fn every_public_type_of_the_core_has_an_example() {
    let sources = files(&core());
    assert!(sources.len() > 30);
    assert_eq!(without_example(&sources), Vec::<String>::new());
    // One whose example is taken away is found.
    let mut spoiled = sources.clone();
    for file in &mut spoiled {
        file.text = file.text.replace("/// ```", "/// ");
    }
    let missing = without_example(&spoiled);
    assert!(missing.len() > 40, "{missing:?}");
    for name in [
        "scene::Scene",
        "keys::Holds",
        "channel::Channel",
        "propagator::Propagator",
    ] {
        assert!(missing.iter().any(|found| found == name), "{name}: {missing:?}");
    }
    assert!(
        !missing.iter().any(|found| found.ends_with("::Ball")),
        "{missing:?}"
    );
}
