//! MAT-files of version 4: matrix after matrix, each with a head of five numbers and its name. Nothing at the start of the
//! file says what it is, so that the head of the first matrix must be one in every way.

use std::sync::Arc;

use super::choose;
use super::contents::{Contents, MOST_MATRICES};
use super::store::Matrix;
use crate::error::{Error, Result};
use crate::formats::array::{Array, Number, Origin, Stored, check_fits};
use crate::formats::binary::Endian;
use crate::input::{Source, Spot};

/// Bytes of a head without the name.
const HEAD: u64 = 20;
/// Most letters of a name, with the zero that ends it.
const LONGEST_NAME: u64 = 64;

/// The head of a matrix.
struct Head {
    endian: Endian,
    number: Number,
    /// Numbers, text or a sparse matrix.
    kind: u32,
    rows: u64,
    columns: u64,
    is_complex: bool,
    name: String,
    /// Bytes of the head with its name.
    len: u64,
}

impl Head {
    /// The head at the start of `bytes`, if one stands there.
    fn read(bytes: &[u8]) -> Option<Self> {
        let [little, big] =
            [Endian::Little, Endian::Big].map(|endian| endian.u32(bytes.get(..4).unwrap_or(&[0xff; 4])));
        // The digits of the type: the machine, zero, how numbers are stored, what they are.
        let (endian, code) = match (little, big) {
            (0..1000, _) => (Endian::Little, little),
            (_, 1000..2000) => (Endian::Big, big - 1000),
            _ => return None,
        };
        let word = |k: usize| bytes.get(4 * k..4 * k + 4).map(|bytes| endian.u32(bytes));
        let number = match code / 10 {
            0 => Number::F64,
            1 => Number::F32,
            2 => Number::I32,
            3 => Number::I16,
            4 => Number::U16,
            5 => Number::U8,
            _ => return None,
        };
        let (rows, columns, imaginary, len) = (word(1)?, word(2)?, word(3)?, u64::from(word(4)?));
        let name = bytes.get(HEAD as usize..(HEAD + len.min(LONGEST_NAME)) as usize)?;
        let (last, letters) = name.split_last()?;
        let is_name = *last == 0
            && letters.first().is_some_and(u8::is_ascii_alphabetic)
            && letters.iter().all(|letter| letter.is_ascii_alphanumeric() || *letter == b'_');
        let most = i32::MAX as u32;
        let fits = code % 10 <= 2 && imaginary <= 1 && rows <= most && columns <= most && len <= LONGEST_NAME;
        (is_name && fits).then(|| Self {
            endian,
            number,
            kind: code % 10,
            rows: rows.into(),
            columns: columns.into(),
            is_complex: imaginary == 1,
            name: String::from_utf8_lossy(letters).into_owned(),
            len: HEAD + len,
        })
    }
}

/// Whether a file starts as one of version 4 does.
pub(super) fn detect(head: &[u8]) -> bool {
    Head::read(head).is_some_and(|head| head.rows > 0 && head.columns > 0)
}

/// Reads what the file holds.
pub(super) fn read(source: &Arc<Source>) -> Result<Contents> {
    let (mut contents, mut at) = (Contents::default(), 0);
    while at < source.len() {
        let Some(head) = Head::read(source.peek(at..at + HEAD + LONGEST_NAME)) else {
            return Err(source.malformed_binary(at, "the head of a matrix of MATLAB 4", "another"));
        };
        let Head { endian, number, rows, columns, ref name, .. } = head;
        let count = rows * columns;
        let stored = Stored { origin: Origin::File, at: at + head.len, number, endian, count };
        let parts = if head.is_complex { 2 } else { 1 };
        let all = Stored { count: count.saturating_mul(parts), ..stored };
        let end = check_fits(source, &all, name)?;
        match (head.kind, head.is_complex) {
            (0, false) if choose::may_be_of_mesh(name) => {
                if contents.matrices.len() >= MOST_MATRICES {
                    let error = Error::limit("number of matrices that may be of a mesh", MOST_MATRICES);
                    return Err(source.place(error, Spot::Binary(at)));
                }
                let numbers = Array::in_file(source, stored);
                contents.matrices.push(Matrix { path: name.clone(), rows, columns, numbers });
            }
            (0, false) => contents.other(name, "numbers"),
            (0, true) => contents.other(name, "complex numbers"),
            (1, _) => contents.other(name, "text"),
            _ => contents.other(name, "a sparse matrix"),
        }
        at = end;
    }
    Ok(contents)
}
