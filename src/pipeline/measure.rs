//! The measure stage: a chunk of elements becomes statistics.
//!
//! Doubles go into [`ShapeStatistics`], which the merge stage puts in order; whole numbers go into the worker's own
//! [`Bins`], which may be added in any order.

use crate::measures::{
    self, Corner, Family, Geometry, LANES, Lanes, MOST_MEASURES, QuadrilateralFlaws, Subject,
};
use crate::mesh::{CHUNK, Chunk, Nodes, Origin, Shape};
use crate::statistics::{Histogram, MOST, Moments, Spread, sum};
use crate::summary::Judgement;

/// The most subjects of a shape: triangular and quadrilateral faces.
pub(super) const SUBJECTS: usize = 2;

/// What was found in elements of one shape, all but the bins.
#[derive(Debug, Clone, Default)]
pub(super) struct ShapeStatistics {
    /// Number of elements.
    pub count: u64,
    /// Sum of areas, or of volumes as magnitudes.
    pub extent: f64,
    /// Moments of the measures, by subject.
    pub subjects: [Moments; SUBJECTS],
    /// Moments of the element sizes.
    pub size: Moments,
    /// Edge lengths: minus the smallest, and the largest, so that both grow.
    pub edges: Option<[f64; 2]>,
    /// Elements by the sign of their orientation, and the first of each.
    pub positive: Hits,
    /// Negative ones.
    pub negative: Hits,
    /// Degenerate ones.
    pub degenerate: Hits,
    /// Tetrahedra whose measures stand in the order M32 >= M34 >= M31 >= M33.
    pub ordered: u64,
    /// Quadrilateral faces with a re-entrant corner.
    pub concave: u64,
    /// Quadrilateral faces two of whose sides cross.
    pub crossed: u64,
}

/// How many, and the number of the first.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Hits {
    pub count: u64,
    pub first: Option<u64>,
}

impl Hits {
    fn add(&mut self, label: u64) {
        self.count += 1;
        self.first.get_or_insert(label);
    }

    fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.first = self.first.or(other.first);
    }
}

impl ShapeStatistics {
    /// Takes in what was found in elements that come after these.
    pub(super) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.extent += other.extent;
        for (mine, theirs) in self.subjects.iter_mut().zip(&other.subjects) {
            mine.merge(theirs);
        }
        self.size.merge(&other.size);
        self.edges = match (self.edges, other.edges) {
            (Some(mine), Some(theirs)) => Some([mine[0].min(theirs[0]), mine[1].max(theirs[1])]),
            (mine, theirs) => mine.or(theirs),
        };
        self.positive.merge(&other.positive);
        self.negative.merge(&other.negative);
        self.degenerate.merge(&other.degenerate);
        self.ordered += other.ordered;
        self.concave += other.concave;
        self.crossed += other.crossed;
    }
}

/// Bins of one worker, by shape; a shape that was not met has none.
#[derive(Debug)]
pub(super) struct Bins {
    shapes: [Option<Box<ShapeBins>>; Shape::ALL.len()],
    /// No edge is longer.
    diagonal: f64,
    /// Says which thresholds are counted.
    judgement: Judgement,
}

/// Bins of one shape.
#[derive(Debug)]
pub(super) struct ShapeBins {
    /// By subject and measure.
    pub measures: Vec<Vec<MeasureBins>>,
    /// Element sizes.
    pub size: Spread,
}

/// Bins of one measure.
#[derive(Debug)]
pub(super) struct MeasureBins {
    pub histogram: Histogram,
    pub spread: Spread,
    /// Number of values under a threshold, by threshold.
    pub below: Vec<(f64, u64)>,
}

impl Bins {
    /// Empty bins for a mesh whose bounds have the given diagonal.
    pub(super) fn new(diagonal: f64, judgement: &Judgement) -> Self {
        Self { shapes: [const { None }; Shape::ALL.len()], diagonal, judgement: judgement.clone() }
    }

    /// The bins of a shape, if it was met.
    pub(super) fn shape(&self, shape: Shape) -> Option<&ShapeBins> {
        self.shapes[shape.index()].as_deref()
    }

    fn shape_mut(&mut self, shape: Shape) -> &mut ShapeBins {
        self.shapes[shape.index()].get_or_insert_with(|| {
            let of = |subject: &Subject| {
                let bins = |code| MeasureBins {
                    histogram: Histogram::default(),
                    spread: Spread::of_unit(),
                    below: self
                        .judgement
                        .thresholds(code, shape)
                        .into_iter()
                        .map(|limit| (limit, 0))
                        .collect(),
                };
                subject.family.measures().iter().map(|measure| bins(measure.code)).collect()
            };
            let measures = measures::subjects(shape).iter().map(of).collect();
            Box::new(ShapeBins { measures, size: Spread::up_to(self.diagonal) })
        })
    }

    /// Adds the counts of another worker.
    pub(super) fn merge(&mut self, other: Self) {
        for (mine, theirs) in self.shapes.iter_mut().zip(other.shapes) {
            match (mine, theirs) {
                (Some(mine), Some(theirs)) => mine.merge(&theirs),
                (mine, theirs) => *mine = mine.take().or(theirs),
            }
        }
    }
}

impl ShapeBins {
    fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.measures.iter_mut().flatten().zip(other.measures.iter().flatten()) {
            mine.histogram.merge(&theirs.histogram);
            mine.spread.merge(&theirs.spread);
            mine.below.iter_mut().zip(&theirs.below).for_each(|(mine, theirs)| mine.1 += theirs.1);
        }
        self.size.merge(&other.size);
    }
}

/// Room for one block of elements, reused.
pub(super) struct Workspace {
    corners: [Corner; Shape::MAX_CORNERS],
    geometry: Geometry,
    scores: [Lanes; MOST_MEASURES],
    flaws: QuadrilateralFlaws,
}

impl Workspace {
    pub(super) fn new() -> Box<Self> {
        Box::new(Self {
            corners: [[[0.0; LANES]; 3]; Shape::MAX_CORNERS],
            geometry: Geometry::default(),
            scores: [[0.0; LANES]; MOST_MEASURES],
            flaws: QuadrilateralFlaws::default(),
        })
    }
}

/// Measures a chunk.
pub(super) fn measure(
    chunk: &Chunk,
    nodes: &Nodes,
    work: &mut Workspace,
    bins: &mut Bins,
) -> ShapeStatistics {
    let shape = chunk.shape();
    let signed = shape.dimension() == 3 || nodes.is_planar();
    let bins = bins.shape_mut(shape);
    let mut found = ShapeStatistics { count: chunk.len() as u64, ..Default::default() };
    let position = position(chunk.origin());
    let blocks = chunk.rows().chunks(LANES * shape.corners()).zip(chunk.labels().chunks(LANES));
    for (number, (rows, labels)) in blocks.enumerate() {
        // Meshes are numbered less well than one hopes: without this a third of the time goes by waiting for nodes.
        let next = chunk.rows().iter().skip((number + 1) * LANES * shape.corners());
        next.take(LANES * shape.corners()).for_each(|row| nodes.prefetch(*row));
        gather(rows, nodes.rows(), shape.corners(), &mut work.corners);
        let first = position + (number * LANES) as u64;
        measure_elements(shape, labels, signed, first, work, bins, &mut found);
        for subject in 0..measures::subjects(shape).len() {
            measure_subject(shape, subject, labels.len(), first, work, bins, &mut found);
        }
    }
    // Positions decided between equal minima inside the chunk; from here on the element's number goes along.
    for extremes in found.subjects.iter_mut().flat_map(|m| &mut m.extremes).filter(|e| e.min_at != u64::MAX) {
        extremes.min_label = chunk.labels()[(extremes.min_at - position) as usize];
    }
    found
}

/// The position in the file of a chunk's first element, among elements of its shape.
fn position(origin: Origin) -> u64 {
    const { assert!(CHUNK == 1 << 12) };
    (origin.piece << 32) | (u64::from(origin.chunk) << 12)
}

/// Puts the corners of a block of elements side by side. Lanes without an element keep what they had.
fn gather(rows: &[u32], points: &[[f64; 3]], corners: usize, out: &mut [Corner; Shape::MAX_CORNERS]) {
    for (lane, rows) in rows.chunks_exact(corners).enumerate() {
        for (row, corner) in rows.iter().zip(out.iter_mut()) {
            let point = &points[*row as usize];
            corner[0][lane] = point[0];
            corner[1][lane] = point[1];
            corner[2][lane] = point[2];
        }
    }
}

/// Sizes, orientation and degeneracy of whole elements.
fn measure_elements(
    shape: Shape,
    labels: &[u64],
    signed: bool,
    first: u64,
    work: &mut Workspace,
    bins: &mut ShapeBins,
    found: &mut ShapeStatistics,
) {
    let n = labels.len();
    let geometry = &mut work.geometry;
    measures::geometry(shape, &work.corners[..shape.corners()], geometry);
    geometry.extent[..n].iter_mut().for_each(|extent| *extent = extent.abs());
    found.extent += sum(&geometry.extent[..n]);
    found.size.merge(&Moments::of(&[&geometry.size[..n]], first));
    geometry.size[..n].iter().for_each(|size| bins.size.record(*size));
    let shortest = geometry.shortest[..n].iter().copied().fold(f64::INFINITY, f64::min);
    let longest = geometry.longest[..n].iter().copied().fold(0.0, f64::max);
    let edges = found.edges.get_or_insert([shortest, longest]);
    *edges = [edges[0].min(shortest), edges[1].max(longest)];
    for (lane, label) in labels.iter().enumerate() {
        if geometry.degenerate[lane] {
            found.degenerate.add(*label);
        } else if signed && geometry.sign[lane] > 0.0 {
            found.positive.add(*label);
        } else if signed && geometry.sign[lane] < 0.0 {
            found.negative.add(*label);
        }
    }
}

/// The measures of a subject: of the elements themselves or of each of their faces.
fn measure_subject(
    shape: Shape,
    subject: usize,
    n: usize,
    first: u64,
    work: &mut Workspace,
    bins: &mut ShapeBins,
    found: &mut ShapeStatistics,
) {
    let Workspace { corners, scores, flaws, .. } = work;
    let bins = &mut bins.measures[subject];
    let moments = &mut found.subjects[subject];
    let facts = shape.facts();
    match measures::subjects(shape)[subject].family {
        Family::Triangle => {
            for face in facts.triangles {
                measures::triangles(face.map(|c| &corners[c]), scores);
                record(scores, n, first, bins, moments);
            }
        }
        Family::Quadrilateral => {
            for face in facts.quadrilaterals {
                let face = face.map(|c| &corners[c]);
                measures::quadrilaterals(face, scores.first_chunk_mut().expect("three of five rows"));
                record(scores, n, first, bins, moments);
                measures::quadrilateral_flaws(face, flaws);
                found.concave += count(&flaws.concave[..n]);
                found.crossed += count(&flaws.crossing[..n]);
            }
        }
        Family::Tetrahedron => {
            let element = [0, 1, 2, 3].map(|c| &corners[c]);
            measures::tetrahedra(element, scores.first_chunk_mut().expect("four of five rows"));
            record(scores, n, first, bins, moments);
            found.ordered += (0..n).filter(|lane| in_order(scores, *lane)).count() as u64;
        }
    }
}

/// Whether a tetrahedron's measures stand in the order that the report found in about nine of ten:
/// M32 >= M34 >= M31 >= M33.
fn in_order(scores: &[Lanes], lane: usize) -> bool {
    let [m31, m32, m33, m34] = [0, 1, 2, 3].map(|m| scores[m][lane]);
    m32 >= m34 && m34 >= m31 && m31 >= m33
}

fn count(flags: &[bool]) -> u64 {
    flags.iter().map(|flag| u64::from(*flag)).sum()
}

/// Takes the scores of one block into bins and moments.
fn record(scores: &[Lanes], n: usize, first: u64, bins: &mut [MeasureBins], moments: &mut Moments) {
    let mut columns: [&[f64]; MOST] = [&[]; MOST];
    for ((column, row), bins) in columns.iter_mut().zip(scores).zip(bins.iter_mut()) {
        *column = &row[..n];
        for score in *column {
            bins.histogram.record(*score);
            bins.spread.record(*score);
        }
        for (limit, count) in &mut bins.below {
            *count += column.iter().filter(|score| **score < *limit).count() as u64;
        }
    }
    moments.merge(&Moments::of(&columns[..bins.len()], first));
}
