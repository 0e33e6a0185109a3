//! Events against zeros that are known in closed form.

use core::f64::consts::{PI, TAU};
use lie_runtime::driver::{EventTable, Options, Problem, Save, integrate, solve};
use lie_runtime::prelude::*;

lie_poisson! {
    system Oscillator;
    poisson { {q, p} = 1; }
    state q, p;
    parameters { a = 1; b = 0; c = 0; }
    hamiltonian = (q^2 + p^2)/2;
    observables { angle = atan2(-p, q), unwrap; }
    events {
        both = a*q + b*p - c;
        up = a*q + b*p - c, direction 1;
        down = a*q + b*p - c, direction -1;
        jump = atan2(-p, q), direction -1;
    }
}

lie_poisson! {
    system Falling;
    poisson { {q, p} = 1; }
    state q, p;
    hamiltonian = p^2/2 + q;
    events { ground = q, stop; top = p, direction -1; tenth = sin(10*pi*t); }
    initial = [1, 1];
}

// The axis x of a body of revolution goes round with the frequency z.
lie_poisson! {
    system Symmetric;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/2 + z^2;
    events { zero = x; high = y - 1/2, direction 1; }
    methods = [exact];
}

lie_poisson! {
    system Body;
    algebra = so(3);
    state x, y, z;
    parameters { i1 = 1; i2 = 2; i3 = 3; a = 1; b = 0; c = 0; q = 0; d = 0; }
    hamiltonian = x^2/(2*i1) + y^2/(2*i2) + z^2/(2*i3);
    events { zero = a*x + b*y + c*z + q*x*y - d; }
}

/// Numbers that look random, in [0, 1).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The zeros of `A cos(t - phase) - c` between two times, with their directions.
fn zeros(amplitude: f64, phase: f64, c: f64, (from, to): (f64, f64)) -> Vec<(f64, f64)> {
    let half = (c / amplitude).acos();
    let mut all = Vec::new();
    for k in -20..20 {
        let turn = phase + TAU * f64::from(k);
        all.extend([(turn - half, 1.0), (turn + half, -1.0)]);
    }
    all.retain(|(t, _)| from.min(to) < *t && *t < from.max(to));
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    if to < from {
        all.reverse();
        all.iter_mut().for_each(|(_, sign)| *sign = -*sign);
    }
    all
}

fn close<V>(found: &EventTable<V>, name: &str, expected: &[f64], far: f64) {
    let found = &found[name].t;
    assert_eq!(
        found.len(),
        expected.len(),
        "{name}: {found:?} {expected:?}"
    );
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= far,
            "{name}: {found} {expected}"
        );
    }
}

#[test]
fn a_thousand_random_events_are_those_of_the_closed_form() {
    let (mut random, mut count, mut narrow) = (Random(1), 0, 0);
    for trial in 0..260 {
        let [a, b] = [(); 2].map(|()| 2.0 * random.unit() - 1.0);
        let amplitude = a.hypot(b);
        // some reach the top by little, so that two zeros are close to each other
        let c = match trial % 4 {
            0 => amplitude * (1.0 - 10.0_f64.powf(-1.0 - 5.0 * random.unit())),
            _ => amplitude * 0.95 * (2.0 * random.unit() - 1.0),
        };
        // q = cos(t + s), p = -sin(t + s): a q + b p = A cos(t + s + arg(a + i b))
        let s = TAU * random.unit();
        let phase = -(s + b.atan2(a));
        let oscillator = Oscillator { a, b, c };
        let end = if trial % 2 == 0 { 12.0 } else { -12.0 };
        let h = (0.1 + 0.3 * random.unit()) * f64::signum(end);
        let problem = Problem::new(
            oscillator.system().unwrap(),
            [s.cos(), -s.sin()],
            (0.0, end),
        );
        let solution = solve(&problem, Gauss12, &Options::new(h)).unwrap();
        let expected = zeros(amplitude, phase, c, (0.0, end));
        // a zero where the function is flat is known the less exactly
        let slope = (amplitude * amplitude - c * c).sqrt() / amplitude;
        let far = 2e-14 / slope + 2e-14;
        let times = |sign: f64| {
            let all = expected.iter().filter(|(_, s)| sign == 0.0 || *s == sign);
            all.map(|(t, _)| *t).collect::<Vec<f64>>()
        };
        close(&solution.events, "both", &times(0.0), 10.0 * far);
        close(&solution.events, "up", &times(1.0), 10.0 * far);
        close(&solution.events, "down", &times(-1.0), 10.0 * far);
        count += expected.len();
        let pairs = expected
            .windows(2)
            .map(|pair| (pair[1].0 - pair[0].0).abs());
        narrow += pairs.filter(|gap| *gap < 0.5 * h.abs()).count();
        for (mu, t) in solution.events["both"]
            .mu
            .iter()
            .zip(&solution.events["both"].t)
        {
            let q = mu.as_slice()[0];
            assert!((q - (t + s).cos()).abs() < 1e-12);
        }
        // the grid has not moved
        let times: Vec<f64> = (0..solution.len() - 1).map(|k| k as f64 * h).collect();
        assert_eq!(solution.t[..solution.len() - 1], times);
    }
    assert!(count >= 1000, "{count}");
    assert!(narrow >= 20, "{narrow} pairs within half a step");
}

/// Bodies in elliptic functions, to 40 digits (`lab/tools/event_roots.py`, which says what a line has).
#[test]
fn a_thousand_events_of_bodies_are_where_forty_digits_have_them() {
    let (mut count, mut worst, mut in_a_step) = (0, 0.0_f64, 0);
    for line in include_str!("event_roots.txt").lines() {
        let mut parts = line.split("; ").map(|part| {
            let numbers = part.split(' ').map(|number| number.parse().unwrap());
            numbers.collect::<Vec<f64>>()
        });
        let given = parts.next().unwrap();
        let [i1, i2, i3, x, y, z, a, b, c, q, d, end] = given.try_into().unwrap();
        let body = Body {
            i1,
            i2,
            i3,
            a,
            b,
            c,
            q,
            d,
        };
        let h = 0.04 * end.signum();
        let problem = Problem::new(body.system().unwrap(), [x, y, z], (0.0, end));
        let solution = solve(&problem, Gauss16, &Options::new(h)).unwrap();
        let (found, expected) = (&solution.events["zero"].t, parts.collect::<Vec<_>>());
        assert_eq!(found.len(), expected.len(), "{line}\n{found:?}");
        for (found, expected) in found.iter().zip(&expected) {
            // what f is at the time that was found: round-off of the state, not of the search
            worst = worst.max((found - expected[0]).abs() * expected[1].abs());
        }
        let step = |t: f64| (t / h).floor();
        in_a_step += expected
            .windows(2)
            .filter(|pair| step(pair[0][0]) == step(pair[1][0]))
            .count();
        count += expected.len();
    }
    println!("{count} events, {in_a_step} pairs within a step, f there up to {worst:e}");
    assert!(count >= 1000 && in_a_step >= 5, "{count} {in_a_step}");
    assert!(worst < 2e-13, "{worst:e}");
}

#[test]
fn a_jump_is_no_zero() {
    let problem = Problem::new(Oscillator::new().system().unwrap(), [1.0, 0.5], (0.0, 20.0));
    let solution = solve(&problem, Gauss6, &Options::new(0.1)).unwrap();
    // the angle rises through zero, and falls only where it jumps
    assert_eq!(solution.events["jump"].t, Vec::<f64>::new());
    let angle: Vec<f64> = solution.quantity("angle").unwrap().copied().collect();
    assert!(angle[angle.len() - 1] > angle[0] + 5.0 * PI);
}

#[test]
fn one_that_stops_is_the_last_row() {
    let falling = Falling::new();
    let problem = Problem::new(
        falling.system().unwrap(),
        falling.initial_state(),
        (0.0, 10.0),
    );
    // q = 1 + t - t^2/2 is 0 at 1 + sqrt 3, p = 1 - t at 1
    let end = 1.0 + 3.0_f64.sqrt();
    let saves = [
        Save::Every(1),
        Save::Ends,
        Save::Interval(0.35),
        Save::At(vec![0.0, 0.5, 2.72, 2.74, 3.0, 10.0]),
    ];
    for save in saves {
        for h in [0.1, 0.25, 4.0] {
            let options = Options::new(h).save(save.clone());
            let solution = solve(&problem, Gauss4, &options).unwrap();
            assert_eq!(solution.status, Status::Event(0), "{save:?}");
            let (time, mu) = solution.last().unwrap();
            assert!((time - end).abs() < 1e-14, "{time}");
            assert!(mu.as_slice()[0].abs() < 1e-14);
            assert_eq!(solution.events["ground"].t, [time]);
            assert_eq!(solution.events["ground"].mu[0], *mu);
            assert!(
                solution.t.windows(2).all(|pair| pair[0] < pair[1]),
                "{:?}",
                solution.t
            );
            close(&solution.events, "top", &[1.0], 1e-14);
            if let Save::At(_) = save {
                assert_eq!(solution.t, [0.0, 0.5, 2.72, time]);
            }
        }
    }
    // times as a section: those of the motion, not of the function, decide how closely it is looked at
    let options = Options::new(0.05);
    let solution = solve(&problem, Gauss4, &options).unwrap();
    let tenths: Vec<f64> = (1..=27).map(|k| f64::from(k) / 10.0).collect();
    close(&solution.events, "tenth", &tenths, 1e-14);
    // who does not ask has none, and comes to the end
    let (_, status) = integrate(&problem, Gauss4, &options, &mut ()).unwrap();
    assert_eq!(status, Status::Finished);
}

#[test]
fn long_steps_have_several() {
    let body = Symmetric::new().system().unwrap();
    let start = [0.6, 0.3, 1.7];
    // x + i y = r exp(i (phase - 1.7 t))
    let (r, phase) = (0.6_f64.hypot(0.3), 0.3_f64.atan2(0.6));
    let solution = |h: f64| {
        let problem = Problem::new(body.clone(), start, (0.0, 30.0));
        solve(&problem, Exact, &Options::new(h)).unwrap()
    };
    let fine = solution(0.1);
    let omega = fine.mu[1].as_slice();
    let turned = omega[1].atan2(omega[0]) - phase;
    let (omega, sign) = (turned.abs() / 0.1, turned.signum());
    assert!((omega - 1.7).abs() < 1e-12);
    let scaled = |all: Vec<(f64, f64)>| all.into_iter().map(|(t, s)| (t / omega, s));
    // x = r cos(omega t + sign phase), y = sign r sin(omega t + sign phase)
    let zero: Vec<f64> = scaled(zeros(r, -sign * phase, 0.0, (0.0, 30.0 * omega)))
        .map(|(t, _)| t)
        .collect();
    let shift = -sign * phase + sign * PI / 2.0;
    let high = scaled(zeros(r, shift, 0.5, (0.0, 30.0 * omega)));
    let high: Vec<f64> = high
        .filter(|(_, sign)| *sign > 0.0)
        .map(|(t, _)| t)
        .collect();
    assert!(zero.len() > 15 && high.len() > 7);
    for h in [0.1, 1.0, 3.0, 7.5, 30.0] {
        let found = solution(h).events;
        close(&found, "zero", &zero, 1e-12);
        close(&found, "high", &high, 1e-12);
    }
}

#[test]
fn methods_that_choose_their_steps_have_them_too() {
    let problem = Problem::new(
        Oscillator {
            a: 1.0,
            b: 0.0,
            c: 0.3,
        }
        .system()
        .unwrap(),
        [1.0, 0.0],
        (0.0, 20.0),
    );
    let expected = zeros(1.0, 0.0, 0.3, (0.0, 20.0));
    let expected: Vec<f64> = expected.into_iter().map(|(t, _)| t).collect();
    let dopri5 = Dopri5 {
        rtol: 1e-10,
        atol: 1e-12,
    };
    let solution = solve(&problem, dopri5, &Options::new(2.5)).unwrap();
    close(&solution.events, "both", &expected, 1e-7);
    let solution = solve(&problem, Gauss6, &Options::tolerance(1e-10)).unwrap();
    close(&solution.events, "both", &expected, 1e-8);
    // steps that follow the motion
    let options = Options::new(0.1).reversible();
    let solution = solve(&problem, Gauss6, &options).unwrap();
    close(&solution.events, "both", &expected, 1e-6);
    // what a projection brings back
    let kept = Options::new(0.05).keep(Keep {
        energy: true,
        ..Keep::NOTHING
    });
    let solution = solve(&problem, Rk4, &kept).unwrap();
    close(&solution.events, "both", &expected, 1e-4);
}

#[test]
fn the_run_is_that_without_them() {
    let system = Oscillator::new().system().unwrap();
    let problem = Problem::new(system, [0.8, 0.3], (0.0, 20.3));
    let options = Options::new(0.2);
    let solution = solve(&problem, Gauss4, &options).unwrap();
    assert!(solution.events["both"].t.len() > 5);
    struct Rows(Vec<(f64, Vec<f64>)>);
    impl<P: Poisson<f64>> Observer<f64, P> for Rows {
        fn row(&mut self, _: &P, time: f64, mu: &P::State) -> core::ops::ControlFlow<()> {
            self.0.push((time, mu.as_slice().to_vec()));
            core::ops::ControlFlow::Continue(())
        }
    }
    let mut rows = Rows(Vec::new());
    let (stats, _) = integrate(&problem, Gauss4, &options, &mut rows).unwrap();
    assert_eq!(solution.stats, stats);
    let seen = solution.t.iter().zip(&solution.mu);
    let seen: Vec<_> = seen.map(|(t, mu)| (*t, mu.as_slice().to_vec())).collect();
    assert_eq!(seen, rows.0);
}
