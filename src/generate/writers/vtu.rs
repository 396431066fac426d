//! VTK unstructured grids (.vtu) with appended raw data. Wedges are in the order of VTK 9.7, which is that of Abaqus.

use std::io::{self, Write};

use flate2::write::ZlibEncoder;

use super::{Encoding, Writer};
use crate::generate::{MeshSource, Problem};

pub(super) const WRITER: Writer = Writer {
    name: "vtu",
    title: "VTK unstructured grid, appended raw data (or compressed by zlib)",
    extensions: &["vtu"],
    encodings: &[Encoding::Binary, Encoding::Compressed],
    write,
};

/// Bytes that are compressed at a time.
const BLOCK: usize = 1 << 18;

/// The arrays of the file in the order of their data.
#[derive(Clone, Copy)]
enum Array {
    Points,
    Connectivity,
    Offsets,
    Types,
}

const ARRAYS: [Array; 4] = [Array::Points, Array::Connectivity, Array::Offsets, Array::Types];

impl Array {
    /// The array's attributes in the XML.
    fn attributes(self) -> &'static str {
        match self {
            Array::Points => r#"type="Float64" Name="Points" NumberOfComponents="3""#,
            Array::Connectivity => r#"type="Int64" Name="connectivity""#,
            Array::Offsets => r#"type="Int64" Name="offsets""#,
            Array::Types => r#"type="UInt8" Name="types""#,
        }
    }

    /// Number of bytes of the array's data.
    fn bytes(self, mesh: &dyn MeshSource) -> u64 {
        match self {
            Array::Points => 24 * mesh.nodes(),
            Array::Connectivity => {
                mesh.blocks().iter().map(|b| 8 * b.elements * b.shape.corners() as u64).sum()
            }
            Array::Offsets => 8 * mesh.elements(),
            Array::Types => mesh.elements(),
        }
    }

    /// Writes the array's data.
    fn data(self, mesh: &dyn MeshSource, out: &mut dyn Write) -> io::Result<()> {
        if let Array::Points = self {
            return mesh.each_node(&mut |point| all(&point.map(f64::to_le_bytes), out));
        }
        let mut end = 0_u64;
        for block in mesh.blocks() {
            match self {
                Array::Points => {}
                Array::Connectivity => mesh.each_element(block.shape, &mut |corners| {
                    corners.iter().try_for_each(|corner| out.write_all(&corner.to_le_bytes()))
                })?,
                Array::Offsets => (0..block.elements).try_for_each(|_| {
                    end += block.shape.corners() as u64;
                    out.write_all(&end.to_le_bytes())
                })?,
                Array::Types => {
                    (0..block.elements).try_for_each(|_| out.write_all(&[block.shape.facts().vtk_cell]))?;
                }
            }
        }
        Ok(())
    }
}

fn all<const N: usize>(values: &[[u8; N]], out: &mut dyn Write) -> io::Result<()> {
    values.iter().try_for_each(|value| out.write_all(value))
}

fn write(problem: &Problem, encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let mesh = problem.mesh();
    let mut headers = Vec::new();
    let mut offsets = Vec::new();
    let mut offset = 0;
    for array in ARRAYS {
        let (header, stored) = match encoding {
            Encoding::Compressed => compressed_header(array, mesh)?,
            _ => (vec![array.bytes(mesh)], array.bytes(mesh)),
        };
        offsets.push(offset);
        offset += 8 * header.len() as u64 + stored;
        headers.push(header);
    }
    xml(problem, encoding, &offsets, out)?;
    for (array, header) in ARRAYS.into_iter().zip(headers) {
        header.iter().try_for_each(|entry| out.write_all(&entry.to_le_bytes()))?;
        match encoding {
            Encoding::Compressed => compress(array, mesh, out).map(drop)?,
            _ => array.data(mesh, out)?,
        }
    }
    writeln!(out, "\n  </AppendedData>\n</VTKFile>")
}

/// Everything before the data. `offsets` are those of the arrays.
fn xml(problem: &Problem, encoding: Encoding, offsets: &[u64], out: &mut dyn Write) -> io::Result<()> {
    let compressor = match encoding {
        Encoding::Compressed => r#" compressor="vtkZLibDataCompressor""#,
        _ => "",
    };
    let array = |k: usize| {
        format!(r#"<DataArray {} format="appended" offset="{}"/>"#, ARRAYS[k].attributes(), offsets[k])
    };
    let (points, connectivity, ends, types) = (array(0), array(1), array(2), array(3));
    let (nodes, elements) = (problem.mesh().nodes(), problem.mesh().elements());
    write!(
        out,
        r#"<?xml version="1.0"?>
<!-- meshgauge: {problem} -->
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"{compressor}>
  <UnstructuredGrid>
    <Piece NumberOfPoints="{nodes}" NumberOfCells="{elements}">
      <Points>
        {points}
      </Points>
      <Cells>
        {connectivity}
        {ends}
        {types}
      </Cells>
    </Piece>
  </UnstructuredGrid>
  <AppendedData encoding="raw">
   _"#
    )
}

/// The header of a compressed array, and the bytes that its blocks take. The XML and the header stand before the blocks
/// and depend on their sizes, so that the array is compressed twice: the price of neither holding nor seeking.
fn compressed_header(array: Array, mesh: &dyn MeshSource) -> io::Result<(Vec<u64>, u64)> {
    let sizes = compress(array, mesh, &mut io::sink())?;
    let stored = sizes.iter().sum();
    let mut header = vec![sizes.len() as u64, BLOCK as u64, array.bytes(mesh) % BLOCK as u64];
    header.extend(sizes);
    Ok((header, stored))
}

/// Writes the array in compressed blocks; gives their sizes.
fn compress(array: Array, mesh: &dyn MeshSource, out: &mut dyn Write) -> io::Result<Vec<u64>> {
    let mut blocks = Blocks { waiting: Vec::with_capacity(BLOCK), sizes: Vec::new(), out };
    array.data(mesh, &mut blocks)?;
    blocks.finish()
}

/// Compresses what is written to it in blocks of [`BLOCK`] bytes.
struct Blocks<'a> {
    waiting: Vec<u8>,
    sizes: Vec<u64>,
    out: &'a mut dyn Write,
}

impl Blocks<'_> {
    fn compress(&mut self) -> io::Result<()> {
        let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(&self.waiting)?;
        let block = encoder.finish()?;
        self.waiting.clear();
        self.sizes.push(block.len() as u64);
        self.out.write_all(&block)
    }

    fn finish(mut self) -> io::Result<Vec<u64>> {
        if !self.waiting.is_empty() {
            self.compress()?;
        }
        Ok(self.sizes)
    }
}

impl Write for Blocks<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(BLOCK - self.waiting.len());
        self.waiting.extend_from_slice(&bytes[..taken]);
        if self.waiting.len() == BLOCK {
            self.compress()?;
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
