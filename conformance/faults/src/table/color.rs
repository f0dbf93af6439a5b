//! Mistakes of colours and their storage.

use super::super::alteration::Form;
use super::super::fault::Fault;
use super::super::fault::Step::Instead;
use super::super::op::Op;
use super::{fault, form, output, pass, pass_as, result, sum};

pub(super) const FAULTS: &[Fault] = &[
    fault("byte-truncated", "8 bits are cut, not rounded", &[&[form("byte", Form::TruncatedByte)]])
        .seen_in("int(255·c)"),
    fault("byte-by-256", "8 bits are the whole part of 256·c", &[&[form("byte", Form::ByteBy256)]]),
    fault("byte-unclamped", "8 bits are not clamped", &[&[form("byte", Form::UnclampedByte)]])
        .seen_in("bytes that wrap around"),
    fault("byte-over-256", "8 bits are divided by 256", &[&[pass_as("byte/255", "byte", Op::Scale(1.0 / 256.0))]]),
    fault(
        "one-power-for-srgb",
        "one power of 2.2 stands for sRGB",
        &[
            &[pass_as("encoded by the power alone", "c", Op::Power(1.0 / 2.2))],
            &[pass_as("encoded", "c", Op::Power(1.0 / 2.2))],
            &[pass_as("decoded", "e", Op::Power(2.2))],
        ],
    ),
    fault(
        "encoded-for-decoded",
        "sRGB is encoded where it is to be decoded",
        &[&[pass_as("decoded", "e", Op::Encode)]],
    ),
    fault(
        "decoded-for-encoded",
        "sRGB is decoded where it is to be encoded",
        &[
            &[pass_as("encoded by the power alone", "c", Op::Decode)],
            &[pass_as("c^(1/2.2)", "c", Op::Decode)],
            &[pass_as("encoded", "c", Op::Decode)],
        ],
    ),
    fault(
        "not-converted",
        "sRGB is not converted at all",
        &[
            &[pass("encoded by the power alone", "c")],
            &[pass("c^(1/2.2)", "c")],
            &[pass("encoded", "c")],
            &[pass("decoded", "e")],
        ],
    ),
    fault(
        "encoded-twice",
        "sRGB is encoded twice",
        &[
            &[result("encoded by the power alone", Op::Encode)],
            &[result("c^(1/2.2)", Op::Encode)],
            &[result("encoded", Op::Encode)],
        ],
    )
    .seen_in("an sRGB target beneath a shader that encodes"),
    fault(
        "straight-piece-throughout",
        "sRGB's straight piece is taken throughout",
        &[
            &[pass_as("encoded by the power alone", "c", Op::Scale(12.92))],
            &[pass_as("c^(1/2.2)", "c", Op::Scale(12.92))],
            &[pass_as("encoded", "c", Op::Scale(12.92))],
        ],
    ),
    fault(
        "alpha-encoded",
        "alpha is sRGB-encoded too",
        &[&[result("alpha of an encoded color", Op::Encode)], &[result("alpha of a decoded color", Op::Decode)]],
    ),
    fault("sum-not-clamped", "the clamp of the sum is missing", &[&[pass("clamp", "sum")]]),
    fault("texture-added", "the texture is added where it is to modulate", &[&[sum("texel·color", "texel", "color")]]),
    fault(
        "texture-replaces",
        "the texture replaces where it is to modulate",
        &[&[Instead(&[("color/modulate", "color/replace")])]],
    ),
    fault(
        "texture-modulates",
        "the texture modulates where it is to replace",
        &[&[Instead(&[("color/replace", "color/modulate")])]],
    ),
    fault(
        "modulated-twice-as-bright",
        "the product of the two colours is doubled",
        &[&[output("color", Op::Scale(2.0))]],
    )
    .only(|spec| spec.id == "color/modulate" || spec.id == "blend/mode-mul")
    .seen_in("modulate2x"),
    fault(
        "encode-threshold-of-decoding",
        "sRGB's pieces part at 0.04045 where they are to part at 0.0031308",
        &[&[form("encoded", Form::EncodeThreshold)]],
    ),
    fault(
        "decode-threshold-of-encoding",
        "sRGB's pieces part at 0.0031308 where they are to part at 0.04045",
        &[&[form("decoded", Form::DecodeThreshold)]],
    )
    .seen_in("FidelityFX-SPD, issue 6"),
    fault(
        "decode-threshold-of-a-draft",
        "sRGB's pieces part at 0.03928 where they are to part at 0.04045",
        &[&[form("decoded", Form::DecodeOldThreshold)]],
    )
    .seen_in("WCAG 2.0's relative luminance, after a draft of the standard"),
    fault(
        "encode-exponent-of-five-digits",
        "sRGB is encoded by a power of 0.41666 for 1/2.4",
        &[&[form("encoded", Form::EncodeShortExponent)]],
    )
    .seen_in("three.js, sRGBTransferOETF"),
    fault(
        "last-weight-as-the-rest",
        "the third vertex's weight is what the other two leave of 1, not what is given",
        &[&[form("Σ weight·color", Form::LastWeightAsTheRest)]],
    )
    .seen_in("c + α(a − c) + β(b − c)"),
    fault(
        "rec709-for-srgb",
        "Rec. 709's curve stands for sRGB's",
        &[
            &[form("encoded by the power alone", Form::EncodeRec709)],
            &[form("encoded", Form::EncodeRec709)],
            &[form("decoded", Form::DecodeRec709)],
        ],
    ),
    fault(
        "square-root-for-srgb",
        "a square root, or a square, stands for sRGB",
        &[
            &[pass_as("encoded by the power alone", "c", Op::Root)],
            &[pass_as("encoded", "c", Op::Root)],
            &[pass_as("decoded", "e", Op::Square)],
        ],
    )
    .seen_in("shaders that spare a pow"),
    fault(
        "power-for-the-curve",
        "a power of 1/2.2 stands for sRGB's curved piece, beside its straight one",
        &[&[form("encoded", Form::EncodeCurve)]],
    ),
    fault("encode-scale-missing", "sRGB's factor of 1.055 is missing", &[&[form("encoded", Form::EncodeWithoutScale)]])
        .seen_in("three.js, PR 8345"),
    fault(
        "power-of-0.4545",
        "the power is 0.4545, where 1/2.2 is asked for",
        &[&[result("c^(1/2.2)", Op::Power(0.4545 * 2.2))]],
    )
    .seen_in("pow(color, vec3(0.4545))"),
    fault("srgb-for-a-power", "sRGB stands for a power of 1/2.2", &[&[pass_as("c^(1/2.2)", "c", Op::Encode)]]),
];
