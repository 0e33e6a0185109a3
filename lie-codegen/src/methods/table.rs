//! The table itself.

use super::{Availability, Method, Preserves};

const ANY: &str = "any Poisson system";
const ALGEBRA: &str = "any Lie algebra";
const RETRACTION: &str =
    "any Lie algebra (exp), a matrix representation closed under (abc + cba)/2 (cayley)";
const LAGRANGIAN: &str = "a system by its Lagrangian; for --retraction cayley a matrix representation closed under (abc + cba)/2";
const REDUCTIVE: &str =
    "a matrix representation closed under (abc + cba)/2, up to matrices that commute with it";
const COLLECTIVE: &str = "a matrix representation closed under (abc + cba)/2, up to matrices that commute with it; with --lift hopf a direct sum of algebras so(3)";

/// A row of the table; [`Method::built`] marks those that are built.
const fn planned(
    id: &'static str,
    title: &'static str,
    order: u32,
    [symmetric, explicit]: [bool; 2],
    preserves: Preserves,
    needs: &'static str,
    reference: &'static str,
) -> Method {
    Method {
        id,
        title,
        order,
        symmetric,
        explicit,
        preserves,
        needs,
        reference,
        availability: Availability::Planned,
    }
}

impl Method {
    const fn built(mut self) -> Self {
        self.availability = Availability::Built;
        self
    }
}

const SUM: &str = "H = sum f_i(x_i), each term of one coordinate";

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
const CH: &str = "Cohen, Hairer (2011), 10.1007/s10543-011-0310-z";
const KL: &str =
    "Suzuki (1990), 10.1016/0375-9601(90)90962-N; Kahan, Li (1997), 10.1090/S0025-5718-97-00873-9";

/// Every method, built or planned.
pub const CATALOGUE: &[Method] = &[
    planned(
        "midpoint",
        "Poisson midpoint rule",
        2,
        [true, false],
        Preserves::QUADRATIC,
        ANY,
        AKW,
    )
    .built(),
    planned(
        "gauss4",
        "Gauss collocation, 2 stages",
        4,
        [true, false],
        Preserves::QUADRATIC,
        ANY,
        HLW,
    )
    .built(),
    planned(
        "gauss6",
        "Gauss collocation, 3 stages",
        6,
        [true, false],
        Preserves::QUADRATIC,
        ANY,
        HLW,
    )
    .built(),
    planned(
        "lie-midpoint",
        "retraction Lie–Poisson integrator",
        2,
        [true, false],
        Preserves::POISSON,
        RETRACTION,
        MPS,
    )
    .built(),
    planned(
        "rk4",
        "classical Runge–Kutta method (control)",
        4,
        [false, true],
        Preserves::LINEAR,
        ANY,
        "Kutta (1901)",
    )
    .built(),
    planned(
        "dopri5",
        "Dormand–Prince pair with step control (control)",
        5,
        [false, true],
        Preserves::LINEAR,
        ANY,
        "Dormand, Prince (1980), 10.1016/0771-050X(80)90013-3",
    )
    .built(),
    planned(
        "lie-euler",
        "Lie–Euler",
        1,
        [false, true],
        Preserves::ORBIT,
        ALGEBRA,
        MK,
    )
    .built(),
    planned(
        "rkmk2",
        "Runge–Kutta–Munthe-Kaas",
        2,
        [false, true],
        Preserves::ORBIT,
        ALGEBRA,
        MK,
    )
    .built(),
    planned(
        "rkmk3",
        "Runge–Kutta–Munthe-Kaas",
        3,
        [false, true],
        Preserves::ORBIT,
        ALGEBRA,
        MK,
    )
    .built(),
    planned(
        "rkmk4",
        "Runge–Kutta–Munthe-Kaas",
        4,
        [false, true],
        Preserves::ORBIT,
        ALGEBRA,
        MK,
    )
    .built(),
    planned(
        "rkmk6",
        "Runge–Kutta–Munthe-Kaas",
        6,
        [false, true],
        Preserves::ORBIT,
        ALGEBRA,
        MK,
    )
    .built(),
    planned(
        "cg3",
        "Crouch–Grossman",
        3,
        [false, true],
        Preserves::ORBIT,
        ALGEBRA,
        CROUCH,
    )
    .built(),
    planned(
        "cf4",
        "commutator-free",
        4,
        [false, true],
        Preserves::ORBIT,
        ALGEBRA,
        CMO,
    )
    .built(),
    planned(
        "variational2",
        "variational integrator (discrete Euler–Poincaré)",
        2,
        [true, false],
        Preserves::POISSON,
        LAGRANGIAN,
        MPS,
    )
    .built(),
    planned(
        "variational4",
        "variational integrator (Lie-group Galerkin)",
        4,
        [false, false],
        Preserves::POISSON,
        "a system by its Lagrangian",
        LEOK,
    )
    .built(),
    planned(
        "variational6",
        "variational integrator (Lie-group Galerkin)",
        6,
        [false, false],
        Preserves::POISSON,
        "a system by its Lagrangian",
        LEOK,
    )
    .built(),
    planned(
        "discrete-euler-poincare",
        "step of a declared discrete Lagrangian; its order is at least 1",
        1,
        [false, false],
        Preserves::POISSON,
        "a system by its discrete Lagrangian; for --retraction cayley a matrix representation closed under (abc + cba)/2",
        MPS,
    )
    .built(),
    planned(
        "moser-veselov",
        "discrete rigid body",
        2,
        [true, false],
        Preserves {
            energy: true,
            ..Preserves::POISSON
        },
        "so(3) with a diagonal quadratic H, or so(n) with H = sum M_ij^2/(2(J_i + J_j))",
        MV,
    )
    .built(),
    planned(
        "compose4",
        "composition of a symmetric method",
        4,
        [true, false],
        Preserves::NOTHING,
        "a symmetric method of order 2",
        KL,
    )
    .built(),
    planned(
        "compose6",
        "composition of a symmetric method",
        6,
        [true, false],
        Preserves::NOTHING,
        "a symmetric method of order 2",
        KL,
    )
    .built(),
    planned(
        "compose8",
        "composition of a symmetric method",
        8,
        [true, false],
        Preserves::NOTHING,
        "a symmetric method of order 2",
        KL,
    )
    .built(),
    planned(
        "generating2",
        "generating function",
        2,
        [true, false],
        Preserves::POISSON,
        RETRACTION,
        GM,
    )
    .built(),
    planned(
        "generating4",
        "generating function",
        4,
        [true, false],
        Preserves::POISSON,
        RETRACTION,
        GM,
    )
    .built(),
    planned(
        "generating6",
        "generating function",
        6,
        [true, false],
        Preserves::POISSON,
        ALGEBRA,
        GM,
    )
    .built(),
    planned(
        "generating-second-kind2",
        "generating function, coordinates of the second kind",
        2,
        [false, false],
        Preserves::POISSON,
        ALGEBRA,
        GM,
    )
    .built(),
    planned(
        "collective2",
        "collective symplectic",
        2,
        [true, false],
        Preserves::POISSON,
        COLLECTIVE,
        COLL,
    )
    .built(),
    planned(
        "collective4",
        "collective symplectic",
        4,
        [true, false],
        Preserves::POISSON,
        COLLECTIVE,
        COLL,
    )
    .built(),
    planned(
        "collective6",
        "collective symplectic",
        6,
        [true, false],
        Preserves::POISSON,
        COLLECTIVE,
        COLL,
    )
    .built(),
    planned(
        "isospectral2",
        "isospectral symplectic Runge–Kutta",
        2,
        [true, false],
        Preserves::POISSON,
        REDUCTIVE,
        MODIN,
    )
    .built(),
    planned(
        "isospectral4",
        "isospectral symplectic Runge–Kutta",
        4,
        [true, false],
        Preserves::POISSON,
        REDUCTIVE,
        MODIN,
    )
    .built(),
    planned(
        "isospectral6",
        "isospectral symplectic Runge–Kutta",
        6,
        [true, false],
        Preserves::POISSON,
        REDUCTIVE,
        MODIN,
    )
    .built(),
    planned(
        "spherical-midpoint",
        "spherical midpoint",
        2,
        [true, false],
        Preserves::POISSON,
        "a direct sum of algebras so(3)",
        MMV,
    )
    .built(),
    planned(
        "splitting1",
        "Lie–Trotter splitting",
        1,
        [false, true],
        Preserves::POISSON,
        SUM,
        MCL,
    )
    .built(),
    planned(
        "splitting2",
        "Strang splitting",
        2,
        [true, true],
        Preserves::POISSON,
        SUM,
        MCL,
    )
    .built(),
    planned(
        "splitting4",
        "Blanes–Moan splitting",
        4,
        [true, true],
        Preserves::POISSON,
        SUM,
        BM,
    )
    .built(),
    planned(
        "splitting6",
        "Blanes–Moan splitting",
        6,
        [true, true],
        Preserves::POISSON,
        SUM,
        BM,
    )
    .built(),
    planned(
        "splitting8",
        "composed splitting",
        8,
        [true, true],
        Preserves::POISSON,
        SUM,
        MCL,
    )
    .built(),
    planned(
        "gonzalez",
        "midpoint discrete gradient",
        2,
        [true, false],
        Preserves::ENERGY,
        ANY,
        DG,
    )
    .built(),
    planned(
        "mean-value",
        "mean-value discrete gradient",
        2,
        [true, false],
        Preserves::ENERGY,
        ANY,
        DG,
    )
    .built(),
    planned(
        "itoh-abe",
        "coordinate-increment discrete gradient",
        2,
        [true, false],
        Preserves::ENERGY,
        ANY,
        DG,
    )
    .built(),
    planned(
        "orbit-energy",
        "orbit- and energy-preserving",
        2,
        [true, false],
        Preserves::ORBIT_ENERGY,
        ALGEBRA,
        EF,
    )
    .built(),
    planned(
        "cohen-hairer2",
        "energy-preserving collocation",
        2,
        [true, false],
        Preserves::ENERGY,
        ANY,
        CH,
    )
    .built(),
    planned(
        "cohen-hairer4",
        "energy-preserving collocation",
        4,
        [true, false],
        Preserves::ENERGY,
        ANY,
        CH,
    )
    .built(),
    planned(
        "cohen-hairer6",
        "energy-preserving collocation",
        6,
        [true, false],
        Preserves::ENERGY,
        ANY,
        CH,
    )
    .built(),
    planned(
        "euler-arnold2",
        "symplectic method on T*G",
        2,
        [true, false],
        Preserves::POISSON,
        "a system on T*G: a group element is declared",
        BRM,
    )
    .built(),
];

/// Ids that are kept for later and have no row in the table yet.
pub const RESERVED: &[&str] = &[
    "taylor",
    "exact",
    "gauss8",
    "gauss10",
    "gauss12",
    "gauss14",
    "gauss16",
    "collective8",
    "collective16",
    "isospectral8",
    "isospectral16",
    "cohen-hairer8",
    "cohen-hairer16",
];
