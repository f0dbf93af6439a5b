//! What each input and output of a formula means: which way a vector points, whether the formula normalises it, in which space a
//! place is, and what each component of a result is.
//!
//! Of several rows for one value the last counts, so that a formula with a convention of its own stands below the general one.

use super::pattern::any_matches;

/// The formulas as patterns between spaces, the names of values between spaces, and what these mean there.
type Row = (&'static str, &'static str, &'static str);

/// What an input means.
///
/// # Panics
/// Where no row has it: a test asks for every input.
#[must_use]
pub(super) fn of_input(id: &str, name: &str) -> &'static str {
    of(INPUTS, id, name)
}

/// What an output means.
///
/// # Panics
/// Where no row has it: a test asks for every output.
#[must_use]
pub(super) fn of_output(id: &str, name: &str) -> &'static str {
    of(OUTPUTS, id, name)
}

fn of(rows: &'static [Row], id: &str, name: &str) -> &'static str {
    let row = rows.iter().rfind(|row| is_for(row, id, name));
    row.unwrap_or_else(|| panic!("`{name}` of {id} has no meaning in meaning.rs")).2
}

fn is_for((ids, names, _): &Row, id: &str, name: &str) -> bool {
    names.split(' ').any(|one| one == name) && any_matches(ids, id)
}

const INPUTS: &[Row] = &[
    // Places, vectors and lights.
    ("*", "p", "surface point in eye space: the eye is at the origin and looks down −z"),
    ("*", "normal", "surface normal; of any length, normalised by the formula"),
    ("*", "n", "surface normal; a unit vector, not normalised by the formula"),
    ("*", "l", "from the surface towards the light; a unit vector, not normalised by the formula"),
    ("*", "v", "from the surface towards the eye; a unit vector, not normalised by the formula"),
    ("*", "i", "the way the light travels, from the light to the surface; not normalised by the formula"),
    (
        "*",
        "direction",
        "the way the light travels, from the light to the surface; of any length, normalised by the formula",
    ),
    ("*", "position", "the light's position in eye space"),
    ("*", "light", "the light's position in eye space"),
    ("*", "axis", "the way the spotlight points, away from the light; a unit vector, not normalised by the formula"),
    ("*", "cutoff_cosine", "cosine of the angle between the cone's axis and its edge"),
    (
        "*",
        "exponent",
        "exponent of the spotlight: the greater it is, the more of the light falls near the axis; 0 or greater",
    ),
    ("*", "kc", "constant coefficient of the attenuation"),
    ("*", "kl", "coefficient of the distance in the attenuation"),
    ("*", "kq", "coefficient of the squared distance in the attenuation"),
    ("*", "t", "place between the first and the second: 0 at the first, 1 at the second"),
    // Lighting.
    ("*", "la", "the light's ambient colour"),
    ("*", "ld", "the light's diffuse colour"),
    ("*", "ls", "the light's specular colour"),
    ("*", "ma", "the material's ambient colour"),
    ("*", "md", "the material's diffuse colour"),
    ("*", "ms", "the material's specular colour"),
    ("*", "shininess", "exponent of the highlight, 0 or greater"),
    ("*", "ka", "the material's ambient coefficient"),
    ("*", "kd", "the material's diffuse coefficient"),
    ("*", "ks", "the material's specular coefficient"),
    (
        "lighting/specular-phong lighting/specular-nonlocal",
        "r",
        "mirrored light, i − 2(i·n)n, in eye space; a unit vector, not normalised by the formula",
    ),
    ("lighting/specular-blinn", "h", "half vector ⟨v + l⟩; a unit vector, not normalised by the formula"),
    (
        "lighting/phong-unit-light lighting/phong-nonlocal",
        "direction",
        "the way the light travels, from the light to the surface, in eye space; a unit vector, not normalised by the formula",
    ),
    (
        "lighting/two-lights",
        "direction",
        "towards light 0, from the surface to the light: not the way it travels; of any length, normalised by the formula",
    ),
    ("lighting/two-lights", "position", "position of light 1 in eye space"),
    ("lighting/two-lights", "color0", "colour of light 0, which is directional"),
    ("lighting/two-lights", "color1", "colour of light 1, which is a point light"),
    ("lighting/two-lights", "ambient", "ambient constant, added once and multiplied by no light"),
    ("lighting/two-lights", "diffuse", "the material's diffuse colour"),
    ("lighting/two-lights", "specular", "the material's specular colour"),
    (
        "lighting/spot",
        "axis",
        "the way the spotlight points, away from the light; of any length, normalised by the formula",
    ),
    ("lighting/point-opengl", "alpha", "alpha of the diffuse material, which becomes the result's"),
    ("lighting/ambient-constant", "ambient", "ambient constant, multiplied by no light"),
    ("lighting/ambient-constant", "diffuse", "diffuse term, CD"),
    ("lighting/sum", "ambient", "ambient term, CA"),
    ("lighting/sum", "emissive", "emissive term, CE"),
    ("lighting/sum", "diffuse0", "diffuse term of the first light, CD"),
    ("lighting/sum", "diffuse1", "diffuse term of the second light, CD"),
    ("lighting/sum", "specular0", "specular term of the first light, CS"),
    ("lighting/sum", "specular1", "specular term of the second light, CS"),
    ("lighting/scalar-material", "ambient_color", "the ambient light's colour"),
    ("lighting/scalar-material", "light_color", "the light's colour, for the diffuse and the specular term"),
    ("lighting/highlight-plastic", "surface", "the surface's colour, which does not change the highlight of plastic"),
    ("lighting/highlight-metal", "surface", "the surface's colour, by which the highlight is multiplied"),
    ("lighting/highlight-*", "fs", "power of the highlight's cosine, FS"),
    ("lighting/gouraud lighting/phong-shading lighting/phong-interpolated", "pa", "the first vertex in eye space"),
    ("lighting/gouraud lighting/phong-shading lighting/phong-interpolated", "pb", "the second vertex in eye space"),
    ("lighting/gouraud", "na", "normal of the first vertex; of any length, normalised by the formula"),
    ("lighting/gouraud", "nb", "normal of the second vertex; of any length, normalised by the formula"),
    (
        "lighting/phong-shading lighting/phong-interpolated",
        "na",
        "normal of the first vertex; of any length, not normalised before it is interpolated",
    ),
    (
        "lighting/phong-shading lighting/phong-interpolated",
        "nb",
        "normal of the second vertex; of any length, not normalised before it is interpolated",
    ),
    ("lighting/flat vector/face-normal*", "a", "first corner of the face, in eye space"),
    ("lighting/flat vector/face-normal*", "b", "second corner of the face, counter-clockwise as seen from its front"),
    ("lighting/flat vector/face-normal*", "c", "third corner of the face, counter-clockwise as seen from its front"),
    (
        "lighting/cosine-power*",
        "a b",
        "one of the two vectors between which the cosine is taken; a unit vector, not normalised by the formula",
    ),
    ("lighting/cosine-power*", "exponent", "exponent of the highlight, 0 or greater"),
    // Attenuation.
    ("attenuation/*", "d", "distance from the surface to the light, 0 or greater"),
    // Vectors.
    (
        "vector/reflect-any-normal",
        "i",
        "the way the light travels, from the light to the surface; of any length, which the result has too",
    ),
    ("vector/reflect-any-normal", "n", "surface normal; of any length, normalised by the formula"),
    (
        "vector/normal-modelview vector/normal-inverse-transpose",
        "n",
        "surface normal in the model's space; not normalised by the formula",
    ),
    ("vector/normal-by-*", "n", "surface normal in the model's space; of any length, since the result is normalised"),
    ("vector/normal-*", "modelview", "upper left 3 × 3 of the modelview matrix, column by column"),
    ("vector/normalize* vector/length*", "v", "any vector"),
    ("vector/light-*", "view", "matrix from world to eye space, column by column"),
    ("vector/light-with-model", "model", "matrix from the model's to world space, column by column"),
    ("vector/light-position", "modelview", "matrix from the space of `position` to eye space, column by column"),
    (
        "vector/light-direction",
        "direction",
        "the light's direction in world space, whichever way it is meant; not normalised by the formula",
    ),
    (
        "vector/light-position",
        "position",
        "the light's position as (x, y, z, w); w = 0 is a light that is infinitely far away",
    ),
    ("vector/light-with-model", "position", "the light's position in the model's space"),
    ("vector/average-normal", "n0 n1 n2", "normal of one of the faces at the vertex; not normalised before the sum"),
    ("vector/interpolated-normal*", "n0", "normal of the first vertex; not normalised before it is interpolated"),
    ("vector/interpolated-normal*", "n1", "normal of the second vertex; not normalised before it is interpolated"),
    ("vector/interpolated-normal", "face", "the face's own normal, which this formula does not use"),
    ("vector/interpolated-normal-guarded", "face", "the face's own normal; of any length, normalised by the formula"),
    // Fog.
    ("fog/*", "dmin", "distance from the eye at which the fog begins"),
    ("fog/*", "dmax", "distance from the eye from which on only fog is seen"),
    ("fog/*", "density", "the fog's density"),
    ("fog/*", "fog", "the fog's colour"),
    ("fog/*", "shaded", "the surface's colour before fog"),
    ("fog/*", "distance", "distance through the fog, 0 or greater"),
    // Colours.
    ("color/* blend/unpremultiply*", "color", "linear colour"),
    ("color/*", "c", "linear component of a colour"),
    ("color/*", "byte", "stored component: a whole number from 0 to 255"),
    ("color/srgb-encode", "c", "linear colour, RGBA"),
    ("color/srgb-decode", "e", "colour of which R, G and B are sRGB-encoded and alpha is linear"),
    ("color/modulate color/replace", "texel", "colour that was read from the texture"),
    ("color/modulate color/replace", "color", "the surface's colour"),
    ("color/sum", "a b", "one of the two colours that are added"),
    ("color/per-vertex", "weights", "barycentric weights of a, b and c, in this order"),
    ("color/per-vertex", "a b c", "colour of the vertex of this name"),
    // Interpolation as arithmetic.
    (
        "interpolation/line interpolation/triangle",
        "weights",
        "barycentric weights of the vertices, in the order of their names",
    ),
    ("interpolation/line interpolation/triangle", "a b c", "attribute of the vertex of this name"),
    ("interpolation/forward-differences", "a", "attribute at the span's first end"),
    ("interpolation/forward-differences", "b", "attribute at the span's second end, which is asked for"),
    ("interpolation/mix*", "a", "attribute at the first end, t = 0"),
    ("interpolation/mix*", "b", "attribute at the second end, t = 1"),
    (
        "interpolation/weights interpolation/last-weight* interpolation/coverage interpolation/front-facing",
        "a b c",
        "corner of the triangle in window coordinates, y down",
    ),
    ("interpolation/edge*", "a", "start of the edge in window coordinates, y down"),
    ("interpolation/edge*", "b", "end of the edge in window coordinates, y down"),
    ("interpolation/*", "p", "point that is asked about, in window coordinates, y down"),
    ("interpolation/scanline", "v1", "vertex at which both edges start, in window coordinates"),
    ("interpolation/scanline", "v2", "vertex at which the edge of Ia and xa ends, in window coordinates"),
    ("interpolation/scanline", "v3", "vertex at which the edge of Ib and xb ends, in window coordinates"),
    ("interpolation/scanline", "i", "attributes I1, I2 and I3 at v1, v2 and v3"),
    (
        "interpolation/perspective interpolation/perspective-scaled",
        "lambda",
        "barycentric weights of the three vertices in screen space",
    ),
    ("interpolation/perspective*", "w", "homogeneous coordinate w of each vertex, greater than 0"),
    ("interpolation/perspective-scaled", "w", "homogeneous coordinate w of each vertex, 0 or greater"),
    ("interpolation/*", "attr", "attribute of each vertex, in their order"),
    (
        "interpolation/perspective-line",
        "t",
        "place along the line as it is seen on the screen: 0 at the first vertex, 1 at the second",
    ),
    ("interpolation/viewport*", "clip", "vertex in clip coordinates (x, y, z, w), y up"),
    ("interpolation/clip-volume*", "clip", "vertex in clip coordinates (x, y, z, w)"),
    ("interpolation/viewport", "origin", "upper left corner (ox, oy) of the viewport; window coordinates have y down"),
    (
        "interpolation/viewport-opengl",
        "origin",
        "lower left corner (ox, oy) of the viewport; window coordinates have y up",
    ),
    ("interpolation/viewport*", "size", "width and height (sx, sy) of the viewport"),
    ("interpolation/viewport*", "depth", "depths (near, far) that the near and the far plane are taken to"),
    ("interpolation/frag-depth interpolation/raster-frag-depth", "depth", "depth that the fragment writes"),
    // The rasteriser.
    (
        "interpolation/raster-* interpolation/cull-* depth/same-geometry-*",
        "a b c",
        "vertex in clip coordinates (x, y, z, w): y up, z from 0 at the near plane to w at the far plane",
    ),
    (
        "interpolation/raster-top-left interpolation/raster-shared-edge",
        "a b c d",
        "corner in window coordinates, y down; the triangles are a b c and a c d",
    ),
    ("interpolation/raster-line", "attr_a", "attribute of the vertex a"),
    ("interpolation/raster-line", "attr_b", "attribute of the vertex b"),
    ("interpolation/raster-attributes", "attr", "attributes of a, b and c, in this order"),
    (
        "interpolation/raster-position interpolation/raster-facing interpolation/raster-clip interpolation/cull-* depth/same-geometry-*",
        "attr",
        "attributes of a, b and c, which do not change the answer",
    ),
    (
        "interpolation/raster-flat-*",
        "a0 a1 a2 a3 a4 a5",
        "attribute of the vertex of this number, counted from 0 in the order of the stream",
    ),
    ("interpolation/raster-flat-*", "primitive", "number of the primitive that is asked about, counted from 0"),
    (
        "interpolation/* depth/same-geometry-*",
        "pixel",
        "column and row of the pixel that is asked about, from the upper left corner, whole numbers; its centre lies half a pixel further right and down",
    ),
    (
        "interpolation/raster-facing interpolation/raster-frag-depth interpolation/raster-flat-*",
        "pixel",
        "column and row of a pixel that the primitive covers, from the upper left corner, whole numbers; which pixel does not change the answer",
    ),
    (
        "interpolation/cull-*",
        "pixel",
        "column and row of a pixel that the triangle covers unless it is culled, from the upper left corner, whole numbers",
    ),
    // Depth.
    ("depth/test/*", "new", "depth of the fragment that is drawn"),
    ("depth/test/*", "old", "depth that is there"),
    ("depth/recovered* depth/stored*", "near", "distance n of the near plane from the eye"),
    ("depth/recovered* depth/stored*", "far", "distance f of the far plane from the eye"),
    (
        "depth/recovered* depth/stored*",
        "z",
        "distance from the eye along its line of sight, positive, from near to far",
    ),
    // Blending.
    ("blend/*", "src", "colour that is drawn, (Cs, As), with straight alpha"),
    ("blend/*", "dst", "colour that is there, (Cd, Ad)"),
    ("blend/*", "constant", "blend constant, (Cc, Ac)"),
    ("blend/write-mask/*", "constant", "blend constant, which this state does not use"),
    (
        "blend/mode-* blend/without-alpha/* blend/over blend/over-incremental",
        "dst",
        "colour that is there, Cd, on a target without alpha",
    ),
    ("blend/layers/*", "count", "number n of the layers that are drawn: a whole number from 1 to 16"),
    (
        "blend/layers/*",
        "src-1 src-2 src-3 src-4 src-5 src-6 src-7 src-8 src-9 src-10 src-11 src-12 src-13 src-14 src-15 src-16",
        "colour of the layer of this number, with straight alpha; drawn only where the number is at most n",
    ),
    ("blend/opacity-of-layers*", "alpha", "alpha of each layer, α"),
    ("blend/opacity-of-layers*", "layers", "number of the layers, n"),
    ("blend/unpremultiply*", "color", "colour that has been multiplied by alpha"),
    ("blend/unpremultiply*", "alpha", "the colour's alpha, α"),
    ("blend/subtract-*", "src", "component of the colour that is drawn"),
    ("blend/subtract-*", "dst", "component of the colour that is there"),
    ("blend/subtract-*", "s", "factor S of the colour that is drawn"),
    ("blend/subtract-*", "d", "factor D of the colour that is there"),
];

const OUTPUTS: &[Row] = &[
    ("interpolation/*", "attr", "interpolated attribute"),
    ("interpolation/raster-flat-*", "attr", "attribute that the primitive has"),
    ("interpolation/flat-*", "attr", "attribute that the triangle has"),
    ("interpolation/weights", "lambda", "barycentric weights of a, b and c, in this order"),
    (
        "interpolation/coverage interpolation/raster-clip interpolation/cull-*",
        "covered",
        "1 where it is covered, else 0",
    ),
    ("interpolation/viewport", "window", "x and y in pixels, y down, and depth"),
    ("interpolation/viewport-opengl", "window", "x and y in pixels, y up, and depth"),
    ("interpolation/clip-volume*", "inside", "1 inside the volume, else 0"),
    ("interpolation/front-facing interpolation/raster-facing", "front", "1 where the front is seen, else 0"),
    ("interpolation/frag-depth interpolation/raster-frag-depth", "depth", "depth that is stored"),
    ("interpolation/raster-*", "perspective", "the attribute interpolated with the perspective, Σ λa/w / Σ λ/w"),
    ("interpolation/raster-*", "linear", "the attribute interpolated linearly in screen space, Σ λa"),
    (
        "interpolation/raster-position",
        "position",
        "x and y of the pixel's centre from the upper left corner, depth, and 1/w interpolated linearly in screen space",
    ),
    ("interpolation/raster-*", "count", "how many of the two triangles cover the pixel: 0, 1 or 2"),
    ("interpolation/edge*", "edge", "twice the signed area of the triangle a b p"),
    ("interpolation/last-weight*", "gamma", "barycentric weight of c"),
    ("color/to-unorm8", "byte", "stored component: a whole number from 0 to 255"),
    ("color/from-unorm8", "c", "linear component of a colour"),
    ("color/*", "e", "encoded component of a colour"),
    ("color/*", "color", "resulting colour"),
    ("color/srgb-encode", "color", "colour of which R, G and B are sRGB-encoded and alpha is linear"),
    ("color/srgb-decode", "color", "linear colour, RGBA"),
    ("vector/*", "r", "mirrored light, away from the surface"),
    ("vector/halfway vector/halfway-unguarded", "h", "half vector; a unit vector"),
    ("vector/halfway-unnormalised", "h", "half vector of document 000, v + l; not a unit vector"),
    ("vector/normalize*", "v", "unit vector of the same direction"),
    ("vector/normal-*", "n", "normal in eye space; not a unit vector"),
    ("vector/normal-by-*", "n", "normal in eye space; a unit vector"),
    ("vector/average-normal", "n", "normal of the vertex; a unit vector"),
    ("vector/interpolated-normal*", "n", "normal at the point; a unit vector"),
    (
        "vector/face-normal*",
        "n",
        "normal of the face, on the side from which its corners run counter-clockwise; a unit vector",
    ),
    ("vector/light-direction", "direction", "the same direction in eye space; not normalised"),
    ("vector/light-*", "p", "the light's position in eye space"),
    ("vector/toward", "l", "from the surface point towards the light; a unit vector"),
    ("vector/length*", "length", "length of the vector"),
    ("lighting/*", "color", "lit colour, RGBA; not clamped, and alpha is 1"),
    (
        "lighting/two-lights",
        "color",
        "lit colour, RGBA; not clamped, and alpha is summed as the other components are, so that it may exceed 1",
    ),
    ("lighting/point-opengl", "color", "lit colour, RGBA; not clamped, and alpha is the input `alpha`"),
    (
        "lighting/ambient lighting/ambient-constant lighting/diffuse-* lighting/specular-* lighting/highlight-* lighting/sum",
        "color",
        "colour of the term or of the sum, RGB; not clamped",
    ),
    (
        "lighting/*",
        "intensity",
        "I = kd·max(l·n, 0) + ks·max(r·v, 0)^shininess under a white point light without attenuation; not clamped",
    ),
    (
        "lighting/gouraud",
        "intensity",
        "mix of the two vertices' I = kd·max(l·n, 0) + ks·max(r·v, 0)^shininess under a white point light without attenuation; not clamped",
    ),
    ("lighting/cosine-power*", "fs", "power of the cosine, FS"),
    ("attenuation/*", "atten", "factor by which the light is multiplied; may exceed 1"),
    ("attenuation/*", "spot", "factor by which the light is multiplied: 0 outside the cone"),
    ("fog/*", "f", "share of the surface's own colour: 1 where the air is clear, 0 where only fog is seen"),
    ("fog/*", "color", "colour after fog"),
    ("fog/*", "opacity", "share of the fog's colour, 1 − f"),
    ("depth/*", "seen", "1 where the fragment that was there stays, 2 where the new one is seen"),
    ("depth/same-geometry-*", "seen", "1 where the triangle's first drawing stays, 2 where its second is seen"),
    ("depth/test/*", "depth", "depth that is left"),
    ("depth/stored*", "depth", "depth that is stored, 0 to 1 for z between the planes"),
    ("depth/recovered*", "z", "distance that is read back from depth"),
    ("blend/*", "color", "colour that is left, RGBA"),
    (
        "blend/mode-* blend/without-alpha/* blend/over blend/over-incremental",
        "color",
        "colour that is left, RGB: the target has no alpha",
    ),
    ("blend/unpremultiply*", "color", "colour with straight alpha"),
    ("blend/subtract-*", "color", "component of the colour that is left"),
    ("blend/opacity-of-layers*", "opacity", "share of what lies behind that n layers hide"),
];

#[cfg(test)]
mod tests {
    use super::{INPUTS, OUTPUTS, Row, is_for};
    use crate::cases::blend::Samples;
    use crate::cases::{Spec, all};
    use std::collections::BTreeSet;

    /// Every value has a meaning, and every row is what some value means: of another meaning than the row that it stands below.
    fn hold(rows: &[Row], specs: &[Spec], names: impl Fn(&Spec) -> Vec<&'static str>) {
        let mut used = BTreeSet::new();
        for spec in specs {
            for name in names(spec) {
                let matching: Vec<usize> = (0..rows.len()).filter(|&k| is_for(&rows[k], &spec.id, name)).collect();
                assert!(!matching.is_empty(), "`{name}` of {} has no meaning", spec.id);
                for pair in matching.windows(2) {
                    assert_ne!(rows[pair[0]].2, rows[pair[1]].2, "`{name}` of {} is said twice", spec.id);
                }
                used.extend(matching.last().map(|&k| (k, name)));
            }
        }
        for (k, (ids, names, means)) in rows.iter().enumerate() {
            assert!(!means.is_empty() && !means.ends_with('.'), "{ids}, {names}");
            for name in names.split(' ') {
                assert!(used.contains(&(k, name)), "nothing is called `{name}` of {ids}: {means}");
            }
        }
    }

    #[test]
    fn every_value_has_a_meaning_and_every_meaning_a_value() {
        let specs: Vec<Spec> = all(&Samples::default()).iter().map(|formula| formula.spec()).collect();
        hold(INPUTS, &specs, |spec| spec.inputs.iter().map(|input| input.name).collect());
        hold(OUTPUTS, &specs, |spec| spec.outputs.iter().map(|output| output.name).collect());
    }

    #[test]
    fn a_convention_of_its_own_counts_more_than_the_general_one() {
        assert!(super::of_input("lighting/phong", "direction").starts_with("the way the light travels"));
        assert!(super::of_input("lighting/two-lights", "direction").starts_with("towards light 0"));
    }
}
