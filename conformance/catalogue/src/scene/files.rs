//! The files that a scene names, and their bytes.

use std::io;
use std::path::Path;

/// Gives the bytes of a file that a scene names.
pub type Files<'a> = dyn Fn(&str) -> io::Result<Vec<u8>> + 'a;

/// Bytes of a file, at most.
const MOST_BYTES: u64 = 64 << 20;

/// The bytes of a file, unless it is too large.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    lightmeter_files::read::bytes(path, MOST_BYTES)
}
