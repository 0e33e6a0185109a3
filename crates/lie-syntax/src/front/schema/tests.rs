//! Reader and schema have the same keys.

use super::*;

fn keys(object: &Value) -> Vec<&str> {
    let mut keys: Vec<&str> = object["properties"]
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    keys.sort_unstable();
    keys
}

fn sorted(keys: &[&'static str]) -> Vec<&'static str> {
    let mut keys = keys.to_vec();
    keys.sort_unstable();
    keys
}

#[test]
fn the_reader_and_the_schema_have_the_same_keys() {
    let schema = schema();
    let tables = [
        (&schema, Spec::KEYS, Spec::REQUIRED),
        (
            &schema["$defs"]["Algebra"],
            Algebra::KEYS,
            Algebra::REQUIRED,
        ),
        (
            &schema["$defs"]["DescribedParameter"],
            DescribedParameter::KEYS,
            DescribedParameter::REQUIRED,
        ),
        (&schema["$defs"]["Run"], Run::KEYS, Run::REQUIRED),
        (
            &schema["$defs"]["Realization"],
            Realization::KEYS,
            Realization::REQUIRED,
        ),
    ];
    for (object, all, required) in tables {
        assert_eq!(keys(object), sorted(all));
        assert_eq!(object["additionalProperties"], false, "{all:?}");
        let listed: Vec<&str> = object["required"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect();
        assert_eq!(sorted(required), {
            let mut l = listed;
            l.sort_unstable();
            l
        });
    }
}

#[test]
fn the_schema_is_deterministic_and_has_no_null() {
    let text = schema().to_string();
    assert_eq!(text, schema().to_string());
    assert!(!text.contains("null"), "{text}");
    assert_eq!(schema()["properties"]["format"]["const"], 1);
    assert_eq!(
        schema()["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
}
