//! Which form of a task becomes the program.

use super::collect::Collector;
use super::forms::{self, Roots};
use super::formula::Formula;
use super::judge::Judge;
use super::program::Program;
use super::{KnownSymbols, linearise, points, reuse, share, signs};
use crate::symbolic::{Graph, Symbol};

/// Forms whose repeated pairs are searched.
const MOST_SHARED: usize = 4;
/// A form that has so many times the operations of the shortest before sharing is hopeless.
const HOPELESS: usize = 2;
/// A kernel of more operations is computed as it was derived.
pub const LONGEST: usize = 5_000;

/// The choice of a program for one task.
pub struct Choice<'a> {
    graph: &'a mut Graph,
    symbols: Vec<Symbol>,
    known: KnownSymbols,
    collector: &'a mut Collector,
    budget: usize,
}

/// A form, its formula, and the program before pairs are shared.
struct Trial {
    roots: Roots,
    formula: Formula,
    program: Program,
}

impl<'a> Choice<'a> {
    pub fn new(graph: &'a mut Graph, collector: &'a mut Collector, symbols: Vec<Symbol>) -> Self {
        Self {
            graph,
            symbols,
            known: collector.known(),
            collector,
            budget: share::BUDGET,
        }
    }

    /// The program of the roots.
    pub fn program(mut self, roots: Roots) -> Program {
        // What is prepared is computed as it stands, once.
        if self.known == KnownSymbols::Nothing {
            let trial = self.trial(roots, false);
            return self.shared(trial);
        }
        let derived = self.trial(roots.clone(), false);
        // Every further form would take seconds.
        if derived.program.operations.len() > LONGEST {
            return self.shared(derived);
        }
        let references = forms::references(self.graph, &roots);
        let mut trials = vec![derived];
        for form in &references[1..] {
            trials.push(self.trial(form.clone(), false));
        }
        let points = points::points(self.graph, &self.symbols, &roots);
        let programs: Vec<&Program> = trials.iter().map(|trial| &trial.program).collect();
        let mut judge = Judge::new(self.graph, &points, &programs);
        let trials = self.admitted(trials, &references, &mut judge);
        self.best(trials, references, &mut judge)
    }

    fn trial(&mut self, roots: Roots, group: bool) -> Trial {
        let formula = Formula::new(
            self.graph,
            &self.symbols,
            &roots,
            self.known,
            group,
            &mut self.collector.answers,
        );
        Trial {
            program: reuse::reuse(linearise::linearise(&formula)),
            roots,
            formula,
        }
    }

    /// The program of a trial with pairs shared.
    fn shared(&mut self, mut trial: Trial) -> Program {
        share::share(&mut trial.formula, &mut self.budget);
        signs::signs(reuse::reuse(linearise::linearise(&trial.formula)))
    }

    /// All forms that may stand for the written one, with their variants; at least one.
    fn admitted(
        &mut self,
        mut trials: Vec<Trial>,
        references: &[Roots],
        judge: &mut Judge,
    ) -> Vec<Trial> {
        for form in forms::rewritten(self.graph, references, self.collector) {
            trials.push(self.trial(form, false));
        }
        let losses: Vec<Vec<f64>> = trials
            .iter()
            .map(|trial| judge.losses(self.graph, &trial.program))
            .collect();
        let mixed = self.mixed(&trials, &losses);
        let mut admitted: Vec<Trial> = vec![self.trial(mixed, false)];
        for (trial, losses) in trials.into_iter().zip(&losses) {
            let good = losses.iter().all(|loss| Judge::admits(*loss));
            if good && trial.roots != admitted[0].roots {
                admitted.push(trial);
            }
        }
        self.varied(promising(admitted))
    }

    /// The trials with their variants, and the best of them with common coefficients pulled out.
    fn varied(&mut self, mut tried: Vec<Trial>) -> Vec<Trial> {
        let mut variants: Vec<Roots> = Vec::new();
        for trial in &tried {
            for form in forms::variants(self.graph, &self.symbols, &trial.roots, self.collector) {
                forms::add(&mut variants, form);
            }
        }
        let plain = variants.into_iter().map(|form| {
            match tried.iter().position(|trial| trial.roots == form) {
                Some(place) => tried.swap_remove(place),
                None => self.trial(form, false),
            }
        });
        let mut trials = promising(plain.collect());
        for index in 0..trials.len() {
            if !trials[index].formula.can_group {
                continue;
            }
            let grouped = self.trial(trials[index].roots.clone(), true);
            if grouped.program != trials[index].program {
                trials.push(grouped);
            }
        }
        promising(trials)
    }

    /// Of every output the form that is cheapest by itself; where none is good enough, the best.
    fn mixed(&self, trials: &[Trial], losses: &[Vec<f64>]) -> Roots {
        let first = self.symbols.len();
        let mut roots = trials[0].roots.clone();
        let weights: Vec<Vec<usize>> = trials.iter().map(|t| t.program.weights()).collect();
        for output in 0..roots.len() - first {
            let admitted = (0..trials.len())
                .filter(|t| Judge::admits(losses[*t][output]))
                .min_by_key(|t| weights[*t][output]);
            let chosen = admitted.or_else(|| {
                (0..trials.len()).min_by(|a, b| losses[*a][output].total_cmp(&losses[*b][output]))
            });
            if let Some(chosen) = chosen {
                roots[first + output] = trials[chosen].roots[first + output];
            }
        }
        roots
    }

    /// The cheapest program after sharing among the most promising trials. Where sharing costs all of them
    /// digits, a reference takes their place; where it costs the references digits too, the least loss counts.
    fn best(&mut self, trials: Vec<Trial>, references: Vec<Roots>, judge: &mut Judge) -> Program {
        let trials = trials.into_iter();
        let mut programs: Vec<Program> = trials.map(|trial| self.shared(trial)).collect();
        programs.sort_by_key(|program| program.counts.weight());
        let mut least: Option<(f64, Program)> = None;
        for program in programs {
            if !self.loses(&program, judge, &mut least) {
                return program;
            }
        }
        for form in references {
            let trial = self.trial(form, false);
            let program = self.shared(trial);
            if !self.loses(&program, judge, &mut least) {
                return program;
            }
        }
        least.map(|(_, program)| program).unwrap_or_default()
    }

    /// Whether a program loses digits; it is kept if it loses the least so far.
    fn loses(
        &self,
        program: &Program,
        judge: &mut Judge,
        least: &mut Option<(f64, Program)>,
    ) -> bool {
        let loss = judge.worst(self.graph, program);
        if least.as_ref().is_none_or(|(known, _)| loss < *known) {
            *least = Some((loss, program.clone()));
        }
        !Judge::admits(loss)
    }
}

/// The trials that may still win, the shortest first.
fn promising(mut trials: Vec<Trial>) -> Vec<Trial> {
    trials.sort_by_key(|trial| trial.program.counts.weight());
    let shortest = trials[0].program.counts.weight();
    trials.retain(|trial| trial.program.counts.weight() <= HOPELESS * shortest);
    trials.truncate(MOST_SHARED);
    trials
}
