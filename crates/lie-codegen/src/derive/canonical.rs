//! The kernels of coordinates in which the bracket is constant.

use super::coadjoint::xi;
use super::field::mu;
use super::{Block, Kernel, Source};
use lie_symbolic::symbolic::ExprId;

/// `canonical`, `canonical_slopes`, `canonical_pull`, `canonical_field` and `canonical_jacobian`.
///
/// Each coordinate w_i is a function of x_i and of coordinates that stay, so that `(dw/dmu)^-1` is
/// `v_i = (xi_i - sum_(k != i) dw_i/dx_k xi_k)/(dw_i/dx_i)`.
pub(super) fn kernels(source: &mut Source) -> Option<Vec<Kernel>> {
    let changes = source.structure.conjugate.clone()?.changes;
    let (field, moved) = (source.field(), source.block(Block::Xi));
    let one = source.graph.integer(1);
    let mut values = source.coordinates();
    let mut slopes = vec![one; source.dimension];
    let mut pulled = moved.clone();
    let mut along = field.clone();
    for change in changes {
        let graph = &mut source.graph;
        let i = change.coordinate;
        values[i] = change.value;
        slopes[i] = change.slope;
        let mut terms = vec![graph.mul(change.slope, field[i])];
        let mut beside = vec![moved[i]];
        for &(k, slope) in &change.beside {
            terms.push(graph.mul(slope, field[k]));
            let term = graph.mul(slope, moved[k]);
            beside.push(graph.neg(term));
        }
        along[i] = graph.sum(&terms);
        let beside = graph.sum(&beside);
        pulled[i] = graph.div(beside, change.slope);
    }
    let jacobian = source.jacobian_of(&along);
    let graph = &source.graph;
    let at = || vec![mu(source)];
    let vector =
        |name, formula, entries: &[ExprId]| Kernel::vector(graph, name, formula, at(), entries);
    let kernels = vec![
        vector(
            "canonical",
            "`out = w(mu)`, in which the bracket is constant",
            &values,
        ),
        vector("canonical_slopes", "`out_i = dw_i/dmu_i`", &slopes),
        Kernel::vector(
            graph,
            "canonical_pull",
            "`out = (dw/dmu)^-1 xi`",
            vec![mu(source), xi(source)],
            &pulled,
        ),
        vector("canonical_field", "`out = (dw/dmu) f(mu)`", &along),
        Kernel::matrix(
            graph,
            "canonical_jacobian",
            "`out_ij = d((dw/dmu) f)_i/dmu_j`",
            at(),
            &jacobian,
        ),
    ];
    Some(kernels)
}
