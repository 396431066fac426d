//! The rows that the report of 2007 printed, to be laid beside a mesh of today.

use std::sync::LazyLock;

use crate::mesh::Shape;
use crate::report::layout::ON_ELEMENT;

/// A row of the report's tables 1 to 6 and 8 to 10.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// The table's number.
    pub table: u8,
    /// The mesh's label in that table: `A5`, `FD1`, `4W`.
    pub mesh: &'static str,
    /// The measure's code.
    pub code: &'static str,
    /// Maximum, minimum, mean and standard deviation.
    pub values: [f64; 4],
    /// The element that has the minimum.
    pub min_element: u64,
}

/// As it stands in the report. M22 of tables 3, 4, 5 and 9 was computed there from three of the four sides.
const TABLES: &str = include_str!("npl_tables.csv");

static ROWS: LazyLock<Vec<Published>> = LazyLock::new(|| {
    TABLES
        .lines()
        .skip(1)
        .map(|line| row(line).expect("the data are part of the program, and tested"))
        .collect()
});

fn row(line: &'static str) -> Option<Published> {
    let mut fields = line.split(',');
    let mut next = || fields.next();
    let (table, mesh, code) = (next()?.parse().ok()?, next()?, next()?);
    let (max, min) = (next()?.parse().ok()?, next()?.parse().ok()?);
    let min_element = next()?.parse().ok()?;
    let (mean, sd) = (next()?.parse().ok()?, next()?.parse().ok()?);
    Some(Published { table, mesh, code, values: [max, min, mean, sd], min_element })
}

/// The labels of all meshes, in the order of the report.
pub fn labels() -> Vec<&'static str> {
    let mut labels: Vec<&str> = Vec::new();
    for row in ROWS.iter() {
        if !labels.contains(&row.mesh) {
            labels.push(row.mesh);
        }
    }
    labels
}

/// The rows of a mesh on some shape, and what of it was measured, as in a summary.
pub fn rows(mesh: &str, shape: Shape, on: &str) -> Vec<&'static Published> {
    ROWS.iter().filter(|row| row.mesh == mesh && row.is_of(shape, on)).collect()
}

impl Published {
    /// The row as text: mesh, measure, maximum, minimum, element, mean, deviation, with the digits that were printed.
    pub fn cells(&self) -> Vec<String> {
        let [max, min, mean, sd] = self.values.map(|value| format!("{value:.3}"));
        let mesh = format!("2007: {}", self.mesh);
        vec![mesh, self.code.to_owned(), max, min, self.min_element.to_string(), mean, sd]
    }

    /// What the row's table is about.
    fn is_of(&self, shape: Shape, on: &str) -> bool {
        let (triangles, quadrilaterals) = ("triangular faces", "quadrilateral faces");
        let of = match self.table {
            1 => (Shape::Triangle, ON_ELEMENT),
            2 | 10 => (Shape::Wedge, triangles),
            3 => (Shape::Quadrilateral, ON_ELEMENT),
            4 => (Shape::Hexahedron, quadrilaterals),
            5 => (Shape::Wedge, quadrilaterals),
            9 if self.mesh.ends_with('H') => (Shape::Hexahedron, quadrilaterals),
            9 => (Shape::Wedge, quadrilaterals),
            _ => (Shape::Tetrahedron, ON_ELEMENT),
        };
        of == (shape, on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_read_and_belongs_to_one_shape() {
        assert_eq!(ROWS.len(), TABLES.lines().count() - 1);
        assert_eq!(ROWS.len(), 138);
        let rows = rows("1", Shape::Tetrahedron, ON_ELEMENT);
        assert_eq!(rows.iter().map(|row| row.code).collect::<Vec<_>>(), ["M31", "M32", "M33", "M34"]);
        assert_eq!((rows[2].values, rows[2].min_element), ([0.998, 0.097, 0.580, 0.119], 17260));
    }

    #[test]
    fn the_faces_of_a_mesh_are_kept_apart() {
        assert_eq!(rows("FD1", Shape::Wedge, "triangular faces").len(), 5);
        assert_eq!(rows("FD1", Shape::Wedge, "quadrilateral faces").len(), 3);
        assert_eq!(rows("FD1", Shape::Hexahedron, "quadrilateral faces").len(), 3);
        assert!(rows("FD1", Shape::Tetrahedron, ON_ELEMENT).is_empty());
        assert!(labels().contains(&"4W") && labels().len() > 20);
    }
}
