use super::*;
use crate::methods::{Choice, refusal};
use crate::model::Descent;

/// so(3) with a realization: as many positions and momenta, and the three components.
fn over(count: usize, parameters: &str, map: [&str; 3]) -> Structure {
    let names = |letter| {
        let names: Vec<String> = (1..=count).map(|k| format!("\"{letter}{k}\"")).collect();
        names.join(", ")
    };
    let [x, y, z] = map;
    let realization = format!(
        r#"{{"positions": [{}], "momenta": [{}], "map": ["x = {x}", "y = {y}", "z = {z}"]}}"#,
        names('q'),
        names('p')
    );
    model(&so3(&[
        ("parameters", parameters),
        ("realization", &realization),
    ]))
}

fn descent(model: &Structure) -> Descent {
    model.realization.as_ref().expect("a realization").descent
}

const SPIN_TWO: [&str; 3] = [
    "2*p2*q5 - 2*p3*q5 + p4*q6 - p5*q2 + p5*q3 - p6*q4",
    "-2*p1*q6 + 2*p3*q6 - p4*q5 + p5*q4 + p6*q1 - p6*q3",
    "2*p1*q4 - 2*p2*q4 - p4*q1 + p4*q2 - p5*q6 + p6*q5",
];

#[test]
fn gauss_methods_over_what_is_not_closed_are_refused() {
    let model = over(6, "{}", SPIN_TWO);
    assert_eq!(descent(&model), Descent::Adds { commuting: false });
    for order in [2, 4, 6] {
        let choice = Choice::Collective(order, crate::methods::Lift::Spec);
        let (reason, help) = refusal(&model, &choice).expect("it does not apply");
        assert!(reason.contains("leave the coadjoint orbit"), "{reason}");
        assert!(help.contains("lie-midpoint"), "{help}");
    }
}

#[test]
fn closed_realizations_carry_gauss_methods() {
    let angular = ["p2*q3 - p3*q2", "p3*q1 - p1*q3", "p1*q2 - p2*q1"];
    let hopf = [
        "(q1*q2 + p1*p2)/2",
        "(q2*p1 - q1*p2)/2",
        "(q1^2 + p1^2 - q2^2 - p2^2)/4",
    ];
    // of canonical coordinates that are moved and turned with the parameters
    // as (q1/c + k, c p1), (q2, p2 - k), (c q3, p3/c)
    let moved = [
        "(p2 - k)*q3*c - p3/c*q2",
        "p3/c*(q1/c + k) - c*p1*c*q3",
        "c*p1*q2 - (p2 - k)*(q1/c + k)",
    ];
    let parameters = r#"{"k": 0.3, "c": 2}"#;
    for (count, map) in [(3, angular), (2, hopf), (3, moved)] {
        let model = over(count, parameters, map);
        assert_eq!(descent(&model), Descent::Closed, "{map:?}");
        let choice = Choice::Collective(4, crate::methods::Lift::Spec);
        assert_eq!(refusal(&model, &choice), None);
    }
}

#[test]
fn what_is_not_of_degree_two_or_not_rational() {
    // canonical coordinates that are moved by a gradient of degree three
    let bent = [
        "(p2 + q2^2)*q3 - p3*q2",
        "p3*q1 - p1*q3",
        "p1*q2 - (p2 + q2^2)*q1",
    ];
    assert_eq!(descent(&over(3, "{}", bent)), Descent::Degree);
    let root = [
        "(p2 - sqrt(2))*q3 - p3*q2",
        "p3*q1 - p1*q3",
        "p1*q2 - (p2 - sqrt(2))*q1",
    ];
    assert_eq!(descent(&over(3, "{}", root)), Descent::Unknown);
}
