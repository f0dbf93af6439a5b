//! Rearrangements: formulas that are equal for real numbers and round elsewhere. A compiler may not make them; an author may, and should read
//! that this is all that differs.

use super::super::alteration::Form;
use super::super::fault::Fault;
use super::super::fault::Step::Instead;
use super::{fault, form};

pub(super) const FAULTS: &[Fault] = &[
    fault(
        "rearranged-from-the-end",
        "the formula is rearranged, b − (1 − t)(b − a) for a(1 − t) + b·t: equal for real numbers, and rounded elsewhere",
        &[&[form("mix", Form::MixFromTheEnd)], &[form("over", Form::MixFromTheEnd)]],
    )
    .rounding(),
    fault(
        "rearranged-incremental",
        "the formula is rearranged, a + t(b − a) for a(1 − t) + b·t: equal for real numbers, and rounded elsewhere",
        &[&[Instead(&[("interpolation/mix", "interpolation/mix-incremental"), ("blend/over", "blend/over-incremental")])]],
    )
    .rounding()
    .seen_in("GLSL's mix, as some drivers compute it"),
    fault(
        "rearranged-over",
        "the formula is rearranged, src·As + (dst − dst·As) for src·As + dst(1 − As): equal for real numbers, and rounded elsewhere",
        &[&[form("over", Form::OverFromTheProduct)]],
    )
    .rounding()
    .seen_in("shaders that write fma(src, a, dst − dst·a)"),
    fault(
        "rearranged-scanline",
        "the formula is rearranged, u + (w − u)·t along the edges and the span, with the share t of each: equal for real numbers, and rounded elsewhere",
        &[&[form("along an edge", Form::AlongByShare), form("along the span", Form::AlongByShare)]],
    )
    .rounding()
    .seen_in("scan converters written with mix"),
    fault(
        "rearranged-edge",
        "the formula is rearranged, with the sides taken from the next vertex: equal for real numbers, and rounded elsewhere",
        &[
            &[form("edge", Form::EdgeFromItsEnd), form("2·area", Form::EdgeFromItsEnd)],
            &[form("edge", Form::EdgeFromItsEnd)],
            &[form("(b − a)×(c − a)", Form::EdgeFromItsEnd)],
            &[form("2·area", Form::EdgeFromItsEnd)],
        ],
    )
    .rounding(),
    fault(
        "rearranged-edge-from-the-last",
        "the formula is rearranged, with the sides taken from the point or the last vertex: equal for real numbers, and rounded elsewhere",
        &[
            &[form("edge", Form::EdgeFromThePoint), form("2·area", Form::EdgeFromThePoint)],
            &[form("edge", Form::EdgeFromThePoint)],
            &[form("(b − a)×(c − a)", Form::EdgeFromThePoint)],
            &[form("2·area", Form::EdgeFromThePoint)],
        ],
    )
    .rounding(),
    fault(
        "rearranged-weights",
        "the formula is rearranged, each area over the sum of the three for each area over that of the triangle: equal for real numbers, and rounded elsewhere",
        &[&[form("weights", Form::WeightsBySum)]],
    )
    .rounding(),
    fault(
        "rearranged-weights-by-difference",
        "the formula is rearranged, 1 without the other two weights for the last one: equal for real numbers, and rounded elsewhere",
        &[&[form("weights", Form::WeightsByDifference)]],
    )
    .rounding()
    .seen_in("rasterisers that compute two weights of three"),
    fault(
        "rearranged-face-normal",
        "the formula is rearranged, a×b + b×c + c×a for (b − a)×(c − a): equal for real numbers, and rounded elsewhere",
        &[&[form("(b − a)×(c − a)", Form::NormalByVertices)]],
    )
    .rounding()
    .seen_in("Newell's method for the normal of a polygon"),
    fault(
        "rearranged-line",
        "the formula is rearranged, a + qb/(qa + qb)·(b − a) for (qa·a + qb·b)/(qa + qb): equal for real numbers, and rounded elsewhere",
        &[&[form("perspective along a line", Form::FromTheFirst)]],
    )
    .rounding()
    .seen_in("clippers that find the share once for all attributes"),
    fault(
        "rearranged-fog-mix",
        "the formula is rearranged, shaded − (1 − f)(shaded − fog) for fog(1 − f) + shaded·f: equal for real numbers, and rounded elsewhere",
        &[&[form("color", Form::FogFromTheSurface)]],
    )
    .rounding(),
    fault(
        "rearranged-fog-factor",
        "the formula is rearranged, 1 − (distance − dmin)/(dmax − dmin) for (dmax − distance)/(dmax − dmin): equal for real numbers, and rounded elsewhere",
        &[&[form("f", Form::FogFromDmin)]],
    )
    .rounding(),
    fault(
        "rearranged-depth",
        "the formula is rearranged as a projection matrix has it, f/(f − n)·(1 − n/z) for f(z − n)/(z(f − n)): equal for real numbers, and rounded elsewhere",
        &[&[form("depth", Form::DepthByProjection)], &[form("reversed depth", Form::DepthByProjection)]],
    )
    .rounding()
    .seen_in("projection matrices, which hold f/(f − n) and n·f/(f − n)"),
    fault(
        "rearranged-depth-by-reciprocals",
        "the formula is rearranged, (1/z − 1/n)/(1/f − 1/n) for f(z − n)/(z(f − n)): equal for real numbers, and rounded elsewhere",
        &[&[form("depth", Form::DepthByReciprocals)], &[form("reversed depth", Form::DepthByReciprocals)]],
    )
    .rounding()
    .seen_in("textbooks that write a depth as a share of 1/z"),
    fault(
        "rearranged-depth-by-difference",
        "the formula is rearranged as a projection matrix multiplies, f/(f − n) − f·n/((f − n)z) for f(z − n)/(z(f − n)): equal for real numbers, and rounded elsewhere",
        &[&[form("depth", Form::DepthByDifference)], &[form("reversed depth", Form::DepthByDifference)]],
    )
    .rounding()
    .seen_in("projection matrices, which hold f/(f − n) and n·f/(f − n)"),
    fault(
        "rearranged-rounding",
        "the formula is rearranged, ⌊255·c + ½⌋ for 255·c rounded: equal for real numbers, and rounded twice",
        &[&[form("byte", Form::ByteBySum)]],
    )
    .rounding()
    .seen_in("Direct3D's rule for a conversion from float to UNORM"),
];
