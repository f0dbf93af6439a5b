//! The rules that the formulas on a line do not state: divisors of 0, vectors of length 0, edges and ties, what is clamped, and what
//! names in an id mean.

use super::pattern::any_matches;

/// The rules of a formula, in the order in which they are told.
#[must_use]
pub(super) fn of(id: &str) -> Vec<&'static str> {
    RULES.iter().filter(|(ids, _)| any_matches(ids, id)).map(|&(_, rule)| rule).collect()
}

/// The blend states that a factor is part of, between spaces, and what it is.
macro_rules! factor {
    ($name:literal, $is:literal) => {
        (
            concat!(
                "blend/add/",
                $name,
                "/* blend/add/*/",
                $name,
                " blend/*subtract/",
                $name,
                "/* blend/*subtract/*/",
                $name,
                " blend/*.",
                $name,
                ".* blend/*.",
                $name,
                "/* blend/*.",
                $name
            ),
            concat!($name, " is ", $is),
        )
    };
}

/// The formulas as patterns between spaces, and a rule of theirs.
const RULES: &[(&str, &str)] = &[
    // Interpolation as arithmetic.
    (
        "interpolation/line interpolation/triangle color/per-vertex",
        "the weights are taken as they are, whatever their sum is",
    ),
    ("interpolation/triangle", "a weight of 0 takes nothing of its vertex, however great the attribute is"),
    ("interpolation/weights", "the vertices may run either way round; outside the triangle some weights are below 0"),
    (
        "interpolation/weights interpolation/last-weight*",
        "(x y z) is the area (y − x) × (z − x), the sides taken from the first letter: from another vertex they round otherwise; of a triangle without area nothing is promised",
    ),
    (
        "interpolation/weights",
        "λ = ((b c p), (c a p), (a b p))/(a b c): the divisor is the triangle's own area, not the sum of the three",
    ),
    (
        "interpolation/scanline",
        "Ia and xa lie on the edge v1 v2, Ib and xb on the edge v1 v3, all at the height of p: Ia = (I1(p.y − v2.y) + I2(v1.y − p.y))/(v1.y − v2.y), and so on",
    ),
    ("interpolation/scanline", "where v1.y = v2.y, v1.y = v3.y or xa = xb nothing is promised"),
    (
        "interpolation/forward-differences",
        "the step is computed once and added 16 times; the roundings of these additions, in any order, are legal",
    ),
    (
        "interpolation/perspective interpolation/perspective-line",
        "where a w is 0, or so small that 1/w overflows, nothing is promised; equal w give what linear interpolation gives",
    ),
    (
        "interpolation/perspective-scaled",
        "w_min is the least of the three w, and a vertex whose w is w_min has q = λ: where a w is 0, only the vertices of w = 0 count",
    ),
    ("interpolation/perspective-scaled", "where the weights of the vertices that count are 0 nothing is promised"),
    (
        "interpolation/mix",
        "t = 0 gives a and t = 1 gives b, to the last bit; no other form of it is the same: neither b − (1 − t)(b − a) nor a shading language's mix, which may be a + t(b − a) and is so on many drivers",
    ),
    (
        "interpolation/edge",
        "the sides are taken from a, the first vertex: from another one they round otherwise, and where p lies near the line that shows",
    ),
    (
        "interpolation/edge*",
        "0 where p lies on the line through a and b; positive where a, b, p run clockwise as seen, y being down",
    ),
    ("interpolation/coverage", "the vertices may run either way round"),
    (
        "interpolation/coverage interpolation/raster-top-left",
        "a left edge is one that is not level and has the inside to its right; a top edge is level and has the inside below it; a point on another edge is not covered, and a corner only where both its edges are top or left ones",
    ),
    ("interpolation/coverage", "a triangle without area covers nothing"),
    (
        "interpolation/viewport*",
        "x, y, z and w are those of `clip`; nothing is clamped; a negative w divides as any other, and where w = 0 nothing is promised",
    ),
    ("interpolation/clip-volume*", "the planes belong to the volume; a vertex of w < 0 lies outside"),
    (
        "interpolation/front-facing interpolation/raster-facing",
        "counter-clockwise is as it is seen on the screen, on which y points down; a triangle without area does not face front",
    ),
    (
        "interpolation/front-facing",
        "the sides are taken from a, the first vertex: from another one they round otherwise, which shows where the triangle has next to no area",
    ),
    // The rasteriser.
    (
        "interpolation/raster-* interpolation/cull-* depth/same-geometry-*",
        "the target is 256 pixels wide and high, the viewport is all of it, depth goes from 0 to 1, and one sample lies at each pixel's centre",
    ),
    (
        "interpolation/raster-attributes interpolation/raster-position interpolation/raster-line interpolation/raster-facing interpolation/raster-clip interpolation/raster-shared-edge interpolation/cull-*",
        "positions may be moved to a grid of subpixels: what follows from moving each vertex by less than one step of it, in x and in y, is legal",
    ),
    ("interpolation/raster-attributes interpolation/raster-position", "the answer is that at the pixel's centre"),
    (
        "interpolation/raster-line",
        "the answer is that at the point of the line which is nearest to the pixel's centre, and those up to half a pixel off in x and in y are legal too",
    ),
    (
        "interpolation/raster-clip",
        "vertices may lie outside the volume −w ≤ x, y ≤ w and 0 ≤ z ≤ w, behind the eye too: what lies within it is drawn, and nothing is culled",
    ),
    (
        "interpolation/cull-*",
        "a face is front where its vertices run as the formula says, as seen on the screen; every other one is back",
    ),
    ("interpolation/raster-top-left interpolation/raster-shared-edge", "nothing is culled"),
    (
        "interpolation/raster-shared-edge",
        "of a pixel whose centre lies nearly on the outline of the two triangles 0, 1 and 2 are legal",
    ),
    ("interpolation/raster-flat-points-*", "primitive m has the vertex m alone"),
    ("interpolation/raster-flat-line-list-*", "primitive m has the vertices 2m and 2m + 1"),
    ("interpolation/raster-flat-line-strip-*", "primitive m has the vertices m and m + 1"),
    ("interpolation/raster-flat-triangle-list-*", "primitive m has the vertices 3m, 3m + 1 and 3m + 2"),
    ("interpolation/raster-flat-triangle-strip-*", "primitive m has the vertices m, m + 1 and m + 2"),
    ("interpolation/raster-flat-*-first", "the provoking vertex is the first of these"),
    ("interpolation/raster-flat-*-last", "the provoking vertex is the last of these"),
    // Colours.
    (
        "color/to-unorm8",
        "at a tie, 255·c halfway between two whole numbers, either is legal; one that is near enough to a tie for the rounding of 255·c counts as one",
    ),
    (
        "color/to-unorm8",
        "the product is rounded in one step: ⌊255·c + ½⌋ rounds the sum as well, and takes the number right below ½ for 1",
    ),
    (
        "color/srgb-encode color/srgb-encode-component",
        "c is not clamped: below 0 the straight piece goes on, above 1 the power does; where the two pieces meet either is legal",
    ),
    (
        "color/srgb-decode",
        "e is not clamped: below 0 the straight piece goes on, above 1 the power does; where the two pieces meet either is legal",
    ),
    ("color/srgb-encode-power color/gamma-encode", "for c ≤ 0 nothing is promised"),
    ("color/modulate", "all four components are multiplied; nothing is clamped"),
    ("color/replace", "all four components are the texel's, alpha too"),
    ("color/uniform color/per-vertex", "alpha is 1"),
    // Vectors.
    (
        "vector/normalize vector/toward vector/average-normal vector/face-normal vector/halfway vector/interpolated-normal vector/normal-by-determinant",
        "⟨x⟩ is x/|x|, and 0 for the zero vector: no NaN",
    ),
    (
        "vector/normalize vector/toward vector/average-normal vector/face-normal vector/halfway vector/interpolated-normal vector/normal-by-determinant vector/normalize-unguarded vector/halfway-unguarded",
        "where the square of a vector's length overflows, or is below 2⁻¹²⁶ though the vector is not zero, nothing is promised",
    ),
    (
        "vector/normalize-scaled vector/length-scaled vector/reflect-any-normal vector/normal-by-cofactors vector/face-normal-compensated",
        "a vector is scaled by a power of two before it is squared, so that any is right whose largest component is a normal number, 2⁻¹²⁶ or greater; the length of the zero vector is 0, and so is that vector normalised",
    ),
    ("vector/normalize-unguarded", "of the zero vector nothing is promised"),
    (
        "vector/length",
        "where the square of the length overflows or is below 2⁻¹²⁶ nothing is promised: of the zero vector neither",
    ),
    (
        "vector/reflect vector/reflect-toward",
        "a normal that is not of length 1 is taken as it is: the result's length is then another one",
    ),
    ("vector/reflect vector/reflect-any-normal", "with a normal of length 0 the result is i"),
    ("vector/reflect-toward", "with a normal of length 0 the result is −l"),
    ("vector/halfway", "where v = −l the result is 0"),
    ("vector/halfway-unguarded", "where v = −l nothing is promised"),
    ("vector/toward", "where the light is at the surface point the result is 0"),
    (
        "vector/face-normal lighting/flat",
        "the sides are taken from a, the first vertex: from another one they round otherwise",
    ),
    ("vector/average-normal", "where the normals cancel the result is 0"),
    ("vector/face-normal vector/face-normal-compensated", "of three points on a line the result is 0"),
    (
        "vector/normal-inverse-transpose vector/normal-by-determinant",
        "a matrix that mirrors has a negative determinant, by which the cofactors are divided as by any other; where the determinant is 0 nothing is promised",
    ),
    (
        "vector/normal-by-cofactors",
        "the cofactors' direction is turned round where the determinant is below 0; where it is 0 it is not",
    ),
    (
        "vector/normal-by-cofactors",
        "cofactorᵢ is the cross product of the two other columns, in cyclic order; column i is multiplied by sᵢ, and the normal's component nᵢ too; n may have any length: it is brought near 1 by a power of two before and after",
    ),
    ("vector/light-direction", "the matrix's translation does not count; x, y and z are the result"),
    ("vector/light-position", "a negative w divides as any other"),
    ("vector/light-with-model", "x, y and z are the result, not divided by w"),
    ("vector/interpolated-normal", "where nothing is left of the mix the result is 0"),
    (
        "vector/interpolated-normal-guarded",
        "the face's normal, normalised like any other as x/|x|, where |mix|² < 2⁻²⁰; 0 where that is the zero vector",
    ),
    // Lighting.
    ("lighting/diffuse-*", "l·n below 0 gives 0"),
    (
        "lighting/specular-* lighting/cosine-power lighting/cosine-power-by-chord lighting/phong lighting/blinn lighting/blinn-unnormalised lighting/phong-gated lighting/phong-unit-light lighting/phong-nonlocal lighting/point-* lighting/spot lighting/scalar-material lighting/two-lights lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat lighting/blinn-stable",
        "max(c, 0)^S is 0 for c ≤ 0 and S > 0, and 1 for c > 0 and S = 0; for c ≤ 0 and S = 0 both 0 and 1 are legal",
    ),
    (
        "lighting/diffuse-* lighting/specular-* lighting/cosine-power lighting/cosine-power-unguarded lighting/phong lighting/blinn lighting/blinn-unnormalised lighting/phong-gated lighting/phong-unit-light lighting/phong-nonlocal lighting/point-* lighting/spot lighting/scalar-material lighting/two-lights lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "a cosine above 1 is not clamped",
    ),
    ("lighting/cosine-power-unguarded", "for a·b ≤ 0 nothing is promised"),
    ("lighting/cosine-power-by-chord", "for exponents of 64 and below, and where q ≥ ½, it is max(a·b, 0)^exponent"),
    (
        "lighting/cosine-power-by-chord lighting/blinn-stable attenuation/spot-exponent-by-chord",
        "ln(1 − q) is computed without forming 1 − q, as log1p(−q): that is what keeps the digits of a small q",
    ),
    (
        "attenuation/spot-exponent-by-chord",
        "for exponents of 64 and below, and where q ≥ ½, it is max(−l·axis, 0)^e within the cone",
    ),
    (
        "lighting/blinn-stable",
        "vectors are scaled by a power of two before they are normalised, and the highlight is lighting/cosine-power-by-chord of n and h",
    ),
    (
        "lighting/phong lighting/phong-gated lighting/point-phong lighting/spot lighting/scalar-material lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "n, l and v are the unit vectors of the normal, towards the light and towards the eye; r = i − 2(i·n)n with i = −l",
    ),
    (
        "lighting/phong-unit-light",
        "n and v are the unit vectors of the normal and towards the eye, and l = −direction as it is; r = i − 2(i·n)n with i = −l",
    ),
    ("lighting/phong-nonlocal", "n is the unit vector of the normal, and l = −direction; r = i − 2(i·n)n with i = −l"),
    (
        "lighting/blinn lighting/point-blinn lighting/point-opengl lighting/two-lights lighting/blinn-stable",
        "n, l and v are the unit vectors of the normal, towards the light and towards the eye; h = ⟨v + l⟩, and 0 where v = −l",
    ),
    (
        "lighting/blinn-unnormalised",
        "n, l and v are the unit vectors of the normal, towards the light and towards the eye; n·h may exceed 1",
    ),
    (
        "lighting/phong lighting/blinn lighting/blinn-unnormalised lighting/phong-gated lighting/phong-unit-light lighting/phong-nonlocal lighting/point-* lighting/spot lighting/scalar-material lighting/two-lights lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat lighting/blinn-stable",
        "the zero vector is normalised to 0, not to NaN and not to a direction of its own: a normal or a light vector of length 0 has l·n = 0",
    ),
    (
        "lighting/phong lighting/blinn lighting/blinn-unnormalised lighting/phong-gated lighting/phong-unit-light lighting/phong-nonlocal lighting/point-* lighting/spot lighting/scalar-material lighting/two-lights lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "where the normal, the vector to the light or the vector to the eye has length 0, the highlight may also be anything from there to 0: what normalize gives for such a vector is open in shading languages, and max makes 0 of NaN",
    ),
    (
        "lighting/phong lighting/phong-unit-light lighting/phong-nonlocal lighting/point-phong lighting/spot lighting/scalar-material lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "with a normal of length 0, r is i: the highlight is that of light which goes straight on",
    ),
    (
        "lighting/phong lighting/phong-gated lighting/phong-unit-light lighting/scalar-material lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "with a light or a view vector of length 0, r·v is 0",
    ),
    ("lighting/point-phong lighting/spot", "with a view vector of length 0, r·v is 0"),
    (
        "lighting/blinn lighting/blinn-unnormalised lighting/two-lights",
        "with a light vector of length 0, h is v: there is a highlight without a light",
    ),
    (
        "lighting/blinn lighting/blinn-unnormalised lighting/blinn-stable lighting/point-blinn lighting/point-opengl lighting/two-lights",
        "with a view vector of length 0, h is l; with a normal of length 0, n·h is 0",
    ),
    (
        "lighting/phong lighting/blinn lighting/blinn-unnormalised lighting/phong-unit-light lighting/phong-nonlocal lighting/point-phong lighting/point-blinn lighting/spot lighting/scalar-material lighting/two-lights lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "the highlight is computed where l·n ≤ 0 too",
    ),
    (
        "lighting/phong lighting/blinn lighting/blinn-unnormalised lighting/phong-gated lighting/phong-unit-light lighting/phong-nonlocal lighting/point-* lighting/spot lighting/scalar-material lighting/two-lights lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "where the square of the length of a vector that is normalised overflows, or is below 2⁻¹²⁶ but not 0, nothing is promised",
    ),
    ("lighting/phong-gated lighting/point-opengl lighting/blinn-stable", "l·n = 0 has no highlight"),
    ("lighting/point-opengl", "the highlight is Blinn's"),
    (
        "lighting/point-* lighting/spot",
        "atten = 1/(kc + kl·d + kq·d²) with d = |position − p|; where that divisor is 0, or the light is at p, nothing is promised of what it multiplies",
    ),
    ("lighting/spot", "the highlight is Phong's, l = ⟨position − p⟩"),
    (
        "lighting/spot attenuation/spot-*",
        "the cone is where −l·axis ≥ cutoff_cosine: its edge belongs to it; with a cutoff_cosine of −1 that is everything for unit vectors, but of vectors a little too long −l·axis may be below −1, which lies outside",
    ),
    (
        "lighting/spot attenuation/spot-exponent*",
        "with an exponent of 0 the whole cone has 1, where −l·axis ≤ 0 too; with one above 0 spot is 0 where −l·axis ≤ 0",
    ),
    ("lighting/spot", "an axis of length 0 has −l·axis = 0 everywhere, and the cone may be dark"),
    (
        "lighting/scalar-material lighting/two-lights lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "lights are not attenuated",
    ),
    ("lighting/scalar-material", "n as an exponent is `shininess`; l = ⟨position − p⟩"),
    ("lighting/two-lights", "the sum is over light 0, directional, and light 1, a point light at `position`"),
    (
        "lighting/gouraud lighting/phong-shading lighting/phong-interpolated lighting/flat",
        "l points from the point to `position`, v from the point to the eye at the origin",
    ),
    ("lighting/gouraud", "I(a) and I(b) are computed at pa and pb and may be above 1 before they are mixed"),
    ("lighting/phong-shading", "where nothing is left of the mixed normals the normal is 0"),
    (
        "lighting/phong-interpolated",
        "l is position − pa and position − pb mixed, or position − mix(pa, pb, t), and v is −pa and −pb mixed; none is normalised before it is mixed",
    ),
    ("lighting/flat", "a face without area has the normal 0"),
    (
        "lighting/ambient* lighting/diffuse-* lighting/specular-* lighting/sum lighting/highlight-* lighting/phong lighting/phong-gated lighting/phong-unit-light lighting/phong-nonlocal lighting/blinn* lighting/point-* lighting/spot lighting/scalar-material lighting/two-lights",
        "* between colours is by component; nothing is clamped",
    ),
    // Attenuation.
    ("attenuation/polynomial attenuation/polynomial-expanded", "at d = 0 it is 1/kc"),
    (
        "attenuation/polynomial attenuation/polynomial-expanded attenuation/point attenuation/square",
        "where the divisor is 0, or d² overflows, nothing is promised",
    ),
    ("attenuation/point", "where the light is at p, or nearer than 2⁻⁶³, nothing is promised"),
    ("attenuation/constant", "1 at every distance"),
    ("attenuation/linear attenuation/square", "at d = 0 nothing is promised"),
    (
        "attenuation/polynomial-bounded attenuation/point-scaled",
        "without any coefficient, or at d = 0 without kc, it is 2¹²⁶: the divisor is clamped to at least 2⁻¹²⁶ and at most 2¹²⁶",
    ),
    ("attenuation/spot-*", "outside the cone it is 0"),
    // Fog.
    (
        "fog/linear* fog/exp*",
        "mix is fog(1 − f) + shaded·f or fog + f(shaded − fog), whose roundings are both legal; shaded − (1 − f)(shaded − fog) rounds otherwise; colours are not clamped",
    ),
    (
        "fog/linear fog/linear-radial",
        "the ramp is counted from dmax: 1 − (distance − dmin)/(dmax − dmin) rounds otherwise",
    ),
    ("fog/linear fog/linear-radial", "where dmin = dmax it is a step: f = 1 nearer than dmax, and 0 from there on"),
    (
        "fog/linear fog/linear-radial",
        "where dmax < dmin the same formula turns the fog round: only fog up to dmax, clear from dmin on",
    ),
    ("fog/linear-multiply-add", "where dmin = dmax nothing is promised"),
    (
        "fog/linear fog/linear-multiply-add fog/exp fog/exp2-document fog/exp2-document-square fog/exp2-opengl fog/exp2-opengl-squares",
        "the distance is |p.z|, in front of the eye and behind it",
    ),
    (
        "fog/linear-radial fog/exp-radial fog/exp2-document-radial fog/exp2-opengl-radial",
        "the distance is |p|; where its square overflows or is below 2⁻¹²⁶ nothing is promised: at the eye neither",
    ),
    (
        "fog/exp-radial-scaled",
        "the distance is |p|, with p scaled by a power of two before it is squared, so that it is right where its largest component is a normal number",
    ),
    ("fog/exp*", "a density of 0 is no fog, f = 1; far away f may underflow to 0"),
    (
        "fog/exp fog/exp-radial fog/exp-radial-scaled fog/exp2-document*",
        "f is clamped, so that with a negative density it is 1",
    ),
    ("fog/exp2-opengl*", "the sign of the density does not matter, since it is squared"),
    ("fog/linear* fog/exp*", "color = mix(fog, shaded, f) = fog·(1 − f) + shaded·f"),
    ("fog/exp2-document-square fog/exp2-opengl-squares", "where a square overflows nothing is promised"),
    ("fog/opacity*", "0 where the density or the distance is 0; not clamped"),
    // Depth.
    (
        "depth/test/*",
        "both depths are clamped to [0, 1] before they are compared and before one is stored: depths beyond an end are equal to it",
    ),
    (
        "depth/stored",
        "depth is 0 at the near plane and 1 at the far plane, for a viewer at the origin; z is a distance and so above 0",
    ),
    (
        "depth/stored-reversed",
        "depth is 1 at the near plane and 0 at the far plane, for a viewer at the origin; z is a distance and so above 0",
    ),
    (
        "depth/stored depth/stored-reversed depth/recovered depth/recovered-reversed",
        "the form is the one that is written: the projection matrix's, f/(f − n)·(1 − n/z), cancels near the near plane and rounds otherwise",
    ),
    ("depth/test/never/*", "nothing passes"),
    ("depth/test/less/*", "new passes where it is < old"),
    ("depth/test/equal/*", "new passes where it is = old"),
    ("depth/test/less-equal/*", "new passes where it is ≤ old"),
    ("depth/test/greater/*", "new passes where it is > old"),
    ("depth/test/not-equal/*", "new passes where it is ≠ old: one unit in the last place is a difference"),
    ("depth/test/greater-equal/*", "new passes where it is ≥ old: the nearer one where depth is reversed"),
    ("depth/test/always/*", "new always passes, however far it is"),
    ("depth/test/*/write", "where new passes its clamped depth is left, else that of old"),
    ("depth/test/*/keep", "depth is not written: old's clamped depth is left"),
    (
        "depth/same-geometry-*",
        "the triangle is drawn into an empty depth buffer first, with its depth written, then again with the depth test of the id: the same geometry has the same depths",
    ),
    (
        "depth/stored depth/stored-reversed depth/recovered depth/recovered-reversed",
        "n is `near` and f is `far`; where near = far, or z = 0, nothing is promised",
    ),
    ("depth/recovered depth/recovered-reversed", "depth is computed and read back in one evaluation"),
    // Blending.
    (
        "blend/add/* blend/subtract/* blend/reverse-subtract/*",
        "the id is blend/EQUATION/S/D: S is the factor of src, D that of dst",
    ),
    (
        "blend/without-alpha/* blend/special/*.*",
        "the last part of the id is EQUATION.S.D: S is the factor of src, D that of dst",
    ),
    (
        "blend/separate/*",
        "the id is blend/separate/COLOR/ALPHA, each EQUATION.S.D with S the factor of src and D that of dst, or min or max: red, green and blue come from the first, alpha from the second",
    ),
    (
        "blend/separate/*",
        "add is src·S + dst·D, subtract is src·S − dst·D, reverse-subtract is dst·D − src·S; min and max take no factors",
    ),
    factor!("zero", "0"),
    factor!("one", "1"),
    factor!("src-color", "Cs for red, green and blue, As for alpha"),
    factor!("one-minus-src-color", "1 − Cs for red, green and blue, 1 − As for alpha"),
    factor!("dst-color", "Cd for red, green and blue, Ad for alpha"),
    factor!("one-minus-dst-color", "1 − Cd for red, green and blue, 1 − Ad for alpha"),
    factor!("src-alpha", "As for all four components"),
    factor!("one-minus-src-alpha", "1 − As for all four components"),
    factor!("dst-alpha", "Ad for all four components"),
    factor!("one-minus-dst-alpha", "1 − Ad for all four components"),
    factor!("constant-color", "Cc for red, green and blue, Ac for alpha"),
    factor!("one-minus-constant-color", "1 − Cc for red, green and blue, 1 − Ac for alpha"),
    factor!("constant-alpha", "Ac for all four components"),
    factor!("one-minus-constant-alpha", "1 − Ac for all four components"),
    factor!("src-alpha-saturate", "min(As, 1 − Ad) for red, green and blue, 1 for alpha"),
    ("blend/min/* blend/max/* blend/*-factors-ignored", "by component, alpha too"),
    ("blend/*-factors-ignored", "the factors change nothing: this equation reads none"),
    (
        "blend/mode-alpha",
        "the same as mix(dst, src, As), of which either form is legal: dst(1 − As) + src·As and dst + As(src − dst)",
    ),
    (
        "blend/add/* blend/subtract/* blend/reverse-subtract/* blend/min/* blend/max/* blend/separate/* blend/write-mask/* blend/without-alpha/* blend/layers/* blend/mode-* blend/saturate-source-only",
        "numbers are not clamped; on a target of 8 bits src, dst, the constant and the result are clamped to [0, 1]",
    ),
    (
        "blend/add/* blend/subtract/* blend/reverse-subtract/*",
        "on a target of 16-bit floats a result that these cannot hold may be ±65504 or infinite",
    ),
    (
        "blend/write-mask/*",
        "the last part of the id names the components that are written, of r, g, b and a, or none; the others stay as they were",
    ),
    ("blend/special/*", "any answer is legal; they are asked of the blend unit on targets alone"),
    ("blend/without-alpha/* blend/mode-*", "the target has no alpha: Ad reads as 1"),
    (
        "blend/layers/*",
        "src-1 is drawn first, then src-2 over what it left, up to src-n; the sources after that are not drawn",
    ),
    ("blend/layers/alpha", "every layer is drawn by src·As + dst·(1 − As), alpha too"),
    (
        "blend/layers/mixed",
        "the layers 1, 4, 7 and so on are drawn by src·As + dst·(1 − As), the layers 2, 5, 8 and so on by src * dst, the others by src·As + dst; alpha too",
    ),
    ("blend/saturate-source-only", "red, green and blue have the factor min(As, 1 − As), alpha has 1"),
    (
        "blend/alpha-clamped",
        "every component of src and dst is clamped to [0, 1] before, alpha too, and the result after; alpha is blended as the other components are",
    ),
    ("blend/over blend/over-incremental", "nothing is clamped"),
    ("blend/over", "where As = 1 the result is src, to the last bit"),
    ("blend/subtract-*", "a result below 0 is not clamped"),
    ("blend/opacity-of-layers*", "n is `layers`, α is `alpha`; for α ≥ 1 nothing is promised"),
    ("blend/unpremultiply", "where α is below 2⁻¹²⁶ nothing is promised"),
    ("blend/unpremultiply-guarded", "black where α is 0 or too small to divide by, whatever the colour is"),
];

#[cfg(test)]
mod tests {
    use super::super::pattern::any_matches;
    use super::{RULES, of};
    use crate::cases::blend::Samples;
    use crate::cases::{Domain, all};

    /// Formulas with hard cases that follow from the formula alone.
    const COMPLETE: [&str; 1] = ["color/sum"];

    #[test]
    fn every_rule_has_its_formulas() {
        let ids: Vec<String> = all(&Samples::default()).iter().map(|formula| formula.spec().id).collect();
        for (patterns, rule) in RULES {
            assert!(!rule.is_empty() && !rule.ends_with('.'), "{rule}");
            for pattern in patterns.split(' ') {
                assert!(ids.iter().any(|id| any_matches(pattern, id)), "no formula is `{pattern}`: {rule}");
            }
        }
    }

    #[test]
    fn every_formula_with_hard_cases_has_a_rule() {
        let specs: Vec<_> = all(&Samples::default()).iter().map(|formula| formula.spec()).collect();
        for spec in specs.iter().filter(|spec| !spec.hard.is_empty()) {
            assert_eq!(of(&spec.id).is_empty(), COMPLETE.contains(&&*spec.id), "{}", spec.id);
        }
        assert!(COMPLETE.iter().all(|id| specs.iter().any(|spec| spec.id == *id && !spec.hard.is_empty())));
    }

    /// Hard cases whose unit vectors are none, by how their ids begin, with the reason.
    const NOT_UNIT: &[(&str, &str)] = &[
        ("vector/reflect/hard/no-normal: n", "a rule says what it gives"),
        ("vector/normal-by-cofactors/", "it takes normals of any length, and gives their direction"),
        ("vector/interpolated-normal/hard/opposite: face", "the formula does not read it"),
        (
            "vector/interpolated-normal-guarded/",
            "the face's normal is normalised; what is left is just enough, or too little",
        ),
    ];

    #[test]
    fn unit_vectors_of_hard_cases_are_unit_vectors() {
        let specs: Vec<_> = all(&Samples::default()).iter().map(|formula| formula.spec()).collect();
        let is_unit = |v: &[f32]| {
            let length = v.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
            // A few roundings, or a direction whose numbers were written with six digits.
            (length - 1.0).abs() < 1e-6
        };
        let mut others = vec![];
        for spec in &specs {
            for hard in spec.hard {
                for (name, values) in hard.inputs {
                    let input = spec.inputs.iter().find(|input| input.name == *name);
                    let is_direction = input.is_some_and(|input| input.domain == Domain::Direction);
                    if is_direction && !is_unit(values) {
                        others.push(format!("{}/hard/{}: {name}", spec.id, hard.name));
                    }
                }
            }
        }
        let is_known = |other: &String| NOT_UNIT.iter().any(|(known, _)| other.starts_with(known));
        let unknown: Vec<&String> = others.iter().filter(|other| !is_known(other)).collect();
        assert!(unknown.is_empty(), "a shader that normalises what is a unit vector already fails at {unknown:#?}");
        for (known, reason) in NOT_UNIT {
            assert!(others.iter().any(|other| other.starts_with(known)), "{known}: {reason}");
        }
    }

    #[test]
    fn a_factor_is_told_where_it_is_used() {
        let tells = |id: &str, name: &str| of(id).iter().any(|rule| rule.starts_with(&format!("{name} is ")));
        for (id, name, expected) in [
            ("blend/add/src-alpha/one-minus-src-alpha", "src-alpha", true),
            ("blend/add/src-alpha/one-minus-src-alpha", "one-minus-src-alpha", true),
            ("blend/add/one/src-alpha-saturate", "src-alpha-saturate", true),
            ("blend/add/one/src-alpha-saturate", "src-alpha", false),
            ("blend/separate/add.zero.one/min", "one", true),
            ("blend/separate/min/add.zero.one", "one", true),
            ("blend/min/one/one", "src-alpha", false),
        ] {
            assert_eq!(tells(id, name), expected, "{name} of {id}");
        }
    }
}
