//! The key `attitude` at the command: where the group element begins, in every chart and form, with checkpoints and pictures.
#![cfg(unix)]

use std::fs;

use crate::common::{folder, lie, spec};
use crate::resuming::within;
use serde_json::{Value, json};

pub const ANGLES: [f64; 3] = [0.5, 1.0, -2.0];
const INERTIA: [f64; 3] = [2.0, 1.0, 2.0 / 3.0];

type Quaternion = [f64; 4];

fn product(a: Quaternion, b: Quaternion) -> Quaternion {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// A turn about an axis.
fn about(axis: usize, angle: f64) -> Quaternion {
    let mut q = [(angle / 2.0).cos(), 0.0, 0.0, 0.0];
    q[1 + axis] = (angle / 2.0).sin();
    q
}

/// `Rz(phi) Rx(theta) Rz(psi)`
fn zxz([phi, theta, psi]: [f64; 3]) -> Quaternion {
    product(product(about(2, phi), about(0, theta)), about(2, psi))
}

/// The free body by the textbook: `mu' = mu x omega`, `q' = q omega/2`, in small steps of Runge and Kutta.
fn by_hand(mut mu: [f64; 3], mut q: Quaternion, until: f64) -> Quaternion {
    let slope = |mu: [f64; 3], q: Quaternion| {
        let w: [f64; 3] = std::array::from_fn(|k| mu[k] / INERTIA[k]);
        let turn = [
            mu[1] * w[2] - mu[2] * w[1],
            mu[2] * w[0] - mu[0] * w[2],
            mu[0] * w[1] - mu[1] * w[0],
        ];
        (turn, product(q, [0.0, w[0] / 2.0, w[1] / 2.0, w[2] / 2.0]))
    };
    let steps = 4000;
    let h = until / f64::from(steps);
    for _ in 0..steps {
        let moved = |(a, b): ([f64; 3], Quaternion), by: f64| {
            let mu = std::array::from_fn(|k| mu[k] + by * a[k]);
            (mu, std::array::from_fn(|k| q[k] + by * b[k]))
        };
        let at = |(mu, q)| slope(mu, q);
        let first = slope(mu, q);
        let second = at(moved(first, h / 2.0));
        let third = at(moved(second, h / 2.0));
        let last = at(moved(third, h));
        let all = [first, second, third, last];
        let sum =
            |part: &dyn Fn(usize) -> f64| (part(0) + 2.0 * (part(1) + part(2)) + part(3)) * h / 6.0;
        mu = std::array::from_fn(|k| mu[k] + sum(&|stage| all[stage].0[k]));
        q = std::array::from_fn(|k| q[k] + sum(&|stage| all[stage].1[k]));
    }
    q
}

/// The rotation of a row by rows of its matrix, in any chart.
pub fn rotation(element: &[f64]) -> Vec<f64> {
    match *element {
        [_, _, _, _] => crate::rotation::rotation(element),
        [phi, theta, psi] => crate::rotation::rotation(&zxz([phi, theta, psi])),
        _ => element.to_vec(),
    }
}

pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn body(here: &std::path::Path, attitude: Value) -> String {
    let path = spec(here, |spec| {
        spec["algebra"] = json!("so(3)");
        spec["attitude"] = attitude;
        spec["run"] = json!({ "method": "gauss6", "step": 0.05, "until": 5 });
    });
    path.display().to_string()
}

/// The three forms, in the three charts, against equations written by hand.
#[test]
fn a_body_from_an_attitude() {
    let here = folder();
    let [phi, theta, psi] = ANGLES;
    let q = zxz(ANGLES);
    let rows = rotation(&q);
    let rows: Vec<&[f64]> = rows.chunks(3).collect();
    let mu = [1.1_f64.cos(), 0.3, 1.1_f64.sin()];
    let expected = rotation(&by_hand(mu, q, 5.0));
    for attitude in [
        json!({ "euler": "zxz", "angles": [phi, "tilt", psi] }),
        json!({ "quaternion": q }),
        json!({ "matrix": rows }),
    ] {
        let path = spec(here.path(), |spec| {
            spec["algebra"] = json!("so(3)");
            spec["parameters"]["tilt"] = json!(theta);
            spec["attitude"] = attitude.clone();
            spec["run"] = json!({ "method": "gauss6", "step": 0.05, "until": 5 });
        });
        let path = path.display();
        for (chart, names) in [
            ("matrix", "g11,g12,g13,g21,g22,g23,g31,g32,g33"),
            ("quaternion", "q0,q1,q2,q3"),
            ("euler:zxz", "phi,theta,psi"),
        ] {
            let run = lie(&format!("run {path} --group {chart} --quiet")).ok();
            let (header, rows) = run.csv();
            let element = header.len() - names.split(',').count();
            assert_eq!(header[element..].join(","), names);
            let first = &rows[0][element..];
            assert!(
                distance(&rotation(first), &rotation(&q)) < 1e-15,
                "{attitude} {chart}"
            );
            let last = &rows.last().unwrap()[element..];
            let error = distance(&rotation(last), &expected);
            assert!(error < 1e-7, "{attitude} {chart}: {error:e}");
            // the identity would be elsewhere
            assert!(distance(&rotation(first), &rotation(&[1.0, 0.0, 0.0, 0.0])) > 0.5);
        }
    }
}

#[test]
fn angles_have_columns_and_follow_parameters() {
    let here = folder();
    let path = spec(here.path(), |spec| {
        spec["algebra"] = json!("so(3)");
        spec["parameters"]["a"] = json!("1/2");
        spec["attitude"] = json!({ "euler": "zxz", "angles": ["a", 1, "4*a"] });
        spec["run"] = json!({ "step": 0.1, "until": 1, "group": "euler:zxz" });
    });
    let path = path.display();
    let (header, rows) = lie(&format!("run {path} --quiet")).ok().csv();
    assert_eq!(header.join(","), "t,x,y,z,energy,C,phi,theta,psi");
    assert_eq!(rows[0][6..], [0.5, 1.0, 2.0]);
    let (_, rows) = lie(&format!("run {path} --param a=2 --quiet")).ok().csv();
    assert_eq!(rows[0][6..], [2.0, 1.0, 8.0]);
    let (header, rows) = lie(&format!("run {path} --param a=1:2:2 --quiet"))
        .ok()
        .csv();
    let starts: Vec<&Vec<f64>> = rows.iter().filter(|row| row[2] == 0.0).collect();
    let first = header.iter().position(|name| name == "phi").unwrap();
    assert_eq!(starts.len(), 2);
    for (start, a) in starts.into_iter().zip([1.0, 2.0]) {
        assert_eq!(start[first..], [a, 1.0, 4.0 * a]);
    }
    // other axes: the same rotation by other angles
    let (_, rows) = lie(&format!("run {path} --group euler:xyz --quiet"))
        .ok()
        .csv();
    let [x, y, z] = [rows[0][6], rows[0][7], rows[0][8]];
    let other = product(product(about(0, x), about(1, y)), about(2, z));
    assert!(distance(&rotation(&other), &rotation(&zxz([0.5, 1.0, 2.0]))) < 1e-15);
    let said = lie(&format!("check {path}")).ok().stdout;
    assert!(
        said.contains("attitude at the start: Euler angles zxz (a, 1, 4*a)"),
        "{said}"
    );
    let report: Value =
        serde_json::from_str(&lie(&format!("check {path} --json")).ok().stdout).unwrap();
    assert_eq!(report["attitude"], "Euler angles zxz (a, 1, 4*a)");
    let code = lie(&format!("expand {path}")).ok().stdout;
    assert!(code.contains("pub fn initial_attitude(&self) -> [S; 9]"));
}

/// Angles of a body that turns by several turns in a step, around its axis and around the vertical: the middle one stays. The body is
/// symmetric with |m| = 6 along the vertical, so that `phi' = 6/I1` and `psi' = (1/I3 - 1/I1) 6 cos(theta)`.
#[test]
fn fast_turns_are_counted() {
    let here = folder();
    let path = here.path().join("spinner.json");
    let spec = json!({
        "name": "Spinner", "algebra": "so(3)", "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2/2 + z^2",
        "attitude": { "euler": "zxz", "angles": [0, 0.5, 0] },
        "initial": [0, "6*sin(0.5)", "6*cos(0.5)"],
    });
    std::fs::write(&path, spec.to_string()).unwrap();
    let psi = 20.0 * 6.0 * 0.5_f64.cos();
    for pace in [
        "--method exact --step 0.3",
        "--method gauss16 --step 1",
        "--method gauss16 --tol 1e-10",
        "--method lie-midpoint --retraction cayley --step 0.01",
        "--tol 1e-6",
    ] {
        let call = format!(
            "run {} {pace} --until 20 --group euler:zxz --quiet",
            path.display()
        );
        let (_, rows) = lie(&call).ok().csv();
        let last = rows.last().unwrap();
        let (phi, theta, spin) = (last[6], last[7], last[8]);
        let off = (phi - 120.0)
            .abs()
            .max((theta - 0.5).abs())
            .max((spin - psi).abs());
        assert!(off < 1.0, "{pace}: {phi} {theta} {spin}, not 120 0.5 {psi}");
    }
}

/// What is written without an attitude has nothing of it.
#[test]
fn nothing_is_said_of_no_attitude() {
    let plain = "specs/so3_free_rigid_body.json";
    let code = lie(&format!("expand {plain}")).ok().stdout;
    let said = lie(&format!("check {plain} --json")).ok().stdout;
    assert!(!code.contains("attitude") && !said.contains("attitude"));
}

/// A name that a column has already is given up for one that is free.
#[test]
fn angles_beside_a_coordinate_of_that_name() {
    let here = folder();
    let path = spec(here.path(), |spec| {
        spec["algebra"] = json!("so(3)");
        spec["observables"] = json!({ "phi": "x" });
    });
    let path = path.display();
    let run = lie(&format!(
        "run {path} --step 0.1 --until 1 --group euler:zyx --quiet"
    ))
    .ok();
    let names = "t,x,y,z,energy,C,phi,group_phi,group_theta,group_psi";
    assert_eq!(run.csv().0.join(","), names);
}

#[test]
fn a_run_that_was_ended_goes_on_with_its_angles() {
    let here = folder();
    body(here.path(), json!({ "euler": "zxz", "angles": ANGLES }));
    for chart in ["matrix", "quaternion", "euler:zxz", "euler:xyz"] {
        let call = format!(
            "run body.json --until 120 --step 0.1 --method lie-midpoint --group {chart} --quiet"
        );
        let whole = within(
            here.path(),
            &format!("{call} --out whole.csv --checkpoint whole.ck --checkpoint-every 1"),
        )
        .ok();
        let rows = fs::read_to_string(here.path().join("whole.csv")).unwrap();
        assert!(whole.stderr.is_empty(), "{}", whole.stderr);
        within(here.path(), "resume whole.ck").ok();
        let again = fs::read_to_string(here.path().join("whole.csv")).unwrap();
        assert!(rows == again, "{chart}: other rows");
        let (_, rows) = crate::common::csv(&rows);
        assert!(
            distance(&rotation(&rows[0][6..]), &rotation(&zxz(ANGLES))) < 1e-14
                || chart == "euler:xyz"
        );
        // they have turned several times
        if chart.starts_with("euler") {
            assert!(
                rows.last().unwrap()[6..]
                    .iter()
                    .any(|angle| angle.abs() > 12.0)
            );
        }
    }
}

#[test]
fn the_entries_of_the_state_begin_there() {
    let here = folder();
    let text = fs::read_to_string("specs/so3_gravity_gradient.json").unwrap();
    let mut spec: Value = serde_json::from_str(&text).unwrap();
    let whole = here.path().join("whole.json");
    fs::write(&whole, spec.to_string()).unwrap();
    spec["initial"] = json!([0.1, 3.2, "-1/20"]);
    spec["parameters"]["tilt"] = json!("1/5");
    spec["attitude"] = json!({ "euler": "yzx", "angles": ["tilt", 0, 0] });
    let turned = here.path().join("turned.json");
    fs::write(&turned, spec.to_string()).unwrap();
    let rows = |path: &std::path::Path, more: &str| {
        let call = format!("run {} --until 1 --quiet {more}", path.display());
        lie(&call).ok().csv().1
    };
    // the second axis is normal to the orbit in the whole spec too, of which the axes are others
    let start = rows(&turned, "");
    let (s, c) = 0.2_f64.sin_cos();
    assert!(distance(&start[0][4..13], &[c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c]) < 1e-16);
    assert_eq!(start, rows(&whole, ""));
    let (s, c) = 0.7_f64.sin_cos();
    for more in ["--param tilt=0.7", "--param tilt=0.7 --initial 1,2,3"] {
        let found = rows(&turned, more);
        assert!(distance(&found[0][4..13], &[c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c]) < 1e-15);
    }
    spec["initial"] = json!([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
    fs::write(&turned, spec.to_string()).unwrap();
    let twice = lie(&format!("check {}", turned.display()));
    assert!(
        twice
            .error("state-length", &turned.display().to_string())
            .stderr
            .contains("given twice")
    );
}

#[test]
fn what_is_asked_for_in_vain() {
    let here = folder();
    let path = body(here.path(), json!({ "quaternion": ["k", 0, 0, 0] }));
    let text = fs::read_to_string(&path).unwrap();
    let mut spec: Value = serde_json::from_str(&text).unwrap();
    spec["parameters"]["k"] = json!(1);
    fs::write(&path, spec.to_string()).unwrap();
    for (more, kind, place, says) in [
        (
            "--group euler",
            "option",
            "command line: --group",
            "euler:zxz",
        ),
        (
            "--group euler:zzx",
            "option",
            "command line: --group",
            "neighbours different",
        ),
        (
            "--group euler:ZXZ",
            "option",
            "command line: --group",
            "euler:zxz",
        ),
        (
            "--group matrix --param k=2",
            "domain",
            "command line: --param",
            "its norm is 2",
        ),
    ] {
        let run = lie(&format!("run {path} {more}"));
        let said = run.error(kind, place).stderr;
        assert!(said.contains(says), "{more}: {said}");
    }
    let plane = "specs/e2_pendulum.json";
    let run = lie(&format!("run {plane} --group euler:zxz"));
    let said = run.error("option", "command line: --group").stderr;
    assert!(
        said.contains("Euler angles are for groups that turn space"),
        "{said}"
    );
}

/// The picture shows where the body looks, whatever the chart is, and begins at the attitude.
#[test]
fn the_picture_is_the_same_in_all_charts() {
    let here = folder();
    body(here.path(), json!({ "euler": "zxz", "angles": ANGLES }));
    let picture = |chart: &str| {
        let call = format!(
            "run body.json --every 5 --group {chart} --picture attitude --plot a.svg --out a.csv --quiet"
        );
        within(here.path(), &call).ok();
        fs::read_to_string(here.path().join("a.svg")).unwrap()
    };
    let first = picture("matrix");
    assert_eq!(picture("quaternion"), first);
    assert_eq!(picture("euler:zyx"), first);
    body(here.path(), json!({ "quaternion": [1, 0, 0, 0] }));
    assert_ne!(picture("matrix"), first);
}
