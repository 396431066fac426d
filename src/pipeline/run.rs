//! One run, from top to bottom: find the format, outline the file, read the nodes, measure the elements, sum up.

use std::time::{Instant, SystemTime};

use super::assemble::{Found, assemble};
use super::duplicates::{Fingerprints, coincident_nodes};
use super::elements::{chunks_in_flight, measure_elements};
use super::listing::Listing;
use super::nodes::read_nodes;
use super::{Options, Progress};
use crate::error::{Error, Kind, Result};
use crate::formats::{self, FORMATS, Format, HEAD_BYTES, Plan};
use crate::input::{Budget, Input, looks_like};
use crate::mesh::{CHUNK, ElementWriter, NodesBuilder, Regions, Shape};
use crate::summary::Summary;

/// Most names of regions, where there are no statistics of them.
const MOST_NAMES: usize = 1 << 20;

/// Scores an open mesh.
pub(super) fn run(
    input: &Input,
    options: &Options,
    writer: Option<&mut dyn ElementWriter>,
) -> Result<Summary> {
    run_as(input, choose(input, options.format.as_deref())?, options, writer)
}

/// Scores an open mesh as one of the given format.
pub(super) fn run_as(
    input: &Input,
    format: &'static dyn Format,
    options: &Options,
    writer: Option<&mut dyn ElementWriter>,
) -> Result<Summary> {
    let started = (SystemTime::now(), Instant::now());
    let named = |error: Error| error.in_format(format.name()).in_file(input.path());
    let quiet = Progress::default();
    let progress = options.progress.as_deref().unwrap_or(&quiet);
    let threads = options.threads.max(1);

    input.begin_hash();
    // Statistics by region cost memory, names hardly any.
    let regions = Regions::new(if options.by_region { options.most_regions } else { MOST_NAMES });
    let (nodes, merged, bins) =
        measure(input, format, options, writer, &regions, threads, progress).map_err(named)?;
    let hash = input.xxh3();
    let found =
        Found { input, format, hash, nodes: &nodes, regions: &regions, merged, bins, threads, started };
    assemble(found, options)
}

/// Nodes first, then elements.
fn measure(
    input: &Input,
    format: &dyn Format,
    options: &Options,
    mut writer: Option<&mut dyn ElementWriter>,
    regions: &Regions,
    threads: usize,
    progress: &Progress,
) -> Result<(crate::mesh::Nodes, super::merge::Merged, super::measure::Bins)> {
    progress.of_bytes(input.source.len());
    let mut plan = Plan::default();
    format.outline(input, &mut plan)?;
    progress.expect((plan.nodes.len() + plan.elements.len()) as u64);
    tracing::debug!(
        format = format.name(),
        node_pieces = plan.nodes.len(),
        element_pieces = plan.elements.len(),
        "outlined"
    );
    let builder = NodesBuilder::new(&input.memory, &input.scratch);
    let nodes = read_nodes(&plan.nodes, threads, builder, progress)?;
    tracing::debug!(nodes = nodes.count(), spilled = nodes.is_spilled(), "nodes read");
    let listing = writer.as_deref_mut().map(|writer| Listing::new(writer, regions));
    let bytes = input.source.len();
    let mut prints = options.all_checks.then(|| Fingerprints::new(bytes, &input.scratch)).transpose()?;
    let prints_in = prints.as_mut();
    let (mut merged, bins) =
        measure_elements(&plan.elements, &nodes, input, options, listing, prints_in, regions, progress)?;
    if let Some(prints) = prints {
        merged.duplicate_elements = Some(prints.repeated()?);
        merged.coincident_nodes = Some(coincident_nodes(&nodes, bytes, &input.scratch)?);
    }
    if let Some(writer) = writer {
        writer.finish(&nodes)?;
    }
    merged.ledger.merge(&plan.ledger);
    Ok((nodes, merged, bins))
}

/// The memory that is left for tables once the chunks in flight have theirs.
pub(super) fn budget(options: &Options) -> Budget {
    Budget::new(options.memory.saturating_sub(buffer_bytes(options.threads.max(1))))
}

/// Memory of the chunks in flight.
fn buffer_bytes(threads: usize) -> u64 {
    (chunks_in_flight(threads) * CHUNK * (4 * Shape::MAX_CORNERS + 8)) as u64
}

/// The format that the caller named, or the first that knows the content.
fn choose(input: &Input, name: Option<&str>) -> Result<&'static dyn Format> {
    if let Some(name) = name {
        return formats::find(name).ok_or_else(|| {
            let known: Vec<_> = FORMATS.iter().map(|format| format.name()).collect();
            Error::usage(format!("there is no format {name:?}; known are {}", known.join(", ")))
        });
    }
    let head = input.source.peek(0..HEAD_BYTES as u64);
    FORMATS.iter().copied().find(|format| format.knows(input)).ok_or_else(|| {
        let mut text = match looks_like(head).or_else(|| formats::foreign(head)) {
            Some(what) => format!("expected a mesh, found {what}; looked for:"),
            None => "expected a mesh of a known format; looked for:".to_owned(),
        };
        for format in FORMATS {
            text.push_str(&format!(" {} ({});", format.name(), format.looks_for()));
        }
        text.pop();
        Error::new(Kind::UnknownFormat(text)).in_file(input.path())
    })
}
