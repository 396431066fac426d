//! Elementary functions without branches, calls or fused multiply-adds: the same bits on every machine.
//!
//! The standard library's go to the host's mathematical library, which stops a loop from becoming vector code
//! and differs between systems.

use super::vector::choose;

/// A bound, relative to the product of the lengths that go in, on the rounding error of a cross or triple product of
/// edge vectors: what lies within it has no sign. (Shewchuk's bound for the determinant of three edges is 7
/// units of 2⁻⁵³ times its permanent, and that is under 1.2 times the product of the lengths.)
pub(super) const ROUNDING: f64 = 10.0 / (1u64 << 53) as f64;

/// [`ROUNDING`] for squared quantities.
pub(super) const ROUNDING2: f64 = ROUNDING * ROUNDING;

/// The power of two that brings a length `x` to between 1 and 2, and its inverse.
///
/// Multiplying by a power of two is exact, so an element measured in such units keeps every digit, and fourth and
/// higher powers of its lengths neither overflow nor vanish.
#[inline(always)]
pub(super) fn unit(x: f64) -> (f64, f64) {
    const ONE: i64 = 1 << 52;
    let exponent = x.to_bits() as i64 & (0x7ff * ONE);
    let exponent = if exponent > ONE { exponent } else { ONE };
    let exponent = if exponent < 2045 * ONE { exponent } else { 2045 * ONE };
    (f64::from_bits((2046 * ONE - exponent) as u64), f64::from_bits(exponent as u64))
}

/// x^(-1/K) for x > 0 and K of 2, 3 or 4, within 2 units in the last place; at 0 something large and finite.
///
/// The exponent is divided by -K in integers, which is right to a few percent, and two fourth-order steps do the
/// rest. Unlike square roots and divisions, which share one slow unit of the processor, this is all multiplications.
#[inline(always)]
pub(super) fn inverse_root<const K: usize>(x: f64) -> f64 {
    closer_inverse_root::<K>(x, closer_inverse_root::<K>(x, rough_inverse_root::<K>(x)))
}

/// x^(-1/K) within a few percent.
#[inline(always)]
fn rough_inverse_root<const K: usize>(x: f64) -> f64 {
    // The upper half of the bits; a third of them by a multiplication that all vector units have.
    let upper = x.to_bits() >> 32;
    let (start, part) = match K {
        2 => (0x5fe6_e918_u64, upper >> 1),
        3 => (0x553e_e918, (upper * 0x5555_5556) >> 32),
        _ => (0x4feb_02e0, upper >> 2),
    };
    f64::from_bits(start.wrapping_sub(part) << 32)
}

/// With e = 1 - x t^K, x^(-1/K) = t (1-e)^(-1/K), by the first terms of its binomial series.
#[inline(always)]
fn closer_inverse_root<const K: usize>(x: f64, t: f64) -> f64 {
    let power = match K {
        2 => x * t * t,
        3 => x * t * t * t,
        _ => x * (t * t) * (t * t),
    };
    let Series { first, second, third } = const { Series::of(K as f64) };
    let e = 1.0 - power;
    t + t * (e * (first + e * (second + e * third)))
}

/// [`inverse_root`] of four numbers, with K of 2, 4, 4 and 2: the same bits, step by step side by side.
#[inline(always)]
pub(super) fn inverse_roots_2442(x: [f64; 4]) -> [f64; 4] {
    let rough = [
        rough_inverse_root::<2>(x[0]),
        rough_inverse_root::<4>(x[1]),
        rough_inverse_root::<4>(x[2]),
        rough_inverse_root::<2>(x[3]),
    ];
    closer_inverse_roots_2442(x, closer_inverse_roots_2442(x, rough))
}

#[inline(always)]
fn closer_inverse_roots_2442(x: [f64; 4], t: [f64; 4]) -> [f64; 4] {
    const HALF: Series = Series::of(2.0);
    const QUARTER: Series = Series::of(4.0);
    const SERIES: [Series; 4] = [HALF, QUARTER, QUARTER, HALF];
    /// Written out: a loop over four would be turned the wrong way round in the loop over lanes.
    macro_rules! each {
        ($k:ident => $value:expr) => {
            [
                {
                    const $k: usize = 0;
                    $value
                },
                {
                    const $k: usize = 1;
                    $value
                },
                {
                    const $k: usize = 2;
                    $value
                },
                {
                    const $k: usize = 3;
                    $value
                },
            ]
        };
    }
    let squares = each!(K => t[K] * t[K]);
    let powers = [
        x[0] * t[0] * t[0],
        x[1] * squares[1] * squares[1],
        x[2] * squares[2] * squares[2],
        x[3] * t[3] * t[3],
    ];
    let e = each!(K => 1.0 - powers[K]);
    let sum = each!(K => e[K] * SERIES[K].third);
    let sum = each!(K => SERIES[K].second + sum[K]);
    let sum = each!(K => e[K] * sum[K]);
    let sum = each!(K => SERIES[K].first + sum[K]);
    let sum = each!(K => e[K] * sum[K]);
    each!(K => t[K] + t[K] * sum[K])
}

/// Coefficients of the binomial series of (1-e)^(-1/K).
struct Series {
    first: f64,
    second: f64,
    third: f64,
}

impl Series {
    const fn of(k: f64) -> Self {
        let first = 1.0 / k;
        let second = first * (1.0 + first) / 2.0;
        Self { first, second, third: second * (2.0 + first) / 3.0 }
    }
}

/// The angle between two vectors, in [0, π], from the magnitude of their cross product, their dot product and the
/// product of their lengths; 0 where all three are 0.
///
/// An arc cosine loses half the digits of angles near 0 and π; the half angle's tangent loses none.
#[inline(always)]
pub(super) fn angle(sine: f64, cosine: f64, lengths: f64) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    const TAN_22_5: f64 = 0.414_213_562_373_095_05;
    // The acute angle's half has the tangent sine / along, in [0, 1]; past 22.5° take 45° less it.
    let along = lengths + cosine.abs();
    let low = sine <= TAN_22_5 * along;
    let above = choose(low, sine, along - sine);
    let below = choose(low, along, along + sine);
    let twice = 2.0 * small_arc_tangent(above / (below + f64::MIN_POSITIVE));
    let acute = choose(low, twice, FRAC_PI_2 - twice);
    choose(cosine < 0.0, PI - acute, acute)
}

/// atan(t) for |t| < 7/16, within one unit in the last place (the polynomial of FDLIBM's s_atan.c).
#[inline(always)]
fn small_arc_tangent(t: f64) -> f64 {
    let z = t * t;
    let w = z * z;
    let odd = w * 1.628_582_011_536_578_2e-2 + 4.976_877_994_615_932e-2;
    let odd = w * odd + 6.661_073_137_387_531e-2;
    let odd = w * odd + 9.090_887_133_436_507e-2;
    let odd = w * odd + 1.428_571_427_250_346_6e-1;
    let odd = w * odd + 3.333_333_333_333_293e-1;
    let even = w * -3.653_157_274_421_691_6e-2 - 5.833_570_133_790_573_5e-2;
    let even = w * even - 7.691_876_205_044_83e-2;
    let even = w * even - 1.111_111_040_546_235_6e-1;
    let even = w * even - 1.999_999_999_987_648_3e-1;
    t - t * (z * odd + w * even)
}

/// cos(⅔ acos u) for u in [0, 1], within 2e-16: with u = cos(θ/2) it is cos(θ/3).
///
/// The function is analytic there (its branch point is at -1), so one interpolating polynomial in 2u - 1 serves.
#[inline(always)]
pub(super) fn cosine_of_two_thirds(u: f64) -> f64 {
    let x = 2.0 * u - 1.0;
    // Pairs, fours, eights: one term after another would be a chain of 34 steps, and the processor would wait for it.
    let x2 = x * x;
    let x4 = x2 * x2;
    let x8 = x4 * x4;
    let low = four(
        [
            0.766_044_443_118_977_9,
            0.247_409_066_322_853_1,
            -0.015_509_188_436_466_925,
            0.002_466_352_815_080_786_5,
        ],
        x,
        x2,
    ) + x4
        * four(
            [
                -0.000_504_124_691_647_182_3,
                0.000_116_425_453_105_203_61,
                -2.891_993_106_141_799_5e-5,
                7.541_076_906_895_577e-6,
            ],
            x,
            x2,
        );
    let high = four(
        [
            -2.035_896_711_396_145_3e-6,
            5.641_598_426_946_4e-7,
            -1.594_650_404_385_395_4e-7,
            4.583_483_187_568_922e-8,
        ],
        x,
        x2,
    ) + x4
        * four(
            [
                -1.348_180_209_578_561e-8,
                3.972_853_735_371_566e-9,
                -1.052_665_824_108_632_4e-9,
                3.146_175_703_917_731_3e-10,
            ],
            x,
            x2,
        );
    let highest = 4.990_811_057_596_218_3e-11 * x - 1.635_825_098_885_818_3e-10;
    low + x8 * (high + x8 * highest)
}

/// Four terms of a polynomial in `x`, given `x` squared.
#[inline(always)]
fn four(terms: [f64; 4], x: f64, x2: f64) -> f64 {
    (terms[0] + terms[1] * x) + x2 * (terms[2] + terms[3] * x)
}

/// A finished score: within [0, 1], and 0 where it is not a number, as that of a degenerate element.
#[inline(always)]
pub(super) fn score(x: f64) -> f64 {
    let x = choose(x > 0.0, x, 0.0);
    choose(x < 1.0, x, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance in units in the last place of the second number.
    fn ulps(a: f64, b: f64) -> f64 {
        (a - b).abs() / (f64::from_bits(b.abs().to_bits() + 1) - b.abs())
    }

    #[test]
    fn inverse_roots_are_those_of_the_standard_library() {
        let mut worst = [0.0; 3];
        for i in 0..200_000 {
            let x = (f64::from(i) * 0.009_5 - 950.0).exp2() * (1.0 + f64::from(i % 97) / 97.0);
            let found = [inverse_root::<2>(x), inverse_root::<3>(x), inverse_root::<4>(x)];
            let expected = [1.0 / x.sqrt(), 1.0 / x.cbrt(), 1.0 / x.sqrt().sqrt()];
            for k in 0..3 {
                worst[k] = f64::max(worst[k], ulps(found[k], expected[k]));
            }
        }
        // The cube root of the standard library is itself off by up to 3.
        assert!(worst[0] <= 2.0 && worst[1] <= 5.0 && worst[2] <= 3.0, "{worst:?} units in the last place");
        for k in 1..1000 {
            let k = f64::from(k);
            assert!(ulps(inverse_root::<3>(k * k * k), 1.0 / k) <= 2.0, "{k}");
        }
        assert!(inverse_root::<2>(0.0).is_finite() && inverse_root::<3>(0.0).is_finite());
        assert!(inverse_root::<4>(0.0).is_finite());
    }

    #[test]
    fn four_roots_are_the_same_bits_as_one_by_one() {
        for i in 0..10_000 {
            let x = [0, 1, 2, 3].map(|k| (f64::from(i) * 0.19 - 950.0 + f64::from(k)).exp2() * 1.37);
            let one_by_one = [
                inverse_root::<2>(x[0]),
                inverse_root::<4>(x[1]),
                inverse_root::<4>(x[2]),
                inverse_root::<2>(x[3]),
            ];
            assert_eq!(inverse_roots_2442(x), one_by_one);
        }
    }

    #[test]
    fn angle_is_the_standard_arc_tangent() {
        let mut worst: f64 = 0.0;
        for i in 0..200_000 {
            let size = (f64::from(i % 40) - 20.0).exp2();
            let turn = f64::from(i) * std::f64::consts::PI / 200_000.0;
            let (sine, cosine) = (size * turn.sin(), size * turn.cos());
            // The product of lengths as the kernels have it: rounded.
            let lengths = (sine * sine + cosine * cosine).sqrt();
            worst = worst.max(ulps(angle(sine, cosine, lengths), sine.atan2(cosine)));
        }
        assert!(worst <= 3.0, "{worst} units in the last place");
        for tiny in [1e-8, 1e-16, 1e-100] {
            assert!(ulps(angle(tiny, 1.0, 1.0), tiny) <= 2.0);
        }
        assert_eq!(angle(0.0, 0.0, 0.0), 0.0);
        assert_eq!(angle(0.0, -1.0, 1.0), std::f64::consts::PI);
    }

    #[test]
    fn two_thirds_of_an_angle() {
        for i in 0..=100_000 {
            let u = f64::from(i) / 100_000.0;
            let expected = (2.0 / 3.0 * u.acos()).cos();
            assert!((cosine_of_two_thirds(u) - expected).abs() <= 5e-16, "{u}");
        }
    }

    #[test]
    fn a_unit_is_a_power_of_two_with_an_exact_inverse() {
        for x in [0.0, 5e-324, 1e-310, 1e-150, 0.3, 1.0, 1.999, 7.0, 1e150, 1e308, f64::INFINITY] {
            let (scale, inverse) = unit(x);
            assert_eq!(scale * inverse, 1.0, "{x}");
            let extreme = !(1e-307..8e307).contains(&x);
            assert!(extreme || (1.0..2.0).contains(&(x * scale)), "{x}");
        }
    }

    #[test]
    fn scores_stay_in_range_and_are_never_nan() {
        assert_eq!(score(f64::NAN), 0.0);
        assert_eq!(score(-1.0), 0.0);
        assert_eq!(score(f64::INFINITY), 1.0);
        assert_eq!(score(0.25), 0.25);
    }
}
