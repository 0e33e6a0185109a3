//! The bonds of a kind: by which axis and in which colours they are done, so that no two of a colour have a site in common.

use super::{Kind, Span};
use crate::lattice::AXES;
use core::ops::Range;

/// The bonds of a kind along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bonds {
    /// By which they are told apart.
    pub(super) axis: usize,
    size: usize,
    /// From the first to the second site.
    offset: isize,
    /// From the lower to the upper one; on a ring not above half of the size.
    distance: usize,
    /// Whether the first site is the upper one.
    turned: bool,
    ring: bool,
}

impl Bonds {
    /// Those of a kind, along the last axis on which its sites differ; none where each site would be bound to itself.
    pub(super) fn new(kind: Kind, sizes: [usize; AXES]) -> Option<Self> {
        (0..AXES)
            .rev()
            .find_map(|axis| Self::along(axis, kind, sizes[axis]))
    }

    fn along(axis: usize, kind: Kind, size: usize) -> Option<Self> {
        let (offset, ring) = (kind.offset[axis], kind.spans[axis] == Span::All);
        let offset = if ring {
            offset.rem_euclid(size as isize)
        } else {
            offset
        };
        let (mut distance, mut turned) = (offset.unsigned_abs(), offset < 0);
        if ring && 2 * distance > size {
            (distance, turned) = (size - distance, true);
        }
        (offset != 0).then_some(Self {
            axis,
            size,
            offset,
            distance,
            turned,
            ring,
        })
    }

    /// Places that differ by this have the same colour where no bond leads over the end of a ring.
    pub(super) fn period(self) -> usize {
        2 * (self.distance & self.distance.wrapping_neg())
    }

    /// How many colours there are.
    pub(super) fn colours(self) -> u8 {
        2 + u8::from(self.ring && !self.size.is_multiple_of(self.period()))
    }

    /// The colour of the bond whose first site is at a place of the axis: bonds behind one another have different ones. Those
    /// that lead over the end of a ring have a third where they do not fit.
    pub(super) fn colour(self, first: usize) -> u8 {
        let lower = if self.turned {
            (first as isize + self.offset).rem_euclid(self.size as isize) as usize
        } else {
            first
        };
        if self.colours() == 3 && lower + self.distance >= self.size {
            return 2;
        }
        (lower / (self.period() / 2) % 2) as u8
    }

    /// The places of first sites among those of a span, with the way to the second ones: those whose bond leads over the end of
    /// a ring by themselves.
    pub(super) fn stretches(self, span: Range<usize>) -> [(Range<usize>, isize); 2] {
        if !self.ring {
            return [(span, self.offset), (0..0, 0)];
        }
        let over = self.size - self.offset as usize;
        [
            (span.start..span.end.min(over), self.offset),
            (
                span.start.max(over)..span.end,
                self.offset - self.size as isize,
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;

    #[test]
    fn bonds_of_a_colour_have_no_site_in_common() {
        for size in 2..30 {
            for offset in -9..=9 {
                for ring in [true, false] {
                    let span = if ring {
                        Span::All
                    } else {
                        Span::Within { first: 0, left: 0 }
                    };
                    let kind = Kind {
                        offset: [0, 0, offset],
                        spans: [Span::All, Span::All, span],
                        collective: false,
                    };
                    let Some(bonds) = Bonds::new(kind, [1, 1, size]) else {
                        assert_eq!(offset % (if ring { size as isize } else { 100 }), 0);
                        continue;
                    };
                    let firsts = match (ring, offset > 0) {
                        (true, _) => 0..size,
                        (false, true) => 0..size.saturating_sub(offset as usize),
                        (false, false) => offset.unsigned_abs().min(size)..size,
                    };
                    let mut seen = vec![vec![0; size]; 3];
                    let mut all = 0;
                    for (range, shift) in bonds.stretches(firsts.clone()) {
                        for first in range {
                            let second = (first as isize + shift) as usize;
                            assert_eq!(
                                second,
                                (first as isize + offset).rem_euclid(size as isize) as usize
                            );
                            let colour = usize::from(bonds.colour(first));
                            assert!(colour < usize::from(bonds.colours()));
                            seen[colour][first] += 1;
                            seen[colour][second] += 1;
                            all += 1;
                        }
                    }
                    assert_eq!(all, firsts.len(), "{size} {offset} {ring}");
                    let most = seen.iter().flatten().max();
                    assert!(most <= Some(&1), "{size} {offset} {ring}: {seen:?}");
                    // a stretch of columns with one remainder has one colour
                    for (range, _) in bonds.stretches(firsts) {
                        for first in range.clone().skip(bonds.period()) {
                            assert_eq!(bonds.colour(first), bonds.colour(first - bonds.period()));
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn bonds_are_told_apart_by_the_last_axis_on_which_their_sites_differ() {
        let kind = Kind {
            offset: [1, 1, 1],
            spans: [Span::All; AXES],
            collective: false,
        };
        for (sizes, axis) in [
            ([2, 4, 1], Some(1)),
            ([1, 4, 1], Some(1)),
            ([5, 4, 3], Some(2)),
            ([5, 1, 1], Some(0)),
            ([1, 1, 1], None),
        ] {
            assert_eq!(Bonds::new(kind, sizes).map(|bonds| bonds.axis), axis);
        }
    }
}
