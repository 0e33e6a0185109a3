//! The expansion of an expression with vectors into one of scalars.

use std::collections::BTreeSet;

use super::scalars::{minus, multiply, number, plus, root, square, times};
use super::shapes::{self, Operand, each, form, mistake, no_quotient, no_scalar, text};
use super::{Value, Vectors, arity, too_large};
use crate::ast::{Expr, ExprKind, Index};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// The expression in scalars; `None` if its shapes do not fit, which is reported.
pub fn expand(expression: Expr, vectors: &Vectors, report: &mut Report) -> Option<Expr> {
    if !concerns(&expression, vectors) {
        return Some(expression);
    }
    if vectors.broken {
        return None;
    }
    let result = Expansion { vectors }.scalar(&expression);
    result.map_err(|mistake| report.push(*mistake)).ok()
}

/// The expression as a scalar, a vector or a matrix of scalars; `None` if its shapes do not fit, which is reported.
pub fn expand_value(expression: Expr, vectors: &Vectors, report: &mut Report) -> Option<Value> {
    if !concerns(&expression, vectors) {
        return Some(Value::Scalar(expression));
    }
    if vectors.broken {
        return None;
    }
    let result = Expansion { vectors }.value(&expression);
    result.map_err(|mistake| report.push(*mistake)).ok()
}

/// Whether there is a vector or a function of vectors in it.
fn concerns(expression: &Expr, vectors: &Vectors) -> bool {
    let mut pending = vec![expression];
    while let Some(part) = pending.pop() {
        let found = match &part.kind {
            ExprKind::Name { name, .. } => vectors.get(name).is_some(),
            ExprKind::Call { function, .. } => arity(&function.text).is_some(),
            _ => false,
        };
        if found {
            return true;
        }
        pending.extend(part.operands());
    }
    false
}

type Result<T> = std::result::Result<T, Box<Diagnostic>>;

struct Expansion<'a> {
    vectors: &'a Vectors,
}

impl Expansion<'_> {
    fn scalar(&self, expression: &Expr) -> Result<Expr> {
        match self.value(expression)? {
            Value::Scalar(scalar) => Ok(scalar),
            other => Err(no_scalar(&Operand::new(expression), &other).into()),
        }
    }

    fn value(&self, expression: &Expr) -> Result<Value> {
        let origin = expression.origin;
        let kind = match &expression.kind {
            ExprKind::Name { name, index } => match (self.vectors.get(name), index) {
                (Some(value), None) => return self.copy(value, origin),
                (Some(value), Some(index)) => return self.at(value, expression, index),
                (None, _) => expression.kind.clone(),
            },
            ExprKind::Number(_) => expression.kind.clone(),
            ExprKind::IndexedSum {
                index,
                from,
                to,
                body,
            } => ExprKind::IndexedSum {
                index: index.clone(),
                from: Box::new(self.scalar(from)?),
                to: Box::new(self.scalar(to)?),
                body: Box::new(self.scalar(body)?),
            },
            ExprKind::Negative(a) => {
                let value = self.value(a)?;
                return Ok(each(value, |entry| minus(entry, origin)));
            }
            ExprKind::Power(a, b) => {
                let base = match self.value(a)? {
                    Value::Scalar(base) => base,
                    value @ Value::Matrix(_) if matches!(b.kind, ExprKind::Negative(_)) => {
                        let whole = Operand::new(expression);
                        return Err(no_quotient(&whole, &Operand::new(a), &value).into());
                    }
                    value => return Err(no_scalar(&Operand::new(a), &value).into()),
                };
                ExprKind::Power(Box::new(base), Box::new(self.scalar(b)?))
            }
            ExprKind::Sum(terms) => return self.sum(expression, terms),
            ExprKind::Product(factors) => return self.product(expression, factors),
            ExprKind::Call {
                function,
                arguments,
            } if arity(&function.text).is_some() => {
                return self.call(expression, &function.text, arguments);
            }
            ExprKind::Call {
                function,
                arguments,
            } => ExprKind::Call {
                function: function.clone(),
                arguments: arguments
                    .iter()
                    .map(|a| self.scalar(a))
                    .collect::<Result<_>>()?,
            },
        };
        Ok(Value::Scalar(Expr { kind, origin }))
    }

    fn spend(&self, entries: &mut dyn Iterator<Item = &Expr>, origin: Origin) -> Result<()> {
        let count = entries.map(|entry| entry.parts().count()).sum();
        match self.vectors.spend(count) {
            true => Ok(()),
            false => Err(too_large(origin).into()),
        }
    }

    fn copy(&self, value: &Value, origin: Origin) -> Result<Value> {
        self.spend(&mut super::entries(value), origin)?;
        Ok(value.clone())
    }

    /// The vector of one site of a family: its coordinates take the index.
    fn at(&self, value: &Value, whole: &Expr, index: &Index) -> Result<Value> {
        let mut found = false;
        let value = each(self.copy(value, whole.origin)?, |mut entry| {
            found |= indexed(&mut entry, index, &self.vectors.sites);
            entry
        });
        if !found {
            let help = "write the name without the index: the same for all sites";
            let message = format!("`{}`: no entry is a coordinate of a site", text(whole));
            return Err(Diagnostic::new(Kind::Syntax, whole.origin, message)
                .help(help)
                .into());
        }
        Ok(value)
    }

    fn sum(&self, whole: &Expr, terms: &[(bool, Expr)]) -> Result<Value> {
        let values = terms
            .iter()
            .map(|(sign, term)| Ok((*sign, self.value(term)?)));
        let values: Vec<(bool, Value)> = values.collect::<Result<_>>()?;
        let other = values
            .iter()
            .position(|(_, v)| form(v) != form(&values[0].1));
        if let Some(other) = other {
            let operands = [0, other].map(|at| Operand::new(&terms[at].1));
            let help = "add what has the same shape";
            let shapes = [
                (&operands[0], &values[0].1),
                (&operands[1], &values[other].1),
            ];
            return Err(mistake(&Operand::new(whole), shapes, help).into());
        }
        if values.iter().all(|(_, v)| matches!(v, Value::Scalar(_))) {
            let mut all = Vec::new();
            for ((_, term), (sign, value)) in terms.iter().zip(values) {
                let Value::Scalar(scalar) = value else {
                    continue;
                };
                match scalar.kind {
                    // written out it is part of the sum
                    ExprKind::Sum(inner) if matches!(term.kind, ExprKind::Call { .. }) => {
                        all.extend(inner.into_iter().map(|(minus, part)| (minus != sign, part)));
                    }
                    _ => all.push((sign, scalar)),
                }
            }
            let kind = ExprKind::Sum(all);
            return Ok(Value::Scalar(Expr {
                kind,
                origin: whole.origin,
            }));
        }
        let shape = values[0].1.clone();
        let mut columns: Vec<Vec<(bool, Expr)>> = Vec::new();
        for (sign, value) in &values {
            for (at, entry) in super::entries(value).enumerate() {
                if columns.len() <= at {
                    columns.push(Vec::new());
                }
                columns[at].push((*sign, entry.clone()));
            }
        }
        let mut columns = columns.into_iter();
        Ok(each(shape, |old| match columns.next() {
            Some(terms) => plus(terms, whole.origin),
            None => old,
        }))
    }

    fn product(&self, whole: &Expr, factors: &[(bool, Expr)]) -> Result<Value> {
        let mut scalars = Vec::new();
        let mut before = 0;
        let mut tensors: Vec<(Operand, Value)> = Vec::new();
        for (divides, factor) in factors {
            match self.value(factor)? {
                Value::Scalar(scalar) => scalars.push((*divides, scalar)),
                value => {
                    let operand = Operand::new(factor);
                    if *divides {
                        let whole = Operand::new(whole);
                        return Err(no_quotient(&whole, &operand, &value).into());
                    }
                    if tensors.is_empty() {
                        before = scalars.len();
                    }
                    tensors.push((operand, value));
                }
            }
        }
        let Some(value) = self.chain(whole, tensors)? else {
            let kind = ExprKind::Product(scalars);
            return Ok(Value::Scalar(Expr {
                kind,
                origin: whole.origin,
            }));
        };
        let count = super::entries(&value).count().saturating_sub(1);
        for _ in 0..count {
            self.spend(&mut scalars.iter().map(|(_, s)| s), whole.origin)?;
        }
        Ok(each(value, |entry| {
            let mut all = scalars.clone();
            all.insert(before, (false, entry));
            multiply(all, whole.origin)
        }))
    }

    /// The product of matrices and a last vector, from the right: `A*B*v` has two products with a vector.
    fn chain(&self, whole: &Expr, tensors: Vec<(Operand, Value)>) -> Result<Option<Value>> {
        let mut tensors = tensors.into_iter().rev();
        let Some((mut right, mut value)) = tensors.next() else {
            return Ok(None);
        };
        for (left, matrix) in tensors {
            value = self.times(whole, (&left, &matrix), (&right, &value))?;
            right = Operand {
                text: format!("{}*{}", left.text, right.text),
                origin: right.origin,
            };
        }
        Ok(Some(value))
    }

    /// A matrix times a vector or a matrix.
    fn times(
        &self,
        whole: &Expr,
        left: (&Operand, &Value),
        right: (&Operand, &Value),
    ) -> Result<Value> {
        let fits = |rows: &[Vec<Expr>], length: usize| rows[0].len() == length;
        let origin = whole.origin;
        let result = match (left.1, right.1) {
            (Value::Matrix(a), Value::Vector(v)) if fits(a, v.len()) => {
                let rows = a.iter().map(|row| self.inner(row, v, origin));
                Value::Vector(rows.collect::<Result<_>>()?)
            }
            (Value::Matrix(a), Value::Matrix(b)) if fits(a, b.len()) => {
                let column = |j: usize| b.iter().map(|row| row[j].clone()).collect::<Vec<_>>();
                let row = |row: &Vec<Expr>| {
                    (0..b[0].len())
                        .map(|j| self.inner(row, &column(j), origin))
                        .collect::<Result<Vec<_>>>()
                };
                Value::Matrix(a.iter().map(row).collect::<Result<_>>()?)
            }
            (Value::Vector(_), Value::Vector(_)) => {
                let help = "the products of vectors are dot(v, w) and cross(v, w)";
                return Err(mistake(&Operand::new(whole), [left, right], help).into());
            }
            _ => {
                let help = "a product is A*v, with as many columns of A as v has entries";
                return Err(mistake(&Operand::new(whole), [left, right], help).into());
            }
        };
        Ok(result)
    }

    /// The sum of the products of entries.
    fn inner(&self, a: &[Expr], b: &[Expr], origin: Origin) -> Result<Expr> {
        self.spend(&mut a.iter().chain(b), origin)?;
        let terms = a.iter().zip(b).map(|(a, b)| (false, times(a, b, origin)));
        Ok(plus(terms.collect(), origin))
    }

    fn call(&self, whole: &Expr, function: &str, arguments: &[Expr]) -> Result<Value> {
        let values = arguments.iter().map(|a| self.value(a));
        let values: Vec<Value> = values.collect::<Result<_>>()?;
        let origin = whole.origin;
        let (scalar, help) = match (function, values.as_slice()) {
            ("dot", [Value::Vector(a), Value::Vector(b)]) if a.len() == b.len() => {
                return Ok(Value::Scalar(self.inner(a, b, origin)?));
            }
            ("cross", [Value::Vector(a), Value::Vector(b)]) if a.len() == 3 && b.len() == 3 => {
                return self.cross(a, b, origin);
            }
            ("norm" | "norm2", [Value::Vector(a)]) => {
                let squares = a.iter().map(|entry| (false, square(entry, origin)));
                let sum = plus(squares.collect(), origin);
                return Ok(Value::Scalar(match function {
                    "norm2" => sum,
                    _ => root(sum, origin),
                }));
            }
            ("quad", [Value::Matrix(a), Value::Vector(v)])
                if a.len() == v.len() && a[0].len() == v.len() =>
            {
                return Ok(Value::Scalar(self.quadratic(a, v, origin)?));
            }
            ("dot", _) => ("dot(v, w)", "two vectors of the same length"),
            ("cross", _) => ("cross(v, w)", "two vectors of 3 entries"),
            ("quad", _) => ("quad(A, v)", "a square matrix and a vector of its size"),
            _ => ("norm(v), norm2(v)", "a vector"),
        };
        let operands: Vec<Operand> = arguments.iter().map(Operand::new).collect();
        let shapes = operands.iter().zip(&values);
        let help = format!("the form is {scalar}, of {help}");
        Err(shapes::mistake(&Operand::new(whole), shapes, &help).into())
    }

    fn cross(&self, a: &[Expr], b: &[Expr], origin: Origin) -> Result<Value> {
        for _ in 0..2 {
            self.spend(&mut a.iter().chain(b), origin)?;
        }
        let entry = |(j, k): (usize, usize)| {
            let terms = vec![
                (false, times(&a[j], &b[k], origin)),
                (true, times(&a[k], &b[j], origin)),
            ];
            plus(terms, origin)
        };
        let entries = [(1, 2), (2, 0), (0, 1)].map(entry);
        Ok(Value::Vector(entries.into()))
    }

    /// `sum_i a_ii v_i^2 + sum_{i<j} (a_ij + a_ji) v_i v_j`
    fn quadratic(&self, a: &[Vec<Expr>], v: &[Expr], origin: Origin) -> Result<Expr> {
        for row in a {
            self.spend(&mut row.iter().chain(v), origin)?;
        }
        let mut terms = Vec::new();
        for i in 0..v.len() {
            terms.push((false, times(&a[i][i], &square(&v[i], origin), origin)));
        }
        for i in 0..v.len() {
            for j in i + 1..v.len() {
                let weight = if text(&a[i][j]) == text(&a[j][i]) {
                    times(&number(2, origin), &a[i][j], origin)
                } else {
                    let both = vec![(false, a[i][j].clone()), (false, a[j][i].clone())];
                    plus(both, origin)
                };
                let product = times(&v[i], &v[j], origin);
                terms.push((false, times(&weight, &product, origin)));
            }
        }
        Ok(plus(terms, origin))
    }
}

/// Gives the coordinates of a site their index; whether there were any.
fn indexed(entry: &mut Expr, index: &Index, sites: &BTreeSet<String>) -> bool {
    let all = |operands: &mut dyn Iterator<Item = &mut Expr>| {
        operands.fold(false, |found, part| indexed(part, index, sites) | found)
    };
    match &mut entry.kind {
        ExprKind::Name { name, index: place } if place.is_none() && sites.contains(name) => {
            *place = Some(Box::new(index.clone()));
            true
        }
        ExprKind::Number(_) | ExprKind::Name { .. } => false,
        ExprKind::Negative(a) => all(&mut [&mut **a].into_iter()),
        ExprKind::Power(a, b) => all(&mut [&mut **a, &mut **b].into_iter()),
        ExprKind::Sum(operands) | ExprKind::Product(operands) => {
            all(&mut operands.iter_mut().map(|(_, operand)| operand))
        }
        ExprKind::Call { arguments, .. } => all(&mut arguments.iter_mut()),
        ExprKind::IndexedSum { body, .. } => all(&mut [&mut **body].into_iter()),
    }
}
