//! Puts the picture together: panels above one another, legends beside them.

use super::chart::{paint, shade_and_naming};
use super::svg::{FAINT, INK, Svg, text_width};
use super::ticks::{Axis, power_of_ten};
use super::{Curve, Plot, few, reference};

const WIDTH: f64 = 960.0;
const HEAD: f64 = 72.0;
/// Height of a panel; the last one is lower.
const PANEL: f64 = 350.0;
const LAST: f64 = 318.0;
/// Around the frame of a panel: titles, ticks and their labels.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 14.0;
const ABOVE: f64 = 26.0;
const BELOW: f64 = 40.0;
const SMALL: f64 = 15.0;
/// So many components share a panel; up to so many have one each.
const FEW: usize = 6;
const MANY: usize = 36;
/// So many lines of a panel have colours and names of their own.
const NAMED: usize = 24;
/// From the left of a legend's sample to its name.
const SAMPLE: f64 = 29.0;
/// How wide a legend may be; longer names are cut off.
const WIDEST: f64 = 420.0;

/// Colours that stay apart for colour-blind readers on white (after Okabe and Ito, and Tol).
const COLOURS: [&str; 12] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#332288", "#882255",
    "#999933", "#333333", "#44aa99", "#999999",
];
/// That of the energy: so no invariant looks like the first component.
const ENERGY: usize = 9;
const GRID: &str = "stroke=\"#e4e4e4\"";

/// Half a unit in the last place of 1: where an error is nothing but round-off.
const ROUND_OFF: f64 = f64::EPSILON / 2.0;

/// Points of a curve in pieces, ready to draw.
struct Line {
    label: String,
    pieces: Vec<Vec<(f64, f64)>>,
    /// Points by themselves, on the pieces.
    dots: Vec<(f64, f64)>,
}

struct Panel {
    title: String,
    x: Axis,
    y: Axis,
    x_title: &'static str,
    y_title: &'static str,
    logarithmic: bool,
    lines: Vec<Line>,
    /// The colour of each line.
    colour: fn(usize) -> Colour,
    markers: bool,
}

/// A colour of the palette; beyond it the colours come again, paler.
struct Colour {
    name: &'static str,
    opacity: f64,
}

/// Where the frame of a panel is.
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

pub fn svg(plot: &Plot) -> String {
    let multiples = (FEW + 1..=MANY).contains(&plot.states.len());
    let mut panels = match multiples {
        true => Vec::new(),
        false => vec![trajectory(plot)],
    };
    if !plot.recorded.is_empty() {
        panels.push(components(plot, &plot.recorded, "Observables", "values"));
    }
    if !plot.element.is_empty() {
        panels.push(element(plot));
    }
    panels.push(errors(plot));
    let wide = |text: &str| text_width(text, SMALL, false);
    let labels = panels.iter().flat_map(|panel| &panel.lines);
    let widest = labels.map(|line| wide(&line.label)).fold(0.0, f64::max);
    let legend = (widest + SAMPLE + 8.0).clamp(90.0, WIDEST);
    let ticks = panels.iter().flat_map(Panel::labels);
    let ticks = ticks.map(|label| wide(&label)).fold(0.0, f64::max);
    let left = LEFT.max(ticks + 40.0);
    let mut svg = Svg::default();
    let mut top = HEAD;
    if multiples {
        top = small_multiples(&mut svg, plot, top);
    }
    for (place, panel) in panels.iter().enumerate() {
        let last = place + 1 == panels.len();
        let height = if last { LAST } else { PANEL };
        let frame = Frame {
            left,
            right: WIDTH - legend - RIGHT,
            top: top + ABOVE,
            bottom: top + height - BELOW,
        };
        draw(&mut svg, panel, &frame);
        draw_legend(&mut svg, panel, (WIDTH - legend, top), height);
        top += height;
    }
    svg.page((WIDTH, top), &plot.title, &plot.subtitle)
}

/// A frame for each component, three in a row; answers where the next panel begins.
fn small_multiples(svg: &mut Svg, plot: &Plot, top: f64) -> f64 {
    let stride = ((WIDTH - RIGHT) / 3.0, 170.0);
    for (place, curve) in plot.states.iter().enumerate() {
        let (row, column) = (place / 3, place % 3);
        let left = stride.0 * column as f64;
        let above = top + stride.1 * row as f64;
        let mut panel = components(plot, std::slice::from_ref(curve), &curve.name, "");
        let (from, to) = plot.shown();
        panel.x = Axis::linear(from, to, 4.0, 0.0);
        let (low, high) = (panel.y.low, panel.y.high);
        panel.y = Axis::linear(low, high, 3.0, 0.0);
        let frame = Frame {
            left: left + LEFT,
            right: left + stride.0 - 8.0,
            top: above + ABOVE,
            bottom: above + stride.1 - BELOW,
        };
        draw(svg, &panel, &frame);
    }
    top + stride.1 * plot.states.len().div_ceil(3) as f64
}

fn time_axis(plot: &Plot) -> Axis {
    let (from, to) = plot.shown();
    Axis::linear(from, to, 8.0, 0.0)
}

fn trajectory(plot: &Plot) -> Panel {
    components(plot, &plot.states, "Trajectory", "components of μ")
}

fn element(plot: &Plot) -> Panel {
    components(plot, &plot.element, "Group element", "entries of g")
}

fn components(plot: &Plot, curves: &[Curve], title: &str, y_title: &'static str) -> Panel {
    let bounds = curves.iter().filter_map(|curve| curve.bins.bounds());
    let (low, high) = bounds
        .reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
        .unwrap_or((0.0, 0.0));
    let line = |curve: &Curve| Line {
        label: curve.name.clone(),
        pieces: curve.bins.pieces(),
        dots: few(&curve.dots, plot.between).to_vec(),
    };
    let title = match curves.len() {
        0..=NAMED => title.to_owned(),
        many => format!("{title}: {many} curves, shaded in their order"),
    };
    Panel {
        title,
        x: time_axis(plot),
        y: Axis::linear(low, high, 6.0, 0.05),
        x_title: "t",
        y_title,
        logarithmic: false,
        lines: curves.iter().map(line).collect(),
        colour,
        markers: plot.rows <= 60 && plot.between == 0,
    }
}

/// |I − I₀| / |I₀| of each invariant, or |I − I₀| where I₀ is nothing but round-off: relative to
/// it would say nothing.
fn errors(plot: &Plot) -> Panel {
    let divisor = |curve: &Curve| reference(curve.first, plot.scale);
    let absolute = |curve: &Curve| divisor(curve).is_none();
    let all = plot.invariants.iter().all(absolute);
    // Exact zeros are drawn where round-off would be.
    let floor = ROUND_OFF.log10();
    let line = |curve: &Curve| {
        let scale = divisor(curve).unwrap_or(1.0);
        let place = |&(t, error): &(f64, f64)| (t, (error / scale).log10().max(floor));
        let pieces = curve.bins.upper_envelope();
        let mark = if absolute(curve) && !all {
            " (absolute)"
        } else {
            ""
        };
        Line {
            label: format!("{}{mark}", curve.name),
            pieces: pieces
                .iter()
                .map(|piece| piece.iter().map(place).collect())
                .collect(),
            dots: Vec::new(),
        }
    };
    let lines: Vec<Line> = plot.invariants.iter().map(line).collect();
    let points = lines.iter().flat_map(|line| line.pieces.iter().flatten());
    let is_zero = |curve: &Curve| {
        let bounds = curve.bins.bounds();
        bounds.is_some_and(|bounds| bounds.1 == 0.0)
    };
    let note = if plot.invariants.iter().any(is_zero) {
        ", exact zeros drawn at round-off"
    } else {
        ""
    };
    let top = points
        .map(|point| point.1)
        .fold(floor, f64::max)
        .clamp(floor, 300.0);
    Panel {
        title: format!("Errors of the invariants{note}"),
        x: time_axis(plot),
        y: Axis::decades(floor - 0.4, (top + 0.4).max(floor + 3.0), 7),
        x_title: "t",
        y_title: if all {
            "|I − I₀|"
        } else {
            "|I − I₀| / |I₀|"
        },
        logarithmic: true,
        lines,
        colour: |index| colour(if index == 0 { ENERGY } else { index }),
        markers: plot.rows <= 60,
    }
}

impl Panel {
    /// The colour of a line, and whether the legend names it.
    fn colour(&self, index: usize) -> (Colour, bool) {
        if self.lines.len() <= NAMED {
            return ((self.colour)(index), true);
        }
        let (shade, named) = shade_and_naming(index, self.lines.len());
        let name = paint(shade);
        (Colour { name, opacity: 0.8 }, named)
    }

    /// The labels of the axis at the left.
    fn labels(&self) -> impl Iterator<Item = String> {
        let label = |&tick: &f64| match self.logarithmic {
            true => power_of_ten(tick),
            false => self.y.label(tick),
        };
        self.y.ticks.iter().map(label)
    }
}

impl Frame {
    /// Where a point of the panel is drawn.
    fn place(&self, panel: &Panel, (x, y): (f64, f64)) -> (f64, f64) {
        (
            self.left + panel.x.part(x) * (self.right - self.left),
            self.bottom - panel.y.part(y) * (self.bottom - self.top),
        )
    }
}

fn draw(svg: &mut Svg, panel: &Panel, frame: &Frame) {
    let ink = format!("fill=\"{INK}\"");
    svg.text((frame.left, frame.top - 11.0), 16.0, &ink, &panel.title);
    axes(svg, panel, frame);
    for (index, line) in panel.lines.iter().enumerate() {
        let (Colour { name, opacity }, _) = panel.colour(index);
        let stroke = format!("stroke=\"{name}\" stroke-width=\"1.5\" opacity=\"{opacity}\"");
        let fill = format!("fill=\"{name}\" opacity=\"{opacity}\"");
        let dots = line.dots.iter().filter(|(_, value)| value.is_finite());
        dots.for_each(|&dot| svg.disc(frame.place(panel, dot), 2.2, &fill));
        for piece in &line.pieces {
            let places = || piece.iter().map(|&point| frame.place(panel, point));
            if panel.markers || piece.len() == 1 {
                places().for_each(|place| svg.disc(place, 2.5, &fill));
            }
            if piece.len() > 1 {
                svg.polyline(places(), &stroke);
            }
        }
    }
}

/// Grid, axes, ticks with their labels, and what the axes are.
fn axes(svg: &mut Svg, panel: &Panel, frame: &Frame) {
    let Frame {
        left,
        right,
        top,
        bottom,
    } = *frame;
    let faint = format!("stroke=\"{FAINT}\"");
    let anchored = |anchor: &str| format!("text-anchor=\"{anchor}\" fill=\"{INK}\"");
    for &tick in &panel.x.ticks {
        let (x, _) = frame.place(panel, (tick, panel.y.low));
        svg.line((x, top), (x, bottom), GRID);
        svg.line((x, bottom), (x, bottom + 5.0), &faint);
        let label = panel.x.label(tick);
        svg.text((x, bottom + 19.0), SMALL, &anchored("middle"), &label);
    }
    for (&tick, label) in panel.y.ticks.iter().zip(panel.labels()) {
        let (_, y) = frame.place(panel, (panel.x.low, tick));
        svg.line((left, y), (right, y), GRID);
        svg.line((left - 5.0, y), (left, y), &faint);
        svg.text((left - 9.0, y + 5.0), SMALL, &anchored("end"), &label);
    }
    svg.line((left, bottom), (right, bottom), &faint);
    svg.line((left, top), (left, bottom), &faint);
    let (x, y) = (0.5 * (left + right), 0.5 * (top + bottom));
    svg.text(
        (x, bottom + 35.0),
        SMALL,
        &anchored("middle"),
        panel.x_title,
    );
    if let Some(factor) = panel.x.factor() {
        svg.text((right, bottom + 35.0), SMALL, &anchored("end"), &factor);
    }
    if let Some(factor) = panel.y.factor().filter(|_| !panel.logarithmic) {
        svg.text((left - 9.0, top - 9.0), SMALL, &anchored("end"), &factor);
    }
    svg.turned_text((20.0, y), -90.0, SMALL, &anchored("middle"), panel.y_title);
}

fn draw_legend(svg: &mut Svg, panel: &Panel, (x, top): (f64, f64), height: f64) {
    let named: Vec<(&Line, Colour)> = panel
        .lines
        .iter()
        .enumerate()
        .filter_map(|(index, line)| {
            let (colour, named) = panel.colour(index);
            named.then_some((line, colour))
        })
        .collect();
    let room = (height - 70.0) / named.len().max(1) as f64;
    let line_height = room.floor().clamp(9.0, 20.0);
    let size = f64::min(line_height - 3.0, SMALL);
    for (index, (line, Colour { name, opacity })) in named.into_iter().enumerate() {
        let y = top + 36.0 + line_height * index as f64;
        let stroke = format!("stroke=\"{name}\" stroke-width=\"2.5\" opacity=\"{opacity}\"");
        svg.line((x, y), (x + 22.0, y), &stroke);
        let place = (x + SAMPLE, y + 0.35 * size);
        let label = shortened(&line.label, WIDEST - SAMPLE, size);
        svg.text(place, size, &format!("fill=\"{INK}\""), &label);
    }
}

/// A text that is as wide as that at most, cut off with dots where need be.
fn shortened(text: &str, width: f64, size: f64) -> String {
    let most = (width / text_width("m", size, false)) as usize;
    match text.char_indices().nth(most) {
        None => text.to_owned(),
        Some(_) => text.chars().take(most - 1).chain(['…']).collect(),
    }
}

fn colour(index: usize) -> Colour {
    Colour {
        name: COLOURS[index % COLOURS.len()],
        opacity: 0.75_f64.powi((index / COLOURS.len()).min(4) as i32),
    }
}
