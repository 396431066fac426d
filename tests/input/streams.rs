//! Meshes that come as a stream, and the hash of what came in.

use std::io::{self, Cursor, Read};
use std::path::Path;

use meshgauge::error::Kind;
use meshgauge::input::{Compression, Input, Limits};
use xxhash_rust::xxh3::xxh3_64;

use crate::packing::{content, mesh, open_bytes, pack, scratch};

/// Gives one byte at a time, and is interrupted before each.
struct Slow<R>(R, bool);

impl<R: Read> Read for Slow<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.1 = !self.1;
        if self.1 {
            return Err(io::ErrorKind::Interrupted.into());
        }
        let count = into.len().min(1);
        self.0.read(&mut into[..count])
    }
}

#[test]
fn a_slow_stream_gives_what_the_file_gives() {
    let text = mesh(500);
    let packed = Compression::ALL.map(|compression| (Some(compression.name()), pack(compression, &text)));
    for (compression, bytes) in packed.into_iter().chain([(None, text.clone())]) {
        let name = Path::new("-");
        let reader = Slow(Cursor::new(&bytes), false);
        let input = Input::from_reader(name, reader, &Limits::default(), &scratch()).expect("sound");
        assert!(content(&input) == text, "{compression:?}");
        assert_eq!(input.compression, compression);
        assert_eq!(input.bytes_on_disk, bytes.len() as u64);
        assert_eq!(input.xxh3(), xxh3_64(&bytes));
        assert_eq!(input.source.path(), Path::new("standard input"));
    }
}

#[test]
fn a_stream_of_nothing_is_empty() {
    let error = Input::from_reader(Path::new("-"), io::empty(), &Limits::default(), &scratch());
    assert_eq!(
        error.expect_err("no bytes").to_string(),
        "standard input: expected a mesh, found an empty file"
    );
}

#[test]
fn a_reader_that_fails_is_not_taken_for_a_corrupt_stream() {
    struct Fails;
    impl Read for Fails {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::from_raw_os_error(5))
        }
    }
    for compression in Compression::ALL {
        let packed = pack(compression, &mesh(1000));
        let reader = Cursor::new(&packed[..packed.len() / 2]).chain(Fails);
        let opened = Input::from_reader(Path::new("pipe"), reader, &Limits::default(), &scratch());
        let error = opened.expect_err("half of it cannot be read");
        match error.kind() {
            Kind::Unreadable(cause) => assert_eq!(cause.raw_os_error(), Some(5)),
            _ => panic!("{}: {error}", compression.name()),
        }
    }
}

#[test]
fn the_hash_is_that_of_the_reference_implementation() {
    // Python: xxhash.xxh3_64(b"*NODE\n1, 0., 0., 0.\n").hexdigest()
    let input = open_bytes("pit.inp", b"*NODE\n1, 0., 0., 0.\n").expect("a sound file");
    assert_eq!(input.xxh3_hex(), "9b4f53b8939ef202");
    assert_eq!(input.clone().xxh3(), input.xxh3());
}

#[test]
fn a_file_of_several_windows_has_the_hash_of_the_whole() {
    let text = mesh(500_000);
    assert!(text.len() > 16 << 20);
    let input = open_bytes("pit.inp", &text).expect("a sound file");
    let hashes = std::thread::scope(|scope| {
        let both = [scope.spawn(|| input.xxh3()), scope.spawn(|| input.clone().xxh3())];
        both.map(|thread| thread.join().expect("no panic"))
    });
    assert_eq!(hashes, [xxh3_64(&text); 2]);
}
