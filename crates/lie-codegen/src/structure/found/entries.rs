//! Pieces of a Hamiltonian on a bracket that is declared by its entries: functions of quantities that commute, whose flows are maps in
//! closed form.
//!
//! * On a bracket `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)` ([`Elementwise`]) a term of H is a function of coordinates that commute, or of one linear
//!   form `sum n_i y_i` of `y_i = int dx_i/a_i`: its gradient in y is constant along its flow, `y -> y + t c grad_y`. On log-canonical brackets,
//!   `a_i = x_i`, these forms are logarithms of monomials, and the flow of `F(z)`, `z = x^n`, is `x_i -> x_i exp(t (c n)_i z F'(z))`, which
//!   keeps signs.
//! * On any other bracket a term is a function of coordinates that commute: `grad T` is constant along its flow, `x' = Pi(x) grad T`. Its
//!   Taylor series in t is that flow where it ends, as those of a charged particle in a magnetic field whose components are polynomials. In
//!   another field the positions move along straight lines, and what the momenta gain is an integral over these, by Gauss's quadrature of 8
//!   nodes: exact to round-off where the field varies little over a step.

use super::atoms::Form;
use super::field_flow::{quadrature, series};
use super::{COLOURING, Found, Piece, WORK, additive, colouring};
use crate::model::{Model, PoissonMatrix};
use crate::structure::elementwise::{
    self, Change, Elementwise, divides_by_numbers, sample, sampled, vanish,
};
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Node, Symbol};

/// More parts are not put together.
const MOST_PARTS: usize = 40;
/// The largest denominator of an exponent that is read from values.
const MOST_DENOMINATOR: i64 = 60;

/// A part of H with what it is a function of.
#[derive(Default)]
struct Part {
    terms: Vec<ExprId>,
    /// Forms that commute, in y where the bracket is constant in them, with the derivatives by them.
    forms: Vec<(Form, ExprId)>,
}

/// The parts of H, and what has constant derivatives.
#[derive(Default)]
struct Parts {
    all: Vec<Part>,
    linear: Part,
    /// The derivatives of that.
    form: Vec<Fraction>,
}

struct Search<'a> {
    model: &'a Model,
    matrix: &'a PoissonMatrix,
    elementwise: Option<Elementwise>,
    hamiltonian: ExprId,
    budget: Budget,
}

/// The pieces of H; the term that is none otherwise, `None` where that was not found out.
pub(super) fn pieces(
    model: &Model,
    matrix: &PoissonMatrix,
    graph: &mut Graph,
) -> Result<Found, Option<ExprId>> {
    let hamiltonian = model.energy.expression().ok_or(None)?.value;
    let search = Search {
        model,
        matrix,
        elementwise: elementwise::elementwise(model, matrix, graph).filter(Elementwise::is_affine),
        hamiltonian,
        budget: Budget::new(WORK),
    };
    let parts = search.parts(graph)?;
    let conflicts: Vec<Vec<bool>> = parts
        .iter()
        .map(|one| {
            let others = parts.iter();
            others.map(|other| !search.commute(one, other)).collect()
        })
        .collect();
    let classes = colouring::fewest(&conflicts, &Budget::new(COLOURING));
    let mut pieces = Vec::new();
    for class in 0..colouring::count(&classes) {
        let members = parts.iter().zip(&classes);
        let members: Vec<&Part> = members
            .filter(|(_, of)| **of == class)
            .map(|(part, _)| part)
            .collect();
        let first = members[0].terms.first().copied();
        pieces.push(search.piece(graph, &members).ok_or(first)?);
    }
    let all = pieces.len();
    pieces.retain(|piece| !piece.is_idle());
    if pieces.is_empty() {
        return Err(None);
    }
    Ok(Found {
        rest: None,
        whole: pieces.len() == all,
        pieces,
        declared: false,
        exponential: None,
    })
}

impl Search<'_> {
    /// The parts of H; all of those with constant derivatives are one.
    fn parts(&self, graph: &mut Graph) -> Result<Vec<Part>, Option<ExprId>> {
        let mut parts = Parts::default();
        let normal = graph.normal(self.hamiltonian);
        let whole = match graph.node(normal).clone() {
            Node::Sum { terms, .. } => {
                let terms = terms.iter();
                terms
                    .map(|(term, scale)| graph.scale(*term, scale))
                    .collect()
            }
            _ => vec![normal],
        };
        for term in whole {
            if self.take(graph, term, &mut parts)? {
                continue;
            }
            // a power of a sum, whose terms may be parts
            for term in additive::terms(graph, term).ok_or(None)? {
                if !self.take(graph, term, &mut parts)? {
                    return Err(Some(term));
                }
            }
        }
        let Parts {
            mut all,
            mut linear,
            form,
        } = parts;
        let form = form.into_iter().enumerate();
        let form: Form = form.filter(|(_, value)| !value.is_zero()).collect();
        if !form.is_empty() {
            linear.forms.push((form, graph.integer(1)));
            all.push(linear);
        }
        Ok(all)
    }

    /// Whether a term is a part, which it is made.
    fn take(
        &self,
        graph: &mut Graph,
        term: ExprId,
        parts: &mut Parts,
    ) -> Result<bool, Option<ExprId>> {
        if graph.coordinates(term).is_empty() {
            return Ok(true);
        }
        let slopes = self.slopes(graph, term);
        if let Some(constants) = self.constants(graph, &slopes) {
            let zero = Fraction::from(Rational::ZERO);
            parts.form.resize(slopes.len(), zero);
            for (sum, value) in parts.form.iter_mut().zip(&constants) {
                *sum = sum.add(value, &self.budget).map_err(|_| None)?;
            }
            parts.linear.terms.push(term);
            return Ok(true);
        }
        let Some(forms) = self.forms(graph, &slopes) else {
            return Ok(false);
        };
        if parts.all.len() == MOST_PARTS {
            return Err(None);
        }
        parts.all.push(Part {
            terms: vec![term],
            forms,
        });
        Ok(true)
    }

    /// `a_i dT/dx_i`, the derivatives in y.
    fn slopes(&self, graph: &mut Graph, term: ExprId) -> Vec<ExprId> {
        (0..self.matrix.dimension)
            .map(|i| {
                let slope = graph.derivative(term, Symbol::Coordinate(i));
                let Some(elementwise) = &self.elementwise else {
                    return slope;
                };
                let speed = elementwise.speeds[i].at(i, graph);
                let product = graph.mul(speed, slope);
                graph.tidy(product)
            })
            .collect()
    }

    /// All derivatives, where they are constants in y.
    fn constants(&self, graph: &mut Graph, slopes: &[ExprId]) -> Option<Vec<Fraction>> {
        self.elementwise.as_ref()?;
        let slopes = slopes.iter();
        slopes.map(|slope| graph.fraction(*slope, None)).collect()
    }

    /// The forms of which a term with these derivatives is a function.
    fn forms(&self, graph: &mut Graph, slopes: &[ExprId]) -> Option<Vec<(Form, ExprId)>> {
        let support: Vec<usize> = (0..slopes.len())
            .filter(|i| !graph.is_zero(slopes[*i]))
            .collect();
        let one = Fraction::from(Rational::ONE);
        let units: Vec<Form> = support.iter().map(|i| vec![(*i, one.clone())]).collect();
        let mut pairs = units.iter().flat_map(|a| units.iter().map(move |b| (a, b)));
        if pairs.all(|(a, b)| self.bracket_vanishes(a, b)) {
            let slopes = support.iter().map(|i| slopes[*i]);
            return Some(units.into_iter().zip(slopes).collect());
        }
        self.elementwise.as_ref()?;
        let mut firsts = support.iter();
        firsts.find_map(|first| self.form(graph, slopes, &support, *first))
    }

    /// The form with the coefficient 1 of one coordinate, where none of the others divides by a parameter, which may be 0.
    fn form(
        &self,
        graph: &mut Graph,
        slopes: &[ExprId],
        support: &[usize],
        first: usize,
    ) -> Option<Vec<(Form, ExprId)>> {
        let (mut form, mut differences) = (Form::new(), Vec::new());
        for &i in support {
            let ratio = match i == first {
                true => Fraction::from(Rational::ONE),
                false => self.ratio(graph, slopes[i], slopes[first])?,
            };
            if !divides_by_numbers(&ratio) {
                return None;
            }
            let factor = graph.rational_function(&ratio);
            let expected = graph.mul(factor, slopes[first]);
            differences.push(graph.sub(slopes[i], expected));
            form.push((i, ratio));
        }
        vanish(
            self.model,
            graph,
            &[self.hamiltonian],
            &differences,
            &self.budget,
        )
        .then(|| vec![(form, slopes[first])])
    }

    /// What the ratio of two expressions is, if it is a constant: at samples of the coordinates, or where they are no fractions there, the
    /// near number with a small denominator.
    fn ratio(&self, graph: &mut Graph, above: ExprId, below: ExprId) -> Option<Fraction> {
        let whole = graph.div(above, below);
        if let Some(ratio) = graph.fraction(whole, None) {
            return Some(ratio);
        }
        if let [Some(above), Some(below)] = [above, below].map(|value| sampled(graph, value)) {
            return above.div(&below, &self.budget).ok()?;
        }
        let defaults = self.model.defaults();
        let values = graph.evaluate_all(&[above, below], &|symbol| match symbol {
            Symbol::Coordinate(i) => sample(i).to_f64(),
            Symbol::Parameter(p) => defaults[p],
            _ => f64::NAN,
        });
        let ratio = values[0] / values[1];
        let denominator = (1..=MOST_DENOMINATOR).find(|d| {
            let scaled = ratio * *d as f64;
            (scaled - scaled.round()).abs() < 1e-9 * scaled.abs().max(1.0)
        })?;
        let numerator = (ratio * denominator as f64).round();
        if numerator.abs() > 1e6 {
            return None;
        }
        Rational::new(numerator as i64, denominator).map(Fraction::from)
    }

    /// Whether the bracket of two forms vanishes.
    fn bracket_vanishes(&self, a: &Form, b: &Form) -> bool {
        let Some(elementwise) = &self.elementwise else {
            let entry = |i: usize, j: usize| {
                let mut entries = self.matrix.entries.iter();
                entries.any(|(k, l, _)| [(*k, *l), (*l, *k)].contains(&(i, j)))
            };
            let mut pairs = a
                .iter()
                .flat_map(|(i, _)| b.iter().map(move |(j, _)| (*i, *j)));
            return !pairs.any(|(i, j)| entry(i, j));
        };
        let mut sum = Fraction::from(Rational::ZERO);
        for (i, first) in a {
            for (j, second) in b {
                let constant = &elementwise.constants[*i][*j];
                let term = first
                    .mul(second, &self.budget)
                    .and_then(|product| product.mul(constant, &self.budget));
                let Ok(added) = term.and_then(|term| sum.add(&term, &self.budget)) else {
                    return false;
                };
                sum = added;
            }
        }
        sum.is_zero()
    }

    fn commute(&self, one: &Part, other: &Part) -> bool {
        let mut forms = one.forms.iter();
        forms.all(|(a, _)| {
            let mut others = other.forms.iter();
            others.all(|(b, _)| self.bracket_vanishes(a, b))
        })
    }

    /// The flow of parts that commute; none where its series does not end.
    fn piece(&self, graph: &mut Graph, members: &[&Part]) -> Option<Piece> {
        let forms = members.iter().flat_map(|part| &part.forms);
        let forms: Vec<&(Form, ExprId)> = forms.collect();
        let map = match &self.elementwise {
            Some(elementwise) => self.shifted(graph, elementwise, &forms)?,
            None => self.along_field(graph, &forms)?,
        };
        let terms = members.iter().flat_map(|part| &part.terms);
        Some(Piece {
            terms: terms.copied().collect(),
            factors: Vec::new(),
            conserved: Vec::new(),
            map: Some(map),
        })
    }

    /// `y -> y + t c g`
    fn shifted(
        &self,
        graph: &mut Graph,
        elementwise: &Elementwise,
        forms: &[&(Form, ExprId)],
    ) -> Option<Vec<(usize, Change)>> {
        let time = graph.symbol(Symbol::Time);
        let mut map = Vec::new();
        for (i, speed) in elementwise.speeds.iter().enumerate() {
            let mut terms = Vec::new();
            for (form, slope) in forms {
                let mut sum = Fraction::from(Rational::ZERO);
                for (j, value) in form {
                    let constant = &elementwise.constants[i][*j];
                    let product = constant.mul(value, &self.budget).ok()?;
                    sum = sum.add(&product, &self.budget).ok()?;
                }
                let factor = graph.rational_function(&sum);
                terms.push(graph.mul(factor, *slope));
            }
            let speed_of_y = graph.sum(&terms);
            if graph.is_zero(speed_of_y) {
                continue;
            }
            let s = graph.mul(time, speed_of_y);
            map.push((i, speed.flow(i, s, graph)?));
        }
        Some(map)
    }

    /// The flow of the field, in which the slopes are constants.
    fn along_field(
        &self,
        graph: &mut Graph,
        forms: &[&(Form, ExprId)],
    ) -> Option<Vec<(usize, Change)>> {
        let held = |place: usize| Symbol::Input(place);
        let mut field: Vec<Vec<ExprId>> = vec![Vec::new(); self.matrix.dimension];
        for (place, (form, _)) in forms.iter().enumerate() {
            let slope = graph.symbol(held(place));
            // of one coordinate each
            let (j, _) = form[0];
            for (a, b, entry) in &self.matrix.entries {
                let term = graph.mul(*entry, slope);
                if *b == j {
                    field[*a].push(term);
                } else if *a == j {
                    field[*b].push(graph.neg(term));
                }
            }
        }
        let field: Vec<ExprId> = field.iter().map(|terms| graph.sum(terms)).collect();
        // neither a series nor a quadrature goes on behind a joint
        if field.iter().any(|speed| graph.chooses(*speed)) {
            return None;
        }
        let increments = series(graph, &field).or_else(|| quadrature(graph, &field))?;
        let increments = graph.substitute(&increments, &|symbol| {
            let place = (0..forms.len()).find(|place| held(*place) == symbol);
            place.map(|place| forms[place].1)
        });
        let moved = increments.into_iter().enumerate();
        let moved = moved.filter(|(_, increment)| !graph.is_zero(*increment));
        Some(
            moved
                .map(|(i, increment)| (i, Change::Add(increment)))
                .collect(),
        )
    }
}
