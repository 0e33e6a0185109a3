//! Equilibria on a leaf, their stability and their branches, against closed formulas.

mod systems;

use lie_equilibria::exact::Prover;
use lie_equilibria::{
    At, ChangeKind, Equations, Equilibrium, Presence, Reason, Stability, System, trace,
};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Symbol};
use systems::{canonical, lagrange_top, number, on_se3, quadratic, rigid_body};

fn all(system: System, parameters: &[Rational]) -> (Vec<Equilibrium>, lie_equilibria::Found) {
    let equations = Equations::new(system, None).expect("expressions");
    let values: Vec<f64> = parameters.iter().map(Rational::to_f64).collect();
    let at = At {
        equations: &equations,
        parameters: &values,
    };
    let found = at.search(100, 1, true).expect("a leaf");
    let prover = Prover::new(&equations);
    let known = found.candidates.iter();
    let known = known.map(|one| Equilibrium::new(&prover, at, parameters, one).expect("finite"));
    (known.collect(), found)
}

/// The axes: stable about the largest and the smallest moment, unstable about the middle one.
#[test]
fn rigid_body_turns_about_its_axes() {
    let state = [number(1, 1), number(2, 1), number(2, 1)];
    let (found, search) = all(rigid_body([1, 2, 3], state), &[]);
    assert_eq!(found.len(), 6);
    let paths = search.paths.expect("polynomials");
    assert_eq!((paths.all, paths.real, paths.lost), (6, 6, 0));
    for one in &found {
        let axis = (0..3).max_by(|i, j| one.state[*i].abs().total_cmp(&one.state[*j].abs()));
        let axis = axis.expect("three coordinates");
        assert!(
            (one.state[axis].abs() - 3.0).abs() < 1e-14,
            "{:?}",
            one.state
        );
        let stable = if axis == 1 {
            Stability::Unstable
        } else {
            Stability::Stable
        };
        assert_eq!(one.judgement.stability, stable);
        assert!(one.judgement.proven && matches!(one.presence, Presence::Rational(_)));
        // about axis 2 the rate is |m| sqrt((I3 - I2)(I2 - I1)/(I1 I3))/I2
        if axis == 1 {
            let rate = 1.5 * (1.0_f64 / 3.0).sqrt();
            assert!((one.linearisation.growth() - rate).abs() < 1e-13);
        }
    }
    // no square roots: the same by a box
    let state = [number(1, 1), number(1, 1), number(0, 1)];
    let (found, _) = all(rigid_body([1, 2, 3], state), &[]);
    assert!(
        found.len() == 6
            && found
                .iter()
                .all(|one| one.presence == Presence::Enclosed && one.judgement.proven)
    );
}

/// A symmetric body: two axes, and an equator of equilibria, which is one family.
#[test]
fn a_symmetric_body_has_a_family() {
    let state = [number(1, 3), number(1, 2), number(1, 1)];
    let (found, search) = all(rigid_body([2, 2, 1], state), &[]);
    let families: Vec<usize> = found.iter().map(|one| one.family).collect();
    assert!(
        families.len() == 3 && families.iter().sum::<usize>() == 1,
        "{families:?}"
    );
    assert!(search.converged > 50, "{}", search.converged);
    // a sphere: everything rests, a family of two dimensions
    let state = [number(1, 3), number(1, 2), number(1, 1)];
    let (found, _) = all(rigid_body([2, 2, 2], state), &[]);
    assert_eq!(found.iter().map(|one| one.family).collect::<Vec<_>>(), [2]);
}

/// Staude's rotations of the Lagrange top: sleeping, hanging, and the roots w of `I1 w^4 - c w^3 + mgl^2/(I3 - I1) = 0` with
/// `cos = mgl/(w^2 (I3 - I1))` between -1 and 1, each a circle.
#[test]
fn all_rotations_of_the_lagrange_top() {
    let (i1, i3, mgl) = (1.0, 2.0, 1.0);
    let mut counts = Vec::new();
    for (n, d) in [(3, 1), (5, 2), (1, 2), (3, 2)] {
        let (found, search) = all(
            lagrange_top(number(1, 1), number(2, 1), number(1, 1)),
            &[number(n, d)],
        );
        let spin = n as f64 / d as f64;
        let quartic = |w: f64| i1 * w.powi(4) - spin * w.powi(3) + mgl * mgl / (i3 - i1);
        let mut roots = Vec::new();
        let grid: Vec<f64> = (-40_000..40_000)
            .map(|k| 5e-4 * f64::from(k) + 1e-5)
            .collect();
        for pair in grid.windows(2) {
            let (mut a, mut b) = (pair[0], pair[1]);
            if quartic(a) * quartic(b) < 0.0 {
                for _ in 0..60 {
                    let c = 0.5 * (a + b);
                    if quartic(c) * quartic(a) > 0.0 {
                        a = c
                    } else {
                        b = c
                    }
                }
                let cosine = mgl / (a * a * (i3 - i1));
                if cosine.abs() < 1.0 {
                    roots.push(cosine);
                }
            }
        }
        let isolated = found.iter().filter(|one| one.family == 0).count();
        let mut cosines: Vec<f64> = found
            .iter()
            .filter(|one| one.family == 1)
            .map(|one| one.state[5])
            .collect();
        cosines.sort_by(f64::total_cmp);
        roots.sort_by(f64::total_cmp);
        assert_eq!(
            (isolated, cosines.len()),
            (2, roots.len()),
            "{spin}: {cosines:?} {roots:?} {:?}",
            search.paths
        );
        assert!(
            cosines
                .iter()
                .zip(&roots)
                .all(|(a, b)| (a - b).abs() < 1e-12),
            "{cosines:?} {roots:?}"
        );
        counts.push(roots.len());
    }
    assert!(counts.iter().any(|count| *count > 0), "{counts:?}");
}

/// The sleeping top: stable with the integral m3 where the spin is above 2 sqrt(I1 mgl), unstable below.
#[test]
fn the_top_sleeps_above_a_spin() {
    let top = |spin| {
        let (found, _) = all(
            lagrange_top(number(1, 1), number(1, 2), number(1, 1)),
            &[spin],
        );
        let sleeping = found
            .into_iter()
            .find(|one| one.family == 0 && one.state[5] > 0.5);
        sleeping.expect("the upright position").judgement
    };
    let fast = top(number(201, 100));
    assert!(
        fast.stability == Stability::Stable && fast.proven,
        "{fast:?}"
    );
    assert!(matches!(fast.reason, Reason::Integrals { .. }), "{fast:?}");
    let slow = top(number(199, 100));
    assert!(
        slow.stability == Stability::Unstable && slow.proven,
        "{slow:?}"
    );
    // without the integral it is spectrally stable, and nothing more is claimed
    let bare = System {
        integrals: Vec::new(),
        ..lagrange_top(number(1, 1), number(1, 2), number(1, 1))
    };
    let (found, _) = all(bare, &[number(3, 1)]);
    let sleeping = found
        .iter()
        .find(|one| one.family == 0 && one.state[5] > 0.5)
        .expect("upright");
    assert_eq!(sleeping.judgement.stability, Stability::Spectral);
}

#[test]
fn the_threshold_of_the_sleeping_top_is_refined() {
    let (i1, mgl) = (number(3, 7), number(5, 11));
    let threshold = 2.0 * (i1.to_f64() * mgl.to_f64()).sqrt();
    let system = lagrange_top(i1, number(2, 3), mgl);
    let equations = Equations::new(system, Some(0)).expect("expressions");
    let grid: Vec<f64> = (0..21).map(|k| 0.4 + 0.05 * f64::from(k)).collect();
    let traced = trace(&equations, &[0.0], 0, &grid, 60, 1);
    let collisions: Vec<f64> = traced
        .branches
        .iter()
        .filter(|branch| branch.family == 0 && branch.points[0].y[5] > 0.5)
        .flat_map(|branch| &branch.changes)
        .filter(|change| change.kind == ChangeKind::Collision)
        .map(|change| change.parameter)
        .collect();
    assert_eq!(collisions.len(), 1, "{collisions:?}");
    assert!(
        (collisions[0] - threshold).abs() < 1e-12,
        "{} {threshold}",
        collisions[0]
    );
}

/// Kirchhoff's body with H = sum a_i m_i^2/2 + b_i p_i^2/2 at m.p = c: along axis i it has m = c e_i.
#[test]
fn kirchhoff_moves_along_its_axes() {
    let (a, b) = ([1, 2, 3], [3, 1, 2]);
    let system = on_se3(
        |graph| {
            let momenta = quadratic(graph, 0, &a.map(Rational::from));
            let impulses = quadratic(graph, 3, &b.map(Rational::from));
            graph.add(momenta, impulses)
        },
        false,
    );
    let (found, search) = all(system, &[number(1, 2)]);
    let paths = search.paths.expect("polynomials");
    assert_eq!(paths.lost, 0, "{paths:?}");
    assert_eq!(paths.real, found.len(), "{paths:?}");
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let there = found.iter().any(|one| {
                let mut wanted = [0.0; 6];
                (wanted[axis], wanted[3 + axis]) = (0.5 * sign, sign);
                one.state
                    .iter()
                    .zip(wanted)
                    .all(|(x, y)| (x - y).abs() < 1e-12)
            });
            assert!(there, "axis {axis}");
        }
    }
    // all others are in planes: p in the plane (i, j), m_k = l p_k/a_k with l^2 (1/a_i - 1/a_j) = b_i - b_j and l sum p_k^2/a_k = c
    let mut planes = 0;
    for (i, j) in [(0, 1), (1, 2), (0, 2)] {
        let [a, b] = [a, b].map(|v| v.map(|x: i64| x as f64));
        let square = (b[i] - b[j]) / (1.0 / a[i] - 1.0 / a[j]);
        if square <= 0.0 {
            continue;
        }
        for l in [square.sqrt(), -square.sqrt()] {
            let part = (0.5 / l - 1.0 / a[j]) / (1.0 / a[i] - 1.0 / a[j]);
            planes += if part > 0.0 && part < 1.0 { 4 } else { 0 };
        }
    }
    assert_eq!(found.len(), 6 + planes, "{paths:?}");
}

/// Without a Casimir there are no multipliers, and every stationary point of H on the plane is an equilibrium.
#[test]
fn polynomials_without_a_casimir() {
    // p^2/2 + q^2/2 - q^4/4: at rest in 0, and unstable with rate sqrt(2) in 1 and -1
    let system = canonical(|graph, q| {
        let square = graph.mul(q, q);
        let fourth = graph.mul(square, square);
        graph.linear(&[(square, number(1, 2)), (fourth, number(-1, 4))])
    });
    let (found, search) = all(system, &[]);
    let paths = search.paths.expect("polynomials");
    assert_eq!((paths.all, paths.real, paths.lost), (3, 3, 0));
    assert_eq!(found.len(), 3);
    for one in &found {
        let at_rest = one.state[0].abs() < 0.5;
        let stable = match at_rest {
            true => Stability::Stable,
            false => Stability::Unstable,
        };
        assert_eq!(
            (one.judgement.stability, one.judgement.proven),
            (stable, true)
        );
        let rate = if at_rest { 0.0 } else { 2.0_f64.sqrt() };
        assert!((one.linearisation.growth() - rate).abs() < 1e-13);
    }
}

/// A top that hardly spins falls with rate `sqrt(mgl/I1 - (spin/(2 I1))^2)`: two pairs of eigenvalues that nearly meet.
#[test]
fn a_top_that_hardly_spins_falls() {
    let (i1, mgl) = (number(7, 5), number(3, 7));
    for spin in [
        number(0, 1),
        number(1, 1_000_000),
        number(1, 100),
        number(1, 80),
    ] {
        let system = lagrange_top(i1.clone(), number(1, 2), mgl.clone());
        let (found, _) = all(system, std::slice::from_ref(&spin));
        let upright = found
            .iter()
            .find(|one| one.family == 0 && one.state[5] > 0.5);
        let upright = upright.expect("the upright position");
        let half = spin.to_f64() / (2.0 * i1.to_f64());
        let rate = (mgl.to_f64() / i1.to_f64() - half * half).sqrt();
        let growth = upright.linearisation.growth();
        assert!((growth - rate).abs() < 1e-12, "{spin:?}: {growth} {rate}");
        assert_eq!(upright.linearisation.eigenvalues.len(), 4);
        assert_eq!(upright.judgement.stability, Stability::Unstable);
    }
    let system = lagrange_top(i1, number(1, 2), mgl);
    let equations = Equations::new(system, Some(0)).expect("expressions");
    let grid: Vec<f64> = (0..11).map(|k| 0.05 * f64::from(k)).collect();
    let traced = trace(&equations, &[0.0], 0, &grid, 60, 1);
    let of = |branch: &&lie_equilibria::Branch| branch.family == 0 && branch.points[0].y[5] > 0.5;
    let upright = traced.branches.iter().filter(of);
    let points: Vec<_> = upright.flat_map(|branch| &branch.points).collect();
    assert!(points.len() > 10);
    assert!(
        points
            .iter()
            .all(|point| point.stability == Stability::Unstable)
    );
}

/// Degenerate equilibria: each counts once, is no family, and nothing is said of its stability.
#[test]
fn degenerate_equilibria_are_not_decided() {
    // stationary in q = 0 alone on the way of the starts: q^3/3, exp(q) - q - q^2/2, sin q - q
    let cubic = |graph: &mut Graph, q: ExprId| {
        let square = graph.mul(q, q);
        let cube = graph.mul(square, q);
        graph.scale(cube, &number(1, 3))
    };
    let exponential = |graph: &mut Graph, q: ExprId| {
        let (square, exp) = (graph.mul(q, q), graph.call(Elementary::Exp, &[q]));
        graph.linear(&[
            (exp, number(1, 1)),
            (q, number(-1, 1)),
            (square, number(-1, 2)),
        ])
    };
    let sine = |graph: &mut Graph, q: ExprId| {
        let sine = graph.call(Elementary::Sin, &[q]);
        graph.sub(sine, q)
    };
    for (name, system) in [
        ("cubic", canonical(cubic)),
        ("exponential", canonical(exponential)),
        ("sine", canonical(sine)),
    ] {
        let (found, _) = all(system, &[]);
        let near: Vec<_> = found
            .iter()
            .filter(|one| one.state[0].abs() < 1.0)
            .collect();
        let states: Vec<_> = near
            .iter()
            .map(|one| (&one.state, one.family, one.hits))
            .collect();
        assert_eq!(near.len(), 1, "{name}: {states:?}");
        let one = near[0];
        assert!(
            one.state[0].abs() < 1e-6 && one.family == 0,
            "{name}: {one:?}"
        );
        assert!(one.degenerate, "{name}: {one:?}");
        assert_eq!(one.judgement.stability, Stability::Undecided, "{name}");
        assert!(found.iter().all(|one| one.family == 0), "{name}");
    }
    // x^3 + y^2 on the sphere: degenerate in (0, 0, 1) and (0, 0, -1) alone
    let mut system = rigid_body([1, 1, 1], [number(0, 1), number(3, 5), number(4, 5)]);
    let graph = &mut system.graph;
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let (square, height) = (graph.mul(x, x), graph.mul(y, y));
    let cube = graph.mul(square, x);
    system.hamiltonian = graph.add(cube, height);
    let (found, _) = all(system, &[]);
    let poles = found.iter().filter(|one| one.state[2].abs() > 0.9);
    let poles: Vec<_> = poles.collect();
    assert_eq!(poles.len(), 2);
    for pole in poles {
        assert!(pole.degenerate && pole.family == 0, "{pole:?}");
        let stability = pole.judgement.stability;
        assert!(
            matches!(stability, Stability::Undecided | Stability::Spectral),
            "{pole:?}"
        );
    }
    assert!(found.iter().all(|one| one.family == 0));
    // the control: a minimum of the fourth part of the cube's height is told
    let control = canonical(|graph, q| {
        let cube = cubic(graph, q);
        let square = graph.mul(q, q);
        graph.linear(&[(cube, number(1, 1)), (square, number(1, 2000))])
    });
    let (found, _) = all(control, &[]);
    let stability: Vec<Stability> = found.iter().map(|one| one.judgement.stability).collect();
    assert_eq!(stability.len(), 2);
    assert!(stability.contains(&Stability::Stable) && stability.contains(&Stability::Unstable));
}

/// A body with a parameter: `H = k x^2/2 + y^2/2 + 3 z^2/4 + l z` with one of k and l the parameter, on the sphere.
fn body_with(parameter: &str) -> Equations {
    let mut system = rigid_body([1, 1, 1], [number(0, 1), number(3, 5), number(4, 5)]);
    let graph = &mut system.graph;
    let value = graph.symbol(Symbol::Parameter(0));
    let [x, y, z] = [0, 1, 2].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let [xx, yy, zz] = [x, y, z].map(|x| graph.mul(x, x));
    let (own, at) = match parameter {
        "k" => (graph.mul(value, xx), number(1, 2)),
        _ => (graph.mul(value, z), number(1, 1)),
    };
    let rest = if parameter == "k" {
        number(0, 1)
    } else {
        number(1, 4)
    };
    let terms = [
        (own, at),
        (xx, rest),
        (yy, number(1, 2)),
        (zz, number(3, 4)),
    ];
    system.hamiltonian = graph.linear(&terms);
    system.parameters = vec![parameter.to_owned()];
    Equations::new(system, Some(0)).expect("expressions")
}

/// Axes change their stability where k is 1 and 3/2, and at l = 1/2 and 1; every point is an equilibrium at its parameter.
#[test]
fn branches_change_where_they_do() {
    let expected = [
        ("k", 0.5, 1.5, [1.0, 1.5]),
        ("k", 0.5, 1.6, [1.0, 1.5]),
        ("k", 0.45, 1.65, [1.0, 1.5]),
        ("l", 0.2, 0.8, [0.5, 1.0]),
        ("l", 0.2, 1.3, [0.5, 1.0]),
    ];
    for (name, from, to, thresholds) in expected {
        let equations = body_with(name);
        let grid: Vec<f64> = (0..11)
            .map(|k| from + 0.1 * (to - from) * f64::from(k))
            .collect();
        let traced = trace(&equations, &[0.0], 0, &grid, 60, 1);
        let mut zeros = 0;
        for branch in &traced.branches {
            // equators are equilibria at one value of k alone
            let one = |point: &lie_equilibria::Point| point.parameter == branch.points[0].parameter;
            assert!(
                branch.family == 0 || branch.points.iter().all(one),
                "{name}: {branch:?}"
            );
            for point in &branch.points {
                let linear = equations
                    .linear(&point.y, &[point.parameter])
                    .expect("finite");
                let most = linear
                    .residual
                    .iter()
                    .fold(0.0_f64, |most, x| most.max(x.abs()));
                assert!(most < 1e-12, "{name}: {point:?}");
            }
            for change in branch
                .changes
                .iter()
                .filter(|one| one.kind != ChangeKind::Fold)
            {
                let off = |threshold: &f64| (change.parameter - threshold).abs();
                let off = thresholds.iter().map(off).fold(f64::INFINITY, f64::min);
                assert!(off <= change.error, "{name}: {change:?} off by {off}");
                if change.kind == ChangeKind::Zero {
                    assert!(change.error < 1e-11, "{name}: {change:?}");
                    zeros += 1;
                }
            }
        }
        assert!(zeros > 0, "{name} from {from}: {:?}", traced.branches);
    }
}

/// Levels that are far from those of the state leave the scale open, and nothing is said to be complete.
#[test]
fn a_state_far_from_the_leaf_tells_no_scale() {
    for (level, complete) in [(number(3, 1), true), (number(1, 1_000_000_000), false)] {
        let mut system = rigid_body([1, 2, 3], [number(1, 1), number(2, 1), number(2, 1)]);
        system.levels = vec![system.graph.number(level)];
        let (_, search) = all(system, &[]);
        assert_eq!(search.paths.is_some(), complete);
    }
}

/// `H = h (X^4 + Y^4 + Z)` on the sphere `|x| = s` with `x = s X` has the same equilibria for all s and h.
#[test]
fn scales_change_nothing() {
    let of = |s: i32, h: i32| {
        let power = |k: i32| Rational::from(10).pow(k).expect("a power");
        let scale = power(s);
        let state = [number(0, 1), &scale * &number(3, 5), &scale * &number(4, 5)];
        let mut system = rigid_body([1, 1, 1], state);
        let graph = &mut system.graph;
        let [x, y, z] = [0, 1, 2].map(|i| {
            let x = graph.symbol(Symbol::Coordinate(i));
            graph.scale(x, &power(-s))
        });
        let [xx, yy] = [x, y].map(|x| graph.mul(x, x));
        let [x4, y4] = [xx, yy].map(|x| graph.mul(x, x));
        let terms = [x4, y4, z].map(|term| (term, power(h)));
        system.hamiltonian = graph.linear(&terms);
        let (found, search) = all(system, &[]);
        let size = scale.to_f64();
        let mut states: Vec<(Vec<i64>, Stability, bool)> = found
            .iter()
            .map(|one| {
                let digits = one.state.iter().map(|x| (1e9 * x / size).round() as i64);
                (
                    digits.collect(),
                    one.judgement.stability,
                    one.judgement.proven,
                )
            })
            .collect();
        states.sort_by(|a, b| a.0.cmp(&b.0));
        let paths = search.paths.expect("polynomials");
        assert_eq!((paths.lost, paths.real), (0, 10), "{s} {h}: {paths:?}");
        states
    };
    let plain = of(0, 0);
    assert_eq!(plain.len(), 10);
    for (s, h) in [(-8, 0), (8, 0), (0, -12), (-8, -9), (8, -9), (8, 12)] {
        assert_eq!(of(s, h), plain, "{s} {h}");
    }
}
