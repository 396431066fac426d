//! What the stages found becomes a summary.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::time::{Instant, SystemTime};

use super::Options;
use super::measure::{Bins, Hits, ShapeBins, ShapeStatistics};
use super::merge::{ByShape, Merged};
use super::regions::{add_worst, by_region};
use crate::error::Result;
use crate::formats::{FORMATS, Format, Ledger};
use crate::input::{Input, mesh_name};
use crate::measures::{self, Family};
use crate::mesh::{Class, Frame, Nodes, Regions, Shape};
use crate::statistics::{Moments, Spread};
use crate::summary::{
    Bounds, Checks, Elements, Frame as FrameSummary, Judgement, MeasureSummary, MeshFile,
    Nodes as NodeSummary, Range, Run, SCHEMA, ShapeSummary, SizeSummary, Sizes, Status, Summary, Totals,
    Verdict, rules,
};

/// Whether a shape is stored with negative orientation as a whole.
type Reversed = [bool; Shape::ALL.len()];

/// Everything that a run found.
pub(super) struct Found<'a> {
    pub input: &'a Input,
    pub format: &'static dyn Format,
    pub hash: u64,
    pub nodes: &'a Nodes,
    pub regions: &'a Regions,
    pub merged: Merged,
    pub bins: Bins,
    pub threads: usize,
    pub started: (SystemTime, Instant),
}

/// Puts the summary together and judges it.
pub(super) fn assemble(found: Found<'_>, options: &Options) -> Result<Summary> {
    let reversed = reversed_shapes(found.format, &found.merged.shapes);
    let shapes = shapes(&found, &reversed, &options.judgement);
    let mut summary = Summary {
        schema: Cow::Borrowed(SCHEMA),
        mesh: mesh_file(&found),
        nodes: node_summary(found.nodes),
        elements: elements(&found.merged.ledger),
        frame: frame(&found.merged.shapes, options.frame),
        totals: totals(&shapes),
        sizes: Sizes { edge_length: None, element_size: None },
        checks: checks(&found, &reversed),
        shapes,
        expected: None,
        verdict: Verdict { status: Status::Pass, reasons: Vec::new() },
        run: None,
        regions: None,
    };
    if options.worst > 0 {
        add_worst(&mut summary.shapes, &found.bins, found.nodes, found.regions);
    }
    if options.by_region {
        let of = found.format.regions();
        summary.regions = Some(by_region(&found.merged.shapes, &reversed, found.regions, of));
    }
    summary.sizes = sizes(&found, summary.dimension());
    options.judgement.judge(&mut summary);
    name_first_elements(&found, &reversed, &mut summary);
    keep_measures(&mut summary, &options.measures);
    if options.run_info {
        summary.run = Some(run(&found));
    }
    Ok(summary)
}

fn mesh_file(found: &Found<'_>) -> MeshFile {
    let path = found.input.path();
    let extensions: Vec<_> = FORMATS.iter().flat_map(|format| format.extensions()).copied().collect();
    // The folder `.` has a name, too.
    let named = if path.file_name().is_none() { path.canonicalize().ok() } else { None };
    MeshFile {
        name: mesh_name(named.as_deref().unwrap_or(path), &extensions).to_string_lossy().into_owned(),
        path: path.to_string_lossy().into_owned(),
        format: found.format.name().to_owned(),
        compression: found.input.compression.map(str::to_owned),
        bytes: found.input.bytes_on_disk,
        xxh3: format!("{:016x}", found.hash),
    }
}

fn node_summary(nodes: &Nodes) -> NodeSummary {
    let bounds = nodes.bounds();
    NodeSummary {
        count: nodes.count(),
        unused: nodes.unused(),
        bounds: (nodes.count() > 0).then_some(Bounds { min: bounds.min, max: bounds.max }),
    }
}

/// The frame, where it is not the file's own.
fn frame(shapes: &ByShape, frame: Frame) -> Option<FrameSummary> {
    let enclosing_axis = shapes.iter().flatten().map(|statistics| statistics.enclosing_axis).sum();
    let Frame { system, stretch } = frame;
    (frame != Frame::OWN).then_some(FrameSummary { system, stretch, enclosing_axis })
}

fn elements(ledger: &Ledger) -> Elements {
    let mut elements = Elements::default();
    for row in ledger.types.iter().filter(|row| row.count > 0) {
        elements.count += row.count;
        *elements.by_type.entry(row.name.to_string()).or_default() += row.count;
        if let Class::Counted(what) = &row.class {
            *elements.not_measured.entry(what.to_string()).or_default() += row.count;
        }
    }
    elements
}

fn shapes(found: &Found<'_>, reversed: &Reversed, judgement: &Judgement) -> BTreeMap<Shape, ShapeSummary> {
    let mut shapes = BTreeMap::new();
    for shape in Shape::ALL {
        if let (Some(statistics), Some(bins)) = (&found.merged.shapes[shape.index()], found.bins.shape(shape))
        {
            let order = order(&found.merged.ledger, shape);
            let inverted = inverted(statistics, reversed[shape.index()]).count;
            shapes.insert(shape, shape_summary(shape, statistics, bins, order, inverted, judgement));
        }
    }
    shapes
}

fn shape_summary(
    shape: Shape,
    statistics: &ShapeStatistics,
    bins: &ShapeBins,
    order: BTreeMap<String, u64>,
    inverted: u64,
    judgement: &Judgement,
) -> ShapeSummary {
    let is_solid = shape.dimension() == 3;
    let mut found = ShapeSummary {
        count: statistics.count,
        order,
        area: (!is_solid).then_some(statistics.extent),
        volume: is_solid.then_some(statistics.extent),
        inverted,
        degenerate: statistics.degenerate.count,
        measures: BTreeMap::new(),
        correlation: BTreeMap::new(),
        ordering: BTreeMap::new(),
    };
    for (subject, what) in measures::subjects(shape).iter().enumerate() {
        let moments = &statistics.subjects[subject];
        let rows = what.family.measures();
        for (i, row) in rows.iter().enumerate() {
            let further = judgement.probabilities(row.code, shape);
            let summary = measure_summary(what.on, moments, i, &bins.measures[subject][i], &further);
            found.measures.insert(row.code.to_owned(), summary);
            for (j, other) in rows.iter().enumerate().skip(i + 1) {
                found.correlation.insert(format!("{} {}", row.code, other.code), moments.correlation(i, j));
            }
        }
        if what.family == Family::Tetrahedron {
            let share = statistics.ordered as f64 / statistics.count as f64;
            found.ordering.insert("M32>=M34>=M31>=M33".to_owned(), share);
        }
    }
    found
}

fn measure_summary(
    on: &'static str,
    moments: &Moments,
    value: usize,
    bins: &super::measure::MeasureBins,
    further_quantiles: &[f64],
) -> MeasureSummary {
    let extremes = &moments.extremes[value];
    MeasureSummary {
        on: Cow::Borrowed(on),
        count: moments.count,
        max: extremes.max,
        min: extremes.min,
        min_element: extremes.min_label,
        mean: moments.mean[value].clamp(extremes.min, extremes.max),
        sd: moments.sd(value),
        quantiles: bins.scores.quantiles(further_quantiles, extremes.min, extremes.max),
        histogram: bins.scores.bins().to_vec(),
        worst: Vec::new(),
        below: bins.below.iter().map(|(limit, count)| (limit.to_string(), *count)).collect(),
    }
}

/// Which shapes are stored with negative orientation as a whole. Of either dimension the majority of the mesh decides; a
/// shape that the format's writers disagree about (VTK changed its own mind about wedges in 9.7) decides for itself.
fn reversed_shapes(format: &dyn Format, shapes: &ByShape) -> Reversed {
    let own = |shape: Shape| format.own_orientation().contains(&shape);
    Shape::ALL.map(|shape| {
        let peers = Shape::ALL.into_iter().filter(|other| {
            if own(shape) { *other == shape } else { !own(*other) && other.dimension() == shape.dimension() }
        });
        let found: Vec<_> = peers.filter_map(|peer| shapes[peer.index()].as_deref()).collect();
        let negative: u64 = found.iter().map(|peer| peer.negative.count).sum();
        let positive: u64 = found.iter().map(|peer| peer.positive.count).sum();
        negative > positive
    })
}

/// Elements of a shape that are oriented against the rest of the mesh.
fn inverted(statistics: &ShapeStatistics, reversed: bool) -> Hits {
    if reversed { statistics.positive } else { statistics.negative }
}

fn order(ledger: &Ledger, shape: Shape) -> BTreeMap<String, u64> {
    let mut orders = BTreeMap::new();
    for row in ledger.types.iter().filter(|row| row.count > 0) {
        if let Class::Measured { shape: its, order, .. } = &row.class
            && *its == shape
        {
            *orders.entry(order.to_string()).or_default() += row.count;
        }
    }
    orders
}

fn totals(shapes: &BTreeMap<Shape, ShapeSummary>) -> Totals {
    let total = |extents: Vec<f64>| (!extents.is_empty()).then(|| extents.iter().sum());
    let volume = total(shapes.values().filter_map(|shape| shape.volume).collect());
    let area = total(shapes.values().filter_map(|shape| shape.area).collect());
    Totals { area: if volume.is_some() { None } else { area }, volume }
}

fn sizes(found: &Found<'_>, dimension: usize) -> Sizes {
    let mut edges: Option<[f64; 2]> = None;
    let mut size = Moments::default();
    let mut spread = Spread::up_to(found.nodes.bounds().diagonal());
    for shape in Shape::ALL.into_iter().filter(|shape| shape.dimension() == dimension) {
        if let (Some(statistics), Some(bins)) = (&found.merged.shapes[shape.index()], found.bins.shape(shape))
        {
            size.merge(&statistics.size);
            spread.merge(&bins.size);
            edges = match (edges, statistics.edges) {
                (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
                (a, b) => a.or(b),
            };
        }
    }
    let extremes = &size.extremes[0];
    Sizes {
        edge_length: edges.map(|[min, max]| Range { min, max }),
        element_size: (size.count > 0).then(|| SizeSummary {
            min: extremes.min,
            max: extremes.max,
            mean: size.mean[0].clamp(extremes.min, extremes.max),
            quantiles: spread.quantiles(&[], extremes.min, extremes.max),
        }),
    }
}

fn checks(found: &Found<'_>, reversed: &Reversed) -> Checks {
    let ledger = &found.merged.ledger;
    let mut checks = Checks {
        missing_nodes: ledger.missing_nodes,
        repeated_nodes: ledger.repeated_nodes,
        ghost_elements: ledger.ghost_elements,
        unused_nodes: found.nodes.unused(),
        duplicate_elements: found.merged.duplicate_elements,
        coincident_nodes: found.merged.coincident_nodes,
        ..Checks::default()
    };
    for (statistics, reversed) in found.merged.shapes.iter().zip(reversed) {
        let Some(statistics) = statistics else { continue };
        checks.inverted += inverted(statistics, *reversed).count;
        checks.degenerate += statistics.degenerate.count;
        checks.concave_faces += statistics.concave;
        checks.crossed_faces += statistics.crossed;
        checks.reversed += if *reversed { statistics.negative.count } else { 0 };
    }
    checks
}

/// Says which element to look at first where the verdict only counted.
fn name_first_elements(found: &Found<'_>, reversed: &Reversed, summary: &mut Summary) {
    for reason in &mut summary.verdict.reasons {
        if let (None, Some(shape)) = (reason.element, reason.shape)
            && let Some(statistics) = &found.merged.shapes[shape.index()]
        {
            reason.element = match &*reason.rule {
                rules::INVERTED => inverted(statistics, reversed[shape.index()]).first,
                rules::DEGENERATE => statistics.degenerate.first,
                _ => None,
            };
        }
    }
}

/// Leaves only the measures that were asked for: the mesh was judged by all of them.
fn keep_measures(summary: &mut Summary, wanted: &[String]) {
    if wanted.is_empty() {
        return;
    }
    let is_wanted = |code: &str| wanted.iter().any(|w| w == code);
    for shape in summary.shapes.values_mut() {
        shape.measures.retain(|code, _| is_wanted(code));
        shape.correlation.retain(|pair, _| pair.split(' ').all(is_wanted));
    }
    let regions = summary.regions.iter_mut().flat_map(|regions| &mut regions.list);
    for shape in regions.flat_map(|region| region.shapes.values_mut()) {
        shape.measures.retain(|code, _| is_wanted(code));
    }
}

fn run(found: &Found<'_>) -> Run {
    let seconds = found.started.1.elapsed().as_secs_f64();
    let measured: u64 = found.merged.shapes.iter().flatten().map(|s| s.count).sum();
    Run {
        meshgauge: Cow::Borrowed(env!("CARGO_PKG_VERSION")),
        host: rustix::system::uname().nodename().to_string_lossy().into_owned(),
        started: humantime::format_rfc3339_millis(found.started.0).to_string(),
        seconds,
        threads: found.threads,
        peak_rss_bytes: peak_resident_bytes(),
        elements_per_second: measured as f64 / seconds,
    }
}

/// Peak resident memory of this process, 0 where the system does not tell.
fn peak_resident_bytes() -> u64 {
    use std::io::{BufRead, BufReader};
    let Ok(file) = std::fs::File::open("/proc/self/status") else { return 0 };
    let line = BufReader::new(file)
        .lines()
        .map_while(std::result::Result::ok)
        .find(|line| line.starts_with("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}
