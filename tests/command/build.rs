//! How `lie run --compile` builds: once, offline first, safely beside others, and what it says if it cannot.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use crate::common::{Run, command, folder, lie, spec};

const FLAGS: [&str; 7] = [
    "--compile",
    "--method",
    "rk4",
    "--step",
    "0.1",
    "--until",
    "0.2",
];

fn run(path: &Path, environment: &[(&str, &Path)]) -> Run {
    let mut command = command(["run".as_ref(), path.as_os_str()]);
    command.args(FLAGS).envs(environment.iter().copied());
    command.output().expect("lie starts").into()
}

/// A program that stands in for cargo.
fn script(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("cargo");
    std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).expect("the script is written");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("it may run");
    path
}

#[test]
fn the_second_run_needs_no_cargo() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["name"] = format!("Once{}", std::process::id()).into()
    });
    let first = run(&path, &[]).ok();
    assert!(
        first.stderr.contains("Building the program of Once"),
        "{}",
        first.stderr
    );
    let broken = script(folder.path(), "exit 1");
    let second = run(&path, &[("CARGO", &broken)]).ok();
    assert!(!second.stderr.contains("Building"), "{}", second.stderr);
    assert_eq!(first.stdout, second.stdout);
    // Another source is another program.
    let other = spec(folder.path(), |spec| {
        spec["name"] = format!("Twice{}", std::process::id()).into()
    });
    assert_eq!(run(&other, &[("CARGO", &broken)]).code, Some(1));
}

/// Without `--compile` nothing is built: neither cargo nor a compiler is asked for.
#[test]
fn a_run_needs_no_toolchain() {
    let folder = folder();
    let nothing = Path::new("/nonexistent/tool");
    for call in [
        "run specs/so3_free_rigid_body.json --until 0.2",
        "verify specs/so3_free_rigid_body.json --methods rk4",
        "run specs/so3_gyrostat_lagrangian.json --until 0.2 --method variational4",
        "run specs/so3_quartic_lagrangian.json --until 0.2 --method variational2",
        "run specs/so3_discrete_lagrangian.json --until 0.2 --method discrete-euler-poincare --retraction cayley",
        "verify specs/so3_quartic_lagrangian.json --methods variational2",
        "run tests/data/declarations/pass/realization.json --until 0.2 --method collective4 --lift spec",
        "verify tests/data/declarations/pass/realization_with_start.json --methods collective2",
        "run tests/data/families/heisenberg_chain.json --until 0.5 --param N=20",
        "verify tests/data/families/lattice.json --methods splitting2 --param M=3",
    ] {
        let mut here = command(call.split(' '));
        here.env("CARGO", nothing)
            .env("RUSTC", nothing)
            .env("PATH", nothing);
        here.env("LIE_CACHE_DIR", folder.path().join("cache"));
        let run: Run = here.output().expect("lie starts").into();
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    }
    let bits = |flags: &str| {
        let call = format!("run specs/se3_heavy_top.json --until 5 --quiet {flags}");
        lie(&call).ok().stdout
    };
    assert_eq!(bits(""), bits("--compile"), "both ways have the same bits");
    assert_ne!(bits(""), bits("--step 0.02"));
}

#[test]
fn no_cargo_and_no_compiler() {
    let folder = folder();
    let path = spec(folder.path(), |spec| spec["name"] = "Nobody".into());
    let out = folder.path().join("out.csv");
    let nothing = Path::new("/nonexistent/tool");
    for variable in ["CARGO", "RUSTC"] {
        let mut call = command([
            "run".as_ref(),
            path.as_os_str(),
            "--compile".as_ref(),
            "--out".as_ref(),
            out.as_os_str(),
        ]);
        call.env(variable, nothing)
            .env("LIE_CACHE_DIR", folder.path().join("cache"));
        let run: Run = call.output().expect("lie starts").into();
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        assert!(run.stderr.contains("error[toolchain]: "), "{}", run.stderr);
        assert!(
            run.stderr.contains("\nhelp: ") && run.stderr.contains("rustup.rs"),
            "{}",
            run.stderr
        );
        assert!(!out.exists(), "nothing was run, nothing is left");
    }
}

#[test]
fn offline_first_then_the_network_then_advice() {
    let folder = folder();
    let path = spec(folder.path(), |spec| spec["name"] = "Remote".into());
    let log = folder.path().join("log");
    let text = format!(
        "echo \"$@\" >> {0}\nenv | grep -E '^(CARGO|RUST)' >> {0}\n\
         echo 'error: no matching package named `nalgebra` found' >&2\nexit 101",
        log.display()
    );
    let cargo = script(folder.path(), &text);
    let cache = folder.path().join("cache with blanks");
    let foreign = Path::new("/foreign");
    let environment = [
        ("CARGO", cargo.as_path()),
        ("LIE_CACHE_DIR", cache.as_path()),
        ("CARGO_TARGET_DIR", foreign),
        ("RUSTFLAGS", Path::new("-Cforeign")),
        ("CARGO_ENCODED_RUSTFLAGS", Path::new("-Cforeign")),
        ("RUSTC_WRAPPER", foreign),
        ("RUSTC_WORKSPACE_WRAPPER", foreign),
        ("CARGO_BUILD_RUSTC_WRAPPER", foreign),
        ("CARGO_BUILD_RUSTFLAGS", foreign),
        ("CARGO_BUILD_TARGET", foreign),
        ("CARGO_PROFILE_RELEASE_OPT_LEVEL", foreign),
        ("CARGO_TERM_COLOR", Path::new("always")),
        ("CARGO_BUILD_JOBS", Path::new("3")),
    ];
    let run = run(&path, &environment);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(
        run.stderr.contains("trying again with the network"),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr.contains("error[toolchain]: cargo failed"),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr.contains("no matching package named `nalgebra`"),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr
            .contains("`cargo fetch --locked --manifest-path "),
        "{}",
        run.stderr
    );
    let log = std::fs::read_to_string(log).expect("cargo was called");
    let calls: Vec<&str> = log
        .lines()
        .filter(|line| line.starts_with("build "))
        .collect();
    assert_eq!(calls.len(), 2, "{log}");
    assert!(
        calls.iter().all(|call| call.contains("--release --locked")),
        "{log}"
    );
    assert!(
        calls[0].contains("--offline") && !calls[1].contains("--offline"),
        "{log}"
    );
    assert!(
        !log.contains("foreign"),
        "the caller's flags stay outside: {log}"
    );
    // an empty wrapper silences one in a configuration file too
    for line in [
        "RUSTC_WRAPPER=",
        "CARGO_BUILD_JOBS=3",
        "CARGO_TERM_COLOR=never",
    ] {
        assert!(log.lines().any(|found| found == line), "{line}: {log}");
    }
}

#[test]
fn a_program_that_does_not_compile_is_not_tried_twice() {
    let folder = folder();
    let path = spec(folder.path(), |spec| spec["name"] = "Broken".into());
    let log = folder.path().join("log");
    let text = format!(
        "echo called >> {}\necho 'error: could not compile `x`' >&2\nexit 101",
        log.display()
    );
    let cargo = script(folder.path(), &text);
    let run = run(
        &path,
        &[
            ("CARGO", &cargo),
            ("LIE_CACHE_DIR", &folder.path().join("cache")),
        ],
    );
    assert_eq!(run.code, Some(1));
    assert!(run.stderr.contains("error[toolchain]"), "{}", run.stderr);
    assert_eq!(
        std::fs::read_to_string(log)
            .expect("cargo was called")
            .lines()
            .count(),
        1
    );
}

#[test]
fn advice_fits_the_failure() {
    let folder = folder();
    let path = spec(folder.path(), |spec| spec["name"] = "Advice".into());
    let cache = folder.path().join("cache");
    for (said, advised) in [
        (
            "error: linker `cc` not found\nerror: could not compile `x`",
            "install a linker",
        ),
        (
            "error: No space left on device (os error 28)",
            "make room for the cache ",
        ),
        ("error: could not compile `x`", "delete the cache folder "),
        ("error: package `x` requires rustc 9.9", "rustup update"),
    ] {
        let cargo = script(folder.path(), &format!("printf '{said}\n' >&2\nexit 101"));
        let run = run(&path, &[("CARGO", &cargo), ("LIE_CACHE_DIR", &cache)]);
        assert_eq!(run.code, Some(1));
        let help = run.stderr.lines().find(|line| line.starts_with("help: "));
        let help = help.expect("a remedy");
        assert!(
            help.contains(advised) && !help.contains("network"),
            "{help}"
        );
        assert!(
            !run.stderr.contains("trying again with the network"),
            "{}",
            run.stderr
        );
    }
}

/// The folder of the only program of a cache.
fn only_program(cache: &Path) -> PathBuf {
    let mut programs = std::fs::read_dir(cache.join("programs")).expect("programs");
    let only = programs.next().expect("a program").expect("a folder");
    assert!(programs.next().is_none());
    only.path()
}

/// The program of a declaration of this name.
fn program_of(name: &str) -> PathBuf {
    let programs =
        std::fs::read_dir(crate::common::cache().join("programs")).expect("the programs");
    let mut folders = programs.flatten().map(|entry| entry.path());
    let folder = folders.find(|folder| {
        let source = std::fs::read_to_string(folder.join("main.rs")).unwrap_or_default();
        source.contains(name)
    });
    folder.expect("the program is there").join("program")
}

/// In place: the copy that cargo keeps may be the same file.
fn damage(path: &Path, change: &dyn Fn(&mut Vec<u8>)) {
    let mut bytes = std::fs::read(path).expect("it is there");
    change(&mut bytes);
    std::fs::write(path, bytes).expect("it is written");
}

/// Truncated, and of its length with other content.
#[test]
#[ignore = "half a minute of builds: .ci/nightly runs it"]
fn a_damaged_program_is_built_again() {
    let folder = folder();
    let name = format!("Damaged{}", std::process::id());
    let path = spec(folder.path(), |spec| spec["name"] = name.clone().into());
    let call = || run(&path, &[]);
    let whole = call().ok();
    let program = program_of(&name);
    for change in [
        &(|bytes: &mut Vec<u8>| bytes.truncate(5000)) as &dyn Fn(&mut Vec<u8>),
        &|bytes| bytes.clear(),
        &|bytes| bytes[3000..4000].fill(0),
    ] {
        damage(&program, change);
        let run = call().ok();
        assert!(run.stderr.contains("Building"), "{}", run.stderr);
        assert_eq!(run.stdout, whole.stdout);
        assert!(!call().ok().stderr.contains("Building"), "once");
    }
}

#[test]
#[ignore = "a minute, it builds the packages of programs twice: .ci/nightly runs it"]
fn a_damaged_cache_heals_itself_and_has_a_limit() {
    let folder = folder();
    let cache = folder.path().join("cache");
    heals_itself(folder.path(), &cache);
    has_a_limit(folder.path(), &cache);
}

/// A source of the runtime is damaged, and then the program.
fn heals_itself(folder: &Path, cache: &Path) {
    let path = spec(folder, |_| ());
    let call = || run(&path, &[("LIE_CACHE_DIR", cache)]);
    let whole = call().ok();
    let program = only_program(cache).join("program");
    let runtime = std::fs::read_dir(cache.join("runtime")).expect("the runtime");
    let runtime = runtime.flatten().next().expect("a version").path();
    damage(&runtime.join("lie-runtime/src/lib.rs"), &|bytes| {
        bytes.truncate(100)
    });
    damage(&program, &|bytes| bytes.clear());
    assert_eq!(call().ok().stdout, whole.stdout);
}

/// Beyond the limit of the cache everything goes but the program just built; a limit that is no number is refused before
/// anything is built.
fn has_a_limit(folder: &Path, cache: &Path) {
    let path = spec(folder, |spec| spec["name"] = "Last".into());
    let cargo = script(folder, "exit 1");
    let wrong = [
        ("LIE_CACHE_DIR", cache),
        ("LIE_CACHE_MB", Path::new("2 GB")),
        ("CARGO", &cargo),
    ];
    let refused = run(&path, &wrong);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(
        refused.stderr.contains("LIE_CACHE_MB is `2 GB`"),
        "{}",
        refused.stderr
    );
    let small = [("LIE_CACHE_DIR", cache), ("LIE_CACHE_MB", Path::new("1"))];
    let built = run(&path, &small).ok();
    assert!(built.stderr.contains("Building"), "{}", built.stderr);
    assert!(!cache.join("target").exists(), "the packages went");
    only_program(cache);
    let again = run(&path, &[small[0], ("CARGO", cargo.as_path())]).ok();
    assert_eq!(again.stdout, built.stdout, "the program stayed");
}

#[test]
fn a_program_that_dies_names_its_folder() {
    let folder = folder();
    let path = spec(folder.path(), |_| ());
    let cache = folder.path().join("cache");
    // what cargo reports as the program cannot be started, or ends at once
    let fake = folder.path().join("fake");
    for (text, said) in [
        ("no program", "cannot be started"),
        ("#!/bin/sh\nexit 9\n", "failed"),
    ] {
        std::fs::write(&fake, text).expect("the program is written");
        let mode = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(&fake, mode).expect("it may run");
        let name = "sed -n 's/^name = \"\\(lie-[0-9a-f]*\\)\"/\\1/p' Cargo.toml";
        let message = format!(
            "printf '{{\"target\":{{\"name\":\"%s\"}},\"executable\":\"{}\"}}\\n' \"$({name})\"",
            fake.display()
        );
        let cargo = script(folder.path(), &message);
        let _ = std::fs::remove_dir_all(cache.join("programs"));
        let run = run(&path, &[("LIE_CACHE_DIR", &cache), ("CARGO", &cargo)]);
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        assert!(
            run.stderr.contains("error[toolchain]: the built program "),
            "{}",
            run.stderr
        );
        assert!(run.stderr.contains(said), "{}", run.stderr);
        let help = format!("delete its folder {}", only_program(&cache).display());
        assert!(run.stderr.contains(&help), "{}", run.stderr);
    }
}

#[test]
fn a_cache_that_others_may_write_is_refused() {
    let folder = folder();
    let path = spec(folder.path(), |_| ());
    let cache = folder.path().join("cache");
    let nothing = Path::new("/nonexistent/tool");
    let call = || run(&path, &[("LIE_CACHE_DIR", &cache), ("CARGO", nothing)]);
    // made by the command, it is the user's alone
    assert!(call().stderr.contains("error[toolchain]"));
    let mode = |path: &Path| {
        std::fs::metadata(path)
            .expect("the cache")
            .permissions()
            .mode()
    };
    assert_eq!(mode(&cache) & 0o777, 0o700);
    let set = |mode| {
        let mode = std::fs::Permissions::from_mode(mode);
        std::fs::set_permissions(&cache, mode).expect("it is ours");
    };
    for (mode, refused) in [(0o777, true), (0o702, true), (0o775, false), (0o755, false)] {
        set(mode);
        let run = call();
        assert_eq!(run.code, Some(1));
        assert_eq!(
            run.stderr.contains("error[io]: every user can write"),
            refused,
            "{}",
            run.stderr
        );
        let advice = format!("`chmod o-w {}`", cache.display());
        assert_eq!(run.stderr.contains(&advice), refused, "{}", run.stderr);
    }
    // that of another user, where this one may give folders away
    if std::os::unix::fs::chown(&cache, Some(12_345), None).is_ok() {
        let run = call();
        assert!(
            run.stderr.contains("belongs to another user"),
            "{}",
            run.stderr
        );
        assert!(run.stderr.contains("LIE_CACHE_DIR"), "{}", run.stderr);
    }
}

#[test]
fn two_runs_at_once() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["name"] = format!("Pair{}", std::process::id()).into()
    });
    let runs: Vec<Run> = std::thread::scope(|scope| {
        let both: Vec<_> = (0..2).map(|_| scope.spawn(|| run(&path, &[]))).collect();
        both.into_iter()
            .map(|one| one.join().expect("no panic").ok())
            .collect()
    });
    assert_eq!(runs[0].stdout, runs[1].stdout);
    let built = runs
        .iter()
        .filter(|run| run.stderr.contains("Built in"))
        .count();
    assert_eq!(built, 1, "one waits for the other: {runs:?}");
}

#[test]
fn a_cache_that_cannot_be_used() {
    let folder = folder();
    let path = spec(folder.path(), |_| ());
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("the file is written");
    let run = run(&path, &[("LIE_CACHE_DIR", &file.join("cache"))]);
    assert_eq!(run.code, Some(1));
    assert!(run.says("io", "").stderr.contains("LIE_CACHE_DIR"));
}

#[test]
fn the_lock_file_has_the_versions_of_the_workspace() {
    let packages = |path: &str| -> Vec<(String, String)> {
        let text = std::fs::read_to_string(path).expect("the lock file is there");
        let value = |block: &str, key: &str| {
            let line = block
                .lines()
                .find_map(|line| line.strip_prefix(key)?.strip_prefix(" = \""));
            line.map(|value| value.trim_end_matches('"').to_owned())
                .unwrap_or_default()
        };
        let blocks = text.split("[[package]]").skip(1);
        blocks
            .map(|block| (value(block, "name"), value(block, "version")))
            .collect()
    };
    let workspace = packages("Cargo.lock");
    let template = packages("src/build/template/Cargo.lock");
    assert!(
        template.iter().any(|(name, _)| name == "nalgebra"),
        "it lists something"
    );
    for package in template.iter().filter(|(name, _)| name != "generated") {
        assert!(
            workspace.contains(package),
            "{package:?}: run with LIE_UPDATE_LOCK=1"
        );
    }
    // the programs that measure have the same, those of `lie bench` with what the controls need
    for (folder, more) in [("measure", "lie-measure"), ("bench", "ode_solvers")] {
        let measuring = packages(&format!("src/build/template/{folder}/Cargo.lock"));
        assert!(measuring.iter().any(|(name, _)| name == more));
        for package in &template {
            assert!(
                measuring.contains(package),
                "{package:?}: run with LIE_UPDATE_LOCK=1"
            );
        }
    }
}

#[test]
fn ordinary_runs_leave_no_drafts_behind() {
    lie("run specs/so3_free_rigid_body.json --compile --quiet --method rk4 --step 0.1 --until 0.2")
        .ok();
    for folder in ["", "runtime"] {
        for entry in std::fs::read_dir(crate::common::cache().join(folder))
            .into_iter()
            .flatten()
            .flatten()
        {
            let name = entry.file_name().to_string_lossy().into_owned();
            assert!(!name.starts_with(".tmp"), "{name}");
        }
    }
}

#[test]
fn to_show_the_cache_does_not_make_it() {
    let folder = folder();
    let cache = folder.path().join("none/cache");
    let mut show = crate::common::command(["cache"]);
    let output = show
        .env("LIE_CACHE_DIR", &cache)
        .output()
        .expect("lie runs");
    assert!(output.status.success());
    let stdout = String::from_utf8_lossy(&output.stdout);
    assert!(stdout.contains("0 programs, 0.0 MB in total"), "{stdout}");
    assert!(
        stdout
            .lines()
            .all(|line| line.chars().count() <= 100 || line.starts_with('/'))
    );
    assert!(!cache.exists() && !folder.path().join("none").exists());
}

/// A project holds all that it needs, and nothing is written over.
#[test]
fn a_project_is_written_into_an_empty_folder() {
    let folder = folder();
    let place = folder.path().join("body");
    let call = format!(
        "expand specs/so3_free_rigid_body.json --project {}",
        place.display()
    );
    let said = lie(&call).ok().stdout;
    assert!(said.contains("cargo run --release"), "{said}");
    let read = |file: &str| std::fs::read_to_string(place.join(file)).expect("the file is there");
    let (main, system, manifest) = (
        read("src/main.rs"),
        read("src/system.rs"),
        read("Cargo.toml"),
    );
    assert!(
        main.contains("solve(&problem, ImplicitMidpoint, "),
        "{main}"
    );
    assert!(system.contains("pub struct FreeRigidBody"));
    assert!(manifest.contains("runtime/lie-runtime"));
    let mut cargo = std::process::Command::new("cargo");
    cargo.args(["metadata", "--no-deps", "--format-version", "1"]);
    let output = cargo.current_dir(&place).output().expect("cargo starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(read("runtime/lie-runtime/Cargo.toml").contains("../lie-core"));
    assert!(
        !place.join("runtime/lie-program").exists(),
        "what is not needed is left out"
    );
    let again = lie(&call);
    assert_eq!(again.code, Some(1));
    assert!(
        again.stderr.contains("a folder that is new or empty"),
        "{}",
        again.stderr
    );
    assert_eq!(read("src/main.rs"), main);
    assert_eq!(lie(&format!("{call} --plan")).code, Some(2));
}

/// The project integrates as the spec's `run` says, with its tolerances and what it keeps.
#[test]
fn a_project_has_the_options_of_the_run() {
    let folder = folder();
    let spec = folder.path().join("kept.json");
    let text = std::fs::read_to_string("specs/so3_free_rigid_body.json").unwrap();
    let mut text: serde_json::Value = serde_json::from_str(&text).unwrap();
    text["run"] = serde_json::json!({
        "method": "dopri5", "step": 0.5, "until": 1, "rtol": 1e-4, "keep": "energy,casimirs"
    });
    std::fs::write(&spec, text.to_string()).unwrap();
    let place = folder.path().join("project");
    lie(&format!(
        "expand {} --project {}",
        spec.display(),
        place.display()
    ))
    .ok();
    let main = std::fs::read_to_string(place.join("src/main.rs")).unwrap();
    text["run"] = serde_json::json!({
        "method": "gauss16", "step": 0.5, "until": 1, "density": "reversible"
    });
    let steered = folder.path().join("steered.json");
    std::fs::write(&steered, text.to_string()).unwrap();
    let other = folder.path().join("other");
    lie(&format!(
        "expand {} --project {}",
        steered.display(),
        other.display()
    ))
    .ok();
    let steered = std::fs::read_to_string(other.join("src/main.rs")).unwrap();
    assert!(
        steered.contains("Options::new(0.5).reversible()"),
        "{steered}"
    );
    for part in [
        "Dopri5::from(Tolerances { rtol: 0.0001, atol: 1e-9 })",
        ".keep(Keep { energy: true, casimirs: true })",
    ] {
        assert!(main.contains(part), "{main}");
    }
}

/// What it computes has the bits of `lie run`.
#[test]
#[ignore = "a minute, it builds the runtime again: .ci/nightly runs it"]
fn a_project_computes_what_the_command_does() {
    let folder = folder();
    for (name, spec, options) in [
        ("body", "so3_free_rigid_body", "--method gauss4"),
        ("spin", "so3_nonpolynomial", "--method taylor"),
    ] {
        let place = folder.path().join(name);
        let spec = format!("specs/{spec}.json {options}");
        lie(&format!("expand {spec} --project {}", place.display())).ok();
        let mut cargo = std::process::Command::new("cargo");
        cargo.args(["run", "--quiet"]).current_dir(&place);
        cargo.env("CARGO_TARGET_DIR", folder.path().join("target"));
        let output = cargo.output().expect("cargo starts");
        let run = lie(&format!("run {spec} --quiet")).ok();
        let written = String::from_utf8(output.stdout).expect("text");
        assert!(
            written == run.stdout,
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}
