//! A function as a list of definitions, and its derivatives as further definitions.
//!
//! Derivatives of a composed function swell when they are written out in the coordinates. Here
//! each intermediate quantity is a symbol; the chain rule runs along the list, backwards for the
//! gradient of one result (adjoints), forwards for its derivative along a coordinate (tangents), and
//! adds definitions whose number is proportional to that of the function.

use std::collections::{BTreeMap, HashMap};

use super::Source;
use lie_symbolic::symbolic::{ExprId, Node, Symbol};

/// Definitions in order; each may use the coordinates and earlier ones.
#[derive(Clone, Debug)]
pub struct Tape {
    definitions: Vec<(Symbol, ExprId)>,
    known: HashMap<ExprId, ExprId>,
    next: usize,
    start: usize,
    swollen: bool,
}

/// By how much the arena may grow for a list, nodes and operands together.
const MOST_DERIVED: usize = 300_000;

/// What becomes of the derivatives of definitions along a symbol.
#[derive(Clone, Copy, Debug)]
pub enum Tangents {
    /// Definitions of their own: for long lists, in which they are used again and again.
    Named,
    /// Parts of what they are used in: for the short lists of an equation.
    Inline,
}

impl Tangents {
    /// The other way.
    pub fn opposite(self) -> Self {
        match self {
            Self::Named => Self::Inline,
            Self::Inline => Self::Named,
        }
    }
}

impl Tape {
    /// An empty list; `first` is the first symbol that no argument uses.
    pub fn new(source: &Source, first: usize) -> Self {
        Self {
            start: source.graph.size(),
            definitions: Vec::new(),
            known: HashMap::new(),
            next: first,
            swollen: false,
        }
    }

    /// Whether a derivative was too large, in which case the list is of no use, or the arena has grown by
    /// more than so many nodes and operands since the list was begun.
    pub fn is_beyond(&self, source: &Source, most: usize) -> bool {
        self.swollen || source.graph.size() - self.start > most
    }

    /// The partial derivative of an expression; 0 and a note if it is too large.
    pub fn slope(&mut self, source: &mut Source, value: ExprId, symbol: Symbol) -> ExprId {
        let slope = source
            .graph
            .derivative_within(value, symbol, self.start + MOST_DERIVED);
        self.swollen |= slope.is_none();
        slope.unwrap_or_else(|| source.graph.integer(0))
    }

    /// The definitions.
    pub fn definitions(&self) -> &[(Symbol, ExprId)] {
        &self.definitions
    }

    /// The quantity as one symbol, which derivatives in the coordinates take for a constant. What does
    /// not vary, or is such a symbol up to a factor, stays as it is.
    pub fn define(&mut self, source: &mut Source, value: ExprId) -> ExprId {
        let (_, bare) = source.graph.coefficient(value);
        let symbols = source.graph.symbols(bare);
        let varies = symbols
            .iter()
            .any(|s| matches!(s, Symbol::Coordinate(_) | Symbol::Input(_)));
        if !varies || matches!(source.graph.node(bare), Node::Symbol(Symbol::Input(_))) {
            return value;
        }
        if let Some(&known) = self.known.get(&value) {
            return known;
        }
        let symbol = Symbol::Input(self.next);
        self.next += 1;
        self.definitions.push((symbol, value));
        let id = source.graph.symbol(symbol);
        self.known.insert(value, id);
        id
    }

    /// Each entry as one symbol.
    pub fn define_all(&mut self, source: &mut Source, values: &[ExprId]) -> Vec<ExprId> {
        values.iter().map(|v| self.define(source, *v)).collect()
    }

    /// Takes over definitions under their own symbols, which no other ones have.
    pub fn extend(&mut self, source: &mut Source, definitions: &[(Symbol, ExprId)]) {
        for definition in definitions {
            if !self.definitions.contains(definition) {
                let (symbol, value) = *definition;
                self.definitions.push(*definition);
                let id = source.graph.symbol(symbol);
                self.known.entry(value).or_insert(id);
            }
        }
    }

    /// Values of another list, which is in the coordinates, at a point.
    pub fn adopt(
        &mut self,
        source: &mut Source,
        (list, values): (&Self, &[ExprId]),
        point: &[ExprId],
    ) -> Vec<ExprId> {
        let coordinates = (0..point.len()).map(Symbol::Coordinate);
        let mut image: HashMap<Symbol, ExprId> = coordinates.zip(point.iter().copied()).collect();
        for (symbol, value) in &list.definitions {
            let value = source
                .graph
                .substitute(&[*value], &|s| image.get(&s).copied())[0];
            image.insert(*symbol, self.define(source, value));
        }
        source.graph.substitute(values, &|s| image.get(&s).copied())
    }

    /// The gradient of a quantity in the coordinates, by adjoints.
    pub fn gradient(&mut self, source: &mut Source, value: ExprId) -> Vec<ExprId> {
        let mut adjoints: BTreeMap<Symbol, Vec<ExprId>> = BTreeMap::new();
        let one = source.graph.integer(1);
        self.spread(source, &mut adjoints, value, one);
        for (symbol, definition) in self.definitions.clone().into_iter().rev() {
            let Some(terms) = adjoints.remove(&symbol) else {
                continue;
            };
            let adjoint = source.graph.sum(&terms);
            if source.graph.is_zero(adjoint) {
                continue;
            }
            let adjoint = self.define(source, adjoint);
            self.spread(source, &mut adjoints, definition, adjoint);
        }
        (0..source.dimension)
            .map(|i| {
                let terms = adjoints.remove(&Symbol::Coordinate(i)).unwrap_or_default();
                source.graph.sum(&terms)
            })
            .collect()
    }

    /// The derivatives of quantities along a symbol, by tangents.
    fn tangents(
        &mut self,
        source: &mut Source,
        values: &[ExprId],
        along: Symbol,
        tangents_are: Tangents,
    ) -> Vec<ExprId> {
        let mut tangents: HashMap<Symbol, ExprId> = HashMap::new();
        let one = source.graph.integer(1);
        tangents.insert(along, one);
        for (symbol, definition) in self.definitions.clone() {
            let tangent = self.tangent(source, &tangents, definition);
            if !source.graph.is_zero(tangent) {
                let tangent = match tangents_are {
                    Tangents::Named => self.define(source, tangent),
                    Tangents::Inline => tangent,
                };
                tangents.insert(symbol, tangent);
            }
        }
        values
            .iter()
            .map(|value| self.tangent(source, &tangents, *value))
            .collect()
    }

    /// The derivatives of quantities in all coordinates, by definitions of their own.
    pub fn jacobian(&mut self, source: &mut Source, values: &[ExprId]) -> Vec<Vec<ExprId>> {
        let coordinates: Vec<Symbol> = (0..source.dimension).map(Symbol::Coordinate).collect();
        self.jacobian_in(source, values, &coordinates, Tangents::Named)
    }

    /// The derivatives of quantities in symbols: `out[i][j]` of value i in symbol j.
    pub fn jacobian_in(
        &mut self,
        source: &mut Source,
        values: &[ExprId],
        symbols: &[Symbol],
        tangents_are: Tangents,
    ) -> Vec<Vec<ExprId>> {
        // tangents of tangents are not needed: each direction starts from the same list
        let count = self.definitions.len();
        let mut rows = vec![Vec::with_capacity(symbols.len()); values.len()];
        for along in symbols {
            let mut direction = Self {
                definitions: self.definitions[..count].to_vec(),
                known: std::mem::take(&mut self.known),
                next: self.next,
                start: self.start,
                swollen: self.swollen,
            };
            let column = direction.tangents(source, values, *along, tangents_are);
            self.next = direction.next;
            self.known = direction.known;
            self.swollen = direction.swollen;
            self.definitions
                .extend_from_slice(&direction.definitions[count..]);
            for (row, entry) in rows.iter_mut().zip(column) {
                row.push(entry);
            }
        }
        rows
    }

    /// Adds `adjoint * d value/d symbol` to the adjoint of every symbol.
    fn spread(
        &mut self,
        source: &mut Source,
        adjoints: &mut BTreeMap<Symbol, Vec<ExprId>>,
        value: ExprId,
        adjoint: ExprId,
    ) {
        for symbol in source.graph.symbols(value) {
            if matches!(symbol, Symbol::Coordinate(_) | Symbol::Input(_)) {
                let slope = self.slope(source, value, symbol);
                let term = source.graph.mul(slope, adjoint);
                adjoints.entry(symbol).or_default().push(term);
            }
        }
    }

    /// `sum over symbols of d value/d symbol * tangent of the symbol`
    fn tangent(
        &mut self,
        source: &mut Source,
        tangents: &HashMap<Symbol, ExprId>,
        value: ExprId,
    ) -> ExprId {
        let mut terms = Vec::new();
        for symbol in source.graph.symbols(value) {
            if let Some(&tangent) = tangents.get(&symbol) {
                let slope = self.slope(source, value, symbol);
                terms.push(source.graph.mul(slope, tangent));
            }
        }
        source.graph.sum(&terms)
    }
}
