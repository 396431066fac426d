//! What is kept of single elements, where somebody asked for it: the worst ones, statistics by region, every score.
//!
//! A run that asks for none of it has no [`Each`], and does none of this.

use std::collections::BTreeMap;

use super::Options;
use super::measure::{SUBJECTS, ShapeBins};
use super::worst::Candidate;
use crate::measures::{self, Corner, Geometry, LANES, Lanes, MOST_MEASURES};
use crate::mesh::{Shape, Tag};
use crate::statistics::{MOST, Moments, sum};

/// The scores of the elements of one block, and what was kept of the chunk so far.
pub(super) struct Each {
    by_region: bool,
    keeps_rows: bool,
    /// By subject and measure; of an element's faces the smallest.
    scores: [[Lanes; MOST_MEASURES]; SUBJECTS],
    /// The regions of the block, each with its lanes in order.
    groups: Vec<(u32, Vec<usize>)>,
    /// Statistics of the chunk by region.
    regions: ByRegion,
    rows: Rows,
}

/// Statistics of one shape by number of region.
pub(super) type ByRegion = BTreeMap<u32, RegionStatistics>;

/// What was found in the elements of one shape and region.
#[derive(Debug, Clone, Default)]
pub(super) struct RegionStatistics {
    pub count: u64,
    /// Sum of areas, or of volumes as magnitudes.
    pub extent: f64,
    /// Moments of the measures, by subject.
    pub subjects: [Moments; SUBJECTS],
    /// Elements by the sign of their orientation.
    pub positive: u64,
    pub negative: u64,
    pub degenerate: u64,
}

impl RegionStatistics {
    /// Takes in what was found in elements that come after these.
    pub(super) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.extent += other.extent;
        for (mine, theirs) in self.subjects.iter_mut().zip(&other.subjects) {
            mine.merge(theirs);
        }
        self.positive += other.positive;
        self.negative += other.negative;
        self.degenerate += other.degenerate;
    }
}

/// The elements of a chunk with all that was measured of each, column by column.
#[derive(Debug, Clone, Default)]
pub(super) struct Rows {
    pub labels: Vec<u64>,
    pub tags: Vec<Tag>,
    /// Corners as rows of the node table, element by element.
    pub corners: Vec<u32>,
    pub centroids: Vec<[f64; 3]>,
    /// Signed.
    pub extents: Vec<f64>,
    pub sizes: Vec<f64>,
    /// By subject and measure.
    pub scores: [[Vec<f64>; MOST_MEASURES]; SUBJECTS],
}

/// A block of elements of one shape, as it is measured.
pub(super) struct Block<'a> {
    pub shape: Shape,
    /// Corners as rows of the node table.
    pub rows: &'a [u32],
    pub labels: &'a [u64],
    pub tags: &'a [Tag],
    /// Position of its first element in the file.
    pub first: u64,
}

impl Each {
    /// What the run asks for; nothing where it asks for nothing of single elements.
    pub(super) fn of(options: &Options, keeps_rows: bool) -> Option<Box<Self>> {
        let asked = options.worst > 0 || options.by_region || keeps_rows;
        asked.then(|| {
            Box::new(Self {
                by_region: options.by_region,
                keeps_rows,
                scores: [[[0.0; LANES]; MOST_MEASURES]; SUBJECTS],
                groups: Vec::new(),
                regions: ByRegion::new(),
                rows: Rows::default(),
            })
        })
    }

    /// A block comes whose elements have these corners, in the file's own coordinates.
    pub(super) fn start(&mut self, block: &Block<'_>, corners: &[Corner]) {
        self.scores.as_flattened_mut().iter_mut().for_each(|lanes| lanes.fill(f64::INFINITY));
        if self.keeps_rows {
            let share = 1.0 / corners.len() as f64;
            let mean =
                |lane: usize, axis: usize| corners.iter().map(|corner| corner[axis][lane] * share).sum();
            let lanes = 0..block.labels.len();
            self.rows.centroids.extend(lanes.map(|lane| [mean(lane, 0), mean(lane, 1), mean(lane, 2)]));
        }
        if self.by_region {
            self.groups.clear();
            for (lane, tag) in block.tags.iter().enumerate() {
                match self.groups.iter_mut().find(|(region, _)| *region == tag.region) {
                    Some((_, lanes)) => lanes.push(lane),
                    None => self.groups.push((tag.region, vec![lane])),
                }
            }
        }
    }

    /// The elements, or one face of each, were measured: `scores[measure][lane]`.
    pub(super) fn record(&mut self, subject: usize, scores: &[Lanes], block: &Block<'_>) {
        for (least, column) in self.scores[subject].iter_mut().zip(scores) {
            for (least, score) in least.iter_mut().zip(column) {
                *least = least.min(*score);
            }
        }
        for (region, lanes) in &self.groups {
            let moments = moments_of(lanes, scores, block);
            self.regions.entry(*region).or_default().subjects[subject].merge(&moments);
        }
    }

    /// All of the block is measured.
    pub(super) fn finish(
        &mut self,
        block: &Block<'_>,
        geometry: &Geometry,
        signed: bool,
        bins: &mut ShapeBins,
    ) {
        self.offer(block, bins);
        for (region, lanes) in &self.groups {
            let found = self.regions.entry(*region).or_default();
            found.count += lanes.len() as u64;
            found.extent += sum(&lanes.iter().map(|lane| geometry.extent[*lane].abs()).collect::<Vec<_>>());
            for &lane in lanes {
                let sign = geometry.sign[lane];
                if geometry.degenerate[lane] {
                    found.degenerate += 1;
                } else if signed {
                    found.positive += u64::from(sign > 0.0);
                    found.negative += u64::from(sign < 0.0);
                }
            }
        }
        if self.keeps_rows {
            self.keep(block, geometry);
        }
    }

    /// Offers the elements to the lists of the worst.
    fn offer(&self, block: &Block<'_>, bins: &mut ShapeBins) {
        for (scores, bins) in self.scores.iter().zip(&mut bins.measures) {
            for (scores, bins) in scores.iter().zip(bins) {
                for (lane, label) in block.labels.iter().enumerate() {
                    if bins.worst.wants(scores[lane]) {
                        let mut corners = [0; Shape::MAX_CORNERS];
                        let count = block.shape.corners();
                        corners[..count].copy_from_slice(&block.rows[lane * count..][..count]);
                        bins.worst.offer(Candidate {
                            value: scores[lane],
                            position: block.first + lane as u64,
                            label: *label,
                            region: block.tags[lane].region,
                            corners,
                        });
                    }
                }
            }
        }
    }

    fn keep(&mut self, block: &Block<'_>, geometry: &Geometry) {
        let n = block.labels.len();
        let rows = &mut self.rows;
        rows.labels.extend_from_slice(block.labels);
        rows.tags.extend_from_slice(block.tags);
        rows.corners.extend_from_slice(block.rows);
        let extent = |lane: usize| {
            // The extents are magnitudes by now.
            let negative = block.shape.dimension() == 3 && geometry.sign[lane] < 0.0;
            if negative { -geometry.extent[lane] } else { geometry.extent[lane] }
        };
        rows.extents.extend((0..n).map(extent));
        rows.sizes.extend_from_slice(&geometry.size[..n]);
        for (subject, what) in measures::subjects(block.shape).iter().enumerate() {
            for m in 0..what.family.measures().len() {
                rows.scores[subject][m].extend_from_slice(&self.scores[subject][m][..n]);
            }
        }
    }

    /// What was kept of the chunk, and makes room for the next.
    pub(super) fn take(&mut self) -> (ByRegion, Option<Box<Rows>>) {
        let rows = self.keeps_rows.then(|| Box::new(std::mem::take(&mut self.rows)));
        (std::mem::take(&mut self.regions), rows)
    }
}

/// Moments of some lanes; the positions and numbers of extremes are those of the elements.
fn moments_of(lanes: &[usize], scores: &[Lanes], block: &Block<'_>) -> Moments {
    let mut gathered = [[0.0; LANES]; MOST];
    let mut columns: [&[f64]; MOST] = [&[]; MOST];
    for ((column, room), scores) in columns.iter_mut().zip(&mut gathered).zip(scores) {
        lanes.iter().zip(room.iter_mut()).for_each(|(lane, value)| *value = scores[*lane]);
        *column = &room[..lanes.len()];
    }
    let mut moments = Moments::default();
    moments.extend(&columns[..scores.len()], 0);
    for extremes in &mut moments.extremes[..scores.len()] {
        let lane = lanes[extremes.min_at as usize];
        (extremes.min_at, extremes.min_label) = (block.first + lane as u64, block.labels[lane]);
    }
    moments
}
