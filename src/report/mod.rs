//! Summaries as text: the report's tables for people, CSV, JSON and Markdown for what comes after.
//!
//! Names come out of mesh files, so every report makes them harmless: no control character reaches a terminal.

mod comparison;
mod csv;
mod details;
pub mod figure;
mod grid;
mod head;
mod json;
mod layout;
mod markdown;
mod numbers;
pub mod page;
mod plot;
mod reasons;
mod safe;
mod table;

use std::io::{self, Write};

use crate::compare::Comparisons;
use crate::summary::Summary;

pub use grid::Grid;

/// One way of writing summaries, or what they are compared to.
#[derive(Debug)]
pub struct Report<T: ?Sized = [Summary]> {
    /// The name that users choose it by.
    pub name: &'static str,
    /// What it is, in one line.
    pub title: &'static str,
    /// Writes it.
    pub render: fn(&T, &Style, &mut dyn Write) -> io::Result<()>,
}

/// How a report for people shall look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Style {
    /// Whether the verdict is coloured by ANSI escape codes.
    pub color: bool,
    /// Columns of the terminal; without it lines are as long as they need to be.
    pub width: Option<u16>,
    /// Whether the terminal's report draws the histograms too.
    pub plot: bool,
}

/// Every report; the first is for people.
pub const REPORTS: &[Report] = &[
    Report { name: "table", title: "the report's tables, for a terminal", render: table::render },
    Report { name: "json", title: "the summary, indented; an array of several", render: json::render },
    Report { name: "jsonl", title: "the summaries, one a line", render: json::render_lines },
    Report { name: "csv", title: "one row for each mesh, shape and measure", render: csv::render },
    Report { name: "markdown", title: "tables for a comment on a merge request", render: markdown::render },
];

/// Every report on a comparison; the first is for people.
pub const COMPARISONS: &[Report<Comparisons>] = &[
    Report {
        name: "table",
        title: "what got better and what got worse, for a terminal",
        render: comparison::table,
    },
    Report { name: "json", title: "every statistic of every mesh", render: comparison::json },
    Report { name: "markdown", title: "a comment on a merge request", render: comparison::markdown },
];

/// The report of that name.
pub fn find(name: &str) -> Option<&'static Report> {
    REPORTS.iter().find(|report| report.name == name)
}
