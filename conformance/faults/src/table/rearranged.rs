//! Rearrangements: formulas that are equal for real numbers and round elsewhere. A compiler may not make them; an author may, and should read
//! that this is all that differs.

use super::super::body::Body as Wrong;
use super::super::fault::Fault;
use super::super::fault::Step::{Body, Instead};
use super::fault;

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "rearranged-from-the-end",
        "the formula is rearranged, b − (1 − t)(b − a) for a(1 − t) + b·t: equal for real numbers, and rounded elsewhere",
        &[&[Body(Wrong::MixFromTheEnd)]],
    ),
    fault(
        "rearranged-incremental",
        "the formula is rearranged, a + t(b − a) for a(1 − t) + b·t: equal for real numbers, and rounded elsewhere",
        &[&[Instead(&[("interpolation/mix", "interpolation/mix-incremental"), ("blend/over", "blend/over-incremental")])]],
    )
    .seen_in("GLSL's mix, as some drivers compute it"),
    fault(
        "rearranged-edge",
        "the formula is rearranged, with the sides taken from another vertex: equal for real numbers, and rounded elsewhere",
        &[&[Body(Wrong::EdgeFromItsEnd)]],
    ),
    fault(
        "rearranged-depth-range",
        "the formula is rearranged, near(1 − z) + far·z for near + z(far − near): equal for real numbers, and rounded elsewhere",
        &[&[Body(Wrong::DepthBetween)]],
    )
    .seen_in("viewport transforms that mix near and far"),
    fault(
        "rearranged-rounding",
        "the formula is rearranged, ⌊255·c + ½⌋ for 255·c rounded: equal for real numbers, and rounded twice",
        &[&[Body(Wrong::RoundedBySum)]],
    )
    .seen_in("Direct3D's rule for a conversion from float to UNORM"),
];
