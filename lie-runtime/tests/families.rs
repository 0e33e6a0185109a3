//! Families: their kernels and loops against a direct sum that is written out, and against H differentiated by dual
//! numbers, which shares nothing with them.

use crate::sites;

use lie_runtime::driver::Save;
use lie_runtime::family::{Family, Sites, unit_spheres};
use lie_runtime::methods::Method;
use lie_runtime::prelude::*;
use sites::{by_component, end, largest_difference};

lie_poisson! { pub spec = "../../tests/data/families/heisenberg_chain.json"; }
lie_poisson! { pub spec = "../../tests/data/families/open_chain.json"; }
lie_poisson! { pub spec = "../../tests/data/families/mean_field.json"; }
lie_poisson! { pub spec = "../../tests/data/families/lattice.json"; }
lie_poisson! { pub spec = "../../tests/data/families/su3_ring.json"; }
lie_poisson! { pub spec = "../../tests/data/families/mean_field_pieces.json"; }
lie_poisson! { pub spec = "../../tests/data/families/disordered_chain.json"; }
lie_poisson! { pub spec = "../../tests/data/families/disordered_lattice.json"; }

lie_poisson! {
    /// Classical spins on a ring, without a spec.
    pub system Ring;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 1000; J = 1; }
    hamiltonian = -J*sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1]);
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// Four spins on a ring, written out.
    pub system Four;
    algebra = so(3)^4;
    state x0, y0, z0, x1, y1, z1, x2, y2, z2, x3, y3, z3;
    parameters { J = 1; }
    hamiltonian = -J*((x0*x1 + y0*y1 + z0*z1) + (x1*x2 + y1*y2 + z1*z2)
        + (x2*x3 + y2*y3 + z2*z3) + (x3*x0 + y3*y0 + z3*z0));
    methods = [rk4];
}

#[test]
fn four_sites_move_as_the_direct_sum_that_is_written_out() {
    let family = HeisenbergChain { N: 4.0, J: 0.75 }.system().expect("sizes");
    let four = Four { J: 0.75 }.system().expect("constants");
    for seed in 0..20 {
        let sites = by_component(&unit_spheres::<f64>(4, 3, seed), 4);
        let mut written = four.zero_state();
        written.as_mut_slice().copy_from_slice(&sites);
        let mu = by_component(&sites, 3);
        let (h, expected) = (family.hamiltonian(&mu), four.hamiltonian(&written));
        assert!((h - expected).abs() < 2e-15, "{h} {expected}");
        let (mut field, mut slope) = (mu.clone(), mu.clone());
        let (mut of_four, mut slope_of_four) = (four.zero_state(), four.zero_state());
        family.vector_field(&mu, &mut field);
        four.vector_field(&written, &mut of_four);
        family.gradient(&mu, &mut slope);
        four.gradient(&written, &mut slope_of_four);
        let expected = by_component(of_four.as_slice(), 3);
        assert!(largest_difference(&field, &expected) < 1e-15);
        let expected = by_component(slope_of_four.as_slice(), 3);
        assert!(largest_difference(&slope, &expected) < 1e-15);
    }
    // a fifth site is another system
    let five = HeisenbergChain { N: 5.0, J: 0.75 }.system().expect("sizes");
    assert_eq!((family.dimension(), five.dimension()), (12, 15));
}

type D = Dual<f64>;

fn d(value: f64) -> D {
    D::constant_of(value)
}

/// A family of spins against its H as a function of the coordinates of its sites, `at(k, site)`.
fn compare<K>(family: &Family<K>, energy: impl Fn(&dyn Fn(usize, isize, isize) -> D) -> D)
where
    K: Sites<f64>,
{
    let [_, rows, columns] = family.sizes();
    let count = rows * columns;
    let mu: Vec<f64> = unit_spheres(count, 3, 17);
    let value = |moved: usize| {
        let at = |k: usize, row: isize, column: isize| {
            let row = row.rem_euclid(rows as isize) as usize;
            let column = column.rem_euclid(columns as isize) as usize;
            let place = k * count + row * columns + column;
            if place == moved {
                D::variable(mu[place])
            } else {
                d(mu[place])
            }
        };
        energy(&at)
    };
    let h = family.hamiltonian(&mu);
    let expected = value(0).value;
    assert!(
        (h - expected).abs() < 1e-13 * count as f64,
        "{h} {expected}"
    );
    let slopes: Vec<f64> = (0..3 * count)
        .map(|place| value(place).derivative)
        .collect();
    let (mut gradient, mut field) = (mu.clone(), mu.clone());
    family.gradient(&mu, &mut gradient);
    assert!(largest_difference(&gradient, &slopes) < 1e-14, "gradient");
    family.vector_field(&mu, &mut field);
    let expected: Vec<f64> = (0..3 * count)
        .map(|place| {
            let (k, site) = (place / count, place % count);
            let (a, b) = ((k + 1) % 3 * count + site, (k + 2) % 3 * count + site);
            mu[a] * slopes[b] - mu[b] * slopes[a]
        })
        .collect();
    assert!(largest_difference(&field, &expected) < 1e-14, "field");
    let mut by_bracket = mu.clone();
    family.ad_star(&gradient, &mu, &mut by_bracket);
    assert!(largest_difference(&field, &by_bracket) < 1e-14, "bracket");
}

#[test]
fn a_family_in_the_macro_is_that_of_its_spec() {
    let written = Ring { N: 33.0, J: 0.75 };
    let spec = HeisenbergChain { N: 33.0, J: 0.75 };
    assert_eq!(Ring::new().N, HeisenbergChain::new().N);
    let mu = written.initial_state().expect("a size");
    assert_eq!(mu, spec.initial_state().expect("a size"));
    let (written, spec) = (
        written.system().expect("a size"),
        spec.system().expect("a size"),
    );
    let (one, other) = (
        end(&written, Splitting6::new(), &mu, 0.3, 9),
        end(&spec, Splitting6::new(), &mu, 0.3, 9),
    );
    assert_eq!(one, other);
    assert_ne!(one, mu);
    let (one, other) = (
        end(&written, Gauss16, &mu, 0.3, 3),
        end(&spec, Gauss16, &mu, 0.3, 3),
    );
    assert_eq!(one, other);
}

#[test]
fn rings_of_any_size_move_as_their_hamiltonian_says() {
    for n in [1, 2, 3, 4, 5, 37] {
        let ring = HeisenbergChain {
            N: n as f64,
            J: 1.25,
        };
        compare(&ring.system().expect("a size"), |at| {
            let bond = |i: isize| (0..3).fold(d(0.0), |sum, k| sum + at(k, 0, i) * at(k, 0, i + 1));
            (0..n).fold(d(0.0), |sum, i| sum - d(1.25) * bond(i))
        });
    }
}

#[test]
fn open_chains_have_no_bond_beyond_their_ends() {
    for n in [3, 4, 5, 8, 40] {
        let chain = OpenChain {
            N: n as f64,
            ..OpenChain::new()
        };
        compare(&chain.system().expect("a size"), |at| {
            let [x, y, z] = [0, 1, 2].map(|k| move |i: isize| at(k, 0, i));
            let mut h = d(0.0);
            for i in 0..n {
                h += d(0.25) * z(i) + x(i) * x(i) * d(0.5);
            }
            for i in 0..n - 1 {
                h += d(1.5) * (x(i) * x(i + 1) + d(1.0 / 3.0) * z(i) * z(i) * y(i + 1));
            }
            for i in 1..n - 1 {
                h -= d(0.5) * x(i - 1) * y(i) * z(i + 1);
            }
            h
        });
    }
}

#[test]
fn all_sites_are_coupled_to_all_by_functions_of_sums() {
    for n in [1, 2, 8, 33] {
        let system = MeanField {
            N: n as f64,
            J: 0.5,
        }
        .system();
        compare(&system.expect("a size"), |at| {
            let [x, y, z] = [0, 1, 2].map(|k| move |i: isize| at(k, 0, i));
            let all = |f: &dyn Fn(isize) -> D| (0..n).fold(d(0.0), |sum, i| sum + f(i));
            let (sx, sy) = (all(&x), all(&y));
            let mean = d(0.5 / (2.0 * n as f64)) * (sx * sx + d(2.0) * sx * sy);
            mean + all(&|i| z(i) * z(i + 1) + x(i) * x(i) * y(i))
        });
    }
}

#[test]
fn functions_of_sums_are_gathered_once() {
    for n in [1.0, 2.0, 9.0, 200.0] {
        let family = MeanFieldPieces {
            N: n,
            ..MeanFieldPieces::new()
        };
        let system = family.system().expect("a size");
        let n = n as isize;
        compare(&system, |at| {
            let [x, y, z] = [0, 1, 2].map(|k| move |i: isize| at(k, 0, i));
            let all =
                |from: isize, f: &dyn Fn(isize) -> D| (from..n).fold(d(0.0), |sum, i| sum + f(i));
            let (sx, sz) = (all(0, &x), all(1, &z));
            let half = all(0, &|i| x(i) * x(i) * d(0.5));
            let bonds = (0..n - 1).fold(d(0.0), |sum, i| sum + z(i) * z(i + 1));
            let mean = (sx * sx + sx * half) * d(0.5 / n as f64);
            mean + d(0.5) * sz.sin() + d(0.25) * all(0, &y) - bonds
        });
    }
}

#[test]
fn lattices_wrap_around_along_the_axes_that_sums_go_over_whole() {
    for (n, m) in [(1, 2), (2, 2), (3, 5), (6, 9)] {
        let lattice = Lattice {
            N: n as f64,
            M: m as f64,
        };
        compare(&lattice.system().expect("sizes"), |at| {
            let [x, y, z] = [0, 1, 2].map(|k| move |i: isize, j: isize| at(k, i, j));
            let mut h = d(0.0);
            for i in 0..n {
                for j in 0..m {
                    h -= x(i, j) * x(i + 1, j) + d(2.0) * y(i, j) * y(i + 1, j);
                    if j < m - 1 {
                        h += z(i, j) * z(i, j + 1) + x(i, j) * y(i, j + 1);
                    }
                }
            }
            h
        });
    }
}

lie_poisson! {
    /// A disordered chain without a spec.
    pub system Disordered;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters {
        N = 4;
        /// The field.
        B = [1, -1/2, 0.25, 3];
        J = [1/3, 2, -1];
    }
    hamiltonian = sum(i in 0..N: B[i]*z[i]) + sum(i in 0..N-1: J[i]*x[i]*x[i+1]);
}

#[test]
fn coefficients_are_those_of_their_site() {
    let chain = DisorderedChain::new();
    let values = |values: &[f64], i: isize| d(values[i as usize]);
    compare(&chain.system().expect("values"), |at| {
        let [x, y, z] = [0, 1, 2].map(|k| move |i: isize| at(k, 0, i));
        let mut h = d(0.0);
        for i in 0..10 {
            let exchange = x(i) * x(i + 1) + y(i) * y(i + 1) + z(i) * z(i + 1);
            h -= values(&chain.J, i) * exchange + values(&chain.K, i + 1) * x(i) * y(i + 1);
        }
        for i in 0..11 {
            let site = values(&chain.B, i) * z(i) + values(&chain.D, i) * z(i) * z(i);
            h -= d(chain.g) * site;
        }
        h
    });
    let lattice = DisorderedLattice::new();
    compare(&lattice.system().expect("values"), |at| {
        let [x, y, z] = [0, 1, 2].map(|k| move |i: isize, j: isize| at(k, i, j));
        let mut h = d(0.0);
        for i in 0..4 {
            for j in 0..5 {
                h += values(&lattice.K, 5 * i + j) * z(i, j) * z(i + 1, j);
                h += values(&lattice.B, 5 * i + j) * x(i, j);
                if j < 4 {
                    let exchange = x(i, j) * x(i, j + 1) + y(i, j) * y(i, j + 1);
                    let exchange = exchange + z(i, j) * z(i, j + 1);
                    h -= values(&lattice.J, 5 * i + j) * exchange;
                }
            }
        }
        h
    });
    let written = Disordered::new();
    assert_eq!(
        (written.B.len(), written.J.as_slice()),
        (4, &[1.0 / 3.0, 2.0, -1.0][..])
    );
    compare(&written.system().expect("values"), |at| {
        let [x, z] = [0, 2].map(|k| move |i: isize| at(k, 0, i));
        let field = (0..4).fold(d(0.0), |h, i| h + values(&written.B, i) * z(i));
        (0..3).fold(field, |h, i| h + values(&written.J, i) * x(i) * x(i + 1))
    });
}

#[test]
fn there_are_as_many_values_as_sites() {
    let wrong = Disordered {
        N: 5.0,
        ..Disordered::new()
    };
    let error = wrong.system().expect_err("four values");
    assert_eq!(error.name, "B");
    assert!(error.to_string().contains("value for each site"), "{error}");
    let long = |n: usize| Disordered {
        N: 5.0,
        B: vec![1.0; 5],
        J: vec![2.0; n],
    };
    let system = long(4).system().expect("a value for each bond");
    let padded = long(5).system().expect("a value for each site");
    let mu: Vec<f64> = unit_spheres(5, 3, 1);
    assert_eq!(system.hamiltonian(&mu), padded.hamiltonian(&mu));
    for n in [3, 6] {
        assert_eq!(long(n).system().expect_err("no such number").name, "J");
    }
}

/// The largest change of the energy and of the Casimirs.
fn drift<P, M>(system: P, method: M, mu: Vec<f64>, h: f64, end: f64) -> (f64, f64)
where
    P: Poisson<f64, State = Vec<f64>>,
    M: Method<f64, P>,
{
    let problem = Problem::new(system, mu, (0.0, end));
    let options = Options::new(h).save(Save::Ends);
    let solution = solve(&problem, method, &options).expect("the steps converge");
    let drift = solution.drift();
    let casimirs = drift.casimirs.iter().map(|c| c.max);
    (drift.energy.max, casimirs.fold(0.0, Scalar::max))
}

#[test]
fn gauss_keeps_energy_and_casimirs_and_the_classical_method_does_not() {
    let ring = HeisenbergChain { N: 50.0, J: 1.0 };
    let mu = ring.initial_state().expect("a size");
    let system = || ring.system().expect("a size");
    let (energy, casimirs) = drift(system(), Gauss16, mu.clone(), 0.25, 100.0);
    assert!(energy < 2e-13 && casimirs < 2e-14, "{energy} {casimirs}");
    let (energy, casimirs) = drift(system(), Rk4, mu.clone(), 0.25, 100.0);
    assert!(energy > 1e-3 && casimirs > 1e-3, "{energy} {casimirs}");
    let ends: Vec<Vec<f64>> = [0.25, 0.125]
        .into_iter()
        .map(|h| {
            let problem = Problem::new(system(), mu.clone(), (0.0, 5.0));
            let solution = solve(&problem, Gauss16, &Options::new(h)).expect("a solution");
            solution.last().expect("a row").1.clone()
        })
        .collect();
    assert!(largest_difference(&ends[0], &ends[1]) < 1e-12);
    let problem = Problem::new(system(), mu.clone(), (0.0, 5.0));
    let tight = Dopri5 {
        rtol: 1e-12,
        atol: 1e-12,
    };
    let solution = solve(&problem, tight, &Options::new(5.0)).expect("a solution");
    let (_, end) = solution.last().expect("a row");
    assert!(largest_difference(&ends[0], end) < 1e-9);
}

#[test]
fn casimirs_are_the_mean_the_smallest_and_the_largest_of_the_sites() {
    let system = HeisenbergChain { N: 3.0, J: 1.0 }.system().expect("a size");
    let mu = vec![1.0, 0.0, 0.5, 0.0, 2.0, 0.5, 0.0, 0.0, 0.5];
    let mut casimirs = [0.0; 3];
    system.casimirs(&mu, &mut casimirs);
    assert!(largest_difference(&casimirs, &[5.75 / 3.0, 0.75, 4.0]) < 1e-15);
    let names: Vec<&str> = (0..3)
        .map(|k| Poisson::<f64>::casimir_name(&system, k))
        .collect();
    assert_eq!(names, ["C1_mean", "C1_min", "C1_max"]);
    assert_eq!(Poisson::<f64>::coordinate(&system, 4), "y[1]");
    let mut gradient = mu.clone();
    system.casimir_gradient(2, &mu, &mut gradient);
    assert_eq!(gradient, [0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
    system.casimir_gradient(1, &mu, &mut gradient);
    assert_eq!(gradient, [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn other_algebras_have_families_too() {
    let ring = Su3Ring::new();
    let system = ring.system().expect("a size");
    assert_eq!(Poisson::<f64>::dimension(&system), 48);
    // of each site a Casimir of degree 2 and one of degree 3
    assert_eq!(Poisson::<f64>::casimir_count(&system), 6);
    let mu = ring.initial_state().expect("a size");
    let (mut gradient, mut field, mut by_bracket) = (mu.clone(), mu.clone(), mu.clone());
    system.gradient(&mu, &mut gradient);
    system.vector_field(&mu, &mut field);
    system.ad_star(&gradient, &mu, &mut by_bracket);
    assert!(largest_difference(&field, &by_bracket) < 1e-14);
    let (energy, casimirs) = drift(system, Gauss16, mu, 0.125, 10.0);
    assert!(energy < 1e-12 && casimirs < 1e-12, "{energy} {casimirs}");
}

#[test]
fn random_spheres_are_the_same_for_every_number_of_sites() {
    let (few, many) = (unit_spheres::<f64>(3, 3, 1), unit_spheres::<f64>(50, 3, 1));
    for site in 0..50 {
        let point = [0, 1, 2].map(|k| many[k * 50 + site]);
        let square: f64 = point.iter().map(|x| x * x).sum();
        assert!((square - 1.0).abs() < 1e-15);
        if site < 3 {
            assert_eq!(point, [0, 1, 2].map(|k| few[k * 3 + site]));
        }
    }
    assert_ne!(unit_spheres::<f64>(3, 3, 1), unit_spheres::<f64>(3, 3, 2));
    let mean = |k: usize| many[k * 50..(k + 1) * 50].iter().sum::<f64>() / 50.0;
    assert!([0, 1, 2].into_iter().all(|k| mean(k).abs() < 0.3));
}

#[test]
fn what_is_no_number_of_sites_is_refused() {
    for n in [0.0, -1.0, 2.5, f64::NAN, f64::INFINITY, 1e12] {
        let error = HeisenbergChain { N: n, J: 1.0 }
            .system()
            .expect_err("no size");
        assert_eq!(error.name, "N");
        assert!(error.to_string().contains("whole number"), "{error}");
    }
    let error = HeisenbergChain {
        N: 4.0,
        J: f64::NAN,
    }
    .system()
    .expect_err("no constant");
    assert_eq!(error.name, "J");
}
