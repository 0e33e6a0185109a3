//! Lattices of three dimensions: against equations that are written by hand, and against lattices of two dimensions where one axis has
//! one site.

use crate::sites;

use lie_runtime::family::{Family, Pieces, unit_spheres};
use lie_runtime::methods::Method;
use lie_runtime::prelude::*;
use lie_runtime::{FoundPoisson, PieceFlows};
use sites::{end, largest_difference};

lie_poisson! { pub spec = "../../tests/data/families/cubic_lattice.json"; }

lie_poisson! {
    /// Spins with bonds along diagonals, open along layers and rows, and a force and friction at each.
    pub system Slanted;
    algebra = so(3)^(L, N, M);
    state x[i, j, k], y[i, j, k], z[i, j, k];
    parameters { L = 4; N = 3; M = 5; a = 1/10; }
    hamiltonian = sum(i in 0..L-1, j in 1..N, k in 0..M: x[i, j, k]*y[i+1, j-1, k+2])
        - sum(i in 0..L, j in 0..N, k in 0..M: z[i, j, k]^2/2 + z[i, j, k]);
    forces { x[i, j, k] = -a*(x[i, j, k] - x[i+1, j-1, k]); }
    initial = random(unit-sphere, 2);
}

lie_poisson! {
    /// Bonds along the last two axes of three, with what may act on a site.
    pub system Layers;
    algebra = so(3)^(L, N, M);
    state x[i, j, k], y[i, j, k], z[i, j, k];
    parameters { L = 1; N = 3; M = 5; a = 1/10; B = [[[1, 2, 3, 4, 5], [1, 1/2, 1/3, 1/4, 1/5], [-1, 0, 1, 0, -1]]]; }
    inputs { u = 1/3; }
    hamiltonian = -sum(i in 0..L, j in 0..N, k in 0..M: x[i, j, k]*x[i, j+1, k] + y[i, j, k]*y[i, j+1, k]
        + z[i, j, k]*z[i, j+1, k] + u*B[i, j, k]*x[i, j, k]) + sum(i in 0..L, j in 0..N, k in 0..M-1: z[i, j, k]*z[i, j, k+1]);
    forces { z[i, j, k] = a/2 - a*z[i, j, k]; }
    noise { hamiltonian = x[i, j, k]/4; }
    initial = random(unit-sphere, 3);
}

lie_poisson! {
    /// The same on a square lattice.
    pub system Square;
    algebra = so(3)^(N, M);
    state x[j, k], y[j, k], z[j, k];
    parameters { N = 3; M = 5; a = 1/10; B = [[1, 2, 3, 4, 5], [1, 1/2, 1/3, 1/4, 1/5], [-1, 0, 1, 0, -1]]; }
    inputs { u = 1/3; }
    hamiltonian = -sum(j in 0..N, k in 0..M: x[j, k]*x[j+1, k] + y[j, k]*y[j+1, k]
        + z[j, k]*z[j+1, k] + u*B[j, k]*x[j, k]) + sum(j in 0..N, k in 0..M-1: z[j, k]*z[j, k+1]);
    forces { z[j, k] = a/2 - a*z[j, k]; }
    noise { hamiltonian = x[j, k]/4; }
    initial = random(unit-sphere, 3);
}

lie_poisson! {
    /// The same bonds along the first and the last axis.
    pub system Planks;
    algebra = so(3)^(L, N, M);
    state x[i, j, k], y[i, j, k], z[i, j, k];
    parameters { L = 3; N = 1; M = 5; a = 1/10; B = [[[1, 2, 3, 4, 5]], [[1, 1/2, 1/3, 1/4, 1/5]], [[-1, 0, 1, 0, -1]]]; }
    inputs { u = 1/3; }
    hamiltonian = -sum(i in 0..L, j in 0..N, k in 0..M: x[i, j, k]*x[i+1, j, k] + y[i, j, k]*y[i+1, j, k]
        + z[i, j, k]*z[i+1, j, k] + u*B[i, j, k]*x[i, j, k]) + sum(i in 0..L, j in 0..N, k in 0..M-1: z[i, j, k]*z[i, j, k+1]);
    forces { z[i, j, k] = a/2 - a*z[i, j, k]; }
    noise { hamiltonian = x[i, j, k]/4; }
    initial = random(unit-sphere, 3);
}

/// 3 x 2 x 4 sites: the number of that in a layer, a row and a column, which count modulo the sizes.
fn at(i: usize, j: usize, k: usize) -> usize {
    (i % 3) * 8 + (j % 2) * 4 + k
}

fn spin(mu: &[f64], site: usize) -> [f64; 3] {
    [mu[site], mu[24 + site], mu[48 + site]]
}

fn dot([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> f64 {
    a * x + b * y + c * z
}

/// H of `cubic_lattice.json`, bond by bond.
fn energy_by_hand(lattice: &CubicLattice, mu: &[f64]) -> f64 {
    let mut h = 0.0;
    for (i, j, k) in all() {
        let one = spin(mu, at(i, j, k));
        h -= lattice.K * dot(one, spin(mu, at(i + 1, j, k)));
        h -= 2.0 * one[2] * spin(mu, at(i, j + 1, k))[2] + lattice.B[at(i, j, k)] * one[0];
        if k < 3 {
            // couplings of bonds have a place for the last column, which no sum asks for
            h -= lattice.J[at(i, j, k)] * dot(one, spin(mu, at(i, j, k + 1)));
        }
    }
    h
}

/// `s' = dH/ds x s` there, neighbour by neighbour.
fn field_by_hand(lattice: &CubicLattice, mu: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; 72];
    for (i, j, k) in all() {
        let site = at(i, j, k);
        let mut xi = [-lattice.B[site], 0.0, 0.0];
        let mut add = |factor: f64, [x, y, z]: [f64; 3]| {
            xi = [xi[0] - factor * x, xi[1] - factor * y, xi[2] - factor * z];
        };
        add(lattice.K, spin(mu, at(i + 1, j, k)));
        add(lattice.K, spin(mu, at(i + 2, j, k)));
        // both neighbours along rows are the same site
        add(4.0, [0.0, 0.0, spin(mu, at(i, j + 1, k))[2]]);
        if k > 0 {
            add(lattice.J[at(i, j, k - 1)], spin(mu, at(i, j, k - 1)));
        }
        if k < 3 {
            add(lattice.J[site], spin(mu, at(i, j, k + 1)));
        }
        let s = spin(mu, site);
        // so(3) as in the runtime: mu' = mu x dH/dmu
        out[site] = s[1] * xi[2] - s[2] * xi[1];
        out[24 + site] = s[2] * xi[0] - s[0] * xi[2];
        out[48 + site] = s[0] * xi[1] - s[1] * xi[0];
    }
    out
}

fn all() -> impl Iterator<Item = (usize, usize, usize)> {
    let columns = |i, j| (0..4).map(move |k| (i, j, k));
    let rows = move |i| (0..2).flat_map(move |j| columns(i, j));
    (0..3).flat_map(rows)
}

/// Steps of the classical method of Runge and Kutta, written out.
fn rk4_by_hand(lattice: &CubicLattice, mu: &[f64], h: f64, steps: usize) -> Vec<f64> {
    let moved = |mu: &[f64], t: f64, slope: &[f64]| -> Vec<f64> {
        mu.iter().zip(slope).map(|(x, v)| x + t * v).collect()
    };
    let mut mu = mu.to_vec();
    for _ in 0..steps {
        let a = field_by_hand(lattice, &mu);
        let b = field_by_hand(lattice, &moved(&mu, h / 2.0, &a));
        let c = field_by_hand(lattice, &moved(&mu, h / 2.0, &b));
        let d = field_by_hand(lattice, &moved(&mu, h, &c));
        for (k, x) in mu.iter_mut().enumerate() {
            *x += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
        }
    }
    mu
}

#[test]
fn energy_and_field_are_those_written_by_hand() {
    let lattice = CubicLattice::new();
    let system = lattice.system().expect("sizes");
    assert_eq!((system.sizes(), system.count()), ([3, 2, 4], 24));
    let name = |place: usize| Poisson::<f64>::coordinate(&system, place).to_owned();
    assert_eq!(
        (name(0), name(24 + 13)),
        ("x[0][0][0]".into(), "y[1][1][1]".into())
    );
    for seed in 0..10 {
        let mu: Vec<f64> = unit_spheres(24, 3, seed);
        let (h, expected) = (system.hamiltonian(&mu), energy_by_hand(&lattice, &mu));
        assert!((h - expected).abs() < 1e-13, "{h} {expected}");
        let (mut field, mut gradient, mut by_bracket) = (mu.clone(), mu.clone(), mu.clone());
        system.vector_field(&mu, &mut field);
        let expected = field_by_hand(&lattice, &mu);
        let difference = largest_difference(&field, &expected);
        assert!(difference < 1e-14, "{difference:e}");
        system.gradient(&mu, &mut gradient);
        system.ad_star(&gradient, &mu, &mut by_bracket);
        assert!(largest_difference(&by_bracket, &expected) < 1e-14);
        let mut m = [0.0];
        system.quantities(&mu, &mut m);
        assert!((m[0] - mu[48..].iter().sum::<f64>() / 24.0).abs() < 1e-15);
        // the control: a field that is periodic along columns
        let mut other = lattice.clone();
        other.J = vec![0.1; 24];
        assert!(largest_difference(&field, &field_by_hand(&other, &mu)) > 0.1);
    }
}

#[test]
fn runs_are_those_of_the_equations_written_by_hand() {
    let lattice = CubicLattice::new();
    let system = lattice.system().expect("sizes");
    let mu = lattice.initial_state().expect("a seed");
    let by_hand = rk4_by_hand(&lattice, &mu, 0.05, 20);
    let difference = largest_difference(&end(&system, Rk4, &mu, 0.05, 20), &by_hand);
    assert!(difference < 2e-14, "{difference:e}");
    let exact = rk4_by_hand(&lattice, &mu, 1.0 / 4096.0, 4096);
    let error = |end: Vec<f64>| largest_difference(&end, &exact);
    for (method, found) in [
        ("gauss8", error(end(&system, Gauss8, &mu, 0.025, 40))),
        ("gauss16", error(end(&system, Gauss16, &mu, 0.05, 20))),
        (
            "splitting8",
            error(end(&system, Splitting8::new(), &mu, 0.02, 50)),
        ),
    ] {
        assert!(found < 1e-11, "{method}: {found:e}");
    }
    let second =
        [20, 40].map(|n| error(end(&system, Splitting2::new(), &mu, 1.0 / f64::from(n), n)));
    let fourth =
        [8, 16].map(|n| error(end(&system, Splitting4::new(), &mu, 1.0 / f64::from(n), n)));
    let sixth = [6, 12].map(|n| error(end(&system, Splitting6::new(), &mu, 1.0 / f64::from(n), n)));
    for (errors, order) in [(second, 2.0), (fourth, 4.0), (sixth, 6.0)] {
        let found = (errors[0] / errors[1]).log2();
        assert!((found - order).abs() < 0.8, "{found} {order} {errors:?}");
    }
}

/// Sites of a piece do not touch: what they do together is what they do one after the other, and each keeps its length.
fn splits<K: Pieces<f64>>(system: &Family<K>, pieces: usize) {
    assert_eq!(FoundPoisson::<f64>::found(system).pieces(), pieces);
    let count = system.count();
    let mu: Vec<f64> = unit_spheres(count, 3, 11);
    let far = end(system, Splitting2::new(), &mu, 0.3, 100);
    for site in 0..count {
        let square: f64 = (0..3).map(|k| far[k * count + site].powi(2)).sum();
        assert!((square - 1.0).abs() < 1e-13, "{site} {square}");
    }
    let back = end(system, Splitting4::new(), &far, 0.3, 5);
    let back = end(system, Splitting4::new(), &back, -0.3, 5);
    assert!(largest_difference(&back, &far) < 1e-12);
    assert!(largest_difference(&mu, &far) > 0.1);
}

#[test]
fn bonds_along_each_axis_have_its_colours() {
    let cube = |l: usize, n: usize, m: usize| {
        let (bonds, sites) = (l * n * m, (0..l * n * m).map(|k| (k as f64).sin()));
        CubicLattice {
            L: l as f64,
            N: n as f64,
            M: m as f64,
            J: (0..bonds).map(|k| (0.7 * k as f64).cos()).collect(),
            B: sites.collect(),
            ..CubicLattice::new()
        }
    };
    // two of the exchange along columns, which are open; two or three along layers and rows; the field
    for (l, n, m, pieces) in [(3, 2, 4, 8), (4, 4, 3, 7), (5, 3, 2, 9), (4, 5, 70, 8)] {
        splits(&cube(l, n, m).system().expect("sizes"), pieces);
    }
}

#[test]
fn a_force_and_slanted_bonds_are_those_written_by_hand() {
    for (l, n, m) in [(4_usize, 3_usize, 5_usize), (2, 2, 3), (3, 4, 130)] {
        let slanted = Slanted {
            L: l as f64,
            N: n as f64,
            M: m as f64,
            ..Slanted::new()
        };
        let system = slanted.system().expect("sizes");
        let count = l * n * m;
        let at = |i: usize, j: usize, k: usize| (i % l * n + j % n) * m + k % m;
        let mut state = slanted.initial_state().expect("a seed");
        let mut slope = vec![0.0; 3 * count];
        let mut h = 0.0;
        for (i, j) in (0..l).flat_map(|i| (0..n).map(move |j| (i, j))) {
            for k in 0..m {
                let (x, z) = (at(i, j, k), 2 * count + at(i, j, k));
                h -= state[z].powi(2) / 2.0 + state[z];
                slope[z] -= state[z] + 1.0;
                if i + 1 < l && j > 0 {
                    let y = count + at(i + 1, j - 1, k + 2);
                    h += state[x] * state[y];
                    slope[x] += state[y];
                    slope[y] += state[x];
                }
            }
        }
        let energy = system.energy(&state);
        assert!((energy - h).abs() < 1e-12, "{energy} {h}");
        let mut field = state.clone();
        system.vector_field(&state, &mut field);
        let mut power = 0.0;
        for (i, j) in (0..l).flat_map(|i| (0..n).map(move |j| (i, j))) {
            for k in 0..m {
                let site = at(i, j, k);
                // indices of forces count modulo the sizes
                let force = -0.1 * (state[site] - state[at(i + 1, j + n - 1, k)]);
                power += force * slope[site];
                let s: [f64; 3] = [0, 1, 2].map(|c| state[c * count + site]);
                let xi: [f64; 3] = [0, 1, 2].map(|c| slope[c * count + site]);
                let expected = [
                    s[1] * xi[2] - s[2] * xi[1] + force,
                    s[2] * xi[0] - s[0] * xi[2],
                    s[0] * xi[1] - s[1] * xi[0],
                ];
                for (c, expected) in expected.into_iter().enumerate() {
                    let found = field[c * count + site];
                    assert!(
                        (found - expected).abs() < 1e-14,
                        "{i} {j} {k}: {found} {expected}"
                    );
                }
            }
        }
        let found = -field[3 * count];
        assert!(
            (found - power).abs() < 1e-12 && power.abs() > 1e-3,
            "{found} {power}"
        );
        // the control: H depends on each site
        state[2 * count] = 2.0;
        assert_ne!(system.energy(&state), energy);
    }
}

/// A step of each method, and the energy.
fn all_steps<K: Pieces<f64>>(system: &Family<K>, start: &[f64]) -> Vec<Vec<f64>> {
    fn step<K: Pieces<f64>, M: Method<f64, Family<K>>>(
        system: &Family<K>,
        method: M,
        start: &[f64],
    ) -> Vec<f64> {
        end(system, method, start, 0.05, 7)
    }
    let start = start.to_vec();
    vec![
        vec![system.hamiltonian(&start)],
        step(system, Rk4, &start),
        step(system, Gauss8, &start),
        step(system, Gauss16, &start),
        step(system, Splitting2::new(), &start),
        step(system, Splitting6::new(), &start),
    ]
}

#[test]
fn one_layer_and_one_row_are_a_square_lattice_to_the_bit() {
    let square = Square::new();
    let start = square.initial_state().expect("a seed");
    let noise = |mut state: Vec<f64>| {
        let behind = state.iter_mut().skip(49).zip(0_u8..);
        behind.for_each(|(rate, k)| *rate = (1.3 * f64::from(k)).sin());
        state
    };
    assert_eq!(Layers::new().initial_state().expect("a seed"), start);
    assert_eq!(Planks::new().initial_state().expect("a seed"), start);
    let start = noise(start);
    let flat = all_steps(&square.system().expect("sizes"), &start);
    let layer = all_steps(&Layers::new().system().expect("sizes"), &start);
    let planks = all_steps(&Planks::new().system().expect("sizes"), &start);
    for ((flat, layer), planks) in flat.iter().zip(&layer).zip(&planks) {
        let bits = |all: &[f64]| all.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(flat), bits(layer));
        assert_eq!(bits(flat), bits(planks));
    }
    assert!(largest_difference(&flat[1], &start) > 0.1);
}

#[test]
fn values_are_those_of_as_many_sites() {
    let wrong = CubicLattice {
        L: 4.0,
        ..CubicLattice::new()
    };
    let error = wrong.system().expect_err("values of three layers");
    assert!(["J", "B"].contains(&error.name), "{error}");
    let none = CubicLattice {
        N: 1.5,
        ..CubicLattice::new()
    };
    assert_eq!(none.sizes().expect_err("no size").name, "N");
    assert_eq!(CubicLattice::new().sizes().expect("sizes"), [3, 2, 4]);
}
