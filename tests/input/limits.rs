//! What is over a limit is refused by that limit's name, and costs nothing afterwards.

use std::path::Path;

use meshgauge::input::{Compression, Input, Limits, Scratch};

use crate::bombs::{gzip_bomb, xz_bomb, zstd_bomb};
use crate::packing::{file, limit, mesh, open_bytes, pack, scratch};

#[test]
fn a_ratio_that_no_mesh_has_is_refused() {
    let zeros = vec![0; 8 << 20];
    let repeated = [Compression::Zstd, Compression::Bzip2, Compression::Xz]
        .map(|compression| (compression, pack(compression, &zeros).repeat(10)));
    for (compression, packed) in repeated.into_iter().chain([(Compression::Gzip, gzip_bomb(80))]) {
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

    let error = open_bytes("pit.xz", &xz_bomb()).expect_err("1.5 GiB of window");
    assert_eq!(limit(&error), "the window that the xz stream asks for is over the limit of 128 MiB");
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
