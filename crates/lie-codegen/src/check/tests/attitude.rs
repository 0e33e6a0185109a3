use super::*;
use crate::model::Form;
use lie_core::structure::{Chart, EulerSequence, rotation};

const SO3: &str = r#"{"basis": ["e1", "e2", "e3"], "matrices": {"e1": [[0,0,0],[0,0,-1],[0,1,0]], "e2": [[0,0,1],[0,0,0],[-1,0,0]], "e3": [[0,-1,0],[1,0,0],[0,0,0]]}}"#;

fn body(attitude: &str, extra: &[(&str, &str)]) -> String {
    let base = [
        ("algebra", SO3),
        ("state", r#"["x", "y", "z"]"#),
        ("parameters", r#"{"a": "1/3", "b": 2}"#),
        ("hamiltonian", r#""a*x^2 + b*y^2""#),
        ("attitude", attitude),
    ];
    system(&base, extra)
}

fn named(algebra: &str, state: &str, attitude: &str) -> String {
    system(
        &[
            ("algebra", algebra),
            ("state", state),
            ("hamiltonian", r#""x^2 + 2*y^2""#),
            ("attitude", attitude),
        ],
        &[],
    )
}

const SE3: [&str; 2] = [r#""se(3)""#, r#"["x", "y", "z", "u", "v", "w"]"#];

fn rows(model: &Structure) -> Vec<f64> {
    model
        .initial_element(Chart::Matrix, &model.defaults())
        .expect("an attitude")
}

fn close(a: &[f64], b: &[f64], what: &str) {
    assert_eq!(a.len(), b.len(), "{what}");
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() < 1e-15, "{what}: {a} and {b}");
    }
}

/// A turn by 0.8 about the third axis is the same in all forms, and in all charts what was written.
#[test]
fn the_forms_say_the_same() {
    let (s, c) = 0.8_f64.sin_cos();
    let turn = [c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0];
    for attitude in [
        r#"{"quaternion": ["cos(2/5)", 0, 0, "sin(2/5)"]}"#,
        r#"{"matrix": [["cos(4/5)", "-sin(4/5)", 0], ["sin(4/5)", "cos(4/5)", 0], [0, 0, 1]]}"#,
        r#"{"euler": "zxz", "angles": [0.5, 0, 0.3]}"#,
        r#"{"euler": "xyz", "angles": [0, 0, 0.8]}"#,
        r#"{"euler": "zyx", "angles": [0.8, 0, 0]}"#,
    ] {
        let model = model(&body(attitude, &[]));
        close(&rows(&model), &turn, attitude);
        let quaternion = model.initial_element(Chart::Quaternion, &model.defaults());
        close(
            &quaternion.unwrap(),
            &[0.4_f64.cos(), 0.0, 0.0, 0.4_f64.sin()],
            attitude,
        );
    }
    let text = body(r#"{"euler": "zxz", "angles": [7, "-pi/3", "a"]}"#, &[]);
    let model = model(&text);
    let chart = |name: &str| Chart::Euler(name.parse().unwrap());
    let angles = |name, parameters: &[f64]| model.initial_element(chart(name), parameters).unwrap();
    // as they were written, at the values of a run
    close(
        &angles("zxz", &[0.25, 2.0]),
        &[7.0, -std::f64::consts::FRAC_PI_3, 0.25],
        "zxz",
    );
    let other = angles("xyz", &[0.25, 2.0]);
    let sequence = EulerSequence::Xyz;
    let back = sequence.quaternion([other[0], other[1], other[2]]);
    let quaternion = model
        .initial_element(Chart::Quaternion, &[0.25, 2.0])
        .unwrap();
    let sign = (back[0] * quaternion[0]).signum();
    close(&back.map(|q| sign * q), &quaternion, "xyz");
    assert_eq!(
        model.attitude.as_ref().unwrap().form,
        Form::Euler(EulerSequence::Zxz)
    );
    assert!(model.initial_element(Chart::Matrix, &[0.25, 2.0]).unwrap() != rows(&model));
}

/// The sign of a quaternion and its digits are those that were written, its norm is 1.
#[test]
fn a_quaternion_is_kept_and_normalised() {
    let text = body(r#"{"quaternion": [-0.5, 0.5, -0.5, 0.5000002]}"#, &[]);
    let model = model(&text);
    let q = model
        .initial_element(Chart::Quaternion, &model.defaults())
        .unwrap();
    let square: f64 = q.iter().map(|x| x * x).sum();
    assert!((square - 1.0).abs() < 1e-15 && q[0] < 0.0 && q[3] > 0.5);
    let r = rows(&model);
    let again = rotation::quaternion(&[[r[0], r[1], r[2]], [r[3], r[4], r[5]], [r[6], r[7], r[8]]]);
    close(&again.map(|x| -x), &q, "the matrix is normalised too");
    let exact = self::model(&body(r#"{"quaternion": [0.6, 0, "4/5", 0]}"#, &[]));
    // 9/25 + 16/25 is 1: no root, no division
    assert_eq!(
        exact.display(exact.attitude.as_ref().unwrap().matrix[0]),
        "-7/25"
    );
}

/// What stands beside the rotations is at rest at the start: a wheel, a second body. Blocks that turn with them are not.
#[test]
fn what_stands_beside_the_rotations_is_at_rest() {
    let turn = r#"{"euler": "zyx", "angles": [0.8, 0, 0]}"#;
    let (s, c) = 0.8_f64.sin_cos();
    let six = r#"["x", "y", "z", "u", "v", "w"]"#;
    let [se3, motions] = SE3;
    for (algebra, state) in [
        (se3, motions),
        (r#""so(3) + R^1""#, r#"["x", "y", "z", "u"]"#),
        (r#""so(3) + R^3""#, six),
        (r#""so(3)^2""#, six),
    ] {
        let turned = model(&named(algebra, state, turn));
        let rows = rows(&turned);
        let size = rows.len().isqrt();
        assert!(size > 3, "{algebra}");
        for (place, entry) in rows.iter().enumerate() {
            let known = match (place / size, place % size) {
                (0, 0) | (1, 1) => c,
                (0, 1) => -s,
                (1, 0) => s,
                (i, j) => f64::from(u8::from(i == j)),
            };
            assert!((entry - known).abs() < 1e-15, "{algebra}: {rows:?}");
        }
        // the same as a matrix, of which only the first rows and columns turn
        let written = rows.chunks(size).map(<[f64]>::to_vec).collect::<Vec<_>>();
        let matrix = self::model(&named(
            algebra,
            state,
            &format!("{{\"matrix\": {written:?}}}"),
        ));
        let quaternion = matrix.initial_element(Chart::Quaternion, &matrix.defaults());
        let half = [0.4_f64.cos(), 0.0, 0.0, 0.4_f64.sin()];
        close(&quaternion.unwrap(), &half, algebra);
    }
    // the same rotation twice: the identity behind it is not in the group
    let block = |e: &str, a: usize, b: usize| {
        let entry = |i: usize, j: usize| match (i / 3 == j / 3, i % 3, j % 3) {
            (true, i, j) if (i, j) == (a, b) => -1,
            (true, i, j) if (i, j) == (b, a) => 1,
            _ => 0,
        };
        let row = |i: usize| (0..6).map(|j| entry(i, j)).collect::<Vec<i32>>();
        format!("\"{e}\": {:?}", (0..6).map(row).collect::<Vec<_>>())
    };
    let matrices = [block("e1", 1, 2), block("e2", 2, 0), block("e3", 0, 1)].join(", ");
    let twice = format!(r#"{{"basis": ["e1", "e2", "e3"], "matrices": {{{matrices}}}}}"#);
    let errors = crate::compile::compile_spec(&named(&twice, r#"["x", "y", "z"]"#, turn));
    let text = format!("{:?}", errors.err());
    assert!(text.contains("quaternions and Euler angles"), "{text}");
}

#[test]
fn motions_of_space_begin_with_a_rotation_and_no_translation() {
    let [algebra, state] = SE3;
    let turned = [
        0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ];
    let text = named(
        algebra,
        state,
        r#"{"euler": "zyx", "angles": ["pi/2", 0, 0]}"#,
    );
    let found = rows(&model(&text));
    for (found, expected) in found.iter().zip(turned) {
        assert!((found - expected).abs() < 1e-15);
    }
    let moved = r#"{"matrix": [[0, -1, 0, 5], [1, 0, 0, -6], [0, 0, 1, 7], [0, 0, 0, 1]]}"#;
    assert_eq!(rows(&model(&named(algebra, state, moved)))[3], 5.0);
}

/// Beside a group element the attitude gives its entries, for every value of the parameters.
#[test]
fn entries_of_the_state_are_those_of_the_attitude() {
    for (invariance, attitude) in [
        ("left", r#"{"euler": "zxz", "angles": ["a", 0, 0]}"#),
        ("right", r#"{"quaternion": ["cos(a/2)", 0, 0, "sin(a/2)"]}"#),
    ] {
        let extra = [
            ("group", r#""R""#),
            ("hamiltonian", r#""a*x^2 + b*y^2 + R33 + t*R11""#),
            ("invariance", &format!("{invariance:?}")),
        ];
        let with = |initial: &'static str| {
            let mut extra = extra.to_vec();
            extra.push(("initial", initial));
            body(attitude, &extra)
        };
        let model = model(&with("[1, 2, 3]"));
        for a in [1.0_f64 / 3.0, -0.7] {
            let (s, c) = a.sin_cos();
            let turn = [c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0];
            let state = model.initial_values(&[a, 2.0]).unwrap();
            // three momenta, that of the time, the entries, the time and its unit
            close(&state[..4], &[1.0, 2.0, 3.0, 0.0], invariance);
            close(&state[4..13], &turn, invariance);
            close(&state[13..], &[0.0, 1.0], invariance);
            let given = model.complete_state(&[4.0, 5.0, 6.0], &[a, 2.0]).unwrap();
            close(&given[4..13], &turn, "of a run that gives the momenta");
            let all: Vec<f64> = [
                vec![4.0, 5.0, 6.0],
                [turn, turn].concat()[..9].iter().map(|x| -x).collect(),
            ]
            .concat();
            close(
                &model.complete_state(&all, &[a, 2.0]).unwrap()[4..13],
                &all[3..],
                "of one that gives all",
            );
        }
        expect(
            &with("[1, 2, 3, 1, 0, 0, 0, 1, 0, 0, 0, 1]"),
            &["state-length"],
        );
        expect(&with("[1, 2]"), &["state-length"]);
    }
}

#[test]
fn attitudes_that_are_none() {
    let wrong = |attitude: &str, expected: &str, says: &str| {
        let found = errors(&body(attitude, &[]));
        let [found] = found.as_slice() else {
            panic!("{attitude}: {found:#?}");
        };
        assert!(
            found.starts_with(expected) && found.contains(says),
            "{attitude}: {found}"
        );
    };
    wrong(r#"{}"#, "schema", "no entries");
    wrong(
        r#"{"quaternion": [1, 0, 0]}"#,
        "schema",
        "3 entries, and needs 4",
    );
    wrong(
        r#"{"quaternion": [[1, 0], [0, 1]]}"#,
        "schema",
        "list of 4 numbers",
    );
    wrong(r#"{"matrix": [1, 0, 0]}"#, "schema", "matrix");
    wrong(r#"{"euler": "zxz"}"#, "schema", "no `angles`");
    wrong(r#"{"angles": [1, 2, 3]}"#, "schema", "no sequence");
    wrong(
        r#"{"euler": "zzx", "angles": [1, 2, 3]}"#,
        "schema",
        "`zzx` is no sequence",
    );
    wrong(
        r#"{"euler": "zxz", "angles": [1, 2]}"#,
        "schema",
        "2 entries, and needs 3",
    );
    wrong(
        r#"{"euler": "zxz", "quaternion": [1, 0, 0, 0]}"#,
        "schema",
        "given twice",
    );
    wrong(
        r#"{"quaternion": [1, 0, 0, 0], "matrix": [[1]]}"#,
        "schema",
        "given twice",
    );
    wrong(
        r#"{"quaternions": [1, 0, 0, 0]}"#,
        "schema",
        "unknown key `quaternions`",
    );
    wrong(r#"{"quaternion": [0, 0, 0, 0]}"#, "domain", "zero");
    wrong(
        r#"{"quaternion": [1, 1, 0, 0]}"#,
        "domain",
        "its norm is 1.414",
    );
    wrong(
        r#"{"quaternion": [1.00001, 0, 0, 0]}"#,
        "domain",
        "its norm is 1.00001",
    );
    wrong(
        r#"{"quaternion": ["1/(a - 1/3)", 0, 0, 0]}"#,
        "domain",
        "not finite",
    );
    wrong(r#"{"quaternion": ["x", 0, 0, 0]}"#, "unknown-symbol", "x");
    wrong(
        r#"{"matrix": [[1, 0], [0, 1]]}"#,
        "representation",
        "2 rows or columns",
    );
    wrong(
        r#"{"matrix": [[1, 0, 0], [0, 1], [0, 0, 1]]}"#,
        "representation",
        "2 rows or columns",
    );
    wrong(
        r#"{"matrix": [[1, 0, 0], [0, 1, 0.1], [0, 0, 1]]}"#,
        "domain",
        "not orthonormal",
    );
    wrong(
        r#"{"matrix": [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]}"#,
        "domain",
        "reflection",
    );
}

#[test]
fn groups_without_the_attitude() {
    let wrong = |text: &str, expected: &str, says: &str| {
        let found = errors(text);
        let [found] = found.as_slice() else {
            panic!("{text}: {found:#?}");
        };
        assert!(
            found.starts_with(expected) && found.contains(says),
            "{text}: {found}"
        );
    };
    let one = r#"{"quaternion": [1, 0, 0, 0]}"#;
    wrong(
        &so3(&[("attitude", one)]),
        "representation",
        "none are declared",
    );
    let sl2 = r#"{"basis": ["h", "e", "f"], "matrices": {"h": [[1, 0], [0, -1]], "e": [[0, 1], [0, 0]], "f": [[0, 0], [1, 0]]}}"#;
    let plane = |attitude| named(sl2, r#"["x", "y", "z"]"#, attitude);
    wrong(&plane(one), "representation", "groups of rotations");
    wrong(
        &plane(r#"{"matrix": [[2, 0], [0, 1]]}"#),
        "domain",
        "determinant is 2",
    );
    wrong(
        &plane(r#"{"matrix": [[1, 2], [2, 4]]}"#),
        "domain",
        "no inverse",
    );
    assert_eq!(
        rows(&model(&plane(r#"{"matrix": [[2, 3], [1, 2]]}"#))),
        [2.0, 3.0, 1.0, 2.0]
    );
    let [algebra, state] = SE3;
    let moved = |last: &str, corner: &str| {
        let text = format!(
            r#"{{"matrix": [[{corner}, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, {last}]]}}"#
        );
        named(algebra, state, &text)
    };
    wrong(
        &moved("2", "1"),
        "domain",
        "row 4 is not that of the identity",
    );
    wrong(&moved("1", "2"), "domain", "not orthonormal");
    wrong(&moved("1", "-1"), "domain", "reflection");
    // rotations of a plane in space
    let disc = r#"{"basis": ["e", "f"], "matrices": {"e": [[0, -1, 0], [1, 0, 0], [0, 0, 0]], "f": [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}, "brackets": []}"#;
    let plane = |attitude| named(disc, r#"["x", "y"]"#, attitude);
    model(&plane(r#"{"euler": "zxz", "angles": [1, 0, 2]}"#));
    let tilted = plane(r#"{"euler": "zxz", "angles": [1, 1, 2]}"#);
    wrong(&tilted, "domain", "row 3 is not that of the identity");
    let general = system(
        &[
            ("poisson", r#"["{x, y} = 1"]"#),
            ("state", r#"["x", "y"]"#),
            ("hamiltonian", r#""x^2 + y^2""#),
            ("attitude", one),
        ],
        &[],
    );
    wrong(&general, "schema", "attitude");
    let extended = body(one, &[("cocycle", r#"["{x, y} = 1"]"#)]);
    // that of the declared algebra
    assert!(model(&extended).attitude.is_some());
    let family = system(
        &[
            ("algebra", r#""so(3)^8""#),
            ("state", r#"["x[i]", "y[i]", "z[i]"]"#),
            ("hamiltonian", r#""sum(i in 0..8: x[i]*x[i+1])""#),
            ("attitude", one),
        ],
        &[],
    );
    wrong(&family, "schema", "sites of a family");
}
