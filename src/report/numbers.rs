//! Numbers as people read them: rounded, but never to a value that says something else.

/// Decimals of a measure, as in the report's tables.
const DECIMALS: usize = 3;

/// Differences below this are rounding in the computation itself.
const NOISE: f64 = 5e-7;

/// A measure's value with three decimals. What is not 0 does not read `0.000` but `3.2e-5`, and what is under 1 does not
/// read `1.000` but `0.9997`, unless the difference is mere rounding.
pub fn score(value: f64) -> String {
    if value > 0.0 && value < 1e-3 {
        format!("{value:.1e}")
    } else if value < 1.0 - NOISE {
        below(value, 1.0)
    } else {
        format!("{value:.DECIMALS$}")
    }
}

/// A standard deviation; mere rounding in it is 0.
pub fn spread(value: f64) -> String {
    score(if value < NOISE { 0.0 } else { value })
}

/// A value with three decimals, or with as many more as it takes to read as less than the limit that it is under.
pub fn below(value: f64, limit: f64) -> String {
    if value > 0.0 && value < 1e-3 {
        return format!("{value:.1e}");
    }
    (DECIMALS..17)
        .map(|decimals| format!("{value:.decimals$}"))
        .find(|text| text.parse::<f64>().is_ok_and(|rounded| rounded < limit))
        .unwrap_or_else(|| value.to_string())
}

/// A number to so many significant digits, without trailing zeros; in powers of ten where it is very large or small.
pub fn significant(value: f64, digits: usize) -> String {
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    let decimals = usize::try_from(digits as i32 - 1 - power);
    match decimals {
        Ok(decimals) if power >= -4 => without_trailing_zeros(&format!("{value:.decimals$}")).to_owned(),
        Err(_) if power < 9 => format!("{value:.0}"),
        _ => format!("{}e{exponent}", without_trailing_zeros(mantissa)),
    }
}

fn without_trailing_zeros(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// A share as per cent.
pub fn percent(share: f64) -> String {
    format!("{} %", significant(share * 100.0, 3))
}

/// A count in groups of three digits.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::with_capacity(digits.len() * 4 / 3 + 1);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// A count and what is counted.
pub fn counted(number: u64, one: &str, many: &str) -> String {
    format!("{} {}", count(number), if number == 1 { one } else { many })
}

/// A number of bytes, in decimal units.
pub fn bytes(number: u64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    match units.iter().find(|(size, _)| number as f64 >= *size) {
        Some((size, unit)) => format!("{} {unit}", significant(number as f64 / size, 3)),
        None => counted(number, "byte", "bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores() {
        let rows = [
            (0.0, "0.000"),
            (1.0, "1.000"),
            (0.0966, "0.097"),
            (0.001, "0.001"),
            (0.00049, "4.9e-4"),
            (3.2e-300, "3.2e-300"),
            (0.9994, "0.999"),
            (0.9997, "0.9997"),
            (0.999_999, "0.999999"),
            (1.0 - 1e-7, "1.000"),
            (1.0 - f64::EPSILON, "1.000"),
        ];
        for (value, text) in rows {
            assert_eq!(score(value), text);
        }
    }

    #[test]
    fn spreads() {
        for (value, text) in [(0.0, "0.000"), (3e-16, "0.000"), (2e-5, "2.0e-5"), (0.1079, "0.108")] {
            assert_eq!(spread(value), text);
        }
    }

    #[test]
    fn a_value_reads_as_under_its_limit() {
        assert_eq!(below(0.04, 0.1), "0.040");
        assert_eq!(below(0.0999, 0.1), "0.0999");
        assert_eq!(below(0.099_999_999, 0.1), "0.099999999");
        assert_eq!(below(0.1f64.next_down(), 0.1), "0.09999999999999999");
        assert_eq!(below(0.0, 0.1), "0.000");
        assert_eq!(below(2e-9, 0.1), "2.0e-9");
    }

    #[test]
    fn significant_digits() {
        let rows = [
            (0.0, "0"),
            (9767.7031, "9767.7"),
            (1.5, "1.5"),
            (0.000_123_456_7, "0.000123457"),
            (1.25e-9, "1.25e-9"),
            (123_456_789.0, "123456789"),
            (9_999_999.6, "10000000"),
            (1e21, "1e21"),
            (-0.507, "-0.507"),
        ];
        for (value, text) in rows {
            assert_eq!(significant(value, 6), text);
        }
    }

    #[test]
    fn counts_and_bytes() {
        let rows = [(0, "0"), (999, "999"), (1000, "1,000"), (82916, "82,916"), (1_234_567, "1,234,567")];
        for (number, text) in rows {
            assert_eq!(count(number), text);
        }
        assert_eq!(counted(1, "node", "nodes"), "1 node");
        assert_eq!(
            (bytes(1), bytes(999_999), bytes(5_120_000)),
            ("1 byte".into(), "1000 kB".into(), "5.12 MB".into())
        );
    }
}
