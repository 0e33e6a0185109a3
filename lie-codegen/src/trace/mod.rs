//! Methods are stated once, in `lie_core::generic`, for any scalar. Here the scalar is an expression: to run an equation
//! over it is to write its formula down, and what is written down is differentiated, scheduled and printed.
//!
//! A trace has one path. An equation that compares numbers has several, and is refused; it runs as it is, or
//! marks what it compares as given from outside. The Jacobian is found by differentiation, or is that which the
//! equation states.

mod equation;
mod sym;
mod system;

pub use equation::{Formulas, Step, kernels, step};
pub(crate) use equation::{linearized, values, whole};
pub use sym::Sym;
pub use system::{Square, SymbolicSystem};
pub(crate) use system::{SymbolicActions, SymbolicFunction, SymbolicGradient};

#[cfg(test)]
mod tests {
    use super::{Formulas, kernels, step};
    use crate::compile::compile_spec;
    use crate::derive::Source;
    use lie_core::generic;

    const SPEC: &str = r#"{
        "format": 1, "name": "Body",
        "algebra": { "basis": ["a", "b", "c"], "brackets": ["[a, b] = c", "[b, c] = a", "[c, a] = b"] },
        "state": ["x", "y", "z"], "hamiltonian": "x^2/2 + y^2/3 + z^4/5", "initial": [1, 1, 1]
    }"#;
    const FORMULAS: Formulas = Formulas {
        residual: "",
        linearize: "",
        result: "",
    };

    #[test]
    fn an_equation_with_one_path_is_written_down() {
        let mut source = Source::of(&compile_spec(SPEC).expect("a sound spec"));
        let dimension = source.dimension;
        let found = kernels(&mut source, &FORMULAS, |system, h| {
            step(generic::Midpoint::new(system, h))
        });
        let names: Vec<&str> = found.iter().flatten().map(|kernel| kernel.name).collect();
        // the unknown is the state at the end
        assert_eq!(names, ["residual", "linearize"]);
        assert_eq!(source.dimension, dimension, "the source is given back");
    }

    /// The exponential series ends by a comparison.
    #[test]
    fn an_equation_that_compares_is_refused() {
        let mut source = Source::of(&compile_spec(SPEC).expect("a sound spec"));
        let found = kernels(&mut source, &FORMULAS, |system, h| {
            step(generic::ExpMidpoint::new(system, h))
        });
        assert!(found.is_none());
    }
}
