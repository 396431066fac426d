//! The summary's schema: the keys of the contract, in its order, and numbers that read back.

use meshgauge::summary::Summary;

use crate::samples::{mixed, tetrahedra};

/// Keys of the object at a JSON pointer, in the order of the text.
fn keys(json: &serde_json::Value, pointer: &str) -> Vec<String> {
    let object = json.pointer(pointer).and_then(|value| value.as_object()).expect(pointer);
    object.keys().cloned().collect()
}

#[test]
fn keys_stand_in_the_order_of_the_contract() {
    let json: serde_json::Value = serde_json::from_str(&mixed().to_json()).expect("JSON");
    let tetrahedra: serde_json::Value = serde_json::from_str(&tetrahedra().to_json()).expect("JSON");
    let rows = [
        (&json, "", "schema mesh nodes elements shapes totals sizes checks expected verdict run"),
        (&json, "/mesh", "name path format compression bytes xxh3"),
        (&json, "/nodes", "count unused bounds"),
        (&json, "/nodes/bounds", "min max"),
        (&json, "/elements", "count by_type not_measured"),
        (&json, "/shapes", "wedge hexahedron"),
        (&tetrahedra, "/shapes", "triangle tetrahedron"),
        (&tetrahedra, "/shapes/triangle", "count order area inverted degenerate measures correlation"),
        (
            &tetrahedra,
            "/shapes/tetrahedron",
            "count order volume inverted degenerate measures correlation ordering",
        ),
        (&tetrahedra, "/shapes/tetrahedron/measures", "M31 M32 M33 M34"),
        (
            &tetrahedra,
            "/shapes/tetrahedron/measures/M31",
            "on count max min min_element mean sd quantiles histogram",
        ),
        (&tetrahedra, "/shapes/tetrahedron/measures/M31/quantiles", "0.001 0.01 0.05 0.5 0.95"),
        (&json, "/totals", "area volume"),
        (&json, "/sizes", "edge_length element_size"),
        (&json, "/sizes/edge_length", "min max"),
        (&json, "/sizes/element_size", "min max mean quantiles"),
        (&json, "/expected", "volume relative_error within"),
        (&json, "/verdict", "status reasons"),
        (&json, "/verdict/reasons/0", "rule measure shape value limit element"),
        (&json, "/verdict/reasons/1", "rule measure shape value limit element"),
        (&json, "/run", "meshgauge host started seconds threads peak_rss_bytes elements_per_second"),
    ];
    for (json, pointer, expected) in rows {
        assert_eq!(keys(json, pointer).join(" "), expected, "{pointer}");
    }
    assert_eq!(keys(&json, "/checks")[..3], ["missing_nodes", "repeated_nodes", "unused_nodes"]);
    assert_eq!(json["schema"], "meshgauge.summary/1");
    assert_eq!(json["verdict"]["status"], "fail");
    assert_eq!(tetrahedra["verdict"]["reasons"][0]["shape"], "tetrahedron");
}

#[test]
fn absent_things_are_null_or_left_out() {
    let mut summary = tetrahedra();
    (summary.mesh.compression, summary.nodes.bounds) = (None, None);
    let json: serde_json::Value = serde_json::from_str(&summary.to_json()).expect("JSON");
    assert_eq!(json.get("run"), None);
    for pointer in ["/expected", "/mesh/compression", "/nodes/bounds", "/totals/area"] {
        assert_eq!(json.pointer(pointer), Some(&serde_json::Value::Null), "{pointer}");
    }
    assert_eq!(serde_json::from_str::<Summary>(&summary.to_json()).expect("its own schema"), summary);
}

#[test]
fn a_summary_reads_back_equal() {
    for summary in [tetrahedra(), mixed()] {
        let json = summary.to_json();
        assert!(json.ends_with("}\n"));
        let back: Summary = serde_json::from_str(&json).expect("its own schema");
        assert_eq!(back, summary);
        assert_eq!(back.to_json(), json);
    }
}

#[test]
fn numbers_are_shortest_and_read_back_to_the_same_bits() {
    let mut summary = tetrahedra();
    let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
    let awkward = [0.1, 1.0 / 3.0, 5e-324, f64::MIN_POSITIVE, f64::MAX, 1.0 - f64::EPSILON / 2.0, -0.0, 1e23];
    let random = std::iter::repeat_with(|| {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from_bits(bits)
    });
    for value in awkward.into_iter().chain(random.filter(|value| value.is_finite()).take(2000)) {
        summary.totals.volume = Some(value);
        let back: Summary = serde_json::from_str(&summary.to_json()).expect("its own schema");
        assert_eq!(back.totals.volume.map(f64::to_bits), Some(value.to_bits()), "{value:e}");
    }
    summary.totals.volume = Some(0.1 + 0.2);
    assert!(summary.to_json().contains(r#""volume": 0.30000000000000004"#));
    summary.totals.volume = Some(0.3);
    assert!(summary.to_json().contains("\"volume\": 0.3\n"));
}
