//! Figures as PNG: what stands in the SVG is drawn, letters too.

use std::fs;
use std::path::Path;

use resvg::tiny_skia::Pixmap;

use super::{meshgauge, nights};

/// Width and height in the head of an SVG file.
fn size(svg: &Path) -> [f64; 2] {
    #[expect(clippy::disallowed_methods, reason = "a small file that was just written")]
    let text = fs::read_to_string(svg).expect("a figure");
    ["width=\"", "height=\""].map(|key| {
        let (_, rest) = text.split_once(&format!(" {key}")).expect("a size");
        rest.split('"').next().and_then(|number| number.parse().ok()).expect("a number")
    })
}

/// Whether something other than paper is in a rectangle of the picture, in pixels of the SVG.
fn is_drawn(picture: &Pixmap, x: std::ops::Range<u32>, y: std::ops::Range<u32>) -> bool {
    let mut pixels =
        (2 * y.start..2 * y.end).flat_map(|row| (2 * x.start..2 * x.end).map(move |column| (column, row)));
    pixels.any(|(x, y)| picture.pixel(x, y).is_some_and(|pixel| pixel.red() < 128))
}

#[test]
fn every_figure_is_drawn_twice_as_large_with_its_letters() {
    let folder = nights();
    let output = meshgauge(folder.path(), &["report", "monday", "hostile.json", "--figures", "figures"]);
    assert!(output.status.success(), "{output:?}");
    if String::from_utf8_lossy(&output.stderr).contains("a font must be installed") {
        eprintln!("skipped: no font is installed");
        return;
    }
    let mut drawn = 0;
    for entry in fs::read_dir(folder.path().join("figures")).expect("the folder") {
        let svg = entry.expect("an entry").path();
        if svg.extension().is_none_or(|extension| extension != "svg") {
            continue;
        }
        let picture = Pixmap::load_png(svg.with_extension("png")).expect("the same as PNG");
        let [width, height] = size(&svg);
        assert_eq!(
            [picture.width(), picture.height()],
            [width, height].map(|length| (2.0 * length).ceil() as u32)
        );
        assert!(is_drawn(&picture, 10..120, 8..24), "the title of {}", svg.display());
        assert!(is_drawn(&picture, 5..picture.width() / 2, 40..picture.height() / 2), "{}", svg.display());
        drawn += 1;
    }
    assert!(drawn > 10, "{drawn}");
}
