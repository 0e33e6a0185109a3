//! Error against run time of many methods, both logarithmic.
//!
//! One panel for each class of methods that keep the same, with all other curves in grey behind; colour tells the
//! family, dashes and markers the order, dots between dashes and hollow markers the variants of one order. Curves on the front of their class (no other in it is faster at an error) are
//! drawn in full strength with their names in bold; a pale band follows what is fastest of all classes.
//!
//! ```
//! use lie_plot::frontier::{Curve, Frontier};
//! let curve = Curve {
//!     name: "rk4".into(),
//!     class: "linear invariants".into(),
//!     family: "control".into(),
//!     order: 4,
//!     control: true,
//!     points: vec![(1e-6, 1e-3), (2e-6, 6e-5)],
//! };
//! let (title, axis) = ("Top".into(), "error".into());
//! let picture = Frontier { title, subtitle: String::new(), axis, floor: 1e-14, curves: vec![curve] };
//! assert!(picture.to_svg().contains("rk4"));
//! ```

mod front;
mod look;

use super::svg::{FAINT, INK, Place, Svg, text_width};
use front::{fastest, front};
use look::{Look, looks};

const WIDTH: f64 = 1160.0;
const HEAD: f64 = 76.0;
/// Panels beside one another, and the size of the frame of each.
const ACROSS: usize = 3;
const PANEL: (f64, f64) = (300.0, 330.0);
const LEFT: f64 = 66.0;
const STRIDE: f64 = 364.0;
const TITLE: f64 = 26.0;
const BELOW: f64 = 54.0;
/// Where the second column of a legend begins at the earliest, and what a name begins with.
const COLUMN: f64 = 172.0;
const SAMPLE: f64 = 31.0;
const LINE: f64 = 15.0;
/// Curves of a panel at most, unless one family has more.
const CURVES: usize = 12;

/// One method.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name, with options.
    pub name: String,
    /// What its panel has in common: what the methods in it keep.
    pub class: String,
    /// What it shares its colour with.
    pub family: String,
    /// Its order.
    pub order: u32,
    /// Whether it is only there to compare with.
    pub control: bool,
    /// Seconds and errors.
    pub points: Vec<(f64, f64)>,
}

/// The picture.
#[derive(Clone, Debug)]
pub struct Frontier {
    /// Its title.
    pub title: String,
    /// A second line; what is bold, pale and grey is said after it.
    pub subtitle: String,
    /// What the axis at the left shows, in a word or two.
    pub axis: String,
    /// The error of the reference: below it nothing is known.
    pub floor: f64,
    /// The methods.
    pub curves: Vec<Curve>,
}

struct Scale {
    x: (f64, f64),
    y: (f64, f64),
    /// The upper left corner of the frame.
    corner: (f64, f64),
}

impl Scale {
    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let across = (x.log10() - self.x.0) / (self.x.1 - self.x.0);
        let up = (y.log10() - self.y.0) / (self.y.1 - self.y.0);
        (
            self.corner.0 + PANEL.0 * across,
            self.corner.1 + PANEL.1 * (1.0 - up),
        )
    }
}

impl Scale {
    fn line(&self, points: &[(f64, f64)]) -> impl Iterator<Item = Place> {
        points.iter().map(|&point| self.place(point))
    }
}

/// The curves of one panel.
struct Panel<'a> {
    title: String,
    curves: Vec<&'a Curve>,
}

impl Panel<'_> {
    /// The rows of the legend, and how far apart its columns are: one column where two have no room.
    fn legend(&self) -> (usize, f64) {
        let rows = self.curves.len().div_ceil(2);
        // any name may be bold
        let entry = |curve: &&Curve| SAMPLE + text_width(&curve.name, 11.0, true) + 10.0;
        let widest = |curves: &[&Curve]| curves.iter().map(entry).fold(0.0, f64::max);
        let (first, second) = self.curves.split_at(rows);
        let column = widest(first).max(COLUMN);
        match column + widest(second) <= STRIDE {
            true => (rows.max(1), column),
            false => (self.curves.len(), 0.0),
        }
    }
}

impl Frontier {
    /// The picture as SVG.
    pub fn to_svg(&self) -> String {
        let mut curves: Vec<Curve> = self.curves.iter().map(|c| self.visible(c)).collect();
        curves.retain(|curve| !curve.points.is_empty());
        let panels = panels(&curves);
        let (x, y) = bounds(&curves);
        // rows are as high as the longest legend in them
        let mut top = HEAD;
        let mut body = Svg::default();
        for row in panels.chunks(ACROSS) {
            for (column, panel) in row.iter().enumerate() {
                let corner = (LEFT + STRIDE * column as f64, top + TITLE);
                self.panel(&mut body, &Scale { x, y, corner }, panel, &curves);
            }
            let longest = row.iter().map(|panel| panel.legend().0).max().unwrap_or(0);
            top += TITLE + PANEL.1 + BELOW + LINE * longest as f64 + 22.0;
        }
        body.page(
            (WIDTH, top),
            &self.title,
            &self.second_line(&panels, &curves),
        )
    }

    /// The second line of the picture: what is bold and pale is explained where there is some.
    fn second_line(&self, panels: &[Panel<'_>], curves: &[Curve]) -> String {
        let mut parts = vec![self.subtitle.clone()];
        let bold = |panel: &Panel<'_>| front(&panel.curves, self.floor).contains(&true);
        if panels.iter().any(bold) {
            parts.push(format!("bold: fastest in the panel at some {}", self.axis));
        }
        if fastest(curves).len() > 1 {
            parts.push("band: fastest of the catalogue".to_owned());
        }
        parts.push("grey: the others".to_owned());
        parts.retain(|part| !part.is_empty());
        parts.join("; ")
    }

    fn panel(&self, svg: &mut Svg, scale: &Scale, panel: &Panel<'_>, all: &[Curve]) {
        let (x, y) = scale.corner;
        let bold = format!("font-weight=\"bold\" fill=\"{INK}\"");
        svg.text((x, y - 9.0), 14.0, &bold, &panel.title);
        self.axes(svg, scale);
        draw_front(svg, all, scale);
        for curve in all {
            let grey = "stroke=\"#d4d4d4\" stroke-width=\"0.8\"";
            svg.polyline(scale.line(&curve.points), grey);
        }
        let looks = looks(&panel.curves);
        let front = front(&panel.curves, self.floor);
        for front_too in [false, true] {
            for ((curve, look), on_front) in panel.curves.iter().zip(&looks).zip(&front) {
                if *on_front == front_too {
                    draw(svg, curve, look, *on_front, scale);
                }
            }
        }
        self.say_floor(svg, scale);
        let (rows, column) = panel.legend();
        let entries = panel.curves.iter().zip(&looks).zip(&front);
        for (index, ((curve, look), on_front)) in entries.enumerate() {
            let x = x - 34.0 + column * (index / rows) as f64;
            let y = y + PANEL.1 + BELOW + LINE * (index % rows) as f64;
            legend(svg, (x, y), curve, look, *on_front);
        }
    }

    /// Points that can be drawn, without what lies below the error of the reference.
    fn visible(&self, curve: &Curve) -> Curve {
        let least = self.floor.max(1e-17);
        let mut points: Vec<(f64, f64)> = Vec::new();
        for &(seconds, error) in &curve.points {
            if !(seconds > 0.0 && error < 3.0) {
                continue;
            }
            points.push((seconds, error.max(least)));
            // beyond the first point at the floor only time is lost
            if error <= least {
                break;
            }
        }
        Curve {
            points,
            ..curve.clone()
        }
    }

    fn axes(&self, svg: &mut Svg, scale: &Scale) {
        let (left, top) = scale.corner;
        let (right, bottom) = (left + PANEL.0, top + PANEL.1);
        let across = scale.x.0.ceil() as i32..=scale.x.1.floor() as i32;
        let up = (scale.y.0.ceil() as i32..=scale.y.1.floor() as i32).filter(|k| k % 3 == 0);
        let column = |k: i32| scale.place((10_f64.powi(k), 1.0)).0;
        let row = |k: i32| scale.place((1.0, 10_f64.powi(k))).1;
        let (grid, axis) = ("stroke=\"#eeeeee\"", "stroke=\"#777\"");
        for x in across.clone().map(column) {
            svg.line((x, top), (x, bottom), grid);
        }
        for y in up.clone().map(row) {
            svg.line((left, y), (right, y), grid);
        }
        svg.line((left, bottom), (right, bottom), axis);
        svg.line((left, top), (left, bottom), axis);
        if self.floor.log10() > scale.y.0 {
            let (_, y) = scale.place((1.0, self.floor));
            svg.rectangle((left, y), (PANEL.0, bottom - y), "fill=\"#f0f0f0\"", "");
        }
        let anchored = |anchor: &str| format!("text-anchor=\"{anchor}\" fill=\"{INK}\"");
        for k in across {
            svg.text(
                (column(k), bottom + 15.0),
                11.0,
                &anchored("middle"),
                &duration(k),
            );
        }
        for k in up {
            svg.power_of_ten((left - 6.0, row(k) + 4.0), 12.0, &anchored("end"), k);
        }
        let faint = format!("text-anchor=\"middle\" fill=\"{FAINT}\"");
        let below = (left + 0.5 * PANEL.0, bottom + 32.0);
        svg.text(below, 12.0, &faint, "run time");
        let side = (left - 48.0, top + 0.5 * PANEL.1);
        svg.turned_text(side, -90.0, 12.0, &faint, &self.axis);
    }

    /// Names the band below the error of the reference, over the curves that end in it.
    fn say_floor(&self, svg: &mut Svg, scale: &Scale) {
        if self.floor.log10() > scale.y.0 {
            let place = (scale.corner.0 + 5.0, scale.corner.1 + PANEL.1 - 4.0);
            let halo = "stroke=\"#f0f0f0\" stroke-width=\"4\" paint-order=\"stroke\"";
            let style = format!("fill=\"{FAINT}\" {halo}");
            svg.text(place, 10.0, &style, "below the error of the reference");
        }
    }
}

/// Ten to so many seconds.
fn duration(exponent: i32) -> String {
    match exponent {
        -9..=-7 => format!("{} ns", 10_i32.pow((exponent + 9) as u32)),
        -6..=-4 => format!("{} µs", 10_i32.pow((exponent + 6) as u32)),
        -3..=-1 => format!("{} ms", 10_i32.pow((exponent + 3) as u32)),
        _ => format!("1e{exponent} s"),
    }
}

/// Classes in the order in which they come, large ones in several panels, no family in two; controls last.
fn panels(curves: &[Curve]) -> Vec<Panel<'_>> {
    let mut classes: Vec<&str> = Vec::new();
    for curve in curves {
        if !classes.contains(&curve.class.as_str()) {
            classes.push(&curve.class);
        }
    }
    classes.sort_by_key(|class| curves.iter().any(|c| c.class == **class && c.control));
    let mut panels: Vec<Panel<'_>> = Vec::new();
    for class in classes {
        let mut families: Vec<Vec<&Curve>> = Vec::new();
        for curve in curves.iter().filter(|curve| curve.class == class) {
            match families.iter_mut().find(|f| f[0].family == curve.family) {
                Some(family) => family.push(curve),
                None => families.push(vec![curve]),
            }
        }
        let first = panels.len();
        for mut family in families {
            family.sort_by_key(|curve| curve.order);
            match panels[first..].last_mut() {
                Some(panel) if panel.curves.len() + family.len() <= CURVES => {
                    panel.curves.extend(family);
                }
                _ => panels.push(Panel {
                    title: class.to_owned(),
                    curves: family,
                }),
            }
        }
        let count = panels.len() - first;
        if count > 1 {
            for (index, panel) in panels[first..].iter_mut().enumerate() {
                panel.title = format!("{class} ({} of {count})", index + 1);
            }
        }
    }
    panels
}

/// The exponents between which all points lie, with a margin.
fn bounds(curves: &[Curve]) -> ((f64, f64), (f64, f64)) {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let bounds = |of: fn(&(f64, f64)) -> f64| {
        let low = all().map(of).fold(f64::INFINITY, f64::min);
        let high = all().map(of).fold(0.0, f64::max);
        if low <= high {
            (low.log10(), high.log10())
        } else {
            (-1.0, 1.0)
        }
    };
    let (x, y) = (bounds(|p| p.0), bounds(|p| p.1));
    let low = y.0.floor();
    ((x.0 - 0.08, x.1 + 0.08), (low, y.1.max(low + 1.0) + 0.1))
}

/// A pale band along the points that none beats.
fn draw_front(svg: &mut Svg, curves: &[Curve], scale: &Scale) {
    let band = "stroke=\"#ffe08a\" stroke-width=\"9\" stroke-linecap=\"round\" opacity=\"0.6\"";
    svg.polyline(scale.line(&fastest(curves)), band);
}

fn draw(svg: &mut Svg, curve: &Curve, look: &Look, on_front: bool, scale: &Scale) {
    let (width, opacity, size) = if on_front {
        (2.0, 1.0, 3.0)
    } else {
        (1.1, 0.75, 2.2)
    };
    let stroke = look.stroke(width);
    svg.group(&format!("opacity=\"{opacity}\""), &curve.name, |svg| {
        svg.polyline(scale.line(&curve.points), &stroke);
        for place in scale.line(&curve.points) {
            look.marker(svg, place, size);
        }
    });
}

fn legend(svg: &mut Svg, (x, y): Place, curve: &Curve, look: &Look, on_front: bool) {
    let (width, weight) = if on_front {
        (2.0, "bold")
    } else {
        (1.2, "normal")
    };
    svg.line((x, y), (x + 26.0, y), &look.stroke(width));
    look.marker(svg, (x + 13.0, y), 3.0);
    let style = format!("font-weight=\"{weight}\" fill=\"{INK}\"");
    svg.text((x + SAMPLE, y + 4.0), 11.0, &style, &curve.name);
}
