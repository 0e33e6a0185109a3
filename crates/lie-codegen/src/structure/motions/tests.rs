//! Constants that textbooks know, and systems that have none.

use super::*;
use crate::compile::compile_spec;
use crate::structure::Structure;

fn model(algebra: &str, state: &str, parameters: &str, hamiltonian: &str) -> Structure {
    let names: Vec<String> = state.split(' ').map(|name| format!("\"{name}\"")).collect();
    let text = format!(
        r#"{{"format": 1, "name": "System", "algebra": "{algebra}", "state": [{}], "parameters": {{{parameters}}},
            "hamiltonian": "{hamiltonian}"}}"#,
        names.join(", ")
    );
    compile_spec(&text).unwrap_or_else(|mistakes| panic!("{mistakes:?}"))
}

fn shown(model: &Structure, work: u64) -> (Vec<String>, u32, End) {
    let motions = find(model, &model.casimirs, work).unwrap();
    let name = |v: usize| match v.checked_sub(model.dimension()) {
        Some(p) => model.parameters[p].name.clone(),
        None => model.coordinates[v].text.clone(),
    };
    let found = motions.found.iter().map(|m| m.function.display(&name));
    (found.collect(), motions.searched, motions.end)
}

const TOP: &str = "m1 m2 m3 g1 g2 g3";

#[test]
fn tops_of_lagrange_and_kovalevskaya() {
    // H does not change with rotations about the axis of the body
    let lagrange = model(
        "se(3)",
        TOP,
        r#""I1": 1, "I3": 2, "k": 1"#,
        "(m1^2 + m2^2)/(2*I1) + m3^2/(2*I3) + k*g3",
    );
    assert_eq!(shown(&lagrange, WORK).0, ["m3"]);
    let kovalevskaya = model("se(3)", TOP, r#""c": 1"#, "(m1^2 + m2^2 + 2*m3^2)/2 + c*g1");
    let (found, searched, _) = shown(&kovalevskaya, WORK);
    // |(m1 + i m2)^2 - 2 c (g1 + i g2)|^2 is 4 H^2 less four times this
    let expected =
        "m1^2*m3^2 + 2*m1^2*g1*c + 2*m1*m2*g2*c + m2^2*m3^2 + m3^4 + 2*m3^2*g1*c - g2^2*c^2";
    assert_eq!((found, searched), (vec![expected.to_owned()], 4));
    // control: other moments of inertia
    let other = model("se(3)", TOP, r#""c": 1"#, "(m1^2 + m2^2 + 3*m3^2)/2 + c*g1");
    assert_eq!(shown(&other, WORK), (Vec::new(), 4, End::Degree));
}

#[test]
fn clebsch_and_manakov() {
    // two bodies of dimension four: a quadratic one each
    let manakov = model(
        "so(4)",
        "a b c d e f",
        "",
        "a^2/3 + b^2/4 + d^2/5 + c^2/5 + e^2/6 + f^2/7",
    );
    let (found, ..) = shown(&manakov, WORK);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        find(&manakov, &manakov.casimirs, WORK).unwrap().found[0].degree,
        2
    );
    // parameters in the coefficients
    let clebsch = model(
        "se(3)",
        TOP,
        r#""a": 1, "b": 2, "c": 3"#,
        "(m1^2 + m2^2 + m3^2)/2 + (a*g1^2 + b*g2^2 + c*g3^2)/2",
    );
    let (found, ..) = shown(&clebsch, WORK);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains('a'), "{found:?}");
}

/// Products of what is known are solutions too. They are not solved for again over the rational functions of the parameters,
/// which of eight of them took longer than anybody waits.
#[test]
fn what_is_known_is_not_found_again() {
    let body = model(
        "su(3)",
        "a b c d e f g h",
        r#""I1": 1, "I2": "4/3", "I3": "5/3", "I4": 2, "I5": "7/3", "I6": "8/3", "I7": 3, "I8": "10/3""#,
        "a^2/(2*I1) + b^2/(2*I2) + c^2/(2*I3) + d^2/(2*I4) + e^2/(2*I5) + f^2/(2*I6) + g^2/(2*I7) + h^2/(2*I8)",
    );
    assert_eq!(shown(&body, WORK / 2), (Vec::new(), 4, End::Degree));
}

#[test]
fn what_is_not_looked_for_is_said() {
    let spin = model("so(3)", "x y z", "", "exp(x) + y");
    assert_eq!(
        find(&spin, &spin.casimirs, WORK),
        Err("H is no polynomial of the coordinates")
    );
    let still = model("so(3)", "x y z", "", "x^2 + y^2 + z^2");
    assert_eq!(find(&still, &still.casimirs, WORK), Err("nothing moves"));
    let spent = model("so(3)", "x y z", "", "x^2 + z");
    let spent = find(&spent, &spent.casimirs, 10).unwrap();
    assert_eq!(
        (spent.found.len(), spent.searched, spent.end),
        (0, 0, End::Spent)
    );
    // on a sphere H says it all
    let body = model("so(3)", "x y z", "", "x^2 + 2*y^2");
    assert_eq!(shown(&body, WORK), (Vec::new(), 1, End::All));
}
