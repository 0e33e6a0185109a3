//! Systems near equilibrium: their declarations, and the written formulas with their derivatives by the rules of
//! differentiation.

use std::collections::HashMap;

use super::random::Random;
use super::scalar::{Jet, Number};

/// A length between two coordinates, or of one from an anchor.
#[derive(Clone, Copy, Debug)]
pub struct Length {
    pub from: usize,
    pub to: Option<usize>,
    /// The parameter that is the length at rest.
    pub rest: usize,
}

/// A term of H; the numbers are positions of parameters.
#[derive(Clone, Copy, Debug)]
pub enum Term {
    /// `K*(x - y - l)^2/2`
    Spring(usize, Length),
    /// `D*(1 - exp(-a*(x - y - l)))^2`
    Morse(usize, usize, Length),
    /// `q/(x - y)`
    Coulomb(usize, Length),
    /// `q/sqrt(e^2 + (x - y - l)^2)`
    Softened(usize, usize, Length),
    /// `(s/(x - y))^12 - (s/(x - y))^6`
    LennardJones(usize, Length),
    /// `b*sqrt(1 + x^2)`
    Root(usize, usize),
    /// `x^2/(2*b)`
    Square(usize, usize),
}

pub struct System {
    pub algebra: usize,
    pub terms: Vec<Term>,
    pub parameters: Vec<f64>,
    /// The state at rest.
    pub rest: Vec<f64>,
}

/// Dimension and brackets `[e_i, e_j] = e_k`.
type Algebra = (usize, &'static [(usize, usize, usize)]);

/// so(3), se(3), so(3) + so(3), the Heisenberg algebra of two pairs.
const ALGEBRAS: [Algebra; 4] = [
    (3, &[(0, 1, 2), (1, 2, 0), (2, 0, 1)]),
    (
        6,
        &[
            (0, 1, 2),
            (1, 2, 0),
            (2, 0, 1),
            (0, 4, 5),
            (1, 5, 3),
            (2, 3, 4),
            (3, 1, 5),
            (4, 2, 3),
            (5, 0, 4),
        ],
    ),
    (
        6,
        &[
            (0, 1, 2),
            (1, 2, 0),
            (2, 0, 1),
            (3, 4, 5),
            (4, 5, 3),
            (5, 3, 4),
        ],
    ),
    (5, &[(0, 1, 4), (2, 3, 4)]),
];

impl System {
    pub fn random(random: &mut Random) -> Self {
        let algebra = random.below(ALGEBRAS.len());
        let n = ALGEBRAS[algebra].0;
        // Numbers that single precision has too.
        let rest: Vec<f64> = (0..n)
            .map(|i| 1.0 + (i * 64 + random.below(48)) as f64 / 64.0)
            .collect();
        let mut system = Self {
            algebra,
            terms: Vec::new(),
            parameters: Vec::new(),
            rest,
        };
        for _ in 0..2 + random.below(3) {
            let term = system.term(random);
            system.terms.push(term);
        }
        system
    }

    fn parameter(&mut self, value: f64) -> usize {
        self.parameters.push(value);
        self.parameters.len() - 1
    }

    /// A stiffness, a depth, a range.
    fn size(&mut self, random: &mut Random) -> usize {
        let size = (1 + random.below(7)) as f64 * 2f64.powi(random.below(20) as i32 - 4);
        self.parameter(size)
    }

    fn length(&mut self, random: &mut Random) -> Length {
        let n = self.rest.len();
        let from = random.below(n);
        let to = Some(random.below(n)).filter(|to| *to != from);
        let rest = self.rest[from] - to.map_or(0.0, |to| self.rest[to]);
        Length {
            from,
            to,
            rest: self.parameter(rest),
        }
    }

    fn term(&mut self, random: &mut Random) -> Term {
        let size = self.size(random);
        match random.below(7) {
            0 => Term::Spring(size, self.length(random)),
            1 => {
                let range = self.parameter(1.5);
                Term::Morse(size, range, self.length(random))
            }
            2 => Term::Coulomb(size, self.length(random)),
            3 => {
                let soft = self.parameter(0.25);
                Term::Softened(size, soft, self.length(random))
            }
            4 => {
                let length = self.length(random);
                let s = self.parameter(self.parameters[length.rest].abs());
                Term::LennardJones(s, length)
            }
            5 => Term::Root(size, random.below(self.rest.len())),
            _ => Term::Square(size, random.below(self.rest.len())),
        }
    }

    pub fn spec(&self) -> String {
        let (n, brackets) = ALGEBRAS[self.algebra];
        let list = |items: Vec<String>| {
            let quoted: Vec<String> = items.iter().map(|item| format!("{item:?}")).collect();
            quoted.join(", ")
        };
        let basis = list((0..n).map(|i| format!("e{i}")).collect());
        let state = list((0..n).map(|i| format!("x{i}")).collect());
        let brackets = brackets
            .iter()
            .map(|(i, j, k)| format!("[e{i}, e{j}] = e{k}"));
        let brackets = list(brackets.collect());
        let parameters: Vec<String> = self
            .parameters
            .iter()
            .enumerate()
            .map(|(i, value)| format!("\"p{i}\": {value:?}"))
            .collect();
        let terms: Vec<String> = self.terms.iter().map(text).collect();
        format!(
            r#"{{"format": 1, "name": "Rest", "algebra": {{"basis": [{basis}], "brackets": [{brackets}]}},
            "state": [{state}], "parameters": {{{}}}, "hamiltonian": "{}"}}"#,
            parameters.join(", "),
            terms.join(" + ")
        )
    }

    /// H with its derivatives, as it is written.
    fn written<T: Number>(&self, state: &[f64]) -> Jet<T> {
        let n = state.len();
        let x: Vec<Jet<T>> = (0..n)
            .map(|i| Jet::variable(T::of(state[i]), i, n))
            .collect();
        let p = |i: usize| Jet::constant(T::of(self.parameters[i]), n);
        let c = |value: f64| Jet::constant(T::of(value), n);
        let distance = |l: &Length| match l.to {
            Some(to) => x[l.from].sub(&x[to]),
            None => x[l.from].clone(),
        };
        let stretch = |l: &Length| distance(l).sub(&p(l.rest));
        let term = |term: &Term| match term {
            Term::Spring(k, l) => p(*k).mul(&stretch(l).powi(2)).mul(&c(0.5)),
            Term::Morse(d, a, l) => {
                let exponent = c(0.0).sub(&p(*a)).mul(&stretch(l));
                p(*d).mul(&c(1.0).sub(&exponent.exp()).powi(2))
            }
            Term::Coulomb(q, l) => p(*q).mul(&distance(l).recip()),
            Term::Softened(q, e, l) => {
                let square = p(*e).powi(2).add(&stretch(l).powi(2));
                p(*q).mul(&square.sqrt().recip())
            }
            Term::LennardJones(s, l) => {
                let ratio = p(*s).mul(&distance(l).recip());
                ratio.powi(12).sub(&ratio.powi(6))
            }
            Term::Root(b, i) => p(*b).mul(&c(1.0).add(&x[*i].powi(2)).sqrt()),
            Term::Square(b, i) => x[*i].powi(2).mul(&c(2.0).mul(&p(*b)).recip()),
        };
        let mut terms = self.terms.iter().map(term);
        let first = terms.next().expect("a term");
        terms.fold(first, |sum, term| sum.add(&term))
    }

    /// The results of the basic kernels as the written formula gives them, by the names of the kernels.
    pub fn results<T: Number>(&self, state: &[f64]) -> HashMap<&'static str, Vec<T>> {
        let (n, brackets) = ALGEBRAS[self.algebra];
        let h = self.written::<T>(state);
        let zero = T::of(0.0);
        let mu: Vec<T> = state.iter().map(|x| T::of(*x)).collect();
        // mu_j' = C_ij^k (dH/dmu_i) mu_k
        let mut field = vec![zero; n];
        let mut jacobian = vec![zero; n * n];
        let both = brackets
            .iter()
            .flat_map(|(i, j, k)| [(*i, *j, *k, 1.0), (*j, *i, *k, -1.0)]);
        for (i, j, k, sign) in both {
            let sign = T::of(sign);
            field[j] = field[j].add(sign.mul(h.first[i].mul(mu[k])));
            for l in 0..n {
                let entry = &mut jacobian[j * n + l];
                *entry = entry.add(sign.mul(h.second[i][l].mul(mu[k])));
                if l == k {
                    *entry = entry.add(sign.mul(h.first[i]));
                }
            }
        }
        HashMap::from([
            ("hamiltonian", vec![h.value]),
            ("gradient", h.first),
            ("hessian", h.second.concat()),
            ("vector_field", field),
            ("jacobian", jacobian),
        ])
    }
}

fn text(term: &Term) -> String {
    let distance = |l: &Length| match l.to {
        Some(to) => format!("x{} - x{to}", l.from),
        None => format!("x{}", l.from),
    };
    let stretch = |l: &Length| format!("({} - p{})", distance(l), l.rest);
    match term {
        Term::Spring(k, l) => format!("p{k}*{}^2/2", stretch(l)),
        Term::Morse(d, a, l) => format!("p{d}*(1 - exp(-p{a}*{}))^2", stretch(l)),
        Term::Coulomb(q, l) => format!("p{q}/({})", distance(l)),
        Term::Softened(q, e, l) => format!("p{q}/sqrt(p{e}^2 + {}^2)", stretch(l)),
        Term::LennardJones(s, l) => {
            format!("(p{s}/({0}))^12 - (p{s}/({0}))^6", distance(l))
        }
        Term::Root(b, i) => format!("p{b}*sqrt(1 + x{i}^2)"),
        Term::Square(b, i) => format!("x{i}^2/(2*p{b})"),
    }
}
