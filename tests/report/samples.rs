//! Summaries made by hand, with numbers of the report's own tables.

use std::collections::BTreeMap;

use meshgauge::mesh::Shape;
use meshgauge::summary::*;

/// One measure: maximum, minimum, its element, mean and standard deviation, as in a row of the report's tables.
fn measure(on: &'static str, count: u64, row: (f64, f64, u64, f64, f64)) -> MeasureSummary {
    let (max, min, min_element, mean, sd) = row;
    let mut histogram = vec![0; 100];
    histogram[((mean * 100.0) as usize).min(99)] = count;
    let quantiles = [("0.001", min + 0.01), ("0.01", 0.4), ("0.05", 0.55), ("0.5", mean), ("0.95", max)];
    let quantiles = quantiles.into_iter().map(|(p, q)| (p.to_owned(), q)).collect();
    let (below, worst) = (BTreeMap::new(), vec![]);
    MeasureSummary {
        on: on.into(),
        count,
        max,
        min,
        min_element,
        mean,
        sd,
        quantiles,
        histogram,
        below,
        worst,
    }
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

pub fn mesh(name: &str, shapes: BTreeMap<Shape, ShapeSummary>) -> Summary {
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
        frame: None,
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
        regions: None,
    };
    Judgement::default().judge(&mut summary);
    summary
}

/// Mesh 1 of the report's table 8, and a boundary of triangles.
pub fn tetrahedra() -> Summary {
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
pub fn mixed() -> Summary {
    let wedges = named([
        ("M11", measure("triangular faces", 720, (0.3181, 0.3181, 17644, 0.3181, 2e-16))),
        ("M21", measure("quadrilateral faces", 1080, (1.0, 1.0, 1, 1.0, 0.0))),
        ("M22", measure("quadrilateral faces", 1080, (1.0, 0.0999, 17644, 0.725, 0.389))),
    ]);
    let hexahedra =
        named([("M22", measure("quadrilateral faces", 105_840, (1.0, 3.2e-5, 1733, 0.54, 0.37)))]);
    let mut hexahedra = shape(17640, hexahedra);
    (hexahedra.inverted, hexahedra.degenerate) = (1, 1200);
    let mut summary =
        mesh("fd-cylinder", [(Shape::Wedge, shape(360, wedges)), (Shape::Hexahedron, hexahedra)].into());
    summary.totals.volume = Some(9_767.703_1);
    summary.run = Some(Run {
        meshgauge: "0.1.0".into(),
        host: "node17".to_owned(),
        started: "2026-11-20T01:02:03Z".to_owned(),
        seconds: 0.1234,
        threads: 4,
        peak_rss_bytes: 61_234_567,
        elements_per_second: 145_867.1,
    });
    let expectation = Some(Expectation { volume: true, value: 9_817.477_042_468_1, tolerance_percent: 0.5 });
    let rules = vec![Rule::fail_under("M11", 0.4)];
    Judgement { rules, expectation, ..Judgement::default() }.judge(&mut summary);
    summary
}
