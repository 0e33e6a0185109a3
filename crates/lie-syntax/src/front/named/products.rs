//! `tangent(A)` and `semidirect(A, R^n, …)`.

use super::Parser;
use crate::constructors::{Acted, Matrices, NamedAlgebra, direct_sum, semidirect, tangent};
use crate::diagnostic::{Kind, Origin};
use crate::front::token::{Token, render, span};

/// The spaces of a semidirect product.
const SPACES: &str =
    "the spaces are `R^n`, `dual(R^n)`, `adjoint` and `coadjoint`, as in `semidirect(so(3), R^3)`";

impl Parser<'_, '_> {
    /// `tangent(A)`
    pub(super) fn tangent(
        &mut self,
        arguments: &[&[Token]],
        place: Origin,
    ) -> Option<NamedAlgebra> {
        let [algebra] = arguments else {
            let message = format!("`tangent` takes 1 argument, not {}", arguments.len());
            return self.fail(
                Kind::Arity,
                place,
                message,
                "write `tangent(A)` with an algebra A",
            );
        };
        let text = render(algebra);
        let algebra = direct_sum(self.deeper(algebra, place)?);
        if !self.fits(2 * algebra.dimension(), place) {
            return None;
        }
        let tangent = tangent(algebra);
        let mut names: Vec<&String> = tangent.basis.iter().collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            let message = format!(
                "two elements of `tangent({text})` would be called `{}`: a `d` stands before the names of an algebra that has such names already",
                twice[0]
            );
            let help = format!(
                "write `semidirect({text}, adjoint)`, the same algebra with P1, P2, … and p1, p2, … for what is added"
            );
            return self.fail(Kind::DuplicateName, place, message, &help);
        }
        Some(tangent)
    }

    /// `semidirect(A, R^n, …)`
    pub(super) fn semidirect(
        &mut self,
        arguments: &[&[Token]],
        place: Origin,
    ) -> Option<NamedAlgebra> {
        let [algebra, spaces @ ..] = arguments else {
            let message = "`semidirect` takes an algebra and spaces on which it acts".to_owned();
            return self.fail(
                Kind::Arity,
                place,
                message,
                "write `semidirect(so(3), R^3)`",
            );
        };
        if spaces.is_empty() {
            let message = "`semidirect` has no space on which the algebra acts".to_owned();
            return self.fail(
                Kind::Arity,
                place,
                message,
                "write `semidirect(so(3), R^3)`",
            );
        }
        let algebra = direct_sum(self.deeper(algebra, place)?);
        let mut dimension = algebra.dimension();
        let mut acted = Vec::new();
        for space in spaces {
            let action = self.action(&algebra, space, place)?;
            dimension += action.size;
            acted.push(Acted::new(action));
        }
        let fits = self.fits(dimension, place);
        fits.then(|| semidirect(algebra, acted))
    }

    /// The action on `R^n`, `dual(R^n)`, `adjoint` or `coadjoint`.
    fn action(
        &mut self,
        algebra: &NamedAlgebra,
        space: &[Token],
        place: Origin,
    ) -> Option<Matrices> {
        let place = span(space).unwrap_or(place);
        let text: Vec<String> = space
            .iter()
            .map(|t| render(std::slice::from_ref(t)))
            .collect();
        let text: Vec<&str> = text.iter().map(String::as_str).collect();
        let (power, dual) = match text.as_slice() {
            ["adjoint"] => return Some(algebra.adjoint()),
            ["coadjoint"] => return Some(algebra.adjoint().dual()),
            ["R", power @ ..] => (power, false),
            ["dual", "(", "R", power @ .., ")"] => (power, true),
            _ => {
                let message = format!("`{}` is not a space of a semidirect product", render(space));
                return self.fail(Kind::Syntax, place, message, SPACES);
            }
        };
        let size = match power {
            [] => Some(1),
            ["^", digits] => digits.parse().ok(),
            _ => None,
        };
        let Some(size) = size else {
            let message = format!("`{}` is not a space of a semidirect product", render(space));
            return self.fail(Kind::Syntax, place, message, SPACES);
        };
        let Some(standard) = &algebra.representation else {
            let message =
                "the algebra is too large to carry its standard representation".to_owned();
            return self.fail(Kind::Limit, place, message, "choose a smaller algebra");
        };
        if standard.size != size {
            let acts = standard.size;
            let message = format!("the standard representation is on R^{acts}, not on R^{size}");
            return self.fail(
                Kind::Representation,
                place,
                message,
                &format!("write R^{acts}"),
            );
        }
        Some(if dual {
            standard.dual()
        } else {
            standard.clone()
        })
    }
}
