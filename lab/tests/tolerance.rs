//! Errors over tolerances of drawn members: a part of what `lab/docs/tolerance.md` has.

use lab::drawn::member::{Member, off};
use lab::measured::{Row, Way};
use lab::page::{BOUND, Summary};
use lie_runtime::generic::PowerSeries;
use lie_runtime::prelude::*;
use lie_runtime::{Poisson, Recurrence, Series};

const MEMBERS: u64 = 36;

/// With a second run no error is more than a hundred times the tolerance but where it warns, and few warn; the half of them is not far
/// below.
#[test]
fn errors_are_below_a_hundred_tolerances_or_said_to_be_above() {
    let rows: Vec<Row> = (0..MEMBERS)
        .map(Member::draw)
        .flat_map(|member| {
            [1e-6, 1e-9].map(|tolerance| Row::measure(&member, Way::Gauss16, tolerance, true))
        })
        .collect();
    let found = Summary::of(rows.iter());
    println!("{found:?}");
    assert_eq!(found.above.1, 0, "{found:?}");
    assert!(
        found.refused + found.above.0 + found.warned <= 5,
        "{found:?}"
    );
    assert!(found.uncertain <= 6, "{found:?}");
    assert!(found.ratios[found.ratios.len() / 2] > 1e-3, "{found:?}");
}

/// The control: with twice the step that was chosen the same bound fails on many of them.
#[test]
fn twice_the_step_does_not_keep_the_bound() {
    let above = (0..MEMBERS).map(Member::draw).filter(|member| {
        let span = (0.0, member.span);
        let problem = Problem::new(member.system.clone(), member.start.clone(), span);
        let options = Options::tolerance(1e-9).save(Save::Ends);
        let Ok(chosen) = solve(&problem, Gauss16, &options) else {
            return false;
        };
        let step = chosen.chosen.expect("a step was chosen").step;
        let twice = Options::new(2.0 * step).save(Save::Ends);
        let Ok(solution) = solve(&problem, Gauss16, &twice) else {
            return true;
        };
        let end = solution.mu.last().expect("the end is saved");
        off(end, &member.end) > BOUND * 1e-9
    });
    let above = above.count();
    assert!(above > 9, "{above} of {MEMBERS}");
}

/// The rules of drawn systems give the coefficients that series through the field do.
#[test]
fn coefficients_are_those_of_the_field_over_series() {
    for number in [0, 20, 40, 55, 60, 64, 70] {
        let member = Member::draw(number);
        let system = &member.system;
        let (mut rules, mut plain) = (Series::<f64>::series(system), PowerSeries::new(system));
        let mut fields: [Vec<f64>; 2] = [system.zero_state(), system.zero_state()];
        rules.begin(&member.start, &mut fields[0]);
        plain.begin(&member.start, &mut fields[1]);
        for k in 1..12 {
            let size = fields[1]
                .iter()
                .fold(1e-300_f64, |most, x| most.max(x.abs()));
            for (one, other) in fields[0].iter().zip(&fields[1]) {
                assert!((one - other).abs() < 1e-12 * size, "{number}, order {k}");
            }
            let next: Vec<f64> = fields[1].iter().map(|x| x / k as f64).collect();
            rules.advance(k, (), &next, &mut fields[0]);
            plain.advance(k, (), &next, &mut fields[1]);
        }
    }
}
