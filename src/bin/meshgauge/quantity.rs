//! Sizes (`256MiB`) and durations (`2s`) as users write them.

use std::fmt;
use std::str::FromStr;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

/// A number of bytes: `256MiB`, `1.5GB`, `4096`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Size(pub u64);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse::<bytesize::ByteSize>() {
            Ok(size) => Ok(Size(size.as_u64())),
            Err(_) => Err(format!("expected a size such as 256MiB, found \"{text}\"")),
        }
    }
}

/// A length of time: `2s`, `1h 30min`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Span(pub Duration);

impl FromStr for Span {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match humantime::parse_duration(text) {
            Ok(duration) => Ok(Span(duration)),
            Err(_) => Err(format!("expected a duration such as 2s or 5min, found \"{text}\"")),
        }
    }
}

/// A point in time, as a length of time before now (`7d`), a day (`2026-11-15`) or a time of UTC (`2026-11-15T06:00:00Z`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Since(pub SystemTime);

impl FromStr for Since {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("expected a duration such as 7d, or a day such as 2026-11-15, found \"{text}\"");
        if let Ok(before) = humantime::parse_duration(text) {
            let time = SystemTime::now().checked_sub(before).filter(|time| *time >= SystemTime::UNIX_EPOCH);
            return time.map(Self).ok_or_else(wrong);
        }
        let midnight = format!("{text} 00:00:00");
        let time = humantime::parse_rfc3339_weak(text).or_else(|_| humantime::parse_rfc3339_weak(&midnight));
        time.map(Self).map_err(|_| wrong())
    }
}

/// RFC 3339 in UTC, as times stand in the state.
impl fmt::Display for Since {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        humantime::format_rfc3339_millis(self.0).fmt(f)
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        bytesize::ByteSize(self.0).display().iec().fmt(f)
    }
}

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        humantime::format_duration(self.0).fmt(f)
    }
}

impl TryFrom<String> for Size {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl TryFrom<String> for Span {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

/// Exact, unlike the text for people.
impl From<Size> for String {
    fn from(size: Size) -> Self {
        size.0.to_string()
    }
}

impl From<Span> for String {
    fn from(span: Span) -> Self {
        span.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_binary_or_decimal_as_written() {
        assert_eq!("256MiB".parse(), Ok(Size(256 << 20)));
        assert_eq!("1GB".parse(), Ok(Size(1_000_000_000)));
        assert_eq!("4096".parse(), Ok(Size(4096)));
        assert!("much".parse::<Size>().is_err());
        assert!("-1".parse::<Size>().is_err());
    }

    #[test]
    fn a_time_is_told_by_its_distance_or_its_day() {
        let day: Since = "2026-11-15".parse().expect("a day");
        assert_eq!(day.to_string(), "2026-11-15T00:00:00.000Z");
        assert_eq!("2026-11-15T00:00:00Z".parse(), Ok(day));
        assert_eq!("2026-11-15 00:00:00".parse(), Ok(day));
        let week: Since = "7d".parse().expect("a duration");
        let distance = week.0.elapsed().expect("before now").as_secs();
        assert!((604_800..604_900).contains(&distance), "{distance}");
        for wrong in ["yesterday", "", "2026-13-01", "99999999999y", "-1d"] {
            assert!(wrong.parse::<Since>().is_err_and(|why| why.contains("such as 7d")), "{wrong}");
        }
    }

    #[test]
    fn quantities_survive_the_way_to_a_worker() {
        let size = Size(123_456_789);
        assert_eq!(String::from(size).parse(), Ok(size));
        let span = Span(Duration::from_millis(90_061_001));
        assert_eq!(String::from(span).parse(), Ok(span));
    }
}
