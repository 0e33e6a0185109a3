//! Names of columns, and of entries of a group element that is not declared, which expressions do not know.

use lie_syntax::ast::Declaration;
use std::cell::OnceCell;
use std::collections::HashMap;

/// The column of H.
const ENERGY: &str = "energy";

/// The names of a declaration that stand above columns, each with what it is, by which errors on unknown names are looked up.
#[derive(Clone, Debug)]
pub struct Columns<'a> {
    pub declaration: &'a Declaration,
    /// Made with the first error: there may be as many as names.
    names: OnceCell<HashMap<String, &'static str>>,
}

impl<'a> Columns<'a> {
    pub fn new(declaration: &'a Declaration) -> Self {
        Self {
            declaration,
            names: OnceCell::new(),
        }
    }

    fn all(&self) -> HashMap<String, &'static str> {
        let declaration = self.declaration;
        let casimirs = declaration.casimirs.iter().filter_map(|c| c.name.as_ref());
        let integrals = declaration.integrals.iter().map(|(name, _)| name);
        let observables = declaration.observables.iter().map(|o| &o.name);
        // of two with one name the last counts
        let mut names = HashMap::from([(ENERGY.to_owned(), "the column of the energy")]);
        names.extend(casimirs.map(|name| (name.text.clone(), "a Casimir")));
        names.extend(integrals.map(|name| (name.text.clone(), "a first integral")));
        names.extend(observables.map(|name| (name.text.clone(), "an observable")));
        names
    }

    /// Message and remedy for the name of a column that stands in an expression; none for other names.
    pub fn meant(&self, name: &str) -> Option<(String, String)> {
        let what = self.names.get_or_init(|| self.all()).get(name)?;
        let help = match name {
            ENERGY => {
                "write the Hamiltonian out; what both contain can be an abbreviation".to_owned()
            }
            _ => format!(
                "write the expression of `{name}` out, or make it an abbreviation with another name, which both may contain"
            ),
        };
        Some((
            format!(
                "`{name}` is {what}, and functions, of events too, are expressions of the state"
            ),
            help,
        ))
    }
}

/// What more helps where a name looks like an entry of the group element, `R11`, and there is none.
pub fn element(declaration: &Declaration, name: &str) -> Option<String> {
    let mut letters = name.chars();
    let matrix = letters
        .next()
        .filter(|c| c.is_ascii_uppercase() || *c == 'g')?;
    let indices: Vec<char> = letters.collect();
    let entry = indices.len() == 2 && indices.iter().all(|c| ('1'..='9').contains(c));
    let single = declaration.algebra().is_some() && declaration.family.is_none();
    (entry && single && declaration.group.is_none()).then(|| {
        format!(
            "; if it is an entry of the group element, declare that by `\"group\": \"{matrix}\"`, in the macro `group {matrix};`"
        )
    })
}
