//! Cases of fog. Formulas: `lightmeter_reference::fog`.

use super::Visitor;
use super::formula::formula;
use super::rows::{Reader, Writer};
use super::spec::{Domain, Hard, Input, Output, Shape};
use lightmeter_reference::Real;
use lightmeter_reference::fog::{self, Distance};

const P: Input = Input::new("p", Shape::Vec3, "unit", Domain::Uniform(-100.0, 100.0));
const DMIN: Input = Input::scalar("dmin", "unit", Domain::Uniform(0.0, 50.0));
const DMAX: Input = Input::scalar("dmax", "unit", Domain::Uniform(1.0, 150.0));
const DENSITY: Input = Input::scalar("density", "1/unit", Domain::LogUniform(1e-4, 1.0));
const DENSITY_SQUARED: Input = Input::scalar("density", "1/unit²", Domain::LogUniform(1e-6, 0.1));
const FOG: Input = Input::rgb("fog");
const SHADED: Input = Input::rgb("shaded");
const F: Output = Output::new("f", Shape::Scalar, "1");
const COLOR: Output = Output::new("color", Shape::Vec3, "color");

/// The factor by a function of the distance and its parameters, then the mix.
fn fogged<R: Real, const N: usize>(
    x: &mut Reader<'_, R>,
    out: &mut Writer<'_, R>,
    distance: Distance,
    factor: impl Fn(R, [R; N]) -> R,
) {
    let f = factor(fog::distance(x.vector(), distance), x.array());
    out.scalar(f);
    out.vector(fog::apply(x.vector(), x.vector(), f));
}

/// dmin and dmax in order, but for one case in sixteen, which turns the fog round.
fn in_order(row: &mut [f32]) {
    let turned = row[0].to_bits() & 15 == 0;
    if (row[3] > row[4]) != turned {
        row.swap(3, 4);
    }
}

macro_rules! linear {
    ($name:ident, $id:literal, $function:literal, $distance:expr, $text:literal $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// Linear fog.
            $name: $id by $function,
            $text, "000 §6.5; ruling 10",
            [P, DMIN, DMAX, FOG, SHADED] -> [F, COLOR],
            fit in_order,
            |x, out| { fogged(x, out, $distance, |d, [dmin, dmax]| fog::linear(d, dmin, dmax)); }
            $(, hard [$($hard),*])?
        );
    };
}

linear!(
    Linear, "fog/linear", "fog_linear", Distance::Planar,
    "f = clamp((dmax − |z|)/(dmax − dmin), 0, 1); color = mix(fog, shaded, f)",
    hard [
        Hard { name: "dmin-equals-dmax", pins: "a step, clear before it", inputs: &[("p", &[0.0, 0.0, -9.0]), ("dmin", &[10.0]), ("dmax", &[10.0])] },
        Hard { name: "dmin-equals-dmax-at-the-step", pins: "fog from dmax on", inputs: &[("p", &[0.0, 0.0, -10.0]), ("dmin", &[10.0]), ("dmax", &[10.0])] },
        Hard { name: "dmax-below-dmin", pins: "the fog turned round", inputs: &[("p", &[0.0, 0.0, -12.0]), ("dmin", &[20.0]), ("dmax", &[10.0])] },
        Hard { name: "at-dmin", pins: "clear", inputs: &[("p", &[0.0, 0.0, -5.0]), ("dmin", &[5.0]), ("dmax", &[10.0])] },
        Hard { name: "at-dmax", pins: "only fog", inputs: &[("p", &[0.0, 0.0, -10.0]), ("dmin", &[5.0]), ("dmax", &[10.0])] },
        Hard { name: "nearly-a-step", pins: "one ULP between dmin and dmax", inputs: &[("p", &[0.0, 0.0, -10.0]), ("dmin", &[10.0]), ("dmax", &[10.000_001])] },
        Hard { name: "a-few-ulp-wide", pins: "a ramp, however steep, is no step", inputs: &[("p", &[0.0, 0.0, -10.000_001]), ("dmin", &[10.0]), ("dmax", &[10.000_004])] },
        Hard { name: "in-front-and-behind", pins: "|z|, not z", inputs: &[("p", &[3.0, 4.0, 7.0]), ("dmin", &[5.0]), ("dmax", &[10.0])] },
    ]
);
linear!(
    LinearRadial,
    "fog/linear-radial",
    "fog_linear_radial",
    Distance::Radial,
    "f = clamp((dmax − |p|)/(dmax − dmin), 0, 1); color = mix(fog, shaded, f)",
    hard [
        Hard { name: "dmin-equals-dmax", pins: "a step, clear before it", inputs: &[("p", &[0.0, 0.0, -9.0]), ("dmin", &[10.0]), ("dmax", &[10.0])] },
        Hard { name: "sideways", pins: "|p|, not |z|", inputs: &[("p", &[10.0, 0.0, 0.0]), ("dmin", &[5.0]), ("dmax", &[10.0])] },
    ]
);

macro_rules! exponential {
    (
        $name:ident, $id:literal, $function:literal, $distance:expr, $factor:path, $density:expr, $text:literal,
        $source:literal $(, hard [$($hard:expr),* $(,)?])?
    ) => {
        formula!(
            /// Exponential fog.
            $name: $id by $function,
            $text, $source,
            [P, $density, FOG, SHADED] -> [F, COLOR],
            |x, out| { fogged(x, out, $distance, |d, [density]| $factor(d, density)); }
            $(, hard [$($hard),*])?
        );
    };
}

exponential!(
    Exp, "fog/exp", "fog_exp", Distance::Planar, fog::exp, DENSITY,
    "f = clamp(exp(−density·|z|), 0, 1); color = mix(fog, shaded, f)", "000 §6.5",
    hard [
        Hard { name: "no-density", pins: "density 0 is no fog", inputs: &[("p", &[0.0, 0.0, -50.0]), ("density", &[0.0])] },
        Hard { name: "at-the-eye", pins: "clear", inputs: &[("p", &[0.0, 0.0, 0.0]), ("density", &[1.0])] },
        Hard { name: "negative-density", pins: "clamped: never clearer than clear", inputs: &[("p", &[0.0, 0.0, -10.0]), ("density", &[-0.1])] },
        Hard { name: "far", pins: "only fog, the factor underflows", inputs: &[("p", &[0.0, 0.0, -1e6]), ("density", &[1.0])] },
    ]
);
exponential!(
    ExpRadial,
    "fog/exp-radial",
    "fog_exp_radial",
    Distance::Radial,
    fog::exp,
    DENSITY,
    "f = clamp(exp(−density·|p|), 0, 1); color = mix(fog, shaded, f)",
    "000 §6.5, a dialect"
);
exponential!(
    Exp2Document, "fog/exp2-document", "fog_exp2_document", Distance::Planar, fog::exp2_document, DENSITY_SQUARED,
    "f = clamp(exp(−density·z²), 0, 1); color = mix(fog, shaded, f)", "000 §6.5; ruling 4",
    hard [
        Hard { name: "no-density", pins: "density 0 is no fog", inputs: &[("density", &[0.0])] },
    ]
);
exponential!(
    Exp2DocumentRadial,
    "fog/exp2-document-radial",
    "fog_exp2_document_radial",
    Distance::Radial,
    fog::exp2_document,
    DENSITY_SQUARED,
    "f = clamp(exp(−density·|p|²), 0, 1); color = mix(fog, shaded, f)",
    "000 §6.5, a dialect"
);
exponential!(
    Exp2OpenGl, "fog/exp2-opengl", "fog_exp2_opengl", Distance::Planar, fog::exp2_opengl, DENSITY,
    "f = clamp(exp(−(density·z)²), 0, 1); color = mix(fog, shaded, f)", "OpenGL 2.1 §3.10; ruling 4",
    hard [
        Hard { name: "no-density", pins: "density 0 is no fog", inputs: &[("density", &[0.0])] },
        Hard { name: "tiny-density-far-away", pins: "a product that may over- or underflow in some order", inputs: &[("p", &[0.0, 0.0, -1e30]), ("density", &[1e-30])] },
    ]
);
exponential!(
    Exp2OpenGlRadial,
    "fog/exp2-opengl-radial",
    "fog_exp2_opengl_radial",
    Distance::Radial,
    fog::exp2_opengl,
    DENSITY,
    "f = clamp(exp(−(density·|p|)²), 0, 1); color = mix(fog, shaded, f)",
    "OpenGL 2.1 §3.10, a dialect"
);

pub(super) fn visit(visitor: &mut impl Visitor) {
    visitor.formula(Linear);
    visitor.formula(LinearRadial);
    visitor.formula(Exp);
    visitor.formula(ExpRadial);
    visitor.formula(Exp2Document);
    visitor.formula(Exp2DocumentRadial);
    visitor.formula(Exp2OpenGl);
    visitor.formula(Exp2OpenGlRadial);
}
