//! Where the numbers of an item are: in the XML file, in a dataset of an HDF5 file, in a binary file. The files that are
//! named must lie beneath the XML file's own folder.

use std::path::Path;
use std::sync::Arc;

use super::light::{Item, Place};
use crate::error::{Error, Result};
use crate::formats::array::{Array, Number, Origin, Stored, Stores, Unpacked, check_fits};
#[cfg(feature = "hdf5")]
use crate::formats::hdf5::Hdf5;
use crate::formats::vtk::{ascii, role::Role};
use crate::input::{Input, Sibling, Siblings, Source, Spot};

/// Longest name of a file and of a dataset in it.
const LONGEST_NAME: u64 = 4096;

/// Numbers that were found or unpacked.
pub(super) struct Found {
    stored: Stored,
    /// The file that they stand in, if they stand in one as they are.
    file: Arc<Source>,
}

impl Found {
    /// The array of the numbers.
    pub(super) fn array(&self, stores: &Stores) -> Result<Array> {
        match self.stored.origin {
            Origin::File => Ok(Array::in_file(&self.file, self.stored)),
            _ => Ok(stores.array(self.stored, "numbers")?.of_file(&self.file)),
        }
    }
}

/// The files that are open.
pub(super) struct Files<'i> {
    input: &'i Input,
    siblings: Siblings<'i>,
    main: Sibling,
    unpacked: Unpacked<'i>,
    #[cfg(feature = "hdf5")]
    open: Vec<(String, Hdf5)>,
}

impl<'i> Files<'i> {
    pub(super) fn new(input: &'i Input) -> Self {
        let siblings = Siblings::new(input);
        let main = siblings.main();
        Self {
            input,
            siblings,
            main,
            unpacked: Unpacked::new(input),
            #[cfg(feature = "hdf5")]
            open: Vec::new(),
        }
    }

    /// Ends unpacking.
    pub(super) fn finish(self) -> Result<Stores> {
        self.unpacked.finish()
    }

    /// Finds the numbers of an item, coordinates or nodes of elements.
    pub(super) fn find(&mut self, item: &Item, is_coordinates: bool) -> Result<Found> {
        let found = match item.place {
            Place::Text => self.text(item, is_coordinates),
            Place::Binary(endian, at) => {
                let name = self.name(item)?;
                let file = self.open_file(&name);
                file.and_then(|file| {
                    let (number, count) = (item.number, item.count);
                    let stored = Stored { origin: Origin::File, at, number, endian, count };
                    check_fits(&file, &stored, "numbers")?;
                    Ok(Found { stored, file })
                })
            }
            Place::Hdf => self.hdf(item),
        };
        found.map_err(|error| self.input.source.place(error, Spot::Text(item.at)))
    }

    /// Opens a file that is named. Writers that are told an absolute name put absolute names into their files: one that
    /// leads into the mesh's own folder is taken for one that starts there.
    fn open_file(&mut self, name: &str) -> Result<Arc<Source>> {
        let main = std::path::absolute(self.input.source.path()).ok();
        let folder = main.as_deref().and_then(Path::parent);
        let beside = folder.and_then(|folder| Path::new(name).strip_prefix(folder).ok());
        Ok(self.siblings.open(&self.main, beside.unwrap_or(Path::new(name)))?.source)
    }

    fn text(&mut self, item: &Item, is_coordinates: bool) -> Result<Found> {
        let source = &self.input.source;
        let (role, number) = match is_coordinates {
            true if item.number == Number::F32 => (Role::Coordinate, Number::F32),
            true => (Role::Coordinate, Number::F64),
            false => (Role::Point, Number::U64),
        };
        let range = item.from..source.len();
        let (stored, _) =
            ascii::unpack(self.input, range, Some(item.count), role, number, &mut self.unpacked)?;
        Ok(Found { stored, file: Arc::clone(source) })
    }

    /// The text between the tags of an item.
    fn name(&self, item: &Item) -> Result<String> {
        let source = &self.input.source;
        let text = source.peek(item.from..item.from + LONGEST_NAME);
        let end = text.iter().position(|byte| *byte == b'<').unwrap_or(0);
        match std::str::from_utf8(text[..end].trim_ascii()) {
            Ok(name) if !name.is_empty() => Ok(name.to_owned()),
            _ => Err(source.malformed_text(item.from, "the name of a file")),
        }
    }

    #[cfg(not(feature = "hdf5"))]
    fn hdf(&mut self, _: &Item) -> Result<Found> {
        Err(Error::unsupported("numbers in HDF5 files are not read: this program was built without"))
    }

    #[cfg(feature = "hdf5")]
    fn hdf(&mut self, item: &Item) -> Result<Found> {
        let name = self.name(item)?;
        let Some((file, path)) = name.split_once(':') else {
            return Err(Error::malformed("the name of a file, a colon, the path of a dataset", name));
        };
        if path.contains('|') {
            return Err(Error::unsupported(format!(
                "a part of a dataset ({path}) is not read in XDMF files"
            )));
        }
        let k = match self.open.iter().position(|open| open.0 == file) {
            Some(k) => k,
            None => {
                let source = self.open_file(file)?;
                self.open.push((file.to_owned(), Hdf5::of_source(&source)?));
                self.open.len() - 1
            }
        };
        let hdf = &self.open[k].1;
        let (mut group, mut parts) =
            (hdf.root()?, path.split('/').filter(|part| !part.is_empty()).peekable());
        while let Some(part) = parts.next() {
            if parts.peek().is_some() {
                let inner = group.group(part)?;
                group =
                    inner.ok_or_else(|| group.malformed(format!("the group {part}"), "none of that name"))?;
                continue;
            }
            let dataset = group.needed(part)?;
            if dataset.len() != item.count {
                let expected = format!("{} numbers, as the XDMF file says", item.count);
                return Err(dataset.malformed(expected, dataset.len().to_string()));
            }
            let stored = dataset.store(self.input, &mut self.unpacked)?;
            return Ok(Found { stored, file: Arc::clone(hdf.source()) });
        }
        Err(Error::malformed("the path of a dataset", name))
    }
}
