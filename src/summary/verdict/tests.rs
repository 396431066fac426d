//! The verdict's rules, as rows.

use serde_json::json;

use super::super::{Checks, SCHEMA};
use super::*;

/// A mesh of one shape, or of tetrahedra with a boundary of triangles, that has a fault where the row puts one.
struct Row {
    what: &'static str,
    min: f64,
    inverted: u64,
    degenerate: u64,
    fail_under: &'static [(&'static str, f64)],
    status: Status,
    rules: &'static [&'static str],
}

const SOUND: Row =
    Row { what: "", min: 0.5, inverted: 0, degenerate: 0, fail_under: &[], status: Status::Pass, rules: &[] };

const ROWS: &[Row] = &[
    Row { what: "sound", ..SOUND },
    Row { what: "at the limit is not under it", min: 0.1, ..SOUND },
    Row { what: "preset", min: 0.0999, status: Status::Warn, rules: &["npl"], ..SOUND },
    Row { what: "inverted", inverted: 2, status: Status::Fail, rules: &["inverted elements"], ..SOUND },
    Row {
        what: "degenerate fails, its minimum of 0 warns after it",
        min: 0.0,
        degenerate: 1,
        status: Status::Fail,
        rules: &["degenerate elements", "npl"],
        ..SOUND
    },
    Row {
        what: "both counts in a fixed order",
        inverted: 1,
        degenerate: 1,
        status: Status::Fail,
        rules: &["inverted elements", "degenerate elements"],
        ..SOUND
    },
    Row {
        what: "the user's limit, over the preset's",
        fail_under: &[("M31", 0.6)],
        status: Status::Fail,
        rules: &["fail under"],
        ..SOUND
    },
    Row { what: "at the user's limit", fail_under: &[("M31", 0.5)], ..SOUND },
    Row {
        what: "the user's limit takes the place of the preset's",
        min: 0.07,
        fail_under: &[("M31", 0.05)],
        ..SOUND
    },
    Row {
        what: "one value, one reason",
        min: 0.07,
        fail_under: &[("M31", 0.2)],
        status: Status::Fail,
        rules: &["fail under"],
        ..SOUND
    },
    Row {
        what: "a limit for another measure leaves the preset in force",
        min: 0.07,
        fail_under: &[("M33", 0.9)],
        status: Status::Warn,
        rules: &["npl"],
        ..SOUND
    },
];

fn shape_summary(row: &Row) -> serde_json::Value {
    json!({
        "count": 10, "order": {"1": 10}, "inverted": row.inverted, "degenerate": row.degenerate,
        "measures": {"M31": {
            "on": "element", "count": 10, "max": 1.0, "min": row.min, "min_element": 7, "mean": 0.8, "sd": 0.1,
            "quantiles": {}, "histogram": [],
        }},
        "correlation": {},
    })
}

fn summary(shapes: &[(&str, &Row)]) -> Summary {
    let shapes: serde_json::Map<_, _> =
        shapes.iter().map(|(name, row)| ((*name).to_owned(), shape_summary(row))).collect();
    serde_json::from_value(json!({
        "schema": SCHEMA,
        "mesh": {"name": "m", "path": "m.inp", "format": "abaqus", "compression": null, "bytes": 1, "xxh3": "0"},
        "nodes": {"count": 0, "unused": 0, "bounds": null},
        "elements": {"count": 10, "by_type": {}, "not_measured": {}},
        "shapes": shapes,
        "totals": {"area": null, "volume": 200.0},
        "sizes": {"edge_length": null, "element_size": null},
        "checks": Checks::default(),
        "expected": null,
        "verdict": {"status": "pass", "reasons": []},
    }))
    .expect("the summary's own schema")
}

fn rules_of(summary: &Summary) -> Vec<&str> {
    summary.verdict.reasons.iter().map(|reason| reason.rule.as_ref()).collect()
}

fn asked(row: &Row) -> Judgement {
    let limit = |(code, value): &(&str, f64)| FailUnder { measure: (*code).to_owned(), value: *value };
    Judgement { fail_under: row.fail_under.iter().map(limit).collect(), expectation: None }
}

#[test]
fn verdicts() {
    for row in ROWS {
        let mut found = summary(&[("tetrahedron", row)]);
        asked(row).judge(&mut found);
        assert_eq!(found.verdict.status, row.status, "{}", row.what);
        assert_eq!(rules_of(&found), row.rules, "{}", row.what);
    }
}

#[test]
fn a_reason_names_the_value_the_limit_and_the_element() {
    let row = Row { min: 0.04, ..SOUND };
    let mut found = summary(&[("tetrahedron", &row)]);
    Judgement::default().judge(&mut found);
    let expected = Reason {
        rule: "npl".into(),
        measure: Some("M31".to_owned()),
        shape: Some(Shape::Tetrahedron),
        value: 0.04,
        limit: 0.1,
        element: Some(7),
    };
    assert_eq!(found.verdict.reasons, [expected]);
}

#[test]
fn boundary_shapes_have_no_say() {
    for row in ROWS {
        let mut found = summary(&[("triangle", row), ("hexahedron", &SOUND)]);
        let fail_under = asked(row).fail_under.into_iter().filter(|f| f.value <= SOUND.min).collect();
        Judgement { fail_under, expectation: None }.judge(&mut found);
        assert_eq!(found.verdict, Verdict { status: Status::Pass, reasons: vec![] }, "{}", row.what);
    }
}

#[test]
fn a_surface_mesh_is_judged_by_its_surface() {
    let mut found = summary(&[("triangle", &Row { inverted: 3, ..SOUND })]);
    Judgement::default().judge(&mut found);
    assert_eq!((found.verdict.status, found.verdict.reasons[0].value), (Status::Fail, 3.0));
}

#[test]
fn failures_stand_before_warnings_across_shapes() {
    let (weak, bad) = (Row { min: 0.05, ..SOUND }, Row { min: 0.0, degenerate: 1, ..SOUND });
    let mut found = summary(&[("tetrahedron", &weak), ("wedge", &bad)]);
    Judgement { fail_under: vec![], expectation: Some(expect(true, 100.0)) }.judge(&mut found);
    assert_eq!(rules_of(&found), ["expected volume", "degenerate elements", "npl", "npl"]);
    assert_eq!(found.verdict.reasons[2].shape, Some(Shape::Tetrahedron));
}

fn expect(volume: bool, value: f64) -> Expectation {
    Expectation { volume, value, tolerance_percent: 0.5 }
}

#[test]
fn expected_volumes_and_areas() {
    // (is a volume, true value, relative error, within); the mesh has a volume of 200 and no area
    let rows = [
        (true, 200.0, 0.0, true),
        (true, 201.0, -1.0 / 201.0, true),
        (true, 199.0, 1.0 / 199.0, false),
        (true, 400.0, -0.5, false),
        (false, 78.5, -1.0, false),
        (true, 0.0, f64::MAX, false),
        (false, 0.0, 0.0, true),
        (true, f64::NAN, f64::MAX, false),
    ];
    for (volume, value, relative_error, within) in rows {
        let mut found = summary(&[("tetrahedron", &SOUND)]);
        Judgement { fail_under: vec![], expectation: Some(expect(volume, value)) }.judge(&mut found);
        let met = found.expected.expect("what was asked is answered");
        assert_eq!((met.relative_error, met.within), (relative_error, within), "{value}");
        assert_eq!((met.volume.is_some(), met.area.is_some()), (volume, !volume));
        let rule = if volume { "expected volume" } else { "expected area" };
        assert_eq!(rules_of(&found), if within { vec![] } else { vec![rule] }, "{value}");
        if let Some(reason) = found.verdict.reasons.first() {
            assert_eq!((reason.value, reason.limit), (relative_error, 0.005));
        }
    }
}

#[test]
fn judging_again_forgets_the_old_verdict() {
    let mut found = summary(&[("tetrahedron", &SOUND)]);
    Judgement { fail_under: vec![], expectation: Some(expect(true, 1.0)) }.judge(&mut found);
    assert_eq!(found.verdict.status, Status::Fail);
    Judgement::default().judge(&mut found);
    assert_eq!((found.verdict.status, found.expected), (Status::Pass, None));
}

#[test]
fn a_mesh_without_a_measured_element_is_no_pass() {
    let mut summary = summary(&[]);
    Judgement::default().judge(&mut summary);
    assert_eq!(summary.verdict.status, Status::Warn);
    assert_eq!(summary.verdict.reasons[0].rule, rules::NOTHING_MEASURED);
}
