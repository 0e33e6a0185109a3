//! The flows of the pieces of H.

use crate::code::Code;
use crate::compiled::CodeBuilder;
use crate::system::Dynamic;
use crate::system::answers::{Families as _, without_loops};
use crate::system::family::FamilySite;
use lie_codegen::derive::{Shape, Update};
use lie_codegen::plan::{Flow, Found, Function, Plan};
use lie_core::family::FamilyFlows;
use lie_core::generic::{CoordinateFlows, DrivenFlows, piece_direction};
use lie_runtime::{FoundPoisson, LiePoisson, PieceFlows, Poisson, Scalar, SeparablePoisson};

/// The flow of a function of one coordinate: its code, and what is done with each result. Without it the flow is that of its
/// series.
#[derive(Debug)]
struct FlowCode {
    coordinate: usize,
    code: Option<(usize, Vec<(usize, Update)>)>,
}

#[derive(Debug)]
struct Part {
    flows: Option<Vec<FlowCode>>,
    direction: usize,
}

#[derive(Debug)]
struct Piece {
    parts: Vec<Part>,
    direction: usize,
}

/// How H was split.
#[derive(Debug, Default)]
pub struct Codes {
    coordinate: Option<Vec<FlowCode>>,
    found: Option<(Vec<Piece>, bool)>,
}

impl Codes {
    pub(crate) fn new(plan: &Plan, making: &mut CodeBuilder) -> Self {
        let splitting = plan.splitting.as_ref();
        let coordinate = splitting.map(|s| s.flows.iter().map(|f| flow(f, making)).collect());
        let found = match &plan.found {
            Some(Found::Pieces { pieces, whole, .. }) => {
                let pieces = pieces.iter().map(|piece| {
                    let direction = making.kernel(&piece.direction);
                    let parts = piece.parts.iter().map(|part| Part {
                        flows: part
                            .flows
                            .as_ref()
                            .map(|flows| flows.iter().map(|known| flow(known, making)).collect()),
                        direction: part
                            .direction
                            .as_ref()
                            .map_or(direction, |kernel| making.kernel(kernel)),
                    });
                    let parts = parts.collect();
                    Piece { parts, direction }
                });
                Some((pieces.collect(), *whole))
            }
            _ => None,
        };
        Self { coordinate, found }
    }
}

fn flow(flow: &Flow, making: &mut CodeBuilder) -> FlowCode {
    let function = flow.function.as_ref();
    FlowCode {
        coordinate: flow.coordinate,
        code: function.map(|function| updates(function, &flow.updates, making)),
    }
}

/// The code of a kernel whose results change entries of a state: which ones, and how.
pub(crate) fn updates(
    function: &Function,
    updates: &[Update],
    making: &mut CodeBuilder,
) -> (usize, Vec<(usize, Update)>) {
    let mut code = Code::from_kernel(function, usize::MAX.isqrt());
    // the results are updates, not the whole vector
    code.clear = [None, None];
    let rows = match &function.shape {
        Shape::Vector(rows) => rows.clone(),
        _ => Vec::new(),
    };
    for (entry, store) in (0..).zip(&mut code.stores) {
        store.entry = entry;
    }
    let updates = rows.into_iter().zip(updates.iter().copied()).collect();
    (making.push(code), updates)
}

/// Changes entries of a state by such results.
pub(crate) fn update<S: Scalar>(updates: &[(usize, Update)], results: &[S], mu: &mut [S]) {
    for ((row, update), result) in updates.iter().zip(results) {
        match update {
            Update::Add => mu[*row] += *result,
            Update::Subtract => mu[*row] -= *result,
            Update::Multiply => mu[*row] *= *result,
            Update::Divide => mu[*row] /= *result,
            Update::Replace => mu[*row] = *result,
        }
    }
}

/// The flows of the pieces of a system.
pub struct Flows<'a, S: Scalar> {
    system: &'a Dynamic<S>,
    series: CoordinateFlows<'a, S, Dynamic<S>>,
    results: Vec<S>,
    start: Vec<S>,
    xi: Vec<S>,
    found: bool,
}

impl<'a, S: Scalar> Flows<'a, S> {
    fn new(system: &'a Dynamic<S>, found: bool) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            series: CoordinateFlows::new(system),
            results: zero.clone(),
            start: zero.clone(),
            xi: zero,
            found: found && system.values.compiled.flows.found.is_some(),
        }
    }

    /// Pieces that were found and are not those of the coordinates.
    fn pieces_found(&self) -> &'a [Piece] {
        match &self.system.values.compiled.flows.found {
            Some((pieces, _)) if self.found => pieces,
            _ => &[],
        }
    }

    fn coordinates(&self) -> Option<&'a [FlowCode]> {
        self.system.values.compiled.flows.coordinate.as_deref()
    }

    fn of_coordinate(&mut self, flow: &FlowCode, t: S, mu: &mut Vec<S>) {
        let Some((code, updates)) = &flow.code else {
            self.series.flow(flow.coordinate, t, mu);
            return;
        };
        let (values, scalars) = (&self.system.values, [S::zero(), t]);
        let frame = values.frame([mu, &[], &[], &[]], &[], &scalars);
        values.run(*code, &frame, [&mut self.results, &mut []]);
        update(updates, &self.results, mu);
    }

    fn along(&self, direction: usize, t: S, mu: &[S], xi: &mut [S]) {
        self.system.values.call(direction, [mu, &[]], xi, &mut []);
        for entry in xi {
            *entry = t * *entry;
        }
    }

    fn of_part(&mut self, part: &Part, t: S, mu: &mut Vec<S>) {
        if let Some(flows) = &part.flows {
            for flow in flows {
                self.of_coordinate(flow, t, mu);
            }
            return;
        }
        self.start.copy_from_slice(mu);
        let mut xi = std::mem::take(&mut self.xi);
        self.along(part.direction, t, mu, &mut xi);
        self.system.coadjoint_action(&xi, &self.start, mu);
        self.xi = xi;
    }
}

impl<S: Scalar> PieceFlows<S> for Flows<'_, S> {
    type State = Vec<S>;

    fn pieces(&self) -> usize {
        match (self.found, self.coordinates()) {
            (true, _) => self.pieces_found().len(),
            (false, Some(flows)) => flows.len(),
            (false, None) => self.series.pieces(),
        }
    }

    fn direction(&self, piece: usize, t: S, mu: &Vec<S>, xi: &mut Vec<S>) {
        match (self.found, self.coordinates()) {
            (true, _) => self.along(self.pieces_found()[piece].direction, t, mu, xi),
            (false, Some(flows)) => {
                piece_direction(self.system, flows[piece].coordinate, t, mu, xi);
            }
            (false, None) => self.series.direction(piece, t, mu, xi),
        }
    }

    fn flow(&mut self, piece: usize, t: S, mu: &mut Vec<S>) {
        match (self.found, self.coordinates()) {
            (true, _) => {
                for part in &self.pieces_found()[piece].parts {
                    self.of_part(part, t, mu);
                }
            }
            (false, Some(flows)) => self.of_coordinate(&flows[piece], t, mu),
            (false, None) => self.series.flow(piece, t, mu),
        }
    }

    fn follow(
        &mut self,
        piece: usize,
        t: S,
        mu: &mut Vec<S>,
        factor: &mut Vec<S>,
        give: &mut dyn FnMut(&mut Vec<S>),
    ) {
        if !self.found {
            self.direction(piece, t, mu, factor);
            give(factor);
            self.flow(piece, t, mu);
            return;
        }
        for part in &self.pieces_found()[piece].parts {
            self.along(part.direction, t, mu, factor);
            give(factor);
            self.of_part(part, t, mu);
        }
    }

    fn rest(&self, t: S, mu: &Vec<S>, xi: &mut Vec<S>) -> bool {
        let whole = self
            .system
            .values
            .compiled
            .flows
            .found
            .as_ref()
            .is_none_or(|found| found.1);
        if !self.found || whole {
            return false;
        }
        let mut part = mu.clone();
        self.system.gradient(mu, xi);
        for piece in self.pieces_found() {
            self.system
                .values
                .call(piece.direction, [mu, &[]], &mut part, &mut []);
            for (entry, part) in xi.iter_mut().zip(&part) {
                *entry -= *part;
            }
        }
        for entry in xi.iter_mut() {
            *entry = t * *entry;
        }
        true
    }
}

impl<S: Scalar> SeparablePoisson<S> for Dynamic<S> {
    type Flows<'a> = Flows<'a, S>;
    fn flows(&self) -> Flows<'_, S> {
        Flows::new(self, false)
    }
}

/// The flows of the pieces that were found: of a system, or of the sites of a family.
pub enum AnyFlows<'a, S: Scalar> {
    /// Of a system.
    System(Flows<'a, S>),
    /// Of a family.
    Family(FamilyFlows<'a, S, FamilySite<S>>),
}

macro_rules! any {
    ($flows:expr, $some:ident => $value:expr) => {
        match $flows {
            AnyFlows::System($some) => $value,
            AnyFlows::Family($some) if S::FAMILIES => $value,
            AnyFlows::Family(_) => without_loops(),
        }
    };
}

impl<S: Scalar> PieceFlows<S> for AnyFlows<'_, S> {
    type State = Vec<S>;

    fn pieces(&self) -> usize {
        any!(self, flows => flows.pieces())
    }
    fn gather(&mut self, mu: &Vec<S>, next: &mut Vec<S>) {
        any!(self, flows => flows.gather(mu, next));
    }
    fn scatter(&self, lanes: S::Mask, next: &Vec<S>, mu: &mut Vec<S>) {
        any!(self, flows => flows.scatter(lanes, next, mu));
    }
    fn direction(&self, piece: usize, t: S, mu: &Vec<S>, xi: &mut Vec<S>) {
        any!(self, flows => flows.direction(piece, t, mu, xi));
    }
    fn flow(&mut self, piece: usize, t: S, mu: &mut Vec<S>) {
        any!(self, flows => flows.flow(piece, t, mu));
    }
    fn follow(
        &mut self,
        piece: usize,
        t: S,
        mu: &mut Vec<S>,
        factor: &mut Vec<S>,
        give: &mut dyn FnMut(&mut Vec<S>),
    ) {
        any!(self, flows => flows.follow(piece, t, mu, factor, give));
    }
    fn rest(&self, t: S, mu: &Vec<S>, xi: &mut Vec<S>) -> bool {
        any!(self, flows => flows.rest(t, mu, xi))
    }
}

impl<S: Scalar> FoundPoisson<S> for Dynamic<S> {
    type Found<'a> = DrivenFlows<'a, Self, AnyFlows<'a, S>, Vec<S>>;
    fn found(&self) -> Self::Found<'_> {
        let flows = match &self.family {
            Some(family) if S::FAMILIES => AnyFlows::Family(family.found()),
            _ => AnyFlows::System(Flows::new(self, true)),
        };
        DrivenFlows::new(self, flows)
    }
}
