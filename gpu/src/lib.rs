//! The formulas in WGSL and their evaluation on any wgpu adapter.
//!
//! Four ways lead through a renderer, and each is judged by itself: the *compute* stage, the *fragment* stage, the
//! *rasteriser* and the *fixed-function* blend unit. This crate never sees a formula of the reference: what a case
//! should give is not known here.
//!
//! Each way describes what it does as data ([`work`]) and reads the words that come back. An executor, which keeps what
//! outlives a submission, runs the descriptions on a device by wgpu; nothing else makes objects there or submits commands.
//! Where the device is elsewhere, as a browser's is, the executor hands the descriptions to a [`Host`] instead.

mod adapters;
mod arithmetic;
mod blend_unit;
pub mod compose;
mod depth_unit;
mod device;
mod error;
mod kernel;
mod library;
mod raster;
mod repeat;
mod rung;
pub mod scene;
mod shaders;
#[cfg(test)]
#[path = "../../tests/src/skip.rs"]
#[expect(unreachable_pub, reason = "the library of the tests has it as well")]
mod skip;
mod sweep;
pub mod work;

pub use adapters::{Adapter, adapters, native_adapters};
pub use arithmetic::{ArithmeticPipeline, Programmable};
pub use blend_unit::{Batch, BlendUnit, UnitDraw};
pub use depth_unit::{DEPTH_OUTPUTS, DepthUnit};
pub use device::{Abilities, Clock, ClockKind, ClockReading, Gpu, Host, HostError, Pending, Ticket, WorkPiece};
pub use error::GpuError;
pub use kernel::Kernel;
pub use library::{EFFECT_FILES, FILES, SCENE_FILES};
pub use raster::RasterPipeline;
pub use repeat::RepeatPipeline;
pub use rung::Rung;
pub use shaders::Shaders;
pub use sweep::{Block, Sweep};

/// Whether this thread's test is skipped for want of a driver.
#[cfg(test)]
fn lacks_driver() -> bool {
    skip::lacks(native_adapters().is_empty(), skip::DRIVER)
}
