//! What is read from others, replayed: seeds and findings of `tests/corpus`, whole, cut and changed. `./x fuzz` looks for more.

use lightmeter_tests::readers::{InputReader, READERS, corpus};
use std::path::PathBuf;

/// The files of a reader's corpus, in order.
fn files(reader: &InputReader) -> Vec<PathBuf> {
    let folder = corpus().join(reader.name);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("the folder can be read").path()).collect();
    files.sort();
    files
}

/// Reads bytes on a stack as large as a main thread's, and says of which file a panic was.
fn read(reader: &'static InputReader, of: &str, bytes: Vec<u8>) {
    let thread = std::thread::Builder::new().stack_size(8 << 20);
    let reading = thread.spawn(move || (reader.read)(&bytes)).expect("a thread can be started");
    assert!(reading.join().is_ok(), "the reader `{}` panics at {of}", reader.name);
}

#[test]
fn every_reader_has_seeds_and_every_folder_a_reader() {
    for reader in READERS {
        assert!(!files(reader).is_empty(), "tests/corpus/{} has no file", reader.name);
    }
    for entry in std::fs::read_dir(corpus()).expect("the corpus can be read") {
        let name = entry.expect("it can be read").file_name().to_string_lossy().into_owned();
        assert!(READERS.iter().any(|reader| reader.name == name), "tests/corpus/{name} is no reader's");
    }
}

#[test]
fn findings_and_seeds_are_read_without_a_panic() {
    for reader in READERS {
        for file in files(reader) {
            let bytes = std::fs::read(&file).expect("the file can be read");
            read(reader, &file.display().to_string(), bytes);
        }
    }
}

/// Cut in eight places, and with a byte turned over in as many: what a broken disk or transfer leaves.
#[test]
fn cut_and_changed_files_are_read_without_a_panic() {
    for reader in READERS {
        for file in files(reader) {
            let bytes = std::fs::read(&file).expect("the file can be read");
            for eighth in 0..8 {
                let place = bytes.len() * eighth / 8;
                let of = |how: &str| format!("{} {how} at byte {place}", file.display());
                read(reader, &of("cut"), bytes[..place].to_vec());
                let mut changed = bytes.clone();
                if let Some(byte) = changed.get_mut(place) {
                    *byte ^= 1 << eighth;
                }
                read(reader, &of("changed"), changed);
            }
        }
    }
}
