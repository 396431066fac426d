//! The summary's schema, and each report of it.

use std::collections::BTreeMap;

use meshgauge::mesh::Shape;
use meshgauge::report::{REPORTS, Style, find};
use meshgauge::summary::*;

/// One measure: maximum, minimum, its element, mean and standard deviation, as in a row of the report's tables.
fn measure(on: &'static str, count: u64, row: (f64, f64, u64, f64, f64)) -> MeasureSummary {
    let (max, min, min_element, mean, sd) = row;
    let mut histogram = vec![0; 100];
    histogram[((mean * 100.0) as usize).min(99)] = count;
    let quantiles = [("0.001", min + 0.01), ("0.01", 0.4), ("0.05", 0.55), ("0.5", mean), ("0.95", max)];
    let quantiles = quantiles.into_iter().map(|(p, q)| (p.to_owned(), q)).collect();
    MeasureSummary { on: on.into(), count, max, min, min_element, mean, sd, quantiles, histogram }
}

fn named<T>(rows: impl IntoIterator<Item = (&'static str, T)>) -> BTreeMap<String, T> {
    rows.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

fn shape(count: u64, measures: BTreeMap<String, MeasureSummary>) -> ShapeSummary {
    ShapeSummary {
        count,
        order: named([("1", count)]),
        area: None,
        volume: None,
        inverted: 0,
        degenerate: 0,
        measures,
        correlation: named([("M31 M32", Some(0.97)), ("M31 M33", None)]),
        ordering: BTreeMap::new(),
    }
}

fn mesh(name: &str, shapes: BTreeMap<Shape, ShapeSummary>) -> Summary {
    let count = shapes.values().map(|shape| shape.count).sum();
    let mut summary = Summary {
        schema: SCHEMA.into(),
        mesh: MeshFile {
            name: name.to_owned(),
            path: format!("drop/{name}.inp.gz"),
            format: "abaqus".to_owned(),
            compression: Some("gzip".to_owned()),
            bytes: 5_123_456,
            xxh3: "00f1e2d3c4b5a697".to_owned(),
        },
        nodes: Nodes {
            count: 15989,
            unused: 12,
            bounds: Some(Bounds { min: [-3.2, -3.2, 0.0], max: [3.2, 3.2, 25.4] }),
        },
        elements: Elements {
            count: count + 12,
            by_type: named([("C3D4", count), ("B31", 12)]),
            not_measured: named([("line", 12)]),
        },
        shapes,
        totals: Totals { area: None, volume: Some(816.029_7) },
        sizes: Sizes {
            edge_length: Some(Range { min: 0.012_34, max: 1.25 }),
            element_size: Some(SizeSummary {
                min: 0.0211,
                max: 1.021,
                mean: 0.1834,
                quantiles: named([("0.5", 0.2)]),
            }),
        },
        checks: Checks { unused_nodes: 12, ..Checks::default() },
        expected: None,
        verdict: Verdict { status: Status::Pass, reasons: vec![] },
        run: None,
    };
    Judgement::default().judge(&mut summary);
    summary
}

/// Mesh 1 of the report's table 8, and a boundary of triangles.
fn tetrahedra() -> Summary {
    let n = 82916;
    let rows = named([
        ("M31", measure("element", n, (0.999, 0.173, 17260, 0.771, 0.108))),
        ("M32", measure("element", n, (0.998, 0.273, 17260, 0.852, 0.067))),
        ("M33", measure("element", n, (0.9997, 0.0966, 17260, 0.580, 0.119))),
        ("M34", measure("element", n, (0.999, 0.193, 17260, 0.809, 0.093))),
    ]);
    let mut tetrahedra = shape(n, rows);
    tetrahedra.volume = Some(816.029_7);
    tetrahedra.ordering = named([("M32>=M34>=M31>=M33", 0.9)]);
    let mut triangles = shape(412, named([("M11", measure("element", 412, (1.0, 0.02, 90001, 0.9, 0.05)))]));
    triangles.area = Some(578.1);
    mesh("pit-1", [(Shape::Triangle, triangles), (Shape::Tetrahedron, tetrahedra)].into())
}

/// A mesh of wedges and hexahedra with faults of every kind.
fn mixed() -> Summary {
    let wedges = named([
        ("M11", measure("triangular faces", 720, (0.318, 0.318, 17644, 0.318, 2e-16))),
        ("M21", measure("quadrilateral faces", 1080, (1.0, 1.0, 1, 1.0, 0.0))),
        ("M22", measure("quadrilateral faces", 1080, (1.0, 0.0999, 17644, 0.725, 0.389))),
    ]);
    let hexahedra =
        named([("M22", measure("quadrilateral faces", 105_840, (1.0, 3.2e-5, 1733, 0.54, 0.37)))]);
    let mut hexahedra = shape(17640, hexahedra);
    (hexahedra.inverted, hexahedra.degenerate) = (1, 1200);
    let mut summary =
        mesh("fd-cylinder", [(Shape::Wedge, shape(360, wedges)), (Shape::Hexahedron, hexahedra)].into());
    summary.totals.volume = Some(9767.703_1);
    summary.run = Some(Run {
        meshgauge: "0.1.0".into(),
        host: "node17".to_owned(),
        started: "2026-11-20T01:02:03Z".to_owned(),
        seconds: 0.1234,
        threads: 4,
        peak_rss_bytes: 61_234_567,
        elements_per_second: 145_867.1,
    });
    let expectation = Some(Expectation { volume: true, value: 9817.477_042_468_1, tolerance_percent: 0.5 });
    let fail_under = vec![FailUnder { measure: "M11".to_owned(), value: 0.4 }];
    Judgement { fail_under, expectation }.judge(&mut summary);
    summary
}

fn render(name: &str, summaries: &[Summary], style: Style) -> String {
    let mut out = Vec::new();
    (find(name).expect("a report of that name").render)(summaries, &style, &mut out)
        .expect("a vector takes it");
    String::from_utf8(out).expect("text")
}

fn plain(name: &str, summaries: &[Summary]) -> String {
    render(name, summaries, Style::default())
}

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

#[test]
fn reports_have_names_and_titles() {
    let names: Vec<_> = REPORTS.iter().map(|report| report.name).collect();
    assert_eq!(names, ["table", "json", "jsonl", "csv", "markdown"]);
    assert!(REPORTS.iter().all(|report| !report.title.is_empty() && !report.title.contains('\n')));
    assert!(find("html5").is_none());
}

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
    Judgement { fail_under: vec![], expectation }.judge(&mut summary);
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
    for width in [80, 120] {
        let found = render("table", &[long.clone()], Style { color: false, width: Some(width) });
        // the first line holds the whole name
        for line in found.lines().skip(1) {
            assert!(line.chars().count() <= width.into(), "{width}: {line}");
        }
        assert!(found.contains("  specimen-") && found.contains("-fine  M11"), "{found}");
    }
}

#[test]
fn only_the_style_colours() {
    let colored = render("table", &[tetrahedra()], Style { color: true, width: None });
    assert!(colored.contains("\u{1b}[33mwarn\u{1b}[0m"), "{colored}");
    let codes = ["\u{1b}[1m", "\u{1b}[33m", "\u{1b}[0m"];
    let bare = codes.iter().fold(colored, |text, code| text.replace(code, ""));
    assert_eq!(bare, plain("table", &[tetrahedra()]));
}

const CSV_HEADER: &str = "mesh,path,format,shape,on,measure,count,max,min,min_element,mean,sd,\
                          q0.001,q0.01,q0.05,q0.5,q0.95,inverted,degenerate,verdict";

#[test]
fn csv_rows() {
    let mut summary = mixed();
    summary.mesh.name = "a \"b\", c".to_owned();
    let found = plain("csv", &[tetrahedra(), summary]);
    let lines: Vec<_> = found.lines().collect();
    assert_eq!((lines[0], lines.len()), (CSV_HEADER, 1 + 5 + 4));
    assert_eq!(
        lines[2],
        "pit-1,drop/pit-1.inp.gz,abaqus,tetrahedron,element,M31,82916,0.999,0.173,17260,0.771,0.108,\
         0.183,0.4,0.55,0.771,0.999,0,0,warn"
    );
    assert_eq!(
        lines[9],
        "\"a \"\"b\"\", c\",drop/fd-cylinder.inp.gz,abaqus,hexahedron,quadrilateral faces,M22,105840,1.0,3.2e-5,\
         1733,0.54,0.37,0.010032000000000001,0.4,0.55,0.54,1.0,1,1200,fail"
    );
}

#[test]
fn json_is_an_object_or_an_array() {
    assert_eq!(plain("json", &[mixed()]), mixed().to_json());
    let back: Vec<Summary> =
        serde_json::from_str(&plain("json", &[mixed(), tetrahedra()])).expect("an array");
    assert_eq!(back, [mixed(), tetrahedra()]);
    assert_eq!(plain("json", &[]), "[]\n");
}

#[test]
fn jsonl_is_one_object_a_line() {
    let found = plain("jsonl", &[mixed(), tetrahedra()]);
    let back: Vec<Summary> =
        found.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    assert_eq!(back, [mixed(), tetrahedra()]);
    assert_eq!(plain("jsonl", &[]), "");
}

#[test]
fn markdown_tables() {
    let found = plain("markdown", &[tetrahedra()]);
    let expected = "\
### pit-1: warn

| file | drop/pit-1.inp.gz (abaqus, gzip, 5.12 MB) |
|---|---|
| nodes | 15,989 |
";
    assert!(found.starts_with(expected), "{found}");
    assert!(found.contains("| pit-1 | M33 | 0.9997 | 0.097 | 17260 | 0.580 | 0.119 |\n"), "{found}");
}

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

#[test]
fn what_cannot_be_written_is_an_error() {
    struct Full;
    impl std::io::Write for Full {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    for report in REPORTS {
        assert!((report.render)(&[mixed()], &Style::default(), &mut Full).is_err(), "{}", report.name);
    }
}

#[test]
#[ignore = "for looking at: cargo test --test report look -- --ignored --nocapture"]
fn look() {
    let mut long = mixed();
    long.mesh.name = "specimen-with-a-hemispherical-pit-of-500-microns-in-a-bar-of-32-millimetres-fine".to_owned();
    long.elements.by_type = (1..20).map(|i| (format!("C3D{i}"), 1000)).collect();
    for width in [80, 120] {
        let style = Style { color: true, width: Some(width) };
        println!("{}\n{}", "-".repeat(width.into()), render("table", &[tetrahedra(), long.clone()], style));
    }
}
