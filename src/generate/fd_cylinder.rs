//! A cylinder on a polar grid, as finite-difference programs use it: the report's mesh FD1 by default.

use std::f64::consts::{PI, TAU};
use std::io;

use super::parameter::{LENGTH, MAX_DIVISIONS};
use super::{Block, MeshSource, Model, Parameter, Range, Values, VisitElement, VisitNode};
use crate::mesh::Shape;

pub(super) const MODEL: Model = Model {
    name: "fd-cylinder",
    title: "cylinder on a polar grid of equal steps: hexahedra, wedges along the axis (the report's mesh FD1)",
    parameters: &[
        Parameter { name: "radius", meaning: "radius of the cylinder", default: 25.0, range: LENGTH },
        Parameter { name: "height", meaning: "height of the cylinder", default: 5.0, range: LENGTH },
        Parameter {
            name: "strips",
            meaning: "elements round the axis",
            default: 36.0,
            range: Range::Whole(3, MAX_DIVISIONS),
        },
        Parameter {
            name: "rings",
            meaning: "elements along a radius, the wedge at the axis included",
            default: 50.0,
            range: Range::Whole(1, MAX_DIVISIONS),
        },
        Parameter {
            name: "layers",
            meaning: "elements along the axis",
            default: 10.0,
            range: Range::Whole(1, MAX_DIVISIONS),
        },
    ],
    grows: &["strips", "rings", "layers"],
    source: |values| Ok(Box::new(FdCylinder::new(values))),
    exact: |values| PI * values.real("radius").powi(2) * values.real("height"),
};

struct FdCylinder {
    radius: f64,
    height: f64,
    rings: u64,
    layers: u64,
    /// Cosine and sine of the angle of each strip's first side.
    directions: Vec<(f64, f64)>,
}

impl FdCylinder {
    fn new(values: &Values) -> Self {
        let strips = values.whole("strips");
        let direction = |strip| {
            let (sine, cosine) = (TAU * strip as f64 / strips as f64).sin_cos();
            (cosine, sine)
        };
        Self {
            radius: values.real("radius"),
            height: values.real("height"),
            rings: values.whole("rings"),
            layers: values.whole("layers"),
            directions: (0..strips).map(direction).collect(),
        }
    }

    fn strips(&self) -> u64 {
        self.directions.len() as u64
    }

    /// Nodes in one plane of constant z.
    fn plane(&self) -> u64 {
        1 + self.strips() * self.rings
    }

    /// Number of the node on circle `ring` (0 is the axis) at the first side of `strip`, in the plane below `layer`.
    fn node(&self, strip: u64, ring: u64, layer: u64) -> u64 {
        let base = layer * self.plane();
        if ring == 0 { base } else { base + 1 + (ring - 1) * self.strips() + strip % self.strips() }
    }

    fn each_hexahedron(&self, visit: VisitElement<'_>) -> io::Result<()> {
        for layer in 0..self.layers {
            for ring in 1..self.rings {
                for strip in 0..self.strips() {
                    let mut corners = [0; 8];
                    for (half, layer) in [layer, layer + 1].into_iter().enumerate() {
                        corners[4 * half..][..4].copy_from_slice(&[
                            self.node(strip, ring, layer),
                            self.node(strip, ring + 1, layer),
                            self.node(strip + 1, ring + 1, layer),
                            self.node(strip + 1, ring, layer),
                        ]);
                    }
                    visit(&corners)?;
                }
            }
        }
        Ok(())
    }

    fn each_wedge(&self, visit: VisitElement<'_>) -> io::Result<()> {
        for layer in 0..self.layers {
            for strip in 0..self.strips() {
                let mut corners = [0; 6];
                for (half, layer) in [layer, layer + 1].into_iter().enumerate() {
                    corners[3 * half..][..3].copy_from_slice(&[
                        self.node(0, 0, layer),
                        self.node(strip, 1, layer),
                        self.node(strip + 1, 1, layer),
                    ]);
                }
                visit(&corners)?;
            }
        }
        Ok(())
    }
}

impl MeshSource for FdCylinder {
    fn nodes(&self) -> u64 {
        self.plane() * (self.layers + 1)
    }

    fn blocks(&self) -> Vec<Block> {
        let wedges = self.strips() * self.layers;
        let hexahedra = Block { shape: Shape::Hexahedron, elements: wedges * (self.rings - 1) };
        let wedges = Block { shape: Shape::Wedge, elements: wedges };
        if hexahedra.elements == 0 { vec![wedges] } else { vec![hexahedra, wedges] }
    }

    fn each_node(&self, visit: VisitNode<'_>) -> io::Result<()> {
        for layer in 0..=self.layers {
            let z = self.height * layer as f64 / self.layers as f64;
            visit([0.0, 0.0, z])?;
            for ring in 1..=self.rings {
                let r = self.radius * ring as f64 / self.rings as f64;
                for (cosine, sine) in &self.directions {
                    visit([r * cosine, r * sine, z])?;
                }
            }
        }
        Ok(())
    }

    fn each_element(&self, shape: Shape, visit: VisitElement<'_>) -> io::Result<()> {
        match shape {
            Shape::Hexahedron => self.each_hexahedron(visit),
            Shape::Wedge => self.each_wedge(visit),
            _ => Ok(()),
        }
    }
}
