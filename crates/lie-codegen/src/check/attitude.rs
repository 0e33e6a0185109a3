//! The initial group element: its expressions, that the group has it, and that the initial state does not say it too.

use super::coordinates::Whole;
use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::algebra::rotating;
use crate::model::{Attitude, Configuration, Form, Model};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Graph};
use lie_syntax::ast::{self, AttitudeForm};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// An element within this of the group is one, written with few digits.
const OFF_THE_GROUP: f64 = 1e-6;
/// A pivot that is smaller than this part of the largest entry is none.
const SINGULAR: f64 = 1e-12;

/// What is wrong with a group element, and what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrong {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

/// Lowers the initial group element; `Some(None)` where none is declared.
pub fn initial_element(
    whole: &Whole<'_>,
    graph: &mut Graph,
    environment: &Environment<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Option<Attitude>> {
    let Some(attitude) = &whole.declaration.attitude else {
        return Some(None);
    };
    let entries = attitude.entries().into_iter();
    let entries: Vec<Option<ExprId>> = entries
        .map(|entry| Lowering::new(graph, environment, mistakes, Allowed::Parameters).lower(entry))
        .collect();
    let size = size(whole, attitude, mistakes)?;
    let entries = entries.into_iter().collect::<Option<Vec<_>>>()?;
    let (form, matrix) = match &attitude.form {
        AttitudeForm::Matrix(_) => (Form::Matrix, entries.clone()),
        AttitudeForm::Quaternion(_) => {
            let rotation = of_quaternion(graph, &entries);
            (Form::Quaternion, within(graph, &rotation, size))
        }
        AttitudeForm::Euler(sequence, _) => {
            let turns = sequence.axes().into_iter().zip(&entries);
            let turns: Vec<_> = turns
                .map(|(axis, angle)| about(graph, axis, *angle))
                .collect();
            let first = product(graph, &turns[0], &turns[1]);
            let rotation = product(graph, &first, &turns[2]);
            (Form::Euler(*sequence), within(graph, &rotation, size))
        }
    };
    Some(Some(Attitude {
        form,
        entries,
        matrix,
        origin: attitude.origin,
    }))
}

/// The initial state with the entries of the group element, where these are coordinates.
pub fn among_coordinates(
    configuration: Option<&Configuration>,
    initial: Option<Vec<ExprId>>,
    attitude: Option<&Attitude>,
) -> Option<Vec<ExprId>> {
    let mut initial = initial?;
    if let (Some(configuration), Some(attitude)) = (configuration, attitude)
        && configuration.group.is_some()
    {
        // with constraints the state may be the reduced one
        let fewer = configuration.dimension().saturating_sub(initial.len());
        let entries = &mut initial[configuration.momenta.saturating_sub(fewer)..];
        entries[..attitude.matrix.len()].copy_from_slice(&attitude.matrix);
    }
    Some(initial)
}

/// The size of the matrices of the group; none where there are none, or where the attitude has another one.
fn size(
    whole: &Whole<'_>,
    attitude: &ast::Attitude,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<usize> {
    let mut wrong = |message: String, help: &str| {
        let place = attitude.origin;
        mistakes.push(Diagnostic::new(Kind::Representation, place, message).help(help));
        None
    };
    let algebra = whole.declaration.algebra();
    let declared = algebra.and_then(|algebra| Some(algebra.matrices.first()?.rows.len()));
    let Some(declared) = declared else {
        return wrong(
            "a group element needs the matrices of the algebra, and none are declared".into(),
            "declare `matrices`: the group element is a matrix of their size",
        );
    };
    let configuration = whole.configuration.as_ref();
    let size = configuration.map_or(declared, |c| c.size_of_group(declared));
    match &attitude.form {
        AttitudeForm::Matrix(rows) => {
            let other = rows.iter().map(Vec::len).find(|length| *length != size);
            let other = other.or((rows.len() != size).then_some(rows.len()));
            match other {
                None => Some(size),
                Some(other) => wrong(
                    format!(
                        "the attitude has {other} rows or columns, and the matrices of the algebra have {size}"
                    ),
                    "give a matrix of their size",
                ),
            }
        }
        _ if size >= 3 => Some(size),
        _ => wrong(not_of_rotations().message, &not_of_rotations().help),
    }
}

fn not_of_rotations() -> Wrong {
    Wrong {
        message: "quaternions and Euler angles are for groups of rotations in three dimensions, with or without translations, and with what can be left at rest".into(),
        help: "give the attitude by its `matrix`".into(),
    }
}

type Rotation = [[ExprId; 3]; 3];

/// The rotation of a quaternion of any norm.
fn of_quaternion(graph: &mut Graph, q: &[ExprId]) -> Rotation {
    let squares: Vec<ExprId> = q.iter().map(|&entry| graph.mul(entry, entry)).collect();
    let norm = graph.sum(&squares);
    let two = Rational::from(2);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let value = if i == j {
                // w^2 + q_i^2 less the other squares
                let mut terms = vec![(squares[0], Rational::ONE)];
                terms.extend((0..3).map(|k| {
                    let sign = if k == i { 1 } else { -1 };
                    (squares[1 + k], Rational::from(sign))
                }));
                graph.linear(&terms)
            } else {
                let k = 3 - i - j;
                let sign = if (j + 1) % 3 == i { 1 } else { -1 };
                let across = graph.mul(q[1 + i], q[1 + j]);
                let along = graph.mul(q[0], q[1 + k]);
                graph.linear(&[(across, two.clone()), (along, &two * &Rational::from(sign))])
            };
            graph.div(value, norm)
        })
    })
}

/// The rotation about an axis.
fn about(graph: &mut Graph, axis: usize, angle: ExprId) -> Rotation {
    let [sine, cosine] =
        [Elementary::Sin, Elementary::Cos].map(|function| graph.call(function, &[angle]));
    let (zero, one, opposite) = (graph.integer(0), graph.integer(1), graph.neg(sine));
    std::array::from_fn(|i| {
        std::array::from_fn(|j| match (i == axis, j == axis) {
            (true, true) => one,
            (true, false) | (false, true) => zero,
            _ if i == j => cosine,
            _ if (j + 1) % 3 == i => sine,
            _ => opposite,
        })
    })
}

fn product(graph: &mut Graph, a: &Rotation, b: &Rotation) -> Rotation {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let terms: Vec<ExprId> = (0..3).map(|k| graph.mul(a[i][k], b[k][j])).collect();
            graph.sum(&terms)
        })
    })
}

/// The matrix of a size with a rotation in its first rows and columns, by rows.
fn within(graph: &mut Graph, rotation: &Rotation, size: usize) -> Vec<ExprId> {
    let [zero, one] = [0, 1].map(|value| graph.integer(value));
    let place = |k: usize| {
        let (i, j) = (k / size, k % size);
        match i < 3 && j < 3 {
            true => rotation[i][j],
            false if i == j => one,
            false => zero,
        }
    };
    (0..size * size).map(place).collect()
}

/// What is wrong with the declared group element at the default parameters.
pub fn mistake(model: &Model) -> Option<Diagnostic> {
    let place = model.attitude.as_ref()?.origin;
    let (kind, wrong) = match unsuitable(model) {
        Some(wrong) => (Kind::Representation, wrong),
        None => (Kind::Domain, violation(model, &model.defaults())?),
    };
    Some(Diagnostic::new(kind, place, wrong.message).help(wrong.help))
}

/// Why a system has no group element, or none that is written so.
fn unsuitable(model: &Model) -> Option<Wrong> {
    let attitude = model.attitude.as_ref()?;
    if let Some((message, help)) = model.parametric_matrices("an attitude, which is checked,") {
        let configuration = model.configuration.as_ref();
        let in_state = configuration.is_some_and(|c| c.group.is_some());
        let help = match in_state {
            true => format!("give the entries of the group element in `initial`, or {help}"),
            false => help,
        };
        return Some(Wrong { message, help });
    }
    let Some((size, matrices)) = model.group_matrices() else {
        return Some(Wrong {
            message: "there is no group element: the bracket is not that of an algebra alone"
                .into(),
            help: "remove `attitude`".into(),
        });
    };
    let turns = rotating::have_rotations(size, &matrices);
    (attitude.form != Form::Matrix && !turns).then(not_of_rotations)
}

/// What is wrong with the group element at values of the parameters: nothing of one that is not declared.
pub fn violation(model: &Model, parameters: &[f64]) -> Option<Wrong> {
    let attitude = model.attitude.as_ref()?;
    let values = attitude.values(&model.graph, parameters);
    if values.iter().any(|value| !value.is_finite()) {
        return Some(Wrong {
            message: "the attitude is not finite".into(),
            help: "give it where its expressions have values".into(),
        });
    }
    if attitude.form == Form::Quaternion
        && let Some(wrong) = no_unit(&values)
    {
        return Some(wrong);
    }
    let (size, matrices) = model.group_matrices()?;
    let configuration = model.configuration.as_ref();
    let transposed = configuration.is_some_and(|c| c.group.is_some());
    let rows = attitude.rows(&model.graph, parameters);
    outside(size, &matrices, transposed, &rows)
}

fn no_unit(q: &[f64]) -> Option<Wrong> {
    let norm = q.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    if norm == 0.0 {
        return Some(Wrong {
            message: "the quaternion of the attitude is zero".into(),
            help: "write `[1, 0, 0, 0]` for the identity".into(),
        });
    }
    ((norm - 1.0).abs() > OFF_THE_GROUP).then(|| Wrong {
        message: format!("the quaternion of the attitude is no unit: its norm is {norm}"),
        help: format!(
            "divide it by that: {:?}",
            q.iter().map(|entry| entry / norm).collect::<Vec<_>>()
        ),
    })
}

/// Why a matrix by rows is not in the group, as far as that is known of the matrices of its algebra, which may be transposed:
/// what they do not move stays, rotations are orthogonal, and where there are no traces the determinant is 1.
fn outside(
    size: usize,
    matrices: &[Vec<Vec<Rational>>],
    transposed: bool,
    rows: &[f64],
) -> Option<Wrong> {
    let at = |i: usize, j: usize| rows[size * i + j];
    let off = |i: usize, j: usize| (at(i, j) - f64::from(u8::from(i == j))).abs();
    let far = |i: usize, j: usize| off(i, j) > OFF_THE_GROUP;
    let fixed = |k: usize, by_row: bool| match by_row != transposed {
        true => rotating::are_zero(matrices, k..k + 1, 0..size),
        false => rotating::are_zero(matrices, 0..size, k..k + 1),
    };
    for k in 0..size {
        for (what, by_row) in [("row", true), ("column", false)] {
            let moved = (0..size).any(|other| match by_row {
                true => far(k, other),
                false => far(other, k),
            });
            if moved && fixed(k, by_row) {
                return Some(Wrong {
                    message: format!(
                        "the attitude is not in the group: its {what} {} is not that of the identity",
                        k + 1
                    ),
                    help: format!(
                        "write that {what} of the identity: no element of the group has another"
                    ),
                });
            }
        }
    }
    let rotation = match () {
        () if rotating::are_orthogonal(size, matrices) => size,
        () if rotating::turn_space(size, matrices) => 3,
        () => 0,
    };
    let product = |i: usize, j: usize| (0..rotation).map(|k| at(i, k) * at(j, k)).sum::<f64>();
    let pairs = (0..rotation).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let deviation = pairs.map(|(i, j)| (product(i, j) - f64::from(u8::from(i == j))).abs());
    let deviation = deviation.fold(0.0, f64::max);
    if deviation > OFF_THE_GROUP {
        return Some(Wrong {
            message: format!(
                "the attitude is no rotation: its rows are not orthonormal, by {deviation:.1e}"
            ),
            help: "write more digits, or exact expressions such as cos(1/5)".into(),
        });
    }
    let leading = |size: usize| {
        (0..size)
            .map(|i| (0..size).map(|j| at(i, j)).collect())
            .collect()
    };
    if rotation > 0 && determinant(leading(rotation)) < 0.0 {
        return Some(Wrong {
            message: "the attitude is a reflection: its determinant is -1".into(),
            help: "exchange two of its rows, or change the sign of one".into(),
        });
    }
    let determinant = determinant(leading(size));
    if determinant == 0.0 {
        return Some(Wrong {
            message: "the attitude is not in the group: its matrix has no inverse".into(),
            help: "give a matrix with independent rows".into(),
        });
    }
    let trace = |matrix: &Vec<Vec<Rational>>| {
        let diagonal = (0..size).map(|k| &matrix[k][k]);
        diagonal.fold(Rational::ZERO, |sum, entry| &sum + entry)
    };
    let special = matrices.iter().all(|matrix| trace(matrix).is_zero());
    (special && (determinant - 1.0).abs() > OFF_THE_GROUP).then(|| Wrong {
        message: format!(
            "the attitude is not in the group: its determinant is {determinant}, and not 1"
        ),
        help: "divide it by a root of that".into(),
    })
}

/// By elimination with pivots; 0 where one is as small as round-off.
fn determinant(mut rows: Vec<Vec<f64>>) -> f64 {
    let entries = rows.iter().flatten();
    let largest = entries.fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
    let mut determinant = 1.0;
    while let Some(column) = rows.len().checked_sub(1) {
        let by_size =
            |a: &usize, b: &usize| rows[*a][column].abs().total_cmp(&rows[*b][column].abs());
        let Some(pivot) = (0..rows.len()).max_by(by_size) else {
            break;
        };
        if rows[pivot][column].abs() <= SINGULAR * largest {
            return 0.0;
        }
        // the last column is eliminated, and the row of its pivot goes to the end
        if pivot != column {
            rows.swap(pivot, column);
            determinant = -determinant;
        }
        let Some(last) = rows.pop() else { break };
        determinant *= last[column];
        for row in &mut rows {
            let factor = row[column] / last[column];
            for (entry, pivot) in row.iter_mut().zip(&last) {
                *entry -= factor * pivot;
            }
            row.pop();
        }
    }
    determinant
}
