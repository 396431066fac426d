//! The README lists what there is, every format, every measure; and what its commands print is what stands there.

#![expect(clippy::disallowed_methods, reason = "the project's own small files")]

#[cfg(feature = "program")]
mod story;

use meshgauge::formats::FORMATS;
use meshgauge::measures::measures;

fn readme() -> String {
    std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).expect("the README")
}

#[test]
fn every_format_is_listed_by_its_extension() {
    let readme = readme();
    for format in FORMATS {
        let row = format!("`.{}`", format.extensions()[0]);
        assert!(readme.lines().any(|line| line.starts_with('|') && line.contains(&row)), "no row has {row}");
    }
}

#[test]
fn every_measure_has_a_row() {
    let readme = readme();
    for measure in measures() {
        let row = format!("| {} |", measure.code);
        assert!(readme.lines().any(|line| line.starts_with(&row)), "no row starts with {row}");
    }
}
