//! Pictures of space: what a curve on a coadjoint orbit or on the sphere of directions looks like from outside.

mod on_surface;

use super::chart::paint;
use super::clip::{bounding_box, clipped};
use super::contours::contours;
use super::surface::{Field, Point, dot};
use super::svg::{FAINT, INK, Place, Svg, thinned};
use super::trace::Trace;

pub use on_surface::OnSurface;

/// The sides of the square in which space is shown, and where it begins.
const SIDE: f64 = 640.0;
const LEFT: f64 = 40.0;
const HEAD: f64 = 80.0;
const LINE: f64 = 18.0;
/// Pixels between the places of a line.
const FINEST: f64 = 2.5;

/// How far around a surface a curve that has left it is followed, in sizes of the surface.
const LEEWAY: f64 = 0.5;
/// So many sizes beyond a surface a curve that began on it has left it; and one that began elsewhere has diverged.
const VISIBLE: f64 = 0.05;
const FAR: f64 = 10.0;

/// From where one looks: turned about the third axis, and from above.
const AZIMUTH: f64 = 0.6;
const ELEVATION: f64 = 0.45;

/// The directions to the right, up, and to the eye.
fn camera() -> [Point; 3] {
    let ((s, c), (t, d)) = (AZIMUTH.sin_cos(), ELEVATION.sin_cos());
    [[-s, c, 0.0], [-t * c, -t * s, d], [d * c, d * s, t]]
}

fn projected(point: &Point) -> Place {
    let [right, up, _] = camera();
    (dot(&right, point), dot(&up, point))
}

/// Whether a surface with this normal faces the eye.
fn faces(normal: &Point) -> bool {
    dot(normal, &camera()[2]) >= 0.0
}

/// Whether what lies between bounds reaches beyond others by so many of their sizes.
fn beyond((low, high): (Point, Point), (from, to): (Point, Point), sizes: f64) -> bool {
    let size = (0..3).map(|i| to[i] - from[i]).fold(0.0, f64::max);
    (0..3).any(|i| low[i] < from[i] - sizes * size || high[i] > to[i] + sizes * size)
}

/// A colour mixed with white: where lines cross, it stays as pale as it is.
fn pale(paint: &str) -> String {
    let part = |at: usize| u16::from_str_radix(&paint[at..at + 2], 16).unwrap_or(0);
    let mixed = [1, 3, 5].map(|at| (3 * part(at) + 7 * 255) / 10);
    format!("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2])
}

/// Lines of one kind behind the curves.
#[derive(Clone, Debug, Default)]
struct Lines {
    front: Vec<Vec<Place>>,
    back: Vec<Vec<Place>>,
}

impl Lines {
    /// A chain of points, divided where the surface turns away.
    fn add(&mut self, chain: &[Point], normal: &dyn Fn(&Point) -> Point) {
        let mut piece: Option<(bool, Vec<Place>)> = None;
        for point in chain {
            let (front, place) = (faces(&normal(point)), projected(point));
            match &mut piece {
                Some((side, places)) => {
                    places.push(place);
                    if *side != front {
                        let (side, places) = (*side, std::mem::take(places));
                        self.keep(side, places);
                        piece = Some((front, vec![place]));
                    }
                }
                None => piece = Some((front, vec![place])),
            }
        }
        if let Some((side, places)) = piece {
            self.keep(side, places);
        }
    }

    fn keep(&mut self, front: bool, places: Vec<Place>) {
        let lines = if front {
            &mut self.front
        } else {
            &mut self.back
        };
        lines.push(places);
    }

    fn all(&self) -> impl Iterator<Item = &Place> {
        self.front.iter().chain(&self.back).flatten()
    }
}

/// A picture of curves on surfaces.
#[derive(Clone, Debug)]
pub struct View {
    title: String,
    subtitle: String,
    /// The names of the axes of space.
    axes: [String; 3],
    curves: Vec<OnSurface>,
    contours: Lines,
    outline: Lines,
    /// Where a surface is cut off.
    border: Lines,
    /// Where curves that have left the surface are cut off.
    frame: Option<(Place, Place)>,
    /// What the lines behind the curves are.
    note: String,
}

impl View {
    /// A picture without lines behind the curves.
    pub fn new(title: &str, subtitle: &str, axes: [String; 3], curves: Vec<OnSurface>) -> Self {
        Self {
            title: title.to_owned(),
            subtitle: subtitle.to_owned(),
            axes,
            curves,
            contours: Lines::default(),
            outline: Lines::default(),
            border: Lines::default(),
            frame: None,
            note: String::new(),
        }
    }

    /// The orbit on which the first curve lies, the level surface of a Casimir, with level curves of the energy if one is given; the note says
    /// what the surface is. False where there is no surface through its first point.
    pub fn orbit(&mut self, casimir: &Field<'_>, energy: Option<&Field<'_>>, note: &str) -> bool {
        let Some(curve) = self.curves.first() else {
            return false;
        };
        let (Some(first), Some(bounds)) = (curve.first, curve.bounds) else {
            return false;
        };
        let Some(found) = contours(casimir, energy, &first, bounds) else {
            self.note = "no surface: the initial state is an orbit by itself".to_owned();
            return false;
        };
        let normal = |point: &Point| casimir(point).1;
        let corners = found.surface.points.iter();
        let towards: Vec<f64> = corners
            .map(|point| dot(&normal(point), &camera()[2]))
            .collect();
        for chain in found.surface.curves(&towards, 0.0) {
            self.outline
                .keep(true, chain.iter().map(projected).collect());
        }
        for chain in &found.levels {
            self.contours.add(chain, &normal);
        }
        self.note = match (energy.is_some(), found.constant) {
            (false, _) => note.to_owned(),
            (true, true) => format!("{note}; H is constant on it"),
            (true, false) => format!("{note}; grey: level curves of H on it"),
        };
        if let (true, Some(surface)) = (found.closed, found.surface.bounds()) {
            self.follow_to(surface, found.surface.points.iter().map(projected));
        }
        if !found.closed {
            self.note.push_str("; cut off around the curve");
            for chain in found.surface.border() {
                self.border.add(&chain, &normal);
            }
        }
        true
    }

    /// Curves that leave a surface are followed a little beyond it alone: others may lie on surfaces that are larger, but not
    /// by far.
    fn follow_to(&mut self, surface: (Point, Point), shadow: impl Iterator<Item = Place>) {
        let reaches = |curve: &OnSurface, sizes: f64| {
            let bounds = curve.bounds;
            bounds.is_some_and(|bounds| beyond(bounds, surface, sizes))
        };
        let left = |(place, curve): (usize, &OnSurface)| {
            reaches(curve, if place == 0 { VISIBLE } else { FAR })
        };
        let (gone, others): (Vec<_>, Vec<_>) = self
            .curves
            .iter()
            .enumerate()
            .partition(|curve| left(*curve));
        if gone.is_empty() {
            return;
        }
        let traces = others
            .iter()
            .flat_map(|(_, curve)| [&curve.front, &curve.back]);
        let corners = traces.filter_map(Trace::bounds);
        let corners = corners.flat_map(|(low, high)| [low, high]);
        self.frame = bounding_box(shadow.chain(corners)).map(|((a, b), (c, d))| {
            let margin = LEEWAY * (c - a).max(d - b);
            ((a - margin, b - margin), (c + margin, d + margin))
        });
        let who = if self.curves.len() > 1 { "a" } else { "the" };
        self.note.push_str(&format!("; {who} curve has left it"));
    }

    /// The unit sphere with circles of latitude and longitude.
    pub fn sphere(&mut self, note: &str) {
        let circle = |of: &dyn Fn(f64) -> Point| -> Vec<Point> {
            let turn = std::f64::consts::TAU / 120.0;
            (0..=120).map(|k| of(turn * f64::from(k))).collect()
        };
        for k in -2..=2 {
            let (s, c) = (std::f64::consts::FRAC_PI_6 * f64::from(k)).sin_cos();
            let latitude = circle(&|t| [c * t.cos(), c * t.sin(), s]);
            self.contours.add(&latitude, &|point| *point);
        }
        for k in 0..6 {
            let (s, c) = (std::f64::consts::FRAC_PI_6 * f64::from(k)).sin_cos();
            let meridian = circle(&|t| [c * t.cos(), s * t.cos(), t.sin()]);
            self.contours.add(&meridian, &|point| *point);
        }
        let [right, up, _] = camera();
        let edge = circle(&|t| [0, 1, 2].map(|i| right[i] * t.cos() + up[i] * t.sin()));
        self.outline
            .keep(true, edge.iter().map(projected).collect());
        self.note = note.to_owned();
    }

    /// The picture.
    pub fn to_svg(&self) -> String {
        let traces = self
            .curves
            .iter()
            .flat_map(|curve| [&curve.front, &curve.back]);
        let corners = traces.filter_map(Trace::bounds);
        let corners = corners.flat_map(|(low, high)| [low, high]);
        let lines = self.contours.all().chain(self.outline.all());
        let lines = lines.chain(self.border.all()).copied();
        let (low, high) = self
            .frame
            .unwrap_or(((f64::MIN, f64::MIN), (f64::MAX, f64::MAX)));
        let kept = |(x, y): Place| (x.clamp(low.0, high.0), y.clamp(low.1, high.1));
        let bounds = bounding_box(corners.chain(lines).map(kept));
        let ((left, bottom), (right, top)) = bounds.unwrap_or(((-1.0, -1.0), (1.0, 1.0)));
        let size = (right - left).max(top - bottom);
        let size = if size > 0.0 { 1.06 * size } else { 1.0 };
        let middle = (0.5 * (left + right), 0.5 * (bottom + top));
        let place = |&(x, y): &Place| -> Place {
            (
                LEFT + SIDE * (0.5 + (x - middle.0) / size),
                HEAD + SIDE * (0.5 - (y - middle.1) / size),
            )
        };
        let mut svg = Svg::default();
        let mut draw = |pieces: &[Vec<Place>], attributes: &str| {
            let inside = pieces.iter().flat_map(|piece| match self.frame {
                Some(frame) => clipped(piece, frame),
                None => vec![piece.clone()],
            });
            for piece in inside.filter(|piece| piece.len() > 1) {
                let places: Vec<Place> = piece.iter().map(place).collect();
                svg.polyline(thinned(&places, FINEST), attributes);
            }
        };
        draw(
            &self.contours.back,
            "stroke=\"#e3e3e3\" stroke-width=\"0.8\"",
        );
        draw(&self.border.back, "stroke=\"#d4d4d4\" stroke-width=\"0.8\"");
        for (index, curve) in self.curves.iter().enumerate() {
            let stroke = format!("stroke=\"{}\" stroke-width=\"1.1\"", pale(paint(index)));
            draw(curve.back.pieces(), &stroke);
        }
        draw(
            &self.contours.front,
            "stroke=\"#a8a8a8\" stroke-width=\"0.8\"",
        );
        draw(&self.border.front, "stroke=\"#888\" stroke-width=\"0.9\"");
        draw(&self.outline.front, "stroke=\"#777\" stroke-width=\"1.2\"");
        for (index, curve) in self.curves.iter().enumerate() {
            let paint = paint(index);
            draw(
                curve.front.pieces(),
                &format!("stroke=\"{paint}\" stroke-width=\"1.6\""),
            );
        }
        let inside = |&(x, y): &&Place| kept((*x, *y)) == (*x, *y);
        for (index, curve) in self.curves.iter().enumerate() {
            let [front, back] = curve.dots();
            for (dots, paint) in [(back, &*pale(paint(index))), (front, paint(index))] {
                let places: Vec<Place> = dots.iter().filter(inside).map(place).collect();
                if !places.is_empty() {
                    svg.discs(&places, 2.4, paint);
                }
            }
            if let Some(first) = &curve.first {
                let paint = paint(index);
                svg.disc(place(&projected(first)), 4.0, &format!("fill=\"{paint}\""));
            }
        }
        self.directions(&mut svg);
        let height = self.legend(&mut svg);
        svg.page((SIDE + 2.0 * LEFT, height), &self.title, &self.subtitle)
    }

    /// The directions of the axes, in the lower left corner.
    fn directions(&self, svg: &mut Svg) {
        let origin = (LEFT + 40.0, HEAD + SIDE - 10.0);
        for (axis, name) in self.axes.iter().enumerate() {
            let mut unit = [0.0; 3];
            unit[axis] = 1.0;
            let (x, y) = projected(&unit);
            let end = (origin.0 + 44.0 * x, origin.1 - 44.0 * y);
            svg.line(
                origin,
                end,
                &format!("stroke=\"{FAINT}\" stroke-width=\"1.4\""),
            );
            let at = (origin.0 + 58.0 * x, origin.1 - 58.0 * y + 4.0);
            let style = format!("text-anchor=\"middle\" fill=\"{INK}\"");
            svg.text(at, 13.0, &style, name);
        }
    }

    fn legend(&self, svg: &mut Svg) -> f64 {
        let mut y = HEAD + SIDE + 34.0;
        if self.curves.len() > 1 {
            for (index, curve) in self.curves.iter().enumerate() {
                let paint = paint(index);
                let stroke = format!("stroke=\"{paint}\" stroke-width=\"2.5\"");
                svg.line((LEFT, y - 4.0), (LEFT + 24.0, y - 4.0), &stroke);
                svg.text(
                    (LEFT + 32.0, y),
                    13.0,
                    &format!("fill=\"{INK}\""),
                    &curve.name,
                );
                y += LINE;
            }
        }
        let mut notes = vec!["dot: where it starts; pale: the side that is turned away"];
        if !self.note.is_empty() {
            notes.insert(0, &self.note);
        }
        for note in notes {
            svg.text((LEFT, y), 12.0, &format!("fill=\"{FAINT}\""), note);
            y += LINE;
        }
        y + 6.0
    }
}

#[cfg(test)]
mod tests;
