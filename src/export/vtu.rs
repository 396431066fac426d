//! Elements as VTU with appended raw data in blocks of zlib: ParaView shows each measure as a cell array.
//!
//! Only nodes that are used are written. Numbers of regions are those of `region names` in the field data, from 1 on.

use std::collections::HashMap;
use std::io::{self, BufReader, BufWriter, Read, Seek, Write};

use super::vtu_array::{Array, WholeArray};
use super::{Columns, Target};
use crate::error::{Error, Result};
use crate::input::{Scratch, ScratchFile};
use crate::mesh::{ElementWriter, Nodes, ScoredElement};

/// Columns of real numbers before those of the measures: of a surface the extent is its area, of a solid its volume.
const REALS: [&str; 2] = ["size", "extent"];

pub(super) struct Vtu {
    target: Target,
    columns: Columns,
    scratch: Scratch,
    /// Nothing once the file is whole.
    cells: Option<Cells>,
}

/// What is known of the cells before the nodes are.
struct Cells {
    /// Rows of the node table, as they come.
    corners: ScratchFile,
    used: Used,
    /// Where the next cell ends in the list of corners.
    end: i64,
    offsets: Array,
    types: Array,
    labels: Array,
    regions: Array,
    reals: Vec<Array>,
    /// Numbers of the regions by name, in the order in which they were met.
    names: HashMap<String, i32>,
    ordered: Vec<String>,
}

impl Vtu {
    pub(super) fn create(target: Target, columns: Columns, scratch: &Scratch) -> Result<Self> {
        // A folder that cannot be written to is told before the work, not after it.
        drop(target.begin()?);
        let array = |name: &str, kind| Array::new(name, kind, 1, scratch);
        let reals = REALS.into_iter().chain(columns.codes());
        let cells = Cells {
            corners: scratch.file()?,
            used: Used::default(),
            end: 0,
            offsets: array("offsets", "Int64")?,
            types: array("types", "UInt8")?,
            labels: array("element", "Int64")?,
            regions: array("region", "Int32")?,
            reals: reals.map(|name| array(name, "Float64")).collect::<Result<_>>()?,
            names: HashMap::new(),
            ordered: Vec::new(),
        };
        Ok(Self { target, columns, scratch: scratch.clone(), cells: Some(cells) })
    }
}

impl ElementWriter for Vtu {
    fn write(&mut self, element: &ScoredElement<'_>) -> Result<()> {
        match &mut self.cells {
            Some(cells) => cells.push(element, &self.columns),
            None => Ok(()),
        }
    }

    fn finish(&mut self, nodes: &Nodes) -> Result<()> {
        let Some(cells) = self.cells.take() else { return Ok(()) };
        let whole = cells.end(nodes, &self.scratch).map_err(|e| e.in_file(&self.target.path))?;
        let file = self.target.begin()?;
        let mut out = BufWriter::with_capacity(1 << 20, file);
        whole.write(&mut out).map_err(|e| self.target.error(e))?;
        let file = out.into_inner().map_err(|e| self.target.error(e.into_error()))?;
        self.target.end(file)
    }
}

impl Cells {
    fn push(&mut self, element: &ScoredElement<'_>, columns: &Columns) -> Result<()> {
        for &row in element.corners {
            self.used.mark(row);
            self.corners.write(&row.to_le_bytes())?;
        }
        self.end += element.corners.len() as i64;
        self.offsets.push(self.end.to_le_bytes())?;
        self.types.push([element.shape.facts().vtk_cell])?;
        self.labels.push((element.label as i64).to_le_bytes())?;
        let region = element.region.map_or(0, |name| self.region(name));
        self.regions.push(region.to_le_bytes())?;
        let reals = [element.size, element.extent].into_iter().chain(columns.scores(element));
        self.reals.iter_mut().zip(reals).try_for_each(|(array, value)| array.push(value.to_le_bytes()))
    }

    /// The number of a region.
    fn region(&mut self, name: &str) -> i32 {
        if let Some(number) = self.names.get(name) {
            return *number;
        }
        self.ordered.push(name.to_owned());
        let number = self.ordered.len() as i32;
        self.names.insert(name.to_owned(), number);
        number
    }

    /// All cells have come: adds the points, and the corners as numbers of points.
    fn end(self, nodes: &Nodes, scratch: &Scratch) -> Result<Whole> {
        let ranks = self.used.ranks();
        let mut points = Array::new("Points", "Float64", 3, scratch)?;
        for row in self.used.rows() {
            nodes.rows()[row].iter().try_for_each(|x| points.push(x.to_le_bytes()))?;
        }
        let mut connectivity = Array::new("connectivity", "Int64", 1, scratch)?;
        let (mut file, share) = self.corners.into_file()?;
        let lost = |e: io::Error| Error::resource("scratch space", e);
        file.rewind().map_err(lost)?;
        let mut corners = BufReader::with_capacity(1 << 16, file);
        let mut word = [0; 4];
        for _ in 0..self.end {
            corners.read_exact(&mut word).map_err(lost)?;
            let point = self.used.rank(&ranks, u32::from_le_bytes(word));
            connectivity.push((point as i64).to_le_bytes())?;
        }
        drop((corners, share));
        let mut cell_data = vec![self.labels.end()?];
        let mut field_data = Vec::new();
        if !self.ordered.is_empty() {
            cell_data.push(self.regions.end()?);
            let mut names = Array::new("region names", "String", 1, scratch)?;
            self.ordered.iter().try_for_each(|name| names.push_text(name))?;
            field_data.push(names.end()?);
        }
        for array in self.reals {
            cell_data.push(array.end()?);
        }
        Ok(Whole {
            field_data,
            points: points.end()?,
            topology: [connectivity.end()?, self.offsets.end()?, self.types.end()?],
            cell_data,
        })
    }
}

/// Everything that the file holds.
struct Whole {
    field_data: Vec<WholeArray>,
    points: WholeArray,
    topology: [WholeArray; 3],
    cell_data: Vec<WholeArray>,
}

impl Whole {
    fn write(self, out: &mut impl Write) -> io::Result<()> {
        let (points, cells) = (self.points.values() / 3, self.topology[1].values());
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        writeln!(
            out,
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>"
        )?;
        let mut offset = 0;
        if !self.field_data.is_empty() {
            writeln!(out, "<FieldData>")?;
            for array in &self.field_data {
                offset = array.describe(offset, true, out)?;
            }
            writeln!(out, "</FieldData>")?;
        }
        writeln!(out, "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n<Points>")?;
        offset = self.points.describe(offset, false, out)?;
        writeln!(out, "</Points>\n<Cells>")?;
        for array in &self.topology {
            offset = array.describe(offset, false, out)?;
        }
        writeln!(out, "</Cells>\n<CellData>")?;
        for array in &self.cell_data {
            offset = array.describe(offset, false, out)?;
        }
        writeln!(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">")?;
        out.write_all(b"_")?;
        let arrays =
            self.field_data.into_iter().chain([self.points]).chain(self.topology).chain(self.cell_data);
        arrays.into_iter().try_for_each(|array| array.write(out))?;
        writeln!(out, "\n</AppendedData>\n</VTKFile>")
    }
}

/// Which rows of the node table are used: a bit each.
#[derive(Default)]
struct Used(Vec<u64>);

impl Used {
    fn mark(&mut self, row: u32) {
        let word = row as usize / 64;
        if word >= self.0.len() {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= 1 << (row % 64);
    }

    /// The used rows in order.
    fn rows(&self) -> impl Iterator<Item = usize> {
        let bits = |(word, bits): (usize, &u64)| {
            let bits = *bits;
            (0..64).filter(move |bit| bits >> bit & 1 == 1).map(move |bit| 64 * word + bit)
        };
        self.0.iter().enumerate().flat_map(bits)
    }

    /// Number of used rows before each word.
    fn ranks(&self) -> Vec<u32> {
        let before = |sum: &mut u32, word: &u64| {
            let before = *sum;
            *sum += word.count_ones();
            Some(before)
        };
        self.0.iter().scan(0, before).collect()
    }

    /// Number of used rows before a used one.
    fn rank(&self, ranks: &[u32], row: u32) -> u32 {
        let (word, bit) = (row as usize / 64, row % 64);
        ranks[word] + (self.0[word] & ((1 << bit) - 1)).count_ones()
    }
}
