//! The catalogue: one row for each id of the list of methods. What is known of a method stands in its type.

use lie_core::methods::{self as m, Facts, Preserves};

use super::Method;

const ANY: &str = "any Poisson system";
const ALGEBRA: &str = "any Lie algebra";
const RETRACTION: &str =
    "any Lie algebra (exp), a matrix representation closed under (abc + cba)/2 (cayley)";
const MIDPOINT: &str = "any Lie algebra (exp), a matrix representation closed under (abc + cba)/2 (cayley), a declared retraction (spec)";
const DISCRETE: &str = "a system given by its discrete Lagrangian; for --retraction cayley a matrix representation closed under (abc + cba)/2";
const LAGRANGIAN: &str = "a system given by its Lagrangian; for --retraction cayley a matrix representation closed under (abc + cba)/2, for --retraction spec a declared retraction";
const REDUCTIVE: &str =
    "a matrix representation closed under (abc + cba)/2, up to matrices that commute with it";
const COLLECTIVE: &str = "a matrix representation closed under (abc + cba)/2, up to matrices that commute with it; with --lift hopf a direct sum of algebras so(3)";

const LINEAR: &str = "a direct sum of algebras so(3) (hopf), so(3) with vectors such as se(3) (quaternion), anti-Hermitian matrices such as those of su(n) and u(n) (unitary), else a matrix representation closed under (abc + cba)/2, up to matrices that commute with it";
const SPINS: &str = "a direct sum of algebras so(3)";
const EXPRESSION: &str = "a Hamiltonian with an expression";
const NOISE: &str = "any Lie algebra, noise along constant directions";
const CANONICAL: &str = "a bracket of pairs {x, y} = 1/B(x, y) with a closed integral of B, of {x_i, x_j} = c_ij a_i(x_i) a_j(x_j) with closed integrals of 1/a_i, and constant ones";
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
const NV: &str = "Ninomiya, Victoir (2008), 10.1080/13504860701413958";
const JZ: &str = "Jorba, Zou (2005), 10.1080/10586458.2005.10128904";
const CMV: &str = "Cabrera, Martín de Diego, Vaquero (2024), arXiv:2409.04342";
const KL: &str =
    "Suzuki (1990), 10.1016/0375-9601(90)90962-N; Kahan, Li (1997), 10.1090/S0025-5718-97-00873-9";

impl Method {
    /// Whether it moves along coadjoint orbits, and so needs the Lie–Poisson bracket of an algebra. What a splitting needs is looked for on
    /// every bracket.
    pub(super) fn needs_algebra(&self) -> bool {
        ![ANY, EXPRESSION, SUM, CANONICAL].contains(&self.needs)
    }
}

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
        forces: M::FORCES,
        damping: M::DAMPING,
        needs,
        reference,
    }
}

macro_rules! catalogue {
    (
        {} choices $choices:tt
        $({ $title:literal $needs:tt $reference:tt $($choice:tt $type:tt $value:tt $how:tt)+ })+
    ) => {
        /// Every method.
        pub const CATALOGUE: &[Method] = &[
            $(catalogue!(@row $title $needs $reference $($type)+)),+
        ];
    };
    (@row $title:tt $needs:tt $reference:tt [$name:ident $(<$($argument:ident),+>)?] $($others:tt)*) => {
        row::<m::$name $(<$(m::$argument),+>)?>($title, $needs, $reference)
    };
}
lie_core::for_each_method!(catalogue! {});

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
