//! The seeds are read, and the targets notice what they are for.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Mutex;

use lie_codegen::compile::compile_spec;
use lie_codegen::methods::{CATALOGUE, Choice};

use super::*;
use crate::compiler::choices;

fn files(folder: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).expect("the folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let files = paths.filter(|path| path.is_file());
    files
        .map(|path| std::fs::read(path).expect("a file"))
        .collect()
}

#[test]
fn seeds_of_the_declarations() {
    let texts = files("seeds/declaration");
    let texts = texts
        .iter()
        .filter_map(|bytes| std::str::from_utf8(bytes).ok());
    assert!(
        texts
            .filter(|text| read_declaration(text) && declaration(text))
            .count()
            > 0
    );
}

/// The choices are all there are: every method applies to one of these systems.
#[test]
fn seeds_of_the_specs() {
    let mut specs = files("../../specs");
    specs.extend(files("../../tests/data/declarations/pass"));
    // no spec of these has noise
    specs.push(
        br#"{"format": 1, "name": "Warm", "algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "x^2 + z",
            "dissipation": [{"kind": "double-bracket", "strength": "1/5", "temperature": "1/3"}]}"#
            .to_vec(),
    );
    let left = Mutex::new(specs);
    let share = || {
        let mut seen = BTreeSet::new();
        loop {
            // a statement of its own, so that the other does not wait
            let next = left.lock().unwrap().pop();
            let Some(bytes) = next else { return seen };
            read_spec(&bytes);
            spec(&bytes);
            if let Ok(model) = compile_spec(std::str::from_utf8(&bytes).expect("UTF-8")) {
                seen.extend(choices(&model).iter().map(Choice::id));
            }
        }
    };
    let seen = std::thread::scope(|scope| {
        let other = scope.spawn(share);
        let mut seen = share();
        seen.append(&mut other.join().expect("no panic"));
        seen
    });
    for method in CATALOGUE {
        let composed = method.id.starts_with("compose");
        assert!(composed || seen.contains(method.id), "{}", method.id);
    }
    files("../../tests/data/declarations/fail")
        .iter()
        .for_each(|bytes| spec(bytes));
}

#[test]
fn seeds_of_the_checkpoints() {
    assert!(
        files("seeds/checkpoint")
            .iter()
            .all(|bytes| checkpoint(bytes))
    );
    assert!(!checkpoint(b"lie checkpoint 1, by lie 0\n{}\n"));
}

/// What is right and what is not reaches its end in each of the others.
#[test]
fn readers_come_to_an_end() {
    for text in [
        "x,y\n0,1\n1,1/2\n2,4\n3,5\n",
        "0,1\n1,0.5\n2,4\n3,5\n",
        "0;1",
    ] {
        table(text.as_bytes());
    }
    for text in ["z,x,y\n1,2,3\n", "1,2,3\n1/2,cos(1)\n", "\u{feff}# none\n"] {
        initial_file(text.as_bytes());
    }
    let mut array = b"\x93NUMPY\x01\x00\x46\x00".to_vec();
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
    array.extend(format!("{header:<69}\n").bytes());
    array.extend(
        [0.5_f64, f64::NAN, 1.0, 0.0, 2.0, -1.0]
            .iter()
            .flat_map(|x| x.to_le_bytes()),
    );
    npy(&array);
    npy(&array[..array.len() - 1]);
    assert!(request(
        r#"{ "method": ["rk4"], "step": "1/7", "param": ["I1=1:2:3"], "at": [1, "x"] }"#
    ));
    assert!(!request(r#"{ "speed": 1 }"#));
    messages(b"{\"found\":{\"rows\":{\"count\":9,\"width\":3}}}\n01234567");
}
