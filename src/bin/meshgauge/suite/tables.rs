//! What a suite found, as tables: the runs of each problem, then the report's tables of its meshes.

use std::io::{self, Write};

use meshgauge::Summary;
use meshgauge::report::Grid;
use meshgauge::summary::MeasureSummary;
use serde::Serialize;

use super::{Row, Scored, Suite};

/// Writes the rows as `table`, `markdown`, `csv` or `json`.
pub fn write(suite: &Suite, scored: &[Scored], format: &str, out: &mut dyn Write) -> io::Result<()> {
    match format {
        "json" => json(scored, out),
        "csv" => measures(scored).csv(out),
        "markdown" => {
            writeln!(out, "## {}\n", suite.title)?;
            by_problem(suite, scored, "### ", Grid::markdown, out)
        }
        _ => {
            writeln!(out, "{}\n", suite.title)?;
            by_problem(suite, scored, "", Grid::plain, out)
        }
    }
}

fn by_problem(
    suite: &Suite,
    scored: &[Scored],
    heading: &str,
    show: fn(&Grid, &mut dyn Write) -> io::Result<()>,
    out: &mut dyn Write,
) -> io::Result<()> {
    for problem in &suite.problems {
        let here: Vec<_> = scored.iter().filter(|(row, _)| row.problem == problem.name).collect();
        if here.is_empty() {
            continue;
        }
        writeln!(out, "{heading}{}\n", problem.title)?;
        show(&runs(here.iter().map(|(row, _)| row)), out)?;
        let summaries: Vec<Summary> = here.iter().filter_map(|(_, summary)| summary.clone()).collect();
        Grid::of_measures(&summaries, &problem.published).iter().try_for_each(|grid| show(grid, out))?;
    }
    Ok(())
}

/// How the generators ran.
fn runs<'a>(rows: impl Iterator<Item = &'a Row>) -> Grid {
    let columns = [
        "mesh",
        "generator",
        "version",
        ">nodes",
        ">elements",
        ">size error %",
        ">seconds",
        ">memory MB",
        "outcome",
    ];
    let mut grid = Grid::new("Runs", &columns);
    for row in rows {
        let outcome = row
            .reason
            .as_ref()
            .map_or_else(|| row.outcome.to_string(), |why| format!("{}: {why}", row.outcome));
        grid.rows.push(vec![
            row.generator.clone(),
            row.title.clone(),
            row.version.clone().unwrap_or_default(),
            shown(row.nodes),
            shown(row.elements),
            row.relative_error.map(|error| format!("{:.3}", 100.0 * error)).unwrap_or_default(),
            row.seconds.map(|seconds| format!("{seconds:.2}")).unwrap_or_default(),
            row.peak_rss_bytes.map(|bytes| format!("{:.0}", bytes as f64 / 1e6)).unwrap_or_default(),
            outcome,
        ]);
    }
    grid
}

/// A row for each run and measure, at full precision; a run without a mesh has one row.
fn measures(scored: &[Scored]) -> Grid {
    let columns = [
        "problem",
        "generator",
        "version",
        "outcome",
        "reason",
        "nodes",
        "elements",
        "relative_error",
        "seconds",
        "cpu_seconds",
        "peak_rss_bytes",
        "shape",
        "on",
        "measure",
        "max",
        "min",
        "min_element",
        "mean",
        "sd",
    ];
    let mut grid = Grid::new("", &columns);
    for (row, summary) in scored {
        let first = vec![
            row.problem.clone(),
            row.generator.clone(),
            row.version.clone().unwrap_or_default(),
            row.outcome.to_string(),
            row.reason.clone().unwrap_or_default(),
            shown(row.nodes),
            shown(row.elements),
            shown(row.relative_error),
            shown(row.seconds),
            shown(row.cpu_seconds),
            shown(row.peak_rss_bytes),
        ];
        let Some(summary) = summary else {
            grid.rows.push([first, vec![String::new(); 8]].concat());
            continue;
        };
        for (shape, found) in &summary.shapes {
            let last = |(code, m): (&String, &MeasureSummary)| {
                let number = |value: f64| value.to_string();
                let names = [shape.to_string(), m.on.to_string(), code.clone(), number(m.max), number(m.min)];
                let rest = [m.min_element.to_string(), number(m.mean), number(m.sd)];
                first.iter().cloned().chain(names).chain(rest).collect()
            };
            grid.rows.extend(found.measures.iter().map(last));
        }
    }
    grid
}

fn shown(value: Option<impl ToString>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

fn json(scored: &[Scored], out: &mut dyn Write) -> io::Result<()> {
    #[derive(Serialize)]
    struct Both<'a> {
        #[serde(flatten)]
        row: &'a Row,
        summary: &'a Option<Summary>,
    }
    let all: Vec<_> = scored.iter().map(|(row, summary)| Both { row, summary }).collect();
    serde_json::to_writer_pretty(&mut *out, &all)?;
    writeln!(out)
}
