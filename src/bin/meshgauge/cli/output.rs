//! Summaries on stdout, in the report that the user chose.

use std::io::{self, IsTerminal, Write, stdout};

use clap::builder::PossibleValuesParser;
use meshgauge::Summary;
use meshgauge::report::{REPORTS, Report, Style};

/// The names of the reports, as the parser of the command line wants them.
pub fn report_names() -> PossibleValuesParser {
    PossibleValuesParser::new(REPORTS.iter().map(|report| report.name))
}

/// Takes summaries as they come.
pub struct Output {
    report: &'static Report,
    many: bool,
    plot: bool,
    kept: Vec<Summary>,
}

impl Output {
    /// The report named `name`, or the first; `many` says whether there may be several summaries, `plot` whether the
    /// report for people draws histograms.
    pub fn new(name: Option<&str>, many: bool, plot: bool) -> Self {
        let report = name.and_then(meshgauge::report::find).unwrap_or(&REPORTS[0]);
        Self { report, many, plot, kept: Vec::new() }
    }

    /// Prints the summary now, if the report needs no other for it.
    pub fn add(&mut self, summary: Summary) -> io::Result<()> {
        if self.needs_all() {
            self.kept.push(summary);
            return Ok(());
        }
        self.print(&[summary])
    }

    /// Prints what had to wait.
    pub fn finish(self) -> io::Result<()> {
        if self.report.name == "json" && self.many {
            return self.print_array();
        }
        if self.kept.is_empty() { Ok(()) } else { self.print(&self.kept) }
    }

    /// CSV has one head, and JSON is an array.
    fn needs_all(&self) -> bool {
        self.many && matches!(self.report.name, "csv" | "json")
    }

    fn print(&self, summaries: &[Summary]) -> io::Result<()> {
        let mut out = stdout().lock();
        (self.report.render)(summaries, &Style { plot: self.plot, ..style() }, &mut out)?;
        out.flush()
    }

    /// An array even of one, so that what reads it need not know how many meshes could be read.
    fn print_array(&self) -> io::Result<()> {
        let mut out = stdout().lock();
        serde_json::to_writer_pretty(&mut out, &self.kept)?;
        out.write_all(b"\n")?;
        out.flush()
    }
}

/// How stdout wants it.
pub fn style() -> Style {
    let color = stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty());
    Style { color, width: stdout().is_terminal().then(terminal_width).flatten(), plot: false }
}

fn terminal_width() -> Option<u16> {
    rustix::termios::tcgetwinsize(stdout()).ok().map(|size| size.ws_col).filter(|&columns| columns > 0)
}
