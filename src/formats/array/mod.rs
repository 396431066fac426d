//! Arrays of equal numbers, read through windows wherever they stand, and the nodes and elements that arrays hold.

pub mod coded;
pub mod elements;
pub mod nodes;
pub mod regions;
pub mod structured;
pub mod table;

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Bound, Error, Result};
use crate::formats::binary::Endian;
use crate::input::{Input, ScratchFile, Source, Spot};

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Number {
    /// Number of bytes.
    pub fn width(self) -> u64 {
        match self {
            Number::I8 | Number::U8 => 1,
            Number::I16 | Number::U16 => 2,
            Number::I32 | Number::U32 | Number::F32 => 4,
            Number::I64 | Number::U64 | Number::F64 => 8,
        }
    }
}

/// Where an array stands, before the scratch file is complete.
#[derive(Debug, Clone, Copy)]
pub struct Stored {
    /// Where it came from.
    pub origin: Origin,
    /// Its first byte in the mesh file, or in scratch if it was unpacked.
    pub at: u64,
    pub number: Number,
    pub endian: Endian,
    pub count: u64,
}

/// Where an array came from; errors about its numbers name that place.
#[derive(Debug, Clone, Copy)]
pub enum Origin {
    /// It stands in the mesh file as it is.
    File,
    /// It was unpacked from text: the byte where that starts, and the byte of scratch of its first number.
    Text {
        /// In the mesh file.
        from: u64,
        /// In scratch.
        base: u64,
    },
    /// It was unpacked from what the tag at this byte holds.
    Tag(u64),
    /// It was unpacked from what the record at this byte of binary data describes.
    Record(u64),
}

/// What has been unpacked of a file so far. All of it goes to one scratch file: a mesh may have very many pieces.
#[derive(Debug)]
pub struct Unpacked<'i> {
    input: &'i Input,
    file: Option<ScratchFile>,
    len: u64,
}

impl<'i> Unpacked<'i> {
    /// Nothing yet.
    pub fn new(input: &'i Input) -> Self {
        Self { input, file: None, len: 0 }
    }

    /// Number of bytes so far: where the next array starts.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Appends bytes.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        self.len += bytes.len() as u64;
        let limit = self.input.limits.unpacked_bytes;
        if self.len > limit {
            return Err(Error::limit_of(Bound::UnpackedBytes, "unpacked size", format!("{limit} bytes")));
        }
        let file = match &mut self.file {
            Some(file) => file,
            None => self.file.insert(self.input.scratch.file()?),
        };
        file.write(bytes)
    }

    /// Ends unpacking: from here on arrays can be read.
    pub fn finish(self) -> Result<Stores> {
        let file = Arc::clone(&self.input.source);
        let scratch = match self.file {
            Some(scratch) => Arc::new(scratch.into_source(file.path())?),
            None => Arc::clone(&file),
        };
        Ok(Stores { file, scratch })
    }
}

/// The mesh file and what was unpacked of it.
#[derive(Debug)]
pub struct Stores {
    /// The mesh file.
    pub file: Arc<Source>,
    scratch: Arc<Source>,
}

impl Stores {
    /// An array of no numbers.
    pub fn nothing(&self) -> Array {
        let (number, endian) = (Number::U8, Endian::Little);
        let stored = Stored { origin: Origin::File, at: 0, number, endian, count: 0 };
        Array { source: Arc::clone(&self.file), stored, file: None }
    }

    /// The array that was stored.
    pub fn array(&self, stored: Stored, name: &str) -> Result<Array> {
        let source = if matches!(stored.origin, Origin::File) { &self.file } else { &self.scratch };
        check_fits(source, &stored, name)?;
        Ok(Array { source: Arc::clone(source), stored, file: None })
    }
}

/// The byte after an array, which must lie in the file.
pub fn check_fits(source: &Source, stored: &Stored, name: &str) -> Result<u64> {
    let bytes = stored.count.checked_mul(stored.number.width());
    match bytes.and_then(|bytes| stored.at.checked_add(bytes)) {
        Some(end) if end <= source.len() => Ok(end),
        _ => {
            let (count, width) = (stored.count, stored.number.width());
            let what = format!("{count} numbers of {width} bytes ({name}) from byte {}", stored.at);
            Err(source.truncated(what))
        }
    }
}

/// An array that lies in a mapped file, every byte of it.
#[derive(Debug, Clone)]
pub struct Array {
    source: Arc<Source>,
    stored: Stored,
    /// The file that it was unpacked from, where it is not the mesh file.
    file: Option<Arc<Source>>,
}

macro_rules! convert {
    ($type:ty, ($($cast:tt)*), $endian:expr, $bytes:expr, $out:expr) => {{
        let (raw, _) = $bytes.as_chunks::<{ size_of::<$type>() }>();
        match $endian {
            Endian::Little => $out.extend(raw.iter().map(|raw| <$type>::from_le_bytes(*raw) $($cast)*)),
            Endian::Big => $out.extend(raw.iter().map(|raw| <$type>::from_be_bytes(*raw) $($cast)*)),
        }
    }};
}

macro_rules! convert_any {
    ($number:expr, $cast:tt, $endian:expr, $bytes:expr, $out:expr) => {
        match $number {
            Number::I8 => convert!(i8, $cast, $endian, $bytes, $out),
            Number::U8 => convert!(u8, $cast, $endian, $bytes, $out),
            Number::I16 => convert!(i16, $cast, $endian, $bytes, $out),
            Number::U16 => convert!(u16, $cast, $endian, $bytes, $out),
            Number::I32 => convert!(i32, $cast, $endian, $bytes, $out),
            Number::U32 => convert!(u32, $cast, $endian, $bytes, $out),
            Number::I64 => convert!(i64, $cast, $endian, $bytes, $out),
            Number::U64 => convert!(u64, $cast, $endian, $bytes, $out),
            Number::F32 => convert!(f32, $cast, $endian, $bytes, $out),
            Number::F64 => convert!(f64, $cast, $endian, $bytes, $out),
        }
    };
}

impl Number {
    /// Adds the whole numbers among `bytes`; of reals the whole parts. Negative ones come out as numbers over [`i64::MAX`].
    pub fn integers(self, endian: Endian, bytes: &[u8], out: &mut Vec<u64>) {
        convert_any!(self, (as i64 as u64), endian, bytes, out);
    }
}

impl Array {
    /// The array that stands in the file itself, every byte of it.
    pub fn in_file(file: &Arc<Source>, stored: Stored) -> Self {
        Self { source: Arc::clone(file), stored, file: None }
    }

    /// The file that errors are to name.
    pub fn source(&self) -> &Arc<Source> {
        self.file.as_ref().unwrap_or(&self.source)
    }

    /// The array, with the file that it was unpacked from.
    pub fn of_file(self, file: &Arc<Source>) -> Self {
        Self { file: Some(Arc::clone(file)), ..self }
    }

    /// Number of numbers.
    pub fn len(&self) -> u64 {
        self.stored.count
    }

    /// Number of bytes of one number.
    pub fn width(&self) -> u64 {
        self.stored.number.width()
    }

    /// The numbers of `range`, cut to the array's end, as an array.
    pub fn part(&self, range: Range<u64>) -> Self {
        let end = range.end.min(self.len());
        let start = range.start.min(end);
        let at = self.stored.at + start * self.width();
        Self { stored: Stored { at, count: end - start, ..self.stored }, ..self.clone() }
    }

    /// The array without its first number.
    pub fn without_first(mut self) -> Self {
        if self.stored.count > 0 {
            self.stored.count -= 1;
            self.stored.at += self.width();
        }
        self
    }

    /// Where number `index` stands in the mesh file, or the tag that holds it.
    #[inline]
    pub fn spot(&self, index: u64) -> Spot {
        let at = self.stored.at + index * self.width();
        match self.stored.origin {
            Origin::File => Spot::Binary(at),
            Origin::Text { from, base } => Spot::Token { from, number: (at - base) / self.width() },
            Origin::Tag(at) => Spot::Text(at),
            Origin::Record(at) => Spot::Binary(at),
        }
    }

    /// Replaces `out` with the whole numbers of `range`. Negative ones come out as numbers over [`i64::MAX`].
    pub fn integers(&self, range: Range<u64>, out: &mut Vec<u64>) {
        out.clear();
        let bytes = self.source.window(self.bytes_of(&range));
        self.stored.number.integers(self.stored.endian, &bytes, out);
    }

    /// Replaces `out` with the numbers of `range`.
    pub fn reals(&self, range: Range<u64>, out: &mut Vec<f64>) {
        out.clear();
        let bytes = self.source.window(self.bytes_of(&range));
        convert_any!(self.stored.number, (as f64), self.stored.endian, bytes, out);
    }

    fn bytes_of(&self, range: &Range<u64>) -> Range<u64> {
        let end = range.end.min(self.len());
        let start = range.start.min(end);
        self.stored.at + start * self.width()..self.stored.at + end * self.width()
    }
}

/// Whole numbers of an array, read ahead in batches.
#[derive(Debug)]
pub struct Reader<'a> {
    array: &'a Array,
    from: u64,
    values: Vec<u64>,
}

impl<'a> Reader<'a> {
    /// Most numbers that are held at once.
    pub const BATCH: u64 = 64 << 10;

    /// A reader of `array`.
    pub fn new(array: &'a Array) -> Self {
        Self { array, from: 0, values: Vec::new() }
    }

    /// The numbers of `range`, which lies in the array and is at most [`Self::BATCH`] long. The caller may change them
    /// as long as it does not ask for the same numbers again. `ahead` is where reading ahead shall stop.
    #[inline]
    pub fn get(&mut self, range: Range<u64>, ahead: u64) -> &mut [u64] {
        debug_assert!(range.end <= self.array.len() && range.end - range.start <= Self::BATCH);
        if range.start < self.from || range.end > self.from + self.values.len() as u64 {
            let end = ahead.min(range.start + Self::BATCH).max(range.end);
            self.array.integers(range.start..end, &mut self.values);
            self.from = range.start;
        }
        let start = (range.start - self.from) as usize;
        &mut self.values[start..start + (range.end - range.start) as usize]
    }
}
