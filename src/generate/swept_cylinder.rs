//! A cylinder swept along its axis from a mesh of its base: hexahedra, tetrahedra or wedges.

use std::f64::consts::PI;
use std::io;

use super::bricks::{BrickGrid, Bricks, Cells, VisitBrick};
use super::disc::{CoredDisc, HexagonalDisc};
use super::parameter::{LENGTH, MAX_DIVISIONS};
use super::{Block, MeshSource, Model, Parameter, Range, VisitElement, VisitNode};
use crate::mesh::Shape;

pub(super) const MODEL: Model = Model {
    name: "swept-cylinder",
    title: "cylinder swept from its base: hexahedra round a square core, the same cut into tetrahedra, or wedges in rings",
    parameters: &[
        Parameter { name: "radius", meaning: "radius of the cylinder", default: 25.0, range: LENGTH },
        Parameter { name: "height", meaning: "height of the cylinder", default: 5.0, range: LENGTH },
        Parameter {
            name: "divisions",
            meaning: "elements along a radius",
            default: 30.0,
            range: Range::Whole(1, MAX_DIVISIONS),
        },
        Parameter {
            name: "layers",
            meaning: "elements along the axis",
            default: 7.0,
            range: Range::Whole(1, MAX_DIVISIONS),
        },
        Parameter {
            name: "elements",
            meaning: "what the mesh is made of",
            default: 0.0,
            range: Range::Choice(&["hexahedra", "tetrahedra", "wedges"]),
        },
    ],
    grows: &["divisions", "layers"],
    exact: |values| PI * values.real("radius").powi(2) * values.real("height"),
    source: |values| {
        let layers = Layers { height: values.real("height"), count: values.whole("layers") };
        let (radius, divisions) = (values.real("radius"), values.whole("divisions"));
        let swept =
            |cells| Bricks { grid: SweptDisc { disc: CoredDisc::new(radius, divisions), layers }, cells };
        Ok(match values.choice("elements").as_str() {
            "hexahedra" => Box::new(swept(Cells::Hexahedra)),
            "tetrahedra" => Box::new(swept(Cells::Tetrahedra)),
            _ => Box::new(Wedges { disc: HexagonalDisc { radius, rings: divisions }, layers }),
        })
    },
};

/// The steps along the axis.
#[derive(Clone, Copy)]
struct Layers {
    height: f64,
    count: u64,
}

impl Layers {
    fn z(self, plane: u64) -> f64 {
        self.height * plane as f64 / self.count as f64
    }
}

struct SweptDisc {
    disc: CoredDisc,
    layers: Layers,
}

impl BrickGrid for SweptDisc {
    fn nodes(&self) -> u64 {
        self.disc.nodes() * (self.layers.count + 1)
    }

    fn bricks(&self) -> u64 {
        self.disc.quadrilaterals() * self.layers.count
    }

    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        (0..=self.layers.count).try_for_each(|plane| {
            let z = self.layers.z(plane);
            self.disc.each_point(|[x, y]| visit([x, y, z]))
        })
    }

    fn each_brick(&self, visit: VisitBrick<'_>) -> io::Result<()> {
        (0..self.layers.count).try_for_each(|layer| {
            let below = layer * self.disc.nodes();
            let above = below + self.disc.nodes();
            self.disc.each_quadrilateral(|[a, b, c, d], dark| {
                let corners =
                    [below + a, below + b, below + c, below + d, above + a, above + b, above + c, above + d];
                visit(&corners, dark ^ (layer % 2 == 1))
            })
        })
    }
}

struct Wedges {
    disc: HexagonalDisc,
    layers: Layers,
}

impl MeshSource for Wedges {
    fn nodes(&self) -> u64 {
        self.disc.nodes() * (self.layers.count + 1)
    }

    fn blocks(&self) -> Vec<Block> {
        vec![Block { shape: Shape::Wedge, elements: self.disc.triangles() * self.layers.count }]
    }

    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        (0..=self.layers.count).try_for_each(|plane| {
            let z = self.layers.z(plane);
            self.disc.each_point(|[x, y]| visit([x, y, z]))
        })
    }

    fn each_element(&self, shape: Shape, visit: VisitElement<'_>) -> io::Result<()> {
        if shape != Shape::Wedge {
            return Ok(());
        }
        (0..self.layers.count).try_for_each(|layer| {
            let below = layer * self.disc.nodes();
            let above = below + self.disc.nodes();
            self.disc.each_triangle(|[a, b, c]| {
                visit(&[below + a, below + b, below + c, above + a, above + b, above + c])
            })
        })
    }
}
