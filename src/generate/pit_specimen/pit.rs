//! The pit's surface: a hemisphere, with a straight shaft above it where the pit is deeper than half its width.
//!
//! Points of it are found along meridians: from the deepest point towards an azimuth (0 is round the specimen, a right
//! angle along its axis) up to the rim, where pit and specimen meet.

use std::f64::consts::{FRAC_PI_2, TAU};

/// A pit that looks along x in the side of a cylinder round z, whose middle is at z = 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pit {
    /// Radius of the specimen.
    pub(super) specimen: f64,
    /// Radius of the pit, half its width.
    pub(super) radius: f64,
    /// How far the centre of the hemisphere lies under the specimen's surface.
    pub(super) sunk: f64,
}

/// Where a meridian leaves the hemisphere, and how far it goes on.
struct Meridian {
    /// The angle from the deepest point at which the hemisphere ends.
    angle: f64,
    /// Length of the shaft above.
    shaft: f64,
}

impl Pit {
    /// The meridian towards an azimuth of the given cosine and sine.
    fn meridian(&self, cosine: f64, sine: f64) -> Meridian {
        let (r, centre) = (self.radius, self.specimen - self.sunk);
        let across = r * cosine;
        // The specimen's surface over the equator's point, from the equator's plane.
        let above = (self.specimen * self.specimen - across * across).sqrt() - centre;
        if above >= 0.0 {
            return Meridian { angle: FRAC_PI_2, shaft: above };
        }
        // The rim is on the sphere: at the cosine w of the angle for which
        // (centre - r w)^2 + (1 - w^2) (r cosine)^2 is the specimen's radius squared.
        let (a, b) = (r * r * sine * sine, centre * r);
        let c = centre * centre + across * across - self.specimen * self.specimen;
        let w = c / (b + (b * b - a * c).sqrt());
        Meridian { angle: w.acos(), shaft: 0.0 }
    }

    /// The point at a share (0 the deepest point, 1 the rim) of the meridian towards an azimuth.
    pub(super) fn point(&self, azimuth: f64, share: f64) -> [f64; 3] {
        let (sine, cosine) = azimuth.sin_cos();
        let meridian = self.meridian(cosine, sine);
        let along = share * (self.radius * meridian.angle + meridian.shaft);
        let angle = (along / self.radius).min(meridian.angle);
        let climbed = (along - self.radius * meridian.angle).max(0.0);
        let out = self.radius * angle.sin();
        let x = self.specimen - self.sunk - self.radius * angle.cos() + climbed;
        [x, out * cosine, out * sine]
    }

    /// Volume of what the pit takes from the specimen: an integral over the pit's floor, by Simpson's rule along
    /// meridians and the trapezium rule round them, good to 12 digits and more.
    pub(super) fn volume(&self) -> f64 {
        const MERIDIANS: u32 = 256;
        const STEPS: u32 = 256;
        let column = |cosine: f64, angle: f64| {
            let (s, c) = angle.sin_cos();
            let across = self.radius * s * cosine;
            let top = (self.specimen * self.specimen - across * across).sqrt();
            let floor = self.specimen - self.sunk - self.radius * c;
            (top - floor) * self.radius * self.radius * s * c
        };
        let along = |azimuth: f64| {
            let (sine, cosine) = azimuth.sin_cos();
            let end = self.meridian(cosine, sine).angle;
            let step = end / f64::from(STEPS);
            let weight = |k| if k == 0 || k == STEPS { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            (0..=STEPS).map(|k| weight(k) * column(cosine, f64::from(k) * step)).sum::<f64>() * step / 3.0
        };
        let turn = TAU / f64::from(MERIDIANS);
        (0..MERIDIANS).map(|k| along(turn * f64::from(k))).sum::<f64>() * turn
    }
}
