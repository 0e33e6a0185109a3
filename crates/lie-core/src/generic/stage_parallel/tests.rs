use super::*;
use crate::generic::pair::Pair;
use crate::generic::tableau::gauss_entry;

type Wide = <f64 as Scalar>::Wide;

/// A free body with moments 2, 1, 2/3: `m' = m x Omega`, `Omega = (m1/2, m2, 3 m3/2)`.
fn body(at: At<'_, [Wide; 3]>, out: &mut [Wide; 3]) {
    let [x, y, z] = *at.points;
    let wide = |number: f64| Scalar::widen(number);
    out[0] = wide(0.5) * y * z;
    out[1] = wide(-1.0) * z * x;
    out[2] = wide(0.5) * x * y;
}

/// The coefficients of a step: those of the method, or entries and weights rounded one by one, for slopes as the unknowns.
#[derive(Clone, Copy, PartialEq)]
enum Table {
    Ratios,
    Entries,
}

/// The square of the momentum, in pairs.
fn square(stages: &StageParallel<f64, [Wide; 3], 8>) -> Pair {
    let mut m = [0.0; 3];
    stages.base_into(&mut m);
    let squares = m.map(|entry| Pair::new(entry).times(Pair::new(entry)));
    squares[0].plus(squares[1]).plus(squares[2])
}

/// The mean and its standard error, over states, of what a step of `gauss16` changes in the square of the momentum.
fn bias(table: Table, h: f64, states: u32, steps: u32) -> [f64; 2] {
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let means: Vec<f64> = (0..states)
        .map(|_| {
            let start = [0.3 + 0.7 * next().abs(), next(), next()];
            let zero = [Wide::default(); 3];
            let mut stages =
                StageParallel::<f64, [Wide; 3], 8>::new(h, zero, &NewtonOptions::default());
            let weights = stages.weights;
            if table == Table::Entries {
                let ahead = |i, j| {
                    let weights = [i, j].map(|k| gauss_weight::<f64>(8, k));
                    gauss_ahead::<f64>(8, i, j) * weights[1] / weights[0]
                };
                stages.ratios = diagonals(8, 8, |i, j| h * gauss_entry::<f64>(8, i, j));
                stages.ahead = diagonals(8, 8, ahead);
                stages.weights = 1.0.widen();
                stages.per_weight = 1.0.widen();
            }
            stages.start(true, &start, &[0.0; 3]);
            let before = square(&stages);
            for step in 0..steps {
                if step > 0 {
                    stages.go_on();
                }
                assert!(stages.iterate(body).converged);
                if table == Table::Ratios {
                    stages.advance();
                } else {
                    for (y, slopes) in stages.base.iter_mut().zip(&stages.work.increments) {
                        *y += total::<f64>(weights * *slopes);
                    }
                }
            }
            square(&stages).sub(before).high / before.high / f64::from(steps)
        })
        .collect();
    let count = f64::from(states);
    let mean = means.iter().sum::<f64>() / count;
    let variance = means.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
    [mean, (variance / count).sqrt()]
}

/// A walk of 1.1e-16 a step leaves a mean of 2e-19 after 25,000 steps of 16 states; rounded entries leave 4e-18.
fn is_a_walk(h: f64, states: u32, steps: u32, bound: f64, control: f64) {
    let [walk, error] = bias(Table::Ratios, h, states, steps);
    println!("h = {h}: {walk:e} ± {error:e}");
    let [drift, error] = bias(Table::Entries, h, states, steps);
    println!("    rounded entries: {drift:e} ± {error:e}");
    assert!(walk.abs() < bound, "{walk:e}");
    assert!(drift.abs() > control, "{drift:e}");
}

#[test]
fn round_off_of_invariants_walks() {
    is_a_walk(1.5, 16, 25_000, 9e-19, 2e-18);
}

/// The same to 3e-19, five standard errors.
#[test]
#[ignore = "a quarter of a minute; .ci/nightly asks for it"]
fn round_off_of_invariants_walks_for_long() {
    is_a_walk(1.5, 16, 200_000, 3e-19, 2e-18);
}
