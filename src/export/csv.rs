//! Elements as CSV (RFC 4180): one a line, numbers in full precision, what does not apply left empty.

use std::io::{self, BufWriter, Write};

use tempfile::NamedTempFile;

use super::{Columns, Target, extents};
use crate::error::Result;
use crate::mesh::{ElementWriter, Nodes, ScoredElement};

pub(super) struct Csv {
    target: Target,
    columns: Columns,
    /// Nothing once the file is whole.
    out: Option<BufWriter<NamedTempFile>>,
}

impl Csv {
    pub(super) fn create(target: Target, columns: Columns) -> Result<Self> {
        let mut out = BufWriter::new(target.begin()?);
        let head = write!(out, "element,shape,region,x,y,z,size,area,volume")
            .and_then(|()| columns.codes().try_for_each(|code| write!(out, ",{code}")))
            .and_then(|()| writeln!(out));
        head.map_err(|e| target.error(e))?;
        Ok(Self { target, columns, out: Some(out) })
    }
}

impl ElementWriter for Csv {
    fn write(&mut self, element: &ScoredElement<'_>) -> Result<()> {
        let Some(out) = &mut self.out else { return Ok(()) };
        row(element, &self.columns, out).map_err(|e| self.target.error(e))
    }

    fn finish(&mut self, _: &Nodes) -> Result<()> {
        let Some(out) = self.out.take() else { return Ok(()) };
        let file = out.into_inner().map_err(|e| self.target.error(e.into_error()))?;
        self.target.end(file)
    }
}

fn row(element: &ScoredElement<'_>, columns: &Columns, out: &mut impl Write) -> io::Result<()> {
    write!(out, "{},{},", element.label, element.shape)?;
    name(element.region.unwrap_or_default(), out)?;
    let [x, y, z] = element.centroid;
    write!(out, ",{x:?},{y:?},{z:?},{:?}", element.size)?;
    let (area, volume) = extents(element);
    for value in [area, volume].into_iter().chain(columns.scores(element).map(Some)) {
        match value.filter(|value| !value.is_nan()) {
            Some(value) => write!(out, ",{value:?}")?,
            None => write!(out, ",")?,
        }
    }
    writeln!(out)
}

/// A name out of a mesh file, on one line.
fn name(text: &str, out: &mut impl Write) -> io::Result<()> {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.contains([',', '"']) {
        write!(out, "\"{}\"", text.replace('"', "\"\""))
    } else {
        write!(out, "{text}")
    }
}
