//! Bonds between any two sites, from a list.

use super::shape::Shape as _;
use super::sites::{Site, Sums};
use super::{Family, Sites};
use crate::parameter::{ParameterError, ParameterFault};
use crate::scalar::Scalar;
use std::vec::Vec;

/// Rows `i, j, value` of bonds between sites of a chain.
///
/// # Errors
/// A row joins sites that are not there, or a site to itself.
pub fn bonds<S: Scalar>(
    given: &[S],
    name: &'static str,
    [rows, columns]: [usize; 2],
) -> Result<Vec<S>, ParameterError> {
    let (bonds, rest) = given.as_chunks::<3>();
    let site = |place: S| {
        let place = place.to_f64();
        place >= 0.0 && place < columns as f64 && place as usize as f64 == place
    };
    let joins = |[i, j, _]: &[S; 3]| site(*i) && site(*j) && i.to_f64() != j.to_f64();
    match rows == 1 && rest.is_empty() && bonds.iter().all(joins) {
        true => Ok(given.to_vec()),
        false => Err(ParameterError {
            name,
            expression: name,
            fault: ParameterFault::NoBond,
        }),
    }
}

impl<K> Family<K> {
    /// The bonds: their sites with their coordinates, and their values.
    fn links<S: Scalar>(&self, mu: &[S]) -> impl Iterator<Item = ([usize; 2], [Site<K, S>; 2], S)>
    where
        K: Sites<S>,
    {
        self.kernels()
            .bonds()
            .as_chunks::<3>()
            .0
            .iter()
            .map(|[i, j, value]| {
                let sites = [i, j].map(|place| place.to_f64() as usize);
                (sites, sites.map(|site| self.site(mu, site)), *value)
            })
    }

    /// What the bonds add to the sums, one after the other.
    pub(super) fn add_bonds<S: Scalar>(&self, mu: &[S], mut add: impl FnMut(&Sums<K, S>))
    where
        K: Sites<S>,
    {
        for (_, [one, other], value) in self.links(mu) {
            add(&self.kernels().bond_summands(&one, &other, value));
        }
    }

    /// What the bonds add to dH/dmu, in the order of a state; nothing where there are none.
    pub(super) fn of_bonds<S: Scalar>(&self, mu: &[S], weights: &Sums<K, S>) -> Vec<S>
    where
        K: Sites<S>,
    {
        if self.kernels().bonds().is_empty() {
            return Vec::new();
        }
        let mut slopes = std::vec![S::zero(); self.own()];
        for (sites, [one, other], value) in self.links(mu) {
            let both = self.kernels().bond_slopes(&one, &other, value, weights);
            for (site, slope) in sites.into_iter().zip(both) {
                for (k, slope) in slope.as_ref().iter().enumerate() {
                    slopes[k * self.count() + site] += *slope;
                }
            }
        }
        slopes
    }

    /// dH/dmu at a site, with what the bonds add.
    pub(super) fn with_bonds<S: Scalar>(
        &self,
        slope: Site<K, S>,
        of_bonds: &[S],
        site: usize,
    ) -> Site<K, S>
    where
        K: Sites<S>,
    {
        if of_bonds.is_empty() {
            return slope;
        }
        let slope = slope.as_ref();
        K::Site::make(slope.len(), |k| {
            slope[k] + of_bonds[k * self.count() + site]
        })
    }
}
