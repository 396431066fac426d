//! The verdict's reasons in plain words.

use super::layout::{ON_ELEMENT, plural};
use super::numbers::{below, counted, percent, significant};
use super::safe::escaped;
use crate::mesh::Shape;
use crate::summary::{Reason, Summary, rules};

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
        _ => unknown(reason),
    }
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
