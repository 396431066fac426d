//! The verdict's reasons in plain words.

use super::layout::{ON_ELEMENT, plural};
use super::numbers::{self, below, count, counted, percent, significant};
use super::safe::escaped;
use crate::mesh::Shape;
use crate::summary::{Reason, Statistic, Summary, rules};

/// A reason in plain words. A rule that is not known here (of a newer summary) is told by its name and numbers.
pub fn in_words(reason: &Reason, summary: &Summary) -> String {
    let number = reason.value as u64;
    match (reason.rule.as_ref(), reason.shape) {
        (rules::NPL, _) => format!("{}: worth a look (NPL)", under(reason, summary, "")),
        (rules::NOTHING_MEASURED, _) => "no element is one that a measure is defined for".to_owned(),
        (rules::FAIL_UNDER, _) => under(reason, summary, "the limit "),
        (rules::INVERTED, Some(shape)) => {
            format!("{}: oriented against the rest of the mesh", shapes(number, "inverted", shape))
        }
        (rules::DEGENERATE, Some(shape)) => {
            let content = if shape.dimension() == 3 { "volume" } else { "area" };
            format!("{}: no {content}, or an edge without length", shapes(number, "degenerate", shape))
        }
        (rules::EXPECTED_VOLUME, _) if summary.totals.volume.is_none() => {
            "a volume is expected, but the mesh has no solid elements".to_owned()
        }
        (rules::EXPECTED_AREA, _) if summary.totals.area.is_none() => {
            let found =
                if summary.totals.volume.is_some() { "is made of solids" } else { "has no surface elements" };
            format!("an area is expected, but the mesh {found}")
        }
        (rules::EXPECTED_VOLUME, _) => off("volume", reason),
        (rules::EXPECTED_AREA, _) => off("area", reason),
        _ => of_rule(reason, summary).unwrap_or_else(|| unknown(reason)),
    }
}

/// A reason that a rule of a preset or of the user's own gave, by its statistic.
fn of_rule(reason: &Reason, summary: &Summary) -> Option<String> {
    reason.status?;
    let rule = escaped(&reason.rule);
    let limit = significant(reason.limit, 4);
    let Some(statistic) = reason.statistic.as_deref() else {
        return Some(format!("{} ({rule})", under(reason, summary, "")));
    };
    let of = reason.measure.as_deref().map(escaped)?;
    if statistic == Statistic::Count.name() {
        let found = count(reason.value as u64);
        return Some(format!("{found} {}, over {limit} ({rule})", of.replace('_', " ")));
    }
    let (shape, first) = (plural(reason.shape?), reason.element?);
    let below = |found: String, allowed: String| {
        let threshold = reason.threshold.unwrap_or_default();
        format!(
            "{found} of {shape} with {of} under {threshold}, over {allowed} ({rule}); {first} is the worst"
        )
    };
    Some(match statistic {
        "share below" => below(percent_over(reason.value, reason.limit), percent(reason.limit)),
        "count below" => below(count(reason.value as u64), limit),
        _ => {
            let value = numbers::below(reason.value, reason.limit);
            format!("the {} of {of} over {shape} is {value}, under {limit} ({rule})", escaped(statistic))
        }
    })
}

/// A share as per cent, with as many digits as it takes to read as more than what is allowed.
fn percent_over(share: f64, allowed: f64) -> String {
    let reads_over =
        |digits: &usize| significant(share * 100.0, *digits) != significant(allowed * 100.0, *digits);
    let digits = (3..17).find(reads_over).unwrap_or(17);
    format!("{} %", significant(share * 100.0, digits))
}

/// `M33 of tetrahedron 1937 is 0.040, under 0.1`.
fn under(reason: &Reason, summary: &Summary, limit: &str) -> String {
    let value = below(reason.value, reason.limit);
    format!("{} is {value}, under {limit}{}", subject(reason, summary), reason.limit)
}

/// `M33 of tetrahedron 1937`, `M22 of a face of hexahedron 12`.
fn subject(reason: &Reason, summary: &Summary) -> String {
    let code = reason.measure.as_deref().unwrap_or("the measure");
    let mut subject = escaped(code);
    if let Some(shape) = reason.shape {
        let found = summary.shapes.get(&shape).and_then(|measured| measured.measures.get(code));
        let of_face = found.is_some_and(|measure| measure.on != ON_ELEMENT);
        subject += if of_face { " of a face of " } else { " of " };
        subject += shape.name();
    }
    if let Some(element) = reason.element {
        subject += &format!(" {element}");
    }
    subject
}

fn shapes(number: u64, what: &str, shape: Shape) -> String {
    counted(number, &format!("{what} {}", shape.name()), &format!("{what} {}", plural(shape)))
}

fn off(what: &str, reason: &Reason) -> String {
    let side = if reason.value < 0.0 { "under" } else { "over" };
    let (error, limit) = (percent(reason.value.abs()), percent(reason.limit));
    format!("the {what} is {error} {side} what is expected; {limit} is allowed")
}

fn unknown(reason: &Reason) -> String {
    let of = [reason.measure.as_deref().map(escaped), reason.shape.map(|shape| shape.to_string())];
    let of: String = of.into_iter().flatten().map(|word| format!(" {word}")).collect();
    let element = reason.element.map(|element| format!(" of element {element}")).unwrap_or_default();
    let (value, limit) = (significant(reason.value, 4), significant(reason.limit, 4));
    format!("{}:{of} {value}{element}, limit {limit}", escaped(&reason.rule))
}
