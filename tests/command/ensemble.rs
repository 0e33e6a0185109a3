//! `lie ensemble` and `lie merge`: members have the bits of runs, whatever the threads and the shares; what is lost is named.

#![cfg(unix)]

use std::fs;
use std::path::Path;

use crate::common::{Run, command, folder, lie};
use crate::process::{ended, signal, start, wait_for_bytes};
use serde_json::Value;

const BODY: &str = "specs/so3_free_rigid_body.json";

/// The shape and the numbers of an array.
pub fn array(path: &Path) -> (Vec<usize>, Vec<f64>) {
    let bytes = fs::read(path).expect("an array");
    let header = std::str::from_utf8(&bytes[10..128]).expect("a header");
    let shape = header.split(['(', ')']).nth(1).expect("a shape");
    let sizes = shape
        .split(',')
        .map(str::trim)
        .filter(|size| !size.is_empty());
    let numbers = bytes[128..].chunks_exact(8);
    (
        sizes.map(|size| size.parse().expect("a size")).collect(),
        numbers
            .map(|one| f64::from_le_bytes(one.try_into().expect("8 bytes")))
            .collect(),
    )
}

/// What stands beside it.
pub fn record(path: &Path) -> Value {
    let text = fs::read_to_string(format!("{}.json", path.display())).expect("a record");
    serde_json::from_str(&text).expect("JSON")
}

/// The same files with these ends, byte by byte.
pub fn assert_same(one: &Path, other: &Path, ends: &[&str]) {
    for end in ends {
        let read = |path: &Path| fs::read(path.with_extension(end)).expect("a file");
        assert!(read(one) == read(other), "{end} differs");
    }
}

#[test]
fn members_are_runs() {
    let folder = folder();
    let (states, out) = (
        folder.path().join("states.csv"),
        folder.path().join("all.npy"),
    );
    fs::write(&states, "1,2,3\n1/2,1/3,-1\n0.3,0.1,0.2\n").expect("written");
    // a time off the grid, several rows, an implicit method and an explicit one
    for flags in [
        "--method gauss4 --step 0.1 --until 1.05 --every 3",
        "--method rk4 --step 0.1 --at 0,0.25,0.5",
        "--method lie-midpoint --step -0.1 --until -1 --every 4",
    ] {
        let flags = format!(
            "{flags} --initial-file {} --param I1=1:2:3",
            states.display()
        );
        lie(&format!("ensemble {BODY} {flags} --out {}", out.display())).ok();
        let run = lie(&format!("run {BODY} {flags} --quiet")).ok();
        let (shape, numbers) = array(&out);
        let record = record(&out);
        let rows: Vec<Vec<f64>> = run.csv().1;
        assert_eq!((shape[0], shape[2]), (9, 3));
        assert_eq!(rows.len(), 9 * shape[1]);
        // run, I1, t, x, y, z, …
        let expected: Vec<u64> = rows
            .iter()
            .flat_map(|row| &row[3..6])
            .map(|x| x.to_bits())
            .collect();
        let found: Vec<u64> = numbers.iter().map(|x| x.to_bits()).collect();
        assert!(found == expected, "{flags}");
        let times: Vec<f64> = rows[..shape[1]].iter().map(|row| row[2]).collect();
        assert_eq!(record["times"], Value::from(times), "{flags}");
        assert_eq!(
            record["parameters"][0][1],
            serde_json::json!([1.0, 1.5, 2.0])
        );
    }
    // the ends alone
    let flags = format!("--step 0.1 --initial-file {}", states.display());
    lie(&format!(
        "ensemble {BODY} {flags} --until 1 --out {}",
        out.display()
    ))
    .ok();
    let rows = lie(&format!("run {BODY} {flags} --at 1 --quiet"))
        .ok()
        .csv()
        .1;
    let expected: Vec<f64> = rows.iter().flat_map(|row| row[2..5].to_vec()).collect();
    assert_eq!(array(&out), (vec![3, 3], expected));
}

/// An event that stops ends its member, by every method: its last state is that of the run, and rows that others have after it are none.
#[test]
fn events_end_members() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let spec = serde_json::json!({
        "name": "Body", "algebra": "so(3)", "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2/2 + z^2",
        "events": { "low": { "when": "x", "direction": -1, "stop": true } },
        "initial": [0.6, 0.3, 1.7],
    });
    fs::write(path("body.json"), spec.to_string()).expect("written");
    let starts: Vec<String> = (0..12)
        .map(|k| format!("0.6,{},1.7", 0.1 * f64::from(k)))
        .collect();
    fs::write(path("starts.csv"), starts.join("\n")).expect("written");
    let body = path("body.json").display().to_string();
    for method in ["rk4", "gauss4", "taylor --tol 1e-9"] {
        let step = if method.contains("tol") {
            ""
        } else {
            "--step 0.1"
        };
        let flags = format!(
            "--method {method} {step} --until 20 --initial-file {}",
            path("starts.csv").display()
        );
        let out = path("all.npy");
        lie(&format!("ensemble {body} {flags} --out {}", out.display())).ok();
        let (header, rows) = lie(&format!("run {body} {flags} --quiet")).ok().csv();
        assert_eq!(header[..2], ["run", "t"]);
        let last = |k: usize| {
            let mut own = rows.iter().filter(|row| row[0] == k as f64);
            own.next_back().expect("rows").clone()
        };
        let ends: Vec<f64> = (0..12).flat_map(|k| last(k)[2..5].to_vec()).collect();
        assert!(
            (0..12).all(|k| last(k)[1] < 6.0),
            "{method}: no event ended a run"
        );
        assert_eq!(array(&out), (vec![12, 3], ends), "{method}");
    }
    let flags = "--method rk4 --step 0.1 --until 20 --every 10 --members 12 --spread 0";
    lie(&format!(
        "ensemble {body} {flags} --out {}",
        path("rows.npy").display()
    ))
    .ok();
    let (shape, numbers) = array(&path("rows.npy"));
    assert_eq!(shape, [12, 21, 3]);
    let came = numbers.iter().take_while(|x| x.is_finite()).count();
    assert!(came > 3 && came < 21, "{came}");
    assert!(numbers[came..63].iter().all(|x| x.is_nan()));
}

const DRAWN: &str =
    "--members 500 --seed 7 --spread orbit --method gauss4 --step 0.2 --until 4 --every 10";

#[test]
fn threads_and_shares_change_no_byte() {
    let folder = folder();
    let path = |name: &str| folder.path().join(format!("{name}.npy"));
    let call = |rest: &str, name: &str| {
        let reduce = "--reduce quantiles,mean,covariance,histogram --quantiles 0,0.5,1 --bins 3";
        lie(&format!(
            "ensemble {BODY} {DRAWN} {reduce} {rest} --out {}",
            path(name).display()
        ))
        .ok()
    };
    call("--threads 1", "one");
    call("--threads 5", "five");
    let ends = [
        "npy",
        "npy.json",
        "mean.npy",
        "covariance.npy",
        "quantiles.npy",
        "histogram.npy",
    ];
    assert_same(&path("one"), &path("five"), &ends);
    let files: Vec<String> = [3, 1, 4, 2]
        .map(|k| {
            let said = call(&format!("--shard {k}/4"), &k.to_string());
            assert!(
                said.stderr
                    .contains(&format!("125 members, share {k} of 4")),
                "{}",
                said.stderr
            );
            path(&k.to_string()).display().to_string()
        })
        .to_vec();
    assert!(!path("1").with_extension("mean.npy").exists());
    let merged = lie(&format!(
        "merge {} --out {}",
        files.join(" "),
        path("merged").display()
    ))
    .ok();
    assert!(
        merged.stderr.contains("500 members from 4 shares"),
        "{}",
        merged.stderr
    );
    assert_same(&path("one"), &path("merged"), &ends);
    // they are what their names say
    let (shape, numbers) = array(&path("one"));
    assert_eq!(shape, [500, 3, 3]);
    let column = |row: usize, k: usize| numbers.iter().skip(3 * row + k).step_by(9).copied();
    let (shape, means) = array(&path("one").with_extension("mean.npy"));
    assert_eq!(shape, [3, 3]);
    let (shape, covariances) = array(&path("one").with_extension("covariance.npy"));
    assert_eq!(shape, [3, 3, 3]);
    let (shape, quantiles) = array(&path("one").with_extension("quantiles.npy"));
    assert_eq!(shape, [3, 3, 3]);
    let (shape, counts) = array(&path("one").with_extension("histogram.npy"));
    assert_eq!(shape, [3, 3, 9]);
    let bins = &record(&path("one"))["histogram"]["sphere"];
    assert_eq!(*bins, serde_json::json!({"bands": 3, "sectors": 9}));
    for (row, counts) in counts.chunks_exact(27).enumerate() {
        let mut expected = [0.0; 27];
        for ((x, y), z) in column(row, 0).zip(column(row, 1)).zip(column(row, 2)) {
            let height = z / (x * x + y * y + z * z).sqrt();
            let turn = (y.atan2(x) / std::f64::consts::PI + 1.0) / 2.0;
            expected[9 * (1.5 * (height + 1.0)) as usize + (9.0 * turn) as usize] += 1.0;
        }
        assert_eq!(counts, expected);
    }
    for row in 0..3 {
        for i in 0..3 {
            let mean = |k: usize| column(row, k).sum::<f64>() / 500.0;
            assert!((means[3 * row + i] - mean(i)).abs() < 1e-13);
            for j in 0..3 {
                let pairs = column(row, i).zip(column(row, j));
                let sum: f64 = pairs.map(|(x, y)| (x - mean(i)) * (y - mean(j))).sum();
                let found = covariances[9 * row + 3 * i + j];
                assert!(
                    (found - sum / 499.0).abs() < 1e-13,
                    "{found} {}",
                    sum / 499.0
                );
            }
            let mut sorted: Vec<f64> = column(row, i).collect();
            sorted.sort_by(f64::total_cmp);
            let expected = [sorted[0], (sorted[249] + sorted[250]) / 2.0, sorted[499]];
            for (k, expected) in expected.into_iter().enumerate() {
                let found = quantiles[9 * k + 3 * row + i];
                assert!((found - expected).abs() < 1e-15, "{found} {expected}");
            }
        }
    }
}

#[test]
fn drawn_states_are_on_the_orbit_and_the_seed_says_which() {
    let folder = folder();
    let out = folder.path().join("drawn.npy");
    let starts = |flags: &str| {
        let call = format!("--members 50 --step 0.1 --at 0 --method rk4 {flags}");
        lie(&format!(
            "ensemble {BODY} --initial 1,2,2 {call} --out {}",
            out.display()
        ))
        .ok();
        array(&out).1
    };
    let (first, again, other, near) = (
        starts("--seed 1"),
        starts(""),
        starts("--seed 2"),
        starts("--spread 1e-3"),
    );
    assert!(first == again && first != other);
    let distance = |states: &[f64]| {
        let moved = states
            .chunks_exact(3)
            .map(|s| (s[0] - 1.0).abs() + (s[1] - 2.0).abs());
        moved.fold(0.0, f64::max)
    };
    let (far, near_by) = (distance(&first), distance(&near));
    assert!(
        far > 0.1 && (1e-4..0.03).contains(&near_by),
        "{far} {near_by}"
    );
    for state in first.chunks_exact(3).chain(near.chunks_exact(3)) {
        let norm = state.iter().map(|x| x * x).sum::<f64>();
        assert!((norm - 9.0).abs() < 1e-13, "{norm}");
    }
    // more members begin with those of fewer, and each value of a parameter has the same
    let call = "--members 2 --step 0.1 --at 0 --method rk4 --initial 1,2,2 --param I1=1:2:2";
    lie(&format!("ensemble {BODY} {call} --out {}", out.display())).ok();
    let both = array(&out).1;
    assert_eq!(both, [&first[..6], &first[..6]].concat());
}

#[test]
fn members_that_end_early_are_values() {
    let folder = folder();
    let out = folder.path().join("some.npy");
    let call = "specs/se3_heavy_top.json --members 40 --spread 3 --method gauss4 --max-iterations 3 --step 0.5 --until 5 --every 1";
    let run = lie(&format!(
        "ensemble {call} --reduce mean --out {}",
        out.display()
    ));
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert!(run.stderr.contains("members ended early"), "{}", run.stderr);
    let (shape, numbers) = array(&out);
    assert_eq!(shape, [40, 11, 6]);
    let record = record(&out);
    assert_eq!(record["complete"], true);
    let failures = record["failures"].as_array().expect("failures");
    assert!(
        failures.len() > 3 && failures.len() < 37,
        "{}",
        failures.len()
    );
    for (number, member) in numbers.chunks_exact(66).enumerate() {
        let failed = failures.iter().find(|one| one["member"] == number);
        let time = failed.map_or(f64::INFINITY, |one| one["time"].as_f64().expect("a time"));
        for (k, row) in member.chunks_exact(6).enumerate() {
            let came = k as f64 * 0.5 <= time;
            assert!(
                row.iter().all(|x| x.is_nan() != came),
                "member {number}, row {k}"
            );
        }
    }
    // those that came to a row are counted there
    let last = || {
        numbers
            .chunks_exact(66)
            .map(|member| member[60])
            .filter(|x| !x.is_nan())
    };
    let mean = array(&out.with_extension("mean.npy")).1[60];
    assert!((mean - last().sum::<f64>() / last().count() as f64).abs() < 1e-12);
}

#[test]
fn lost_shares_are_named() {
    let folder = folder();
    let path = |name: &str| folder.path().join(format!("{name}.npy"));
    for k in 1..=4 {
        let rest = format!(
            "--shard {k}/4 --quiet --out {}",
            path(&k.to_string()).display()
        );
        lie(&format!("ensemble {BODY} {DRAWN} {rest}")).ok();
    }
    let merge = |names: &[&str]| -> Run {
        let files = names.iter().map(|name| path(name).display().to_string());
        let files: Vec<String> = files.collect();
        lie(&format!(
            "merge {} --out {}",
            files.join(" "),
            path("merged").display()
        ))
    };
    let refused = |run: Run, code: i32, texts: &[&str]| {
        assert_eq!(run.code, Some(code), "{}", run.stderr);
        for text in texts {
            assert!(run.stderr.contains(text), "{text}\n{}", run.stderr);
        }
        assert!(!path("merged").exists());
    };
    let missing = [
        "share 1 of 4 is missing: members 0 to 124",
        "share 4 of 4 is missing",
        "--shard 4/4",
    ];
    refused(merge(&["2", "3"]), 1, &missing);
    refused(
        merge(&["1", "2", "2", "3", "4"]),
        2,
        &["share 2 is given twice"],
    );
    refused(merge(&["1", "none"]), 1, &["none.npy"]);
    // of very many shares the gaps are named, and not more than some
    let far = |number: u64, of: u64| {
        let name = format!("far{number}");
        let rest = format!(
            "--shard {number}/{of} --quiet --out {}",
            path(&name).display()
        );
        lie(&format!("ensemble {BODY} {DRAWN} {rest}")).ok();
        name
    };
    let last = u64::MAX;
    let name = far(last, last);
    let gap = format!(
        "shares 1 to {} of {last} are missing: members 0 to 498",
        last - 1
    );
    refused(merge(&[&name]), 1, &[&gap, &format!("--shard 1/{last}")]);
    let every_third: Vec<String> = (1..=15).map(|k| far(3 * k, 60)).collect();
    let names: Vec<&str> = every_third.iter().map(String::as_str).collect();
    let run = merge(&names);
    assert_eq!(
        run.stderr.matches("are missing").count(),
        10,
        "{}",
        run.stderr
    );
    refused(
        run,
        1,
        &[
            "shares 28 to 29 of 60 are missing: members 225 to 240",
            "of 25 more shares",
        ],
    );
    // another seed, another spec, another number of shares, the whole
    for (flags, what) in [
        (
            format!("{BODY} {DRAWN} --shard 4/4").replace("--seed 7", "--seed 8"),
            "--seed is 8 here and 7 there",
        ),
        (
            format!("{BODY} {DRAWN} --shard 4/4").replace("--until 4", "--until 5"),
            "--until is \"5\" here",
        ),
        (
            format!("{BODY} {DRAWN} --shard 4/5"),
            "one of 5 shares here, one of 4 shares there",
        ),
        (format!("{BODY} {DRAWN}"), "the whole here"),
        (
            format!("specs/se3_heavy_top.json {DRAWN} --shard 4/4").replace("orbit", "0.1"),
            "HeavyTop here, FreeRigidBody there",
        ),
    ] {
        lie(&format!(
            "ensemble {flags} --quiet --out {}",
            path("other").display()
        ))
        .ok();
        refused(
            merge(&["1", "2", "3", "other"]),
            2,
            &["no share of the ensemble of", what],
        );
    }
    // a share of which a part is gone
    let whole = fs::read(path("3")).expect("a share");
    fs::write(path("3"), &whole[..whole.len() - 8]).expect("written");
    refused(
        merge(&["1", "2", "3", "4"]),
        1,
        &["the members of share 3 of 4 are not in this file"],
    );
    // one with the numbers of another
    fs::copy(path("2"), path("3")).expect("copied");
    let run = merge(&["1", "2", "3", "4"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    for text in ["3.npy", "not those of share 3 of 4", "--shard 3/4"] {
        assert!(run.stderr.contains(text), "{text}\n{}", run.stderr);
    }
    assert_eq!(record(&path("merged"))["complete"], false);
    fs::remove_file(path("merged")).expect("it is there");
    // one that was killed on its way, where there was a whole one before
    let long = DRAWN.replace("--members 500", "--members 100000000");
    let out = path("4").display().to_string();
    let flags = format!("ensemble {BODY} {long} --shard 4/4 --quiet --out {out}");
    let child = start(&mut command(flags.split_whitespace()));
    wait_for_bytes(&path("4"), 100_000);
    signal(child.id(), "-KILL");
    ended(child);
    fs::write(path("3"), &whole).expect("written");
    assert_eq!(record(&path("4"))["complete"], false);
    refused(
        merge(&["4"]),
        1,
        &[
            "share 4 of 4 did not come to its end",
            "shares 1 to 3 of 4 are missing",
        ],
    );
}

#[test]
fn a_signal_leaves_members() {
    let folder = folder();
    let out = folder.path().join("many.npy");
    let flags = format!(
        "ensemble {BODY} --members 100000000 --method rk4 --step 0.1 --until 1 --out {}",
        out.display()
    );
    let child = start(command(flags.split_whitespace()).stderr(std::process::Stdio::piped()));
    wait_for_bytes(&out, 100_000);
    signal(child.id(), "-INT");
    let run = ended(child);
    assert_eq!(run.code, Some(130), "{}", run.stderr);
    assert!(
        run.stderr.contains("of 100000000 members are written"),
        "{}",
        run.stderr
    );
    let (shape, numbers) = array(&out);
    assert_eq!(shape[0] * 3, numbers.len());
    assert!(numbers.len() > 10_000 && numbers.iter().all(|x| x.is_finite()));
    assert_eq!(record(&out)["complete"], false);
}

#[test]
fn shares_are_those_of_an_array_job() {
    let folder = folder();
    let out = folder.path().join("task.npy");
    let flags = format!(
        "ensemble {BODY} {DRAWN} --quiet --shard slurm --out {}",
        out.display()
    );
    let mut call = command(flags.split_whitespace());
    for (name, value) in [("ID", "4"), ("COUNT", "8"), ("MIN", "1"), ("MAX", "8")] {
        call.env(format!("SLURM_ARRAY_TASK_{name}"), value);
    }
    assert!(call.status().expect("lie runs").success());
    assert_eq!(
        record(&out)["share"],
        serde_json::json!({"number": 4, "of": 8})
    );
    lie(&flags).error("option", "command line: --shard");
}

#[test]
fn mistakes_have_a_place_and_a_remedy() {
    let folder = folder();
    let out = folder.path().join("none.npy");
    let states = folder.path().join("states.csv");
    fs::write(&states, "1,2,3\n3,2,1\n").expect("written");
    let states = states.display();
    for (flags, place) in [
        ("", "--members"),
        ("--members 0", "--members"),
        ("--members 1.5", "--members"),
        ("--members 10 --spread -1", "--spread"),
        ("--members 10 --shard 3/2", "--shard"),
        ("--members 10 --method rk4 --method gauss4", "--method"),
        ("--members 10 --group matrix", "--group"),
        ("--members 10 --assess", "--assess"),
        ("--members 10 --reduce mean --quantiles 0.5", "--quantiles"),
        (
            "--members 10 --reduce quantiles --quantiles 0.5,2",
            "--quantiles",
        ),
        ("--members 10 --reduce median", "--reduce"),
        ("--members 10 --reduce mean --bins 4", "--bins"),
        ("--members 10 --reduce histogram --bins 0.5", "--bins"),
        ("--members 10 --tol 1e-6 --every 2", "--every"),
        ("--param I1=1:2:3 --seed 4", "--seed"),
        ("--members 10 --step 0.1 --until -1", "--until"),
        (&format!("--members 3 --initial-file {states}"), "--members"),
    ] {
        let run = lie(&format!("ensemble {BODY} {flags} --out {}", out.display()));
        run.error("option", &format!("command line: {place}"));
        assert!(!out.exists(), "{flags}");
    }
    let none = lie(&format!(
        "ensemble {BODY} --members 0 --out {}",
        out.display()
    ));
    assert!(none.stderr.contains("--members 1000"), "{}", none.stderr);
    assert!(!none.stderr.contains("every tenth"), "{}", none.stderr);
    let to = |name: &str| lie(&format!("ensemble {BODY} --members 10 --out {name}"));
    to("rows.csv").error("option", "command line: --out");
    let wide = "--members 10 --spread wide --out x.npy";
    lie(&format!("ensemble {BODY} {wide}")).error("number", "command line: --spread");
    // files that are read stay
    let spec = folder.path().join("a.npy.json");
    fs::copy(BODY, &spec).expect("copied");
    let out = folder.path().join("a.npy");
    let run = lie(&format!(
        "ensemble {} --members 10 --out {}",
        spec.display(),
        out.display()
    ));
    run.error("option", "command line: --out");
    assert!(!out.exists() && fs::read(&spec).expect("it") == fs::read(BODY).expect("it"));
    // no orbit of se(3) is bounded
    let call = "specs/se3_heavy_top.json --members 10 --spread orbit";
    lie(&format!("ensemble {call} --out {}", out.display()))
        .error("option", "command line: --spread");
}
