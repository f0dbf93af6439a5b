//! Cases of attenuation and spotlights. Formulas: `lightmeter_reference::attenuation`.

use super::Visitor;
use super::formula::formula;
use super::spec::{Domain, Hard, Input, Output, Shape};
use lightmeter_reference::attenuation;

const ATTEN: Output = Output::new("atten", Shape::Scalar, "1");
const SPOT: Output = Output::new("spot", Shape::Scalar, "1");
pub(super) const KC: Input = Input::scalar("kc", "1", Domain::Uniform(0.1, 2.0));
pub(super) const KL: Input = Input::scalar("kl", "1/unit", Domain::Uniform(0.0, 1.0));
pub(super) const KQ: Input = Input::scalar("kq", "1/unit²", Domain::Uniform(0.0, 0.5));
const DISTANCE: Input = Input::scalar("d", "unit", Domain::LogUniform(1e-3, 1e3));
pub(super) const CUTOFF: Input = Input::scalar("cutoff_cosine", "1", Domain::Uniform(-0.5, 0.99));
pub(super) const EXPONENT: Input = Input::scalar("exponent", "1", Domain::Uniform(0.0, 128.0));

formula!(
    /// The polynomial of the distance.
    Polynomial: "attenuation/polynomial" by "attenuation_polynomial",
    "atten = 1 / (kc + kl·d + kq·d²)", "004",
    [KC, KL, KQ, DISTANCE] -> [ATTEN],
    |x, out| { out.scalar(attenuation::polynomial(x.scalar(), x.scalar(), x.scalar(), x.scalar())); },
    hard [
        Hard { name: "all-zero", pins: "no value: nothing is promised", inputs: &[("kc", &[0.0]), ("kl", &[0.0]), ("kq", &[0.0])] },
        Hard { name: "at-the-light", pins: "1/kc", inputs: &[("kc", &[0.5]), ("d", &[0.0])] },
        Hard { name: "far", pins: "d² overflows: nothing is promised", inputs: &[("d", &[2e19]), ("kq", &[1.0])] },
        Hard { name: "no-falloff", pins: "kc = 1 alone gives 1", inputs: &[("kc", &[1.0]), ("kl", &[0.0]), ("kq", &[0.0])] },
    ],
);
formula!(
    /// The falloff of a distant light.
    Constant: "attenuation/constant" by "attenuation_constant",
    "atten = 1, (kc, kl, kq) = (1, 0, 0)", "004",
    [DISTANCE] -> [ATTEN],
    |x, out| { out.scalar(attenuation::constant(x.scalar())); },
);
formula!(
    /// The falloff of a tube light.
    Linear: "attenuation/linear" by "attenuation_linear",
    "atten = 1/d, (0, 1, 0)", "004",
    [DISTANCE] -> [ATTEN],
    |x, out| { out.scalar(attenuation::linear(x.scalar())); },
);
formula!(
    /// The falloff of a point light.
    Square: "attenuation/square" by "attenuation_square",
    "atten = 1/d², (0, 0, 1)", "004",
    [DISTANCE] -> [ATTEN],
    |x, out| { out.scalar(attenuation::square(x.scalar())); },
);
formula!(
    /// From positions.
    Point: "attenuation/point" by "attenuation_point",
    "atten = 1 / (kc + kl·d + kq·d²), d = |light − p|", "004",
    [KC, KL, KQ, Input::position("light"), Input::position("p")] -> [ATTEN],
    |x, out| { out.scalar(attenuation::point(x.scalar(), x.scalar(), x.scalar(), x.vector(), x.vector())); },
);
formula!(
    /// A spotlight's cone.
    SpotCutoff: "attenuation/spot-cutoff" by "attenuation_spot_cutoff",
    "spot = 1 for −l·axis ≥ cos(cutoff), else 0", "000 §6.4",
    [Input::direction("l"), Input::direction("axis"), CUTOFF] -> [SPOT],
    |x, out| { out.scalar(attenuation::spot_cutoff(x.vector(), x.vector(), x.scalar())); },
    hard [
        Hard { name: "on-the-edge", pins: "the edge belongs to the cone", inputs: &[("l", &[0.0, 0.0, -1.0]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[1.0])] },
        Hard { name: "all-round", pins: "a cutoff of 180 degrees lights what lies behind too", inputs: &[("l", &[0.0, 0.0, 1.0]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[-1.0])] },
    ],
);
formula!(
    /// A spotlight's exponent.
    SpotExponent: "attenuation/spot-exponent" by "attenuation_spot_exponent",
    "spot = max(−l·axis, 0)^e within the cone, else 0", "OpenGL 2.1 §2.14.1",
    [Input::direction("l"), Input::direction("axis"), CUTOFF, EXPONENT] -> [SPOT],
    fit toward_the_cone,
    |x, out| { out.scalar(attenuation::spot_exponent(x.vector(), x.vector(), x.scalar(), x.scalar())); },
    hard [
        Hard { name: "no-exponent", pins: "an evenly lit cone", inputs: &[("l", &[0.0, 0.6, -0.8]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.5]), ("exponent", &[0.0])] },
        Hard { name: "behind", pins: "0 behind the light with the widest cone", inputs: &[("l", &[0.0, 0.0, 1.0]), ("axis", &[0.0, 0.0, 1.0]), ("cutoff_cosine", &[0.0]), ("exponent", &[2.0])] },
    ],
);

/// Half of all random directions lie behind the light: turn those round.
fn toward_the_cone(row: &mut [f32]) {
    let behind = (0..3).map(|k| row[k] * row[3 + k]).sum::<f32>() > 0.0;
    if behind {
        row[..3].iter_mut().for_each(|x| *x = -*x);
    }
}

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(Polynomial);
    visitor.formula(Constant);
    visitor.formula(Linear);
    visitor.formula(Square);
    visitor.formula(Point);
    visitor.formula(SpotCutoff);
    visitor.formula(SpotExponent);
}
