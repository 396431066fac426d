//! Surfaces: what OFF, PLY, OBJ and STL share. Their elements are faces of so many corners, and nothing else.

mod faces;
mod obj;
mod off;
mod ply;
mod rows;
mod stl;
#[cfg(test)]
mod tests;

pub(super) use obj::Obj;
pub(super) use off::Off;
pub(super) use ply::Ply;
pub(super) use stl::Stl;
