//! The one list of methods: which type, which generic equation and which options belong to an id.
//!
//! It is expanded by [`generic_equations!`](crate::generic_equations), by the compiler for its catalogue and for the text of
//! generated code, and by the systems that are made at run time, so that none of them can forget a method.

/// Gives the list of methods to a macro: `for_each_method!(callback! { … })` becomes
/// `callback! { { … } choices { … } rows }`.
///
/// First come the variants of an enum, a method with its options, then the ids in the order of the catalogue: title, what a
/// system must have, reference, and a row for each combination of options that is a type of its own, the default first. The
/// names of what is needed and of references are constants of the compiler's catalogue (`methods/table.rs`).
///
/// ```text
/// [choice] [type] [value] { what is particular [key carrier equation] }
/// ```
///
/// The equation is generic over systems; `key` names it in [`generic_equations!`](crate::generic_equations), and the
/// carrier says which systems have it: `Any`, those of an `Algebra`, with a `Closed` representation, … It is
///
/// * `Name`, `Name 2` with stages, `Name of Gradient` along a discrete gradient, `Name along Function` of a generating
///   function: a type of [`generic`](crate::generic);
/// * `same Type`: that of the method of this type.
///
/// Particular are: `explicit`, the step is a function of the state alone; `tolerances`, the value is made from
/// [`Tolerances`](crate::methods::Tolerances); `smallest`, the space depends on the system; `splitting` and `compose`, which
/// have [schemes](crate::methods::Scheme) too.
#[doc(hidden)]
#[macro_export]
macro_rules! for_each_method {
    ($then:ident! { $($context:tt)* }) => {
        $then! {
            { $($context)* }
            choices {
                /// `midpoint`
                Midpoint,
                /// `gauss4`, `gauss6` to `gauss16`: Gauss collocation with that many stages.
                Gauss(usize),
                /// `lie-midpoint`
                LieMidpoint(Retraction),
                /// `lie-euler`
                LieEuler,
                /// `rkmk2`, `rkmk3`, `rkmk4`, `rkmk6`
                Rkmk(u32),
                /// `cg3`
                CrouchGrossman3,
                /// `cf4`
                CommutatorFree4,
                /// `variational2`, `variational4`, `variational6`; of reduced Lagrangians only the first has another retraction than exp.
                Variational(u32, Retraction),
                /// `discrete-euler-poincare`
                DiscreteEulerPoincare(Retraction),
                /// `moser-veselov`
                MoserVeselov,
                /// `compose4(ID)`, `compose6(ID)`, `compose8(ID)` of a symmetric method of order 2.
                Compose(u32, Scheme, Box<Choice>),
                /// `generating2`, `generating4`, `generating6`
                Generating(u32, Retraction),
                /// `generating-second-kind2`
                GeneratingSecondKind2,
                /// `collective2` to `collective16`
                Collective(u32, Lift),
                /// `isospectral2` to `isospectral16`
                Isospectral(u32),
                /// `euler-arnold2`
                EulerArnold2,
                /// `spherical-midpoint`
                SphericalMidpoint,
                /// `splitting1`, `splitting2`, `splitting4`, `splitting6`, `splitting8`; of order 1 the
                /// scheme means nothing.
                Splitting(u32, Scheme, Pieces),
                /// `ninomiya-victoir`
                NinomiyaVictoir,
                /// `gonzalez`, `mean-value`, `itoh-abe`
                DiscreteGradient(Gradient, Tensor),
                /// `orbit-energy`
                OrbitEnergy(Gradient),
                /// `k-hj2`, `k-hj4`, `k-hj6`
                HamiltonJacobi(u32),
                /// `canonical2`, `canonical4`, `canonical6`
                Canonical(u32),
                /// `cohen-hairer2`, `cohen-hairer4` to `cohen-hairer16`
                CohenHairer(u32),
                /// `exact`
                Exact,
                /// `rk4`
                Rk4,
                /// `dopri5`; its tolerances are arguments of the program.
                Dopri5,
                /// `taylor`; its tolerance is an argument of the program.
                Taylor,
                /// `lie-taylor`; its tolerance is an argument of the program.
                LieTaylor,
            }
            { "Poisson midpoint rule" ANY AKW
                [Midpoint] [ImplicitMidpoint] [ImplicitMidpoint] { [midpoint Any Midpoint] } }
            { "Gauss collocation, 2 stages" ANY HLW
                [Gauss(2)] [Gauss4] [Gauss4] { [gauss4 Any Gauss 2] } }
            { "Gauss collocation, 3 stages" ANY HLW
                [Gauss(3)] [Gauss6] [Gauss6] { [gauss6 Any Gauss 3] } }
            { "stage-parallel Gauss collocation" ANY HLW
                [Gauss(4)] [Gauss8] [Gauss8] {} }
            { "stage-parallel Gauss collocation" ANY HLW
                [Gauss(5)] [Gauss10] [Gauss10] {} }
            { "stage-parallel Gauss collocation" ANY HLW
                [Gauss(6)] [Gauss12] [Gauss12] {} }
            { "stage-parallel Gauss collocation" ANY HLW
                [Gauss(7)] [Gauss14] [Gauss14] {} }
            { "stage-parallel Gauss collocation" ANY HLW
                [Gauss(8)] [Gauss16] [Gauss16] {} }
            { "retraction Lie–Poisson integrator" MIDPOINT MPS
                [LieMidpoint(Retraction::Exp)] [LieMidpoint<Exp>] [LieMidpoint::exp()] { [exp Algebra ExpMidpoint] }
                [LieMidpoint(Retraction::Cayley)] [LieMidpoint<Cayley>] [LieMidpoint::cayley()] { [cayley Closed CayleyMidpoint] }
                [LieMidpoint(Retraction::Spec)] [LieMidpoint<Declared>] [LieMidpoint::declared()] { [retraction Retraction DeclaredMidpoint] } }
            { "classical Runge–Kutta method (control)" ANY "Kutta (1901)"
                [Rk4] [Rk4] [Rk4] { explicit } }
            { "Dormand–Prince pair with step control (control)" ANY "Dormand, Prince (1980), 10.1016/0771-050X(80)90013-3"
                [Dopri5] [Dopri5] [Dopri5] { tolerances } }
            { "Taylor series, order and step from a tolerance" EXPRESSION JZ
                [Taylor] [Taylor] [Taylor] { tolerances } }
            { "Taylor series in the algebra, order and step from a tolerance" "any Lie algebra, a Hamiltonian with an expression" JZ
                [LieTaylor] [LieTaylor] [LieTaylor] { tolerances } }
            { "Lie–Euler" ALGEBRA MK
                [LieEuler] [LieEuler] [LieEuler] { explicit } }
            { "Runge–Kutta–Munthe-Kaas" ALGEBRA MK
                [Rkmk(2)] [Rkmk2] [Rkmk2] { explicit } }
            { "Runge–Kutta–Munthe-Kaas" ALGEBRA MK
                [Rkmk(3)] [Rkmk3] [Rkmk3] { explicit } }
            { "Runge–Kutta–Munthe-Kaas" ALGEBRA MK
                [Rkmk(4)] [Rkmk4] [Rkmk4] { explicit } }
            { "Runge–Kutta–Munthe-Kaas" ALGEBRA MK
                [Rkmk(6)] [Rkmk6] [Rkmk6] { explicit } }
            { "Crouch–Grossman" ALGEBRA CROUCH
                [CrouchGrossman3] [CrouchGrossman3] [CrouchGrossman3] { explicit } }
            { "commutator-free" ALGEBRA CMO
                [CommutatorFree4] [CommutatorFree4] [CommutatorFree4] { explicit } }
            { "variational integrator (discrete Euler–Poincaré)" LAGRANGIAN MPS
                [Variational(2, Retraction::Exp)] [Variational2<Exp>] [Variational2::exp()] { [variational2 Lagrangian ExpVariational] [variational2_on_group LagrangianOnGroup GalerkinOnGroup 1] }
                [Variational(2, Retraction::Cayley)] [Variational2<Cayley>] [Variational2::cayley()] { [variational_cayley ClosedLagrangian CayleyVariational] [variational2_cayley ClosedLagrangianOnGroup GalerkinCayley 1] }
                [Variational(2, Retraction::Spec)] [Variational2<Declared>] [Variational2::declared()] { [variational2_declared RetractedLagrangian same LieMidpoint<Declared>] } }
            { "variational integrator (Lie-group Galerkin)" "a system given by its Lagrangian; for --retraction cayley one with the group element, the time or something that acts in it, and a matrix representation closed under (abc + cba)/2" LEOK
                [Variational(4, Retraction::Exp)] [Variational4<Exp>] [Variational4::exp()] { [variational4 Lagrangian GalerkinStep 2] [variational4_on_group LagrangianOnGroup GalerkinOnGroup 2] }
                [Variational(4, Retraction::Cayley)] [Variational4<Cayley>] [Variational4::cayley()] { [variational4_cayley ClosedLagrangianOnGroup GalerkinCayley 2] } }
            { "variational integrator (Lie-group Galerkin)" "a system given by its Lagrangian; for --retraction cayley one with the group element, the time or something that acts in it, and a matrix representation closed under (abc + cba)/2" LEOK
                [Variational(6, Retraction::Exp)] [Variational6<Exp>] [Variational6::exp()] { [variational6 Lagrangian GalerkinStep 3] [variational6_on_group LagrangianOnGroup GalerkinOnGroup 3] }
                [Variational(6, Retraction::Cayley)] [Variational6<Cayley>] [Variational6::cayley()] { [variational6_cayley ClosedLagrangianOnGroup GalerkinCayley 3] } }
            { "step of a declared discrete Lagrangian; its order is at least 1" DISCRETE MPS
                [DiscreteEulerPoincare(Retraction::Exp)] [DiscreteEulerPoincare<Exp>] [DiscreteEulerPoincare::exp()] { [discrete DiscreteLagrangian ExpDiscrete] }
                [DiscreteEulerPoincare(Retraction::Cayley)] [DiscreteEulerPoincare<Cayley>] [DiscreteEulerPoincare::cayley()] { [discrete_cayley ClosedDiscreteLagrangian CayleyDiscrete] } }
            { "discrete rigid body" "so(3) with a quadratic H, or so(n) with M = J W + W J for W = grad H(M)" MV
                [MoserVeselov] [MoserVeselov] [MoserVeselov] { [moser_veselov Body DiscreteTop] [moser_veselov_n BodyOfMany DiscreteBody] } }
            { "composition of a symmetric method" "a symmetric method of order 2" KL
                [Compose(4, Scheme::Suzuki, Box::new(Choice::Midpoint))] [Compose4<ImplicitMidpoint>] [Compose4] { compose } }
            { "composition of a symmetric method" "a symmetric method of order 2" KL
                [Compose(6, Scheme::KahanLi, Box::new(Choice::Midpoint))] [Compose6<ImplicitMidpoint>] [Compose6] { compose } }
            { "composition of a symmetric method" "a symmetric method of order 2" KL
                [Compose(8, Scheme::KahanLi, Box::new(Choice::Midpoint))] [Compose8<ImplicitMidpoint>] [Compose8] { compose } }
            { "generating function" RETRACTION GM
                [Generating(2, Retraction::Exp)] [Generating2<Exp>] [Generating2::exp()] { [generating2 Algebra same LieMidpoint<Exp>] }
                [Generating(2, Retraction::Cayley)] [Generating2<Cayley>] [Generating2::cayley()] { [generating2_cayley Closed same LieMidpoint<Cayley>] } }
            { "generating function" RETRACTION GM
                [Generating(4, Retraction::Exp)] [Generating4<Exp>] [Generating4::exp()] { [generating4 Algebra ExpRetraction along Generating4] }
                [Generating(4, Retraction::Cayley)] [Generating4<Cayley>] [Generating4::cayley()] { [generating4_cayley Closed CayleyRetraction along CayleyGenerating4] } }
            { "generating function" ALGEBRA GM
                [Generating(6, Retraction::Exp)] [Generating6<Exp>] [Generating6::exp()] { [generating6 Algebra ExpRetraction along Generating6] } }
            { "generating function, coordinates of the second kind" ALGEBRA GM
                [GeneratingSecondKind2] [GeneratingSecondKind2] [GeneratingSecondKind2] { [second_kind Algebra SecondKind along SecondKind2] } }
            { "collective symplectic" COLLECTIVE COLL
                [Collective(2, Lift::Representation)] [Collective2<Representation>] [Collective2::representation()] { [collective2 Matrices same Isospectral2] }
                [Collective(2, Lift::Hopf)] [Collective2<Hopf>] [Collective2::hopf()] { [hopf2 Spins QuaternionMomenta 1] }
                [Collective(2, Lift::Spec)] [Collective2<Given>] [Collective2::given()] {} }
            { "collective symplectic" COLLECTIVE COLL
                [Collective(4, Lift::Representation)] [Collective4<Representation>] [Collective4::representation()] { [collective4 Matrices same Isospectral4] }
                [Collective(4, Lift::Hopf)] [Collective4<Hopf>] [Collective4::hopf()] { [hopf4 Spins QuaternionMomenta 2] }
                [Collective(4, Lift::Spec)] [Collective4<Given>] [Collective4::given()] {} }
            { "collective symplectic" COLLECTIVE COLL
                [Collective(6, Lift::Representation)] [Collective6<Representation>] [Collective6::representation()] { [collective6 Matrices same Isospectral6] }
                [Collective(6, Lift::Hopf)] [Collective6<Hopf>] [Collective6::hopf()] { [hopf6 Spins QuaternionMomenta 3] }
                [Collective(6, Lift::Spec)] [Collective6<Given>] [Collective6::given()] {} }
            { "stage-parallel collective symplectic" LINEAR COLL
                [Collective(8, Lift::Smallest)] [Collective8<Smallest>] [Collective8::smallest()] { smallest }
                [Collective(8, Lift::Hopf)] [Collective8<Hopf>] [Collective8::hopf()] {}
                [Collective(8, Lift::Quaternion)] [Collective8<Quaternion>] [Collective8::quaternion()] {}
                [Collective(8, Lift::Unitary)] [Collective8<Unitary>] [Collective8::unitary()] {}
                [Collective(8, Lift::Representation)] [Collective8<Representation>] [Collective8::representation()] {} }
            { "stage-parallel collective symplectic" LINEAR COLL
                [Collective(10, Lift::Smallest)] [Collective10<Smallest>] [Collective10::smallest()] { smallest }
                [Collective(10, Lift::Hopf)] [Collective10<Hopf>] [Collective10::hopf()] {}
                [Collective(10, Lift::Quaternion)] [Collective10<Quaternion>] [Collective10::quaternion()] {}
                [Collective(10, Lift::Unitary)] [Collective10<Unitary>] [Collective10::unitary()] {}
                [Collective(10, Lift::Representation)] [Collective10<Representation>] [Collective10::representation()] {} }
            { "stage-parallel collective symplectic" LINEAR COLL
                [Collective(12, Lift::Smallest)] [Collective12<Smallest>] [Collective12::smallest()] { smallest }
                [Collective(12, Lift::Hopf)] [Collective12<Hopf>] [Collective12::hopf()] {}
                [Collective(12, Lift::Quaternion)] [Collective12<Quaternion>] [Collective12::quaternion()] {}
                [Collective(12, Lift::Unitary)] [Collective12<Unitary>] [Collective12::unitary()] {}
                [Collective(12, Lift::Representation)] [Collective12<Representation>] [Collective12::representation()] {} }
            { "stage-parallel collective symplectic" LINEAR COLL
                [Collective(14, Lift::Smallest)] [Collective14<Smallest>] [Collective14::smallest()] { smallest }
                [Collective(14, Lift::Hopf)] [Collective14<Hopf>] [Collective14::hopf()] {}
                [Collective(14, Lift::Quaternion)] [Collective14<Quaternion>] [Collective14::quaternion()] {}
                [Collective(14, Lift::Unitary)] [Collective14<Unitary>] [Collective14::unitary()] {}
                [Collective(14, Lift::Representation)] [Collective14<Representation>] [Collective14::representation()] {} }
            { "stage-parallel collective symplectic" LINEAR COLL
                [Collective(16, Lift::Smallest)] [Collective16<Smallest>] [Collective16::smallest()] { smallest }
                [Collective(16, Lift::Hopf)] [Collective16<Hopf>] [Collective16::hopf()] {}
                [Collective(16, Lift::Quaternion)] [Collective16<Quaternion>] [Collective16::quaternion()] {}
                [Collective(16, Lift::Unitary)] [Collective16<Unitary>] [Collective16::unitary()] {}
                [Collective(16, Lift::Representation)] [Collective16<Representation>] [Collective16::representation()] {} }
            { "isospectral symplectic Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(2)] [Isospectral2] [Isospectral2::new()] { [momenta2 Reductive MatrixMomenta 1] [momenta2_cayley Closed same LieMidpoint<Cayley>] } }
            { "isospectral symplectic Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(4)] [Isospectral4] [Isospectral4::new()] { [momenta4 Matrices MatrixMomenta 2] } }
            { "isospectral symplectic Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(6)] [Isospectral6] [Isospectral6::new()] { [momenta6 Matrices MatrixMomenta 3] } }
            { "stage-parallel isospectral Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(8)] [Isospectral8] [Isospectral8::new()] {} }
            { "stage-parallel isospectral Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(10)] [Isospectral10] [Isospectral10::new()] {} }
            { "stage-parallel isospectral Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(12)] [Isospectral12] [Isospectral12::new()] {} }
            { "stage-parallel isospectral Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(14)] [Isospectral14] [Isospectral14::new()] {} }
            { "stage-parallel isospectral Runge–Kutta" REDUCTIVE MODIN
                [Isospectral(16)] [Isospectral16] [Isospectral16::new()] {} }
            { "spherical midpoint" SPINS MMV
                [SphericalMidpoint] [SphericalMidpoint] [SphericalMidpoint] { [spherical Spheres Spherical] } }
            { "Lie–Trotter splitting" SUM MCL
                [Splitting(1, Scheme::Suzuki, Pieces::Found)] [Splitting1] [Splitting1::new()] { splitting } }
            { "Strang splitting" SUM MCL
                [Splitting(2, Scheme::Strang, Pieces::Found)] [Splitting2] [Splitting2::new()] { splitting } }
            { "Blanes–Moan splitting" SUM BM
                [Splitting(4, Scheme::BlanesMoan, Pieces::Found)] [Splitting4] [Splitting4::new()] { splitting } }
            { "Blanes–Moan splitting" SUM BM
                [Splitting(6, Scheme::BlanesMoan, Pieces::Found)] [Splitting6] [Splitting6::new()] { splitting } }
            { "composed splitting" SUM MCL
                [Splitting(8, Scheme::KahanLi, Pieces::Found)] [Splitting8] [Splitting8::new()] { splitting } }
            { "Ninomiya–Victoir splitting of noise, weak order 2" NOISE NV
                [NinomiyaVictoir] [NinomiyaVictoir] [NinomiyaVictoir] {} }
            { "midpoint discrete gradient" ANY DG
                [DiscreteGradient(Gradient::Gonzalez, Tensor::Midpoint)] [Gonzalez] [Gonzalez] { [gonzalez Any DiscreteGradientStep of GonzalezGradient] }
                [DiscreteGradient(Gradient::Gonzalez, Tensor::Mean)] [WithTensor<Gonzalez, MeanTensor>] [WithTensor::new(Gonzalez, MeanTensor)] {} }
            { "mean-value discrete gradient" ANY DG
                [DiscreteGradient(Gradient::MeanValue, Tensor::Midpoint)] [MeanValue] [MeanValue] { [mean_value Any DiscreteGradientStep of MeanValueGradient] }
                [DiscreteGradient(Gradient::MeanValue, Tensor::Mean)] [WithTensor<MeanValue, MeanTensor>] [WithTensor::new(MeanValue, MeanTensor)] {} }
            { "coordinate-increment discrete gradient" ANY DG
                [DiscreteGradient(Gradient::ItohAbe, Tensor::Midpoint)] [ItohAbe] [ItohAbe] { [itoh_abe Any DiscreteGradientStep of ItohAbeGradient] }
                [DiscreteGradient(Gradient::ItohAbe, Tensor::Mean)] [WithTensor<ItohAbe, MeanTensor>] [WithTensor::new(ItohAbe, MeanTensor)] {} }
            { "orbit- and energy-preserving" ANY EF
                [OrbitEnergy(Gradient::Gonzalez)] [OrbitEnergy<Gonzalez>] [OrbitEnergy::gonzalez()] { [orbit_gonzalez Algebra OrbitEnergyStep of GonzalezGradient] [frozen_gonzalez Any FrozenStep of GonzalezGradient] }
                [OrbitEnergy(Gradient::MeanValue)] [OrbitEnergy<MeanValue>] [OrbitEnergy::mean_value()] { [orbit_mean_value Algebra OrbitEnergyStep of MeanValueGradient] [frozen_mean_value Any FrozenStep of MeanValueGradient] }
                [OrbitEnergy(Gradient::ItohAbe)] [OrbitEnergy<ItohAbe>] [OrbitEnergy::itoh_abe()] { [orbit_itoh_abe Algebra OrbitEnergyStep of ItohAbeGradient] [frozen_itoh_abe Any FrozenStep of ItohAbeGradient] } }
            { "generating function on a symplectic realization" ANY CMV
                [HamiltonJacobi(2)] [HamiltonJacobi2] [HamiltonJacobi2::new()] { [k_hj2_along_exp Algebra same LieMidpoint<Exp>] [k_hj2 Any RealizationStep along Generating2] } }
            { "generating function on a symplectic realization" ANY CMV
                [HamiltonJacobi(4)] [HamiltonJacobi4] [HamiltonJacobi4::new()] { [k_hj4_along_exp Algebra same Generating4<Exp>] [k_hj4 Any RealizationStep along HamiltonJacobi4] } }
            { "generating function on a symplectic realization" ANY CMV
                [HamiltonJacobi(6)] [HamiltonJacobi6] [HamiltonJacobi6::new()] { [k_hj6_along_exp Algebra same Generating6<Exp>] [k_hj6 Any RealizationStep along HamiltonJacobi6] } }
            { "Gauss collocation in canonical coordinates" CANONICAL HLW
                [Canonical(2)] [Canonical2] [Canonical2] { [canonical2 Canonical CanonicalGauss 2] } }
            { "Gauss collocation in canonical coordinates" CANONICAL HLW
                [Canonical(4)] [Canonical4] [Canonical4] { [canonical4 Canonical CanonicalGauss 3] } }
            { "Gauss collocation in canonical coordinates" CANONICAL HLW
                [Canonical(6)] [Canonical6] [Canonical6] { [canonical6 Canonical CanonicalGauss 4] } }
            { "energy-preserving collocation" ANY CH
                [CohenHairer(2)] [CohenHairer2] [CohenHairer2::new()] { [cohen_hairer2 Any DiscreteGradientStep of MeanValueGradient] } }
            { "energy-preserving collocation" ANY CH
                [CohenHairer(4)] [CohenHairer4] [CohenHairer4::new()] { [cohen_hairer4 Any CohenHairerStep 2] } }
            { "energy-preserving collocation" ANY CH
                [CohenHairer(6)] [CohenHairer6] [CohenHairer6::new()] { [cohen_hairer6 Any CohenHairerStep 3] } }
            { "stage-parallel energy-preserving collocation" ANY CH
                [CohenHairer(8)] [CohenHairer8] [CohenHairer8::new()] {} }
            { "stage-parallel energy-preserving collocation" ANY CH
                [CohenHairer(10)] [CohenHairer10] [CohenHairer10::new()] {} }
            { "stage-parallel energy-preserving collocation" ANY CH
                [CohenHairer(12)] [CohenHairer12] [CohenHairer12::new()] {} }
            { "stage-parallel energy-preserving collocation" ANY CH
                [CohenHairer(14)] [CohenHairer14] [CohenHairer14::new()] {} }
            { "stage-parallel energy-preserving collocation" ANY CH
                [CohenHairer(16)] [CohenHairer16] [CohenHairer16::new()] {} }
            { "exact flow; the order is that of the group element" "so(3), or a sum of such, with a quadratic form H that does not couple them; or H that is linear or contains only coordinates that commute" WW
                [Exact] [Exact] [Exact] {} }
            { "symplectic method on T*G" "a system on T*G: a group element is declared" BRM
                [EulerArnold2] [EulerArnold2] [EulerArnold2] {} }
        }
    };
}
