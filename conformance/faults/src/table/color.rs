//! Mistakes of colours and their storage.

use super::super::body::Body as Wrong;
use super::super::change::After as Out;
use super::super::fault::Fault;
use super::super::fault::Step::{After, Body, Instead};
use super::fault;

pub(super) const FAULTS: &[Fault] = &[
    fault("byte-truncated", "8 bits are cut, not rounded", &[&[Body(Wrong::TruncatedByte)]]).seen_in("int(255·c)"),
    fault("byte-by-256", "8 bits are the whole part of 256·c", &[&[Body(Wrong::By256)]]),
    fault("byte-unclamped", "8 bits are not clamped", &[&[Body(Wrong::UnclampedByte)]])
        .seen_in("bytes that wrap around"),
    fault("byte-over-256", "8 bits are divided by 256", &[&[Body(Wrong::Over256)]]),
    fault("one-power-for-srgb", "one power of 2.2 stands for sRGB", &[&[Body(Wrong::OnePower)]]),
    fault("encoded-for-decoded", "sRGB is encoded where it is to be decoded", &[&[Body(Wrong::Encoded)]]),
    fault("decoded-for-encoded", "sRGB is decoded where it is to be encoded", &[&[Body(Wrong::Decoded)]]),
    fault("not-converted", "sRGB is not converted at all", &[&[Body(Wrong::NotConverted)]]),
    fault("encoded-twice", "sRGB is encoded twice", &[&[Body(Wrong::Twice)]])
        .seen_in("an sRGB target beneath a shader that encodes"),
    fault("straight-piece-throughout", "sRGB's straight piece is taken throughout", &[&[Body(Wrong::StraightPiece)]]),
    fault("alpha-encoded", "alpha is sRGB-encoded too", &[&[Body(Wrong::AlphaToo)]]),
    fault("sum-not-clamped", "the clamp of the sum is missing", &[&[Body(Wrong::SumNotClamped)]]),
    fault("texture-added", "the texture is added where it is to modulate", &[&[Body(Wrong::Added)]]),
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
    fault("modulated-twice-as-bright", "a lightmap is twice as bright", &[&[After(Out::Scale("color", 2.0))]])
        .only(|spec| spec.id == "color/modulate" || spec.id == "blend/mode-mul")
        .seen_in("modulate2x"),
];
