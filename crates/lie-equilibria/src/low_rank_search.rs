//! The search for states at rest where the rank of the bracket drops.
//!
//! Starts are those of a search for others, in parts of the scale. From what is found of a family others of its members are looked for along it:
//! they differ in their energy and their stability.

use crate::dense::{add, difference, norm};
use crate::family::{SAME, Solutions};
use crate::field::Field;
use crate::low_rank::{LowRank, ZERO};
use crate::newton::At;
use crate::random::Random;

/// Members from which a family is explored, in so many directions each.
const EXPLORED: usize = 40;
const DIRECTIONS: usize = 8;
/// So many members of a family are told apart by walks; further ones count as members.
const WALKS: usize = 60;

/// What is known of solutions so far.
struct Search<'a> {
    field: Field<'a>,
    /// The same at the energy of the initial state.
    held: Option<Field<'a>>,
    found: Vec<LowRank>,
}

impl At<'_> {
    /// Looks for all states at rest where the rank drops, from so many starts.
    pub fn low_rank(self, starts: usize, seed: u64) -> Vec<LowRank> {
        let (Some(field), Some((_, state))) =
            (Field::new(self), self.equations.leaf(self.parameters))
        else {
            return Vec::new();
        };
        let n = state.len();
        let first: Vec<f64> = state.iter().map(|x| x / field.size).collect();
        let held = self.energy_of(&state).and_then(|energy| {
            let field = Field::new(self)?;
            Some(field.with_energy(energy))
        });
        let mut random = Random::new(seed ^ 0x10e);
        let axes = (0..2 * n).map(|k| {
            let mut z = vec![1e-3; n];
            z[k / 2] = if k % 2 == 0 { 1.0 } else { -1.0 };
            z
        });
        let drawn = (0..starts).map(|_| {
            let far = (2.0 * random.unit()).exp2();
            let direction = random.direction(n);
            direction.iter().map(|x| far * x).collect::<Vec<f64>>()
        });
        let all: Vec<Vec<f64>> = std::iter::once(first).chain(axes).chain(drawn).collect();
        let mut members = Vec::new();
        let mut search = Search {
            field,
            held,
            found: Vec::new(),
        };
        for z in all {
            let x: Vec<f64> = z.iter().map(|z| z * search.field.size).collect();
            let on_leaf = self.on_leaf(&x).map(|y| {
                let own = y[..n].iter();
                own.map(|x| x / search.field.size).collect::<Vec<f64>>()
            });
            let solved = search.field.solve(&on_leaf.unwrap_or(z));
            if let Some(one) = solved.and_then(|z| self.low_rank_at(&search.field, z)) {
                members.extend((one.family > 0).then(|| one.state.clone()));
                self.take_low_rank(&mut search, one);
            }
        }
        for member in members.iter().take(EXPLORED) {
            self.explore(&mut search, member, &mut random);
        }
        // members near a change of a family tell nothing that others do not
        if search.found.iter().any(LowRank::is_clear) {
            search.found.retain(LowRank::is_clear);
        }
        let by_energy = |a: &LowRank, b: &LowRank| a.energy.total_cmp(&b.energy);
        search.found.sort_by(by_energy);
        search.found
    }

    /// Looks for other members of a family, in which the spectrum may be another one.
    fn explore(self, search: &mut Search<'_>, member: &[f64], random: &mut Random) {
        let z: Vec<f64> = member.iter().map(|x| x / search.field.size).collect();
        let Some(kernel) = search.field.kernel(&z) else {
            return;
        };
        for _ in 0..DIRECTIONS {
            let mut other = z.clone();
            for direction in &kernel {
                add(&mut other, random.unit() * norm(&z).max(1.0), direction);
            }
            let solved = search.field.solve(&other);
            if let Some(one) = solved.and_then(|z| self.low_rank_at(&search.field, z)) {
                self.take_low_rank(search, one);
            }
        }
    }

    /// H of the initial state, where it has the values of the Casimirs.
    fn energy_of(self, state: &[f64]) -> Option<f64> {
        let y = [state, &vec![0.0; self.equations.sizes.m]].concat();
        let shape = self.equations.shape(&y, self.parameters)?;
        self.state_is_on_level().then_some(shape.energy)
    }

    /// Adds a solution to those that are known, if it is a new one.
    fn take_low_rank(self, search: &mut Search<'_>, one: LowRank) {
        let one = match &search.held {
            Some(held) => self.at_energy(&search.field, held, &one).unwrap_or(one),
            None => one,
        };
        let (field, size) = (&search.field, search.field.size);
        let near = |other: &&mut LowRank| {
            let apart = norm(&difference(&one.state, &other.state));
            let size = norm(&one.state).max(norm(&other.state));
            let uncertain = 4.0 * (one.error + other.error);
            apart <= (SAME * size).max(uncertain).max(ZERO * field.size)
        };
        if let Some(other) = search.found.iter_mut().find(near) {
            other.hits += 1;
            return;
        }
        if one.family > 0 {
            let here: Vec<f64> = one.state.iter().map(|x| x / size).collect();
            let member = |other: &&mut LowRank| {
                let there: Vec<f64> = other.state.iter().map(|x| x / size).collect();
                (other.family, other.sides, other.rank) == (one.family, one.sides, one.rank)
                    && (other.hits > WALKS || field.leads(&there, &here))
            };
            if let Some(other) = search.found.iter_mut().find(member) {
                other.hits += 1;
                // what is shown is far from where the family changes
                let clearer = |one: &LowRank| (one.is_clear(), one.at_energy);
                if clearer(&one) > clearer(other) {
                    *other = LowRank {
                        hits: other.hits,
                        ..one
                    };
                }
                return;
            }
        }
        search.found.push(one);
    }

    /// The member of a family with the energy of the initial state.
    fn at_energy(self, field: &Field<'_>, held: &Field<'_>, one: &LowRank) -> Option<LowRank> {
        if one.family == 0 {
            return None;
        }
        let z: Vec<f64> = one.state.iter().map(|x| x / field.size).collect();
        // from a point further on too: near a crossing of families H does not tell where to go
        let ahead = field.kernel(&z)?.into_iter().flat_map(|direction| {
            [1.0, -1.0, 0.1, -0.1].map(|part| {
                let mut other = z.clone();
                add(&mut other, part, &direction);
                other
            })
        });
        let starts = std::iter::once(z.clone()).chain(ahead);
        let found = starts.filter_map(|start| self.low_rank_at(field, held.solve(&start)?));
        let same = |other: &LowRank| {
            (one.family, one.sides, one.rank) == (other.family, other.sides, other.rank)
        };
        let mut found = found.filter(same);
        found.next().map(|other| LowRank {
            at_energy: true,
            ..other
        })
    }
}
