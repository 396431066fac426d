//! The VTK family: legacy files ([`Legacy`], `.vtk`) and XML files ([`Vtu`], `.vtu` and others).
//!
//! Both hold the same four arrays: points, connectivity, offsets and cell types; or a structured grid ([`grid`]). Arrays that stand in the file as plain
//! binary numbers are read where they stand; text, base64 and compressed arrays are unpacked to scratch first. From
//! there on one [`layout`] serves both.
//!
//! Cells and points have no numbers of their own: both are counted from 0 over the whole file, as ParaView shows them.
//!
//! VTK 9.7 turned its wedges round: what it writes is in our corner order, what older versions call sound has the two
//! triangles the other way round, and writers of both kinds are about. Corners are kept as they stand; the sign of a
//! wedge's volume means something only against the other wedges of its mesh.

pub(super) mod ascii;
mod cells;
mod grid;
#[cfg(feature = "hdf5")]
mod hdf;
mod layout;
mod legacy;
mod lists;
mod marks;
pub(super) mod markup;
mod payload;
mod points;
pub(super) mod role;
mod xml;

#[cfg(test)]
mod tests;

#[cfg(feature = "hdf5")]
pub use hdf::VtkHdf;
pub use legacy::Legacy;
pub use xml::Vtu;
