//! The system of a family: loops over the kernels of a site.

use super::links::Adjacency;
use super::parts::Power;
use super::stencil::inputs;
use super::{LateMatrix, Sites};
use crate::clock::Clock;
use crate::lattice::{AXES, count, named, site};
use crate::poisson::{LiePoisson, Poisson, Widen};
use crate::scalar::Scalar;
use core::ops::Range;
use std::format;
use std::string::String;
use std::sync::OnceLock;
use std::vec::Vec;

/// A family of sites as a system; see the [module's text](super).
///
/// Its Casimirs are, of each Casimir of a site, the mean over all sites, the smallest and the largest one.
#[derive(Clone, Debug)]
pub struct Family<K> {
    kernels: K,
    sizes: [usize; AXES],
    /// The names of the coordinates, made when somebody asks for one: a large family is integrated without.
    coordinates: OnceLock<Vec<String>>,
    casimirs: OnceLock<Vec<String>>,
    /// The bonds of each site, found when they are asked for.
    pub(super) adjacency: OnceLock<Adjacency>,
}

/// A recorded function: the work stands before observables, and inputs behind them.
enum Recorded {
    Work,
    Observable(usize),
    Input(usize),
}

/// What there is of each Casimir of a site, over all sites.
pub const STATISTICS: [&str; 3] = ["mean", "min", "max"];

impl<K> Family<K> {
    /// The family of so many sites, layers, rows and columns; a chain is one row, a square lattice one layer.
    pub fn new(kernels: K, sizes: [usize; AXES]) -> Self {
        Self {
            kernels,
            sizes,
            coordinates: OnceLock::new(),
            casimirs: OnceLock::new(),
            adjacency: OnceLock::new(),
        }
    }

    /// The kernels of a site.
    #[inline]
    pub fn kernels(&self) -> &K {
        &self.kernels
    }

    /// Layers, rows and columns.
    #[inline]
    pub fn sizes(&self) -> [usize; AXES] {
        self.sizes
    }

    /// The number of sites.
    #[inline]
    pub fn count(&self) -> usize {
        count(self.sizes)
    }

    fn coordinate_names<S: Scalar>(&self) -> &[String]
    where
        K: Sites<S>,
    {
        self.coordinates.get_or_init(|| {
            let coordinates = 0..self.kernels.dimension();
            let named = |name: &str, site: usize| named(name, site, self.sizes);
            let all = coordinates.map(|k| self.kernels.coordinate(k));
            let all = all.flat_map(|name| (0..self.count()).map(move |site| named(name, site)));
            let carried = ["clock", "t", "unit"].map(str::to_owned);
            let carried = carried.into_iter().filter(|_| self.kernels.is_timed());
            let inputs = 0..inputs(&self.kernels);
            let inputs = inputs.map(|index| self.kernels.input_name(index).to_owned());
            let rates = 0..self.kernels.noise_count();
            let rates = rates
                .flat_map(|k| (0..self.count()).map(move |site| named(&format!("dW{k}"), site)));
            all.chain(carried).chain(inputs).chain(rates).collect()
        })
    }

    fn casimir_names<S: Scalar>(&self) -> &[String]
    where
        K: Sites<S>,
    {
        self.casimirs.get_or_init(|| {
            let casimirs = (0..3 * self.kernels.casimir_count()).map(|index| {
                let name = self.kernels.casimir_name(index / 3);
                format!("{name}_{}", STATISTICS[index % 3])
            });
            casimirs.collect()
        })
    }

    /// What a recorded function is.
    fn recorded<S: Scalar>(&self, quantity: usize) -> Recorded
    where
        K: Sites<S>,
    {
        let Some(place) = quantity.checked_sub(usize::from(self.kernels.acts())) else {
            return Recorded::Work;
        };
        match place.checked_sub(self.kernels.observable_count()) {
            None => Recorded::Observable(place),
            Some(place) => Recorded::Input(place),
        }
    }

    /// The sum of a Casimir over all sites, and the smallest and the largest value.
    fn statistics<S: Scalar>(&self, mu: &[S], index: usize) -> [S; 3]
    where
        K: Sites<S>,
    {
        let value = |site: usize| self.kernels.casimir(index, &self.site(mu, site));
        let first = value(0);
        (1..self.count()).fold([first; 3], |[sum, smallest, largest], site| {
            let next = value(site);
            [sum + next, -(-smallest).max(-next), largest.max(next)]
        })
    }

    /// The site at which a Casimir is smallest, or largest; of lanes in the first one.
    fn extreme<S: Scalar>(&self, mu: &[S], index: usize, largest: bool) -> usize
    where
        K: Sites<S>,
    {
        let value = |site: usize| self.kernels.casimir(index, &self.site(mu, site)).to_f64();
        let mut found = (0, value(0));
        for site in 1..self.count() {
            let next = value(site);
            if next != found.1 && (next > found.1) == largest {
                found = (site, next);
            }
        }
        found.0
    }
}

impl<S, K> Poisson<S> for Family<K>
where
    S: Scalar,
    K: Sites<S>,
{
    type State = Vec<S>;
    type Jacobian = LateMatrix<S>;

    fn dimension(&self) -> usize {
        self.length()
    }
    fn name(&self) -> &str {
        self.kernels.name()
    }
    fn coordinate(&self, index: usize) -> &str {
        &self.coordinate_names()[index]
    }
    fn sites(&self) -> Option<[usize; AXES]> {
        Some(self.sizes)
    }
    fn casimir_count(&self) -> usize {
        3 * self.kernels.casimir_count()
    }
    fn casimir_name(&self, index: usize) -> &str {
        &self.casimir_names()[index]
    }
    fn casimir_degree(&self, index: usize) -> Option<u32> {
        self.kernels
            .casimir_degree(index / 3)
            .filter(|_| index.is_multiple_of(3))
    }
    fn casimir_is_kept(&self, index: usize) -> bool {
        self.kernels.casimir_is_kept(index / 3)
    }
    fn hamiltonian_degree(&self) -> Option<u32> {
        self.kernels.degree()
    }
    fn is_autonomous(&self) -> bool {
        self.kernels.is_autonomous()
    }
    fn clock(&self) -> Option<Clock> {
        let [momentum, time, _] = self.pair();
        let clock = Clock { momentum, time };
        self.kernels.is_timed().then_some(clock)
    }
    fn is_forced(&self) -> bool {
        self.kernels.is_forced()
    }
    fn is_damped(&self) -> bool {
        self.kernels.is_damped()
    }
    fn input_count(&self) -> usize {
        inputs(&self.kernels)
    }
    fn input_sampling(&self, index: usize) -> Option<f64> {
        self.kernels.input_sampling(index)
    }
    fn noise_count(&self) -> usize {
        self.kernels.noise_count() * self.count()
    }
    fn quantity_count(&self) -> usize {
        let work = usize::from(self.kernels.acts());
        work + self.kernels.observable_count() + inputs(&self.kernels)
    }
    fn quantity_name(&self, index: usize) -> &str {
        match self.recorded(index) {
            Recorded::Work => "work",
            Recorded::Observable(index) => self.kernels.observable_name(index),
            Recorded::Input(index) => self.kernels.input_name(index),
        }
    }
    fn quantity_unwraps(&self, index: usize) -> bool {
        match self.recorded(index) {
            Recorded::Observable(index) => self.kernels.observable_unwraps(index),
            Recorded::Work | Recorded::Input(_) => false,
        }
    }
    fn quantities(&self, mu: &Vec<S>, out: &mut [S]) {
        let asked = self.kernels.observable_count() > 0;
        let totals = asked.then(|| self.totals(mu));
        for (place, value) in out.iter_mut().enumerate() {
            *value = match (self.recorded(place), &totals) {
                (Recorded::Observable(index), Some(totals)) => {
                    self.kernels.observable(index, totals)
                }
                (Recorded::Input(index), _) => mu[self.input(index)],
                _ => -mu[self.own()],
            };
        }
    }
    fn has_jacobian(&self) -> bool {
        false
    }
    fn zero_state(&self) -> Vec<S> {
        std::vec![S::zero(); self.length()]
    }
    fn zero_jacobian(&self) -> LateMatrix<S> {
        LateMatrix::new(self.length())
    }

    fn hamiltonian(&self, mu: &Vec<S>) -> S {
        let energy = self.energy(mu);
        match mu.get(self.own()) {
            Some(momentum) => energy + *momentum,
            None => energy,
        }
    }

    fn energy(&self, mu: &Vec<S>) -> S {
        self.kernels.energy(&self.totals(mu))
    }

    fn gradient(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        let (weights, of_time) = self.weights(mu);
        for place in 0..self.count() {
            let slope = self.slope(mu, site(place, self.sizes), &weights);
            let slope = self.with_bonds(slope, mu, place, &weights);
            self.set_site(out, place, slope.as_ref());
        }
        self.set_carried(out, [S::one(), of_time]);
        self.set_input_slopes(mu, out);
    }

    fn hessian(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        self.derivative(mu, out, |family, mu, out| family.gradient(mu, out));
    }

    fn poisson_matrix(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        self.by_sites(out, |site, unit| {
            self.kernels.ad_star(unit, &self.site(mu, site))
        });
        if self.kernels.is_timed() {
            self.set_pair(mu, out);
        }
    }

    #[inline]
    fn vector_field(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        let (weights, of_time) = self.weights(mu);
        let columns = self.columns();
        let mut power = Power::new(1);
        power.add(&[of_time]);
        for line in 0..self.lines() {
            let inner = self.inner::<S>(line);
            self.field_of_line(mu, (line, 0..columns), inner, &weights, out, &mut power);
        }
        self.set_carried(out, [-power.end()[0], S::one()]);
    }

    fn vector_field_by_parts(
        &self,
        mu: &mut Vec<S>,
        out: &mut Vec<S>,
        before: impl FnMut(&mut [S], Range<usize>),
        after: impl FnMut(&mut [S], Range<usize>),
    ) {
        self.field_by_parts(mu, out, before, after);
    }

    fn jacobian(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        self.derivative(mu, out, |family, mu, out| family.vector_field(mu, out));
    }

    fn casimirs(&self, mu: &Vec<S>, out: &mut [S]) {
        let count = S::from_f64(self.count() as f64);
        for index in 0..self.kernels.casimir_count() {
            let [sum, smallest, largest] = self.statistics(mu, index);
            out[3 * index..][..3].copy_from_slice(&[sum / count, smallest, largest]);
        }
    }

    fn casimir_gradient(&self, index: usize, mu: &Vec<S>, out: &mut Vec<S>) {
        out.fill(S::zero());
        let casimir = index / 3;
        let gradient = |site| self.kernels.casimir_gradient(casimir, &self.site(mu, site));
        if !index.is_multiple_of(3) {
            let site = self.extreme(mu, casimir, index % 3 == 2);
            return self.set_site(out, site, gradient(site).as_ref());
        }
        let share = S::one() / S::from_f64(self.count() as f64);
        for site in 0..self.count() {
            let mut gradient = gradient(site);
            for slope in gradient.as_mut() {
                *slope = share * *slope;
            }
            self.set_site(out, site, gradient.as_ref());
        }
    }
}

impl<S, K> LiePoisson<S> for Family<K>
where
    S: Scalar,
    K: Sites<S>,
{
    fn ad(&self, xi: &Vec<S>, eta: &Vec<S>, out: &mut Vec<S>) {
        for site in 0..self.count() {
            let value = self.kernels.ad(&self.site(xi, site), &self.site(eta, site));
            self.set_site(out, site, value.as_ref());
        }
        self.set_carried(out, [S::zero(); 2]);
        if self.kernels.is_timed() {
            let [momentum, time, unit] = self.pair();
            out[unit] = xi[momentum] * eta[time] - xi[time] * eta[momentum];
        }
    }
    fn ad_star(&self, xi: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        for site in 0..self.count() {
            let value = self
                .kernels
                .ad_star(&self.site(xi, site), &self.site(mu, site));
            self.set_site(out, site, value.as_ref());
        }
        if self.kernels.is_timed() {
            let [momentum, time, unit] = self.pair();
            self.set_carried(out, [-xi[time] * mu[unit], xi[momentum] * mu[unit]]);
        }
    }
    fn ad_star_matrix(&self, xi: &Vec<S>, out: &mut LateMatrix<S>) {
        self.by_sites(out, |site, unit| {
            self.kernels.ad_star(&self.site(xi, site), unit)
        });
        if self.kernels.is_timed() {
            self.set_pair_slope(xi, out);
        }
    }
}

impl<S, K> Widen<S> for Family<K>
where
    S: Scalar,
    K: Sites<S>,
{
    type Widened = Family<K::Widened>;
    fn widen(&self) -> Self::Widened {
        Family::new(self.kernels.widen(), self.sizes)
    }
}
