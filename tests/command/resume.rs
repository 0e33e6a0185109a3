//! `lie run --checkpoint` and `lie resume`: a run that was ended goes on as if it had not been.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use crate::common::{Run, command, folder};
use crate::random::Random;
use crate::resuming::{arguments, forged, prepared, within};

/// What is said of the errors.
fn errors(run: &Run) -> &str {
    let (_, said) = run
        .stderr
        .split_once("largest relative error")
        .unwrap_or_default();
    said
}

/// Runs to the end, goes on from the last milestone, and expects the same rows and errors.
#[track_caller]
fn goes_on(here: &Path, call: &str, out: &str) {
    let whole = within(
        here,
        &format!("run {call} --out {out} --checkpoint {out}.ck --checkpoint-every 1"),
    );
    assert_eq!(whole.code, Some(0), "{call}: {}", whole.stderr);
    let rows = fs::read(here.join(out)).unwrap();
    let resumed = within(here, &format!("resume {out}.ck")).ok();
    assert!(
        resumed.stderr.contains("goes on from step ") && resumed.stderr.contains("000, t = "),
        "{call}: {}",
        resumed.stderr
    );
    assert!(
        fs::read(here.join(out)).unwrap() == rows,
        "{call}: other rows"
    );
    assert_eq!(errors(&resumed), errors(&whole), "{call}");
}

/// Each method that applies, as it is written on the command line.
fn methods(here: &Path, spec: &str) -> Vec<String> {
    let report = within(here, &format!("check {spec} --json")).ok().stdout;
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let all = report["methods"].as_object().unwrap().iter();
    let applies = all.filter(|(_, reason)| reason.is_null());
    let written = applies.map(|(id, _)| match id.starts_with("compose") {
        true => format!("{id}(midpoint)"),
        false => id.clone(),
    });
    written.collect()
}

#[test]
fn a_thousand_steps_and_a_hundred_are_eleven_hundred() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let all = methods(here, "body.json");
    assert!(all.len() > 40, "{all:?}");
    let halves = all.chunks(all.len().div_ceil(2));
    std::thread::scope(|scope| {
        for half in halves {
            scope.spawn(move || {
                for method in half {
                    let out = method.replace(['(', ')'], "-");
                    let call =
                        format!("body.json --method {method} --step 0.2 --until 220 --every 50");
                    goes_on(here, &call, &format!("{out}.csv"));
                }
            });
        }
    });
}

#[test]
fn every_form_and_every_kind_of_rows_goes_on() {
    go_on(false);
}

#[test]
#[ignore = "half a minute: .ci/nightly runs it"]
fn every_form_of_every_kind_of_rows_goes_on() {
    go_on(true);
}

/// Runs of all kinds go on, each in every form, or in one of them.
fn go_on(every_form: bool) {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let steps = "body.json --step 0.2";
    for (number, call) in [
        format!("{steps} --until 220 --method gauss16"),
        format!("{steps} --until 220 --method lie-midpoint --group quaternion"),
        format!("{steps} --method gauss4 --group matrix --at 0.05,0.2,199.9,200,200.1,210"),
        format!("{steps} --method rk4 --at 210,220"),
        format!("{steps} --until 300 --method gauss16 --density reversible --every 7"),
        format!("{steps} --method lie-midpoint --density reversible --at 0.05,10,200,290.5,300"),
        format!("{steps} --until 220.07 --method dopri5 --every 7"),
        format!("{steps} --until 220.07 --method dopri5 --every 7 --keep energy,casimirs"),
        format!("{steps} --until 220 --method taylor --rtol 1e-8 --keep casimirs"),
        format!("{steps} --until 220 --method rk4 --keep energy"),
        "body.json --method gauss8 --step -0.2 --from 3 --until -230 --every 9".to_owned(),
        "driven.json --method collective8 --step 0.02 --until 22".to_owned(),
        "driven.json --method midpoint --tol 1e-4 --until 30".to_owned(),
        "body.json --method gauss16 --tol 1e-10 --until 2500 --initial 1e-4,1,1e-4".to_owned(),
        "folded.json --method gauss6 --step 0.02 --until 22 --every 5".to_owned(),
        "chirp.json --method gauss8 --tol 1e-5 --until 460".to_owned(),
        "chirp.json --method gauss16 --tol 1e-5 --at 1,300,700.5,899,900".to_owned(),
    ]
    .iter()
    .enumerate()
    {
        let forms = ["csv", "json", "jsonl", "npy"];
        let (all, one) = (&forms[..], &forms[number % 4..=number % 4]);
        for form in if every_form || number == 0 { all } else { one } {
            goes_on(here, call, &format!("{number}.{form}"));
        }
    }
}

/// The rows from a time on, without that.
fn rows_from(rows: &str, time: &str) -> Vec<String> {
    let from = rows.lines().skip_while(|line| !line.starts_with(time));
    from.map(|line| line.split_once(',').unwrap().1.to_owned())
        .collect()
}

/// A velocity that is found from elsewhere has other last digits.
#[test]
fn a_branch_is_part_of_a_checkpoint() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let call = "run folded.json --method gauss6 --step 0.02 --until 44 --every 50 --out rows.csv --checkpoint ck --checkpoint-every 1";
    within(here, call).ok();
    let rows = fs::read(here.join("rows.csv")).unwrap();
    forged(&here.join("ck"), |content| {
        let branch = &mut content["place"]["milestone"]["branch"];
        assert!(branch.is_array(), "{branch}");
        *branch = serde_json::Value::Null;
    });
    within(here, "resume ck").ok();
    assert!(fs::read(here.join("rows.csv")).unwrap() != rows);
}

#[test]
fn the_controls_differ() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let call = "run body.json --step 1/4 --until 300 --every 4 --quiet";
    for method in ["gauss16", "lie-midpoint", "dopri5"] {
        let kept =
            format!("{call} --method {method} --out rows.csv --checkpoint ck --checkpoint-every 1");
        within(here, &kept).ok();
        let rows = fs::read_to_string(here.join("rows.csv")).unwrap();
        // the last bit of the state
        forged(&here.join("ck"), |content| {
            let bits = &mut content["place"]["milestone"]["state"][0];
            *bits = (bits.as_u64().unwrap() ^ 1).into();
        });
        within(here, "resume ck").ok();
        let changed = fs::read_to_string(here.join("rows.csv")).unwrap();
        let before = rows.lines().take_while(|line| !line.starts_with("250.0,"));
        let before: Vec<&str> = before.collect();
        assert!(changed.lines().take(before.len()).eq(before), "{method}");
        assert_ne!(rows, changed, "{method}");
        // a state is enough where the run has forgotten, at a multiple of 1000 steps; elsewhere it is not
        for (time, same) in [("250.0", true), ("248.0", false)] {
            // these are solved to the last digit, whatever the iteration begins with
            if !same && method != "dopri5" {
                continue;
            }
            let row = rows
                .lines()
                .find(|line| line.starts_with(&format!("{time},")))
                .unwrap();
            let state: Vec<&str> = row.split(',').skip(1).take(3).collect();
            let again = format!(
                "{call} --method {method} --from {time} --initial {} --out again.csv",
                state.join(",")
            );
            within(here, &again).ok();
            let again = fs::read_to_string(here.join("again.csv")).unwrap();
            let [rows, again] = [&rows, &again].map(|rows| rows_from(rows, &format!("{time},")));
            assert_eq!(rows == again, same, "{method} from {time}");
        }
        fs::remove_file(here.join("ck")).unwrap();
    }
}

/// Runs that are killed, of so many kinds one after the other.
fn kills(count: u64, seed: u64) {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let mut random = Random(seed);
    let mut part = |most: f64| (random.number() + 1.0) / 2.0 * most;
    let (mut late, mut early, mut taken_up) = (0, 0, 0);
    let methods = [
        "gauss16",
        "lie-midpoint --group quaternion",
        "rk4",
        "dopri5",
        "collective4",
        "splitting4",
    ];
    for kill in 0..count {
        let method = methods[kill as usize % methods.len()];
        let form =
            ["csv", "json", "jsonl", "npy"][(kill as usize / methods.len() + kill as usize) % 4];
        let every = ["", "--checkpoint-every 1", "--checkpoint-every 5000"][part(3.0) as usize];
        let call = format!("body.json --method {method} --step 0.01 --until 300 --every 3 --quiet");
        let name = format!("{}.{form}", kill as usize % methods.len());
        let reference = here.join(format!("reference.{name}"));
        if !reference.exists() {
            let call = format!("run {call} --out reference.{name} --checkpoint reference.ck");
            within(here, &call).ok();
        }
        let (out, kept) = (here.join(&name), here.join(format!("{kill}.ck")));
        let begin = format!("run {call} --out {name} --checkpoint {kill}.ck {every}");
        let resume = format!("resume {kill}.ck");
        let mut next = begin.clone();
        loop {
            let child = command(arguments(&next))
                .current_dir(here)
                .stderr(Stdio::piped())
                .spawn();
            let mut child = child.unwrap();
            std::thread::sleep(Duration::from_secs_f64(part(0.5)));
            let over = child.try_wait().unwrap().is_some();
            let _ = child.kill();
            let ended: Run = child.wait_with_output().unwrap().into();
            assert!(!over || ended.code == Some(0), "{next}: {}", ended.stderr);
            let begun = kept.exists();
            (late, early) = (late + u64::from(over), early + u64::from(!begun));
            taken_up += u64::from(next == resume);
            next = if begun { resume.clone() } else { begin.clone() };
            if over || part(1.0) < 0.5 {
                break;
            }
        }
        within(here, &next).ok();
        assert!(
            fs::read(&out).unwrap() == fs::read(&reference).unwrap(),
            "{kill}: {begin}"
        );
        fs::remove_file(&out).unwrap();
    }
    println!(
        "{count} runs; {taken_up} kills of one that was taken up; {early} before the first checkpoint, {late} after the end"
    );
}

#[test]
fn a_run_that_is_killed_goes_on() {
    kills(10, 31);
}

#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn two_hundred_runs_that_are_killed_go_on() {
    kills(200, 2026);
}

/// Waits until a checkpoint speaks of steps.
#[track_caller]
fn wait_for_place(path: &Path) {
    crate::process::wait("a checkpoint", || {
        fs::read_to_string(path).is_ok_and(|text| text.contains("milestone"))
    });
}

/// A run of months that has come to some steps and was then ended by a signal.
#[track_caller]
fn cut_short(here: &Path, signal: &str) -> Run {
    let call = "run body.json --method rk4 --step 0.01 --until 1e9 --out rows.csv --checkpoint ck --checkpoint-every 1";
    let child = crate::process::start(
        command(arguments(call))
            .current_dir(here)
            .stderr(Stdio::piped()),
    );
    wait_for_place(&here.join("ck"));
    crate::process::signal(child.id(), signal);
    crate::process::ended(child)
}

#[test]
fn ctrl_c_says_how_to_go_on() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let run = cut_short(here, "-INT");
    assert_eq!(run.code, Some(130), "{}", run.stderr);
    assert!(
        run.stderr.contains("`lie resume ck` goes on from step "),
        "{}",
        run.stderr
    );
    // what can go on is not begun anew by mistake
    let rows = fs::read(here.join("rows.csv")).unwrap();
    let again = "run body.json --out rows.csv --checkpoint ck";
    let refused = within(here, again).error("checkpoint", "ck");
    assert!(
        refused.stderr.contains("`lie resume ck` goes on with it"),
        "{}",
        refused.stderr
    );
    assert!(fs::read(here.join("rows.csv")).unwrap() == rows);
    fs::remove_file(here.join("ck")).unwrap();
    within(here, again).ok();
}
