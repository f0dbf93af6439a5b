//! Cases of lighting. Formulas: `lightmeter_reference::lighting`.

use super::Visitor;
use super::attenuation::{CUTOFF, EXPONENT, KC, KL, KQ};
use super::formula::formula;
use super::rows::Reader;
use super::spec::{Domain, Hard, Input, Output, Shape};
use lightmeter_reference::Real;
use lightmeter_reference::lighting::{self, Falloff, Gate, Light, Material, Specular, Vertex};

const LA: Input = Input::rgb("la");
const LD: Input = Input::rgb("ld");
const LS: Input = Input::rgb("ls");
const MA: Input = Input::rgb("ma");
const MD: Input = Input::rgb("md");
const MS: Input = Input::rgb("ms");
const SHININESS: Input = Input::scalar("shininess", "1", Domain::LogUniform(1.0, 256.0));
const P: Input = Input::position("p");
const NORMAL: Input = Input::vector("normal");
const DIRECTION: Input = Input::vector("direction");
const LIGHT_POSITION: Input = Input::position("position");
const RGB: Output = Output::new("color", Shape::Vec3, "color");
const RGBA: Output = Output::new("color", Shape::Vec4, "color");
const INTENSITY: Output = Output::new("intensity", Shape::Scalar, "color");

fn light<R: Real>(x: &mut Reader<'_, R>) -> Light<R> {
    Light { ambient: x.vector(), diffuse: x.vector(), specular: x.vector() }
}

fn material<R: Real>(x: &mut Reader<'_, R>) -> Material<R> {
    Material { ambient: x.vector(), diffuse: x.vector(), specular: x.vector(), shininess: x.scalar() }
}

fn falloff<R: Real>(x: &mut Reader<'_, R>) -> Falloff<R> {
    Falloff { kc: x.scalar(), kl: x.scalar(), kq: x.scalar() }
}

fn vertex<R: Real>(x: &mut Reader<'_, R>) -> Vertex<R> {
    Vertex { p: x.vector(), n: x.vector() }
}

formula!(
    /// The ambient term.
    Ambient: "lighting/ambient" by "lighting_ambient",
    "CA = LA * MA", "000 §6.3; ruling 8, `product`",
    [LA, MA] -> [RGB],
    |x, out| { out.vector(lighting::ambient(x.vector(), x.vector())); },
    hard [
        Hard { name: "blue-under-white", pins: "document 000's figure", inputs: &[("la", &[1.0, 1.0, 1.0]), ("ma", &[0.0, 0.0, 1.0])] },
        Hard { name: "blue-under-red", pins: "document 000's figure", inputs: &[("la", &[1.0, 0.0, 0.0]), ("ma", &[0.0, 0.0, 1.0])] },
    ],
);
formula!(
    /// An ambient constant.
    AmbientConstant: "lighting/ambient-constant" by "lighting_ambient_constant",
    "ambient + CD, the ambient term a global constant", "004; ruling 8, `constant`",
    [Input::rgb("ambient"), Input::rgb("diffuse")] -> [RGB],
    |x, out| { out.vector(lighting::ambient_constant(x.vector(), x.vector())); },
);
formula!(
    /// The diffuse term from the vector to the light.
    DiffuseToward: "lighting/diffuse-toward" by "lighting_diffuse_toward",
    "CD = LD * MD * max(l·n, 0)", "004; ruling 13, `toward`",
    [LD, MD, Input::direction("l"), Input::direction("n")] -> [RGB],
    |x, out| { out.vector(lighting::diffuse_toward(x.vector(), x.vector(), x.vector(), x.vector())); },
    hard [
        Hard { name: "edge-on", pins: "0 at a right angle", inputs: &[("l", &[1.0, 0.0, 0.0]), ("n", &[0.0, 0.0, 1.0])] },
        Hard { name: "from-behind", pins: "max, not abs and not the bare product", inputs: &[("l", &[0.0, 0.0, -1.0]), ("n", &[0.0, 0.0, 1.0])] },
    ],
);
formula!(
    /// The diffuse term from the direction of travel.
    DiffuseTravel: "lighting/diffuse-travel" by "lighting_diffuse_travel",
    "CD = LD * MD * max((−i)·n, 0)", "000 §6.3; rulings 5, 13, 16",
    [LD, MD, Input::direction("i"), Input::direction("n")] -> [RGB],
    |x, out| { out.vector(lighting::diffuse_travel(x.vector(), x.vector(), x.vector(), x.vector())); },
);
formula!(
    /// Phong's highlight.
    SpecularPhong: "lighting/specular-phong" by "lighting_specular_phong",
    "CS = LS * MS * max(r·v, 0)^shininess", "000 §6.3",
    [LS, MS, Input::direction("r"), Input::direction("v"), SHININESS] -> [RGB],
    fit facing_vectors,
    |x, out| { out.vector(lighting::specular_phong(x.vector(), x.vector(), x.vector(), x.vector(), x.scalar())); },
    hard [
        Hard { name: "mirror", pins: "1 at any shininess", inputs: &[("r", &[0.0, 0.0, 1.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[1e6])] },
        Hard { name: "slightly-above-one", pins: "a cosine a few ULP above 1 under a great power", inputs: &[("r", &[0.0, 0.0, 1.000_000_2]), ("v", &[0.0, 0.0, 1.000_000_2]), ("shininess", &[1e6])] },
        Hard { name: "edge-on", pins: "0 at a right angle", inputs: &[("r", &[1.0, 0.0, 0.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[1.0])] },
        Hard { name: "no-shininess-edge-on", pins: "0 and 1 are both legal: 0 to the power 0", inputs: &[("r", &[1.0, 0.0, 0.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[0.0])] },
        Hard { name: "no-shininess", pins: "1 for a cosine above 0", inputs: &[("r", &[0.0, 0.6, 0.8]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[0.0])] },
        Hard { name: "behind", pins: "0, never the even power of a negative cosine", inputs: &[("r", &[0.0, 0.0, -1.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[2.0])] },
    ],
);
formula!(
    /// Blinn's highlight.
    SpecularBlinn: "lighting/specular-blinn" by "lighting_specular_blinn",
    "CS = LS * MS * max(n·h, 0)^shininess", "000 §6.4, 004",
    [LS, MS, Input::direction("n"), Input::direction("h"), SHININESS] -> [RGB],
    fit facing_vectors,
    |x, out| { out.vector(lighting::specular_blinn(x.vector(), x.vector(), x.vector(), x.vector(), x.scalar())); },
);
formula!(
    /// The highlight of a viewer at infinity.
    SpecularNonlocal: "lighting/specular-nonlocal" by "lighting_specular_nonlocal",
    "CS = LS * MS * max(r.z, 0)^shininess", "000 §6.4",
    [LS, MS, Input::direction("r"), SHININESS] -> [RGB],
    |x, out| { out.vector(lighting::specular_nonlocal(x.vector(), x.vector(), x.vector(), x.scalar())); },
);

/// Half of all pairs of directions look away from each other, where the highlight is 0: keep a quarter of those.
fn facing_vectors(row: &mut [f32]) {
    let away = (0..3).map(|k| row[6 + k] * row[9 + k]).sum::<f32>() < 0.0;
    if away && row[6].to_bits() & 3 != 0 {
        row[6..9].iter_mut().for_each(|x| *x = -*x);
    }
}

macro_rules! directional {
    ($name:ident, $id:literal, $function:literal, $dialect:expr, $text:literal, $source:literal $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// A directional light.
            $name: $id by $function, $text, $source,
            [LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, DIRECTION] -> [RGBA],
            |x, out| {
                let (light, material) = (light(x), material(x));
                out.vector(lighting::directional($dialect, &light, &material, x.vectors()));
            }
            $(, hard [$($hard),*])?
        );
    };
}

directional!(
    Phong, "lighting/phong", "lighting_phong", (Specular::Phong, Gate::Documents),
    "CF = LA*MA + LD*MD·max(l·n, 0) + LS*MS·max(r·v, 0)^shininess, everything normalised", "000 §6.3",
    hard [
        Hard { name: "light-behind-the-surface", pins: "the documents light the highlight; ruling 9", inputs: &[("p", &[0.0, 0.0, -1.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[-1.0, 0.0, 0.05]), ("shininess", &[1.0])] },
        Hard { name: "eye-on-the-surface", pins: "no view vector: 0, not NaN", inputs: &[("p", &[0.0, 0.0, 0.0])] },
        Hard { name: "no-normal", pins: "ambient alone, not NaN", inputs: &[("normal", &[0.0, 0.0, 0.0])] },
    ]
);
directional!(
    Blinn, "lighting/blinn", "lighting_blinn", (Specular::Blinn, Gate::Documents),
    "CF = LA*MA + LD*MD·max(l·n, 0) + LS*MS·max(n·h, 0)^shininess, everything normalised", "000 §6.4, 004",
    hard [
        Hard { name: "half-vector-of-nothing", pins: "the light behind the eye's line: no highlight, not NaN", inputs: &[("p", &[0.0, 0.0, -1.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[0.0, 0.0, 1.0])] },
    ]
);
directional!(
    PhongGated,
    "lighting/phong-gated",
    "lighting_phong_gated",
    (Specular::Phong, Gate::OpenGl),
    "CF as lighting/phong, the highlight 0 where l·n ≤ 0",
    "OpenGL 2.1 §2.14.1; ruling 9, `opengl`",
    hard [
        Hard { name: "light-edge-on", pins: "l·n = 0 has no highlight, though r·v is above 0", inputs: &[("p", &[-1.0, 0.0, -1.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[1.0, 0.0, 0.0]), ("shininess", &[1.0])] },
    ]
);
formula!(
    /// Blinn's model with document 000's halfway vector.
    BlinnUnnormalised: "lighting/blinn-unnormalised" by "lighting_blinn_unnormalised",
    "CF as lighting/blinn with h = v + l", "000 §6.4; ruling 3, a dialect",
    [LA, LD, LS, MA, MD, MS, Input::scalar("shininess", "1", Domain::Uniform(1.0, 16.0)), P, NORMAL, DIRECTION] -> [RGBA],
    |x, out| {
        let (light, material) = (light(x), material(x));
        let dialect = (Specular::BlinnUnnormalised, Gate::Documents);
        out.vector(lighting::directional(dialect, &light, &material, x.vectors()));
    },
);
formula!(
    /// A light taken as a unit vector.
    PhongUnitLight: "lighting/phong-unit-light" by "lighting_phong_unit_light",
    "CF as lighting/phong, the light's direction not normalised", "000 §6.4",
    [LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, Input::direction("direction")] -> [RGBA],
    |x, out| {
        let (light, material) = (light(x), material(x));
        out.vector(lighting::unit_light(&light, &material, x.vectors()));
    },
);
formula!(
    /// A viewer at infinity.
    PhongNonlocal: "lighting/phong-nonlocal" by "lighting_phong_nonlocal",
    "CF as lighting/phong-unit-light with v = (0, 0, 1)", "000 §6.4",
    [LA, LD, LS, MA, MD, MS, SHININESS, NORMAL, Input::direction("direction")] -> [RGBA],
    |x, out| {
        let (light, material) = (light(x), material(x));
        out.vector(lighting::nonlocal(&light, &material, x.vector(), x.vector()));
    },
);

macro_rules! point {
    ($name:ident, $id:literal, $function:literal, $model:expr, $text:literal) => {
        formula!(
            /// A point light.
            $name: $id by $function, $text, "000 §6.4, 004; rulings 2 and 11",
            [LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, LIGHT_POSITION, KC, KL, KQ] -> [RGBA],
            |x, out| {
                let (light, material, vectors) = (light(x), material(x), x.vectors());
                out.vector(lighting::point(($model, Gate::Documents), &light, &material, vectors, &falloff(x)));
            },
        );
    };
}

point!(
    PointPhong,
    "lighting/point-phong",
    "lighting_point_phong",
    Specular::Phong,
    "CF = CA + atten·(CD + CS), l = ⟨position − p⟩, Phong's highlight"
);
point!(
    PointBlinn,
    "lighting/point-blinn",
    "lighting_point_blinn",
    Specular::Blinn,
    "CF = CA + atten·(CD + CS), l = ⟨position − p⟩, Blinn's highlight"
);
formula!(
    /// A point light as OpenGL's fixed function has it.
    PointOpenGl: "lighting/point-opengl" by "lighting_point_opengl",
    "CF = atten·(CA + CD + CS), no highlight where l·n ≤ 0, alpha of the material", "OpenGL 2.1 §2.14.1; rulings 9, 11, 14",
    [
        LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, LIGHT_POSITION, KC, KL, KQ,
        Input::scalar("alpha", "color", Domain::Unit),
    ] -> [RGBA],
    |x, out| {
        let (light, material, vectors, falloff) = (light(x), material(x), x.vectors(), falloff(x));
        out.vector(lighting::point_opengl(&light, &material, vectors, &falloff, x.scalar()));
    },
);
formula!(
    /// A spotlight.
    Spot: "lighting/spot" by "lighting_spot",
    "CF = CA + atten·spot·(CD + CS), spot = max(−l·axis, 0)^e within the cone", "000 §6.4; OpenGL 2.1 §2.14.1",
    [
        LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, LIGHT_POSITION, Input::vector("axis"), KC, KL, KQ, CUTOFF, EXPONENT,
    ] -> [RGBA],
    fit aimed,
    |x, out| {
        let (light, material, vectors, falloff) = (light(x), material(x), x.vectors(), falloff(x));
        out.vector(lighting::spot(&light, &material, vectors, &falloff, x.array()));
    },
);

/// Three spotlights of four are aimed near the surface point, or most cases would lie outside their cones.
fn aimed(row: &mut [f32]) {
    if row[28].to_bits() & 3 != 0 {
        for k in 0..3 {
            let toward_surface = row[19 + k] - row[25 + k];
            row[28 + k] = 0.25 * row[28 + k] + 0.25 * toward_surface;
        }
        row[34] *= 0.5;
    }
}

formula!(
    /// A scalar material.
    ScalarMaterial: "lighting/scalar-material" by "lighting_scalar_material",
    "CF = ka·ambient_color + kd·light_color·max(l·n, 0) + ks·light_color·max(r·v, 0)^n", "003",
    [
        Input::rgb("ambient_color"), Input::rgb("light_color"),
        Input::scalar("ka", "1", Domain::Unit), Input::scalar("kd", "1", Domain::Unit), Input::scalar("ks", "1", Domain::Unit),
        SHININESS, P, NORMAL, LIGHT_POSITION,
    ] -> [RGBA],
    |x, out| { out.vector(lighting::scalar_material(x.vectors(), x.array(), x.vectors())); },
);
formula!(
    /// Document 004's two lights.
    TwoLights: "lighting/two-lights" by "lighting_two_lights",
    "ambient + Σ(diffuse·color·max(n·l, 0) + specular·color·max(n·h, 0)^shininess), RGBA", "004; rulings 13 and 14, `sum`",
    [
        Input::rgba("ambient"), Input::rgba("color0"), Input::rgba("color1"), Input::rgba("diffuse"),
        Input::rgba("specular"), SHININESS, P, NORMAL, DIRECTION, LIGHT_POSITION,
    ] -> [RGBA],
    |x, out| {
        let (ambient, colors, material, shininess) = (x.vector(), x.vectors(), x.vectors(), x.scalar());
        out.vector(lighting::two_lights(ambient, colors, material, shininess, x.vectors()));
    },
);
formula!(
    /// The sum of all terms.
    Sum: "lighting/sum" by "lighting_sum",
    "CF = CE + CA + Σ(CDᵢ + CSᵢ)", "004",
    [
        Input::rgb("emissive"), Input::rgb("ambient"), Input::rgb("diffuse0"), Input::rgb("diffuse1"),
        Input::rgb("specular0"), Input::rgb("specular1"),
    ] -> [RGB],
    |x, out| { out.vector(lighting::sum(x.vector(), x.vector(), x.vectors(), x.vectors())); },
);
formula!(
    /// Plastic.
    Plastic: "lighting/highlight-plastic" by "lighting_highlight_plastic",
    "CS = LS·ks·FS", "004",
    [LS, Input::rgb("surface"), Input::scalar("ks", "1", Domain::Unit), Input::scalar("fs", "1", Domain::Unit)] -> [RGB],
    |x, out| { out.vector(lighting::highlight_plastic(x.vector(), x.vector(), x.scalar(), x.scalar())); },
);
formula!(
    /// Metal.
    Metal: "lighting/highlight-metal" by "lighting_highlight_metal",
    "CS = LS * surface·ks·FS", "004",
    [LS, Input::rgb("surface"), Input::scalar("ks", "1", Domain::Unit), Input::scalar("fs", "1", Domain::Unit)] -> [RGB],
    |x, out| { out.vector(lighting::highlight_metal(x.vector(), x.vector(), x.scalar(), x.scalar())); },
);

const KD: Input = Input::scalar("kd", "1", Domain::Unit);
const KS: Input = Input::scalar("ks", "1", Domain::Unit);
const T: Input = Input::scalar("t", "1", Domain::Unit);

macro_rules! along_an_edge {
    ($name:ident, $id:literal, $function:literal, $shading:path, $text:literal, $source:literal $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// Shading between two vertices.
            $name: $id by $function, $text, $source,
            [
                Input::position("pa"), Input::vector("na"), Input::position("pb"), Input::vector("nb"), T,
                LIGHT_POSITION, KD, KS, SHININESS,
            ] -> [INTENSITY],
            |x, out| { out.scalar($shading(vertex(x), vertex(x), x.scalar(), x.vector(), x.array())); }
            $(, hard [$($hard),*])?
        );
    };
}

along_an_edge!(
    Gouraud,
    "lighting/gouraud",
    "lighting_gouraud",
    lighting::gouraud,
    "mix(I(a), I(b), t): lit at the vertices, the intensity interpolated",
    "000 §6.3, 004",
    hard[Hard {
        name: "no-highlight-between",
        pins: "document 004: both vertices dark, so is the middle",
        inputs: BETWEEN
    }]
);
along_an_edge!(
    PhongShading, "lighting/phong-shading", "lighting_phong_shading", lighting::phong,
    "I(mix(pa, pb, t), ⟨mix(na, nb, t)⟩): position and normal interpolated, lit at the point", "000 §6.3, 004",
    hard [
        Hard { name: "highlight-between", pins: "document 004: both vertices dark, the middle bright", inputs: BETWEEN },
        Hard { name: "opposite-normals", pins: "nothing is left to normalise: the normal is 0, not NaN", inputs: &[("na", &[0.0, 0.0, 1.0]), ("nb", &[0.0, 0.0, -1.0]), ("t", &[0.5])] },
    ]
);
along_an_edge!(
    PhongInterpolated,
    "lighting/phong-interpolated",
    "lighting_phong_interpolated",
    lighting::phong_interpolated,
    "I of n, l and v interpolated from the vertices and normalised at the point",
    "003"
);

/// A cylinder's edge from one side to the other: n·v < 0 at one vertex, n·l < 0 at the other, the mirror in the middle.
const BETWEEN: &[(&str, &[f32])] = &[
    ("pa", &[-1.0, 0.0, -5.0]),
    ("na", &[-1.0, 0.0, 0.0]),
    ("pb", &[1.0, 0.0, -5.0]),
    ("nb", &[1.0, 0.0, 0.0001]),
    ("t", &[0.5]),
    ("position", &[0.0, 0.0, 0.0]),
    ("kd", &[0.0]),
    ("ks", &[1.0]),
    ("shininess", &[100.0]),
];

formula!(
    /// Flat shading.
    Flat: "lighting/flat" by "lighting_flat",
    "I of the face's own normal ⟨(b − a) × (c − a)⟩ at its first vertex", "004",
    [Input::position("a"), Input::position("b"), Input::position("c"), LIGHT_POSITION, KD, KS, SHININESS] -> [INTENSITY],
    |x, out| { out.scalar(lighting::flat(x.vectors(), x.vector(), x.array())); },
    hard [
        Hard { name: "no-area", pins: "0, not NaN, for three points on a line", inputs: &[("a", &[0.0, 0.0, -1.0]), ("b", &[1.0, 1.0, -1.0]), ("c", &[2.0, 2.0, -1.0])] },
    ],
);

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(Ambient);
    visitor.formula(AmbientConstant);
    visitor.formula(DiffuseToward);
    visitor.formula(DiffuseTravel);
    visitor.formula(SpecularPhong);
    visitor.formula(SpecularBlinn);
    visitor.formula(SpecularNonlocal);
    visitor.formula(Phong);
    visitor.formula(Blinn);
    visitor.formula(BlinnUnnormalised);
    visitor.formula(PhongGated);
    visitor.formula(PhongUnitLight);
    visitor.formula(PhongNonlocal);
    visitor.formula(PointPhong);
    visitor.formula(PointBlinn);
    visitor.formula(PointOpenGl);
    visitor.formula(Spot);
    visitor.formula(ScalarMaterial);
    visitor.formula(TwoLights);
    visitor.formula(Sum);
    visitor.formula(Plastic);
    visitor.formula(Metal);
    visitor.formula(Gouraud);
    visitor.formula(PhongShading);
    visitor.formula(PhongInterpolated);
    visitor.formula(Flat);
}
