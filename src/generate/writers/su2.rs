//! SU2 meshes: one zone without markers.

use std::io::{self, Write};

use super::{Encoding, Writer};
use crate::generate::Problem;

pub(super) const WRITER: Writer = Writer {
    name: "su2",
    title: "SU2 mesh of one zone, without markers",
    extensions: &["su2"],
    encodings: &[Encoding::Text],
    write,
};

fn write(problem: &Problem, _: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let mesh = problem.mesh();
    let dimension = mesh.dimension();
    writeln!(out, "% meshgauge: {problem}\nNDIME= {dimension}\nNELEM= {}", mesh.elements())?;
    let mut element = 0_u64;
    for block in mesh.blocks() {
        mesh.each_element(block.shape, &mut |corners| {
            write!(out, "{}", block.shape.facts().vtk_cell)?;
            corners.iter().try_for_each(|corner| write!(out, " {corner}"))?;
            writeln!(out, " {element}")?;
            element += 1;
            Ok(())
        })?;
    }
    writeln!(out, "NPOIN= {}", mesh.nodes())?;
    let mut node = 0_u64;
    mesh.each_node(&mut |point| {
        point[..dimension].iter().try_for_each(|coordinate| write!(out, "{coordinate:?} "))?;
        writeln!(out, "{node}")?;
        node += 1;
        Ok(())
    })?;
    writeln!(out, "NMARK= 0")
}
