//! Vectors of three doubles, and the few choices that kernels make between numbers.
//!
//! Everything here is inlined into the kernels and has no branch, so that a loop over elements becomes vector code.

/// A point or a vector of space.
pub(super) type Vector = [f64; 3];

/// From `p` to `q`, times `scale`.
#[inline(always)]
pub(super) fn edge(p: &Vector, q: &Vector, scale: f64) -> Vector {
    [(q[0] - p[0]) * scale, (q[1] - p[1]) * scale, (q[2] - p[2]) * scale]
}

#[inline(always)]
pub(super) fn add(a: &Vector, b: &Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn sub(a: &Vector, b: &Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The squared length.
#[inline(always)]
pub(super) fn square(a: &Vector) -> f64 {
    dot(a, a)
}

/// The larger one. `f64::max` has rules about NaN that cost three instructions where this takes one.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller one.
#[inline(always)]
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// `a` where the condition holds, else `b`.
#[inline(always)]
pub(super) fn choose(condition: bool, a: f64, b: f64) -> f64 {
    if condition { a } else { b }
}

/// Vector `a` where the condition holds, else `b`.
#[inline(always)]
pub(super) fn choose_vector(condition: bool, a: &Vector, b: &Vector) -> Vector {
    [choose(condition, a[0], b[0]), choose(condition, a[1], b[1]), choose(condition, a[2], b[2])]
}

/// The largest magnitude of a component of the vector from `p` to `q`.
#[inline(always)]
pub(super) fn reach(p: &Vector, q: &Vector) -> f64 {
    larger(larger((q[0] - p[0]).abs(), (q[1] - p[1]).abs()), (q[2] - p[2]).abs())
}
