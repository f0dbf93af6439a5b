//! Numbers that are held in fewer bits than binary32 has: mediump, half-precision varyings, bfloat16.

use super::super::alteration::ANY;
use super::super::change::After as Out;
use super::super::change::Before as In;
use super::super::fault::Fault;
use super::super::fault::Step::{After, Before};
use super::super::op::Op;
use super::{fault, given, input, result};
use lightmeter_catalogue::cases::{Kind, Spec};

pub(super) const FAULTS: &[Fault] = &[
    fault("inputs-in-half-precision", "every input is held in half precision", &[&[Before(In::All(Op::Half))]])
        .only(in_arithmetic)
        .seen_in("mediump uniforms and varyings"),
    fault("outputs-in-half-precision", "every output is held in half precision", &[&[After(Out::All(Op::Half))]])
        .only(in_arithmetic)
        .seen_in("mediump; rgba16float targets"),
    fault(
        "all-in-half-precision",
        "inputs, each named step and outputs are held in half precision",
        &[&[Before(In::All(Op::Half)), result(ANY, Op::Half), After(Out::All(Op::Half))]],
    )
    .only(in_arithmetic)
    .seen_in("precision mediump float"),
    fault("inputs-in-bfloat16", "every input is held in bfloat16", &[&[Before(In::All(Op::BFloat))]])
        .only(in_arithmetic),
    fault("outputs-in-bfloat16", "every output is held in bfloat16", &[&[After(Out::All(Op::BFloat))]])
        .only(in_arithmetic),
    fault(
        "inputs-in-half-by-truncation",
        "every input is cut to half precision, not rounded",
        &[&[Before(In::All(Op::HalfCut))]],
    )
    .only(|spec| in_arithmetic(spec) && spec.id != "interpolation/front-facing")
    .seen_in("half from float by shifts"),
    fault(
        "outputs-in-half-by-truncation",
        "every output is cut to half precision, not rounded",
        &[&[After(Out::All(Op::HalfCut))]],
    )
    .only(in_arithmetic),
    fault(
        "inputs-in-bfloat16-by-truncation",
        "every input is cut to bfloat16, not rounded",
        &[&[Before(In::All(Op::BFloatCut))]],
    )
    .only(in_arithmetic)
    .seen_in("bfloat16 as the upper half of a float"),
    fault(
        "outputs-in-bfloat16-by-truncation",
        "every output is cut to bfloat16, not rounded",
        &[&[After(Out::All(Op::BFloatCut))]],
    )
    .only(in_arithmetic),
    fault("normal-in-half-precision", "the normal is held in half precision", &[&[result("n", Op::Half)]])
        .only(in_arithmetic),
    fault(
        "light-vector-in-half-precision",
        "the vector to the light is held in half precision",
        &[&[result("l", Op::Half)]],
    )
    .only(in_arithmetic),
    fault(
        "unnormalised-light-vector-in-half-precision",
        "the vector to the light is held in half precision before it is normalised",
        &[&[result("light − p", Op::Half)]],
    )
    .only(in_arithmetic),
    fault("view-vector-in-half-precision", "the view vector is held in half precision", &[&[result("v", Op::Half)]])
        .only(in_arithmetic),
    fault("half-vector-in-half-precision", "the half vector is held in half precision", &[&[result("h", Op::Half)]])
        .only(in_arithmetic),
    fault(
        "mirrored-vector-in-half-precision",
        "the mirrored vector is held in half precision",
        &[&[result("r", Op::Half)]],
    )
    .only(in_arithmetic),
    fault("incidence-in-half-precision", "the diffuse cosine is held in half precision", &[&[result("FI", Op::Half)]])
        .only(in_arithmetic),
    fault("n-dot-h-in-half-precision", "the cosine n·h is held in half precision", &[&[result("n·h", Op::Half)]])
        .only(in_arithmetic),
    fault("r-dot-v-in-half-precision", "the cosine r·v is held in half precision", &[&[result("r·v", Op::Half)]])
        .only(in_arithmetic),
    fault("power-in-half-precision", "the highlight's power is held in half precision", &[&[result("FS", Op::Half)]])
        .only(in_arithmetic),
    fault(
        "light-distance-in-half-precision",
        "the distance to the light is held in half precision",
        &[&[result("d", Op::Half)]],
    )
    .only(in_arithmetic),
    fault("attenuation-in-half-precision", "attenuation is held in half precision", &[&[result("atten", Op::Half)]])
        .only(in_arithmetic),
    fault("cone-in-half-precision", "the cone's share is held in half precision", &[&[result("spot", Op::Half)]])
        .only(in_arithmetic),
    fault(
        "fog-distance-in-half-precision",
        "the fog's distance is held in half precision",
        &[&[result("distance", Op::Half)]],
    )
    .only(in_arithmetic),
    fault("fog-factor-in-half-precision", "the fog's factor is held in half precision", &[&[result("f", Op::Half)]])
        .only(in_arithmetic),
    fault("weights-in-half-precision", "each weight is held in half precision", &[&[result("weight", Op::Half)]])
        .only(in_arithmetic),
    fault("depth-in-half-precision", "depth is held in half precision", &[&[result("depth", Op::Half)]])
        .only(in_arithmetic),
    fault("ndc-in-half-precision", "the position over w is held in half precision", &[&[result("ndc", Op::Half)]])
        .only(in_arithmetic),
    fault(
        "given-density-in-half-precision",
        "the density is given in half precision",
        &[&[input("density", Op::Half)]],
    )
    .only(in_arithmetic),
    fault(
        "given-shininess-in-half-precision",
        "the shininess is given in half precision",
        &[&[input("shininess", Op::Half)]],
    )
    .only(in_arithmetic),
    fault(
        "given-exponent-in-half-precision",
        "the exponent is given in half precision",
        &[&[input("exponent", Op::Half)]],
    )
    .only(in_arithmetic),
    fault("given-p-in-half-precision", "the point is given in half precision", &[&[input("p", Op::Half)]])
        .only(in_arithmetic),
    fault("given-normal-in-half-precision", "the normal is given in half precision", &[&[input("normal", Op::Half)]])
        .only(in_arithmetic),
    fault(
        "given-position-in-half-precision",
        "the light's position is given in half precision",
        &[&[input("position", Op::Half)]],
    )
    .only(in_arithmetic),
    fault(
        "given-attributes-in-half-precision",
        "the attributes are given in half precision",
        &[&[input("attr", Op::Half)]],
    )
    .only(in_arithmetic),
    fault(
        "given-clip-in-half-precision",
        "the position in clip space is given in half precision",
        &[&[input("clip", Op::Half)]],
    )
    .only(in_arithmetic),
    fault("given-t-in-half-precision", "the share t is given in half precision", &[&[input("t", Op::Half)]])
        .only(in_arithmetic),
    fault(
        "exponent-in-bfloat16",
        "the highlight's exponent is held in bfloat16",
        &[&[given("FS", "exponent", Op::BFloat)]],
    )
    .only(in_arithmetic),
];

/// What blends, tests depth or rasterises rounds as its target does.
fn in_arithmetic(spec: &Spec) -> bool {
    matches!(spec.kind, Kind::Arithmetic)
}
