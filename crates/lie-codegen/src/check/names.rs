//! Names: identifiers, none reserved, none twice in one name space.

use std::collections::HashMap;

use crate::model::WORK;
use lie_syntax::ast::names::{is_keyword, is_reserved};
use lie_syntax::ast::{Declaration, Expr, ExprKind, Name, Realization};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Types that generated code names without a path: a system of that name would hide them.
const TYPES: &[&str] = &[
    "S", "bool", "char", "f32", "f64", "i8", "i16", "i32", "i64", "i128", "isize", "str", "u8",
    "u16", "u32", "u64", "u128", "usize",
];
/// So many elements of a basis are listed.
const MOST_LISTED: usize = 8;

/// Every bad name.
///
/// Basis and state are separate name spaces, because elements of the algebra and coordinates of
/// its dual never stand in one expression. Parameters and abbreviations can stand beside both.
pub fn name_spaces(declaration: &Declaration) -> Vec<Diagnostic> {
    let mut mistakes = Vec::new();
    let basis = declaration.basis();
    let state = &declaration.state;
    let velocity = declaration.energy.velocity();
    let parameters = declaration.parameters.iter().map(|p| &p.name);
    let family = declaration.family.as_ref();
    let bonds = family.and_then(|family| family.bonds.as_ref());
    let data = declaration.site_data().iter().chain(bonds);
    let parameters = parameters.chain(data.map(|data| &data.name));
    let lets = declaration.lets.iter().map(|(name, _)| name);
    let casimirs = declaration.casimirs.iter().filter_map(|c| c.name.as_ref());
    for name in [&declaration.name]
        .into_iter()
        .chain(basis)
        .chain(state)
        .chain(velocity)
        .chain(&declaration.group)
        .chain(declaration.realization.iter().flat_map(Realization::names))
        .chain(parameters.clone())
        .chain(lets.clone())
        .chain(casimirs.clone())
        .chain(declaration.quantities().map(|(name, _)| name))
    {
        mistakes.extend(forbidden(name));
    }
    if declaration.energy.has_step() {
        mistakes.extend(steps(declaration));
    }
    if TYPES.contains(&declaration.name.text.as_str()) {
        mistakes.push(of_a_type(&declaration.name));
    }
    let mut algebra: HashMap<&str, &str> = HashMap::new();
    let mut dual: HashMap<&str, &str> = HashMap::new();
    for name in basis {
        declare(&mut [&mut algebra], name, "basis element", &mut mistakes);
    }
    for name in state {
        declare(&mut [&mut dual], name, "coordinate", &mut mistakes);
    }
    for name in velocity {
        declare(
            &mut [&mut dual],
            name,
            "component of the velocity",
            &mut mistakes,
        );
    }
    for name in declaration.realization.iter().flat_map(Realization::names) {
        declare(
            &mut [&mut dual],
            name,
            "canonical coordinate",
            &mut mistakes,
        );
    }
    // A Casimir is a column beside the coordinates, but no expression refers to it.
    let mut columns = dual.clone();
    let others = parameters.clone().chain(lets.clone());
    for name in parameters {
        declare(
            &mut [&mut algebra, &mut dual],
            name,
            "parameter",
            &mut mistakes,
        );
    }
    for name in lets {
        declare(
            &mut [&mut algebra, &mut dual],
            name,
            "abbreviation",
            &mut mistakes,
        );
    }
    for name in casimirs.clone() {
        declare(&mut [&mut columns], name, "Casimir", &mut mistakes);
    }
    if declaration.is_driven() {
        let columns = state.iter().chain(casimirs.clone());
        mistakes.extend(columns.filter_map(of_work));
    }
    for (name, what) in declaration.quantities() {
        let mut spaces = vec![&mut columns];
        if !records_abbreviation(declaration, name) {
            spaces.push(&mut dual);
        }
        if what == "input" {
            // it stands in expressions, as a parameter does
            spaces.push(&mut algebra);
        }
        declare(&mut spaces, name, what, &mut mistakes);
        mistakes.extend(of_work(name));
    }
    // labels of rows of a table of their own
    let mut labels = HashMap::new();
    for event in &declaration.events {
        declare(&mut [&mut labels], &event.name, "event", &mut mistakes);
        mistakes.extend(forbidden(&event.name));
    }
    // the basis of an algebra by its name stands where that name does: nobody wrote its elements
    if let [first, second, ..] = basis
        && first.origin == second.origin
    {
        let of_basis = |name: &&Name| basis.iter().any(|element| element.text == name.text);
        for name in others.filter(of_basis) {
            let of_name = |mistake: &&mut Diagnostic| mistake.origin == Some(name.origin);
            let found = mistakes.iter_mut().find(of_name);
            if let Some(mistake) = found.filter(|m| m.kind == Kind::DuplicateName) {
                explain(mistake, name, basis);
            }
        }
    }
    mistakes
}

/// Says where a name comes from that an algebra by its name brings along.
fn explain(mistake: &mut Diagnostic, name: &Name, basis: &[Name]) {
    let elements: Vec<&str> = basis
        .iter()
        .take(MOST_LISTED)
        .map(|e| e.text.as_str())
        .collect();
    let more = if basis.len() > MOST_LISTED {
        ", …"
    } else {
        ""
    };
    let elements = elements.join(", ");
    mistake.message +=
        &format!(": the algebra, which is given by its name, has the basis {elements}{more}");
    mistake.help = Some(format!(
        "choose another name, such as `{}_`; or name the basis, as in {{\"named\": \"se(3)\", \"basis\": [\"L1\", …]}}",
        name.text
    ));
}

/// What is called as the step size, which a discrete Lagrangian contains.
fn steps(declaration: &Declaration) -> impl Iterator<Item = Diagnostic> {
    let lets = declaration.lets.iter().map(|(name, _)| name);
    let parameters = declaration.parameters.iter().map(|p| &p.name);
    let names = declaration.energy.velocity().iter();
    let names = names
        .chain(&declaration.state)
        .chain(parameters)
        .chain(lets);
    names.filter(|name| name.text == "h").map(|name| {
        let message = "`h` is the step size in a discrete Lagrangian";
        Diagnostic::new(Kind::ReservedName, name.origin, message).help("choose another name")
    })
}

/// What is called as the column of the work.
fn of_work(name: &Name) -> Option<Diagnostic> {
    (name.text == WORK).then(|| {
        let message = "`work` is the column of what forces and damping do";
        Diagnostic::new(Kind::ReservedName, name.origin, message).help("choose another name")
    })
}

/// Whether this is an abbreviation that is recorded under its own name.
fn records_abbreviation(declaration: &Declaration, name: &Name) -> bool {
    let is_itself = |value: &Expr| matches!(&value.kind, ExprKind::Name { name: value, index: None } if *value == name.text);
    let mut observables = declaration.observables.iter();
    let recorded = observables.any(|o| o.name.text == name.text && is_itself(&o.value));
    recorded
        && declaration
            .lets
            .iter()
            .any(|(other, _)| other.text == name.text)
}

fn of_a_type(name: &Name) -> Diagnostic {
    let message = format!(
        "`{}` is the name of a type of the generated code",
        name.text
    );
    Diagnostic::new(Kind::ReservedName, name.origin, message)
        .help("choose another name for the system, such as RigidBody")
}

fn declare<'a>(
    spaces: &mut [&mut HashMap<&'a str, &'static str>],
    name: &'a Name,
    what: &'static str,
    mistakes: &mut Vec<Diagnostic>,
) {
    if let Some(other) = spaces
        .iter()
        .find_map(|space| space.get(name.text.as_str()))
    {
        let message = if *other == what {
            format!("`{}` is declared twice", name.text)
        } else {
            let article = match other.starts_with(['a', 'e', 'i', 'o']) {
                true => "an",
                false => "a",
            };
            format!(
                "the {what} `{}` has the name of {article} {other}",
                name.text
            )
        };
        let help = if name.text.is_ascii() {
            "choose another name"
        } else {
            "choose another name; letters with marks are compared in Unicode's normalisation form C, as Rust does"
        };
        mistakes.push(Diagnostic::new(Kind::DuplicateName, name.origin, message).help(help));
        return;
    }
    for space in spaces {
        space.insert(&name.text, what);
    }
}

/// The mistake of a name that nothing may have.
fn forbidden(name: &Name) -> Option<Diagnostic> {
    let text = name.text.as_str();
    let mut letters = text.chars();
    let first = letters
        .next()
        .is_some_and(|c| c == '_' || unicode_ident::is_xid_start(c));
    if !first || !letters.all(unicode_ident::is_xid_continue) {
        let message = format!("`{}` is not an identifier", text.escape_debug());
        return Some(
            Diagnostic::new(Kind::Syntax, name.origin, message)
                .help("a name begins with a letter and consists of letters, digits and `_`"),
        );
    }
    let why = if !is_reserved(text) {
        return None;
    } else if is_keyword(text) {
        "a keyword of Rust"
    } else if text.starts_with('_') {
        "kept for generated code, as is every name that begins with `_`"
    } else if text == "energy" {
        "the column of the Hamiltonian in every output"
    } else {
        "a word of the language"
    };
    let message = format!("`{text}` is {why}");
    Some(Diagnostic::new(Kind::ReservedName, name.origin, message).help("choose another name"))
}
