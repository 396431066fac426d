//! Abaqus input files, which CalculiX reads too.

use std::io::{self, Write};

use super::{Encoding, Writer};
use crate::generate::Problem;
use crate::mesh::Shape;

pub(super) const WRITER: Writer = Writer {
    name: "abaqus",
    title: "Abaqus input file (C3D4, C3D5, C3D6, C3D8, CPS3, CPS4)",
    extensions: &["inp"],
    encodings: &[Encoding::Text],
    write,
};

/// The element type and the name of the set that all its elements make.
fn element_type(shape: Shape) -> (&'static str, &'static str) {
    match shape {
        Shape::Triangle => ("CPS3", "TRIANGLES"),
        Shape::Quadrilateral => ("CPS4", "QUADRILATERALS"),
        Shape::Tetrahedron => ("C3D4", "TETRAHEDRA"),
        Shape::Pyramid => ("C3D5", "PYRAMIDS"),
        Shape::Wedge => ("C3D6", "WEDGES"),
        Shape::Hexahedron => ("C3D8", "HEXAHEDRA"),
    }
}

fn write(problem: &Problem, _: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let mesh = problem.mesh();
    writeln!(out, "*HEADING\nmeshgauge: {problem}\n*NODE, NSET=NODES")?;
    let mut node = 0_u64;
    mesh.each_node(&mut |[x, y, z]| {
        node += 1;
        // Debug is the shortest text that reads back to the same double, and has a decimal point or an exponent.
        writeln!(out, "{node}, {x:?}, {y:?}, {z:?}")
    })?;
    let mut element = 0_u64;
    for block in mesh.blocks() {
        let (name, set) = element_type(block.shape);
        writeln!(out, "*ELEMENT, TYPE={name}, ELSET={set}")?;
        mesh.each_element(block.shape, &mut |corners| {
            element += 1;
            write!(out, "{element}")?;
            corners.iter().try_for_each(|corner| write!(out, ", {}", corner + 1))?;
            writeln!(out)
        })?;
    }
    Ok(())
}
