//! First integrals and observables in generated code.

use core::f64::consts::PI;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::{Options, Problem, Save, solve, solve_observed};
use lie_runtime::prelude::*;

lie_poisson! {
    system Top;
    algebra = se(3);
    state m1, m2, m3, g1, g2, g3;
    parameters { J = 3/5; }
    vectors { m = (m1, m2, m3); g = (g1, g2, g3); }
    let w3 = m3/J;
    hamiltonian = (m1^2 + m2^2)/2 + m3^2/(2*J) + 2*g3;
    integrals { spin = m3; weight = dot(m, g)*m3; }
    observables { phi = atan2(g2, g1), unwrap; turning = w3 + norm(cross(m, g)); zero = 0; late = t*g3; }
    initial = [0.3, 0.1, 2, 0.6, 0, 0.8];
    methods = [gauss6];
}

lie_poisson! {
    system Plain;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
}

#[test]
fn a_system_says_what_is_recorded() {
    let top = Top::new().system().unwrap();
    let top = || &top;
    let count = Poisson::<f64>::quantity_count(top());
    let names: Vec<&str> = (0..count)
        .map(|k| Poisson::<f64>::quantity_name(top(), k))
        .collect();
    assert_eq!(names, ["spin", "weight", "phi", "turning", "zero", "late"]);
    let of = |flag: fn(&TopSystem<f64>, usize) -> bool| {
        (0..count).map(move |k| flag(top(), k)).collect::<Vec<_>>()
    };
    let conserved = of(Poisson::<f64>::quantity_is_conserved);
    assert_eq!(conserved, [true, true, false, false, false, false]);
    let unwraps = of(Poisson::<f64>::quantity_unwraps);
    assert_eq!(unwraps, [false, false, true, false, false, false]);
    let plain = Plain::new().system().unwrap();
    assert_eq!(Poisson::<f64>::quantity_count(&plain), 0);
    assert!(Poisson::<f64>::clock(&plain).is_none() && Poisson::<f64>::clock(top()).is_some());
}

#[test]
fn a_solution_has_them_by_name() {
    let top = Top::new();
    let problem = Problem::new(top.system().unwrap(), top.initial_state(), (0.0, 20.0));
    let options = Options::new(0.05);
    let mut monitor = DriftMonitor::new();
    let solution = solve_observed(&problem, Gauss6, &options, &mut monitor).unwrap();
    let of = |name: &str| {
        solution
            .quantity(name)
            .unwrap()
            .copied()
            .collect::<Vec<f64>>()
    };
    let (phi, turning, late) = (of("phi"), of("turning"), of("late"));
    assert!(solution.quantity("omega").is_none());
    for (row, mu) in solution.mu.iter().enumerate() {
        let s = mu.as_slice();
        let cross = [
            s[1] * s[5] - s[2] * s[4],
            s[2] * s[3] - s[0] * s[5],
            s[0] * s[4] - s[1] * s[3],
        ];
        let norm = cross.iter().map(|c| c * c).sum::<f64>().sqrt();
        assert!((turning[row] - s[2] / 0.6 - norm).abs() < 1e-13);
        assert!((phi[row] - s[4].atan2(s[3])).sin().abs() < 1e-12);
        assert!((late[row] - solution.t[row] * s[5]).abs() < 1e-12);
        assert_eq!(solution.quantities[row][4], 0.0);
    }
    assert!(phi.windows(2).all(|pair| (pair[1] - pair[0]).abs() < PI));
    assert!((phi[phi.len() - 1] - phi[0]).abs() > 2.0 * PI);
    for drift in [&solution.drift(), monitor.drift()] {
        let names: Vec<&str> = drift.integrals.iter().map(|drift| &*drift.name).collect();
        assert_eq!(names, ["spin", "weight"]);
        assert!(drift.integrals.iter().all(|drift| drift.max < 1e-12));
    }
    // rows far apart, and between steps, are on the same branch
    let every = Options {
        save: Save::Every(100),
        ..options.clone()
    };
    let few = solve(&problem, Gauss6, &every).unwrap();
    assert_eq!(few.quantity("phi").unwrap().last(), phi.last());
    let mut csv = Vec::new();
    few.write_csv(&mut csv).unwrap();
    let csv = String::from_utf8(csv).unwrap();
    assert!(
        csv.lines()
            .next()
            .unwrap()
            .ends_with("spin,weight,phi,turning,zero,late")
    );
    assert_eq!(
        csv.lines().nth(1).unwrap().split(',').count(),
        csv.lines().next().unwrap().split(',').count()
    );
}

#[test]
fn a_method_that_keeps_less_shows_it() {
    let top = Top::new();
    let problem = Problem::new(top.system().unwrap(), top.initial_state(), (0.0, 20.0));
    let solution = solve(&problem, Rk4, &Options::new(0.1)).unwrap();
    assert!(solution.drift().integrals[1].max > 1e-9);
}
