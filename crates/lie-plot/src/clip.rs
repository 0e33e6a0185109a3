//! Lines without what lies outside of a frame.

use super::svg::Place;

/// The least and the largest coordinates of places.
pub(crate) fn bounding_box(places: impl Iterator<Item = Place>) -> Option<(Place, Place)> {
    places.fold(None, |bounds, (x, y)| {
        let ((a, b), (c, d)) = bounds.unwrap_or(((x, y), (x, y)));
        Some(((a.min(x), b.min(y)), (c.max(x), d.max(y))))
    })
}

/// The pieces of a line that lie between the lower and the upper corner of a frame.
pub(crate) fn clipped(line: &[Place], frame: (Place, Place)) -> Vec<Vec<Place>> {
    let mut pieces: Vec<Vec<Place>> = Vec::new();
    for pair in line.windows(2) {
        let Some((from, to)) = inside(pair[0], pair[1], frame) else {
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&from) => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
    }
    pieces
}

/// The part of a segment that lies in a frame.
fn inside(from: Place, to: Place, (low, high): (Place, Place)) -> Option<(Place, Place)> {
    let (across, up) = (to.0 - from.0, to.1 - from.1);
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    // of each side: how fast the segment goes outwards, and how far inside it begins
    for (out, room) in [
        (-across, from.0 - low.0),
        (across, high.0 - from.0),
        (-up, from.1 - low.1),
        (up, high.1 - from.1),
    ] {
        if out > 0.0 {
            last = last.min(room / out);
        } else if out < 0.0 {
            first = first.max(room / out);
        } else if room < 0.0 {
            return None;
        }
    }
    let at = |part: f64| match part {
        0.0 => from,
        1.0 => to,
        part => (from.0 + part * across, from.1 + part * up),
    };
    let (from, to) = (at(first), at(last));
    let finite = [from.0, from.1, to.0, to.1].iter().all(|x| x.is_finite());
    (first <= last && finite).then_some((from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_at_the_frame_and_begins_there_again() {
        let frame = ((0.0, 0.0), (2.0, 1.0));
        let line = [(1.0, 0.5), (3.0, 0.5), (3.0, 0.25), (-1.0, 0.25)];
        let pieces = clipped(&line, frame);
        assert_eq!(
            pieces,
            [[(1.0, 0.5), (2.0, 0.5)], [(2.0, 0.25), (0.0, 0.25)]]
        );
        // what is inside stays as it is, and in one piece
        let whole = [(0.1, 0.1), (1.9, 0.9), (0.3, 0.7)];
        assert_eq!(clipped(&whole, frame), [whole]);
        assert!(clipped(&[(3.0, 0.0), (3.0, 1.0)], frame).is_empty());
        // far beyond, too
        let far = clipped(&[(1.0, 0.5), (1.0, 1e300), (-1e300, 1e300)], frame);
        assert_eq!(far, [[(1.0, 0.5), (1.0, 1.0)]]);
    }
}
