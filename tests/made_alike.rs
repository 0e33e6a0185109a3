//! Every method of the catalogue is made by `new()`.

use lie_codegen::methods::CATALOGUE;
use lie_runtime::methods::*;

fn id<M: Facts>(_: M) -> &'static str {
    M::ID
}

macro_rules! ids {
    ($($method:ident),+ $(,)?) => {
        [$(id($method::new())),+]
    };
}

#[test]
fn by_new() {
    let mut made = ids!(
        CohenHairer2,
        CohenHairer4,
        CohenHairer6,
        CohenHairer8,
        CohenHairer10,
        CohenHairer12,
        CohenHairer14,
        CohenHairer16,
        Collective2,
        Collective4,
        Collective6,
        Collective8,
        Collective10,
        Collective12,
        Collective14,
        Collective16,
        CommutatorFree4,
        CrouchGrossman3,
        DiscreteEulerPoincare,
        Dopri5,
        EulerArnold2,
        Exact,
        Gauss4,
        Gauss6,
        Gauss8,
        Gauss10,
        Gauss12,
        Gauss14,
        Gauss16,
        Generating2,
        Generating4,
        Generating6,
        GeneratingSecondKind2,
        Gonzalez,
        ImplicitMidpoint,
        Isospectral2,
        Isospectral4,
        Isospectral6,
        Isospectral8,
        Isospectral10,
        Isospectral12,
        Isospectral14,
        Isospectral16,
        ItohAbe,
        LieEuler,
        LieMidpoint,
        LieTaylor,
        MeanValue,
        MoserVeselov,
        OrbitEnergy,
        Rk4,
        Rkmk2,
        Rkmk3,
        Rkmk4,
        Rkmk6,
        SphericalMidpoint,
        Splitting1,
        Splitting2,
        Splitting4,
        Splitting6,
        Splitting8,
        Taylor,
        Variational2,
        Variational4,
        Variational6,
    );
    made.sort_unstable();
    // compositions are made of another method, `Compose4::new(Rk4::new())`
    let catalogue = CATALOGUE
        .iter()
        .map(|row| row.id)
        .filter(|id| !id.starts_with("compose"));
    let mut catalogue: Vec<&str> = catalogue.collect();
    catalogue.sort_unstable();
    assert_eq!(made.as_slice(), catalogue);
}
