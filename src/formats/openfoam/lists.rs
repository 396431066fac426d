//! Lists as OpenFOAM writes them: `3(0 1 2)`, `(0 1 2)`, `3{0}`, and with bytes for numbers in binary files.

use super::header::{self, Header};
use super::reader::Reader;
use super::too_many;
use crate::error::{Error, Result};
use crate::input::{Budget, Input, Scratch, Source, Spot};
use crate::mesh::{Column, ColumnBuilder};
use bytemuck::Pod;

/// The faces of a mesh: the points of all of them, and where those of each begin; one more than there are faces.
#[derive(Debug)]
pub(super) struct Faces {
    points: Column<u32>,
    starts: Column<u64>,
}

impl Faces {
    /// Number of faces.
    pub(super) fn count(&self) -> u64 {
        self.starts.rows().len() as u64 - 1
    }

    /// The points of a face, in order round it.
    #[inline]
    pub(super) fn points(&self, face: u32) -> &[u32] {
        let starts = &self.starts.rows()[face as usize..];
        &self.points.rows()[starts[0] as usize..starts[1] as usize]
    }
}

/// Rows on their way to a column, gathered.
struct Rows<T> {
    column: ColumnBuilder<T>,
    buffer: Vec<T>,
}

impl<T: Pod> Rows<T> {
    fn new(budget: &Budget, scratch: &Scratch) -> Self {
        Self { column: ColumnBuilder::new(budget, scratch), buffer: Vec::new() }
    }

    fn len(&self) -> u64 {
        (self.column.len() + self.buffer.len()) as u64
    }

    #[inline]
    fn push(&mut self, row: T) -> Result<()> {
        self.buffer.push(row);
        if self.buffer.len() == 16 << 10 {
            self.column.extend(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Column<T>> {
        self.column.extend(&self.buffer)?;
        self.column.finish()
    }
}

/// Reads one list of labels: hands each on with the byte that it stands at. There may be `most` of them.
fn labels(
    reader: &mut Reader<'_>,
    header: &Header,
    (most, what): (u64, &str),
    mut take: impl FnMut(i64, u64) -> Result<()>,
) -> Result<u64> {
    let told = match reader.next() {
        Some(b'(') => None,
        _ => Some(reader.integer(&format!("a list of {what}"))?),
    };
    let place = reader.at();
    let count = match told {
        Some(count) => Some(u64::try_from(count).ok().filter(|c| *c <= most).ok_or_else(|| {
            let expected = format!("a list of up to {most} {what}");
            reader.placed(place, Error::malformed(expected, format!("one of {count}")))
        })?),
        None => None,
    };
    if reader.takes(b'{') {
        let at = reader.at();
        let label = if header.binary { reader.raw_label(header, what)? } else { reader.integer(what)? };
        reader.expect(b'}', "the end } of a list")?;
        (0..count.unwrap_or(0)).try_for_each(|_| take(label, at))?;
        return Ok(count.unwrap_or(0));
    }
    // Nothing follows the number of an empty binary list.
    if header.binary && count == Some(0) && reader.next() != Some(b'(') {
        return Ok(0);
    }
    reader.expect(b'(', "the beginning ( of a list")?;
    let mut found = 0;
    if header.binary
        && let Some(count) = count
    {
        while found < count {
            let at = reader.at();
            take(reader.raw_label(header, what)?, at)?;
            found += 1;
        }
        reader.expect(b')', "the end ) of a list")?;
        return Ok(count);
    }
    while !reader.takes(b')') {
        let at = reader.at();
        if count.is_some_and(|count| found == count) || found == most {
            return Err(reader.unlike(&format!("the end ) of a list after {found} {what}")));
        }
        take(reader.integer(what)?, at)?;
        found += 1;
    }
    match count {
        Some(count) if found < count => {
            Err(reader.placed(place, Error::malformed(format!("{count} {what}"), format!("{found}"))))
        }
        _ => Ok(found),
    }
}

/// Reads the owners or neighbours: the cell on one side of each face.
pub(super) fn cells(input: &Input, source: &Source, faces: u64) -> Result<Column<u32>> {
    let header = header::read(source)?;
    let mut reader = Reader::new(source, header.end);
    let mut rows = Rows::new(&input.memory, &input.scratch);
    labels(&mut reader, &header, (faces, "numbers of cells, one a face"), |label, at| {
        // Old versions mark the faces of the boundary by a neighbour -1.
        if label == -1 {
            return rows.push(NO_CELL);
        }
        let cell = u32::try_from(label).ok().filter(|cell| *cell < u32::MAX >> 1);
        rows.push(cell.ok_or_else(|| number_out_of_range(source, at, "cell", label))?)
    })?;
    end(&mut reader)?;
    rows.finish()
}

/// In the place of a cell where there is none.
pub(super) const NO_CELL: u32 = u32::MAX;

fn number_out_of_range(source: &Source, at: u64, what: &str, label: i64) -> Error {
    let error =
        Error::malformed(format!("the number of a {what}, from 0 to {}", u32::MAX >> 1), label.to_string());
    source.place(error, Spot::Text(at))
}

/// Reads the faces, `most` at the most.
pub(super) fn faces(input: &Input, source: &Source) -> Result<Faces> {
    let header = header::read(source)?;
    let mut reader = Reader::new(source, header.end);
    let (mut points, mut starts) =
        (Rows::new(&input.memory, &input.scratch), Rows::new(&input.memory, &input.scratch));
    let mut point = |label: i64, at: u64| {
        let number = u32::try_from(label).map_err(|_| number_out_of_range(source, at, "point", label))?;
        points.push(number)
    };
    if header.compact {
        let begin = reader.at();
        let mut last = 0;
        labels(
            &mut reader,
            &header,
            (1 + u64::from(u32::MAX >> 1), "places where faces begin"),
            |label, at| {
                let start = u64::try_from(label)
                    .ok()
                    .filter(|s| if starts.len() == 0 { *s == 0 } else { *s >= last + 3 });
                let Some(start) = start else {
                    let expected = if starts.len() == 0 {
                        "0".into()
                    } else {
                        format!("{} or more: a face has 3 points", last + 3)
                    };
                    return Err(source.place(Error::malformed(expected, label.to_string()), Spot::Text(at)));
                };
                last = start;
                starts.push(start)
            },
        )?;
        let found = labels(&mut reader, &header, (last, "points of faces"), point)?;
        if found != last || starts.len() == 0 {
            let expected = format!("{last} points of faces");
            return Err(source.place(Error::malformed(expected, found.to_string()), Spot::Text(begin)));
        }
    } else {
        let told = if reader.next() == Some(b'(') { None } else { Some(reader.integer("a list of faces")?) };
        reader.expect(b'(', "the beginning ( of a list of faces")?;
        let (begin, mut total) = (reader.at(), 0);
        starts.push(0u64)?;
        while !reader.takes(b')') {
            let at = reader.at();
            let len = labels(&mut reader, &header, (u64::from(u32::MAX), "points of a face"), &mut point)?;
            if len < 3 {
                let error = Error::malformed("a face with 3 points or more", format!("{len}"));
                return Err(source.place(error, Spot::Text(at)));
            }
            total += len;
            starts.push(total)?;
            if starts.len() > u64::from(u32::MAX >> 1) {
                return Err(too_many(source, at, "faces"));
            }
        }
        let found = starts.len() - 1;
        if told.is_some_and(|told| u64::try_from(told) != Ok(found)) {
            let expected = format!("{} faces", told.unwrap_or_default());
            return Err(source.place(Error::malformed(expected, found.to_string()), Spot::Text(begin)));
        }
    }
    end(&mut reader)?;
    Ok(Faces { points: points.finish()?, starts: starts.finish()? })
}

/// The end of the file, but for comments.
pub(super) fn end(reader: &mut Reader<'_>) -> Result<()> {
    match reader.next() {
        None => Ok(()),
        Some(_) => Err(reader.unlike("the end of the file")),
    }
}
