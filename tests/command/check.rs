//! `lie check` and `lie expand` on sound and on broken specs.

use crate::common::{folder, lie, spec};

#[test]
fn the_specs_of_the_repository_are_sound() {
    let run = lie("check specs/se3_heavy_top.json specs/so4_manakov.json").ok();
    for text in [
        "HeavyTop",
        "dimension 6, generic rank 4",
        "length2 = ",
        "vector_field",
        "gauss6",
    ] {
        assert!(run.stdout.contains(text), "{text}: {}", run.stdout);
    }
}

#[test]
fn json_has_the_agreed_fields() {
    let one: serde_json::Value =
        serde_json::from_str(&lie("check specs/se3_heavy_top.json --json").ok().stdout)
            .expect("JSON");
    assert_eq!(one["name"], "HeavyTop");
    assert_eq!(
        (
            &one["dimension"],
            &one["generic_rank"],
            &one["initial_rank"],
            &one["independent_casimirs"]
        ),
        (&6.into(), &4.into(), &4.into(), &2.into())
    );
    assert_eq!(one["casimirs"][0]["name"], "length2");
    assert_eq!(one["casimirs"][0]["kind"], "declared");
    assert_eq!(one["casimirs"][0]["degree"], 2);
    let class = serde_json::json!({
        "abelian": false, "nilpotent": false, "solvable": false,
        "semisimple": false, "reductive": false, "unimodular": true,
    });
    assert_eq!(one["class"], class);
    assert_eq!(one["series"]["derived"], serde_json::json!([6]));
    assert_eq!(one["killing"]["negative"], 3);
    assert_eq!(one["splitting"].as_array().map(Vec::len), Some(3));
    assert!(
        one["splitting_cost"]["weight"]
            .as_u64()
            .is_some_and(|weight| weight > 0)
    );
    assert!(one["methods"]["midpoint"].is_null());
    assert!(one["methods"]["spherical-midpoint"].is_string());
    assert_eq!(one["operations"]["vector_field"]["mul"], 21);
    assert_eq!(one["operations"]["vector_field"]["add"], 9);
    let several = lie("check specs/se3_heavy_top.json specs/sl2_quadratic.json --json")
        .ok()
        .stdout;
    let several: serde_json::Value = serde_json::from_str(&several).expect("JSON");
    assert_eq!(several.as_array().map(Vec::len), Some(2));
    assert_eq!(several[0], one);
}

#[test]
fn mistakes_are_reported_at_their_place() {
    let folder = folder();
    let place = |path: &std::path::Path, what: &str| {
        let text = std::fs::read_to_string(path).expect("the spec is there");
        let line = text
            .lines()
            .position(|line| line.contains(what))
            .expect("the text is there");
        let column = text
            .lines()
            .nth(line)
            .and_then(|line| line.find(what))
            .unwrap_or(0);
        format!("{}:{}:{}", path.display(), line + 1, column + 1)
    };
    let path = spec(folder.path(), |spec| {
        spec["hamiltonian"] = "x^2 + qq*y".into()
    });
    lie(&format!("check {}", path.display())).error("unknown-symbol", &place(&path, "qq"));
    let path = spec(folder.path(), |spec| {
        spec["casimirs"] = serde_json::json!(["C = x^2 + y^2"])
    });
    let run = lie(&format!("check {}", path.display()));
    run.error("casimir", &place(&path, "x^2 + y^2\""));
    // Every spec is looked at, and what is sound is reported.
    let run = lie(&format!(
        "check {} specs/sl2_quadratic.json",
        path.display()
    ));
    assert_eq!(run.code, Some(2));
    assert!(run.stdout.contains("dimension 3"), "{}", run.stdout);
}

#[test]
fn files_that_are_none() {
    let folder = folder();
    let run = lie("check specs/nowhere.json");
    assert_eq!(run.code, Some(1));
    run.says("io", "specs/nowhere.json");
    assert_eq!(
        lie(&format!("check {}", folder.path().display())).code,
        Some(1)
    );
    for content in [
        &b""[..],
        b"{",
        b"[]",
        b"\xff\xfe{}",
        b"{\"name\": \"\xff\"}",
        b"\n\n\t",
        b"\xef\xbb\xbf{",
    ] {
        let path = folder.path().join("broken.json");
        std::fs::write(&path, content).expect("the file is written");
        let run = lie(&format!("check {}", path.display()));
        run.error("schema", &format!("{}:", path.display()));
    }
}

#[test]
fn expand_prints_rust_with_fused_code_on_demand() {
    let plain = lie("expand specs/so3_free_rigid_body.json").ok().stdout;
    assert!(plain.contains("pub struct FreeRigidBody"), "{plain}");
    let fused = lie("expand specs/so3_free_rigid_body.json --method gauss4 --method midpoint")
        .ok()
        .stdout;
    assert!(fused.len() > plain.len() || fused.contains("Gauss4"));
    assert_eq!(
        fused,
        lie("expand specs/so3_free_rigid_body.json --method gauss4 --method midpoint").stdout
    );
    let elsewhere = lie("expand specs/so3_free_rigid_body.json --crate my_crate::rt")
        .ok()
        .stdout;
    assert!(elsewhere.contains("impl<S: my_crate::rt::Scalar> my_crate::rt::Poisson<S>"));
    assert!(!elsewhere.contains("::lie_runtime"));
    lie("expand specs/so3_free_rigid_body.json --crate my-crate::rt")
        .error("option", "command line: --crate");
    lie("expand specs/so3_free_rigid_body.json --method gaus4")
        .error("method", "command line: --method");
    lie("expand specs/so3_free_rigid_body.json --method variational4")
        .error("method", "command line: --method");
}

/// A lift is of the declared algebra, which is not blamed for the time that makes it larger.
#[test]
fn lifts_are_refused_because_of_the_time_where_that_is_why() {
    let folder = folder();
    let text = std::fs::read_to_string("specs/su3_quadratic.json").expect("a spec");
    let mut spec: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let plain = spec["hamiltonian"].as_str().expect("text").to_owned();
    let first = spec["state"][0].as_str().expect("a name").to_owned();
    let path = folder.path().join("driven.json");
    spec["hamiltonian"] = format!("{plain} + cos(t)*{first}").into();
    spec.as_object_mut().expect("an object").remove("$schema");
    std::fs::write(&path, spec.to_string()).expect("written");
    for method in ["collective8 --lift unitary", "collective4 --lift hopf"] {
        let call = format!("run {} --until 1 --step 0.1 --method", path.display());
        let mut call: Vec<&str> = call.split(' ').collect();
        call.push(method);
        let run =
            crate::common::Run::from(crate::common::command(call).output().expect("lie starts"));
        let run = run.error("method", "command line: --method");
        let said = run.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains("the time makes that larger"), "{said}");
    }
    // the control: without the time the lift applies
    lie("run specs/su3_quadratic.json --until 1 --step 0.1 --quiet --method collective8 --lift unitary").ok();
}

/// The unit beside the time is a Casimir that nobody has to find; what the time or the group element rules out is
/// not blamed on the algebra.
#[test]
fn larger_algebras_are_not_what_was_declared() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["hamiltonian"] = "x^2 + 2*y^2 + 3*z^2 + cos(t)*x".into();
    });
    let timed = lie(&format!("check {}", path.display())).ok().stdout;
    assert!(
        timed.contains("Casimirs: 1 declared of 1 independent"),
        "{timed}"
    );
    let group = lie("check specs/so3_gravity_gradient.json").ok().stdout;
    // spins are on their spheres beside the time, and not beside a group element
    for (text, what, spheres) in [
        (timed, "the time makes", false),
        (group, "the group element makes", true),
    ] {
        // a sentence goes on in lines that are indented further
        let text = text.replace("\n        ", " ");
        let mut lines = text.lines();
        let refused = lines.find(|line| line.contains("not moser-veselov"));
        let refused = refused.unwrap_or_else(|| panic!("{text}"));
        assert!(
            refused.contains(what) && !refused.contains("so(3)"),
            "{refused}"
        );
        assert_eq!(refused.contains("spherical-midpoint"), spheres, "{refused}");
    }
}

/// A slip in a sign makes another algebra, which is seen; Casimirs need not be declared.
#[test]
fn the_algebra_is_named_and_its_casimirs_are_found() {
    let folder = folder();
    let check = |brackets: serde_json::Value, flags: &str| {
        let path = spec(folder.path(), |spec| {
            spec["casimirs"] = serde_json::json!([]);
            spec["algebra"]["brackets"] = brackets;
        });
        lie(&format!("check {} {flags}", path.display()))
            .ok()
            .stdout
    };
    let right = || serde_json::json!(["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]);
    let slip = || serde_json::json!(["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = -e2"]);
    for (brackets, name, casimir) in [
        (right(), "so(3)", "C1 = x^2 + y^2 + z^2"),
        (slip(), "sl(2,R)", "C1 = x^2 - y^2 + z^2"),
    ] {
        for flags in ["", "--deep"] {
            let text = check(brackets.clone(), flags);
            for part in [
                format!("algebra: {name} ("),
                "Casimirs: found 1 of 1 independent".to_owned(),
                casimir.to_owned(),
            ] {
                assert!(text.contains(&part), "{part}: {text}");
            }
        }
        let json: serde_json::Value =
            serde_json::from_str(&check(brackets, "--json")).expect("JSON");
        assert_eq!(json["algebra_name"], name);
        assert_eq!(json["casimirs"][0]["kind"], "polynomial");
        assert_eq!(json["class"]["semisimple"], true);
    }
}
