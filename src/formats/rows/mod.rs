//! What formats of plain tables share: a table is a count and as many rows of numbers. Rows of text are told by their
//! numbers, whatever lines those stand on ([`TokenReader`]), or by their lines ([`pass_lines`]); binary rows are of one width.
//! Nodes and elements of such tables have no numbers of their own: their position counts, from 1.

mod lines;
mod numbers;
mod records;
mod tables;
mod tokens;

pub use lines::{pass_lines, pass_node_lines};
pub use numbers::Numbers;
pub use records::{ElementRecords, NodeRecords, Words};
pub use tables::{Table, outline_elements, outline_nodes};
pub use tokens::TokenReader;

/// Whether a byte stands between numbers.
#[inline]
fn is_blank(byte: u8) -> bool {
    byte == b' ' || byte.wrapping_sub(b'\t') < 5
}
