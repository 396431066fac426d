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
    let rules = row.fail_under.iter().map(|(code, value)| Rule::fail_under(*code, *value)).collect();
    Judgement { rules, ..Judgement::default() }
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
        statistic: None,
        threshold: None,
        status: None,
    };
    assert_eq!(found.verdict.reasons, [expected]);
}

#[test]
fn boundary_shapes_have_no_say() {
    for row in ROWS {
        let mut found = summary(&[("triangle", row), ("hexahedron", &SOUND)]);
        let rules = asked(row).rules.into_iter().filter(|rule| rule.limit <= SOUND.min).collect();
        Judgement { rules, ..Judgement::default() }.judge(&mut found);
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
    expecting(expect(true, 100.0)).judge(&mut found);
    assert_eq!(rules_of(&found), ["expected volume", "degenerate elements", "npl", "npl"]);
    assert_eq!(found.verdict.reasons[2].shape, Some(Shape::Tetrahedron));
}

fn expecting(expectation: Expectation) -> Judgement {
    Judgement { expectation: Some(expectation), ..Judgement::default() }
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
        expecting(expect(volume, value)).judge(&mut found);
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
    expecting(expect(true, 1.0)).judge(&mut found);
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

/// A measure with a mean of 0.8, a maximum of 1, a minimum of 0.5, 3 of 1000 values under 0.6, a median of 0.79.
fn measured() -> Summary {
    let mut found = summary(&[("tetrahedron", &SOUND)]);
    let shape = found.shapes.get_mut(&Shape::Tetrahedron).expect("there are some");
    let measure = shape.measures.get_mut("M31").expect("it was measured");
    measure.count = 1000;
    measure.below = [("0.6".to_owned(), 3)].into();
    measure.quantiles = [("0.5".to_owned(), 0.79)].into();
    found.checks.unused_nodes = 12;
    found
}

fn rule(statistic: Statistic, limit: f64) -> Rule {
    Rule { name: "ours".into(), statistic, ..Rule::fail_under("M31", limit) }
}

#[test]
fn each_statistic_is_broken_on_its_own_side_of_the_limit() {
    // (statistic, limit, value and limit of the reason)
    let rows = [
        (Statistic::Min, 0.51, Some((0.5, 0.51))),
        (Statistic::Min, 0.5, None),
        (Statistic::Mean, 0.81, Some((0.8, 0.81))),
        (Statistic::Mean, 0.8, None),
        (Statistic::Max, 1.0, None),
        (Statistic::Quantile(0.5), 0.8, Some((0.79, 0.8))),
        (Statistic::Quantile(0.5), 0.79, None),
        (Statistic::ShareBelow(0.002), 0.6, Some((0.003, 0.002))),
        (Statistic::ShareBelow(0.003), 0.6, None),
        (Statistic::ShareBelow(0.0), 0.6, Some((0.003, 0.0))),
        (Statistic::CountBelow(2), 0.6, Some((3.0, 2.0))),
        (Statistic::CountBelow(3), 0.6, None),
    ];
    for (statistic, limit, expected) in rows {
        let mut found = measured();
        Judgement { rules: vec![rule(statistic, limit)], ..Judgement::default() }.judge(&mut found);
        let reason = found.verdict.reasons.first().map(|reason| (reason.value, reason.limit));
        assert_eq!(reason, expected, "{statistic:?} {limit}");
        assert_eq!(found.verdict.status == Status::Fail, expected.is_some(), "{statistic:?} {limit}");
    }
}

#[test]
fn a_rule_may_warn_be_of_one_shape_or_of_a_check() {
    let own = |rule: Rule| Judgement { rules: vec![rule], presets: vec![], expectation: None };
    let mut found = measured();
    own(Rule { status: Status::Warn, ..rule(Statistic::Mean, 0.9) }).judge(&mut found);
    assert_eq!((found.verdict.status, rules_of(&found)), (Status::Warn, vec!["ours"]));
    own(Rule { shape: Some(Shape::Wedge), ..rule(Statistic::Mean, 0.9) }).judge(&mut found);
    assert_eq!(found.verdict.status, Status::Pass);
    let unused = Subject::Check("unused_nodes".into());
    own(Rule { subject: unused.clone(), ..rule(Statistic::Count, 12.0) }).judge(&mut found);
    assert_eq!(found.verdict.status, Status::Pass);
    own(Rule { subject: unused, ..rule(Statistic::Count, 11.0) }).judge(&mut found);
    assert_eq!((found.verdict.status, found.verdict.reasons[0].value), (Status::Fail, 12.0));
}

#[test]
fn a_failure_and_a_warning_for_one_value_are_one_reason() {
    let warn = |limit| Rule { status: Status::Warn, ..rule(Statistic::Min, limit) };
    let mut found = measured();
    let rules = vec![rule(Statistic::Min, 0.6), warn(0.9), rule(Statistic::Mean, 0.9)];
    Judgement { rules, ..Judgement::default() }.judge(&mut found);
    let limits: Vec<_> = found.verdict.reasons.iter().map(|reason| reason.limit).collect();
    assert_eq!(limits, [0.6, 0.9], "the minimum fails once, the mean fails too");
}

#[test]
fn presets() {
    // (preset, measure, shape, its minimum, status)
    let rows = [
        ("npl", "M31", "tetrahedron", 0.09, Status::Warn),
        ("comsol", "M31", "tetrahedron", 0.09, Status::Warn),
        ("comsol", "M31", "tetrahedron", 0.1, Status::Pass),
        ("comsol", "M33", "tetrahedron", 0.0, Status::Pass),
        ("comsol", "M13", "triangle", 0.29, Status::Warn),
        ("comsol", "M13", "wedge", 0.29, Status::Pass),
        ("aspect", "M22", "quadrilateral", 0.19, Status::Warn),
        ("aspect", "M22", "hexahedron", 0.069, Status::Fail),
        ("aspect", "M22", "hexahedron", 0.2, Status::Pass),
        ("none", "M22", "hexahedron", 0.0, Status::Pass),
    ];
    for (name, code, shape, min, status) in rows {
        let mut found = summary(&[(shape, &Row { min, ..SOUND })]);
        for measured in found.shapes.values_mut() {
            measured.measures = measured.measures.values().map(|m| (code.to_owned(), m.clone())).collect();
        }
        let presets = vec![preset(name).expect("it is in the table").name];
        Judgement { presets, ..Judgement::default() }.judge(&mut found);
        assert_eq!(found.verdict.status, status, "{name} {code} {shape} {min}");
        assert!(found.verdict.reasons.len() <= 1, "{name} {code} {shape} {min}");
    }
}

#[test]
fn a_rule_for_one_shape_leaves_the_preset_to_the_others() {
    let weak = Row { min: 0.05, ..SOUND };
    let mut found = summary(&[("tetrahedron", &weak), ("wedge", &weak)]);
    let rules = vec![Rule { shape: Some(Shape::Wedge), ..Rule::fail_under("M31", 0.01) }];
    Judgement { rules, ..Judgement::default() }.judge(&mut found);
    assert_eq!((rules_of(&found), found.verdict.reasons[0].shape), (vec!["npl"], Some(Shape::Tetrahedron)));
}
