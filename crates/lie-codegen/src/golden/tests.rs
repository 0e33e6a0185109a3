use super::*;

#[test]
fn differences_missing_and_left_over_files_are_reported() {
    let folder = std::env::temp_dir().join(format!("lie-golden-{}", std::process::id()));
    let mut golden = Golden::new(&folder);
    golden
        .text("a.rs", "one\ntwo\n".into())
        .text("b.rs", "three\n".into());
    assert!(golden.run(false).is_err(), "nothing is there yet");
    golden.run(true).unwrap();
    golden.run(false).unwrap();
    std::fs::write(folder.join("a.rs"), "one\nzwei\n").unwrap();
    std::fs::write(folder.join("c.rs"), "").unwrap();
    let Stale(problems) = golden.run(false).unwrap_err();
    assert_eq!(problems.len(), 2, "{problems:?}");
    assert!(
        problems[0].contains("a.rs:2: was `zwei`, is `two`"),
        "{problems:?}"
    );
    assert!(problems[1].contains("c.rs"), "{problems:?}");
    golden.run(true).unwrap();
    golden.run(false).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_runtime_of_a_golden_file_is_at_a_path() {
    let folder = std::env::temp_dir().join(format!("lie-golden-path-{}", std::process::id()));
    let mut golden = Golden::new(&folder);
    golden.runtime("my_crate::lie_runtime");
    golden.spec("../../specs/so3_free_rigid_body.json", &[]);
    let code = &golden.files["so3_free_rigid_body.rs"];
    assert!(
        code.contains("impl<S: my_crate::lie_runtime::Scalar>"),
        "{code}"
    );
    assert!(
        !code.contains("::lie_runtime::Scalar> ::lie_runtime"),
        "{code}"
    );
    let Stale(problems) = golden.runtime("my-crate").run(true).unwrap_err();
    assert!(
        problems[0].starts_with("`my-crate` is not the path of a crate"),
        "{problems:?}"
    );
}

/// The macros of a source file: one that declares, one that names a spec; a broken one at its place.
#[test]
fn macros_of_a_source_file() {
    let folder = std::env::temp_dir().join(format!("lie-golden-source-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let source = folder.join("bodies.txt");
    let body = "lie_poisson! {\n    system Body;\n    algebra = so(3);\n    state x, y, z;\n    hamiltonian = x^2 + y^2;\n    methods = [midpoint];\n}\n";
    let named = "lie_poisson! { pub spec = \"../../specs/so3_free_rigid_body.json\"; }";
    std::fs::write(
        &source,
        format!("//! Bodies.\nmod inner {{\n{body}}}\n{named}\n"),
    )
    .unwrap();
    let mut golden = Golden::new(folder.join("golden"));
    golden.source(&source);
    assert_eq!(golden.problems, [""; 0]);
    assert!(
        golden.files["Body.rs"].contains("pub struct BodyMidpoint")
            || golden.files["Body.rs"].contains("struct BodyMidpoint")
    );
    assert!(golden.files["so3_free_rigid_body.rs"].contains("from the declaration of"));
    golden.run(true).unwrap();
    std::fs::write(&source, body.replace("y^2", "y^3")).unwrap();
    let mut other = Golden::new(folder.join("golden"));
    let stale = other.source(&source).run(false).unwrap_err().to_string();
    assert!(stale.contains("Body.rs:"), "{stale}");
    assert!(
        stale.contains("so3_free_rigid_body.rs: no system claims"),
        "{stale}"
    );
    std::fs::write(&source, format!("\n{}", body.replace("y^2", "w^2"))).unwrap();
    let mut broken = Golden::new(folder.join("golden"));
    let stale = broken.source(&source).run(true).unwrap_err().to_string();
    assert!(
        stale.contains("bodies.txt:6:25: error[unknown-symbol]"),
        "{stale}"
    );
    std::fs::write(&source, "fn main() {}").unwrap();
    let stale = Golden::new(folder.join("golden"))
        .source(&source)
        .run(true)
        .unwrap_err();
    assert!(stale.to_string().contains("no declaration"), "{stale}");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_unwrap_prints_says_what_to_do() {
    let folder = std::env::temp_dir().join(format!("lie-golden-help-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let spec = folder.join("broken.json");
    std::fs::write(&spec, "{\n  \"format\": 1,\n  \"hamiltonain\": \"x\"\n}").unwrap();
    let mut golden = Golden::new(&folder);
    golden.text("a.rs", "one\n".into());
    let stale = format!("{:?}", golden.run(false).unwrap_err());
    assert!(
        stale.contains(&format!("\nhelp: set {UPDATE}=1 to write")),
        "{stale}"
    );
    golden.spec(&spec, &["gauss4"]);
    let broken = format!("{:?}", golden.run(false).unwrap_err());
    let place = format!("{}:3:4: error[schema]: ", spec.display());
    assert!(broken.contains(&place), "{broken}");
    assert!(
        broken.contains("\nhelp: did you mean `hamiltonian`?"),
        "{broken}"
    );
    std::fs::remove_dir_all(folder).unwrap();
}
