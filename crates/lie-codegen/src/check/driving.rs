//! What acts beside the Hamiltonian: forces and dissipation, and what has to be proven of them.
//!
//! `mu' = Pi(mu) xi + F` with `F = forces - R grad H + K grad S` and `xi = grad H + c G v`, `v = Pi grad H`, so that
//! `H' = <F, grad H> - c <v, G v>`. The momentum p of the time, which is carried wherever something acts, gives that power, and H + p
//! stays constant.

mod metric;

use super::constant_value;
use super::coordinates::Whole;
use super::energy::Declared;
use super::environment::Allowed;
use super::matrix;
use super::poisson::Entry;
use crate::algebra::StructureConstants;
use crate::model::{Acting, Driving, Energy, Input, Model, PoissonMatrix};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Declaration, DissipationKind, Expr, ExprKind, Metric, Name, Noise};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use metric::{Checks, Rows};

/// What is held from step to step: inputs with their defaults, then the rates of Wiener processes.
pub fn held(declaration: &Declaration, mistakes: &mut Vec<Diagnostic>) -> Vec<(String, Rational)> {
    let mut held = Vec::new();
    for input in &declaration.inputs {
        let default = match &input.default.kind {
            ExprKind::Number(value) => Ok(value.clone()),
            _ => constant_value(&input.default)
                .map(|value| Rational::from_f64(value).unwrap_or(Rational::ZERO)),
        };
        match default {
            Ok(default) => held.push((input.name.text.clone(), default)),
            Err(wrong) => mistakes.extend(wrong),
        }
        let sampling = input
            .sampling
            .as_ref()
            .map(|value| (value.origin, constant_value(value)));
        match sampling {
            Some((origin, Ok(value))) if !(value > 0.0 && value.is_finite()) => {
                let message = format!("`{}` is sampled every {value}", input.name.text);
                let help = "write a time that is positive, or leave `sampling` out to sample before every step";
                mistakes.push(Diagnostic::new(Kind::Input, origin, message).help(help));
            }
            Some((_, Err(wrong))) => mistakes.extend(wrong),
            _ => {}
        }
    }
    let own = declaration.dimension();
    let warm = declaration
        .dissipation
        .iter()
        .filter(|d| d.temperature.is_some());
    let count = declaration.noise.len() + own * warm.count();
    held.extend((1..=count).map(|k| (format!("_w{k}"), Rational::ZERO)));
    held
}

/// The inputs of a declaration that passed its checks.
pub fn inputs(declaration: &Declaration) -> Vec<Input> {
    let value = |expr: &Expr| constant_value(expr).unwrap_or(f64::NAN);
    let inputs = declaration.inputs.iter();
    inputs
        .map(|input| Input {
            name: input.name.text.clone(),
            default: value(&input.default),
            sampling: input.sampling.as_ref().map(value),
        })
        .collect()
}

/// Lowers what acts; `None` where an expression is wrong, which is reported.
pub fn acting(
    whole: &Whole<'_>,
    lower: &mut dyn FnMut(&Expr, Allowed) -> Option<ExprId>,
) -> Option<Vec<Acting>> {
    let declaration = &*whole.declaration;
    let mut all = Vec::new();
    let mut complete = true;
    for (name, value) in &declaration.forces {
        let place = declaration.state.iter().position(|c| c.text == name.text);
        let force = place.zip(lower(value, Allowed::State));
        complete &= force.is_some();
        all.extend(force.map(|(place, value)| Acting::Force(place, value)));
    }
    for dissipation in &declaration.dissipation {
        let mut rows = |rows: &[Vec<Expr>], allowed| -> Option<Rows> {
            let row =
                |row: &Vec<Expr>| -> Vec<_> { row.iter().map(|e| lower(e, allowed)).collect() };
            let lowered: Vec<Vec<Option<ExprId>>> = rows.iter().map(row).collect();
            lowered
                .into_iter()
                .map(|row| row.into_iter().collect())
                .collect()
        };
        let found = match &dissipation.kind {
            DissipationKind::DoubleBracket { strength, metric } => {
                let metric = metric.as_ref().map(|m| rows(m, Allowed::Parameters));
                let strength = lower(strength, Allowed::Parameters);
                match metric {
                    Some(metric) => strength
                        .zip(metric)
                        .map(|(c, g)| Acting::DoubleBracket(c, Some(g))),
                    None => strength.map(|c| Acting::DoubleBracket(c, None)),
                }
            }
            DissipationKind::Metriplectic { entropy, metric } => {
                let (Metric::Entries(given) | Metric::Factor(given)) = metric;
                let given = rows(given, Allowed::State);
                let entropy = lower(entropy, Allowed::State);
                entropy.zip(given).map(|(s, k)| Acting::Metriplectic(s, k))
            }
            DissipationKind::Rayleigh { matrix } => {
                rows(matrix, Allowed::Parameters).map(Acting::Rayleigh)
            }
        };
        complete &= found.is_some();
        all.extend(found);
        if let Some(temperature) = &dissipation.temperature {
            let temperature = lower(temperature, Allowed::Parameters);
            complete &= temperature.is_some();
            all.extend(temperature.map(Acting::Temperature));
        }
    }
    for noise in &declaration.noise {
        let found = match noise {
            Noise::Hamiltonian(value) => lower(value, Allowed::State).map(Acting::HamiltonianNoise),
            Noise::Force(parts) => {
                let part = |(name, value): &(Name, Expr)| {
                    let place = declaration.state.iter().position(|c| c.text == name.text);
                    place.zip(lower(value, Allowed::State))
                };
                let parts: Vec<Option<(usize, ExprId)>> = parts.iter().map(part).collect();
                let parts: Option<Vec<_>> = parts.into_iter().collect();
                parts.map(Acting::ForceNoise)
            }
        };
        complete &= found.is_some();
        all.extend(found);
    }
    complete.then_some(all)
}

/// What dissipation promises and does not hold at values of the parameters: why, as text with a remedy.
pub fn violation(model: &Model, values: &[f64]) -> Option<Diagnostic> {
    let driving = model.driving.as_ref()?;
    let name = |symbol| model.symbol_name(symbol);
    let configuration = model.configuration.as_ref()?;
    let checks = Checks {
        origin: model.name_origin,
        own: configuration.own_momenta(),
        defaults: values,
        name: &name,
    };
    let mut declared = driving.declared.iter();
    let wrong = declared.find_map(|acting| match acting {
        Acting::DoubleBracket(strength, metric) => {
            let wrong = checks.strength(&model.graph, *strength);
            let metric = metric.as_ref();
            wrong.or_else(|| checks.damps(&model.graph, "the metric G", metric?))
        }
        Acting::Rayleigh(rows) => checks.damps(&model.graph, "the matrix R", rows),
        Acting::Temperature(temperature) => checks.temperature(&model.graph, *temperature),
        _ => None,
    })?;
    let message = wrong
        .message
        .replace("at the default parameters", "at these parameters");
    Some(Diagnostic { message, ..wrong })
}

/// What the motion of a driven system is made of.
pub struct Sources<'a> {
    /// The declaration in all its coordinates.
    pub whole: &'a Whole<'a>,
    /// The structure constants.
    pub constants: Option<&'a StructureConstants<ExprId>>,
    /// The brackets of coordinates.
    pub brackets: &'a [Entry],
    /// The Hamiltonian.
    pub energy: &'a Energy<Declared>,
    /// The defaults of the parameters.
    pub defaults: &'a [f64],
    /// The names of symbols.
    pub name: &'a dyn Fn(Symbol) -> String,
}

/// What acts on a system; `None` where nothing does, or something is wrong, which is reported.
pub fn driving(
    graph: &mut Graph,
    sources: &Sources<'_>,
    mut declared: Vec<Acting>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Driving> {
    let declaration = &*sources.whole.declaration;
    if !declaration.is_driven() {
        return None;
    }
    if let Some(mistake) = refused(declaration, sources) {
        mistakes.push(mistake);
        return None;
    }
    let (configuration, energy) = sources
        .whole
        .configuration
        .as_ref()
        .zip(sources.energy.expression())?;
    let (own, clock) = (configuration.own_momenta(), configuration.clock()?);
    let matrix = matrix::poisson_matrix(
        graph,
        declaration.dimension(),
        sources.constants,
        sources.brackets,
    );
    let mut work = Work {
        own,
        slopes: slopes(graph, energy.value, declaration.dimension()),
        matrix,
        graph,
    };
    let zero = work.graph.integer(0);
    let nothing = vec![zero; declaration.dimension()];
    let (mut force, mut damping) = (nothing.clone(), nothing.clone());
    // what noise adds to both, which is no work
    let mut noise = Loud {
        force: nothing.clone(),
        damping: nothing,
        next: declaration.dimension() - configuration.held.len() + declaration.inputs.len(),
    };
    let mut dissipations = declaration.dissipation.iter();
    let (mut dissipation, mut before) = (None, None);
    let count = mistakes.len();
    for acting in &mut declared {
        let own_entry = matches!(
            acting,
            Acting::DoubleBracket(..) | Acting::Metriplectic(..) | Acting::Rayleigh(_)
        );
        if own_entry {
            dissipation = dissipations.next();
        }
        let checks = Checks {
            origin: dissipation.map_or(declaration.name.origin, |d| d.origin),
            own,
            defaults: sources.defaults,
            name: sources.name,
        };
        match acting {
            Acting::Force(place, value) => force[*place] = work.graph.add(force[*place], *value),
            Acting::Rayleigh(rows) => {
                mistakes.extend(checks.damps(work.graph, "the matrix R", rows));
                work.add_rayleigh(rows, &mut force);
            }
            Acting::DoubleBracket(strength, metric) => {
                mistakes.extend(checks.strength(work.graph, *strength));
                if let Some(rows) = metric {
                    let symmetric = checks.symmetric(work.graph, "the metric G", rows);
                    let wrong =
                        symmetric.or_else(|| checks.damps(work.graph, "the metric G", rows));
                    mistakes.extend(wrong);
                }
                work.add_double_bracket(*strength, metric.as_ref(), &mut damping, clock.time);
            }
            Acting::Metriplectic(entropy, rows) => {
                let held = clock.time..declaration.dimension();
                let symbols = work.graph.symbols(*entropy).into_iter();
                let mut outside = symbols.filter(
                    |symbol| matches!(symbol, Symbol::Coordinate(place) if held.contains(place)),
                );
                if outside.next().is_some() {
                    let message = "the entropy depends on the time or on an input, and would change without the motion";
                    let help = "write a function of the state and of parameters";
                    let mistake = Diagnostic::new(Kind::Dissipation, checks.origin, message);
                    mistakes.push(mistake.help(help));
                }
                let factor = matches!(
                    dissipation.map(|d| &d.kind),
                    Some(DissipationKind::Metriplectic {
                        metric: Metric::Factor(_),
                        ..
                    })
                );
                let found = work.metriplectic(*entropy, rows, factor, &checks);
                mistakes.extend(found.map(|k| *rows = k).err());
                work.add_metriplectic(*entropy, rows, &mut force);
            }
            Acting::HamiltonianNoise(function) => {
                work.add_hamiltonian_noise(*function, &mut noise, clock.time)
            }
            Acting::ForceNoise(parts) => {
                let rate = noise.rate(work.graph);
                for (place, value) in parts {
                    let part = work.graph.mul(*value, rate);
                    noise.force[*place] = work.graph.add(noise.force[*place], part);
                }
            }
            Acting::Temperature(temperature) => {
                mistakes.extend(checks.temperature(work.graph, *temperature));
                let wrong = match &before {
                    Some(Acting::DoubleBracket(strength, metric)) => work.warm(
                        &checks,
                        (*temperature, Some(*strength)),
                        metric.as_ref(),
                        &mut noise,
                        clock.time,
                    ),
                    Some(Acting::Rayleigh(rows)) => work.warm(
                        &checks,
                        (*temperature, None),
                        Some(rows),
                        &mut noise,
                        clock.time,
                    ),
                    _ => None,
                };
                mistakes.extend(wrong);
            }
        }
        before = Some(acting.clone());
    }
    if mistakes.len() > count {
        return None;
    }
    let power = work.power(&force);
    damping[clock.time] = work.graph.add(damping[clock.time], power);
    for (sum, part) in force.iter_mut().zip(&noise.force) {
        *sum = work.graph.add(*sum, *part);
    }
    for (sum, part) in damping.iter_mut().zip(&noise.damping) {
        *sum = work.graph.add(*sum, *part);
    }
    Some(Driving {
        force,
        damping,
        declared,
        noises: configuration.held.len() - declaration.inputs.len(),
    })
}

/// What noise adds to the force and to the generator.
struct Loud {
    force: Vec<ExprId>,
    damping: Vec<ExprId>,
    /// The coordinate of the rate of the next Wiener process.
    next: usize,
}

impl Loud {
    /// The rate `dW/dt` of the next Wiener process.
    fn rate(&mut self, graph: &mut Graph) -> ExprId {
        let place = self.next;
        self.next += 1;
        graph.symbol(Symbol::Coordinate(place))
    }
}

/// What no driven system is yet, or can be.
fn refused(declaration: &Declaration, sources: &Sources<'_>) -> Option<Diagnostic> {
    let origin = declaration.place_of_driving();
    let origin = origin.unwrap_or(declaration.name.origin);
    let mistake = |origin: Origin, message: &str, help: &str| {
        Some(Diagnostic::new(Kind::Dissipation, origin, message).help(help))
    };
    if sources.energy.expression().is_none() {
        let message = "forces, dissipation, noise and inputs need H as an expression, and the Legendre transform of the Lagrangian is by iteration";
        return mistake(origin, message, "declare the `hamiltonian`");
    }
    let along = |kind: &DissipationKind| matches!(kind, DissipationKind::DoubleBracket { .. });
    let mut along = declaration.dissipation.iter().filter(|d| along(&d.kind));
    if declaration.group.is_some()
        && let Some(bracket) = along.next()
    {
        let message = "a double bracket moves along the coadjoint orbit, and beside a group element that is all of T*G: \
                       the velocity of the group element would not be grad H";
        let help = "leave `group` out, or use `rayleigh` or `forces`, which change mu alone";
        return mistake(bracket.origin, message, help);
    }
    None
}

fn slopes(graph: &mut Graph, energy: ExprId, dimension: usize) -> Vec<ExprId> {
    let slopes = (0..dimension).map(|i| graph.derivative(energy, Symbol::Coordinate(i)));
    slopes.collect()
}

/// What the expressions of a driven system are made of.
struct Work<'a> {
    graph: &'a mut Graph,
    /// How many coordinates were declared; they come first.
    own: usize,
    /// The gradient of H with the momentum of the time.
    slopes: Vec<ExprId>,
    matrix: PoissonMatrix,
}

impl Work<'_> {
    /// `Pi w` in the declared coordinates.
    fn moved(&mut self, w: &[ExprId]) -> Vec<ExprId> {
        let mut terms = vec![Vec::new(); w.len()];
        for (i, j, entry) in &self.matrix.entries {
            let forth = self.graph.mul(*entry, w[*j]);
            let back = self.graph.mul(*entry, w[*i]);
            terms[*i].push(forth);
            terms[*j].push(self.graph.scale(back, &Rational::MINUS_ONE));
        }
        let own = terms.into_iter().take(self.own);
        own.map(|terms| self.graph.sum(&terms)).collect()
    }

    /// `M w` of the first coordinates.
    fn times(&mut self, rows: &Rows, w: &[ExprId]) -> Vec<ExprId> {
        let row = |row: &Vec<ExprId>| {
            let products: Vec<ExprId> = row
                .iter()
                .zip(w)
                .map(|(a, b)| self.graph.mul(*a, *b))
                .collect();
            self.graph.sum(&products)
        };
        rows.iter().map(row).collect()
    }

    fn add_rayleigh(&mut self, rows: &Rows, force: &mut [ExprId]) {
        let slopes = self.slopes.clone();
        for (slot, drag) in force.iter_mut().zip(self.times(rows, &slopes)) {
            *slot = self.graph.sub(*slot, drag);
        }
    }

    fn add_double_bracket(
        &mut self,
        strength: ExprId,
        metric: Option<&Rows>,
        damping: &mut [ExprId],
        time: usize,
    ) {
        let slopes = self.slopes.clone();
        let v = self.moved(&slopes);
        let lowered = match metric {
            Some(rows) => self.times(rows, &v),
            None => v.clone(),
        };
        let mut power = Vec::new();
        for (i, (v, w)) in v.into_iter().zip(lowered).enumerate() {
            let part = self.graph.mul(strength, w);
            damping[i] = self.graph.add(damping[i], part);
            power.push(self.graph.mul(part, v));
        }
        let power = self.graph.sum(&power);
        damping[time] = self.graph.sub(damping[time], power);
    }

    /// `xi += grad sigma dW/dt`, without what that does to the momentum of the time.
    fn add_hamiltonian_noise(&mut self, function: ExprId, noise: &mut Loud, time: usize) {
        let rate = noise.rate(self.graph);
        for (i, slope) in slopes(self.graph, function, self.slopes.len())
            .into_iter()
            .enumerate()
        {
            if i != time {
                let part = self.graph.mul(slope, rate);
                noise.damping[i] = self.graph.add(noise.damping[i], part);
            }
        }
    }

    /// The noise of a dissipation at a temperature T: `sigma sigma^T = 2 c T G` along the orbit with the strength c, `2 T R` as a force
    /// without one.
    fn warm(
        &mut self,
        checks: &Checks<'_>,
        (temperature, strength): (ExprId, Option<ExprId>),
        metric: Option<&Rows>,
        noise: &mut Loud,
        time: usize,
    ) -> Option<Diagnostic> {
        if strength.is_none() {
            let rows = metric?;
            if let Some(mistake) = checks.symmetric(self.graph, "the matrix R", rows) {
                return Some(mistake);
            }
            let divergence = self.divergence();
            if let Some(mistake) = checks.unimodular(self.graph, &divergence) {
                return Some(mistake);
            }
        }
        let two = self.graph.integer(2);
        let half = Rational::ONE / Rational::from(2);
        let mut factors = vec![two, temperature];
        factors.extend(strength);
        let scale = self.graph.product(&factors);
        let (columns, pivots) = checks.factors(self.graph, metric);
        for (column, pivot) in columns.into_iter().zip(pivots) {
            let square = self.graph.mul(scale, pivot);
            let amplitude = self.graph.pow(square, &half);
            let rate = noise.rate(self.graph);
            let rate = self.graph.mul(amplitude, rate);
            let target = match strength {
                Some(_) => &mut noise.damping,
                None => &mut noise.force,
            };
            for (i, entry) in column.into_iter().enumerate() {
                let part = self.graph.mul(entry, rate);
                target[i] = self.graph.add(target[i], part);
            }
        }
        debug_assert!(
            self.graph.is_zero(noise.damping[time]),
            "noise does no work"
        );
        None
    }

    /// `sum_i dPi_ij/dx_i` for each declared coordinate j: zero where every Hamiltonian field has no divergence.
    fn divergence(&mut self) -> Vec<ExprId> {
        let mut terms = vec![Vec::new(); self.own];
        for (i, j, entry) in &self.matrix.entries {
            if *i < self.own && *j < self.own {
                terms[*j].push(self.graph.derivative(*entry, Symbol::Coordinate(*i)));
                let other = self.graph.derivative(*entry, Symbol::Coordinate(*j));
                terms[*i].push(self.graph.neg(other));
            }
        }
        terms
            .into_iter()
            .map(|terms| self.graph.sum(&terms))
            .collect()
    }

    fn add_metriplectic(&mut self, entropy: ExprId, rows: &Rows, force: &mut [ExprId]) {
        let slopes = slopes(self.graph, entropy, self.own);
        for (slot, push) in force.iter_mut().zip(self.times(rows, &slopes)) {
            *slot = self.graph.add(*slot, push);
        }
    }

    /// The metric K, once all that it promises is proven.
    fn metriplectic(
        &mut self,
        entropy: ExprId,
        rows: &Rows,
        factor: bool,
        checks: &Checks<'_>,
    ) -> Result<Rows, Diagnostic> {
        let rows = match factor {
            true => checks.square(self.graph, rows)?,
            false => rows.clone(),
        };
        checks.shape("the metric K", &rows).map_or(Ok(()), Err)?;
        let degenerate = self.times(&rows, &self.slopes.clone());
        let mut slopes = slopes(self.graph, entropy, self.own);
        slopes.resize(self.slopes.len(), self.graph.integer(0));
        let moved = self.moved(&self.slopes.clone());
        let products = moved.iter().zip(&slopes);
        let products: Vec<ExprId> = products.map(|(a, b)| self.graph.mul(*a, *b)).collect();
        let bracket = self.graph.sum(&products);
        checks.metriplectic(self.graph, &rows, factor, &degenerate, bracket)?;
        Ok(rows)
    }

    /// `<F, grad H>`
    fn power(&mut self, force: &[ExprId]) -> ExprId {
        let parts = force.iter().zip(&self.slopes).take(self.own);
        let parts: Vec<ExprId> = parts.map(|(f, g)| self.graph.mul(*f, *g)).collect();
        self.graph.sum(&parts)
    }
}
