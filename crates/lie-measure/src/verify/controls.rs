//! What a verification must notice, before it is believed.

use super::{Found, driven};
use crate::facts::{Ground, Subject, broken_measurements, unsound_iterations};
use lie_program::session::Session;
use lie_runtime::Lift;
use std::borrow::Cow;

/// What must fail, and equations with a known solution.
pub(super) fn controls<P: Lift<f64> + Clone>(
    system: &P,
    lifted: &P::Lifted,
    ground: &Ground<P>,
    subject: &Subject<P>,
    session: &mut Session<'_, Found>,
) {
    let mut broken = broken_measurements(system, lifted, ground, subject);
    if driven::is_blind(system, ground, subject) {
        broken.push("rows".into());
    }
    for fact in broken.into_iter().map(Cow::into_owned) {
        session.found(Found::Broken { fact });
    }
    for what in unsound_iterations().into_iter().map(str::to_owned) {
        session.found(Found::Unsound { what });
    }
}
