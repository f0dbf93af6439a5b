//! A device elsewhere, such as a browser's, which runs work that is handed to it as data.

use super::clock::{Clock, ClockReading};
use super::objects::bytes_of_pixel;
use crate::error::GpuError;
use crate::work::{Handle, Read, Resources, Submission, TextureResource};
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What a device elsewhere can do besides what WebGPU guarantees.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Abilities {
    /// Whether it computes on the processor.
    pub is_cpu: bool,
    /// Pixels of a target's side, at most.
    pub most_pixels: u32,
    /// WebGPU's names of the optional features that the device was opened with.
    pub features: Vec<String>,
}

/// A piece of work. An *executor* is a number that resources are kept under.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WorkPiece<'a> {
    /// Makes further resources, which follow those that the executor keeps. What comes back has no bytes.
    Make {
        /// The executor.
        executor: u64,
        /// Those that are new.
        resources: &'a Resources,
    },
    /// Drops an executor's pipelines and what they bind. Nothing else is dropped.
    ForgetPipelines {
        /// The executor.
        executor: u64,
    },
    /// Drops all that an executor keeps.
    Drop {
        /// The executor.
        executor: u64,
    },
    /// Runs a submission. What is read comes back.
    Submit {
        /// The executor.
        executor: u64,
        /// The submission.
        work: &'a Submission,
    },
    /// Times a submission's steps on an idle device. What comes back are the first and the last timestamp in nanoseconds, which are 0 without
    /// the feature, as 64-bit integers, and the seconds that went by as a 64-bit float; all of them little endian.
    Time {
        /// The executor.
        executor: u64,
        /// The submission.
        work: &'a Submission,
        /// How often the steps are repeated.
        repeats: u32,
    },
    /// Destroys the device, as if it were lost.
    Destroy,
}

/// The number of a piece of work that was sent, by which its result is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Ticket(pub u64);

/// Why a piece of work came to nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HostError {
    /// A shader or a pipeline was refused.
    Refused(String),
    /// The device failed at something else, or was lost.
    Failed(String),
    /// The device did not answer within this many seconds.
    Silent(u64),
}

/// Whatever runs pieces of work on a device that it has: a browser's page.
pub trait Host: Debug + Send + Sync {
    /// What the device can do.
    fn abilities(&self) -> Abilities;

    /// Sends a piece of work. Pieces are begun in the order in which they are sent.
    fn send(&self, piece: &WorkPiece<'_>) -> Ticket;

    /// Waits for what comes back of a piece of work.
    ///
    /// # Errors
    /// Where the device refuses it, fails, or does not answer.
    fn wait(&self, ticket: Ticket) -> Result<Vec<u8>, HostError>;

    /// Says that nobody will wait for what comes back of a piece of work.
    fn forget(&self, ticket: Ticket);
}

/// What an executor keeps on a device elsewhere.
#[derive(Debug)]
pub(super) struct Kept {
    host: Arc<dyn Host>,
    executor: u64,
    /// How many shaders, pipelines, buffers, textures and bind groups were made.
    made: [usize; 5],
    /// What of them nobody has waited for yet.
    unsettled: Arc<Unsettled>,
    /// The bytes of each texture.
    textures: Vec<usize>,
}

/// What is made and was not waited for. The device makes it while others are judged; what it refused is told with the first result that needs it.
#[derive(Debug)]
struct Unsettled {
    host: Arc<dyn Host>,
    /// Each piece with the file that what it makes is of.
    made: Mutex<Vec<(Ticket, String)>>,
}

impl Unsettled {
    fn tickets(&self) -> Vec<(Ticket, String)> {
        std::mem::take(&mut *self.made.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Waits until all of it is made.
    fn settle(&self) -> Result<(), GpuError> {
        let mut settled = Ok(());
        for (ticket, file) in self.tickets() {
            if settled.is_ok() {
                settled = self.host.wait(ticket).map(drop).map_err(|error| error.said_of(&file));
            } else {
                self.host.forget(ticket);
            }
        }
        settled
    }
}

impl Drop for Unsettled {
    fn drop(&mut self) {
        for (ticket, _) in self.tickets() {
            self.host.forget(ticket);
        }
    }
}

impl Abilities {
    /// The features in wgpu's terms; those that the suite has no use for are left out.
    pub(super) fn features(&self) -> wgpu::Features {
        let of_name = |name: &String| match name.as_str() {
            "float32-blendable" => wgpu::Features::FLOAT32_BLENDABLE,
            "dual-source-blending" => wgpu::Features::DUAL_SOURCE_BLENDING,
            "timestamp-query" => wgpu::Features::TIMESTAMP_QUERY,
            "shader-f16" => wgpu::Features::SHADER_F16,
            _ => wgpu::Features::empty(),
        };
        self.features.iter().map(of_name).fold(wgpu::Features::empty(), wgpu::Features::union)
    }
}

impl HostError {
    /// The same as an error of the GPU's side. What is refused is said of `file`.
    fn said_of(self, file: &str) -> GpuError {
        match self {
            Self::Refused(message) => GpuError::Shader { file: file.into(), message },
            other => other.said_of_the_device(),
        }
    }

    /// The same of the device.
    fn said_of_the_device(self) -> GpuError {
        match self {
            Self::Refused(message) | Self::Failed(message) => GpuError::Device(message),
            Self::Silent(seconds) => GpuError::Timeout(seconds),
        }
    }
}

impl Kept {
    pub(super) fn new(host: &Arc<dyn Host>) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let unsettled = Arc::new(Unsettled { host: host.clone(), made: Mutex::default() });
        let executor = NEXT.fetch_add(1, Ordering::Relaxed);
        Self { host: host.clone(), executor, made: [0; 5], unsettled, textures: vec![] }
    }

    /// Has what is described and not made yet made. What the device refuses of it is told with the next result.
    pub(super) fn make(&mut self, resources: &Resources, file: &str) {
        let [shaders, pipelines, buffers, textures, groups] = self.made;
        let new = Resources {
            shaders: resources.shaders[shaders..].to_vec(),
            pipelines: resources.pipelines[pipelines..].to_vec(),
            buffers: resources.buffers[buffers..].to_vec(),
            textures: resources.textures[textures..].to_vec(),
            groups: resources.groups[groups..].to_vec(),
        };
        if new == Resources::default() {
            return;
        }
        self.made = [
            resources.shaders.len(),
            resources.pipelines.len(),
            resources.buffers.len(),
            resources.textures.len(),
            resources.groups.len(),
        ];
        self.textures.extend(new.textures.iter().map(texture_bytes));
        let ticket = self.host.send(&WorkPiece::Make { executor: self.executor, resources: &new });
        self.unsettled.made.lock().unwrap_or_else(PoisonError::into_inner).push((ticket, file.into()));
    }

    pub(super) fn forget_pipelines(&mut self) {
        self.made[1] = 0;
        let ticket = self.host.send(&WorkPiece::ForgetPipelines { executor: self.executor });
        self.host.forget(ticket);
    }

    pub(super) fn submit(&self, work: &Submission) -> Asked {
        let ticket = self.host.send(&WorkPiece::Submit { executor: self.executor, work });
        let bytes = work.reads.iter().map(|read| self.bytes(work, read)).sum();
        Asked { host: self.host.clone(), unsettled: self.unsettled.clone(), ticket, bytes, is_waited_for: false }
    }

    /// How many bytes a read of a submission gives.
    fn bytes(&self, work: &Submission, read: &Read) -> usize {
        match *read {
            Read::Buffer { bytes, .. } => bytes,
            Read::Texture(Handle::Kept(place)) => self.textures.get(place as usize).copied().unwrap_or_default(),
            Read::Texture(Handle::Own(place)) => work.own.textures.get(place as usize).map_or(0, texture_bytes),
        }
    }

    pub(super) fn time(&self, clock: &Clock, work: &Submission, repeats: u32) -> Result<ClockReading, GpuError> {
        self.unsettled.settle()?;
        let ticket = self.host.send(&WorkPiece::Time { executor: self.executor, work, repeats });
        let bytes = self.host.wait(ticket).map_err(HostError::said_of_the_device)?;
        let parts: Option<[[u8; 8]; 3]> = bytes.as_chunks().0.try_into().ok();
        let [start, end, wall] = parts.ok_or_else(|| GpuError::Device(format!("a time of {} bytes", bytes.len())))?;
        Ok(clock.reading([start, end].map(u64::from_le_bytes), f64::from_le_bytes(wall)))
    }
}

/// The bytes of a texture's pixels.
fn texture_bytes(texture: &TextureResource) -> usize {
    texture.width as usize * texture.height as usize * bytes_of_pixel(texture.format)
}

impl Drop for Kept {
    fn drop(&mut self) {
        let ticket = self.host.send(&WorkPiece::Drop { executor: self.executor });
        self.host.forget(ticket);
    }
}

/// A result that is still worked on elsewhere.
#[derive(Debug)]
pub(super) struct Asked {
    host: Arc<dyn Host>,
    /// What it needs.
    unsettled: Arc<Unsettled>,
    ticket: Ticket,
    /// How many bytes are to come back.
    bytes: usize,
    is_waited_for: bool,
}

impl Asked {
    /// The words that come back.
    pub(super) fn wait(mut self) -> Result<Vec<u32>, GpuError> {
        self.unsettled.settle()?;
        self.is_waited_for = true;
        let bytes = self.host.wait(self.ticket).map_err(HostError::said_of_the_device)?;
        if bytes.len() != self.bytes {
            let message = format!("{} bytes came back, where {} were asked for", bytes.len(), self.bytes);
            return Err(GpuError::Device(message));
        }
        Ok(bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
    }
}

impl Drop for Asked {
    fn drop(&mut self) {
        if !self.is_waited_for {
            self.host.forget(self.ticket);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{Executor, Gpu};
    use crate::work::{Buffer, Resources};
    use wgpu_types::{BufferUsages, TextureFormat, TextureUsages};

    /// A host that gives the same result for everything, and notes what is sent.
    #[derive(Debug)]
    struct Same(Result<Vec<u8>, HostError>, Mutex<Vec<String>>);

    impl Host for Same {
        fn abilities(&self) -> Abilities {
            Abilities { is_cpu: true, most_pixels: 64, features: vec!["float32-blendable".into(), "unheard-of".into()] }
        }

        fn send(&self, piece: &WorkPiece<'_>) -> Ticket {
            let mut sent = self.1.lock().expect("no test panics here");
            sent.push(serde_json::to_string(piece).expect("a piece can be written"));
            Ticket(sent.len() as u64)
        }

        fn wait(&self, _: Ticket) -> Result<Vec<u8>, HostError> {
            self.0.clone()
        }

        fn forget(&self, _: Ticket) {}
    }

    fn host(result: Result<Vec<u8>, HostError>) -> (Arc<Same>, Gpu) {
        let host = Arc::new(Same(result, Mutex::default()));
        (host.clone(), Gpu::hosted(host))
    }

    /// A buffer of 16 bytes and a texture of 2 × 3 pixels of 4, which are read back.
    fn work() -> Submission {
        let mut work = Submission::default();
        let buffer = work.buffer(Buffer::unwritten(16, BufferUsages::COPY_SRC));
        let texture = TextureResource::target([2, 3], TextureFormat::R32Uint, TextureUsages::COPY_SRC);
        let texture = work.texture(texture);
        work.reads.extend([Read::Buffer { buffer, bytes: 16 }, Read::Texture(texture)]);
        work
    }

    #[test]
    fn bytes_of_another_length_than_asked_for_are_an_error() {
        for (bytes, is_right) in [(40, true), (39, false), (0, false), (44, false)] {
            let (_, gpu) = host(Ok(vec![7; bytes]));
            let mut executor = Executor::default();
            executor.make(&gpu, &Resources::default(), "some.wgsl").expect("nothing is to be made");
            let words = executor.submit(&gpu, &work()).wait(&gpu);
            match words {
                Ok(words) => assert!(is_right && words == [0x0707_0707; 10], "{bytes}: {words:?}"),
                Err(error) => assert!(!is_right && error.to_string().contains("where 40 were asked for"), "{error}"),
            }
        }
    }

    #[test]
    fn what_is_new_is_made_once_and_dropped_at_the_end() {
        let (host, gpu) = host(Ok(vec![]));
        let mut resources = Resources::default();
        let mut executor = Executor::default();
        resources.shader("first", "1".into());
        executor.make(&gpu, &resources, "some.wgsl").expect("it is made");
        executor.make(&gpu, &resources, "some.wgsl").expect("nothing is new");
        resources.shader("second", "2".into());
        executor.make(&gpu, &resources, "some.wgsl").expect("it is made");
        drop(executor);
        let sent = host.1.lock().expect("no test panics here");
        let [first, second, dropped] = &sent[..] else { panic!("{sent:?}") };
        assert!(first.contains("first") && !first.contains("second"), "{first}");
        assert!(second.contains("second") && !second.contains("first"), "{second}");
        assert!(dropped.contains("drop"), "{dropped}");
    }

    #[test]
    fn what_is_refused_is_said_of_the_shader_and_what_fails_of_the_device() {
        let mut resources = Resources::default();
        resources.shader("a shader", "rubbish".into());
        for (error, is_of_shader) in
            [(HostError::Refused("1:1".into()), true), (HostError::Failed("gone".into()), false)]
        {
            let (_, gpu) = host(Err(error));
            let mut executor = Executor::default();
            executor.make(&gpu, &resources, "some.wgsl").expect("it is told with the next result");
            let made = executor.submit(&gpu, &Submission::default()).wait(&gpu).expect_err("it is refused");
            assert_eq!(
                matches!(made, GpuError::Shader { ref file, .. } if file == "some.wgsl"),
                is_of_shader,
                "{made}"
            );
        }
    }

    #[test]
    fn abilities_are_wgpus_features_and_what_is_unheard_of_is_none() {
        let (_, gpu) = host(Ok(vec![]));
        assert!(gpu.has(wgpu::Features::FLOAT32_BLENDABLE) && !gpu.has_dual_source() && gpu.is_cpu());
        assert_eq!(gpu.most_pixels(), 64);
    }
}
