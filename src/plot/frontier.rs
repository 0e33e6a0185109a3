//! Error against run time of many methods, both logarithmic.
//!
//! One panel for each class of methods that keep the same, with all other curves in grey behind; colour tells the
//! family, dashes and markers the order. Curves on the front of their class (no other in it is faster at an error) are
//! drawn in full strength with their names in bold; a pale band follows what is fastest of all classes.
//!
//! ```
//! use lie_poisson::plot::frontier::{Curve, Frontier};
//! let curve = Curve {
//!     name: "rk4".into(),
//!     class: "linear invariants".into(),
//!     family: "control".into(),
//!     order: 4,
//!     control: true,
//!     points: vec![(1e-6, 1e-3), (2e-6, 6e-5)],
//! };
//! let picture = Frontier { title: "Top".into(), subtitle: String::new(), floor: 1e-14, curves: vec![curve] };
//! assert!(picture.to_svg().contains("rk4"));
//! ```

use std::fmt::Write as _;

const WIDTH: f64 = 1160.0;
const HEAD: f64 = 76.0;
/// Panels beside one another, and the size of the frame of each.
const ACROSS: usize = 3;
const PANEL: (f64, f64) = (300.0, 330.0);
const LEFT: f64 = 66.0;
const STRIDE: f64 = 364.0;
const TITLE: f64 = 26.0;
const BELOW: f64 = 44.0;
const LINE: f64 = 15.0;
/// Curves of a panel at most, unless one family has more.
const CURVES: usize = 12;

/// Colours of families: neighbours in the list differ in hue and in lightness.
const COLOURS: [&str; 16] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#332288", "#882255", "#44aa99",
    "#999933", "#56b4e9", "#aa4466", "#117733", "#6699cc", "#b8860b", "#7f3fbf", "#4d4d00",
];
/// The error below which a method is measured against others.
const SERIOUS: f64 = 1e-2;

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
    /// A second line.
    pub subtitle: String,
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

/// The curves of one panel.
struct Panel<'a> {
    title: String,
    curves: Vec<&'a Curve>,
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
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
        let mut body = String::new();
        for row in panels.chunks(ACROSS) {
            for (column, panel) in row.iter().enumerate() {
                let corner = (LEFT + STRIDE * column as f64, top + TITLE);
                self.panel(&mut body, &Scale { x, y, corner }, panel, &curves);
            }
            let longest = row
                .iter()
                .map(|panel| panel.curves.len())
                .max()
                .unwrap_or(0);
            top += TITLE + PANEL.1 + BELOW + LINE * longest.div_ceil(2) as f64 + 22.0;
        }
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{top}\" \
             viewBox=\"0 0 {WIDTH} {top}\" font-family=\"sans-serif\" stroke-linejoin=\"round\">\n\
             <title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
             <text x=\"20\" y=\"32\" font-size=\"22\" fill=\"#222\">{title}</text>\n\
             <text x=\"20\" y=\"55\" font-size=\"14\" fill=\"#666\">{}</text>\n{body}</svg>\n",
            escaped(&self.subtitle),
            title = escaped(&self.title),
        )
    }

    fn panel(&self, svg: &mut String, scale: &Scale, panel: &Panel<'_>, all: &[Curve]) {
        let (x, y) = scale.corner;
        let _ = writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"14\" font-weight=\"bold\" fill=\"#222\">{}</text>",
            y - 9.0,
            escaped(&panel.title)
        );
        self.axes(svg, scale);
        draw_front(svg, all, scale);
        for curve in all {
            let line = line_of(curve, scale);
            let _ = writeln!(
                svg,
                "<polyline points=\"{line}\" fill=\"none\" stroke=\"#d4d4d4\" stroke-width=\"0.8\"/>"
            );
        }
        let mut families: Vec<&str> = Vec::new();
        for curve in &panel.curves {
            if !families.contains(&curve.family.as_str()) {
                families.push(&curve.family);
            }
        }
        let colour = |curve: &Curve| {
            let place = families.iter().position(|family| *family == curve.family);
            COLOURS[place.unwrap_or(0) % COLOURS.len()]
        };
        let front = front(&panel.curves, self.floor);
        for front_too in [false, true] {
            for (curve, on_front) in panel.curves.iter().zip(&front) {
                if *on_front == front_too {
                    draw(svg, curve, colour(curve), *on_front, scale);
                }
            }
        }
        let rows = panel.curves.len().div_ceil(2);
        for (index, (curve, on_front)) in panel.curves.iter().zip(&front).enumerate() {
            let x = x - 34.0 + 172.0 * (index / rows) as f64;
            let y = y + PANEL.1 + BELOW + LINE * (index % rows) as f64;
            legend(svg, (x, y), curve, colour(curve), *on_front);
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

    fn axes(&self, svg: &mut String, scale: &Scale) {
        let (left, top) = scale.corner;
        let (right, bottom) = (left + PANEL.0, top + PANEL.1);
        let mut line = |x1: f64, y1: f64, x2: f64, y2: f64, colour: &str| {
            let _ = writeln!(
                svg,
                "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{colour}\"/>"
            );
        };
        let across = scale.x.0.ceil() as i32..=scale.x.1.floor() as i32;
        let up = (scale.y.0.ceil() as i32..=scale.y.1.floor() as i32).filter(|k| k % 3 == 0);
        for k in across.clone() {
            let (x, _) = scale.place((10_f64.powi(k), 1.0));
            line(x, top, x, bottom, "#eeeeee");
        }
        for k in up.clone() {
            let (_, y) = scale.place((1.0, 10_f64.powi(k)));
            line(left, y, right, y, "#eeeeee");
        }
        line(left, bottom, right, bottom, "#777");
        line(left, top, left, bottom, "#777");
        if self.floor.log10() > scale.y.0 {
            let (_, y) = scale.place((1.0, self.floor));
            let _ = writeln!(
                svg,
                "<rect x=\"{left}\" y=\"{y:.1}\" width=\"{}\" height=\"{:.1}\" fill=\"#f0f0f0\"/>\n\
                 <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"10\" fill=\"#888\">below the error of the reference</text>",
                PANEL.0,
                bottom - y,
                left + 5.0,
                bottom - 4.0,
            );
        }
        for k in across {
            let (x, _) = scale.place((10_f64.powi(k), 1.0));
            let name = match k {
                -9..=-7 => format!("{} ns", 10_i32.pow((k + 9) as u32)),
                -6..=-4 => format!("{} µs", 10_i32.pow((k + 6) as u32)),
                -3..=-1 => format!("{} ms", 10_i32.pow((k + 3) as u32)),
                _ => format!("1e{k} s"),
            };
            let _ = writeln!(
                svg,
                "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"11\" text-anchor=\"middle\" fill=\"#222\">{name}</text>",
                bottom + 15.0
            );
        }
        for k in up {
            let (_, y) = scale.place((1.0, 10_f64.powi(k)));
            let label = if k == 0 {
                "1".to_owned()
            } else {
                let exponent = k.to_string().replace('-', "−");
                format!("10<tspan dy=\"-5\" font-size=\"9\">{exponent}</tspan>")
            };
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" text-anchor=\"end\" fill=\"#222\">{label}</text>",
                left - 6.0,
                y + 4.0
            );
        }
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

fn line_of(curve: &Curve, scale: &Scale) -> String {
    let places = curve.points.iter().map(|&point| scale.place(point));
    let text: Vec<String> = places.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    text.join(" ")
}

/// Which curves have a point that no other curve beats in both.
fn front(curves: &[&Curve], floor: f64) -> Vec<bool> {
    let on_front = |curve: &Curve| {
        // errors of the size of the solution are no contest, nor are those that nobody knows
        let serious = curve
            .points
            .iter()
            .filter(|point| point.1 < SERIOUS && point.1 > floor);
        serious.into_iter().any(|&(seconds, error)| {
            let others = curves.iter().filter(|other| other.name != curve.name);
            let beaten = others
                .flat_map(|other| segments(&other.points))
                .any(|(from, to)| beats(from, to, seconds, error));
            !beaten
        })
    };
    curves.iter().map(|curve| on_front(curve)).collect()
}

/// A pale band along the points that none beats.
fn draw_front(svg: &mut String, curves: &[Curve], scale: &Scale) {
    let all = curves.iter().filter(|curve| !curve.control);
    let mut points: Vec<(f64, f64)> = all.flat_map(|curve| curve.points.iter().copied()).collect();
    points.retain(|point| point.1 < SERIOUS);
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut least = f64::INFINITY;
    points.retain(|point| {
        let better = point.1 < least;
        least = least.min(point.1);
        better
    });
    let line: Vec<String> = points
        .iter()
        .map(|&point| scale.place(point))
        .map(|(x, y)| format!("{x:.1},{y:.1}"))
        .collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#ffe08a\" stroke-width=\"9\" stroke-linecap=\"round\" opacity=\"0.6\"/>",
        line.join(" ")
    );
}

fn segments(points: &[(f64, f64)]) -> impl Iterator<Item = ((f64, f64), (f64, f64))> {
    points.iter().enumerate().map(|(index, &point)| {
        let next = points.get(index + 1).copied().unwrap_or(point);
        (point, next)
    })
}

/// Whether a segment passes below and left of a point.
fn beats(from: (f64, f64), to: (f64, f64), seconds: f64, error: f64) -> bool {
    let better = |p: (f64, f64)| p.0 < seconds && p.1 < error;
    if better(from) || better(to) {
        return true;
    }
    if from.0 >= seconds || to.0 <= seconds {
        return false;
    }
    let part = (seconds / from.0).ln() / (to.0 / from.0).ln();
    let there = from.1.ln() + part * (to.1 / from.1).ln();
    there < error.ln() - 1e-9
}

/// Dashes by order: the higher, the more solid.
fn dashes(order: u32) -> &'static str {
    match order {
        0..=1 => "1 4",
        2 => "3 3",
        3 => "6 3 1 3",
        4 => "9 3",
        5 => "14 3 2 3",
        _ => "",
    }
}

fn marker(svg: &mut String, (x, y): (f64, f64), order: u32, size: f64, colour: &str) {
    let shape = match order {
        0..=1 => {
            let (a, b, c, d) = (x - size, x + size, y - size, y + size);
            format!(
                "<path d=\"M{a:.1} {c:.1}L{b:.1} {d:.1}M{a:.1} {d:.1}L{b:.1} {c:.1}\" stroke=\"{colour}\" fill=\"none\"/>"
            )
        }
        2 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{size:.1}\" fill=\"{colour}\"/>"),
        3 => polygon(x, y, size * 1.3, 3, -90.0, colour),
        4 => polygon(x, y, size * 1.3, 4, 45.0, colour),
        5 => polygon(x, y, size * 1.3, 5, -90.0, colour),
        6 => polygon(x, y, size * 1.3, 6, 0.0, colour),
        _ => polygon(x, y, size * 1.5, 4, 0.0, colour),
    };
    svg.push_str(&shape);
    svg.push('\n');
}

fn polygon(x: f64, y: f64, radius: f64, corners: u32, turned: f64, colour: &str) -> String {
    let corner = |k: u32| {
        let angle = (turned + 360.0 * f64::from(k) / f64::from(corners)).to_radians();
        format!(
            "{:.1},{:.1}",
            x + radius * angle.cos(),
            y + radius * angle.sin()
        )
    };
    let points: Vec<String> = (0..corners).map(corner).collect();
    format!(
        "<polygon points=\"{}\" fill=\"{colour}\"/>",
        points.join(" ")
    )
}

fn draw(svg: &mut String, curve: &Curve, colour: &str, on_front: bool, scale: &Scale) {
    let (width, opacity, size) = if on_front {
        (2.0, 1.0, 3.0)
    } else {
        (1.1, 0.75, 2.2)
    };
    let _ = writeln!(
        svg,
        "<g opacity=\"{opacity}\"><title>{}</title><polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" \
         stroke-width=\"{width}\" stroke-dasharray=\"{}\"/>",
        escaped(&curve.name),
        line_of(curve, scale),
        dashes(curve.order),
    );
    for &point in &curve.points {
        marker(svg, scale.place(point), curve.order, size, colour);
    }
    svg.push_str("</g>\n");
}

fn legend(svg: &mut String, (x, y): (f64, f64), curve: &Curve, colour: &str, on_front: bool) {
    let _ = writeln!(
        svg,
        "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\" stroke=\"{colour}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"/>",
        x + 26.0,
        if on_front { 2.0 } else { 1.2 },
        dashes(curve.order)
    );
    marker(svg, (x + 13.0, y), curve.order, 3.0, colour);
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\" fill=\"#222\"{}>{}</text>",
        x + 31.0,
        y + 4.0,
        if on_front {
            " font-weight=\"bold\""
        } else {
            ""
        },
        escaped(&curve.name)
    );
}
