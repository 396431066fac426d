//! Summaries as JSON, whole or one a line.

use std::io::{self, Write};

use super::Style;
use super::safe::escaped_json;
use crate::summary::Summary;

/// One indented object for one summary, an array for none or several.
pub fn render(summaries: &[Summary], _: &Style, out: &mut dyn Write) -> io::Result<()> {
    let json = match summaries {
        [summary] => summary.to_json(),
        several => serde_json::to_string_pretty(several)? + "\n",
    };
    out.write_all(escaped_json(&json).as_bytes())
}

/// One object a line.
pub fn render_lines(summaries: &[Summary], _: &Style, out: &mut dyn Write) -> io::Result<()> {
    for summary in summaries {
        writeln!(out, "{}", escaped_json(&serde_json::to_string(summary)?))?;
    }
    Ok(())
}
