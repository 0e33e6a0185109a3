//! Bonds between any two sites: the same as bonds at fixed distances, and as one algebra written out.

use crate::sites;

use lie_runtime::family::unit_spheres;
use lie_runtime::methods::Gauss8;
use lie_runtime::prelude::*;
use sites::{by_component, end, largest_difference};

lie_poisson! {
    /// A ring of spins by its bonds, with damping.
    pub system Listed;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 5; J = 3/4; a = 0; }
    bonds = [[0, 1, 1], [1, 2, 1], [2, 3, 1], [3, 4, 1], [4, 0, 1]];
    hamiltonian = -J*sum(bonds: value*(x[i]*x[j] + y[i]*y[j] + z[i]*z[j]));
    dissipation { double-bracket(strength = a); }
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// The same by its neighbours.
    pub system Ring;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 5; J = 3/4; a = 0; }
    hamiltonian = -J*sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1]);
    dissipation { double-bracket(strength = a); }
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// Bonds that are not symmetric in their sites, on neighbours with a field of all of them.
    pub system Net;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 4; }
    bonds = [[0, 2, 1/2], [3, 1, -2], [2, 3, 3/4], [3, 2, 1/8]];
    let E = sum(bonds: value*(x[i]*y[j] + z[i]^2*z[j]));
    hamiltonian = E^2/3 - E + sum(i in 0..N-1: x[i]*z[i+1]);
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// The same written out.
    pub system Four;
    algebra = so(3)^4;
    state x0, y0, z0, x1, y1, z1, x2, y2, z2, x3, y3, z3;
    let E = (x0*y2 + z0^2*z2)/2 - 2*(x3*y1 + z3^2*z1) + 3/4*(x2*y3 + z2^2*z3) + (x3*y2 + z3^2*z2)/8;
    hamiltonian = E^2/3 - E + x0*z1 + x1*z2 + x2*z3;
    methods = [gauss8];
}

#[test]
fn a_ring_by_its_bonds_is_the_ring() {
    for a in [0.0, 0.3] {
        let listed = Listed { a, ..Listed::new() }.system().expect("bonds");
        let ring = Ring { a, ..Ring::new() }.system().expect("sizes");
        let mut start = Listed::new().initial_state().expect("a seed");
        assert_eq!(start, Ring::new().initial_state().expect("a seed"));
        let (mut one, mut other) = (start.clone(), start.clone());
        listed.vector_field(&start, &mut one);
        ring.vector_field(&start, &mut other);
        assert!(largest_difference(&one, &other) < 2e-15);
        assert!((listed.energy(&start) - ring.energy(&start)).abs() < 1e-15);
        // an extra bond is another system
        let mut more = Listed { a, ..Listed::new() };
        more.bonds.extend([0.0, 2.0, 0.5]);
        more.system()
            .expect("bonds")
            .vector_field(&start, &mut other);
        assert!(largest_difference(&one, &other) > 0.1, "the control");
        let ends = [
            end(&listed, Gauss8, &start, 0.1, 30),
            end(&ring, Gauss8, &start, 0.1, 30),
        ];
        assert!(largest_difference(&ends[0], &ends[1]) < 1e-13);
        start.fill(0.0);
    }
}

#[test]
fn bonds_are_those_of_the_algebra_written_out() {
    let net = Net::new().system().expect("bonds");
    let four = Four::new().system().expect("constants");
    for seed in 0..20 {
        let sites = by_component(&unit_spheres::<f64>(4, 3, seed), 4);
        let mut written = four.zero_state();
        written.as_mut_slice().copy_from_slice(&sites);
        let mu = by_component(&sites, 3);
        assert!((net.hamiltonian(&mu) - four.hamiltonian(&written)).abs() < 1e-14);
        let (mut out, mut expected) = (mu.clone(), four.zero_state());
        net.vector_field(&mu, &mut out);
        four.vector_field(&written, &mut expected);
        assert!(largest_difference(&out, &by_component(expected.as_slice(), 3)) < 1e-14);
        net.gradient(&mu, &mut out);
        four.gradient(&written, &mut expected);
        assert!(largest_difference(&out, &by_component(expected.as_slice(), 3)) < 1e-14);
    }
}

#[test]
fn a_row_that_joins_no_two_sites_is_refused() {
    for rows in [
        vec![0.0, 5.0, 1.0],
        vec![2.0, 2.0, 1.0],
        vec![0.5, 1.0, 1.0],
        vec![0.0, 1.0],
    ] {
        let listed = Listed {
            bonds: rows,
            ..Listed::new()
        };
        let error = listed.system().expect_err("no bond").to_string();
        assert!(
            error.contains("joins no two sites of the family"),
            "{error}"
        );
    }
}
