//! The INCLUDE statement: a file's name, plain or between quotes, which may go on over lines.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;

use crate::error::{Error, Result, excerpt};

/// The longest statement.
pub(super) const MOST_BYTES: u64 = 8192;

/// The file that the statement at the start of `text` names, and where the first line after it starts.
pub(super) fn read(text: &[u8]) -> Result<(PathBuf, usize)> {
    let word = text.iter().position(|b| !matches!(b, b' ' | b'\t')).unwrap_or(0) + b"INCLUDE".len();
    let rest = text.get(word..).unwrap_or_default();
    let gap = rest.iter().position(|b| !matches!(b, b' ' | b'\t' | b'=' | b',')).unwrap_or(rest.len());
    let (start, rest) = (word + gap, &rest[gap..]);
    let (name, len) = match rest.first() {
        Some(quote @ (b'\'' | b'"')) => {
            let Some(end) = memchr::memchr(*quote, &rest[1..]) else {
                return Err(Error::malformed(
                    "the quote that ends the name of an included file",
                    excerpt(rest),
                ));
            };
            (rest[1..=end].split(|b| *b == b'\n').flat_map(<[u8]>::trim_ascii).copied().collect(), end + 2)
        }
        _ => {
            let len = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
            (rest[..len].to_vec(), len)
        }
    };
    Ok((path(name)?, memchr::memchr(b'\n', &text[start + len..]).map_or(text.len(), |k| start + len + k + 1)))
}

fn path(mut name: Vec<u8>) -> Result<PathBuf> {
    if name.is_empty() {
        return Err(Error::malformed("the name of a file", "INCLUDE without"));
    }
    if name.iter().any(|b| matches!(b, b'$' | b':')) || name.iter().filter(|b| **b == b'%').count() > 1 {
        let what = "an include by drive, logical symbol or environment variable is not resolved";
        return Err(Error::unsupported(format!("{what}: {}", excerpt(&name))));
    }
    // Written on Windows: no name of a file has a backslash there.
    name.iter_mut().filter(|b| **b == b'\\').for_each(|b| *b = b'/');
    Ok(PathBuf::from(OsStr::from_bytes(&name)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_every_kind() {
        let rows: &[(&str, &str, &str)] = &[
            ("INCLUDE 'a b.inc' $ note\nGRID", "a b.inc", "GRID"),
            ("  include a.inc\r\nGRID", "a.inc", "GRID"),
            ("INCLUDE \"sub\\a.inc\"", "sub/a.inc", ""),
            ("INCLUDE='a.inc'\n", "a.inc", ""),
            ("INCLUDE 'sub/\r\n  deeper/\n  a.inc'\nGRID", "sub/deeper/a.inc", "GRID"),
        ];
        for (text, name, after) in rows {
            let (path, next) = read(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert_eq!((path.to_str(), &text[next..]), (Some(*name), *after), "{text}");
        }
    }

    #[test]
    fn what_is_no_plain_name_is_refused() {
        let rows = [
            ("INCLUDE 'OUTDIR:a.inc'", "is not resolved: \"OUTDIR:a.inc\""),
            ("INCLUDE '$DIR/a.inc'", "is not resolved"),
            ("INCLUDE %DIR%/a.inc", "is not resolved"),
            ("INCLUDE 'C:\\a.inc'", "is not resolved"),
            ("INCLUDE 'a.inc\nGRID", "expected the quote that ends"),
            ("INCLUDE\n", "expected the name of a file"),
            ("INCLUDE ''", "expected the name of a file"),
        ];
        for (text, expected) in rows {
            let error = read(text.as_bytes()).expect_err(text).to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
