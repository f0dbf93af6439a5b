//! How each step of lighting is done, and which of them a mistake changes.

/// A step of the model that goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Twist {
    NormalNotNormalised,
    /// Alpha is the diffuse material's.
    AlphaOfTheMaterial,
    LightNotNormalised,
    LightReversed,
    PositionAsDirection,
    DirectionAsPosition,
    ViewNotNormalised,
    ViewReversed,
    ViewerAtInfinity,
    ReflectWithPlus,
    ReflectOfToward,
    BlinnForPhong,
    PhongForBlinn,
    HalfNotNormalised,
    HalfNormalised,
    IncidenceUnclamped,
    IncidenceOfBothSides,
    HalfLambert,
    NoIncidence,
    LobeOfBothSides,
    SchlickPower,
    Gated,
    NotGated,
    SpecularTimesIncidence,
    NormalisedLobeWithFresnel,
    EnergyConservingLobe,
    OverPi,
    NoAmbient,
    AmbientTwice,
    NoDiffuse,
    NoSpecular,
    AmbientAttenuated,
    AmbientNotAttenuated,
    DiffuseNotAttenuated,
    SpecularNotAttenuated,
    DistanceSquaredTwice,
    AttenuationNotInverted,
    AttenuationAtMostOne,
    NotAttenuated,
    NoCone,
    NoCutoff,
    SmoothCone,
    SpecularNotInCone,
    GouraudForPhong,
    PhongForGouraud,
    VectorsAtTheVertices,
    LitAtTheLastVertex,
    LitAtTheMiddle,
    OneLightAlone,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// The way light travels.
    Travel,
    /// A vector to the light.
    Toward,
    /// A place.
    Position,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Edge {
    Gouraud,
    Phong,
    Interpolated,
    /// Between unit vectors.
    UnitVectors,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrangement {
    /// LD * MD * max(l·n, 0) alone.
    Diffuse(Source, &'static str),
    /// A power of the cosine between two inputs, the exponent of a name.
    Power([&'static str; 2], &'static str),
    /// A surface under a light.
    Surface(Source),
    /// Document 004's pair.
    TwoLights,
    /// Between two vertices.
    Edge(Edge),
    /// A face.
    Face,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cosine {
    Phong,
    Blinn,
    BlinnUnnormalised,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mirror {
    Right,
    WithPlus,
    OfToward,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    Local,
    NotNormalised,
    Reversed,
    Infinity,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Incidence {
    Max,
    Unclamped,
    Abs,
    HalfLambert,
    One,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lobe {
    Max,
    Abs,
    Schlick,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Strength {
    Plain,
    TimesIncidence,
    NormalisedWithFresnel,
    EnergyConserving,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Attenuation {
    Right,
    DistanceSquared,
    NotInverted,
    /// Limited to 1.
    AtMostOne,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cone {
    None,
    Right,
    Ignored,
    NoCutoff,
    Smooth,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LitAt {
    First,
    Last,
    Middle,
}

/// How each step is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Model {
    pub(super) arrangement: Arrangement,
    pub(super) normal_normalised: bool,
    pub(super) light_normalised: bool,
    pub(super) light_reversed: bool,
    pub(super) position_as_direction: bool,
    pub(super) direction_as_position: bool,
    pub(super) view: View,
    pub(super) cosine: Cosine,
    pub(super) mirror: Mirror,
    pub(super) incidence: Incidence,
    pub(super) lobe: Lobe,
    /// Powers by the chord between the vectors.
    pub(super) by_chord: bool,
    pub(super) gated: bool,
    pub(super) strength: Strength,
    pub(super) over_pi: bool,
    /// Alpha is not summed up.
    pub(super) alpha_of_material: bool,
    pub(super) ambient: u8,
    pub(super) diffuse: bool,
    pub(super) specular: bool,
    pub(super) attenuation: Attenuation,
    /// Of ambient, diffuse and specular.
    pub(super) attenuated: [bool; 3],
    pub(super) cone: Cone,
    pub(super) specular_in_cone: bool,
    pub(super) lit_at: LitAt,
    pub(super) both_lights: bool,
}

/// The model of a formula, right throughout; `None` where there is none.
pub(super) fn right(id: &str) -> Option<Model> {
    let is = |ids: &[&str]| ids.iter().any(|name| id.strip_prefix("lighting/") == Some(name));
    let attenuated = is(&["point-phong", "point-blinn", "point-opengl", "spot"]);
    Some(Model {
        arrangement: arrangement(id)?,
        normal_normalised: true,
        light_normalised: !is(&["phong-unit-light", "phong-nonlocal"]),
        light_reversed: false,
        position_as_direction: false,
        direction_as_position: false,
        view: if is(&["phong-nonlocal"]) { View::Infinity } else { View::Local },
        cosine: cosine(id),
        mirror: Mirror::Right,
        incidence: Incidence::Max,
        lobe: Lobe::Max,
        by_chord: is(&["cosine-power-by-chord", "blinn-stable"]),
        gated: is(&["phong-gated", "point-opengl", "blinn-stable"]),
        strength: Strength::Plain,
        over_pi: false,
        alpha_of_material: false,
        ambient: 1,
        diffuse: true,
        specular: true,
        attenuation: if attenuated { Attenuation::Right } else { Attenuation::None },
        attenuated: [is(&["point-opengl"]), attenuated, attenuated],
        cone: if is(&["spot"]) { Cone::Right } else { Cone::None },
        specular_in_cone: true,
        lit_at: LitAt::First,
        both_lights: true,
    })
}

/// What a formula computes, and of what.
fn arrangement(id: &str) -> Option<Arrangement> {
    use Arrangement::{Diffuse, Face, Power, Surface, TwoLights};
    Some(match id {
        "lighting/diffuse-toward" => Diffuse(Source::Toward, "l"),
        "lighting/diffuse-travel" => Diffuse(Source::Travel, "i"),
        "lighting/specular-phong" => Power(["r", "v"], "shininess"),
        "lighting/specular-blinn" => Power(["n", "h"], "shininess"),
        "lighting/cosine-power" | "lighting/cosine-power-unguarded" | "lighting/cosine-power-by-chord" => {
            Power(["a", "b"], "exponent")
        }
        "lighting/phong"
        | "lighting/blinn"
        | "lighting/phong-gated"
        | "lighting/blinn-unnormalised"
        | "lighting/phong-unit-light"
        | "lighting/phong-nonlocal"
        | "lighting/blinn-stable" => Surface(Source::Travel),
        "lighting/point-phong"
        | "lighting/point-blinn"
        | "lighting/point-opengl"
        | "lighting/spot"
        | "lighting/scalar-material" => Surface(Source::Position),
        "lighting/two-lights" => TwoLights,
        "lighting/gouraud" => Arrangement::Edge(Edge::Gouraud),
        "lighting/phong-shading" => Arrangement::Edge(Edge::Phong),
        "lighting/phong-interpolated" => Arrangement::Edge(Edge::Interpolated),
        "lighting/flat" => Face,
        _ => return None,
    })
}

/// The vectors that a formula's highlight is the cosine between.
fn cosine(id: &str) -> Cosine {
    match id {
        "lighting/blinn"
        | "lighting/point-blinn"
        | "lighting/point-opengl"
        | "lighting/blinn-stable"
        | "lighting/two-lights" => Cosine::Blinn,
        "lighting/blinn-unnormalised" => Cosine::BlinnUnnormalised,
        _ => Cosine::Phong,
    }
}

impl Model {
    /// Whether it computes n, l and v by itself and lights a point with them.
    const fn is_lit(&self) -> bool {
        !matches!(self.arrangement, Arrangement::Diffuse(..) | Arrangement::Power(..))
    }

    const fn has_incidence(&self) -> bool {
        !matches!(self.arrangement, Arrangement::Power(..))
    }

    const fn has_lobe(&self) -> bool {
        !matches!(self.arrangement, Arrangement::Diffuse(..))
    }

    const fn has_ambient(&self) -> bool {
        matches!(self.arrangement, Arrangement::Surface(_) | Arrangement::TwoLights)
    }

    const fn has_position(&self) -> bool {
        self.is_lit() && !matches!(self.arrangement, Arrangement::Surface(Source::Travel | Source::Toward))
    }

    /// Makes the mistake; `false` where the model has no such step, or does it so by right.
    #[expect(clippy::too_many_lines, reason = "one line for each kind of mistake")]
    pub(super) fn twist(&mut self, twist: Twist) -> bool {
        let before = *self;
        let lit = self.is_lit();
        let attenuated = self.attenuated[1];
        match twist {
            Twist::NormalNotNormalised if lit && !matches!(self.arrangement, Arrangement::Face) => {
                self.normal_normalised = false;
            }
            Twist::LightNotNormalised if lit => self.light_normalised = false,
            Twist::LightReversed if lit => self.light_reversed = true,
            Twist::PositionAsDirection if self.has_position() => self.position_as_direction = true,
            Twist::DirectionAsPosition
                if matches!(self.arrangement, Arrangement::Surface(Source::Travel))
                    && !matches!(self.view, View::Infinity) =>
            {
                self.direction_as_position = true;
            }
            Twist::ViewNotNormalised if lit && self.view == View::Local => self.view = View::NotNormalised,
            Twist::ViewReversed if lit && self.view == View::Local => self.view = View::Reversed,
            Twist::ViewerAtInfinity if lit => self.view = View::Infinity,
            Twist::ReflectWithPlus if lit && self.cosine == Cosine::Phong => self.mirror = Mirror::WithPlus,
            Twist::ReflectOfToward if lit && self.cosine == Cosine::Phong => self.mirror = Mirror::OfToward,
            Twist::BlinnForPhong if lit && self.cosine == Cosine::Phong => self.cosine = Cosine::Blinn,
            Twist::PhongForBlinn if lit && self.cosine != Cosine::Phong => self.cosine = Cosine::Phong,
            Twist::HalfNotNormalised if lit && self.cosine == Cosine::Blinn => self.cosine = Cosine::BlinnUnnormalised,
            Twist::HalfNormalised if lit && self.cosine == Cosine::BlinnUnnormalised => self.cosine = Cosine::Blinn,
            Twist::IncidenceUnclamped if self.has_incidence() => self.incidence = Incidence::Unclamped,
            Twist::IncidenceOfBothSides if self.has_incidence() => self.incidence = Incidence::Abs,
            Twist::HalfLambert if self.has_incidence() => self.incidence = Incidence::HalfLambert,
            Twist::NoIncidence if self.has_incidence() => self.incidence = Incidence::One,
            Twist::LobeOfBothSides if self.has_lobe() => self.lobe = Lobe::Abs,
            Twist::SchlickPower if self.has_lobe() => self.lobe = Lobe::Schlick,
            Twist::Gated if lit => self.gated = true,
            Twist::NotGated if lit => self.gated = false,
            Twist::SpecularTimesIncidence if lit => self.strength = Strength::TimesIncidence,
            Twist::NormalisedLobeWithFresnel if lit => self.strength = Strength::NormalisedWithFresnel,
            Twist::EnergyConservingLobe if self.has_lobe() => self.strength = Strength::EnergyConserving,
            Twist::OverPi if self.has_incidence() => self.over_pi = true,
            Twist::NoAmbient if self.has_ambient() => self.ambient = 0,
            Twist::AmbientTwice if self.has_ambient() => self.ambient = 2,
            Twist::NoDiffuse if lit => self.diffuse = false,
            Twist::NoSpecular if lit => self.specular = false,
            Twist::AmbientAttenuated if attenuated => self.attenuated[0] = true,
            Twist::AmbientNotAttenuated if attenuated => self.attenuated[0] = false,
            Twist::DiffuseNotAttenuated if attenuated => self.attenuated[1] = false,
            Twist::SpecularNotAttenuated if attenuated => self.attenuated[2] = false,
            Twist::DistanceSquaredTwice if attenuated => self.attenuation = Attenuation::DistanceSquared,
            Twist::AttenuationNotInverted if attenuated => self.attenuation = Attenuation::NotInverted,
            Twist::AttenuationAtMostOne if attenuated => self.attenuation = Attenuation::AtMostOne,
            Twist::NotAttenuated if attenuated => self.attenuation = Attenuation::None,
            Twist::NoCone if self.cone == Cone::Right => self.cone = Cone::Ignored,
            Twist::NoCutoff if self.cone == Cone::Right => self.cone = Cone::NoCutoff,
            Twist::SmoothCone if self.cone == Cone::Right => self.cone = Cone::Smooth,
            Twist::SpecularNotInCone if self.cone == Cone::Right => self.specular_in_cone = false,
            Twist::GouraudForPhong => self.edge(&[Edge::Phong, Edge::Interpolated], Edge::Gouraud),
            Twist::PhongForGouraud => self.edge(&[Edge::Gouraud], Edge::Phong),
            Twist::VectorsAtTheVertices => self.edge(&[Edge::Phong, Edge::Interpolated], Edge::UnitVectors),
            Twist::LitAtTheLastVertex if matches!(self.arrangement, Arrangement::Face) => self.lit_at = LitAt::Last,
            Twist::LitAtTheMiddle if matches!(self.arrangement, Arrangement::Face) => self.lit_at = LitAt::Middle,
            Twist::AlphaOfTheMaterial if matches!(self.arrangement, Arrangement::TwoLights) => {
                self.alpha_of_material = true
            }
            Twist::OneLightAlone if matches!(self.arrangement, Arrangement::TwoLights) => self.both_lights = false,
            _ => {}
        }
        *self != before
    }

    fn edge(&mut self, from: &[Edge], to: Edge) {
        if let Arrangement::Edge(edge) = &mut self.arrangement
            && from.contains(edge)
        {
            *edge = to;
        }
    }
}
