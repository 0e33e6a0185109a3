//! Random declarations: what people write, and what is short to write and long to derive.

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use serde_json::json;

use super::random;

/// A drawn declaration.
pub struct Declaration {
    /// Its number.
    pub index: usize,
    /// Its kind.
    pub family: &'static str,
    /// The spec.
    pub spec: String,
}

/// A kind of Hamiltonian: its name and how a function of n coordinates is drawn.
type Family = (&'static str, fn(&mut Draw) -> String);

const FAMILIES: [Family; 9] = [
    ("springs", Draw::springs),
    ("ratios", Draw::ratios),
    ("nested radicals", Draw::nested_radicals),
    ("roots below", Draw::roots_below),
    ("exponentials", Draw::exponentials),
    ("dense quadratic", Draw::dense_quadratic),
    ("powers of sums", Draw::powers_of_sums),
    ("radii", Draw::radii),
    ("mixture", Draw::mixture),
];

/// Every tenth declaration is one of the random systems of the tests.
pub fn declarations(seed: u64, count: usize) -> Vec<Declaration> {
    let mut draw = Draw {
        state: seed,
        dimension: 0,
        radius: String::new(),
    };
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    (0..count)
        .map(|index| {
            let (family, spec) = match FAMILIES.get(index % (FAMILIES.len() + 1)) {
                Some(family) => (family.0, draw.spec(family.1)),
                None => {
                    let tree = random::system().new_tree(&mut runner);
                    let system = tree.expect("a random system").current();
                    ("random system", system.spec("Random"))
                }
            };
            Declaration {
                index,
                family,
                spec,
            }
        })
        .collect()
}

/// so(3), so(2,1), the Heisenberg algebra, aff(1), the oscillator algebra, so(4), se(3): dimension and brackets.
const ALGEBRAS: [(usize, &[&str]); 7] = [
    (3, &["[e0, e1] = e2", "[e1, e2] = e0", "[e2, e0] = e1"]),
    (3, &["[e0, e1] = e2", "[e1, e2] = -e0", "[e2, e0] = e1"]),
    (3, &["[e0, e1] = e2"]),
    (2, &["[e0, e1] = e1"]),
    (4, &["[e0, e1] = e2", "[e0, e2] = -e1", "[e1, e2] = e3"]),
    (
        6,
        &[
            "[e0, e1] = e2",
            "[e1, e2] = e0",
            "[e2, e0] = e1",
            "[e3, e4] = e5",
            "[e4, e5] = e3",
            "[e5, e3] = e4",
        ],
    ),
    (
        6,
        &[
            "[e0, e1] = e2",
            "[e1, e2] = e0",
            "[e2, e0] = e1",
            "[e0, e4] = e5",
            "[e1, e5] = e3",
            "[e2, e3] = e4",
            "[e1, e3] = -e5",
            "[e2, e4] = -e3",
            "[e0, e5] = -e4",
        ],
    ),
];

/// Numbers from a seed (splitmix64), and the number of coordinates of the moment.
pub struct Draw {
    state: u64,
    /// Coordinates `x0, …` of the system that is drawn.
    pub dimension: usize,
    /// The square of the radius that all terms of one Hamiltonian share.
    pub radius: String,
}

impl Draw {
    /// A number below a bound.
    pub fn below(&mut self, bound: usize) -> usize {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }

    /// One of the texts.
    pub fn pick<'a>(&mut self, texts: &[&'a str]) -> &'a str {
        texts[self.below(texts.len())]
    }

    fn spec(&mut self, hamiltonian: fn(&mut Draw) -> String) -> String {
        let (dimension, brackets) = ALGEBRAS[self.below(ALGEBRAS.len())];
        self.dimension = dimension;
        let names = |letter: &str| -> Vec<String> {
            (0..dimension).map(|i| format!("{letter}{i}")).collect()
        };
        let state = (0..dimension).map(|i| 0.31 + 0.17 * i as f64);
        let spec = json!({
            "format": 1,
            "name": "Drawn",
            "algebra": { "basis": names("e"), "brackets": brackets },
            "state": names("x"),
            "parameters": { "k0": "2", "k1": "3/2", "k2": "1/3", "k3": "5/7" },
            "hamiltonian": hamiltonian(self),
            "methods": ["midpoint", "lie-midpoint"],
            "initial": state.collect::<Vec<_>>(),
        });
        spec.to_string()
    }
}
