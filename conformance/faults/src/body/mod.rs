//! Single formulas with a mistake in their midst, where neither inputs nor outputs can be changed to the same effect.

mod attenuation;
mod color;
mod depth;
mod interpolation;
mod vector;

use super::row::{InputRow, put};
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_reference::{Real, Vector};
use lightmeter_scene::depth::Compare;

/// What is computed instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Body {
    // Vectors.
    /// i − (i·n)n.
    ReflectOnce,
    /// i + 2(i·n)n.
    ReflectWithPlus,
    /// (v + l)/2.
    HalfwayAsMean,
    /// v/Σ|vᵢ|.
    NormalizeBySum,
    /// v/max|vᵢ|.
    NormalizeByLargest,
    /// v/|v|².
    NormalizeBySquare,
    /// |v|².
    SquaredLength,
    /// Normals by the inverse, not transposed: transposed cofactors over the determinant.
    NormalByInverse,
    /// Normals by the modelview, as such or normalised.
    NormalByModelview,
    /// Normals by the cofactors without the determinant, whose sign is lost.
    NormalByBareCofactors,
    /// A direction moved by the view's translation.
    DirectionAsPosition,
    /// A position without the view's translation.
    PositionAsDirection,
    /// A position not divided by its w.
    NotDivided,
    /// A position divided by its w though that is 0.
    DividedAlways,
    /// model·(view·position).
    MatricesExchanged,
    /// The sum of normals, or their interpolation, not normalised.
    NotNormalised,
    /// The sum of normals over three.
    MeanNormal,
    /// Fogless: light − p not normalised.
    TowardNotNormalised,
    /// ⟨light⟩.
    TowardFromOrigin,
    /// (b − a) × (c − b), the edges in a row: the same for triangles; or with the last vertex for the first.
    FaceNotNormalised,
    // Attenuation.
    /// d² in the place of d.
    DistanceSquared,
    /// kc + kl·d + kq·d² itself.
    NotInverted,
    /// The cone's edge by smoothstep.
    SmoothCone,
    /// The exponent without the cone.
    NoCutoff,
    // Interpolation.
    /// Σ λa.
    LinearForPerspective,
    /// Σ λaw / Σ λw.
    MultipliedByW,
    /// Σ λa/w, not divided by Σ λ/w.
    NotRenormalised,
    /// Signed areas made positive.
    UnsignedWeights,
    /// Twice the weights: over the area rather than twice the area.
    WeightsTwice,
    /// Every edge belongs to the triangle.
    EveryEdge,
    /// No edge does.
    NoEdge,
    /// Both windings are front.
    FrontAlways,
    /// Clip coordinates not divided by w.
    WindowNotDivided,
    /// y the other way up.
    UpsideDown,
    /// Depth from [−1, 1] for [0, 1] or the reverse.
    DepthRange,
    /// The near plane at the eye, the far plane nowhere.
    NoFarPlane,
    /// b − (1 − t)(b − a) for a mix.
    MixFromTheEnd,
    /// (p − b) × (a − b) for (b − a) × (p − a).
    EdgeFromItsEnd,
    /// near(1 − z) + far·z for near + z(far − near).
    DepthBetween,
    /// ⌊255·c + ½⌋ for round(255·c).
    RoundedBySum,
    /// One step too many along the span.
    OneStepTooMany,
    // Colours.
    /// ⌊255·c⌋.
    TruncatedByte,
    /// ⌊256·c⌋, at most 255.
    By256,
    /// round(255·c), not clamped.
    UnclampedByte,
    /// byte/256.
    Over256,
    /// One power for the two pieces, 1/2.2 or 2.2.
    OnePower,
    /// Encoded for decoded.
    Encoded,
    /// Decoded for encoded.
    Decoded,
    /// Not converted at all.
    NotConverted,
    /// Twice: encoded after it is encoded.
    Twice,
    /// The straight piece everywhere.
    StraightPiece,
    /// texel + color.
    Added,
    /// Alpha converted as the colour is.
    AlphaToo,
    /// A sum beyond [0, 1].
    SumNotClamped,
    // Depth.
    /// Equal depths pass where they do not, and the reverse.
    OtherStrictness,
    /// Less for greater.
    ReversedCompare,
    /// Written though it is not to be, or the reverse.
    OtherWriting,
    /// Written though the test fails.
    WrittenAlways,
    /// Not clamped.
    DepthNotClamped,
    /// Read back as if it grew evenly from near to far.
    LinearDepth,
    /// near and far exchanged when it is read back.
    PlanesExchanged,
}

/// Whether the formula has that step.
#[expect(clippy::too_many_lines, reason = "one line for each kind of mistake")]
pub(super) fn concerns(spec: &Spec, body: Body) -> bool {
    let is = |ids: &[&str]| ids.contains(&spec.id.as_str());
    let interpolated_normal = ["vector/interpolated-normal", "vector/interpolated-normal-guarded"];
    let polynomial = [
        "attenuation/polynomial",
        "attenuation/polynomial-expanded",
        "attenuation/polynomial-bounded",
        "attenuation/point",
        "attenuation/point-scaled",
    ];
    let spot = ["attenuation/spot-exponent", "attenuation/spot-exponent-by-chord"];
    let perspective =
        ["interpolation/perspective", "interpolation/perspective-scaled", "interpolation/perspective-line"];
    let viewport = ["interpolation/viewport", "interpolation/viewport-opengl"];
    let encode = ["color/srgb-encode", "color/srgb-encode-component"];
    let normals = ["vector/normal-inverse-transpose", "vector/normal-by-determinant", "vector/normal-by-cofactors"];
    let normalize = ["vector/normalize", "vector/normalize-unguarded", "vector/normalize-scaled"];
    let tested = matches!(spec.kind, Kind::Depth(_));
    match body {
        Body::ReflectOnce | Body::ReflectWithPlus => {
            is(&["vector/reflect", "vector/reflect-toward", "vector/reflect-any-normal"])
        }
        Body::HalfwayAsMean => is(&["vector/halfway", "vector/halfway-unguarded", "vector/halfway-unnormalised"]),
        Body::NormalizeBySum | Body::NormalizeByLargest | Body::NormalizeBySquare => is(&normalize),
        Body::SquaredLength => is(&["vector/length", "vector/length-scaled"]),
        Body::NormalByInverse => is(&normals),
        Body::NormalByModelview => is(&normals),
        Body::NormalByBareCofactors => is(&normals),
        Body::DirectionAsPosition => is(&["vector/light-direction"]),
        Body::PositionAsDirection => is(&["vector/light-position", "vector/light-with-model"]),
        Body::NotDivided | Body::DividedAlways => is(&["vector/light-position"]),
        Body::MatricesExchanged => is(&["vector/light-with-model"]),
        Body::NotNormalised => {
            is(&["vector/average-normal"]) || is(&interpolated_normal) || is(&["vector/reflect-any-normal"])
        }
        Body::MeanNormal => is(&["vector/average-normal"]),
        Body::TowardNotNormalised | Body::TowardFromOrigin => is(&["vector/toward"]),
        Body::FaceNotNormalised => is(&["vector/face-normal", "vector/face-normal-compensated"]),
        Body::DistanceSquared | Body::NotInverted => is(&polynomial),
        Body::SmoothCone => is(&spot) || is(&["attenuation/spot-cutoff"]),
        Body::NoCutoff => is(&spot),
        Body::LinearForPerspective | Body::MultipliedByW | Body::NotRenormalised => is(&perspective),
        Body::UnsignedWeights => is(&["interpolation/weights", "interpolation/last-weight"]),
        Body::WeightsTwice => is(&["interpolation/weights", "interpolation/last-weight"]),
        Body::EveryEdge | Body::NoEdge => is(&["interpolation/coverage"]),
        Body::FrontAlways => is(&["interpolation/front-facing"]),
        Body::WindowNotDivided | Body::UpsideDown | Body::DepthRange => is(&viewport),
        Body::NoFarPlane => is(&["interpolation/clip-volume", "interpolation/clip-volume-opengl"]),
        Body::MixFromTheEnd => is(&["interpolation/mix"]),
        Body::EdgeFromItsEnd => is(&["interpolation/edge", "interpolation/weights", "interpolation/last-weight"]),
        Body::DepthBetween => is(&viewport),
        Body::RoundedBySum => is(&["color/to-unorm8"]),
        Body::OneStepTooMany => is(&["interpolation/forward-differences"]),
        Body::TruncatedByte | Body::By256 | Body::UnclampedByte => is(&["color/to-unorm8"]),
        Body::Over256 => is(&["color/from-unorm8"]),
        Body::OnePower => is(&encode) || is(&["color/srgb-encode-power", "color/srgb-decode"]),
        Body::Encoded => is(&["color/srgb-decode"]),
        Body::Decoded | Body::Twice | Body::StraightPiece => {
            is(&encode) || is(&["color/srgb-encode-power", "color/gamma-encode"])
        }
        Body::NotConverted => {
            is(&encode) || is(&["color/srgb-decode", "color/srgb-encode-power", "color/gamma-encode"])
        }
        Body::Added => is(&["color/modulate"]),
        Body::AlphaToo => is(&["color/srgb-encode", "color/srgb-decode"]),
        Body::SumNotClamped => is(&["color/sum"]),
        Body::OtherStrictness | Body::ReversedCompare => match spec.kind {
            Kind::Depth(by) => depth::other_compare(body, by.compare) != by.compare,
            _ => false,
        },
        Body::OtherWriting => {
            matches!(spec.kind, Kind::Depth(by) if by.compare != Compare::Never && by.compare != Compare::Equal)
        }
        Body::WrittenAlways => {
            matches!(spec.kind, Kind::Depth(by) if by.write && !matches!(by.compare, Compare::Always | Compare::NotEqual))
        }
        Body::DepthNotClamped => tested || is(&["interpolation/frag-depth"]),
        Body::LinearDepth | Body::PlanesExchanged => {
            is(&["depth/stored", "depth/stored-reversed", "depth/recovered", "depth/recovered-reversed"])
        }
    }
}

/// The formula with that step wrong; `None` where it has none such.
pub(super) fn evaluate<R: Real>(spec: &Spec, body: Body, numbers: &[R], out: &mut [R]) -> Option<()> {
    let x = InputRow::new(spec, numbers);
    match spec.family() {
        "vector" => put(out, 0, vector::vectors(body, &x)?),
        "attenuation" => put(out, 0, Vector([attenuation::falloff(body, &x)?])),
        "interpolation" => interpolation::interpolated(spec, body, &x, out)?,
        "color" => color::colors(spec, body, &x, out)?,
        "depth" => depth::depths(spec, body, &x, out)?,
        _ => return None,
    }
    Some(())
}
