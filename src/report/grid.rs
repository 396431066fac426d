//! A table of any columns, for a terminal, as Markdown and as CSV.

use std::io::{self, Write};

use comfy_table::{CellAlignment, ContentArrangement, ContentLineStyle, LineStyle, TableStyle};

use super::layout;
use super::numbers::{score, spread};
use super::page::published::{self, Published};
use super::safe::{escaped, markdown};
use crate::summary::Summary;

/// A table of text. Cells may hold anything: every way of writing makes them harmless.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Grid {
    /// What stands over it.
    pub title: String,
    /// Names of the columns, and whether they are set to the right as numbers are.
    pub columns: Vec<(String, bool)>,
    /// Rows of as many cells.
    pub rows: Vec<Vec<String>>,
}

impl Grid {
    /// An empty table; a column whose name begins with `>` is set to the right.
    pub fn new(title: impl Into<String>, columns: &[&str]) -> Self {
        let column = |name: &&str| match name.strip_prefix('>') {
            Some(name) => (name.to_owned(), true),
            None => ((*name).to_owned(), false),
        };
        Self { title: title.into(), columns: columns.iter().map(column).collect(), rows: Vec::new() }
    }

    /// The report's tables of some meshes, one for each shape and what of it was measured; under them those rows of the
    /// report of 2007 that bear the labels.
    pub fn of_measures(summaries: &[Summary], published: &[String]) -> Vec<Grid> {
        let columns = ["mesh", "measure", ">maximum", ">minimum", ">element", ">mean", ">deviation"];
        let grid = |table: &layout::Table<'_>| {
            let mut grid = Grid::new(table.title(), &columns);
            let row = |row: &layout::Row<'_>| {
                let m = row.found;
                let (max, min) = (score(m.max), score(m.min));
                [row.mesh.to_owned(), row.code.to_owned(), max, min]
                    .into_iter()
                    .chain([m.min_element.to_string(), score(m.mean), spread(m.sd)])
                    .collect()
            };
            grid.rows.extend(table.rows.iter().map(row));
            for label in published {
                let rows = published::rows(label, table.shape, table.on);
                grid.rows.extend(rows.into_iter().map(Published::cells));
            }
            grid
        };
        layout::tables(summaries).iter().map(grid).collect()
    }

    /// For a terminal.
    pub fn plain(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut table = comfy_table::Table::new();
        let rule = TableStyle::new()
            .header_lines(ContentLineStyle::none())
            .header_separator(LineStyle::none().fill('─').junction('─'));
        table.load_style(rule).set_content_arrangement(ContentArrangement::Disabled);
        table.set_header(self.columns.iter().map(|(name, _)| escaped(name)));
        table.add_rows(self.rows.iter().map(|row| row.iter().map(|cell| escaped(cell))));
        for (i, (column, (_, right))) in table.column_iter_mut().zip(&self.columns).enumerate() {
            column.set_padding((if i == 0 { 2 } else { 1 }, 0));
            if *right {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        writeln!(out, "{}", escaped(&self.title))?;
        for line in table.lines() {
            writeln!(out, "{}", line.trim_end())?;
        }
        writeln!(out)
    }

    /// As Markdown.
    pub fn markdown(&self, out: &mut dyn Write) -> io::Result<()> {
        let line = |cells: &mut dyn Iterator<Item = String>| {
            format!("| {} |", cells.collect::<Vec<_>>().join(" | "))
        };
        writeln!(out, "#### {}\n", markdown(&self.title))?;
        writeln!(out, "{}", line(&mut self.columns.iter().map(|(name, _)| markdown(name))))?;
        let rules = self.columns.iter().map(|(_, right)| if *right { "---:" } else { "---" });
        writeln!(out, "|{}|", rules.collect::<Vec<_>>().join("|"))?;
        for row in &self.rows {
            writeln!(out, "{}", line(&mut row.iter().map(|cell| markdown(cell))))?;
        }
        writeln!(out)
    }

    /// As CSV (RFC 4180), without the title.
    pub fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let line = |cells: &mut dyn Iterator<Item = &str>| cells.map(quoted).collect::<Vec<_>>().join(",");
        writeln!(out, "{}", line(&mut self.columns.iter().map(|(name, _)| name.as_str())))?;
        self.rows.iter().try_for_each(|row| writeln!(out, "{}", line(&mut row.iter().map(String::as_str))))
    }
}

/// A cell of CSV; control characters are escaped, so that a row is a line.
fn quoted(cell: &str) -> String {
    let cell = escaped(cell);
    if cell.contains([',', '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(write: impl Fn(&mut dyn Write) -> io::Result<()>) -> String {
        let mut out = Vec::new();
        write(&mut out).expect("written");
        String::from_utf8(out).expect("text")
    }

    #[test]
    fn a_table_reads_the_same_in_every_way_and_steers_nothing() {
        let mut grid = Grid::new("Runs", &["name", ">nodes"]);
        grid.rows.push(vec!["a,\"b\"|\u{1b}[1m".into(), "12".into()]);
        assert_eq!(text(|out| grid.csv(out)), "name,nodes\n\"a,\"\"b\"\"|\\u{1b}[1m\",12\n");
        let plain = text(|out| grid.plain(out));
        assert!(
            plain.starts_with("Runs\n") && plain.contains("nodes") && !plain.contains('\u{1b}'),
            "{plain}"
        );
        let marked = text(|out| grid.markdown(out));
        assert!(
            marked.contains("|---|---:|\n") && marked.contains("&#124;") && !marked.contains('\u{1b}'),
            "{marked}"
        );
    }
}
