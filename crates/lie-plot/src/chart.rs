//! Lines and dots in panels side by side, each axis linear or logarithmic.
//!
//! ```
//! use lie_plot::chart::{Axis, Chart, Panel, Series};
//! let panel = Panel {
//!     title: "Energy".into(),
//!     x: Axis::logarithmic("time"),
//!     y: Axis::logarithmic("drift"),
//!     series: vec![Series::line("rk4", 0, vec![(1e3, 1e-6), (1e4, 1e-5)])],
//! };
//! let picture = Chart { title: "Top".into(), subtitle: String::new(), panels: vec![panel], across: 3 };
//! assert!(picture.to_svg().contains("rk4"));
//! ```

use super::svg::{FAINT, INK, Place, Svg, text_width, thinned};
use super::ticks::Axis as Ticks;

const PANEL: Place = (300.0, 260.0);
const LEFT: f64 = 84.0;
const STRIDE: Place = (396.0, 344.0);
const HEAD: f64 = 102.0;
const LINE: f64 = 17.0;

/// From the left of a legend's sample to its name.
const SAMPLE: f64 = 29.0;
/// What stands in a panel in which there is nothing to draw.
const EMPTY: &str = "nothing to draw";

/// Pixels between the places of a level curve.
const FINEST: f64 = 1.5;

/// Dots that are so few are larger.
const FEW_DOTS: usize = 400;

/// Colours of series, which are told apart by their names.
pub(super) const COLOURS: [&str; 14] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#332288", "#882255", "#44aa99",
    "#999933", "#56b4e9", "#aa4466", "#117733", "#b8860b", "#7f3fbf",
];

/// Colours of series beyond these, from the first to the last of a long list (after viridis).
const SHADES: [&str; 16] = [
    "#440154", "#481a6c", "#472f7d", "#414487", "#39568c", "#31688e", "#2a788e", "#23888e",
    "#1f988b", "#22a884", "#35b779", "#54c568", "#7ad151", "#a5db36", "#c7e020", "#e3cf1c",
];
/// So many of a long list are named.
const NAMED: usize = 8;

/// The colour of one of many, by its number: each has its own where these suffice, else it is a shade.
pub(super) fn paint(number: usize) -> &'static str {
    match COLOURS.get(number) {
        Some(paint) => paint,
        None => SHADES[(number - COLOURS.len()) % SHADES.len()],
    }
}

/// The number of the colour of one of so many, and whether it is named.
pub(super) fn shade_and_naming(place: usize, many: usize) -> (usize, bool) {
    if many <= COLOURS.len() {
        return (place, true);
    }
    let shade = place * (SHADES.len() - 1) / (many - 1);
    let nearest = |k: usize| (2 * k * (many - 1) + NAMED - 1) / (2 * (NAMED - 1));
    let named = (0..NAMED).any(|k| nearest(k) == place);
    (COLOURS.len() + shade, named)
}

/// How values are laid out along an axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it shows.
    pub label: String,
    /// Whether by logarithms.
    pub logarithmic: bool,
}

impl Axis {
    /// By values.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            logarithmic: false,
        }
    }

    /// By logarithms; what is not positive is left out.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            logarithmic: true,
        }
    }

    fn value(&self, value: f64) -> Option<f64> {
        let value = if self.logarithmic {
            value.log10()
        } else {
            value
        };
        value.is_finite().then_some(value)
    }
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A line with a mark at every point.
    Line,
    /// The same, dashed.
    Dashed,
    /// A line without marks; a point that is not finite leaves a gap.
    Curve,
    /// The same in dashes, over a curve with the same points, which shows between them.
    Over,
    /// A curve that is thin and grey, behind the others.
    Level,
    /// Dots alone.
    Dots,
    /// Pale dots behind the others.
    Behind,
}

impl Stroke {
    /// The attribute of its dashes.
    fn dashes(self) -> &'static str {
        match self {
            Self::Dashed => " stroke-dasharray=\"5 3\"",
            Self::Over => " stroke-dasharray=\"6 7\"",
            _ => "",
        }
    }
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name; series of one name and colour appear once in the legend.
    pub name: String,
    /// The number of its colour.
    pub colour: usize,
    /// How it is drawn.
    pub stroke: Stroke,
    /// The points.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// A line.
    pub fn line(name: impl Into<String>, colour: usize, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.into(),
            colour,
            stroke: Stroke::Line,
            points,
        }
    }

    fn paint(&self) -> &'static str {
        match self.stroke {
            Stroke::Behind | Stroke::Level => "#c4c4c4",
            _ => paint(self.colour),
        }
    }
}

/// A frame with series.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Its title.
    pub title: String,
    /// The axis below.
    pub x: Axis,
    /// The axis at the left.
    pub y: Axis,
    /// What it shows.
    pub series: Vec<Series>,
}

/// The picture.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Its title.
    pub title: String,
    /// A second line.
    pub subtitle: String,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row.
    pub across: usize,
}

/// Where a panel lies and what it goes through.
struct Frame<'a> {
    panel: &'a Panel,
    corner: Place,
    size: Place,
    x: Ticks,
    y: Ticks,
}

impl Chart {
    /// The picture as SVG; names are explained below all panels.
    pub fn to_svg(&self) -> String {
        self.with_panels_of(PANEL)
    }

    /// The same with panels of another width and height.
    pub fn with_panels_of(&self, size: Place) -> String {
        let across = self.across.max(1);
        let stride = (STRIDE.0 - PANEL.0 + size.0, STRIDE.1 - PANEL.1 + size.1);
        let mut svg = Svg::default();
        for (place, panel) in self.panels.iter().enumerate() {
            let (row, column) = (place / across, place % across);
            let corner = (
                LEFT + stride.0 * column as f64,
                HEAD + stride.1 * row as f64,
            );
            Frame::new(panel, corner, size).draw(&mut svg);
        }
        let columns = self.panels.len().min(across);
        let width = (stride.0 * columns as f64).max(780.0) + 24.0;
        let top = HEAD + stride.1 * self.panels.len().div_ceil(across) as f64 - 18.0;
        let rows = self.legend(&mut svg, top, width);
        let height = top + LINE * rows as f64 + 10.0;
        svg.page((width, height), &self.title, &self.subtitle)
    }

    fn legend(&self, svg: &mut Svg, top: f64, width: f64) -> usize {
        let mut names: Vec<&Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            let known =
                |other: &&Series| other.name == series.name && other.paint() == series.paint();
            if !series.name.is_empty() && !names.iter().any(known) {
                names.push(series);
            }
        }
        let widths = names
            .iter()
            .map(|series| text_width(&series.name, 12.0, false) + SAMPLE + 20.0);
        let stride = widths.fold(190.0, f64::max);
        let columns = ((width - 24.0) / stride).floor().max(1.0) as usize;
        for (place, series) in names.iter().enumerate() {
            let x = 24.0 + stride * (place % columns) as f64;
            let y = top + LINE * (place / columns) as f64;
            match series.stroke {
                Stroke::Dots | Stroke::Behind => mark(svg, series, &[(x + 11.0, y - 4.0)]),
                _ => mark(svg, series, &[(x, y - 4.0), (x + 22.0, y - 4.0)]),
            }
            svg.text(
                (x + SAMPLE, y),
                12.0,
                &format!("fill=\"{INK}\""),
                &series.name,
            );
        }
        names.len().div_ceil(columns)
    }
}

/// A line or dots at places.
fn mark(svg: &mut Svg, series: &Series, places: &[Place]) {
    let paint = series.paint();
    let dashes = series.stroke.dashes();
    match series.stroke {
        Stroke::Line | Stroke::Dashed => {}
        Stroke::Curve | Stroke::Over | Stroke::Level => {
            let stroke = format!("stroke=\"{paint}\" stroke-width=\"2\"{dashes}");
            return svg.polyline(places.iter().copied(), &stroke);
        }
        Stroke::Dots | Stroke::Behind => {
            let radius = if places.len() < FEW_DOTS { 2.0 } else { 0.9 };
            return svg.discs(places, radius, paint);
        }
    }
    let stroke = format!("stroke=\"{paint}\" stroke-width=\"1.5\"{dashes}");
    svg.polyline(places.iter().copied(), &stroke);
    for &place in places {
        svg.disc(place, 2.2, &format!("fill=\"{paint}\""));
    }
}

impl<'a> Frame<'a> {
    fn new(panel: &'a Panel, corner: Place, size: Place) -> Self {
        let axis = |axis: &Axis, of: fn(&(f64, f64)) -> f64| {
            let points = panel.series.iter().flat_map(|series| &series.points);
            let values = points.filter_map(|point| axis.value(of(point)));
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            });
            let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
            if axis.logarithmic {
                Ticks::decades(low.floor(), high.ceil().max(low.floor() + 1.0), 8)
            } else {
                Ticks::linear(low, high, 5.0, 0.05)
            }
        };
        Self {
            panel,
            corner,
            size,
            x: axis(&panel.x, |p| p.0),
            y: axis(&panel.y, |p| p.1),
        }
    }

    fn place(&self, (x, y): (f64, f64)) -> Option<Place> {
        let (x, y) = (self.panel.x.value(x)?, self.panel.y.value(y)?);
        Some((
            self.corner.0 + self.size.0 * self.x.part(x),
            self.corner.1 + self.size.1 * (1.0 - self.y.part(y)),
        ))
    }

    fn draw(&self, svg: &mut Svg) {
        let (left, top) = self.corner;
        let title = format!("font-weight=\"bold\" fill=\"{INK}\"");
        svg.text((left, top - 9.0), 13.0, &title, &self.panel.title);
        self.axes(svg);
        let mut points = self.panel.series.iter().flat_map(|series| &series.points);
        if !points.any(|point| self.place(*point).is_some()) {
            let faint = format!("text-anchor=\"middle\" fill=\"{FAINT}\"");
            let middle = (left + 0.5 * self.size.0, top + 0.5 * self.size.1);
            svg.text(middle, 13.0, &faint, EMPTY);
        }
        let behind = |series: &&Series| matches!(series.stroke, Stroke::Behind | Stroke::Level);
        let (back, front): (Vec<&Series>, Vec<&Series>) =
            self.panel.series.iter().partition(behind);
        for series in back.into_iter().chain(front) {
            let places = series.points.iter().map(|point| self.place(*point));
            let places: Vec<Option<Place>> = places.collect();
            if let Stroke::Curve | Stroke::Over | Stroke::Level = series.stroke {
                let width = match series.stroke {
                    Stroke::Level => 0.8,
                    _ => 1.3,
                };
                let (paint, dashes) = (series.paint(), series.stroke.dashes());
                let stroke = format!("stroke=\"{paint}\" stroke-width=\"{width}\"{dashes}");
                for piece in places.split(Option::is_none) {
                    match piece {
                        [Some(place)] => {
                            svg.disc(*place, 2.5, &format!("fill=\"{}\"", series.paint()));
                        }
                        [] => {}
                        _ if series.stroke == Stroke::Level => {
                            let places: Vec<Place> = piece.iter().flatten().copied().collect();
                            svg.polyline(thinned(&places, FINEST), &stroke);
                        }
                        _ => svg.polyline(piece.iter().flatten().copied(), &stroke),
                    }
                }
                continue;
            }
            let places: Vec<Place> = places.into_iter().flatten().collect();
            mark(svg, series, &places);
        }
    }

    fn axes(&self, svg: &mut Svg) {
        let (left, top) = self.corner;
        let (right, bottom) = (left + self.size.0, top + self.size.1);
        let (grid, axis) = ("stroke=\"#eeeeee\"", "stroke=\"#777\"");
        let anchored = |anchor: &str| format!("text-anchor=\"{anchor}\" fill=\"{INK}\"");
        for &tick in &self.x.ticks {
            let x = left + self.size.0 * self.x.part(tick);
            svg.line((x, top), (x, bottom), grid);
            let at = (x, bottom + 16.0);
            match self.panel.x.logarithmic {
                true => svg.power_of_ten(at, 11.0, &anchored("middle"), tick.round() as i32),
                false => svg.text(at, 11.0, &anchored("middle"), &self.x.label(tick)),
            }
        }
        for &tick in &self.y.ticks {
            let y = bottom - self.size.1 * self.y.part(tick);
            svg.line((left, y), (right, y), grid);
            let at = (left - 6.0, y + 4.0);
            match self.panel.y.logarithmic {
                true => svg.power_of_ten(at, 11.0, &anchored("end"), tick.round() as i32),
                false => svg.text(at, 11.0, &anchored("end"), &self.y.label(tick)),
            }
        }
        svg.line((left, bottom), (right, bottom), axis);
        svg.line((left, top), (left, bottom), axis);
        if let Some(factor) = self.x.factor().filter(|_| !self.panel.x.logarithmic) {
            svg.text((right, bottom + 30.0), 11.0, &anchored("end"), &factor);
        }
        if let Some(factor) = self.y.factor().filter(|_| !self.panel.y.logarithmic) {
            svg.text((left - 6.0, top - 9.0), 11.0, &anchored("end"), &factor);
        }
        let faint = format!("text-anchor=\"middle\" fill=\"{FAINT}\"");
        let middle = (left + 0.5 * self.size.0, bottom + 34.0);
        svg.text(middle, 12.0, &faint, &self.panel.x.label);
        let side = (left - 62.0, top + 0.5 * self.size.1);
        svg.turned_text(side, -90.0, 12.0, &faint, &self.panel.y.label);
    }
}
