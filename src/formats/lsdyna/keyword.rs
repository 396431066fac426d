//! Keyword lines.

/// A keyword line taken apart.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Keyword {
    /// In capitals, without the star: `ELEMENT_SHELL_THICKNESS`.
    pub(super) name: String,
    /// What the line says of the width of its cards.
    pub(super) width: Option<Width>,
}

/// How wide the fields of cards are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Width {
    /// 8 columns for numbers of nodes and elements, 16 for coordinates.
    #[default]
    Standard,
    /// 10 columns for numbers: `%`.
    Ten,
    /// 20 columns for everything: `+`.
    Long,
}

impl Width {
    /// Columns of a number.
    pub(super) fn number(self) -> usize {
        match self {
            Width::Standard => 8,
            Width::Ten => 10,
            Width::Long => 20,
        }
    }

    /// Columns of a coordinate.
    pub(super) fn coordinate(self) -> usize {
        if self == Width::Long { 20 } else { 16 }
    }
}

impl Keyword {
    /// Longest name that is looked at.
    const LONGEST: usize = 80;

    pub(super) fn read(line: &[u8]) -> Self {
        let line = line.strip_prefix(b"*").unwrap_or(line).trim_ascii();
        let line = line[..line.len().min(Self::LONGEST)].to_ascii_uppercase();
        let blank = line.iter().position(|b| b.is_ascii_whitespace() || *b == b',').unwrap_or(line.len());
        let (name, rest) = line.split_at(blank);
        let bare = name.strip_suffix(b"+").or(name.strip_suffix(b"%")).or(name.strip_suffix(b"-"));
        let suffix = match bare {
            Some(bare) => name[bare.len()],
            None => rest.trim_ascii().first().copied().unwrap_or_default(),
        };
        let name = String::from_utf8_lossy(bare.unwrap_or(name)).into_owned();
        let says = |option: &[u8]| rest.windows(option.len()).any(|part| part == option);
        let width = match suffix {
            b'+' => Some(Width::Long),
            b'%' => Some(Width::Ten),
            b'-' => Some(Width::Standard),
            _ if name == "KEYWORD" && says(b"LONG=Y") => Some(Width::Long),
            _ if name == "KEYWORD" && says(b"I10=Y") => Some(Width::Ten),
            _ => None,
        };
        Self { name, width }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_widths() {
        for (line, name, width) in [
            (&b"*NODE"[..], "NODE", None),
            (b"*Element_Solid (ten nodes format)", "ELEMENT_SOLID", None),
            (b"*NODE+", "NODE", Some(Width::Long)),
            (b"*NODE %", "NODE", Some(Width::Ten)),
            (b"*NODE -", "NODE", Some(Width::Standard)),
            (b"*KEYWORD LONG=Y", "KEYWORD", Some(Width::Long)),
            (b"*KEYWORD long=s", "KEYWORD", None),
            (b"*KEYWORD  I10=Y", "KEYWORD", Some(Width::Ten)),
            (b"*", "", None),
        ] {
            assert_eq!(Keyword::read(line), Keyword { name: name.to_owned(), width });
        }
    }
}
