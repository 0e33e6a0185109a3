//! Ends of `lie run` that nobody planned: signals, a kill, a reader that goes away, a disk that is full.
#![cfg(unix)]

mod common;

use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::{command, csv, folder, lie};

const LONG: &str = "run specs/so3_free_rigid_body.json --method midpoint --step 0.001 --until 1e9";

/// Starts a run of a month that writes to a file, and waits for its first rows.
fn start(out: &Path, flags: &str) -> Child {
    // Built beforehand, so that the signal meets the run and not cargo.
    lie("run specs/so3_free_rigid_body.json --quiet --method midpoint --step 0.1 --until 0.1").ok();
    let call = format!("{LONG} {flags} --out {}", out.display());
    let mut command = command(call.split_whitespace());
    let child = command.stderr(Stdio::piped()).spawn().expect("lie starts");
    wait("rows", || {
        std::fs::metadata(out).is_ok_and(|file| file.len() > 10_000)
    });
    child
}

fn wait(what: &str, done: impl Fn() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "no {what} within a minute"
        );
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(status.is_ok_and(|status| status.success()), "kill {name}");
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

#[test]
fn control_c_keeps_the_rows() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let child = start(&out, "");
    signal(&child, "-INT");
    let output = child.wait_with_output().expect("lie ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("Interrupted at t = "), "{stderr}");
    assert!(whole_rows(&out) > 10);
}

/// `timeout` signals the command and then its group.
#[test]
fn two_signals_at_once_are_one() {
    let folder = folder();
    let (out, plot) = (
        folder.path().join("rows.csv"),
        folder.path().join("rows.svg"),
    );
    let child = start(&out, &format!("--plot {}", plot.display()));
    signal(&child, "-INT");
    signal(&child, "-INT");
    let output = child.wait_with_output().expect("lie ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("Interrupted at t = "), "{stderr}");
    let svg = std::fs::read_to_string(&plot).expect("a picture");
    assert!(svg.trim_end().ends_with("</svg>"), "it is whole");
}

#[test]
#[cfg(target_os = "linux")]
fn a_kill_keeps_whole_rows_and_ends_the_program() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let mut child = start(&out, "--compile");
    let programs = children(child.id());
    assert_eq!(programs.len(), 1, "the built program runs");
    signal(&child, "-KILL");
    child.wait().expect("lie ends");
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
    for delay in [0, 3, 50, 170, 310] {
        let folder = folder();
        let out = folder.path().join("rows.npy");
        let mut child = start(&out, "");
        std::thread::sleep(Duration::from_millis(delay));
        signal(&child, "-KILL");
        child.wait().expect("lie ends");
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
            let child = start(&out, "");
            signal(&child, name);
            let output = child.wait_with_output().expect("lie ends");
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(code), "{name} {stderr}");
            assert!(stderr.contains("Interrupted at t = "), "{stderr}");
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
    lie("run specs/so3_free_rigid_body.json --quiet --method midpoint --step 0.1 --until 0.1").ok();
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let text = format!("trap '' HUP; exec \"$0\" {LONG} --out \"$1\"");
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &text, env!("CARGO_BIN_EXE_lie")])
        .arg(&out)
        .env("LIE_CACHE_DIR", common::cache())
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stderr(Stdio::null());
    let mut child = shell.spawn().expect("a shell");
    let length = || std::fs::metadata(&out).map_or(0, |file| file.len());
    wait("rows", || length() > 10_000);
    signal(&child, "-HUP");
    let before = length();
    wait("more rows", || length() > before + 100_000);
    signal(&child, "-TERM");
    assert_eq!(child.wait().expect("lie ends").code(), Some(143));
}

/// Runs with files of at most so many units of 512 or 1024 bytes, as the shell counts.
fn limited(out: &Path, units: u32) -> common::Run {
    lie("run specs/so3_free_rigid_body.json --quiet --method midpoint --step 0.1 --until 0.1").ok();
    let text = format!("ulimit -f {units}; exec \"$0\" {LONG} --quiet --out \"$1\"");
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &text, env!("CARGO_BIN_EXE_lie")])
        .arg(out)
        .env("LIE_CACHE_DIR", common::cache())
        .current_dir(env!("CARGO_MANIFEST_DIR"));
    shell.output().expect("a shell").into()
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
fn measuring_programs_end_with_the_command() {
    let body = "specs/so3_free_rigid_body.json --compile --quiet --methods gonzalez";
    let methods =
        "specs/so3_nonpolynomial.json --compile --quiet --methods midpoint,lie-midpoint,rk4,dopri5";
    for (call, spec, short, long) in [
        ("stress", body, "--steps 1", "--steps 1e15"),
        (
            "bench",
            body,
            "--until 1 --budget 1e-6",
            "--until 1e4 --budget 1e6",
        ),
        ("verify", methods, "", ""),
    ] {
        lie(&format!("{call} {spec} {short}")).ok();
        for (name, code) in [("-TERM", Some(143)), ("-HUP", Some(129)), ("-KILL", None)] {
            let mut command = command(format!("{call} {spec} {long}").split_whitespace());
            let mut child = command
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .expect("lie starts");
            wait("program", || programs(child.id()).len() == 1);
            let programs = programs(child.id());
            // `verify` is done soon: it waits until the signal is there
            let halt = |name: &str| Command::new("kill").args([name, &programs[0]]).status();
            halt("-STOP").expect("kill");
            signal(&child, name);
            halt("-CONT").expect("kill");
            let ended = Instant::now();
            assert_eq!(
                child.wait().expect("lie ends").code(),
                code,
                "{call} {name}"
            );
            wait("end of the program", || gone(&programs));
            // a measurement may go on for two seconds
            assert!(ended.elapsed() < Duration::from_secs(20), "{call} {name}");
        }
    }
}

/// The same where the command measures by itself.
#[test]
fn measurements_end_with_the_command() {
    let body = "specs/so3_free_rigid_body.json";
    for (call, long) in [
        ("stress", "--methods gonzalez --steps 1e15"),
        // all methods: each run is short, and all of them are long
        ("bench", "--until 100 --budget 0.5"),
    ] {
        let mut command = command(format!("{call} {body} {long}").split_whitespace());
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().expect("lie starts");
        std::thread::sleep(Duration::from_secs(2));
        signal(&child, "-TERM");
        let ended = Instant::now();
        let output = child.wait_with_output().expect("lie ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(143), "{call}: {stderr}");
        assert!(ended.elapsed() < Duration::from_secs(20), "{call}");
        assert!(stderr.contains("Interrupted"), "{call}: {stderr}");
    }
}

/// What is missing from a measurement cannot have failed. A signal before the first measurement leaves nothing to be printed.
#[test]
fn an_interrupted_verification_says_so_in_json() {
    for halves in 1..60 {
        let mut command = command("verify specs/se3_heavy_top.json --json --quiet".split(' '));
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().expect("lie starts");
        std::thread::sleep(Duration::from_millis(500 * halves));
        signal(&child, "-INT");
        let output = child.wait_with_output().expect("lie ends");
        assert_eq!(
            output.status.code(),
            Some(130),
            "it ended before the signal"
        );
        if output.stdout.is_empty() {
            continue;
        }
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(value["interrupted"], true);
        return;
    }
    panic!("nothing was measured");
}

/// Each run of the ladder takes twice as long as the one before, up to days: the signal meets a long one.
#[test]
fn one_long_run_of_a_benchmark_is_cut_short_and_those_before_it_are_kept() {
    let folder = folder();
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
        let (out, plot) = (
            folder.path().join("points.csv"),
            folder.path().join("p.svg"),
        );
        let call = format!(
            "bench specs/so3_free_rigid_body.json --methods midpoint,gonzalez --until 100 --budget 1e9 --out {} --plot {}",
            out.display(),
            plot.display()
        );
        let mut command = command(call.split_whitespace());
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().expect("lie starts");
        std::thread::sleep(Duration::from_secs(6));
        signal(&child, name);
        let ended = Instant::now();
        let output = child.wait_with_output().expect("lie ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{stderr}");
        assert!(ended.elapsed() < Duration::from_secs(10), "{stderr}");
        assert!(stderr.contains("Interrupted"), "{stderr}");
        let text = std::fs::read_to_string(&out).expect("points");
        let errors: Vec<f64> = text
            .lines()
            .filter(|line| line.starts_with("midpoint,step,"))
            .filter_map(|line| line.split(',').nth(3)?.parse().ok())
            .collect();
        // of order 2, up to the run that was met
        assert!(errors.len() > 6, "{text}");
        let ratio = errors[5] / errors[6];
        assert!((3.0..5.0).contains(&ratio), "{text}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        let stdout = String::from_utf8_lossy(&output.stdout);
        assert!(
            stdout.lines().any(|line| line.starts_with("midpoint ")),
            "{stdout}"
        );
        let svg = std::fs::read_to_string(&plot).expect("a picture");
        assert!(svg.trim_end().ends_with("</svg>"));
    }
}

/// The reference solution does not look for signals.
#[test]
fn what_does_not_end_is_left_behind() {
    let call = "bench specs/so3_free_rigid_body.json --methods midpoint --until 1e6";
    let mut command = command(call.split_whitespace());
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().expect("lie starts");
    std::thread::sleep(Duration::from_secs(1));
    signal(&child, "-TERM");
    let ended = Instant::now();
    let output = child.wait_with_output().expect("lie ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(143), "{stderr}");
    assert!(ended.elapsed() < Duration::from_secs(8), "{stderr}");
    assert!(stderr.contains("Interrupted"), "{stderr}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_signal_ends_the_build() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = folder();
    let spec = common::spec(folder.path(), |spec| spec["name"] = "Slow".into());
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
    let mut child = command.stderr(Stdio::null()).spawn().expect("lie starts");
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
    signal(&child, "-TERM");
    assert_eq!(child.wait().expect("lie ends").code(), Some(143));
    wait("end of what cargo started", || gone(&started));
    assert!(!out.exists(), "nothing was run, nothing is left");
}

#[test]
fn a_reader_that_goes_away_ends_the_run_quietly() {
    lie("run specs/so3_free_rigid_body.json --quiet --method midpoint --step 0.1 --until 0.1").ok();
    let mut command = command(LONG.split(' '));
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("lie starts");
    let mut first = [0; 100];
    child
        .stdout
        .take()
        .expect("a pipe")
        .read_exact(&mut first)
        .expect("some rows");
    let output = child.wait_with_output().expect("lie ends");
    assert_eq!(output.status.code(), Some(0));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(
        !stderr.contains("error") && !stderr.contains("panicked"),
        "{stderr}"
    );
}
