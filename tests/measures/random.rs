//! Reproducible random elements, from round to hopeless.

/// A small generator (SplitMix64): the same numbers on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [-1, 1).
    pub(crate) fn number(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn below(&mut self, n: u64) -> usize {
        (self.bits() % n) as usize
    }

    /// A regular element of `N` corners (the first corners of a cube's, from 5 on), jittered by up to `jitter`.
    pub(crate) fn element<const N: usize>(&mut self, jitter: f64) -> [[f64; 3]; N] {
        let mut points = regular::<N>();
        for c in points.as_flattened_mut() {
            *c += jitter * self.number();
        }
        points
    }

    /// An element of any kind, hopeless ones among them: clouds, needles, flat and collinear ones, repeated corners,
    /// far from the origin, of any size that a double holds.
    pub(crate) fn any_element<const N: usize>(&mut self) -> [[f64; 3]; N] {
        let mut points = self.element::<N>(0.5);
        let small = (-60.0 * self.number().abs()).exp2();
        match self.below(10) {
            0 => points[1] = points[0].map(|c| c * (1.0 + small)),
            1 => points.iter_mut().for_each(|p| p[2] *= small),
            2 => points.iter_mut().for_each(|p| *p = [p[0], p[1] * small, p[2] * small]),
            3 => points[N - 1] = points[0],
            4 => points.iter_mut().for_each(|p| *p = [p[0], 0.3 * p[0], 0.7 * p[0]]),
            5 => points.iter_mut().for_each(|p| *p = p.map(|c| c + 1e6)),
            6 => points.iter_mut().for_each(|p| *p = p.map(|c| (3.0 * c).round())),
            7 => {
                let size = (1070.0 * self.number()).exp2();
                points.iter_mut().for_each(|p| *p = p.map(|c| c * size));
            }
            8 => {
                for c in points.as_flattened_mut() {
                    *c = f64::from_bits(self.bits());
                    *c = if c.is_finite() { *c } else { 0.0 };
                }
            }
            _ => {}
        }
        points
    }
}

/// The element that scores 1, or a cube's first corners.
pub(crate) fn regular<const N: usize>() -> [[f64; 3]; N] {
    let points: &[[f64; 3]] = match N {
        3 => &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.866_025_403_784_438_6, 0.0]],
        4 => &[[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]],
        5 => &[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.5, 0.5, 0.7]],
        6 => &[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.]],
        _ => &CUBE,
    };
    points.try_into().expect("shapes have 3, 4, 5, 6 or 8 corners")
}

/// A quadrilateral that scores 1.
pub(crate) const SQUARE: [[f64; 3]; 4] = [CUBE[0], CUBE[1], CUBE[2], CUBE[3]];

pub(crate) const CUBE: [[f64; 3]; 8] = [
    [0., 0., 0.],
    [1., 0., 0.],
    [1., 1., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [1., 0., 1.],
    [1., 1., 1.],
    [0., 1., 1.],
];
