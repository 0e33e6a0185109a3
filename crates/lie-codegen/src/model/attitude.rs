//! The initial group element.

use super::{Bracket, Model, at_parameters};
use lie_core::structure::{Chart, EulerSequence, rotation};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::diagnostic::Origin;

/// The declared group element at the start, expressions in constants and parameters.
#[derive(Clone, Debug)]
pub struct Attitude {
    /// How it was written.
    pub form: Form,
    /// Its entries in this form: those of a matrix by rows.
    pub entries: Vec<ExprId>,
    /// Its matrix by rows, that of a quaternion divided by its norm.
    pub matrix: Vec<ExprId>,
    /// Where it stands.
    pub origin: Origin,
}

/// How a group element is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A quaternion, the real part first.
    Quaternion,
    /// A matrix.
    Matrix,
    /// Euler angles.
    Euler(EulerSequence),
}

impl Attitude {
    /// The entries in the form in which it was written, at values of the parameters.
    pub fn values(&self, graph: &Graph, parameters: &[f64]) -> Vec<f64> {
        at_parameters(graph, &self.entries, parameters)
    }

    /// The entries of the matrix by rows, at values of the parameters.
    pub fn rows(&self, graph: &Graph, parameters: &[f64]) -> Vec<f64> {
        at_parameters(graph, &self.matrix, parameters)
    }

    /// The entries in a chart, at values of the parameters: as they were written where that is the form, with a quaternion of norm 1.
    pub fn in_chart(&self, chart: Chart, graph: &Graph, parameters: &[f64]) -> Vec<f64> {
        let values = || self.values(graph, parameters);
        let quaternion = || match self.form {
            Form::Quaternion => rotation::unit(first(&values())),
            Form::Euler(sequence) => sequence.quaternion(first(&values())),
            Form::Matrix => {
                let rows = self.rows(graph, parameters);
                // the first rows and columns of a matrix that may be larger
                let size = rows.len().isqrt();
                rotation::quaternion(&[0, 1, 2].map(|row| first(&rows[row * size..])))
            }
        };
        match chart {
            Chart::Matrix => self.rows(graph, parameters),
            Chart::Euler(sequence) if self.form == Form::Euler(sequence) => values(),
            Chart::Euler(sequence) => sequence.angles(quaternion()).to_vec(),
            Chart::Quaternion => quaternion().to_vec(),
        }
    }
}

fn first<const N: usize>(values: &[f64]) -> [f64; N] {
    std::array::from_fn(|k| values[k])
}

impl Model {
    /// The declared group element at the start as text.
    pub fn display_attitude(&self) -> Option<String> {
        let attitude = self.attitude.as_ref()?;
        let entries = attitude.entries.iter().map(|entry| self.display(*entry));
        let entries: Vec<String> = entries.collect();
        let listed = |entries: &[String]| entries.join(", ");
        Some(match attitude.form {
            Form::Quaternion => format!("quaternion ({})", listed(&entries)),
            Form::Euler(sequence) => {
                format!("Euler angles {} ({})", sequence.name(), listed(&entries))
            }
            Form::Matrix => {
                let rows = entries.chunks(entries.len().isqrt());
                let rows: Vec<String> = rows.map(|row| format!("[{}]", listed(row))).collect();
                format!("matrix [{}]", rows.join(", "))
            }
        })
    }

    /// The group element at the start in a chart, at values of the parameters; none where none is declared.
    pub fn initial_element(&self, chart: Chart, parameters: &[f64]) -> Option<Vec<f64>> {
        let attitude = self.attitude.as_ref()?;
        Some(attitude.in_chart(chart, &self.graph, parameters))
    }

    /// The matrices of the declared basis elements, of which those of the group are made, and their size; none where there are no
    /// matrices or brackets beside those of the algebra. Beside a group element they are transposed.
    pub fn group_matrices(&self) -> Option<(usize, Vec<Vec<Vec<Rational>>>)> {
        let Bracket::Lie(algebra) = &self.bracket else {
            return None;
        };
        let representation = algebra.group_representation()?;
        let configuration = self.configuration.as_ref();
        let whole = representation.dimension;
        let size = configuration.map_or(whole, |c| c.size_of_group(whole));
        let own = configuration.filter(|c| c.group.is_some());
        let own = own.map_or(usize::MAX, |c| c.own_momenta());
        let block = |matrix: &Vec<Vec<Rational>>| {
            let rows = matrix.iter().take(size);
            rows.map(|row| row[..size].to_vec()).collect()
        };
        let matrices = representation.matrices.iter().take(own);
        Some((size, matrices.map(block).collect()))
    }
}
