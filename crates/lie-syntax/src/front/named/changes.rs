//! What is written beside the name of an algebra: an action on a space, a central extension, another basis, other matrices.

use std::collections::BTreeMap;

use super::fits;
use crate::ast::{Bracket, Matrix, Name};
use crate::constructors::{
    Acted, Central, Constants, Entries, Matrices, NamedAlgebra, changed, extended, semidirect,
};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::entries::{Line, Read};
use crate::front::token::span;
use crate::front::{Names, item};
use crate::linear::{Scope, WORK, rational, rational_form};
use lie_symbolic::exact::{Budget, Fraction, Rational};

/// A named algebra as it is.
pub fn standard(named: &NamedAlgebra, place: Origin) -> Read {
    Read {
        algebra: named.declared(place),
        state: Some(named.coordinates(place)),
        sizes: Vec::new(),
    }
}

/// A key that belongs to a named algebra.
pub fn without_name(kind: Kind, key: &str, place: Origin) -> Diagnostic {
    let message = format!("`{key}` extends an algebra by its name, and there is no `named`");
    Diagnostic::new(kind, place, message)
        .help("write the central elements into `basis`, and their brackets")
}

/// What is written beside the name of an algebra.
pub struct Changes<'a> {
    /// The matrices by which the algebra acts on a further space.
    pub action: Option<Vec<Matrix>>,
    /// Other names, or another basis as `NAME = combination`.
    pub basis: Option<Vec<Line<'a>>>,
    /// Names of central elements.
    pub central: Vec<Name>,
    /// The cocycle, with values in these.
    pub brackets: Vec<Line<'a>>,
    /// Another representation.
    pub matrices: Option<Vec<Matrix>>,
    /// The whole.
    pub origin: Origin,
}

impl Changes<'_> {
    /// The algebra with its changes: first the further space, then the extension, then the basis.
    pub fn apply(self, mut named: NamedAlgebra, report: &mut Report) -> Option<Read> {
        let is_standard = self.basis.is_none() && self.central.is_empty();
        if let Some(action) = &self.action {
            named = self.acting(named, action, report)?;
        }
        if let Some(place) = span_of(&self.brackets).filter(|_| self.central.is_empty()) {
            let message = "an algebra by its name has its brackets; what is added to them has values in new, central elements";
            let diagnostic = Diagnostic::new(Kind::Basis, place, message);
            report.push(diagnostic.help("name these in `central`, or remove the brackets"));
            return None;
        }
        if !self.central.is_empty() {
            named = self.extended(named, report)?;
        }
        let mut places = None;
        if let Some(lines) = &self.basis {
            let names;
            (named, names) = self.changed(&named, lines, report)?;
            places = Some(names);
        }
        let mut algebra = named.declared(self.origin);
        let places = places.into_iter().flatten().chain(self.central);
        for place in places {
            let of_name = |name: &&mut Name| name.text == place.text;
            if let Some(name) = algebra.basis.iter_mut().find(of_name) {
                name.origin = place.origin;
            }
        }
        if let Some(matrices) = self.matrices {
            algebra.matrices = matrices;
        }
        let state = if is_standard {
            named.coordinates(self.origin)
        } else {
            Vec::new()
        };
        Some(Read {
            algebra,
            state: Some(state),
            sizes: Vec::new(),
        })
    }

    /// The semidirect product with a space on which these matrices act.
    fn acting(
        &self,
        named: NamedAlgebra,
        action: &[Matrix],
        report: &mut Report,
    ) -> Option<NamedAlgebra> {
        let basis = named.declared(self.origin).basis;
        let scope = Scope::from_basis(&basis);
        for (index, matrix) in action.iter().enumerate() {
            let name = &matrix.name;
            if scope.basis_index(&name.text).is_none() {
                report.push(scope.unknown_basis(Kind::Basis, name));
                return None;
            }
            if action[..index]
                .iter()
                .any(|other| other.name.text == name.text)
            {
                let message = format!("a second matrix for `{}`", name.text);
                report.push(
                    Diagnostic::new(Kind::Basis, name.origin, message).help("keep one of the two"),
                );
                return None;
            }
        }
        let size = action.first().map_or(0, |matrix| matrix.rows.len());
        let place = |text: &str| action.iter().find(|matrix| matrix.name.text == text);
        let mut entries = Vec::new();
        for name in &basis {
            // what is not written acts as zero
            let Some(matrix) = place(&name.text) else {
                entries.push(Entries::new());
                continue;
            };
            if size == 0
                || matrix.rows.len() != size
                || matrix.rows.iter().any(|row| row.len() != size)
            {
                let message = format!(
                    "the matrix of `{}` is not square, or not of the size of the others",
                    name.text
                );
                let help = "the matrices of an action are square and of one size";
                report
                    .push(Diagnostic::new(Kind::Representation, matrix.origin, message).help(help));
                return None;
            }
            entries.push(sparse(matrix, report)?);
        }
        let action = Matrices { size, entries };
        if let Some((i, j)) = named.not_represented(&action) {
            let [a, b] = [i, j].map(|index| scope.basis()[index]);
            let matrix = place(b).or(place(a));
            let message = format!("the matrices of the action do not represent [{a}, {b}]");
            let place = matrix.map_or(self.origin, |matrix| matrix.origin);
            let help = "correct them; one that is left out is zero";
            report.push(Diagnostic::new(Kind::Representation, place, message).help(help));
            return None;
        }
        let fits = fits(named.dimension() + size, self.origin, report);
        fits.then(|| semidirect(named, vec![Acted::new(action)]))
    }

    /// The central extension by the brackets.
    fn extended(&self, named: NamedAlgebra, report: &mut Report) -> Option<NamedAlgebra> {
        let old = named.declared(self.origin).basis;
        let elements: Names = names(&old).chain(names(&self.central)).collect();
        let (old, new) = (Scope::from_basis(&old), Scope::from_basis(&self.central));
        let mut central = Central {
            names: names(&self.central).collect(),
            cocycle: Constants::new(),
        };
        for name in &self.central {
            if old.basis_index(&name.text).is_some() {
                let message = format!("`{}` is in the basis of the algebra already", name.text);
                let diagnostic = Diagnostic::new(Kind::DuplicateName, name.origin, message);
                report.push(diagnostic.help("choose another name"));
                return None;
            }
        }
        for line in &self.brackets {
            let bracket = item::bracket(&line.tokens, line.place, &elements, report)?;
            added(&bracket, (&old, &new), &mut central.cocycle, report)?;
        }
        let place = span_of(&self.brackets).unwrap_or(self.origin);
        match extended(named, &central) {
            Ok(named) => Some(named),
            Err((triple, residual)) => {
                let [a, b, c] = triple.map(|index| old.basis()[index]);
                let residual = residual
                    .into_iter()
                    .map(|(k, value)| (k, Fraction::from(value)));
                let residual = new.display(&residual.collect::<Vec<_>>());
                let message = format!(
                    "the cocycle identity fails for ({a}, {b}, {c}): S([{a}, {b}], {c}) + S([{b}, {c}], {a}) + S([{c}, {a}], {b}) = {residual}"
                );
                report.push(
                    Diagnostic::new(Kind::Cocycle, place, message)
                        .help("correct the brackets; S(a, b) is what they add to [a, b]"),
                );
                None
            }
        }
    }

    /// The algebra in the basis of these lines, and its names with their places.
    fn changed(
        &self,
        named: &NamedAlgebra,
        lines: &[Line<'_>],
        report: &mut Report,
    ) -> Option<(NamedAlgebra, Vec<Name>)> {
        let declared = named.declared(self.origin).basis;
        let known: Names = names(&declared).collect();
        let scope = Scope::from_basis(&declared);
        let budget = Budget::new(WORK);
        let (mut new, mut rows) = (Vec::new(), Vec::new());
        for (index, line) in lines.iter().enumerate() {
            if !line.tokens.iter().any(|token| token.is('=')) {
                new.push(item::name(&line.tokens, line.place, report)?);
                rows.push([(index, Rational::ONE)].into());
                continue;
            }
            let what = "an element of the basis";
            let (name, value) = item::definition(&line.tokens, what, line.place, report)?;
            let example = ("its value", "e1 + 2*e2");
            let value = item::formula(value, example, name.origin, &known, report)?;
            rows.push(report.accept(rational_form(&value, &scope, &budget))?);
            new.push(name);
        }
        let plain = lines
            .iter()
            .filter(|line| !line.tokens.iter().any(|token| token.is('=')));
        let mixed = ![0, lines.len()].contains(&plain.count());
        let (count, n) = (lines.len(), named.dimension());
        if count != n || mixed {
            let message = if mixed {
                "some elements of the basis are names, others are combinations".to_owned()
            } else {
                format!("the basis has {count} elements, but the algebra has dimension {n}")
            };
            let place = span_of(lines).unwrap_or(self.origin);
            let help = format!(
                "name all of {}, or write each new element as a combination of them",
                scope.basis().join(", ")
            );
            report.push(Diagnostic::new(Kind::Basis, place, message).help(help));
            return None;
        }
        let Some(changed) = changed(named, names(&new).collect(), &rows) else {
            let place = span_of(lines).unwrap_or(self.origin);
            let message = "the elements of the basis are linearly dependent";
            let diagnostic = Diagnostic::new(Kind::Basis, place, message);
            report.push(diagnostic.help("write independent combinations"));
            return None;
        };
        Some((changed, new))
    }
}

/// Adds a bracket of old elements with its value in new ones to a cocycle; `None` if it is none.
fn added(
    bracket: &Bracket,
    (old, new): (&Scope<'_>, &Scope<'_>),
    cocycle: &mut Constants,
    report: &mut Report,
) -> Option<()> {
    let ends = [&bracket.left, &bracket.right].map(|name| {
        let index = old.basis_index(&name.text);
        if index.is_none() {
            report.push(old.unknown_basis(Kind::UnknownSymbol, name));
        }
        index
    });
    let [Some(i), Some(j)] = ends else {
        return None;
    };
    let terms = rational_form(&bracket.value, new, &Budget::new(WORK));
    let mut terms = report.accept(terms)?;
    if i > j {
        terms.values_mut().for_each(|value| *value = -&*value);
    }
    let pair = (i.min(j), i.max(j));
    if let Some(diagnostic) = repeated(bracket, i == j, cocycle.get(&pair), &terms) {
        report.push(diagnostic);
        return None;
    }
    cocycle.insert(pair, terms);
    Some(())
}

/// A bracket of an element with itself that is not zero, or one that was given another value before.
fn repeated(
    bracket: &Bracket,
    with_itself: bool,
    before: Option<&BTreeMap<usize, Rational>>,
    terms: &BTreeMap<usize, Rational>,
) -> Option<Diagnostic> {
    let shown = format!("[{}, {}]", bracket.left.text, bracket.right.text);
    if with_itself && !terms.is_empty() {
        let message = format!("{shown} is not zero, but a bracket is antisymmetric");
        let diagnostic = Diagnostic::new(Kind::Antisymmetry, bracket.origin, message);
        return Some(diagnostic.help("remove this bracket"));
    }
    let message = format!("{shown} was already given another value");
    let differs = before.is_some_and(|before| before != terms);
    let diagnostic = Diagnostic::new(Kind::DuplicateBracket, bracket.origin, message);
    differs.then(|| diagnostic.help("keep one of the two"))
}

/// The entries of a matrix that are not zero.
fn sparse(matrix: &Matrix, report: &mut Report) -> Option<Entries> {
    let budget = Budget::new(WORK);
    let mut entries = Entries::new();
    for (r, row) in matrix.rows.iter().enumerate() {
        for (c, entry) in row.iter().enumerate() {
            let value = report.accept(rational(entry, &budget))?;
            if !value.is_zero() {
                entries.insert((r, c), value);
            }
        }
    }
    Some(entries)
}

fn names(names: &[Name]) -> impl Iterator<Item = String> {
    names.iter().map(|name| name.text.clone())
}

fn span_of(lines: &[Line<'_>]) -> Option<Origin> {
    let place = |line: &Line<'_>| span(&line.tokens).unwrap_or(line.place);
    Some(place(lines.first()?).join(place(lines.last()?)))
}
