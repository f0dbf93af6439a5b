//! A step of a shader made the function of a formula: what else the formula is of stands around it, right.

use crate::bind::type_of;
use lightmeter_catalogue::cases::Spec;
use lightmeter_document::report::StepFunction;
use std::fmt::Write as _;

/// A step as a function of a formula's inputs.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct StepFormula {
    /// The formula.
    pub id: &'static str,
    /// A library in WGSL, whose function [`FUNCTION`] has the formula's inputs as its parameters.
    pub wgsl: String,
    /// Inputs that are constants in the shader or by the form, by the bits of their numbers.
    pub numbers: Vec<(&'static str, Vec<u32>)>,
    /// Inputs that are the same as another one.
    pub same: Vec<(&'static str, &'static str)>,
}

/// The name of the function that is judged.
pub const FUNCTION: &str = "judged";

/// What a parameter of a form is over a formula's inputs.
struct Is {
    parameter: &'static str,
    expression: &'static str,
    /// The input that is held where the parameter is a constant, and whether as its negative; none where that cannot be.
    held: Option<(&'static str, bool)>,
}

const fn is(parameter: &'static str, expression: &'static str) -> Is {
    Is { parameter, expression, held: Some((expression, false)) }
}

const fn made(parameter: &'static str, expression: &'static str) -> Is {
    Is { parameter, expression, held: None }
}

const fn held(parameter: &'static str, expression: &'static str, input: &'static str, is_negated: bool) -> Is {
    Is { parameter, expression, held: Some((input, is_negated)) }
}

/// Forms, and how they are a formula. `STEP` is the step's value.
struct Row {
    forms: &'static [&'static str],
    formula: &'static str,
    parameters: &'static [Is],
    /// Inputs that the forms have as a constant.
    numbers: &'static [(&'static str, f32)],
    same: &'static [(&'static str, &'static str)],
    value: &'static str,
}

const fn row(
    forms: &'static [&'static str],
    formula: &'static str,
    parameters: &'static [Is],
    value: &'static str,
) -> Row {
    Row { forms, formula, parameters, numbers: &[], same: &[], value }
}

/// A vector to a light, and one to the eye, of lit surfaces.
const LIT: &[Is] = &[
    held("n", "unit(normal)", "normal", false),
    held("l", "unit(-direction)", "direction", true),
    held("v", "unit(-p)", "p", true),
    is("exponent", "shininess"),
];
const LIT_SUM: &str = "vec4f(la * ma + ld * md * max(dot(unit(normal), unit(-direction)), 0.0) + ls * ms * STEP, 1.0)";
const POLYNOMIAL: &[Is] = &[is("kc", "kc"), is("kl", "kl"), is("kq", "kq"), made("d", "d")];
const CONE: &[Is] =
    &[is("l", "l"), is("axis", "axis"), is("cut", "cutoff_cosine"), is("exponent", "exponent"), made("lit", "1.0")];
const CONE_OF_COLOR: &[Is] = &[is("l", "l"), is("axis", "axis"), is("cut", "cutoff_cosine"), made("lit", "vec3f(1.0)")];
const CONE_OF_FOUR: &[Is] = &[is("l", "l"), is("axis", "axis"), is("cut", "cutoff_cosine"), made("lit", "vec4f(1.0)")];
const FOG: &[Is] = &[made("d", "length(p)"), made("x", "length(p)"), is("density", "density")];
/// A ramp is 0 where fog is thickest.
const RAMP: &[Is] = &[made("x", "length(p)"), is("start", "dmax"), is("to", "dmin")];
const OPACITY: &[Is] = &[made("d", "distance"), is("density", "density")];
const POWER: &[Is] = &[is("a", "a"), is("b", "b"), is("exponent", "exponent")];
const MATRIX: &[Is] = &[made("m", "modelview"), is("normal", "n")];
const MATRIX_TRANSPOSED: &[Is] = &[made("m", "transpose(modelview)"), is("normal", "n")];
/// A matrix of four columns, which moves too.
const MOVING: &str =
    "mat4x4f(vec4f(modelview[0], 0.0), vec4f(modelview[1], 0.0), vec4f(modelview[2], 0.0), vec4f(1.0, 2.0, 3.0, 1.0))";
const MATRIX_OF_FOUR: &[Is] = &[made("m", MOVING), is("normal", "n")];
const MATRIX_OF_FOUR_TRANSPOSED: &[Is] = &[made("m", MOVING_TRANSPOSED), is("normal", "n")];
/// The same from the right of its transpose, whose rows are the columns.
const MOVING_TRANSPOSED: &str = "transpose(mat4x4f(vec4f(modelview[0], 0.0), vec4f(modelview[1], 0.0), vec4f(modelview[2], 0.0), vec4f(1.0, 2.0, 3.0, 1.0)))";
const FACTOR: &str = "Fogged(STEP, mix(fog, shaded, STEP))";

const ROWS: &[Row] = &[
    row(
        &["lambert", "lambert_absolute", "lambert_unclamped", "lambert_squared"],
        "lighting/diffuse-toward",
        &[is("n", "n"), is("l", "l")],
        "ld * md * STEP",
    ),
    row(
        &["phong", "phong_single", "phong_unguarded", "phong_absolute", "phong_inverse"],
        "lighting/phong",
        LIT,
        LIT_SUM,
    ),
    row(&["phong_gated"], "lighting/phong-gated", LIT, LIT_SUM),
    row(
        &["blinn", "blinn_mean", "blinn_sum", "blinn_unguarded", "blinn_absolute", "blinn_inverse"],
        "lighting/blinn",
        LIT,
        LIT_SUM,
    ),
    row(&["lobe", "lobe_unguarded", "lobe_absolute"], "lighting/cosine-power", POWER, "STEP"),
    row(
        &["attenuation", "quadratic_without_square", "reciprocal_of_first"],
        "attenuation/polynomial",
        POLYNOMIAL,
        "STEP",
    ),
    Row { numbers: &[("kc", 1.0)], ..row(&["attenuation_one"], "attenuation/polynomial", POLYNOMIAL, "STEP") },
    Row {
        numbers: &[("kc", 1.0)],
        same: &[("kq", "kl")],
        ..row(&["attenuation_twice"], "attenuation/polynomial", &[is("k", "kl"), made("d", "d")], "STEP")
    },
    Row {
        numbers: &[("kl", 0.0)],
        ..row(&["attenuation_constant_quadratic"], "attenuation/polynomial", POLYNOMIAL, "STEP")
    },
    Row {
        numbers: &[("kq", 0.0)],
        ..row(&["attenuation_constant_linear"], "attenuation/polynomial", POLYNOMIAL, "STEP")
    },
    Row {
        numbers: &[("kc", 1.0), ("kl", 0.0)],
        ..row(&["attenuation_quadratic"], "attenuation/polynomial", POLYNOMIAL, "STEP")
    },
    Row {
        numbers: &[("kc", 1.0), ("kq", 0.0)],
        ..row(&["attenuation_linear"], "attenuation/polynomial", POLYNOMIAL, "STEP")
    },
    Row {
        numbers: &[("kc", 0.0)],
        ..row(&["attenuation_linear_quadratic"], "attenuation/polynomial", POLYNOMIAL, "STEP")
    },
    Row {
        numbers: &[("kc", 1.0), ("kl", 0.0), ("kq", 1.0)],
        ..row(&["attenuation_one_square"], "attenuation/polynomial", &[made("offset", "vec3f(0.0, d, 0.0)")], "STEP")
    },
    row(&["divisor"], "attenuation/polynomial", POLYNOMIAL, "1.0 / STEP"),
    Row { numbers: &[("kc", 1.0)], ..row(&["divisor_one"], "attenuation/polynomial", POLYNOMIAL, "1.0 / STEP") },
    Row {
        numbers: &[("kc", 1.0)],
        same: &[("kq", "kl")],
        ..row(&["divisor_twice"], "attenuation/polynomial", &[is("k", "kl"), made("d", "d")], "1.0 / STEP")
    },
    Row {
        numbers: &[("kl", 0.0)],
        ..row(&["divisor_constant_quadratic"], "attenuation/polynomial", POLYNOMIAL, "1.0 / STEP")
    },
    row(
        &["inverse_square", "inverse_square_given", "inverse_fourth"],
        "attenuation/square",
        &[made("d", "d"), made("offset", "vec3f(0.0, d, 0.0)")],
        "STEP",
    ),
    row(
        &["inverse_square_of", "inverse_square_given_of"],
        "attenuation/square",
        &[made("d", "d"), made("offset", "vec3f(0.0, d, 0.0)"), made("k", "1.0")],
        "STEP",
    ),
    row(
        &["inverse_square_colored"],
        "attenuation/square",
        &[made("offset", "vec3f(0.0, d, 0.0)"), made("color", "vec3f(1.0)")],
        "STEP.x",
    ),
    Row {
        numbers: &[("kc", 0.0), ("kl", 0.0)],
        ..row(
            &["inverse_square_by"],
            "attenuation/polynomial",
            &[made("offset", "vec3f(0.0, d, 0.0)"), is("k", "kq")],
            "STEP",
        )
    },
    Row {
        numbers: &[("kc", 0.0), ("kl", 0.0)],
        ..row(
            &["inverse_square_scaled"],
            "attenuation/polynomial",
            &[made("offset", "vec3f(0.0, d, 0.0)"), made("k", "1.0"), is("kq", "kq")],
            "STEP",
        )
    },
    Row {
        numbers: &[("kc", 0.0), ("kq", 0.0)],
        ..row(&["inverse_by"], "attenuation/polynomial", &[made("offset", "vec3f(0.0, d, 0.0)"), is("k", "kl")], "STEP")
    },
    row(&["inverse"], "attenuation/linear", &[made("offset", "vec3f(0.0, d, 0.0)")], "STEP"),
    row(&["spot_hard", "spot_gate_f32", "spot_turned"], "attenuation/spot-cutoff", CONE, "STEP"),
    row(&["spot_gate_vec3f"], "attenuation/spot-cutoff", CONE_OF_COLOR, "STEP.x"),
    row(&["spot_gate_vec4f"], "attenuation/spot-cutoff", CONE_OF_FOUR, "STEP.x"),
    row(&["spot_power", "spot_power_open"], "attenuation/spot-exponent", CONE, "STEP"),
    row(&["fog_exp", "fog_base_two", "fog_positive"], "fog/exp-radial", FOG, FACTOR),
    row(
        &["fog_exp2", "fog_base_two_square", "fog_difference", "fog_positive_square"],
        "fog/exp2-opengl-radial",
        FOG,
        FACTOR,
    ),
    row(&["fog_exp2_document"], "fog/exp2-document-radial", FOG, FACTOR),
    row(&["fog_exp_amount"], "fog/opacity", OPACITY, "STEP"),
    row(&["ramp", "ramp_open", "ramp_above", "ramp_below"], "fog/linear-radial", RAMP, FACTOR),
    row(
        &["ramp_width"],
        "fog/linear-radial",
        &[made("x", "length(p)"), is("start", "dmax"), made("width", "(dmin - dmax)")],
        FACTOR,
    ),
    row(&["normal_by_matrix"], "vector/normal-modelview", MATRIX, "STEP"),
    row(&["normal_by_transpose", "normal_by_transposed"], "vector/normal-modelview", MATRIX_TRANSPOSED, "STEP"),
    row(&["normal_by_upper", "normal_by_part", "normal_moved"], "vector/normal-modelview", MATRIX_OF_FOUR, "STEP"),
    row(
        &["normal_by_upper_transposed", "normal_by_part_transposed"],
        "vector/normal-modelview",
        MATRIX_OF_FOUR_TRANSPOSED,
        "STEP",
    ),
    row(&["normal_of_four"], "vector/normal-modelview", &[made("m", MOVING), made("normal", "vec4f(n, 0.0)")], "STEP"),
    row(
        &["barycentric_vec3f"],
        "color/per-vertex",
        &[is("weights", "weights"), is("color", "a"), is("other", "b"), is("third", "c")],
        "vec4f(STEP, 1.0)",
    ),
    row(&["srgb_encode_f32"], "color/srgb-encode-component", &[made("color", "c")], "STEP"),
    row(
        &["srgb_encode_vec3f", "srgb_encode_late_vec3f"],
        "color/srgb-encode",
        &[made("color", "c.rgb")],
        "vec4f(STEP, c.a)",
    ),
    row(
        &["srgb_decode_vec3f", "srgb_decode_late_vec3f"],
        "color/srgb-decode",
        &[made("color", "e.rgb")],
        "vec4f(STEP, e.a)",
    ),
];

/// The forms that are judged as formulas, with the formula of each.
pub fn judged_forms() -> impl Iterator<Item = (&'static str, &'static str)> {
    ROWS.iter().flat_map(|row| row.forms.iter().map(|form| (*form, row.formula)))
}

/// A vector's length made 1, but for that of no length.
const UNIT: &str = "fn unit(v: vec3f) -> vec3f {\n    return select(normalize(v), vec3f(), all(v == vec3f()));\n}\n";

/// The formula that a step's form is of; none where no formula is.
#[must_use]
pub fn formula_of_form(form: &str) -> Option<&'static str> {
    judged_forms().find(|(own, _)| *own == form).map(|(_, formula)| formula)
}

/// A step as the formula of its form, which `spec` describes; none where its form is of no formula, or has a constant where the formula has
/// what is drawn.
#[must_use]
pub fn step_formula(step: &StepFunction, spec: &Spec) -> Option<StepFormula> {
    let row = ROWS.iter().find(|row| row.forms.contains(&&*step.form) && row.formula == spec.id)?;
    let mut numbers: Vec<(&'static str, Vec<u32>)> =
        row.numbers.iter().map(|(name, number)| (*name, vec![number.to_bits()])).collect();
    let mut arguments = vec![];
    for parameter in &step.parameters {
        let own = row.parameters.iter().find(|own| own.parameter == parameter.name)?;
        if parameter.bits.is_empty() {
            arguments.push(format!("{}({})", if parameter.is_negated { "-" } else { "" }, own.expression));
            continue;
        }
        let (input, is_turned) = own.held?;
        let sign = if parameter.is_negated == is_turned { 1.0 } else { -1.0 };
        let components = spec.inputs.iter().find(|one| one.name == input)?.shape.components();
        if components != parameter.bits.len() {
            return None;
        }
        let bits = parameter.bits.iter().map(|own| (sign * f32::from_bits(*own)).to_bits()).collect();
        numbers.push((input, bits));
    }
    let is_input = |name: &&str| spec.inputs.iter().any(|input| input.name == *name);
    if !numbers.iter().map(|own| &own.0).all(is_input) {
        return None;
    }
    let mut wgsl = format!("{}\n{UNIT}\n", step.wgsl.trim_end());
    let result = match spec.outputs {
        [only] => type_of(only.shape).to_owned(),
        several => {
            let members: String =
                several.iter().map(|own| format!("    {}: {},\n", own.name, type_of(own.shape))).collect();
            let _ = writeln!(wgsl, "struct Fogged {{\n{members}}}\n");
            "Fogged".into()
        }
    };
    let inputs: Vec<String> =
        spec.inputs.iter().map(|input| format!("{}: {}", input.name, type_of(input.shape))).collect();
    let value = row.value.replace("STEP", "own");
    let _ = writeln!(
        wgsl,
        "fn {FUNCTION}({}) -> {result} {{\n    let own = shader_step({});\n    return {value};\n}}",
        inputs.join(", "),
        arguments.join(", ")
    );
    Some(StepFormula { id: row.formula, wgsl, numbers, same: row.same.to_vec() })
}
