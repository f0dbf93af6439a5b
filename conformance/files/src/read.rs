//! Files that somebody else may have written: of a stated size, and regular ones alone, since a pipe may wait for ever and a device never
//! end.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// Bytes that a file of text may have: a baseline, a document, known failures, a manifest, a shader.
pub const MOST_TEXT: u64 = 64 << 20;

/// Opens a regular file.
///
/// # Errors
/// Where there is none, it cannot be opened, or it is a folder, a pipe or a device.
pub fn open(path: &Path) -> io::Result<File> {
    let about = std::fs::metadata(path)?;
    if about.is_dir() {
        return Err(io::Error::other("it is a folder; expected a file"));
    }
    if !about.is_file() && !is_given(path) {
        return Err(io::Error::other("it is a pipe or a device; expected a file"));
    }
    File::open(path)
}

/// Whether it is what this process was given to read from, `/dev/stdin` or `<(…)` of a shell, by a pipe: that ends when its writer does.
#[cfg(unix)]
fn is_given(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt as _;
    let is_named = path == Path::new("/dev/stdin") || path.starts_with("/dev/fd") || path.starts_with("/proc/self/fd");
    is_named && std::fs::metadata(path).is_ok_and(|about| about.file_type().is_fifo())
}

#[cfg(not(unix))]
const fn is_given(_: &Path) -> bool {
    false
}

/// The bytes of a regular file.
///
/// # Errors
/// Where it cannot be read, is no regular file, or has more than `most` bytes.
pub fn bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let too_long = |length: u64| io::Error::other(format!("it has {length} bytes; expected at most {most}"));
    let length = file.metadata()?.len();
    if length > most {
        return Err(too_long(length));
    }
    let mut bytes = vec![];
    // Files of a kernel have no length beforehand, and any file may grow.
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(too_long(bytes.len() as u64));
    }
    Ok(bytes)
}

/// The text of a regular file.
///
/// # Errors
/// As [`bytes`], and where it is not UTF-8: with the line and the byte.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(bytes(path, most)?).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..place].iter().filter(|byte| **byte == b'\n').count();
        io::Error::other(format!("it is not UTF-8: byte {place}, in line {line}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_within_its_limit() {
        let path = std::env::temp_dir().join(format!("lightmeter-read-{}", std::process::id()));
        std::fs::write(&path, b"one\ntw\xFF").expect("it can be written");
        assert_eq!(bytes(&path, 7).expect("seven bytes"), b"one\ntw\xFF");
        let error = |result: io::Result<String>| result.expect_err("it is refused").to_string();
        assert_eq!(error(text(&path, 6)), "it has 7 bytes; expected at most 6");
        assert_eq!(error(text(&path, 7)), "it is not UTF-8: byte 6, in line 2");
        std::fs::remove_file(&path).expect("it can be removed");
        assert_eq!(error(text(&std::env::temp_dir(), 7)), "it is a folder; expected a file");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_refused() {
        let error = bytes(Path::new("/dev/zero"), 7).expect_err("it has no end").to_string();
        assert_eq!(error, "it is a pipe or a device; expected a file");
    }
}
