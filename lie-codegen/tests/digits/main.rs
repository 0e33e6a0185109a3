//! Generated kernels keep the digits of the formula that was written: systems with springs, anchors, Morse,
//! Coulomb and Lennard-Jones terms near equilibrium, against double-double. What is compared with is the
//! written formula with its derivatives by the rules of differentiation, in the same precision.

mod scalar;

use std::collections::HashMap;

use lie_codegen::compile::{compile_spec, source};
use lie_codegen::derive::{Kernel, Shape, Source};
use lie_codegen::schedule::{Known, Operation, Program, Task, Value, schedule};
use lie_codegen::symbolic::{ExprId, Function, Symbol};
use scalar::{Jet, Number, Pair};

/// Steele, Lea, Flood (2014): SplitMix.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// A length between two coordinates, or of one from an anchor.
#[derive(Clone, Copy, Debug)]
struct Length {
    from: usize,
    to: Option<usize>,
    /// The parameter that is the length at rest.
    rest: usize,
}

/// A term of H; the numbers are positions of parameters.
#[derive(Clone, Copy, Debug)]
enum Term {
    /// `K*(x - y - l)^2/2`
    Spring(usize, Length),
    /// `D*(1 - exp(-a*(x - y - l)))^2`
    Morse(usize, usize, Length),
    /// `q/(x - y)`
    Coulomb(usize, Length),
    /// `q/sqrt(e^2 + (x - y - l)^2)`
    Softened(usize, usize, Length),
    /// `(s/(x - y))^12 - (s/(x - y))^6`
    LennardJones(usize, Length),
    /// `b*sqrt(1 + x^2)`
    Root(usize, usize),
    /// `x^2/(2*b)`
    Square(usize, usize),
}

struct System {
    algebra: usize,
    terms: Vec<Term>,
    parameters: Vec<f64>,
    /// The state at rest.
    rest: Vec<f64>,
}

/// Basis size and brackets of the algebras: so(3), se(3), so(3) + so(3), the Heisenberg algebra of two pairs.
const ALGEBRAS: [(usize, &[(usize, usize, usize)]); 4] = [
    (3, &[(0, 1, 2), (1, 2, 0), (2, 0, 1)]),
    (
        6,
        &[
            (0, 1, 2),
            (1, 2, 0),
            (2, 0, 1),
            (0, 4, 5),
            (1, 5, 3),
            (2, 3, 4),
            (3, 1, 5),
            (4, 2, 3),
            (5, 0, 4),
        ],
    ),
    (
        6,
        &[
            (0, 1, 2),
            (1, 2, 0),
            (2, 0, 1),
            (3, 4, 5),
            (4, 5, 3),
            (5, 3, 4),
        ],
    ),
    (5, &[(0, 1, 4), (2, 3, 4)]),
];

impl System {
    fn random(random: &mut Random) -> Self {
        let algebra = random.below(ALGEBRAS.len());
        let n = ALGEBRAS[algebra].0;
        // Numbers that single precision has too.
        let rest: Vec<f64> = (0..n)
            .map(|i| 1.0 + (i * 64 + random.below(48)) as f64 / 64.0)
            .collect();
        let mut system = Self {
            algebra,
            terms: Vec::new(),
            parameters: Vec::new(),
            rest,
        };
        for _ in 0..2 + random.below(3) {
            let term = system.term(random);
            system.terms.push(term);
        }
        system
    }

    fn parameter(&mut self, value: f64) -> usize {
        self.parameters.push(value);
        self.parameters.len() - 1
    }

    /// A stiffness, a depth, a range.
    fn size(&mut self, random: &mut Random) -> usize {
        let size = (1 + random.below(7)) as f64 * 2f64.powi(random.below(20) as i32 - 4);
        self.parameter(size)
    }

    fn length(&mut self, random: &mut Random) -> Length {
        let n = self.rest.len();
        let from = random.below(n);
        let to = Some(random.below(n)).filter(|to| *to != from);
        let rest = self.rest[from] - to.map_or(0.0, |to| self.rest[to]);
        Length {
            from,
            to,
            rest: self.parameter(rest),
        }
    }

    fn term(&mut self, random: &mut Random) -> Term {
        let size = self.size(random);
        match random.below(7) {
            0 => Term::Spring(size, self.length(random)),
            1 => {
                let range = self.parameter(1.5);
                Term::Morse(size, range, self.length(random))
            }
            2 => Term::Coulomb(size, self.length(random)),
            3 => {
                let soft = self.parameter(0.25);
                Term::Softened(size, soft, self.length(random))
            }
            4 => {
                let length = self.length(random);
                let s = self.parameter(self.parameters[length.rest].abs());
                Term::LennardJones(s, length)
            }
            5 => Term::Root(size, random.below(self.rest.len())),
            _ => Term::Square(size, random.below(self.rest.len())),
        }
    }

    fn spec(&self) -> String {
        let (n, brackets) = ALGEBRAS[self.algebra];
        let list = |items: Vec<String>| {
            let quoted: Vec<String> = items.iter().map(|item| format!("{item:?}")).collect();
            quoted.join(", ")
        };
        let basis = list((0..n).map(|i| format!("e{i}")).collect());
        let state = list((0..n).map(|i| format!("x{i}")).collect());
        let brackets = brackets
            .iter()
            .map(|(i, j, k)| format!("[e{i}, e{j}] = e{k}"));
        let brackets = list(brackets.collect());
        let parameters: Vec<String> = self
            .parameters
            .iter()
            .enumerate()
            .map(|(i, value)| format!("\"p{i}\": {value:?}"))
            .collect();
        let terms: Vec<String> = self.terms.iter().map(text).collect();
        format!(
            r#"{{"format": 1, "name": "Rest", "algebra": {{"basis": [{basis}], "brackets": [{brackets}]}},
            "state": [{state}], "parameters": {{{}}}, "hamiltonian": "{}"}}"#,
            parameters.join(", "),
            terms.join(" + ")
        )
    }

    /// H with its derivatives, as it is written.
    fn written<T: Number>(&self, state: &[f64]) -> Jet<T> {
        let n = state.len();
        let x: Vec<Jet<T>> = (0..n)
            .map(|i| Jet::variable(T::of(state[i]), i, n))
            .collect();
        let p = |i: usize| Jet::constant(T::of(self.parameters[i]), n);
        let c = |value: f64| Jet::constant(T::of(value), n);
        let distance = |l: &Length| match l.to {
            Some(to) => x[l.from].sub(&x[to]),
            None => x[l.from].clone(),
        };
        let stretch = |l: &Length| distance(l).sub(&p(l.rest));
        let term = |term: &Term| match term {
            Term::Spring(k, l) => p(*k).mul(&stretch(l).powi(2)).mul(&c(0.5)),
            Term::Morse(d, a, l) => {
                let exponent = c(0.0).sub(&p(*a)).mul(&stretch(l));
                p(*d).mul(&c(1.0).sub(&exponent.exp()).powi(2))
            }
            Term::Coulomb(q, l) => p(*q).mul(&distance(l).recip()),
            Term::Softened(q, e, l) => {
                let square = p(*e).powi(2).add(&stretch(l).powi(2));
                p(*q).mul(&square.sqrt().recip())
            }
            Term::LennardJones(s, l) => {
                let ratio = p(*s).mul(&distance(l).recip());
                ratio.powi(12).sub(&ratio.powi(6))
            }
            Term::Root(b, i) => p(*b).mul(&c(1.0).add(&x[*i].powi(2)).sqrt()),
            Term::Square(b, i) => x[*i].powi(2).mul(&c(2.0).mul(&p(*b)).recip()),
        };
        let mut terms = self.terms.iter().map(term);
        let first = terms.next().expect("a term");
        terms.fold(first, |sum, term| sum.add(&term))
    }

    /// The results of the basic kernels as the written formula gives them, by the names of the kernels.
    fn results<T: Number>(&self, state: &[f64]) -> HashMap<&'static str, Vec<T>> {
        let (n, brackets) = ALGEBRAS[self.algebra];
        let h = self.written::<T>(state);
        let zero = T::of(0.0);
        let mu: Vec<T> = state.iter().map(|x| T::of(*x)).collect();
        // mu_j' = C_ij^k (dH/dmu_i) mu_k
        let mut field = vec![zero; n];
        let mut jacobian = vec![zero; n * n];
        let both = brackets
            .iter()
            .flat_map(|(i, j, k)| [(*i, *j, *k, 1.0), (*j, *i, *k, -1.0)]);
        for (i, j, k, sign) in both {
            let sign = T::of(sign);
            field[j] = field[j].add(sign.mul(h.first[i].mul(mu[k])));
            for l in 0..n {
                let entry = &mut jacobian[j * n + l];
                *entry = entry.add(sign.mul(h.second[i][l].mul(mu[k])));
                if l == k {
                    *entry = entry.add(sign.mul(h.first[i]));
                }
            }
        }
        HashMap::from([
            ("hamiltonian", vec![h.value]),
            ("gradient", h.first),
            ("hessian", h.second.concat()),
            ("vector_field", field),
            ("jacobian", jacobian),
        ])
    }
}

fn text(term: &Term) -> String {
    let distance = |l: &Length| match l.to {
        Some(to) => format!("x{} - x{to}", l.from),
        None => format!("x{}", l.from),
    };
    let stretch = |l: &Length| format!("({} - p{})", distance(l), l.rest);
    match term {
        Term::Spring(k, l) => format!("p{k}*{}^2/2", stretch(l)),
        Term::Morse(d, a, l) => format!("p{d}*(1 - exp(-p{a}*{}))^2", stretch(l)),
        Term::Coulomb(q, l) => format!("p{q}/({})", distance(l)),
        Term::Softened(q, e, l) => format!("p{q}/sqrt(p{e}^2 + {}^2)", stretch(l)),
        Term::LennardJones(s, l) => {
            format!("(p{s}/({0}))^12 - (p{s}/({0}))^6", distance(l))
        }
        Term::Root(b, i) => format!("p{b}*sqrt(1 + x{i}^2)"),
        Term::Square(b, i) => format!("x{i}^2/(2*p{b})"),
    }
}

/// An interpreter of programs in any precision.
fn run<T: Number>(
    program: &Program,
    symbol: &dyn Fn(Symbol) -> T,
    prepared: &HashMap<ExprId, T>,
) -> Vec<T> {
    let mut done: Vec<T> = Vec::new();
    let get = |operand: &Value, done: &[T]| match operand {
        Value::Symbol(s) => symbol(*s),
        Value::Prepared(id) => prepared[id],
        Value::Number(number) => T::of(number.to_f64()),
        Value::Temporary(index) => done[*index],
    };
    for operation in &program.operations {
        let at = |operand: &Value| get(operand, &done);
        let result = match operation {
            Operation::Add(a, b) => at(a).add(at(b)),
            Operation::Sub(a, b) => at(a).sub(at(b)),
            Operation::Mul(a, b) => at(a).mul(at(b)),
            Operation::Div(a, b) => at(a).div(at(b)),
            Operation::Neg(a) => T::of(0.0).sub(at(a)),
            Operation::Sqrt(a) => at(a).sqrt(),
            Operation::Call(Function::Exp, arguments) => at(&arguments[0]).exp(),
            other => panic!("{other:?} in a system without it"),
        };
        done.push(result);
    }
    let outputs = program.outputs.iter();
    outputs.map(|output| get(output, &done)).collect()
}

/// The prepared constants of a program, computed as generated code computes them.
fn constants<T: Number>(
    program: &Program,
    source: &mut Source,
    parameters: &[f64],
) -> HashMap<ExprId, T> {
    let operands = program.operations.iter().flat_map(Operation::operands);
    let ids: Vec<ExprId> = operands
        .chain(&program.outputs)
        .filter_map(|value| match value {
            Value::Prepared(id) => Some(*id),
            _ => None,
        })
        .collect();
    let task = Task {
        definitions: Vec::new(),
        outputs: ids.clone(),
        known: Known::Nothing,
    };
    let preparation = schedule(&mut source.graph, &task);
    let symbol = |s| match s {
        Symbol::Parameter(i) => T::of(parameters[i]),
        other => panic!("{other:?} in a prepared constant"),
    };
    let values = run(&preparation, &symbol, &HashMap::new());
    ids.into_iter().zip(values).collect()
}

/// The entries of a kernel in the order of the full vector or matrix.
fn full<T: Number>(kernel: &Kernel, n: usize, values: Vec<T>) -> Vec<T> {
    let (length, places): (usize, Vec<usize>) = match &kernel.shape {
        Shape::Scalar => return values,
        Shape::Vector(places) => (n, places.clone()),
        Shape::Matrix(places) => (n * n, places.iter().map(|(i, j)| i * n + j).collect()),
        Shape::VectorAndMatrix(..) => panic!("not compared here"),
    };
    let mut all = vec![T::of(0.0); length];
    for (place, value) in places.into_iter().zip(values) {
        all[place] = value;
    }
    all
}

/// The greatest loss against the written formula over all results, and where.
fn loss<T: Number>(system: &System, states: &[Vec<f64>], unit: f64) -> (f64, String) {
    let model = compile_spec(&system.spec()).unwrap_or_else(|e| panic!("{}: {e:?}", system.spec()));
    let mut source = source(&model);
    let n = system.rest.len();
    let kernels: Vec<Kernel> = source.basic_kernels();
    let mut worst = (0.0, String::new());
    for kernel in &kernels {
        let names = [
            "hamiltonian",
            "gradient",
            "hessian",
            "vector_field",
            "jacobian",
        ];
        if !names.contains(&kernel.name) {
            continue;
        }
        let program = kernel.program(&mut source.graph);
        let prepared = constants::<T>(&program, &mut source, &system.parameters);
        let mut errors: Vec<(f64, f64)> = Vec::new();
        for state in states {
            let symbol = |s| match s {
                Symbol::Coordinate(i) => T::of(state[i]),
                Symbol::Parameter(i) => T::of(system.parameters[i]),
                other => panic!("{other:?}"),
            };
            let found = full(kernel, n, run(&program, &symbol, &prepared));
            let written = &system.results::<T>(state)[kernel.name];
            let exact = &system.results::<Pair>(state)[kernel.name];
            errors.resize(exact.len(), (0.0, 0.0));
            for (error, ((found, written), exact)) in
                errors.iter_mut().zip(found.iter().zip(written).zip(exact))
            {
                let off = |value: &T| Pair::of(value.to_f64()).sub(*exact).to_f64().abs();
                error.0 = f64::max(error.0, off(found));
                error.1 = error
                    .1
                    .max(off(written))
                    .max(2.0 * unit * exact.to_f64().abs());
                assert!(off(found).is_finite(), "{} {}", kernel.name, system.spec());
            }
        }
        for (entry, (found, written)) in errors.iter().enumerate() {
            if *found > worst.0 * written {
                let place = format!("{} {entry} of {}", kernel.name, system.spec());
                worst = (found / written, place);
            }
        }
    }
    worst
}

/// States within `2^nearness` of equilibrium.
fn states(system: &System, random: &mut Random, nearness: i32) -> Vec<Vec<f64>> {
    let mut state = || {
        let off = |x: &f64| x + (random.below(15) as f64 - 7.0) * 2f64.powi(nearness);
        system.rest.iter().map(off).collect()
    };
    (0..12).map(|_| state()).collect()
}

/// The greatest loss over that many systems.
fn audit<T: Number>(count: u64, nearness: i32, unit: f64) -> (f64, String) {
    // Where the digits go is seen with `--nocapture`.
    let losses = (0..count).map(|seed| {
        let mut random = Random(2018 + seed);
        let system = System::random(&mut random);
        let states = states(&system, &mut random, nearness);
        loss::<T>(&system, &states, unit)
    });
    let worst = losses.max_by(|a, b| a.0.total_cmp(&b.0)).expect("systems");
    println!("the greatest loss is {:.2}: {}", worst.0, worst.1);
    worst
}

#[test]
fn near_equilibrium_in_double_precision() {
    let (worst, place) = audit::<f64>(300, -34, f64::EPSILON / 2.0);
    assert!(worst <= 16.0, "{worst}: {place}");
}

#[test]
fn near_equilibrium_in_single_precision() {
    let (worst, place) = audit::<f32>(300, -18, f64::from(f32::EPSILON) / 2.0);
    assert!(worst <= 16.0, "{worst}: {place}");
}

/// A spring of stiffness 1e10 stretched by 1e-10: the control multiplies out and must fail.
#[test]
fn a_stiff_spring() {
    let system = System {
        algebra: 0,
        terms: vec![
            Term::Spring(
                0,
                Length {
                    from: 0,
                    to: Some(1),
                    rest: 1,
                },
            ),
            Term::Square(2, 2),
        ],
        parameters: vec![1e10, 0.0, 2.0],
        rest: vec![1.0, 1.0, 0.5],
    };
    let state = vec![vec![1.0 + 1e-10, 1.0, 0.5]];
    let (worst, place) = loss::<f64>(&system, &state, f64::EPSILON / 2.0);
    assert!(worst <= 4.0, "{worst}: {place}");
    let (k, x, y) = (1e10, state[0][0], state[0][1]);
    let exact = &system.results::<Pair>(&state[0])["vector_field"][2];
    let expanded = k * x * x - k * y * y;
    let lost = Pair::of(expanded).sub(*exact).to_f64().abs() / exact.to_f64().abs();
    assert!(lost > 1e-9, "the control lost {lost}");
}

/// The results of a kernel of a spec at a state, and the exact ones by double-double.
fn kernel<T: Number>(spec: &str, name: &str, parameters: &[f64], state: &[f64]) -> Vec<T> {
    let model = compile_spec(spec).unwrap_or_else(|e| panic!("{spec}: {e:?}"));
    let mut source = source(&model);
    let kernels = source.basic_kernels();
    let kernel = kernels.iter().find(|kernel| kernel.name == name);
    let program = kernel.expect("a kernel").program(&mut source.graph);
    let prepared = constants::<T>(&program, &mut source, parameters);
    let symbol = |s| match s {
        Symbol::Coordinate(i) => T::of(state[i]),
        Symbol::Parameter(i) => T::of(parameters[i]),
        other => panic!("{other:?}"),
    };
    run(&program, &symbol, &prepared)
}

/// A system on so(3) with this Hamiltonian; its parameters are a, b, c.
fn spec(hamiltonian: &str) -> String {
    format!(
        r#"{{"format": 1, "name": "Case", "algebra": {{"basis": ["e1", "e2", "e3"],
        "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}}, "state": ["x", "y", "z"],
        "parameters": {{"a": 1, "b": 2, "c": 3}}, "hamiltonian": "{hamiltonian}"}}"#
    )
}

/// `1/r - z^2/r^3` has no digit at z = 1e8; `1/r^3` has all.
#[test]
fn the_second_derivative_of_a_radius() {
    let text = spec("sqrt(1 + z^2) + a*x + b*y + c*x*y");
    let z = 1e8;
    let hessian = kernel::<f64>(&text, "hessian", &[1.0, 2.0, 3.0], &[1.0, 1.0, z]);
    let exact = 1e-24 * (1.0 - 1.5e-16);
    let found = hessian
        .iter()
        .find(|entry| (*entry / exact - 1.0).abs() < 1e-14);
    assert!(found.is_some(), "{hessian:?}");
    // the control: by the rules of differentiation
    let r = (1.0 + z * z).sqrt();
    let ruled = 1.0 / r - z * z / (r * r * r);
    assert!((ruled / exact - 1.0).abs() > 0.5, "{ruled}");
    // in three dimensions too: (x^2 + y^2)/r^3
    let text = spec("sqrt(x^2 + y^2 + z^2) + a*x + b*y + c*x*y");
    let hessian = kernel::<f64>(&text, "hessian", &[1.0, 2.0, 3.0], &[1.0, 1.0, z]);
    let found = hessian
        .iter()
        .find(|entry| (*entry / 2e-24 - 1.0).abs() < 1e-14);
    assert!(found.is_some(), "{hessian:?}");
}

/// A prepared difference is computed before it is multiplied.
#[test]
fn a_prepared_constant() {
    let text = spec("a*(b - c)*y^2 + x^2");
    let parameters = [1.0 / 3.0, 1.0 + 1e-12, 1.0];
    let exact = Pair::of(parameters[0]).mul(Pair::of(parameters[1]).sub(Pair::of(parameters[2])));
    let energy = kernel::<f64>(&text, "hamiltonian", &parameters, &[0.0, 1.0, 0.0])[0];
    let error = Pair::of(energy).sub(exact).to_f64().abs() / exact.to_f64();
    assert!(error < 1e-15, "{error}");
    let expanded = parameters[0] * parameters[1] - parameters[0] * parameters[2];
    let lost = Pair::of(expanded).sub(exact).to_f64().abs() / exact.to_f64();
    assert!(lost > 1e-7, "the control lost {lost}");
}

/// The twelfth power of a ratio stays in range where those of its terms do not.
#[test]
fn the_power_of_a_ratio_in_single_precision() {
    let text = spec("(a/x)^12 - (a/x)^6 + (y + z)^2");
    for scale in [1e-5, 1e5] {
        let state = [1.25 * scale, 0.0, 0.0];
        let energy = kernel::<f32>(&text, "hamiltonian", &[scale, 2.0, 3.0], &state)[0];
        let exact = 0.8f64.powi(12) - 0.8f64.powi(6);
        assert!((f64::from(energy) / exact - 1.0).abs() < 3e-6, "{energy}");
        let control = (scale as f32).powi(12) * (state[0] as f32).powi(-12);
        assert!(control == 0.0 || !control.is_finite(), "{control}");
    }
}

/// Field and Jacobian are the same numbers alone and in `linearize`.
#[test]
fn kernels_agree_bit_for_bit() {
    let mut compared = 0;
    for seed in 0..60 {
        let mut random = Random(77 + seed);
        let system = System::random(&mut random);
        let text = system.spec();
        let model = compile_spec(&text).expect("a system");
        let mut source = source(&model);
        let kernels = source.basic_kernels();
        let state = states(&system, &mut random, -3).remove(0);
        let mut results = |name: &str| {
            let kernel = kernels.iter().find(|kernel| kernel.name == name);
            let program = kernel.expect("a kernel").program(&mut source.graph);
            let prepared = constants::<f64>(&program, &mut source, &system.parameters);
            let symbol = |s| match s {
                Symbol::Coordinate(i) => state[i],
                Symbol::Parameter(i) => system.parameters[i],
                other => panic!("{other:?}"),
            };
            run(&program, &symbol, &prepared)
        };
        let mut apart = results("vector_field");
        apart.extend(results("jacobian"));
        let together = results("linearize");
        assert_eq!(apart.len(), together.len());
        for (a, b) in apart.iter().zip(&together) {
            assert_eq!(a.to_bits(), b.to_bits(), "{text}");
            compared += 1;
        }
    }
    assert!(compared > 500, "{compared}");
}
