//! The pages of reference, written from the tables of the compiler.

use std::fmt::Write as _;

use lie_codegen::compile::{compile_spec, expand};
use lie_codegen::methods::CATALOGUE;
use lie_syntax::diagnostic::Kind;
use lie_syntax::front::{schema, vocabulary};
use serde_json::Value;

use crate::common::catalogue::words;
use crate::compare;

/// The head of a page.
fn head(title: &str, about: &str) -> String {
    format!(
        "# {title}\n\n<!-- written by `LIE_UPDATE_GOLDEN=1 cargo test --test book` -->\n\n{about}\n"
    )
}

/// Text in a cell of a table.
fn cell(text: &str) -> String {
    text.replace('\n', " ").replace('|', "\\|")
}

/// The derivative of a function of one argument, as the compiler finds it: p' = -dH/dq.
fn derivative(call: &str) -> String {
    let energy = call.replace("(x)", "(q)");
    let spec = format!(
        r#"{{"name": "A", "poisson": ["{{q, p}} = 1"], "state": ["q", "p"], "hamiltonian": "-{energy}"}}"#
    );
    let model = compile_spec(&spec).expect("a sound spec");
    let code = expand(&model, &[]);
    let equation = code
        .lines()
        .find_map(|line| line.trim().strip_prefix("/// p' = "));
    let equation = equation.unwrap_or_else(|| panic!("no equation in {code}"));
    let letter = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let characters: Vec<char> = equation.chars().collect();
    let renamed = characters.iter().enumerate().map(|(i, c)| {
        let alone = !letter(i.checked_sub(1).map(|i| characters[i]))
            && !letter(characters.get(i + 1).copied());
        if *c == 'q' && alone { 'x' } else { *c }
    });
    renamed.collect()
}

#[test]
fn the_page_of_functions_is_current() {
    let mut text = head(
        "Functions",
        "These are the functions of the expression language. The tables come from the parser, and the derivatives are those \
         that the compiler takes.\n\nThe names are reserved. A declaration has no function of its own but by a \
         [table](language.md#functions-by-tables), or in the macro by a path of Rust.",
    );
    text += "\n## Of numbers\n\n| Written | Is | Derivative |\n|---|---|---|\n";
    for function in vocabulary::functions() {
        let derivative = match function.call.ends_with("(x)") {
            true => format!("`{}`", derivative(function.call)),
            false => String::new(),
        };
        let _ = writeln!(
            text,
            "| `{}` | {} | {derivative} |",
            cell(function.call),
            cell(function.meaning)
        );
    }
    text += "\n## Of vectors and matrices\n\n| Written | Is |\n|---|---|\n";
    for function in vocabulary::vector_functions() {
        let _ = writeln!(
            text,
            "| `{}` | {} |",
            cell(function.call),
            cell(function.meaning)
        );
    }
    let names = vocabulary::built_in()
        .iter()
        .map(|name| format!("`{name}`"));
    let names: Vec<String> = names.collect();
    let _ = write!(
        text,
        "\n## Names with a value\n\n{}: the circle constant and the time.\n",
        names.join(" and ")
    );
    text += "\n## Functions of other languages\n\nThe compiler knows these names from elsewhere. It refuses them and says what to \
             write.\n\n| Elsewhere | Here |\n|---|---|\n";
    for (name, form) in vocabulary::elsewhere() {
        let _ = writeln!(text, "| `{name}` | `{}` |", cell(&form));
    }
    compare("reference/functions.md", text.as_bytes());
    assert_eq!(derivative("sin(x)"), "cos(x)");
    assert_eq!(derivative("exp(x)"), "exp(x)");
}

/// The type of a key in words.
fn kind(schema: &Value) -> String {
    if let Some(reference) = schema["$ref"].as_str() {
        let name = reference.rsplit('/').next().unwrap_or_default();
        return format!("[{name}](#{})", name.to_lowercase());
    }
    if !schema["const"].is_null() {
        return format!("`{}`", schema["const"]);
    }
    if let Some(options) = schema["anyOf"]
        .as_array()
        .or_else(|| schema["oneOf"].as_array())
    {
        let options: Vec<String> = options.iter().map(kind).collect();
        return options.join(" or ");
    }
    match schema["type"].as_str() {
        Some("array") if schema["prefixItems"].is_array() => "pair".to_owned(),
        Some("array") => format!(
            "list of {}",
            kind(&schema["items"]).replacen("list of", "lists of", 1)
        ),
        Some("object") => format!(
            "object, each value a {}",
            kind(&schema["additionalProperties"])
        ),
        Some("string") => "text".to_owned(),
        Some("boolean") => "`true` or `false`".to_owned(),
        Some("number") => "number".to_owned(),
        Some("integer") => "whole number".to_owned(),
        other => other.unwrap_or("any").to_owned(),
    }
}

/// The keys of an object as a table, or the forms of a value as a list.
fn describe(text: &mut String, name: &str, schema: &Value) {
    let _ = write!(
        text,
        "\n## {name}\n\n{}\n\n",
        schema["description"].as_str().unwrap_or_default()
    );
    if let Some(keys) = schema["properties"].as_object() {
        let required = schema["required"].as_array().cloned().unwrap_or_default();
        text.push_str("| Key | Value | Meaning |\n|---|---|---|\n");
        for (key, value) in keys {
            let must = if required.contains(&Value::from(key.as_str())) {
                " (required)"
            } else {
                ""
            };
            let meaning = value["description"].as_str().unwrap_or_default();
            let _ = writeln!(
                text,
                "| `{key}`{must} | {} | {} |",
                cell(&kind(value)),
                cell(meaning)
            );
        }
        return;
    }
    let forms = schema["anyOf"]
        .as_array()
        .or_else(|| schema["oneOf"].as_array());
    for form in forms.into_iter().flatten() {
        let meaning = form["description"].as_str().unwrap_or_default();
        let _ = writeln!(text, "- {}: {}", kind(form), cell(meaning));
    }
    for value in schema["enum"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "- `{value}`");
    }
}

#[test]
fn the_page_of_keys_is_current() {
    let schema = schema();
    let mut text = head(
        "Keys of a spec",
        "A spec is a JSON object with these keys. This page is made of the JSON Schema that `lie schema` prints and an editor \
         can read. An unknown key, and a key that is there twice, are errors.\n\nThere is one of `hamiltonian`, `lagrangian` and \
         `discrete_lagrangian`, and one of `algebra` and `poisson`.",
    );
    describe(&mut text, "Spec", &schema);
    for (name, definition) in schema["$defs"].as_object().expect("definitions") {
        describe(&mut text, name, definition);
    }
    assert!(text.contains("| `hamiltonian` | text |"), "{text}");
    compare("reference/keys.md", text.as_bytes());
}

#[test]
fn the_page_of_methods_is_current() {
    let mut text = head(
        "Methods",
        "The catalogue of methods, as `lie methods` lists it. *Orbit* is the coadjoint orbit, and with it every Casimir. \
         *Poisson* means that a step is a Poisson map. `lie check SPEC` says which of them apply to a system, and why the \
         others do not.",
    );
    text += "\n| Id | Name | Order | Symmetric | Solves equations | Keeps | Needs | Reference |\n|---|---|---|---|---|---|---|---|\n";
    for method in CATALOGUE {
        let yes = |is: bool| if is { "yes" } else { "no" };
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} | {} | {} | {} |",
            method.id,
            cell(method.title),
            method.order,
            yes(method.symmetric),
            yes(!method.explicit),
            words(method).replace("as ID", "what its base keeps"),
            cell(method.needs),
            cell(method.reference),
        );
    }
    text += "\n## Options\n\n| Option | Values, the default first | Methods |\n|---|---|---|\n";
    let mut options: Vec<(String, Vec<&str>)> = Vec::new();
    for method in CATALOGUE {
        for (name, _) in method.options() {
            let values = method.values(name).into_iter();
            let values: Vec<String> = values.map(|value| format!("`{value}`")).collect();
            let option = format!("| `--{name}` | {} |", values.join(", "));
            match options.iter_mut().find(|(known, _)| *known == option) {
                Some((_, ids)) => ids.push(method.id),
                None => options.push((option, vec![method.id])),
            }
        }
    }
    for (option, ids) in options {
        let ids: Vec<String> = ids.iter().map(|id| format!("`{id}`")).collect();
        let _ = writeln!(text, "{option} {} |", ids.join(", "));
    }
    compare("reference/methods.md", text.as_bytes());
}

#[test]
fn the_page_of_errors_is_current() {
    let mut text = head(
        "Errors",
        "A mistake is reported as `error[KIND]` with its place and a remedy. These are the kinds.",
    );
    text += "\n| Kind | When |\n|---|---|\n";
    for kind in Kind::ALL {
        let _ = writeln!(text, "| `{}` | {} |", kind.as_str(), cell(kind.meaning()));
    }
    compare("reference/errors.md", text.as_bytes());
}
