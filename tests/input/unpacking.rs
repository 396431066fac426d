//! Every compression: whole, of several streams, cut, broken.

use std::path::PathBuf;

use meshgauge::error::{At, Kind};
use meshgauge::input::Compression;
use xxhash_rust::xxh3::xxh3_64;

use crate::packing::{content, mesh, open, open_bytes, pack};

#[test]
fn every_compression_unpacks_whatever_the_name() {
    let text = mesh(20_000);
    for compression in Compression::ALL {
        let packed = pack(compression, &text);
        let input = open_bytes("pit.inp", &packed).expect("sound streams");
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
        let input = open_bytes("pit", &parts.concat()).expect("sound streams");
        assert!(content(&input) == text, "{}", compression.name());
    }
}

#[test]
fn a_stream_of_nothing_among_others_does_not_end_the_file() {
    for compression in Compression::ALL {
        let nothing = pack(compression, b"");
        let packed = [&nothing[..], &pack(compression, b"1, 2\n"), &nothing, &pack(compression, b"3, 4\n")];
        let input = open_bytes("pit", &packed.concat()).expect("sound streams");
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
        for parts in 1..4 {
            let cut = packed.len() * parts / 4;
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
