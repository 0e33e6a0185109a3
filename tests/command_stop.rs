//! Ends of `lie run` that nobody planned: Ctrl-C, a kill, a reader that goes away.
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
    let (header, rows) = csv(&text);
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

#[test]
#[cfg(target_os = "linux")]
fn a_kill_keeps_whole_rows_and_ends_the_program() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let mut child = start(&out, "");
    let programs = children(child.id());
    assert_eq!(programs.len(), 1, "the built program runs");
    signal(&child, "-KILL");
    child.wait().expect("lie ends");
    let gone = || {
        programs.iter().all(|id| {
            let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
            status.is_empty() || status.contains("State:\tZ")
        })
    };
    wait("end of the program", gone);
    assert!(whole_rows(&out) > 10);
}

#[test]
fn an_array_counts_its_rows_also_after_a_kill() {
    let folder = folder();
    let out = folder.path().join("rows.npy");
    let mut child = start(&out, "--format npy");
    std::thread::sleep(Duration::from_millis(500));
    signal(&child, "-KILL");
    child.wait().expect("lie ends");
    let bytes = std::fs::read(&out).expect("the rows are there");
    let head = String::from_utf8_lossy(&bytes[..128]).into_owned();
    let count = head
        .split("'shape': (")
        .nth(1)
        .and_then(|rest| rest.split(',').next());
    let count: usize = count.and_then(|count| count.parse().ok()).expect("a count");
    assert!(
        count > 10 && 128 + count * 48 <= bytes.len(),
        "{head} {}",
        bytes.len()
    );
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
