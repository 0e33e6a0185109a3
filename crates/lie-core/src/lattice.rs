//! Sites in layers, rows and columns: a chain is a row, a square lattice a layer.

use core::array::from_fn;

/// The number of axes. The last one is that of columns, along which sites stand one behind the other in a state.
pub const AXES: usize = 3;

/// What is said of the last axes, with something else in front for each of the others; none where there are more than [`AXES`].
#[must_use]
pub fn last_axes<T: Copy>(given: &[T], before: T) -> Option<[T; AXES]> {
    let others = AXES.checked_sub(given.len())?;
    Some(from_fn(|axis| {
        axis.checked_sub(others).map_or(before, |axis| given[axis])
    }))
}

/// The sizes by which a site is told from the others: those behind axes of one site, and that of columns.
#[must_use]
pub fn shown(sizes: &[usize; AXES]) -> &[usize] {
    let several = sizes.iter().position(|size| *size != 1);
    &sizes[several.unwrap_or(AXES - 1)..]
}

/// The number of sites, or the largest number there is where they are more.
#[inline]
#[must_use]
pub fn count(sizes: [usize; AXES]) -> usize {
    sizes
        .iter()
        .fold(1, |count, size| count.saturating_mul(*size))
}

/// Layer, row and column of the site at a place of a state.
#[inline]
#[must_use]
pub fn site(mut place: usize, sizes: [usize; AXES]) -> [usize; AXES] {
    let mut site = [0; AXES];
    for axis in (1..AXES).rev() {
        site[axis] = place % sizes[axis];
        place /= sizes[axis];
    }
    site[0] = place;
    site
}

/// The place in a state of the site at a distance from another one; indices count modulo the sizes.
#[inline]
#[must_use]
pub fn place(site: [usize; AXES], offset: [isize; AXES], sizes: [usize; AXES]) -> usize {
    let columns = sizes[AXES - 1];
    let column = wrapped(site[AXES - 1] as isize + offset[AXES - 1], columns);
    line(site, offset, sizes) * columns + column
}

/// The line along the last axis of the site at a distance from another one; indices count modulo the sizes.
#[inline]
#[must_use]
pub fn line(site: [usize; AXES], offset: [isize; AXES], sizes: [usize; AXES]) -> usize {
    (0..AXES - 1).fold(0, |line, axis| {
        line * sizes[axis] + wrapped(site[axis] as isize + offset[axis], sizes[axis])
    })
}

/// An index modulo the size.
#[inline]
#[must_use]
pub fn wrapped(index: isize, size: usize) -> usize {
    // most are no neighbours over an end, and a division takes long
    match index as usize {
        index if index < size => index,
        _ => index.rem_euclid(size as isize) as usize,
    }
}

/// The name of a coordinate at the site at a place, `x[5]`, of a lattice `x[1][2]` or `x[0][1][2]`.
#[cfg(feature = "std")]
#[must_use]
pub fn named(name: &str, place: usize, sizes: [usize; AXES]) -> std::string::String {
    use core::fmt::Write as _;
    let mut text = std::string::String::from(name);
    let hidden = AXES - shown(&sizes).len();
    for index in &site(place, sizes)[hidden..] {
        // a text takes whatever is written
        let _ = write!(text, "[{index}]");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_go_along_the_last_axis_first() {
        let sizes = [3, 2, 4];
        for at in 0..24 {
            assert_eq!(place(site(at, sizes), [0; AXES], sizes), at);
        }
        assert_eq!((site(13, sizes), count(sizes)), ([1, 1, 1], 24));
        assert_eq!(count([1 << 31; AXES]), usize::MAX);
        assert_eq!(place([1, 1, 1], [2, -1, 5], sizes), 2);
        assert_eq!(line([1, 1, 1], [1, -1, 5], sizes), 4);
        assert_eq!((wrapped(-1, 4), wrapped(-9, 4), wrapped(3, 4)), (3, 3, 3));
    }

    #[test]
    fn axes_of_one_site_in_front_are_left_out() {
        assert_eq!(last_axes(&[5], 1), Some([1, 1, 5]));
        assert_eq!(last_axes(&[2, 3, 5], 1), Some([2, 3, 5]));
        assert_eq!(last_axes(&[1; 4], 1), None);
        assert_eq!(shown(&[1, 1, 1]), [1]);
        assert_eq!(shown(&[1, 3, 1]), [3, 1]);
        assert_eq!(named("x", 5, [1, 1, 8]), "x[5]");
        assert_eq!(named("x", 5, [1, 2, 4]), "x[1][1]");
        assert_eq!(named("x", 5, [2, 1, 4]), "x[1][0][1]");
    }
}
