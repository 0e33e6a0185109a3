use super::*;
use crate::exact::Rational;
use crate::symbolic::Elementary;

fn coordinate(g: &mut Graph, i: usize) -> ExprId {
    g.symbol(Symbol::Coordinate(i))
}
fn parameter(g: &mut Graph, i: usize) -> ExprId {
    g.symbol(Symbol::Parameter(i))
}
fn rational(n: i64, d: i64) -> Rational {
    Rational::new(n, d).unwrap()
}
/// `(a, b, c) x (d, e, f)`
fn cross(g: &mut Graph, a: [ExprId; 3], b: [ExprId; 3]) -> [ExprId; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let (p, q) = (g.mul(a[i], b[j]), g.mul(a[j], b[i]));
        g.sub(p, q)
    })
}

/// Runs a program, the test's own interpreter.
fn run(program: &Program, g: &Graph, value: &dyn Fn(Symbol) -> f64) -> Vec<f64> {
    let mut temporaries: Vec<f64> = Vec::new();
    let get = |v: &Value, t: &[f64]| match v {
        Value::Symbol(s) => value(*s),
        Value::Prepared(id) => g.evaluate(*id, value),
        Value::Number(n) => n.to_f64(),
        Value::Temporary(i) => t[*i],
    };
    for operation in &program.operations {
        let t = &temporaries;
        let result = match operation {
            Operation::Add(a, b) => get(a, t) + get(b, t),
            Operation::Sub(a, b) => get(a, t) - get(b, t),
            Operation::Mul(a, b) => get(a, t) * get(b, t),
            Operation::Div(a, b) => get(a, t) / get(b, t),
            Operation::Neg(a) => -get(a, t),
            Operation::Sqrt(a) => get(a, t).sqrt(),
            Operation::Power(a, e) => get(a, t).powf(e.to_f64()),
            Operation::Call(f, a) => f.evaluate(&a.iter().map(|v| get(v, t)).collect::<Vec<_>>()),
        };
        temporaries.push(result);
    }
    program
        .outputs
        .iter()
        .map(|v| get(v, &temporaries))
        .collect()
}

fn values(symbol: Symbol) -> f64 {
    match symbol {
        Symbol::Parameter(i) => 1.3 + 0.7 * i as f64,
        Symbol::Coordinate(i) => 0.4 - 0.3 * i as f64 + 0.05 * (i * i) as f64,
        Symbol::Input(i) => 0.21 + 0.11 * i as f64,
        Symbol::Step => 0.1,
        Symbol::Time => 0.0,
    }
}

fn check(g: &mut Graph, outputs: Vec<ExprId>, known: KnownSymbols) -> Program {
    let program = schedule(
        g,
        &Task {
            definitions: vec![],
            outputs: outputs.clone(),
            known,
        },
    );
    for (result, output) in run(&program, g, &values).into_iter().zip(outputs) {
        let exact = g.evaluate(output, &values);
        assert!(
            (result - exact).abs() <= 1e-13 * exact.abs().max(1.0),
            "{result} {exact}"
        );
    }
    program
}

#[test]
fn field_of_the_free_rigid_body() {
    let mut g = Graph::new();
    let mu = [0, 1, 2].map(|i| coordinate(&mut g, i));
    let omega = [0, 1, 2].map(|i| {
        let inertia = parameter(&mut g, i);
        g.div(mu[i], inertia)
    });
    let field = cross(&mut g, mu, omega);
    let counts = check(&mut g, field.to_vec(), KnownSymbols::Parameters).counts;
    assert_eq!(
        counts,
        Counts {
            mul: 6,
            ..Counts::default()
        }
    );
}

#[test]
fn field_of_the_heavy_top() {
    let mut g = Graph::new();
    let pi = [0, 1, 2].map(|i| coordinate(&mut g, i));
    let gamma = [3, 4, 5].map(|i| coordinate(&mut g, i));
    let omega = [0, 1, 2].map(|i| {
        let inertia = parameter(&mut g, i);
        g.div(pi[i], inertia)
    });
    let mgl = parameter(&mut g, 3);
    let chi = [4, 5, 6].map(|i| {
        let c = parameter(&mut g, i);
        g.mul(mgl, c)
    });
    let (a, b) = (cross(&mut g, pi, omega), cross(&mut g, gamma, chi));
    let mut field: Vec<_> = a.iter().zip(b).map(|(&a, b)| g.add(a, b)).collect();
    field.extend(cross(&mut g, gamma, omega));
    let counts = check(&mut g, field, KnownSymbols::Parameters).counts;
    assert_eq!(
        counts,
        Counts {
            add: 9,
            mul: 21,
            ..Counts::default()
        }
    );
}

#[test]
fn powers_and_quotients_are_shared() {
    let mut g = Graph::new();
    let [x, y, z] = [0, 1, 2].map(|i| coordinate(&mut g, i));
    let fourth = g.pow(x, &rational(4, 1));
    assert_eq!(
        check(&mut g, vec![fourth], KnownSymbols::Parameters)
            .counts
            .mul,
        2
    );
    // z / sqrt(s) and z^2 / s^(3/2): one root, one division.
    let zz = g.pow(z, &rational(2, 1));
    let yy = g.pow(y, &rational(2, 1));
    let s = g.sum(&[zz, yy]);
    let a = g.power_product(&[(z, Rational::ONE), (s, rational(-1, 2))]);
    let b = g.power_product(&[(z, rational(2, 1)), (s, rational(-3, 2))]);
    let program = check(&mut g, vec![a, b], KnownSymbols::Parameters);
    assert_eq!((program.counts.div, program.counts.call), (1, 1));
    let sine = g.call(Elementary::Sin, &[s]);
    let e = g.mul(sine, a);
    let f = g.sub(sine, b);
    let third = g.pow(x, &rational(1, 3));
    check(&mut g, vec![e, f, third], KnownSymbols::Parameters);
}

#[test]
fn definitions_stay_opaque_and_signs_cost_nothing() {
    let mut g = Graph::new();
    let [x, y] = [0, 1].map(|i| coordinate(&mut g, i));
    let m = g.symbol(Symbol::Input(0));
    let h = g.symbol(Symbol::Step);
    let k = parameter(&mut g, 0);
    let middle = g.linear(&[(x, rational(1, 2)), (y, rational(1, 2))]);
    let square = g.pow(m, &rational(2, 1));
    let slope = g.product(&[h, k, square]);
    let residual = g.sub(x, slope);
    let task = Task {
        definitions: vec![(Symbol::Input(0), middle)],
        outputs: vec![residual],
        known: KnownSymbols::Step,
    };
    let program = schedule(&mut g, &task);
    // (x + y)/2: 1 addition, 1 multiplication; x - (h k) m m: 2 multiplications, 1 subtraction.
    assert_eq!(
        program.counts,
        Counts {
            add: 2,
            mul: 3,
            ..Counts::default()
        }
    );
    let (a, b) = (g.sub(x, y), g.sub(y, x));
    let (p, q) = (g.product(&[a, k, x]), g.product(&[b, k, y]));
    let counts = check(&mut g, vec![p, q], KnownSymbols::Parameters).counts;
    assert!(counts.mul + counts.add <= 5, "{counts:?}");
}

/// Random polynomials and quotients: the program equals exact evaluation, twice the same program.
#[test]
fn random_tasks_are_computed_rightly_and_reproducibly() {
    let mut state = 2018u64;
    let mut next = move |n: u64| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) % n
    };
    for _ in 0..60 {
        let mut g = Graph::new();
        let mut pool: Vec<ExprId> = (0..3).map(|i| coordinate(&mut g, i)).collect();
        pool.extend((0..2).map(|i| parameter(&mut g, i)));
        for _ in 0..14 {
            let (a, b) = (
                pool[next(pool.len() as u64) as usize],
                pool[next(pool.len() as u64) as usize],
            );
            let new = match next(7) {
                0 | 1 => g.add(a, b),
                2 => g.sub(a, b),
                3 | 4 => g.mul(a, b),
                5 => {
                    let s = g.pow(b, &rational(2, 1));
                    let one = g.integer(1);
                    let d = g.add(one, s);
                    let e = g.pow(d, &rational([-1, -2, 1, -3][next(4) as usize], 2));
                    g.mul(a, e)
                }
                _ => {
                    let small = g.scale(a, &rational(1, 7));
                    g.call(
                        [Elementary::Sin, Elementary::Tanh, Elementary::Cos][next(3) as usize],
                        &[small],
                    )
                }
            };
            pool.push(new);
        }
        let outputs: Vec<ExprId> = pool[pool.len() - 4..].to_vec();
        let first = check(&mut g, outputs.clone(), KnownSymbols::Parameters);
        let second = check(&mut g, outputs, KnownSymbols::Parameters);
        assert_eq!(first, second);
    }
}
