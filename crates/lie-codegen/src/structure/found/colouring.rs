//! The fewest classes of things some of which are in conflict: a colouring of their graph.

use lie_symbolic::exact::Budget;

/// A class for each vertex, none with two vertices in conflict: the fewest, where the budget allows to prove that, else few.
/// Classes are numbered by their first vertices.
pub(super) fn fewest(conflicts: &[Vec<bool>], budget: &Budget) -> Vec<usize> {
    let n = conflicts.len();
    let mut search = Search {
        conflicts,
        classes: vec![None; n],
        best: (0..n).collect(),
        count: n,
        least: clique(conflicts),
        complete: false,
        budget,
    };
    search.extend(0, 0);
    ordered(&search.best)
}

/// The size of a set of vertices that are all in conflict: there are as many classes at least.
fn clique(conflicts: &[Vec<bool>]) -> usize {
    let n = conflicts.len();
    let grown = |first: usize| {
        let mut members = vec![first];
        for (v, row) in conflicts.iter().enumerate() {
            if members.iter().all(|member| row[*member]) {
                members.push(v);
            }
        }
        members.len()
    };
    (0..n).map(grown).max().unwrap_or(0)
}

/// How many classes there are.
pub(super) fn count(classes: &[usize]) -> usize {
    classes.iter().map(|class| class + 1).max().unwrap_or(0)
}

struct Search<'a> {
    conflicts: &'a [Vec<bool>],
    classes: Vec<Option<usize>>,
    best: Vec<usize>,
    count: usize,
    /// No colouring has fewer classes.
    least: usize,
    /// Whether there is one; the first is made whatever it costs.
    complete: bool,
    budget: &'a Budget,
}

impl Search<'_> {
    /// All ways to go on after `done` vertices in `used` classes; the vertex with the fewest choices comes first.
    fn extend(&mut self, done: usize, used: usize) {
        if self.count <= self.least || (self.complete && used >= self.count) {
            return;
        }
        let n = self.classes.len();
        let work = (n - done) * (1 + used) * n;
        if self.budget.spend(work as u64).is_err() && self.complete {
            return;
        }
        if done == n {
            self.best = self.classes.iter().flatten().copied().collect();
            (self.count, self.complete) = (used, true);
            return;
        }
        let open = (0..self.classes.len()).filter(|v| self.classes[*v].is_none());
        let Some(vertex) =
            open.max_by_key(|v| (self.taken(*v, used), self.degree(*v), usize::MAX - v))
        else {
            return;
        };
        for class in 0..=used {
            if self.is_free(vertex, class) {
                self.classes[vertex] = Some(class);
                self.extend(done + 1, used.max(class + 1));
                self.classes[vertex] = None;
            }
        }
    }

    fn is_free(&self, vertex: usize, class: usize) -> bool {
        let mut others = self.classes.iter().enumerate();
        !others.any(|(other, of)| *of == Some(class) && self.conflicts[vertex][other])
    }

    /// How many classes a vertex cannot join.
    fn taken(&self, vertex: usize, used: usize) -> usize {
        (0..used)
            .filter(|class| !self.is_free(vertex, *class))
            .count()
    }

    fn degree(&self, vertex: usize) -> usize {
        self.conflicts[vertex]
            .iter()
            .filter(|conflict| **conflict)
            .count()
    }
}

/// The same classes, numbered by their first vertices.
fn ordered(classes: &[usize]) -> Vec<usize> {
    let mut known: Vec<usize> = Vec::new();
    let number = |class: &usize| {
        let place = known.iter().position(|other| other == class);
        place.unwrap_or_else(|| {
            known.push(*class);
            known.len() - 1
        })
    };
    classes.iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn classes(n: usize, edges: &[(usize, usize)]) -> Vec<usize> {
        let mut conflicts = vec![vec![false; n]; n];
        for &(i, j) in edges {
            conflicts[i][j] = true;
            conflicts[j][i] = true;
        }
        let found = fewest(&conflicts, &Budget::new(10_000_000));
        assert!(
            edges.iter().all(|(i, j)| found[*i] != found[*j]),
            "{found:?}"
        );
        found
    }

    #[test]
    fn the_fewest_classes() {
        assert_eq!(count(&classes(0, &[])), 0);
        assert_eq!(classes(3, &[]), [0, 0, 0]);
        assert_eq!(classes(3, &[(0, 1), (1, 2)]), [0, 1, 0]);
        // an odd ring needs three, an even one two
        let ring = |n: usize| (0..n).map(|i| (i, (i + 1) % n)).collect::<Vec<_>>();
        assert_eq!(count(&classes(7, &ring(7))), 3);
        assert_eq!(count(&classes(8, &ring(8))), 2);
        // a crown, on which taking one vertex after the other fails: 2 classes, not 4
        let mut crown = Vec::new();
        for i in 0..4 {
            crown.extend((0..4).filter(|j| *j != i).map(|j| (2 * i, 2 * j + 1)));
        }
        assert_eq!(count(&classes(8, &crown)), 2);
        // the graph of Grötzsch has no triangle and needs four
        let outer = ring(5);
        let mut edges = outer.clone();
        for (i, j) in outer {
            edges.extend([(i, 5 + j), (j, 5 + i)]);
        }
        edges.extend((5..10).map(|i| (i, 10)));
        assert_eq!(count(&classes(11, &edges)), 4);
    }
}
