//! Bonds between any two sites, from a list.

use super::shape::Shape as _;
use super::sites::{Site, Sums};
use super::{Family, Sites};
use crate::lattice::{AXES, shown};
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
    sizes: [usize; AXES],
) -> Result<Vec<S>, ParameterError> {
    let (bonds, rest) = given.as_chunks::<3>();
    let (is_chain, count) = (shown(&sizes).len() == 1, sizes[AXES - 1]);
    let site = |place: S| {
        let place = place.to_f64();
        place >= 0.0 && place < count as f64 && place as usize as f64 == place
    };
    let joins = |[i, j, _]: &[S; 3]| site(*i) && site(*j) && i.to_f64() != j.to_f64();
    match is_chain && rest.is_empty() && bonds.iter().all(joins) {
        true => Ok(given.to_vec()),
        false => Err(ParameterError {
            name,
            expression: name,
            fault: ParameterFault::NoBond,
        }),
    }
}

/// The bonds of each site: those of site i are `ends[starts[i]..starts[i + 1]]`, a bond and which of its sites it is.
#[derive(Clone, Debug)]
pub(super) struct Adjacency {
    starts: Vec<usize>,
    ends: Vec<(usize, usize)>,
}

/// The sites of a bond.
fn sites<S: Scalar>([i, j, _]: &[S; 3]) -> [usize; 2] {
    [i, j].map(|place| place.to_f64() as usize)
}

impl Adjacency {
    /// Of so many sites, in the order of the bonds.
    fn new<S: Scalar>(bonds: &[[S; 3]], count: usize) -> Self {
        let all = || bonds.iter().map(sites);
        let mut starts = std::vec![0; count + 1];
        all().flatten().for_each(|site| starts[site + 1] += 1);
        (0..count).for_each(|site| starts[site + 1] += starts[site]);
        let (mut next, mut ends) = (starts.clone(), std::vec![(0, 0); 2 * bonds.len()]);
        for (bond, sites) in all().enumerate() {
            for (which, site) in sites.into_iter().enumerate() {
                ends[next[site]] = (bond, which);
                next[site] += 1;
            }
        }
        Self { starts, ends }
    }
}

impl<K> Family<K> {
    /// What the bonds add to the sums, one after the other.
    pub(super) fn add_bonds<S: Scalar>(
        &self,
        mu: &[S],
        shared: &Sums<K, S>,
        mut add: impl FnMut(&Sums<K, S>),
    ) where
        K: Sites<S>,
    {
        for bond in self.kernels().bonds().as_chunks::<3>().0 {
            let [one, other] = sites(bond).map(|site| self.site(mu, site));
            let kernels = self.kernels();
            add(&kernels.shared_bond_summands(&one, &other, bond[2], shared));
        }
    }

    /// dH/dmu at a site, with what its bonds add.
    pub(super) fn with_bonds<S: Scalar>(
        &self,
        mut slope: Site<K, S>,
        mu: &[S],
        site: usize,
        weights: &Sums<K, S>,
    ) -> Site<K, S>
    where
        K: Sites<S>,
    {
        let bonds = self.kernels().bonds().as_chunks::<3>().0;
        if bonds.is_empty() {
            return slope;
        }
        let adjacency = self
            .adjacency
            .get_or_init(|| Adjacency::new(bonds, self.count()));
        for (bond, which) in &adjacency.ends[adjacency.starts[site]..adjacency.starts[site + 1]] {
            let bond = &bonds[*bond];
            let [one, other] = sites(bond).map(|site| self.site(mu, site));
            let both = self.kernels().bond_slopes(&one, &other, bond[2], weights);
            let more = both[*which].as_ref().iter();
            (slope.as_mut().iter_mut().zip(more)).for_each(|(slope, more)| *slope += *more);
        }
        slope
    }

    /// Adds what bonds do to the sites of some columns of a line.
    pub(super) fn add_field_of_bonds<S: Scalar>(
        &self,
        mu: &[S],
        sites: core::ops::Range<usize>,
        weights: &Sums<K, S>,
        out: &mut [S],
    ) where
        K: Sites<S>,
    {
        let kernels = self.kernels();
        for site in sites {
            let none = K::Site::make(kernels.dimension(), |_| S::zero());
            let slope = self.with_bonds(none, mu, site, weights);
            let field = kernels.ad_star(&slope, &self.site(mu, site));
            for (k, value) in field.as_ref().iter().enumerate() {
                out[k * self.count() + site] += *value;
            }
        }
    }
}
