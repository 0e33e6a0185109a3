//! Forms of the output, on files.

use lie_in_process::request::Labels;

use super::*;

fn header() -> Header {
    Header {
        system: "Rigid\"Body".to_owned(),
        columns: ["t", "x", "energy"].into_iter().collect(),
        events: None,
        labels: None,
    }
}

fn run() -> Run {
    Run {
        method: "midpoint".to_owned(),
        step: 0.1,
        ..Run::default()
    }
}

/// Rows of one run that has begun.
fn opened(destination: Destination, format: Format) -> Rows {
    let mut rows = Rows::new(destination, format, header());
    rows.open(&run()).unwrap();
    rows
}

const NUMBERS: [f64; 9] = [
    0.0,
    0.1 + 0.2,
    -1e-300,
    0.1,
    f64::NAN,
    f64::INFINITY,
    1e22,
    -0.0,
    5e-324,
];

fn written(format: Format, finish: bool) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out");
    std::fs::write(&path, "an older and longer file ".repeat(100)).unwrap();
    let mut rows = opened(Destination::file(&path).unwrap(), format);
    rows.push(&NUMBERS[..6]).unwrap();
    rows.push(&NUMBERS[6..]).unwrap();
    if finish {
        rows.close("done", &[]).unwrap();
        rows.finish().unwrap();
    }
    std::fs::read(&path).unwrap()
}

fn text(format: Format) -> String {
    String::from_utf8(written(format, true)).unwrap()
}

#[test]
fn csv_numbers_round_trip() {
    let text = text(Format::Csv);
    assert!(
        text.starts_with("t,x,energy\n0.0,0.30000000000000004,-1e-300\n"),
        "{text}"
    );
    let read: Vec<f64> = text
        .lines()
        .skip(1)
        .flat_map(|line| line.split(','))
        .map(|n| n.parse().unwrap())
        .collect();
    assert!(
        read.iter()
            .zip(NUMBERS)
            .all(|(a, b)| a.to_bits() == b.to_bits() || b.is_nan())
    );
    assert_eq!(read.len(), 9);
}

#[test]
fn json_is_json() {
    let value: serde_json::Value = serde_json::from_str(&text(Format::Json)).unwrap();
    assert_eq!(value["system"], "Rigid\"Body");
    assert_eq!(value["columns"][2], "energy");
    assert_eq!(value["rows"][0][1], 0.1 + 0.2);
    assert!(value["rows"][1][1].is_null());
    assert_eq!(value["rows"].as_array().map(Vec::len), Some(3));
    assert_eq!(value["status"], "done");
}

#[test]
fn lines_of_json_are_objects_by_the_names_of_columns() {
    let text = text(Format::Jsonl);
    let lines = text.lines().map(serde_json::from_str::<serde_json::Value>);
    let lines: Vec<serde_json::Value> = lines.map(Result::unwrap).collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[0]["x"], 0.1 + 0.2);
    assert_eq!(lines[0].as_object().unwrap().len(), 3);
    assert!(lines[1]["x"].is_null() && lines[1]["t"] == 0.1);
    assert_eq!(lines[2]["energy"], 5e-324);
    assert_eq!(
        written(Format::Jsonl, false),
        text.as_bytes(),
        "nothing stands behind"
    );
}

#[test]
fn npy_counts_its_rows_also_when_it_is_not_finished() {
    for finish in [true, false] {
        let bytes = written(Format::Npy, finish);
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let length = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        assert_eq!(length % 64, 0, "numpy aligns the data");
        let head = String::from_utf8_lossy(&bytes[10..length]);
        assert!(
            head.contains("'shape': (3, 3)") && head.ends_with('\n'),
            "{head}"
        );
        assert_eq!(bytes.len() - length, 72);
        assert_eq!(bytes[length + 8..length + 16], (0.1f64 + 0.2).to_le_bytes());
    }
}

#[test]
fn numpy_reads_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    std::fs::write(&path, written(Format::Npy, true)).unwrap();
    let script = "import sys\ntry:\n    import numpy\nexcept ImportError:\n    sys.exit(77)\n\
                  a = numpy.load(sys.argv[1])\n\
                  assert a.shape == (3, 3) and a.dtype == numpy.float64\n\
                  assert a.flags.c_contiguous and a[0, 1] == 0.1 + 0.2 and a[2, 2] == 5e-324\n";
    let python = std::process::Command::new("python3")
        .args(["-c", script])
        .arg(&path)
        .status();
    match python.ok().and_then(|status| status.code()) {
        Some(0) => {}
        Some(77) | None => eprintln!("skipped: no numpy"),
        Some(code) => panic!("numpy does not read the file: exit code {code}"),
    }
}

#[test]
fn an_old_file_survives_until_rows_come_and_a_new_one_does_not_stay() {
    let folder = tempfile::tempdir().unwrap();
    let (old, new) = (folder.path().join("old"), folder.path().join("new"));
    std::fs::write(&old, "precious").unwrap();
    drop(Destination::file(&old).unwrap());
    drop(Destination::file(&new).unwrap());
    assert_eq!(std::fs::read_to_string(&old).unwrap(), "precious");
    assert!(!new.exists());
    assert!(Destination::file(&folder.path().join("no/such/folder")).is_err());
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error() {
    let destination = Destination::file(std::path::Path::new("/dev/full")).unwrap();
    let mut rows = Rows::new(destination, Format::Csv, header());
    let error = rows.open(&run()).err().unwrap();
    assert_eq!(error.kind(), io::ErrorKind::StorageFull);
}

/// Two runs of two rows and of none, told apart by all there is.
fn several(format: Format) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out");
    let mut header = header();
    header.labels = Some(Labels {
        run: "run".to_owned(),
        method: Some("method".to_owned()),
        parameters: vec!["k".to_owned()],
    });
    let mut rows = Rows::new(Destination::file(&path).unwrap(), format, header);
    for (number, k) in [0.5, 2.0].into_iter().enumerate() {
        let run = Run {
            number,
            parameters: vec![k],
            ..run()
        };
        rows.open(&run).unwrap();
        rows.push(&NUMBERS[..6 * (1 - number)]).unwrap();
        rows.close(["done", "stopped"][number], &[]).unwrap();
    }
    rows.finish().unwrap();
    std::fs::read(&path).unwrap()
}

#[test]
fn several_runs_are_told_apart() {
    let text = String::from_utf8(several(Format::Csv)).unwrap();
    let expected = "run,method,k,t,x,energy\n0,midpoint,0.5,0.0,0.30000000000000004,-1e-300\n\
                    0,midpoint,0.5,0.1,NaN,inf\n";
    assert_eq!(text, expected);
    let value: serde_json::Value = serde_json::from_slice(&several(Format::Json)).unwrap();
    assert_eq!(value["columns"], serde_json::json!(["t", "x", "energy"]));
    let (first, second) = (&value["runs"][0], &value["runs"][1]);
    assert_eq!(first["parameters"], serde_json::json!({"k": 0.5}));
    assert_eq!(first["rows"][1], serde_json::json!([0.1, null, null]));
    assert_eq!(second["run"], 1);
    assert_eq!(second["status"], "stopped");
    assert_eq!(second["rows"], serde_json::json!([]));
    let bytes = several(Format::Npy);
    assert!(String::from_utf8_lossy(&bytes[..128]).contains("'shape': (2, 5)"));
    let number = |at: usize| f64::from_le_bytes(bytes[128 + 8 * at..][..8].try_into().unwrap());
    assert_eq!(
        [0, 1, 2, 5, 6, 7].map(number),
        [0.0, 0.5, 0.0, 0.0, 0.5, 0.1]
    );
}
