//! Vertices and indices on a device, each uploaded once where it is needed.

use crate::work::{Buffer, Bytes, Contents, Handle, Resources};
use lightmeter_scene::frame::{Draw, Frame, Mesh};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::shading::Frequency;
use std::collections::HashMap;
use wgpu_types::{BufferUsages, VertexFormat};

/// A vertex input by its location in `scene.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Input {
    Position = 0,
    Normal = 1,
    Uv = 2,
    LightmapUv = 3,
    Color = 4,
}

impl Input {
    const ALL: [Self; 5] = [Self::Position, Self::Normal, Self::Uv, Self::LightmapUv, Self::Color];

    pub(super) fn at(location: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|input| input.location() == location)
    }

    pub(super) const fn location(self) -> u32 {
        self as u32
    }

    pub(super) const fn format(self) -> VertexFormat {
        match self {
            Self::Position | Self::Normal => VertexFormat::Float32x3,
            Self::Uv | Self::LightmapUv => VertexFormat::Float32x2,
            Self::Color => VertexFormat::Float32x4,
        }
    }

    /// The bytes of a mesh's vertices: 0, or white, where the mesh lacks them.
    fn bytes(self, mesh: &Mesh) -> Vec<u8> {
        let given: &[u8] = match self {
            Self::Position => bytemuck::cast_slice(&mesh.positions),
            Self::Normal => bytemuck::cast_slice(&mesh.normals),
            Self::Uv => bytemuck::cast_slice(&mesh.uvs),
            Self::LightmapUv => bytemuck::cast_slice(&mesh.lightmap_uvs),
            Self::Color => bytemuck::cast_slice(&mesh.colors),
        };
        let count = mesh.positions.len();
        match self {
            _ if !given.is_empty() => given.to_vec(),
            Self::Color => bytemuck::cast_slice(&vec![1.0_f32; 4 * count]).to_vec(),
            _ => vec![0; count * usize::try_from(self.format().size()).unwrap_or(usize::MAX)],
        }
    }
}

/// The buffers that were needed so far.
pub(super) struct Geometry<'a> {
    frame: &'a Frame,
    is_gl: bool,
    vertices: HashMap<(usize, Input), Handle>,
    /// By mesh and by how far its triangles are turned.
    indices: HashMap<(usize, usize), Handle>,
}

impl<'a> Geometry<'a> {
    pub(super) fn new(frame: &'a Frame, is_gl: bool) -> Self {
        Self { frame, is_gl, vertices: HashMap::new(), indices: HashMap::new() }
    }

    pub(super) fn vertices(&mut self, resources: &mut Resources, mesh: usize, input: Input) -> Handle {
        *self.vertices.entry((mesh, input)).or_insert_with(|| {
            let contents = Contents::Bytes(Bytes(input.bytes(&self.frame.meshes[mesh])));
            resources.buffer(Buffer { usage: BufferUsages::VERTEX, contents })
        })
    }

    /// The indices of a draw and their number. Flat attributes are the first vertex's, on OpenGL the last's: triangles
    /// are turned until that is the vertex that is wanted.
    pub(super) fn indices(&mut self, resources: &mut Resources, draw: &Draw) -> (Handle, u32) {
        let flat = draw.shading.filter(|shading| shading.frequency == Frequency::Flat);
        let turn = flat.map_or(0, |shading| turn(shading.provoking, self.is_gl));
        let triangles = &self.frame.meshes[draw.mesh].triangles;
        let described = self.indices.entry((draw.mesh, turn)).or_insert_with(|| {
            let turned: Vec<[u32; 3]> =
                triangles.iter().map(|t| [t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]]).collect();
            resources.buffer(Buffer::of(&turned, BufferUsages::INDEX))
        });
        (*described, u32::try_from(3 * triangles.len()).unwrap_or(u32::MAX))
    }
}

/// Which of a triangle's vertices has to come first.
const fn turn(provoking: Provoking, hardware_takes_last: bool) -> usize {
    match (provoking, hardware_takes_last) {
        (Provoking::First, false) | (Provoking::Last, true) => 0,
        (Provoking::First, true) => 1,
        (Provoking::Last, false) => 2,
    }
}
