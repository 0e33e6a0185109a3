//! Signs: a difference that is only ever subtracted is computed the other way round where that saves a change of sign,
//! `-x - (a - b)` as `(b - a) - x`. A change of sign is exact, so that no digit changes.

use super::program::{Counts, Operation, Program, Value};

/// Where the result of an operation goes.
#[derive(Clone, Default)]
struct Uses {
    /// The operations that take it away from something.
    subtracted: Vec<usize>,
    /// Those that change its sign.
    negated: Vec<usize>,
    /// All, with the outputs.
    count: usize,
}

/// The program with fewer changes of sign.
pub fn signs(mut program: Program) -> Program {
    let mut uses = all_uses(&program);
    for place in 0..program.operations.len() {
        let Operation::Sub(a, b) = program.operations[place].clone() else {
            continue;
        };
        let of_this = &uses[place];
        let reversible = of_this.subtracted.len() + of_this.negated.len() == of_this.count;
        let saves = |user: &usize| negative(&program, &uses, *user).is_some();
        let saved = of_this.negated.len() + of_this.subtracted.iter().filter(|u| saves(u)).count();
        if !reversible || saved == 0 {
            continue;
        }
        let this = Value::Temporary(place);
        for &user in &of_this.subtracted {
            program.operations[user] =
                match (negative(&program, &uses, user), &program.operations[user]) {
                    (Some(x), _) => Operation::Sub(this.clone(), x),
                    (None, Operation::Sub(from, _)) => Operation::Add(from.clone(), this.clone()),
                    (None, other) => other.clone(),
                };
        }
        program.operations[place] = Operation::Sub(b, a);
        for &user in &of_this.negated {
            redirect(&mut program, user, place);
        }
        uses = all_uses(&program);
    }
    without_dead(program)
}

fn all_uses(program: &Program) -> Vec<Uses> {
    let mut uses = vec![Uses::default(); program.operations.len()];
    for (user, operation) in program.operations.iter().enumerate() {
        for value in operation.operands() {
            if let Value::Temporary(index) = value {
                uses[*index].count += 1;
            }
        }
        match operation {
            Operation::Sub(a, Value::Temporary(index)) if *a != Value::Temporary(*index) => {
                uses[*index].subtracted.push(user);
            }
            Operation::Neg(Value::Temporary(index)) => uses[*index].negated.push(user),
            _ => {}
        }
    }
    for value in &program.outputs {
        if let Value::Temporary(index) = value {
            uses[*index].count += 1;
        }
    }
    uses
}

/// What a difference takes away from: `x` where it is `-x`, and this is its only use.
fn negative(program: &Program, uses: &[Uses], user: usize) -> Option<Value> {
    let Operation::Sub(Value::Temporary(first), _) = &program.operations[user] else {
        return None;
    };
    match &program.operations[*first] {
        Operation::Neg(x) if uses[*first].count == 1 => Some(x.clone()),
        _ => None,
    }
}

/// Lets all that uses one result use another.
fn redirect(program: &mut Program, from: usize, to: usize) {
    let place = |index: usize| if index == from { to } else { index };
    for operation in &mut program.operations[from + 1..] {
        *operation = operation.renumbered(&place);
    }
    for value in &mut program.outputs {
        *value = value.clone().renumbered(&place);
    }
}

/// The program without operations that nothing uses.
fn without_dead(program: Program) -> Program {
    let mut alive = vec![false; program.operations.len()];
    let mark = |alive: &mut Vec<bool>, value: &Value| {
        if let Value::Temporary(index) = value {
            alive[*index] = true;
        }
    };
    for value in &program.outputs {
        mark(&mut alive, value);
    }
    for place in (0..program.operations.len()).rev() {
        if alive[place] {
            for value in program.operations[place].operands() {
                mark(&mut alive, value);
            }
        }
    }
    let mut moved = Vec::with_capacity(alive.len());
    let mut kept = Vec::with_capacity(alive.len());
    let mut counts = Counts::default();
    for (operation, alive) in program.operations.iter().zip(&alive) {
        moved.push(kept.len());
        if *alive {
            counts.record(operation);
            kept.push(operation.renumbered(&|index| moved[index]));
        }
    }
    let outputs = program.outputs.into_iter();
    Program {
        outputs: outputs
            .map(|value| value.renumbered(&|index| moved[index]))
            .collect(),
        operations: kept,
        counts,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
}
