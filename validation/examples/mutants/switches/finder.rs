//! Where the mutants of a file stand.

use super::*;

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_expr_binary(&mut self, node: &'ast syn::ExprBinary) {
        let (left, right) = (self.text(node.left.span()), self.text(node.right.span()));
        let mutants = self.of(Genre::BinaryOperator, node.op.span(), |operator| {
            format!("{left} {operator} {right}")
        });
        if !has_let(&node.left) && !has_let(&node.right) {
            self.expression(node.span(), mutants);
        }
        visit::visit_expr_binary(self, node);
    }

    fn visit_expr_unary(&mut self, node: &'ast syn::ExprUnary) {
        let operand = self.text(node.expr.span());
        let mutants = self.of(Genre::UnaryOperator, node.span(), |_| operand.to_string());
        self.expression(node.span(), mutants);
        visit::visit_expr_unary(self, node);
    }

    fn visit_arm(&mut self, node: &'ast syn::Arm) {
        let mut mutants = self.of(Genre::MatchArm, node.span(), |_| "false".to_string());
        match &node.guard {
            Some((_, guard)) => {
                mutants.extend(self.of(Genre::MatchArmGuard, guard.span(), str::to_string));
                self.expression(guard.span(), mutants);
            }
            None => {
                let end = node.pat.span().byte_range().end;
                self.add(end..end, mutants, Kind::Arm);
            }
        }
        visit::visit_arm(self, node);
    }

    fn visit_expr_struct(&mut self, node: &'ast syn::ExprStruct) {
        if let Some(rest) = &node.rest {
            let (path, rest) = (self.text(node.path.span()), self.text(rest.span()));
            let mut found = Vec::new();
            for field in &node.fields {
                let name = self.text(field.member.span());
                let mutants = self.of(Genre::StructField, field.span(), |_| {
                    format!("let rest: {path} = {rest}; rest.{name}")
                });
                let shorthand = field.colon_token.is_none();
                let field_text = if shorthand {
                    format!("{name}: ")
                } else {
                    String::new()
                };
                found.push((field.expr.span().byte_range(), mutants, field_text));
            }
            for (range, mutants, field) in found {
                self.add(range, mutants, Kind::Expression { field });
            }
        }
        visit::visit_expr_struct(self, node);
    }

    fn visit_item_fn(&mut self, node: &'ast syn::ItemFn) {
        self.constant(node.sig.constness.is_some(), |finder| {
            finder.body(&node.sig, &node.block);
            visit::visit_item_fn(finder, node);
        });
    }

    fn visit_impl_item_fn(&mut self, node: &'ast syn::ImplItemFn) {
        self.constant(node.sig.constness.is_some(), |finder| {
            finder.body(&node.sig, &node.block);
            visit::visit_impl_item_fn(finder, node);
        });
    }

    fn visit_trait_item_fn(&mut self, node: &'ast syn::TraitItemFn) {
        if let Some(block) = &node.default {
            self.body(&node.sig, block);
        }
        visit::visit_trait_item_fn(self, node);
    }

    fn visit_item_const(&mut self, node: &'ast syn::ItemConst) {
        self.constant(true, |finder| visit::visit_item_const(finder, node));
    }

    fn visit_item_static(&mut self, node: &'ast syn::ItemStatic) {
        self.constant(true, |finder| visit::visit_item_static(finder, node));
    }

    fn visit_impl_item_const(&mut self, node: &'ast syn::ImplItemConst) {
        self.constant(true, |finder| visit::visit_impl_item_const(finder, node));
    }

    fn visit_expr_repeat(&mut self, node: &'ast syn::ExprRepeat) {
        self.visit_expr(&node.expr);
        self.constant(true, |finder| finder.visit_expr(&node.len));
    }

    fn visit_type_array(&mut self, node: &'ast syn::TypeArray) {
        self.constant(true, |finder| visit::visit_type_array(finder, node));
    }
}

/// Whether the operand of an operator is a chain with `let`, whose names the rest of the chain uses.
fn has_let(expr: &syn::Expr) -> bool {
    match expr {
        syn::Expr::Let(_) => true,
        syn::Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}
