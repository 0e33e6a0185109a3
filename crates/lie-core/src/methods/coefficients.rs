//! Coefficients of compositions and splittings, by `lab/tools/composition_coefficients.py`.
//!
//! References: M. Suzuki, "Fractal decomposition of exponential operators with applications to many-body
//! theories and Monte Carlo simulations", Physics Letters A 146 (1990) 319–323,
//! [doi:10.1016/0375-9601(90)90962-N](https://doi.org/10.1016/0375-9601(90)90962-N); H. Yoshida,
//! "Construction of higher order symplectic integrators", Physics Letters A 150 (1990) 262–268,
//! [doi:10.1016/0375-9601(90)90092-3](https://doi.org/10.1016/0375-9601(90)90092-3); M. Suzuki,
//! K. Umeno, "Higher-order decomposition theory of exponential operators and its applications to QMC
//! and nonlinear dynamics", Computer Simulation Studies in Condensed-Matter Physics VI, Springer 1993,
//! 74–86, [doi:10.1007/978-3-642-78448-4_7](https://doi.org/10.1007/978-3-642-78448-4_7); W. Kahan,
//! R.-C. Li, "Composition constants for raising the orders of unconventional schemes for ordinary
//! differential equations", Mathematics of Computation 66 (1997) 1089–1099,
//! [doi:10.1090/S0025-5718-97-00873-9](https://doi.org/10.1090/S0025-5718-97-00873-9); S. Blanes,
//! P. C. Moan, "Practical symplectic partitioned Runge–Kutta and Runge–Kutta–Nyström methods", Journal
//! of Computational and Applied Mathematics 142 (2002) 313–330,
//! [doi:10.1016/S0377-0427(01)00492-7](https://doi.org/10.1016/S0377-0427(01)00492-7); R. I. McLachlan,
//! "Composition methods in the presence of small parameters", BIT 35 (1995) 258–268,
//! [doi:10.1007/BF01951548](https://doi.org/10.1007/BF01951548); J. Laskar, P. Robutel, "High order symplectic
//! integrators for perturbed Hamiltonian systems", Celestial Mechanics and Dynamical Astronomy 80 (2001)
//! 39–62, [doi:10.1023/A:1012098603882](https://doi.org/10.1023/A:1012098603882).

use crate::scalar::Scalar;

/// Every scheme: its name as an option, and its coefficients by order. The first of those that a method may have is its
/// default. `Sweeps` are of splittings alone; `near` marks those for two pieces of which one is small.
macro_rules! schemes {
    ($(
        $(#[$doc:meta])*
        $scheme:ident = $name:literal $($near:ident)? { $($order:literal $kind:ident $steps:ident),+ };
    )+) => {
        /// The coefficients of a composition or a splitting.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Scheme {
            $($(#[$doc])* $scheme,)+
        }

        impl Scheme {
            /// Every scheme.
            pub const ALL: &'static [Self] = &[$(Self::$scheme),+];

            /// The scheme as an option spells it.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$scheme => $name,)+
                }
            }

            /// Whether it is for two pieces of which one is small.
            pub const fn is_near_integrable(self) -> bool {
                match self {
                    $(Self::$scheme => { let near: &[&str] = &[$(stringify!($near))?]; !near.is_empty() })+
                }
            }

            const fn steps(self, order: u32) -> Option<Steps> {
                match (self, order) {
                    $($((Self::$scheme, $order) => Some(Steps::$kind(&$steps)),)+)+
                    _ => None,
                }
            }
        }
    };
}

/// The first half of the steps of a scheme, whose second half is the mirror image.
#[derive(Clone, Copy)]
enum Steps {
    /// Steps of a symmetric method of order 2, the middle included.
    Composition(&'static [Parts]),
    /// Sweeps of a splitting, forwards and backwards in turn.
    Sweeps(&'static [Parts]),
}

schemes! {
    /// For splittings alone: order 4 with 6 stages (S6), order 6 with 10 stages (S10).
    BlanesMoan = "blanes-moan" { 4 Sweeps BLANES_MOAN_4, 6 Sweeps BLANES_MOAN_6 };
    /// Order 6 with 9 stages, order 8 with 17 stages.
    KahanLi = "kahan-li" { 6 Composition KAHAN_LI_6, 8 Composition KAHAN_LI_8 };
    /// Order 8 with 15 stages.
    SuzukiUmeno = "suzuki-umeno" { 8 Composition SUZUKI_UMENO_8 };
    /// Order 6 with 7 stages, solution A of Yoshida.
    Yoshida = "yoshida" { 6 Composition YOSHIDA_6 };
    /// Suzuki's five stages with `1/(4 - 4^(1/3))`; of order 6, five times those.
    Suzuki = "suzuki" { 4 Composition SUZUKI_4, 6 Composition SUZUKI_6 };
    /// Three stages with `1/(2 - 2^(1/3))`; of order 6, three times those. Its stages are long: a
    /// cheap step with a large error.
    TripleJump = "triple-jump" { 4 Composition TRIPLE_JUMP_4, 6 Composition TRIPLE_JUMP_6 };
    /// For splittings alone: order 2, two sweeps.
    Strang = "strang" { 2 Sweeps STRANG };
    /// For a splitting into A, the first piece, and a small B: order 2, two stages, Gauss nodes, `O(e h^4 + e^2 h^2)`.
    Saba2 = "saba2" near { 2 Sweeps SABA_2 };
    /// The same with four stages, `O(e h^8 + e^2 h^2)`.
    Saba4 = "saba4" near { 2 Sweeps SABA_4 };
    /// For a splitting into a small A, the first piece, and B: order 2, two stages, Lobatto nodes, `O(e h^4 + e^2 h^2)`.
    Sbab2 = "sbab2" near { 2 Sweeps SBAB_2 };
    /// The same with four stages, `O(e h^8 + e^2 h^2)`.
    Sbab4 = "sbab4" near { 2 Sweeps SBAB_4 };
    /// For a splitting into A, the first piece, and a small B: order 4, five stages, `O(e h^8 + e^2 h^4)`.
    McLachlan84 = "mclachlan-8-4" near { 4 Sweeps MCLACHLAN_84 };
}

/// High and low part of a coefficient; the sum is good to 100 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parts(f64, f64);

impl Parts {
    /// The coefficient.
    pub(super) fn number<S: Scalar>(self) -> S {
        S::constant(self.0, self.1)
    }

    pub(super) const ONE: Self = Self(1.0, 0.0);
    pub(super) const HALF: Self = Self(0.5, 0.0);
}

impl Scheme {
    /// The steps of a composition of symmetric steps of order 2: the first half, the middle included. None if there is no
    /// such scheme.
    pub(super) const fn composition(self, order: u32) -> Option<&'static [Parts]> {
        match self.steps(order) {
            Some(Steps::Composition(steps)) => Some(steps),
            _ => None,
        }
    }

    /// The sweeps of a splitting of its own, forwards and backwards in turn: the first half of an even number.
    pub(super) const fn sweeps(self, order: u32) -> Option<&'static [Parts]> {
        match self.steps(order) {
            Some(Steps::Sweeps(steps)) => Some(steps),
            _ => None,
        }
    }

    /// The schemes of a composition of an order, the default first.
    pub fn of_composition(order: u32) -> impl Iterator<Item = Self> + Clone {
        let all = Self::ALL.iter().copied();
        all.filter(move |scheme| scheme.composition(order).is_some())
    }

    /// The schemes of a splitting of an order, the default first.
    pub fn of_splitting(order: u32) -> impl Iterator<Item = Self> + Clone {
        let all = Self::ALL.iter().copied();
        all.filter(move |scheme| scheme.steps(order).is_some())
    }

    /// The default of a composition of an order.
    pub(super) const fn default_of_composition(order: u32) -> Self {
        let mut place = 0;
        while Self::ALL[place].composition(order).is_none() {
            place += 1;
        }
        Self::ALL[place]
    }

    /// The default of a splitting of an order; none of order 1.
    pub(super) const fn default_of_splitting(order: u32) -> Option<Self> {
        let mut place = 0;
        while place < Self::ALL.len() {
            if Self::ALL[place].steps(order).is_some() {
                return Some(Self::ALL[place]);
            }
            place += 1;
        }
        None
    }
}

const TRIPLE_JUMP_4: [Parts; 2] = [
    Parts(1.3512071919596575, 8.42741775545176e-17),
    Parts(-1.7024143839193153, 5.349624981599612e-17),
];
const SUZUKI_4: [Parts; 3] = [
    Parts(0.4144907717943757, 2.5197374150855977e-17),
    Parts(0.4144907717943757, 2.5197374150855977e-17),
    Parts(-0.657963087177503, 1.023280585909174e-17),
];
const TRIPLE_JUMP_6: [Parts; 5] = [
    Parts(1.587224927722243, -4.939464866311627e-17),
    Parts(-1.9997780973551225, -4.359357947937653e-17),
    Parts(1.587224927722243, -4.939464866311627e-17),
    Parts(-1.8232426634848282, -3.8981130044281167e-17),
    Parts(2.29714181079093, -8.136119615028214e-17),
];
const SUZUKI_6: [Parts; 13] = [
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(-0.2454635437358147, 8.378198458016198e-18),
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(-0.2454635437358147, 8.378198458016198e-18),
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(0.15463234286727187, 6.0135023819025505e-18),
    Parts(-0.20403859967471177, 1.1433646232457761e-18),
    Parts(-0.20403859967471177, 1.1433646232457761e-18),
    Parts(0.3238910877657558, -2.3279987972973054e-17),
];
const YOSHIDA_6: [Parts; 4] = [
    Parts(0.7845136104775573, -3.5563524748377886e-17),
    Parts(0.23557321335935813, 3.570263965698029e-18),
    Parts(-1.177679984178871, -2.0335583675283312e-17),
    Parts(1.3151863206839112, 4.9146537684668507e-17),
];
const KAHAN_LI_6: [Parts; 5] = [
    Parts(0.3921614440073141, 1.982609470119188e-17),
    Parts(0.33259913678935943, 9.998816861901094e-18),
    Parts(-0.7062461725576393, -3.0817257968634285e-17),
    Parts(0.0822135962935508, 5.551218882364133e-18),
    Parts(0.79854399093483, -9.117744953645643e-18),
];
const SUZUKI_UMENO_8: [Parts; 8] = [
    Parts(0.741670364350613, -5.148655304931061e-19),
    Parts(-0.4091008258000316, 3.8036097257781035e-18),
    Parts(0.1907547102962384, -8.968542237625456e-18),
    Parts(-0.5738624711160822, -2.6626178221869147e-17),
    Parts(0.2990641813036559, 5.6129646959270855e-18),
    Parts(0.33462491824529816, 1.9697115983221028e-17),
    Parts(0.3152930923967666, -1.994874881186706e-17),
    Parts(-0.7968879393529164, -1.6218624374007235e-18),
];
const KAHAN_LI_8: [Parts; 9] = [
    Parts(0.13020248308889007, 1.1160926480849635e-17),
    Parts(0.5611629817751084, 1.303259411965714e-17),
    Parts(-0.38947496264484727, -1.960641655404629e-17),
    Parts(0.1588419065551556, 7.801358339164295e-18),
    Parts(-0.39590389413323757, -1.126979043468229e-17),
    Parts(0.1845396409783157, -3.914442027328778e-18),
    Parts(0.25837438768632204, 9.400318801532906e-18),
    Parts(0.2950117236093103, 2.6483903317120415e-17),
    Parts(-0.6055085338300346, 4.4845398377981585e-17),
];
const BLANES_MOAN_4: [Parts; 6] = [
    Parts(0.07920369643119567, 2.9395229566172393e-18),
    Parts(0.13031141018216635, -2.1255732086060005e-18),
    Parts(0.22286149586760765, -8.542020914331025e-18),
    Parts(-0.3667132690474256, -1.7559704520212816e-17),
    Parts(0.32464818868970613, -2.0202677257805526e-17),
    Parts(0.10968847787674987, 3.857089520894759e-18),
];
const BLANES_MOAN_6: [Parts; 10] = [
    Parts(0.050262764400392686, 2.9487298057731478e-19),
    Parts(0.09855368350065055, -5.930056594696677e-18),
    Parts(0.3149606169276933, -1.2944340912093354e-17),
    Parts(-0.44734648269547694, 2.693518927303705e-17),
    Parts(0.492426372489875, 4.578605096857399e-18),
    Parts(-0.42511876779769053, 1.1819107900817071e-17),
    Parts(0.2370639139781216, 7.918240555404807e-18),
    Parts(0.195602488600052, -8.216567118626383e-18),
    Parts(0.34635818985072814, 6.353406242375e-18),
    Parts(-0.3627627792543458, 1.776379990369837e-17),
];
const STRANG: [Parts; 1] = [Parts(0.5, 0.0)];
const SABA_2: [Parts; 2] = [
    Parts(0.2113248654051871, 1.1030435245950743e-17),
    Parts(0.28867513459481287, 1.6725140369678172e-17),
];
const SABA_4: [Parts; 4] = [
    Parts(0.06943184420297371, -1.3430706493351195e-18),
    Parts(0.10449557836575321, 5.17323884370984e-18),
    Parts(0.15608205563884495, -7.57582904785581e-18),
    Parts(0.16999052179242813, 3.745660853481089e-18),
];
const SBAB_2: [Parts; 2] = [
    Parts(0.16666666666666666, 9.25185853854297e-18),
    Parts(0.3333333333333333, 1.850371707708594e-17),
];
const SBAB_4: [Parts; 4] = [
    Parts(0.05, -2.7755575615628915e-18),
    Parts(0.12267316464601143, 1.9853965172945736e-18),
    Parts(0.1495490575762108, 7.574857305866497e-18),
    Parts(0.17777777777777778, -6.784696261598179e-18),
];
const MCLACHLAN_84: [Parts; 5] = [
    Parts(0.07534696026989289, -1.8885378876530202e-18),
    Parts(0.11487897910378374, -6.8410054278198655e-18),
    Parts(0.40303787558447307, -1.9461384554608393e-17),
    Parts(0.4434861948590532, -1.2104251869325211e-17),
    Parts(-0.5367500098172029, 1.2539604123777578e-17),
];

#[cfg(test)]
mod tests {
    use super::*;
    use Scheme::{
        BlanesMoan, KahanLi, McLachlan84, Saba2, Saba4, Sbab2, Sbab4, Strang, Suzuki, SuzukiUmeno,
        TripleJump, Yoshida,
    };

    /// Sum of powers of the steps of a composition, and of their absolute values.
    fn sums(half: &[Parts], power: i32) -> (f64, f64) {
        let mirrored = half.iter().chain(half.iter().rev().skip(1));
        mirrored.fold((0.0, 0.0), |(sum, size), parts| {
            let term = parts.number::<f64>().powi(power);
            (sum + term, size + term.abs())
        })
    }

    #[test]
    fn odd_powers_cancel_below_the_order() {
        let schemes = [
            (Suzuki, 4, 5),
            (TripleJump, 4, 3),
            (Suzuki, 6, 25),
            (TripleJump, 6, 9),
            (Yoshida, 6, 7),
            (KahanLi, 6, 9),
            (KahanLi, 8, 17),
            (SuzukiUmeno, 8, 15),
        ];
        for (scheme, order, stages) in schemes {
            let half = scheme.composition(order).expect("a scheme of that order");
            assert_eq!(2 * half.len() - 1, stages);
            let (sum, size) = sums(half, 1);
            assert!((sum - 1.0).abs() < 1e-16 * size, "{scheme:?} {order}");
            for power in (3..order as i32).step_by(2) {
                let (sum, size) = sums(half, power);
                let loss = sum.abs() / size;
                assert!(loss < 1e-15, "{scheme:?} {order}, power {power}: {loss:e}");
            }
            assert!(sums(half, order as i32 + 1).0.abs() > 1e-6);
        }
        assert_eq!(Yoshida.composition(4), None);
        assert_eq!(BlanesMoan.composition(4), None);
    }

    #[test]
    fn sweeps_cover_one_step() {
        let schemes = [
            (BlanesMoan, 4, 6),
            (BlanesMoan, 6, 10),
            (Strang, 2, 1),
            (Saba2, 2, 2),
            (Saba4, 2, 4),
            (Sbab2, 2, 2),
            (Sbab4, 2, 4),
            (McLachlan84, 4, 5),
        ];
        for (scheme, order, stages) in schemes {
            let half = scheme.sweeps(order).expect("a scheme of that order");
            assert_eq!(half.len(), stages);
            let sum: f64 = half.iter().map(|parts| 2.0 * parts.number::<f64>()).sum();
            assert!((sum - 1.0).abs() < 5e-16, "{scheme:?}: {sum}");
        }
    }

    /// The conditions on the terms with one B: quadrature of the functions up to a degree, at the times at which B acts.
    #[test]
    fn near_integrable_schemes_are_quadratures() {
        let schemes = [
            (Saba2, 2, 4, false),
            (Saba4, 2, 8, false),
            (Sbab2, 2, 4, true),
            (Sbab4, 2, 8, true),
            (McLachlan84, 4, 8, false),
        ];
        for (scheme, order, exact, b_first) in schemes {
            let half = scheme.sweeps(order).expect("a scheme of that order");
            let sizes: Vec<f64> = half.iter().map(|parts| parts.number()).collect();
            let all = sizes.iter().chain(sizes.iter().rev()).copied();
            let all: Vec<f64> = all.collect();
            // the flows in turn, those of the first piece at even places
            let mut flows = vec![all[0]];
            flows.extend(all.windows(2).map(|pair| pair[0] + pair[1]));
            flows.push(all[all.len() - 1]);
            let defect = |power: i32| {
                let (mut time, mut sum) = (0.0_f64, 0.0_f64);
                for (place, flow) in flows.iter().enumerate() {
                    if (place % 2 == 0) == b_first {
                        sum += flow * time.powi(power);
                    } else {
                        time += flow;
                    }
                }
                (sum - 1.0 / f64::from(power + 1)).abs()
            };
            for power in 0..exact {
                assert!(defect(power) < 1e-15, "{scheme:?}: power {power}");
            }
            // the control: no further
            assert!(defect(exact) > 1e-6, "{scheme:?}: {}", defect(exact));
        }
    }
}
