//! The shading of a small renderer.

/// A point, a direction or a colour.
pub type Vec3 = [f32; 3];

fn zip(a: Vec3, b: Vec3, f: impl Fn(f32, f32) -> f32) -> Vec3 {
    [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])]
}

fn scale(a: Vec3, by: f32) -> Vec3 {
    a.map(|x| x * by)
}

fn dot(a: Vec3, b: Vec3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vector of the same direction and of length 1; the zero vector stays what it is.
pub fn normalize(v: Vec3) -> Vec3 {
    // The largest component first, so that no square overflows or vanishes.
    let largest = v.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
    if largest == 0.0 {
        return v;
    }
    let v = v.map(|x| x / largest);
    v.map(|x| x / dot(v, v).sqrt())
}

/// A ray that meets a mirror.
pub fn reflect(i: Vec3, n: Vec3) -> Vec3 {
    zip(i, n, |i_k, n_k| i_k - 2.0 * dot(i, n) * n_k)
}

/// The unit vector from a point to a light.
pub fn toward(light: Vec3, p: Vec3) -> Vec3 {
    normalize(zip(light, p, |a, b| a - b))
}

/// How light weakens with distance.
pub fn attenuation(kc: f32, kl: f32, kq: f32, d: f32) -> f32 {
    1.0 / (kc + kl * d + kq * d * d)
}

/// The distance of two points.
pub fn distance(a: Vec3, b: Vec3) -> f32 {
    let v = zip(a, b, |a, b| a - b);
    dot(v, v).sqrt()
}

/// What is seen through fog: the share `f` of the surface, and the rest of the fog.
pub fn mix(fog: Vec3, surface: Vec3, f: f32) -> Vec3 {
    zip(fog, surface, |fog, surface| fog * (1.0 - f) + surface * f)
}

/// The share of the surface that is seen through exponential fog.
pub fn fog_exp(density: f32, z: f32) -> f32 {
    (-density * z.abs()).exp().clamp(0.0, 1.0)
}

/// A light's colours, or a surface's.
#[derive(Clone, Copy, Debug)]
pub struct Colors {
    pub ambient: Vec3,
    pub diffuse: Vec3,
    pub specular: Vec3,
}

/// Blinn's lighting of a point in eye space, by a light whose rays travel in one direction.
pub fn blinn(light: Colors, surface: Colors, shininess: f32, p: Vec3, normal: Vec3, travels: Vec3) -> [f32; 4] {
    let (n, l, v) = (normalize(normal), scale(normalize(travels), -1.0), normalize(scale(p, -1.0)));
    // The bug: the half vector is the mean of the two, and it is shorter than 1.
    let h = scale(zip(v, l, |a, b| a + b), 0.5);
    let diffuse = dot(l, n).max(0.0);
    let cosine = dot(n, h);
    let specular = if cosine > 0.0 { cosine.powf(shininess) } else { 0.0 };
    let color = |k: usize| {
        light.ambient[k] * surface.ambient[k]
            + light.diffuse[k] * surface.diffuse[k] * diffuse
            + light.specular[k] * surface.specular[k] * specular
    };
    [color(0), color(1), color(2), 1.0]
}
