//! One array of a VTU file: its values go to scratch in blocks of zlib as they come, since where it stands in the file
//! is known only once all arrays before it are complete.

use std::fs::File;
use std::io::{self, Seek, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::error::Result;
use crate::input::{Scratch, ScratchFile, ScratchShare};

/// Bytes of a block before it is compressed.
const BLOCK: usize = 1 << 16;

/// An array that is being written.
pub(super) struct Array {
    name: String,
    kind: &'static str,
    components: usize,
    pending: Vec<u8>,
    packed: ScratchFile,
    /// Bytes of each block, packed.
    sizes: Vec<u64>,
    /// Number of values.
    values: u64,
}

impl Array {
    /// An empty array of VTK's type `kind`, `components` values a tuple.
    pub(super) fn new(name: &str, kind: &'static str, components: usize, scratch: &Scratch) -> Result<Self> {
        let (name, pending) = (name.to_owned(), Vec::with_capacity(BLOCK));
        Ok(Self { name, kind, components, pending, packed: scratch.file()?, sizes: Vec::new(), values: 0 })
    }

    /// Appends a value as the bytes that the type has, the low one first.
    pub(super) fn push<const BYTES: usize>(&mut self, value: [u8; BYTES]) -> Result<()> {
        self.values += 1;
        self.bytes(&value)
    }

    /// Appends a text as one value, with the 0 that ends it.
    pub(super) fn push_text(&mut self, text: &str) -> Result<()> {
        self.values += 1;
        self.bytes(text.replace('\0', " ").as_bytes())?;
        self.bytes(&[0])
    }

    fn bytes(&mut self, mut bytes: &[u8]) -> Result<()> {
        while !bytes.is_empty() {
            let (now, rest) = bytes.split_at(bytes.len().min(BLOCK - self.pending.len()));
            self.pending.extend_from_slice(now);
            bytes = rest;
            if self.pending.len() == BLOCK {
                self.pack()?;
                self.pending.clear();
            }
        }
        Ok(())
    }

    /// Packs what is pending as one block.
    fn pack(&mut self) -> Result<()> {
        let mut encoder = ZlibEncoder::new(Vec::with_capacity(BLOCK / 2), Compression::new(3));
        let packed = encoder.write_all(&self.pending).and_then(|()| encoder.finish());
        let packed = packed.expect("a vector takes every byte");
        self.sizes.push(packed.len() as u64);
        self.packed.write(&packed)
    }

    /// The array is complete.
    pub(super) fn end(mut self) -> Result<WholeArray> {
        let partial = self.pending.len();
        if partial > 0 {
            self.pack()?;
        }
        let blocks = self.sizes.len() as u64;
        let header = [blocks, BLOCK as u64, partial as u64].into_iter().chain(self.sizes).collect();
        let Self { name, kind, components, values, .. } = self;
        let (file, share) = self.packed.into_file()?;
        Ok(WholeArray { name, kind, components, values, header, file, share })
    }
}

/// An array that is complete.
pub(super) struct WholeArray {
    name: String,
    kind: &'static str,
    components: usize,
    values: u64,
    /// What stands before the blocks: their number, their size, that of the last if it is less, their sizes packed.
    header: Vec<u64>,
    file: File,
    share: ScratchShare,
}

impl WholeArray {
    /// Number of values.
    pub(super) fn values(&self) -> u64 {
        self.values
    }

    /// Bytes that it takes in the file.
    fn len(&self) -> u64 {
        8 * self.header.len() as u64 + self.header[3..].iter().sum::<u64>()
    }

    /// Writes the element that describes it; gives where the next array stands.
    pub(super) fn describe(&self, offset: u64, of_field: bool, out: &mut impl Write) -> io::Result<u64> {
        let Self { name, kind, components, .. } = self;
        let tuples = if of_field { format!(" NumberOfTuples=\"{}\"", self.values) } else { String::new() };
        // Arrays of text have an element of their own.
        let element = if *kind == "String" { "Array" } else { "DataArray" };
        writeln!(
            out,
            "<{element} type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"{tuples} \
             format=\"appended\" offset=\"{offset}\"/>"
        )?;
        Ok(offset + self.len())
    }

    /// Writes what it holds, and gives its scratch space back.
    pub(super) fn write(mut self, out: &mut impl Write) -> io::Result<()> {
        for number in &self.header {
            out.write_all(&number.to_le_bytes())?;
        }
        self.file.rewind()?;
        io::copy(&mut self.file, out)?;
        drop(self.share);
        Ok(())
    }
}
