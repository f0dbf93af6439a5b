//! Cases of vectors and transforms. Formulas: `lightmeter_reference::vector`.

use super::Visitor;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, ValueShape};
use lightmeter_reference::vector;

const fn vec3(name: &'static str) -> Output {
    Output::new(name, ValueShape::Vec3, "1")
}

const fn transform(name: &'static str, shape: ValueShape) -> Input {
    Input::new(name, shape, "1", Domain::Transform(0.5, 2.0))
}

const EYE: Output = Output::new("p", ValueShape::Vec3, "unit");

formula!(
    /// reflect, of the direction of travel.
    Reflect: "vector/reflect" by "vector_reflect",
    "r = i − 2(i·n)n", "000 §6.3",
    [Input::direction("i"), Input::direction("n")] -> [vec3("r")],
    |i, n; out| { out.vector(vector::reflect(i, n)); },
    hard [
        Hard::new("straight-down", "comes back", &[("i", &[0.0, 0.0, -1.0])]),
        Hard::new("grazing", "goes on", &[("i", &[1.0, 0.0, 0.0])]),
        Hard::new("no-normal", "i itself", &[("n", &[0.0, 0.0, 0.0])]),
    ],
);
formula!(
    /// reflect, of the vector to the light.
    ReflectToward: "vector/reflect-toward" by "vector_reflect_toward",
    "r = −l + 2(l·n)n", "004",
    [Input::direction("l"), Input::direction("n")] -> [vec3("r")],
    |l, n; out| { out.vector(vector::reflect_toward(l, n)); },
);
formula!(
    /// The halfway vector.
    Halfway: "vector/halfway" by "vector_halfway",
    "h = ⟨v + l⟩", "004; ruling 3", normalised true,
    [Input::direction("v"), Input::direction("l")] -> [vec3("h")],
    stable 16.0 Own "an exact sum of opposite vectors, then a normalisation of 16",
    |v, l; out| { out.vector(vector::halfway(v, l)); },
    hard [
        Hard::new("half-vector-of-nothing", "0 where v = −l, not NaN", &[("v", &[0.0, 0.0, 1.0]), ("l", &[0.0, 0.0, -1.0])])
            .naive("vector/halfway-unguarded", "0/0", f64::INFINITY),
        Hard::new("nearly-opposite", "what is left after cancellation is normalised", &[("v", &[0.0, 0.0, 1.0]), ("l", &[1e-3, 0.0, -1.0])]),
        Hard::new("same", "v itself", &[("v", &[0.6, 0.0, 0.8]), ("l", &[0.6, 0.0, 0.8])]),
    ],
);
formula!(
    /// The halfway vector of document 000.
    HalfwayUnnormalised: "vector/halfway-unnormalised" by "vector_halfway_unnormalised",
    "h = v + l", "000 §6.4, a dialect",
    [Input::direction("v"), Input::direction("l")] -> [vec3("h")],
    |v, l; out| { out.vector(vector::halfway_unnormalised(v, l)); },
);
formula!(
    /// normalize.
    Normalize: "vector/normalize" by "vector_normalize",
    "⟨v⟩ = v/|v|, 0 for the zero vector", "000 §6.3", normalised true,
    [Input::new("v", ValueShape::Vec3, "1", Domain::Vector(1e-6, 1e6))] -> [vec3("v")],
    |v; out| { out.vector(vector::normalize(v)); },
    hard [
        Hard::new("zero", "0, not NaN", &[("v", &[0.0, 0.0, 0.0])]),
        Hard::new("tiny", "the square underflows: nothing is promised of the published form", &[("v", &[1e-23, 1e-23, 1e-23])]),
        Hard::new("huge", "the square overflows: nothing is promised of the published form", &[("v", &[1.9e19, 0.0, 0.0])]),
        Hard::new("smallest-promised", "the square is just normal", &[("v", &[2e-19, 0.0, 0.0])]),
        Hard::new("axis", "stays what it is", &[("v", &[0.0, -1.0, 0.0])]),
        Hard::new("nearly-an-axis", "a component counts, however small", &[("v", &[3e-13, -2.0, 4e-20])]),
        Hard::new("longest-promised", "the square is just a number", &[("v", &[6e18, -8e18, 0.0])]),
    ],
);
formula!(
    /// Normals by the modelview.
    NormalModelview: "vector/normal-modelview" by "vector_normal_modelview",
    "n′ = modelview·(n, 0)", "000 §6.3, 003; a dialect",
    [transform("modelview", ValueShape::Mat3), Input::direction("n")] -> [vec3("n")],
    |modelview, n; out| { out.vector(vector::normal_modelview(&modelview, n)); },
);
formula!(
    /// Normals by the inverse transpose.
    NormalInverseTranspose: "vector/normal-inverse-transpose" by "vector_normal_inverse_transpose",
    "n′ = modelview⁻ᵀ·n", "004; ruling 6",
    [transform("modelview", ValueShape::Mat3), Input::direction("n")] -> [vec3("n")],
    |modelview, n; out| { out.vector(vector::normal_inverse_transpose(&modelview, n)); },
    hard [
        Hard::new("reflection", "a negative determinant", &[("modelview", &[-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]), ("n", &[0.6, 0.0, 0.8])]),
        Hard::new("nearly-a-rotation", "a determinant of 1.00005 divides as any other", &[("modelview", &[0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.000_05]), ("n", &[0.6, 0.0, 0.8])]),
        Hard::new("flat", "a scale of 1e-3 along one axis", &[("modelview", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-3]), ("n", &[0.6, 0.0, 0.8])]),
    ],
);
formula!(
    /// A light's direction in eye space.
    LightDirection: "vector/light-direction" by "vector_light_direction",
    "view·(direction, 0)", "000 §6.3",
    [transform("view", ValueShape::Mat4), Input::direction("direction")] -> [vec3("direction")],
    |view, direction; out| { out.vector(vector::light_direction(&view, direction)); },
);
formula!(
    /// A light's position in eye space.
    LightPosition: "vector/light-position" by "vector_light_position",
    "xyz/w of modelview·position; xyz where w = 0", "004",
    [
        transform("modelview", ValueShape::Mat4),
        Input::new("position", ValueShape::Vec4, "unit", Domain::Uniform(0.5, 10.0)),
    ] -> [EYE],
    |modelview, position; out| { out.vector(vector::light_position(&modelview, position)); },
    hard [
        Hard::new("at-infinity", "w = 0: a direction, undivided", &[("position", &[0.5, 0.25, -0.75, 0.0])]),
        Hard::new("at-no-height", "only w = 0 leaves it undivided", &[("position", &[0.5, 0.0, -0.75, 2.0])]),
        Hard::new("behind-infinity", "a negative w turns it round", &[("position", &[1.0, 2.0, 3.0, -2.0])]),
        Hard::new("nearly-near", "however near 1, w divides", &[("position", &[5.0, 2.5, -7.5, 1.000_005])]),
        Hard::new("nearly-at-infinity", "however small, w divides", &[("position", &[0.5, 0.25, -0.75, 5e-7])]),
        Hard::new("as-far-as-numbers-go", "however small, w divides", &[("position", &[0.5, 0.25, -0.75, 1e-37])]),
    ],
);
formula!(
    /// A light that moves with a model.
    LightWithModel: "vector/light-with-model" by "vector_light_with_model",
    "view·(model·(position, 1))", "004",
    [transform("view", ValueShape::Mat4), transform("model", ValueShape::Mat4), Input::position("position")] -> [EYE],
    |view, model, position; out| { out.vector(vector::light_with_model(&view, &model, position)); },
);
formula!(
    /// From a surface point to a light.
    Toward: "vector/toward" by "vector_toward",
    "l = ⟨light − p⟩", "000 §6.4, 003; ruling 2", normalised true,
    [Input::position("light"), Input::position("p")] -> [vec3("l")],
    |light, p; out| { out.vector(vector::toward(light, p)); },
    hard [
        Hard::new("light-on-the-surface", "0, not NaN", &[("light", &[1.0, 2.0, -3.0]), ("p", &[1.0, 2.0, -3.0])]),
    ],
);
formula!(
    /// Face normals averaged at a vertex.
    AverageNormal: "vector/average-normal" by "vector_average_normal",
    "⟨n0 + n1 + n2⟩", "004", normalised true,
    [Input::direction("n0"), Input::direction("n1"), Input::direction("n2")] -> [vec3("n")],
    |n0, n1, n2; out| { out.vector(vector::average_normal([n0, n1, n2])); },
);
formula!(
    /// The normal of a face.
    FaceNormal: "vector/face-normal" by "vector_face_normal",
    "n = ⟨(b − a) × (c − a)⟩", "004", normalised true,
    [Input::position("a"), Input::position("b"), Input::position("c")] -> [vec3("n")],
    |a, b, c; out| { out.vector(vector::face_normal(a, b, c)); },
    hard [
        Hard::new("no-area", "0 for three points on a line", &[("a", &[0.0, 0.0, 0.0]), ("b", &[1.0, 1.0, 1.0]), ("c", &[2.0, 2.0, 2.0])]),
        Hard::new("short-side-c", "c is 0.02 from a, and b is 60", &[("a", &[1.1, 2.3, 0.7]), ("b", &[41.9, -33.3, 25.1]), ("c", &[1.11, 2.32, 0.69])]),
        Hard::new("short-side-b", "b is 0.02 from a, and c is 60", &[("a", &[1.1, 2.3, 0.7]), ("b", &[1.11, 2.32, 0.69]), ("c", &[41.9, -33.3, 25.1])]),
    ],
);

const V: Input = Input::new("v", ValueShape::Vec3, "1", Domain::Vector(1e-6, 1e6));
const LENGTH: Output = Output::new("length", ValueShape::Scalar, "1");

formula!(
    /// normalize without its guard.
    NormalizeUnguarded: "vector/normalize-unguarded" by "vector_normalize_unguarded",
    "v/|v|", "WGSL, normalize",
    [V] -> [vec3("v")],
    |v; out| { out.vector(vector::normalize_unguarded(v)); },
);
formula!(
    /// normalize of any length.
    NormalizeScaled: "vector/normalize-scaled" by "vector_normalize_scaled",
    "⟨v·2ᵏ⟩ with the largest component of v·2ᵏ in [2⁻²⁰, 2²⁰); 0 for the zero vector", "000 §6.3, at any length", normalised true,
    [V] -> [vec3("v")],
    stable 16.0 Own "an inverse root of 2 ULP or a division of 2½, and the half of three squares' errors",
    |v; out| { out.vector(vector::normalize_scaled(v)); },
    hard [
        Hard::new("zero", "0, not NaN", &[("v", &[0.0, 0.0, 0.0])])
            .naive("vector/normalize-unguarded", "0/0", f64::INFINITY),
        Hard::new("length-1e-20", "the squares are subnormal", &[("v", &[1e-20, -1e-20, 1e-20])])
            .naive("vector/normalize", "a square of 1e-40 is flushed, or has few bits", 20.0),
        Hard::new("length-1e-22", "the squares are subnormal", &[("v", &[1e-22, 1e-22, 1e-22])])
            .naive("vector/normalize", "a square of 1e-44 has 3 bits, or none", 1e5),
        Hard::new("length-1e-23", "the squares underflow", &[("v", &[1e-23, 2e-23, -1e-23])])
            .naive("vector/normalize", "0 or ∞", 1e6),
        Hard::new("length-1e-30", "the squares underflow", &[("v", &[3e-30, 4e-30, 0.0])])
            .naive("vector/normalize", "taken for the zero vector", 1e7),
        Hard::new("length-1e-37", "barely a normal number", &[("v", &[3e-37, 4e-37, 5e-37])])
            .naive("vector/normalize", "taken for the zero vector", 1e7),
        Hard::new("length-1.9e19", "the square overflows", &[("v", &[1.9e19, 0.0, 0.0])])
            .naive("vector/normalize", "1/∞ is 0", 1e7),
        Hard::new("length-1e30", "the squares overflow", &[("v", &[1e30, -1e30, 2e30])])
            .naive("vector/normalize", "1/∞ is 0", 1e7),
        Hard::new("length-3e38", "nearly the greatest number", &[("v", &[2e38, 3e38, 1e38])])
            .naive("vector/normalize", "1/∞ is 0", 1e7),
        Hard::new("uneven", "one component is all", &[("v", &[1e25, 1e-20, 1.0])])
            .naive("vector/normalize", "1/∞ is 0", 1e7),
    ],
);
formula!(
    /// length.
    Length: "vector/length" by "vector_length",
    "|v| = √(v·v)", "WGSL, length",
    [V] -> [LENGTH],
    |v; out| { out.scalar(vector::length(v)); },
);
formula!(
    /// length at any length.
    LengthScaled: "vector/length-scaled" by "vector_length_scaled",
    "|v·2ᵏ|·2⁻ᵏ", "at any length",
    [V] -> [LENGTH],
    stable 16.0 Own "a root as 1/inverseSqrt: 4½ ULP, and the half of three squares' errors",
    |v; out| { out.scalar(vector::length_scaled(v)); },
    hard [
        Hard::new("tiny", "the squares underflow", &[("v", &[3e-25, 4e-25, 0.0])])
            .naive("vector/length", "0", 1e7),
        Hard::new("small", "the squares are subnormal", &[("v", &[1e-22, 1e-22, 1e-22])])
            .naive("vector/length", "a square of 1e-44 has 3 bits, or none", 1e5),
        Hard::new("huge", "the squares overflow", &[("v", &[3e25, 4e25, 0.0])])
            .naive("vector/length", "∞", f64::INFINITY),
        Hard::new("giant", "a component of 2e30, which is scaled by less than 2⁻¹⁰⁰", &[("v", &[2e30, 0.0, 0.0])]),
        Hard::new("least", "right down to 2⁻¹²⁶", &[("v", &[5e-38, 0.0, 0.0])]),
    ],
);
formula!(
    /// The halfway vector without its guard.
    HalfwayUnguarded: "vector/halfway-unguarded" by "vector_halfway_unguarded",
    "h = (v + l)/|v + l|", "004, taken literally",
    [Input::direction("v"), Input::direction("l")] -> [vec3("h")],
    |v, l; out| { out.vector(vector::halfway_unguarded(v, l)); },
);
formula!(
    /// reflect about a normal of any length.
    ReflectAnyNormal: "vector/reflect-any-normal" by "vector_reflect_any_normal",
    "r = i − 2(i·⟨n⟩)⟨n⟩", "000 §6.3, the normal normalised at any length", normalised true,
    [Input::direction("i"), Input::vector("n")] -> [vec3("r")],
    stable 64.0 Own "twice the normal's 16 roundings twice over",
    |i, n; out| { out.vector(vector::reflect_any_normal(i, n)); },
    hard [
        Hard::new("normal-of-0.9", "|r| = |i|", &[("i", &[0.6, 0.0, -0.8]), ("n", &[0.0, 0.0, 0.9])])
            .naive("vector/reflect", "|r| is 0.8", 1e6),
        Hard::new("normal-of-1.1", "|r| = |i|", &[("i", &[0.6, 0.0, -0.8]), ("n", &[0.0, 0.0, 1.1])])
            .naive("vector/reflect", "|r| is 1.3", 1e6),
        Hard::new("between-two-vertices", "a normal interpolated between two at right angles", &[("i", &[0.6, 0.0, -0.8]), ("n", &[0.5, 0.0, 0.5])])
            .naive("vector/reflect", "the mirrored vector goes half the way", 1e6),
        Hard::new("tiny-normal", "a mirror however small its normal", &[("i", &[0.6, 0.0, -0.8]), ("n", &[0.0, 3e-24, 4e-24])])
            .naive("vector/reflect", "nothing is mirrored", 1e7),
    ],
);
formula!(
    /// Normals by the inverse transpose, normalised.
    NormalByDeterminant: "vector/normal-by-determinant" by "vector_normal_by_determinant",
    "n′ = ⟨cofactors·n/determinant⟩", "004; ruling 6", normalised true,
    [transform("modelview", ValueShape::Mat3), Input::direction("n")] -> [vec3("n")],
    |modelview, n; out| { out.vector(vector::normal_by_determinant(&modelview, n)); },
);
formula!(
    /// Normals by the cofactors alone.
    NormalByCofactors: "vector/normal-by-cofactors" by "vector_normal_by_cofactors",
    "n′ = ±⟨Σ nᵢ·sᵢ·cofactorᵢ⟩ of columns scaled by powers of two sᵢ, by the determinant's sign", "Lengyel; ruling 6", normalised true,
    [transform("modelview", ValueShape::Mat3), Input::direction("n")] -> [vec3("n")],
    stable 64.0 Own "nine cofactors and a product that do not cancel, then a normalisation of 16",
    |modelview, n; out| { out.vector(vector::normal_by_cofactors(&modelview, n)); },
    hard [
        Hard::new("flattened-1e-20", "a scale of 1e-20 along one axis", &[("modelview", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-20]), ("n", &[0.6, 0.0, 0.8])])
            .naive("vector/normal-by-determinant", "cofactors over the determinant have a square of 1e40", 1e6),
        Hard::new("flattened-1e-30", "a scale of 1e-30 along one axis", &[("modelview", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-30]), ("n", &[0.6, 0.0, 0.8])])
            .naive("vector/normal-by-determinant", "cofactors over the determinant have a square of 1e60", 1e6),
        Hard::new("shrunk-1e-16", "a uniform scale of 1e-16", &[("modelview", &[1e-16, 0.0, 0.0, 0.0, 1e-16, 0.0, 0.0, 0.0, 1e-16]), ("n", &[0.6, 0.0, 0.8])])
            .naive("vector/normal-by-determinant", "the determinant of 1e-48 underflows", 1e6),
        Hard::new("shrunk-1e-25", "a uniform scale of 1e-25", &[("modelview", &[1e-25, 0.0, 0.0, 0.0, 1e-25, 0.0, 0.0, 0.0, 1e-25]), ("n", &[0.6, 0.0, 0.8])])
            .naive("vector/normal-by-determinant", "the cofactors underflow", 1e6),
        Hard::new("grown-1e13", "a uniform scale of 1e13", &[("modelview", &[1e13, 0.0, 0.0, 0.0, 1e13, 0.0, 0.0, 0.0, 1e13]), ("n", &[0.6, 0.0, 0.8])])
            .naive("vector/normal-by-determinant", "the determinant overflows", 1e6),
        Hard::new("mirrored-and-flattened", "a reflection turns the cofactors round", &[("modelview", &[-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-20]), ("n", &[0.6, 0.0, 0.8])])
            .naive("vector/normal-by-determinant", "cofactors over the determinant have a square of 1e40", 1e6),
        Hard::new("mirrored-and-thin-1e-20", "two axes of 1e-20 under reflection", &[("modelview", &[-1.0, 0.0, 0.0, 0.0, 1e-20, 0.0, 0.0, 0.0, 1e-20]), ("n", &[0.0, 0.6, 0.8])])
            .naive("vector/normal-by-determinant", "the determinant of 1e-40 underflows, or its inverse overflows", 1e6),
        Hard::new("mirrored-and-thin-1e-30", "two axes of 1e-30 under reflection, the normal along the third", &[("modelview", &[-1.0, 0.0, 0.0, 0.0, 1e-30, 0.0, 0.0, 0.0, 1e-30]), ("n", &[1.0, 0.0, 0.0])])
            .naive("vector/normal-by-determinant", "the cofactor of 1e-60 underflows", 1e6),
        Hard::new("long-normal", "a normal of length 1e38, and columns of 1e10", &[("modelview", &[1e10, 0.0, 0.0, 0.0, 1e10, 0.0, 0.0, 0.0, 1e-10]), ("n", &[6e37, 0.0, 8e37])])
            .naive("vector/normal-by-determinant", "the normal's square overflows", 1e6),
        Hard::new("short-normal", "a normal of length 1e-37, and columns of 1e10", &[("modelview", &[1e10, 0.0, 0.0, 0.0, 1e10, 0.0, 0.0, 0.0, 1e10]), ("n", &[6e-38, 0.0, 8e-38])])
            .naive("vector/normal-by-determinant", "the normal's square underflows", 1e6),
        Hard::new("mirrored-and-parallel", "columns that differ by 1e-36, under reflection", &[("modelview", &[1.0, 0.0, -1e-3, 1.0, 0.0, 0.0, 1.0, 1e-36, 0.0]), ("n", &[0.6, 0.0, 0.8])])
            .naive("vector/normal-by-determinant", "the determinant of 1e-39 underflows", 1e6),
        Hard::new("grown-and-parallel", "columns of 1e36 that differ by 1e-3", &[("modelview", &[1e36, 0.0, 0.0, 1e36, 1e33, 0.0, 1e36, 0.0, 1e33]), ("n", &[1.0, 0.0, 0.0])])
            .naive("vector/normal-by-determinant", "the cofactors overflow", 1e6),
        Hard::new("flattened-to-a-plane", "a determinant of 0 does not turn the normal", &[("modelview", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]), ("n", &[0.0, 0.0, 0.5])]),
    ],
);
formula!(
    /// The normal of any face.
    FaceNormalCompensated: "vector/face-normal-compensated" by "vector_face_normal_compensated",
    "n = ⟨(b − a)·2ʲ × (c − a)·2ᵏ⟩, differences of products with their errors", "004, for faces of any size and slivers", normalised true,
    [Input::position("a"), Input::position("b"), Input::position("c")] -> [vec3("n")],
    stable 24.0 Own "2 roundings a component, then a normalisation of 16; for corners whose differences are exact",
    |a, b, c; out| { out.vector(vector::face_normal_compensated(a, b, c)); },
    hard [
        Hard::new("tiny", "edges of 1e-12", &[("a", &[0.0, 0.0, 0.0]), ("b", &[1e-12, 2e-12, 0.0]), ("c", &[-1e-12, 1e-12, 3e-12])])
            .naive("vector/face-normal", "the square of the cross product underflows", 1e6),
        Hard::new("tiniest", "edges of 1e-30", &[("a", &[0.0, 0.0, 0.0]), ("b", &[1e-30, 2e-30, 0.0]), ("c", &[-1e-30, 1e-30, 3e-30])])
            .naive("vector/face-normal", "the cross product underflows", 1e6),
        Hard::new("hugest", "edges of 1e30", &[("a", &[0.0, 0.0, 0.0]), ("b", &[1e30, 2e30, 0.0]), ("c", &[-1e30, 1e30, 3e30])])
            .naive("vector/face-normal", "the cross product overflows", 1e6),
        Hard::new("huge", "edges of 1e12", &[("a", &[0.0, 0.0, 0.0]), ("b", &[1e12, 2e12, 0.0]), ("c", &[-1e12, 1e12, 3e12])])
            .naive("vector/face-normal", "the square of the cross product overflows", 1e6),
        Hard::new("sliver", "edges that agree to 5 digits", &[("a", &[0.0, 0.0, 0.0]), ("b", &[0.7, 0.3, 0.2]), ("c", &[1.4, 0.600_01, 0.4])])
            .naive("vector/face-normal", "the rounding of the products is what is left", 1e3),
        Hard::new("tiny-sliver", "edges of 1e-33 that agree to 5 digits", &[("a", &[0.0, 0.0, 0.0]), ("b", &[0.7e-33, 0.3e-33, 0.2e-33]), ("c", &[1.4e-33, 0.600_01e-33, 0.4e-33])])
            .naive("vector/face-normal", "the products underflow", 1e6),
        Hard::new("needle", "edges that agree to the last bits", &[("a", &[0.0, 0.0, 0.0]), ("b", &[0.1, 0.3, 0.7]), ("c", &[0.7, 2.1, 4.9])])
            .naive("vector/face-normal", "any direction", 1e6),
    ],
);

const FACE: Input = Input::direction("face");
const BETWEEN: Input = Input::scalar("t", "1", Domain::Unit);

formula!(
    /// A normal between two vertices.
    InterpolatedNormal: "vector/interpolated-normal" by "vector_interpolated_normal",
    "n = ⟨mix(n0, n1, t)⟩", "000 §6.3, 004", normalised true,
    [Input::direction("n0"), Input::direction("n1"), FACE, BETWEEN] -> [vec3("n")],
    |n0, n1, face, t; out| {
        let [n0, n1, _] = [n0, n1, face];
        out.vector(vector::interpolated_normal(n0, n1, t));
    },
    hard [
        Hard::new("nearly-opposite", "ill-conditioned: what is left is 1e-3 of the normals", &[("n0", &[0.0, 0.6, 0.8]), ("n1", &[0.001, -0.6, -0.8]), ("t", &[0.5])]),
        Hard::new("opposite", "nothing is left: 0, not the face's normal", &[("n0", &[1.0, 0.0, 0.0]), ("n1", &[-1.0, 0.0, 0.0]), ("face", &[0.5, 0.0, 1.0]), ("t", &[0.5])]),
    ],
);
formula!(
    /// A normal between two vertices, or the face's.
    InterpolatedNormalGuarded: "vector/interpolated-normal-guarded" by "vector_interpolated_normal_guarded",
    "n = ⟨mix(n0, n1, t)⟩, the face's normal where the mix is below 2⁻¹⁰", "000 §6.3, 004, with a rule for opposite normals", normalised true,
    [Input::direction("n0"), Input::direction("n1"), FACE, BETWEEN] -> [vec3("n")],
    stable 16.0 Own "a normalisation of 16; where the mix is used, twice its condition of at most 2¹⁰ besides",
    |n0, n1, face, t; out| {
        let [n0, n1, face] = [n0, n1, face];
        out.vector(vector::interpolated_normal_guarded(n0, n1, face, t));
    },
    hard [
        Hard::new("opposite", "nothing is left to normalise", &[("n0", &[0.0, 0.6, 0.8]), ("n1", &[0.0, -0.6, -0.8]), ("face", &[1.0, 0.0, 0.0]), ("t", &[0.5])])
            .naive("vector/interpolated-normal", "0, or the direction of a rounding", 1e6),
        Hard::new("opposite-beside-a-long-face", "the face's normal is normalised", &[("n0", &[0.0, 0.6, 0.8]), ("n1", &[0.0, -0.6, -0.8]), ("face", &[3.0, 0.0, 4.0]), ("t", &[0.5])]),
        Hard::new("opposite-but-1e-6", "what is left is 1e-6", &[("n0", &[0.0, 0.6, 0.8]), ("n1", &[0.000_001, -0.6, -0.8]), ("face", &[0.0, 0.8, -0.6]), ("t", &[0.5])])
            .naive("vector/interpolated-normal", "2 rad off with the least change of t", 1e6),
        Hard::new("a-little-is-left", "half of 0.004 is above 2⁻¹⁰: the mix is used", &[("n0", &[0.0, 0.0, 1.0]), ("n1", &[0.004, 0.0, -1.0]), ("face", &[0.0, 1.0, 0.0]), ("t", &[0.5])]),
        Hard::new("barely-enough-is-left", "half of 0.002 is above 2⁻¹⁰, by a fortieth", &[("n0", &[0.0, 0.0, 1.0]), ("n1", &[0.002, 0.0, -1.0]), ("face", &[0.0, 1.0, 0.0]), ("t", &[0.5])]),
        Hard::new("barely-too-little-is-left", "half of 0.0019 is below 2⁻¹⁰, by a fortieth", &[("n0", &[0.0, 0.0, 1.0]), ("n1", &[0.001_9, 0.0, -1.0]), ("face", &[0.0, 1.0, 0.0]), ("t", &[0.5])]),
        Hard::new("too-little-is-left", "half of 0.0009 is below 2⁻¹⁰: the face's normal is used", &[("n0", &[0.0, 0.0, 1.0]), ("n1", &[0.000_9, 0.0, -1.0]), ("face", &[0.0, 1.0, 0.0]), ("t", &[0.5])]),
        Hard::new("exactly-enough-is-left", "2⁻¹⁰ itself is no less than 2⁻¹⁰: the mix is used", &[("n0", &[1.0, 0.0, 0.0]), ("n1", &[-1.0, 0.0, 0.0]), ("face", &[0.5, 0.0, 1.0]), ("t", &[0.499_511_72])]),
    ],
);

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(Reflect);
    visitor.formula(ReflectToward);
    visitor.formula(Halfway);
    visitor.formula(HalfwayUnnormalised);
    visitor.formula(Normalize);
    visitor.formula(NormalModelview);
    visitor.formula(NormalInverseTranspose);
    visitor.formula(LightDirection);
    visitor.formula(LightPosition);
    visitor.formula(LightWithModel);
    visitor.formula(Toward);
    visitor.formula(AverageNormal);
    visitor.formula(FaceNormal);
    visitor.formula(NormalizeUnguarded);
    visitor.formula(NormalizeScaled);
    visitor.formula(Length);
    visitor.formula(LengthScaled);
    visitor.formula(HalfwayUnguarded);
    visitor.formula(ReflectAnyNormal);
    visitor.formula(NormalByDeterminant);
    visitor.formula(NormalByCofactors);
    visitor.formula(FaceNormalCompensated);
    visitor.formula(InterpolatedNormal);
    visitor.formula(InterpolatedNormalGuarded);
}
