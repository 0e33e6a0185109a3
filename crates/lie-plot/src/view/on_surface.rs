//! Curves on surfaces as they come, point by point.

use super::super::are_dots;
use super::super::rows::Rows;
use super::super::surface::Point;
use super::super::svg::Place;
use super::super::trace::Trace;
use super::{faces, projected};

/// A curve on a surface: what faces the eye, and the rest.
#[derive(Clone, Debug)]
pub struct OnSurface {
    pub(super) name: String,
    pub(super) front: Trace,
    pub(super) back: Trace,
    pub(super) bounds: Option<(Point, Point)>,
    pub(super) first: Option<Point>,
    /// Whether the last point faced the eye.
    side: Option<bool>,
    /// Rows that face the eye, and the others.
    rows: [Rows; 2],
}

impl OnSurface {
    /// A curve without points.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            front: Trace::default(),
            back: Trace::default(),
            bounds: None,
            first: None,
            side: None,
            rows: Default::default(),
        }
    }

    /// Takes the next row, and the normal of the surface there.
    pub fn push(&mut self, point: &Point, normal: &Point) {
        self.rows[usize::from(!faces(normal))].push(projected(point));
        self.go_to(point, normal);
    }

    /// Takes a point between rows, through which the line goes.
    pub fn between(&mut self, point: &Point, normal: &Point) {
        self.rows[0].add_between();
        self.go_to(point, normal);
    }

    /// The rows that are dots: those that face the eye, and the others.
    pub(super) fn dots(&self) -> [&[Place]; 2] {
        let [front, back] = &self.rows;
        match are_dots(front.count() + back.count(), front.between()) {
            true => [front.all(), back.all()],
            false => [&[], &[]],
        }
    }

    fn go_to(&mut self, point: &Point, normal: &Point) {
        let (low, high) = self.bounds.unwrap_or((*point, *point));
        self.bounds = Some((
            [0, 1, 2].map(|i| low[i].min(point[i])),
            [0, 1, 2].map(|i| high[i].max(point[i])),
        ));
        self.first.get_or_insert(*point);
        let place = projected(point);
        let front = faces(normal);
        let (own, other) = match front {
            true => (&mut self.front, &mut self.back),
            false => (&mut self.back, &mut self.front),
        };
        if self.side.replace(front) == Some(!front) {
            // the segment in which it turns away belongs to the side it comes from
            other.push(place);
            other.lift();
        }
        own.push(place);
    }
}
