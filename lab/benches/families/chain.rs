//! The limit that families are compared with: a ring of classical spins, `H = -sum_i s_i . s_(i+1)`, written by hand for the
//! traits of lie-poisson with its loops: the field, and the exact flows of the bonds that begin at even and at odd places.
//!
//! The number of spins is even. A state holds the first components of the spins at even places, of those at odd places,
//! then the second and the third components alike.

use lie_runtime::{FoundPoisson, LiePoisson, PieceFlows, Poisson, Scalar, SquareMatrix, Widen};
use std::marker::PhantomData;

/// The chain.
#[derive(Clone, Debug)]
pub struct Chain<S> {
    spins: usize,
    scalar: PhantomData<S>,
}

impl<S> Chain<S> {
    pub fn new(spins: usize) -> Self {
        assert!(
            spins.is_multiple_of(2) && spins >= 4,
            "an even number of spins"
        );
        Self {
            spins,
            scalar: PhantomData,
        }
    }
}

/// The place in a state of a component of a spin.
fn place(spins: usize, spin: usize, component: usize) -> usize {
    component * spins + spin % 2 * (spins / 2) + spin / 2
}

/// Spin after spin, as a state.
pub fn state(spins: &[f64]) -> Vec<f64> {
    let count = spins.len() / 3;
    let mut state = vec![0.0; spins.len()];
    for (index, &value) in spins.iter().enumerate() {
        state[place(count, index / 3, index % 3)] = value;
    }
    state
}

/// Components of the spins at even and at odd places.
fn halves<S>(state: &[S]) -> [&[S]; 6] {
    let mut parts = state.chunks_exact(state.len() / 6);
    std::array::from_fn(|_| parts.next().expect("six parts"))
}

/// The same, to be written.
fn halves_mut<S>(state: &mut [S]) -> [&mut [S]; 6] {
    let mut parts = state.chunks_exact_mut(state.len() / 6);
    std::array::from_fn(|_| parts.next().expect("six parts"))
}

/// `out_i = n_i x s_i`, n the sum of two neighbours.
#[inline(always)]
fn turn<S: Scalar>(spins: [&[S]; 3], one: [&[S]; 3], other: [&[S]; 3], out: [&mut [S]; 3]) {
    let count = spins[0].len();
    let [x, y, z] = spins.map(|s| &s[..count]);
    let [ax, ay, az] = one.map(|s| &s[..count]);
    let [bx, by, bz] = other.map(|s| &s[..count]);
    let [ox, oy, oz] = out.map(|s| &mut s[..count]);
    for i in 0..count {
        let n = [ax[i] + bx[i], ay[i] + by[i], az[i] + bz[i]];
        ox[i] = n[1] * z[i] - n[2] * y[i];
        oy[i] = n[2] * x[i] - n[0] * z[i];
        oz[i] = n[0] * y[i] - n[1] * x[i];
    }
}

/// The right-hand side.
#[inline(always)]
pub fn field<S: Scalar>(state: &[S], out: &mut [S]) {
    let [xe, xo, ye, yo, ze, zo] = halves(state);
    let [oxe, oxo, oye, oyo, oze, ozo] = halves_mut(out);
    let last = xe.len() - 1;
    let (even, odd) = ([xe, ye, ze], [xo, yo, zo]);
    let [ex, ey, ez] = [oxe, oye, oze];
    // an even spin stands between the odd ones before and behind it
    let ends = [&mut ex[..1], &mut ey[..1], &mut ez[..1]];
    turn(
        even.map(|s| &s[..1]),
        odd.map(|s| &s[..1]),
        odd.map(|s| &s[last..]),
        ends,
    );
    let inner = [&mut ex[1..], &mut ey[1..], &mut ez[1..]];
    turn(even.map(|s| &s[1..]), odd.map(|s| &s[1..]), odd, inner);
    let [ox, oy, oz] = [oxo, oyo, ozo];
    let inner = [&mut ox[..last], &mut oy[..last], &mut oz[..last]];
    turn(odd.map(|s| &s[..last]), even.map(|s| &s[1..]), even, inner);
    let ends = [&mut ox[last..], &mut oy[last..], &mut oz[last..]];
    turn(
        odd.map(|s| &s[last..]),
        even.map(|s| &s[last..]),
        even.map(|s| &s[..1]),
        ends,
    );
}

/// `out_i = sign (n_i)`, the sum of the neighbours of each spin.
fn neighbours<S: Scalar>(state: &[S], sign: S, out: &mut [S]) {
    let spins = state.len() / 3;
    for component in 0..3 {
        for spin in 0..spins {
            let value = |spin: usize| state[place(spins, spin % spins, component)];
            out[place(spins, spin, component)] = sign * (value(spin + spins - 1) + value(spin + 1));
        }
    }
}

/// `out_i = sign u_i x v_i`.
fn cross<S: Scalar>(u: &[S], v: &[S], sign: S, out: &mut [S]) {
    let n = u.len() / 3;
    for i in 0..n {
        let ([a, b, c], [x, y, z]) = (
            [u[i], u[n + i], u[2 * n + i]],
            [v[i], v[n + i], v[2 * n + i]],
        );
        out[i] = sign * (b * z - c * y);
        out[n + i] = sign * (c * x - a * z);
        out[2 * n + i] = sign * (a * y - b * x);
    }
}

/// No method that is measured here asks for a matrix.
#[derive(Clone, Debug)]
pub struct NoMatrix;

impl<S: Scalar> SquareMatrix<S> for NoMatrix {
    fn dimension(&self) -> usize {
        0
    }
    fn get(&self, _row: usize, _column: usize) -> S {
        unreachable!("no method here has a matrix")
    }
    fn set(&mut self, _row: usize, _column: usize, _value: S) {
        unreachable!("no method here has a matrix")
    }
}

impl<S: Scalar> Poisson<S> for Chain<S> {
    type State = Vec<S>;
    type Jacobian = NoMatrix;

    fn dimension(&self) -> usize {
        3 * self.spins
    }
    fn name(&self) -> &str {
        "chain"
    }
    fn coordinate(&self, _index: usize) -> &str {
        ""
    }
    fn casimir_count(&self) -> usize {
        self.spins
    }
    fn hamiltonian_degree(&self) -> Option<u32> {
        Some(2)
    }
    fn zero_state(&self) -> Vec<S> {
        vec![S::zero(); self.dimension()]
    }
    fn zero_jacobian(&self) -> NoMatrix {
        NoMatrix
    }
    fn hamiltonian(&self, mu: &Vec<S>) -> S {
        let mut gradient = self.zero_state();
        self.gradient(mu, &mut gradient);
        let twice = mu
            .iter()
            .zip(&gradient)
            .fold(S::zero(), |sum, (&s, &g)| sum + s * g);
        S::ratio(1.0, 2.0) * twice
    }
    fn gradient(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        neighbours(mu, -S::one(), out);
    }
    fn hessian(&self, _mu: &Vec<S>, _out: &mut NoMatrix) {}
    fn poisson_matrix(&self, _mu: &Vec<S>, _out: &mut NoMatrix) {}
    #[inline(always)]
    fn vector_field(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        field(mu, out);
    }
    fn jacobian(&self, _mu: &Vec<S>, _out: &mut NoMatrix) {}
    fn casimirs(&self, mu: &Vec<S>, out: &mut [S]) {
        for (i, square) in out.iter_mut().enumerate() {
            let [x, y, z] = [mu[i], mu[self.spins + i], mu[2 * self.spins + i]];
            *square = (x * x + y * y) + z * z;
        }
    }
    fn casimir_gradient(&self, index: usize, mu: &Vec<S>, out: &mut Vec<S>) {
        out.fill(S::zero());
        for k in 0..3 {
            let place = k * self.spins + index;
            out[place] = mu[place] + mu[place];
        }
    }
}

impl<S: Scalar> Widen<S> for Chain<S> {
    type Widened = Chain<S::Wide>;
    fn widen(&self) -> Chain<S::Wide> {
        Chain::new(self.spins)
    }
}

impl<S: Scalar> LiePoisson<S> for Chain<S> {
    fn ad(&self, xi: &Vec<S>, eta: &Vec<S>, out: &mut Vec<S>) {
        cross(xi, eta, S::one(), out);
    }
    fn ad_star(&self, xi: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        cross(mu, xi, S::one(), out);
    }
    fn ad_star_matrix(&self, _xi: &Vec<S>, _out: &mut NoMatrix) {}
}

/// The flows of the bonds that begin at even places, and of those that begin at odd ones.
pub struct Bonds;

impl FoundPoisson<f64> for Chain<f64> {
    type Found<'a> = Bonds;
    fn found(&self) -> Bonds {
        Bonds
    }
}

/// `out_i`, the six components of the spins of bonds.
type Pairs<'a> = [&'a mut [f64]; 6];

/// The exact flow of bonds over a time t: both spins of a bond turn about their sum S, by the angle `|S| t`. In the square
/// x of that the functions sine and one minus cosine are series; `TERMS` of them are taken.
fn turn_bonds<const TERMS: usize>(t: f64, [x1, y1, z1, x2, y2, z2]: Pairs<'_>) {
    // (-1)^k t / (2k + 1)! and (-1)^k t^2 / (2k + 2)!
    let (mut sines, mut cosines) = ([t; TERMS], [0.5 * t * t; TERMS]);
    for k in 1..TERMS {
        let n = 2.0 * k as f64;
        sines[k] = -sines[k - 1] / (n * (n + 1.0));
        cosines[k] = -cosines[k - 1] / ((n + 1.0) * (n + 2.0));
    }
    let count = x1.len();
    let [x1, y1, z1, x2, y2, z2] = [x1, y1, z1, x2, y2, z2].map(|s| &mut s[..count]);
    for i in 0..count {
        let (a, b) = ([x1[i], y1[i], z1[i]], [x2[i], y2[i], z2[i]]);
        let s = [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        // S x s1 = s2 x s1
        let w = [
            b[1] * a[2] - b[2] * a[1],
            b[2] * a[0] - b[0] * a[2],
            b[0] * a[1] - b[1] * a[0],
        ];
        let v = [
            s[1] * w[2] - s[2] * w[1],
            s[2] * w[0] - s[0] * w[2],
            s[0] * w[1] - s[1] * w[0],
        ];
        let x = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) * (t * t);
        let (mut sine, mut cosine) = (sines[TERMS - 1], cosines[TERMS - 1]);
        for k in (0..TERMS - 1).rev() {
            sine = sine * x + sines[k];
            cosine = cosine * x + cosines[k];
        }
        let d = [
            sine * w[0] + cosine * v[0],
            sine * w[1] + cosine * v[1],
            sine * w[2] + cosine * v[2],
        ];
        (x1[i], y1[i], z1[i]) = (a[0] + d[0], a[1] + d[1], a[2] + d[2]);
        (x2[i], y2[i], z2[i]) = (b[0] - d[0], b[1] - d[1], b[2] - d[2]);
    }
}

/// The same with as many terms as unit spins need for round-off.
fn bonds(t: f64, pairs: Pairs<'_>) {
    match 4.0 * t * t {
        x if x < 3e-4 => turn_bonds::<4>(t, pairs),
        x if x < 2e-2 => turn_bonds::<6>(t, pairs),
        x if x < 0.4 => turn_bonds::<8>(t, pairs),
        x if x < 4.0 => turn_bonds::<11>(t, pairs),
        _ => turn_bonds::<20>(t, pairs),
    }
}

impl PieceFlows<f64> for Bonds {
    type State = Vec<f64>;

    fn pieces(&self) -> usize {
        2
    }
    fn direction(&self, _piece: usize, _t: f64, _mu: &Vec<f64>, _xi: &mut Vec<f64>) {
        unreachable!("nobody follows the group here")
    }
    fn flow(&mut self, piece: usize, t: f64, mu: &mut Vec<f64>) {
        let [xe, xo, ye, yo, ze, zo] = halves_mut(mu);
        if piece == 0 {
            return bonds(t, [xe, ye, ze, xo, yo, zo]);
        }
        // each odd spin with the even one behind it, the last one with the first
        let last = xe.len() - 1;
        bonds(
            t,
            [
                &mut xo[..last],
                &mut yo[..last],
                &mut zo[..last],
                &mut xe[1..],
                &mut ye[1..],
                &mut ze[1..],
            ],
        );
        bonds(
            t,
            [
                &mut xo[last..],
                &mut yo[last..],
                &mut zo[last..],
                &mut xe[..1],
                &mut ye[..1],
                &mut ze[..1],
            ],
        );
    }
}
