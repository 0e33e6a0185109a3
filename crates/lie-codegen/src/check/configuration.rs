//! Systems on T*G and systems that depend on the time, as Lie–Poisson systems of a larger algebra.
//!
//! The equations `g' = g xi`, `mu' = ad*_xi mu - F`, `xi = dH/dmu`, `F = L_g^* dH/dg` of a Hamiltonian
//! `H(g, mu)` are those of the semidirect product of the algebra with the matrices: the entries `g_ab` are
//! coordinates beside mu, and `g' = g rho(xi)` is the coadjoint action when
//! `[e_i, E_ab] = sum_c rho(e_i)_cb E_ac`. For `H(t, mu)` the time and its momentum are a canonical pair
//! beside mu: `K = H + p`, `t' = dK/dp = 1`, `p' = -dH/dt`, in the Heisenberg algebra `[P, T] = Z`; beside
//! brackets of coordinates they have the bracket `{t, p} = 1`.
//!
//! A cocycle S is that of a central extension, `[e_i, e_j] = C_ij^k e_k - S_ij Z`: its central element is that of the Heisenberg
//! algebra, and the time is there for that alone. It is added when the constants are known ([`super::central`]).
//!
//! Both are written into the declaration, so that all checks see one algebra. The order of the coordinates
//! is mu, p, the entries of g row by row, t, and the central one, whose value is 1.

mod larger;

use super::driving;
use crate::model::configuration::{Configuration, TIME, TIME_MOMENTUM, UNIT};
use larger::Builder;
use lie_symbolic::exact::Rational;
use lie_syntax::ast::{Algebra, Bracket, Declaration, Expr, ExprKind, Invariance, Name, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, plural};
use lie_syntax::limits::MAX_DIMENSION;

/// The configuration of a declaration; `None` where it has neither a group element nor the time.
pub fn configuration(
    declaration: &Declaration,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Configuration> {
    let group = declaration.group.as_ref().and_then(|name| {
        let size = declaration
            .algebra()
            .and_then(|algebra| algebra.matrices.first())
            .map(|m| m.rows.len());
        if size.is_none() {
            mistakes.push(
                Diagnostic::new(
                    Kind::Representation,
                    name.origin,
                    "a group element needs the matrices of the algebra, and none are declared",
                )
                .help("declare `matrices`: the group element is a matrix of their size"),
            );
        }
        Some((name.text.clone(), size?))
    });
    // what forces do is taken from the momentum of the time
    let matters = uses_time(declaration) || declaration.is_driven();
    let extends = extends(declaration);
    let time = matters || extends;
    if group.is_none() && !time {
        return None;
    }
    Some(Configuration {
        momenta: declaration.dimension() + usize::from(time),
        group,
        time,
        idle: extends && !matters,
        held: driving::held::held(declaration, mistakes),
    })
}

/// Whether a cocycle makes a central extension of the algebra. Brackets that are constant are as good as those of any algebra, a
/// realization is one of the declared coordinates, and a constraint leaves a general bracket anyway.
fn extends(declaration: &Declaration) -> bool {
    let Structure::Lie { algebra, cocycle } = &declaration.structure else {
        return false;
    };
    let brackets = algebra.brackets.iter().flatten();
    let moves = !algebra.matrices.is_empty() || brackets.count() > 0;
    let alone = declaration.realization.is_none() && !declaration.is_constrained();
    !cocycle.is_empty() && moves && alone
}

/// Whether an expression mentions the time.
pub fn uses_time(declaration: &Declaration) -> bool {
    let lets = declaration.lets.iter().map(|(_, value)| value);
    let mut parts = lets
        .chain([declaration.energy.expression()])
        .chain(declaration.driving())
        .chain(declaration.recorded())
        .flat_map(Expr::parts);
    parts.any(|part| matches!(&part.kind, ExprKind::Name { name, index: None } if name == TIME))
}

/// The declaration with all coordinates, basis elements, brackets and matrices.
pub fn extended(
    declaration: &Declaration,
    configuration: &Configuration,
    mistakes: &mut Vec<Diagnostic>,
) -> Declaration {
    let group = declaration.group.as_ref();
    let origin = group.map_or(declaration.energy.expression().origin, |name| name.origin);
    let added = Added {
        configuration,
        origin,
    };
    mistakes.extend(clashes(declaration, &configuration.entries(), origin));
    let mut whole = declaration.clone();
    added.names(&mut whole.state);
    if let Some(initial) = &declaration.initial {
        mistakes.extend(twice(declaration, configuration, initial, origin));
        let complete = configuration.complete(initial, |value| added.exact(value.clone()));
        let reduced = configuration.with_fewer_momenta(declaration.constraint.len());
        let complete = complete.or_else(|| {
            let reduced = reduced?;
            reduced.complete(initial, |value| added.exact(value.clone()))
        });
        if complete.is_none() {
            mistakes.push(incomplete(declaration, configuration, initial, origin));
        }
        // of a wrong number of values each is still looked at
        whole.initial = complete.or_else(|| {
            let mut padded = initial.clone();
            padded.resize(whole.state.len(), added.number(0));
            Some(padded)
        });
    }
    match &mut whole.structure {
        Structure::Lie { algebra, .. } => added.elements(algebra, declaration.invariance),
        // the pair is canonical by itself; the central coordinate is there for the order of the others
        Structure::General { brackets, .. } => brackets.push(Bracket {
            left: added.name(TIME),
            right: added.name(TIME_MOMENTUM),
            value: added.number(1),
            origin,
        }),
    }
    whole
}

/// What is added to a declaration, at the place of what asks for it.
struct Added<'a> {
    configuration: &'a Configuration,
    origin: Origin,
}

impl Added<'_> {
    fn name(&self, text: &str) -> Name {
        Name {
            text: text.to_owned(),
            origin: self.origin,
        }
    }

    fn number(&self, value: i64) -> Expr {
        self.exact(Rational::from(value))
    }

    fn exact(&self, value: Rational) -> Expr {
        Expr {
            kind: ExprKind::Number(value),
            origin: self.origin,
        }
    }

    /// The names of coordinates, or of basis elements, behind those that were declared.
    fn names(&self, names: &mut Vec<Name>) {
        let time = self.configuration.time;
        if time {
            names.push(self.name(TIME_MOMENTUM));
        }
        let entries = self.configuration.entries();
        names.extend(entries.iter().map(|text| self.name(text)));
        if time {
            names.extend([TIME, UNIT].map(|text| self.name(text)));
        }
        let held = self.configuration.held.iter();
        names.extend(held.map(|(text, _)| self.name(text)));
    }

    /// The elements of the larger algebra with their brackets and matrices.
    fn elements(&self, algebra: &mut Algebra, invariance: Invariance) {
        let declared = algebra.clone();
        let builder = Builder {
            algebra: &declared,
            invariance,
            configuration: self.configuration,
            origin: self.origin,
        };
        self.names(&mut algebra.basis);
        if let Some(brackets) = &mut algebra.brackets {
            builder.add_brackets(brackets);
        }
        if !declared.matrices.is_empty() {
            algebra.matrices = builder.matrices();
        }
    }
}

/// Entries of the group element in the initial state, where `attitude` gives them.
fn twice(
    declaration: &Declaration,
    configuration: &Configuration,
    initial: &[Expr],
    origin: Origin,
) -> Option<Diagnostic> {
    let (own, entries) = (declaration.state.len(), configuration.entries().len());
    let given = declaration.attitude.is_some() && entries > 0 && initial.len() == own + entries;
    given.then(|| {
        let place = declaration.initial_origin.unwrap_or(origin);
        let message = "the initial group element is given twice: by `initial` and by `attitude`";
        Diagnostic::new(Kind::StateLength, place, message)
            .help("write the momenta alone in `initial`, or remove `attitude`")
    })
}

/// An initial state that has neither the values of the declared coordinates nor those of all.
fn incomplete(
    declaration: &Declaration,
    configuration: &Configuration,
    initial: &[Expr],
    origin: Origin,
) -> Diagnostic {
    let place = declaration.initial_origin;
    let place = place.or(initial.last().map(|e| e.origin)).unwrap_or(origin);
    let (own, entries) = (declaration.state.len(), configuration.entries().len());
    let (or, help) = match entries {
        0 => (
            String::new(),
            "write one value for every coordinate, in their order",
        ),
        _ => (
            format!(
                ", or {} with the entries of the group element",
                own + entries
            ),
            "write the momenta alone, to begin at the identity, or also the entries row by row",
        ),
    };
    let count = initial.len();
    let values = plural(count, "value");
    let message =
        format!("the initial state has {count} {values}, but the state has {own} coordinates{or}");
    Diagnostic::new(Kind::StateLength, place, message).help(help)
}

/// Names of the user that the entries of the group element take, and entries that are too many.
pub fn clashes(
    declaration: &Declaration,
    entries: &[String],
    origin: Origin,
) -> impl Iterator<Item = Diagnostic> {
    let own = declaration.state.iter().chain(declaration.basis());
    let others = declaration.parameters.iter().map(|p| &p.name);
    let lets = declaration.lets.iter().map(|(name, _)| name);
    let velocity = declaration.energy.velocity();
    let casimirs = declaration.casimirs.iter().filter_map(|c| c.name.as_ref());
    let names = own
        .chain(others)
        .chain(lets)
        .chain(velocity)
        .chain(casimirs)
        .chain(declaration.quantities().map(|(name, _)| name));
    let taken = names.filter(|name| entries.contains(&name.text));
    let taken = taken.map(|name| {
        let message = format!("`{}` is an entry of the group element", name.text);
        Diagnostic::new(Kind::DuplicateName, name.origin, message)
            .help("choose another name, here or for the group element")
    });
    let size = entries.len();
    let letters = |c: char| c == '_' || unicode_ident::is_xid_continue(c);
    let many = entries.iter().any(|entry| !entry.chars().all(letters)) || size > MAX_DIMENSION;
    taken.chain(many.then(|| {
        let message = format!("the group element has {size} entries, too many coordinates");
        Diagnostic::new(Kind::Limit, origin, message).help("choose a smaller representation")
    }))
}
