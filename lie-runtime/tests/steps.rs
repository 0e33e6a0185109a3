//! Single steps against values computed with 60 digits by other code.

use crate::systems;

use lie_runtime::prelude::*;
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::rigid_body::RigidBody;
use systems::{distance, state, steps};

/// One step of h against the expected state; a step of half the size must not agree.
fn check<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    h: f64,
    start: &[f64],
    expected: &[f64],
) {
    let expected = state(system, expected);
    let mut mu = state(system, start);
    steps(system, method, h, 1, &mut mu).expect("the step converges");
    let error = distance(&mu, &expected);
    assert!(error < 2e-15, "h = {h}: {error:e}");
    let mut half = state(system, start);
    steps(system, method, h / 2.0, 1, &mut half).expect("the step converges");
    assert!(distance(&half, &expected) > 1e-4);
}

#[test]
fn so3_free_rigid_body() {
    let system = RigidBody::default();
    let start = [0.45359612142557737, 0.0, 0.8912073600614353];
    let expected = [0.4526968035760509, -0.04037438307524992, 0.8907499723397803];
    check(&system, &ImplicitMidpoint, 0.1, &start, &expected);
    let expected = [
        0.4526956587110436,
        -0.040410950965410995,
        0.8907488959444437,
    ];
    check(&system, &LieMidpoint::exp(), 0.1, &start, &expected);
    let expected = [
        0.45270963866158476,
        -0.04011757747203228,
        0.8907550522117025,
    ];
    check(&system, &LieMidpoint::cayley(), 0.1, &start, &expected);
    let expected = [0.4500149672436653, 0.0804483763541566, 0.889390008937959];
    check(&system, &ImplicitMidpoint, -0.2, &start, &expected);
    let expected = [0.44999681122530183, 0.08073852147652215, 0.8893729032508497];
    check(&system, &LieMidpoint::exp(), -0.2, &start, &expected);
    let expected = [0.4502080425542984, 0.07850032643991019, 0.8894663665188552];
    check(&system, &LieMidpoint::cayley(), -0.2, &start, &expected);
}

#[test]
fn se3_heavy_top() {
    let system = HeavyTop::default();
    let start = START;
    let expected = [
        0.4442770331468836,
        0.27035767093573093,
        0.8916194216122411,
        0.3870726566901298,
        0.46339366955242534,
        0.7971455735695849,
    ];
    check(&system, &ImplicitMidpoint, 0.1, &start, &expected);
    let expected = [
        0.44431426783185435,
        0.2703323870996903,
        0.8916196206374019,
        0.38705338717993604,
        0.46340429735105637,
        0.7971487519083952,
    ];
    check(&system, &LieMidpoint::exp(), 0.1, &start, &expected);
    let expected = [
        0.4442675261197483,
        0.27041760768501044,
        0.8916185707013313,
        0.3869514103271296,
        0.4634825410042103,
        0.7971527709480322,
    ];
    check(&system, &LieMidpoint::cayley(), 0.1, &start, &expected);
    let expected = [
        0.3041180301459895,
        0.3450131065341341,
        0.9198006825288408,
        0.3041876353295267,
        0.5122136590756695,
        0.803185563844959,
    ];
    check(&system, &ImplicitMidpoint, -0.2, &start, &expected);
    let expected = [
        0.30380168659908807,
        0.34521036431748253,
        0.9197999561585876,
        0.3043724925295822,
        0.5121969612640705,
        0.8031261785443067,
    ];
    check(&system, &LieMidpoint::exp(), -0.2, &start, &expected);
    let expected = [
        0.30433406055824014,
        0.34478933690312913,
        0.9197602410951661,
        0.30523867470826554,
        0.5116824389380709,
        0.8031254155763775,
    ];
    check(&system, &LieMidpoint::cayley(), -0.2, &start, &expected);
}

#[test]
fn so3_nonpolynomial() {
    let system = Nonpolynomial;
    let start = [0.6, -0.5, 0.7];
    let expected = [0.5661521273417977, -0.4694400921244504, 0.7477284056477622];
    check(&system, &ImplicitMidpoint, 0.1, &start, &expected);
    let expected = [0.566134833965455, -0.46938061694990135, 0.747778835086041];
    check(&system, &LieMidpoint::exp(), 0.1, &start, &expected);
    let expected = [0.566011784220471, -0.46924629439924564, 0.7479562656440117];
    check(&system, &LieMidpoint::cayley(), 0.1, &start, &expected);
    let expected = [0.6687056900749127, -0.5369407616175479, 0.6037609780161372];
    check(&system, &ImplicitMidpoint, -0.2, &start, &expected);
    let expected = [0.6689157197330966, -0.537114972845499, 0.6033732392467636];
    check(&system, &LieMidpoint::exp(), -0.2, &start, &expected);
    let expected = [0.6696000468530956, -0.5381592495628427, 0.6016813104661721];
    check(&system, &LieMidpoint::cayley(), -0.2, &start, &expected);
}
