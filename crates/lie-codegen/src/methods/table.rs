//! The table itself: one row for each method. What is known of it stands in its type.

use lie_core::methods::{
    CohenHairer2, CohenHairer4, CohenHairer6, CohenHairer8, CohenHairer10, CohenHairer12,
    CohenHairer14, CohenHairer16, Collective2, Collective4, Collective6, Collective8, Collective10,
    Collective12, Collective14, Collective16, CommutatorFree4, Compose4, Compose6, Compose8,
    CrouchGrossman3, DiscreteEulerPoincare, Dopri5, EulerArnold2, Exact, Exp, Facts, Gauss4,
    Gauss6, Gauss8, Gauss10, Gauss12, Gauss14, Gauss16, Generating2, Generating4, Generating6,
    GeneratingSecondKind2, Gonzalez, ImplicitMidpoint, Isospectral2, Isospectral4, Isospectral6,
    Isospectral8, Isospectral10, Isospectral12, Isospectral14, Isospectral16, ItohAbe, LieEuler,
    LieMidpoint, LieTaylor, MeanValue, MoserVeselov, OrbitEnergy, Preserves, Representation, Rk4,
    Rkmk2, Rkmk3, Rkmk4, Rkmk6, Smallest, SphericalMidpoint, Splitting1, Splitting2, Splitting4,
    Splitting6, Splitting8, Taylor, Variational2, Variational4, Variational6,
};

use super::Method;

const ANY: &str = "any Poisson system";
const ALGEBRA: &str = "any Lie algebra";
const RETRACTION: &str =
    "any Lie algebra (exp), a matrix representation closed under (abc + cba)/2 (cayley)";
const LAGRANGIAN: &str = "a system given by its Lagrangian; for --retraction cayley a matrix representation closed under (abc + cba)/2";
const REDUCTIVE: &str =
    "a matrix representation closed under (abc + cba)/2, up to matrices that commute with it";
const COLLECTIVE: &str = "a matrix representation closed under (abc + cba)/2, up to matrices that commute with it; with --lift hopf a direct sum of algebras so(3)";

const LINEAR: &str = "a direct sum of algebras so(3) (hopf), so(3) with vectors such as se(3) (quaternion), else a matrix representation closed under (abc + cba)/2, up to matrices that commute with it";
const SPINS: &str = "a direct sum of algebras so(3)";
const EXPRESSION: &str = "a Hamiltonian with an expression";
const SUM: &str = "H of functions of commuting coordinates and of Casimirs of subalgebras, or quadratic; for --pieces coordinate H = sum f_i(x_i)";

const AKW: &str = "Austin, Krishnaprasad, Wang (1993), 10.1006/jcph.1993.1128";
const HLW: &str =
    "Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), 10.1007/3-540-30666-8";
const MPS: &str = "Marsden, Pekarsky, Shkoller (1999), 10.1088/0951-7715/12/6/314; Bou-Rabee, Marsden (2009), 10.1007/s10208-008-9030-4";
const LEOK: &str = "Marsden, Pekarsky, Shkoller (1999), 10.1088/0951-7715/12/6/314; Hall, Leok (2017), 10.1007/s10208-015-9287-3";
const BRM: &str = "Bou-Rabee, Marsden (2009), 10.1007/s10208-008-9030-4";
const MK: &str = "Munthe-Kaas (1999), 10.1016/S0168-9274(98)00030-0";
const CROUCH: &str = "Crouch, Grossman (1993), 10.1007/BF02429858";
const CMO: &str = "Celledoni, Marthinsen, Owren (2003), 10.1016/S0167-739X(02)00161-9";
const MV: &str = "Moser, Veselov (1991), 10.1007/BF02352494";
const GM: &str = "Ge, Marsden (1988), 10.1016/0375-9601(88)90773-6; Channell, Scovel (1991), 10.1016/0167-2789(91)90081-J";
const MODIN: &str = "Modin, Viviani (2020), 10.1007/s10208-019-09428-w";
const COLL: &str = "McLachlan, Modin, Verdier (2014), 10.1088/0951-7715/27/6/1525";
const MMV: &str = "McLachlan, Modin, Verdier (2014), 10.1103/PhysRevE.89.061301";
const MCL: &str = "McLachlan (1993), 10.1103/PhysRevLett.71.3043";
const BM: &str = "McLachlan (1993), 10.1103/PhysRevLett.71.3043; Blanes, Moan (2002), 10.1016/S0377-0427(01)00492-7";
const DG: &str = "Gonzalez (1996), 10.1007/BF02440162; McLachlan, Quispel, Robidoux (1999), 10.1098/rsta.1999.0363";
const EF: &str = "Engø, Faltinsen (2001), 10.1137/S0036142999364212";
const WW: &str = "Whittaker, Watson, A Course of Modern Analysis (1927), 10.1017/CBO9780511608759";
const CH: &str = "Cohen, Hairer (2011), 10.1007/s10543-011-0310-z";
const JZ: &str = "Jorba, Zou (2005), 10.1080/10586458.2005.10128904";
const KL: &str =
    "Suzuki (1990), 10.1016/0375-9601(90)90962-N; Kahan, Li (1997), 10.1090/S0025-5718-97-00873-9";

/// The row of a method.
const fn row<M: Facts>(
    title: &'static str,
    needs: &'static str,
    reference: &'static str,
) -> Method {
    // a composition keeps what its base keeps, which only its base can say
    let composes = matches!(
        M::ID.as_bytes(),
        [b'c', b'o', b'm', b'p', b'o', b's', b'e', ..]
    );
    Method {
        id: M::ID,
        title,
        order: M::ORDER,
        symmetric: M::SYMMETRIC,
        explicit: M::EXPLICIT,
        fixed_point: M::FIXED_POINT,
        preserves: if composes {
            Preserves::NOTHING
        } else {
            M::PRESERVES
        },
        needs,
        reference,
    }
}

macro_rules! catalogue {
    ($($method:ty: $title:literal, $needs:expr, $reference:expr;)+) => {
        /// Every method.
        pub const CATALOGUE: &[Method] = &[$(row::<$method>($title, $needs, $reference)),+];
    };
}

catalogue! {
    ImplicitMidpoint: "Poisson midpoint rule", ANY, AKW;
    Gauss4: "Gauss collocation, 2 stages", ANY, HLW;
    Gauss6: "Gauss collocation, 3 stages", ANY, HLW;
    Gauss8: "stage-parallel Gauss collocation", ANY, HLW;
    Gauss10: "stage-parallel Gauss collocation", ANY, HLW;
    Gauss12: "stage-parallel Gauss collocation", ANY, HLW;
    Gauss14: "stage-parallel Gauss collocation", ANY, HLW;
    Gauss16: "stage-parallel Gauss collocation", ANY, HLW;
    LieMidpoint<Exp>: "retraction Lie–Poisson integrator", RETRACTION, MPS;
    Rk4: "classical Runge–Kutta method (control)", ANY, "Kutta (1901)";
    Dopri5: "Dormand–Prince pair with step control (control)", ANY, "Dormand, Prince (1980), 10.1016/0771-050X(80)90013-3";
    Taylor: "Taylor series, order and step from a tolerance", EXPRESSION, JZ;
    LieTaylor: "Taylor series in the algebra, order and step from a tolerance", "any Lie algebra, a Hamiltonian with an expression", JZ;
    LieEuler: "Lie–Euler", ALGEBRA, MK;
    Rkmk2: "Runge–Kutta–Munthe-Kaas", ALGEBRA, MK;
    Rkmk3: "Runge–Kutta–Munthe-Kaas", ALGEBRA, MK;
    Rkmk4: "Runge–Kutta–Munthe-Kaas", ALGEBRA, MK;
    Rkmk6: "Runge–Kutta–Munthe-Kaas", ALGEBRA, MK;
    CrouchGrossman3: "Crouch–Grossman", ALGEBRA, CROUCH;
    CommutatorFree4: "commutator-free", ALGEBRA, CMO;
    Variational2: "variational integrator (discrete Euler–Poincaré)", LAGRANGIAN, MPS;
    Variational4: "variational integrator (Lie-group Galerkin)", "a system given by its Lagrangian", LEOK;
    Variational6: "variational integrator (Lie-group Galerkin)", "a system given by its Lagrangian", LEOK;
    DiscreteEulerPoincare<Exp>: "step of a declared discrete Lagrangian; its order is at least 1", "a system given by its discrete Lagrangian; for --retraction cayley a matrix representation closed under (abc + cba)/2", MPS;
    MoserVeselov: "discrete rigid body", "so(3) with a diagonal quadratic H, or so(n) with H = sum M_ij^2/(2(J_i + J_j))", MV;
    Compose4<ImplicitMidpoint>: "composition of a symmetric method", "a symmetric method of order 2", KL;
    Compose6<ImplicitMidpoint>: "composition of a symmetric method", "a symmetric method of order 2", KL;
    Compose8<ImplicitMidpoint>: "composition of a symmetric method", "a symmetric method of order 2", KL;
    Generating2: "generating function", RETRACTION, GM;
    Generating4: "generating function", RETRACTION, GM;
    Generating6: "generating function", ALGEBRA, GM;
    GeneratingSecondKind2: "generating function, coordinates of the second kind", ALGEBRA, GM;
    Collective2<Representation>: "collective symplectic", COLLECTIVE, COLL;
    Collective4<Representation>: "collective symplectic", COLLECTIVE, COLL;
    Collective6<Representation>: "collective symplectic", COLLECTIVE, COLL;
    Collective8<Smallest>: "stage-parallel collective symplectic", LINEAR, COLL;
    Collective10<Smallest>: "stage-parallel collective symplectic", LINEAR, COLL;
    Collective12<Smallest>: "stage-parallel collective symplectic", LINEAR, COLL;
    Collective14<Smallest>: "stage-parallel collective symplectic", LINEAR, COLL;
    Collective16<Smallest>: "stage-parallel collective symplectic", LINEAR, COLL;
    Isospectral2: "isospectral symplectic Runge–Kutta", REDUCTIVE, MODIN;
    Isospectral4: "isospectral symplectic Runge–Kutta", REDUCTIVE, MODIN;
    Isospectral6: "isospectral symplectic Runge–Kutta", REDUCTIVE, MODIN;
    Isospectral8: "stage-parallel isospectral Runge–Kutta", REDUCTIVE, MODIN;
    Isospectral10: "stage-parallel isospectral Runge–Kutta", REDUCTIVE, MODIN;
    Isospectral12: "stage-parallel isospectral Runge–Kutta", REDUCTIVE, MODIN;
    Isospectral14: "stage-parallel isospectral Runge–Kutta", REDUCTIVE, MODIN;
    Isospectral16: "stage-parallel isospectral Runge–Kutta", REDUCTIVE, MODIN;
    SphericalMidpoint: "spherical midpoint", SPINS, MMV;
    Splitting1: "Lie–Trotter splitting", SUM, MCL;
    Splitting2: "Strang splitting", SUM, MCL;
    Splitting4: "Blanes–Moan splitting", SUM, BM;
    Splitting6: "Blanes–Moan splitting", SUM, BM;
    Splitting8: "composed splitting", SUM, MCL;
    Gonzalez: "midpoint discrete gradient", ANY, DG;
    MeanValue: "mean-value discrete gradient", ANY, DG;
    ItohAbe: "coordinate-increment discrete gradient", ANY, DG;
    OrbitEnergy<Gonzalez>: "orbit- and energy-preserving", ALGEBRA, EF;
    CohenHairer2: "energy-preserving collocation", ANY, CH;
    CohenHairer4: "energy-preserving collocation", ANY, CH;
    CohenHairer6: "energy-preserving collocation", ANY, CH;
    CohenHairer8: "stage-parallel energy-preserving collocation", ANY, CH;
    CohenHairer10: "stage-parallel energy-preserving collocation", ANY, CH;
    CohenHairer12: "stage-parallel energy-preserving collocation", ANY, CH;
    CohenHairer14: "stage-parallel energy-preserving collocation", ANY, CH;
    CohenHairer16: "stage-parallel energy-preserving collocation", ANY, CH;
    Exact: "exact flow; the order is that of the group element", "so(3), or a sum of such, with a quadratic form H that does not couple them; or H that is linear or contains only coordinates that commute", WW;
    EulerArnold2: "symplectic method on T*G", "a system on T*G: a group element is declared", BRM;
}

#[cfg(test)]
mod tests {
    use super::CATALOGUE;
    use crate::methods::Choice;

    #[test]
    fn each_row_is_a_method_that_can_be_chosen() {
        for (place, method) in CATALOGUE.iter().enumerate() {
            let others = &CATALOGUE[place + 1..];
            assert!(
                others.iter().all(|other| other.id != method.id),
                "{} twice",
                method.id
            );
            let id = if method.id.starts_with("compose") {
                format!("{}(midpoint)", method.id)
            } else {
                method.id.to_owned()
            };
            assert!(Choice::from_id(&id).is_ok(), "{id}");
        }
    }
}
