//! Random frames: small, with everything that a frame may name, and zeros and ones among its numbers so that effects come
//! and go.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "small numbers of a small frame"
)]

use lightmeter_scene::blend::{Equation, Factor, State};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::frame::{
    Blend, Cull, Draw, Fog, FogForm, Frame, Light, Material, Mesh, Place, Sampled, Shading, Target, Texture,
    TextureFilter, Textured, Wrap,
};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::shading::{Ambient, Distance, Frequency, LightAmbient, Normals, Specular, SpecularGate, Viewer};
use lightmeter_scene::target::TargetFormat;

/// A stream of numbers from a seed (SplitMix64).
#[derive(Clone, Debug)]
pub struct Numbers(u64);

impl Numbers {
    /// The stream of a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Less than `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// One of several.
    pub fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// True once in `count` times on average.
    pub fn once_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// Between two numbers.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        let unit = (self.next() >> 40) as f32 / (1 << 24) as f32;
        low + unit * (high - low)
    }

    /// A colour, black at times.
    pub fn color(&mut self) -> [f32; 3] {
        if self.once_in(4) { [0.0; 3] } else { std::array::from_fn(|_| self.between(0.0, 1.0)) }
    }

    fn direction(&mut self) -> [f32; 3] {
        loop {
            let v: [f32; 3] = std::array::from_fn(|_| self.between(-1.0, 1.0));
            if v.iter().map(|x| x * x).sum::<f32>() > 0.05 {
                return v;
            }
        }
    }
}

/// A frame of a seed, of 48 × 40 pixels.
#[must_use]
pub fn frame(seed: u64) -> Frame {
    let n = &mut Numbers::new(seed);
    let reversed = n.once_in(4);
    let format = n.of(&[TargetFormat::Rgba32Float, TargetFormat::Rgba8Unorm, TargetFormat::Rgba16Float]);
    let mut frame = Frame {
        target: Target { width: 48, height: 40, format },
        background: [0.1, 0.2, 0.3, 1.0],
        clear_depth: if reversed { 0.0 } else { 1.0 },
        projection: if n.once_in(4) { orthographic(reversed) } else { perspective(reversed) },
        ambient: n.color(),
        ambient_form: n.of(&[Ambient::Product, Ambient::Constant]),
        departures: lightmeter_scene::frame::Departures::default(),
        light_ambient: n.of(&[LightAmbient::Documents, LightAmbient::OpenGl]),
        lights: vec![],
        fog: None,
        meshes: vec![],
        textures: vec![],
        draws: vec![],
    };
    for number in 0..n.below(5) {
        frame.lights.push(light(n, number));
    }
    if n.once_in(2) {
        frame.fog = Some(fog(n));
    }
    frame.textures = (0..2).map(|_| texture(n)).collect();
    for number in 0..=n.below(3) {
        frame.meshes.push(mesh(n));
        let draw = draw(n, number, reversed, format);
        frame.draws.push(draw);
    }
    frame
}

const NEAR: f32 = 0.5;
const FAR: f32 = 20.0;

/// A focal length of 1.5 heights, the depth from 0 to 1 between near and far.
fn perspective(reversed: bool) -> [[f32; 4]; 4] {
    let (a, b) = if reversed {
        (NEAR / (FAR - NEAR), NEAR * FAR / (FAR - NEAR))
    } else {
        (FAR / (NEAR - FAR), NEAR * FAR / (NEAR - FAR))
    };
    [[1.25, 0.0, 0.0, 0.0], [0.0, 1.5, 0.0, 0.0], [0.0, 0.0, a, -1.0], [0.0, 0.0, b, 0.0]]
}

fn orthographic(reversed: bool) -> [[f32; 4]; 4] {
    let (a, b) =
        if reversed { (1.0 / (FAR - NEAR), FAR / (FAR - NEAR)) } else { (1.0 / (NEAR - FAR), NEAR / (NEAR - FAR)) };
    [[0.4, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, a, 0.0], [0.0, 0.0, b, 1.0]]
}

fn light(n: &mut Numbers, number: usize) -> Light {
    let position = [n.between(-4.0, 4.0), n.between(-4.0, 4.0), n.between(-6.0, 2.0)];
    let falloff = n.of(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.1, 0.02]]);
    let place = match n.below(4) {
        0 => Place::Directional { toward: n.direction(), unit: false },
        1 => Place::Directional { toward: n.of(&[[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [0.0, -0.6, 0.8]]), unit: true },
        2 => Place::Point { position, falloff },
        _ => Place::Spot {
            position,
            falloff,
            axis: std::array::from_fn(|k| [0.0, 0.0, -5.0][k] - position[k] + n.between(-1.0, 1.0)),
            cutoff_cosine: n.of(&[0.5, 0.9, 0.98]),
            exponent: n.of(&[0.0, 1.0, 8.0]),
        },
    };
    Light { name: format!("light {number}"), ambient: n.color(), diffuse: n.color(), specular: n.color(), place }
}

fn fog(n: &mut Numbers) -> Fog {
    let density = if n.once_in(4) { 0.0 } else { n.between(0.05, 0.5) };
    let form = match n.below(5) {
        0 => FogForm::Linear { dmin: n.between(1.0, 5.0), dmax: n.between(5.0, 7.0) },
        // Behind everything, and before everything.
        1 => n.of(&[FogForm::Linear { dmin: 50.0, dmax: 60.0 }, FogForm::Linear { dmin: 0.5, dmax: 1.0 }]),
        2 => FogForm::Exp { density },
        3 => FogForm::Exp2Document { density: density * 0.2 },
        _ => FogForm::Exp2OpenGl { density },
    };
    Fog { color: n.color(), form, distance: n.of(&[Distance::Planar, Distance::Radial]) }
}

fn texture(n: &mut Numbers) -> Texture {
    let (width, height) = (1 + n.below(4), 1 + n.below(4));
    let white = n.once_in(3);
    let texels = (0..width * height)
        .map(|_| if white { [1.0; 4] } else { std::array::from_fn(|_| n.below(256) as f32 / 255.0) })
        .collect();
    Texture { width: width as u32, height: height as u32, texels }
}

/// A grid of quads bent into a bowl, or a single large triangle, with every attribute.
fn mesh(n: &mut Numbers) -> Mesh {
    let mut mesh = Mesh::default();
    let side = n.of(&[1, 2, 5]);
    let bend = n.between(-1.0, 1.0);
    for j in 0..=side {
        for i in 0..=side {
            let [x, y] = [i, j].map(|k| 2.0 * k as f32 / side as f32 - 1.0);
            mesh.positions.push([x, y, bend * (x * x + y * y)]);
            mesh.normals.push([-2.0 * bend * x, -2.0 * bend * y, n.of(&[1.0, 0.5, 2.0])]);
            mesh.uvs.push([1.5 * x, 0.5 - 0.5 * y]);
            mesh.lightmap_uvs.push([0.5 + 0.5 * x, 0.5 + 0.5 * y]);
            mesh.colors.push(std::array::from_fn(|_| n.of(&[0.25, 1.0])));
        }
    }
    let row = side as u32 + 1;
    for j in 0..side as u32 {
        for i in 0..side as u32 {
            let a = j * row + i;
            mesh.triangles.extend([[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]);
        }
    }
    if n.once_in(4) {
        mesh.colors.fill([1.0; 4]);
    }
    mesh
}

fn draw(n: &mut Numbers, number: usize, reversed: bool, format: TargetFormat) -> Draw {
    let sampled = |n: &mut Numbers| Sampled {
        texture: n.below(2),
        filter: n.of(&[TextureFilter::Nearest, TextureFilter::Bilinear]),
        wrap: n.of(&[Wrap::Repeat, Wrap::Clamp]),
    };
    let blend = (n.once_in(3) && format != TargetFormat::Rgba32Float).then(|| {
        let factors = [Factor::One, Factor::SrcAlpha, Factor::OneMinusSrcAlpha, Factor::DstColor, Factor::Zero];
        let state =
            State { equation: n.of(&[Equation::Add, Equation::Subtract]), src: n.of(&factors), dst: n.of(&factors) };
        Blend { state: state.into(), constant: [0.5; 4] }
    });
    let nearer = if reversed { Compare::Greater } else { Compare::Less };
    Draw {
        name: format!("draw {number}"),
        mesh: number,
        modelview: modelview(n),
        material: Material {
            emissive: n.color(),
            ambient: n.color(),
            diffuse: n.color(),
            specular: n.color(),
            shininess: n.of(&[1.0, 5.0, 32.0]),
        },
        shading: (!n.once_in(5)).then(|| Shading {
            frequency: n.of(&[Frequency::Flat, Frequency::Gouraud, Frequency::Phong]),
            provoking: n.of(&[Provoking::First, Provoking::Last]),
            specular: n.of(&[Specular::Phong, Specular::Blinn, Specular::BlinnUnnormalised]),
            gate: n.of(&[SpecularGate::Documents, SpecularGate::OpenGl]),
            viewer: n.of(&[Viewer::Local, Viewer::NonLocal]),
            normals: n.of(&[Normals::InverseTranspose, Normals::Modelview]),
        }),
        alpha: n.of(&[1.0, 0.5]),
        vertex_colors: n.once_in(3),
        texture: n.once_in(2).then(|| Textured { sampled: sampled(n), replaces: n.once_in(3) }),
        lightmap: n.once_in(3).then(|| sampled(n)),
        cutout: n.once_in(4).then(|| n.of(&[0.0, 0.3, 0.75])),
        blend,
        depth: (!n.once_in(5)).then(|| DepthTest { compare: nearer, write: !n.once_in(4) }),
        cull: n.of(&[Cull::None, Cull::None, Cull::Back, Cull::Front]),
    }
}

/// Turned, stretched and put before the eye.
fn modelview(n: &mut Numbers) -> [[f32; 4]; 4] {
    let (s, c) = (n.between(-1.2, 1.2), n.between(-1.2, 1.2));
    let (turn, tilt) = (glam::Mat4::from_rotation_y(s), glam::Mat4::from_rotation_x(c));
    let scale = glam::Mat4::from_scale(glam::Vec3::from_array(std::array::from_fn(|_| n.between(0.6, 1.6))));
    let place = glam::Vec3::new(n.between(-1.5, 1.5), n.between(-1.5, 1.5), n.between(-8.0, -3.5));
    (glam::Mat4::from_translation(place) * turn * tilt * scale).to_cols_array_2d()
}
