//! The tags of an XML file, found through windows: the text between them may be far larger than memory.

use quick_xml::XmlVersion;
use quick_xml::events::attributes::Attributes;

use crate::error::Result;
use crate::input::{Input, Source};

/// Longest tag, in bytes.
const LONGEST: u64 = 64 << 10;

/// A tag.
#[derive(Debug)]
pub struct Tag {
    /// The byte of its `<`.
    pub at: u64,
    /// The byte after its `>`.
    pub end: u64,
    /// Whether it closes an element: `</a>`.
    pub closes: bool,
    /// Whether it is an element of its own: `<a/>`.
    pub is_empty: bool,
    /// Name and attributes.
    text: String,
    name_len: usize,
}

impl Tag {
    /// The element's name.
    pub fn name(&self) -> &str {
        &self.text[..self.name_len]
    }

    /// The value of an attribute, without blanks round it.
    pub fn attribute(&self, source: &Source, name: &str) -> Result<Option<String>> {
        let malformed = || source.malformed_text(self.at, "a tag with attributes of the form name=\"value\"");
        for attribute in Attributes::new(&self.text, self.name_len) {
            let attribute = attribute.map_err(|_| malformed())?;
            if attribute.key.as_ref() == name {
                let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|_| malformed())?;
                return Ok(Some(value.trim().to_owned()));
            }
        }
        Ok(None)
    }
}

/// Goes from tag to tag.
#[derive(Debug)]
pub struct Tags<'i> {
    source: &'i Source,
    at: u64,
    passes_doctype: bool,
}

impl<'i> Tags<'i> {
    /// From the start of the file.
    pub fn new(input: &'i Input) -> Self {
        Self { source: &input.source, at: 0, passes_doctype: false }
    }

    /// Passes over a document type, too. Entities that it defines remain unknown.
    pub fn passing_doctype(self) -> Self {
        Self { passes_doctype: true, ..self }
    }

    /// The next tag; `None` at the end of the file. Comments and processing instructions are passed over.
    pub fn next_tag(&mut self) -> Result<Option<Tag>> {
        while let Some(at) = self.find(b"<", self.at) {
            let head = self.source.peek(at..at + 4);
            if head.starts_with(b"<!--") {
                self.at = self.after(b"-->", at + 4)?;
            } else if head.starts_with(b"<?") {
                self.at = self.after(b"?>", at + 2)?;
            } else if self.passes_doctype && self.source.peek(at..at + 9) == b"<!DOCTYPE" {
                let (mark, subset) = (self.after(b">", at)?, self.find(b"[", at));
                let has_subset = subset.is_some_and(|subset| subset < mark);
                self.at = if has_subset { self.after(b"]>", at)? } else { mark };
            } else if head.starts_with(b"<!") {
                return Err(self.source.malformed_text(at, "a tag"));
            } else {
                return self.tag(at).map(Some);
            }
        }
        Ok(None)
    }

    fn tag(&mut self, at: u64) -> Result<Tag> {
        let bytes = self.source.peek(at..at + LONGEST);
        let mut quote = None;
        let end = bytes.iter().position(|&byte| {
            match quote {
                Some(open) if open == byte => quote = None,
                None if byte == b'"' || byte == b'\'' => quote = Some(byte),
                _ => {}
            }
            quote.is_none() && byte == b'>'
        });
        let Some(end) = end else {
            if (bytes.len() as u64) < LONGEST {
                return Err(self.source.truncated("the end of a tag"));
            }
            return Err(self.source.malformed_text(at, format!("a tag of less than {LONGEST} bytes")));
        };
        self.at = at + end as u64 + 1;
        let inner = &bytes[1..end];
        let closes = inner.starts_with(b"/");
        let is_empty = !closes && inner.ends_with(b"/");
        let inner = if closes { &inner[1..] } else { inner.strip_suffix(b"/").unwrap_or(inner) };
        let Ok(text) = std::str::from_utf8(inner) else {
            return Err(self.source.malformed_text(at, "a tag in UTF-8"));
        };
        let name_len = text.find(|c: char| c.is_ascii_whitespace()).unwrap_or(text.len());
        Ok(Tag { at, end: self.at, closes, is_empty, text: text.to_owned(), name_len })
    }

    /// The byte after the next `pattern`.
    fn after(&self, pattern: &[u8], at: u64) -> Result<u64> {
        match self.find(pattern, at) {
            Some(found) => Ok(found + pattern.len() as u64),
            None => Err(self.source.truncated(String::from_utf8_lossy(pattern))),
        }
    }

    fn find(&self, pattern: &[u8], mut at: u64) -> Option<u64> {
        const STEP: u64 = 4 << 20;
        while at < self.source.len() {
            let window = self.source.window(at..at + STEP);
            if let Some(found) = memchr::memmem::find(&window, pattern) {
                return Some(at + found as u64);
            }
            // A pattern may lie across the end of the window.
            at += (window.len() as u64).saturating_sub(pattern.len() as u64 - 1).max(1);
        }
        None
    }
}
