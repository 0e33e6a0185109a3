//! Methods are stated once, in `lie_core::generic`, for any scalar. Here the scalar is an expression: to run an equation
//! over it is to write its formula down, and what is written down is differentiated, scheduled and printed.
//!
//! A trace has one path. An equation that compares numbers has several, and is refused; it runs as it is, or
//! marks what it compares as given from outside. The Jacobian is found by differentiation, or is that which the
//! equation states.

mod equation;
mod explicit_unknowns;
mod linear;
mod parts;
mod sym;
mod system;

pub use equation::{COMPLETED, Formulas, Step, kernels, step};
pub(crate) use equation::{complete, linearized, values};
pub(crate) use parts::{SymbolicActions, SymbolicFunction, SymbolicGradient};
pub use sym::Sym;
pub use system::{Square, SymbolicSystem};

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
        let mut source = Source::new(&compile_spec(SPEC).expect("a sound spec"));
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
        let mut source = Source::new(&compile_spec(SPEC).expect("a sound spec"));
        let found = kernels(&mut source, &FORMULAS, |system, h| {
            step(generic::ExpMidpoint::new(system, h))
        });
        assert!(found.is_none());
    }

    /// The coordinates that the iteration of an equation leaves out.
    fn left_out(
        spec: &str,
        kernels: fn(&mut Source) -> Option<Vec<crate::derive::Kernel>>,
    ) -> Vec<usize> {
        let model = compile_spec(spec).expect("a sound spec");
        let mut source = Source::new(&model);
        let algebra = model.bracket.algebra().expect("an algebra");
        source.exponential = crate::structure::exponential::closed_form(&algebra.exact);
        let kernels = kernels(&mut source).expect("one path");
        let residual = kernels.iter().find(|kernel| kernel.name == "residual");
        let crate::derive::Shape::Vector(indices) = &residual.expect("a residual").shape else {
            panic!("the residual is a vector")
        };
        let iterated: Vec<usize> = indices.clone();
        let left_out = (0..source.dimension).filter(|i| !iterated.contains(i));
        let left_out: Vec<usize> = left_out.collect();
        let completed = kernels.iter().any(|kernel| kernel.name == super::COMPLETED);
        assert_eq!(completed, !left_out.is_empty());
        left_out
    }

    fn spec_of(algebra: &str, state: &str, hamiltonian: &str, initial: &str) -> String {
        format!(
            r#"{{ "format": 1, "name": "Body", "algebra": {algebra}, "state": [{state}],
            "hamiltonian": "{hamiltonian}", "initial": [{initial}] }}"#
        )
    }

    /// `exp(ad*_x)` for `x = h grad H(m)` does not know a coordinate in which H is linear with a constant coefficient.
    #[test]
    fn what_the_gradient_does_not_know_is_left_out() {
        let exp = |source: &mut Source| source.exp_kernels();
        let se3 = r#""se(3)""#;
        let state = r#""a", "b", "c", "x", "y", "z""#;
        let of = |hamiltonian: &str| {
            left_out(&spec_of(se3, state, hamiltonian, "1, 1, 1, 0, 0, 1"), exp)
        };
        assert_eq!(of("a^2 + b^2/2 + c^2/3 + z"), [3, 4, 5], "the heavy top");
        assert_eq!(of("a^2 + b^2/2 + c^2/3 + z^2"), [3, 4]);
        assert_eq!(of("a^2 + b^2/2 + c^2/3 + x^2 + y^2/2 + z^2/3"), [0; 0]);
        assert_eq!(left_out(SPEC, exp), [0; 0]);
        assert_eq!(
            left_out(SPEC, |source| Some(source.midpoint_kernels())),
            [0; 0]
        );
    }

    /// A vector that H does not see turns about the gradient, linearly: it is solved for at the end.
    #[test]
    fn a_vector_that_is_not_seen_is_left_out() {
        let midpoint = |source: &mut Source| Some(source.midpoint_kernels());
        let cayley = |source: &mut Source| source.cayley_kernels();
        let state = r#""a", "b", "c", "x", "y", "z""#;
        let body = "a^2 + b^2/2 + c^2/3";
        for (hamiltonian, expected) in [
            (body.to_owned(), vec![3, 4, 5]),
            (format!("{body} + x"), vec![]),
            (format!("{body} + x^2"), vec![]),
        ] {
            let spec = spec_of(r#""se(3)""#, state, &hamiltonian, "1, 1, 1, 0, 0, 1");
            assert_eq!(left_out(&spec, midpoint), expected, "{hamiltonian}");
            assert_eq!(left_out(&spec, cayley), expected, "{hamiltonian}");
        }
        // two vectors, each by itself
        let algebra = r#""semidirect(so(3), R^3, R^3)""#;
        let state = r#""a", "b", "c", "x", "y", "z", "u", "v", "w""#;
        let spec = spec_of(algebra, state, body, "1, 1, 1, 0, 0, 1, 0, 1, 0");
        assert_eq!(left_out(&spec, midpoint), [3, 4, 5, 6, 7, 8]);
    }

    /// Time, the central coordinate of its pair, and the momentum conjugate to time.
    #[test]
    fn time_is_not_iterated() {
        let spec = SPEC.replace("z^4/5", "z^4/5 + x*sin(t)");
        let all = Source::new(&compile_spec(&spec).expect("a sound spec")).dimension;
        let hidden: Vec<usize> = (3..all).collect();
        assert_eq!(hidden.len(), 3, "time, its momentum, one");
        assert_eq!(
            left_out(&spec, |source| Some(source.midpoint_kernels())),
            hidden
        );
        assert_eq!(left_out(&spec, |source| source.exp_kernels()), hidden);
    }
}
