//! M31 to M34: tetrahedra.

use super::elementary::{ROUNDING2, cosine_of_two_thirds, inverse_roots_2442, unit};
use super::vector::{Vector, choose, choose_vector, cross, dot, edge, larger, reach, smaller, square};
use super::{COMSOL_TETRAHEDRON, Family};

measures! { Family::Tetrahedron, of 4 corners:
    volume_over_edges {
        code: "M31",
        title: "Volume over squared edges",
        definition: "72√3 V/(Σl²)^(3/2)",
        watches: "aspect ratio",
        source: "Comsol Multiphysics; NPL eq. (11)",
        thresholds: &[COMSOL_TETRAHEDRON],
    }
    gradient {
        code: "M32",
        title: "Gradient interpolation",
        definition: "9.6058568005065245 V [ΣA/(ΣAᵢAⱼlᵢⱼ² + 6V maxᵢ Σⱼ Aⱼlᵢⱼ)]^¾",
        watches: "interpolation error of gradients",
        source: "Shewchuk 2002; NPL eq. (12), with the factor that it lacks",
        thresholds: &[],
    }
    conditioning {
        code: "M33",
        title: "Conditioning",
        definition: "(V/λ³)^¼/√3, λ the largest root of NPL eq. (14)",
        watches: "conditioning of the stiffness matrix",
        source: "Shewchuk 2002; NPL eq. (13)",
        thresholds: &[],
    }
    radius_ratio {
        code: "M34",
        title: "Ratio of radii",
        definition: "3r/R, R of the minimum containment sphere",
        watches: "flatness",
        source: "Cavendish, Field and Frey 1985; NPL eq. (15)",
        thresholds: &[],
    }
}

/// What the measures are made of, in units of about the longest edge.
struct Facts {
    /// 6|V|; 0 where it is within the rounding error of its computation.
    volume: f64,
    /// [Σl²]^(-1/2)
    edges: f64,
    /// [(ΣAᵢAⱼlᵢⱼ² + 6V maxᵢ Σⱼ Aⱼlᵢⱼ)/ΣA]^(-1/4) with twice the areas.
    gradient: f64,
    /// μ^(-1/4), see [`conditioning`].
    eigenvalue: f64,
    /// 1/(2RΣA) with twice the areas.
    radii: f64,
}

impl Facts {
    #[inline(always)]
    fn of(p: &[Vector; 4]) -> Self {
        let t = Parts::of(p);
        // A root is a chain of steps that wait for each other: the four are drawn side by side, and what takes longest to
        // come to is begun first.
        let ball = t.containment_ball();
        let surface = t.surface();
        let radii = ball.below * ball.above * (surface * surface);
        let eigenvalue = largest_eigenvalue(&t.normals);
        let gradient = t.gradient();
        let edges = t.sum_of_squares();
        let [edges, gradient, eigenvalue, radii] = inverse_roots_2442([edges, gradient, eigenvalue, radii]);
        Facts { volume: t.volume, edges, gradient, eigenvalue, radii: ball.below * radii }
    }
}

#[inline(always)]
fn volume_over_edges(t: &Facts) -> f64 {
    20.784_609_690_826_528 * t.volume * cube(t.edges)
}

#[inline(always)]
fn gradient(t: &Facts) -> f64 {
    1.600_976_133_417_754 * t.volume * cube(t.gradient)
}

/// λ is the largest eigenvalue of Σ AᵢAᵢᵀ/(9V) over the faces' area vectors. With μ that of twice the area vectors and
/// without the division, M33 = √2 6V / μ^¾.
#[inline(always)]
fn conditioning(t: &Facts) -> f64 {
    std::f64::consts::SQRT_2 * t.volume * cube(t.eigenvalue)
}

/// r = 3V/ΣA.
#[inline(always)]
fn radius_ratio(t: &Facts) -> f64 {
    6.0 * t.volume * t.radii
}

#[inline(always)]
fn cube(x: f64) -> f64 {
    x * x * x
}

/// What the facts share, in units of about the longest edge.
struct Parts {
    /// Squared edges 01, 02, 03, 12, 13, 23.
    squares: [f64; 6],
    /// Twice the area vectors of the faces opposite corners 0 to 3. Those opposite 1, 2 and 3 add up to that
    /// opposite 0.
    normals: [Vector; 4],
    /// Their lengths.
    areas: [f64; 4],
    /// 6|V|; 0 where it is within the rounding error of its computation.
    volume: f64,
}

impl Parts {
    #[inline(always)]
    fn of(p: &[Vector; 4]) -> Self {
        let far = larger(larger(reach(&p[0], &p[1]), reach(&p[0], &p[2])), reach(&p[0], &p[3]));
        let (scale, _) = unit(far);
        let edges = Edges::of(p, scale);
        let [a, b, c, d, e, _] = &edges.vectors;
        let normals = [cross(d, e), cross(b, c), cross(c, a), cross(a, b)];
        let areas = [
            square(&normals[0]).sqrt(),
            square(&normals[1]).sqrt(),
            square(&normals[2]).sqrt(),
            square(&normals[3]).sqrt(),
        ];
        let (determinant, bound) = edges.determinant();
        let volume = choose(determinant * determinant > bound, determinant.abs(), 0.0);
        Parts { squares: edges.squares, normals, areas, volume }
    }

    #[inline(always)]
    fn surface(&self) -> f64 {
        let [a, b, c, d] = self.areas;
        (a + b) + (c + d)
    }

    #[inline(always)]
    fn sum_of_squares(&self) -> f64 {
        let [a, b, c, d, e, f] = self.squares;
        ((a + b) + (c + d)) + (e + f)
    }

    /// (ΣAᵢAⱼlᵢⱼ² + 6V maxᵢ Σⱼ Aⱼlᵢⱼ)/ΣA with twice the areas.
    #[inline(always)]
    fn gradient(&self) -> f64 {
        let [s01, s02, s03, s12, s13, s23] = self.squares;
        let [a0, a1, a2, a3] = self.areas;
        let pairs = ((a0 * a1) * s01 + (a0 * a2) * s02 + (a0 * a3) * s03)
            + ((a1 * a2) * s12 + (a1 * a3) * s13 + (a2 * a3) * s23);
        let (l01, l02, l03) = (s01.sqrt(), s02.sqrt(), s03.sqrt());
        let (l12, l13, l23) = (s12.sqrt(), s13.sqrt(), s23.sqrt());
        let from0 = a1 * l01 + a2 * l02 + a3 * l03;
        let from1 = a0 * l01 + a2 * l12 + a3 * l13;
        let from2 = a0 * l02 + a1 * l12 + a3 * l23;
        let from3 = a0 * l03 + a1 * l13 + a2 * l23;
        let most = larger(larger(from0, from1), larger(from2, from3));
        (pairs + 2.0 * self.volume * most) / (2.0 * self.surface())
    }

    /// The containment sphere is the largest of the smallest spheres through an edge, a face or all corners whose
    /// centre lies within that edge, face or tetrahedron. 4R² is kept as a fraction, so that spheres are compared
    /// without dividing.
    #[inline(always)]
    fn containment_ball(&self) -> Ball {
        let [s01, s02, s03, s12, s13, s23] = self.squares;
        let [a0, a1, a2, a3] = self.areas;
        let longest = larger(larger(larger(s01, s02), larger(s03, s12)), larger(s13, s23));
        let ball = Ball { above: longest, below: 1.0 };
        let ball = ball.or_face(s12, s13, s23, a0);
        let ball = ball.or_face(s02, s03, s23, a1);
        let ball = ball.or_face(s01, s03, s13, a2);
        let ball = ball.or_face(s01, s02, s12, a3);

        // The circumcentre seen from corner 0 is q/12V; q·nᵢ are its barycentric coordinates.
        let [n0, n1, n2, n3] = &self.normals;
        let q = [
            s01 * n1[0] + s02 * n2[0] + s03 * n3[0],
            s01 * n1[1] + s02 * n2[1] + s03 * n3[1],
            s01 * n1[2] + s02 * n2[2] + s03 * n3[2],
        ];
        let square_volume = self.volume * self.volume;
        let inside = (dot(&q, n1) >= 0.0)
            & (dot(&q, n2) >= 0.0)
            & (dot(&q, n3) >= 0.0)
            & (dot(&q, n0) <= 2.0 * square_volume);
        ball.or(inside, square(&q), square_volume)
    }
}

/// The edges 01, 02, 03, 12, 13, 23 as vectors, and their squared lengths.
struct Edges {
    vectors: [Vector; 6],
    squares: [f64; 6],
}

impl Edges {
    #[inline(always)]
    fn of(p: &[Vector; 4], scale: f64) -> Self {
        let vectors = [
            edge(&p[0], &p[1], scale),
            edge(&p[0], &p[2], scale),
            edge(&p[0], &p[3], scale),
            edge(&p[1], &p[2], scale),
            edge(&p[1], &p[3], scale),
            edge(&p[2], &p[3], scale),
        ];
        let [a, b, c, d, e, f] = &vectors;
        let squares = [square(a), square(b), square(c), square(d), square(e), square(f)];
        Edges { vectors, squares }
    }

    /// 6V with its sign, and the square of a bound on its rounding error.
    ///
    /// Taken from corner 0 or 1, where the edges are shorter: three long edges to one far corner lose digits.
    #[inline(always)]
    fn determinant(&self) -> (f64, f64) {
        let [a, b, c, d, e, _] = &self.vectors;
        let [aa, bb, cc, dd, ee, _] = self.squares;
        let normal = choose_vector(dd * ee < bb * cc, &cross(d, e), &cross(b, c));
        (dot(a, &normal), ROUNDING2 * (aa * smaller(dd * ee, bb * cc)))
    }
}

/// 6V with its sign, and the square of a bound on its rounding error.
#[inline(always)]
pub(super) fn determinant(p: &[Vector; 4], scale: f64) -> (f64, f64) {
    Edges::of(p, scale).determinant()
}

/// The largest eigenvalue of N = Σ n nᵀ over four vectors: mean + 2ρ cos(θ/3), with ρ and θ from the invariants
/// of the deviator of N.
///
/// The angle's sine comes from the discriminant as a sum of squares, since 1 + cos θ keeps only half the digits
/// where the two largest eigenvalues (nearly) coincide, as they do in every tetrahedron stretched along an axis
/// of symmetry.
#[inline(always)]
fn largest_eigenvalue(n: &[Vector; 4]) -> f64 {
    let [a, b, c, d] = n;
    let xx = a[0] * a[0] + b[0] * b[0] + (c[0] * c[0] + d[0] * d[0]);
    let yy = a[1] * a[1] + b[1] * b[1] + (c[1] * c[1] + d[1] * d[1]);
    let zz = a[2] * a[2] + b[2] * b[2] + (c[2] * c[2] + d[2] * d[2]);
    let yz = a[1] * a[2] + b[1] * b[2] + (c[1] * c[2] + d[1] * d[2]);
    let zx = a[2] * a[0] + b[2] * b[0] + (c[2] * c[0] + d[2] * d[0]);
    let xy = a[0] * a[1] + b[0] * b[1] + (c[0] * c[1] + d[0] * d[1]);

    let mean = (xx + yy + zz) * (1.0 / 3.0);
    let (x, y, z) = (xx - mean, yy - mean, zz - mean);
    let (p, q, r) = (yz * yz, zx * zx, xy * xy);
    let (u, v, w) = (yy - zz, zz - xx, xx - yy);
    let rho2 = (u * u + v * v + w * w) * (1.0 / 18.0) + (p + q + r) * (1.0 / 3.0);
    // The deviator's determinant is 2ρ³ cos θ.
    let third = x * (y * z - p) - y * q - z * r + 2.0 * (yz * zx * xy);
    let cube = 2.0 * rho2 * rho2.sqrt();
    let discriminant = discriminant([u, v, w], [yz, zx, xy], [p, q, r]);
    // cos²(θ/2) = (1 + cos θ)/2, or where that cancels sin²θ/(2(1 - cos θ)); the discriminant is 27 (2ρ³ sin θ)².
    let obtuse = third < 0.0;
    let above = choose(obtuse, discriminant, cube + third);
    let below = choose(obtuse, 54.0 * cube * (cube - third), 2.0 * cube);
    // A multiple of the identity has no angle, and any will do.
    let half = (above / (below + f64::MIN_POSITIVE)).sqrt();
    mean + 2.0 * rho2.sqrt() * cosine_of_two_thirds(smaller(half, 1.0))
}

/// The discriminant (λ₁-λ₂)²(λ₂-λ₃)²(λ₃-λ₁)² of a symmetric matrix as a sum of seven squares.
///
/// It is the Gram determinant of I, N and N², and so, by Cauchy and Binet, the sum of the squares of the minors of
/// these three seen as vectors of nine; most of them are equal or add up to another.
/// Given are the differences of the diagonal (yy-zz, zz-xx, xx-yy), the entries yz, zx, xy and their squares.
#[inline(always)]
fn discriminant([u, v, w]: Vector, [yz, zx, xy]: Vector, [p, q, r]: Vector) -> f64 {
    let k1 = zx * xy * u + yz * (q - r);
    let k2 = xy * yz * v + zx * (r - p);
    let k3 = yz * zx * w + xy * (p - q);
    let h1 = yz * (2.0 * (v * w + p) - q - r) + zx * xy * (w - v);
    let h2 = zx * (2.0 * (w * u + q) - r - p) + xy * yz * (u - w);
    let h3 = xy * (2.0 * (u * v + r) - p - q) + yz * zx * (v - u);
    let d = u * v * w + u * p + v * q + w * r;
    d * d + (h1 * h1 + h2 * h2 + h3 * h3) + 15.0 * (k1 * k1 + k2 * k2 + k3 * k3)
}

/// A ball's 4R² as a fraction.
struct Ball {
    above: f64,
    below: f64,
}

impl Ball {
    /// The larger of this ball and another that counts only where `valid`.
    #[inline(always)]
    fn or(self, valid: bool, above: f64, below: f64) -> Self {
        let better = valid & (above * self.below >= self.above * below);
        Ball { above: choose(better, above, self.above), below: choose(better, below, self.below) }
    }

    /// The circumcircle's ball of a face of squared edges `a`, `b`, `c`, if the face is acute.
    #[inline(always)]
    fn or_face(self, a: f64, b: f64, c: f64, twice_area: f64) -> Self {
        let acute = a + b + c >= 2.0 * larger(larger(a, b), c);
        self.or(acute, a * b * c, twice_area * twice_area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_discriminant_is_that_of_the_characteristic_polynomial() {
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for _ in 0..10_000 {
            let [xx, yy, zz, yz, zx, xy] = [random(), random(), random(), random(), random(), random()];
            let squares =
                discriminant([yy - zz, zz - xx, xx - yy], [yz, zx, xy], [yz * yz, zx * zx, xy * xy]);
            let b = -(xx + yy + zz);
            let c = xx * yy + yy * zz + zz * xx - yz * yz - zx * zx - xy * xy;
            let d = -(xx * yy * zz + 2.0 * yz * zx * xy - xx * yz * yz - yy * zx * zx - zz * xy * xy);
            let cubic =
                18.0 * b * c * d - 4.0 * b * b * b * d + b * b * c * c - 4.0 * c * c * c - 27.0 * d * d;
            assert!((squares - cubic).abs() < 1e-12, "{squares} {cubic}");
        }
    }
}
