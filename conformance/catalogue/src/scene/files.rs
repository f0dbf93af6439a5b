//! The files that a scene names, and their bytes.

use std::io::{self, Read as _};
use std::path::Path;

/// Gives the bytes of a file that a scene names.
pub type Files<'a> = dyn Fn(&str) -> io::Result<Vec<u8>> + 'a;

/// Bytes of a file, at most.
const MOST_BYTES: u64 = 64 << 20;

/// The bytes of a file, unless it is too large.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let about = std::fs::metadata(path)?;
    // A pipe may wait for ever, and a device never end.
    if !about.is_file() {
        return Err(io::Error::other("it is no file"));
    }
    let mut bytes = vec![];
    std::fs::File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(io::Error::other(format!("it has more than {MOST_BYTES} bytes")));
    }
    Ok(bytes)
}
