//! Gmsh MSH 4.1, binary or as text. All nodes and elements belong to one volume (or surface), number 1.

use std::fmt;
use std::io::{self, Write};

use super::{Encoding, Writer};
use crate::generate::{MeshSource, Problem};
use crate::mesh::Shape;

pub(super) const WRITER: Writer = Writer {
    name: "gmsh",
    title: "Gmsh MSH 4.1, binary (or text)",
    extensions: &["msh"],
    encodings: &[Encoding::Binary, Encoding::Text],
    write,
};

/// The format's number for the linear element of a shape.
fn element_type(shape: Shape) -> i32 {
    match shape {
        Shape::Triangle => 2,
        Shape::Quadrilateral => 3,
        Shape::Tetrahedron => 4,
        Shape::Hexahedron => 5,
        Shape::Wedge => 6,
        Shape::Pyramid => 7,
    }
}

fn write(problem: &Problem, encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let mut out = Records { binary: encoding == Encoding::Binary, out, at_start: true };
    let file_type = u8::from(out.binary);
    writeln!(out.out, "$MeshFormat\n4.1 {file_type} 8")?;
    if out.binary {
        // By this number a reader knows the order of bytes.
        out.out.write_all(&1_i32.to_le_bytes())?;
        writeln!(out.out)?;
    }
    writeln!(out.out, "$EndMeshFormat")?;
    nodes(problem.mesh(), &mut out)?;
    elements(problem.mesh(), &mut out)
}

fn nodes(mesh: &dyn MeshSource, out: &mut Records<'_>) -> io::Result<()> {
    let count = mesh.nodes();
    out.open("$Nodes")?;
    out.sizes(&[1, count, 1, count])?;
    out.end()?;
    out.ints(&[mesh.dimension() as i32, 1, 0])?;
    out.sizes(&[count])?;
    out.end()?;
    for tag in 1..=count {
        out.sizes(&[tag])?;
        out.end()?;
    }
    mesh.each_node(&mut |point| {
        out.reals(&point)?;
        out.end()
    })?;
    out.close("$EndNodes")
}

fn elements(mesh: &dyn MeshSource, out: &mut Records<'_>) -> io::Result<()> {
    let (blocks, count) = (mesh.blocks(), mesh.elements());
    out.open("$Elements")?;
    out.sizes(&[blocks.len() as u64, count, 1, count])?;
    out.end()?;
    let mut tag = 0;
    for block in blocks {
        out.ints(&[block.shape.dimension() as i32, 1, element_type(block.shape)])?;
        out.sizes(&[block.elements])?;
        out.end()?;
        let mut record = [0; 1 + Shape::MAX_CORNERS];
        mesh.each_element(block.shape, &mut |corners| {
            tag += 1;
            record[0] = tag;
            record[1..].iter_mut().zip(corners).for_each(|(entry, corner)| *entry = corner + 1);
            out.sizes(&record[..=corners.len()])?;
            out.end()
        })?;
    }
    out.close("$EndElements")
}

/// Writes the numbers of records one after another, or as text with a record a line.
struct Records<'a> {
    binary: bool,
    out: &'a mut dyn Write,
    /// Whether the next number is the first of its record.
    at_start: bool,
}

impl Records<'_> {
    fn open(&mut self, name: &str) -> io::Result<()> {
        writeln!(self.out, "{name}")
    }

    fn close(&mut self, name: &str) -> io::Result<()> {
        if self.binary { writeln!(self.out, "\n{name}") } else { writeln!(self.out, "{name}") }
    }

    /// Ends a record.
    fn end(&mut self) -> io::Result<()> {
        self.at_start = true;
        if self.binary { Ok(()) } else { writeln!(self.out) }
    }

    fn sizes(&mut self, values: &[u64]) -> io::Result<()> {
        values.iter().try_for_each(|value| self.number(value.to_le_bytes(), value))
    }

    fn ints(&mut self, values: &[i32]) -> io::Result<()> {
        values.iter().try_for_each(|value| self.number(value.to_le_bytes(), value))
    }

    fn reals(&mut self, values: &[f64]) -> io::Result<()> {
        // Debug is the shortest text that reads back to the same double.
        values.iter().try_for_each(|value| self.number(value.to_le_bytes(), value))
    }

    fn number<const N: usize>(&mut self, bytes: [u8; N], text: impl fmt::Debug) -> io::Result<()> {
        if self.binary {
            return self.out.write_all(&bytes);
        }
        let blank = if std::mem::take(&mut self.at_start) { "" } else { " " };
        write!(self.out, "{blank}{text:?}")
    }
}
