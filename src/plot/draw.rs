//! Puts the picture together: two panels above one another, legends beside them.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::ticks::{Axis, power_of_ten};
use super::{Curve, Plot, reference};

/// The backend rounds to whole pixels: everything is drawn this much larger and scaled down.
const ZOOM: i32 = 4;
const WIDTH: i32 = 960;
const HEIGHT: i32 = 740;
const HEAD: i32 = 72;
/// Height of the panels of the trajectory and of the group element.
const UPPER: i32 = 350;

/// Colours that stay apart for colour-blind readers on white (after Okabe and Ito, and Tol).
const COLOURS: [RGBColor; 12] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x33, 0x22, 0x88),
    RGBColor(0x88, 0x22, 0x55),
    RGBColor(0x99, 0x99, 0x33),
    RGBColor(0x33, 0x33, 0x33),
    RGBColor(0x44, 0xaa, 0x99),
    RGBColor(0x99, 0x99, 0x99),
];
const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const FAINT: RGBColor = RGBColor(0x77, 0x77, 0x77);
const GRID: RGBColor = RGBColor(0xe4, 0xe4, 0xe4);

/// Half a unit in the last place of 1: where an error is nothing but round-off.
const ROUND_OFF: f64 = f64::EPSILON / 2.0;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Points of a curve in pieces, ready to draw.
struct Line {
    label: String,
    pieces: Vec<Vec<(f64, f64)>>,
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
    colour: fn(usize) -> RGBAColor,
    markers: bool,
}

pub fn svg(plot: &Plot) -> Result<String, Box<dyn std::error::Error>> {
    let mut text = String::new();
    let mut panels = vec![trajectory(plot)];
    if !plot.element.is_empty() {
        panels.push(element(plot));
    }
    panels.push(errors(plot));
    let height = HEIGHT + UPPER * (panels.len() as i32 - 2);
    {
        let size = ((WIDTH * ZOOM) as u32, (height * ZOOM) as u32);
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE)?;
        write(&root, &plot.title, (20, 14), 22, INK)?;
        write(&root, &plot.subtitle, (20, 41), 15, FAINT)?;
        let widest = panels
            .iter()
            .flat_map(|panel| &panel.lines)
            .map(|l| l.label.chars().count());
        let legend = (widest.max().unwrap_or(0) as i32 * 8 + 50).clamp(90, 260);
        let (_, mut rest) = root.split_vertically(HEAD * ZOOM);
        for (place, panel) in panels.iter().enumerate() {
            let (area, below) = if place + 1 < panels.len() {
                rest.split_vertically(UPPER * ZOOM)
            } else {
                (rest.clone(), rest)
            };
            rest = below;
            let (chart, beside) = area.split_horizontally((WIDTH - legend) * ZOOM);
            draw(&chart, panel)?;
            draw_legend(&beside, panel)?;
        }
        root.present()?;
    }
    Ok(scaled_down(&text, &plot.title, height))
}

/// The size on paper, round joints, and a name for readers that do not see.
fn scaled_down(svg: &str, title: &str, height: i32) -> String {
    let body = svg.split_once('>').map_or("", |(_, body)| body);
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let (wide, high) = (WIDTH * ZOOM, height * ZOOM);
    format!(
        "<svg width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {wide} {high}\" \
         stroke-linejoin=\"round\" xmlns=\"http://www.w3.org/2000/svg\">\n<title>{title}</title>{body}"
    )
}

fn time_axis(plot: &Plot) -> Axis {
    Axis::linear(plot.range.0, plot.range.1, 8.0, 0.0)
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
    };
    Panel {
        title: title.to_owned(),
        x: time_axis(plot),
        y: Axis::linear(low, high, 6.0, 0.05),
        x_title: "t",
        y_title,
        logarithmic: false,
        lines: curves.iter().map(line).collect(),
        colour,
        markers: plot.rows <= 60,
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
        // The energy in ink, so that no invariant looks like the first component.
        colour: |index| colour(if index == 0 { 9 } else { index }),
        markers: plot.rows <= 60,
    }
}

fn draw(area: &Area<'_>, panel: &Panel) -> Drawn {
    let Panel { x, y, .. } = panel;
    write(area, &panel.title, (78, 0), 16, INK)?;
    let mut chart = ChartBuilder::on(area)
        .margin_top(26 * ZOOM)
        .margin_right(14 * ZOOM)
        .margin_left(14 * ZOOM)
        .x_label_area_size(40 * ZOOM)
        .y_label_area_size(64 * ZOOM)
        .build_cartesian_2d(x.clone(), y.clone())?;
    let small = ("sans-serif", 15 * ZOOM, &INK).into_text_style(area);
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(ZOOM as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(FAINT.stroke_width(ZOOM as u32))
        .set_all_tick_mark_size(5 * ZOOM)
        .x_labels(x.ticks.len() + 1)
        .y_labels(y.ticks.len() + 1)
        .x_label_style(small.clone())
        .y_label_style(small.clone())
        .x_label_formatter(&|tick| x.label(*tick))
        .y_label_formatter(&|tick| {
            if panel.logarithmic {
                power_of_ten(*tick)
            } else {
                y.label(*tick)
            }
        })
        .axis_desc_style(small)
        .x_desc(panel.x_title)
        .y_desc(panel.y_title)
        .draw()?;
    for (index, line) in panel.lines.iter().enumerate() {
        let colour = (panel.colour)(index);
        for piece in &line.pieces {
            let stroke = colour.stroke_width(6);
            let dot = |&point: &(f64, f64)| Circle::new(point, 2 * ZOOM + 2, colour.filled());
            if panel.markers || piece.len() == 1 {
                chart.draw_series(piece.iter().map(dot))?;
            }
            chart.draw_series(LineSeries::new(piece.iter().copied(), stroke))?;
        }
    }
    Ok(())
}

fn draw_legend(area: &Area<'_>, panel: &Panel) -> Drawn {
    let room = area.dim_in_pixel().1 as i32 / ZOOM - 70;
    let height = (room / panel.lines.len().max(1) as i32).clamp(9, 20);
    for (index, line) in panel.lines.iter().enumerate() {
        let y = 36 + height * index as i32;
        let ends = vec![(0, y * ZOOM), (22 * ZOOM, y * ZOOM)];
        area.draw(&PathElement::new(
            ends,
            (panel.colour)(index).stroke_width(10),
        ))?;
        let style = ("sans-serif", (height - 3).min(15) * ZOOM, &INK).into_text_style(area);
        let style = style.pos(Pos::new(HPos::Left, VPos::Center));
        area.draw_text(&line.label, &style, (29 * ZOOM, y * ZOOM))?;
    }
    Ok(())
}

fn colour(index: usize) -> RGBAColor {
    // Beyond the palette the colours come again, paler.
    let paler = 0.75f64.powi((index / COLOURS.len()).min(4) as i32);
    COLOURS[index % COLOURS.len()].mix(paler)
}

fn write(area: &Area<'_>, text: &str, at: (i32, i32), size: i32, colour: RGBColor) -> Drawn {
    let style = ("sans-serif", size * ZOOM, &colour).into_text_style(area);
    Ok(area.draw_text(text, &style, (at.0 * ZOOM, at.1 * ZOOM))?)
}
