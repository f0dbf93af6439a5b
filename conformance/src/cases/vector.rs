//! Cases of vectors and transforms. Formulas: `lightmeter_reference::vector`.

use super::Visitor;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, Shape};
use lightmeter_reference::vector;

const fn vec3(name: &'static str) -> Output {
    Output::new(name, Shape::Vec3, "1")
}

const fn transform(name: &'static str, shape: Shape) -> Input {
    Input::new(name, shape, "1", Domain::Transform(0.5, 2.0))
}

const EYE: Output = Output::new("p", Shape::Vec3, "unit");

formula!(
    /// reflect, of the direction of travel.
    Reflect: "vector/reflect" by "vector_reflect",
    "r = i − 2(i·n)n", "000 §6.3",
    [Input::direction("i"), Input::direction("n")] -> [vec3("r")],
    |x, out| { out.vector(vector::reflect(x.vector(), x.vector())); },
    hard [
        Hard { name: "straight-down", pins: "comes back", inputs: &[("i", &[0.0, 0.0, -1.0])] },
        Hard { name: "grazing", pins: "goes on", inputs: &[("i", &[1.0, 0.0, 0.0])] },
        Hard { name: "short-normal", pins: "a normal of length 0.9 gives |r| below 1", inputs: &[("i", &[0.6, 0.0, -0.8]), ("n", &[0.0, 0.0, 0.9])] },
        Hard { name: "no-normal", pins: "i itself", inputs: &[("n", &[0.0, 0.0, 0.0])] },
    ],
);
formula!(
    /// reflect, of the vector to the light.
    ReflectToward: "vector/reflect-toward" by "vector_reflect_toward",
    "r = −l + 2(l·n)n", "004",
    [Input::direction("l"), Input::direction("n")] -> [vec3("r")],
    |x, out| { out.vector(vector::reflect_toward(x.vector(), x.vector())); },
);
formula!(
    /// The halfway vector.
    Halfway: "vector/halfway" by "vector_halfway",
    "h = ⟨v + l⟩", "004; ruling 3",
    [Input::direction("v"), Input::direction("l")] -> [vec3("h")],
    |x, out| { out.vector(vector::halfway(x.vector(), x.vector())); },
    hard [
        Hard { name: "half-vector-of-nothing", pins: "0 where v = −l, not NaN", inputs: &[("v", &[0.0, 0.0, 1.0]), ("l", &[0.0, 0.0, -1.0])] },
        Hard { name: "nearly-opposite", pins: "what is left after cancellation is normalised", inputs: &[("v", &[0.0, 0.0, 1.0]), ("l", &[1e-3, 0.0, -1.0])] },
        Hard { name: "same", pins: "v itself", inputs: &[("v", &[0.6, 0.0, 0.8]), ("l", &[0.6, 0.0, 0.8])] },
    ],
);
formula!(
    /// The halfway vector of document 000.
    HalfwayUnnormalised: "vector/halfway-unnormalised" by "vector_halfway_unnormalised",
    "h = v + l", "000 §6.4, a dialect",
    [Input::direction("v"), Input::direction("l")] -> [vec3("h")],
    |x, out| { out.vector(vector::halfway_unnormalised(x.vector(), x.vector())); },
);
formula!(
    /// normalize.
    Normalize: "vector/normalize" by "vector_normalize",
    "⟨v⟩ = v/|v|, 0 for the zero vector", "000 §6.3",
    [Input::new("v", Shape::Vec3, "1", Domain::Vector(1e-6, 1e6))] -> [vec3("v")],
    |x, out| { out.vector(vector::normalize(x.vector())); },
    hard [
        Hard { name: "zero", pins: "0, not NaN", inputs: &[("v", &[0.0, 0.0, 0.0])] },
        Hard { name: "tiny", pins: "the square underflows: nothing is promised of the published form", inputs: &[("v", &[1e-23, 1e-23, 1e-23])] },
        Hard { name: "huge", pins: "the square overflows: nothing is promised of the published form", inputs: &[("v", &[1.9e19, 0.0, 0.0])] },
        Hard { name: "smallest-promised", pins: "the square is just normal", inputs: &[("v", &[2e-19, 0.0, 0.0])] },
        Hard { name: "axis", pins: "stays what it is", inputs: &[("v", &[0.0, -1.0, 0.0])] },
    ],
);
formula!(
    /// Normals by the modelview.
    NormalModelview: "vector/normal-modelview" by "vector_normal_modelview",
    "n′ = modelview·(n, 0)", "000 §6.3, 003; a dialect",
    [transform("modelview", Shape::Mat3), Input::direction("n")] -> [vec3("n")],
    |x, out| { out.vector(vector::normal_modelview(&x.mat3(), x.vector())); },
);
formula!(
    /// Normals by the inverse transpose.
    NormalInverseTranspose: "vector/normal-inverse-transpose" by "vector_normal_inverse_transpose",
    "n′ = modelview⁻ᵀ·n", "004; ruling 6",
    [transform("modelview", Shape::Mat3), Input::direction("n")] -> [vec3("n")],
    |x, out| { out.vector(vector::normal_inverse_transpose(&x.mat3(), x.vector())); },
    hard [
        Hard { name: "reflection", pins: "a negative determinant", inputs: &[("modelview", &[-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]), ("n", &[0.6, 0.0, 0.8])] },
        Hard { name: "flat", pins: "a scale of 1e-3 along one axis", inputs: &[("modelview", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e-3]), ("n", &[0.6, 0.0, 0.8])] },
    ],
);
formula!(
    /// A light's direction in eye space.
    LightDirection: "vector/light-direction" by "vector_light_direction",
    "view·(direction, 0)", "000 §6.3",
    [transform("view", Shape::Mat4), Input::direction("direction")] -> [vec3("direction")],
    |x, out| { out.vector(vector::light_direction(&x.mat4(), x.vector())); },
);
formula!(
    /// A light's position in eye space.
    LightPosition: "vector/light-position" by "vector_light_position",
    "xyz/w of modelview·position; xyz where w = 0", "004",
    [
        transform("modelview", Shape::Mat4),
        Input::new("position", Shape::Vec4, "unit", Domain::Uniform(0.5, 10.0)),
    ] -> [EYE],
    |x, out| { out.vector(vector::light_position(&x.mat4(), x.vector())); },
    hard [
        Hard { name: "at-infinity", pins: "w = 0: a direction, undivided", inputs: &[("position", &[0.5, 0.0, 0.0, 0.0])] },
        Hard { name: "behind-infinity", pins: "a negative w turns it round", inputs: &[("position", &[1.0, 2.0, 3.0, -2.0])] },
    ],
);
formula!(
    /// A light that moves with a model.
    LightWithModel: "vector/light-with-model" by "vector_light_with_model",
    "view·(model·(position, 1))", "004",
    [transform("view", Shape::Mat4), transform("model", Shape::Mat4), Input::position("position")] -> [EYE],
    |x, out| { out.vector(vector::light_with_model(&x.mat4(), &x.mat4(), x.vector())); },
);
formula!(
    /// From a surface point to a light.
    Toward: "vector/toward" by "vector_toward",
    "l = ⟨light − p⟩", "000 §6.4, 003; ruling 2",
    [Input::position("light"), Input::position("p")] -> [vec3("l")],
    |x, out| { out.vector(vector::toward(x.vector(), x.vector())); },
    hard [
        Hard { name: "light-on-the-surface", pins: "0, not NaN", inputs: &[("light", &[1.0, 2.0, -3.0]), ("p", &[1.0, 2.0, -3.0])] },
    ],
);
formula!(
    /// Face normals averaged at a vertex.
    AverageNormal: "vector/average-normal" by "vector_average_normal",
    "⟨n0 + n1 + n2⟩", "004",
    [Input::direction("n0"), Input::direction("n1"), Input::direction("n2")] -> [vec3("n")],
    |x, out| { out.vector(vector::average_normal(x.vectors())); },
);
formula!(
    /// The normal of a face.
    FaceNormal: "vector/face-normal" by "vector_face_normal",
    "n = ⟨(b − a) × (c − a)⟩", "004",
    [Input::position("a"), Input::position("b"), Input::position("c")] -> [vec3("n")],
    |x, out| { out.vector(vector::face_normal(x.vector(), x.vector(), x.vector())); },
    hard [
        Hard { name: "no-area", pins: "0 for three points on a line", inputs: &[("a", &[0.0, 0.0, 0.0]), ("b", &[1.0, 1.0, 1.0]), ("c", &[2.0, 2.0, 2.0])] },
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
}
