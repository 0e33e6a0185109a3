//! Pictures as PNG and PDF, made of the SVG.

use std::sync::Arc;

use lie_syntax::diagnostic::Kind;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, fontdb};

use crate::message::{Failure, Message};

/// DejaVu Sans, the letters that pictures use: text appears on machines without fonts, and everywhere alike.
const FONT: &[u8] = include_bytes!("dejavu_sans.ttf");
/// Pixels of a PNG along one of the SVG.
const SCALE: f32 = 2.0;

fn options() -> usvg::Options<'static> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    usvg::Options {
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    }
}

/// The drawing.
fn tree(svg: &str) -> Result<usvg::Tree, Failure> {
    usvg::Tree::from_str(svg, &options()).map_err(|error| failed(&error.to_string()))
}

fn failed(why: &str) -> Failure {
    let message = Message::new(Kind::Io, format!("the picture cannot be converted: {why}"));
    Failure::surroundings(message.help("write it as .svg, and report this"))
}

/// The pixels, as the bytes of a PNG file.
///
/// # Errors
/// A bug of ours, or of the libraries that convert.
pub fn png(svg: &str) -> Result<Vec<u8>, Failure> {
    let tree = tree(svg)?;
    let large = || failed("it is too large");
    let size = tree.size().to_int_size().scale_by(SCALE);
    let size = size.ok_or_else(large)?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or_else(large)?;
    let scale = Transform::from_scale(SCALE, SCALE);
    resvg::render(&tree, scale, &mut pixels.as_mut());
    pixels
        .encode_png()
        .map_err(|error| failed(&error.to_string()))
}

/// The page, as the bytes of a PDF file.
///
/// # Errors
/// A bug of ours, or of the libraries that convert.
pub fn pdf(svg: &str) -> Result<Vec<u8>, Failure> {
    let page = svg2pdf::PageOptions::default();
    svg2pdf::to_pdf(&tree(svg)?, svg2pdf::ConversionOptions::default(), page)
        .map_err(|error| failed(&error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"30\" viewBox=\"0 0 40 30\" \
        font-family=\"sans-serif\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/><text x=\"5\" y=\"20\" \
        font-size=\"14\" fill=\"#222\">μ₀−</text></svg>";

    #[test]
    fn pixels_have_the_text() {
        let png = png(SQUARE).unwrap();
        let pixels = Pixmap::decode_png(&png).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (80, 60));
        let dark = |of: &Pixmap| of.pixels().iter().filter(|p| p.red() < 100).count();
        assert!(dark(&pixels) > 60, "{}", dark(&pixels));
        // the control: without text there is none
        let empty = SQUARE.replace("μ₀−", "");
        let empty = Pixmap::decode_png(&png(&empty).unwrap()).unwrap();
        assert_eq!(dark(&empty), 0);
    }

    #[test]
    fn a_page_holds_its_font() {
        let pdf = pdf(SQUARE).unwrap();
        assert!(pdf.starts_with(b"%PDF-"));
        let text = String::from_utf8_lossy(&pdf);
        assert!(text.contains("DejaVuSans"));
        assert!(
            !String::from_utf8_lossy(&pdf(&SQUARE.replace("μ₀−", "")).unwrap())
                .contains("DejaVuSans")
        );
    }
}
