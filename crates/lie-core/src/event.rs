//! Which zeros of a function are events.

/// Which zeros of a function along a run count, and what they do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct EventRule {
    /// 1 for zeros where the function rises with the run, -1 for those where it falls, 0 for both.
    pub direction: i8,
    /// Whether the first of them ends the run.
    pub stops: bool,
}

impl EventRule {
    /// Whether a zero counts behind which the function has this sign.
    pub fn counts(self, sign: f64) -> bool {
        self.direction == 0 || f64::from(self.direction) * sign > 0.0
    }
}
