//! The other formulas that a step may be computed by.

/// Another formula for a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Form {
    /// i + 2(i·n)n.
    ReflectWithPlus,
    /// i − (i·n)n.
    ReflectOnce,
    /// n·h for r·v.
    Blinn,
    /// n·⟨v − l⟩ for n·h.
    BlinnByDifference,
    /// r·v for n·h.
    Phong,
    /// (r·v)^exponent.
    PhongPower,
    /// The normal turned to the eye, n·v ≥ 0.
    NormalToTheEye,
    /// The normal turned to the light, n·l ≥ 0.
    NormalToTheLight,
    /// |cosine|^exponent.
    LobeOfBothSides,
    /// Schlick's approximation of the power.
    SchlickPower,
    /// cosine·exponent.
    ProductForPower,
    /// max(cosine, 10⁻⁴)^exponent, or any other floor.
    PowerOfAtLeast(u8),
    /// min(cosine, 1)^exponent.
    PowerOfAtMostOne,
    /// 0 of an exponent of 0.
    NoneWithoutExponent,
    /// cosine^exponent, of a cosine below 0 too, where it has no value.
    PowerUnguarded,
    /// The power times (exponent + 8)/8π.
    EnergyConserving,
    /// The power times (exponent + 2)/2π.
    NormalisedPhong,
    /// 0 where the cosine is at most 0.
    Gated,
    /// 0 where the cosine is below 0: not where it is 0.
    GatedBelow,
    /// 0 where the cosine is above 0.
    GateTurned,
    /// Times max(cosine, 0).
    TimesIncidence,
    /// Blinn's normalised lobe with Schlick's Fresnel term, times n·l; over π or not.
    Fresnel { over_pi: bool },
    /// (½·cosine + ½)², or without the square.
    HalfLambert { squared: bool },
    /// kc + kl·d + kq·d².
    NotInverted,
    /// 1/kc + kl·d + kq·d².
    ConstantInverted,
    /// 1/(kc + kl·d + kq·d).
    QuadraticOfDistance,
    /// 1/(kc + d·kl + (d·kq)²).
    QuadraticOfProduct,
    /// The cone's edge by smoothstep from the cutoff to the axis, times the power.
    SmoothCone,
    /// The same without the power.
    SmoothConeAlone,
    /// The cone's edge by a straight line from the cutoff to the axis.
    LinearCone,
    /// The power of the cosine rescaled from the cutoff to the axis.
    RescaledCone,
    /// The cone without its edge.
    ConeWithoutEdge,
    /// The spotlight shines where its cone is not.
    ConeTurned,
    /// A ramp where dmin < dmax, a step elsewhere.
    FogNotTurned,
    /// A ramp where dmin and dmax differ, a step that is still 1 at dmax where they do not.
    FogStepBeyond,
    /// |z|.
    Planar,
    /// |p|.
    Radial,
    /// z, which is negative before the eye.
    SignedDepth,
    /// −z, which is negative behind the eye.
    NegatedDepth,
    /// exp(−density·distance).
    FogExp,
    /// exp(−density·distance²).
    FogExp2Document,
    /// exp(−(density·distance)²).
    FogExp2OpenGl,
    /// 1/(1 + density·distance).
    FogRational,
    /// 1/(1 − x + x²/2) for e^x.
    ExpByQuadratic,
    /// The full surface colour plus the fog's colour times 1 − f: the surface's colour is not multiplied by f.
    FogAdded,
    /// The surface's colour as far as the fog leaves it.
    FogToBlack,
    /// shaded − (1 − f)(shaded − fog).
    FogFromTheSurface,
    /// 1 − (distance − dmin)/(dmax − dmin).
    FogFromDmin,
    /// |v|².
    SquaredLength,
    /// The inverse, not transposed.
    NormalByInverse,
    /// The modelview as such.
    NormalByModelview,
    /// The cofactor matrix, not divided by the determinant: where the determinant is negative, the normal points the wrong way.
    NormalByCofactors,
    /// The cofactor matrix over the determinant without its sign: where the determinant is negative, the normal points the wrong way.
    NormalByUnsigned,
    /// A direction moved by the view's translation.
    DirectionAsPosition,
    /// A position that is not moved by a matrix's translation.
    PositionAsDirection,
    /// Divided by w though that is 0.
    DividedAlways,
    /// Divided by w where it is above 0.
    DividedIfPositive,
    /// Not divided by w.
    NotDivided,
    /// b − (1 − t)(b − a), or src − (1 − As)(src − dst).
    MixFromTheEnd,
    /// src·As + (dst − dst·As).
    OverFromTheProduct,
    /// u + (w − u)·t, with the share t of the edge or of the span.
    AlongByShare,
    /// (p − b) × (a − b) for (b − a) × (p − a).
    EdgeFromItsEnd,
    /// (a − p) × (b − p) for (b − a) × (p − a).
    EdgeFromThePoint,
    /// Each weight is its area over the sum of the three.
    WeightsBySum,
    /// The last weight is 1 without the others.
    WeightsByDifference,
    /// a × b + b × c + c × a.
    NormalByVertices,
    /// Depth from [−1, 1] for [0, 1] or the reverse.
    DepthRange,
    /// y the other way up.
    UpsideDown,
    /// ⌊255·c⌋.
    TruncatedByte,
    /// ⌊256·c⌋, at most 255.
    ByteBy256,
    /// round(255·c), not clamped.
    UnclampedByte,
    /// ⌊255·c + ½⌋.
    ByteBySum,
    /// How far z is between near and far.
    LinearDepth,
    /// far/(far − near)·(1 − near/z), or near/(far − near)·(far/z − 1).
    DepthByProjection,
    /// (1/n − 1/z) / (1/n − 1/f).
    DepthByReciprocals,
    /// far/(far − near) − far·near/((far − near)z), or near·far/((far − near)z) − near/(far − near).
    DepthByDifference,
    /// Depth read back as if it grew evenly.
    LinearDepthRead,
    /// c + α(a − c) + β(b − c): the last weight is what the other two leave of 1.
    LastWeightAsTheRest,
    /// a + qb/(qa + qb)·(b − a) along a line.
    FromTheFirst,
    /// What lies in the near plane is outside.
    NearPlaneOutside,
    /// What lies in the far plane is outside.
    FarPlaneOutside,
    /// sRGB encoding that switches from the linear piece to the curved piece at the threshold of decoding, 0.04045.
    EncodeThreshold,
    /// The same, decoded.
    DecodeThreshold,
    /// sRGB decoding that switches at 0.03928.
    DecodeOldThreshold,
    /// c^0.41666 for c^(1/2.4) in the curved piece.
    EncodeShortExponent,
    /// c^(1/2.2) for the curved piece.
    EncodeCurve,
    /// c^(1/2.4) − 0.055.
    EncodeWithoutScale,
    /// Rec. 709's pieces for sRGB's.
    EncodeRec709,
    /// The same, decoded.
    DecodeRec709,
    /// The middle of three vertices.
    Middle,
}

impl Form {
    /// The operands that this form needs, as alternative sets of names: a step must have every operand of at least one set.
    #[expect(clippy::too_many_lines, reason = "a line for each form")]
    pub(super) const fn needs(self) -> &'static [&'static [&'static str]] {
        match self {
            Self::ReflectWithPlus | Self::ReflectOnce => &[&["i", "n"], &["l", "n"]],
            Self::Blinn | Self::BlinnByDifference | Self::Phong => &[&["n", "l", "v"]],
            Self::PhongPower => &[&["n", "l", "v", "exponent"]],
            Self::NormalToTheEye | Self::NormalToTheLight => &[&["n", "l", "v"]],
            Self::ExpByQuadratic => &[&["exponent"]],
            Self::LobeOfBothSides
            | Self::SchlickPower
            | Self::ProductForPower
            | Self::PowerOfAtLeast(_)
            | Self::PowerOfAtMostOne
            | Self::NoneWithoutExponent
            | Self::PowerUnguarded
            | Self::EnergyConserving
            | Self::NormalisedPhong => &[&["cosine", "exponent"], &["a", "b", "exponent"]],
            Self::Gated | Self::GatedBelow | Self::GateTurned | Self::TimesIncidence | Self::HalfLambert { .. } => {
                &[&["cosine"]]
            }
            Self::Fresnel { .. } => {
                &[&["light", "material", "n", "l", "v", "shininess"], &["ks", "n", "l", "v", "shininess"]]
            }
            Self::NotInverted | Self::ConstantInverted | Self::QuadraticOfDistance | Self::QuadraticOfProduct => {
                &[&["kc", "kl", "kq", "d"]]
            }
            Self::SmoothCone
            | Self::SmoothConeAlone
            | Self::LinearCone
            | Self::RescaledCone
            | Self::ConeWithoutEdge
            | Self::ConeTurned => &[&["cosine", "cutoff_cosine"]],
            Self::Planar | Self::Radial | Self::SignedDepth | Self::NegatedDepth => &[&["p"]],
            Self::FogExp | Self::FogExp2Document | Self::FogExp2OpenGl | Self::FogRational => {
                &[&["distance", "density"]]
            }
            Self::FogAdded | Self::FogToBlack | Self::FogFromTheSurface => &[&["fog", "shaded", "f"]],
            Self::FogFromDmin | Self::FogNotTurned | Self::FogStepBeyond => &[&["distance", "dmin", "dmax"]],
            Self::SquaredLength => &[&["v"]],
            Self::NormalByInverse | Self::NormalByModelview | Self::NormalByCofactors | Self::NormalByUnsigned => {
                &[&["modelview", "n"]]
            }
            Self::DirectionAsPosition => &[&["view", "direction"]],
            Self::PositionAsDirection => &[&["view", "model", "position"]],
            Self::DividedAlways | Self::DividedIfPositive | Self::NotDivided => &[&["eye"], &["clip"]],
            Self::MixFromTheEnd => &[&["a", "b", "t"], &["src", "dst"]],
            Self::OverFromTheProduct => &[&["src", "dst"]],
            Self::AlongByShare => &[&["near", "far", "top", "bottom", "y"], &["ia", "ib", "xa", "xb", "x"]],
            Self::EdgeFromItsEnd | Self::EdgeFromThePoint => &[&["a", "b", "p"], &["a", "b", "c"]],
            Self::WeightsBySum | Self::WeightsByDifference => &[&["a", "b", "c", "p"]],
            Self::DepthRange | Self::UpsideDown => &[&["ndc", "origin", "size", "depth"]],
            Self::TruncatedByte | Self::ByteBy256 | Self::UnclampedByte | Self::ByteBySum => &[&["c"]],
            Self::LinearDepth | Self::DepthByProjection | Self::DepthByReciprocals | Self::DepthByDifference => {
                &[&["near", "far", "z"]]
            }
            Self::LinearDepthRead => &[&["near", "far", "depth"]],
            Self::EncodeThreshold
            | Self::EncodeRec709
            | Self::EncodeWithoutScale
            | Self::EncodeCurve
            | Self::EncodeShortExponent => &[&["c"]],
            Self::DecodeRec709 | Self::DecodeThreshold | Self::DecodeOldThreshold => &[&["e"]],
            Self::LastWeightAsTheRest => &[&["weights", "a", "b", "c"]],
            Self::FromTheFirst => &[&["t", "w", "attr"]],
            Self::NearPlaneOutside => &[&["z", "near"]],
            Self::FarPlaneOutside => &[&["z", "w"]],
            Self::Middle | Self::NormalByVertices => &[&["a", "b", "c"]],
        }
    }
}
