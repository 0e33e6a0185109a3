//! The catalogue of methods against the constants of the runtime: one of them cannot change alone.

use lie_codegen::methods::{Availability, CATALOGUE, Method};
use lie_runtime::methods::{
    CohenHairer2, CohenHairer4, CohenHairer6, Collective2, Collective4, Collective6,
    CommutatorFree4, Compose4, Compose6, Compose8, CrouchGrossman3, DiscreteEulerPoincare, Dopri5,
    EulerArnold2, Facts, Gauss4, Gauss6, Generating2, Generating4, Generating6,
    GeneratingSecondKind2, Gonzalez, ImplicitMidpoint, Isospectral2, Isospectral4, Isospectral6,
    ItohAbe, LieEuler, LieMidpoint, MeanValue, MoserVeselov, OrbitEnergy, Preserves, Rk4, Rkmk2,
    Rkmk3, Rkmk4, Rkmk6, SphericalMidpoint, Splitting1, Splitting2, Splitting4, Splitting6,
    Splitting8, Variational2, Variational4, Variational6,
};

fn agrees<F: Facts>(_: &F) -> &'static str {
    compare::<F>(F::PRESERVES)
}

/// Of a composition the catalogue says only what every one has: it keeps what its base keeps.
fn composition<F: Facts>(_: &F) -> &'static str {
    compare::<F>(Preserves::NOTHING)
}

fn compare<F: Facts>(facts: Preserves) -> &'static str {
    let Method {
        order,
        symmetric,
        explicit,
        preserves,
        ..
    } = CATALOGUE
        .iter()
        .find(|method| method.id == F::ID)
        .expect("an id of the catalogue");
    assert_eq!(*order, F::ORDER, "{}", F::ID);
    assert_eq!(
        (*symmetric, *explicit),
        (F::SYMMETRIC, F::EXPLICIT),
        "{}",
        F::ID
    );
    assert_eq!(preserves.energy, facts.energy, "{}", F::ID);
    assert_eq!(preserves.casimirs, facts.casimirs, "{}", F::ID);
    assert_eq!(
        preserves.quadratic_casimirs,
        facts.quadratic_casimirs,
        "{}",
        F::ID
    );
    assert_eq!(preserves.orbit, facts.orbit, "{}", F::ID);
    assert_eq!(preserves.poisson, facts.poisson, "{}", F::ID);
    assert_eq!(
        preserves.constant_poisson,
        facts.constant_poisson,
        "{}",
        F::ID
    );
    assert_eq!(
        preserves.quadratic_invariants,
        facts.quadratic_invariants,
        "{}",
        F::ID
    );
    assert_eq!(
        preserves.linear_invariants,
        facts.linear_invariants,
        "{}",
        F::ID
    );
    F::ID
}

#[test]
fn facts_are_those_of_the_runtime() {
    let mut built = vec![
        agrees(&ImplicitMidpoint),
        agrees(&Gauss4),
        agrees(&Gauss6),
        agrees(&LieMidpoint::exp()),
        agrees(&Rk4),
        agrees(&Dopri5::default()),
        agrees(&LieEuler),
        agrees(&Rkmk2),
        agrees(&Rkmk3),
        agrees(&Rkmk4),
        agrees(&Rkmk6),
        agrees(&CrouchGrossman3),
        agrees(&CommutatorFree4),
        agrees(&Splitting1::new()),
        agrees(&Splitting2::new()),
        agrees(&Splitting4::new()),
        agrees(&Splitting6::new()),
        agrees(&Splitting8::new()),
        agrees(&Gonzalez),
        agrees(&MeanValue),
        agrees(&ItohAbe),
        agrees(&OrbitEnergy::gonzalez()),
        agrees(&CohenHairer2::new()),
        agrees(&CohenHairer4::new()),
        agrees(&CohenHairer6::new()),
        agrees(&Generating2::exp()),
        agrees(&Generating4::exp()),
        agrees(&Generating6::exp()),
        agrees(&GeneratingSecondKind2),
        agrees(&Collective2::representation()),
        agrees(&Collective4::hopf()),
        agrees(&Collective6::hopf()),
        agrees(&Isospectral2::new()),
        agrees(&Isospectral4::new()),
        agrees(&Isospectral6::new()),
        agrees(&SphericalMidpoint),
        agrees(&MoserVeselov),
        agrees(&Variational2::exp()),
        agrees(&DiscreteEulerPoincare::exp()),
        agrees(&Variational4::exp()),
        agrees(&Variational6::exp()),
        agrees(&EulerArnold2),
        composition(&Compose4::new(LieMidpoint::exp())),
        composition(&Compose6::new(ImplicitMidpoint)),
        composition(&Compose8::new(LieMidpoint::cayley())),
    ];
    assert_eq!(agrees(&LieMidpoint::cayley()), "lie-midpoint");
    assert_eq!(agrees(&OrbitEnergy::mean_value()), "orbit-energy");
    assert_eq!(agrees(&OrbitEnergy::itoh_abe()), "orbit-energy");
    assert_eq!(agrees(&Variational2::cayley()), "variational2");
    assert_eq!(agrees(&Generating2::cayley()), "generating2");
    assert_eq!(agrees(&Generating4::cayley()), "generating4");
    built.sort_unstable();
    let rows = CATALOGUE
        .iter()
        .filter(|method| method.availability == Availability::Built);
    let mut ids: Vec<&str> = rows.map(|method| method.id).collect();
    ids.sort_unstable();
    assert_eq!(ids, built);
}
