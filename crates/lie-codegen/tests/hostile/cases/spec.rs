//! Specs as lists of keys with the JSON of their values, so that a key may be repeated, wrong or missing.

use std::fmt::Write as _;

/// A spec under construction.
#[derive(Clone)]
pub struct Spec(Vec<(String, String)>);

impl Spec {
    /// The rigid body.
    pub fn body() -> Self {
        let members = [
            ("name", r#""Body""#),
            (
                "algebra",
                r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#,
            ),
            ("state", r#"["x", "y", "z"]"#),
            ("hamiltonian", r#""x^2/2 + y^2 + 3*z^2/2""#),
        ];
        Self(
            members
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .to_vec(),
        )
    }

    /// A system on the dual of an algebra with the basis e0, e1, … and the coordinates x0, x1, ….
    pub fn algebra(dimension: usize, brackets: &[String], hamiltonian: &str) -> Self {
        let algebra = format!(
            r#"{{"basis": {}, "brackets": {}}}"#,
            strings(&names("e", dimension)),
            strings(brackets)
        );
        Self::body()
            .set("algebra", algebra)
            .set("state", strings(&names("x", dimension)))
            .set("hamiltonian", string(hamiltonian))
    }

    /// A system by the Poisson brackets of x0, x1, ….
    pub fn poisson(dimension: usize, brackets: &[String], hamiltonian: &str) -> Self {
        Self::algebra(dimension, &[], hamiltonian)
            .without("algebra")
            .set("poisson", strings(brackets))
    }

    /// With this value of a key, which takes the place of the present one.
    pub fn set(mut self, key: &str, value: impl Into<String>) -> Self {
        let value = value.into();
        match self.0.iter_mut().find(|(known, _)| known == key) {
            Some((_, present)) => *present = value,
            None => self.0.push((key.to_owned(), value)),
        }
        self
    }

    /// With a member at the end, wherever else its key stands.
    pub fn and(mut self, key: &str, value: impl Into<String>) -> Self {
        self.0.push((key.to_owned(), value.into()));
        self
    }

    /// Without a key.
    pub fn without(mut self, key: &str) -> Self {
        self.0.retain(|(known, _)| known != key);
        self
    }

    /// With a text as the value.
    pub fn text(self, key: &str, text: &str) -> Self {
        self.set(key, string(text))
    }

    /// With a list of texts as the value.
    pub fn list(self, key: &str, texts: &[String]) -> Self {
        self.set(key, strings(texts))
    }

    /// The JSON.
    pub fn json(&self) -> String {
        let mut text = "{".to_owned();
        for (index, (key, value)) in self.0.iter().enumerate() {
            let comma = if index > 0 { ",\n" } else { "" };
            let _ = write!(text, "{comma}{}: {value}", string(key));
        }
        text + "}"
    }
}

/// A JSON string.
pub fn string(text: &str) -> String {
    serde_json::to_string(text).expect("a string is JSON")
}

/// A JSON list of strings.
pub fn strings(texts: &[String]) -> String {
    serde_json::to_string(texts).expect("strings are JSON")
}

/// A prefix with 0, 1, ….
pub fn names(prefix: &str, count: usize) -> Vec<String> {
    (0..count).map(|i| format!("{prefix}{i}")).collect()
}

/// What `form` gives for 0, 1, …, joined.
pub fn joined(count: usize, separator: &str, form: impl Fn(usize) -> String) -> String {
    let all: Vec<String> = (0..count).map(form).collect();
    all.join(separator)
}

/// What `form` gives for 0, 1, ….
pub fn each(count: usize, form: impl Fn(usize) -> String) -> Vec<String> {
    (0..count).map(form).collect()
}

/// Numbers from a seed, the same on every machine.
pub struct Draw(pub u64);

impl Draw {
    /// A number below `bound`.
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }
}
