//! Splittings of families: their order and what they keep, and the flows of their pieces.

use crate::families::{
    DisorderedChain, DisorderedLattice, HeisenbergChain, Lattice, MeanFieldPieces,
};
use crate::sites;

use lie_runtime::family::{Family, Pieces, unit_spheres};
use lie_runtime::methods::Method;
use lie_runtime::prelude::*;
use lie_runtime::{FoundPoisson, PieceFlows};
use sites::{by_component, end, largest_difference};

lie_poisson! { pub spec = "../../tests/data/families/fput_chain.json"; }
lie_poisson! { pub spec = "../../tests/data/families/xxz_chain.json"; }
lie_poisson! { pub spec = "../../tests/data/families/toda_ring.json"; }

lie_poisson! {
    /// Spins on a lattice with all bonds in one sum, and bonds along a diagonal.
    pub system Square;
    algebra = so(3)^(N, M);
    state x[i, j], y[i, j], z[i, j];
    parameters { N = 4; M = 6; }
    hamiltonian = -sum(i in 0..N, j in 0..M: x[i, j]*x[i+1, j] + y[i, j]*y[i+1, j] + z[i, j]*z[i+1, j]
        + x[i, j]*x[i, j+2] + y[i, j]*y[i, j+2] + z[i, j]*z[i, j+2] + z[i, j]*z[i+1, j-1]/2);
    initial = random(unit-sphere, 3);
}

/// Splittings have their orders.
fn have_orders<K>(system: &Family<K>, mu: &[f64])
where
    K: Pieces<f64>,
{
    let exact = end(system, Gauss16, mu, 0.05, 20);
    let error = |end: Vec<f64>| largest_difference(&end, &exact);
    let order = |coarse: f64, fine: f64| (coarse / fine).log2();
    let second = [20, 40].map(|n| error(end(system, Splitting2::new(), mu, 1.0 / f64::from(n), n)));
    let fourth = [8, 16].map(|n| error(end(system, Splitting4::new(), mu, 1.0 / f64::from(n), n)));
    let sixth = [5, 10].map(|n| error(end(system, Splitting6::new(), mu, 1.0 / f64::from(n), n)));
    for (errors, expected) in [(second, 2.0), (fourth, 4.0), (sixth, 6.0)] {
        let found = order(errors[0], errors[1]);
        assert!(
            (found - expected).abs() < 0.7,
            "{found} {expected} {errors:?}"
        );
        assert!(errors[1] > 1e-13, "{errors:?} is round-off");
    }
}

/// Splittings have their orders, keep the Casimir of each site and are undone by the step back.
fn splits<K>(system: &Family<K>)
where
    K: Pieces<f64>,
{
    let count = system.count();
    let mu: Vec<f64> = unit_spheres(count, 3, 11);
    have_orders(system, &mu);
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
    let start = one.clone();
    flows.gather(&start, &mut one);
    flows.gather(&start, &mut ten);
    flows.flow(0, 9.0, &mut one);
    for _ in 0..10 {
        flows.flow(0, 0.9, &mut ten);
    }
    assert!(largest_difference(&one, &ten) < 1e-13);
    assert!(largest_difference(&one, &start) > 0.1);
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
fn lanes_make_the_steps_of_single_runs() {
    // spins of very different lengths, so that lanes take different numbers of terms, or none
    let scales = [1e-6, 0.01, 0.3, 1.0, 2.0, 7.0, 1e3, 0.0];
    let mu: Vec<Vec<f64>> = (0..8)
        .map(|lane| {
            let state = unit_spheres::<f64>(7, 3, lane as u64);
            state.into_iter().map(|x| scales[lane] * x).collect()
        })
        .collect();
    let ring = HeisenbergChain::<F64x8> {
        N: F64x8::from_f64(7.0),
        J: F64x8::from_f64(0.75),
    };
    let wide = ring.system().expect("a size");
    let mut lanes: Vec<F64x8> = (0..21)
        .map(|k| F64x8::new(std::array::from_fn(|lane| mu[lane][k])))
        .collect();
    let h = F64x8::from_f64(0.25);
    let mut stepper = Splitting6::new().stepper(&wide, h, &NewtonOptions::default());
    for _ in 0..5 {
        stepper.step(&mut lanes, &mut ()).expect("a step");
    }
    let single = HeisenbergChain { N: 7.0, J: 0.75 }
        .system()
        .expect("a size");
    for (lane, mu) in mu.iter().enumerate() {
        let alone = end(&single, Splitting6::new(), mu, 0.25, 5);
        let among: Vec<f64> = lanes.iter().map(|x| x.lane(lane)).collect();
        assert_eq!(alone, among, "lane {lane}");
        if lane < 7 {
            assert_ne!(&alone, mu);
        }
    }
}

#[test]
fn opposite_spins_beside_a_bond_that_turns_far_stay() {
    let family = HeisenbergChain { N: 4.0, J: 0.75 }.system().expect("sizes");
    // the first bond has the sum 0; the second turns by more than what a series is taken for
    let spins = [0.6, 0.0, 0.8, -0.6, 0.0, -0.8, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let start = by_component(&spins, 3);
    let (mut once, mut often) = (start.clone(), start.clone());
    let mut flows = family.found();
    flows.gather(&start, &mut once);
    flows.gather(&start, &mut often);
    flows.flow(0, 4.0, &mut once);
    (0..1000).for_each(|_| flows.flow(0, 0.004, &mut often));
    let difference = largest_difference(&once, &often);
    assert!(difference < 1e-12, "{difference:e}");
    let mut end = start.clone();
    flows.scatter(true, &once, &mut end);
    let moved = |site: usize| (0..3).any(|k| (end[4 * k + site] - start[4 * k + site]).abs() > 0.1);
    assert_eq!([0, 1, 2, 3].map(moved), [false, false, true, true]);
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

#[test]
fn a_sum_of_bonds_is_taken_apart_and_every_distance_has_its_colours() {
    for (n, m) in [(2.0, 3.0), (3.0, 4.0), (4.0, 6.0), (5.0, 9.0), (3.0, 70.0)] {
        splits(&Square { N: n, M: m }.system().expect("sizes"));
    }
}

#[test]
fn functions_of_sums_over_one_coordinate_are_pieces_too() {
    for n in [1.0, 2.0, 9.0, 200.0] {
        let family = MeanFieldPieces {
            N: n,
            ..MeanFieldPieces::new()
        };
        let system = family.system().expect("a size");
        if n > 1.0 {
            splits(&system);
        }
    }
    // a function of the sum turns all sites by the same angle, however far
    let family = MeanFieldPieces {
        N: 3.0,
        J: 6.0,
        K: 0.0,
    };
    let system = family.system().expect("a size");
    let start = vec![0.5, 0.25, 0.75, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let mut flows = FoundPoisson::<f64>::found(&system);
    let (mut taken, mut end) = (start.clone(), start.clone());
    flows.gather(&start, &mut taken);
    let piece = (0..flows.pieces()).find(|piece| {
        let mut moved = taken.clone();
        flows.flow(*piece, 0.125, &mut moved);
        moved[..3] == taken[..3] && moved[3..] != taken[3..]
    });
    flows.flow(piece.expect("a turn about x"), 0.125, &mut taken);
    flows.scatter(true, &taken, &mut end);
    let (sum, squares): (f64, f64) = (1.5, 0.5 * (0.25 + 0.0625 + 0.5625));
    let turned = |i: usize| {
        let angle = 0.125 * (2.0 * sum + squares + sum * start[i]);
        let (y, z) = (start[3 + i], start[6 + i]);
        let (sin, cos) = angle.sin_cos();
        [
            y * cos - z * sin,
            y * sin + z * cos,
            y * cos + z * sin,
            z * cos - y * sin,
        ]
    };
    for i in 0..3 {
        let [y, z, y_back, z_back] = turned(i);
        let near = |a: f64, b: f64| (end[3 + i] - a).abs() + (end[6 + i] - b).abs() < 1e-14;
        assert!(near(y, z) || near(y_back, z_back), "{i} {end:?}");
    }
}

#[test]
fn pieces_have_the_coefficients_of_their_sites() {
    splits(&DisorderedChain::new().system().expect("values"));
    splits(&DisorderedLattice::new().system().expect("values"));
}

#[test]
fn functions_of_two_coordinates_have_exact_flows() {
    let ring = TodaRing::new().system().expect("values");
    let chain = FputChain::new().system().expect("values");
    // momenta, and bonds in two colours, those of the ring with the potentials of their first sites
    assert_eq!(FoundPoisson::<f64>::found(&ring).pieces(), 3);
    assert_eq!(FoundPoisson::<f64>::found(&chain).pieces(), 3);
    let moving = |count: usize| {
        let mut mu: Vec<f64> = unit_spheres(count, 3, 11);
        mu[2 * count..].fill(1.0);
        mu
    };
    have_orders(&ring, &moving(6));
    have_orders(&chain, &moving(9));
    // the flow keeps the total momentum of a chain, and the unit of every site
    let mu = moving(9);
    let far = end(&chain, Splitting4::new(), &mu, 0.1, 500);
    let momentum = |mu: &[f64]| mu[9..18].iter().sum::<f64>();
    assert!((momentum(&far) - momentum(&mu)).abs() < 1e-12);
    assert_eq!(&far[18..], &mu[18..]);
    let change = chain.hamiltonian(&far) - chain.hamiltonian(&mu);
    assert!(change.abs() < 1e-4, "{change}");
    let back = end(&chain, Splitting4::new(), &far, -0.1, 500);
    assert!(largest_difference(&back, &mu) < 1e-8);
}
