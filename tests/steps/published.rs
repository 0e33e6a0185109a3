//! Numbers that others have published, reproduced; `docs/published.md` explains them.

use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

lie_poisson! {
    /// The free rigid body of Hairer and Vilmart.
    system HairerVilmartBody;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state y1, y2, y3;
    parameters { I1 = 0.6; I2 = 0.8; I3 = 1; }
    hamiltonian = y1^2/(2*I1) + y2^2/(2*I2) + y3^2/(2*I3);
    casimir C = y1^2 + y2^2 + y3^2;
    methods = [gauss6, midpoint];
}

lie_poisson! {
    /// The heavy top of the DiffMan tutorial.
    system DiffManTop;
    algebra {
        basis J1, J2, J3, P1, P2, P3;
        [J1, J2] = J3; [J2, J3] = J1; [J3, J1] = J2;
        [J1, P2] = P3; [J2, P3] = P1; [J3, P1] = P2;
        [J2, P1] = -P3; [J3, P2] = -P1; [J1, P3] = -P2;
    }
    state Pi1, Pi2, Pi3, Gamma1, Gamma2, Gamma3;
    parameters { I1 = 7/8; I3 = 1/4; m = 1; g = 9.81; l = sqrt(3)/2; }
    hamiltonian = (Pi1^2 + Pi2^2)/(2*I1) + Pi3^2/(2*I3) + m*g*l*Gamma3;
    casimir length = Gamma1^2 + Gamma2^2 + Gamma3^2;
    casimir projection = Pi1*Gamma1 + Pi2*Gamma2 + Pi3*Gamma3;
    methods = [gauss6, lie-midpoint];
}

const HAIRER_VILMART: [f64; 3] = [1.8, 0.4, -0.9];
const AT_TEN: [f64; 3] = [
    1.765_962_508_518_207_5,
    -0.695_464_197_033_089_1,
    0.779_554_981_481_871_1,
];

/// The page shows this row.
fn page_shows(row: &str) {
    let page = std::fs::read_to_string("docs/published.md").expect("the page");
    assert!(
        page.lines().any(|line| line == row),
        "not in the page: {row}"
    );
}

/// The entries in parentheses, with so many decimals.
fn entries(values: &[f64], decimals: usize) -> String {
    let texts: Vec<String> = values.iter().map(|v| format!("{v:.decimals$}")).collect();
    format!("({})", texts.join(", "))
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()))
}

/// The state at the end of a run.
fn end<P, M>(system: P, method: M, mu0: &[f64], until: f64, step: f64) -> Vec<f64>
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let mut start = system.zero_state();
    start.as_mut_slice().copy_from_slice(mu0);
    let problem = Problem {
        system,
        mu0: start,
        span: (0.0, until),
    };
    let Ok(solution) = solve(&problem, method, &Options::new(step).save(Save::Ends)) else {
        panic!("{}: the run does not reach its end", M::ID);
    };
    let (_, last) = solution.last().expect("a row");
    last.as_slice().to_vec()
}

/// E. Hairer, G. Vilmart, "Preprocessed discrete Moser–Veselov algorithm for the full dynamics of a
/// rigid body", Journal of Physics A 39 (2006), doi:10.1088/0305-4470/39/42/006.
#[test]
fn free_rigid_body_of_hairer_and_vilmart() {
    let body = || HairerVilmartBody::new().system().expect("valid");
    for (name, value) in [
        (
            "y(10) by `gauss6`, h = 0.01",
            end(body(), Gauss6, &HAIRER_VILMART, 10.0, 0.01),
        ),
        (
            "the same by `rk4`, h = 0.001",
            end(body(), Rk4, &HAIRER_VILMART, 10.0, 0.001),
        ),
    ] {
        let error = distance(&value, &AT_TEN);
        println!("{name}: {error:.1e}");
        assert!(error < 1e-12, "{name}: {error:e}");
        page_shows(&format!("| {name} | {} |", entries(&value, 12)));
    }
    let discrete = end(body(), MoserVeselov, &HAIRER_VILMART, 10.0, 0.1);
    let error = distance(&discrete, &AT_TEN);
    page_shows(&format!(
        "| error of `moser-veselov` at t = 10 with h = 0.1, largest component | {error:.3} |"
    ));
    let midpoint = end(body(), ImplicitMidpoint, &HAIRER_VILMART, 10.0, 0.1);
    assert!(distance(&midpoint, &AT_TEN) > 1e-3, "a control");
}

/// K. Engø, A. Marthinsen, H. Z. Munthe-Kaas, "DiffMan: an object-oriented MATLAB toolbox for solving
/// differential equations on manifolds", Applied Numerical Mathematics 39 (2001) 323–347,
/// doi:10.1016/S0168-9274(00)00042-8: the heavy top. By the symmetry of the top its Pi3 stays 1/4.
#[test]
fn heavy_top_of_diffman() {
    let top = || DiffManTop::new().system().expect("valid");
    let angle = core::f64::consts::PI / 16.0;
    let start = [0.0, 0.0, 0.25, 0.0, -angle.sin(), angle.cos()];
    let expected = [
        0.169_715_476_325_913_8,
        -0.373_327_269_513_135_7,
        0.25,
        0.225_978_749_210_773_2,
        0.095_155_562_070_024_2,
        0.969_473_580_822_227_6,
    ];
    for (name, value) in [
        ("gauss6", end(top(), Gauss6, &start, 5.0, 0.005)),
        ("gauss4", end(top(), Gauss4, &start, 5.0, 0.0005)),
    ] {
        let error = distance(&value, &expected);
        println!("{name}: {error:.1e}");
        assert!(error < 2e-12, "{name}: {error:e}");
        page_shows(&format!(
            "| Pi(5) by `gauss6`, h = 0.005 | {} |",
            entries(&value[..3], 10)
        ));
        page_shows(&format!("| Gamma(5) | {} |", entries(&value[3..], 10)));
    }
    let coarse = end(top(), LieMidpoint::exp(), &start, 5.0, 0.01);
    assert!(distance(&coarse, &expected) > 1e-6, "a control");
}

/// M. A. Austin, P. S. Krishnaprasad, L.-S. Wang, "Almost Poisson integration of rigid body systems",
/// Journal of Computational Physics 107 (1993) 105–117, doi:10.1006/jcph.1993.1128: how far the
/// midpoint rule is from a Poisson map.
#[test]
fn almost_poisson_midpoint() {
    let system = HairerVilmartBody::<Dual<f64>>::default()
        .system()
        .expect("valid");
    let newton = NewtonOptions::default();
    for (h, expected) in [(0.1, 3.56e-5), (0.05, 4.77e-6), (0.025, 6.15e-7)] {
        let defect = poisson_defect(&system, &ImplicitMidpoint, h, &HAIRER_VILMART, &newton);
        let defect = defect.expect("the step converges");
        println!("h = {h}: {defect:.4e}, published {expected:e}");
        assert!(
            (defect / expected - 1.0).abs() < 2e-3,
            "h = {h}: {defect:e}"
        );
        page_shows(&format!("| {h} | {defect:.2e} |"));
    }
    let exact = poisson_defect(&system, &LieMidpoint::exp(), 0.1, &HAIRER_VILMART, &newton);
    assert!(exact.expect("the step converges") < 1e-14);
}
