//! Ends of `lie run` that nobody planned: signals, a kill, a reader that goes away, a disk that is full.

use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::common::{Run, command, csv, folder};
use crate::process::{Terminal, ended, signal, wait, wait_for_bytes};

/// A run of months.
const LONG: &str = "run specs/so3_free_rigid_body.json --method midpoint --step 0.001 --until 1e9";

/// Starts a run of months that writes to a file, and waits for so many bytes.
#[track_caller]
fn start(out: &Path, flags: &str, bytes: u64) -> Child {
    let call = format!("{LONG} {flags} --out {}", out.display());
    let mut command = command(call.split_whitespace());
    let child = crate::process::start(command.stderr(Stdio::piped()));
    wait_for_bytes(out, bytes);
    child
}

/// A call of `lie` by a script of the shell, as `"$0"`, with a file as `"$1"`.
fn shell(script: &str, out: &Path) -> Command {
    let mut shell = Command::new("sh");
    shell
        .args(["-c", script, env!("CARGO_BIN_EXE_lie")])
        .arg(out)
        .env("LIE_CACHE_DIR", crate::common::cache())
        .current_dir(env!("CARGO_MANIFEST_DIR"));
    shell
}

/// Fails unless a signal has ended it with this exit code, which it says.
#[track_caller]
fn interrupted(run: &Run, code: i32) {
    assert_eq!(run.code, Some(code), "{}", run.stderr);
    assert!(run.stderr.contains("Interrupted"), "{}", run.stderr);
}

/// The processes whose parent is this one.
#[cfg(target_os = "linux")]
fn children(of: u32) -> Vec<String> {
    let path = format!("/proc/{of}/task/{of}/children");
    let mut all = std::fs::read_to_string(path).unwrap_or_default();
    for entry in std::fs::read_dir(format!("/proc/{of}/task"))
        .into_iter()
        .flatten()
        .flatten()
    {
        all += &std::fs::read_to_string(entry.path().join("children")).unwrap_or_default();
    }
    all.split_whitespace().map(str::to_owned).collect()
}

#[track_caller]
fn whole_rows(out: &Path) -> usize {
    let text = std::fs::read_to_string(out).expect("the rows are there");
    assert!(text.ends_with('\n'), "half a row at the end");
    count_rows(&text)
}

/// As [`whole_rows`], after a kill: a row that lies across two pages of the file is written by one call, within which
/// the kernel may end the process after the first page. A row that ends anywhere else was cut by us.
#[track_caller]
fn rows_after_a_kill(out: &Path) -> usize {
    let text = std::fs::read_to_string(out).expect("the rows are there");
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let cut = text.len() - whole;
    assert!(cut == 0 || text.len().is_multiple_of(4096), "a row is cut");
    count_rows(&text[..whole])
}

#[track_caller]
fn count_rows(text: &str) -> usize {
    let (header, rows) = csv(text);
    assert!(rows.iter().all(|row| row.len() == header.len()));
    assert!(rows.windows(2).all(|pair| pair[1][0] > pair[0][0]));
    rows.len()
}

/// `timeout` signals the command and then its group.
#[test]
fn two_signals_at_once_are_one() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let plot = folder.path().join("rows.svg");
    let child = start(&out, &format!("--plot {}", plot.display()), 10_000);
    signal(child.id(), "-INT");
    signal(child.id(), "-INT");
    interrupted(&ended(child), 130);
    let svg = std::fs::read_to_string(&plot).expect("a picture");
    assert!(svg.trim_end().ends_with("</svg>"), "it is whole");
}

#[test]
#[cfg(target_os = "linux")]
fn a_kill_keeps_whole_rows_and_ends_the_program() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let child = start(&out, "--compile", 10_000);
    let programs = children(child.id());
    assert_eq!(programs.len(), 1, "the built program runs");
    signal(child.id(), "-KILL");
    ended(child);
    wait("end of the program", || gone(&programs));
    assert!(rows_after_a_kill(&out) > 10);
}

/// The rows that an array's header counts and the bytes behind it.
#[track_caller]
fn array(out: &Path) -> (usize, Vec<f64>) {
    let bytes = std::fs::read(out).expect("the rows are there");
    let head = String::from_utf8_lossy(&bytes[..128]).into_owned();
    let shape = head.split("'shape': (").nth(1);
    let count = shape.and_then(|rest| rest.split(',').next()?.parse().ok());
    let numbers = bytes[128..]
        .chunks_exact(8)
        .map(|eight| f64::from_le_bytes(eight.try_into().expect("eight bytes")));
    (count.expect("a count"), numbers.collect())
}

/// Columns of the rigid body: t, three coordinates, energy, C.
const WIDTH: usize = 6;

#[test]
fn an_array_counts_its_rows_also_after_a_kill() {
    for bytes in [10_000, 20_000, 300_000, 2_000_000, 7_000_000] {
        let folder = folder();
        let out = folder.path().join("rows.npy");
        let child = start(&out, "", bytes);
        signal(child.id(), "-KILL");
        ended(child);
        let (count, numbers) = array(&out);
        let rows = numbers.len() / WIDTH;
        // what a program sends at once, it counts at once
        assert!(
            count > 10 && count <= rows && rows - count < 2000,
            "{count} of {rows}"
        );
        for (k, row) in numbers.chunks_exact(WIDTH).take(count).enumerate() {
            assert_eq!(row[0], k as f64 * 0.001);
        }
    }
}

#[test]
fn every_signal_ends_every_form_in_order() {
    for (name, code) in [("-TERM", 143), ("-HUP", 129), ("-INT", 130)] {
        for form in ["csv", "json", "npy"] {
            let folder = folder();
            let out = folder.path().join(format!("rows.{form}"));
            let child = start(&out, "", 10_000);
            signal(child.id(), name);
            let run = ended(child);
            interrupted(&run, code);
            assert!(run.stderr.contains("Interrupted at t = "), "{run:?}");
            match form {
                "csv" => assert!(whole_rows(&out) > 10),
                "json" => {
                    let json = json(&out);
                    assert_eq!(json["status"], "interrupted");
                    assert!(json["rows"].as_array().is_some_and(|rows| rows.len() > 10));
                }
                _ => {
                    let (count, numbers) = array(&out);
                    assert_eq!(count * WIDTH, numbers.len());
                }
            }
        }
    }
}

#[track_caller]
fn json(out: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(out).expect("the rows are there");
    serde_json::from_str(&text).expect("it is JSON")
}

#[test]
fn a_run_that_shall_outlive_its_terminal_does() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let script = format!("trap '' HUP; exec \"$0\" {LONG} --out \"$1\"");
    let child = crate::process::start(shell(&script, &out).stderr(Stdio::null()));
    wait_for_bytes(&out, 10_000);
    signal(child.id(), "-HUP");
    let length = std::fs::metadata(&out).expect("the rows").len();
    wait_for_bytes(&out, length + 100_000);
    signal(child.id(), "-TERM");
    assert_eq!(ended(child).code, Some(143));
}

/// Runs with files of at most so many units of 512 or 1024 bytes, as the shell counts.
fn limited(out: &Path, units: u32) -> Run {
    let script = format!("ulimit -f {units}; exec \"$0\" {LONG} --quiet --out \"$1\"");
    let mut shell = shell(&script, out);
    ended(crate::process::start(shell.stderr(Stdio::piped())))
}

#[test]
fn a_file_that_cannot_grow_is_whole_as_far_as_it_goes() {
    for units in [1, 7, 100] {
        let folder = folder();
        let out = |form: &str| folder.path().join(format!("rows.{form}"));
        for form in ["csv", "json", "npy"] {
            let run = limited(&out(form), units);
            assert_eq!(run.code, Some(1), "{form}: {run:?}");
            assert!(
                run.says("io", "").stderr.contains("the whole rows so far"),
                "{form}"
            );
        }
        let rows = whole_rows(&out("csv"));
        assert!(rows > 2);
        let json = json(&out("json"));
        assert_eq!(json["status"], "failed");
        let written = json["rows"].as_array().map_or(0, Vec::len);
        assert!(written > 0, "{json}");
        let (count, numbers) = array(&out("npy"));
        assert_eq!(numbers.len(), count * WIDTH, "header and rows agree");
        // the limit is used
        let length = std::fs::metadata(out("npy")).expect("the rows").len();
        assert!(length + 4096 > 512 * u64::from(units), "{length}");
    }
}

/// The built programs among the children.
#[cfg(target_os = "linux")]
fn programs(of: u32) -> Vec<String> {
    let is_program = |id: &String| {
        std::fs::read_link(format!("/proc/{id}/exe"))
            .is_ok_and(|path| path.to_string_lossy().contains("/programs/"))
    };
    children(of).into_iter().filter(is_program).collect()
}

#[cfg(target_os = "linux")]
fn gone(programs: &[String]) -> bool {
    programs.iter().all(|id| {
        let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
        status.is_empty() || status.contains("State:\tZ")
    })
}

#[test]
#[cfg(target_os = "linux")]
#[ignore = "half a minute, it builds three programs: .ci/nightly runs it"]
fn measuring_programs_end_with_the_command() {
    let body = "specs/so3_free_rigid_body.json --compile --quiet --methods gonzalez";
    for call in [
        format!("stress {body} --steps 1e15"),
        format!("bench {body} --until 1e4 --budget 1e6"),
        "verify specs/so3_nonpolynomial.json --compile --quiet --methods midpoint,lie-midpoint,rk4,dopri5".to_owned(),
    ] {
        for (name, code) in [("-TERM", Some(143)), ("-HUP", Some(129)), ("-KILL", None)] {
            let mut command = command(call.split_whitespace());
            let child = crate::process::start(command.stdout(Stdio::null()).stderr(Stdio::null()));
            wait("program", || programs(child.id()).len() == 1);
            let programs = programs(child.id());
            // `verify` is done soon: it waits until the signal is there
            signal(&programs[0], "-STOP");
            signal(child.id(), name);
            signal(&programs[0], "-CONT");
            assert_eq!(ended(child).code, code, "{call} {name}");
            wait("end of the program", || gone(&programs));
        }
    }
}

/// The same where the command measures by itself.
#[test]
fn measurements_end_with_the_command() {
    let body = "specs/so3_free_rigid_body.json";
    for (call, long, stage) in [
        ("stress", "--methods gonzalez --steps 1e15", "experiments"),
        // all methods: each run is short, and all of them are long
        ("bench", "--until 100 --budget 0.5", "gauss4, step"),
    ] {
        let mut command = command(format!("{call} {body} {long}").split_whitespace());
        command.stdout(Stdio::null());
        let (child, terminal) = Terminal::start(command);
        terminal.wait(stage, |text| text.contains(stage));
        signal(child.id(), "-TERM");
        assert_eq!(ended(child).code, Some(143), "{call}");
        let text = terminal.text();
        assert!(text.contains("Interrupted"), "{call}: {text}");
    }
}

/// What is missing from a measurement cannot have failed.
#[test]
fn an_interrupted_verification_says_so_in_json() {
    let mut command = command("verify specs/se3_heavy_top.json --json".split(' '));
    command.stdout(Stdio::piped());
    let (child, terminal) = Terminal::start(command);
    let second = "gauss4, ";
    terminal.wait("second method", |text| text.contains(second));
    signal(child.id(), "-INT");
    let run = ended(child);
    assert_eq!(run.code, Some(130), "{}", terminal.text());
    let value: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(value["interrupted"], true);
}

/// Below this step a run of the rigid body to t = 100 takes a second.
const SHORT: f64 = 4e-5;

/// The step of the run that a benchmark has said last to be at.
fn latest_step(shown: &str) -> Option<f64> {
    let (_, rest) = shown.rsplit_once("midpoint, step ")?;
    let end = rest.find(|c: char| !(c.is_ascii_digit() || ".e-".contains(c)))?;
    rest[..end].parse().ok()
}

/// Each run of the ladder takes twice as long as the one before, up to days: the signal meets one of a second, after which
/// there are none.
#[test]
fn one_long_run_of_a_benchmark_is_cut_short_and_those_before_it_are_kept() {
    let folder = folder();
    let out = folder.path().join("points.csv");
    let plot = folder.path().join("p.svg");
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
        let call = format!(
            "bench specs/so3_free_rigid_body.json --methods midpoint,gonzalez --until 100 --budget 1e9 --out {} --plot {}",
            out.display(),
            plot.display()
        );
        let mut command = command(call.split_whitespace());
        command.stdout(Stdio::piped());
        let (child, terminal) = Terminal::start(command);
        terminal.wait("long run", |text| {
            latest_step(text).is_some_and(|step| step < SHORT)
        });
        signal(child.id(), name);
        let mut run = ended(child);
        run.stderr = terminal.text();
        interrupted(&run, code);
        let text = std::fs::read_to_string(&out).expect("points");
        let points: Vec<(f64, f64)> = text
            .lines()
            .filter_map(|line| line.strip_prefix("midpoint,step,"))
            .filter_map(|line| {
                let (step, rest) = line.split_once(',')?;
                Some((step.parse().ok()?, rest.split(',').next()?.parse().ok()?))
            })
            .collect();
        // of order 2, up to the run that was met
        assert!(points.len() > 6, "{text}");
        let ratio = points[5].1 / points[6].1;
        assert!((3.0..5.0).contains(&ratio), "{text}");
        assert!(points.iter().all(|(step, _)| *step > SHORT / 2.0), "{text}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        let lines = run.stdout.lines();
        let of_midpoint = lines.filter(|line| line.starts_with("midpoint "));
        assert_eq!(of_midpoint.count(), 1, "{}", run.stdout);
        let svg = std::fs::read_to_string(&plot).expect("a picture");
        assert!(svg.trim_end().ends_with("</svg>"));
    }
}

/// The reference solution, of hours, does not look for signals.
#[test]
fn what_does_not_end_is_left_behind() {
    let call =
        "bench tests/data/families/heisenberg_chain.json --param N=10000 --methods rk4 --until 1e6";
    let mut command = command(call.split_whitespace());
    command.stdout(Stdio::null());
    let (child, terminal) = Terminal::start(command);
    let stage = "the reference solution";
    terminal.wait(stage, |text| text.contains(stage));
    signal(child.id(), "-TERM");
    assert_eq!(ended(child).code, Some(143));
    let text = terminal.text();
    assert!(text.contains("Interrupted"), "{text}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_signal_ends_the_build() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = folder();
    let spec = crate::common::spec(folder.path(), |spec| spec["name"] = "Slow".into());
    let cargo = folder.path().join("cargo");
    std::fs::write(&cargo, "#!/bin/sh\nsleep 1000 &\nwait\n").expect("the script is written");
    let mode = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(&cargo, mode).expect("it may run");
    let out = folder.path().join("rows.csv");
    let arguments = [
        "run".as_ref(),
        spec.as_os_str(),
        "--compile".as_ref(),
        "--out".as_ref(),
        out.as_os_str(),
    ];
    let mut command = command(arguments);
    command
        .env("CARGO", &cargo)
        .env("LIE_CACHE_DIR", folder.path().join("cache"));
    let child = crate::process::start(command.stderr(Stdio::null()));
    let of_cargo = || -> Vec<String> {
        let ids = children(child.id())
            .into_iter()
            .filter_map(|id| id.parse().ok());
        ids.flat_map(children).collect()
    };
    let sleeps = |id: &String| {
        let name = std::fs::read_to_string(format!("/proc/{id}/comm")).unwrap_or_default();
        name.trim() == "sleep"
    };
    wait("cargo", || of_cargo().iter().any(sleeps));
    let started = of_cargo();
    signal(child.id(), "-TERM");
    assert_eq!(ended(child).code, Some(143));
    wait("end of what cargo started", || gone(&started));
    assert!(!out.exists(), "nothing was run, nothing is left");
}

#[test]
fn a_reader_that_goes_away_ends_the_run_quietly() {
    let mut command = command(LONG.split(' '));
    let mut child = crate::process::start(command.stdout(Stdio::piped()).stderr(Stdio::piped()));
    let mut first = [0; 100];
    let mut stdout = child.stdout.take().expect("a pipe");
    stdout.read_exact(&mut first).expect("some rows");
    drop(stdout);
    let run = ended(child);
    assert_eq!(run.code, Some(0));
    assert!(
        !run.stderr.contains("error") && !run.stderr.contains("panicked"),
        "{run:?}"
    );
}
