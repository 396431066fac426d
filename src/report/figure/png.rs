//! Figures as PNG: the SVG file, drawn by resvg with a font of the system.
//!
//! No font is part of the program. Letters are those of DejaVu Sans, Liberation Sans or Arial where one is installed, else of
//! any font; where there is none at all there is no PNG, because a figure without its numbers tells nothing.

use std::io;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Pixels of the PNG a pixel of the SVG: sharp on paper and on the screens of today.
const SCALE: f32 = 2.0;

/// Draws figures. It has the fonts of the system, so make one for all.
#[derive(Debug)]
pub struct Painter {
    options: Options<'static>,
}

impl Painter {
    /// A painter with the fonts that are installed; `None` where none is.
    pub fn new() -> Option<Self> {
        let mut options = Options::default();
        let fonts = options.fontdb_mut();
        fonts.load_system_fonts();
        Self::with(options)
    }

    fn with(mut options: Options<'static>) -> Option<Self> {
        let fonts = options.fontdb_mut();
        let any = fonts.faces().find_map(|face| Some(face.families.first()?.0.clone()))?;
        let sans = fontdb::Query { families: &[fontdb::Family::SansSerif], ..fontdb::Query::default() };
        if fonts.query(&sans).is_none() {
            fonts.set_sans_serif_family(any);
        }
        Some(Self { options })
    }

    /// An SVG file as a PNG file.
    ///
    /// # Errors
    /// Where it is no SVG, or larger than memory.
    pub fn paint(&self, svg: &str) -> io::Result<Vec<u8>> {
        let tree = Tree::from_str(svg, &self.options).map_err(io::Error::other)?;
        let size = tree.size();
        let pixels = |length: f32| (length * SCALE).ceil() as u32;
        let mut picture = Pixmap::new(pixels(size.width()), pixels(size.height()))
            .ok_or_else(|| io::Error::other("the figure is too large for a picture"))?;
        resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut picture.as_mut());
        picture.encode_png().map_err(io::Error::other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_any_font_there_is_no_painter() {
        assert!(Painter::with(Options::default()).is_none());
    }
}
