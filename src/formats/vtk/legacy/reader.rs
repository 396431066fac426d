//! Reads a legacy file word by word and array by array.

use crate::error::{Error, Result, excerpt};
use crate::formats::Format;
use crate::formats::binary::Endian;
use crate::formats::text::{self, LineReader};
use crate::input::Input;

use super::super::ascii;
use super::super::role::Role;
use super::Legacy;
use crate::formats::array::{Number, Origin, Stored, Unpacked, check_fits};

/// Reads a file from section to section.
pub struct Reader<'i> {
    pub input: &'i Input,
    /// The byte that comes next.
    pub at: u64,
    /// ASCII, not BINARY.
    pub is_text: bool,
    pub unpacked: Unpacked<'i>,
}

impl<'i> Reader<'i> {
    /// Reads the three lines that every file starts with.
    pub fn open(input: &'i Input) -> Result<Self> {
        let mut lines = LineReader::new(&input.source, &input.limits, 0);
        let mut line = |expected: &str| match lines.next_line()? {
            Some(line) => {
                Ok((line.at, line.bytes.trim_ascii().to_ascii_uppercase(), line.at + line.bytes.len() as u64))
            }
            None => Err(input.source.malformed_text(input.source.len(), expected)),
        };
        let (at, magic, _) = line("\"# vtk DataFile Version\"")?;
        if !Legacy.detect(&magic) {
            return Err(input.source.malformed_text(at, "\"# vtk DataFile Version\""));
        }
        line("a title")?;
        let (at, encoding, end) = line("ASCII or BINARY")?;
        let is_text = match &encoding[..] {
            b"ASCII" => true,
            b"BINARY" => false,
            _ => return Err(input.source.malformed_text(at, "ASCII or BINARY")),
        };
        Ok(Self { input, at: end, is_text, unpacked: Unpacked::new(input) })
    }

    /// The `count` numbers that follow: where they stand, or what was unpacked of them.
    pub fn numbers(&mut self, number: Number, role: Role, count: u64) -> Result<Stored> {
        if self.is_text {
            let text = self.at..self.input.source.len();
            let (stored, end) =
                ascii::unpack(self.input, text, Some(count), role, number, &mut self.unpacked)?;
            self.at = end;
            return Ok(stored);
        }
        self.end_line()?;
        let stored = Stored { origin: Origin::File, at: self.at, number, endian: Endian::Big, count };
        self.at = check_fits(&self.input.source, &stored, role.name())?;
        Ok(stored)
    }

    /// Goes to the start of the next line, where binary numbers start.
    pub fn end_line(&mut self) -> Result<()> {
        let rest = self.input.source.peek(self.at..self.at + 256);
        match memchr::memchr(b'\n', rest) {
            Some(end) if rest[..end].iter().all(u8::is_ascii_whitespace) => {
                self.at += end as u64 + 1;
                Ok(())
            }
            _ => Err(self.malformed(self.at, "the end of the line before binary numbers")),
        }
    }

    /// The next word in upper case; `None` at the end of the file.
    pub fn next_word(&mut self) -> Result<Option<Word>> {
        const STEP: u64 = 256;
        let source = &self.input.source;
        loop {
            let bytes = source.peek(self.at..self.at + STEP);
            let Some(start) = bytes.iter().position(|b| !b.is_ascii_whitespace()) else {
                if bytes.is_empty() {
                    return Ok(None);
                }
                self.at += bytes.len() as u64;
                continue;
            };
            let at = self.at + start as u64;
            let bytes = source.peek(at..at + STEP);
            let len = bytes.iter().position(u8::is_ascii_whitespace).unwrap_or(bytes.len());
            if len as u64 == STEP {
                return Err(self.malformed(at, "a word of less than 256 bytes"));
            }
            self.at = at + len as u64;
            let text = bytes[..len].escape_ascii().to_string().to_ascii_uppercase();
            return Ok(Some(Word { at, text }));
        }
    }

    /// Whether the word `word` is the next.
    pub fn follows(&self, word: &str) -> bool {
        let bytes = self.input.source.peek(self.at..self.at + 256).trim_ascii_start();
        bytes.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
    }

    /// The next word, which must be there.
    pub fn word(&mut self, expected: &str) -> Result<Word> {
        match self.next_word()? {
            Some(word) => Ok(word),
            None => Err(self.truncated(expected)),
        }
    }

    /// The error of a file that ends where `expected` should follow.
    pub fn truncated(&self, expected: &str) -> Error {
        self.malformed(self.input.source.len(), expected)
    }

    /// The next word, which must be `expected`.
    pub fn keyword(&mut self, expected: &str) -> Result<()> {
        let word = self.word(expected)?;
        if word.text == expected { Ok(()) } else { Err(self.expected(&word, expected)) }
    }

    /// The next word, which must be a whole number.
    pub fn count(&mut self, expected: &str) -> Result<u64> {
        let word = self.word(expected)?;
        text::integer(word.text.as_bytes()).ok_or_else(|| self.expected(&word, expected))
    }

    /// A type that an array of the role may have.
    pub fn number(&mut self, role: Role) -> Result<Number> {
        let word = self.word("a type of numbers")?;
        let found = number(&word.text).filter(|number| role.allows(*number));
        found.ok_or_else(|| self.expected(&word, &format!("a type of numbers for {}", role.name())))
    }

    /// The error of another word than was expected.
    pub fn expected(&self, word: &Word, expected: &str) -> Error {
        self.malformed(word.at, expected)
    }

    /// Lines make no sense between binary numbers.
    fn malformed(&self, at: u64, expected: &str) -> Error {
        let source = &self.input.source;
        if self.is_text {
            return source.malformed_text(at, expected);
        }
        source.malformed_binary(at, expected, excerpt(source.peek(at..at + 48)))
    }
}

/// A word of the file.
pub struct Word {
    pub at: u64,
    /// In upper case.
    pub text: String,
}

/// The type of numbers that the file calls `name`.
pub fn number(name: &str) -> Option<Number> {
    Some(match name {
        "CHAR" | "SIGNED_CHAR" | "VTKTYPEINT8" => Number::I8,
        "UNSIGNED_CHAR" | "VTKTYPEUINT8" => Number::U8,
        "SHORT" | "VTKTYPEINT16" => Number::I16,
        "UNSIGNED_SHORT" | "VTKTYPEUINT16" => Number::U16,
        // VTK writes its ids as `int` under this name, whatever their size in memory.
        "INT" | "VTKIDTYPE" | "VTKTYPEINT32" => Number::I32,
        "UNSIGNED_INT" | "VTKTYPEUINT32" => Number::U32,
        // As VTK does on all systems but Windows.
        "LONG" | "VTKTYPEINT64" => Number::I64,
        "UNSIGNED_LONG" | "VTKTYPEUINT64" => Number::U64,
        "FLOAT" => Number::F32,
        "DOUBLE" => Number::F64,
        _ => return None,
    })
}
