//! Writers: a problem's mesh as a file, a row a format.

mod abaqus;
mod gmsh;
mod medit;
mod place;
mod su2;
mod vtk;
mod vtu;

use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::Problem;
use crate::error::{Error, Kind, Result};

pub use place::write_file;

/// How the numbers stand in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// The first of the format's own list.
    Default,
    /// As text that reads back to the same doubles.
    Text,
    /// As 64-bit little-endian numbers.
    Binary,
    /// As binary, in blocks compressed within the format.
    Compressed,
}

impl Encoding {
    fn name(self) -> &'static str {
        match self {
            Encoding::Default => "default",
            Encoding::Text => "text",
            Encoding::Binary => "binary",
            Encoding::Compressed => "compressed",
        }
    }
}

/// A format that meshes are written in: a row of [`WRITERS`].
#[derive(Debug)]
pub struct Writer {
    /// The format's name, the one it is read by.
    pub name: &'static str,
    /// What is written.
    pub title: &'static str,
    /// File extensions without the dot, in lower case.
    pub extensions: &'static [&'static str],
    /// The encodings that the format has here, its default first.
    pub encodings: &'static [Encoding],
    write: fn(&Problem, Encoding, &mut dyn Write) -> io::Result<()>,
}

/// Every format that meshes are written in.
pub static WRITERS: &[Writer] =
    &[abaqus::WRITER, gmsh::WRITER, medit::WRITER, su2::WRITER, vtk::WRITER, vtu::WRITER];

/// What was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Number of nodes.
    pub nodes: u64,
    /// Number of elements.
    pub elements: u64,
}

/// The writer named `name`.
pub fn writer(name: &str) -> Result<&'static Writer> {
    WRITERS.iter().find(|writer| writer.name == name).ok_or_else(|| {
        let known: Vec<_> = WRITERS.iter().map(|writer| writer.name).collect();
        Error::usage(format!("no mesh is written in a format \"{name}\", only {}", known.join(", ")))
    })
}

/// The writer for a file of this name, by its extension; one of a compression (`.gz`, `.zst`) is passed over.
pub fn writer_for(path: &Path) -> Result<&'static Writer> {
    let (name, _) = place::split_compression(path);
    let extension = name.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    WRITERS.iter().find(|writer| writer.extensions.contains(&extension.as_str())).ok_or_else(|| {
        let known: Vec<_> = WRITERS
            .iter()
            .flat_map(|w| w.extensions.iter().map(|extension| format!(".{extension} ({})", w.name)))
            .collect();
        let found = if extension.is_empty() { "none".into() } else { format!("\".{extension}\"") };
        Error::usage(format!(
            "the mesh's format follows from the file's extension: expected {}, found {found} in {}",
            known.join(", "),
            path.display()
        ))
    })
}

impl Writer {
    /// The encoding that is meant, where the format has it.
    fn encoding(&self, asked: Encoding) -> Result<Encoding> {
        match asked {
            Encoding::Default => Ok(self.encodings[0]),
            _ if self.encodings.contains(&asked) => Ok(asked),
            _ => {
                let known: Vec<_> = self.encodings.iter().map(|encoding| encoding.name()).collect();
                let (name, asked, known) = (self.name, asked.name(), known.join(", "));
                Err(Error::usage(format!("{name} is not written as {asked}, only as {known}")))
            }
        }
    }

    /// Writes the problem's mesh to `out`. Memory does not grow with the mesh.
    pub fn write(&self, problem: &Problem, encoding: Encoding, out: &mut dyn Write) -> Result<Counts> {
        let encoding = self.encoding(encoding)?;
        self.stream(problem, encoding, out).map_err(write_error)?;
        Ok(Counts { nodes: problem.mesh().nodes(), elements: problem.mesh().elements() })
    }

    fn stream(&self, problem: &Problem, encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
        let mut out = BufWriter::with_capacity(1 << 18, out);
        (self.write)(problem, encoding, &mut out)?;
        out.flush()
    }
}

/// A failed write as the library's error: a full disk is the machine's fault.
fn write_error(cause: io::Error) -> Error {
    match cause.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Error::resource("disk space", cause),
        _ => Error::new(Kind::Unwritable(cause)),
    }
}
