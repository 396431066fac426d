//! `.mesh`: words and numbers, whatever lines they stand on.

use super::keywords::Polytopes;
use super::{Found, keywords};
use crate::error::{Error, Result};
use crate::formats::Outline;
use crate::formats::rows::{Numbers, Table, TokenReader, outline_elements, outline_nodes};
use crate::input::{Input, Spot};

const VERSION: &[u8] = b"MeshVersionFormatted";

/// Whether the first word is that of the format.
pub(super) fn is_text(head: &[u8]) -> bool {
    let mut rest = head.trim_ascii_start();
    while rest.starts_with(b"#") {
        let end = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        rest = rest[end..].trim_ascii_start();
    }
    rest.get(..VERSION.len()).is_some_and(|word| word.eq_ignore_ascii_case(VERSION))
}

pub(super) fn outline(input: &Input, out: &mut dyn Outline) -> Result<()> {
    let mut reader = TokenReader::new(input, b'#');
    let (mut found, mut ended) = (Found::new(), false);
    while let Some(word) = reader.token()? {
        let (at, name) = (word.at, word.bytes.to_ascii_lowercase());
        if name == b"end" {
            ended = true;
            break;
        }
        let done = keyword(&mut reader, &name, &mut found, out);
        done.map_err(|e| input.source.place(e, Spot::Text(at)))?;
    }
    // Without End, a file that lacks elements is one that lost them.
    if !ended && found.vertices.is_some() && found.tables.is_empty() {
        return Err(input.source.malformed_text(input.source.len(), "elements, or the keyword End"));
    }
    found.check(&input.source, Spot::Text(reader.position()))
}

/// Reads what follows a keyword, which is in lower case.
fn keyword(
    reader: &mut TokenReader<'_>,
    name: &[u8],
    found: &mut Found,
    out: &mut dyn Outline,
) -> Result<()> {
    if !name[0].is_ascii_alphabetic() {
        let error = Numbers::new(0, name, b'#').unlike_here("a keyword (Vertices, Tetrahedra, End, ...)");
        return Err(error);
    }
    if let Some(keyword) = keywords::by_name(name) {
        let rows = reader.integer(&format!("the number of {}", keyword.name))?;
        // A row a line is what everybody writes; where it is not so, numbers are left over, or too few.
        let alone = rows > 0 && keyword.is_ambiguous();
        let nodes = if alone { reader.tokens_of_line().saturating_sub(1) } else { 0 };
        let kind = keyword.with_nodes(nodes).unwrap_or(keyword.usual());
        let first = found.add_elements(keyword, rows);
        let what = format!("rows of {}", keyword.name);
        return outline_elements(reader, Table { what: &what, rows, extra: 1, first }, kind, out);
    }
    if let Some(polytopes) = Polytopes::by_name(name) {
        return count(reader, polytopes, out);
    }
    match name {
        b"meshversionformatted" => match reader.integer("a version")? {
            0..=4 => Ok(()),
            other => Err(Error::unsupported(format!("MEDIT version {other} is not read (1 to 4 are)"))),
        },
        b"dimension" => found.set_dimension(reader.integer("a dimension, 2 or 3")?),
        b"vertices" => {
            let dimension = found.dimension()?;
            let rows = reader.integer("the number of vertices")?;
            let first = found.add_vertices(rows);
            outline_nodes(reader, Table { what: "rows of Vertices", rows, extra: 1, first }, dimension, out)
        }
        _ if keywords::is_of_elements(name) => count_unknown(reader, name, found, out),
        _ => skip(reader, name, found),
    }
}

/// Passes the rows of polygons or polyhedra and counts them.
fn count(reader: &mut TokenReader<'_>, polytopes: &Polytopes, out: &mut dyn Outline) -> Result<()> {
    let name = polytopes.name;
    let rows = reader.integer(&format!("the number of rows of {name}"))?;
    let numbers = reader.pass_to_word()?;
    if rows.checked_mul(polytopes.width as u64) != Some(numbers) {
        reader.more();
        let width = polytopes.width;
        let expected = format!("{rows} rows of {name} of {width} numbers each, and not {numbers} in all");
        return Err(reader.source.malformed_text(reader.position(), expected));
    }
    out.count(&polytopes.kind(), rows)
}

/// Passes the elements of a kind that is not known and counts them under its name.
fn count_unknown(
    reader: &mut TokenReader<'_>,
    name: &[u8],
    found: &mut Found,
    out: &mut dyn Outline,
) -> Result<()> {
    let name = String::from_utf8_lossy(name).into_owned();
    let rows = reader.integer(&format!("the number of {name}"))?;
    let numbers = reader.pass_to_word()?;
    if rows > numbers || rows > 0 && !numbers.is_multiple_of(rows) {
        reader.more();
        let expected = format!("{rows} whole rows of {name}, and not {numbers} numbers in all");
        return Err(reader.source.malformed_text(reader.position(), expected));
    }
    found.label = found.label.saturating_add(rows);
    out.count(&keywords::unknown(name), rows)
}

/// Passes a keyword that is not read, with its numbers.
fn skip(reader: &mut TokenReader<'_>, name: &[u8], found: &mut Found) -> Result<()> {
    if let Some(of) = name.strip_suffix(b"ordering")
        && let Some(keyword) = keywords::by_name(of)
    {
        found.ordered.push(keyword.name.to_owned());
    }
    let rows = reader.peek_integer()?;
    let numbers = reader.pass_to_word()?;
    // Where End is missing, whole rows are the only sign that the file is whole.
    if !reader.more()
        && let Some(rows) = rows.filter(|rows| *rows > 0)
        && (numbers == 1 || !(numbers - 1).is_multiple_of(rows))
    {
        let name = String::from_utf8_lossy(name).into_owned();
        let expected = format!("{rows} whole rows of {name}, or the keyword End");
        return Err(reader.source.malformed_text(reader.source.len(), expected));
    }
    Ok(())
}
