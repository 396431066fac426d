//! MEDIT meshes, as Mmg, Gmsh, FreeFem and TetGen read them. All nodes and elements have the reference 1.

use std::io::{self, Write};

use super::{Encoding, Writer};
use crate::generate::Problem;
use crate::mesh::Shape;

pub(super) const WRITER: Writer = Writer {
    name: "medit",
    title: "MEDIT mesh, text of version 2",
    extensions: &["mesh"],
    encodings: &[Encoding::Text],
    write,
};

/// The keyword of a shape's elements.
fn keyword(shape: Shape) -> &'static str {
    match shape {
        Shape::Triangle => "Triangles",
        Shape::Quadrilateral => "Quadrilaterals",
        Shape::Tetrahedron => "Tetrahedra",
        Shape::Pyramid => "Pyramids",
        Shape::Wedge => "Prisms",
        Shape::Hexahedron => "Hexahedra",
    }
}

fn write(problem: &Problem, _: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let mesh = problem.mesh();
    writeln!(out, "MeshVersionFormatted 2\n# meshgauge: {problem}\nDimension 3\nVertices\n{}", mesh.nodes())?;
    mesh.each_node(&mut |[x, y, z]| writeln!(out, "{x:?} {y:?} {z:?} 1"))?;
    for block in mesh.blocks() {
        writeln!(out, "{}\n{}", keyword(block.shape), block.elements)?;
        mesh.each_element(block.shape, &mut |corners| {
            corners.iter().try_for_each(|corner| write!(out, "{} ", corner + 1))?;
            writeln!(out, "1")
        })?;
    }
    writeln!(out, "End")
}
