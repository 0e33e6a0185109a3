//! The files that a spec names.

use crate::diagnostic::Report;
use crate::front::json::{self, Type, Value};

/// The keys whose texts are paths, by the way to them; `*` stands for every key.
const WAYS: [&[&str]; 4] = [
    &["bonds"],
    &["functions", "*", "table"],
    &["initial", "npy"],
    &["parameters", "*", "file"],
];

/// The paths of the files that the text of a spec names, as they stand there: relative to its folder.
pub fn files(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    if let Ok(spec) = json::document(text) {
        for way in WAYS {
            follow(spec, way, &mut found);
        }
    }
    found
}

fn follow(value: Value<'_>, way: &[&str], found: &mut Vec<String>) {
    let mut mistakes = Report::new();
    match way {
        [] if value.kind() == Type::String => {
            let path = value.string(&mut mistakes);
            found.extend(path.map(|path| path.text.into_owned()));
        }
        [] => {}
        [key, rest @ ..] => {
            let members = value.members(&mut mistakes).into_iter();
            let members = members.filter(|member| *key == "*" || member.key.text == *key);
            members.for_each(|member| follow(member.value, rest, found));
        }
    }
    mistakes.ignore("who reads the spec tells of them");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_told_from_numbers_and_from_other_texts() {
        let text = r#"{
            "name": "a.csv",
            "functions": { "drag": { "table": "dr\u0061g.csv" }, "lift": { "table": [[0, 1]], "outside": "b.csv" } },
            "bonds": "bonds.csv", "initial": { "npy": "chain.npy" },
            "parameters": { "B": { "file": "B.npy" }, "J": { "values": [1, 2], "unit": "J.npy" }, "N": 2 }
        }"#;
        assert_eq!(files(text), ["bonds.csv", "drag.csv", "chain.npy", "B.npy"]);
        assert!(files(r#"{ "initial": [1, "1/2"], "functions": 3 }"#).is_empty());
        assert!(files("{").is_empty());
    }
}
