//! The sums of a Hamiltonian, and the sites that their summands depend on.

mod acting;
mod bonds;
mod collected;

use std::collections::BTreeSet;

use super::bounds::{self, Span};
use super::parts::mapped;
pub use acting::far;
pub use collected::Collected;
use lie_syntax::ast::{BONDS, Declaration, Expr, ExprKind, Family, Index, Name};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// What to do where sites differ.
const DIFFERENT: &str = "what differs from site to site is a parameter with a list, `\"B\": {\"values\": [1, 2, 3]}` or `{\"file\": \"B.npy\"}`, \
                         and `B[i]` in a sum";

/// Names for the index of a sum.
const INDICES: [&str; 6] = ["i", "j", "k", "l", "m", "site"];

/// One sum.
pub struct Sum {
    /// The summand, its coordinates under the names of their slots.
    pub body: Expr,
    /// The distances of the sites in it.
    pub sites: BTreeSet<[i64; 2]>,
    /// Of those whose coordinates are in it.
    pub moving: BTreeSet<[i64; 2]>,
    /// The distances of coefficients in it, and which they are.
    data: BTreeSet<([i64; 2], usize)>,
    /// Where it goes, by row and by column.
    pub spans: [Span; 2],
    /// Whether it goes over bonds, with [`Collected::other`] for their second sites.
    pub over_bonds: bool,
    /// Where it stands.
    pub origin: Origin,
}

/// The name under which a sum stands in H, which nobody can write.
pub fn total(index: usize) -> String {
    format!("sum {index}")
}

/// The name of a coordinate of a site at a distance.
fn named(name: &str, indices: &[String], [down, right]: [i64; 2]) -> String {
    let offsets = if indices.len() == 1 {
        vec![right]
    } else {
        vec![down, right]
    };
    let index = |(index, offset): (&String, i64)| match offset {
        0 => index.clone(),
        _ => format!("{index}{offset:+}"),
    };
    let indices: Vec<String> = indices.iter().zip(offsets).map(index).collect();
    format!("{name}[{}]", indices.join(","))
}

fn indices(family: &Family) -> Vec<String> {
    family.indices.iter().map(|i| i.text.clone()).collect()
}

/// The answer to a sum within another one.
pub fn within(origin: Origin) -> Diagnostic {
    Diagnostic::new(
        Kind::Syntax,
        origin,
        "a sum over all sites stands within another one",
    )
    .help("couple all sites with all by a product of sums, such as `X^2/(2*N)` with `X = sum(i in 0..N: x[i])`")
}

/// The sums of a declaration, as they are found.
pub struct Sums<'a> {
    declaration: &'a Declaration,
    family: &'a Family,
    found: Vec<Sum>,
    /// What depends on a site beside the sums.
    acting: Near,
    /// Of each coefficient how many last rows and columns no sum has asked for; none before one asks.
    unused: Vec<Option<[usize; 2]>>,
}

/// Sites and coefficients at distances.
#[derive(Default)]
struct Near {
    sites: BTreeSet<[i64; 2]>,
    data: BTreeSet<([i64; 2], usize)>,
}

/// A sum that is being read.
struct Reading<'a> {
    variables: Vec<&'a Name>,
    spans: Vec<Span>,
    sites: BTreeSet<[i64; 2]>,
    moving: BTreeSet<[i64; 2]>,
    data: BTreeSet<([i64; 2], usize)>,
}

impl<'a> Sums<'a> {
    /// None yet.
    pub fn new(declaration: &'a Declaration, family: &'a Family) -> Self {
        Self {
            declaration,
            family,
            found: Vec::new(),
            acting: Near::default(),
            unused: vec![None; family.data.len()],
        }
    }

    fn indices(&self) -> Vec<String> {
        indices(self.family)
    }

    /// An expression outside of sums, with a name for each of them.
    pub fn outside(&mut self, expr: &Expr, mistakes: &mut Vec<Diagnostic>) -> Option<Expr> {
        let name = |sums: &mut Self, expr: &Expr, mistakes: &mut Vec<Diagnostic>| match &expr.kind {
            ExprKind::Name {
                name,
                index: Some(_),
            } => {
                let message = format!("`{name}` has an index and stands in no sum");
                let help = "H and observables of a family are functions of sums such as `sum(i in 0..N: …)`";
                mistakes.push(Diagnostic::new(Kind::Syntax, expr.origin, message).help(help));
                None
            }
            ExprKind::Name { name, .. } if sums.is_coordinate(name) => {
                mistakes.push(sums.without_index(name, expr.origin));
                None
            }
            ExprKind::Name { name, .. } if sums.data(name).is_some() => {
                mistakes.push(sums.without_site(name, expr.origin));
                None
            }
            ExprKind::IndexedSum { .. } => sums.sum(expr, mistakes),
            _ => Some(expr.clone()),
        };
        mapped(expr, &mut |expr| name(self, expr, mistakes))
    }

    fn is_coordinate(&self, name: &str) -> bool {
        self.declaration.state.iter().any(|s| s.text == name)
    }

    /// The place of a coefficient that has a value for each site.
    fn data(&self, name: &str) -> Option<usize> {
        let mut data = self.family.data.iter();
        data.position(|data| data.name.text == name)
    }

    fn without_site(&self, name: &str, origin: Origin) -> Diagnostic {
        let help = format!("write `{}` in a sum", named(name, &self.indices(), [0, 0]));
        let message = format!("`{name}` has a value for each site and needs an index");
        Diagnostic::new(Kind::UnknownSymbol, origin, message).help(help)
    }

    fn without_index(&self, name: &str, origin: Origin) -> Diagnostic {
        let help = format!("write `{}` in a sum", named(name, &self.indices(), [0, 0]));
        let message = format!("`{name}` is a coordinate of each site and needs an index");
        Diagnostic::new(Kind::UnknownSymbol, origin, message).help(help)
    }

    /// A sum becomes a name.
    fn sum(&mut self, expr: &Expr, mistakes: &mut Vec<Diagnostic>) -> Option<Expr> {
        let mut reading = Reading {
            variables: Vec::new(),
            spans: Vec::new(),
            sites: BTreeSet::new(),
            moving: BTreeSet::new(),
            data: BTreeSet::new(),
        };
        let mut body = expr;
        if let ExprKind::IndexedSum { index, body, .. } = &expr.kind
            && index.text == BONDS
        {
            return self.over_bonds(body, expr.origin, mistakes);
        }
        for size in &self.family.sizes {
            let ExprKind::IndexedSum {
                index,
                from,
                to,
                body: inner,
            } = &body.kind
            else {
                let message = "the sum goes over rows alone, and the sites have two indices";
                let help = "write `sum(i in 0..N, j in 0..M: …)`";
                mistakes.push(Diagnostic::new(Kind::Syntax, expr.origin, message).help(help));
                return None;
            };
            self.fresh(index, mistakes)?;
            reading.spans.push(bounds::span(from, to, size, mistakes)?);
            reading.variables.push(index);
            body = inner;
        }
        let body = mapped(body, &mut |part| match &part.kind {
            ExprKind::IndexedSum { .. } => {
                mistakes.push(within(part.origin));
                None
            }
            _ => self.at_site(part, &mut reading, mistakes),
        })?;
        let span = |axis: usize| {
            let before = 2 - reading.spans.len();
            axis.checked_sub(before)
                .and_then(|axis| reading.spans[axis])
        };
        self.found.push(Sum {
            body,
            sites: reading.sites,
            moving: reading.moving,
            data: reading.data,
            spans: [span(0), span(1)],
            over_bonds: false,
            origin: expr.origin,
        });
        Some(self.last(expr.origin))
    }

    /// The name of the sum that was found last.
    fn last(&self, origin: Origin) -> Expr {
        let name = total(self.found.len() - 1);
        Expr {
            kind: ExprKind::Name { name, index: None },
            origin,
        }
    }

    /// What stands at a site: coordinates and coefficients under the names of their slots.
    fn at_site(
        &mut self,
        part: &Expr,
        reading: &mut Reading<'_>,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Expr> {
        match &part.kind {
            ExprKind::Name { name, index: None } if self.is_coordinate(name) => {
                mistakes.push(self.without_index(name, part.origin));
                None
            }
            ExprKind::Name { name, index: None } if self.data(name).is_some() => {
                mistakes.push(self.without_site(name, part.origin));
                None
            }
            ExprKind::Name { name, index: None }
                if reading.variables.iter().any(|v| v.text == *name) =>
            {
                let message = format!("`{name}` is an index and no number");
                let mistake = Diagnostic::new(Kind::UnknownSymbol, part.origin, message);
                mistakes.push(mistake.help(DIFFERENT));
                None
            }
            ExprKind::Name {
                name,
                index: Some(index),
            } => self.coordinate(name, index, part.origin, reading, mistakes),
            _ => Some(part.clone()),
        }
    }

    /// Reports the index of a sum that is another name too.
    fn fresh(&self, index: &Name, mistakes: &mut Vec<Diagnostic>) -> Option<()> {
        let declaration = self.declaration;
        let parameters = declaration.parameters.iter().map(|p| &p.name);
        let parameters = parameters.chain(self.family.data.iter().map(|data| &data.name));
        let lets = declaration.lets.iter().map(|(name, _)| name);
        let inputs = declaration.inputs.iter().map(|input| &input.name);
        let taken = declaration.state.iter().chain(parameters);
        let taken = taken.chain(lets).chain(inputs);
        if taken.clone().any(|name| name.text == index.text) {
            let message = format!("the index `{}` is the name of something else", index.text);
            let is_taken = |free: &&str| taken.clone().any(|name| name.text == **free);
            let mut names = INDICES.into_iter().filter(|free| !is_taken(free));
            let free = names.next().unwrap_or("site");
            let help = format!(
                "give the index another name, such as `{free}`; it counts sites, and no coefficient depends on it"
            );
            mistakes.push(Diagnostic::new(Kind::DuplicateName, index.origin, message).help(help));
            return None;
        }
        Some(())
    }

    /// A coordinate with an index under the name of its slot.
    fn coordinate(
        &mut self,
        name: &str,
        index: &Index,
        origin: Origin,
        reading: &mut Reading<'_>,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Expr> {
        let mut fail = |kind, message: String, help: String| {
            mistakes.push(Diagnostic::new(kind, origin, message).help(help));
            None
        };
        let data = self.data(name);
        if data.is_none() && !self.is_coordinate(name) {
            let message = format!("`{name}` has an index and is no coordinate");
            let help = format!(
                "a parameter that is one number is the same for all sites, `{name}`; {DIFFERENT}"
            );
            return fail(Kind::UnknownSymbol, message, help);
        }
        let indices: Vec<&Index> =
            std::iter::successors(Some(index), |i| i.second.as_deref()).collect();
        let variables: Vec<&str> = reading.variables.iter().map(|v| v.text.as_str()).collect();
        let right = format!("write `{name}[{}]`", variables.join(", "));
        if indices.len() != variables.len() {
            let message = format!("`{name}` has {} indices here", indices.len());
            return fail(Kind::Syntax, message, right);
        }
        let mut distance = [0, 0];
        for (axis, (index, variable)) in indices.iter().zip(&variables).enumerate() {
            match &index.variable {
                Some(used) if used.text == *variable => {}
                Some(used) => {
                    let message = format!("the index `{}` is not that of the sum here", used.text);
                    return fail(Kind::UnknownSymbol, message, right);
                }
                None => {
                    let message =
                        format!("`{name}` has a fixed index, and every site is as the others");
                    return fail(Kind::Syntax, message, right);
                }
            }
            let last = 2 - variables.len();
            distance[axis + last] = index.offset;
            if let Some(help) = bounds::beyond(reading.spans[axis], index.offset, variable) {
                let message = format!(
                    "this site is beyond the end: the sum does not go over all sites, so that `{variable}` does not wrap around"
                );
                return fail(Kind::Domain, message, help);
            }
        }
        reading.sites.insert(distance);
        match data {
            None => drop(reading.moving.insert(distance)),
            Some(place) => {
                reading.data.insert((distance, place));
                self.asked(place, distance, &reading.spans);
            }
        }
        Some(Expr {
            kind: ExprKind::Name {
                name: named(name, &self.indices(), distance),
                index: None,
            },
            origin,
        })
    }
}

impl Sums<'_> {
    /// Notes which of the last values of a coefficient a sum asks for.
    fn asked(&mut self, place: usize, distance: [i64; 2], spans: &[Span]) {
        let before = 2 - spans.len();
        let unused = |axis: usize| {
            let span = axis.checked_sub(before).and_then(|axis| spans[axis]);
            let left = span.map_or(0, |(_, left)| left as i64 - distance[axis]);
            usize::try_from(left).unwrap_or(0)
        };
        let found = [unused(0), unused(1)];
        let known = self.unused[place].get_or_insert(found);
        *known = [known[0].min(found[0]), known[1].min(found[1])];
    }
}
