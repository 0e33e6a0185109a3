//! `lie new` and `lie cache`.

use crate::common::{Run, command, folder};

/// Runs `lie` in a folder.
fn lie_in(folder: &std::path::Path, arguments: &[&str]) -> Run {
    let mut command = command(arguments.iter().copied());
    let command = command
        .current_dir(folder)
        .env("LIE_CACHE_DIR", folder.join("cache"));
    command.output().expect("lie starts").into()
}

#[test]
fn what_is_written_runs() {
    for algebra in [
        "so(3)",
        "so(4)",
        "so(2,1)",
        "su(2)",
        "su(3)",
        "sl(2)",
        "gl(2)",
        "sp(2)",
        "se(2)",
        "se(3)",
        "heisenberg(1)",
        "aff(1)",
        "so(3) + R^2",
        "so(3)^2",
        "semidirect(so(3), R^3)",
        "galilei(3)",
        "poincare(2)",
    ] {
        let folder = folder();
        let made = lie_in(folder.path(), &["new", "first_try", "--algebra", algebra]).ok();
        assert!(
            made.stdout.contains("next: lie run first_try.json"),
            "{}",
            made.stdout
        );
        let run = lie_in(folder.path(), &["run", "first_try.json", "--until", "0.1"]).ok();
        assert!(
            run.stderr.contains("FirstTry, lie-midpoint"),
            "{algebra}: {}",
            run.stderr
        );
        let rows = run.csv().1;
        assert!(rows.len() > 3, "{algebra}");
        // a body that rests shows nothing; abelian summands do
        let moved = rows[0]
            .iter()
            .zip(&rows[rows.len() - 1])
            .skip(1)
            .any(|(a, b)| a != b);
        assert!(moved, "{algebra}");
    }
}

#[test]
fn what_comes_next_can_be_typed() {
    let folder = folder();
    let made = lie_in(folder.path(), &["new", "my top's body"]).ok();
    let next = made
        .stdout
        .lines()
        .find_map(|line| line.strip_prefix("next: lie "));
    let next = next.expect("what comes next");
    assert_eq!(
        next,
        r"run 'my top'\''s body.json' --plot 'my top'\''s body.svg'"
    );
    let words = ["run", "my top's body.json", "--until", "0.1"];
    lie_in(folder.path(), &words).ok();
}

#[test]
fn nothing_is_overwritten_and_mistakes_have_a_remedy() {
    let folder = folder();
    lie_in(folder.path(), &["new", "body"]).ok();
    let before = std::fs::read(folder.path().join("body.json")).expect("the spec");
    let again = lie_in(folder.path(), &["new", "body", "--algebra", "se(3)"]);
    assert_eq!(again.code, Some(1), "{}", again.stderr);
    assert!(
        again.stderr.contains("help: choose another name"),
        "{}",
        again.stderr
    );
    assert_eq!(
        std::fs::read(folder.path().join("body.json")).expect("the spec"),
        before
    );
    let wrong = lie_in(folder.path(), &["new", "other", "--algebra", "so(three)"]);
    assert_eq!(wrong.code, Some(2), "{}", wrong.stderr);
    assert!(
        wrong.stderr.contains("--> command line: --algebra"),
        "{}",
        wrong.stderr
    );
    assert!(wrong.stderr.contains("help: "), "{}", wrong.stderr);
    assert_eq!(lie_in(folder.path(), &["new", "7"]).code, Some(2));
    let hyphen = lie_in(folder.path(), &["new", "--", "-x"]);
    assert_eq!(hyphen.code, Some(2), "{}", hyphen.stderr);
    assert!(hyphen.stderr.contains("help: "), "{}", hyphen.stderr);
    assert!(!folder.path().join("-x.json").exists());
    assert!(!folder.path().join("other.json").exists());
}

#[test]
fn the_cache_is_shown_and_emptied() {
    let folder = folder();
    let program = folder.path().join("cache/programs/key");
    std::fs::create_dir_all(&program).expect("a folder");
    std::fs::write(program.join("program"), vec![0; 3_000_000]).expect("a file");
    let shown = lie_in(folder.path(), &["cache"]).ok();
    assert!(
        shown.stdout.contains("1 program, 3.0 MB"),
        "{}",
        shown.stdout
    );
    lie_in(folder.path(), &["cache", "--clear"]).ok();
    assert!(!program.exists());
    let empty = lie_in(folder.path(), &["cache"]).ok();
    assert!(
        empty.stdout.contains("0 programs, 0.0 MB"),
        "{}",
        empty.stdout
    );
}
