//! The mesh as a whole: verdict, numbers of elements, area or volume, sizes, checks.

use super::{Finding, Outcome, Tolerances, less_is_better, neither};
use crate::mesh::Shape;
use crate::summary::{Checks, Status, Summary};

/// The statistics of the mesh as a whole.
pub fn findings(base: &Summary, new: &Summary, tolerances: &Tolerances) -> Vec<Finding> {
    let mut findings = vec![verdict(base, new)];
    findings.extend(counts(base, new, tolerances));
    findings.extend(shapes(base, new, tolerances));
    findings.extend(totals(base, new, tolerances));
    findings.extend(sizes(base, new, tolerances));
    findings.extend(checks(&base.checks, &new.checks, tolerances));
    findings
}

/// Whether the mesh fails. Warnings are not compared: the minimum that they rest on is.
fn verdict(base: &Summary, new: &Summary) -> Finding {
    let fails = |summary: &Summary| f64::from(summary.verdict.status == Status::Fail);
    let (base, new) = (fails(base), fails(new));
    Finding::of_mesh("verdict fails", base, new, 0.0, less_is_better(base, new, 0.0))
}

fn counts(base: &Summary, new: &Summary, tolerances: &Tolerances) -> Vec<Finding> {
    let measured = |summary: &Summary| summary.main_shapes().map(|(_, s)| s.count).sum::<u64>();
    let rows = [
        ("nodes", base.nodes.count, new.nodes.count),
        ("elements", base.elements.count, new.elements.count),
        ("elements measured", measured(base), measured(new)),
    ];
    let finding = |(statistic, base, new): (&'static str, u64, u64)| {
        let (base, new) = (base as f64, new as f64);
        let allowed = tolerances.size * base;
        // A mesh of which nothing is left to measure would have no other statistic that could be worse.
        let vanished = statistic == "elements measured" && base > 0.0 && new == 0.0;
        let outcome = if vanished { Outcome::Worse } else { neither(base, new, allowed) };
        Finding::of_mesh(statistic, base, new, allowed, outcome)
    };
    rows.map(finding).into()
}

/// The number of elements of each shape that either has.
fn shapes(base: &Summary, new: &Summary, tolerances: &Tolerances) -> Vec<Finding> {
    let count = |summary: &Summary, shape| {
        summary.main_shapes().find(|(found, _)| *found == shape).map_or(0.0, |(_, s)| s.count as f64)
    };
    let finding = |shape: Shape| {
        let (base, new) = (count(base, shape), count(new, shape));
        let allowed = tolerances.size * base;
        let outcome = neither(base, new, allowed);
        let whole = Finding::of_mesh("elements", base, new, allowed, outcome);
        (base > 0.0 || new > 0.0).then_some(Finding { shape: Some(shape), ..whole })
    };
    Shape::ALL.into_iter().filter_map(finding).collect()
}

/// Area or volume. Where both were told the true one, the error counts; else any change is for the worse, for then the
/// two are no longer meshes of one part.
fn totals(base: &Summary, new: &Summary, tolerances: &Tolerances) -> Vec<Finding> {
    if let (Some(before), Some(after)) = (&base.expected, &new.expected)
        && (before.volume, before.area) == (after.volume, after.area)
    {
        let (base, new) = (before.relative_error.abs(), after.relative_error.abs());
        let outcome = less_is_better(base, new, tolerances.volume);
        return vec![Finding::of_mesh(
            "error against what is expected",
            base,
            new,
            tolerances.volume,
            outcome,
        )];
    }
    let totals =
        [("area", base.totals.area, new.totals.area), ("volume", base.totals.volume, new.totals.volume)];
    let finding = |(statistic, base, new): (&'static str, Option<f64>, Option<f64>)| {
        if base.is_none() && new.is_none() {
            return None;
        }
        let allowed = tolerances.volume * base.unwrap_or(0.0).abs();
        let kept = base.zip(new).is_some_and(|(base, new)| (new - base).abs() <= allowed);
        let outcome = if kept { Outcome::Same } else { Outcome::Worse };
        let whole = Finding::of_mesh(statistic, 0.0, 0.0, allowed, outcome);
        Some(Finding { base, new, ..whole })
    };
    totals.into_iter().filter_map(finding).collect()
}

fn sizes(base: &Summary, new: &Summary, tolerances: &Tolerances) -> Vec<Finding> {
    let mut rows = Vec::new();
    if let (Some(base), Some(new)) = (base.sizes.edge_length, new.sizes.edge_length) {
        rows.push(("shortest edge", base.min, new.min));
        rows.push(("longest edge", base.max, new.max));
    }
    if let (Some(base), Some(new)) = (&base.sizes.element_size, &new.sizes.element_size) {
        rows.push(("mean element size", base.mean, new.mean));
    }
    let finding = |(statistic, base, new): (&'static str, f64, f64)| {
        let allowed = tolerances.size * base.abs();
        Finding::of_mesh(statistic, base, new, allowed, neither(base, new, allowed))
    };
    rows.into_iter().map(finding).collect()
}

/// The checks. Unused nodes and reversed shapes are a writer's convention, no fault.
fn checks(base: &Checks, new: &Checks, tolerances: &Tolerances) -> Vec<Finding> {
    let rows = [
        ("elements that name missing nodes", base.missing_nodes, new.missing_nodes, true),
        ("elements that name a corner twice", base.repeated_nodes, new.repeated_nodes, true),
        ("unused nodes", base.unused_nodes, new.unused_nodes, false),
        ("inverted elements", base.inverted, new.inverted, true),
        ("degenerate elements", base.degenerate, new.degenerate, true),
        ("reversed elements", base.reversed, new.reversed, false),
        ("concave faces", base.concave_faces, new.concave_faces, true),
        ("crossed faces", base.crossed_faces, new.crossed_faces, true),
    ];
    let finding = |(statistic, base, new, fault): (&'static str, u64, u64, bool)| {
        let (base, new) = (base as f64, new as f64);
        let allowed = tolerances.checks * base;
        let outcome = if fault { less_is_better(base, new, allowed) } else { neither(base, new, allowed) };
        Finding::of_mesh(statistic, base, new, allowed, outcome)
    };
    rows.map(finding).into()
}
