//! Names that are passed over.

use std::ffi::OsStr;

/// The first of the patterns that a name fits.
pub fn ignored_by<'p>(patterns: &'p [String], name: &OsStr) -> Option<&'p str> {
    patterns.iter().find(|pattern| fits(pattern, name)).map(String::as_str)
}

/// Whether a name fits a pattern in which `*` stands for anything.
pub fn fits(pattern: &str, name: &OsStr) -> bool {
    matches(pattern.as_bytes(), name.as_encoded_bytes())
}

fn matches(pattern: &[u8], name: &[u8]) -> bool {
    match pattern.iter().position(|&b| b == b'*') {
        None => pattern == name,
        Some(star) => {
            let (head, tail) = (&pattern[..star], &pattern[star + 1..]);
            name.starts_with(head) && (head.len()..=name.len()).any(|from| matches(tail, &name[from..]))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_know_one_sign() {
        let cases = [
            (".*", ".nfs0001", true),
            (".*", "pit.inp", false),
            ("*.tmp", "pit.inp.tmp", true),
            ("*.tmp", "tmp", false),
            ("*~", "pit.inp~", true),
            ("a*b*c", "a-b-b-c", true),
            ("a*b*c", "a-c-b", false),
            ("*", "", true),
        ];
        for (pattern, name, expected) in cases {
            assert_eq!(matches(pattern.as_bytes(), name.as_bytes()), expected, "{pattern} {name}");
        }
    }
}
