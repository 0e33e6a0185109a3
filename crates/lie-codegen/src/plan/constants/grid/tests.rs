use lie_symbolic::schedule::schedule;

use super::*;

/// A draw of numbers between 0 and 1.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / 2.0_f64.powi(53)
    }

    /// Of either sign, of sizes up to the factor apart.
    fn number(&mut self, factor: f64) -> f64 {
        let size = factor.powf(self.next());
        if self.next() < 0.3 { -size } else { size }
    }
}

fn exactly(value: f64) -> Rational {
    Rational::from_f64(value).expect("finite")
}

/// The constants of a field of so(3) with three inverses of parameters, and the same times a step size over four.
fn of_three(graph: &mut Graph) -> Vec<ExprId> {
    let inverse: Vec<ExprId> = (0..3)
        .map(|k| {
            let moment = graph.symbol(Symbol::Parameter(k));
            graph.pow(moment, &Rational::MINUS_ONE)
        })
        .collect();
    let h = graph.symbol(Symbol::Step);
    let h = graph.scale(h, &Rational::new(1, 4).expect("a number"));
    let mut all = inverse.clone();
    all.extend((0..3).map(|k| graph.sub(inverse[(k + 1) % 3], inverse[k])));
    let of_step: Vec<ExprId> = all.iter().map(|c| graph.mul(*c, h)).collect();
    all.extend(of_step);
    all
}

fn values(graph: &mut Graph, task: &Task, [a, b, c, h]: [f64; 4]) -> Vec<f64> {
    let program = schedule(graph, task);
    let of = |symbol| match symbol {
        Symbol::Parameter(k) => [a, b, c][k],
        _ => h,
    };
    program.evaluate(&of, &|_| unreachable!("nothing is prepared"))
}

/// How many of the relations between three numbers and their differences fail.
fn broken(values: &[f64]) -> usize {
    let value = |k: usize| exactly(values[k]);
    let fails = |k: usize| value(3 + k) != &value((k + 1) % 3) - &value(k);
    (0..3).filter(|k| fails(*k)).count()
}

#[test]
fn differences_of_what_is_on_a_grid_are_exact() {
    let mut graph = Graph::new();
    let constants = of_three(&mut graph);
    let apart = Task {
        definitions: Vec::new(),
        outputs: constants.clone(),
        known: KnownSymbols::Nothing,
    };
    let together = preparation(&mut graph, &constants);
    let (mut draw, mut control) = (Draw(7), 0);
    for _ in 0..300 {
        let moments: [f64; 3] = core::array::from_fn(|_| draw.number(500.0));
        let given = [moments[0], moments[1], moments[2], draw.number(50.0)];
        let plain = values(&mut graph, &apart, given);
        let found = values(&mut graph, &together, given);
        for (plain, found) in [(&plain[..6], &found[..6]), (&plain[6..], &found[6..])] {
            assert_eq!(broken(found), 0, "{given:?}");
            control += usize::from(broken(plain) > 0);
            let largest = plain.iter().fold(0.0, |all: f64, c| all.max(c.abs()));
            for (plain, found) in plain.iter().zip(found) {
                assert!(
                    (plain - found).abs() <= 2.0 * f64::EPSILON * largest,
                    "{given:?}"
                );
            }
        }
        // powers of two in the moments change no digit
        let scaled = given.map(|x| x * 2.0_f64.powi(-40));
        let scaled = values(
            &mut graph,
            &together,
            [scaled[0], scaled[1], scaled[2], given[3]],
        );
        let back: Vec<f64> = scaled.iter().map(|c| c * 2.0_f64.powi(-40)).collect();
        assert_eq!(back, found);
    }
    assert!(control > 300, "rounded apart, {control} of 600 fail");
}

#[test]
fn what_is_small_keeps_its_digits() {
    let mut graph = Graph::new();
    let constants = of_three(&mut graph);
    let task = preparation(&mut graph, &constants);
    let found = values(&mut graph, &task, [3e5, 0.7, 0.3, 0.1]);
    assert_eq!(found[0], 1.0 / 3e5);
    assert_eq!(
        broken(&[0.0, found[1], found[2], found[1], found[4], -found[2]]),
        0
    );
    let none = values(&mut graph, &task, [0.0, 0.7, 0.3, 0.1]);
    assert!(!none[0].is_finite() && none[1..3] == [1.0 / 0.7, 1.0 / 0.3]);
}

#[test]
fn sums_without_relations_are_left_alone() {
    let mut graph = Graph::new();
    let [a, b] = [0, 1].map(|k| graph.symbol(Symbol::Parameter(k)));
    let sum = graph.add(a, b);
    assert!(preparation(&mut graph, &[sum, a]).definitions.is_empty());
    let task = preparation(&mut graph, &[sum, a, b]);
    assert!(!task.definitions.is_empty());
    // a third of both is a number of its own
    let third = Rational::new(1, 3).expect("a number");
    let thirds = [sum, a, b].map(|c| graph.scale(c, &third));
    let task = preparation(&mut graph, &thirds);
    let [a, b] = [0.1, 0.7];
    let found = values(&mut graph, &task, [a, b, 0.0, 0.0]);
    assert_eq!(exactly(found[0]), &exactly(found[1]) + &exactly(found[2]));
}
