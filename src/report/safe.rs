//! Text from mesh files, made harmless.

use std::fmt::Write;

/// Whether a character could steer a terminal or reorder the text around it: control characters of both blocks, line
/// and paragraph separators, marks and overrides of the writing direction, and characters that nobody can see.
pub fn is_harmful(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

/// The text with harmful characters as escapes, such as `\n` and `\u{1b}`.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if is_harmful(c) {
            safe.extend(c.escape_default());
        } else {
            safe.push(c);
        }
    }
    safe
}

/// JSON with harmful characters as `\uXXXX`. Line ends are kept: outside strings JSON has no other harmful character,
/// and inside them line ends are escaped already.
pub fn escaped_json(json: &str) -> String {
    let mut safe = String::with_capacity(json.len());
    for c in json.chars() {
        if is_harmful(c) && c != '\n' {
            write!(safe, "\\u{:04x}", u32::from(c)).expect("a string takes everything");
        } else {
            safe.push(c);
        }
    }
    safe
}

/// The text for Markdown, where it makes no structure, and calls nobody.
pub fn markdown(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in escaped(text).chars() {
        match c {
            // an entity alone would still mention a person
            '@' => safe.push_str("<code>@</code>"),
            '-' | '.' | ',' | ';' | ':' | '/' | '%' | '(' | ')' => safe.push(c),
            _ if c.is_ascii_punctuation() => {
                write!(safe, "&#{};", u32::from(c)).expect("a string takes everything");
            }
            _ => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_harmful_is_left() {
        let hostile = "a\u{1b}[2Jb\nc\u{9b}31md\u{202e}e\u{7f}f\u{0}g\u{2028}h\u{feff}é∂";
        let escaped = escaped(hostile);
        assert_eq!(escaped, r"a\u{1b}[2Jb\nc\u{9b}31md\u{202e}e\u{7f}f\u{0}g\u{2028}h\u{feff}é∂");
        assert!(!escaped.contains(is_harmful));
    }

    #[test]
    fn json_reads_back_as_it_was() {
        let hostile = "a\u{1b}[2Jb\nc\u{9b}31md\u{202e}e\u{7f}f\u{0}g\u{2028}h\"\\é";
        let json = serde_json::to_string_pretty(&[hostile]).expect("a string");
        let safe = escaped_json(&json);
        assert!(!safe.replace('\n', "").contains(is_harmful), "{safe}");
        assert_eq!(serde_json::from_str::<[String; 1]>(&safe).expect("still JSON"), [hostile]);
    }

    #[test]
    fn markdown_sees_no_structure_in_a_name() {
        assert_eq!(markdown("a|b"), "a&#124;b");
        assert_eq!(markdown("</code>@all"), "&#60;/code&#62;<code>@</code>all");
        assert_eq!(markdown("`[x](y)`\n"), "&#96;&#91;x&#93;(y)&#96;&#92;n");
    }
}
