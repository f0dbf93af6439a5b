//! Results on their way back from the device.

use super::hosted::Asked;
use super::native::Native;
use super::objects::{Scope, pixel_bytes};
use super::{Gpu, Place};
use crate::error::GpuError;
use crate::work::Read;
use std::borrow::Cow;
use std::sync::mpsc;

/// A result that the device is still working on.
#[derive(Debug)]
pub struct Pending(Way);

/// Which way a result comes back.
#[derive(Debug)]
enum Way {
    /// From wgpu's device.
    Mapped(Mapped),
    /// From a device elsewhere.
    Asked(Asked),
}

/// A result that a buffer is mapped for.
#[derive(Debug)]
struct Mapped {
    submission: wgpu::SubmissionIndex,
    buffer: wgpu::Buffer,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
    layout: Layout,
}

/// Where the reads of a submission lie in the buffer that they come back through: one after the other.
#[derive(Debug)]
pub(super) struct Layout(Vec<Part>);

/// Rows of words with gaps.
#[derive(Debug)]
struct Part {
    rows: usize,
    /// Bytes from a row to the next.
    stride: usize,
    /// Bytes of a row that count.
    row_bytes: usize,
}

impl Pending {
    /// Asks for what a submission copies to the buffer.
    pub(super) fn new(submission: wgpu::SubmissionIndex, buffer: wgpu::Buffer, layout: Layout) -> Self {
        let (done, mapped) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only where nobody waits for the result any more.
            let _ = done.send(result);
        });
        Self(Way::Mapped(Mapped { submission, buffer, mapped, layout }))
    }

    /// A result of a device elsewhere.
    pub(super) const fn elsewhere(asked: Asked) -> Self {
        Self(Way::Asked(asked))
    }

    /// The words that came back, read after read.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn wait(self, gpu: &Gpu) -> Result<Vec<u32>, GpuError> {
        self.map(gpu, |words| words.into_owned())
    }

    /// Hands the words on, once they are there; a buffer that is kept can be used again after.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub(crate) fn map<T>(self, gpu: &Gpu, then: impl FnOnce(Cow<'_, [u32]>) -> T) -> Result<T, GpuError> {
        match (self.0, &gpu.place) {
            (Way::Mapped(mapped), Place::Here(native)) => mapped.map(native, then),
            (Way::Asked(asked), _) => asked.wait().map(|words| then(Cow::Owned(words))),
            (Way::Mapped(_), Place::Hosted(_)) => {
                unreachable!("a result is waited for on the device that it was asked of")
            }
        }
    }
}

impl Mapped {
    fn map<T>(self, native: &Native, then: impl FnOnce(Cow<'_, [u32]>) -> T) -> Result<T, GpuError> {
        native.wait_for(self.submission)?;
        match self.mapped.recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(GpuError::Device(error.to_string())),
            Err(error) => return Err(GpuError::Device(error.to_string())),
        }
        let result = {
            let view = self.buffer.get_mapped_range(..).map_err(|error| GpuError::Device(error.to_string()))?;
            then(self.layout.words(bytemuck::cast_slice(&view)))
        };
        self.buffer.unmap();
        Ok(result)
    }
}

impl Layout {
    pub(super) fn new(scope: Scope<'_>, reads: &[Read]) -> Self {
        let part = |read: &Read| match read {
            Read::Buffer { bytes, .. } => Part { rows: 1, stride: *bytes, row_bytes: *bytes },
            Read::Texture(texture) => {
                let texture = &scope.texture(*texture).texture;
                let row_bytes = texture.width() as usize * pixel_bytes(texture);
                let stride = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
                Part { rows: texture.height() as usize, stride, row_bytes }
            }
        };
        Self(reads.iter().map(part).collect())
    }

    /// A buffer to read back through.
    pub(super) fn buffer(&self, native: &Native) -> wgpu::Buffer {
        native.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: self.bytes() as u64,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// Copies what is read into the buffer.
    pub(super) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scope: Scope<'_>,
        reads: &[Read],
        through: &wgpu::Buffer,
    ) {
        let mut offset = 0;
        for (part, read) in self.0.iter().zip(reads) {
            match read {
                Read::Buffer { buffer, bytes } => {
                    encoder.copy_buffer_to_buffer(scope.buffer(*buffer), 0, through, offset, *bytes as u64);
                }
                Read::Texture(texture) => {
                    let bytes_per_row = u32::try_from(part.stride).ok();
                    let layout = wgpu::TexelCopyBufferLayout { offset, bytes_per_row, rows_per_image: None };
                    let texture = &scope.texture(*texture).texture;
                    let place = wgpu::TexelCopyBufferInfo { buffer: through, layout };
                    encoder.copy_texture_to_buffer(texture.as_image_copy(), place, texture.size());
                }
            }
            offset += part.bytes() as u64;
        }
    }

    fn bytes(&self) -> usize {
        self.0.iter().map(Part::bytes).sum()
    }

    /// The words that count, of all that are there.
    fn words<'a>(&self, all: &'a [u32]) -> Cow<'a, [u32]> {
        if self.0.iter().all(|part| part.stride == part.row_bytes) {
            return Cow::Borrowed(&all[..self.bytes() / 4]);
        }
        let (mut words, mut rest) = (vec![], all);
        for part in &self.0 {
            let (rows, after) = rest.split_at(part.bytes() / 4);
            words.extend(rows.chunks_exact(part.stride / 4).flat_map(|row| &row[..part.row_bytes / 4]));
            rest = after;
        }
        Cow::Owned(words)
    }
}

impl Part {
    const fn bytes(&self) -> usize {
        self.rows * self.stride
    }
}
