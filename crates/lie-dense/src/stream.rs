//! Stream maps: what a user gives of a Hamiltonian on u(N).

use crate::skew::SkewHermitian;
use lie_runtime::State;

/// The stream map of a Hamiltonian H on skew-Hermitian N x N matrices.
///
/// ```text
/// W' = [P(W), W],   P(W) = -grad H(W),   dH(W) V = <grad H(W), V>,   <A, B> = Re tr(A^H B)
/// ```
///
/// The name is that of fluid dynamics: W is the vorticity, P its stream function. Any Hamiltonian will do, quadratic or not; what
/// is not the gradient of one still gives an isospectral flow, without an energy.
///
/// ```
/// use lie_dense::{SkewHermitian, StreamMap};
///
/// /// `H = a/2 sum_k k |W_kk|^2`
/// struct Diagonal { size: usize, a: f64 }
///
/// impl StreamMap for Diagonal {
///     fn name(&self) -> &str { "Diagonal" }
///     fn size(&self) -> usize { self.size }
///     fn stream(&self, w: &SkewHermitian, p: &mut SkewHermitian) {
///         for k in 0..self.size {
///             for j in k..self.size {
///                 let (_, im) = w.entry(j, k);
///                 p.set_lower(j, k, (0.0, if j == k { -self.a * k as f64 * im } else { 0.0 }));
///             }
///         }
///     }
/// }
/// ```
pub trait StreamMap {
    /// The name of the system.
    fn name(&self) -> &str;
    /// The number of rows N of the matrices.
    fn size(&self) -> usize;
    /// Writes `P(W) = -grad H(W)`, every entry. Allocates nothing.
    fn stream(&self, w: &SkewHermitian, p: &mut SkewHermitian);

    /// The energy H(W), given W and P(W). The provided one, `-<W, P>/2`, is that of a linear map: any other must have its own.
    fn hamiltonian(&self, w: &SkewHermitian, p: &SkewHermitian) -> f64 {
        -0.5 * w.inner(p)
    }

    /// The derivative of P at W along V. Only Jacobians and Hessians use it, which no isospectral method needs. The provided one
    /// is a central difference, exact to round-off for linear maps.
    fn derivative(&self, w: &SkewHermitian, v: &SkewHermitian, out: &mut SkewHermitian) {
        use lie_runtime::Unknown as _;
        let distance =
            6e-6 * w.max_norm().max(f64::MIN_POSITIVE) / v.max_norm().max(f64::MIN_POSITIVE);
        let mut point = w.clone();
        point.axpy(distance, v);
        self.stream(&point, out);
        let ahead = out.clone();
        point.axpy(-2.0 * distance, v);
        self.stream(&point, out);
        let pairs = out.as_mut_slice().iter_mut().zip(ahead.as_slice());
        for (out, &ahead) in pairs {
            *out = (ahead - *out) / (2.0 * distance);
        }
    }
}
