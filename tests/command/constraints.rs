//! Constraints on the velocity, by the command: Suslov's body, the sleigh, a potential, so(4).

use crate::common::{folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

pub fn written(folder: &Path, name: &str, spec: &Value) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

/// Suslov's body with products of inertia and a blade along its third axis.
pub fn suslov() -> Value {
    json!({
        "format": 1,
        "name": "Suslov",
        "algebra": "so(3)",
        "state": ["m1", "m2", "m3"],
        "velocity": ["w1", "w2", "w3"],
        "lagrangian": "(2*w1^2 + w2^2 + 3/2*w3^2)/2 + 3/10*w1*w3 - 2/5*w2*w3",
        "constraint": ["w3 = 0"],
        "initial": ["3/5", "-1/2"]
    })
}

/// A sleigh whose blade is fixed off its centre of mass.
fn sleigh() -> Value {
    json!({
        "format": 1,
        "name": "Sleigh",
        "algebra": { "basis": ["e0", "e1", "e2"], "brackets": ["[e0, e1] = e2", "[e0, e2] = -e1"] },
        "state": ["p0", "p1", "p2"],
        "velocity": ["w", "v1", "v2"],
        "parameters": { "J": "3/2", "m": 1, "a": "2/5" },
        "lagrangian": "(J*w^2 + m*v1^2 + m*v2^2)/2 + m*a*w*v2",
        "constraint": ["v2 = 0"],
        "initial": ["3/5", "-1/2"]
    })
}

/// Suslov's body in a potential of degree four.
fn with_potential(potential: &str) -> Value {
    let kinetic = "(134*m1^2 + 291*m2^2 + 200*m3^2 - 24*m1*m2 - 60*m1*m3 + 160*m2*m3)/518";
    json!({
        "format": 1,
        "name": "SuslovPotential",
        "algebra": "se(3)",
        "state": ["m1", "m2", "m3", "g1", "g2", "g3"],
        "hamiltonian": format!("{kinetic} + {potential}"),
        "constraint": ["J3 = 0"],
        "initial": ["3/5", "-1/2", "3/10", "2/5", "4/5"]
    })
}

const QUARTIC: &str = "g1/3 + g3^3/2 + g2^4";

/// A body in four dimensions that cannot turn in two of its six planes.
fn so4() -> Value {
    let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    let matrix = |(i, j): (usize, usize)| {
        let mut rows = [[0; 4]; 4];
        (rows[j][i], rows[i][j]) = (1, -1);
        (format!("e{i}{j}"), json!(rows))
    };
    let matrices: serde_json::Map<String, Value> = pairs.map(matrix).into_iter().collect();
    json!({
        "format": 1,
        "name": "Turning",
        "algebra": { "basis": pairs.map(|(i, j)| format!("e{i}{j}")), "matrices": matrices },
        "state": ["m1", "m2", "m3", "m4", "m5", "m6"],
        "velocity": ["w1", "w2", "w3", "w4", "w5", "w6"],
        "lagrangian": "(2*w1^2 + 3/2*w2^2 + w3^2 + 4/3*w4^2 + 5/4*w5^2 + 7/4*w6^2)/2 + w1*w4/3 + w2*w5/4 - w3*w6/5 + w1*w6/6",
        "constraint": ["w5 = 0", "w6 = 0"],
        "initial": ["3/5", "-1/2", "2/5", "3/10"]
    })
}

/// The columns of a run by name.
fn columns(path: &Path, arguments: &str) -> impl Fn(&str) -> Vec<f64> + use<> {
    let run = lie(&format!("run {} --quiet {arguments}", path.display())).ok();
    let (header, rows) = run.csv();
    move |name| {
        let place = header.iter().position(|known| known == name);
        let place = place.unwrap_or_else(|| panic!("no {name} in {header:?}"));
        rows.iter().map(|row| row[place]).collect()
    }
}

/// The largest distance of a column from its first entry.
fn drift(values: &[f64]) -> f64 {
    let changes = values.iter().map(|value| (value - values[0]).abs());
    changes.fold(0.0, f64::max)
}

#[test]
fn check_tells_what_a_constraint_leaves() {
    let folder = folder();
    let path = written(folder.path(), "suslov.json", &suslov());
    let text = lie(&format!("check {}", path.display())).ok().stdout;
    for expected in [
        "  constraint: w3 = 0\n",
        "m1 along e1, m2 along e2",
        "velocity w1 = m1/2\n",
        "velocity w3 = 0\n",
        "the bracket is almost Poisson: its Jacobi identity holds",
        "m3 = 3*m1/20 - 2*m2/5\n",
        "H = m1^2/4 + m2^2/2\n",
        "dimension 2, generic rank 2",
    ] {
        assert!(text.contains(expected), "no {expected:?} in\n{text}");
    }
    let path = written(folder.path(), "so4.json", &so4());
    let check = lie(&format!("check {} --json", path.display())).ok();
    let check: Value = serde_json::from_str(&check.stdout).expect("JSON");
    let constraint = &check["constraint"];
    assert_eq!(constraint["equations"], json!(["w5 = 0", "w6 = 0"]));
    assert_eq!(constraint["basis"]["m4"], "e12");
    assert_eq!(constraint["almost_poisson"], true);
    assert_eq!(constraint["jacobi"], false);
    assert_eq!(check["dimension"], 4);
    for id in [
        "k-hj2",
        "k-hj4",
        "lie-midpoint",
        "splitting2",
        "generating4",
        "collective4",
    ] {
        let reason = check["methods"][id].as_str().expect(id);
        assert!(reason.contains("almost Poisson"), "{id}: {reason}");
    }
    for id in ["midpoint", "gauss4", "gonzalez", "orbit-energy", "rk4"] {
        assert!(check["methods"][id].is_null(), "{id}");
    }
}

/// The energy to 1e-14 over 10^4 steps, which Runge–Kutta of order four loses.
#[test]
fn energy_is_kept_over_ten_thousand_steps() {
    let folder = folder();
    for (name, spec) in [("suslov", suslov()), ("sleigh", sleigh()), ("so4", so4())] {
        let path = written(folder.path(), &format!("{name}.json"), &spec);
        for method in ["midpoint", "gauss4", "gonzalez", "orbit-energy"] {
            let run = columns(&path, &format!("--method {method} --step 0.2 --until 2000"));
            let energy = run("energy");
            assert_eq!(energy.len(), 10_001);
            let drift = drift(&energy);
            assert!(drift < 2e-14, "{name}, {method}: {drift:e}");
        }
        let control = columns(&path, "--method rk4 --step 0.2 --until 2000");
        assert!(drift(&control("energy")) > 1e-9, "{name}");
    }
}

/// In a potential of degree four discrete gradients alone keep the energy, and all but Runge–Kutta the length of the vertical.
#[test]
fn a_potential_of_degree_four() {
    let folder = folder();
    let path = written(folder.path(), "quartic.json", &with_potential(QUARTIC));
    let measured = |method: &str| {
        let run = columns(&path, &format!("--method {method} --step 0.2 --until 600"));
        (drift(&run("energy")), drift(&run("C1")))
    };
    for method in ["gonzalez", "orbit-energy"] {
        let (energy, length) = measured(method);
        assert!(
            energy < 5e-14 && length < 2e-14,
            "{method}: {energy:e}, {length:e}"
        );
    }
    let (energy, length) = measured("midpoint");
    assert!(
        (3e-2..0.2).contains(&energy) && length < 1e-13,
        "{energy:e}, {length:e}"
    );
    let (energy, length) = measured("gauss4");
    assert!(
        (1e-4..1e-3).contains(&energy) && length < 1e-13,
        "{energy:e}, {length:e}"
    );
    let (energy, length) = measured("rk4");
    assert!(energy > 1e-4 && length > 1e-3, "{energy:e}, {length:e}");
}

/// The momenta and the velocity belong to each other: the constrained component stays zero, and the other momenta follow.
#[test]
fn what_is_determined_is_recorded() {
    let folder = folder();
    let mut spec = suslov();
    spec["observables"] = json!({ "twice": "2*m3 + m1" });
    let path = written(folder.path(), "suslov.json", &spec);
    let run = columns(&path, "--method gonzalez --step 0.1 --until 5");
    let (first, second, third) = (run("m1"), run("m2"), run("m3"));
    for (k, twice) in run("twice").iter().enumerate() {
        let expected = 0.15 * first[k] - 0.4 * second[k];
        assert!((third[k] - expected).abs() < 1e-15);
        assert!((twice - 2.0 * expected - first[k]).abs() < 1e-15);
    }
}

/// The discrete Euler–Poincaré–Suslov equations along exp, `P (dexp_{h xi}^-1)* I xi = m` and back with -h: the discrete principle of
/// Lagrange and d'Alembert, which is the control that loses the energy.
fn discrete_suslov(m: [f64; 2], h: f64) -> [f64; 2] {
    // (dexp_{s xi}^-1)* mu = sum_k B_k/k! (ad*_{s xi})^k mu, with ad*_xi mu = mu x xi
    const BERNOULLI: [f64; 6] = [-0.5, 1.0 / 12.0, 0.0, -1.0 / 720.0, 0.0, 1.0 / 30_240.0];
    let image = |m: [f64; 2], s: f64| {
        let xi = [s * m[0] / 2.0, s * m[1]];
        let mut term = [m[0], m[1], 0.15 * m[0] - 0.4 * m[1]];
        let mut sum = [m[0], m[1]];
        for factor in BERNOULLI {
            // mu x (xi1, xi2, 0)
            term = [
                -term[2] * xi[1],
                term[2] * xi[0],
                term[0] * xi[1] - term[1] * xi[0],
            ];
            sum[0] += factor * term[0];
            sum[1] += factor * term[1];
        }
        sum
    };
    let mut middle = m;
    for _ in 0..60 {
        let found = image(middle, h);
        middle = [middle[0] + m[0] - found[0], middle[1] + m[1] - found[1]];
    }
    image(middle, -h)
}

#[test]
fn the_discrete_principle_loses_the_energy() {
    let energy = |m: [f64; 2]| m[0] * m[0] / 4.0 + m[1] * m[1] / 2.0;
    let (mut m, start) = ([0.6, -0.5], energy([0.6, -0.5]));
    let mut lost: f64 = 0.0;
    for _ in 0..300 {
        m = discrete_suslov(m, 0.25);
        lost = lost.max((energy(m) - start).abs());
    }
    // 1.4e-4 by 40 digits
    assert!((1.2e-4..1.6e-4).contains(&lost), "{lost:e}");
    let folder = folder();
    let path = written(folder.path(), "suslov.json", &suslov());
    for method in ["midpoint", "gauss4", "gonzalez", "orbit-energy"] {
        let run = columns(&path, &format!("--method {method} --step 0.25 --until 75"));
        let lost = drift(&run("energy"));
        assert!(lost < 2e-15, "{method}: {lost:e}");
    }
}

/// What methods claim is measured; of a bracket that is almost Poisson there are no leaves, and no step is a Poisson map.
#[test]
fn verify_measures_what_is_claimed() {
    let folder = folder();
    let methods = "midpoint,gauss4,gonzalez,orbit-energy,rk4";
    for (name, spec) in [
        ("suslov", suslov()),
        ("sleigh", sleigh()),
        ("so4", so4()),
        ("quadratic", with_potential("g1/3 + g3^2/2 + g2^2/5")),
        ("quartic", with_potential(QUARTIC)),
    ] {
        let path = written(folder.path(), &format!("{name}.json"), &spec);
        let call = format!(
            "verify {} --methods {methods} --quiet --json",
            path.display()
        );
        let report: Value = serde_json::from_str(&lie(&call).ok().stdout).expect("JSON");
        assert_eq!(report["failed"], 0, "{name}: {report:#}");
        for method in methods.split(',') {
            for fact in ["Poisson", "orbit"] {
                let finding = &report["methods"][method][fact];
                assert_eq!(
                    finding["verdict"], "absent",
                    "{name}, {method}: {finding:#}"
                );
                let note = finding["note"].as_str().unwrap_or_default();
                assert!(note.contains("almost Poisson"), "{name}, {method}: {note}");
            }
        }
        let energy = &report["methods"]["orbit-energy"]["energy"];
        assert_eq!(energy["verdict"], "holds", "{name}: {energy:#}");
    }
}

#[test]
fn states_off_the_constraint_are_refused() {
    let folder = folder();
    let path = written(folder.path(), "suslov.json", &suslov());
    let call = |initial: &str| {
        let path = path.display();
        lie(&format!(
            "run {path} --step 0.1 --until 1 --quiet --initial {initial}"
        ))
    };
    let reduced = call("0.4,0.2").ok().stdout;
    let declared = call("0.4,0.2,-0.02").ok().stdout;
    assert_eq!(reduced, declared);
    let wrong = call("0.4,0.2,0.5").error("constraint", "command line: --initial");
    assert!(
        wrong.stderr.contains("violates the constraint w3 = 0"),
        "{}",
        wrong.stderr
    );
    assert!(
        wrong.stderr.contains("give the values of m1, m2 alone"),
        "{}",
        wrong.stderr
    );
    call("0.4").error("state-length", "command line: --initial");
    let mut spec = suslov();
    spec["initial"] = json!(["3/5", "-1/2", 0]);
    let path = written(folder.path(), "off.json", &spec);
    let place = format!("{}:1:", path.display());
    let wrong = lie(&format!("check {}", path.display()));
    assert!(wrong.stderr.contains(&place), "{}", wrong.stderr);
    assert!(
        wrong.stderr.starts_with("error[constraint]: "),
        "{}",
        wrong.stderr
    );
}

/// With the group element in the state the sleigh moves in the plane: its velocity across the blade is zero.
#[test]
fn a_sleigh_on_its_group() {
    let folder = folder();
    let mut spec = sleigh();
    spec["algebra"] = json!("se(2)");
    spec["group"] = json!("g");
    spec["parameters"] = json!({ "I": "3/2", "m": 1, "a": "2/5" });
    spec["lagrangian"] = json!("(I*w^2 + m*v1^2 + m*v2^2)/2 + m*a*w*v2");
    let path = written(folder.path(), "sleigh.json", &spec);
    let run = columns(&path, "--method gauss16 --step 0.01 --until 4");
    let (cosine, sine) = (run("g11"), run("g21"));
    let (x, y) = (run("g13"), run("g23"));
    let mut across: f64 = 0.0;
    let mut along: f64 = 0.0;
    for k in 1..x.len() - 1 {
        let rate = |of: &[f64]| (of[k + 1] - of[k - 1]) / 0.02;
        let (dx, dy) = (rate(&x), rate(&y));
        across = across.max((cosine[k] * dy - sine[k] * dx).abs());
        along = along.max((cosine[k] * dx + sine[k] * dy).abs());
    }
    assert!(across < 1e-4 && along > 0.3, "{across:e}, {along}");
}

/// A potential that depends on the time: what it does to the energy is what the run says, and the constraint stays.
#[test]
fn a_potential_that_depends_on_the_time() {
    let folder = folder();
    let spec = with_potential("g1/3 + cos(t)*g3^2/2");
    let path = written(folder.path(), "time.json", &spec);
    let by = |method: &str, step: &str| {
        let run = columns(&path, &format!("--method {method} --step {step} --until 4"));
        let last = |name: &str| *run(name).last().expect("a row");
        ["m1", "m2", "m3", "g1", "g2", "g3"].map(last)
    };
    let exact = by("gauss16", "0.1");
    let other = by("rk4", "0.002");
    for (a, b) in exact.iter().zip(other) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    assert!((exact[2] - 0.15 * exact[0] + 0.4 * exact[1]).abs() < 1e-13);
}
