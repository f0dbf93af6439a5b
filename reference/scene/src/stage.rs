//! The intermediate results of a fragment, which tell where a wrong image first departs.

/// What a fragment may show in place of its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Intermediate {
    /// Its position in eye space.
    Position,
    /// Its depth in the window.
    Depth,
    /// Its unit normal; where it is lit at the vertices, theirs, interpolated.
    Normal,
    /// `CE + CA + Σ(CAᵢ + CDᵢ)`; without lighting the material's colour.
    Diffuse,
    /// `Σ CSᵢ`.
    Specular,
    /// Its colour with vertex colours, texture and lightmap.
    Surface,
    /// The same in the fog, before it is blended and stored.
    Fog,
}

impl Intermediate {
    /// All, in the order in which they come about.
    pub const ALL: [Self; 7] =
        [Self::Position, Self::Depth, Self::Normal, Self::Diffuse, Self::Specular, Self::Surface, Self::Fog];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Diffuse => "diffuse",
            Self::Specular => "specular",
            Self::Surface => "surface",
            Self::Fog => "fog",
        }
    }
}
