//! What a file that is surely no mesh is instead, so that the error can say it.

/// First bytes, and what a file that starts so is.
const STARTS: &[(&[u8], &str)] = &[
    (b"%PDF-", "a PDF document"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"PK\x05\x06", "a ZIP archive"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive"),
    (b"Rar!\x1a\x07", "a RAR archive"),
    (b"\x1f\x9d", "a file packed by compress (.Z)"),
    (b"LZIP", "a file packed by lzip"),
    (b"\x5d\0\0", "a file packed by lzma: repack it as .xz"),
    (b"\x02\x21\x4c\x18", "an LZ4 file of the legacy kind: repack it"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file"),
    (b"CDF\x01", "a NetCDF file"),
    (b"CDF\x02", "a NetCDF file"),
    (b"CDF\x05", "a NetCDF file"),
    (b"\x7fELF", "an ELF program"),
    (b"MZ\x90\0", "a Windows program"),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an old Office document"),
    (b"\x89PNG\r\n", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"SQLite format 3\0", "an SQLite database"),
    (b"PAR1", "a Parquet file"),
    (b"glTF", "a glTF scene"),
    (b"ISO-10303-21;", "STEP geometry: a shape that is yet to be meshed"),
    (b"DBRep_DrawableShape", "BRep geometry: a shape that is yet to be meshed"),
    (b"version https://git-lfs", "a Git LFS pointer: the file itself was not fetched"),
    (b"<!DOCTYPE html", "a web page"),
    (b"<!doctype html", "a web page"),
    (b"<html", "a web page"),
    (b"<HTML", "a web page"),
    (b"{\\rtf", "an RTF document"),
    (b"#!/", "a script"),
];

/// What the file that starts with `head` is, if it is surely no mesh; in words that follow "found".
///
/// To be asked once no format has known the content: some formats build on containers that are named here.
pub fn looks_like(head: &[u8]) -> Option<&'static str> {
    if let Some(&(_, word)) = STARTS.iter().find(|(start, _)| head.starts_with(start)) {
        return Some(word);
    }
    if let Some(compression) = super::Compression::detect(head) {
        return Some(compression.name());
    }
    match head {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32 text"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("UTF-16 text"),
        _ if !head.is_empty() && head.iter().all(|&b| b == 0) => Some("zero bytes only"),
        _ if !head.is_empty() && head.iter().all(u8::is_ascii_whitespace) => Some("blank lines only"),
        _ if head.get(257..262) == Some(b"ustar") => Some("a tar archive"),
        _ if is_utf16_without_mark(head) => Some("UTF-16 text"),
        _ => None,
    }
}

/// Whether every second byte of the start is zero, and the others are printable: ASCII written as UTF-16.
fn is_utf16_without_mark(head: &[u8]) -> bool {
    let start = &head[..head.len().min(256)];
    let text = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    start.len() >= 16
        && (start.chunks_exact(2).all(|pair| text(pair[0]) && pair[1] == 0)
            || start.chunks_exact(2).all(|pair| pair[0] == 0 && text(pair[1])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn utf16(text: &str) -> Vec<u8> {
        text.encode_utf16().flat_map(u16::to_le_bytes).collect()
    }

    #[test]
    fn what_is_no_mesh_is_named() {
        let mut tar = vec![b'x'; 512];
        tar[257..262].copy_from_slice(b"ustar");
        let marked = [&[0xff, 0xfe][..], &utf16("*NODE\n1, 0., 0., 0.\n")].concat();
        let rows: [(&[u8], &str); 7] = [
            (&marked, "UTF-16 text"),
            (&utf16("*NODE\n1, 0., 0., 0.\n"), "UTF-16 text"),
            (&[0; 4096], "zero bytes only"),
            (b" \r\n\n", "blank lines only"),
            (&tar, "a tar archive"),
            (b"%PDF-1.7\n", "a PDF document"),
            (b"\x1f\x8b\x08\0", "gzip"),
        ];
        for (head, word) in rows {
            assert_eq!(looks_like(head), Some(word));
        }
    }

    #[test]
    fn a_mesh_or_what_may_be_one_has_no_name() {
        for head in [&b"*HEADING\n"[..], b"$MeshFormat\n", b"<?xml version=\"1.0\"?>", b"", b"3 3\n0 0 0\n"] {
            assert_eq!(looks_like(head), None);
        }
    }
}
