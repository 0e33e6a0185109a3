//! Derivatives of functions that a declaration takes from Rust.

use super::{Dual, Scalar};

/// The partial derivative `df/dx_i` of a function of N arguments, exact to round-off, by dual numbers.
///
/// ```
/// use lie_core::scalar::partial;
/// let slope = partial(|[x, y]| x * x * y, [3.0_f64, 5.0], 0);
/// assert_eq!(slope, 30.0);
/// ```
#[inline]
pub fn partial<S: Scalar, const N: usize>(
    function: impl Fn([Dual<S>; N]) -> Dual<S>,
    at: [S; N],
    place: usize,
) -> S {
    along(function, at, place).derivative
}

#[inline]
fn along<S: Scalar, const N: usize>(
    function: impl Fn([Dual<S>; N]) -> Dual<S>,
    at: [S; N],
    place: usize,
) -> Dual<S> {
    let mut moved = at.map(Dual::constant_of);
    moved[place] = Dual::variable(at[place]);
    function(moved)
}

/// The derivative that was declared of a function, compared with that by dual numbers where debug assertions are on.
///
/// Both agree within `sqrt(eps) (|f'| + |f/x_i|)`, where eps is the round-off unit of the scalar. No more is asked for, because
/// cancellation in either of them is no mistake of the declaration.
///
/// # Panics
/// With debug assertions, where they differ by more; without them never.
#[inline]
pub fn declared_derivative<S: Scalar, const N: usize>(
    name: &str,
    derivative: impl Fn([S; N]) -> S,
    function: impl Fn([Dual<S>; N]) -> Dual<S>,
    at: [S; N],
    place: usize,
) -> S {
    let declared = derivative(at);
    if cfg!(debug_assertions) {
        let computed = along(function, at, place);
        for lane in 0..S::LANES {
            let number = |x: S| x.lane(lane).to_f64();
            let (given, slope) = (number(declared), number(computed.derivative));
            let value = number(computed.value / at[place]).abs();
            let size = slope.abs() + if value.is_finite() { value } else { 0.0 };
            let bound = S::epsilon().lane(lane).to_f64().sqrt() * size;
            // where dual numbers give none, the declared one stands alone
            assert!(
                !slope.is_finite() || (given - slope).abs() <= bound,
                "the declared derivative of `{name}` by its argument {} is {given:e} at {:e}, where dual numbers give \
                 {slope:e}: correct it, or leave `derivatives` out",
                place + 1,
                number(at[place]),
            );
        }
    }
    declared
}

#[cfg(test)]
mod tests {
    use super::*;

    fn f<S: Scalar>(x: S, y: S) -> S {
        x.sin() * y * y
    }

    #[test]
    fn derivatives_of_any_order_are_those_of_calculus() {
        let at = [0.7_f64, 1.3];
        let mixed = partial(|x| partial(|x| f(x[0], x[1]), x, 0), at, 1);
        assert!((mixed - 2.0 * 1.3 * libm::cos(0.7)).abs() < 1e-15);
        let third = partial(
            |x| partial(|x| partial(|x| f(x[0], x[1]), x, 0), x, 0),
            at,
            0,
        );
        assert!((third + 1.69 * libm::cos(0.7)).abs() < 1e-15);
    }

    #[test]
    fn a_right_derivative_is_taken_as_it_is() {
        let slope = |x: [f64; 2]| 2.0 * libm::sin(x[0]) * x[1];
        let at = [0.7, 1.3];
        let found = declared_derivative("f", slope, |x| f(x[0], x[1]), at, 1);
        assert_eq!(found.to_bits(), slope(at).to_bits());
    }

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "the declared derivative of `f` by its argument 2")]
    fn a_wrong_derivative_is_found() {
        let slope = |x: [f64; 2]| -2.0 * libm::sin(x[0]) * x[1];
        declared_derivative("f", slope, |x| f(x[0], x[1]), [0.7, 1.3], 1);
    }
}
