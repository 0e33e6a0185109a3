//! The forms of picture files: SVG as it is drawn; PNG and PDF are made of it where the feature `raster` is on.

use std::path::Path;

use crate::message::{Failure, Message};

/// A form of a picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Scalable vector graphics.
    Svg,
    /// Pixels.
    #[cfg(feature = "raster")]
    Png,
    /// A page.
    #[cfg(feature = "raster")]
    Pdf,
}

/// The forms that this program writes, by their extensions.
const FORMS: &[(&str, Form)] = &[
    ("svg", Form::Svg),
    #[cfg(feature = "raster")]
    ("png", Form::Png),
    #[cfg(feature = "raster")]
    ("pdf", Form::Pdf),
];

/// The form that the extension of a file names; SVG where there is none.
///
/// # Errors
/// `option`: pictures have no such form, or this program was built without it.
pub fn form(flag: &str, path: &Path) -> Result<Form, Failure> {
    let Some(extension) = path.extension() else {
        return Ok(Form::Svg);
    };
    let named = |name: &str| extension.eq_ignore_ascii_case(name);
    if let Some((_, form)) = FORMS.iter().find(|(name, _)| named(name)) {
        return Ok(*form);
    }
    let svg = path.with_extension("svg");
    let (text, help) = if named("png") || named("pdf") {
        let form = extension.to_string_lossy().to_uppercase();
        (
            format!("this `lie` was built without pictures as {form}"),
            format!(
                "write `{}`, or build with them: `cargo run --release --features raster -- run …`, \
                 `cargo install --path . --locked --features raster`",
                svg.display()
            ),
        )
    } else {
        (
            format!("`{}` names no form of pictures", path.display()),
            format!("write `{}`, or .png or .pdf", svg.display()),
        )
    };
    Err(Message::option(flag, text).help(help).into())
}

impl Form {
    /// The bytes of the file of a picture.
    ///
    /// # Errors
    /// A bug of ours, or of the libraries that convert.
    pub fn bytes(self, svg: &str) -> Result<Vec<u8>, Failure> {
        match self {
            Self::Svg => Ok(svg.as_bytes().to_vec()),
            #[cfg(feature = "raster")]
            Self::Png => super::raster::png(svg),
            #[cfg(feature = "raster")]
            Self::Pdf => super::raster::pdf(svg),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_are_named_by_extensions() {
        let of = |name: &str| form("--plot", Path::new(name)).ok();
        assert_eq!(of("a.SVG"), Some(Form::Svg));
        assert_eq!(of("a"), Some(Form::Svg));
        assert_eq!(of("a.jpg"), None);
        for raster in ["a.PNG", "a.pdf"] {
            assert_eq!(of(raster).is_some(), cfg!(feature = "raster"), "{raster}");
        }
    }
}
