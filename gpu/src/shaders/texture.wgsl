// Reading textures with an arithmetic of one's own: no specification bounds a sampler's.
// u and v run right and down from the image's upper left corner, 0 to 1; texels are the middles of squares.

// The texel again beyond an edge, by Euclidean division; or the texel at the edge. A negative i is counted from the other end, since
// naga 30 passes % to GLSL and to SPIR-V, which leave it open for negative operands (wgpu's pull requests 9674 and 9687).
fn texture_wrap(i: i32, size: i32, clamps: bool) -> i32 {
    let repeated = select(i % size, size - 1 - (-1 - i) % size, i < 0);
    return select(repeated, clamp(i, 0, size - 1), clamps);
}

fn texture_texel(image: texture_2d<f32>, x: i32, y: i32, clamps: bool) -> vec4f {
    let size = vec2i(textureDimensions(image));
    return textureLoad(image, vec2i(texture_wrap(x, size.x, clamps), texture_wrap(y, size.y, clamps)), 0);
}

fn texture_mix(c00: vec4f, c10: vec4f, c01: vec4f, c11: vec4f, t: vec2f) -> vec4f {
    return mix(mix(c00, c10, t.x), mix(c01, c11, t.x), t.y);
}

fn texture_nearest(image: texture_2d<f32>, uv: vec2f, clamps: bool) -> vec4f {
    let i = vec2i(floor(uv * vec2f(textureDimensions(image))));
    return texture_texel(image, i.x, i.y, clamps);
}

fn texture_bilinear(image: texture_2d<f32>, uv: vec2f, clamps: bool) -> vec4f {
    let x = uv * vec2f(textureDimensions(image)) - 0.5;
    let low = floor(x);
    let i = vec2i(low);
    let c00 = texture_texel(image, i.x, i.y, clamps);
    let c10 = texture_texel(image, i.x + 1, i.y, clamps);
    let c01 = texture_texel(image, i.x, i.y + 1, clamps);
    let c11 = texture_texel(image, i.x + 1, i.y + 1, clamps);
    return texture_mix(c00, c10, c01, c11, x - low);
}
