//! The tables for a terminal.

use std::collections::BTreeMap;

use meshgauge::compare::{Comparisons, Tolerances, compare};
use meshgauge::report::{COMPARISONS, Style};
use meshgauge::summary::{Expectation, Judgement, WorstElement};

use crate::samples::{mesh, mixed, tetrahedra};
use crate::{plain, render};

#[test]
fn table_of_a_mesh() {
    let expected = "\
pit-1  warn
  file          drop/pit-1.inp.gz (abaqus, gzip, 5.12 MB)
  nodes         15,989
  elements      83,340: B31 12, C3D4 83,328
  not measured  line 12
  volume        816.03
  edge length   0.01234 to 1.25
  element size  0.0211 to 1.021, mean 0.1834, median 0.2
  checks        12 unused nodes
  verdict       M33 of tetrahedron 17260 is 0.097, under 0.1: worth a look (NPL)

Tetrahedra
  mesh   measure  maximum  minimum  element   mean   standard
                                     number         deviation
─────────────────────────────────────────────────────────────
  pit-1  M31        0.999    0.173    17260  0.771      0.108
  pit-1  M32        0.998    0.273    17260  0.852      0.067
  pit-1  M33       0.9997    0.097    17260  0.580      0.119
  pit-1  M34        0.999    0.193    17260  0.809      0.093

Triangles (boundary: not in the totals and the verdict)
  mesh   measure  maximum  minimum  element   mean   standard
                                     number         deviation
─────────────────────────────────────────────────────────────
  pit-1  M11        1.000    0.020    90001  0.900      0.050

";
    let found = plain("table", &[tetrahedra()]);
    assert_eq!(found, expected, "\n{found}");
}

#[test]
fn reasons_in_plain_words() {
    let found = plain("table", &[mixed()]);
    let verdict = "
  verdict       the volume is 0.507 % under what is expected; 0.5 % is allowed
                M11 of a face of wedge 17644 is 0.318, under the limit 0.4
                1 inverted hexahedron: oriented against the rest of the mesh
                1,200 degenerate hexahedra: no volume, or an edge without length
                M22 of a face of wedge 17644 is 0.0999, under 0.1: worth a look (NPL)
                M22 of a face of hexahedron 1733 is 3.2e-5, under 0.1: worth a look (NPL)
";
    assert!(found.contains(verdict), "{found}");
    assert!(
        found.contains("  volume        9767.7, 0.507 % under the expected 9817.48, outside the tolerance\n"),
        "{found}"
    );
}

#[test]
fn an_expectation_of_the_wrong_kind_is_told() {
    let mut summary = tetrahedra();
    let expectation = Some(Expectation { volume: false, value: 78.5, tolerance_percent: 0.5 });
    Judgement { expectation, ..Judgement::default() }.judge(&mut summary);
    let found = plain("table", &[summary]);
    assert!(found.contains("  area          none; expected 78.5\n"), "{found}");
    assert!(found.contains("an area is expected, but the mesh is made of solids\n"), "{found}");
}

#[test]
fn a_rule_of_a_newer_summary_is_told_by_its_numbers() {
    let mut summary = tetrahedra();
    summary.verdict.reasons[0].rule = "jacobian".into();
    let found = plain("table", &[summary]);
    assert!(found.contains("jacobian: M33 tetrahedron 0.0966 of element 17260, limit 0.1\n"), "{found}");
}

#[test]
fn a_mesh_without_measured_elements_has_a_head_and_no_table() {
    let found = plain("table", &[mesh("lines", BTreeMap::new())]);
    assert!(found.contains("none that a measure is defined for"), "{found}");
    assert!(!found.contains("maximum"), "{found}");
    assert_eq!(plain("csv", &[mesh("lines", BTreeMap::new())]).lines().count(), 1);
}

#[test]
fn meshes_of_one_shape_share_a_table() {
    let mut other = tetrahedra();
    other.mesh.name = "pit-2".to_owned();
    let found = plain("table", &[tetrahedra(), mixed(), other]);
    assert_eq!(found.matches("Tetrahedra\n").count(), 1);
    assert_eq!(found.lines().filter(|line| line.starts_with("  pit-2 ")).count(), 5, "{found}");
}

#[test]
fn tables_keep_to_the_width() {
    let mut long = mixed();
    long.mesh.name =
        "specimen-with-a-hemispherical-pit-of-500-microns-in-a-bar-of-32-millimetres-fine".to_owned();
    long.elements.by_type = (1..40).map(|i| (format!("C3D{i}"), 1000)).collect();
    let worst = WorstElement {
        element: 17_260,
        value: 0.097,
        centroid: [-2.1213, 0.099309, -12.666],
        nodes: vec![2294, 3286, 2738, 3745, 12_294, 13_286, 12_738, 13_745],
        region: Some("specimen-near-the-pit".to_owned()),
    };
    for measure in long.shapes.values_mut().flat_map(|shape| shape.measures.values_mut()) {
        measure.worst = vec![worst.clone(); 2];
    }
    for width in [80, 120] {
        let found = render("table", &[long.clone()], Style { color: false, width: Some(width), plot: false });
        // the first line holds the whole name
        for line in found.lines().skip(1) {
            assert!(line.chars().count() <= width.into(), "{width}: {line}");
        }
        assert!(found.contains("  specimen-") && found.contains("-fine  M11"), "{found}");
    }
}

#[test]
fn a_comparison_keeps_to_the_width() {
    let mut worse = mixed();
    for measure in worse.shapes.values_mut().flat_map(|shape| shape.measures.values_mut()) {
        (measure.min, measure.min_element) = (0.001, 123_456_789);
    }
    let pair = compare("pit", &mixed(), &worse, &Tolerances::default());
    let found = Comparisons::new(vec![pair], vec![], vec![]);
    for width in [80, 120] {
        let mut out = Vec::new();
        let style = Style { color: false, width: Some(width), plot: false };
        (COMPARISONS[0].render)(&found, &style, &mut out).expect("written");
        let table = String::from_utf8(out).expect("text");
        assert!(table.contains("123456789") && table.contains("worse"), "{table}");
        for line in table.lines() {
            assert!(line.chars().count() <= width.into(), "{width}: {line}\n{table}");
        }
    }
}

#[test]
fn only_the_style_colours() {
    let colored = render("table", &[tetrahedra()], Style { color: true, width: None, plot: false });
    assert!(colored.contains("\u{1b}[33mwarn\u{1b}[0m"), "{colored}");
    let codes = ["\u{1b}[1m", "\u{1b}[33m", "\u{1b}[0m"];
    let bare = codes.iter().fold(colored, |text, code| text.replace(code, ""));
    assert_eq!(bare, plain("table", &[tetrahedra()]));
}

#[test]
fn histograms_are_drawn_in_the_width_of_the_terminal() {
    for (width, columns) in [(60, 50), (80, 50), (120, 100), (230, 200)] {
        let style = Style { color: false, width: Some(width), plot: true };
        let found = render("table", &[tetrahedra()], style);
        assert!(found.contains("M33 of 82,916 tetrahedra  pit-1\n"), "{found}");
        assert_eq!(
            found.lines().filter(|line| line.trim_start() == format!("0 └{}", "─".repeat(columns))).count(),
            5
        );
        assert!(
            found.lines().filter(|line| line.contains(['│', '└'])).all(|l| l.chars().count() <= width.into())
        );
        assert!(found.contains('█'), "{found}");
    }
    assert!(!plain("table", &[tetrahedra()]).contains('└'));
}

#[test]
#[ignore = "for looking at: cargo test --test report look -- --ignored --nocapture"]
fn look() {
    let mut long = mixed();
    long.mesh.name =
        "specimen-with-a-hemispherical-pit-of-500-microns-in-a-bar-of-32-millimetres-fine".to_owned();
    long.elements.by_type = (1..20).map(|i| (format!("C3D{i}"), 1000)).collect();
    for width in [80, 120] {
        let style = Style { color: true, width: Some(width), plot: true };
        println!("{}\n{}", "-".repeat(width.into()), render("table", &[tetrahedra(), long.clone()], style));
    }
}
