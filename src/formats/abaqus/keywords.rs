//! Keyword lines: finding them fast, and taking them apart.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;

use crate::error::{Error, Result, excerpt};
use crate::formats::text;
use crate::input::{Limits, Source, Window};

/// Finds keyword lines: looks for stars, not at every line.
pub(super) struct Scanner<'s> {
    source: &'s Source,
    window: Option<(u64, Window<'s>)>,
}

impl<'s> Scanner<'s> {
    pub(super) fn new(source: &'s Source) -> Self {
        Self { source, window: None }
    }

    /// The star of the first keyword line at or after `at`, which must be the start of a line.
    pub(super) fn next(&mut self, at: u64) -> Option<u64> {
        const STEP: u64 = 8 << 20;
        let mut at = at;
        while at < self.source.len() {
            let (start, window) = match &mut self.window {
                Some((start, window)) if (*start..*start + window.len() as u64).contains(&at) => {
                    (*start, &*window)
                }
                slot => {
                    let (start, window) = slot.insert((at, self.source.window(at..at + STEP)));
                    (*start, &*window)
                }
            };
            let from = (at - start) as usize;
            let mut stars = memchr::memchr_iter(b'*', &window[from..]).map(|k| at + k as u64);
            if let Some(star) = stars.find(|star| is_keyword(self.source, *star)) {
                return Some(star);
            }
            at = start + window.len() as u64;
        }
        None
    }
}

/// Whether the star is the first of its line but for blanks, and alone: two make a comment.
fn is_keyword(source: &Source, star: u64) -> bool {
    if source.peek(star + 1..star + 2) == b"*" {
        return false;
    }
    let mut before = star;
    while before > 0 {
        match source.peek(before - 1..before) {
            b"\n" => return true,
            b" " | b"\t" | b"\r" => before -= 1,
            // A byte order mark may stand before the first line.
            _ => return before == 3 && source.peek(0..3) == BYTE_ORDER_MARK,
        }
    }
    true
}

/// What some editors put before UTF-8 text.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A keyword line with its continuations.
#[derive(Debug)]
pub(super) struct Keyword {
    /// The star.
    pub(super) at: u64,
    /// The first byte after the line.
    pub(super) end: u64,
    /// In capitals, without the star and blanks: `ENDPART`.
    pub(super) name: String,
    parameters: Vec<(String, Vec<u8>)>,
}

impl Keyword {
    /// The keyword line whose star is at byte `at`.
    pub(super) fn read(source: &Source, at: u64, limits: &Limits) -> Result<Self> {
        let mut line = Vec::new();
        let mut end = at;
        loop {
            let next = source.peek(end..end + limits.line_bytes as u64);
            let text = next.split(|b| *b == b'\n').next().unwrap_or_default();
            if line.len() + text.len() >= limits.line_bytes {
                return Err(text::too_long(source, "a keyword line", limits.line_bytes, at));
            }
            line.extend_from_slice(text.trim_ascii());
            end = (end + text.len() as u64 + 1).min(source.len());
            // What goes on begins with a parameter's name; after a stray comma the data begin with a number.
            let follows =
                source.peek(end..end + limits.line_bytes as u64).iter().find(|b| !matches!(b, b' ' | b'\t'));
            if line.last() != Some(&b',') || !follows.is_some_and(u8::is_ascii_alphabetic) {
                break;
            }
        }
        let mut fields = split_unquoted(&line, b',').into_iter();
        let name = plain(fields.next().unwrap_or_default().strip_prefix(b"*").unwrap_or_default());
        let parameters = fields.filter(|f| !f.trim_ascii().is_empty()).map(|field| {
            let name = field.split(|b| *b == b'=').next().unwrap_or_default();
            (plain(name), field.get(name.len() + 1..).unwrap_or_default().trim_ascii().to_vec())
        });
        Ok(Self { at, end, name, parameters: parameters.collect() })
    }

    /// What stands after `name=`, as written; empty for a parameter without a value.
    pub(super) fn value(&self, name: &str) -> Option<&[u8]> {
        self.parameters.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_slice())
    }

    /// The label after `name=`: in capitals and without blanks, unless quoted.
    pub(super) fn label(&self, name: &str) -> Result<Option<Vec<u8>>> {
        let Some(value) = self.value(name) else { return Ok(None) };
        if value.first() == Some(&b'<') {
            let text = format!("the parameter in {name}={} is not substituted", value.escape_ascii());
            return Err(Error::unsupported(text));
        }
        let label = label(value);
        if label.is_empty() || label.len() > 255 {
            return Err(Error::malformed(format!("a name after {name}="), excerpt(value)));
        }
        Ok(Some(label))
    }

    /// The label after `name=`, which must stand there.
    pub(super) fn required(&self, name: &str) -> Result<Vec<u8>> {
        self.label(name)?.ok_or_else(|| {
            Error::malformed(format!("the parameter {name}="), format!("*{} without it", self.name))
        })
    }

    /// The file after `INPUT=`, as written but for quotes.
    pub(super) fn input(&self) -> Option<PathBuf> {
        let value = self.value("INPUT")?;
        let value = value.strip_prefix(b"\"").and_then(|v| v.strip_suffix(b"\"")).unwrap_or(value);
        (!value.is_empty()).then(|| PathBuf::from(OsStr::from_bytes(value)))
    }
}

/// A label as Abaqus compares it: what is quoted stays, else capitals without blanks.
pub(super) fn label(text: &[u8]) -> Vec<u8> {
    match text.strip_prefix(b"\"").and_then(|t| t.strip_suffix(b"\"")) {
        Some(quoted) => quoted.to_vec(),
        None => text.iter().filter(|b| !b.is_ascii_whitespace()).map(u8::to_ascii_uppercase).collect(),
    }
}

/// Capitals without blanks.
pub(super) fn plain(text: &[u8]) -> String {
    label(text).escape_ascii().to_string()
}

/// The parts of `line` between separators outside quotes.
fn split_unquoted(line: &[u8], separator: u8) -> Vec<&[u8]> {
    let mut quoted = false;
    let parts = line.split(|b| {
        quoted ^= *b == b'"';
        *b == separator && !quoted
    });
    parts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn source(text: &[u8]) -> Source {
        let mut file = tempfile::tempfile().expect("a scratch file");
        file.write_all(text).expect("written");
        Source::new(std::path::Path::new("deck.inp"), &file).expect("mapped")
    }

    fn keywords(text: &[u8]) -> Vec<Keyword> {
        let source = source(text);
        let mut scanner = Scanner::new(&source);
        let (mut found, mut at) = (Vec::new(), 0);
        while let Some(star) = scanner.next(at) {
            let keyword = Keyword::read(&source, star, &Limits::default()).expect("a keyword");
            at = keyword.end;
            found.push(keyword);
        }
        found
    }

    #[test]
    fn blanks_case_quotes_and_continuations() {
        let text = b" *End  Part\r\n** *NODE\n*nOdE , nset = A, System = c \n1, 2*3\n*INSTANCE, NAME=\"a, b\",\n  Part=\"P a\"\n*ELEMENT,\n*NODE PRINT,\n1,2\n*Include, input=\"Sub dir/b.INP\"";
        let found = keywords(text);
        let names: Vec<_> = found.iter().map(|k| k.name.as_str()).collect();
        assert_eq!(names, ["ENDPART", "NODE", "INSTANCE", "ELEMENT", "NODEPRINT", "INCLUDE"]);
        assert_eq!(found[1].label("SYSTEM").expect("a label"), Some(b"C".to_vec()));
        assert_eq!(found[2].required("NAME").expect("a label"), b"a, b");
        assert_eq!(found[2].required("PART").expect("a label"), b"P a");
        assert!(found[3].required("TYPE").is_err());
        assert_eq!(found[5].input(), Some(PathBuf::from("Sub dir/b.INP")));
        assert_eq!(found[5].end, text.len() as u64);
    }

    #[test]
    fn a_keyword_after_many_windows_is_found() {
        let mut text = b"*NODE\n".to_vec();
        while text.len() < (17 << 20) {
            text.extend_from_slice(b"1, 2.5, 3.5 *\n** ***\n");
        }
        text.extend_from_slice(b"  *ELEMENT, TYPE=S4\n");
        let found = keywords(&text);
        assert_eq!(found.len(), 2);
        assert_eq!(found[1].name, "ELEMENT");
    }
}
