//! Families: their kernels and loops against a direct sum that is written out, and against H differentiated by dual
//! numbers, which shares nothing with them.

use lie_runtime::driver::Save;
use lie_runtime::family::{Family, Pieces, Sites, unit_spheres};
use lie_runtime::methods::Method;
use lie_runtime::prelude::*;
use lie_runtime::{FoundPoisson, PieceFlows};

lie_poisson! { pub spec = "../tests/data/families/heisenberg_chain.json"; }
lie_poisson! { pub spec = "../tests/data/families/open_chain.json"; }
lie_poisson! { pub spec = "../tests/data/families/mean_field.json"; }
lie_poisson! { pub spec = "../tests/data/families/lattice.json"; }
lie_poisson! { pub spec = "../tests/data/families/su3_ring.json"; }
lie_poisson! { pub spec = "../tests/data/families/xxz_chain.json"; }

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

/// The state of a family from that of a direct sum, site after site.
fn by_component(sites: &[f64], n: usize) -> Vec<f64> {
    let count = sites.len() / n;
    (0..sites.len())
        .map(|place| sites[place % count * n + place / count])
        .collect()
}

fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let differences = one.iter().zip(other).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, Scalar::max)
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
fn compare<K, const L: usize, const T: usize>(
    family: &Family<K, 3, L, T>,
    energy: impl Fn(&dyn Fn(usize, isize, isize) -> D) -> D,
) where
    K: Sites<f64, 3, L, T>,
{
    let [rows, columns] = family.sizes();
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

/// The end of a run of so many steps.
fn end<P, M>(system: &P, method: M, mu: &[f64], h: f64, steps: u32) -> Vec<f64>
where
    P: Poisson<f64, State = Vec<f64>>,
    M: Method<f64, P>,
{
    let mut mu = mu.to_vec();
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    mu
}

/// Splittings have their orders, keep the Casimir of each site and are undone by the step back.
fn splits<K, const L: usize, const T: usize>(system: &Family<K, 3, L, T>)
where
    K: Pieces<f64, 3, L, T> + Sites<f64, 3, L, T>,
{
    let count = system.count();
    let mu: Vec<f64> = unit_spheres(count, 3, 11);
    let exact = end(system, Gauss16, &mu, 0.05, 20);
    let error = |end: Vec<f64>| largest_difference(&end, &exact);
    let order = |coarse: f64, fine: f64| (coarse / fine).log2();
    let second =
        [20, 40].map(|n| error(end(system, Splitting2::new(), &mu, 1.0 / f64::from(n), n)));
    let fourth = [8, 16].map(|n| error(end(system, Splitting4::new(), &mu, 1.0 / f64::from(n), n)));
    let sixth = [5, 10].map(|n| error(end(system, Splitting6::new(), &mu, 1.0 / f64::from(n), n)));
    for (errors, expected) in [(second, 2.0), (fourth, 4.0), (sixth, 6.0)] {
        let found = order(errors[0], errors[1]);
        assert!(
            (found - expected).abs() < 0.7,
            "{found} {expected} {errors:?}"
        );
        assert!(errors[1] > 1e-13, "{errors:?} is round-off");
    }
    let far = end(system, Splitting2::new(), &mu, 0.3, 200);
    for site in 0..count {
        let square: f64 = (0..3).map(|k| far[k * count + site].powi(2)).sum();
        assert!((square - 1.0).abs() < 1e-13, "{site} {square}");
    }
    let back = end(system, Splitting4::new(), &far, 0.3, 5);
    let back = end(system, Splitting4::new(), &back, -0.3, 5);
    assert!(largest_difference(&back, &far) < 1e-12);
}

#[test]
fn bonds_of_spins_are_done_two_or_three_colours_at_a_time() {
    for n in [2, 3, 6, 7, 100, 101] {
        let ring = HeisenbergChain {
            N: f64::from(n),
            J: 0.8,
        };
        let system = ring.system().expect("a size");
        let colours = if n % 2 == 0 { 2 } else { 3 };
        assert_eq!(FoundPoisson::<f64>::found(&system).pieces(), colours);
        // both bonds of two sites are the same, so that a splitting of them is exact
        if n > 2 {
            splits(&system);
        }
    }
    // large steps, on which the turn is no short series
    let system = HeisenbergChain { N: 6.0, J: 1.0 }.system().expect("a size");
    let mu: Vec<f64> = unit_spheres(6, 3, 1);
    let (mut one, mut ten) = (mu.clone(), mu);
    let mut flows = FoundPoisson::<f64>::found(&system);
    flows.flow(0, 9.0, &mut one);
    for _ in 0..10 {
        flows.flow(0, 0.9, &mut ten);
    }
    assert!(largest_difference(&one, &ten) < 1e-13);
}

#[test]
fn products_and_functions_of_one_coordinate_are_pieces_too() {
    for n in [2.0, 7.0, 80.0] {
        let chain = XxzChain {
            N: n,
            ..XxzChain::new()
        };
        splits(&chain.system().expect("a size"));
    }
    for (n, m) in [(2.0, 3.0), (3.0, 5.0), (4.0, 70.0)] {
        splits(&Lattice { N: n, M: m }.system().expect("sizes"));
    }
}

#[test]
fn opposite_spins_beside_a_bond_that_turns_far_stay() {
    let family = HeisenbergChain { N: 4.0, J: 0.75 }.system().expect("sizes");
    // the first bond has the sum 0; the second turns by more than what a series is taken for
    let spins = [0.6, 0.0, 0.8, -0.6, 0.0, -0.8, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let start = by_component(&spins, 3);
    let (mut once, mut often) = (start.clone(), start.clone());
    let mut flows = family.flows();
    flows.flow(0, 4.0, &mut once);
    (0..1000).for_each(|_| flows.flow(0, 0.004, &mut often));
    let difference = largest_difference(&once, &often);
    assert!(difference < 1e-12, "{difference:e}");
    assert!(
        largest_difference(&once, &start) > 0.1,
        "the other bond turns"
    );
}

#[test]
fn a_bond_of_a_site_with_itself_is_no_piece() {
    let system = HeisenbergChain { N: 1.0, J: 1.0 }.system().expect("a size");
    let mut stepper =
        Method::<f64, _>::stepper(&Splitting2::new(), &system, 0.1, &NewtonOptions::default());
    let mut mu = vec![1.0, 0.0, 0.0];
    assert!(stepper.step(&mut mu, &mut ()).is_err());
    assert_eq!(mu, [1.0, 0.0, 0.0]);
}
