//! A cylindrical specimen with one corrosion pit half-way along its side, graded to the pit: section 6 of the report.

mod grid;
mod pit;

use std::f64::consts::PI;

use super::bricks::{Bricks, Cells, cells_parameter};
use super::parameter::{LENGTH, MAX_DIVISIONS};
use super::{MeshSource, Model, Parameter, Range, Values};
use crate::error::{Error, Result};
use grid::SpecimenGrid;
use pit::Pit;

pub(super) const MODEL: Model = Model {
    name: "pit-specimen",
    title: "cylinder with a corrosion pit half-way along its side, graded to the pit (section 6 of the report)",
    parameters: &[
        Parameter { name: "diameter", meaning: "diameter of the specimen", default: 6.4, range: LENGTH },
        Parameter { name: "length", meaning: "length of the specimen", default: 25.4, range: LENGTH },
        Parameter { name: "depth", meaning: "depth of the pit", default: 0.5, range: LENGTH },
        Parameter {
            name: "width",
            meaning: "width of the pit's mouth; 0 for a hemisphere's, twice the depth",
            default: 0.0,
            range: Range::Real(0.0, 1e12),
        },
        Parameter {
            name: "divisions",
            meaning: "elements along a quarter of the specimen's or the pit's girth",
            default: 12.0,
            range: Range::Whole(1, MAX_DIVISIONS),
        },
        cells_parameter(1.0),
    ],
    grows: &["divisions"],
    source,
    exact: |values| {
        let (radius, length) = (values.real("diameter") / 2.0, values.real("length"));
        PI * radius * radius * length - pit(values).volume()
    },
};

fn pit(values: &Values) -> Pit {
    let (depth, width) = (values.real("depth"), values.real("width"));
    let radius = if width == 0.0 { depth } else { width / 2.0 };
    Pit { specimen: values.real("diameter") / 2.0, radius, sunk: depth - radius }
}

fn source(values: &Values) -> Result<Box<dyn MeshSource>> {
    let pit = pit(values);
    let (length, depth) = (values.real("length"), pit.radius + pit.sunk);
    // What the blocks round the pit have room for.
    let room = (0.3 * pit.specimen).min(0.2 * length);
    let width = 2.0 * pit.radius;
    if !(depth / 2.0..=2.0 * depth).contains(&width) {
        return Err(Error::usage(format!(
            "pit-specimen: width must be from half to twice the depth, {} to {}, found {width}",
            depth / 2.0,
            2.0 * depth
        )));
    }
    if depth > room {
        return Err(Error::usage(format!(
            "pit-specimen: depth must be at most 0.3 of the specimen's radius and 0.2 of its length, here {room}, found {depth}"
        )));
    }
    let grid = SpecimenGrid::new(pit, length, values.whole("divisions"));
    let cells = if values.choice("elements") == "hexahedra" { Cells::Hexahedra } else { Cells::Tetrahedra };
    Ok(Box::new(Bricks { grid, cells }))
}
