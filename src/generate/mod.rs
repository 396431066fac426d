//! Model problems and the writers of their meshes.
