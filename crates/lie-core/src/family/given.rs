//! What parameters give a family: the number of its sites, and values for each of them.

use crate::lattice::{AXES, count, shown};
use crate::parameter::{ParameterError, ParameterFault};
use crate::scalar::Scalar;
use std::vec::Vec;

/// The number of sites along one axis, from the value of a parameter.
///
/// # Errors
/// It is no whole number between 1 and `2^31`.
pub fn size<S: Scalar>(value: S, name: &'static str) -> Result<usize, ParameterError> {
    let number = value.to_f64();
    if number >= 1.0 && number <= (1_u64 << 31) as f64 && number as usize as f64 == number {
        Ok(number as usize)
    } else {
        Err(ParameterError {
            name,
            expression: name,
            fault: ParameterFault::NotASize,
        })
    }
}

/// The values of a coefficient that differs from site to site, as many as there are sites: in place of those of the last sites of a
/// chain that are left out, of which no sum asks for more than `unused`, stands 0.
///
/// # Errors
/// There are other numbers of values and of sites.
pub fn values<S: Scalar>(
    given: &[S],
    name: &'static str,
    sizes: [usize; AXES],
    unused: usize,
) -> Result<Vec<S>, ParameterError> {
    let left_out = if shown(&sizes).len() == 1 { unused } else { 0 };
    let count = count(sizes);
    if given.len() > count || count - given.len() > left_out {
        return Err(ParameterError {
            name,
            expression: name,
            fault: ParameterFault::NotOneForEachSite,
        });
    }
    let mut values = given.to_vec();
    values.resize(count, S::zero());
    Ok(values)
}
