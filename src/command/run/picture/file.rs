//! The forms of picture files: SVG as it is drawn, PNG and PDF made of it.

use std::path::Path;
use std::sync::Arc;

use lie_codegen::diagnostic::Kind;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, fontdb};

use crate::message::{Failure, Message};

/// DejaVu Sans, the letters that pictures use: text appears on machines without fonts, and everywhere alike.
const FONT: &[u8] = include_bytes!("dejavu_sans.ttf");
/// Pixels of a PNG along one of the SVG.
const SCALE: f32 = 2.0;

/// A form of a picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Scalable vector graphics.
    Svg,
    /// Pixels.
    Png,
    /// A page.
    Pdf,
}

/// The form that the extension of a file names; SVG where there is none.
///
/// # Errors
/// `option`: pictures have no such form.
pub fn form(flag: &str, path: &Path) -> Result<Form, Failure> {
    let Some(extension) = path.extension() else {
        return Ok(Form::Svg);
    };
    let forms = [("svg", Form::Svg), ("png", Form::Png), ("pdf", Form::Pdf)];
    let found = forms
        .into_iter()
        .find(|(name, _)| extension.eq_ignore_ascii_case(name));
    found.map(|(_, form)| form).ok_or_else(|| {
        let text = format!("`{}` names no form of pictures", path.display());
        let help = format!(
            "write `{}`, or .png or .pdf",
            path.with_extension("svg").display()
        );
        Message::option(flag, text).help(help).into()
    })
}

impl Form {
    /// The bytes of the file of a picture.
    ///
    /// # Errors
    /// A bug of ours, or of the libraries that convert.
    pub fn bytes(self, svg: &str) -> Result<Vec<u8>, Failure> {
        match self {
            Self::Svg => Ok(svg.as_bytes().to_vec()),
            Self::Png => png(svg),
            Self::Pdf => pdf(svg),
        }
        .map_err(|why: String| {
            let message = Message::new(Kind::Io, format!("the picture cannot be converted: {why}"));
            Failure::surroundings(message.help("write it as .svg, and report this"))
        })
    }
}

fn options() -> usvg::Options<'static> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    usvg::Options {
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    }
}

fn png(svg: &str) -> Result<Vec<u8>, String> {
    let tree = usvg::Tree::from_str(svg, &options()).map_err(|error| error.to_string())?;
    let size = tree
        .size()
        .to_int_size()
        .scale_by(SCALE)
        .ok_or("it is too large")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or("it is too large")?;
    resvg::render(
        &tree,
        Transform::from_scale(SCALE, SCALE),
        &mut pixels.as_mut(),
    );
    pixels.encode_png().map_err(|error| error.to_string())
}

fn pdf(svg: &str) -> Result<Vec<u8>, String> {
    let tree = usvg::Tree::from_str(svg, &options()).map_err(|error| error.to_string())?;
    let page = svg2pdf::PageOptions::default();
    svg2pdf::to_pdf(&tree, svg2pdf::ConversionOptions::default(), page)
        .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"30\" viewBox=\"0 0 40 30\" \
        font-family=\"sans-serif\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/><text x=\"5\" y=\"20\" \
        font-size=\"14\" fill=\"#222\">μ₀−</text></svg>";

    #[test]
    fn pixels_have_the_text() {
        let png = Form::Png.bytes(SQUARE).unwrap();
        let pixels = Pixmap::decode_png(&png).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (80, 60));
        let dark = |of: &Pixmap| of.pixels().iter().filter(|p| p.red() < 100).count();
        assert!(dark(&pixels) > 60, "{}", dark(&pixels));
        // the control: without text there is none
        let empty = SQUARE.replace("μ₀−", "");
        let empty = Pixmap::decode_png(&Form::Png.bytes(&empty).unwrap()).unwrap();
        assert_eq!(dark(&empty), 0);
    }

    #[test]
    fn a_page_holds_its_font() {
        let pdf = Form::Pdf.bytes(SQUARE).unwrap();
        assert!(pdf.starts_with(b"%PDF-"));
        let text = String::from_utf8_lossy(&pdf);
        assert!(text.contains("DejaVuSans"));
        assert!(
            !String::from_utf8_lossy(&Form::Pdf.bytes(&SQUARE.replace("μ₀−", "")).unwrap())
                .contains("DejaVuSans")
        );
    }

    #[test]
    fn forms_are_named_by_extensions() {
        let of = |name: &str| form("--plot", Path::new(name)).ok();
        assert_eq!(of("a.PNG"), Some(Form::Png));
        assert_eq!(of("a.pdf"), Some(Form::Pdf));
        assert_eq!(of("a"), Some(Form::Svg));
        assert_eq!(of("a.jpg"), None);
    }
}
