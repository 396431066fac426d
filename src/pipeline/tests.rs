//! The pipeline against a made-up format: same bytes for any number of threads and any budget, the first error in
//! the file for any number of threads, and no hang.

use std::io::Write;
use std::ops::Range;
use std::sync::{Arc, LazyLock};

use super::join::{Join, Local};
use super::locality::{Used, locality};
use super::nodes::read_nodes;
use super::run::{budget, run_as};
use super::{Options, Progress};
use crate::error::{At, Error, Result};
use crate::formats::{ElementLayout, ElementSink, Format, NodeBatch, NodeLayout, Outline, Piece, Plan};
use crate::input::{Budget, Input, Limits, Scratch, Source, Spot};
use crate::mesh::{ElementType, NodesBuilder, Shape};
use crate::summary::Summary;

/// A box of hexahedra, `SIDE` along each axis, each followed by one tetrahedron of its corners.
const SIDE: u64 = 24;
const PER_PIECE: usize = 1000;

struct Lattice {
    /// Pieces of elements that fail.
    bad: &'static [u64],
    /// Pieces of nodes that fail.
    bad_nodes: &'static [u64],
    /// The piece of nodes that panics.
    panics: Option<u64>,
    /// Whether element pieces come before node pieces.
    elements_first: bool,
}

struct Layout {
    source: Arc<Source>,
    bad: &'static [u64],
    bad_nodes: &'static [u64],
    panics: Option<u64>,
}

impl Format for Lattice {
    fn name(&self) -> &'static str {
        "lattice"
    }
    fn title(&self) -> &'static str {
        "made up"
    }
    fn extensions(&self) -> &'static [&'static str] {
        &["lattice"]
    }
    fn looks_for(&self) -> &'static str {
        "nothing"
    }
    fn detect(&self, _head: &[u8]) -> bool {
        false
    }
    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let Lattice { bad, bad_nodes, panics, .. } = *self;
        let layout = Arc::new(Layout { source: Arc::clone(&input.source), bad, bad_nodes, panics });
        let pieces =
            |count: u64| (0..count).step_by(PER_PIECE).map(move |k| k..(k + PER_PIECE as u64).min(count));
        let nodes = |out: &mut dyn Outline| {
            pieces((SIDE + 1).pow(3)).try_for_each(|span| out.nodes(Piece { layout: layout.clone(), span }))
        };
        let elements = |out: &mut dyn Outline| {
            pieces(SIDE.pow(3)).try_for_each(|span| out.elements(Piece { layout: layout.clone(), span }))
        };
        if self.elements_first {
            elements(out)?;
            nodes(out)
        } else {
            nodes(out)?;
            elements(out)
        }
    }
}

impl NodeLayout for Layout {
    fn source(&self) -> &Source {
        &self.source
    }
    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let number = span.start / PER_PIECE as u64;
        assert_ne!(self.panics, Some(number), "as the test asks for");
        if self.bad_nodes.contains(&number) {
            out.at = Spot::Binary(span.start);
            return Err(Error::malformed("a node", "noise"));
        }
        for k in span {
            let at = [k % (SIDE + 1), k / (SIDE + 1) % (SIDE + 1), k / (SIDE + 1).pow(2)].map(|i| i as f64);
            // Bent a little, so that no two elements are alike.
            let bend = |t: f64| t + 0.3 * (0.7 * at[0] + 1.3 * at[1] + 0.9 * at[2]).sin();
            out.push(10 * k + 7, [bend(at[0]), at[1], bend(at[2])])?;
        }
        Ok(())
    }
}

static HEXAHEDRON: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::measured("brick", Shape::Hexahedron, 1, 8)));
static TETRAHEDRON: LazyLock<Arc<ElementType>> =
    LazyLock::new(|| Arc::new(ElementType::measured("tet", Shape::Tetrahedron, 1, 4)));

impl ElementLayout for Layout {
    fn source(&self) -> &Source {
        &self.source
    }
    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        if self.bad.contains(&(span.start / PER_PIECE as u64)) {
            out.at = Spot::Binary(span.start);
            return Err(Error::malformed("an element", "noise"));
        }
        for k in span {
            let (i, j, l) = (k % SIDE, k / SIDE % SIDE, k / SIDE.pow(2));
            let id = |i: u64, j: u64, l: u64| 10 * (i + (SIDE + 1) * (j + (SIDE + 1) * l)) + 7;
            let ring = |l: u64| [id(i, j, l), id(i + 1, j, l), id(i + 1, j + 1, l), id(i, j + 1, l)];
            let corners = [ring(l), ring(l + 1)].concat();
            out.element(2 * k, &HEXAHEDRON, &corners)?;
            out.element(2 * k + 1, &TETRAHEDRON, &[corners[0], corners[1], corners[3], corners[4]])?;
        }
        Ok(())
    }
}

const SOUND: Lattice = Lattice { bad: &[], bad_nodes: &[], panics: None, elements_first: false };

fn lattice(format: &'static Lattice, threads: usize, memory: u64) -> Result<Summary> {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(&[7; 100]).expect("room for it");
    let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
    let mut input = Input::open(file.path(), &Limits::default(), &scratch)?;
    let options = Options { threads, memory, run_info: false, ..Options::default() };
    input.memory = budget(&options);
    run_as(&input, format, &options, None)
}

fn text(mut summary: Summary) -> String {
    summary.mesh.name = String::new();
    summary.mesh.path = String::new();
    summary.to_json()
}

#[test]
fn the_summary_does_not_depend_on_threads_or_memory() {
    static FORMAT: Lattice = SOUND;
    static TURNED: Lattice = Lattice { elements_first: true, ..SOUND };
    let first = lattice(&FORMAT, 1, 256 << 20).expect("a sound mesh");
    assert_eq!(first.nodes.count, (SIDE + 1).pow(3));
    assert_eq!(first.nodes.unused, 0);
    assert_eq!(first.shapes[&Shape::Hexahedron].count, SIDE.pow(3));
    assert_eq!(first.shapes[&Shape::Hexahedron].measures["M22"].count, 6 * SIDE.pow(3));
    assert_eq!(first.shapes[&Shape::Tetrahedron].measures["M33"].histogram.iter().sum::<u64>(), SIDE.pow(3));
    let first = text(first);
    for threads in [1, 2, 7] {
        for memory in [0, 1 << 20, 1 << 30] {
            assert_eq!(text(lattice(&FORMAT, threads, memory).expect("sound")), first, "{threads} {memory}");
            assert_eq!(text(lattice(&TURNED, threads, memory).expect("sound")), first, "{threads} {memory}");
        }
    }
}

#[test]
fn a_join_brings_each_piece_the_points_of_its_rows() {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(&[7; 100]).expect("room for it");
    let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
    let input = Input::open(file.path(), &Limits::default(), &scratch).expect("a file");
    let mut plan = Plan::default();
    SOUND.outline(&input, &mut plan).expect("sound");
    let builder = NodesBuilder::new(&Budget::new(0), &scratch);
    let nodes = read_nodes(&plan.nodes, 2, builder, &Progress::default()).expect("sound");
    assert!(nodes.is_spilled());
    let options = Options::default();
    let found = locality(&plan.elements, &nodes, &options).expect("enough pieces");
    assert!(found.paged < found.joined, "the lattice is in order: {found:?}");
    for threads in [1, 3] {
        let join = Join::new(&plan.elements, &nodes, threads, 0, &scratch, &options).expect("scratch");
        assert_eq!(join.blocks(), 4);
        let (mut local, mut used) = (Local::default(), Used::default());
        for (number, piece) in plan.elements.iter().enumerate() {
            used.read(piece, number, &nodes, &options).expect("sound");
            join.read(number, &mut local).expect("scratch");
            assert_eq!(local.points().len(), used.rows().len());
            let mut rows = used.rows().to_vec();
            local.localise(&mut rows);
            for (row, place) in used.rows().iter().zip(rows) {
                assert_eq!(local.points()[place as usize], nodes.rows()[*row as usize]);
            }
        }
    }
}

#[test]
fn the_first_bad_piece_in_the_file_gives_the_error() {
    static FORMAT: Lattice = Lattice { bad: &[3, 4, 9], ..SOUND };
    for run in 0..60 {
        let error = lattice(&FORMAT, 1 + run % 7, 1 << 20).expect_err("piece 3 is bad");
        assert_eq!(error.place(), Some(At::Byte(3 * PER_PIECE as u64)), "{error}");
        assert_eq!(error.format(), Some("lattice"));
    }
}

/// There are far more pieces of nodes than batches: whoever waited for an empty one waited for ever.
#[test]
fn a_bad_node_ends_the_run_however_many_pieces_follow() {
    static FORMAT: Lattice = Lattice { bad_nodes: &[2, 5], ..SOUND };
    for run in 0..60 {
        let error = lattice(&FORMAT, 1 + run % 7, 1 << 20).expect_err("piece 2 is bad");
        assert_eq!(error.place(), Some(At::Byte(2 * PER_PIECE as u64)), "{error}");
    }
}

#[test]
fn a_panic_among_the_nodes_ends_the_run() {
    static FORMAT: Lattice = Lattice { panics: Some(2), ..SOUND };
    for threads in 1..5 {
        assert!(std::panic::catch_unwind(|| lattice(&FORMAT, threads, 1 << 20)).is_err());
    }
}
