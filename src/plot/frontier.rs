//! Error against run time of many methods, both logarithmic.
//!
//! Colour tells the family, dashes and markers the order; the curves on the front (no other is faster at
//! an error) are drawn in full strength with their names in bold.
//!
//! ```
//! use lie_poisson::plot::frontier::{Curve, Frontier};
//! let curve = Curve {
//!     name: "rk4".into(),
//!     family: "control".into(),
//!     order: 4,
//!     control: true,
//!     points: vec![(1e-6, 1e-3), (2e-6, 6e-5)],
//! };
//! let picture = Frontier { title: "Top".into(), subtitle: String::new(), floor: 1e-14, curves: vec![curve] };
//! assert!(picture.to_svg().contains("rk4"));
//! ```

use std::fmt::Write as _;

const WIDTH: f64 = 1120.0;
const LEFT: f64 = 78.0;
const TOP: f64 = 78.0;
const PANEL: f64 = 700.0;
const LINE: f64 = 17.0;

/// Colours of families: neighbours in the list differ in hue and in lightness.
const COLOURS: [&str; 16] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#332288", "#882255", "#44aa99",
    "#999933", "#56b4e9", "#aa4466", "#117733", "#6699cc", "#b8860b", "#7f3fbf", "#4d4d00",
];
const CONTROL: &str = "#777777";
/// The error below which a method is measured against others.
const SERIOUS: f64 = 1e-2;

/// One method.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name, with options.
    pub name: String,
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
    height: f64,
}

impl Scale {
    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let across = (x.log10() - self.x.0) / (self.x.1 - self.x.0);
        let up = (y.log10() - self.y.0) / (self.y.1 - self.y.0);
        (LEFT + PANEL * across, TOP + self.height * (1.0 - up))
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

impl Frontier {
    /// The picture as SVG.
    pub fn to_svg(&self) -> String {
        let mut curves: Vec<Curve> = self.curves.iter().map(|c| self.visible(c)).collect();
        curves.retain(|curve| !curve.points.is_empty());
        let mut families: Vec<String> = Vec::new();
        for curve in &curves {
            if !families.contains(&curve.family) {
                families.push(curve.family.clone());
            }
        }
        families.sort_by_key(|family| family == "control");
        curves.sort_by_key(|curve| {
            let family = families.iter().position(|family| *family == curve.family);
            (family, curve.order, curve.name.clone())
        });
        let scale = self.scale(&curves);
        let front = front(&curves, self.floor);
        let height = TOP + scale.height + 70.0;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" \
             viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" stroke-linejoin=\"round\">\n\
             <title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
             <text x=\"20\" y=\"32\" font-size=\"22\" fill=\"#222\">{title}</text>\n\
             <text x=\"20\" y=\"55\" font-size=\"14\" fill=\"#666\">{}</text>\n",
            escaped(&self.subtitle),
            title = escaped(&self.title),
        );
        self.axes(&mut svg, &scale);
        draw_front(&mut svg, &curves, &scale);
        for front_too in [false, true] {
            for (curve, on_front) in curves.iter().zip(&front) {
                if *on_front == front_too {
                    draw(&mut svg, curve, colour(curve, &families), *on_front, &scale);
                }
            }
        }
        legend(&mut svg, &curves, &families, &front);
        svg.push_str("</svg>\n");
        svg
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

    fn scale(&self, curves: &[Curve]) -> Scale {
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
        let legend = (curves.len() + 4) as f64 * LINE;
        Scale {
            x: (x.0 - 0.08, x.1 + 0.08),
            y: (y.0.floor(), y.1.max(y.0.floor() + 1.0) + 0.1),
            height: legend.max(560.0),
        }
    }

    fn axes(&self, svg: &mut String, scale: &Scale) {
        let bottom = TOP + scale.height;
        let mut line = |x1: f64, y1: f64, x2: f64, y2: f64, colour: &str| {
            let _ = writeln!(
                svg,
                "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{colour}\"/>"
            );
        };
        for k in scale.x.0.ceil() as i32..=scale.x.1.floor() as i32 {
            let (x, _) = scale.place((10_f64.powi(k), 1.0));
            line(x, TOP, x, bottom, "#e4e4e4");
        }
        for k in scale.y.0.ceil() as i32..=scale.y.1.floor() as i32 {
            let (_, y) = scale.place((1.0, 10_f64.powi(k)));
            line(
                LEFT,
                y,
                LEFT + PANEL,
                y,
                if k % 3 == 0 { "#d0d0d0" } else { "#eeeeee" },
            );
        }
        line(LEFT, bottom, LEFT + PANEL, bottom, "#777");
        line(LEFT, TOP, LEFT, bottom, "#777");
        if self.floor.log10() > scale.y.0 {
            let (_, y) = scale.place((1.0, self.floor));
            let _ = writeln!(
                svg,
                "<rect x=\"{LEFT}\" y=\"{y:.1}\" width=\"{PANEL}\" height=\"{:.1}\" fill=\"#f2f2f2\"/>\n\
                 <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" fill=\"#777\">below the error of the reference</text>",
                bottom - y,
                LEFT + 8.0,
                (y + 14.0).min(bottom - 4.0),
            );
        }
        for k in scale.x.0.ceil() as i32..=scale.x.1.floor() as i32 {
            let (x, _) = scale.place((10_f64.powi(k), 1.0));
            let name = match k {
                -9 => "1 ns".to_owned(),
                -8..=-7 => format!("{} ns", 10_i32.pow((k + 9) as u32)),
                -6..=-4 => format!("{} µs", 10_i32.pow((k + 6) as u32)),
                -3..=-1 => format!("{} ms", 10_i32.pow((k + 3) as u32)),
                _ => format!("10^{k} s"),
            };
            let _ = writeln!(
                svg,
                "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"14\" text-anchor=\"middle\" fill=\"#222\">{name}</text>",
                bottom + 20.0
            );
        }
        for k in scale.y.0.ceil() as i32..=scale.y.1.floor() as i32 {
            if k % 3 != 0 {
                continue;
            }
            let (_, y) = scale.place((1.0, 10_f64.powi(k)));
            let label = if k == 0 {
                "1".to_owned()
            } else {
                format!(
                    "10<tspan dy=\"-6\" font-size=\"10\">{}</tspan>",
                    k.to_string().replace('-', "−")
                )
            };
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"14\" text-anchor=\"end\" fill=\"#222\">{label}</text>",
                LEFT - 8.0,
                y + 5.0
            );
        }
        let middle = TOP + scale.height / 2.0;
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"14\" text-anchor=\"middle\" fill=\"#222\">run time per unit of time</text>\n\
             <text transform=\"translate(22 {middle:.1}) rotate(-90)\" font-size=\"14\" text-anchor=\"middle\" fill=\"#222\">relative error at the end</text>",
            LEFT + PANEL / 2.0,
            bottom + 46.0
        );
    }
}

/// Which curves have a point that no point of another curve beats in both.
fn front(curves: &[Curve], floor: f64) -> Vec<bool> {
    let of_catalogue = |curve: &&Curve| !curve.control;
    let on_front = |curve: &Curve| {
        // errors of the size of the solution are no contest, nor are those that nobody knows
        let serious = curve
            .points
            .iter()
            .filter(|point| point.1 < SERIOUS && point.1 > floor);
        serious.into_iter().any(|&(seconds, error)| {
            let others = curves.iter().filter(of_catalogue);
            let others = others.filter(|other| other.name != curve.name);
            let beaten = others
                .flat_map(|other| segments(&other.points))
                .any(|(from, to)| beats(from, to, seconds, error));
            !beaten
        })
    };
    curves
        .iter()
        .map(|curve| !curve.control && on_front(curve))
        .collect()
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
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#ffe08a\" stroke-width=\"14\" stroke-linecap=\"round\" opacity=\"0.6\"/>",
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

fn colour<'a>(curve: &Curve, families: &[String]) -> &'a str {
    if curve.control {
        return CONTROL;
    }
    let place = families.iter().position(|family| *family == curve.family);
    COLOURS[place.unwrap_or(0) % COLOURS.len()]
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
    let places: Vec<(f64, f64)> = curve.points.iter().map(|&p| scale.place(p)).collect();
    let line: Vec<String> = places
        .iter()
        .map(|(x, y)| format!("{x:.1},{y:.1}"))
        .collect();
    let (width, opacity, size) = if on_front {
        (2.6, 1.0, 4.0)
    } else {
        (1.2, 0.6, 2.6)
    };
    let _ = writeln!(
        svg,
        "<g opacity=\"{opacity}\"><title>{}</title><polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" \
         stroke-width=\"{width}\" stroke-dasharray=\"{}\"/>",
        escaped(&curve.name),
        line.join(" "),
        dashes(curve.order),
    );
    for place in places {
        marker(svg, place, curve.order, size, colour);
    }
    svg.push_str("</g>\n");
}

fn legend(svg: &mut String, curves: &[Curve], families: &[String], front: &[bool]) {
    let x = LEFT + PANEL + 18.0;
    let mut y = TOP + 2.0;
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"12\" fill=\"#666\">bold: nothing is faster at some error</text>",
        y + 2.0
    );
    y += LINE + 2.0;
    for (curve, on_front) in curves.iter().zip(front) {
        let colour = colour(curve, families);
        let _ = writeln!(
            svg,
            "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\" stroke=\"{colour}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"/>",
            x + 34.0,
            if *on_front { 2.6 } else { 1.4 },
            dashes(curve.order)
        );
        marker(
            svg,
            (x + 17.0, y),
            curve.order,
            if *on_front { 4.0 } else { 3.2 },
            colour,
        );
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12.5\" fill=\"#222\"{}>{}</text>",
            x + 42.0,
            y + 4.5,
            if *on_front {
                " font-weight=\"bold\""
            } else {
                ""
            },
            escaped(&curve.name)
        );
        y += LINE;
    }
}
