//! Cases of lighting. Formulas: `lightmeter_reference::lighting`.

use super::Visitor;
use super::attenuation::{CUTOFF, EXPONENT, KC, KL, KQ};
use super::fit;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, Spec, ValueShape};
use lightmeter_reference::Vec3;
use lightmeter_reference::lighting::{self, Falloff, Light, Material, Specular, SpecularGate, Vertex};

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
const RGB: Output = Output::new("color", ValueShape::Vec3, "color");
const RGBA: Output = Output::new("color", ValueShape::Vec4, "color");
const INTENSITY: Output = Output::new("intensity", ValueShape::Scalar, "color");

fn light<R>([ambient, diffuse, specular]: [Vec3<R>; 3]) -> Light<R> {
    Light { ambient, diffuse, specular }
}

fn material<R>([ambient, diffuse, specular]: [Vec3<R>; 3], shininess: R) -> Material<R> {
    Material { ambient, diffuse, specular, shininess }
}

formula!(
    /// The ambient term.
    Ambient: "lighting/ambient" by "lighting_ambient",
    "CA = LA * MA", "000 §6.3; ruling 8, `product`",
    [LA, MA] -> [RGB],
    |la, ma; out| { out.vector(lighting::ambient(la, ma)); },
    hard [
        Hard::new("blue-under-white", "document 000's figure", &[("la", &[1.0, 1.0, 1.0]), ("ma", &[0.0, 0.0, 1.0])]),
        Hard::new("blue-under-red", "document 000's figure", &[("la", &[1.0, 0.0, 0.0]), ("ma", &[0.0, 0.0, 1.0])]),
    ],
);
formula!(
    /// An ambient constant.
    AmbientConstant: "lighting/ambient-constant" by "lighting_ambient_constant",
    "ambient + CD, the ambient term a global constant", "004; ruling 8, `constant`",
    [Input::rgb("ambient"), Input::rgb("diffuse")] -> [RGB],
    |ambient, diffuse; out| { out.vector(lighting::ambient_constant(ambient, diffuse)); },
);
formula!(
    /// The diffuse term from the vector to the light.
    DiffuseToward: "lighting/diffuse-toward" by "lighting_diffuse_toward",
    "CD = LD * MD * max(l·n, 0)", "004; ruling 13, `toward`",
    [LD, MD, Input::direction("l"), Input::direction("n")] -> [RGB],
    |ld, md, l, n; out| { out.vector(lighting::diffuse_toward(ld, md, l, n)); },
    hard [
        Hard::new("edge-on", "0 at a right angle", &[("l", &[1.0, 0.0, 0.0]), ("n", &[0.0, 0.0, 1.0])]),
        Hard::new("least-lit", "1e-12 is above 0, too", &[("ld", WHITE), ("md", WHITE), ("l", &[1.0, 0.0, 1e-12]), ("n", &[0.0, 0.0, 1.0])]).at_an_end(),
        Hard::new("from-behind", "max, not abs and not the bare product", &[("l", &[0.0, 0.0, -1.0]), ("n", &[0.0, 0.0, 1.0])]),
    ],
);
formula!(
    /// The diffuse term from the direction of travel.
    DiffuseTravel: "lighting/diffuse-travel" by "lighting_diffuse_travel",
    "CD = LD * MD * max((−i)·n, 0)", "000 §6.3; rulings 5, 13, 16",
    [LD, MD, Input::direction("i"), Input::direction("n")] -> [RGB],
    |ld, md, i, n; out| { out.vector(lighting::diffuse_travel(ld, md, i, n)); },
    hard [
        Hard::new("least-lit", "1e-12 is above 0, too", &[("ld", WHITE), ("md", WHITE), ("i", &[1.0, 0.0, -1e-12]), ("n", &[0.0, 0.0, 1.0])]).at_an_end(),
    ],
);
formula!(
    /// Phong's highlight.
    SpecularPhong: "lighting/specular-phong" by "lighting_specular_phong",
    "CS = LS * MS * max(r·v, 0)^shininess", "000 §6.3",
    [LS, MS, Input::direction("r"), Input::direction("v"), SHININESS] -> [RGB],
    fit facing_vectors,
    |ls, ms, r, v, shininess; out| { out.vector(lighting::specular_phong(ls, ms, r, v, shininess)); },
    hard [
        Hard::new("mirror", "1 at any shininess", &[("r", &[0.0, 0.0, 1.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[1e6])]).at_an_end(),
        Hard::new("edge-on", "0 at a right angle", &[("r", &[1.0, 0.0, 0.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[1.0])]),
        Hard::new("barely-lit", "however small, a cosine above 0 counts", &[("r", &[0.999_999_9, 0.0, 6e-5]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[1.0])]),
        Hard::new("least-lit", "1e-12 is above 0, too", &[("ls", WHITE), ("ms", WHITE), ("r", &[1.0, 0.0, 1e-12]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[1.0])]),
        Hard::new("no-shininess-edge-on", "0 and 1 are both legal: 0 to the power 0", &[("r", &[1.0, 0.0, 0.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[0.0])]),
        Hard::new("no-shininess", "1 for a cosine above 0", &[("r", &[0.0, 0.6, 0.8]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[0.0])]),
        Hard::new("behind", "0, never the even power of a negative cosine", &[("r", &[0.0, 0.0, -1.0]), ("v", &[0.0, 0.0, 1.0]), ("shininess", &[2.0])]),
    ],
);
formula!(
    /// Blinn's highlight.
    SpecularBlinn: "lighting/specular-blinn" by "lighting_specular_blinn",
    "CS = LS * MS * max(n·h, 0)^shininess", "000 §6.4, 004",
    [LS, MS, Input::direction("n"), Input::direction("h"), SHININESS] -> [RGB],
    fit facing_vectors,
    |ls, ms, n, h, shininess; out| { out.vector(lighting::specular_blinn(ls, ms, n, h, shininess)); },
    hard [
        Hard::new("barely-lit", "however small, a cosine above 0 counts", &[("n", &[0.999_999_9, 0.0, 6e-5]), ("h", &[0.0, 0.0, 1.0]), ("shininess", &[1.0])]),
        Hard::new("least-lit", "1e-12 is above 0, too", &[("ls", WHITE), ("ms", WHITE), ("n", &[1.0, 0.0, 1e-12]), ("h", &[0.0, 0.0, 1.0]), ("shininess", &[1.0])]),
    ],
);
formula!(
    /// The highlight of a viewer at infinity.
    SpecularNonlocal: "lighting/specular-nonlocal" by "lighting_specular_nonlocal",
    "CS = LS * MS * max(r.z, 0)^shininess", "000 §6.4",
    [LS, MS, Input::direction("r"), SHININESS] -> [RGB],
    |ls, ms, r, shininess; out| { out.vector(lighting::specular_nonlocal(ls, ms, r, shininess)); },
    hard [Hard::new("barely-lit", "however small, a cosine above 0 counts", &[("r", &[0.999_999_9, 0.0, 6e-5]), ("shininess", &[1.0])]),
        Hard::new("least-lit", "5e-10 is above 0, too", &[("ls", WHITE), ("ms", WHITE), ("r", &[1.0, 0.0, 5e-10]), ("shininess", &[1.0])]),
        Hard::new("no-shininess-least-lit", "1 for a cosine above 0, however small", &[("ls", WHITE), ("ms", WHITE), ("r", &[1.0, 0.0, 5e-10]), ("shininess", &[0.0])]),
    ],
);

/// Half of all pairs of directions look away from each other, where the highlight is 0: keep a quarter of those.
fn facing_vectors(_: &Spec, row: &mut [f32]) {
    let away = (0..3).map(|k| row[6 + k] * row[9 + k]).sum::<f32>() < 0.0;
    if away && row[6].to_bits() & 3 != 0 {
        row[6..9].iter_mut().for_each(|x| *x = -*x);
    }
}

macro_rules! directional {
    ($name:ident, $id:literal, $function:literal, $dialect:expr, $text:literal, $source:literal
        $(, stable $bound:literal $size:ident $because:literal)? $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// A directional light.
            $name: $id by $function, $text, $source,
            [LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, DIRECTION] -> [RGBA],
            fit fit::surface,
            $(stable $bound $size $because,)?
            |la, ld, ls, ma, md, ms, shininess, p, normal, direction; out| {
                let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
                out.vector(lighting::directional($dialect, &light, &material, [p, normal, direction]));
            }
            $(, hard [$($hard),*])?
        );
    };
}

directional!(
    Phong, "lighting/phong", "lighting_phong", (Specular::Phong, SpecularGate::Documents),
    "CF = LA*MA + LD*MD·max(l·n, 0) + LS*MS·max(r·v, 0)^shininess, everything normalised", "000 §6.3",
    hard [
        Hard::new("light-behind-the-surface", "the documents light the highlight; ruling 9", &[("p", &[0.0, 0.0, -1.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[-1.0, 0.0, 0.05]), ("shininess", &[1.0])]),
        Hard::new("low-shininess", "an exponent of ½ widens the highlight", &[("ls", WHITE), ("ms", WHITE), ("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.5, 1.0]), ("direction", &[0.0, 0.0, -1.0]), ("shininess", &[0.5])]),
        Hard::new("high-shininess", "an exponent of 300", &[("ls", WHITE), ("ms", WHITE), ("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.1, 1.0]), ("direction", &[0.0, 0.0, -1.0]), ("shininess", &[300.0])]),
    ]
);
directional!(
    Blinn, "lighting/blinn", "lighting_blinn", (Specular::Blinn, SpecularGate::Documents),
    "CF = LA*MA + LD*MD·max(l·n, 0) + LS*MS·max(n·h, 0)^shininess, everything normalised", "000 §6.4, 004",
    hard [
        Hard::new("half-vector-of-nothing", "the light behind the eye's line: no highlight, not NaN", &[("p", &[0.0, 0.0, -1.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[0.0, 0.0, 1.0])]),
        Hard::new("low-shininess", "an exponent of ½ widens the highlight", &[("ls", WHITE), ("ms", WHITE), ("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.5, 1.0]), ("direction", &[0.0, 0.0, -1.0]), ("shininess", &[0.5])]),
        Hard::new("high-shininess", "an exponent of 300", &[("ls", WHITE), ("ms", WHITE), ("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.1, 1.0]), ("direction", &[0.0, 0.0, -1.0]), ("shininess", &[300.0])]),
    ]
);
directional!(
    PhongGated,
    "lighting/phong-gated",
    "lighting_phong_gated",
    (Specular::Phong, SpecularGate::OpenGl),
    "CF as lighting/phong, the highlight 0 where l·n ≤ 0",
    "OpenGL 2.1 §2.14.1; ruling 9, `opengl`",
    stable 16.0 Unit "where the gate closes the other terms are left: products and a sum of one sign",
    hard [
        Hard::new("light-at-95-degrees", "no highlight on the dark side, ruling 9", &[("ls", WHITE), ("ms", WHITE), ("p", &[-0.984_807_8, 0.0, -0.173_648_2]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[0.996_194_7, 0.0, 0.087_155_7]), ("shininess", &[32.0])])
            .naive("lighting/phong", "a highlight of up to 0.6 from a light behind the surface", 1e6),
        Hard::new("light-edge-on", "l·n = 0 has no highlight, though r·v is above 0", &[("p", &[-1.0, 0.0, -1.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[1.0, 0.0, 0.0]), ("shininess", &[1.0])]),
        Hard::new("light-barely-above", "l·n of 9e-7 is above 0: the highlight is there", &[("ls", WHITE), ("ms", WHITE), ("p", &[0.0, -1.0, -0.001]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[0.0, 1.0, -9e-7]), ("shininess", &[1.0])]),
    ]
);
formula!(
    /// Blinn's model with document 000's halfway vector.
    BlinnUnnormalised: "lighting/blinn-unnormalised" by "lighting_blinn_unnormalised",
    "CF as lighting/blinn with h = v + l", "000 §6.4; ruling 3, a dialect",
    [LA, LD, LS, MA, MD, MS, Input::scalar("shininess", "1", Domain::Uniform(1.0, 16.0)), P, NORMAL, DIRECTION] -> [RGBA],
    fit fit::surface,
    |la, ld, ls, ma, md, ms, shininess, p, normal, direction; out| {
        let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
        let dialect = (Specular::BlinnUnnormalised, SpecularGate::Documents);
        out.vector(lighting::directional(dialect, &light, &material, [p, normal, direction]));
    },
);
formula!(
    /// A light taken as a unit vector.
    PhongUnitLight: "lighting/phong-unit-light" by "lighting_phong_unit_light",
    "CF as lighting/phong, the light's direction not normalised", "000 §6.4",
    [LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, Input::direction("direction")] -> [RGBA],
    fit fit::surface,
    |la, ld, ls, ma, md, ms, shininess, p, normal, direction; out| {
        let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
        out.vector(lighting::unit_light(&light, &material, [p, normal, direction]));
    },
);
formula!(
    /// A viewer at infinity.
    PhongNonlocal: "lighting/phong-nonlocal" by "lighting_phong_nonlocal",
    "CF as lighting/phong-unit-light with v = (0, 0, 1)", "000 §6.4",
    [LA, LD, LS, MA, MD, MS, SHININESS, NORMAL, Input::direction("direction")] -> [RGBA],
    fit fit::surface,
    |la, ld, ls, ma, md, ms, shininess, normal, direction; out| {
        let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
        out.vector(lighting::nonlocal(&light, &material, normal, direction));
    },
);

macro_rules! point {
    ($name:ident, $id:literal, $function:literal, $model:expr, $text:literal) => {
        formula!(
            /// A point light.
            $name: $id by $function, $text, "000 §6.4, 004; rulings 2 and 11", normalised true,
            [LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, LIGHT_POSITION, KC, KL, KQ] -> [RGBA],
            fit fit::surface,
            |la, ld, ls, ma, md, ms, shininess, p, normal, position, kc, kl, kq; out| {
                let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
                let (dialect, falloff) = (($model, SpecularGate::Documents), Falloff { kc, kl, kq });
                out.vector(lighting::point(dialect, &light, &material, [p, normal, position], &falloff));
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
    fit fit::surface,
    |la, ld, ls, ma, md, ms, shininess, p, normal, position, kc, kl, kq, alpha; out| {
        let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
        let falloff = Falloff { kc, kl, kq };
        out.vector(lighting::point_opengl(&light, &material, [p, normal, position], &falloff, alpha));
    },
    hard [
        Hard::new("light-in-the-surface", "no highlight where l·n is 0", &[
            ("ls", WHITE), ("ms", WHITE), ("shininess", &[2.0]), ("p", &[0.0, 0.0, -4.0]), ("normal", &[0.0, 0.0, 1.0]),
            ("position", &[3.0, 0.0, -4.0]), ("kc", &[1.0]), ("kl", &[0.0]), ("kq", &[0.0]),
        ]),
    ],
);
formula!(
    /// A spotlight.
    Spot: "lighting/spot" by "lighting_spot",
    "CF = CA + atten·spot·(CD + CS), spot = max(−l·axis, 0)^e within the cone", "000 §6.4; OpenGL 2.1 §2.14.1",
    [
        LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, LIGHT_POSITION, Input::vector("axis"), KC, KL, KQ, CUTOFF, EXPONENT,
    ] -> [RGBA],
    fit fit::surface,
    |la, ld, ls, ma, md, ms, shininess, p, normal, position, axis, kc, kl, kq, cutoff_cosine, exponent; out| {
        let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
        let (vectors, falloff) = ([p, normal, position, axis], Falloff { kc, kl, kq });
        out.vector(lighting::spot(&light, &material, vectors, &falloff, [cutoff_cosine, exponent]));
    },
    hard [
        Hard::new("no-exponent-behind", "0 and 1 are both legal behind the light: 0 to the power 0", &[("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.0, 1.0]), ("position", &[0.0, 0.0, -2.0]), ("axis", &[0.953_939_2, 0.0, 0.3]), ("cutoff_cosine", &[-0.5]), ("exponent", &[0.0])]),
        Hard::new("no-axis", "−l·axis is 0: outside of a cone of 72°", &[("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.0, 1.0]), ("position", &[-2.0, -2.0, -2.0]), ("axis", &[0.0, 0.0, 0.0]), ("cutoff_cosine", &[0.3]), ("exponent", &[1.0])]),
        Hard::new("no-axis-lit-from-behind", "−l·axis is 0, wherever the light is: outside of a cone of 72°", &[("p", &[0.0, 0.0, -5.0]), ("normal", &[0.5, 0.5, -0.7]), ("position", &[2.0, 2.0, -8.0]), ("axis", &[0.0, 0.0, 0.0]), ("cutoff_cosine", &[0.3]), ("exponent", &[1.0])]),
        Hard::new("just-outside-the-cone", "ambient light alone, however low the exponent", &[("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.0, 1.0]), ("position", &[0.0, 0.0, -2.0]), ("axis", &[0.6, 0.0, -0.8]), ("cutoff_cosine", &[0.81]), ("exponent", &[0.5])]),
    ],
);

formula!(
    /// A scalar material.
    ScalarMaterial: "lighting/scalar-material" by "lighting_scalar_material",
    "CF = ka·ambient_color + kd·light_color·max(l·n, 0) + ks·light_color·max(r·v, 0)^n", "003",
    [
        Input::rgb("ambient_color"), Input::rgb("light_color"),
        Input::scalar("ka", "1", Domain::Unit), Input::scalar("kd", "1", Domain::Unit), Input::scalar("ks", "1", Domain::Unit),
        SHININESS, P, NORMAL, LIGHT_POSITION,
    ] -> [RGBA],
    fit fit::surface,
    |ambient_color, light_color, ka, kd, ks, shininess, p, normal, position; out| { out.vector(lighting::scalar_material([ambient_color, light_color], [ka, kd, ks, shininess], [p, normal, position])); },
);
formula!(
    /// Document 004's two lights.
    TwoLights: "lighting/two-lights" by "lighting_two_lights",
    "ambient + Σ(diffuse·color·max(n·l, 0) + specular·color·max(n·h, 0)^shininess), RGBA", "004; rulings 13 and 14, `sum`",
    [
        Input::rgba("ambient"), Input::rgba("color0"), Input::rgba("color1"), Input::rgba("diffuse"),
        Input::rgba("specular"), SHININESS, P, NORMAL, DIRECTION, LIGHT_POSITION,
    ] -> [RGBA],
    fit fit::surface,
    |ambient, color0, color1, diffuse, specular, shininess, p, normal, direction, position; out| {
        let (colors, material, vectors) = ([color0, color1], [diffuse, specular], [p, normal, direction, position]);
        out.vector(lighting::two_lights(ambient, colors, material, shininess, vectors));
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
    |emissive, ambient, diffuse0, diffuse1, specular0, specular1; out| {
        out.vector(lighting::sum(emissive, ambient, [diffuse0, diffuse1], [specular0, specular1]));
    },
);
formula!(
    /// Plastic.
    Plastic: "lighting/highlight-plastic" by "lighting_highlight_plastic",
    "CS = LS·ks·FS", "004",
    [LS, Input::rgb("surface"), Input::scalar("ks", "1", Domain::Unit), Input::scalar("fs", "1", Domain::Unit)] -> [RGB],
    |ls, surface, ks, fs; out| { out.vector(lighting::highlight_plastic(ls, surface, ks, fs)); },
);
formula!(
    /// Metal.
    Metal: "lighting/highlight-metal" by "lighting_highlight_metal",
    "CS = LS * surface·ks·FS", "004",
    [LS, Input::rgb("surface"), Input::scalar("ks", "1", Domain::Unit), Input::scalar("fs", "1", Domain::Unit)] -> [RGB],
    |ls, surface, ks, fs; out| { out.vector(lighting::highlight_metal(ls, surface, ks, fs)); },
);

const KD: Input = Input::scalar("kd", "1", Domain::Unit);
const KS: Input = Input::scalar("ks", "1", Domain::Unit);
const T: Input = Input::scalar("t", "1", Domain::Unit);

macro_rules! along_an_edge {
    ($name:ident, $id:literal, $function:literal, $shading:path, $text:literal, $source:literal
        $(, normalised $normalised:literal)? $(, stable $bound:literal $size:ident $because:literal)?
        $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// Shading between two vertices.
            $name: $id by $function, $text, $source, $(normalised $normalised,)?
            [
                Input::position("pa"), Input::vector("na"), Input::position("pb"), Input::vector("nb"), T,
                LIGHT_POSITION, KD, KS, SHININESS,
            ] -> [INTENSITY],
            fit fit::edge,
            $(stable $bound $size $because,)?
            |pa, na, pb, nb, t, position, kd, ks, shininess; out| {
                let (a, b) = (Vertex { p: pa, n: na }, Vertex { p: pb, n: nb });
                out.scalar($shading(a, b, t, position, [kd, ks, shininess]));
            }
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
    hard[Hard::new("no-highlight-between", "document 004: both vertices dark, so is the middle", BETWEEN)]
);
along_an_edge!(
    PhongShading, "lighting/phong-shading", "lighting_phong_shading", lighting::phong,
    "I(mix(pa, pb, t), ⟨mix(na, nb, t)⟩): position and normal interpolated, lit at the point", "000 §6.3, 004", normalised true,
    stable 16384.0 Unit "a shininess of 100 times the 40 roundings of a cosine of three normalised vectors, twice by the mirror, and pow's 2⁻²¹",
    hard [
        Hard::new("highlight-between", "document 004: both vertices dark, the middle bright", BETWEEN)
            .naive("lighting/gouraud", "interpolates two dark vertices: no highlight", 1e6),
        Hard::new("opposite-normals", "nothing is left to normalise: the normal is 0, not NaN", &[("na", &[0.0, 0.0, 1.0]), ("nb", &[0.0, 0.0, -1.0]), ("t", &[0.5])]),
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
    ("na", &[-1.0, 0.0, 0.1]),
    ("pb", &[1.0, 0.0, -5.0]),
    ("nb", &[1.0, 0.0, 0.1]),
    ("t", &[0.5]),
    ("position", &[0.0, 0.0, 0.0]),
    ("kd", &[0.0]),
    ("ks", &[1.0]),
    ("shininess", &[100.0]),
];

formula!(
    /// Flat shading.
    Flat: "lighting/flat" by "lighting_flat",
    "I of the face's own normal ⟨(b − a) × (c − a)⟩ at its first vertex", "004", normalised true,
    [Input::position("a"), Input::position("b"), Input::position("c"), LIGHT_POSITION, KD, KS, SHININESS] -> [INTENSITY],
    fit fit::face,
    |a, b, c, position, kd, ks, shininess; out| { out.scalar(lighting::flat([a, b, c], position, [kd, ks, shininess])); },
    hard [
        Hard::new("no-area", "0, not NaN, for three points on a line", &[("a", &[0.0, 0.0, -1.0]), ("b", &[1.0, 1.0, -1.0]), ("c", &[2.0, 2.0, -1.0])]),
        Hard::new("tiny", "edges of 1e-9 have a normal", &[
            ("a", &[-1e-9, -1e-9, -8e-9]), ("b", &[1.5e-9, -1e-9, -8.5e-9]), ("c", &[0.0, 1.5e-9, -8e-9]), ("position", &[2e-9, 3e-9, -2e-9]),
        ]),
    ],
);

const POWER: Output = Output::new("fs", ValueShape::Scalar, "1");
const MIRROR: &[f32] = &[0.6, 0.0, 0.8];
/// Vectors at 89.997° to each other.
const BARELY: &[(&str, &[f32])] = &[("a", &[0.999_999_9, 0.0, 6e-5]), ("b", &[0.0, 0.0, 1.0]), ("exponent", &[1.0])];
/// Vectors as nearly at right angles as anybody would cut off.
const LEAST: &[(&str, &[f32])] = &[("a", &[1.0, 0.0, 1e-12]), ("b", &[0.0, 0.0, 1.0]), ("exponent", &[1.0])];

formula!(
    /// A highlight's power.
    CosinePower: "lighting/cosine-power" by "lighting_cosine_power",
    "FS = max(a·b, 0)^exponent", "000 §6.3, 004",
    [Input::direction("a"), Input::direction("b"), Input::scalar("exponent", "1", Domain::LogUniform(1.0, 256.0))] -> [POWER],
    fit toward_each_other,
    |a, b, exponent; out| { out.scalar(lighting::cosine_power(a, b, exponent)); },
    hard [
        Hard::new("barely-lit", "however small, a cosine above 0 counts", BARELY),
        Hard::new("least-lit", "1e-12 is above 0, too", LEAST),
        Hard::new("no-exponent", "1 for a cosine above 0", &[("a", &[0.0, 0.6, 0.8]), ("b", &[0.0, 0.0, 1.0]), ("exponent", &[0.0])]),
    ],
);
formula!(
    /// A highlight's power without its guard.
    CosinePowerUnguarded: "lighting/cosine-power-unguarded" by "lighting_cosine_power_unguarded",
    "FS = (a·b)^exponent", "000 §6.3 without its max",
    [Input::direction("a"), Input::direction("b"), Input::scalar("exponent", "1", Domain::LogUniform(1.0, 256.0))] -> [POWER],
    fit toward_each_other_only,
    |a, b, exponent; out| { out.scalar(lighting::cosine_power_unguarded(a, b, exponent)); },
    hard [
        Hard::new("barely-lit", "however small, a cosine above 0 counts", BARELY),
        Hard::new("least-lit", "1e-12 is above 0, too", LEAST),
    ],
);
formula!(
    /// A highlight's power by the chord.
    CosinePowerByChord: "lighting/cosine-power-by-chord" by "lighting_cosine_power_by_chord",
    "FS = exp(exponent·ln(1 − q)), q = ½|a − b|²; as published for exponents of 64 and below and for angles above 60°", "000 §6.3, 004",
    [Input::direction("a"), Input::direction("b"), Input::scalar("exponent", "1", Domain::LogUniform(1.0, 4096.0))] -> [POWER],
    fit toward_each_other,
    stable 32.0 Unit "above an exponent of 64: q errs by 8 roundings of itself, of which q·exponent·(1 − q)^exponent takes at most 0.37, and exp by 3 ULP and more; at 64 and below as pow",
    |a, b, exponent; out| { out.scalar(lighting::cosine_power_by_chord(a, b, exponent)); },
    hard [
        Hard::new("mirror-1e4", "1 where a = b, however they are rounded", &[("a", MIRROR), ("b", MIRROR), ("exponent", &[1e4])])
            .naive("lighting/cosine-power", "a·b is a few ULP from 1", 1e3),
        Hard::new("mirror-1e6", "1 where a = b, however they are rounded", &[("a", MIRROR), ("b", MIRROR), ("exponent", &[1e6])])
            .naive("lighting/cosine-power", "a·b is a few ULP from 1", 1e5),
        Hard::new("above-one-1e6", "never more than 1", &[("a", &[0.6, 0.0, 0.800_000_2]), ("b", &[0.6, 0.0, 0.800_000_2]), ("exponent", &[1e6])])
            .naive("lighting/cosine-power", "a cosine above 1 gives a highlight above 1", 1e5),
        Hard::new("above-one-just-above-64", "above 64 by the chord, which gives 1 where a = b", &[("a", &[0.6, 0.0, 0.800_000_2]), ("b", &[0.6, 0.0, 0.800_000_2]), ("exponent", &[64.03])]),
        Hard::new("above-one-above-64", "likewise", &[("a", &[0.6, 0.0, 0.800_000_2]), ("b", &[0.6, 0.0, 0.800_000_2]), ("exponent", &[64.5])]),
        Hard::new("half-1e3", "half as bright at 2.1°", &[("a", &[0.0, 0.0, 1.0]), ("b", &[0.037_228_2, 0.0, 0.999_306_8]), ("exponent", &[1e3])])
            .naive("lighting/cosine-power", "a·b near 1 has no digits for the angle, which a − b keeps", 100.0),
        Hard::new("half-1e4", "half as bright at 0.67°", &[("a", &[0.0, 0.0, 1.0]), ("b", &[0.011_773_7, 0.0, 0.999_930_7]), ("exponent", &[1e4])])
            .naive("lighting/cosine-power", "a·b near 1 has no digits for the angle, which a − b keeps", 1e3),
        Hard::new("half-1e5", "half as bright at 0.21°", &[("a", &[0.0, 0.0, 1.0]), ("b", &[0.003_723_3, 0.0, 0.999_993_1]), ("exponent", &[1e5])])
            .naive("lighting/cosine-power", "a·b near 1 has no digits for the angle, which a − b keeps", 1e4),
        Hard::new("half-1e6", "half as bright at 0.07°", &[("a", &[0.0, 0.0, 1.0]), ("b", &[0.001_177_4, 0.0, 0.999_999_3]), ("exponent", &[1e6])])
            .naive("lighting/cosine-power", "a·b near 1 has no digits for the angle, which a − b keeps", 1e5),
        Hard::new("barely-lit", "however small, a cosine above 0 counts", BARELY),
        Hard::new("least-lit", "1e-12 is above 0, too", LEAST),
        Hard::new("no-exponent", "1 for a cosine above 0", &[("a", &[0.0, 0.6, 0.8]), ("b", &[0.0, 0.0, 1.0]), ("exponent", &[0.0])]),
        Hard::new("behind-even", "0, never the even power of a negative cosine", &[("a", &[0.0, 0.0, -1.0]), ("b", &[0.0, 0.0, 1.0]), ("exponent", &[2.0])])
            .naive("lighting/cosine-power-unguarded", "NaN, or 1", 1e6),
        Hard::new("behind", "0, not NaN", &[("a", &[0.0, -0.6, -0.8]), ("b", &[0.0, 0.0, 1.0]), ("exponent", &[32.5])])
            .naive("lighting/cosine-power-unguarded", "NaN", 1e3),
    ],
);

/// Half of all pairs of directions look away from each other, where the power is 0: keep a quarter of those.
fn toward_each_other(_: &Spec, row: &mut [f32]) {
    let away = (0..3).map(|k| row[k] * row[3 + k]).sum::<f32>() < 0.0;
    if away && row[0].to_bits() & 3 != 0 {
        row[..3].iter_mut().for_each(|x| *x = -*x);
    }
}

/// A negative base has no power: turn every such pair round, and keep off the right angle.
fn toward_each_other_only(_: &Spec, row: &mut [f32]) {
    let cosine = (0..3).map(|k| row[k] * row[3 + k]).sum::<f32>();
    if cosine < 0.0 {
        row[..3].iter_mut().for_each(|x| *x = -*x);
    }
    if cosine.abs() < 1e-3 {
        row.copy_within(3..6, 0);
    }
}

formula!(
    /// Blinn's model, stable throughout.
    BlinnStable: "lighting/blinn-stable" by "lighting_blinn_stable",
    "CF as lighting/blinn, vectors of any length, the highlight 0 where l·n ≤ 0 and its power by the chord", "000 §6.4, 004; ruling 9, `opengl`",
    [LA, LD, LS, MA, MD, MS, SHININESS, P, NORMAL, DIRECTION] -> [RGBA],
    fit fit::surface,
    stable 2048.0 Unit "up to a shininess of 64 pow, whose log2 errs by 2⁻²¹, 5 roundings for each unit of it, on a cosine of 40; by the chord 16 roundings and more with √shininess",
    |la, ld, ls, ma, md, ms, shininess, p, normal, direction; out| {
        let (light, material) = (light([la, ld, ls]), material([ma, md, ms], shininess));
        out.vector(lighting::blinn_stable(&light, &material, [p, normal, direction]));
    },
    hard [
        Hard::new("light-in-the-surface", "no highlight where l·n is 0", &[
            ("ls", WHITE), ("ms", WHITE), ("shininess", &[2.0]), ("p", &[0.0, 0.0, -4.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[-1.0, 0.0, 0.0]),
        ]),
        Hard::new("eye-behind-the-light", "half a vector of nothing: no highlight", &[("ld", WHITE), ("ls", WHITE), ("md", GREY), ("ms", WHITE), ("p", &[0.0, 0.0, -1.0]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[0.001, 0.0, 1.0]), ("shininess", &[1.0])])
            .naive("lighting/blinn", "lit from behind", 5e3),
        Hard::new("light-at-95-degrees", "a highlight on the dark side", &[("ld", WHITE), ("ls", WHITE), ("md", GREY), ("ms", WHITE), ("p", &[-0.996, 0.0, -0.0872]), ("normal", &[0.0, 0.0, 1.0]), ("direction", &[0.996_194_7, 0.0, 0.087_155_7]), ("shininess", &[0.5])])
            .naive("lighting/blinn", "lit from behind", 1e4),
        Hard::new("light-of-1e-23", "a direction of any length", &[("ld", WHITE), ("md", GREY), ("ms", BLACK), ("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 0.6, 0.8]), ("direction", &[0.0, 0.0, -1e-23])])
            .naive("lighting/blinn", "taken for no light", 1e6),
        Hard::new("normal-of-1e-25", "a normal of any length", &[("ld", WHITE), ("md", GREY), ("ms", BLACK), ("p", &[0.0, 0.0, -5.0]), ("normal", &[0.0, 6e-26, 8e-26]), ("direction", &[0.0, 0.0, -1.0])])
            .naive("lighting/blinn", "taken for no normal", 1e6),
        Hard::new("surface-at-1e20", "a point at any distance", &[("ld", BLACK), ("md", BLACK), ("ls", WHITE), ("ms", WHITE), ("p", &[-6e19, 0.0, -8e19]), ("normal", &[0.6, 0.0, 1.8]), ("direction", &[0.0, 0.0, -1.0]), ("shininess", &[32.0])])
            .naive("lighting/blinn", "the view vector is 0, and the half vector the light's", 1e6),
        Hard::new("highlight-of-1e6", "the sharpest highlight at its middle", &[("ld", BLACK), ("md", BLACK), ("ls", WHITE), ("ms", WHITE), ("p", &[-0.25, -0.2, -0.25]), ("normal", &[0.1, 0.2, 0.3]), ("direction", &[0.05, -0.2, -0.35]), ("shininess", &[1e6])])
            .naive("lighting/blinn", "the cosine is a few ULP from 1", 1e5),
    ],
);

const WHITE: &[f32] = &[1.0, 1.0, 1.0];
const GREY: &[f32] = &[0.5, 0.5, 0.5];
const BLACK: &[f32] = &[0.0, 0.0, 0.0];

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
    visitor.formula(CosinePower);
    visitor.formula(CosinePowerUnguarded);
    visitor.formula(CosinePowerByChord);
    visitor.formula(BlinnStable);
}
