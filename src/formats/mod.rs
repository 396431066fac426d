//! Formats: bytes to nodes and elements.
//!
//! A format does two things. It *outlines* a file: says where the node records and the element records stand, cut into
//! pieces of bounded size. And its layouts *decode* one piece. It knows no thread, no channel and no measure. Every
//! format is one file here and one row of [`FORMATS`].

mod abaqus;
mod ansys;
mod array;
mod axes;
mod batch;
pub mod binary;
#[cfg(feature = "hdf5")]
mod cgns;
pub mod columns;
mod comsol;
pub mod degenerate;
mod exodus;
mod facts;
mod femgv;
mod foreign;
mod gmsh;
#[cfg(feature = "hdf5")]
mod hdf5;
mod lsdyna;
mod matlab;
#[cfg(feature = "hdf5")]
mod med;
mod medit;
mod nag;
mod nastran;
mod netcdf;
mod netgen;
mod openfoam;
mod plain;
mod plan;
#[cfg(test)]
pub(crate) mod reading;
mod rows;
mod simplex;
mod sink;
mod su2;
mod surface;
mod sweeps;
#[cfg(test)]
mod testing;
pub mod text;
mod ugrid;
mod unv;
mod vtk;
pub mod words;
mod xdmf;

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::error::Result;
use crate::input::{Input, Limits, Scratch, Source};
use crate::mesh::{ElementType, Shape};

pub use batch::NodeBatch;
pub use facts::{Facts, facts};
pub use foreign::foreign;
pub use plan::Plan;
pub use sink::{BLOCK, Chunks, ElementSink, Ledger, TypeCount};
pub use sweeps::SWEEPS;

/// The number of bytes that a piece aims at. It does not depend on threads or budget: chunks, and so the last bits of
/// every mean, follow from it.
pub const PIECE_BYTES: u64 = 1 << 20;

/// A mesh format: a row of [`FORMATS`].
pub trait Format: Sync {
    /// The name that users type: `--mesh-format gmsh`.
    fn name(&self) -> &'static str;
    /// What the format is, its versions and encodings that are read.
    fn title(&self) -> &'static str;
    /// File extensions without the dot, in lower case; only a hint.
    fn extensions(&self) -> &'static [&'static str];
    /// What is looked for in the content, for the error that lists it.
    fn looks_for(&self) -> &'static str;
    /// Whether the first bytes (at most [`HEAD_BYTES`]) are of this format.
    fn detect(&self, head: &[u8]) -> bool;
    /// Whether the file is of this format: for containers whose directory may stand anywhere in the file, so that the
    /// first bytes cannot tell.
    fn knows(&self, input: &Input) -> bool {
        self.detect(input.source.peek(0..HEAD_BYTES as u64))
    }
    /// Shapes whose orientation the format's writers do not agree on: each such shape is judged by its own majority
    /// instead of the mesh's.
    fn own_orientation(&self) -> &'static [Shape] {
        &[]
    }
    /// The files, the main one first, of the mesh that stands under `path`, where a mesh of this format is several files in
    /// a folder. `path` is that folder where `is_folder`, else one of the files. Names alone decide, and the disk is asked
    /// only about names that may be such files: folders with a million others are read through.
    fn files(&self, _path: &Path, _is_folder: bool) -> Option<Result<Vec<PathBuf>>> {
        None
    }
    /// What the format divides elements into, as its users call it: `physical groups`, `parts`. Its layouts call
    /// [`ElementSink::region`]. Nothing where the format has no such thing, or it is not read.
    fn regions(&self) -> Option<&'static str> {
        None
    }
    /// Says where the node and element records stand, in file order. Headers are not believed: what is yielded must lie
    /// in the file.
    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()>;
}

/// How much of a file detection looks at.
pub const HEAD_BYTES: usize = 64 << 10;

/// Takes the pieces of a file as a format finds them.
pub trait Outline {
    /// A piece of node records. Pieces of nodes may come before, between or after those of elements.
    fn nodes(&mut self, piece: Piece<dyn NodeLayout>) -> Result<()>;
    /// A piece of element records.
    fn elements(&mut self, piece: Piece<dyn ElementLayout>) -> Result<()>;
    /// Elements that are counted and not measured, and that no piece will speak of.
    fn count(&mut self, kind: &ElementType, count: u64) -> Result<()>;
}

/// A run of records that one call decodes, in bounded memory.
#[derive(Debug)]
pub struct Piece<L: ?Sized> {
    /// Who can decode it.
    pub layout: Arc<L>,
    /// What of the layout's records: byte positions or record numbers, as the layout likes.
    pub span: Range<u64>,
}

impl<L: ?Sized> Clone for Piece<L> {
    fn clone(&self) -> Self {
        Self { layout: Arc::clone(&self.layout), span: self.span.clone() }
    }
}

/// Decodes node records.
pub trait NodeLayout: Send + Sync {
    /// The file that the records stand in, for errors and progress.
    fn source(&self) -> &Source;
    /// Decodes the nodes of `span`. Coordinates must be finite: the batch refuses others.
    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()>;
}

/// Decodes element records.
pub trait ElementLayout: Send + Sync {
    /// The file that the records stand in, for errors and progress.
    fn source(&self) -> &Source;
    /// Decodes the elements of `span`.
    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()>;
}

/// Every format that is read; detection tries them in this order.
pub static FORMATS: &[&dyn Format] = &[
    &gmsh::Gmsh,
    &abaqus::Abaqus,
    &vtk::Legacy,
    &vtk::Vtu,
    &comsol::Comsol,
    &simplex::TRIANGLE,
    &simplex::TETGEN,
    &nag::Nag,
    &medit::Medit,
    &su2::Su2,
    &netgen::Netgen,
    &ugrid::Ugrid,
    &nastran::Nastran,
    &matlab::Matlab,
    &surface::Off,
    &surface::Ply,
    &surface::Stl,
    &surface::Obj,
    &femgv::Frd,
    &femgv::Femgv,
    &unv::Unv,
    &ansys::Ansys,
    &lsdyna::Lsdyna,
    &openfoam::OpenFoam,
    &exodus::Exodus,
    #[cfg(feature = "hdf5")]
    &med::Med,
    #[cfg(feature = "hdf5")]
    &cgns::Cgns,
    #[cfg(feature = "hdf5")]
    &vtk::VtkHdf,
    &xdmf::Xdmf,
];

/// The format named `name`.
pub fn find(name: &str) -> Option<&'static dyn Format> {
    FORMATS.iter().copied().find(|f| f.name() == name)
}

/// The files, the main one first, of a mesh that is several files: [`Format::files`] of whichever format knows them.
pub fn files(path: &Path) -> Option<Result<Vec<PathBuf>>> {
    files_of(path, path.is_dir())
}

/// As [`files`], for one who knows whether `path` is a folder.
pub fn files_of(path: &Path, is_folder: bool) -> Option<Result<Vec<PathBuf>>> {
    FORMATS.iter().find_map(|format| format.files(path, is_folder))
}

/// Opens the mesh at `path`: a file, or several that [`files`] finds.
pub fn open(path: &Path, limits: &Limits, scratch: &Scratch) -> Result<Input> {
    match files(path) {
        Some(files) => Input::open_together(path, &files?, limits, scratch),
        None => Input::open(path, limits, scratch),
    }
}
