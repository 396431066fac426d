//! What stands under a file's name, how it is packed, and what is refused: through the public door alone.

use std::fs::{self, File};
use std::io::{self, Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use meshgauge::error::{At, Error, Kind, Result};
use meshgauge::input::{Compression, Input, Limits, Scratch};
use rustix::fs::{CWD, FileType, Mode, mknodat};
use tempfile::TempDir;
use xxhash_rust::xxh3::xxh3_64;

fn scratch() -> Scratch {
    Scratch::new(&std::env::temp_dir(), 1 << 30)
}

/// A file named `name` in a folder of its own.
fn file(name: &str, content: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    fs::write(&path, content).expect("the file can be written");
    (folder, path)
}

fn open(path: &Path) -> Result<Input> {
    Input::open(path, &Limits::default(), &scratch())
}

fn open_bytes(name: &str, content: &[u8]) -> Result<Input> {
    let (_folder, path) = file(name, content);
    open(&path)
}

fn content(input: &Input) -> Vec<u8> {
    input.source.window(0..input.source.len()).to_vec()
}

/// Lines that do not pack too well.
fn mesh(lines: u64) -> Vec<u8> {
    let mut text = b"*NODE\n".to_vec();
    for n in 1..=lines {
        let x = n.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11;
        writeln!(text, "{n}, {}, {}., 0.", x as f64 * 1e-16, x % 97).expect("memory takes it");
    }
    text
}

/// One stream, with the check sums that the command-line tools write.
fn pack(compression: Compression, content: &[u8]) -> Vec<u8> {
    let packed = match compression {
        Compression::Gzip => {
            let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::new(9));
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Zstd => {
            let mut out = zstd::Encoder::new(Vec::new(), 3).expect("an encoder");
            out.include_checksum(true).expect("a known parameter");
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Bzip2 => {
            let mut out = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Xz => {
            let mut out = liblzma::write::XzEncoder::new(Vec::new(), 6);
            out.write_all(content).and_then(|()| out.finish())
        }
        Compression::Lz4 => {
            let info = lz4_flex::frame::FrameInfo::new().content_checksum(true);
            let mut out = lz4_flex::frame::FrameEncoder::with_frame_info(info, Vec::new());
            out.write_all(content).and_then(|()| out.finish().map_err(io::Error::other))
        }
    };
    packed.expect("memory takes it")
}

/// A zstd frame of zeros that asks for a window of 2^`window_log`: 128 KiB for every four bytes.
fn zstd_bomb(blocks: u32, window_log: u8) -> Vec<u8> {
    let mut frame = b"\x28\xb5\x2f\xfd\0".to_vec();
    frame.push((window_log - 10) << 3);
    for block in 1..=blocks {
        let header = (128 << 10) << 3 | 1 << 1 | u32::from(block == blocks);
        frame.extend_from_slice(&header.to_le_bytes()[..3]);
        frame.push(0);
    }
    frame
}

fn limit(error: &Error) -> String {
    match error.kind() {
        Kind::Limit { .. } => error.kind().to_string(),
        _ => panic!("expected a limit, found {error}"),
    }
}

#[test]
fn a_plain_file_is_mapped() {
    let text = mesh(100);
    let input = open_bytes("pit.inp", &text).expect("a sound file");
    assert_eq!(content(&input), text);
    assert_eq!((input.compression, input.bytes_on_disk), (None, text.len() as u64));
    assert_eq!(input.scratch.used(), 0);
}

#[test]
fn every_compression_unpacks_whatever_the_name() {
    let text = mesh(20_000);
    for compression in Compression::ALL {
        let packed = pack(compression, &text);
        let input = open_bytes("pit.inp", &packed).expect(compression.name());
        assert!(content(&input) == text, "{}", compression.name());
        assert_eq!(input.compression, Some(compression.name()));
        assert_eq!(input.bytes_on_disk, packed.len() as u64);
        assert_eq!(input.xxh3(), xxh3_64(&packed));
    }
}

#[test]
fn every_stream_of_several_is_unpacked() {
    let text = mesh(3_000);
    for compression in Compression::ALL {
        let parts: Vec<_> = text.chunks(20_000).map(|part| pack(compression, part)).collect();
        assert!(parts.len() > 2);
        let input = open_bytes("pit", &parts.concat()).expect(compression.name());
        assert!(content(&input) == text, "{}", compression.name());
    }
}

#[test]
fn a_stream_of_nothing_among_others_does_not_end_the_file() {
    for compression in Compression::ALL {
        let nothing = pack(compression, b"");
        let packed = [&nothing[..], &pack(compression, b"1, 2\n"), &nothing, &pack(compression, b"3, 4\n")];
        let input = open_bytes("pit", &packed.concat()).expect(compression.name());
        assert_eq!(content(&input), b"1, 2\n3, 4\n", "{}", compression.name());
    }
}

#[test]
fn skippable_zstd_frames_are_skipped_wherever_they_stand() {
    let skippable = b"\x53\x2a\x4d\x18\x05\0\0\0notes";
    let frame = pack(Compression::Zstd, b"*NODE\n");
    let packed = [&skippable[..], &frame, skippable, &frame, skippable].concat();
    let input = open_bytes("pit.zst", &packed).expect("sound frames");
    assert_eq!(content(&input), b"*NODE\n*NODE\n");
}

#[test]
fn zero_padding_is_allowed_where_the_format_allows_it() {
    for compression in Compression::ALL {
        let packed = [pack(compression, b"*NODE\n"), vec![0; 1 << 20]].concat();
        let opened = open_bytes("pit", &packed);
        match compression {
            Compression::Gzip | Compression::Xz => {
                let input = opened.expect("padding");
                assert_eq!(content(&input), b"*NODE\n");
                assert_eq!(input.xxh3(), xxh3_64(&packed), "the padding belongs to the file");
            }
            _ => assert!(opened.is_err(), "{}", compression.name()),
        }
    }
}

#[test]
fn bytes_behind_the_last_stream_are_an_error_with_their_place() {
    for compression in Compression::ALL {
        let packed = pack(compression, b"*NODE\n");
        for padding in [0, 8] {
            let zeros = vec![0; padding];
            let error = open_bytes("pit.inp", &[&packed[..], &zeros, b"garbage"].concat())
                .expect_err("garbage is no mesh");
            let message = error.to_string();
            assert!(message.contains("pit.inp") && message.contains(compression.name()), "{message}");
            let expected = format!("expected another {} stream or the end of the file", compression.name());
            assert!(message.contains(&expected), "{message}");
            if padding == 0 {
                assert_eq!(error.place(), Some(At::Byte(packed.len() as u64)));
                assert!(message.contains("found \"garbage\""), "{message}");
            }
        }
    }
}

#[test]
fn a_cut_stream_is_never_a_short_mesh() {
    let text = mesh(40);
    for compression in Compression::ALL {
        let packed = pack(compression, &text);
        for cut in 0..packed.len() {
            let head = &packed[..cut];
            let place = format!("{} cut at {cut}", compression.name());
            match open_bytes("pit.inp", head) {
                // Too short to be known: the formats will not know it either.
                Ok(input) => {
                    assert!(Compression::detect(head).is_none() && cut < Compression::HEAD_BYTES, "{place}");
                    assert_eq!(input.compression, None);
                }
                Err(error) if cut == 0 => assert!(matches!(error.kind(), Kind::Empty), "{error}"),
                Err(error) => {
                    let expected = format!(
                        "{}: byte {cut}: expected the rest of the {0} stream, found the end of the file",
                        compression.name()
                    );
                    assert!(error.to_string().ends_with(&expected), "{place}: {error}");
                    assert!(error.to_string().contains("pit.inp"), "{error}");
                }
            }
        }
    }
}

#[test]
fn a_cut_second_stream_is_never_half_a_mesh() {
    let text = mesh(40);
    for compression in Compression::ALL {
        let first = pack(compression, &text);
        let both = [&first[..], &first].concat();
        for cut in first.len() + 1..both.len() {
            let error = open_bytes("pit.inp", &both[..cut]).expect_err("cut");
            assert!(matches!(error.kind(), Kind::Malformed { .. }), "{} {cut}: {error}", compression.name());
        }
    }
}

#[test]
fn a_large_stream_that_is_cut_is_an_error_too() {
    let text = mesh(60_000);
    for compression in Compression::ALL {
        let packed = pack(compression, &text);
        assert!(packed.len() > 512 << 10, "more than one buffer");
        for parts in 1..8 {
            let cut = packed.len() * parts / 8;
            let error = open_bytes("pit.inp", &packed[..cut]).expect_err("cut");
            assert_eq!(error.place(), Some(At::Byte(cut as u64)), "{error}");
        }
    }
}

#[test]
fn a_flipped_bit_is_never_another_mesh() {
    let text = mesh(40);
    for compression in Compression::ALL {
        let packed = pack(compression, &text);
        for at in 0..packed.len() {
            let mut broken = packed.clone();
            broken[at] ^= 1 << (at % 8);
            let place = format!("{} byte {at}", compression.name());
            match open_bytes("pit.inp", &broken) {
                // A time stamp, a flag that changes nothing, or a file that does not look packed any more.
                Ok(input) if input.compression.is_some() => assert!(content(&input) == text, "{place}"),
                Ok(_) => assert!(at < Compression::HEAD_BYTES, "{place}"),
                Err(error) => {
                    let message = error.to_string();
                    assert!(message.contains("pit.inp") && message.contains(compression.name()), "{message}");
                }
            }
        }
    }
}

#[test]
fn corrupt_data_names_the_byte_and_the_fault() {
    let mut packed = pack(Compression::Gzip, &mesh(1000));
    let length = packed.len();
    packed[length - 6] ^= 0xff;
    let error = open_bytes("pit.inp.gz", &packed).expect_err("a wrong check sum");
    let message = error.to_string();
    let expected = format!("pit.inp.gz: gzip: byte {length}: expected sound gzip data, found ");
    assert!(message.contains(&expected), "{message}");
}

#[test]
fn what_is_packed_twice_is_refused() {
    let inner = pack(Compression::Zstd, &mesh(10));
    let error = open_bytes("pit.inp.gz", &pack(Compression::Gzip, &inner)).expect_err("packed twice");
    assert!(matches!(error.kind(), Kind::Unsupported(_)));
    assert!(error.to_string().ends_with("zstd within gzip: only one layer of compression is unpacked"));
}

#[test]
fn nothing_packed_is_an_empty_file() {
    for compression in Compression::ALL {
        let error = open_bytes("pit.inp", &pack(compression, b"")).expect_err("no bytes");
        assert!(matches!(error.kind(), Kind::Empty), "{}: {error}", compression.name());
    }
}

#[test]
fn a_ratio_that_no_mesh_has_is_refused() {
    let zeros = vec![0; 8 << 20];
    for compression in [Compression::Gzip, Compression::Zstd, Compression::Bzip2, Compression::Xz] {
        let packed = pack(compression, &zeros).repeat(10);
        let error = open_bytes("pit.inp", &packed).expect_err("a bomb");
        let expected = "the number of bytes that a packed byte yields is over the limit of 1000";
        assert_eq!(limit(&error), expected, "{}", compression.name());
        assert!(error.to_string().contains("pit.inp"), "{error}");
    }
}

#[test]
fn a_high_ratio_of_a_small_file_is_fine() {
    let input = open_bytes("pit", &zstd_bomb(512, 20)).expect("64 MiB and no more");
    assert_eq!(input.source.len(), 64 << 20);
    let error = open_bytes("pit", &zstd_bomb(513, 20)).expect_err("more than 64 MiB");
    assert!(limit(&error).contains("packed byte"));
}

#[test]
fn the_size_of_the_content_has_a_limit() {
    let text = mesh(1000);
    let size = text.len() as u64;
    let at = |unpacked_bytes| Limits { unpacked_bytes, ..Limits::default() };
    for compression in Compression::ALL {
        let (_folder, path) = file("pit", &pack(compression, &text));
        let space = scratch();
        let error = Input::open(&path, &at(size - 1), &space).expect_err("over the limit");
        assert_eq!(limit(&error), format!("the size of the content is over the limit of {} bytes", size - 1));
        assert_eq!(space.used(), 0, "what was written counts no more");
        assert!(Input::open(&path, &at(size), &space).is_ok());
    }
}

#[test]
fn a_window_over_the_limit_is_refused_for_zstd_and_xz() {
    let error = open_bytes("pit.zst", &zstd_bomb(8192, 31)).expect_err("2 GiB of window");
    assert_eq!(limit(&error), "the window that the zstd stream asks for is over the limit of 128 MiB");
    assert!(open_bytes("pit.zst", &zstd_bomb(8, 27)).is_ok());
    assert!(open_bytes("pit.zst", &zstd_bomb(8, 28)).is_err());

    // The sixth preset asks for 8 MiB.
    let (_folder, path) = file("pit.xz", &pack(Compression::Xz, &mesh(10)));
    let at = |window_bytes| Limits { window_bytes, ..Limits::default() };
    let error = Input::open(&path, &at(4 << 20), &scratch()).expect_err("8 MiB of window");
    assert_eq!(limit(&error), "the window that the xz stream asks for is over the limit of 4 MiB");
    assert!(Input::open(&path, &at(8 << 20), &scratch()).is_ok());
}

#[test]
fn the_size_of_the_file_has_a_limit() {
    let limits = Limits { file_bytes: 1000, ..Limits::default() };
    for content in [mesh(100), pack(Compression::Gzip, &mesh(1000))] {
        let (_folder, path) = file("pit.inp", &content);
        let error = Input::open(&path, &limits, &scratch()).expect_err("over the limit");
        assert_eq!(limit(&error), "the size of the file is over the limit of 1000 bytes");
        let streamed = Input::from_reader(Path::new("-"), &content[..], &limits, &scratch());
        assert_eq!(limit(&streamed.expect_err("over the limit")), limit(&error));
    }
}

#[test]
fn full_scratch_space_is_a_resource_that_comes_back() {
    let text = mesh(1000);
    let (_folder, path) = file("pit.inp.gz", &pack(Compression::Gzip, &text));
    let space = Scratch::new(&std::env::temp_dir(), text.len() as u64 * 3 / 2);
    let first = Input::open(&path, &Limits::default(), &space).expect("room for one");
    assert_eq!(space.used(), text.len() as u64);
    let error = Input::open(&path, &Limits::default(), &space).expect_err("no room for two");
    assert!(error.is_resource(), "{error}");
    assert!(error.to_string().contains("out of scratch space"), "{error}");
    drop(first);
    assert_eq!(space.used(), 0);
    assert!(Input::open(&path, &Limits::default(), &space).is_ok());
}

#[test]
fn a_scratch_folder_that_is_not_there_is_named() {
    let space = Scratch::new(Path::new("/nowhere/scratch"), 1 << 20);
    let (_folder, path) = file("pit.gz", &pack(Compression::Gzip, b"*NODE\n"));
    let error = Input::open(&path, &Limits::default(), &space).expect_err("no folder");
    assert!(error.is_resource() && error.to_string().contains("/nowhere/scratch"), "{error}");
}

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

#[test]
fn only_regular_files_are_opened_and_nothing_hangs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("folder.inp")).expect("a folder");
    mknodat(CWD, path("fifo.inp"), FileType::Fifo, Mode::RWXU, 0).expect("a FIFO");
    let _socket = std::os::unix::net::UnixListener::bind(path("socket.inp")).expect("a socket");
    std::os::unix::fs::symlink(path("fifo.inp"), path("link.inp")).expect("a link");
    let rows = [
        (path("folder.inp"), "a directory"),
        (path("fifo.inp"), "a FIFO"),
        (path("link.inp"), "a FIFO"),
        (path("socket.inp"), "a socket"),
        ("/dev/zero".into(), "a character device"),
    ];
    for (path, word) in rows {
        let (send, receive) = std::sync::mpsc::sync_channel(1);
        let name = path.clone();
        std::thread::spawn(move || send.send(open(&name).err()));
        let answer = receive.recv_timeout(Duration::from_secs(5)).expect("opening does not hang");
        let error = answer.expect("no regular file");
        let expected = format!("{}: expected a regular file, found {word}", path.display());
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn a_link_to_a_file_is_followed() {
    let (folder, path) = file("pit.inp", b"*NODE\n");
    let link = folder.path().join("link.inp");
    std::os::unix::fs::symlink(&path, &link).expect("a link");
    let input = open(&link).expect("a sound file");
    assert_eq!((content(&input), input.source.path()), (b"*NODE\n".to_vec(), &*link));
}

#[test]
fn what_cannot_be_opened_is_named_with_the_cause() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let ring = folder.path().join("ring.inp");
    std::os::unix::fs::symlink(&ring, &ring).expect("a link");
    for path in [ring, folder.path().join("missing.inp")] {
        let error = open(&path).expect_err("no file");
        assert!(matches!(error.kind(), Kind::Unreadable(_)), "{error}");
        assert_eq!(error.path(), Some(&*path));
    }
}

#[test]
fn a_file_without_permission_is_unreadable() {
    let (_folder, path) = file("pit.inp", b"*NODE\n");
    let forbidden = std::os::unix::fs::PermissionsExt::from_mode(0);
    fs::set_permissions(&path, forbidden).expect("the owner may");
    if File::open(&path).is_ok() {
        eprintln!("skipped: this user may read every file");
        return;
    }
    let error = open(&path).expect_err("no permission");
    assert!(matches!(error.kind(), Kind::Unreadable(_)), "{error}");
}

#[test]
fn an_empty_file_is_empty() {
    let error = open_bytes("pit.inp", b"").expect_err("no bytes");
    assert!(matches!(error.kind(), Kind::Empty));
    assert!(error.to_string().ends_with("pit.inp: expected a mesh, found an empty file"), "{error}");
}

#[test]
fn packed_files_of_the_corpus_hold_what_the_plain_ones_hold() {
    let Some(corpus) = std::env::var_os("MESHGAUGE_CORPUS").map(PathBuf::from) else {
        eprintln!("skipped: MESHGAUGE_CORPUS is not set");
        return;
    };
    let rows = [
        ("compressed/mesh_1.mphtxt.zst", "comsol/mesh_1.mphtxt", "zstd"),
        ("compressed/rivet_two_members.inp.gz", "abaqus/cae_multi_instance_rivet.inp", "gzip"),
    ];
    for (packed, plain, compression) in rows {
        let packed = open(&corpus.join(packed)).expect(packed);
        let plain = open(&corpus.join(plain)).expect(plain);
        assert_eq!(packed.compression, Some(compression));
        assert!(content(&packed) == content(&plain));
    }
}
