//! The generating-function method in coordinates of the second kind, where every `exp(s ad*_(e_i))` has
//! a closed form.
//!
//! With `m_0 = mu` and `m_i = exp(xi_i ad*_(e_i)) m_(i-1)`, `xi = grad S(p)`: `r_i = p_i - (m_(i-1))_i` and
//! `mu1 = m_n`. An action is linear in m, and its derivative is `dm_i/dxi_i = ad*_(e_i) m_i`; so
//! `dm_i/dxi_l` is this vector for l, moved on by the later actions, and nothing but sums of
//! products of quantities that the residual has anyway.

use super::field::mu;
use super::generating::{Generating, Slope, exchanged, slope, symmetric, too_large};
use super::splitting::{Definitions, weights};
use super::{Argument, Block as Symbols, Kernel, Source};
use crate::exact::Rational;
use crate::structure::one_parameter::{Block, Form};
use crate::symbolic::{ExprId, Node, Symbol};

/// What an action does to a block of entries.
enum Part {
    /// `m_row` times the quantity.
    Scale(usize, ExprId),
    /// `m` plus the sum of weights times powers of R.
    Add(Vec<ExprId>, Block),
}

type Action = Vec<Part>;

/// The closed forms of an action along `s e_i`.
fn action(source: &mut Source, blocks: &[Block], s: ExprId, made: &mut Definitions) -> Action {
    let mut parts = Vec::new();
    if source.graph.is_zero(s) {
        return parts;
    }
    for block in blocks {
        if let (Some(row), Form::Exponential(a)) = (block.only_row(), &block.form) {
            let exponent = super::splitting::sigma(source, block, s);
            let exponent = source.graph.scale(exponent, a);
            let (value, inverted) = made.exponential(source, exponent);
            let power = Rational::from(if inverted { -1 } else { 1 });
            parts.push(Part::Scale(row, source.graph.pow(value, &power)));
        } else {
            let weights = weights(source, block, s, made);
            parts.push(Part::Add(weights, block.clone()));
        }
    }
    parts
}

/// A quantity of its own, unless it is one.
fn quantity(source: &mut Source, made: &mut Definitions, value: ExprId) -> ExprId {
    match source.graph.node(value) {
        Node::Symbol(_) | Node::Number(_) => value,
        _ => made.define(source, value),
    }
}

/// The action on a vector, whose new entries become one quantity each. Increments are quantities too,
/// so that their addition is the only rounding in units of the vector.
fn apply(
    source: &mut Source,
    action: &Action,
    vector: &[ExprId],
    made: &mut Definitions,
) -> Vec<ExprId> {
    let mut moved = vector.to_vec();
    let mut increments: Vec<Vec<ExprId>> = vec![Vec::new(); vector.len()];
    for part in action {
        match part {
            Part::Scale(row, factor) => moved[*row] = source.graph.mul(vector[*row], *factor),
            Part::Add(weights, block) => {
                for (weight, power) in weights.iter().zip(&block.powers) {
                    for (row, column, value) in power {
                        let term = source.graph.mul(*weight, vector[*column]);
                        increments[*row].push(source.graph.scale(term, value));
                    }
                }
            }
        }
    }
    moved
        .into_iter()
        .zip(increments)
        .map(|(entry, terms)| {
            let increment = source.graph.sum(&terms);
            let increment = quantity(source, made, increment);
            let entry = source.graph.add(entry, increment);
            quantity(source, made, entry)
        })
        .collect()
}

/// The start of the iteration, residual, Jacobian and result; `None` where an action has no closed form
/// or the derivatives swell.
pub(super) fn kernels(source: &mut Source) -> Option<Vec<Kernel>> {
    let n = source.dimension;
    let blocks: Vec<Vec<Block>> = source.actions.clone()?.into_iter().collect::<Option<_>>()?;
    let Slope { mut tape, entries } = slope(source, Generating::Second);
    let xi = tape.define_all(source, &entries);
    let values = tape.definitions().to_vec();
    let mut hessian = symmetric(tape.jacobian(source, &entries));
    for row in &mut hessian {
        *row = tape.define_all(source, row);
    }
    let slopes = tape.definitions().to_vec();
    if too_large(source, &tape) {
        return None;
    }

    let (p, start) = (source.coordinates(), source.block(Symbols::Unknown));
    let mut made = Definitions::default();
    let actions: Vec<Action> = blocks
        .iter()
        .zip(&xi)
        .map(|(blocks, s)| action(source, blocks, *s, &mut made))
        .collect();
    let mut moment = start;
    let (mut guess, mut residual, mut moments) = (Vec::new(), Vec::new(), Vec::new());
    for (i, action) in actions.iter().enumerate() {
        guess.push(moment[i]);
        residual.push(source.graph.sub(p[i], moment[i]));
        moment = apply(source, action, &moment, &mut made);
        moments.push(moment.clone());
    }
    let walk = made.all().to_vec();

    let zero = source.graph.integer(0);
    let mut columns: Vec<Vec<ExprId>> = Vec::new();
    let mut rows = Vec::new();
    for (i, action) in actions.iter().enumerate() {
        let row: Vec<ExprId> = (0..n)
            .map(|j| {
                let unit = source.graph.integer(i64::from(i == j));
                let mut terms = vec![(unit, Rational::ONE)];
                for (column, curvature) in columns.iter().zip(&hessian) {
                    let term = source.graph.mul(column[i], curvature[j]);
                    terms.push((term, Rational::MINUS_ONE));
                }
                source.graph.linear(&terms)
            })
            .collect();
        rows.push(row);
        for column in &mut columns {
            *column = apply(source, action, column, &mut made);
        }
        let mut unit = vec![zero; n];
        unit[i] = source.graph.integer(1);
        columns.push(source.ad_star_of(&unit, &moments[i]));
    }

    let exchange = |source: &mut Source, definitions: &[&[(Symbol, ExprId)]]| {
        let all = definitions.iter().flat_map(|list| list.iter());
        all.map(|(symbol, value)| (*symbol, exchanged(source, &[*value])[0]))
            .collect::<Vec<_>>()
    };
    let start_definitions = {
        let all = values.iter().chain(&walk);
        all.map(|(symbol, value)| (*symbol, at_start(source, &[*value])[0]))
            .collect::<Vec<_>>()
    };
    let guess = at_start(source, &guess);
    let value_definitions = exchange(source, &[&values, &walk]);
    let slope_definitions = exchange(source, &[&slopes, made.all()]);
    let residual = exchanged(source, &residual);
    let result = exchanged(source, &moment);
    let rows: Vec<Vec<ExprId>> = rows.iter().map(|row| exchanged(source, row)).collect();
    let arguments = vec![
        mu(source),
        Argument {
            name: "unknown",
            symbols: source.symbols(Symbols::Unknown),
        },
    ];
    let graph = &source.graph;
    let formula =
        "`r_i = p_i - (m_(i-1))_i`, `m_i = exp(xi_i ad*_(e_i)) m_(i-1)`, `xi = grad S(p)`";
    let slopes = "`r_i = p_i - (m_(i-1))_i` and `dr/dp`, by `dm_i/dxi_i = ad*_(e_i) m_i`";
    Some(vec![
        Kernel::vector(
            graph,
            "initial_guess",
            "`p_i = (m_(i-1))_i` with `xi = grad S(mu)`",
            vec![mu(source)],
            &guess,
        )
        .within_step(start_definitions),
        Kernel::vector(graph, "residual", formula, arguments.clone(), &residual)
            .within_step(value_definitions.clone()),
        Kernel::fused(
            graph,
            "linearize",
            slopes,
            arguments.clone(),
            &residual,
            &rows,
        )
        .within_step(slope_definitions),
        Kernel::vector(graph, "result", "`mu1 = m_n`", arguments, &result)
            .within_step(value_definitions),
    ])
}

/// The unknown is the state itself.
fn at_start(source: &mut Source, expressions: &[ExprId]) -> Vec<ExprId> {
    let (unknown, state) = (source.symbols(Symbols::Unknown), source.coordinates());
    source.graph.substitute(expressions, &|symbol| {
        unknown.iter().position(|s| *s == symbol).map(|i| state[i])
    })
}
