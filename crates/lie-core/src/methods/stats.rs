//! The work of steps.

use super::StepReport;

/// The work of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Steps of the grid, shorter ones to saved times included.
    pub steps: u64,
    /// Evaluations of the vector field or of the residual of an implicit step.
    pub evaluations: u64,
    /// Iterations of the solver.
    pub newton: u64,
    /// Those among them without a Jacobian.
    pub fixed_point: u64,
    /// Jacobians factored.
    pub factorizations: u64,
    /// Steps in which some lane had a small pivot and was solved with row exchanges.
    pub pivoted: u64,
    /// Steps that an adaptive method accepted (one per step of every other method).
    pub accepted: u64,
    /// Steps that an adaptive method rejected.
    pub rejected: u64,
    /// Steps that failed.
    pub failures: u64,
}

impl Stats {
    /// Adds a step.
    pub fn add(&mut self, report: &StepReport) {
        self.steps += 1;
        self.add_work(report);
    }

    /// Adds a step that failed.
    pub fn add_failure(&mut self, report: &StepReport) {
        self.failures += 1;
        self.add_work(report);
    }

    fn add_work(&mut self, report: &StepReport) {
        self.evaluations += u64::from(report.evaluations);
        self.newton += u64::from(report.iterations);
        self.fixed_point += u64::from(report.fixed_point);
        self.factorizations += u64::from(report.factorizations);
        self.pivoted += u64::from(report.pivoted != 0);
        self.accepted += u64::from(report.substeps);
        self.rejected += u64::from(report.rejected);
    }
}
