//! Signs: a difference that is only ever subtracted is computed the other way round where that saves a change of sign,
//! `-x - (a - b)` as `(b - a) - x`. A change of sign is exact, so that no digit changes.

use super::program::{Operation, Program, Value};

/// The program with fewer changes of sign.
pub fn signs(program: Program) -> Program {
    let mut signs = Signs::new(program);
    for place in 0..signs.program.operations.len() {
        signs.turn(place);
    }
    let outputs = 0..signs.program.outputs.len();
    signs.program.part(outputs)
}

/// A program, and where each result goes.
struct Signs {
    program: Program,
    /// The operations that use the result of each, once for every operand.
    users: Vec<Vec<usize>>,
    /// The outputs of the program that it is.
    outputs: Vec<Vec<usize>>,
}

impl Signs {
    fn new(program: Program) -> Self {
        let count = program.operations.len();
        let (mut users, mut outputs) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        for (user, operation) in program.operations.iter().enumerate() {
            for value in operation.operands() {
                if let Value::Temporary(index) = value {
                    users[*index].push(user);
                }
            }
        }
        for (output, value) in program.outputs.iter().enumerate() {
            if let Value::Temporary(index) = value {
                outputs[*index].push(output);
            }
        }
        Self {
            program,
            users,
            outputs,
        }
    }

    /// Turns a difference round if all that uses it allows that, and a change of sign is saved.
    fn turn(&mut self, place: usize) {
        let Operation::Sub(a, b) = self.program.operations[place].clone() else {
            return;
        };
        let this = Value::Temporary(place);
        let (mut subtracted, mut negated) = (Vec::new(), Vec::new());
        for &user in &self.users[place] {
            match &self.program.operations[user] {
                Operation::Sub(from, _) if *from != this => subtracted.push(user),
                Operation::Neg(_) => negated.push(user),
                _ => return,
            }
        }
        let saves = negated.len() + subtracted.iter().filter(|u| self.saves(**u, &this)).count();
        if saves == 0 || !self.outputs[place].is_empty() {
            return;
        }
        for user in subtracted {
            self.add_instead(user, &this);
        }
        self.program.operations[place] = Operation::Sub(b, a);
        for user in negated {
            self.replace(user, place);
        }
    }

    fn saves(&self, user: usize, this: &Value) -> bool {
        self.negative(user, this).is_some()
    }

    /// What a difference takes `this` away from: `-x` that nothing else uses, as its place and x. Where x is
    /// `this` itself, `-this` goes when it is turned round, not here.
    fn negative(&self, user: usize, this: &Value) -> Option<(usize, Value)> {
        let Operation::Sub(Value::Temporary(first), _) = self.program.operations[user] else {
            return None;
        };
        match &self.program.operations[first] {
            Operation::Neg(x) if x != this && self.used_once(first) => Some((first, x.clone())),
            _ => None,
        }
    }

    fn used_once(&self, place: usize) -> bool {
        self.users[place].len() == 1 && self.outputs[place].is_empty()
    }

    /// `from - this`, of which the sign of `this` has changed.
    fn add_instead(&mut self, user: usize, this: &Value) {
        let turned = match self.negative(user, this) {
            Some((negation, x)) => {
                self.users[negation].clear();
                if let Value::Temporary(index) = x {
                    let use_of_x = self.users[index].iter_mut().find(|u| **u == negation);
                    use_of_x.into_iter().for_each(|u| *u = user);
                }
                Operation::Sub(this.clone(), x)
            }
            None => match &self.program.operations[user] {
                Operation::Sub(from, _) => Operation::Add(from.clone(), this.clone()),
                other => other.clone(),
            },
        };
        self.program.operations[user] = turned;
    }

    /// Lets all that uses a negation use what it has become equal to.
    fn replace(&mut self, negation: usize, place: usize) {
        let moved = |index: usize| if index == negation { place } else { index };
        self.users[place].retain(|user| *user != negation);
        for user in std::mem::take(&mut self.users[negation]) {
            let operation = &mut self.program.operations[user];
            *operation = operation.renumbered(&moved);
            self.users[place].push(user);
        }
        for output in std::mem::take(&mut self.outputs[negation]) {
            self.program.outputs[output] = Value::Temporary(place);
            self.outputs[place].push(output);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use proptest::prelude::*;
    use proptest::sample::Index;
    use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

    use super::*;
    use crate::schedule::Counts;
    use crate::symbolic::Symbol;

    fn x(index: usize) -> Value {
        Value::Symbol(Symbol::Coordinate(index))
    }

    fn program(operations: Vec<Operation>, outputs: &[usize]) -> Program {
        let mut counts = Counts::default();
        operations.iter().for_each(|o| counts.record(o));
        Program {
            operations,
            outputs: outputs.iter().map(|i| Value::Temporary(*i)).collect(),
            counts,
        }
    }

    fn difference_and_negative() -> Vec<Operation> {
        use Operation::{Neg, Sub};
        vec![
            Sub(x(0), x(1)),
            Neg(x(2)),
            Sub(Value::Temporary(1), Value::Temporary(0)),
            Sub(x(3), Value::Temporary(0)),
        ]
    }

    #[test]
    fn a_difference_that_is_subtracted_is_turned_round() {
        use Operation::{Add, Sub};
        let found = signs(program(difference_and_negative(), &[2, 3]));
        let difference = Value::Temporary(0);
        let expected = [
            Sub(x(1), x(0)),
            Sub(difference.clone(), x(2)),
            Add(x(3), difference),
        ];
        assert_eq!(found.operations, expected);
        assert_eq!(found.counts.add, 3);
        assert_eq!(found.outputs, [Value::Temporary(1), Value::Temporary(2)]);
    }

    #[test]
    fn one_that_is_a_result_itself_is_not() {
        let found = signs(program(difference_and_negative(), &[0, 2, 3]));
        assert_eq!(found.operations, difference_and_negative());
    }

    #[test]
    fn a_difference_taken_from_its_own_negative_stays_twice_itself() {
        use Operation::{Add, Neg, Sub};
        let difference = Value::Temporary(0);
        let operations = vec![
            Sub(x(0), x(1)),
            Neg(difference.clone()),
            Sub(Value::Temporary(1), difference.clone()),
        ];
        let found = signs(program(operations, &[2]));
        let expected = [Sub(x(1), x(0)), Add(difference.clone(), difference)];
        assert_eq!(found.operations, expected);
    }

    /// Programs of a few operations, mostly differences and signs, over few values, so that the same one
    /// meets itself and its negative often.
    fn random() -> impl Strategy<Value = Program> {
        let kind = prop_oneof![5 => Just('-'), 4 => Just('n'), 1 => Just('+'), 1 => Just('*')];
        let operation = (kind, any::<Index>(), any::<Index>());
        let operations = prop::collection::vec(operation, 1..12);
        let outputs = prop::collection::vec(any::<Index>(), 1..4);
        (operations, outputs).prop_map(|(drawn, outputs)| {
            let mut operations = Vec::new();
            for (place, (kind, a, b)) in drawn.into_iter().enumerate() {
                let value = |index: Index| match index.index(place + 3) {
                    symbol @ 0..3 => x(symbol),
                    temporary => Value::Temporary(temporary - 3),
                };
                operations.push(match kind {
                    '-' => Operation::Sub(value(a), value(b)),
                    'n' => Operation::Neg(value(a)),
                    '+' => Operation::Add(value(a), value(b)),
                    _ => Operation::Mul(value(a), value(b)),
                });
            }
            let places = operations.len();
            let outputs: Vec<usize> = outputs.iter().map(|i| i.index(places)).collect();
            program(operations, &outputs)
        })
    }

    /// A change of sign is exact: all results are equal, but for the sign of a zero.
    #[test]
    fn no_result_changes() {
        let mut config = Config::with_cases(20_000);
        config.failure_persistence = None;
        let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
        let mut runner = TestRunner::new_with_rng(config, rng);
        let turned = Cell::new(0);
        let result = runner.run(&random(), |before| {
            let after = signs(before.clone());
            let at = |symbol| match symbol {
                Symbol::Coordinate(index) => [0.7, -1.3, 2.9][index],
                _ => f64::NAN,
            };
            let values = |program: &Program| program.evaluate(&at, &|_| f64::NAN);
            let same = |(a, b): (&f64, &f64)| a == b || a.is_nan() && b.is_nan();
            let (a, b) = (values(&before), values(&after));
            prop_assert!(
                a.iter().zip(&b).all(same),
                "{a:?} before, {b:?} after, {after:?}"
            );
            let live = before.part(0..before.outputs.len());
            prop_assert!(after.counts.weight() <= live.counts.weight());
            turned.set(turned.get() + usize::from(after.counts != live.counts));
            Ok(())
        });
        result.unwrap();
        assert!(
            turned.get() > 1_000,
            "only {} programs changed",
            turned.get()
        );
    }
}
