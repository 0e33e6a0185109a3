//! What the kernels of a system give, written out for a judge who knows the declaration.

use super::found::Kernel;
use crate::random::Random;
use lie_runtime::generic;
use lie_runtime::lagrangian::{DiscreteLagrangianPoisson, LagrangianPoisson};
use lie_runtime::matrix::SquareMatrix;
use lie_runtime::poisson::{CayleyPoisson, LiePoisson, Poisson};
use lie_runtime::state::State;
use lie_runtime::structure::{RealizedPoisson, Spectrum};

/// Writes the kernels of one trait at a state.
pub(super) type Kernels<P> = fn(&P, &mut Writer<'_, <P as Poisson<f64>>::State>);

/// Where values go, with the state and what may be an argument beside it.
pub(super) struct Writer<'a, V> {
    pub(super) mu: V,
    pub(super) random: &'a mut Random,
    show: &'a mut dyn FnMut(Kernel),
    gradient: Vec<f64>,
}

fn rows<M: SquareMatrix<f64>>(matrix: &M) -> Vec<f64> {
    let n = matrix.dimension();
    let places = (0..n).flat_map(|row| (0..n).map(move |column| (row, column)));
    places
        .map(|(row, column)| matrix.get(row, column))
        .collect()
}

impl<'a, V: State<f64>> Writer<'a, V> {
    pub(super) fn new<P: Poisson<f64, State = V>>(
        system: &P,
        mu: &V,
        random: &'a mut Random,
        show: &'a mut dyn FnMut(Kernel),
    ) -> Self {
        let mut gradient = system.zero_state();
        system.gradient(mu, &mut gradient);
        Self {
            mu: mu.clone(),
            random,
            show,
            gradient: gradient.as_slice().to_vec(),
        }
    }

    fn write(&mut self, name: &str, arguments: &[&[f64]], values: &[f64]) {
        (self.show)(Kernel {
            name: name.to_owned(),
            arguments: arguments.iter().map(|argument| argument.to_vec()).collect(),
            values: values.to_vec(),
            gradient: self.gradient.clone(),
        });
    }

    /// A vector that looks random, of the size of a state or of a point.
    fn vector<U: State<f64>>(&mut self, mut like: U) -> U {
        for entry in like.as_mut_slice() {
            *entry = self.random.unit();
        }
        like
    }
}

/// Those of [`Poisson`]. Entries that a kernel leaves out show as what was there before.
pub(super) fn poisson<P: Poisson<f64>>(system: &P, writer: &mut Writer<'_, P::State>) {
    let mu = writer.mu.clone();
    let stale = |mut vector: P::State| {
        vector.fill(f64::NAN);
        vector
    };
    let stale_matrix = || {
        let mut matrix = system.zero_jacobian();
        for place in 0..system.dimension() * system.dimension() {
            matrix.set(
                place / system.dimension(),
                place % system.dimension(),
                f64::NAN,
            );
        }
        matrix
    };
    let at = mu.as_slice().to_vec();
    writer.write("hamiltonian", &[&at], &[system.hamiltonian(&mu)]);
    writer.write("energy", &[&at], &[system.energy(&mu)]);
    let mut vector = stale(mu.clone());
    system.gradient(&mu, &mut vector);
    writer.write("gradient", &[&at], vector.as_slice());
    let mut matrix = stale_matrix();
    system.hessian(&mu, &mut matrix);
    writer.write("hessian", &[&at], &rows(&matrix));
    let mut matrix = stale_matrix();
    system.poisson_matrix(&mu, &mut matrix);
    writer.write("poisson_matrix", &[&at], &rows(&matrix));
    let xi = writer.vector(system.zero_state());
    let mut matrix = stale_matrix();
    system.poisson_slope(&mu, &xi, &mut matrix);
    writer.write("poisson_slope", &[&at, xi.as_slice()], &rows(&matrix));
    if system.is_forced() || system.is_damped() {
        let mut vector = stale(mu.clone());
        generic::vector_field(system, &mu, &mut vector);
        writer.write("driven_field", &[&at], vector.as_slice());
    }
    let mut vector = stale(mu.clone());
    system.vector_field(&mu, &mut vector);
    writer.write("vector_field", &[&at], vector.as_slice());
    let mut matrix = stale_matrix();
    system.jacobian(&mu, &mut matrix);
    writer.write("jacobian", &[&at], &rows(&matrix));
    let (mut vector, mut matrix) = (stale(mu.clone()), stale_matrix());
    system.linearize(&mu, &mut vector, &mut matrix);
    let both = [vector.as_slice(), &rows(&matrix)].concat();
    writer.write("linearize", &[&at], &both);
    let mut casimirs = vec![f64::NAN; system.casimir_count()];
    system.casimirs(&mu, &mut casimirs);
    writer.write("casimirs", &[&at], &casimirs);
    let count = system.quantity_count();
    if count > 0 {
        let mut quantities = vec![f64::NAN; count];
        system.quantities(&mu, &mut quantities);
        writer.write("quantities", &[&at], &quantities);
    }
    let count = system.event_count();
    if count > 0 {
        let mut events = vec![f64::NAN; count];
        system.events(&mu, &mut events);
        writer.write("events", &[&at], &events);
    }
    for index in 0..system.casimir_count() {
        let mut vector = stale(mu.clone());
        system.casimir_gradient(index, &mu, &mut vector);
        writer.write(
            &format!("casimir_gradient {index}"),
            &[&at],
            vector.as_slice(),
        );
    }
}

/// Those of [`LiePoisson`].
pub(super) fn algebra<P: LiePoisson<f64>>(system: &P, writer: &mut Writer<'_, P::State>) {
    let [xi, eta] = [(); 2].map(|()| writer.vector(system.zero_state()));
    let mu = writer.mu.clone();
    let mut out = system.zero_state();
    system.ad(&xi, &eta, &mut out);
    writer.write("ad", &[xi.as_slice(), eta.as_slice()], out.as_slice());
    system.ad_star(&xi, &mu, &mut out);
    writer.write("ad_star", &[xi.as_slice(), mu.as_slice()], out.as_slice());
    let mut matrix = system.zero_jacobian();
    system.ad_star_matrix(&xi, &mut matrix);
    writer.write("ad_star_matrix", &[xi.as_slice()], &rows(&matrix));
}

/// That of [`CayleyPoisson`], and whether the eigenvalues of its matrices are said to be imaginary.
pub(super) fn cayley<P: CayleyPoisson<f64>>(system: &P, writer: &mut Writer<'_, P::State>) {
    let [x, z] = [(); 2].map(|()| writer.vector(system.zero_state()));
    let mu = writer.mu.clone();
    let mut out = system.zero_state();
    system.triple(&x, &z, &mu, &mut out);
    let arguments = [x.as_slice(), z.as_slice(), mu.as_slice()];
    writer.write("triple", &arguments, out.as_slice());
    let imaginary = matches!(system.spectrum(), Spectrum::Imaginary);
    writer.write(
        "imaginary",
        &[x.as_slice()],
        &[f64::from(u8::from(imaginary))],
    );
}

/// Those of [`LagrangianPoisson`], at the velocity of the state.
pub(super) fn lagrangian<P: LagrangianPoisson<f64>>(system: &P, writer: &mut Writer<'_, P::State>) {
    let mut xi = system.zero_state();
    system.gradient(&writer.mu, &mut xi);
    let (mut momentum, mut inertia) = (system.zero_state(), system.zero_jacobian());
    system.momentum(&xi, &mut momentum);
    system.inertia(&xi, &mut inertia);
    let at = xi.as_slice();
    writer.write("lagrangian", &[at], &[system.lagrangian(&xi)]);
    writer.write("momentum", &[at], momentum.as_slice());
    writer.write("inertia", &[at], &rows(&inertia));
}

/// Those of [`DiscreteLagrangianPoisson`], at the coordinates of a step.
pub(super) fn discrete<P: DiscreteLagrangianPoisson<f64>>(
    system: &P,
    writer: &mut Writer<'_, P::State>,
) {
    let h = 0.125;
    let mut x = system.zero_state();
    system.gradient(&writer.mu, &mut x);
    for entry in x.as_mut_slice() {
        *entry *= h;
    }
    let (mut slope, mut curvature) = (system.zero_state(), system.zero_jacobian());
    let value = system.discrete_lagrangian(h, &x);
    system.discrete_slope(h, &x, &mut slope);
    system.discrete_curvature(h, &x, &mut curvature);
    let at = [&[h][..], x.as_slice()];
    writer.write("discrete_lagrangian", &at, &[value]);
    writer.write("discrete_slope", &at, slope.as_slice());
    writer.write("discrete_curvature", &at, &rows(&curvature));
}

/// Those of [`RealizedPoisson`], near the point from which lifts begin.
pub(super) fn realization<P: RealizedPoisson<f64>>(system: &P, writer: &mut Writer<'_, P::State>) {
    let mut z = system.zero_point();
    system.start(&mut z);
    let noise = writer.vector(system.zero_point());
    z.axpy(0.1, &noise);
    let xi = writer.vector(system.zero_state());
    let v = writer.vector(system.zero_point());
    let at = z.as_slice();
    let (mut over, mut along) = (system.zero_state(), system.zero_state());
    system.momentum_map(&z, &mut over);
    writer.write("momentum_map", &[at], over.as_slice());
    let mut back = system.zero_point();
    system.pullback(&z, &xi, &mut back);
    writer.write("pullback", &[at, xi.as_slice()], back.as_slice());
    system.pushforward(&z, &v, &mut along);
    writer.write("pushforward", &[at, v.as_slice()], along.as_slice());
    let mut curvature = system.zero_point_matrix();
    system.curvature(&z, &xi, &mut curvature);
    writer.write("curvature", &[at, xi.as_slice()], &rows(&curvature));
}
