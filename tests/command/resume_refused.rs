//! What `lie resume` does not go on with, and what a run cannot keep a checkpoint of.
#![cfg(unix)]

use std::fs;
use std::path::Path;

use crate::common::folder;
use crate::resuming::{forged, prepared, within};

#[test]
fn what_does_not_fit_is_refused() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let body = fs::read_to_string(here.join("driven.json")).unwrap();
    let call = "run driven.json --method rk4 --step 0.02 --until 40 --out rows.csv --checkpoint ck --checkpoint-every 1 --quiet";
    within(here, call).ok();
    let [whole, kept] = ["rows.csv", "ck"].map(|name| fs::read(here.join(name)).unwrap());
    let mut cases: Vec<(&str, &str, Vec<u8>, &str)> = vec![
        (
            "driven.json",
            "driven.json",
            body.replace("0.4", "0.41").into(),
            "has changed",
        ),
        (
            "drag.csv",
            "drag.csv",
            b"-9,0\n9,1\n".to_vec(),
            "has changed",
        ),
        (
            "rows.csv",
            "rows.csv",
            whole[..whole.len() / 2].to_vec(),
            "bytes of the",
        ),
        (
            "rows.csv",
            "rows.csv",
            whole.iter().map(|byte| byte ^ 1).collect(),
            "was changed",
        ),
        ("ck", "ck", body.clone().into(), "no checkpoint"),
        ("ck", "ck", Vec::new(), "no checkpoint"),
        ("ck", "ck", kept[..kept.len() / 2].to_vec(), "damaged"),
        ("ck", "ck", [&kept[..], b"more\n"].concat(), "damaged"),
    ];
    let text = String::from_utf8(kept.clone()).unwrap();
    let other = text.replacen("by lie 0.", "by lie 9.", 1).into_bytes();
    cases.push(("ck", "ck", other, "was written by lie 9."));
    for (name, place, bytes, why) in cases {
        let before = fs::read(here.join(name)).unwrap();
        fs::write(here.join(name), &bytes).unwrap();
        let refused = within(here, "resume ck").error("checkpoint", place);
        assert!(refused.stderr.contains(why), "{why}: {}", refused.stderr);
        assert!(
            fs::read(here.join(name)).unwrap() == bytes,
            "{why}: it was touched"
        );
        fs::write(here.join(name), before).unwrap();
    }
    type Change = fn(&mut serde_json::Value);
    let changes: [(Change, &str); 7] = [
        (
            |content| content["arguments"] = serde_json::json!(["check", "driven.json"]),
            "no `lie run`",
        ),
        (
            |content| content["place"]["milestone"]["index"] = 500.into(),
            "not on the grid",
        ),
        (
            |content| content["place"]["milestone"]["index"] = 3000.into(),
            "not on the grid",
        ),
        (
            |content| content["place"]["milestone"]["step"] = 1.into(),
            "step is another",
        ),
        (
            |content| content["place"]["milestone"]["state"] = serde_json::json!([1, 2]),
            "another length",
        ),
        (
            |content| content["place"]["milestone"]["division"]["parts"] = 2.into(),
            "divided otherwise",
        ),
        (
            |content| content["place"]["milestone"]["stats"]["steps"] = u64::MAX.into(),
            "those of no run",
        ),
    ];
    for (change, why) in changes {
        forged(&here.join("ck"), change);
        let refused = within(here, "resume ck").error("checkpoint", "");
        assert!(refused.stderr.contains(why), "{why}: {}", refused.stderr);
        fs::write(here.join("ck"), &kept).unwrap();
    }
    // the control
    within(here, "resume ck").ok();
    assert!(fs::read(here.join("rows.csv")).unwrap() == whole);
    // from elsewhere too, and with the folder moved
    let moved = here.join("moved");
    fs::create_dir(&moved).unwrap();
    for name in ["driven.json", "drag.csv", "rows.csv", "ck"] {
        fs::copy(here.join(name), moved.join(name)).unwrap();
    }
    within(
        Path::new("/"),
        &format!("resume {}", here.join("ck").display()),
    )
    .ok();
    fs::remove_file(here.join("rows.csv")).unwrap();
    within(&moved, "resume ck").ok();
    assert!(!here.join("rows.csv").exists());
    within(here, "resume ck").error("checkpoint", "rows.csv");
    assert_eq!(
        within(here, "resume none.ck").says("io", "none.ck").code,
        Some(1)
    );
}

#[test]
fn what_cannot_be_gone_on_with_is_refused_beforehand() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    fs::write(here.join("notes"), "precious").unwrap();
    for (call, help) in [
        ("run body.json --checkpoint ck", "add `--out FILE`"),
        (
            "run body.json --checkpoint ck --out rows.csv --plot rows.svg",
            "leave out `--plot`",
        ),
        (
            "run body.json --checkpoint ck --out rows.csv --param a=1:2:3",
            "one by one",
        ),
        (
            "run body.json --checkpoint ck --out /dev/null",
            "the name of a file",
        ),
        (
            "run body.json --checkpoint /dev/null --out rows.csv",
            "the name of a file",
        ),
        (
            "run body.json --checkpoint notes --out rows.csv",
            "that does not exist",
        ),
        (
            "run body.json --checkpoint body.json --out rows.csv",
            "another file",
        ),
        (
            "run body.json --checkpoint rows.csv --out rows.csv",
            "another file",
        ),
    ] {
        let refused = within(here, call).error("option", "command line: --checkpoint");
        assert!(refused.stderr.contains(help), "{call}: {}", refused.stderr);
        assert!(
            !here.join("ck").exists() && !here.join("rows.csv").exists(),
            "{call}"
        );
    }
    assert_eq!(fs::read_to_string(here.join("notes")).unwrap(), "precious");
    for flags in [
        "--checkpoint ck --checkpoint-every 0",
        "--checkpoint-every 5",
    ] {
        let run = within(here, &format!("run body.json --out rows.csv {flags}"));
        assert_eq!(run.code, Some(2), "{flags}: {}", run.stderr);
    }
    let missing = "run body.json --checkpoint none/ck --out rows.csv";
    assert_eq!(within(here, missing).says("io", "none/ck").code, Some(1));
}
