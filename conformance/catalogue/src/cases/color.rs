//! Cases of colours and their storage. Formulas: `lightmeter_reference::color`.

use super::Visitor;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, ValueShape};
use lightmeter_reference::color;

const BEYOND: Domain = Domain::Uniform(-0.25, 1.25);
const COLOR: Output = Output::new("color", ValueShape::Vec4, "color");

formula!(
    /// Conversion to 8 bits.
    ToUnorm8: "color/to-unorm8" by "color_to_unorm8",
    "byte = round(255·clamp(c, 0, 1))", "000 §6.2",
    [Input::scalar("c", "color", BEYOND)] -> [Output::new("byte", ValueShape::Scalar, "1/255")],
    |c; out| { out.scalar(color::to_unorm8(c)); },
    hard [
        Hard::new("half-a-step", "a tie: both neighbours are legal", &[("c", &[0.5 / 255.0])]),
        Hard::new("half-grey", "127.5 may go either way, 128 by ties to even", &[("c", &[0.5])]),
        Hard::new("just-below-a-step", "truncation would give 0", &[("c", &[0.003_921_568])]),
        Hard::new("below-zero", "clamped", &[("c", &[-1e30])]),
        Hard::new("above-one", "clamped", &[("c", &[1e30])]),
    ],
);
formula!(
    /// Conversion from 8 bits.
    FromUnorm8: "color/from-unorm8" by "color_from_unorm8",
    "c = byte / 255", "000 §6.2",
    [Input::scalar("byte", "1/255", Domain::Whole(0, 255))] -> [Output::new("c", ValueShape::Scalar, "color")],
    |byte; out| { out.scalar(color::from_unorm8(byte)); },
);
formula!(
    /// sRGB encoding.
    SrgbEncode: "color/srgb-encode" by "color_srgb_encode",
    "e = 12.92·c for c ≤ 0.0031308, else 1.055·c^(1/2.4) − 0.055; alpha linear", "IEC 61966-2-1",
    [Input::rgba("c")] -> [COLOR],
    |c; out| { out.vector(color::srgb_encode_rgba(c)); },
    hard [
        Hard::new("threshold", "both pieces are legal where they meet", &[("c", &[0.003_130_8, 0.003_130_7, 0.003_131, 1.0])]),
        Hard::new("ends", "0 and 1 are kept", &[("c", &[0.0, 1.0, 1e-30, 0.0])]),
    ],
);
formula!(
    /// sRGB decoding.
    SrgbDecode: "color/srgb-decode" by "color_srgb_decode",
    "c = e/12.92 for e ≤ 0.04045, else ((e + 0.055)/1.055)^2.4; alpha linear", "IEC 61966-2-1",
    [Input::rgba("e")] -> [COLOR],
    |e; out| { out.vector(color::srgb_decode_rgba(e)); },
    hard [
        Hard::new("threshold", "both pieces are legal where they meet", &[("e", &[0.040_45, 0.040_449, 0.040_451, 1.0])]),
        Hard::new("above-the-threshold", "the power a thousandth above the threshold", &[("e", &[0.040_488, 0.040_489, 0.040_49, 1.0])]),
    ],
);
formula!(
    /// A texture that modulates.
    Modulate: "color/modulate" by "color_modulate",
    "color = texel * color", "002 (DIFFUSE × LIGHTMAP)",
    [Input::rgba("texel"), Input::rgba("color")] -> [COLOR],
    |texel, color; out| { out.vector(color::modulate(texel, color)); },
);
formula!(
    /// A texture that replaces.
    Replace: "color/replace" by "color_replace",
    "color = texel", "004",
    [Input::rgba("texel"), Input::rgba("color")] -> [COLOR],
    |texel, color; out| { out.vector(color::replace(texel, color)); },
);
formula!(
    /// Sums on the colour cube.
    Sum: "color/sum" by "color_sum",
    "color = clamp(a + b, 0, 1)", "004",
    [Input::rgb("a"), Input::rgb("b")] -> [Output::new("color", ValueShape::Vec3, "color")],
    |a, b; out| { out.vector(color::sum(a, b)); },
    hard [
        Hard::new("red-and-green", "yellow", &[("a", &[1.0, 0.0, 0.0]), ("b", &[0.0, 1.0, 0.0])]),
        Hard::new("green-and-blue", "cyan", &[("a", &[0.0, 1.0, 0.0]), ("b", &[0.0, 0.0, 1.0])]),
        Hard::new("blue-and-red", "magenta", &[("a", &[0.0, 0.0, 1.0]), ("b", &[1.0, 0.0, 0.0])]),
        Hard::new("yellow-and-blue", "white", &[("a", &[1.0, 1.0, 0.0]), ("b", &[0.0, 0.0, 1.0])]),
        Hard::new("below-black", "clamped", &[("a", &[-1.0, -0.25, 0.5]), ("b", &[0.5, 0.125, -0.75])]),
        Hard::new("white-and-white", "clamped", &[("a", &[1.0, 1.0, 1.0]), ("b", &[1.0, 1.0, 1.0])]),
    ],
);
formula!(
    /// A fixed or uniform colour.
    Uniform: "color/uniform" by "color_uniform",
    "(color, 1)", "000 §6.2",
    [Input::rgb("color")] -> [COLOR],
    |color; out| { out.vector(color::uniform(color)); },
);
formula!(
    /// A colour bound to the vertices.
    PerVertex: "color/per-vertex" by "color_per_vertex",
    "(Σ weightᵢ·colorᵢ, 1)", "000 §6.2",
    [
        Input::new("weights", ValueShape::Vec3, "1", Domain::Weights),
        Input::rgb("a"), Input::rgb("b"), Input::rgb("c"),
    ] -> [COLOR],
    |weights, a, b, c; out| { out.vector(color::per_vertex(weights, [a, b, c])); },
    hard [
        Hard::new("outside", "alpha is 1, not the weights' sum", &[("weights", &[0.5, 0.25, 0.0])]),
    ],
);

const ENCODED: Output = Output::new("e", ValueShape::Scalar, "color");
const COMPONENT: Input = Input::scalar("c", "color", Domain::Uniform(0.01, 1.0));

formula!(
    /// sRGB encoding of one component.
    SrgbEncodeComponent: "color/srgb-encode-component" by "color_srgb_encode_component",
    "e = 12.92·c for c ≤ 0.0031308, else 1.055·c^(1/2.4) − 0.055", "IEC 61966-2-1",
    [COMPONENT] -> [ENCODED],
    stable 128.0 Own "exp2's 3 + 2·3.4 ULP, 20 roundings, and log2's 3 ULP through the exponent, magnified up to 2.4 times by the subtraction of 0.055",
    |c; out| { out.scalar(color::srgb_encode(c)); },
    hard [
        Hard::new("below-zero", "a colour out of gamut stays a number", &[("c", &[-0.001])])
            .naive("color/srgb-encode-power", "the power of a negative base: NaN, or a colour", 1e6),
        Hard::new("far-below-zero", "likewise", &[("c", &[-0.5])])
            .naive("color/srgb-encode-power", "the power of a negative base: NaN, or a colour", 1e6),
        Hard::new("near-black", "the straight piece", &[("c", &[1e-4])])
            .naive("color/gamma-encode", "12 times too bright", 1e8),
        Hard::new("black-of-half-a-step", "the straight piece", &[("c", &[1.5e-4])])
            .naive("color/gamma-encode", "9 times too bright", 1e8),
        Hard::new("a-thousandth-above-the-threshold", "the power", &[("c", &[0.003_133_8])]),
        Hard::new("just-above-the-threshold", "the two pieces meet", &[("c", &[0.0032])])
            .naive("color/gamma-encode", "1.8 times too bright", 1e7),
    ],
);
formula!(
    /// sRGB encoding of one component without its straight piece.
    SrgbEncodePower: "color/srgb-encode-power" by "color_srgb_encode_power",
    "e = 1.055·c^(1/2.4) − 0.055", "a shortcut: sRGB without its straight piece",
    [COMPONENT] -> [ENCODED],
    |c; out| { out.scalar(color::srgb_encode_power(c)); },
);
formula!(
    /// One power for sRGB.
    GammaEncode: "color/gamma-encode" by "color_gamma_encode",
    "e = c^(1/2.2)", "a shortcut",
    [COMPONENT] -> [ENCODED],
    |c; out| { out.scalar(color::gamma_encode(c)); },
);

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(ToUnorm8);
    visitor.formula(FromUnorm8);
    visitor.formula(SrgbEncode);
    visitor.formula(SrgbDecode);
    visitor.formula(Modulate);
    visitor.formula(Replace);
    visitor.formula(Sum);
    visitor.formula(Uniform);
    visitor.formula(PerVertex);
    visitor.formula(SrgbEncodeComponent);
    visitor.formula(SrgbEncodePower);
    visitor.formula(GammaEncode);
}
