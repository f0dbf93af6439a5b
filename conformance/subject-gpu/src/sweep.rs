//! A sweep on a device.

use super::{device_error, kernel};
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::select::Member;
use lightmeter_engine::device::{Blocks, DeviceError};
use lightmeter_gpu::{Block, Gpu, GpuError, Shaders, Sweep};
use lightmeter_scene::along::Along;
use std::collections::VecDeque;

const _: () =
    assert!(lightmeter_engine::sweep::UNDER_WAY <= Sweep::UNDER_WAY, "a device holds every block that is under way");

/// Prepares a sweep of a formula; or why it cannot be.
pub(super) fn sweep<'a>(
    gpu: &'a Gpu,
    shaders: &Shaders,
    member: &Member,
    stage: Stage,
    along: Along<'_>,
    capacity: usize,
) -> Result<Result<Box<dyn Blocks + 'a>, &'static str>, GpuError> {
    let stage = match stage {
        Stage::Fragment => lightmeter_gpu::Programmable::Fragment,
        _ => lightmeter_gpu::Programmable::Compute,
    };
    let Some(kernel) = kernel(shaders, member)? else { return Ok(Err("no shader function evaluates it")) };
    let selectors = member.spec.selectors.iter().map(|&code| f32::from_bits(code));
    let selected: Vec<f32> = selectors.chain(along.row.iter().copied()).collect();
    let along = Along { row: &selected, free: along.free + member.spec.selectors.len(), output: along.output };
    let sweep = Sweep::new(gpu, shaders, &kernel, stage, along, capacity)?;
    Ok(sweep.map(|sweep| Box::new(OnDevice { gpu, sweep, under_way: VecDeque::new() }) as Box<dyn Blocks + 'a>))
}

struct OnDevice<'a> {
    gpu: &'a Gpu,
    sweep: Sweep,
    under_way: VecDeque<Block>,
}

impl Blocks for OnDevice<'_> {
    fn start(&mut self, key: u32, count: usize) {
        self.under_way.push_back(self.sweep.submit(self.gpu, key, count));
    }

    fn finish(&mut self, read: &mut dyn FnMut(&[u32])) -> Result<(), DeviceError> {
        let block = self.under_way.pop_front().expect("a block that ends has begun");
        self.sweep.read(self.gpu, block, read).map_err(device_error)
    }
}
