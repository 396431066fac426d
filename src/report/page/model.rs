//! What the template of the page takes.

use serde::Serialize;

use super::Content;
use super::groups::{Group, groups, published_series, series_of, sizes_of};
use crate::compare::{Comparison, Outcome};
use crate::measures::measures;
use crate::report::comparison::{COLUMNS, cells, rest, side, told};
use crate::report::details::TextTable;
use crate::report::figure::{INVESTIGATE, Series};
use crate::report::numbers::{bytes, count, score, significant};
use crate::report::safe::escaped;
use crate::report::{layout, reasons};
use crate::summary::{Checks, Status, Summary};

/// The whole page.
#[derive(Debug, Serialize)]
pub struct Model {
    title: String,
    version: &'static str,
    tally: Tally,
    legend: Vec<Entry>,
    meshes: Vec<Mesh>,
    changes: Option<Changes>,
    groups: Vec<Group>,
    sizes: Option<String>,
    details: Vec<Details>,
    checks: Vec<&'static str>,
    not_measured: Vec<NotMeasured>,
    measures: Vec<Definition>,
}

#[derive(Debug, Serialize)]
struct Tally {
    meshes: usize,
    pass: usize,
    warn: usize,
    fail: usize,
}

#[derive(Debug, Serialize)]
struct Entry {
    class: String,
    name: String,
    index: usize,
}

#[derive(Debug, Serialize)]
struct Mesh {
    index: usize,
    class: String,
    name: String,
    path: String,
    file: String,
    status: &'static str,
    rank: usize,
    reasons: Vec<String>,
    elements: (String, u64),
    nodes: (String, u64),
    shapes: String,
    total: (String, f64),
    lowest: Option<Lowest>,
    checks: Vec<u64>,
}

#[derive(Debug, Serialize)]
struct Lowest {
    code: String,
    text: String,
    value: f64,
    low: bool,
}

#[derive(Debug, Serialize)]
struct Changes {
    worse: usize,
    better: usize,
    same: usize,
    columns: [&'static str; 8],
    meshes: Vec<Changed>,
}

#[derive(Debug, Serialize)]
struct Changed {
    name: String,
    outcome: &'static str,
    base: String,
    new: String,
    rest: String,
    findings: Vec<(&'static str, [String; 8])>,
}

/// A table of the worst elements, or of statistics by region.
#[derive(Debug, Serialize)]
struct Details {
    title: String,
    header: Vec<&'static str>,
    text_columns: usize,
    rows: Vec<Vec<String>>,
}

#[derive(Debug, Serialize)]
struct NotMeasured {
    name: String,
    what: String,
    count: String,
}

#[derive(Debug, Serialize)]
struct Definition {
    code: &'static str,
    title: &'static str,
    family: &'static str,
    definition: &'static str,
    watches: &'static str,
    source: &'static str,
}

impl Model {
    /// The page's content in the template's words.
    pub fn of(content: &Content) -> Self {
        let (series, of_2007) = (series_of(content), published_series(content));
        let with = |status| content.meshes.iter().filter(|mesh| mesh.verdict.status == status).count();
        Self {
            title: escaped(content.title),
            version: env!("CARGO_PKG_VERSION"),
            tally: Tally {
                meshes: content.meshes.len(),
                pass: with(Status::Pass),
                warn: with(Status::Warn),
                fail: with(Status::Fail),
            },
            legend: legend(&series, &of_2007),
            meshes: content.meshes.iter().zip(&series).map(|(mesh, series)| row(mesh, series)).collect(),
            changes: content.changes.map(changes),
            groups: groups(content, &series, &of_2007),
            sizes: sizes_of(content, &series).map(|scene| scene.to_svg()),
            details: details(content.meshes),
            checks: checks(&Checks::default()).map(|(name, _)| name).to_vec(),
            not_measured: content.meshes.iter().flat_map(not_measured).collect(),
            measures: definitions(content),
        }
    }
}

fn legend(series: &[Series], of_2007: &[Series]) -> Vec<Entry> {
    let coloured = series.iter().filter(|series| series.class != "rest").chain(of_2007);
    let entry = |series: &Series| Entry {
        class: series.class.clone(),
        name: series.name.clone(),
        index: series.index,
    };
    coloured.map(entry).collect()
}

fn row(mesh: &Summary, series: &Series) -> Mesh {
    let total = mesh.totals.volume.or(mesh.totals.area);
    let kind = if mesh.totals.volume.is_some() { "volume" } else { "area" };
    let shapes: Vec<_> = mesh
        .main_shapes()
        .map(|(shape, found)| format!("{} {}", count(found.count), layout::plural(shape)))
        .collect();
    let packed =
        mesh.mesh.compression.as_ref().map(|packed| format!(", {}", escaped(packed))).unwrap_or_default();
    Mesh {
        index: series.index,
        class: series.class.clone(),
        name: series.name.clone(),
        path: escaped(&mesh.mesh.path),
        file: format!("{}{packed}, {}", escaped(&mesh.mesh.format), bytes(mesh.mesh.bytes)),
        status: mesh.verdict.status.name(),
        rank: mesh.verdict.status as usize,
        reasons: mesh.verdict.reasons.iter().map(|reason| reasons::in_words(reason, mesh)).collect(),
        elements: (count(mesh.elements.count), mesh.elements.count),
        nodes: (count(mesh.nodes.count), mesh.nodes.count),
        shapes: if shapes.is_empty() { "nothing to measure".to_owned() } else { shapes.join(", ") },
        total: total.map(|total| (format!("{kind} {}", significant(total, 6)), total)).unwrap_or_default(),
        lowest: lowest(mesh),
        checks: checks(&mesh.checks).map(|(_, found)| found).to_vec(),
    }
}

/// The measure with the lowest minimum, of the mesh's own dimension.
fn lowest(mesh: &Summary) -> Option<Lowest> {
    let all = mesh.main_shapes().flat_map(|(_, shape)| &shape.measures);
    let (code, found) = all.min_by(|a, b| a.1.min.total_cmp(&b.1.min))?;
    Some(Lowest {
        code: escaped(code),
        text: score(found.min),
        value: found.min,
        low: found.min < INVESTIGATE,
    })
}

fn changes(comparisons: &[Comparison]) -> Changes {
    let count = |outcome| comparisons.iter().filter(|mesh| mesh.outcome == outcome).count();
    let changed = |mesh: &Comparison| Changed {
        name: escaped(&mesh.name),
        outcome: mesh.outcome.name(),
        base: side(&mesh.base),
        new: side(&mesh.new),
        rest: rest(mesh),
        findings: told(mesh).map(|finding| (finding.outcome.name(), cells(finding))).collect(),
    };
    Changes {
        worse: count(Outcome::Worse),
        better: count(Outcome::Better),
        same: count(Outcome::Same) + count(Outcome::Changed),
        columns: COLUMNS,
        meshes: comparisons.iter().filter(|mesh| mesh.outcome != Outcome::Same).map(changed).collect(),
    }
}

/// The worst elements and the statistics by region, those of all meshes under one title.
fn details(meshes: &[Summary]) -> Vec<Details> {
    let mut tables: Vec<Details> = Vec::new();
    for table in crate::report::details::tables(meshes) {
        let TextTable { title, header, text_columns, rows } = table;
        match tables.iter_mut().find(|known| (&known.title, &known.header) == (&title, &header)) {
            Some(known) => known.rows.extend(rows),
            None => tables.push(Details { title, header, text_columns, rows }),
        }
    }
    tables
}

/// The checks by what they count.
fn checks(checks: &Checks) -> [(&'static str, u64); 9] {
    [
        ("missing nodes", checks.missing_nodes),
        ("repeated nodes", checks.repeated_nodes),
        ("unused nodes", checks.unused_nodes),
        ("inverted", checks.inverted),
        ("degenerate", checks.degenerate),
        ("reversed", checks.reversed),
        ("concave faces", checks.concave_faces),
        ("crossed faces", checks.crossed_faces),
        ("ghosts left out", checks.ghost_elements),
    ]
}

fn not_measured(mesh: &Summary) -> Vec<NotMeasured> {
    let name = escaped(&mesh.mesh.name);
    let one = |(what, number): (&String, &u64)| NotMeasured {
        name: name.clone(),
        what: escaped(what),
        count: count(*number),
    };
    mesh.elements.not_measured.iter().map(one).collect()
}

/// The measures that some mesh has.
fn definitions(content: &Content) -> Vec<Definition> {
    let used = |code: &str| {
        content.meshes.iter().any(|mesh| mesh.shapes.values().any(|shape| shape.measures.contains_key(code)))
    };
    let row = |m: &crate::measures::Measure| Definition {
        code: m.code,
        title: m.title,
        family: m.family.name(),
        definition: m.definition,
        watches: m.watches,
        source: m.source,
    };
    measures().filter(|measure| used(measure.code)).map(row).collect()
}
