//! Cases of colours and their storage. Formulas: `lightmeter_reference::color`.

use super::Visitor;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, Shape};
use lightmeter_reference::color;

const BEYOND: Domain = Domain::Uniform(-0.25, 1.25);
const COLOR: Output = Output::new("color", Shape::Vec4, "color");

formula!(
    /// Conversion to 8 bits.
    ToUnorm8: "color/to-unorm8" by "color_to_unorm8",
    "byte = round(255·clamp(c, 0, 1))", "000 §6.2",
    [Input::scalar("c", "color", BEYOND)] -> [Output::new("byte", Shape::Scalar, "1/255")],
    |x, out| { out.scalar(color::to_unorm8(x.scalar())); },
    hard [
        Hard { name: "half-a-step", pins: "a tie: both neighbours are legal", inputs: &[("c", &[0.5 / 255.0])] },
        Hard { name: "half-grey", pins: "127.5 may go either way, 128 by ties to even", inputs: &[("c", &[0.5])] },
        Hard { name: "just-below-a-step", pins: "truncation would give 0", inputs: &[("c", &[0.003_921_568])] },
        Hard { name: "below-zero", pins: "clamped", inputs: &[("c", &[-1e30])] },
        Hard { name: "above-one", pins: "clamped", inputs: &[("c", &[1e30])] },
    ],
);
formula!(
    /// Conversion from 8 bits.
    FromUnorm8: "color/from-unorm8" by "color_from_unorm8",
    "c = byte / 255", "000 §6.2",
    [Input::scalar("byte", "1/255", Domain::Whole(0, 255))] -> [Output::new("c", Shape::Scalar, "color")],
    |x, out| { out.scalar(color::from_unorm8(x.scalar())); },
);
formula!(
    /// sRGB encoding.
    SrgbEncode: "color/srgb-encode" by "color_srgb_encode",
    "e = 12.92·c for c ≤ 0.0031308, else 1.055·c^(1/2.4) − 0.055; alpha linear", "IEC 61966-2-1",
    [Input::rgba("c")] -> [COLOR],
    |x, out| { out.vector(color::srgb_encode_rgba(x.vector())); },
    hard [
        Hard { name: "threshold", pins: "both pieces are legal where they meet", inputs: &[("c", &[0.003_130_8, 0.003_130_7, 0.003_131, 1.0])] },
        Hard { name: "ends", pins: "0 and 1 are kept", inputs: &[("c", &[0.0, 1.0, 1e-30, 0.0])] },
    ],
);
formula!(
    /// sRGB decoding.
    SrgbDecode: "color/srgb-decode" by "color_srgb_decode",
    "c = e/12.92 for e ≤ 0.04045, else ((e + 0.055)/1.055)^2.4; alpha linear", "IEC 61966-2-1",
    [Input::rgba("e")] -> [COLOR],
    |x, out| { out.vector(color::srgb_decode_rgba(x.vector())); },
    hard [
        Hard { name: "threshold", pins: "both pieces are legal where they meet", inputs: &[("e", &[0.040_45, 0.040_449, 0.040_451, 1.0])] },
    ],
);
formula!(
    /// A texture that modulates.
    Modulate: "color/modulate" by "color_modulate",
    "color = texel * color", "002 (DIFFUSE × LIGHTMAP)",
    [Input::rgba("texel"), Input::rgba("color")] -> [COLOR],
    |x, out| { out.vector(color::modulate(x.vector(), x.vector())); },
);
formula!(
    /// A texture that replaces.
    Replace: "color/replace" by "color_replace",
    "color = texel", "004",
    [Input::rgba("texel"), Input::rgba("color")] -> [COLOR],
    |x, out| { out.vector(color::replace(x.vector(), x.vector())); },
);
formula!(
    /// Sums on the colour cube.
    Sum: "color/sum" by "color_sum",
    "color = clamp(a + b, 0, 1)", "004",
    [Input::rgb("a"), Input::rgb("b")] -> [Output::new("color", Shape::Vec3, "color")],
    |x, out| { out.vector(color::sum(x.vector(), x.vector())); },
    hard [
        Hard { name: "red-and-green", pins: "yellow", inputs: &[("a", &[1.0, 0.0, 0.0]), ("b", &[0.0, 1.0, 0.0])] },
        Hard { name: "green-and-blue", pins: "cyan", inputs: &[("a", &[0.0, 1.0, 0.0]), ("b", &[0.0, 0.0, 1.0])] },
        Hard { name: "blue-and-red", pins: "magenta", inputs: &[("a", &[0.0, 0.0, 1.0]), ("b", &[1.0, 0.0, 0.0])] },
        Hard { name: "yellow-and-blue", pins: "white", inputs: &[("a", &[1.0, 1.0, 0.0]), ("b", &[0.0, 0.0, 1.0])] },
        Hard { name: "white-and-white", pins: "clamped", inputs: &[("a", &[1.0, 1.0, 1.0]), ("b", &[1.0, 1.0, 1.0])] },
    ],
);
formula!(
    /// A fixed or uniform colour.
    Uniform: "color/uniform" by "color_uniform",
    "(color, 1)", "000 §6.2",
    [Input::rgb("color")] -> [COLOR],
    |x, out| { out.vector(color::uniform(x.vector())); },
);
formula!(
    /// A colour bound to the vertices.
    PerVertex: "color/per-vertex" by "color_per_vertex",
    "(Σ weightᵢ·colorᵢ, 1)", "000 §6.2",
    [
        Input::new("weights", Shape::Vec3, "1", Domain::Weights),
        Input::rgb("a"), Input::rgb("b"), Input::rgb("c"),
    ] -> [COLOR],
    |x, out| { out.vector(color::per_vertex(x.array(), x.vectors())); },
    hard [
        Hard { name: "outside", pins: "alpha is 1, not the weights' sum", inputs: &[("weights", &[0.5, 0.25, 0.0])] },
    ],
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
}
