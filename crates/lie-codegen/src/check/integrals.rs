//! First integrals: `{F, H} = sum_ij dF/dx_i Pi_ij dH/dx_j = 0`, proven by a normal form. With the time among the coordinates H is that of
//! the extended phase space, so that the bracket has `dF/dt` in it.

use super::energy::Declared;
use crate::model::configuration::Configuration;
use crate::model::{Driving, Energy, PoissonMatrix, bracket_of};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::{Proof, Prover};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Expr, Name};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Work allowed for one of them.
const WORK: u64 = 5_000_000;

/// Of what functions are to be first integrals.
pub struct Motion<'a> {
    /// The Poisson matrix.
    pub matrix: &'a PoissonMatrix,
    /// The Hamiltonian.
    pub energy: &'a Energy<Declared>,
    /// What acts beside it.
    pub driving: Option<&'a Driving>,
    /// The group element and the time, where they are among the coordinates.
    pub configuration: Option<&'a Configuration>,
    /// The names of symbols.
    pub name: &'a dyn Fn(Symbol) -> String,
}

impl Motion<'_> {
    /// Why a function is no first integral, or is not shown to be one. `scratch` is an arena that may be littered.
    pub fn refutation(
        &self,
        (name, declared): &(Name, Expr),
        function: ExprId,
        scratch: &mut Graph,
    ) -> Option<Diagnostic> {
        let hamiltonian = self.energy.value(|hamiltonian| hamiltonian.value);
        let bracket = bracket_of(scratch, &self.matrix.entries, function, hamiltonian);
        let driven = self.driven(function, scratch);
        let bracket = scratch.add(bracket, driven);
        let bracket = self.on_solutions(bracket, scratch);
        let mut domain = vec![function, hamiltonian];
        domain.extend(self.matrix.entries.iter().map(|(.., value)| *value));
        let domain: Vec<ExprId> = domain
            .into_iter()
            .map(|part| self.on_solutions(part, scratch))
            .collect();
        let budget = Budget::new(WORK);
        let proof = Prover::new(scratch, &budget, &domain, self.name).examine(bracket);
        let text = &name.text;
        let rate = match self.driving {
            Some(_) => format!("d{text}/dt"),
            None => format!("{{{text}, H}}"),
        };
        let noisy = self.driving.is_some_and(Driving::is_noisy);
        let of_noise = |shown: &str| match noisy && shown.contains("dW") {
            true => ", where the W are the processes of the noise",
            false => "",
        };
        let (message, help) = match proof {
            Proof::Zero => return None,
            Proof::Nonzero(shown) => (
                format!(
                    "`{text}` is not a first integral: {rate} = {shown}{}",
                    of_noise(&shown)
                ),
                "a first integral keeps its value along every motion: mend it or the Hamiltonian, or make it one of the `observables`",
            ),
            Proof::Unproven {
                text: shown,
                values,
            } => {
                let shown = shown.map_or_else(String::new, |shown| format!(" = {shown}"));
                (
                    format!(
                        "`{text}` is unproven: it could not be shown that {rate}{shown} is zero{}, {values}",
                        of_noise(&shown)
                    ),
                    "write it in a simpler form, with fewer different functions and roots, or make it one of the `observables`",
                )
            }
        };
        Some(Diagnostic::new(Kind::Integral, declared.origin, message).help(help))
    }

    /// What acts beside the Hamiltonian changes in a function: `<grad F, f + Pi d>` with the force f and what damping adds to the generator.
    fn driven(&self, function: ExprId, scratch: &mut Graph) -> ExprId {
        let Some(driving) = self.driving else {
            return scratch.integer(0);
        };
        let slopes: Vec<ExprId> = (0..driving.force.len())
            .map(|i| scratch.derivative(function, Symbol::Coordinate(i)))
            .collect();
        let pairs = slopes.iter().zip(&driving.force);
        let mut terms: Vec<ExprId> = pairs.map(|(s, f)| scratch.mul(*s, *f)).collect();
        for (i, j, entry) in &self.matrix.entries {
            let forth = scratch.mul(slopes[*i], driving.damping[*j]);
            let back = scratch.mul(slopes[*j], driving.damping[*i]);
            let both = scratch.sub(forth, back);
            terms.push(scratch.mul(*entry, both));
        }
        scratch.sum(&terms)
    }

    /// The expression where the motion takes place: the unit beside the time is 1, and momenta without a Hamiltonian in them are
    /// those of their velocity, `mu = l'(xi)`.
    fn on_solutions(&self, expr: ExprId, scratch: &mut Graph) -> ExprId {
        let mut values: Vec<(Symbol, ExprId)> = Vec::new();
        if let Some(clock) = self.configuration.and_then(Configuration::clock) {
            values.push((Symbol::Coordinate(clock.time + 1), scratch.integer(1)));
        }
        if let Energy::Legendre(lagrangian, _) = self.energy {
            for i in 0..lagrangian.velocity.len() {
                let momentum = scratch.derivative(lagrangian.value, Symbol::Input(i));
                values.push((Symbol::Coordinate(i), momentum));
            }
        }
        if values.is_empty() {
            return expr;
        }
        let replace = |symbol| {
            let mut values = values.iter();
            values.find(|(s, _)| *s == symbol).map(|(_, value)| *value)
        };
        scratch.substitute(&[expr], &replace)[0]
    }
}
