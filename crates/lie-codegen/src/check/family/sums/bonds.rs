//! Sums over bonds between any two sites.

use std::collections::BTreeSet;

use super::{Sum, Sums, mapped, within};
use lie_core::lattice::AXES;
use lie_syntax::ast::{Expr, ExprKind};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// The value of a bond, under a name that nobody can write.
pub const BOND_VALUE: &str = "bond value";

/// The name of a coordinate of the second site of a bond.
pub fn second(name: &str) -> String {
    format!("second {name}")
}

impl Sums<'_> {
    /// A sum over bonds becomes a name: the first site of a bond has the index i, the second one j, whatever the index of the state is.
    pub(super) fn over_bonds(
        &mut self,
        body: &Expr,
        origin: Origin,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Expr> {
        if self.family.bonds.is_none() {
            let message = "the sum goes over bonds, and none are declared";
            let help = "add `\"bonds\": \"FILE.csv\"` with `i,j,value` in each line";
            mistakes.push(Diagnostic::new(Kind::UnknownSymbol, origin, message).help(help));
            return None;
        }
        let body = mapped(body, &mut |part| {
            let mut fail = |message: String, help: &str| {
                let mistake = Diagnostic::new(Kind::Syntax, part.origin, message);
                mistakes.push(mistake.help(help));
                None
            };
            let named = |name: String| {
                Some(Expr {
                    kind: ExprKind::Name { name, index: None },
                    origin: part.origin,
                })
            };
            match &part.kind {
                ExprKind::IndexedSum { .. } => {
                    mistakes.push(within(part.origin));
                    None
                }
                ExprKind::Name { name, index: None } if name == "value" => {
                    named(BOND_VALUE.to_owned())
                }
                ExprKind::Name { name, index: None } if self.is_coordinate(name) => {
                    mistakes.push(self.without_index(name, part.origin));
                    None
                }
                ExprKind::Name {
                    name,
                    index: Some(index),
                } => {
                    let variable = index.variable.as_ref().map(|variable| &variable.text);
                    let (Some(variable), 0, None) = (variable, index.offset, &index.next) else {
                        let message =
                            format!("`{name}` has another index than that of a site of the bond");
                        return fail(message, "write `x[i]` and `x[j]` for the two sites");
                    };
                    if !self.is_coordinate(name) {
                        let message = format!("`{name}` has an index and is no coordinate");
                        return fail(message, "a bond has its coordinates and `value`");
                    }
                    match variable.as_str() {
                        "i" => named(self.own(name)),
                        "j" => named(second(name)),
                        _ => {
                            let message = format!("`{name}[{variable}]` is of no site of the bond");
                            fail(message, "write `x[i]` and `x[j]` for the two sites")
                        }
                    }
                }
                _ => Some(part.clone()),
            }
        })?;
        self.found.push(Sum {
            body,
            sites: BTreeSet::new(),
            moving: BTreeSet::new(),
            data: BTreeSet::new(),
            spans: [None; AXES],
            over_bonds: true,
            origin,
        });
        Some(self.last(origin))
    }
}
