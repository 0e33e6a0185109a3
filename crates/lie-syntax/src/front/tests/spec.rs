//! The spec file: what is read, and mistakes with their exact bytes.

use super::*;
use crate::ast::{Declaration, Invariance};
use crate::front::{Body, Parsed, spec};

const TOP: &str = r#"{
  "$schema": "lie-system.schema.json", "format": 1,
  "name": "HeavyTop", "description": "Heavy top.\nIn the body frame.", "references": ["Arnold"],
  "algebra": { "basis": ["J1","J2","J3"], "brackets": ["[J1, J2] = J3", "[J2, J3] = k*J1"] },
  "state": ["Π1","Π2","\u03a03"],
  "parameters": { "I1": 0.1, "I2": "3/2", "k": { "default": "1/3", "exact": true },
                  "m": { "default": 1e-2, "unit": "N m", "description": "weight" } },
  "let": ["w3 = Π3/I1"],
  "hamiltonian": "Π1^2/(2*I1) + m*w3",
  "casimirs": ["length = Π1^2", "Π2"],
  "methods": ["lie-midpoint"],
  "invariance": "right",
  "initial": [0.3, "-1/2", "cos(I1)"],
  "run": { "method": "lie-midpoint", "step": 0.01, "until": "1/7", "at": "1, 1/2,pi", "retraction": "cayley" }
}"#;

fn read(text: &str) -> (Parsed, Vec<Diagnostic>) {
    let mut report = Report::new();
    let parsed = spec::read(text, &mut report);
    (parsed, report.into_diagnostics())
}

fn declaration(text: &str) -> Declaration {
    match read(text) {
        (
            Parsed {
                body: Some(Body::Declaration(declaration)),
                ..
            },
            _,
        ) => *declaration,
        (_, diagnostics) => panic!("{diagnostics:#?}"),
    }
}

/// `TOP` with a change, and the mistakes it makes.
fn changed(from: &str, to: &str) -> Vec<(Kind, String)> {
    assert!(TOP.contains(from), "{from}");
    let text = TOP.replacen(from, to, 1);
    let (_, diagnostics) = read(&text);
    places(&text, &diagnostics)
        .into_iter()
        .map(|(kind, place)| (kind, place.to_owned()))
        .collect()
}

fn one(kind: Kind, place: &str) -> Vec<(Kind, String)> {
    vec![(kind, place.to_owned())]
}

#[test]
fn everything_is_read() {
    let d = declaration(TOP);
    let texts =
        |names: &[crate::ast::Name]| names.iter().map(|n| n.text.clone()).collect::<Vec<_>>();
    assert_eq!(d.visibility.to_string(), "pub");
    assert_eq!(
        (
            d.name.text.as_str(),
            d.description.len(),
            d.references.len()
        ),
        ("HeavyTop", 2, 1)
    );
    assert_eq!(texts(d.basis()), ["J1", "J2", "J3"]);
    assert_eq!(texts(&d.state), ["Π1", "Π2", "Π3"]);
    let brackets = d.algebra().unwrap().brackets.clone().unwrap();
    assert_eq!(
        (
            brackets[1].left.text.as_str(),
            brackets[1].right.text.as_str()
        ),
        ("J2", "J3")
    );
    assert_eq!(explicit(&brackets[1].value), "(k*J1)");
    let parameters: Vec<_> = d
        .parameters
        .iter()
        .map(|p| (p.name.text.as_str(), explicit(&p.default), p.exact))
        .collect();
    let expected = [
        ("I1", "1/10", false),
        ("I2", "(3/2)", false),
        ("k", "(1/3)", true),
        ("m", "1/100", false),
    ];
    assert_eq!(parameters, expected.map(|(n, v, e)| (n, v.to_owned(), e)));
    assert_eq!(d.parameters[3].unit.as_deref(), Some("N m"));
    assert_eq!(d.parameters[3].description.as_deref(), Some("weight"));
    assert_eq!(
        (d.lets[0].0.text.as_str(), explicit(&d.lets[0].1)),
        ("w3", "(Π3/I1)".into())
    );
    assert_eq!(explicit(d.energy.expression()), "(((Π1^2)/(2*I1))+(m*w3))");
    assert_eq!(d.casimirs[0].name.as_ref().unwrap().text, "length");
    assert!(d.casimirs[1].name.is_none());
    assert_eq!(texts(&d.methods), ["lie-midpoint"]);
    assert_eq!(d.invariance, Invariance::Right);
    let initial: Vec<String> = d.initial.unwrap().iter().map(explicit).collect();
    assert_eq!(initial, ["3/10", "((-1)/2)", "cos(I1)"]);
    let run: Vec<(String, Vec<String>)> = d
        .run
        .iter()
        .map(|o| {
            (
                o.name.text.clone(),
                o.values.iter().map(|(v, _)| v.clone()).collect(),
            )
        })
        .collect();
    assert_eq!(run[1], ("step".into(), vec!["0.01".into()]));
    assert_eq!(run[2], ("until".into(), vec!["1/7".into()]));
    assert_eq!(
        run[3],
        ("at".into(), vec!["1".into(), "1/2".into(), "pi".into()])
    );
    assert_eq!(run[4], ("retraction".into(), vec!["cayley".into()]));
}

#[test]
fn the_places_of_names_are_those_of_the_file() {
    let d = declaration(TOP);
    let Origin::Text { start, end } = d.state[2].origin else {
        panic!()
    };
    assert_eq!(&TOP[start..end], r"\u03a03");
    let Origin::Text { start, end } = d.run[3].values[1].1 else {
        panic!()
    };
    assert_eq!(&TOP[start..end], "1/2");
}

#[test]
fn the_short_form_is_enough() {
    let d = declaration(
        "\u{feff}{\"name\":\"A\",\"algebra\":{\"basis\":[\"a\"],\"matrices\":{\"a\":[[0,\"1/2\"],[-1,0]]}},\"state\":[\"a\"],\"hamiltonian\":\"a\"}",
    );
    assert!(d.algebra().unwrap().brackets.is_none() && d.initial.is_none());
    let entries: Vec<String> = d.algebra().unwrap().matrices[0]
        .rows
        .concat()
        .iter()
        .map(explicit)
        .collect();
    assert_eq!(entries, ["0", "(1/2)", "-1", "0"]);
}

#[test]
fn keys() {
    use Kind::Schema;
    assert_eq!(changed("\"state\"", "\"sate\""), one(Schema, "sate"));
    assert_eq!(
        changed("\"let\":", "\"name\": \"B\", \"let\":"),
        one(Schema, "name")
    );
    assert_eq!(changed("\"unit\"", "\"untit\""), one(Schema, "untit"));
    assert_eq!(changed("\"step\"", "\"stepp\""), one(Schema, "stepp"));
    assert_eq!(
        changed("\"brackets\"", "\"bracket\""),
        one(Schema, "bracket")
    );
    assert_eq!(
        changed("\"exact\": true", "\"exact\": true, \"exact\": true"),
        one(Schema, "exact")
    );
    assert_eq!(
        changed(
            "{ \"default\": \"1/3\", \"exact\": true }",
            "{ \"exact\": true }"
        ),
        one(Schema, "{")
    );
    // Keys may be escaped, and are still the same keys.
    assert_eq!(changed("\"let\"", r#""\u006cet""#), []);
    let (_, diagnostics) = read(&TOP.replacen("\"state\"", "\"sate\"", 1));
    assert_eq!(
        diagnostics[0].help.as_deref(),
        Some("did you mean `state`?")
    );
}

#[test]
fn what_later_versions_declare_is_reserved() {
    let algebra =
        r#"{ "basis": ["J1","J2","J3"], "brackets": ["[J1, J2] = J3", "[J2, J3] = k*J1"] }"#;
    assert_eq!(changed(algebra, "\"so(3)\""), []);
    assert_eq!(
        changed(algebra, "\"so(3)^N\""),
        [(Kind::Syntax, "N".into())]
    );
    assert_eq!(
        changed(
            r#"[0.3, "-1/2", "cos(I1)"]"#,
            r#"{"random": "unit-sphere"}"#
        ),
        one(Kind::Schema, "{")
    );
    assert_eq!(
        changed("\"Π1\",", "\"x[i]\","),
        [(Kind::Syntax, "x[i]".into())]
    );
}

#[test]
fn types() {
    use Kind::Schema;
    assert_eq!(changed("\"format\": 1", "\"format\": 2"), one(Schema, "2"));
    assert_eq!(
        changed("\"format\": 1", "\"format\": \"1\""),
        one(Schema, "\"1\"")
    );
    assert_eq!(changed("\"HeavyTop\"", "7"), one(Schema, "7"));
    assert_eq!(changed("[\"w3 = Π3/I1\"]", "null"), one(Schema, "null"));
    assert_eq!(changed("[\"lie-midpoint\"]", "[true]"), one(Schema, "true"));
    assert_eq!(changed("\"right\"", "\"rigth\""), one(Schema, "rigth"));
    assert_eq!(changed("\"exact\": true", "\"exact\": 1"), one(Schema, "1"));
    assert_eq!(changed("0.3,", "[0.3],"), one(Schema, "["));
    assert_eq!(changed("\"cayley\"", "1"), one(Schema, "1"));
    for text in ["[]", "1", "null", "\"x\""] {
        let (_, diagnostics) = read(text);
        assert_eq!(diagnostics[0].kind, Schema, "{text}");
    }
}

#[test]
fn malformed_json() {
    let found = |text: &'static str| {
        let (_, diagnostics) = read(text);
        assert_eq!(diagnostics.len(), 1);
        let Some(Origin::Text { start, .. }) = diagnostics[0].origin else {
            panic!()
        };
        (diagnostics[0].kind, crate::front::line_column(text, start))
    };
    assert_eq!(found("{\n  \"name\": ,\n}"), (Kind::Schema, (2, 11)));
    assert_eq!(found("{\n  \"ωω\": x\n}"), (Kind::Schema, (2, 9)));
    assert_eq!(found("{\"a\": 1,}"), (Kind::Schema, (1, 9)));
    assert_eq!(found("{} {}"), (Kind::Schema, (1, 4)));
    assert_eq!(found("").0, Kind::Schema);
    assert_eq!(found("{\"a\": \"x").0, Kind::Schema);
}

#[test]
fn expressions_in_their_places() {
    assert_eq!(changed("Π3/I1", "2Π3"), one(Kind::Syntax, "2Π3"));
    assert_eq!(changed("m*w3", "2w3"), one(Kind::Syntax, "2w3"));
    assert_eq!(changed("k*J1", "2J1"), one(Kind::Syntax, "2J1"));
    assert_eq!(
        changed("\"Π2\"]", "\"sni(Π2)\"]"),
        [(Kind::UnknownFunction, "sni".into())].to_vec()
    );
    assert_eq!(changed("cos(I1)", "cos(1,2)"), one(Kind::Arity, "cos(1,2)"));
    assert_eq!(changed("\"3/2\"", "\"one\""), one(Kind::Number, "one"));
    assert_eq!(changed("\"3/2\"", "\"I1\""), one(Kind::Number, "I1"));
    assert_eq!(changed("\"3/2\"", "\" \""), one(Kind::Number, "\" \""));
    assert_eq!(changed("\"1/7\"", "\"soon\""), one(Kind::Number, "soon"));
    assert_eq!(changed("0.01", "1e99999"), one(Kind::Limit, "1e99999"));
    assert_eq!(
        changed("Π1^2/(2*I1) + m*w3", " \\t"),
        one(Kind::EmptyHamiltonian, "\" \\t\"")
    );
    assert_eq!(
        changed("[J1, J2] = J3", "[J1 J2] = J3"),
        one(Kind::Syntax, "[J1 J2] = J3")
    );
    assert_eq!(
        changed("[J1, J2] = J3", "[J1, J2] ="),
        one(Kind::Syntax, "=")
    );
    assert_eq!(changed("[J1, J2] = J3", ""), one(Kind::Syntax, "\"\""));
    assert_eq!(changed("w3 = Π3/I1", "Π3/I1"), one(Kind::Syntax, "Π3/I1"));
    assert_eq!(changed("\"J2\",", "\"J 2\","), one(Kind::Syntax, "J 2"));
    assert_eq!(changed("\"Π2\",", "\"a·b\","), one(Kind::Syntax, "a·b"));
    assert_eq!(changed("\"Π2\",", "\"\","), one(Kind::Syntax, "\"\""));
    assert_eq!(
        changed("\"HeavyTop\"", "\"Heavy Top\""),
        one(Kind::Syntax, "Heavy Top")
    );
    assert_eq!(
        changed("\"1, 1/2,pi\"", "\"1, , 2\""),
        one(Kind::Number, "1, , 2")
    );
    // `e3` is the third name only of a system that has it.
    assert_eq!(changed("m*w3", "2e3"), []);
}

#[test]
fn several_mistakes_come_in_the_order_of_the_file() {
    let text = TOP
        .replacen("k*J1", "2J1", 1)
        .replacen("m*w3", "2w3", 1)
        .replacen("\"methods\"", "\"methds\"", 1);
    let (parsed, diagnostics) = read(&text);
    let found: Vec<&str> = places(&text, &diagnostics)
        .into_iter()
        .map(|(_, place)| place)
        .collect();
    assert_eq!(found, ["2J1", "2w3", "methds"]);
    assert!(parsed.body.is_none());
    assert_eq!(parsed.name.unwrap().text, "HeavyTop");
    assert_eq!((parsed.state.len(), parsed.parameters.len()), (3, 4));
}

#[test]
fn repeated_names_are_left_to_the_check_of_names() {
    assert_eq!(changed("\"I2\": \"3/2\"", "\"I1\": \"3/2\""), []);
}

#[test]
fn brackets_of_coordinates() {
    use crate::ast::Structure;
    let algebra = r#""algebra": { "basis": ["J1","J2","J3"], "brackets": ["[J1, J2] = J3", "[J2, J3] = k*J1"] },"#;
    let general = TOP
        .replacen(
            algebra,
            r#""poisson": ["{Π1, Π2} = w3*Π3^2", "{Π3,Π1}=-1"],"#,
            1,
        )
        .replacen(r#""invariance": "right","#, "", 1);
    let d = declaration(&general);
    let Structure::General { brackets, .. } = &d.structure else {
        panic!("{:?}", d.structure)
    };
    let texts: Vec<String> = brackets
        .iter()
        .map(|b| format!("{} {} {}", b.left.text, b.right.text, explicit(&b.value)))
        .collect();
    assert_eq!(texts, ["Π1 Π2 (w3*(Π3^2))", "Π3 Π1 (-1)"]);
    assert_eq!((d.dimension(), d.basis().len()), (3, 0));
    let extended = TOP.replacen(
        algebra,
        &format!(r#"{algebra} "cocycle": ["{{Π1, Π2}} = k"],"#),
        1,
    );
    let d = declaration(&extended);
    assert!(matches!(d.structure, Structure::Lie { cocycle, .. } if cocycle.len() == 1));
    let with = |keys: &str| changed(algebra, keys);
    assert_eq!(
        with(r#""poisson": ["{Π1, Π2} = 1"],"#),
        one(Kind::Schema, "\"right\"")
    );
    assert_eq!(
        with(&format!(r#"{algebra} "poisson": ["{{Π1, Π2}} = 1"],"#)),
        one(Kind::Schema, r#"["{Π1, Π2} = 1"]"#)
    );
    for wrong in [
        "{Π1, Π2}",
        "{Π1, Π2, Π3} = 1",
        "(Π1, Π2) = 1",
        "[Π1, Π2] = 1",
        "{Π1 Π2} = 1",
    ] {
        let found = with(&format!(r#"{algebra} "cocycle": ["{wrong}"],"#));
        assert_eq!(found, one(Kind::Syntax, wrong), "{wrong}");
    }
}
