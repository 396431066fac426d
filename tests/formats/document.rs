//! docs/FORMATS.md says of each format what the table of formats says, and no more.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use meshgauge::formats::{FORMATS, Facts, SWEEPS, facts};

use crate::OWN;

const HEAD: &str = "# Formats

What is read, format by format. This page is written from the table of formats in `src/formats/`; a test holds it in step, and
`MESHGAUGE_WRITE_DOCS=1 cargo test --test formats document` writes it anew. `meshgauge formats` prints the same.

A file's content decides, not its name. Files packed by gzip, zstd, bzip2, xz or lz4 are unpacked on the way. Elements of second and
higher order are measured by their corners; what has no measure (lines, points, connectors, polygons, polyhedra, user elements) is
counted by name. A file that ends too early is an error wherever the format has a count or an end mark that tells.
";

const SWEPT: &str = "
## Whole collections

`tests/sweep/sweep.py` scores every file of a folder and lists those that fail, each with its reason. What it told of collections
that anybody can fetch:

| collection | files | scored | not scored, and why |
|---|---|---|---|
";

fn list(out: &mut String, title: &str, rows: &[&str]) {
    if !rows.is_empty() {
        writeln!(out, "- {title}: {}", rows.join("; ")).expect("a string takes all");
    }
}

fn document() -> String {
    let mut out = HEAD.to_owned();
    for format in FORMATS {
        let Facts { quirks, refused, proof, .. } = facts(format.name()).expect("facts of every format");
        let extensions: Vec<_> = format.extensions().iter().map(|e| format!("`.{e}`")).collect();
        let own: Vec<_> =
            OWN.iter().filter(|row| row.0 == format.name()).map(|row| format!("`{}`", row.1)).collect();
        writeln!(out, "\n## {}\n\n{}.\n", format.name(), format.title()).expect("a string takes all");
        list(&mut out, "known by", &[format.looks_for()]);
        list(&mut out, "usual extensions", &extensions.iter().map(String::as_str).collect::<Vec<_>>());
        list(&mut out, "handled", quirks);
        list(&mut out, "refused by name", refused);
        list(&mut out, "proved on files of", proof);
        list(&mut out, "meshes in `tests/meshes/`", &own.iter().map(String::as_str).collect::<Vec<_>>());
    }
    out += SWEPT;
    for (what, files, scored, why) in SWEEPS {
        writeln!(out, "| {what} | {files} | {scored} | {why} |").expect("a string takes all");
    }
    out
}

#[test]
fn the_page_of_formats_is_in_step() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/FORMATS.md");
    let expected = document();
    if std::env::var_os("MESHGAUGE_WRITE_DOCS").is_some() {
        fs::write(&path, &expected).expect("written");
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == expected,
        "docs/FORMATS.md is out of step: MESHGAUGE_WRITE_DOCS=1 cargo test --test formats document"
    );
}
