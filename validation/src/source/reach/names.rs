//! The names that a piece of source mentions.

use super::Mention;
use std::collections::BTreeSet;
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprMethodCall, Member, Pat, PatIdent, Token};

/// The names in a function's body or a type's definition, but for its own variables.
#[derive(Default)]
pub struct Names {
    owner: Option<String>,
    bound: BTreeSet<String>,
    /// Of these, parameters and closures: a call of theirs is no call of a function of that name.
    callable: BTreeSet<String>,
    calls: Vec<String>,
    pub found: Vec<Mention>,
}

impl Names {
    pub fn of(owner: Option<String>, visit: impl Fn(&mut Self)) -> Self {
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
