//! SPIR-V: naga reads it, and where its instructions stand in the source.

use super::ShaderError;
use naga::front::spv;
use std::path::Path;

const OP_LINE: u32 = 8;
const OP_ENTRY_POINT: u32 = 15;
const OP_EXECUTION_MODE: u32 = 16;
const OP_TYPE_FUNCTION: u32 = 33;
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

/// The bytes of an instruction that naga does not count in the places that it gives: its last operands, of some.
fn uncounted(bytes: &[u8], at: usize, words: usize) -> usize {
    let counted = match word(bytes, at) & 0xffff {
        OP_EXECUTION_MODE | OP_TYPE_FUNCTION => 3,
        OP_ENTRY_POINT => {
            let ends = |k: &usize| word(bytes, at + 4 * k).to_le_bytes().contains(&0);
            (3..words).find(ends).map_or(words, |last| last + 1)
        }
        _ => words,
    };
    words.saturating_sub(counted) * 4
}

fn table(bytes: &[u8]) -> Table {
    let (mut at, mut lost, mut found) = (20, 0, vec![]);
    while at + 4 <= bytes.len() {
        let (op, words) = (word(bytes, at) & 0xffff, (word(bytes, at) >> 16).max(1) as usize);
        lost += uncounted(bytes, at, words);
        match op {
            OP_LINE => found.push((at - lost, word(bytes, at + 8))),
            OP_FUNCTION_END => found.push((at - lost, 0)),
            _ => {}
        }
        at += words * 4;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_at_the_places_that_naga_gives() {
        let op = |op: u32, operands: &[u32]| -> Vec<u32> {
            let length = u32::try_from(operands.len() + 1).expect("few");
            std::iter::once(length << 16 | op).chain(operands.iter().copied()).collect()
        };
        let name = u32::from_le_bytes(*b"m\0\0\0");
        // Two variables of an entry point, a mode's three numbers and two parameters are not counted.
        let words = [
            vec![0; 5],
            op(OP_ENTRY_POINT, &[4, 1, name, 7, 8]),
            op(OP_EXECUTION_MODE, &[1, 17, 8, 8, 1]),
            op(OP_TYPE_FUNCTION, &[2, 3, 4, 5]),
            op(OP_LINE, &[9, 42, 0]),
        ]
        .concat();
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let at = 4 * (5 + 6 + 6 + 5 - 2 - 3 - 2);
        assert_eq!(table(&bytes), [(at, 42)]);
    }
}
