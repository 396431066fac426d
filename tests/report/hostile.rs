//! Names from mesh files that are made to do harm.

use meshgauge::mesh::Shape;
use meshgauge::report::REPORTS;
use meshgauge::summary::Summary;

use crate::plain;
use crate::samples::tetrahedra;

/// A name that moves the cursor, ends lines and rows, opens tags, and calls people.
const HOSTILE: &str = "x\u{1b}[2J\r\n| y |,\"z\"\u{9b}31m\u{202e}`<b>@all\u{0}";

fn hostile() -> Summary {
    let mut summary = tetrahedra();
    summary.mesh.name = HOSTILE.to_owned();
    summary.mesh.path = HOSTILE.to_owned();
    summary.mesh.format = HOSTILE.to_owned();
    summary.mesh.compression = Some(HOSTILE.to_owned());
    summary.elements.by_type = [(HOSTILE.to_owned(), 1)].into();
    summary.elements.not_measured = [(HOSTILE.to_owned(), 1)].into();
    summary.verdict.reasons[0].rule = HOSTILE.into();
    summary.verdict.reasons[0].measure = Some(HOSTILE.to_owned());
    let tetrahedra = summary.shapes.get_mut(&Shape::Tetrahedron).expect("there are some");
    let mut measure = tetrahedra.measures["M31"].clone();
    measure.on = HOSTILE.into();
    tetrahedra.measures.insert(HOSTILE.to_owned(), measure);
    summary
}

#[test]
fn names_from_a_file_cannot_steer_a_terminal() {
    let harmful = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
    let lines = |name: &str, summary| plain(name, &[summary]).lines().count();
    let tame = || {
        let mut tame = hostile();
        let text = serde_json::to_string(&tame).expect("JSON");
        let name = serde_json::to_string(HOSTILE).expect("JSON");
        tame = serde_json::from_str(&text.replace(&name[1..name.len() - 1], "tame")).expect("its own schema");
        tame
    };
    for report in REPORTS {
        let found = plain(report.name, &[hostile()]);
        assert!(!found.contains(harmful), "{}: {found:?}", report.name);
        assert_eq!(lines(report.name, hostile()), lines(report.name, tame()), "{}: {found}", report.name);
    }
    for name in ["json", "jsonl"] {
        let back: Summary = serde_json::from_str(&plain(name, &[hostile()])).expect("its own schema");
        assert_eq!(back, hostile());
    }
    let markdown = plain("markdown", &[hostile()]);
    assert!(!markdown.contains("@all") && !markdown.contains("<b>") && !markdown.contains('`'), "{markdown}");
    let tame = plain("markdown", &[tame()]);
    assert_eq!(markdown.matches('|').count(), tame.matches('|').count());
}
