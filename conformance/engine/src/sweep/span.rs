//! All inputs of a sweep as numbers, cut into blocks, and which blocks a shard has.

use lightmeter_catalogue::select::Shard;
use lightmeter_scene::along::{float_of, key_of};

/// The most inputs of a block, which take a device about a fifth of a second.
const MOST: u64 = 1 << 22;
/// The fewest, but for the last block.
const FEWEST: u64 = 1 << 12;
/// Blocks that a short sweep is cut into, so that it can be shared out.
const SHARED_OUT: u64 = 64;

/// The inputs of a sweep, numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// All inputs.
    pub inputs: u64,
    /// Inputs of a block.
    pub block: u64,
}

impl Span {
    /// That many inputs in blocks that follow from their number alone, so that shards agree.
    #[must_use]
    pub fn of(inputs: u64) -> Self {
        let block = (inputs / SHARED_OUT).checked_ilog2().map_or(0, |power| 1 << power).clamp(FEWEST, MOST);
        Self { inputs, block }
    }

    /// Blocks in all.
    #[must_use]
    pub const fn blocks(self) -> u64 {
        self.inputs.div_ceil(self.block)
    }

    /// Blocks of a shard: those whose number leaves its index when divided by the number of shards.
    #[must_use]
    pub const fn blocks_of(self, shard: Shard) -> u64 {
        self.blocks().saturating_sub(shard.index).div_ceil(shard.count.get())
    }

    /// The number of the first input of a shard's block, and how many it has.
    #[must_use]
    pub fn block_of(self, shard: Shard, number: u64) -> (u64, u64) {
        let first = (shard.index + number * shard.count.get()) * self.block;
        (first, self.block.min(self.inputs - first))
    }

    /// Inputs of a shard's first blocks.
    #[must_use]
    pub fn inputs_of(self, shard: Shard, blocks: u64) -> u64 {
        let Some(last) = blocks.checked_sub(1) else { return 0 };
        last * self.block + self.block_of(shard, last).1
    }
}

/// The float of a number in a range.
#[must_use]
pub(super) fn input(from: f32, number: u64) -> f32 {
    float_of(key_of(from) + u32::try_from(number).unwrap_or(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroU64;

    #[test]
    fn shards_have_every_input_once() {
        for (inputs, count) in [(1_u64, 1_u64), (4097, 2), (1_000_000, 7), (1_232_348_161, 3), (1 << 24, 8)] {
            let span = Span::of(inputs);
            let mut blocks: Vec<(u64, u64)> = vec![];
            for index in 0..count {
                let shard = Shard { index, count: NonZeroU64::new(count).expect("not 0") };
                let own: Vec<_> = (0..span.blocks_of(shard)).map(|number| span.block_of(shard, number)).collect();
                assert_eq!(own.iter().map(|(_, count)| count).sum::<u64>(), span.inputs_of(shard, own.len() as u64));
                blocks.extend(own);
            }
            blocks.sort_unstable();
            let end = blocks.iter().fold(0, |end, &(first, count)| {
                assert_eq!(first, end);
                end + count
            });
            assert_eq!((end, blocks.len() as u64), (inputs, span.blocks()));
        }
    }

    #[test]
    fn short_sweeps_can_be_shared_out_and_long_ones_have_long_blocks() {
        assert_eq!(Span::of(1).blocks(), 1);
        assert!(Span::of(1_000_000).blocks() >= 64);
        assert_eq!(Span::of(1_232_348_161).block, MOST);
        assert_eq!(Span::of(1 << 24).blocks(), 64);
    }
}
