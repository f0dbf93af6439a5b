//! SPIR-V: naga reads it, and where its instructions stand in the source.

use super::ShaderError;
use naga::front::spv;
use std::path::Path;

const OP_LINE: u32 = 8;
const OP_FUNCTION_END: u32 = 56;
const OP_LABEL: u32 = 248;
const OP_NO_LINE: u32 = 317;

/// The line of each instruction's place, in bytes.
pub(super) type Table = Vec<(usize, u32)>;

fn word(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..at + 4).map_or(0, |own| u32::from_le_bytes([own[0], own[1], own[2], own[3]]))
}

/// naga knows lines within functions alone: others are taken out.
fn without_lines_outside(bytes: &[u8]) -> Vec<u8> {
    let (mut at, mut is_inside) = (20, false);
    let mut found = bytes.get(..at).unwrap_or_default().to_vec();
    while at + 4 <= bytes.len() {
        let (op, length) = (word(bytes, at) & 0xffff, (word(bytes, at) >> 16).max(1) as usize * 4);
        is_inside |= op == OP_LABEL;
        is_inside &= op != OP_FUNCTION_END;
        if !matches!(op, OP_LINE | OP_NO_LINE) || is_inside && op == OP_LINE {
            found.extend_from_slice(bytes.get(at..at + length).unwrap_or_default());
        }
        at += length;
    }
    found
}

fn table(bytes: &[u8]) -> Table {
    let (mut at, mut found) = (20, vec![]);
    while at + 4 <= bytes.len() {
        let (op, length) = (word(bytes, at) & 0xffff, (word(bytes, at) >> 16).max(1) as usize * 4);
        match op {
            OP_LINE => found.push((at, word(bytes, at + 8))),
            OP_FUNCTION_END => found.push((at, 0)),
            _ => {}
        }
        at += length;
    }
    found
}

/// A module, and the lines of its source.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<(naga::Module, Table), ShaderError> {
    let bytes = without_lines_outside(bytes);
    let options =
        spv::Options { adjust_coordinate_space: false, strict_capabilities: false, ..spv::Options::default() };
    let invalid = |message: String| ShaderError::Invalid { path: path.into(), line: None, message };
    let parsed = std::panic::catch_unwind(|| spv::parse_u8_slice(&bytes, &options));
    let module = parsed
        .map_err(|_| invalid("naga ended while reading it as SPIR-V".into()))?
        .map_err(|error| invalid(format!("it is no SPIR-V that naga reads: {error}")))?;
    Ok((module, table(&bytes)))
}

/// The line of a place.
pub(super) fn line(table: &Table, place: usize) -> u32 {
    table[..table.partition_point(|(at, _)| *at <= place)].last().map_or(0, |(_, line)| *line)
}
