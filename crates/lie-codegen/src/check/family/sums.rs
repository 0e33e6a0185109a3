//! The sums of a Hamiltonian, and the sites that their summands depend on.

mod acting;
mod bonds;
mod collected;

use std::array::from_fn;
use std::collections::BTreeSet;

use super::bounds::{self, Span};
use super::parts::mapped;
pub use acting::far;
pub use collected::Collected;
use lie_core::lattice::{AXES, last_axes};
use lie_syntax::ast::{BONDS, Declaration, Expr, ExprKind, Family, Index, Name, Size};
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
    pub sites: BTreeSet<[i64; AXES]>,
    /// Of those whose coordinates are in it.
    pub moving: BTreeSet<[i64; AXES]>,
    /// The distances of coefficients in it, and which they are.
    data: BTreeSet<([i64; AXES], usize)>,
    /// Where it goes, by layer, row and column.
    pub spans: [Span; AXES],
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
fn named(name: &str, indices: &[String], distance: [i64; AXES]) -> String {
    let index = |(index, offset): (&String, i64)| match offset {
        0 => index.clone(),
        _ => format!("{index}{offset:+}"),
    };
    let of_axes = &distance[others(indices)..];
    let of_axes = of_axes.iter().copied();
    let indices: Vec<String> = indices.iter().zip(of_axes).map(index).collect();
    format!("{name}[{}]", indices.join(","))
}

/// How many axes the sites with these indices do not have: those before the last ones.
fn others<T>(indices: &[T]) -> usize {
    AXES.saturating_sub(indices.len())
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
    /// Of each coefficient how many last layers, rows and columns no sum has asked for; none before one asks.
    unused: Vec<Option<[usize; AXES]>>,
}

/// Sites and coefficients at distances.
#[derive(Default)]
struct Near {
    sites: BTreeSet<[i64; AXES]>,
    data: BTreeSet<([i64; AXES], usize)>,
}

/// A sum that is being read.
struct Reading<'a> {
    variables: Vec<&'a Name>,
    spans: Vec<Span>,
    sites: BTreeSet<[i64; AXES]>,
    moving: BTreeSet<[i64; AXES]>,
    data: BTreeSet<([i64; AXES], usize)>,
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
        let help = format!(
            "write `{}` in a sum",
            named(name, &self.indices(), [0; AXES])
        );
        let message = format!("`{name}` has a value for each site and needs an index");
        Diagnostic::new(Kind::UnknownSymbol, origin, message).help(help)
    }

    fn without_index(&self, name: &str, origin: Origin) -> Diagnostic {
        let help = format!(
            "write `{}` in a sum",
            named(name, &self.indices(), [0; AXES])
        );
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
                mistakes.push(self.other_ranges(reading.spans.len(), expr.origin));
                return None;
            };
            self.fresh(index, mistakes)?;
            reading.spans.push(bounds::span(from, to, size, mistakes)?);
            reading.variables.push(index);
            body = inner;
        }
        if matches!(body.kind, ExprKind::IndexedSum { .. }) && body.origin == expr.origin {
            mistakes.push(self.other_ranges(self.family.sizes.len() + 1, expr.origin));
            return None;
        }
        let body = mapped(body, &mut |part| match &part.kind {
            ExprKind::IndexedSum { .. } => {
                mistakes.push(within(part.origin));
                None
            }
            _ => self.at_site(part, &mut reading, mistakes),
        })?;
        self.found.push(Sum {
            body,
            sites: reading.sites,
            moving: reading.moving,
            data: reading.data,
            spans: last_axes(&reading.spans, None)?,
            over_bonds: false,
            origin: expr.origin,
        });
        Some(self.last(expr.origin))
    }

    /// The answer to a sum that goes along another number of axes than the sites have.
    fn other_ranges(&self, found: usize, origin: Origin) -> Diagnostic {
        let sizes = &self.family.sizes;
        let number = |count: usize| match count {
            1 => "one index".to_owned(),
            _ => format!("{count} indices"),
        };
        let message = format!(
            "the sum has {}, and the sites have {}",
            number(found),
            number(sizes.len())
        );
        let range = |(size, index): (&Size, &Name)| format!("{} in 0..{}", index.text, size.text());
        let ranges: Vec<String> = sizes.iter().zip(&self.family.indices).map(range).collect();
        let help = format!("write `sum({}: …)`", ranges.join(", "));
        Diagnostic::new(Kind::Syntax, origin, message).help(help)
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
        let indices: Vec<&Index> = index.along_axes().collect();
        let variables: Vec<&str> = reading.variables.iter().map(|v| v.text.as_str()).collect();
        let right = format!("write `{name}[{}]`", variables.join(", "));
        if indices.len() != variables.len() {
            let message = format!("`{name}` has {} indices here", indices.len());
            return fail(Kind::Syntax, message, right);
        }
        let (mut distance, others) = ([0; AXES], others(&variables));
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
            distance[axis + others] = index.offset;
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
    fn asked(&mut self, place: usize, distance: [i64; AXES], spans: &[Span]) {
        let others = others(spans);
        let unused = |axis: usize| {
            let span = axis.checked_sub(others).and_then(|axis| spans[axis]);
            let left = span.map_or(0, |(_, left)| left as i64 - distance[axis]);
            usize::try_from(left).unwrap_or(0)
        };
        let found: [usize; AXES] = from_fn(unused);
        let known = self.unused[place].get_or_insert(found);
        *known = from_fn(|axis| known[axis].min(found[axis]));
    }
}
