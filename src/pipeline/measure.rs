//! The measure stage: a chunk of elements becomes statistics.
//!
//! Doubles go into [`ShapeStatistics`], which the merge stage puts in order; whole numbers go into the worker's own
//! [`Bins`], which may be added in any order.

use super::Options;
use super::each::{Block, ByRegion, Each, Rows};
use super::worst::Worst;
use crate::measures::{
    self, Corner, Family, Geometry, LANES, Lanes, MOST_MEASURES, QuadrilateralFlaws, Subject,
};
use crate::mesh::{CHUNK, Chunk, Frame, Origin, Shape, gather, prefetch};
use crate::statistics::{Distribution, MOST, Moments, Spread, sum};
use crate::summary::Judgement;
use crate::width::{Wide, at_widest};

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
    /// Elements that enclose the axis of the frame.
    pub enclosing_axis: u64,
    /// By region, where that was asked for.
    pub regions: ByRegion,
}

/// How many, and the number of the first.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Hits {
    pub count: u64,
    pub first: Option<u64>,
}

impl Hits {
    /// Adds the elements whose flag is set.
    #[inline(always)]
    fn add(&mut self, flags: &[bool], labels: &[u64]) {
        let more = count(flags);
        if more > 0 {
            self.count += more;
            let first = flags.iter().position(|flag| *flag).and_then(|lane| labels.get(lane));
            self.first = self.first.or(first.copied());
        }
    }

    pub(super) fn merge(&mut self, other: &Self) {
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
        self.enclosing_axis += other.enclosing_axis;
        for (region, theirs) in &other.regions {
            self.regions.entry(*region).or_default().merge(theirs);
        }
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
    /// How many of the worst elements are kept a measure.
    worst: usize,
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
    pub scores: Distribution,
    /// Number of values under a threshold, by threshold.
    pub below: Vec<(f64, u64)>,
    pub worst: Worst,
}

impl Bins {
    /// Empty bins for a mesh whose bounds have the given diagonal.
    pub(super) fn new(diagonal: f64, options: &Options) -> Self {
        let (judgement, worst) = (options.judgement.clone(), options.worst);
        Self { shapes: [const { None }; Shape::ALL.len()], diagonal, judgement, worst }
    }

    /// The bins of a shape, if it was met.
    pub(super) fn shape(&self, shape: Shape) -> Option<&ShapeBins> {
        self.shapes[shape.index()].as_deref()
    }

    fn shape_mut(&mut self, shape: Shape) -> &mut ShapeBins {
        self.shapes[shape.index()].get_or_insert_with(|| {
            let of = |subject: &Subject| {
                let bins = |code| MeasureBins {
                    scores: Distribution::default(),
                    worst: Worst::new(self.worst),
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
            mine.scores.merge(&theirs.scores);
            mine.worst.merge(&theirs.worst);
            mine.below.iter_mut().zip(&theirs.below).for_each(|(mine, theirs)| mine.1 += theirs.1);
        }
        self.size.merge(&other.size);
    }
}

/// Room for one block of elements, reused.
pub(super) struct Workspace {
    /// What measures look at, where it is not what the file has.
    frame: Option<Frame>,
    corners: [Corner; Shape::MAX_CORNERS],
    geometry: Geometry,
    scores: [Lanes; MOST_MEASURES],
    flaws: QuadrilateralFlaws,
    /// Where somebody asked for single elements.
    each: Option<Box<Each>>,
}

impl Workspace {
    pub(super) fn new(frame: Frame, each: Option<Box<Each>>) -> Box<Self> {
        Box::new(Self {
            frame: (frame != Frame::OWN).then_some(frame),
            each,
            corners: [[[0.0; LANES]; 3]; Shape::MAX_CORNERS],
            geometry: Geometry::default(),
            scores: [[0.0; LANES]; MOST_MEASURES],
            flaws: QuadrilateralFlaws::default(),
        })
    }
}

/// Measures a chunk; the single elements come along where somebody takes them.
pub(super) fn measure(
    chunk: &Chunk,
    points: &[[f64; 3]],
    planar: bool,
    work: &mut Workspace,
    bins: &mut Bins,
) -> (ShapeStatistics, Option<Box<Rows>>) {
    let shape = chunk.shape();
    let signed = shape.dimension() == 3 || planar;
    let bins = bins.shape_mut(shape);
    let mut found = ShapeStatistics { count: chunk.len() as u64, ..Default::default() };
    let position = position(chunk.origin());
    let block = LANES * shape.corners();
    let blocks = chunk.rows().chunks(block).zip(chunk.labels().chunks(LANES));
    for (number, (rows, labels)) in blocks.enumerate() {
        put_side_by_side(shape, rows, points, &mut work.corners);
        // Meshes are numbered less well than one hopes: without this a third of the time goes by waiting for nodes. There is
        // room for a few at a time on their way, so that not all are asked for at once.
        let next = chunk.rows().get((number + 1) * block..).unwrap_or_default();
        let (soon, later) = next[..next.len().min(block)].split_at(next.len().min(block) / 2);
        prefetch(points, soon);
        let first = position + (number * LANES) as u64;
        let tags = chunk.tags().get(number * LANES..).unwrap_or_default();
        let block = Block { shape, rows, labels, tags: &tags[..tags.len().min(LANES)], first };
        if let Some(each) = &mut work.each {
            each.start(&block, &work.corners[..shape.corners()]);
        }
        measure_elements(shape, labels, signed, first, work, bins, &mut found);
        prefetch(points, later);
        if let Some(frame) = &work.frame {
            found.enclosing_axis += frame.apply(&mut work.corners[..shape.corners()], labels.len());
        }
        for subject in 0..measures::subjects(shape).len() {
            measure_subject(subject, &block, work, bins, &mut found);
        }
        if let Some(each) = &mut work.each {
            each.finish(&block, &work.geometry, signed, bins);
        }
    }
    // Positions decided between equal minima inside the chunk; from here on the element's number goes along.
    for extremes in found.subjects.iter_mut().flat_map(|m| &mut m.extremes).filter(|e| e.min_at != u64::MAX) {
        extremes.min_label = chunk.labels()[(extremes.min_at - position) as usize];
    }
    let Some(each) = &mut work.each else { return (found, None) };
    let (regions, rows) = each.take();
    found.regions = regions;
    (found, rows)
}

/// The position in the file of a chunk's first element, among elements of its shape.
fn position(origin: Origin) -> u64 {
    const { assert!(CHUNK == 1 << 12) };
    (origin.piece << 32) | (u64::from(origin.chunk) << 12)
}

/// Puts the corners of a block of elements side by side.
fn put_side_by_side(shape: Shape, rows: &[u32], points: &[[f64; 3]], out: &mut [Corner]) {
    match shape.corners() {
        3 => gather::<3, LANES>(rows, points, out),
        4 => gather::<4, LANES>(rows, points, out),
        5 => gather::<5, LANES>(rows, points, out),
        6 => gather::<6, LANES>(rows, points, out),
        _ => gather::<8, LANES>(rows, points, out),
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
    measures::geometry(shape, &work.corners[..shape.corners()], &mut work.geometry);
    at_widest(TakeElements { labels, signed, first, geometry: &mut work.geometry, bins, found });
}

/// Takes the geometry of one block into bins and statistics.
struct TakeElements<'a> {
    labels: &'a [u64],
    signed: bool,
    first: u64,
    geometry: &'a mut Geometry,
    bins: &'a mut ShapeBins,
    found: &'a mut ShapeStatistics,
}

impl Wide for TakeElements<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { labels, signed, first, geometry, bins, found } = self;
        let n = labels.len();
        geometry.extent[..n].iter_mut().for_each(|extent| *extent = extent.abs());
        found.extent += sum(&geometry.extent[..n]);
        found.size.extend(&[&geometry.size[..n]], first);
        bins.size.record(&geometry.size[..n]);
        let edges = found.edges.get_or_insert([f64::INFINITY, 0.0]);
        *edges = [least(edges[0], &geometry.shortest[..n]), most(edges[1], &geometry.longest[..n])];
        found.degenerate.add(&geometry.degenerate[..n], labels);
        if signed {
            let (mut positive, mut negative) = ([false; LANES], [false; LANES]);
            for lane in 0..LANES {
                let (sign, sound) = (geometry.sign[lane], !geometry.degenerate[lane]);
                positive[lane] = sound & (sign > 0.0);
                negative[lane] = sound & (sign < 0.0);
            }
            found.positive.add(&positive[..n], labels);
            found.negative.add(&negative[..n], labels);
        }
    }
}

/// The smallest of all.
#[inline(always)]
fn least(first: f64, others: &[f64]) -> f64 {
    others.iter().fold(first, |a, b| if *b < a { *b } else { a })
}

/// The largest of all.
#[inline(always)]
fn most(first: f64, others: &[f64]) -> f64 {
    others.iter().fold(first, |a, b| if *b > a { *b } else { a })
}

/// The measures of a subject: of the elements themselves or of each of their faces.
fn measure_subject(
    subject: usize,
    block: &Block<'_>,
    work: &mut Workspace,
    bins: &mut ShapeBins,
    found: &mut ShapeStatistics,
) {
    let Workspace { corners, scores, flaws, each, .. } = work;
    let bins = &mut bins.measures[subject];
    let moments = &mut found.subjects[subject];
    let (facts, n) = (block.shape.facts(), block.labels.len());
    let mut record = |scores: &[Lanes]| {
        record(scores, n, block.first, bins, moments);
        if let Some(each) = each {
            each.record(subject, &scores[..bins.len()], block);
        }
    };
    match measures::subjects(block.shape)[subject].family {
        Family::Triangle => {
            for face in facts.triangles {
                measures::triangles(face.map(|c| &corners[c]), scores);
                record(scores);
            }
        }
        Family::Quadrilateral => {
            for face in facts.quadrilaterals {
                let face = face.map(|c| &corners[c]);
                measures::quadrilaterals(face, scores.first_chunk_mut().expect("three of five rows"));
                record(scores);
                measures::quadrilateral_flaws(face, flaws);
                found.concave += count(&flaws.concave[..n]);
                found.crossed += count(&flaws.crossing[..n]);
            }
        }
        Family::Tetrahedron => {
            let element = [0, 1, 2, 3].map(|c| &corners[c]);
            measures::tetrahedra(element, scores.first_chunk_mut().expect("four of five rows"));
            record(scores);
            found.ordered += at_widest(InOrder(&scores[..4], n));
        }
    }
}

/// How many of the first so many tetrahedra have their measures in the order that the report found in about nine of ten:
/// M32 >= M34 >= M31 >= M33.
struct InOrder<'a>(&'a [Lanes], usize);

impl Wide for InOrder<'_> {
    type Output = u64;

    #[inline(always)]
    fn run(self) -> u64 {
        let [m31, m32, m33, m34] = [0, 1, 2, 3].map(|m| &self.0[m][..self.1]);
        let mut ordered = 0;
        for lane in 0..self.1 {
            let in_order = (m32[lane] >= m34[lane]) & (m34[lane] >= m31[lane]) & (m31[lane] >= m33[lane]);
            ordered += u64::from(in_order);
        }
        ordered
    }
}

#[inline(always)]
fn count(flags: &[bool]) -> u64 {
    // A byte holds the count of a block.
    const { assert!(LANES < 256) };
    flags.iter().fold(0u8, |count, flag| count + u8::from(*flag)).into()
}

/// Takes the scores of one block into bins and moments.
fn record(scores: &[Lanes], n: usize, first: u64, bins: &mut [MeasureBins], moments: &mut Moments) {
    at_widest(Record { scores, n, first, bins, moments });
}

struct Record<'a> {
    scores: &'a [Lanes],
    n: usize,
    first: u64,
    bins: &'a mut [MeasureBins],
    moments: &'a mut Moments,
}

impl Wide for Record<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut columns: [&[f64]; MOST] = [&[]; MOST];
        for ((column, row), bins) in columns.iter_mut().zip(self.scores).zip(self.bins.iter_mut()) {
            *column = &row[..self.n];
            bins.scores.record(column);
            for (limit, count) in &mut bins.below {
                *count += column.iter().map(|score| u64::from(*score < *limit)).sum::<u64>();
            }
        }
        self.moments.extend(&columns[..self.bins.len()], self.first);
    }
}
