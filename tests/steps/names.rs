//! Names that generated code could take for its own: it compiles, and computes the same.

use lie_runtime::prelude::*;

/// A constant beside a declaration that uses its name for a parameter and a coordinate.
#[allow(dead_code)]
const I1: f64 = 2.0;
#[allow(dead_code)]
const L: f64 = 1.0;

lie_poisson! {
    pub system Beside;
    algebra { basis a, b, c; [a, b] = c; [b, c] = a; [c, a] = b; }
    state L, y, z;
    parameters { I1 = 2.0; I2 = 1.0; I3 = 2/3; }
    hamiltonian = L^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3) + I1*L*y;
    methods = [midpoint, gauss4, lie-midpoint];
}

lie_poisson! { pub spec = "tests/data/names/hostile_names.json"; }
lie_poisson! { pub spec = "tests/data/names/more_hostile_names.json"; }

fn end<P, M>(system: P, mu: P::State, method: M) -> Vec<f64>
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let problem = Problem::new(system, mu, (0.0, 1.0));
    let solution = solve(&problem, method, &Options::new(0.02))
        .ok()
        .expect("a solution");
    let (_, state) = solution.last().expect("a row");
    state.as_slice().to_vec()
}

fn close(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance)
}

macro_rules! all_methods_agree {
    ($system:expr, $mu:expr) => {{
        let system = || $system.system().expect("finite constants");
        let mu = || $mu;
        let reference = end(system(), mu(), Gauss6);
        assert!(close(&end(system(), mu(), Gauss4), &reference, 1e-6));
        for other in [
            end(system(), mu(), ImplicitMidpoint),
            end(system(), mu(), LieMidpoint::exp()),
            end(system(), mu(), LieMidpoint::cayley()),
        ] {
            assert!(close(&other, &reference, 1e-2) && !close(&other, &reference, 1e-12));
        }
        reference
    }};
}

#[test]
fn names_of_the_generated_code_and_of_the_prelude() {
    all_methods_agree!(HostileNames::new(), HostileNames::new().initial_state());
    all_methods_agree!(
        MoreHostileNames::new(),
        MoreHostileNames::new().initial_state()
    );
}

#[test]
fn a_constant_beside_the_declaration() {
    let system = || Beside::new().system().expect("finite constants");
    let mu = || [0.9, 0.3, 0.4].into();
    let reference = end(system(), mu(), Gauss4);
    assert!(close(
        &end(system(), mu(), LieMidpoint::exp()),
        &reference,
        1e-2
    ));
}
