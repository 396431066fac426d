//! What was kept of single elements and by region becomes part of a summary.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use super::each::RegionStatistics;
use super::measure::Bins;
use super::merge::ByShape;
use super::worst::Candidate;
use crate::measures;
use crate::mesh::{NO_REGION, Nodes, Regions, Shape};
use crate::summary::{self, RegionMeasure, RegionShape, ShapeSummary, WorstElement};

/// Statistics by region; `of` is what the format calls them.
pub(super) fn by_region(
    shapes: &ByShape,
    reversed: &[bool; Shape::ALL.len()],
    regions: &Regions,
    of: Option<&'static str>,
) -> summary::Regions {
    let mut found: BTreeMap<u32, summary::Region> = BTreeMap::new();
    for shape in Shape::ALL {
        let Some(statistics) = &shapes[shape.index()] else { continue };
        for (number, statistics) in &statistics.regions {
            let name = regions.name(*number);
            let region = || summary::Region { name, shapes: BTreeMap::new() };
            let summary = region_shape(shape, statistics, reversed[shape.index()]);
            found.entry(*number).or_insert_with(region).shapes.insert(shape, summary);
        }
    }
    let mut list: Vec<_> = found.into_values().collect();
    list.sort_by_cached_key(|region| (region.name.is_none(), region.name.as_deref().map(in_order)));
    // Elements of a format without regions are all in none, which says nothing.
    list.retain(|region| region.name.is_some() || of.is_some());
    summary::Regions { of: of.map(Cow::Borrowed), list }
}

/// What names are put in order by: runs of digits as numbers.
fn in_order(name: &str) -> Vec<(u64, String)> {
    let mut parts = Vec::new();
    let mut rest = name;
    while !rest.is_empty() {
        let text = rest.find(|c: char| c.is_ascii_digit()).unwrap_or(rest.len());
        let (before, digits) = rest.split_at(text);
        let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        // A name without digits where others have a number comes after them.
        parts.push((0, before.to_owned()));
        if end > 0 {
            parts.push((digits[..end].parse().unwrap_or(u64::MAX), digits[..end].to_owned()));
        }
        rest = &digits[end..];
    }
    parts
}

fn region_shape(shape: Shape, found: &RegionStatistics, reversed: bool) -> RegionShape {
    let is_solid = shape.dimension() == 3;
    let mut measured = BTreeMap::new();
    for (what, moments) in measures::subjects(shape).iter().zip(&found.subjects) {
        for (i, row) in what.family.measures().iter().enumerate() {
            let extremes = &moments.extremes[i];
            let summary = RegionMeasure {
                on: Cow::Borrowed(what.on),
                count: moments.count,
                max: extremes.max,
                min: extremes.min,
                min_element: extremes.min_label,
                mean: moments.mean[i].clamp(extremes.min, extremes.max),
                sd: moments.sd(i),
            };
            measured.insert(row.code.to_owned(), summary);
        }
    }
    RegionShape {
        count: found.count,
        area: (!is_solid).then_some(found.extent),
        volume: is_solid.then_some(found.extent),
        inverted: if reversed { found.positive } else { found.negative },
        degenerate: found.degenerate,
        measures: measured,
    }
}

/// Puts the worst elements into the summaries of their measures.
pub(super) fn add_worst(
    shapes: &mut BTreeMap<Shape, ShapeSummary>,
    bins: &Bins,
    nodes: &Nodes,
    regions: &Regions,
) {
    let mut lists: Vec<(Shape, &'static str, Vec<Candidate>)> = Vec::new();
    for shape in Shape::ALL {
        let Some(bins) = bins.shape(shape) else { continue };
        for (what, bins) in measures::subjects(shape).iter().zip(&bins.measures) {
            for (row, bins) in what.family.measures().iter().zip(bins) {
                lists.push((shape, row.code, bins.worst.sorted()));
            }
        }
    }
    let corners = |shape: Shape, candidate: &Candidate| candidate.corners[..shape.corners()].to_vec();
    let rows: BTreeSet<u32> =
        lists.iter().flat_map(|(shape, _, list)| list.iter().flat_map(|c| corners(*shape, c))).collect();
    let numbers = nodes.numbers(&rows);
    for (shape, code, list) in lists {
        let element = |candidate: Candidate| {
            let rows = corners(shape, &candidate);
            let points = rows.iter().map(|row| nodes.rows()[*row as usize]);
            let sum = points.fold([0.0; 3], |sum, p| [sum[0] + p[0], sum[1] + p[1], sum[2] + p[2]]);
            WorstElement {
                element: candidate.label,
                value: candidate.value,
                centroid: sum.map(|x| x / rows.len() as f64),
                nodes: rows.iter().filter_map(|row| numbers.get(row).copied()).collect(),
                region: if candidate.region == NO_REGION { None } else { regions.name(candidate.region) },
            }
        };
        if let Some(measure) = shapes.get_mut(&shape).and_then(|found| found.measures.get_mut(code)) {
            measure.worst = list.into_iter().map(element).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_put_in_order_with_numbers_as_numbers() {
        let mut names = ["10", "pit-10", "9", "pit-9", "pit", "Part-1.STEEL", "100"];
        names.sort_by_cached_key(|name| in_order(name));
        assert_eq!(names, ["9", "10", "100", "Part-1.STEEL", "pit", "pit-9", "pit-10"]);
    }
}
