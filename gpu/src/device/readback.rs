//! Results on their way back from the device.

use crate::device::Gpu;
use crate::error::GpuError;
use std::sync::mpsc;

/// A result that the device is still working on.
#[derive(Debug)]
pub struct Pending {
    buffer: wgpu::Buffer,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
    /// Words of a row in the buffer, and how many of them count.
    row: (usize, usize),
    /// Bytes that count, where pixels are not whole words.
    bytes: usize,
}

impl Pending {
    /// Submits the commands and asks for the buffer, of which each row of `row.0` words holds `row.1` that count.
    pub(crate) fn submit(gpu: &Gpu, encoder: wgpu::CommandEncoder, buffer: wgpu::Buffer, row: (usize, usize)) -> Self {
        gpu.queue.submit([encoder.finish()]);
        let (done, mapped) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only where nobody waits for the result any more.
            let _ = done.send(result);
        });
        Self { buffer, mapped, row, bytes: 0 }
    }

    /// The same of which the first bytes count.
    pub(crate) fn of_bytes(self, bytes: usize) -> Self {
        Self { bytes, ..self }
    }

    /// The first bytes that came back.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub(crate) fn wait_bytes(self, gpu: &Gpu) -> Result<Vec<u8>, GpuError> {
        let bytes = self.bytes;
        let words = self.wait(gpu)?;
        Ok(bytemuck::cast_slice(&words)[..bytes].to_vec())
    }

    /// The words that came back, row after row.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn wait(self, gpu: &Gpu) -> Result<Vec<u32>, GpuError> {
        gpu.wait()?;
        match self.mapped.recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(GpuError::Device(error.to_string())),
            Err(error) => return Err(GpuError::Device(error.to_string())),
        }
        let view = self.buffer.get_mapped_range(..).map_err(|error| GpuError::Device(error.to_string()))?;
        let words: &[u32] = bytemuck::cast_slice(&view);
        let (stride, kept) = self.row;
        Ok(words.chunks_exact(stride).flat_map(|row| &row[..kept]).copied().collect())
    }
}

/// A buffer to read back through.
pub(crate) fn staging(gpu: &Gpu, words: usize) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: 4 * words as u64,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Copies a whole target of four words a pixel into a staging buffer, whose rows are `width` pixels wide: the width must
/// be a multiple of 16.
fn copy_target(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, target: &wgpu::Texture) -> wgpu::Buffer {
    let size = target.size();
    let staging = staging(gpu, 4 * (size.width * size.height) as usize);
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &staging,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(16 * size.width),
                rows_per_image: None,
            },
        },
        size,
    );
    staging
}

/// [`copy_target`] and the submission: all pixels of a target of four words each.
pub(crate) fn read_target(gpu: &Gpu, mut encoder: wgpu::CommandEncoder, target: &wgpu::Texture) -> Pending {
    let staging = copy_target(gpu, &mut encoder, target);
    Pending::submit(gpu, encoder, staging, (4, 4))
}

/// A clear value that fills an integer target with the sentinel.
pub(crate) fn sentinel_color() -> wgpu::Color {
    let word = f64::from(lightmeter_scene::target::SENTINEL);
    wgpu::Color { r: word, g: word, b: word, a: word }
}
