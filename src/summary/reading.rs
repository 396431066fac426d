//! Summaries read back from what `score` writes.

use serde::Deserialize;

use super::{SCHEMA, Summary};
use crate::error::{At, Error, Result};

impl Summary {
    /// The summaries in a JSON text: one object, several one after another (JSON lines), or an array.
    ///
    /// # Errors
    /// Where the text is no JSON, no summary, or one of another schema; with the line.
    pub fn read_all(text: &str) -> Result<Vec<Summary>> {
        let summaries: Vec<Summary> = if text.trim_start().starts_with('[') {
            serde_json::from_str(text).map_err(|e| no_summary(&e))?
        } else {
            let stream = serde_json::Deserializer::from_str(text).into_iter::<Summary>();
            stream.collect::<serde_json::Result<_>>().map_err(|e| explained(text, &e))?
        };
        match summaries.iter().find(|summary| summary.schema != SCHEMA) {
            Some(other) => Err(unknown(&other.schema)),
            None => Ok(summaries),
        }
    }
}

fn no_summary(cause: &serde_json::Error) -> Error {
    let found = cause.to_string();
    let found = found.split(" at line ").next().unwrap_or(&found);
    Error::malformed(format!("a summary ({SCHEMA})"), found).at(At::Line(cause.line() as u64))
}

fn unknown(schema: &str) -> Error {
    Error::unsupported(format!("schema \"{}\"; this version reads {SCHEMA}", schema.escape_default()))
}

/// Why a text is no summary: another schema explains it better than a missing field.
fn explained(text: &str, cause: &serde_json::Error) -> Error {
    #[derive(Deserialize)]
    struct Named {
        schema: String,
    }
    match serde_json::Deserializer::from_str(text).into_iter::<Named>().next() {
        Some(Ok(Named { schema })) if schema != SCHEMA => unknown(&schema),
        _ => no_summary(cause),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_summary_is_told_with_its_line() {
        let rows = [
            (
                "{\n\"schema\": 1\n}",
                "line 2: expected a summary (meshgauge.summary/1), found invalid type: integer `1`",
            ),
            ("{}", "line 1: expected a summary (meshgauge.summary/1), found missing field `schema`"),
            ("[{}]", "found missing field `schema`"),
            ("{\"schema\": \"meshgauge.summary/2\"}", "schema \"meshgauge.summary/2\"; this version reads"),
            ("{\"schema\": \"meshgauge.summary/1\"", "line 1: expected a summary"),
            ("nodes", "line 1: expected a summary"),
        ];
        for (text, message) in rows {
            let error = Summary::read_all(text).expect_err(text).to_string();
            assert!(error.contains(message), "{text}: {error}");
        }
        assert_eq!(Summary::read_all("[]").map(|summaries| summaries.len()).ok(), Some(0));
    }
}
