//! Cases of fog. Formulas: `lightmeter_reference::fog`.

use super::Visitor;
use super::formula::formula;
use super::rows::Writer;
use super::spec::{Domain, Hard, Input, Output, Spec, ValueShape};
use lightmeter_reference::fog::{self, Distance};
use lightmeter_reference::{Real, Vec3};

const P: Input = Input::new("p", ValueShape::Vec3, "unit", Domain::Uniform(-100.0, 100.0));
const DMIN: Input = Input::scalar("dmin", "unit", Domain::Uniform(0.0, 50.0));
const DMAX: Input = Input::scalar("dmax", "unit", Domain::Uniform(1.0, 150.0));
const DENSITY: Input = Input::scalar("density", "1/unit", Domain::LogUniform(1e-4, 1.0));
const DENSITY_SQUARED: Input = Input::scalar("density", "1/unit²", Domain::LogUniform(1e-6, 0.1));
const FOG: Input = Input::rgb("fog");
const SHADED: Input = Input::rgb("shaded");
const F: Output = Output::new("f", ValueShape::Scalar, "1");
const COLOR: Output = Output::new("color", ValueShape::Vec3, "color");

/// The factor, and the mix by it.
fn fogged<R: Real>(out: &mut Writer<'_, R>, f: R, fog: Vec3<R>, shaded: Vec3<R>) {
    out.scalar(f);
    out.lazy_vector(|| fog::apply(fog, shaded, f));
}

/// dmin and dmax in order, but for one case in sixteen, which turns the fog round.
fn in_order(_: &Spec, row: &mut [f32]) {
    let turned = row[0].to_bits() & 15 == 0;
    if (row[3] > row[4]) != turned {
        row.swap(3, 4);
    }
}

macro_rules! linear {
    ($name:ident, $id:literal, $function:literal, $distance:expr, $text:literal
        $(, stable $bound:literal $size:ident $because:literal)? $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// Linear fog.
            $name: $id by $function,
            $text, "000 §6.5; ruling 10",
            [P, DMIN, DMAX, FOG, SHADED] -> [F, COLOR],
            fit in_order,
            $(stable $bound $size $because,)?
            |p, dmin, dmax, fog, shaded; out| { fogged(out, fog::linear(fog::distance(p, $distance), dmin, dmax), fog, shaded); }
            $(, hard [$($hard),*])?
        );
    };
}

linear!(
    Linear, "fog/linear", "fog_linear", Distance::Planar,
    "f = clamp((dmax − |z|)/(dmax − dmin), 0, 1); color = mix(fog, shaded, f)",
    stable 24.0 Unit "two exact differences and a division of at most 2½ ULP, then a mix of it in three components",
    hard [
        Hard::new("dmin-equals-dmax", "a step, clear before it", &[("p", &[0.0, 0.0, -9.0]), ("dmin", &[10.0]), ("dmax", &[10.0])])
            .naive("fog/linear-multiply-add", "∞ − ∞", 1e6),
        Hard::new("band-of-1-at-1e4", "a narrow band far away", &[("p", &[0.0, 0.0, -9999.7]), ("dmin", &[9999.0]), ("dmax", &[10000.0])])
            .naive("fog/linear-multiply-add", "10000 − 9999.7 from two rounded numbers", 1e3),
        Hard::new("band-of-1-at-1e5", "a narrow band farther away", &[("p", &[0.0, 0.0, -99_999.7]), ("dmin", &[99_999.0]), ("dmax", &[1e5])])
            .naive("fog/linear-multiply-add", "100000 − 99999.7 from two rounded numbers", 1e4),
        Hard::new("band-of-a-half-at-1e6", "a few steps wide", &[("p", &[0.0, 0.0, -999_999.7]), ("dmin", &[999_999.5]), ("dmax", &[1e6])])
            .naive("fog/linear-multiply-add", "1e6 − 999999.7 from two rounded numbers", 1e5),
        Hard::new("dmin-equals-dmax-at-the-step", "fog from dmax on", &[("p", &[0.0, 0.0, -10.0]), ("dmin", &[10.0]), ("dmax", &[10.0])]),
        Hard::new("dmax-below-dmin", "the fog turned round", &[("p", &[0.0, 0.0, -12.0]), ("dmin", &[20.0]), ("dmax", &[10.0])]),
        Hard::new("at-dmin", "clear", &[("p", &[0.0, 0.0, -5.0]), ("dmin", &[5.0]), ("dmax", &[10.0])]),
        Hard::new("at-dmax", "only fog", &[("p", &[0.0, 0.0, -10.0]), ("dmin", &[5.0]), ("dmax", &[10.0])]),
        Hard::new("nearly-a-step", "one ULP between dmin and dmax", &[("p", &[0.0, 0.0, -10.0]), ("dmin", &[10.0]), ("dmax", &[10.000_001])]),
        Hard::new("a-few-ulp-wide", "a ramp, however steep, is no step", &[("p", &[0.0, 0.0, -10.000_001]), ("dmin", &[10.0]), ("dmax", &[10.000_004])]),
        Hard::new("in-front-and-behind", "|z|, not z", &[("p", &[3.0, 4.0, 7.0]), ("dmin", &[5.0]), ("dmax", &[10.0])]),
    ]
);
linear!(
    LinearRadial,
    "fog/linear-radial",
    "fog_linear_radial",
    Distance::Radial,
    "f = clamp((dmax − |p|)/(dmax − dmin), 0, 1); color = mix(fog, shaded, f)",
    hard [
        Hard::new("dmin-equals-dmax", "a step, clear before it", &[("p", &[0.0, 0.0, -9.0]), ("dmin", &[10.0]), ("dmax", &[10.0])]),
        Hard::new("sideways", "|p|, not |z|", &[("p", &[10.0, 0.0, 0.0]), ("dmin", &[5.0]), ("dmax", &[10.0])]),
    ]
);

/// A point 2000 units away.
const FAR: &[(&str, &[f32])] = &[("p", &[1200.0, 0.0, -1600.0]), ("density", &[0.000_5])];

/// Without a clamp the factor is e.
const NEGATIVE: &[(&str, &[f32])] = &[("p", &[0.0, 0.0, -10.0]), ("density", &[-0.01])];

/// Fog whose density is below 0, thin enough to see through.
const NEGATIVE_THIN: &[(&str, &[f32])] = &[("p", &[0.0, 0.0, -1.0]), ("density", &[-0.1])];

macro_rules! exponential {
    (
        $name:ident, $id:literal, $function:literal, $distance:expr, $factor:path, $density:expr, $text:literal,
        $source:literal $(, stable $bound:literal $size:ident $because:literal)? $(, hard [$($hard:expr),* $(,)?])?
    ) => {
        formula!(
            /// Exponential fog.
            $name: $id by $function,
            $text, $source,
            [P, $density, FOG, SHADED] -> [F, COLOR],
            $(stable $bound $size $because,)?
            |p, density, fog, shaded; out| { fogged(out, $factor(fog::distance(p, $distance), density), fog, shaded); }
            $(, hard [$($hard),*])?
        );
    };
}

exponential!(
    Exp, "fog/exp", "fog_exp", Distance::Planar, fog::exp, DENSITY,
    "f = clamp(exp(−density·|z|), 0, 1); color = mix(fog, shaded, f)", "000 §6.5",
    hard [
        Hard::new("no-density", "density 0 is no fog", &[("p", &[0.0, 0.0, -50.0]), ("density", &[0.0])]),
        Hard::new("at-the-eye", "clear", &[("p", &[0.0, 0.0, 0.0]), ("density", &[1.0])]),
        Hard::new("negative-density", "clamped: never clearer than clear", &[("p", &[0.0, 0.0, -10.0]), ("density", &[-0.1])]),
        Hard::new("far-out", "2000 units away in thin fog", FAR),
        Hard::new("far", "only fog, the factor underflows", &[("p", &[0.0, 0.0, -1e6]), ("density", &[1.0])]),
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
    "000 §6.5, a dialect",
    hard[Hard::new("far-out", "2000 units away in thin fog", FAR)]
);
exponential!(
    Exp2Document, "fog/exp2-document", "fog_exp2_document", Distance::Planar, fog::exp2_document, DENSITY_SQUARED,
    "f = clamp(exp(−density·z²), 0, 1); color = mix(fog, shaded, f)", "000 §6.5; ruling 4",
    stable 32.0 Unit "(density·z)·z: two products, of which f·ln f takes at most 0.37, exp's 3 ULP and more, and a mix",
    hard [
        Hard::new("far-in-the-thinnest-fog", "density·z² is 4.8 though z² overflows", &[("p", &[0.0, 0.0, -2e19]), ("density", &[1.2e-38])])
            .naive("fog/exp2-document-square", "z² is ∞", 1e4),
        Hard::new("no-density", "density 0 is no fog", &[("density", &[0.0])]),
        Hard::new("negative-density", "clamped: never clearer than clear", NEGATIVE),
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
    "000 §6.5, a dialect",
    hard[Hard::new("negative-density", "clamped: never clearer than clear", NEGATIVE)]
);
exponential!(
    Exp2OpenGl, "fog/exp2-opengl", "fog_exp2_opengl", Distance::Planar, fog::exp2_opengl, DENSITY,
    "f = clamp(exp(−(density·z)²), 0, 1); color = mix(fog, shaded, f)", "OpenGL 2.1 §3.10; ruling 4",
    stable 32.0 Unit "t = density·z, then t·t: two products, of which f·ln f takes at most 0.74, exp's 3 ULP and more, and a mix",
    hard [
        Hard::new("no-density", "density 0 is no fog", &[("density", &[0.0])]),
        Hard::new("tiny-density-far-away", "a product that may over- or underflow in some order", &[("p", &[0.0, 0.0, -1e30]), ("density", &[1e-30])])
            .naive("fog/exp2-opengl-squares", "0·∞ is NaN", 1e6),
        Hard::new("dense-fog-at-1e-23", "the distance's square underflows", &[("p", &[0.0, 0.0, -1e-23]), ("density", &[9e22])])
            .naive("fog/exp2-opengl-squares", "∞·0 is NaN", 1e6),
        Hard::new("negative-density", "squared, so that its sign does not matter", NEGATIVE_THIN),
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
    "OpenGL 2.1 §3.10, a dialect",
    hard[Hard::new("far-out", "2000 units away in thin fog", FAR),
        Hard::new("negative-density", "squared, so that its sign does not matter", NEGATIVE_THIN),
    ]
);

formula!(
    /// Linear fog as a multiply-add.
    LinearMultiplyAdd: "fog/linear-multiply-add" by "fog_linear_multiply_add",
    "f = clamp(|z|·scale + offset, 0, 1), scale = −1/(dmax − dmin), offset = dmax/(dmax − dmin)", "a shortcut",
    [P, DMIN, DMAX, FOG, SHADED] -> [F, COLOR],
    fit in_order,
    |p, dmin, dmax, fog, shaded; out| {
        fogged(out, fog::linear_multiply_add(fog::distance(p, Distance::Planar), dmin, dmax), fog, shaded);
    },
);
formula!(
    /// Document 000's exponential-squared fog, the distance squared first.
    Exp2DocumentSquare: "fog/exp2-document-square" by "fog_exp2_document_square",
    "f = clamp(exp(−density·(z·z)), 0, 1)", "000 §6.5, taken literally",
    [P, DENSITY_SQUARED, FOG, SHADED] -> [F, COLOR],
    |p, density, fog, shaded; out| {
        fogged(out, fog::exp2_document_square(fog::distance(p, Distance::Planar), density), fog, shaded);
    },
    hard [Hard::new("negative-density", "clamped: never clearer than clear", NEGATIVE)],
);
formula!(
    /// OpenGL's exponential-squared fog, density and distance squared alone.
    Exp2OpenGlSquares: "fog/exp2-opengl-squares" by "fog_exp2_opengl_squares",
    "f = clamp(exp(−(density·density)·(z·z)), 0, 1)", "a shortcut",
    [P, DENSITY, FOG, SHADED] -> [F, COLOR],
    |p, density, fog, shaded; out| {
        fogged(out, fog::exp2_opengl_squares(fog::distance(p, Distance::Planar), density), fog, shaded);
    },
    hard [
        Hard::new("negative-density", "squared, so that its sign does not matter", NEGATIVE_THIN),
    ],
);
formula!(
    /// Exponential fog by a distance of any length.
    ExpRadialScaled: "fog/exp-radial-scaled" by "fog_exp_radial_scaled",
    "f = clamp(exp(−density·|p·2ᵏ|·2⁻ᵏ), 0, 1); color = mix(fog, shaded, f)", "000 §6.5, a dialect, at any distance",
    [P, DENSITY, FOG, SHADED] -> [F, COLOR],
    stable 48.0 Unit "a distance of 16 roundings, which f·ln f takes at most 0.37 of, and exp's 3 ULP and more",
    |p, density, fog, shaded; out| {
        let f = fog::exp(fog::radial_distance_scaled(p), density);
        out.scalar(f);
        out.vector(fog::apply(fog, shaded, f));
    },
    hard [
        Hard::new("far", "5e19 away in thin fog", &[("p", &[3e19, 0.0, -4e19]), ("density", &[1e-20])])
            .naive("fog/exp-radial", "the distance is ∞", 1e6),
        Hard::new("near", "5e-24 away in dense fog", &[("p", &[3e-24, 0.0, -4e-24]), ("density", &[1e23])])
            .naive("fog/exp-radial", "the distance is 0", 1e6),
    ],
);

const THICKNESS: Input = Input::scalar("distance", "unit", Domain::LogUniform(0.1, 100.0));
const OPACITY: Output = Output::new("opacity", ValueShape::Scalar, "1");

formula!(
    /// How much of the fog is seen.
    Opacity: "fog/opacity" by "fog_opacity",
    "opacity = 1 − exp(−density·distance)", "000 §6.5, 1 − f",
    [THICKNESS, DENSITY] -> [OPACITY],
    |distance, density; out| { out.scalar(fog::opacity(distance, density)); },
    hard [
        Hard::new("negative-density", "below 0: nothing is clamped", &[("density", &[-0.1]), ("distance", &[10.0])]),
    ],
);
formula!(
    /// How much of the fog is seen, however thin.
    OpacityExpm1: "fog/opacity-expm1" by "fog_opacity_expm1",
    "opacity = −expm1(−density·distance), a short series below ½", "000 §6.5, 1 − f",
    [THICKNESS, DENSITY] -> [OPACITY],
    stable 72.0 Own "a product, and a series of 8 terms summed in any order, 66; beyond ½, exp's bound on at most 0.61",
    |distance, density; out| { out.scalar(fog::opacity_expm1(distance, density)); },
    hard [
        Hard::new("one-in-1e3", "a thousandth of fog", &[("distance", &[1.0]), ("density", &[1.1e-3])])
            .naive("fog/opacity", "1 − 0.999 has lost 10 bits", 100.0),
        Hard::new("one-in-1e5", "thin fog", &[("distance", &[1.0]), ("density", &[1.1e-5])])
            .naive("fog/opacity", "1 − 0.99999 has lost 16 bits", 1e4),
        Hard::new("one-in-1e7", "thinner than a rounding of 1", &[("distance", &[1.0]), ("density", &[1e-7])])
            .naive("fog/opacity", "one bit is left", 1e6),
        Hard::new("one-in-1e12", "the thinnest fog", &[("distance", &[1e-6]), ("density", &[1e-6])])
            .naive("fog/opacity", "none", 1e7),
        Hard::new("half", "the thickest fog of the series", &[("distance", &[1.0]), ("density", &[0.5])]),
    ],
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
    visitor.formula(LinearMultiplyAdd);
    visitor.formula(Exp2DocumentSquare);
    visitor.formula(Exp2OpenGlSquares);
    visitor.formula(ExpRadialScaled);
    visitor.formula(Opacity);
    visitor.formula(OpacityExpm1);
}
