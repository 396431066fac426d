//! Legacy VTK files of version 5.1, which VTK reads since 9.0. Wedges are in the order of VTK 9.7, which is that of Abaqus.

use std::fmt;
use std::io::{self, Write};

use super::{Encoding, Writer};
use crate::generate::Problem;

pub(super) const WRITER: Writer = Writer {
    name: "vtk",
    title: "legacy VTK file 5.1, binary (or text)",
    extensions: &["vtk"],
    encodings: &[Encoding::Binary, Encoding::Text],
    write,
};

/// The longest title that a reader must take.
const TITLE: usize = 200;

fn write(problem: &Problem, encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let mesh = problem.mesh();
    let binary = encoding == Encoding::Binary;
    let title: String = format!("meshgauge: {problem}").chars().take(TITLE).collect();
    let kind = if binary { "BINARY" } else { "ASCII" };
    writeln!(out, "# vtk DataFile Version 5.1\n{title}\n{kind}\nDATASET UNSTRUCTURED_GRID")?;
    let mut out = Numbers { binary, out };
    writeln!(out.out, "POINTS {} double", mesh.nodes())?;
    mesh.each_node(&mut |point| out.record(point.iter().map(|x| (x.to_be_bytes(), *x))))?;
    let (blocks, count) = (mesh.blocks(), mesh.elements());
    let entries: u64 = blocks.iter().map(|block| block.elements * block.shape.corners() as u64).sum();
    writeln!(out.out, "\nCELLS {} {entries}\nOFFSETS vtktypeint64", count + 1)?;
    let mut end = 0_u64;
    out.record([(end.to_be_bytes(), end)])?;
    for block in &blocks {
        (0..block.elements).try_for_each(|_| {
            end += block.shape.corners() as u64;
            out.record([(end.to_be_bytes(), end)])
        })?;
    }
    writeln!(out.out, "\nCONNECTIVITY vtktypeint64")?;
    for block in &blocks {
        let mut row = |corners: &[u64]| out.record(corners.iter().map(|c| (c.to_be_bytes(), *c)));
        mesh.each_element(block.shape, &mut row)?;
    }
    writeln!(out.out, "\nCELL_TYPES {count}")?;
    for block in &blocks {
        let number = i32::from(block.shape.facts().vtk_cell);
        (0..block.elements).try_for_each(|_| out.record([(number.to_be_bytes(), number)]))?;
    }
    writeln!(out.out)
}

/// Writes records of numbers, big-endian, or as text with a record a line.
struct Numbers<'a> {
    binary: bool,
    out: &'a mut dyn Write,
}

impl Numbers<'_> {
    fn record<const N: usize, T: fmt::Debug>(
        &mut self,
        numbers: impl IntoIterator<Item = ([u8; N], T)>,
    ) -> io::Result<()> {
        for (k, (bytes, number)) in numbers.into_iter().enumerate() {
            match (self.binary, k) {
                (true, _) => self.out.write_all(&bytes)?,
                // Debug is the shortest text that reads back to the same double.
                (false, 0) => write!(self.out, "{number:?}")?,
                (false, _) => write!(self.out, " {number:?}")?,
            }
        }
        if self.binary { Ok(()) } else { writeln!(self.out) }
    }
}
