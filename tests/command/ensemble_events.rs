//! Events of members: when they end them, what is computed of those that go on, and their table.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Run, folder, lie};
use crate::ensemble::{array, assert_same, record};
use serde_json::{Value, json};
use tempfile::TempDir;

/// The square of the norm at which members end.
const LOW: f64 = 0.25;
/// The last time.
const END: f64 = 3.0;

/// A body with linear friction: |m| falls as exp(-k t), whatever the moments of inertia.
fn body() -> Value {
    json!({
        "name": "Damped", "algebra": "so(3)", "state": ["x", "y", "z"],
        "parameters": { "k": 0.3 },
        "hamiltonian": "x^2/2 + y^2/3 + z^2",
        "forces": { "x": "-k*x", "y": "-k*y", "z": "-k*z" },
        "events": {
            "low": { "when": "x^2 + y^2 + z^2 - 1/4", "direction": -1, "stop": true },
            "turn": { "when": "y" },
        },
        "initial": [0.6, 0.3, 1.7],
    })
}

/// A folder with a spec and 20 starts, of norms from 0.6 on.
struct Place(TempDir);

impl Place {
    fn new(spec: &Value) -> Self {
        let place = Self(folder());
        fs::write(place.path("body.json"), spec.to_string()).expect("written");
        let start = |k: usize| {
            let size = norm(k) / 7.0;
            format!("{},{},{}", 2.0 * size, 3.0 * size, 6.0 * size)
        };
        let starts: Vec<String> = (0..20).map(start).collect();
        fs::write(place.path("starts.csv"), starts.join("\n")).expect("written");
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A call for the array of a name, with the table of events of the same name where `--events` stands.
    fn call(&self, flags: &str, name: &str) -> Run {
        let table = self.path(&format!("{name}.csv"));
        let flags = flags.replace("--events", &format!("--events {}", table.display()));
        lie(&format!(
            "ensemble {} --initial-file {} --until {END} --method gauss12 --step 0.1 {flags} --out {}",
            self.path("body.json").display(),
            self.path("starts.csv").display(),
            self.array(name).display()
        ))
    }

    fn array(&self, name: &str) -> PathBuf {
        self.path(&format!("{name}.npy"))
    }

    fn table(&self, name: &str) -> String {
        fs::read_to_string(self.path(&format!("{name}.csv"))).expect("a table")
    }
}

/// Of a start.
fn norm(k: usize) -> f64 {
    0.6 + 0.05 * k as f64
}

/// When a member ends by the closed form, if it does.
fn stop(k: usize, friction: f64) -> Option<f64> {
    Some((norm(k) / LOW.sqrt()).ln() / friction).filter(|time| *time <= END)
}

fn stops(path: &Path) -> (Vec<usize>, Vec<f64>) {
    array(&path.with_extension("stops.npy"))
}

#[test]
fn members_end_when_the_closed_form_says() {
    let place = Place::new(&body());
    let run = place.call("", "all").ok();
    let (shape, times) = stops(&place.array("all"));
    assert_eq!(shape, [20, 1]);
    let far = |friction: f64| {
        let each = times
            .iter()
            .enumerate()
            .map(|(k, found)| match stop(k, friction) {
                Some(time) if found.is_nan() => time,
                Some(time) => (found - time).abs(),
                None if found.is_nan() => 0.0,
                None => *found,
            });
        each.fold(0.0, f64::max)
    };
    assert!(far(0.3) < 1e-12, "{}", far(0.3));
    assert!(far(0.301) > 1e-3, "the control");
    // what is said of them
    let expected: Vec<f64> = (0..20).filter_map(|k| stop(k, 0.3)).collect();
    let (count, last) = (expected.len() as f64, expected.len() - 1);
    assert!((5..18).contains(&expected.len()));
    let mean = expected.iter().sum::<f64>() / count;
    let squares: f64 = expected.iter().map(|time| (time - mean).powi(2)).sum();
    let said = &record(&place.array("all"))["stops"];
    let low = &said["events"][0];
    assert_eq!(
        (&low["event"], low["members"].as_f64()),
        (&json!("low"), Some(count))
    );
    let near =
        |found: &Value, expected: f64| (found.as_f64().expect("a number") - expected).abs() < 1e-12;
    assert!(near(&low["mean"], mean), "{low}");
    assert!(
        near(&low["deviation"], (squares / (count - 1.0)).sqrt()),
        "{low}"
    );
    assert_eq!(said["quantiles"], json!([0.05, 0.25, 0.5, 0.75, 0.95]));
    let middle = (expected[last / 2] + expected[last.div_ceil(2)]) / 2.0;
    assert!(near(&low["quantiles"][2], middle), "{low}");
    let line = format!("`low` ended {count} of 20 members, at t = ");
    assert!(run.stderr.contains(&line), "{}", run.stderr);
    // a member that was ended stands where it was
    let (_, ends) = array(&place.array("all"));
    for (k, end) in ends.chunks_exact(3).enumerate() {
        let square: f64 = end.iter().map(|x| x * x).sum();
        let expected = stop(k, 0.3).map_or((norm(k) * (-0.3 * END).exp()).powi(2), |_| LOW);
        assert!((square - expected).abs() < 1e-12, "{k}: {square}");
    }
}

/// A member that one event ended was not ended by another; of what stops nobody nothing is computed.
#[test]
fn each_event_has_a_column() {
    let mut spec = body();
    spec["events"] = json!({
        "low": { "when": "x^2 + y^2 + z^2 - 1/4", "stop": true },
        "late": { "when": "t - 2", "stop": true },
        "never": { "when": "x - 7", "stop": true },
        "turn": { "when": "y" },
    });
    let place = Place::new(&spec);
    let run = place.call("", "all").ok();
    let said = record(&place.array("all"))["stops"].clone();
    let names: Vec<&str> = said["events"]
        .as_array()
        .expect("events")
        .iter()
        .filter_map(|one| one["event"].as_str())
        .collect();
    let column = |name: &str| names.iter().position(|one| *one == name).expect("a column");
    let (shape, times) = stops(&place.array("all"));
    assert_eq!(shape, [20, 3]);
    for (k, times) in times.chunks_exact(3).enumerate() {
        let early = stop(k, 0.3).filter(|time| *time < 2.0);
        let low = times[column("low")];
        assert!(
            early.map_or(low.is_nan(), |time| (low - time).abs() < 1e-12),
            "{k}: {low}"
        );
        let late = times[column("late")];
        assert!(
            if early.is_some() {
                late.is_nan()
            } else {
                (late - 2.0).abs() < 1e-14
            },
            "{k}: {late}"
        );
        assert!(times[column("never")].is_nan());
    }
    let never = &said["events"][column("never")];
    assert_eq!(
        *never,
        json!({"event": "never", "members": 0, "mean": null, "deviation": null, "quantiles": []})
    );
    assert!(
        run.stderr.contains("`never` ended none of 20 members"),
        "{}",
        run.stderr
    );
}

#[test]
fn reductions_are_over_members_that_go_on() {
    let place = Place::new(&body());
    let reduce = "--reduce mean,covariance,quantiles,histogram --bins 2";
    place.call(&format!("--every 5 {reduce}"), "rows").ok();
    place.call(reduce, "ends").ok();
    let (shape, rows) = array(&place.array("rows"));
    assert_eq!(shape, [20, 7, 3]);
    let counts = record(&place.array("rows"))["counts"].clone();
    let means = array(&place.array("rows").with_extension("mean.npy")).1;
    for row in 0..7 {
        let time = 0.5 * row as f64;
        let going = |k: &usize| stop(*k, 0.3).is_none_or(|stop| stop >= time);
        let going: Vec<usize> = (0..20).filter(going).collect();
        assert_eq!(counts[row], going.len(), "row {row}");
        for i in 0..3 {
            let sum: f64 = going.iter().map(|k| rows[21 * k + 3 * row + i]).sum();
            let mean = sum / going.len() as f64;
            assert!((means[3 * row + i] - mean).abs() < 1e-13, "row {row}");
        }
    }
    // of the ends alone they are those of the last row, and not of the states in which members were ended
    assert_eq!(record(&place.array("ends"))["counts"], json!([counts[6]]));
    for end in ["mean.npy", "covariance.npy"] {
        let [all, last] =
            ["rows", "ends"].map(|name| array(&place.array(name).with_extension(end)).1);
        assert_eq!(all[all.len() - last.len()..], last, "{end}");
    }
    let [all, last] =
        ["rows", "ends"].map(|name| array(&place.array(name).with_extension("quantiles.npy")).1);
    for (all, last) in all.chunks_exact(21).zip(last.chunks_exact(3)) {
        assert_eq!(all[18..], *last);
    }
    let counted = array(&place.array("ends").with_extension("histogram.npy")).1;
    assert_eq!(json!(counted.iter().sum::<f64>() as u64), counts[6]);
    let ends = array(&place.array("ends")).1;
    let mixed = ends.iter().step_by(3).sum::<f64>() / 20.0;
    assert!((mixed - means[18]).abs() > 1e-3, "the control");
}

/// Threads and shares change no byte of rows, times, statistics and table; the table is that of single runs.
#[test]
fn threads_and_shares_change_no_byte() {
    for rows in ["", "--every 7"] {
        let place = Place::new(&body());
        let flags = format!(
            "--param k=0.2:0.4:3 --reduce mean,quantiles,histogram {rows} --quiet --events"
        );
        place.call(&format!("{flags} --threads 1"), "one").ok();
        place.call(&format!("{flags} --threads 2"), "two").ok();
        let ends = [
            "npy",
            "npy.json",
            "stops.npy",
            "mean.npy",
            "quantiles.npy",
            "histogram.npy",
            "csv",
        ];
        assert_same(&place.array("one"), &place.array("two"), &ends);
        let shares = [2, 3, 1].map(|k| {
            let name = format!("share{k}");
            place.call(&format!("{flags} --shard {k}/3"), &name).ok();
            place.array(&name).display().to_string()
        });
        let merge = |rest: &str| {
            let out = place.array("merged").display().to_string();
            lie(&format!("merge {} --out {out} {rest}", shares.join(" ")))
        };
        let table = place.path("merged.csv").display().to_string();
        let said = merge(&format!("--events {table}")).ok().stderr;
        assert!(said.contains("`low` ended "), "{said}");
        assert_same(&place.array("one"), &place.array("merged"), &ends);
        place.call(&format!("{flags} --shard 1/1"), "single").ok();
        let single = place.array("single").display().to_string();
        let out = place.array("again").display().to_string();
        let again = place.path("again.csv").display().to_string();
        lie(&format!("merge {single} --out {out} --events {again}")).ok();
        assert_same(&place.array("one"), &place.array("again"), &ends);
        let run = format!(
            "run {} --initial-file {} --until {END} --method gauss12 --step 0.1 --param k=0.2:0.4:3 --quiet --events {}",
            place.path("body.json").display(),
            place.path("starts.csv").display(),
            place.path("runs.csv").display()
        );
        lie(&run).ok();
        let (events, runs) = (place.table("one"), place.table("runs"));
        assert_eq!(events.lines().next(), Some("member,event,t,x,y,z"));
        assert!(events.contains(",turn,") && events.lines().count() > 60);
        assert_eq!(events.replacen("member", "run", 1), runs);
        // a share whose events or times are others, or are gone
        fs::remove_file(&table).expect("removed");
        let said = merge("").ok().stderr;
        assert!(said.contains("`--events FILE` puts together"), "{said}");
        assert!(record(&place.array("merged"))["events"].is_null());
        let spoil = |name: &str, text: &str| {
            let path = place.path(name);
            let whole = fs::read(&path).expect("a file");
            let mut other = whole.clone();
            *other.last_mut().expect("bytes") ^= 1;
            fs::write(&path, other).expect("written");
            let run = merge(&format!("--events {table}"));
            assert_eq!(run.code, Some(1), "{}", run.stderr);
            assert!(
                run.stderr.contains(text) && run.stderr.contains("--shard 2/3"),
                "{}",
                run.stderr
            );
            fs::write(&path, whole).expect("written");
        };
        spoil(
            "share2.csv",
            "the events in this file are not those of share 2 of 3",
        );
        spoil(
            "share2.stops.npy",
            "the times in this file are not those of share 2 of 3",
        );
        for (name, text) in [
            ("share3.csv", "the events of share 3 of 3 are not there"),
            (
                "share3.stops.npy",
                "the times of stops of share 3 of 3 are not in this file",
            ),
        ] {
            let whole = fs::read(place.path(name)).expect("a file");
            fs::remove_file(place.path(name)).expect("removed");
            let run = merge("");
            assert_eq!(run.code, Some(1), "{}", run.stderr);
            assert!(run.stderr.contains(text), "{}", run.stderr);
            fs::write(place.path(name), whole).expect("written");
        }
    }
}

/// Members whose events are only looked at have the rows of members side by side.
#[test]
fn a_table_changes_no_row() {
    let mut spec = body();
    spec["events"]["low"]["stop"] = json!(false);
    let place = Place::new(&spec);
    place.call("--every 5", "plain").ok();
    place.call("--every 5 --events", "table").ok();
    assert_same(&place.array("plain"), &place.array("table"), &["npy"]);
    assert!(!place.array("table").with_extension("stops.npy").exists());
    assert!(record(&place.array("table"))["stops"].is_null());
    let table = place.table("table");
    let of = |member: usize| {
        let (low, own) = (format!("{member},low,"), format!("{member},"));
        let own = table.lines().filter(move |line| line.starts_with(&own));
        (
            own.clone().filter(|line| line.starts_with(&low)).count(),
            own.count(),
        )
    };
    for k in 0..20 {
        let (low, all) = of(k);
        assert_eq!(low, usize::from(stop(k, 0.3).is_some()), "{k}");
        assert!(all > low, "{k}");
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let place = Place::new(&body());
    let elsewhere = |flags: &str| {
        lie(&format!(
            "ensemble {} --members 4 {flags} --out {}",
            place.path("body.json").display(),
            place.array("one").display()
        ))
    };
    let run = elsewhere("--shard 1/2 --events elsewhere.csv");
    let help = format!("write `{}`", place.path("elsewhere.csv").display());
    assert!(run.stderr.contains(&help), "{}", run.stderr);
    run.error("option", "command line: --events");
    elsewhere("--events events.npy").error("option", "command line: --events");
    assert!(!place.array("one").exists());
    let mut spec = body();
    spec.as_object_mut().expect("an object").remove("events");
    let none = Place::new(&spec);
    none.call("--events", "one")
        .error("option", "command line: --events");
    assert!(!none.path("one.csv").exists());
    // shares that differ in their tables, and such as have none
    place.call("--shard 1/2 --events", "first").ok();
    place.call("--shard 2/2", "second").ok();
    place.call("--shard 1/2", "bare").ok();
    let merge = |first: &str, rest: &str| {
        let [first, second, out] = [first, "second", "merged"].map(|name| place.array(name));
        let (first, second, out) = (first.display(), second.display(), out.display());
        lie(&format!("merge {first} {second} --out {out} {rest}"))
    };
    let run = merge("first", "");
    assert!(
        run.stderr
            .contains("--events is not given here and given there"),
        "{}",
        run.stderr
    );
    assert_eq!(run.code, Some(2));
    let table = place.path("merged.csv").display().to_string();
    merge("bare", &format!("--events {table}")).error("option", "command line: --events");
    assert!(!place.path("merged.csv").exists());
    merge("bare", "").ok();
}

/// The last row of an ensemble is at its end, on the grid or off it: a member that is ended just there has it.
#[test]
fn a_stop_at_an_end_off_the_grid_leaves_the_last_row() {
    let mut spec = body();
    spec["events"] = json!({ "late": { "when": "t - 2", "stop": true } });
    let place = Place::new(&spec);
    for step in ["0.3", "0.25"] {
        let out = place.array("late");
        let run = lie(&format!(
            "ensemble {} --initial-file {} --until 2 --method gauss12 --step {step} --every 1 --out {} --quiet",
            place.path("body.json").display(),
            place.path("starts.csv").display(),
            out.display()
        ));
        run.ok();
        let counts = record(&out)["counts"].clone();
        let counts = counts.as_array().expect("counts").clone();
        assert_eq!(counts.last(), Some(&json!(20)), "step {step}: {counts:?}");
        for name in ["late.npy", "late.npy.json", "late.stops.npy"] {
            fs::remove_file(place.path(name)).expect("it was written");
        }
    }
}
