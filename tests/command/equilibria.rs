//! `lie equilibria`: against closed formulas, and what it refuses.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::common::{folder, lie, spec};

/// A spec of the repository with changes.
fn changed(name: &str, folder: &Path, changes: impl FnOnce(&mut Value)) -> PathBuf {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("specs")
        .join(name);
    let text = std::fs::read_to_string(path).expect("a spec");
    let mut spec: Value = serde_json::from_str(&text).expect("JSON");
    changes(&mut spec);
    spec.as_object_mut().expect("an object").remove("$schema");
    let path = folder.join(name);
    std::fs::write(&path, format!("{spec:#}")).expect("the spec is written");
    path
}

#[track_caller]
fn found(arguments: &str) -> Value {
    let run = lie(&format!("equilibria {arguments} --json")).ok();
    serde_json::from_str(&run.stdout).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let entries = value.as_array().expect("an array").iter();
    entries
        .map(|entry| entry.as_f64().expect("a number"))
        .collect()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("an array")
}

/// A symmetric top with I1 = I2 = 3/7, I3 = 2/3, mgl = 5/11, spinning upright.
fn top(folder: &Path) -> PathBuf {
    changed("se3_heavy_top.json", folder, |spec| {
        spec["parameters"] = json!({ "I1": "3/7", "I3": "2/3", "mgl": "5/11", "spin": 1 });
        spec["hamiltonian"] = "(m1^2 + m2^2)/(2*I1) + m3^2/(2*I3) + mgl*g3".into();
        spec["initial"] = json!([0, 0, "spin", 0, 0, 1]);
    })
}

/// Of a body with moments 2, 1, 2/3 and momentum 1: pairs on the axes, the middle one (I = 1) unstable with rate
/// `|m| sqrt((I1 - I2)(I2 - I3)/(I1 I3))/I2`.
#[test]
fn axes_of_the_rigid_body() {
    let of = |options: &str| found(&format!("specs/so3_free_rigid_body.json {options}"));
    let expected = |found: &Value| {
        let all = list(&found["equilibria"]);
        all.len() == 6
            && all.iter().all(|one| {
                let state = numbers(&one["state"]);
                let unstable = one["stability"] == "unstable";
                let growth = numbers(&one["eigenvalues"][0])[0];
                let rate = if unstable {
                    (1.0_f64 / 3.0 / (4.0 / 3.0)).sqrt()
                } else {
                    0.0
                };
                let axis = state.iter().filter(|x| x.abs() > 1e-12).count() == 1;
                axis && unstable == (state[1].abs() > 0.5)
                    && (growth - rate).abs() < 1e-12
                    && one["zero_eigenvalues"] == 1
                    && one["proven"] == true
            })
    };
    let body = of("");
    assert!(expected(&body), "{body:#}");
    assert_eq!(
        (&body["paths"]["all"], &body["paths"]["real"]),
        (&json!(6), &json!(6))
    );
    // the control: a symmetric body has an equator of equilibria
    let symmetric = of("--param I2=2");
    assert!(!expected(&symmetric));
    let families = list(&symmetric["equilibria"])
        .iter()
        .map(|one| &one["family_dimension"]);
    assert_eq!(
        families.filter(|dimension| **dimension == 1).count(),
        1,
        "{symmetric:#}"
    );
}

/// Rotations of the symmetric top about the vertical: upright, hanging, and circles at `cos = mgl/(w^2 (I3 - I1))` for the roots w of
/// `I1 w^4 - c w^3 + mgl^2/(I3 - I1) = 0`.
#[test]
fn all_rotations_of_the_symmetric_top() {
    let folder = folder();
    let path = top(folder.path());
    let (i1, i3, mgl): (f64, f64, f64) = (3.0 / 7.0, 2.0 / 3.0, 5.0 / 11.0);
    for spin in [0.6, 3.0] {
        let residual = |w: f64| i1 * w.powi(4) - spin * w.powi(3) + mgl * mgl / (i3 - i1);
        let mut cosines = Vec::new();
        let mut at = -20.0 + 1e-4;
        while at < 20.0 {
            let (mut a, mut b) = (at, at + 1e-3);
            if residual(a) * residual(b) < 0.0 {
                for _ in 0..60 {
                    let c = 0.5 * (a + b);
                    if residual(c) * residual(a) > 0.0 {
                        a = c
                    } else {
                        b = c
                    }
                }
                cosines.push(mgl / (a * a * (i3 - i1)));
            }
            at += 1e-3;
        }
        cosines.retain(|cosine| cosine.abs() < 1.0);
        cosines.sort_by(f64::total_cmp);
        let all = found(&format!("{} --param spin={spin}", path.display()));
        let (isolated, families): (Vec<&Value>, Vec<&Value>) = list(&all["equilibria"])
            .iter()
            .partition(|one| one["family_dimension"] == 0);
        assert_eq!(isolated.len(), 2, "{all:#}");
        let mut heights: Vec<f64> = families
            .iter()
            .map(|one| numbers(&one["state"])[5])
            .collect();
        heights.sort_by(f64::total_cmp);
        let agrees = |cosines: &[f64]| {
            heights.len() == cosines.len()
                && heights
                    .iter()
                    .zip(cosines)
                    .all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert!(agrees(&cosines), "{spin}: {heights:?} {cosines:?}");
        let off: Vec<f64> = cosines.iter().map(|cosine| cosine + 1e-11).collect();
        assert!(cosines.is_empty() || !agrees(&off));
    }
}

/// A top sleeps where its spin is above `2 sqrt(I1 mgl)`.
#[test]
fn the_threshold_of_the_sleeping_top() {
    let folder = folder();
    let path = top(folder.path());
    let plot = folder.path().join("top.svg");
    let all = found(&format!(
        "{} --param spin=0.5:1.5:11 --starts 40 --plot {}",
        path.display(),
        plot.display()
    ));
    let upright = |branch: &&Value| numbers(&branch["points"][0]["state"])[5] > 1.0 - 1e-9;
    let branches: Vec<&Value> = list(&all["branches"]).iter().filter(upright).collect();
    assert_eq!(branches.len(), 1, "{all:#}");
    let change = list(&branches[0]["changes"])
        .iter()
        .find(|change| change["kind"] == "eigenvalues meet");
    let change = change.unwrap_or_else(|| panic!("{all:#}"));
    let value = change["value"].as_f64().expect("a number");
    let threshold = 2.0 * (3.0_f64 / 7.0 * 5.0 / 11.0).sqrt();
    assert!((value - threshold).abs() < 1e-12, "{value} {threshold}");
    assert!(
        (value - 2.0 * (2.0_f64 / 3.0 * 5.0 / 11.0).sqrt()).abs() > 0.1,
        "the control has another moment"
    );
    assert_eq!(
        (&change["from"], &change["to"]),
        (&json!("unstable"), &json!("stable"))
    );
    for point in list(&branches[0]["points"]) {
        let below = point["value"].as_f64().expect("a number") < threshold;
        assert_eq!(point["stability"] == "unstable", below, "{point}");
    }
    let picture = std::fs::read_to_string(plot).expect("a picture");
    assert!(
        picture.contains("stroke-dasharray") && picture.contains("spin"),
        "solid and dashed"
    );
    // on both sides a proof, in rational numbers
    for (spin, stability) in [("22/25", "unstable"), ("89/100", "stable")] {
        let all = found(&format!("{} --param spin={spin}", path.display()));
        let upright = list(&all["equilibria"])
            .iter()
            .find(|one| numbers(&one["state"])[5] > 1.0 - 1e-9);
        let upright = upright.expect("it stands");
        assert_eq!(
            (&upright["stability"], &upright["proven"]),
            (&json!(stability), &json!(true)),
            "{upright:#}"
        );
    }
}

/// Each state of a body in a fluid stands still by equations that are written out here, and no path was lost.
#[test]
fn kirchhoff_stands_still() {
    let all = found("specs/se3_kirchhoff.json");
    let equilibria = list(&all["equilibria"]);
    assert_eq!(all["paths"]["lost"], 0, "{:#}", all["paths"]);
    assert_eq!(all["paths"]["real"], json!(equilibria.len()));
    assert!(equilibria.len() >= 6, "{}", equilibria.len());
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let field = |x: &[f64]| {
        let (m, p) = ([x[0], x[1], x[2]], [x[3], x[4], x[5]]);
        let w = [
            m[0] + p[0] / 4.0,
            2.0 * m[1] / 3.0 + p[2] / 6.0,
            m[2] / 2.0 - p[1] / 8.0,
        ];
        let v = [
            2.0 * p[0] / 5.0 + m[0] / 4.0,
            p[1] - m[2] / 8.0,
            4.0 * p[2] / 3.0 + m[1] / 6.0,
        ];
        let (a, b, c) = (cross(m, w), cross(p, v), cross(p, w));
        (0..3)
            .map(|i| (a[i] + b[i]).abs() + c[i].abs())
            .fold(0.0, f64::max)
    };
    for one in equilibria {
        let state = numbers(&one["state"]);
        assert!(field(&state) < 1e-14, "{state:?}");
        let moved: Vec<f64> = state.iter().map(|x| x + 1e-3).collect();
        assert!(field(&moved) > 1e-5, "the control moves");
        let casimirs = (
            state[3..].iter().map(|p| p * p).sum::<f64>(),
            (0..3).map(|i| state[i] * state[3 + i]).sum::<f64>(),
        );
        let [impulse, pitch] = [0, 1].map(|k| numbers(&all["casimir_values"])[k]);
        assert!((casimirs.0 - impulse).abs() < 1e-14 && (casimirs.1 - pitch).abs() < 1e-14);
        assert!(
            one["existence"] != "numerical" && one["proven"] == true,
            "{one:#}"
        );
    }
    // a body that is a minimum is there: H has one on this leaf
    assert!(
        equilibria
            .iter()
            .any(|one| one["reason"]["kind"] == "minimum")
    );
}

/// Brackets that are none of an algebra, and one that has no Casimirs: a pendulum hangs or stands.
#[test]
fn other_brackets() {
    let all = found("specs/canonical_pendulum.json");
    let kinds: Vec<&Value> = list(&all["equilibria"])
        .iter()
        .map(|one| &one["stability"])
        .collect();
    assert!(
        kinds.contains(&&json!("stable")) && kinds.contains(&&json!("unstable")),
        "{all:#}"
    );
    assert_eq!(all["paths"], Value::Null, "a cosine is no polynomial");
    let text = lie("equilibria specs/canonical_pendulum.json").ok().stdout;
    assert!(text.contains("searched, not proven to be all"), "{text}");
}

/// Numbers that are uncertain are shown with their error, zeros as zeros, and the end of a branch on a threshold as one.
#[test]
fn what_is_uncertain_is_shown_so() {
    let folder = folder();
    let shown = |hamiltonian: &str| {
        let path = spec(folder.path(), |spec| {
            spec.as_object_mut().expect("an object").remove("algebra");
            spec["poisson"] = json!(["{x, y} = (2*x + 3)*(1 - y/2)"]);
            spec["state"] = json!(["x", "y"]);
            spec["hamiltonian"] = hamiltonian.into();
            spec["initial"] = json!([-1.0, 0.5]);
            spec.as_object_mut().expect("an object").remove("casimirs");
        });
        lie(&format!("equilibria {}", path.display())).ok().stdout
    };
    let double = shown("y^2/2 + (x^2 - 2)^3/3");
    assert!(
        double.contains("x = 1.4142") && double.contains(", each up to ± "),
        "{double}"
    );
    assert!(!double.contains("x = 1.414214"), "{double}");
    let simple = shown("y^2/2 + (x^2 - 2)^2/3");
    assert!(simple.contains("x = 1.414214"), "{simple}");
    assert!(!simple.contains("each up to"), "{simple}");
    let zero = shown("x^2/2 + y^2 + x*y");
    assert!(
        zero.contains("state: x = 0, y = 0\n  energy: 0\n"),
        "{zero}"
    );
    let path = top(folder.path());
    let range = |range: &str| {
        let run = lie(&format!(
            "equilibria {} --param spin={range}",
            path.display()
        ))
        .ok();
        run.stdout
    };
    let i1_mgl: f64 = 3.0 / 7.0 * 5.0 / 11.0;
    let threshold = 2.0 * i1_mgl.sqrt();
    let what = "at a threshold and not decided";
    assert!(range(&format!("0.5:{threshold}:11")).contains(what));
    assert!(!range(&format!("0.5:{}:11", threshold - 0.01)).contains(what));
}

/// What is said of a change of a spec.
type Case<'a> = (&'a str, &'a dyn Fn(&mut Value));

#[test]
fn what_is_refused_says_why() {
    let folder = folder();
    let body = |changes: &dyn Fn(&mut Value)| spec(folder.path(), changes);
    let run = |path: &Path, options: &str| lie(&format!("equilibria {} {options}", path.display()));
    let plain = body(&|_| {});
    run(&plain, "--plot x.svg").error("option", "command line: --plot");
    run(&plain, "--param I1=1:2:3 --param I2=1:2:3").error("option", "command line: --param");
    run(&plain, "--param I1=1:1:1").error("option", "command line: --param");
    run(&plain, "--param I9=1:2:3").error("option", "command line: --param");
    run(&plain, "--param I1=1:2").error("option", "command line: --param");
    run(&plain, "--casimir D=1").error("option", "command line: --casimir");
    run(&plain, "--casimir C").error("option", "command line: --casimir");
    run(&plain, "--casimir C=1 --casimir C=2").error("option", "command line: --casimir");
    run(&plain, "--initial 0,0,0").error("domain", "command line: --initial");
    run(&plain, "--initial 1,2").error("state-length", "command line: --initial");
    let path = body(&|spec| drop(spec.as_object_mut().expect("an object").remove("initial")));
    let refused = lie(&format!("equilibria {}", path.display()));
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("initial"), "{}", refused.stderr);
    let place = |path: &Path| format!("{}:", path.display());
    let cases: [Case<'_>; 2] = [
        ("depends on the time", &|spec| {
            spec["hamiltonian"] = "x^2/2 + y^2/4 + z^2/6 + cos(t)*x".into()
        }),
        ("the motion leaves the leaf", &|spec| {
            spec["forces"] = json!({ "x": "-x" })
        }),
    ];
    let family = "tests/data/families/open_chain.json";
    let refused = lie(&format!("equilibria {family}")).error("method", family);
    assert!(
        refused.stderr.contains("it is a family"),
        "{}",
        refused.stderr
    );
    for (what, changes) in cases {
        let path = body(changes);
        let refused = lie(&format!("equilibria {}", path.display())).error("method", &place(&path));
        assert!(refused.stderr.contains(what), "{}", refused.stderr);
    }
}
