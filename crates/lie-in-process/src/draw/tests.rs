use super::*;
use lie_codegen::compile::compile_spec;

fn system(name: &str) -> (Dynamic<f64>, Vec<f64>, bool) {
    let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
    system_of(&std::fs::read_to_string(path).unwrap())
}

fn system_of(text: &str) -> (Dynamic<f64>, Vec<f64>, bool) {
    let model = compile_spec(text).unwrap();
    let declared = crate::declared(&model).unwrap();
    let system = declared.system(&model.defaults()).unwrap();
    let initial = system.initial_state().unwrap();
    (system, initial, model.is_lie_poisson())
}

fn casimirs(system: &Dynamic<f64>, state: &Vec<f64>) -> Vec<f64> {
    let count = Poisson::<f64>::casimir_count(system);
    let mut values = vec![0.0; count];
    system.casimirs(state, &mut values);
    values
}

#[test]
fn states_are_on_the_orbit_and_not_all_near() {
    for (name, spread) in [
        ("so3_free_rigid_body", Spread::Normal(0.1)),
        ("so3_free_rigid_body", Spread::Orbit),
        ("se3_heavy_top", Spread::Normal(0.3)),
        ("lotka_volterra", Spread::Normal(0.05)),
    ] {
        let (system, initial, orbits) = system(name);
        let draw = Draw {
            count: 100,
            seed: 7,
            spread,
        };
        let expected = casimirs(&system, &initial);
        let mut far = 0.0_f64;
        for number in 0..100 {
            let state = draw.within(&system, orbits).state(&initial, number);
            for (found, expected) in casimirs(&system, &state).iter().zip(&expected) {
                let error = (found - expected).abs() / (1.0 + expected.abs());
                let most = if orbits { 1e-13 } else { 1e-8 };
                assert!(error < most, "{name}, {spread:?}: {error:e}");
            }
            let moved = state.iter().zip(&initial).map(|(a, b)| (a - b).abs());
            far = moved.fold(far, f64::max);
            assert_eq!(state, draw.within(&system, orbits).state(&initial, number));
        }
        assert!(far > 0.01, "{name}, {spread:?}: {far}");
    }
}

#[test]
fn what_carries_the_time_is_not_drawn() {
    let (system, initial, orbits) = system_of(
        r#"{"name": "Spin", "algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "-z", "initial": [1, 0, 0],
            "dissipation": [{"kind": "double-bracket", "strength": 1, "temperature": "1/2"}]}"#,
    );
    assert!(keeps_norm(&system));
    let draw = Draw {
        count: 2000,
        seed: 3,
        spread: Spread::Orbit,
    };
    let within = draw.within(&system, orbits);
    let mut states = (0..2000).map(|number| within.state(&initial, number));
    assert!(states.all(|state| state[3..] == initial[3..]));
    let parts = (0..2000).map(|number| within.state(&initial, number)[..3].to_vec());
    let found = uneven(parts);
    assert!(found < 4.0, "{found}");
}

#[test]
fn an_orbit_is_covered_evenly() {
    let (system, initial, orbits) = system("so3_free_rigid_body");
    assert!(keeps_norm(&system) && !keeps_norm(&self::system("se3_heavy_top").0));
    let count = 20_000;
    let moments = |spread| {
        let draw = Draw {
            count,
            seed: 1,
            spread,
        };
        let norm = initial.iter().map(|x| x * x).sum::<f64>();
        let mut moments = [0.0; 6];
        let within = draw.within(&system, orbits);
        for number in 0..count as u64 {
            let state = within.state(&initial, number);
            for i in 0..3 {
                moments[i] += state[i] / norm.sqrt() / count as f64;
                moments[3 + i] += state[i] * state[i] / norm / count as f64;
            }
        }
        moments
    };
    // of a uniform distribution on the sphere 0 and 1/3, to four standard deviations of the mean
    let even = |moments: [f64; 6]| {
        (0..3).all(|i| moments[i].abs() < 4.0 / (3.0 * count as f64).sqrt())
            && (3..6).all(|i| (moments[i] - 1.0 / 3.0).abs() < 4.0 * 0.3 / (count as f64).sqrt())
    };
    assert!(even(moments(Spread::Orbit)), "{:?}", moments(Spread::Orbit));
    assert!(!even(moments(Spread::Normal(1.0))), "the control");
}

/// A spec by structure constants: of each bracket the factor, with the indices of basis elements.
fn by_constants(size: usize, brackets: &[(usize, usize, &str, usize)]) -> String {
    let basis = (1..=size).map(|k| format!("\"e{k}\""));
    let state = (1..=size).map(|k| format!("\"x{k}\""));
    // a start that is not the same along all of them
    let initial = (1..=size).map(|k| format!("\"{}/3\"", k % 3 + k / 4));
    let mut sums = std::collections::BTreeMap::<_, Vec<String>>::new();
    for (i, j, factor, k) in brackets {
        for (i, j, k) in [(i, j, k), (j, k, i), (k, i, j)] {
            let (pair, sign) = if i < j { ((i, j), "") } else { ((j, i), "-") };
            sums.entry(pair)
                .or_default()
                .push(format!("{sign}{factor}*e{k}"));
        }
    }
    let brackets = sums.iter().map(|((i, j), sum)| {
        format!(
            "\"[e{i}, e{j}] = {}\"",
            sum.join(" + ").replace("+ -", "- ")
        )
    });
    let list = |items: &mut dyn Iterator<Item = String>| items.collect::<Vec<_>>().join(", ");
    format!(
        "{{\"format\": 1, \"name\": \"Scaled\", \"algebra\": {{\"basis\": [{}], \"brackets\": [{}]}}, \"state\": [{}], \
         \"hamiltonian\": \"x1^2 + 2*x2^2\", \"initial\": [{}]}}",
        list(&mut basis.into_iter()),
        list(&mut brackets.into_iter()),
        list(&mut state.into_iter()),
        list(&mut initial.into_iter()),
    )
}

/// The largest mean of a coordinate, in standard deviations of it.
fn uneven(states: impl Iterator<Item = Vec<f64>>) -> f64 {
    let states: Vec<_> = states.collect();
    let count = states.len() as f64;
    let of = |k: usize| {
        let mean = states.iter().map(|state| state[k]).sum::<f64>() / count;
        let square = states
            .iter()
            .map(|state| (state[k] - mean).powi(2))
            .sum::<f64>();
        mean.abs() / (square / (count * (count - 1.0))).sqrt()
    };
    (0..states[0].len()).map(of).fold(0.0, f64::max)
}

#[test]
fn an_orbit_is_covered_whatever_the_structure_constants() {
    // e1 + e4 and e1 - e4 and so on, of [e1, e2] = e3 and [e4, e5] = e6 / 50
    let mixed: Vec<_> = (0..8)
        .map(|bits: usize| {
            let [a, b, c] = [0, 1, 2].map(|bit| bits >> bit & 1);
            let odd = (a + b + c) % 2 == 1;
            (
                1 + 3 * a,
                2 + 3 * b,
                if odd { "49/100" } else { "51/100" },
                3 + 3 * c,
            )
        })
        .collect();
    for (name, size, brackets) in [
        ("small so(3)", 3, vec![(1, 2, "1/100", 3)]),
        ("tiny so(3)", 3, vec![(1, 2, "1/1000000000000", 3)]),
        ("large so(3)", 3, vec![(1, 2, "300", 3)]),
        ("two scales", 6, vec![(1, 2, "1/100", 3), (4, 5, "7", 6)]),
        (
            "two scales and a center",
            7,
            vec![(1, 3, "1/100", 4), (5, 6, "7", 7)],
        ),
        ("mixed", 6, mixed),
    ] {
        let (system, initial, orbits) = system_of(&by_constants(size, &brackets));
        assert!(orbits && keeps_norm(&system), "{name}");
        let draw = Draw {
            count: 2000,
            seed: 3,
            spread: Spread::Orbit,
        };
        let within = draw.within(&system, orbits);
        let still = |k: usize| {
            brackets
                .iter()
                .all(|(a, b, _, c)| ![*a, *b, *c].contains(&(k + 1)))
        };
        let moving: Vec<usize> = (0..size).filter(|k| !still(*k)).collect();
        let part = |state: Vec<f64>| moving.iter().map(|k| state[*k]).collect::<Vec<f64>>();
        let found = uneven((0..2000).map(|number| part(within.state(&initial, number))));
        assert!(found < 4.0, "{name}: {found}");
        // the control: steps of the deviation 1 in each coordinate
        let plain = (0..2000).map(|number| {
            let (mut source, mut state) = (stream(3, number), initial.clone());
            for _ in 0..WALK {
                let xi: Vec<f64> = state.iter().map(|_| source.normal()).collect();
                state = within.moved(&xi, state);
            }
            part(state)
        });
        assert!(
            name.starts_with("large") || uneven(plain) > 8.0,
            "{name}: the control"
        );
    }
}

#[test]
fn an_orbit_of_higher_rank_is_covered() {
    for (algebra, size) in [("so(5)", 10), ("so(4)", 6)] {
        let state = (0..size)
            .map(|k| format!("\"x{k}\""))
            .collect::<Vec<_>>()
            .join(", ");
        let initial = (0..size)
            .map(|k| (k % 3).to_string())
            .collect::<Vec<_>>()
            .join(", ");
        let (system, initial, orbits) = system_of(&format!(
            "{{\"format\": 1, \"name\": \"Large\", \"algebra\": \"{algebra}\", \"state\": [{state}], \"hamiltonian\": \"x1^2\", \
             \"initial\": [{initial}]}}"
        ));
        assert!(keeps_norm(&system), "{algebra}");
        let draw = Draw {
            count: 2000,
            seed: 3,
            spread: Spread::Orbit,
        };
        let within = draw.within(&system, orbits);
        let found = uneven((0..2000).map(|number| within.state(&initial, number)));
        assert!(found < 4.0, "{algebra}: {found}");
    }
}
