//! What hostile specs cost: time and memory, each in a process of its own, as `lie check` and `lie expand`
//! work on it.
//!
//! `cargo bench -p lie-codegen --bench hostile` prints all that took more than a tenth of a second and the
//! worst. Arguments after `--`: `--only TEXT` (cases with the text in their name), `--write FOLDER` (the
//! specs as files and nothing measured), `--seconds N` (what runs for longer is ended; 60).

#[path = "../tests/hostile/cases/mod.rs"]
mod cases;
#[path = "declarations/clock.rs"]
mod clock;

use std::io::{Read as _, Write as _};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use cases::Case;
use clock::Clock;
use lie_codegen::compile::{compile_spec, declared_choices, expand};
use lie_syntax::front::file::oversized;

/// The stack that `lie` gives the compiler.
const STACK: usize = 256 << 20;

/// What the spec on the standard input comes to, on the standard output.
fn child() {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).expect("a text");
    let thread = std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(move || {
            let clock = Clock::start();
            let verdict = verdict(&text);
            println!("{:.3}\t{}\t{verdict}", clock.seconds(), peak());
        });
    thread.expect("a thread").join().expect("no panic");
}

fn verdict(text: &str) -> String {
    let mistakes = match oversized(text.len()) {
        Some(mistake) => vec![mistake],
        None => match compile_spec(text) {
            Ok(model) => {
                let code = expand(&model, &declared_choices(&model));
                return format!("done, {} kB of code", code.len() / 1000);
            }
            Err(mistakes) => mistakes,
        },
    };
    let Some(first) = mistakes.iter().find(|mistake| !mistake.warning) else {
        return "refused without a reason".into();
    };
    let message: String = first.message.chars().take(90).collect();
    format!("{} x {}: {message}", mistakes.len(), first.kind).replace(['\n', '\t'], " ")
}

/// The largest memory of this process so far in MB (Linux).
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|rest| rest.split_whitespace().next()?.parse::<u64>().ok());
    kilobytes.unwrap_or(0) / 1024
}

fn measure(case: &Case, seconds: u64) -> String {
    let mut child = Command::new(std::env::current_exe().expect("this program"))
        .arg("--child")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("a process");
    let mut input = child.stdin.take().expect("its input");
    input.write_all(case.text.as_bytes()).expect("it reads");
    drop(input);
    let start = Instant::now();
    while child.try_wait().expect("a process").is_none() {
        if start.elapsed() > Duration::from_secs(seconds) {
            let _ = child.kill();
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().expect("its output");
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    match text.is_empty() {
        false => text,
        true => format!("{seconds}\t0\tENDED: {}", output.status),
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let value = |flag: &str| {
        let at = arguments.iter().position(|argument| argument == flag)?;
        arguments.get(at + 1).cloned()
    };
    if arguments.iter().any(|argument| argument == "--child") {
        return child();
    }
    let cases = cases::all();
    if let Some(folder) = value("--write") {
        std::fs::create_dir_all(&folder).expect("a folder");
        for (index, case) in cases.iter().enumerate() {
            std::fs::write(format!("{folder}/{index:03}.json"), &case.text).expect("a file");
        }
        return;
    }
    let seconds = value("--seconds")
        .and_then(|text| text.parse().ok())
        .unwrap_or(60);
    let only = value("--only").unwrap_or_default();
    println!("{} cases\nseconds\tMB\tname\tverdict", cases.len());
    let mut rows = Vec::new();
    for case in cases.iter().filter(|case| case.name.contains(&only)) {
        let row = measure(case, seconds);
        let mut cells = row.splitn(3, '\t');
        let [time, memory, verdict] = [(); 3].map(|()| cells.next().unwrap_or_default().to_owned());
        println!("{time}\t{memory}\t{}\t{verdict}", case.name);
        rows.push((time.parse().unwrap_or(f64::INFINITY), memory, &case.name));
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("\nthe worst");
    for (time, memory, name) in rows.iter().take(10) {
        println!("{time:.2} s\t{memory} MB\t{name}");
    }
}
