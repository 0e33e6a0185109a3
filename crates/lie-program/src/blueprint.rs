//! A system before its parameters have values.

use crate::protocol::{End, Obstacle, Start};
use lie_runtime::{ParameterError, Poisson, State};

type Make<P> = dyn Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync;

/// The parameters of a system, and how it is made of their values.
pub struct Blueprint<P> {
    parameters: Vec<(String, f64)>,
    make: Box<Make<P>>,
}

/// A system at its initial state.
pub struct Built<P: Poisson<f64>> {
    /// The system.
    pub system: P,
    /// The state.
    pub mu: P::State,
}

impl<P: Poisson<f64>> Blueprint<P> {
    /// From the parameters with their defaults, in the order in which `make` takes their values.
    pub fn new(
        parameters: &[(&str, f64)],
        make: impl Fn(&[f64]) -> Result<P, ParameterError> + Send + Sync + 'static,
    ) -> Self {
        Self {
            parameters: parameters
                .iter()
                .map(|(name, value)| ((*name).to_owned(), *value))
                .collect(),
            make: Box::new(make),
        }
    }

    /// The names of the parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters.iter().map(|(name, _)| name.as_str())
    }

    /// The values of the parameters, in order.
    ///
    /// # Errors
    /// A value is given to none of them.
    pub fn values(&self, start: &Start) -> Result<Vec<f64>, End> {
        let known = |name: &str| self.parameters.iter().any(|(known, _)| known == name);
        if let Some(name) = start.parameters.keys().find(|name| !known(name)) {
            return Err(End::refused(
                Obstacle::Request,
                format!("no parameter `{name}` in this program"),
            ));
        }
        let value =
            |(name, default): &(String, f64)| *start.parameters.get(name).unwrap_or(default);
        Ok(self.parameters.iter().map(value).collect())
    }

    /// The system of these values.
    ///
    /// # Errors
    /// The value of a parameter is impossible.
    pub fn make(&self, values: &[f64]) -> Result<P, ParameterError> {
        (self.make)(values)
    }

    /// The system at its initial state.
    ///
    /// # Errors
    /// The value of a parameter is impossible, or the state has another length.
    pub fn build(&self, start: &Start) -> Result<Built<P>, End> {
        let system = self
            .make(&self.values(start)?)
            .map_err(|error| End::Parameter {
                name: error.name.to_owned(),
                why: error.to_string(),
            })?;
        let (given, needed) = (start.initial.len(), system.dimension());
        if given != needed {
            let why = format!("{given} values where {needed} are needed");
            return Err(End::refused(Obstacle::Initial, why));
        }
        let mut mu = system.zero_state();
        mu.as_mut_slice().copy_from_slice(&start.initial);
        Ok(Built { system, mu })
    }
}
