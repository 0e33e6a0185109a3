//! Several runs, and what tells them apart.

use lie_program::protocol::Start;

use super::Plan;

/// The names of what tells runs apart, which stand before the columns.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// The number of the run, from 0 on.
    pub run: String,
    /// The method, where there are several. Its column is text: an array has none.
    pub method: Option<String>,
    /// Parameters with several values.
    pub parameters: Vec<String>,
}

/// Runs: of each method those of all values of the parameters, and of these those of all initial states.
#[derive(Debug)]
pub struct Several {
    /// A plan for each method.
    pub plans: Vec<Plan>,
    /// The runs.
    pub members: Vec<Member>,
    /// What tells them apart; nothing for one run alone.
    pub labels: Option<Labels>,
}

impl Several {
    /// Whether another run has the method and the parameters of a run: those that differ in their initial states alone are
    /// neighbours.
    pub fn repeated(&self, number: usize) -> bool {
        let of = |number: usize| {
            let member = self.members.get(number)?;
            Some((member.plan, &member.parameters))
        };
        let own = of(number);
        own.is_some() && (of(number + 1) == own || (number > 0 && of(number - 1) == own))
    }

    /// The method, where all runs have the same.
    pub fn method(&self) -> Option<String> {
        match self.plans.as_slice() {
            [plan] => Some(plan.method.title()),
            _ => None,
        }
    }

    /// Whether runs differ in parameters.
    pub fn parameters_differ(&self) -> bool {
        let mut starts = self.members.iter().map(|member| &member.start.parameters);
        let first = starts.next();
        starts.any(|other| Some(other) != first)
    }
}

/// One of several runs.
#[derive(Clone, Debug)]
pub struct Member {
    /// Which of the plans.
    pub plan: usize,
    /// Which of the points: runs of several methods from one have the same noise.
    pub point: usize,
    /// The values of the parameters that have several.
    pub parameters: Vec<f64>,
    /// Where it starts.
    pub start: Start,
}
