//! What the coordinates of a system on T*G, or of one that depends on the time, are.

use lie_core::Clock;
use lie_symbolic::exact::Rational;

/// The name of the momentum of the time. A user's name does not begin with an underscore.
pub const TIME_MOMENTUM: &str = "_p";
/// The name of the central coordinate.
pub const UNIT: &str = "_one";
/// What the names of the rates of Wiener processes begin with, in front of their number.
pub const WIENER: &str = "_w";
/// The time in expressions.
pub const TIME: &str = "t";
/// The size of the block of the time in the matrices of a representation, the last one.
pub const TIME_BLOCK: usize = 3;
/// The size of the block of something that is held, behind that of the time.
pub const HELD_BLOCK: usize = 2;

/// How the coordinates of a system on `T*G`, or on `T*(G x R)`, are ordered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// The momenta come first: this many, with that of the time.
    pub momenta: usize,
    /// Name and size of the group element, whose entries follow.
    pub group: Option<(String, usize)>,
    /// Whether the three coordinates of the time are there: the Hamiltonian depends on it, something acts beside it, or a cocycle
    /// needs the central one.
    pub time: bool,
    /// Whether they are there for a cocycle alone, and nothing depends on the time.
    pub idle: bool,
    /// What is held from one step to the next, behind the time, which is there then: inputs with their defaults, and the rates of Wiener
    /// processes.
    pub held: Vec<(String, Rational)>,
}

impl Configuration {
    /// Whether a coordinate is one of the three that carry the time, which no user named.
    pub fn is_hidden(&self, coordinate: usize) -> bool {
        let entries = self.group.as_ref().map_or(0, |(_, size)| size * size);
        // the time, the unit and what is held come last
        self.time && (coordinate + 1 == self.momenta || coordinate >= self.momenta + entries)
    }

    /// The coordinates that carry the time.
    pub fn clock(&self) -> Option<Clock> {
        self.time.then(|| Clock {
            momentum: self.momenta - 1,
            time: self.dimension() - 2 - self.held.len(),
        })
    }

    /// The coordinates that are held from step to step: inputs, then the rates of Wiener processes.
    pub fn held_places(&self) -> std::ops::Range<usize> {
        self.dimension() - self.held.len()..self.dimension()
    }

    /// The momenta without that of the time.
    pub fn own_momenta(&self) -> usize {
        self.momenta - usize::from(self.time)
    }

    /// The size of the matrices of the group, of those in the algebra of all coordinates: the blocks of the time and of what is held come
    /// last, and beside a group element there are two.
    pub fn size_of_group(&self, whole: usize) -> usize {
        match &self.group {
            Some((_, size)) => *size,
            None => whole - TIME_BLOCK - HELD_BLOCK * self.held.len(),
        }
    }

    /// What the coordinates are.
    pub fn description(&self) -> String {
        let own = self.own_momenta();
        // beside the time alone they may be any coordinates
        let what = match self.group {
            Some(_) => "momenta",
            None => "coordinates",
        };
        let mut parts = vec![format!("{own} {what}")];
        if let Some((name, size)) = &self.group {
            parts.push(format!(
                "the {size} x {size} entries of the group element {name}"
            ));
        }
        if self.time {
            let time = "the time with its momentum and a unit";
            parts.push(match self.idle {
                true => format!("{time}, by which the cocycle is that of a central extension"),
                false => time.into(),
            });
        }
        match self.held.len() {
            0 => {}
            1 => parts.push("one that is held from step to step".into()),
            count => parts.push(format!("{count} that are held from step to step")),
        }
        parts.join(", ")
    }

    /// The same beside so many momenta less, those that constraints determine; `None` where none are left.
    pub fn with_fewer_momenta(&self, count: usize) -> Option<Self> {
        let left = self.own_momenta().checked_sub(count);
        left.filter(|left| *left > 0).map(|_| Self {
            momenta: self.momenta - count,
            ..self.clone()
        })
    }

    /// The number of coordinates.
    pub fn dimension(&self) -> usize {
        let size = self.group.as_ref().map_or(0, |(_, size)| *size);
        self.momenta + size * size + 2 * usize::from(self.time) + self.held.len()
    }

    /// A coordinate of the state at rest at the identity, at time 0.
    pub fn at_rest(&self, coordinate: usize) -> f64 {
        let size = self.group.as_ref().map_or(0, |(_, size)| *size);
        let behind = self.dimension() - self.held.len();
        if let Some(held) = coordinate.checked_sub(behind) {
            return self.held[held].1.to_f64();
        }
        let unit = self.time && coordinate + 1 == behind;
        let diagonal = coordinate
            .checked_sub(self.momenta)
            .is_some_and(|place| place < size * size && place % (size + 1) == 0);
        f64::from(u8::from(unit || diagonal))
    }

    /// The names of the entries of the group element, row by row.
    pub fn entries(&self) -> Vec<String> {
        self.group
            .as_ref()
            .map_or_else(Vec::new, |(name, size)| entries_of(name, *size))
    }

    /// A state from the one that the user gives: the momenta alone (the group element is 1 then), or with
    /// the entries of g. `None` where the number of values is neither.
    pub fn complete<T: Clone>(
        &self,
        given: &[T],
        number: impl Fn(&Rational) -> T,
    ) -> Option<Vec<T>> {
        let held = self.held.iter().map(|(_, default)| number(default));
        let number = |value: i64| number(&Rational::from(value));
        let own = self.own_momenta();
        let size = self.group.as_ref().map_or(0, |(_, size)| *size);
        if given.len() != own && given.len() != own + size * size {
            return None;
        }
        let mut state = given[..own].to_vec();
        if self.time {
            state.push(number(0));
        }
        if given.len() > own {
            state.extend_from_slice(&given[own..]);
        } else {
            let identity = (0..size * size).map(|k| number(i64::from(k % (size + 1) == 0)));
            state.extend(identity);
        }
        if self.time {
            state.extend([number(0), number(1)]);
        }
        state.extend(held);
        Some(state)
    }
}

/// The names of the entries of a matrix, row by row.
pub fn entries_of(name: &str, size: usize) -> Vec<String> {
    let pairs = (1..=size).flat_map(|row| (1..=size).map(move |column| (row, column)));
    pairs
        .map(|(row, column)| entry(name, size, row, column))
        .collect()
}

/// `R12`, from size 10 on `R_1_12`.
pub fn entry(name: &str, size: usize, row: usize, column: usize) -> String {
    if size < 10 {
        format!("{name}{row}{column}")
    } else {
        format!("{name}_{row}_{column}")
    }
}
