//! The elements of an SVG picture, coordinates in pixels to a tenth.

use std::fmt::Write as _;

/// What every picture is written in.
pub const INK: &str = "#222";
/// What is beside the point.
pub const FAINT: &str = "#666";

/// From a line of the head to the next.
const LINE: f64 = 18.0;

/// A place in pixels, from the upper left corner.
pub type Place = (f64, f64);

/// A picture or a part of it. Attributes are given as they stand in the file.
#[derive(Debug, Default)]
pub struct Svg(String);

impl Svg {
    /// The file of a picture with these parts, under a title and a second line; where that is too long for the width it goes on
    /// below, and the parts move down.
    pub fn page(&self, (width, height): Place, title: &str, subtitle: &str) -> String {
        let mut head = Self::default();
        let white = "width=\"100%\" height=\"100%\" fill=\"white\"";
        let _ = writeln!(head.0, "<title>{}</title>\n<rect {white}/>", escaped(title));
        head.text((20.0, 32.0), 22.0, &format!("fill=\"{INK}\""), title);
        let lines = wrapped(subtitle, width - 40.0, 14.0);
        for (number, line) in lines.iter().enumerate() {
            let at = (20.0, 55.0 + LINE * number as f64);
            head.text(at, 14.0, &format!("fill=\"{FAINT}\""), line);
        }
        let down = LINE * lines.len().saturating_sub(1) as f64;
        let height = height + down;
        let body = match down > 0.0 {
            true => format!("<g transform=\"translate(0 {down})\">\n{}</g>\n", self.0),
            false => self.0.clone(),
        };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" stroke-linejoin=\"round\">\n{}{}</svg>\n",
            head.0, body
        )
    }

    /// Text whose line begins at a place, or as `text-anchor` says.
    pub fn text(&mut self, (x, y): Place, size: f64, attributes: &str, text: &str) {
        let text = escaped(text);
        let _ = writeln!(
            self.0,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" {attributes}>{text}</text>"
        );
    }

    /// Text that is turned by so many degrees about the place where it begins.
    pub fn turned_text(
        &mut self,
        at: Place,
        degrees: f64,
        size: f64,
        attributes: &str,
        text: &str,
    ) {
        let (x, y) = at;
        let turned = format!("transform=\"rotate({degrees} {x:.1} {y:.1})\" {attributes}");
        self.text(at, size, &turned, text);
    }

    /// A power of ten, the exponent raised.
    pub fn power_of_ten(&mut self, (x, y): Place, size: f64, attributes: &str, exponent: i32) {
        let power = match exponent {
            0 => "1".to_owned(),
            exponent => {
                let exponent = exponent.to_string().replace('-', "−");
                let small = 0.75 * size;
                format!("10<tspan dy=\"-5\" font-size=\"{small}\">{exponent}</tspan>")
            }
        };
        let _ = writeln!(
            self.0,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" {attributes}>{power}</text>"
        );
    }

    /// A straight line.
    pub fn line(&mut self, (x1, y1): Place, (x2, y2): Place, attributes: &str) {
        let _ = writeln!(
            self.0,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" {attributes}/>"
        );
    }

    /// A line through places.
    pub fn polyline(&mut self, places: impl IntoIterator<Item = Place>, attributes: &str) {
        self.through("polyline", places, &format!("fill=\"none\" {attributes}"));
    }

    /// A closed polygon.
    pub fn polygon(&mut self, places: impl IntoIterator<Item = Place>, attributes: &str) {
        self.through("polygon", places, attributes);
    }

    fn through(&mut self, shape: &str, places: impl IntoIterator<Item = Place>, attributes: &str) {
        let _ = write!(self.0, "<{shape} {attributes} points=\"");
        for (index, (x, y)) in places.into_iter().enumerate() {
            let space = if index == 0 { "" } else { " " };
            let _ = write!(self.0, "{space}{x:.1},{y:.1}");
        }
        self.0.push_str("\"/>\n");
    }

    /// A disc.
    pub fn disc(&mut self, (x, y): Place, radius: f64, attributes: &str) {
        let _ = writeln!(
            self.0,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {attributes}/>"
        );
    }

    /// Many discs of one colour.
    pub fn discs(&mut self, places: &[Place], radius: f64, paint: &str) {
        let dots: String = places
            .iter()
            .map(|(x, y)| format!("M{x:.1} {y:.1}h0"))
            .collect();
        let width = 2.0 * radius;
        let _ = writeln!(
            self.0,
            "<path d=\"{dots}\" fill=\"none\" stroke=\"{paint}\" stroke-width=\"{width}\" stroke-linecap=\"round\"/>"
        );
    }

    /// A rectangle, with words for readers that point at it.
    pub fn rectangle(
        &mut self,
        (x, y): Place,
        (width, height): Place,
        attributes: &str,
        words: &str,
    ) {
        let words = match words {
            "" => String::new(),
            words => format!("<title>{}</title>", escaped(words)),
        };
        let _ = writeln!(
            self.0,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" {attributes}>{words}</rect>"
        );
    }

    /// Elements that belong together, with words for readers that point at them.
    pub fn group(&mut self, attributes: &str, words: &str, draw: impl FnOnce(&mut Self)) {
        let _ = write!(self.0, "<g {attributes}><title>{}</title>", escaped(words));
        draw(self);
        self.0.push_str("</g>\n");
    }
}

/// A line without the places that lie nearer than a distance to the one before; its ends stay.
pub fn thinned(places: &[Place], distance: f64) -> Vec<Place> {
    let mut kept: Vec<Place> = Vec::new();
    for (index, &(x, y)) in places.iter().enumerate() {
        let near = kept
            .last()
            .is_some_and(|&(a, b)| (x - a).hypot(y - b) < distance);
        if !near || index + 1 == places.len() {
            kept.push((x, y));
        }
    }
    kept
}

/// How wide a text is at most, about, in a common sans-serif font; bold ones are wider.
pub fn text_width(text: &str, size: f64, bold: bool) -> f64 {
    let letter = if bold { 0.70 } else { 0.62 };
    letter * size * text.chars().count() as f64
}

/// A text in lines that are as wide as that at most, divided between words.
fn wrapped(text: &str, width: f64, size: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let Some(line) = lines.last_mut() else { break };
        let longer = format!("{line} {word}");
        if line.is_empty() {
            word.clone_into(line);
        } else if text_width(&longer, size, false) <= width {
            *line = longer;
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
