//! Reading a texture (002: DIFFUSE × LIGHTMAP; 004).
//!
//! Symbols: `u v` texture coordinates, 0 to 1 across the image from its upper left corner; a texel's middle lies at its
//! whole coordinates plus ½, over the image's size. A texel is found by whole numbers, so beyond 2²⁴ texels from the origin,
//! where an f32 has no fraction, there is nothing to find.

use crate::algebra::{Rgba, Vec2, Vector};
use crate::real::Real;
use lightmeter_scene::frame::{Texture, TextureFilter, Wrap};

/// The texture at (u, v).
pub fn sample<R: Real>(texture: &Texture, filter: TextureFilter, wrap: Wrap, uv: Vec2<R>) -> Rgba<R> {
    match filter {
        TextureFilter::Nearest => nearest(texture, wrap, uv),
        TextureFilter::Bilinear => bilinear(texture, wrap, uv),
    }
}

/// The texel that (u, v) lies in: `i = ⌊u·width⌋`, `j = ⌊v·height⌋`.
pub fn nearest<R: Real>(texture: &Texture, wrap: Wrap, uv: Vec2<R>) -> Rgba<R> {
    let [width, height] = size(texture);
    let (x, y) = (uv.x() * R::literal(width), uv.y() * R::literal(height));
    x.floor_then(|i| y.floor_then(|j| texel(texture, wrap, [i, j])))
}

/// The four texels around, mixed: with `x = u·width − ½`, `i = ⌊x⌋`, `t = x − i` and likewise y, j, s,
/// `mix(mix(c(i,j), c(i+1,j), t), mix(c(i,j+1), c(i+1,j+1), t), s)`.
pub fn bilinear<R: Real>(texture: &Texture, wrap: Wrap, uv: Vec2<R>) -> Rgba<R> {
    let ([width, height], half) = (size(texture), R::literal(0.5));
    let (x, y) = (uv.x() * R::literal(width) - half, uv.y() * R::literal(height) - half);
    // A fraction lies in [0, 1], whichever whole number an interval is taken to be above.
    let fraction = |x: R, whole: f64| (x - R::literal(whole)).clamp(R::literal(0.0), R::literal(1.0));
    x.floor_then(|i| {
        let t = fraction(x, i);
        y.floor_then(|j| {
            let at = |di: f64, dj: f64| texel(texture, wrap, [i + di, j + dj]);
            let (above, below) = (at(0.0, 0.0).mix(at(1.0, 0.0), t), at(0.0, 1.0).mix(at(1.0, 1.0), t));
            above.mix(below, fraction(y, j))
        })
    })
}

fn size(texture: &Texture) -> [f64; 2] {
    [texture.width.into(), texture.height.into()]
}

/// The texel of whole coordinates that may lie beyond the edges.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "wrapped into the texture's size")]
fn texel<R: Real>(texture: &Texture, wrap: Wrap, at: [f64; 2]) -> Rgba<R> {
    let [width, height] = size(texture);
    let within = |i: f64, size: f64| match wrap {
        Wrap::Repeat => i.rem_euclid(size),
        Wrap::Clamp => i.clamp(0.0, size - 1.0),
    } as usize;
    let (i, j) = (within(at[0], width), within(at[1], height));
    Vector(texture.texels[j * texture.width as usize + i].map(R::input))
}
