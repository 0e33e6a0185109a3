//! Branches of angles.

use super::Scalar;
use core::f64::consts::TAU;

/// `angle + 2 pi k` within pi of another angle, lane by lane.
pub fn nearest_branch<S: Scalar>(angle: S, other: S) -> S {
    let mut found = angle;
    for lane in 0..S::LANES {
        let turns = libm::round((other.lane(lane) - angle.lane(lane)).to_f64() / TAU);
        if turns != 0.0 && turns.is_finite() {
            let turn = S::Lane::constant(TAU, 2.449_293_598_294_706_4e-16);
            let angle = angle.lane(lane) + S::Lane::from_f64(turns) * turn;
            found = found.with_lane(lane, angle);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    #[test]
    fn the_nearest_branch_is_taken() {
        for k in -5..5 {
            let branch = f64::from(k) * TAU;
            for offset in [-3.1, -1.0, 0.0, 1.0, 3.1] {
                let found: f64 = nearest_branch(0.5 + offset, branch + 0.5);
                assert!(
                    (found - (branch + 0.5 + offset)).abs() < 1e-13,
                    "{k} {offset}"
                );
            }
        }
        assert_eq!(nearest_branch(PI - 0.1, -PI + 0.1 + TAU), PI - 0.1);
        assert!(nearest_branch(f64::NAN, 1.0).is_nan());
    }

    #[test]
    fn lanes_are_unwrapped_each_by_itself() {
        type Wide = <f64 as Scalar>::Wide;
        let angle = Wide::from_lanes(|k| 0.1 * k as f64);
        let other = Wide::from_lanes(|k| 7.0 * k as f64);
        let found = nearest_branch(angle, other);
        for lane in 0..Wide::LANES {
            let alone = nearest_branch(0.1 * lane as f64, 7.0 * lane as f64);
            assert_eq!(found.lane(lane), alone);
            assert!((alone - 7.0 * lane as f64).abs() <= PI);
        }
    }
}
