//! Tables that are there on demand, for the terminal and for Markdown alike: the worst elements, and statistics by region.

use super::layout::{COLUMNS, ON_ELEMENT, plural};
use super::numbers::{count, score, significant, spread};
use super::safe::escaped;
use crate::mesh::Shape;
use crate::summary::{Region, Summary, WorstElement};

/// Significant digits of coordinates.
const DIGITS: usize = 5;

/// A table of text. Nothing in it can steer a terminal; Markdown is for the caller to escape.
#[derive(Debug)]
pub struct TextTable {
    /// What stands over it.
    pub title: String,
    /// The columns' names.
    pub header: Vec<&'static str>,
    /// Number of columns at the left that hold text; those after it hold numbers.
    pub text_columns: usize,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

/// All tables of some meshes.
pub fn tables(summaries: &[Summary]) -> Vec<TextTable> {
    summaries.iter().flat_map(|summary| worst(summary).into_iter().chain(regions(summary))).collect()
}

/// One table a shape: its measures one after another, the worst element of each first.
fn worst(summary: &Summary) -> Vec<TextTable> {
    let mut tables = Vec::new();
    for (shape, measured) in &summary.shapes {
        let rows = measured.measures.iter().flat_map(|(code, measure)| {
            measure.worst.iter().map(|element| worst_row(&summary.mesh.name, code, element))
        });
        let rows: Vec<_> = rows.collect();
        if !rows.is_empty() {
            let header = vec!["mesh", "measure", "region", "element", "value", "centroid", "nodes"];
            let title = format!("Worst {}", plural(*shape));
            tables.push(TextTable { title, header, text_columns: 3, rows });
        }
    }
    tables
}

fn worst_row(mesh: &str, code: &str, found: &WorstElement) -> Vec<String> {
    let list = |items: Vec<String>| items.join(" ");
    vec![
        escaped(mesh),
        escaped(code),
        region_name(found.region.as_deref()),
        found.element.to_string(),
        score(found.value),
        list(found.centroid.iter().map(|x| significant(*x, DIGITS)).collect()),
        list(found.nodes.iter().map(u64::to_string).collect()),
    ]
}

/// One table a shape and what of it was measured.
fn regions(summary: &Summary) -> Vec<TextTable> {
    let Some(regions) = &summary.regions else { return Vec::new() };
    let of = regions.of.as_deref().map_or_else(|| "the format has none that are read".to_owned(), escaped);
    let mut tables: Vec<(Shape, TextTable)> = Vec::new();
    for region in &regions.list {
        for (shape, on, row) in region_rows(&summary.mesh.name, region) {
            let faces = if on == ON_ELEMENT { String::new() } else { format!(", {on}") };
            let title = format!("By region ({of}): {}{}", plural(shape), escaped(&faces));
            match tables.iter_mut().find(|(_, table)| table.title == title) {
                Some((_, table)) => table.rows.push(row),
                None => {
                    let header =
                        ["mesh", "region", "measure", "elements"].into_iter().chain(COLUMNS).collect();
                    tables.push((shape, TextTable { title, header, text_columns: 3, rows: vec![row] }));
                }
            }
        }
    }
    if tables.is_empty() {
        let title = format!("By region ({of})");
        return vec![TextTable { title, header: Vec::new(), text_columns: 0, rows: Vec::new() }];
    }
    tables.sort_by_key(|(shape, _)| *shape);
    tables.into_iter().map(|(_, table)| table).collect()
}

fn region_rows<'a>(mesh: &str, region: &'a Region) -> Vec<(Shape, &'a str, Vec<String>)> {
    let mut rows = Vec::new();
    for (shape, found) in &region.shapes {
        for (code, measure) in &found.measures {
            let cells = vec![
                escaped(mesh),
                region_name(region.name.as_deref()),
                escaped(code),
                count(found.count),
                score(measure.max),
                score(measure.min),
                measure.min_element.to_string(),
                score(measure.mean),
                spread(measure.sd),
            ];
            rows.push((*shape, measure.on.as_ref(), cells));
        }
    }
    rows
}

/// A region's name; a dash where there is none.
fn region_name(name: Option<&str>) -> String {
    name.map_or_else(|| "-".to_owned(), escaped)
}
