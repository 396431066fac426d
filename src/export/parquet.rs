//! Elements as Parquet, in groups of rows: what pandas, DuckDB and Polars read.

use std::collections::HashMap;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result as Written};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use tempfile::NamedTempFile;

use super::{Columns, Target, extents};
use crate::error::Result;
use crate::mesh::{ElementWriter, Nodes, ScoredElement, Shape};

/// Rows of a group: what is kept in memory.
const GROUP: usize = 1 << 16;

/// Columns of real numbers before those of the measures.
const REALS: [&str; 6] = ["x", "y", "z", "size", "area", "volume"];

pub(super) struct Parquet {
    target: Target,
    columns: Columns,
    /// Nothing once the file is whole.
    out: Option<SerializedFileWriter<NamedTempFile>>,
    group: Group,
}

/// Rows that wait for their group to be full, column by column.
#[derive(Default)]
struct Group {
    labels: Vec<i64>,
    shapes: Vec<Shape>,
    regions: Vec<Option<ByteArray>>,
    /// A name as it is stored, one for all its elements.
    names: HashMap<String, ByteArray>,
    /// Those of [`REALS`], then the measures; NaN stands for nothing.
    reals: Vec<Vec<f64>>,
}

impl Parquet {
    pub(super) fn create(target: Target, columns: Columns) -> Result<Self> {
        let reals: Vec<_> = REALS.into_iter().chain(columns.codes()).collect();
        let properties = WriterProperties::builder().set_compression(Compression::ZSTD(ZstdLevel::default()));
        let schema = schema(&reals).map_err(|e| failed(&target, e))?;
        let out = SerializedFileWriter::new(target.begin()?, schema, Arc::new(properties.build()));
        let out = out.map_err(|e| failed(&target, e))?;
        let group = Group { reals: vec![Vec::new(); reals.len()], ..Group::default() };
        Ok(Self { target, columns, out: Some(out), group })
    }

    fn flush(&mut self) -> Result<()> {
        let Some(out) = &mut self.out else { return Ok(()) };
        out.next_row_group().and_then(|rows| self.group.write(rows)).map_err(|e| failed(&self.target, e))?;
        self.group.clear();
        Ok(())
    }
}

impl ElementWriter for Parquet {
    fn write(&mut self, element: &ScoredElement<'_>) -> Result<()> {
        self.group.push(element, &self.columns);
        if self.group.labels.len() == GROUP { self.flush() } else { Ok(()) }
    }

    fn finish(&mut self, _: &Nodes) -> Result<()> {
        if !self.group.labels.is_empty() {
            self.flush()?;
        }
        let Some(out) = self.out.take() else { return Ok(()) };
        let file = out.into_inner().map_err(|e| failed(&self.target, e))?;
        self.target.end(file)
    }
}

impl Group {
    fn push(&mut self, element: &ScoredElement<'_>, columns: &Columns) {
        self.labels.push(element.label as i64);
        self.shapes.push(element.shape);
        let stored = |name: &str| match self.names.get(name) {
            Some(stored) => stored.clone(),
            None => self.names.entry(name.to_owned()).or_insert(ByteArray::from(name)).clone(),
        };
        let region = element.region.map(stored);
        self.regions.push(region);
        let (area, volume) = extents(element);
        let [x, y, z] = element.centroid;
        let reals = [x, y, z, element.size, area.unwrap_or(f64::NAN), volume.unwrap_or(f64::NAN)];
        for (column, value) in self.reals.iter_mut().zip(reals.into_iter().chain(columns.scores(element))) {
            column.push(value);
        }
    }

    fn clear(&mut self) {
        self.labels.clear();
        self.shapes.clear();
        self.regions.clear();
        self.names.clear();
        self.reals.iter_mut().for_each(Vec::clear);
    }

    fn write(&self, mut rows: SerializedRowGroupWriter<'_, NamedTempFile>) -> Written<()> {
        let end = || ParquetError::General("the schema has a column less".to_owned());
        let mut column = rows.next_column()?.ok_or_else(end)?;
        column.typed::<Int64Type>().write_batch(&self.labels, None, None)?;
        column.close()?;
        let shapes: Vec<_> = self.shapes.iter().map(|shape| ByteArray::from(shape.name())).collect();
        let mut column = rows.next_column()?.ok_or_else(end)?;
        column.typed::<ByteArrayType>().write_batch(&shapes, None, None)?;
        column.close()?;
        let present: Vec<_> = self.regions.iter().map(|region| i16::from(region.is_some())).collect();
        let regions: Vec<_> = self.regions.iter().flatten().cloned().collect();
        let mut column = rows.next_column()?.ok_or_else(end)?;
        column.typed::<ByteArrayType>().write_batch(&regions, Some(&present), None)?;
        column.close()?;
        for values in &self.reals {
            let present: Vec<_> = values.iter().map(|value| i16::from(!value.is_nan())).collect();
            let values: Vec<_> = values.iter().copied().filter(|value| !value.is_nan()).collect();
            let mut column = rows.next_column()?.ok_or_else(end)?;
            column.typed::<DoubleType>().write_batch(&values, Some(&present), None)?;
            column.close()?;
        }
        rows.close().map(drop)
    }
}

fn schema(reals: &[&str]) -> Written<TypePtr> {
    let field = |name: &str, physical, logical, repetition| {
        let field = Type::primitive_type_builder(name, physical).with_repetition(repetition);
        field.with_logical_type(logical).build().map(Arc::new)
    };
    let number = LogicalType::integer(64, false);
    let mut fields = vec![
        field("element", Physical::INT64, Some(number), Repetition::REQUIRED)?,
        field("shape", Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::REQUIRED)?,
        field("region", Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::OPTIONAL)?,
    ];
    for name in reals {
        fields.push(field(name, Physical::DOUBLE, None, Repetition::OPTIONAL)?);
    }
    Type::group_type_builder("elements").with_fields(fields).build().map(Arc::new)
}

fn failed(target: &Target, error: ParquetError) -> crate::error::Error {
    let cause = match error {
        ParquetError::External(cause) => match cause.downcast::<std::io::Error>() {
            Ok(cause) => *cause,
            Err(other) => std::io::Error::other(other),
        },
        other => std::io::Error::other(other),
    };
    target.error(cause)
}
