//! The motion on the group beside every method.

use crate::attitude::{Q10, Y0};
use crate::rotation::rotation;
use crate::systems::{Declared, HeavyTop, KirchhoffBody, ManakovTop};
use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::driver::{Chart, Reconstruction};
use lie_runtime::methods::{Cayley, Exp, Method};
use lie_runtime::prelude::*;
use lie_runtime::structure::Entry;
use lie_runtime::{MatrixGroup, MatrixPoisson, State};

lie_poisson! {
    /// The body of Hairer and Vilmart, with right invariance as a twin.
    pub system Body;
    algebra {
        basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2;
        matrix e1 = [[0, 0, 0], [0, 0, -1], [0, 1, 0]];
        matrix e2 = [[0, 0, 1], [0, 0, 0], [-1, 0, 0]];
        matrix e3 = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
    }
    state y1, y2, y3;
    hamiltonian = y1^2/(2*3/5) + y2^2/(2*4/5) + y3^2/2;
    casimir C = y1^2 + y2^2 + y3^2;
    initial = [9/5, 2/5, -9/10];
}

/// The same body, right-invariant: the spatial angular velocity is a function of the spatial momentum.
mod right {
    use lie_runtime::prelude::*;
    lie_poisson! {
        pub system Twin;
        algebra {
            basis e1, e2, e3;
            matrix e1 = [[0, 0, 0], [0, 0, -1], [0, 1, 0]];
            matrix e2 = [[0, 0, 1], [0, 0, 0], [-1, 0, 0]];
            matrix e3 = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
        }
        state y1, y2, y3;
        hamiltonian = y1^2/(2*3/5) + y2^2/(2*4/5) + y3^2/2;
        invariance = right;
    }
}

/// The final state and group element of a run, and the group element of every row.
struct Run {
    mu: Vec<f64>,
    element: Vec<f64>,
    rows: Vec<Vec<f64>>,
}

fn run<P, M>(system: &P, mu: &[f64], method: M, h: f64, save: Save, end: f64, chart: Chart) -> Run
where
    P: MatrixGroup<f64> + Clone,
    M: Method<f64, P>,
{
    let mut start = system.zero_state();
    start.as_mut_slice().copy_from_slice(mu);
    let mut attitude = Reconstruction::new(system, chart);
    let problem = Problem::new(system.clone(), start, (0.0, end));
    let options = Options::new(h).save(save);
    let solution = solve_observed(&problem, method, &options, &mut attitude)
        .ok()
        .expect("a run");
    Run {
        mu: solution.last().unwrap().1.as_slice().to_vec(),
        element: attitude.element().to_vec(),
        rows: attitude.rows().to_vec(),
    }
}

/// `g mu` for matrices of rotations; the spatial momentum, as `Ad*_(g^-1) mu = g mu` there.
fn turn(g: &[f64], mu: &[f64]) -> Vec<f64> {
    (0..3)
        .map(|i| (0..3).map(|j| g[3 * i + j] * mu[j]).sum())
        .collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()))
}

/// The largest entry of `g^T g - 1`.
fn skewness(g: &[f64], n: usize) -> f64 {
    let mut largest = 0.0_f64;
    for i in 0..n {
        for j in 0..n {
            let sum: f64 = (0..n).map(|k| g[n * k + i] * g[n * k + j]).sum();
            largest = largest.max((sum - f64::from(u8::from(i == j))).abs());
        }
    }
    largest
}

#[test]
fn the_attitude_of_hairer_and_vilmart_is_met() {
    let body = Body::new().system().unwrap();
    let end = run(
        &body,
        &Y0,
        Gauss6,
        0.01,
        Save::Ends,
        10.0,
        Chart::Quaternion,
    );
    assert!(distance(&end.element, &Q10) < 1e-11, "{:?}", end.element);
    let digits: Vec<String> = end.element.iter().map(|q| format!("{q:.12}")).collect();
    let row = format!(
        "| attitude q(10) by `gauss6`, h = 0.01, q(0) = 1 | ({}) |",
        digits.join(", ")
    );
    let page = std::fs::read_to_string("docs/published.md").expect("the page");
    assert!(page.contains(&row), "{row}");
    let end = run(
        &body,
        &Y0,
        Compose8::new(LieMidpoint::exp()),
        0.02,
        Save::Ends,
        10.0,
        Chart::Quaternion,
    );
    assert!(distance(&end.element, &Q10) < 1e-12, "{:?}", end.element);
    let wrong = run(&body, &Y0, Gauss6, 0.5, Save::Ends, 10.0, Chart::Quaternion);
    assert!(distance(&wrong.element, &Q10) > 1e-5);
}

/// Of a method on the free body: the order of the attitude, and the largest deviation of the spatial momentum
/// and of `g^T g` from what they are at the start, over 500 steps of 0.1.
fn figures<M: Method<f64, BodySystem> + Clone>(method: M) -> (f64, f64, f64) {
    let body = Body::new().system().unwrap();
    let error = |h: f64| {
        let end = run(
            &body,
            &Y0,
            method.clone(),
            h,
            Save::Ends,
            10.0,
            Chart::Quaternion,
        );
        distance(&end.element, &Q10)
    };
    let coarse = match M::ORDER {
        1 => 0.005,
        2..=4 => 0.05,
        5..=6 => 0.1,
        // beyond order 6 smaller steps are at the round-off of the published value
        _ => 0.5,
    };
    let order = (error(coarse) / error(coarse / 2.0)).log2();
    let long = run(&body, &Y0, method, 0.1, Save::Ends, 50.0, Chart::Matrix);
    let momentum = distance(&turn(&long.element, &long.mu), &Y0);
    (order, momentum, skewness(&long.element, 3))
}

#[test]
fn every_method_moves_the_group_element_at_its_order() {
    macro_rules! methods {
        ($($exact:literal $method:expr;)*) => { $({
            let (order, momentum, orthogonal) = figures($method);
            let name = stringify!($method);
            println!("{name:<40} order {order:.2}, momentum {momentum:.1e}, orthogonal {orthogonal:.1e}");
            let claimed = f64::from(order_of(&$method));
            assert!((order - claimed).abs() < 0.4, "{name}: order {order}");
            assert!(orthogonal < 5e-14, "{name}: {orthogonal:e}");
            assert_eq!(momentum < 5e-14, $exact, "{name}: momentum {momentum:e}");
        })* };
    }
    fn order_of<M: Method<f64, BodySystem>>(_: &M) -> u32 {
        M::ORDER
    }
    methods! {
        true LieMidpoint::exp();
        true LieMidpoint::cayley();
        true Generating4::exp();
        true Generating4::cayley();
        true Generating6::exp();
        true GeneratingSecondKind2;
        true HamiltonJacobi2::new();
        true HamiltonJacobi4::new();
        true HamiltonJacobi6::new();
        true LieEuler;
        true Rkmk2;
        true Rkmk3;
        true Rkmk4;
        true Rkmk6;
        true CrouchGrossman3;
        true CommutatorFree4;
        true Splitting2::new();
        true Splitting4::new();
        true OrbitEnergy::gonzalez();
        true OrbitEnergy::itoh_abe();
        true SphericalMidpoint;
        true MoserVeselov;
        true Collective2::hopf();
        true Collective4::hopf();
        true Collective6::hopf();
        true Collective4::representation();
        true Isospectral2::new();
        true Isospectral6::new();
        true Compose4::new(LieMidpoint::exp());
        true Compose6::new(MoserVeselov);
        // of coadjoint form on so(3): the midpoint rule is the Cayley map of the adjoint representation there
        true ImplicitMidpoint;
        true Gauss4;
        true Gauss6;
        true Gauss8;
        true Gonzalez;
        true MeanValue;
        true CohenHairer4::new();
        true CohenHairer6::new();
        true Compose4::new(ImplicitMidpoint);
        // what the others lose
        false Rk4;
    }
}

#[test]
fn a_right_invariant_system_moves_from_the_left() {
    let twin = right::Twin::new().system().unwrap();
    let near = run(
        &twin,
        &Y0,
        LieMidpoint::exp(),
        1e-6,
        Save::Ends,
        1e-6,
        Chart::Matrix,
    );
    let xi = [Y0[0] / 0.6, Y0[1] / 0.8, Y0[2]];
    assert!((near.element[3] - 1e-6 * xi[2]).abs() < 1e-11, "G' = xi G");
    for h in [0.1, -0.1] {
        let end = run(
            &twin,
            &Y0,
            LieMidpoint::exp(),
            h,
            Save::Ends,
            100.0 * h,
            Chart::Matrix,
        );
        let g = &end.element;
        let back: Vec<f64> = (0..3)
            .map(|i| (0..3).map(|j| g[3 * j + i] * end.mu[j]).sum())
            .collect();
        assert!(distance(&back, &Y0) < 1e-14, "G^T mu is constant: {back:?}");
        assert!(distance(&turn(g, &end.mu), &Y0) > 0.1, "and G mu is not");
        let quaternion = run(
            &twin,
            &Y0,
            LieMidpoint::exp(),
            h,
            Save::Ends,
            100.0 * h,
            Chart::Quaternion,
        );
        assert!(distance(&rotation(&quaternion.element), g) < 1e-14);
    }
}

#[test]
fn rows_off_the_grid_leave_the_run_as_it_is() {
    let body = Body::new().system().unwrap();
    let all = |save| {
        run(
            &body,
            &Y0,
            LieMidpoint::exp(),
            0.1,
            save,
            2.0,
            Chart::Quaternion,
        )
    };
    let plain = all(Save::At(vec![2.0]));
    let more = all(Save::At(vec![0.0, 0.05, 0.1, 1.234, 2.0]));
    assert_eq!(plain.element, more.element);
    assert_eq!(more.rows[0], [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(more.rows[4], plain.element);
    // the row between is where one shorter step leads
    let between = run(
        &body,
        &Y0,
        LieMidpoint::exp(),
        0.05,
        Save::Ends,
        0.05,
        Chart::Quaternion,
    );
    assert_eq!(more.rows[1], between.element);
    assert!(distance(&more.rows[3], &more.rows[4]) > 0.1);
}

/// A matrix times another.
fn times(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let entry = |i: usize, j: usize| (0..b.len()).map(|k| a[i][k] * b[k][j]).sum();
    (0..a.len())
        .map(|i| (0..b.len()).map(|j| entry(i, j)).collect())
        .collect()
}

/// The inverse, by elimination with row exchanges.
fn inverse(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let unit = |i: usize| (0..n).map(move |j| f64::from(u8::from(i == j)));
    let mut rows: Vec<Vec<f64>> = matrix
        .iter()
        .enumerate()
        .map(|(i, row)| row.iter().copied().chain(unit(i)).collect())
        .collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()));
        rows.swap(k, pivot.unwrap());
        let scale = rows[k][k];
        rows[k].iter_mut().for_each(|entry| *entry /= scale);
        for i in (0..n).filter(|&i| i != k) {
            let (factor, above) = (rows[i][k], rows[k].clone());
            rows[i]
                .iter_mut()
                .zip(above)
                .for_each(|(entry, above)| *entry -= factor * above);
        }
    }
    rows.into_iter().map(|row| row[n..].to_vec()).collect()
}

/// The largest entry of `Ad*_g mu0 - mu` by the declared matrices, `<Ad*_g mu0, e_k> = <mu0, g e_k g^-1>`.
fn coadjoint_defect<P: MatrixPoisson<f64> + MatrixGroup<f64>>(
    system: &P,
    mu0: &[f64],
    end: &Run,
) -> f64 {
    let n = system.group().size;
    let g: Vec<Vec<f64>> = end.element.chunks(n).map(<[f64]>::to_vec).collect();
    let back = inverse(&g);
    let matrix = |entries: &[Entry]| {
        let mut matrix = vec![vec![0.0; n]; n];
        for entry in entries {
            matrix[usize::from(entry.row)][usize::from(entry.column)] = entry.high;
        }
        matrix
    };
    let mut largest = 0.0_f64;
    for (k, basis) in system.group().matrices.iter().enumerate() {
        let turned = times(&times(&g, &matrix(basis)), &back);
        let pairs = system.representation().dual.iter().zip(mu0);
        let value: f64 = pairs
            .map(|(dual, mu)| {
                let product = times(&matrix(dual), &turned);
                mu * (0..n).map(|i| product[i][i]).sum::<f64>()
            })
            .sum();
        largest = largest.max((value - end.mu[k]).abs());
    }
    largest
}

#[test]
fn mu_moves_with_the_group_element_in_other_groups() {
    fn check<P>(system: &P, start: &[f64], others: bool)
    where
        P: MatrixPoisson<f64> + MatrixGroup<f64> + CayleyPoisson<f64> + Clone,
        LieMidpoint<Exp>: Method<f64, P>,
        LieMidpoint<Cayley>: Method<f64, P>,
        Isospectral4: Method<f64, P>,
        Rkmk4: Method<f64, P>,
        GeneratingSecondKind2: Method<f64, P>,
        Gauss4: Method<f64, P>,
        Rk4: Method<f64, P>,
    {
        let name = system.name();
        macro_rules! defect {
            ($method:expr) => {{
                let end = run(
                    system,
                    start,
                    $method,
                    0.05,
                    Save::Ends,
                    10.0,
                    Chart::Matrix,
                );
                coadjoint_defect(system, start, &end)
            }};
        }
        for (method, defect) in [
            ("exp", defect!(LieMidpoint::exp())),
            ("cayley", defect!(LieMidpoint::cayley())),
            ("isospectral4", defect!(Isospectral4::new())),
            ("rkmk4", defect!(Rkmk4)),
            ("second kind", defect!(GeneratingSecondKind2)),
        ] {
            println!("{name} {method}: {defect:.1e}");
            assert!(defect < 1e-12, "{name} {method}: {defect:e}");
        }
        if others {
            // at the order of the method, as they leave the orbit
            let (gauss, classical) = (defect!(Gauss4), defect!(Rk4));
            println!("{name} gauss4: {gauss:.1e}, rk4: {classical:.1e}");
            assert!((1e-11..1e-4).contains(&gauss), "{name}: {gauss:e}");
            assert!((1e-11..1e-4).contains(&classical), "{name}: {classical:e}");
        }
    }
    let top = HeavyTop::declared::<f64>();
    check(&top, HeavyTop::initial::<f64>().as_slice(), true);
    let four = ManakovTop::declared::<f64>();
    check(&four, ManakovTop::initial::<f64>().as_slice(), true);
    let body = KirchhoffBody::declared::<f64>();
    check(&body, KirchhoffBody::initial::<f64>().as_slice(), false);
    let end = run(
        &four,
        ManakovTop::initial::<f64>().as_slice(),
        MoserVeselov,
        0.05,
        Save::Ends,
        10.0,
        Chart::Matrix,
    );
    let defect = coadjoint_defect(&four, ManakovTop::initial::<f64>().as_slice(), &end);
    assert!(
        defect < 1e-12 && skewness(&end.element, 4) < 1e-13,
        "{defect:e}"
    );
}

/// How far one step on `T*SO(3)` is from a symplectic map, by its tangent map in left trivialisation:
/// `omega((x1, n1), (x2, n2)) = <n2, x1> - <n1, x2> + <mu, [x1, x2]>`, `(x, n) -> (F^T x + F^T dF n, dmu1 n)`.
fn symplectic_defect<M>(method: &M, h: f64) -> f64
where
    M: Method<f64, BodySystem> + Method<Dual<f64>, BodySystem<Dual<f64>>> + Clone,
{
    let lifted = Body::new().system().unwrap().lift();
    let mut tangent = [[0.0; 6]; 6];
    let mut end = Y0;
    for column in 0..3 {
        let mut start = lifted.zero_state();
        for (k, &y) in Y0.iter().enumerate() {
            start[k] = Dual::new(y, f64::from(u8::from(k == column)));
        }
        let mut attitude = Reconstruction::new(&lifted, Chart::Matrix);
        let problem = Problem::new(lifted.clone(), start, (0.0, h));
        let options = Options::new(h).save(Save::Ends);
        let solution = solve_observed(&problem, method.clone(), &options, &mut attitude)
            .ok()
            .unwrap();
        let mu = solution.last().unwrap().1;
        let g = attitude.element();
        end = core::array::from_fn(|k| mu[k].value);
        let factor: [f64; 9] = core::array::from_fn(|k| g[k].value);
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let turned = |l: usize| factor[3 * l + b] * g[3 * l + a].derivative;
            tangent[k][3 + column] = (0..3).map(turned).sum();
            tangent[3 + k][3 + column] = mu[k].derivative;
            tangent[k][column] = factor[3 * column + k];
        }
    }
    let form = |mu: &[f64; 3]| {
        let mut omega = [[0.0; 6]; 6];
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            omega[i][a] = mu[b];
            omega[i][b] = -mu[a];
            omega[i][3 + i] = 1.0;
            omega[3 + i][i] = -1.0;
        }
        omega
    };
    let (before, after) = (form(&Y0), form(&end));
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

/// What a method keeps exactly: spatial momentum, Casimir, energy, Poisson structure, symplectic form.
fn kept<M>(name: &str, method: M) -> [bool; 5]
where
    M: Method<f64, BodySystem> + Method<Dual<f64>, BodySystem<Dual<f64>>> + Clone,
{
    let body = Body::new().system().unwrap();
    let long = run(
        &body,
        &Y0,
        method.clone(),
        0.1,
        Save::Ends,
        50.0,
        Chart::Matrix,
    );
    let start: [f64; 3] = Y0;
    let casimir = |mu: &[f64]| mu.iter().map(|y| y * y).sum::<f64>();
    let energy = |mu: &[f64]| mu[0] * mu[0] / 1.2 + mu[1] * mu[1] / 1.6 + mu[2] * mu[2] / 2.0;
    let mu: &[f64] = &start;
    let defect = poisson_defect(&body.lift(), &method, 0.1, mu, &NewtonOptions::default()).unwrap();
    let figures = [
        distance(&turn(&long.element, &long.mu), &Y0),
        (casimir(&long.mu) - casimir(&start)).abs(),
        (energy(&long.mu) - energy(&start)).abs(),
        defect,
        symplectic_defect(&method, 0.1),
    ];
    println!(
        "{name:<20} {}",
        figures.map(|figure| format!("{figure:.1e}")).join(", ")
    );
    figures.map(|figure| figure < 2e-14)
}

/// E. Hairer, G. Vilmart (2006), doi:10.1088/0305-4470/39/42/006: what is preserved exactly by the discrete
/// Moser–Veselov algorithm, the implicit midpoint rule with rotations, and the symmetric splitting with rotations.
#[test]
fn the_table_of_preserved_quantities_is_that_of_hairer_and_vilmart() {
    //                                                              Qy    Casimir energy Poisson symplectic
    assert_eq!(
        kept("moser-veselov", MoserVeselov),
        [true, true, true, true, true]
    );
    assert_eq!(
        kept("midpoint", ImplicitMidpoint),
        [true, true, true, false, false]
    );
    assert_eq!(
        kept("splitting2", Splitting2::new().coordinate()),
        [true, true, false, true, true]
    );
    // others of ours, and a control that keeps nothing
    assert_eq!(
        kept("lie-midpoint", LieMidpoint::exp()),
        [true, true, false, true, true]
    );
    assert_eq!(
        kept("orbit-energy", OrbitEnergy::gonzalez()),
        [true, true, true, false, false]
    );
    assert_eq!(kept("rkmk4", Rkmk4), [true, true, false, false, false]);
    assert_eq!(kept("rk4", Rk4), [false, false, false, false, false]);
}
