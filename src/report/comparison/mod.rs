//! Comparisons as text: what got better, what got worse.

mod markdown;
mod table;
mod words;

use std::io::{self, Write};

use super::Style;
use super::safe::escaped_json;
use crate::compare::Comparisons;

pub use markdown::render as markdown;
pub use table::render as table;
pub(super) use words::{COLUMNS, cells, rest, side, told};

/// One indented object.
pub fn json(comparisons: &Comparisons, _: &Style, out: &mut dyn Write) -> io::Result<()> {
    let json = serde_json::to_string_pretty(comparisons)? + "\n";
    out.write_all(escaped_json(&json).as_bytes())
}
