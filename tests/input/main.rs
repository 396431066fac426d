//! What stands under a file's name, how it is packed, and what is refused: through the public door alone.

mod bombs;
mod limits;
mod opening;
mod packing;
mod streams;
mod unpacking;
