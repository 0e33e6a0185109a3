//! Systems on `T*G`: the Hamiltonian depends on the group element, and on the time.

use crate::vectors::{Reference, number};
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::integrate;
use lie_runtime::methods::Method;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{CotangentPoisson, Lift, Poisson};

lie_poisson! { pub spec = "specs/so3_cotangent_group.json"; }
lie_poisson! { pub spec = "specs/so3_cotangent_euler_arnold.json"; }

lie_poisson! {
    /// A rigid body under a torque that turns with the time, by its Lagrangian.
    pub system ForcedBody;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    velocity u, v, w;
    parameters { a = 3/10; k = 2; }
    lagrangian = u^2 + v^2/2 + w^2/3 - a*u*cos(k*t);
    casimir C = x^2 + y^2 + z^2;
    initial = [4/5, 1/10, 3/5];
}

/// A few numbers that look random.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn step<P: Poisson<f64>, M: Method<f64, P>>(system: &P, method: &M, h: f64, mu: &mut P::State) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    stepper.step(mu, &mut ()).expect("a step");
}

#[test]
fn the_field_is_that_of_the_twelve_dimensional_form() {
    let group = CotangentBody::new().system().unwrap();
    let flat = CotangentEulerArnold::new().system().unwrap();
    assert_eq!(group.momenta(), 3);
    let mut numbers = Numbers(7);
    for _ in 0..100 {
        let mut mu = group.zero_state();
        mu.as_mut_slice()
            .iter_mut()
            .for_each(|entry| *entry = numbers.next());
        let (mut here, mut there) = (group.zero_state(), group.zero_state());
        group.vector_field(&mu, &mut here);
        flat.vector_field(&mu, &mut there);
        assert!((here - there).amax() < 1e-14);
        assert!((group.hamiltonian(&mu) - flat.hamiltonian(&mu)).abs() < 1e-14);
    }
}

#[test]
fn its_trajectory_is_that_of_the_reference() {
    let reference = Reference::vector("so3_cotangent_euler_arnold");
    let start = CotangentBody::new().initial_state();
    let system = CotangentBody::new().system().unwrap();
    for (time, state) in reference.times().iter().zip(reference.states()) {
        let end = number(&(*time).into());
        let problem = Problem::new(system.clone(), start, (0.0, end));
        let options = Options::new(0.01).save(Save::Ends);
        let solution = solve(&problem, Gauss6, &options).unwrap();
        let (_, mu) = solution.last().unwrap();
        let error = mu
            .iter()
            .zip(&state)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(error < 1e-13, "t = {time}: {error:e}");
    }
}

/// One step from the initial state by a program of its own: momenta, then R by rows.
const STEPS: [(f64, [f64; 12]); 2] = [
    (
        0.1,
        [
            0.493_813_710_645_281_5,
            0.500_040_782_910_385_1,
            -0.601_577_388_301_225_2,
            0.569_626_380_502_036_1,
            0.064_703_774_563_631_42,
            0.819_352_920_415_475_6,
            -0.059_243_036_483_998_285,
            0.997_535_661_897_684,
            -0.037_588_108_099_576_49,
            -0.819_765_850_267_2,
            -0.027_129_776_990_763_525,
            0.572_055_876_585_606_2,
        ],
    ),
    (
        -0.2,
        [
            0.506_944_296_472_026_3,
            0.209_637_671_197_979_16,
            -0.612_081_923_626_506_7,
            0.629_653_260_036_504_1,
            -0.132_951_625_220_159_5,
            0.765_415_336_583_165_7,
            0.121_476_076_936_621_67,
            0.989_977_542_078_558_9,
            0.072_027_973_122_830_09,
            -0.767_320_229_667_829_5,
            0.047_627_004_224_635_165,
            0.639_493_028_586_782_9,
        ],
    ),
];

#[test]
fn a_step_is_the_second_half_after_the_first() {
    let body = CotangentBody::new();
    let system = body.system().unwrap();
    for (h, expected) in STEPS {
        let mut mu = body.initial_state();
        step(&system, &EulerArnold2, h, &mut mu);
        let error = mu
            .iter()
            .zip(&expected)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(error < 1e-15, "h = {h}: {error:e}");
        let mut other = body.initial_state();
        step(&system, &LieMidpoint::exp(), h, &mut other);
        assert!((mu - other).amax() > 1e-6, "another method");
    }
}

/// The largest entry of `D^T Omega(mu1) D - Omega(mu)` for the tangent map D of a step in left
/// trivialisation, `omega((x1, n1), (x2, n2)) = <n2, x1> - <n1, x2> + <mu, [x1, x2]>`.
fn symplectic_defect<M>(method: &M, h: f64) -> f64
where
    M: Method<f64, CotangentBodySystem> + Method<Dual<f64>, CotangentBodySystem<Dual<f64>>>,
{
    let body = CotangentBody::new();
    let system = body.system().unwrap();
    let lifted = system.lift();
    let mu = body.initial_state();
    let mut end = mu;
    step(&system, method, h, &mut end);
    let mut tangent = [[0.0; 6]; 6];
    let hat = |k: usize, i: usize, j: usize| -> f64 {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        if (i, j) == (b, a) {
            1.0
        } else if (i, j) == (a, b) {
            -1.0
        } else {
            0.0
        }
    };
    #[expect(clippy::needless_range_loop, reason = "columns of the tangent map")]
    for column in 0..6 {
        let mut state = lifted.zero_state();
        for index in 0..12 {
            let mut slope = f64::from(u8::from(column >= 3 && index == column - 3));
            if column < 3 && index >= 3 {
                // (g (1 + s e_k))_ij
                let (i, j) = ((index - 3) / 3, (index - 3) % 3);
                slope = (0..3).map(|l| mu[3 + 3 * i + l] * hat(column, l, j)).sum();
            }
            state[index] = Dual::new(mu[index], slope);
        }
        let mut stepper = method.stepper(&lifted, Dual::from_f64(h), &NewtonOptions::default());
        stepper.step(&mut state, &mut ()).expect("a step");
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            tangent[k][column] = (0..3)
                .map(|l| end[3 + 3 * l + b] * state[3 + 3 * l + a].derivative)
                .sum();
            tangent[3 + k][column] = state[k].derivative;
        }
    }
    let form = |mu: &[f64]| {
        let mut omega = [[0.0; 6]; 6];
        for i in 0..3 {
            for (j, entry) in omega[i][..3].iter_mut().enumerate() {
                *entry = (0..3).map(|k| mu[k] * hat(k, j, i)).sum::<f64>();
            }
            omega[i][3 + i] = 1.0;
            omega[3 + i][i] = -1.0;
        }
        omega
    };
    let (before, after) = (form(mu.as_slice()), form(end.as_slice()));
    let mut largest = 0.0_f64;
    for i in 0..6 {
        for j in 0..6 {
            let mut sum = -before[i][j];
            for (k, row) in after.iter().enumerate() {
                for (l, entry) in row.iter().enumerate() {
                    sum += tangent[k][i] * entry * tangent[l][j];
                }
            }
            largest = largest.max(sum.abs());
        }
    }
    largest
}

#[test]
fn the_symplectic_form_is_kept() {
    for h in [0.1, 0.5, -0.3] {
        let defect = symplectic_defect(&EulerArnold2, h);
        assert!(defect < 4e-15, "h = {h}: {defect:e}");
        assert!(symplectic_defect(&Compose4::new(EulerArnold2), h) < 2e-14);
        assert!(symplectic_defect(&LieMidpoint::exp(), h) < 4e-15);
        // controls: the same measurement on methods that do not keep it
        assert!(symplectic_defect(&Rk4, h) > 1e-8, "h = {h}");
        assert!(symplectic_defect(&ImplicitMidpoint, h) > 1e-6, "h = {h}");
    }
}

#[test]
fn the_group_element_stays_in_the_group_and_the_energy_near() {
    let body = CotangentBody::new();
    let system = body.system().unwrap();
    let run = |steps: f64| {
        let problem = Problem::new(system.clone(), body.initial_state(), (0.0, 0.05 * steps));
        let mut monitor = DriftMonitor::new();
        integrate(
            &problem,
            EulerArnold2,
            &Options::new(0.05).save(Save::Ends),
            &mut monitor,
        )
        .unwrap();
        monitor.drift().clone()
    };
    let drift = run(4000.0);
    for casimir in &drift.casimirs {
        assert!(casimir.max < 2e-13, "{casimir:?}");
    }
    assert!(drift.energy.max < 2e-3, "{:?}", drift.energy);
    assert!(drift.energy.growth().unwrap() < 1.5, "{:?}", drift.energy);
}

#[test]
fn the_time_enters_a_step_where_it_is() {
    let body = ForcedBody::new();
    let system = body.system().unwrap();
    let start = body.initial_state();
    assert_eq!(start.as_slice(), [0.8, 0.1, 0.6, 0.0, 0.0, 1.0]);
    let run = |h: f64| {
        let problem = Problem::new(system.clone(), start, (0.0, 2.0));
        let solution = solve(
            &problem,
            LieMidpoint::exp(),
            &Options::new(h).save(Save::Ends),
        )
        .unwrap();
        *solution.last().unwrap().1
    };
    // the equations by hand: l = u^2 + v^2/2 + w^2/3 - a u cos(k t), mu = l', mu' = mu x xi, with rk4
    let field = |t: f64, m: [f64; 3]| {
        let a = 0.3 * (2.0 * t).cos();
        let xi = [(m[0] + a) / 2.0, m[1], m[2] * 1.5];
        [
            m[1] * xi[2] - m[2] * xi[1],
            m[2] * xi[0] - m[0] * xi[2],
            m[0] * xi[1] - m[1] * xi[0],
        ]
    };
    let mut m = [0.8, 0.1, 0.6];
    let steps = 2000;
    let h = 2.0 / f64::from(steps);
    let add =
        |m: [f64; 3], h: f64, k: [f64; 3]| [m[0] + h * k[0], m[1] + h * k[1], m[2] + h * k[2]];
    for k in 0..steps {
        let t = f64::from(k) * h;
        let k1 = field(t, m);
        let k2 = field(t + h / 2.0, add(m, h / 2.0, k1));
        let k3 = field(t + h / 2.0, add(m, h / 2.0, k2));
        let k4 = field(t + h, add(m, h, k3));
        for (slope, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            m = add(m, weight * h / 6.0, slope);
        }
    }
    let error = |h: f64| {
        let end = run(h);
        (0..3).map(|i| (end[i] - m[i]).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(0.02), error(0.01));
    assert!(
        fine < 1e-4 && (coarse / fine - 4.0).abs() < 0.1,
        "{coarse:e} {fine:e}"
    );
    let end = run(0.01);
    assert!((end[4] - 2.0).abs() < 1e-13 && end[5] == 1.0);
    // the energy is that of the declaration; the momentum of the time makes up for it
    let extended = system.hamiltonian(&end) - system.hamiltonian(&start);
    assert!((system.energy(&end) - system.energy(&start)).abs() > 0.01);
    assert!(extended.abs() < 1e-3, "{extended:e}");
}
