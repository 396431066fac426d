//! From numbers to pixels, and where the ticks stand.

use crate::report::numbers::significant;

/// A linear or logarithmic scale.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    from: f64,
    to: f64,
    pixels: [f64; 2],
    logarithmic: bool,
}

/// A tick: where, and what stands beside it.
pub struct Tick {
    /// The value.
    pub value: f64,
    /// Its text; empty for one between two others.
    pub text: String,
}

impl Scale {
    /// Values from `from` to `to` on pixels from the first to the second.
    pub fn linear(from: f64, to: f64, pixels: [f64; 2]) -> Self {
        Self { from, to, pixels, logarithmic: false }
    }

    /// Whole decades that hold the values from `from` to `to`, both over 0.
    pub fn logarithmic(from: f64, to: f64, pixels: [f64; 2]) -> Self {
        let (from, mut to) = (from.log10().floor(), to.log10().ceil());
        if to <= from {
            to = from + 1.0;
        }
        Self { from, to, pixels, logarithmic: true }
    }

    /// The pixel of a value; of one outside the scale, its end.
    pub fn at(&self, value: f64) -> f64 {
        let value = if self.logarithmic { value.max(f64::MIN_POSITIVE).log10() } else { value };
        let share = ((value - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.pixels[0] + share * (self.pixels[1] - self.pixels[0])
    }

    /// The lower end.
    pub fn start(&self) -> f64 {
        if self.logarithmic { 10f64.powf(self.from) } else { self.from }
    }

    /// A tick a decade, or about every 150 pixels where there are more; with those between where there are few decades.
    pub fn decades(&self) -> Vec<Tick> {
        let (first, last) = (self.from as i32, self.to as i32);
        let room = ((self.pixels[1] - self.pixels[0]).abs() / 45.0).max(1.0) as i32;
        let every = ((last - first) / room + 1).max(1);
        let decades = (first..=last).map(|power| {
            let value = 10f64.powi(power);
            let text = if (power - first) % every == 0 { significant(value, 3) } else { String::new() };
            Tick { value, text }
        });
        let between = (first..last).filter(|_| last - first <= 3).flat_map(|power| {
            (2..10)
                .map(move |digit| Tick { value: f64::from(digit) * 10f64.powi(power), text: String::new() })
        });
        decades.chain(between).collect()
    }
}

/// The smallest of 1, 2, 2.5 and 5 times a power of ten that is not under the value.
pub fn round_up(value: f64) -> f64 {
    if value <= 0.0 || !value.is_finite() {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().find(|step| step * power >= value * (1.0 - 1e-12));
    step.unwrap_or(10.0) * power
}

/// Round values from 0 to one that [`round_up`] gave.
pub fn steps(to: f64) -> Vec<f64> {
    let leading = to / 10f64.powf(to.log10().floor());
    let steps = if (leading - 2.0).abs() < 1e-9 { 4 } else { 5 };
    (0..=steps).map(|step| to * f64::from(step) / f64::from(steps)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_land_where_they_should() {
        let linear = Scale::linear(0.0, 1.0, [100.0, 0.0]);
        assert_eq!([0.0, 0.25, 1.0, 7.0, -1.0].map(|value| linear.at(value)), [100.0, 75.0, 0.0, 0.0, 100.0]);
        let decades = Scale::logarithmic(0.02, 3.0, [0.0, 300.0]);
        assert_eq!(decades.start(), 0.01);
        for (value, pixel) in [(0.01, 0.0), (0.1, 100.0), (1.0, 200.0), (10.0, 300.0), (0.0, 0.0)] {
            assert!((decades.at(value) - pixel).abs() < 1e-9, "{value}");
        }
    }

    #[test]
    fn decades_of_one_value_and_of_many() {
        let one = Scale::logarithmic(1.0, 1.0, [0.0, 300.0]).decades();
        assert_eq!(one.iter().filter(|tick| !tick.text.is_empty()).count(), 2);
        let many = Scale::logarithmic(1e-300, 1e300, [0.0, 300.0]).decades();
        assert!(many.iter().filter(|tick| !tick.text.is_empty()).count() <= 8);
    }

    #[test]
    fn round_numbers() {
        for (value, round) in
            [(0.031, 0.05), (0.1, 0.1), (0.21, 0.25), (1.0, 1.0), (0.0, 1.0), (f64::NAN, 1.0)]
        {
            assert!((round_up(value) - round).abs() < 1e-12, "{value}");
        }
    }
}
