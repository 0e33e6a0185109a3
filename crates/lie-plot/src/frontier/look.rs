//! What the curves of a panel look like: no two of them alike.

use super::Curve;
use crate::svg::{Place, Svg};

/// Colours of families: neighbours in the list differ in hue and in lightness.
const COLOURS: [&str; 16] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#332288", "#882255", "#44aa99",
    "#999933", "#56b4e9", "#aa4466", "#117733", "#6699cc", "#b8860b", "#7f3fbf", "#4d4d00",
];

/// Orders from here on have one marker.
const HIGH: u32 = 7;

/// What a curve looks like.
pub(super) struct Look {
    colour: &'static str,
    order: u32,
    /// Which one it is of those with the same colour, dashes and markers otherwise.
    variant: usize,
}

/// What each curve of a panel looks like.
pub(super) fn looks(curves: &[&Curve]) -> Vec<Look> {
    let mut families: Vec<&str> = Vec::new();
    for curve in curves {
        if !families.contains(&curve.family.as_str()) {
            families.push(&curve.family);
        }
    }
    let kind = |curve: &Curve| {
        let family = families.iter().position(|family| *family == curve.family);
        (
            family.unwrap_or(0) % COLOURS.len(),
            curve.order.clamp(1, HIGH),
        )
    };
    let look = |(place, curve): (usize, &&Curve)| {
        let (family, order) = kind(curve);
        let before = curves[..place].iter().copied();
        Look {
            colour: COLOURS[family],
            order,
            variant: before
                .filter(|other| kind(other) == (family, order))
                .count(),
        }
    };
    curves.iter().enumerate().map(look).collect()
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

impl Look {
    /// The attributes of a line: each variant has a dot more between its dashes.
    pub fn stroke(&self, width: f64) -> String {
        let (colour, dots) = (self.colour, " 1 3".repeat(self.variant));
        let dashes = match (dashes(self.order), self.variant) {
            ("", 1..) => format!("20 3{dots}"),
            (dashes, _) => format!("{dashes}{dots}"),
        };
        format!("stroke=\"{colour}\" stroke-width=\"{width}\" stroke-dasharray=\"{dashes}\"")
    }

    /// A marker at a place: of the variants, filled, hollow, hollow with a dot, filled with a white dot.
    pub fn marker(&self, svg: &mut Svg, at: Place, size: f64) {
        let (x, y) = at;
        let (hollow, dotted) = match self.variant % 4 {
            0 => (false, false),
            1 => (true, false),
            2 => (true, true),
            _ => (false, true),
        };
        let colour = self.colour;
        let attributes = match hollow {
            true => format!("fill=\"white\" stroke=\"{colour}\""),
            false => format!("fill=\"{colour}\""),
        };
        let mut polygon = |part: f64, corners: u32, turned: f64| {
            let corner = |k: u32| {
                let angle = (turned + 360.0 * f64::from(k) / f64::from(corners)).to_radians();
                let radius = part * size;
                (x + radius * angle.cos(), y + radius * angle.sin())
            };
            svg.polygon((0..corners).map(corner), &attributes);
        };
        match self.order {
            0..=1 => {
                let stroke = format!("stroke=\"{colour}\"");
                // a cross, or an upright one
                let (a, b) = if hollow { (size, 0.0) } else { (size, size) };
                svg.line((x - a, y - b), (x + a, y + b), &stroke);
                svg.line((x - b, y + a), (x + b, y - a), &stroke);
            }
            2 => svg.disc(at, size, &attributes),
            3 => polygon(1.3, 3, -90.0),
            4 => polygon(1.3, 4, 45.0),
            5 => polygon(1.3, 5, -90.0),
            6 => polygon(1.3, 6, 0.0),
            _ => polygon(1.5, 4, 0.0),
        }
        if dotted {
            let fill = if hollow || self.order <= 1 {
                colour
            } else {
                "white"
            };
            svg.disc(at, 0.4 * size, &format!("fill=\"{fill}\""));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(name: &str, order: u32) -> Curve {
        Curve {
            name: name.to_owned(),
            class: "orbit".to_owned(),
            family: name.trim_end_matches(char::is_numeric).to_owned(),
            order,
            control: false,
            points: Vec::new(),
        }
    }

    #[test]
    fn no_two_curves_look_alike() {
        let mut curves: Vec<Curve> = [4, 6, 8, 10, 16]
            .into_iter()
            .map(|order| curve(&format!("gauss{order}"), order))
            .collect();
        for order in [1, 2, 4] {
            curves.extend(
                [
                    "midpoint",
                    "midpoint",
                    "splitting",
                    "splitting",
                    "splitting",
                    "splitting",
                ]
                .map(|n| curve(n, order)),
            );
        }
        let curves: Vec<&Curve> = curves.iter().collect();
        let looks = looks(&curves);
        let lines: std::collections::HashSet<String> =
            looks.iter().map(|look| look.stroke(1.0)).collect();
        // of gauss6 and gauss8 the lines are solid, and the markers differ
        assert_eq!(lines.len(), curves.len() - 1);
        let seen = |look: &Look| {
            let mut svg = Svg::default();
            look.marker(&mut svg, (10.0, 10.0), 3.0);
            svg.line((0.0, 0.0), (1.0, 0.0), &look.stroke(1.0));
            svg.page((10.0, 10.0), "", "")
        };
        let seen: std::collections::HashSet<String> = looks.iter().map(seen).collect();
        assert_eq!(seen.len(), curves.len());
        // markers alone tell four variants apart
        let marker = |look: &Look| {
            let mut svg = Svg::default();
            look.marker(&mut svg, (10.0, 10.0), 3.0);
            svg.page((10.0, 10.0), "", "")
        };
        let markers: std::collections::HashSet<String> = looks.iter().map(marker).collect();
        assert_eq!(markers.len(), curves.len());
        // the control: two with the same place in their families are alike
        let one = super::looks(&curves[..1]);
        assert_eq!(one[0].stroke(1.0), looks[0].stroke(1.0));
    }
}
