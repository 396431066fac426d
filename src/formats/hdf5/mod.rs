//! HDF5 files: groups, datasets and attributes by name, on top of the crate that decodes the container.
//!
//! The directory of such a file stands anywhere in it, so that formats built on it look into the tree to know their own.
//! Numbers that stand in the file as one plain run are read where they are; chunked and packed ones are unpacked to
//! scratch, slab by slab ([`slabs`]). Links into other files, and raw data in other files, are refused.

mod old_layout;
mod slabs;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use hdf5_reader::messages::HdfMessage;
use hdf5_reader::storage::{Storage, StorageBuffer};
use hdf5_reader::{ByteOrder, Datatype, Hdf5File, OpenOptions};

use crate::error::{Error, Result};
use crate::formats::array::{Array, Number, Origin, Stored, Unpacked, check_fits};
use crate::formats::binary::Endian;
use crate::input::{Input, Source, Spot};
use old_layout::OldLayout;

/// What an HDF5 file starts with, perhaps behind a block of the user's own.
const MAGIC: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Largest chunk, unpacked.
const LARGEST_CHUNK: usize = 128 << 20;
/// Most that is read of the file at once: a chunk as it stands there, at worst packed into more bytes than it has.
const LARGEST_READ: usize = LARGEST_CHUNK + (LARGEST_CHUNK >> 3);
/// Most bytes of an object's header.
const LARGEST_HEADER: usize = 16 << 20;
/// Most bytes of unpacked chunks that are kept.
const CACHE: usize = 16 << 20;

/// Whether a file starts as an HDF5 file does.
pub fn detect(head: &[u8]) -> bool {
    [0, 512, 1024, 2048, 4096].iter().any(|at| head.get(*at..).is_some_and(|rest| rest.starts_with(MAGIC)))
}

/// An open file.
pub struct Hdf5 {
    source: Arc<Source>,
    file: Hdf5File,
    /// The byte that the file's own places count from.
    base: u64,
}

/// The mapped file, as the crate reads it.
struct Mapped(Arc<Source>);

impl Storage for Mapped {
    fn len(&self) -> u64 {
        self.0.len()
    }

    fn read_range(&self, offset: u64, len: usize) -> hdf5_reader::error::Result<StorageBuffer> {
        let end = offset.checked_add(len as u64).filter(|end| *end <= self.0.len());
        let Some(end) = end else {
            let available = self.0.len().saturating_sub(offset);
            return Err(hdf5_reader::error::Error::UnexpectedEof { offset, needed: len as u64, available });
        };
        if len > LARGEST_READ {
            let what = format!("{len} bytes of the file at once");
            return Err(hdf5_reader::error::Error::ResourceLimit(what));
        }
        Ok(StorageBuffer::from_vec(self.0.window(offset..end).to_vec()))
    }
}

impl Hdf5 {
    /// Opens the file, which must not end before it says.
    pub fn open(input: &Input) -> Result<Self> {
        Self::of_source(&input.source)
    }

    /// Opens the HDF5 file `source`.
    pub fn of_source(source: &Arc<Source>) -> Result<Self> {
        let options = OpenOptions::default()
            .with_chunk_cache_bytes(CACHE)
            .with_max_chunk_bytes(LARGEST_CHUNK)
            .with_max_read_bytes(LARGEST_CHUNK)
            .with_max_object_header_bytes(LARGEST_HEADER);
        let storage = Arc::new(Mapped(Arc::clone(source)));
        let opened = Hdf5File::from_storage_with_options(storage, options);
        let file = opened.map_err(|error| place(source, error, 0))?;
        let (base, end) = (file.superblock().base_address, file.superblock().eof_address);
        if end > source.len() {
            return Err(source.truncated(format!("an HDF5 file of {end} bytes")));
        }
        Ok(Self { source: Arc::clone(source), file, base })
    }

    /// The file itself.
    pub fn source(&self) -> &Arc<Source> {
        &self.source
    }

    /// The group that all else is in.
    pub fn root(&self) -> Result<Group<'_>> {
        let inner = self.file.root_group().map_err(|error| place(&self.source, error, self.base))?;
        Ok(Group { file: self, inner })
    }
}

/// An error of the crate, at a byte of the file.
fn place(source: &Source, error: hdf5_reader::error::Error, at: u64) -> Error {
    use hdf5_reader::error::Error::*;
    if let Context { source: inner, .. } = error {
        return place(source, *inner, at);
    }
    let text = error.to_string();
    let error = match error {
        UnexpectedEof { offset, needed, .. } if offset.saturating_add(needed) > source.len() => {
            return source.truncated(format!("{needed} bytes from byte {offset}"));
        }
        ResourceLimit(what) => Error::limit(format!("HDF5 ({what})"), "what is read at once"),
        UnsupportedFilter(_)
        | UnsupportedEncoding(_)
        | UnsupportedLinkType(_)
        | UnsupportedLayoutVersion(_)
        | UnsupportedSuperblockVersion(_)
        | UnsupportedDatatypeClass(_)
        | UnsupportedChunkIndexType(_) => Error::unsupported(format!("HDF5: {text}")),
        _ => Error::malformed("a sound HDF5 file", text),
    };
    source.place(error, Spot::Binary(at))
}

/// A group.
#[derive(Clone)]
pub struct Group<'f> {
    file: &'f Hdf5,
    inner: hdf5_reader::group::Group,
}

impl<'f> Group<'f> {
    /// Its own name.
    pub fn name(&self) -> &str {
        self.inner.name()
    }

    /// Where it is described.
    pub fn spot(&self) -> Spot {
        Spot::Binary(self.at())
    }

    fn at(&self) -> u64 {
        self.file.base.saturating_add(self.inner.address())
    }

    /// The mesh file.
    pub fn source(&self) -> &'f Arc<Source> {
        &self.file.source
    }

    /// An error that names this group.
    pub fn malformed(&self, expected: impl Into<String>, found: impl Into<String>) -> Error {
        self.source().place(Error::malformed(expected, found), self.spot())
    }

    fn known<T>(&self, found: hdf5_reader::error::Result<T>) -> Result<Option<T>> {
        use hdf5_reader::error::Error::{AttributeNotFound, DatasetNotFound, GroupNotFound};
        match found {
            Ok(found) => Ok(Some(found)),
            Err(GroupNotFound(_) | DatasetNotFound(_) | AttributeNotFound(_)) => Ok(None),
            Err(error) => Err(place(self.source(), error, self.at())),
        }
    }

    /// The groups and the datasets in it, by name.
    pub fn names(&self) -> Result<(Vec<String>, Vec<String>)> {
        self.inner.member_names().map_err(|error| place(self.source(), error, self.at()))
    }

    /// The group `name` in it.
    pub fn group(&self, name: &str) -> Result<Option<Group<'f>>> {
        Ok(self.known(self.inner.group(name))?.map(|inner| Group { file: self.file, inner }))
    }

    /// All groups in it.
    pub fn groups(&self) -> Result<Vec<Group<'f>>> {
        let names = self.names()?.0;
        let groups = names.iter().map(|name| self.group(name));
        Ok(groups.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect())
    }

    /// The dataset `name` in it.
    pub fn dataset(&self, name: &str) -> Result<Option<Dataset<'f>>> {
        Ok(self.known(self.inner.dataset(name))?.map(|inner| Dataset { file: self.file, inner }))
    }

    /// The dataset `name`, which must be there.
    pub fn needed(&self, name: &str) -> Result<Dataset<'f>> {
        let found = self.dataset(name)?;
        found.ok_or_else(|| {
            self.malformed(format!("the dataset {name} in {}", self.name()), "none of that name")
        })
    }

    /// The text of an attribute; `None` where there is none, or where it is no text.
    pub fn text(&self, attribute: &str) -> Result<Option<String>> {
        Ok(self.known(self.inner.attribute(attribute))?.and_then(|found| text(&found)))
    }

    /// The whole number of an attribute; `None` where there is none, or where it is no number.
    pub fn integer(&self, attribute: &str) -> Result<Option<i64>> {
        let found = self.known(self.inner.attribute(attribute))?;
        Ok(found.and_then(|found| found.read_as_f64().ok()).map(|value| value as i64))
    }

    /// Whether it has the attribute.
    pub fn has(&self, attribute: &str) -> Result<bool> {
        Ok(self.known(self.inner.attribute(attribute))?.is_some())
    }
}

/// The text of an attribute, without blanks and zeros round it.
fn text(attribute: &hdf5_reader::Attribute) -> Option<String> {
    let text = attribute.read_string().ok()?;
    Some(text.trim_matches(['\0', ' ']).to_owned())
}

/// A dataset.
#[derive(Clone)]
pub struct Dataset<'f> {
    file: &'f Hdf5,
    inner: hdf5_reader::Dataset,
}

impl Dataset<'_> {
    /// Its own name.
    pub fn name(&self) -> &str {
        self.inner.name()
    }

    /// Number of entries along each dimension, the slowest first.
    pub fn shape(&self) -> &[u64] {
        self.inner.shape()
    }

    /// Number of entries; as good as endless where it is more than a number can say.
    pub fn len(&self) -> u64 {
        self.shape().iter().copied().fold(1, u64::saturating_mul)
    }

    /// Where it is described: a byte of the file.
    pub fn at(&self) -> u64 {
        self.file.base.saturating_add(self.inner.address())
    }

    /// An error that names this dataset.
    pub fn malformed(&self, expected: impl Into<String>, found: impl Into<String>) -> Error {
        self.placed(Error::malformed(expected, found))
    }

    fn placed(&self, error: Error) -> Error {
        self.file.source.place(error, Spot::Binary(self.at()))
    }

    fn wrong(&self, error: hdf5_reader::error::Error) -> Error {
        place(&self.file.source, error, self.at())
    }

    /// The text of an attribute; `None` where there is none, or where it is no text.
    pub fn text(&self, attribute: &str) -> Option<String> {
        self.inner.attribute(attribute).ok().and_then(|found| text(&found))
    }

    /// The whole number of an attribute; `None` where there is none, or where it is no number.
    pub fn integer(&self, attribute: &str) -> Option<i64> {
        let found = self.inner.attribute(attribute).ok()?;
        found.read_as_f64().ok().map(|value| value as i64)
    }

    /// Its bytes, where there are at most `most` of them: names, one after another, each of equal length.
    pub fn letters(&self, most: usize) -> Result<Option<Vec<u8>>> {
        if self.inner.raw_byte_len().is_ok_and(|bytes| bytes <= most) {
            return self.inner.read_raw_bytes().map(Some).map_err(|error| self.wrong(error));
        }
        Ok(None)
    }

    /// Whether it is of numbers.
    pub fn is_of_numbers(&self) -> bool {
        number(self.inner.dtype()).is_some()
    }

    /// Its numbers, of which there may be at most `most`; of reals the whole parts.
    pub fn integers(&self, most: u64) -> Result<Vec<i64>> {
        let (number, endian) = self.number()?;
        if self.len() > most {
            let expected = format!("at most {most} numbers ({})", self.name());
            return Err(self.malformed(expected, format!("{}", self.len())));
        }
        let mut values = Vec::new();
        match self.plain_run()? {
            Some(at) => {
                let stored = self.stored_in_file(at, number, endian)?;
                Array::in_file(&self.file.source, stored).integers(0..stored.count, &mut values);
            }
            None => slabs::read(self, number, |bytes| {
                number.integers(Endian::NATIVE, bytes, &mut values);
                Ok(())
            })?,
        }
        Ok(values.into_iter().map(u64::cast_signed).collect())
    }

    fn number(&self) -> Result<(Number, Endian)> {
        let expected = || self.malformed(format!("numbers ({})", self.name()), "a dataset of another type");
        number(self.inner.dtype()).ok_or_else(expected)
    }

    fn stored_in_file(&self, at: u64, number: Number, endian: Endian) -> Result<Stored> {
        let stored = Stored { origin: Origin::File, at, number, endian, count: self.len() };
        check_fits(&self.file.source, &stored, self.name()).map_err(|error| self.placed(error))?;
        Ok(stored)
    }

    /// Finds its numbers, or unpacks them.
    pub fn store(&self, input: &Input, unpacked: &mut Unpacked<'_>) -> Result<Stored> {
        let (number, endian) = self.number()?;
        let count = self.len();
        if let Some(at) = self.plain_run()? {
            return self.stored_in_file(at, number, endian);
        }
        self.check_size(input, count.saturating_mul(number.width()))?;
        let stored = Stored {
            origin: Origin::Record(self.at()),
            at: unpacked.len(),
            number,
            endian: Endian::NATIVE,
            count,
        };
        slabs::read(self, number, |bytes| unpacked.write(bytes))?;
        Ok(stored)
    }

    /// Where its numbers start in the file, if they stand there as one plain run.
    fn plain_run(&self) -> Result<Option<u64>> {
        let Hdf5 { source, file, base } = self.file;
        let refuse =
            |what: &str| Err(self.placed(Error::unsupported(format!("HDF5: {} {what}", self.name()))));
        match old_layout::find(source, *base, self.inner.address(), file.superblock().offset_size) {
            Some(OldLayout::Plain(at)) if at < u64::MAX >> 1 => return Ok(Some(base.saturating_add(at))),
            Some(_) => return refuse("is stored in chunks of HDF5 before 1.6.3: h5repack makes them new"),
            None => {}
        }
        let header = file.get_or_parse_header(self.inner.address()).map_err(|error| self.wrong(error))?;
        let mut address = None;
        for message in &header.messages {
            match message {
                HdfMessage::ExternalFiles(_) => return refuse("stands in another file"),
                HdfMessage::DataLayout(message) => address = slabs::plain_run(&message.layout, self.len()),
                _ => {}
            }
        }
        Ok(address.map(|at| base.saturating_add(at)))
    }

    /// Numbers that were never written take no room in the file, however many they are.
    fn check_size(&self, input: &Input, bytes: u64) -> Result<()> {
        /// The ratio is not looked at before so many bytes.
        const FREE: u64 = 64 << 20;
        let (limits, file) = (&input.limits, &self.file.source);
        if bytes > FREE && bytes / limits.unpacked_ratio > file.len() {
            let error = Error::limit("bytes unpacked from one byte", limits.unpacked_ratio);
            return Err(self.placed(error));
        }
        Ok(())
    }
}

/// How the numbers of a type are stored.
fn number(kind: &Datatype) -> Option<(Number, Endian)> {
    let (number, order) = match kind {
        Datatype::FixedPoint { size, signed, byte_order } => {
            let number = match (size, signed) {
                (1, true) => Number::I8,
                (1, false) => Number::U8,
                (2, true) => Number::I16,
                (2, false) => Number::U16,
                (4, true) => Number::I32,
                (4, false) => Number::U32,
                (8, true) => Number::I64,
                (8, false) => Number::U64,
                _ => return None,
            };
            (number, byte_order)
        }
        Datatype::FloatingPoint { size: 4, byte_order } => (Number::F32, byte_order),
        Datatype::FloatingPoint { size: 8, byte_order } => (Number::F64, byte_order),
        _ => return None,
    };
    let endian = match order {
        ByteOrder::LittleEndian => Endian::Little,
        ByteOrder::BigEndian => Endian::Big,
    };
    Some((number, endian))
}
