//! A disc as one mapped patch of quadrilaterals: the report's mesh FG2 by default.

use std::f64::consts::{FRAC_PI_4, PI};
use std::io;

use super::parameter::{LENGTH, MAX_DIVISIONS};
use super::{Block, MeshSource, Model, Parameter, Range, Values, VisitElement, VisitNode};
use crate::mesh::Shape;

pub(super) const MODEL: Model = Model {
    name: "mapped-disc",
    title: "disc of quadrilaterals mapped from four arcs by transfinite interpolation (the report's mesh FG2)",
    parameters: &[
        Parameter { name: "radius", meaning: "radius of the disc", default: 25.0, range: LENGTH },
        Parameter {
            name: "divisions",
            meaning: "elements along each of the four arcs",
            default: 44.0,
            range: Range::Whole(1, MAX_DIVISIONS),
        },
    ],
    grows: &["divisions"],
    source: |values| Ok(Box::new(MappedDisc::new(values))),
    exact: |values| PI * values.real("radius").powi(2),
};

struct MappedDisc {
    divisions: u64,
    /// Points at equal angles on the arc from -135 to -45 degrees. The other three are this one, turned or mirrored.
    arc: Vec<[f64; 2]>,
}

impl MappedDisc {
    fn new(values: &Values) -> Self {
        let (radius, divisions) = (values.real("radius"), values.whole("divisions"));
        let point = |step| {
            let (sine, cosine) = (FRAC_PI_4 * (2.0 * step as f64 / divisions as f64 - 3.0)).sin_cos();
            [radius * cosine, radius * sine]
        };
        Self { divisions, arc: (0..=divisions).map(point).collect() }
    }

    /// The Coons patch between the arcs at column `i`, row `j`.
    fn point(&self, i: usize, j: usize) -> [f64; 3] {
        let (u, v) = (i as f64 / self.divisions as f64, j as f64 / self.divisions as f64);
        let bottom = self.arc[i];
        let top = [bottom[0], -bottom[1]];
        let left = [self.arc[j][1], self.arc[j][0]];
        let right = [-left[0], left[1]];
        let corner = -self.arc[0][0];
        let bilinear = [corner * (2.0 * u - 1.0), corner * (2.0 * v - 1.0)];
        let coordinate =
            |k: usize| (1.0 - v) * bottom[k] + v * top[k] + (1.0 - u) * left[k] + u * right[k] - bilinear[k];
        [coordinate(0), coordinate(1), 0.0]
    }
}

impl MeshSource for MappedDisc {
    fn nodes(&self) -> u64 {
        (self.divisions + 1).pow(2)
    }

    fn blocks(&self) -> Vec<Block> {
        vec![Block { shape: Shape::Quadrilateral, elements: self.divisions.pow(2) }]
    }

    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        let steps = self.arc.len();
        (0..steps).try_for_each(|j| (0..steps).try_for_each(|i| visit(self.point(i, j))))
    }

    fn each_element(&self, shape: Shape, visit: VisitElement<'_>) -> io::Result<()> {
        if shape != Shape::Quadrilateral {
            return Ok(());
        }
        let row = self.divisions + 1;
        for j in 0..self.divisions {
            for first in (j * row)..(j * row + self.divisions) {
                visit(&[first, first + 1, first + 1 + row, first + row])?;
            }
        }
        Ok(())
    }
}
