//! Which rows stand together: one table for each shape and what of it was measured, as in the report, with the
//! meshes one after another.

use crate::mesh::Shape;
use crate::summary::{MeasureSummary, Summary};

/// Columns after the mesh and the measure, as in the report.
pub const COLUMNS: [&str; 5] = ["maximum", "minimum", "element number", "mean", "standard deviation"];

/// One of the report's tables.
#[derive(Debug)]
pub struct Table<'a> {
    /// The shape of the elements.
    pub shape: Shape,
    /// What of them was measured.
    pub on: &'a str,
    /// Whether they bound elements of a higher dimension.
    pub boundary: bool,
    /// One row a mesh and measure.
    pub rows: Vec<Row<'a>>,
}

/// A row: one measure on one mesh.
#[derive(Debug)]
pub struct Row<'a> {
    /// The mesh's place among the summaries.
    pub index: usize,
    /// The mesh's name, as it stands in the summary.
    pub mesh: &'a str,
    /// The measure's code, as it stands in the summary.
    pub code: &'a str,
    /// What was found.
    pub found: &'a MeasureSummary,
}

impl Table<'_> {
    /// What stands over the table; `on` as it stands in the summary.
    pub fn title(&self) -> String {
        let shapes = plural(self.shape);
        let mut title = shapes[..1].to_uppercase() + &shapes[1..];
        if self.on != ON_ELEMENT {
            title = format!("{title}, {}", self.on);
        }
        if self.boundary {
            title += " (boundary: not in the totals and the verdict)";
        }
        title
    }
}

/// The `on` of measures of the element itself.
pub const ON_ELEMENT: &str = "element";

/// The shape's name for several of them.
pub fn plural(shape: Shape) -> &'static str {
    match shape {
        Shape::Triangle => "triangles",
        Shape::Quadrilateral => "quadrilaterals",
        Shape::Tetrahedron => "tetrahedra",
        Shape::Pyramid => "pyramids",
        Shape::Wedge => "wedges",
        Shape::Hexahedron => "hexahedra",
    }
}

/// The tables of some meshes: by shape, and boundaries after the rest.
pub fn tables(summaries: &[Summary]) -> Vec<Table<'_>> {
    let mut tables: Vec<Table> = Vec::new();
    for (index, summary) in summaries.iter().enumerate() {
        let dimension = summary.dimension();
        for (&shape, measured) in &summary.shapes {
            let boundary = shape.dimension() < dimension;
            for (code, found) in &measured.measures {
                let row = Row { index, mesh: &summary.mesh.name, code, found };
                let on = found.on.as_ref();
                match tables.iter_mut().find(|t| (t.boundary, t.shape, t.on) == (boundary, shape, on)) {
                    Some(table) => table.rows.push(row),
                    None => tables.push(Table { shape, on, boundary, rows: vec![row] }),
                }
            }
        }
    }
    tables.sort_by_key(|table| (table.boundary, table.shape));
    tables
}
