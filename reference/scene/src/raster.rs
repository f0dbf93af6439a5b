//! Primitive topologies and the vertex that a flat attribute is taken from.

/// How a stream of vertices is read as primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Topology {
    /// Every vertex a point.
    Points,
    /// Every two vertices a line.
    LineList,
    /// Every vertex after the first a line from the one before it.
    LineStrip,
    /// Every three vertices a triangle.
    TriangleList,
    /// Every vertex after the second a triangle with the two before it.
    TriangleStrip,
}

impl Topology {
    /// All of them, in the order of their codes.
    pub const ALL: [Self; 5] = [Self::Points, Self::LineList, Self::LineStrip, Self::TriangleList, Self::TriangleStrip];

    /// The name used in case ids, JSON and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::LineList => "line-list",
            Self::LineStrip => "line-strip",
            Self::TriangleList => "triangle-list",
            Self::TriangleStrip => "triangle-strip",
        }
    }

    /// Its place in [`Topology::ALL`], which is the selector that the shaders take.
    #[must_use]
    pub const fn code(self) -> u32 {
        self as u32
    }

    /// Vertices in a primitive.
    #[must_use]
    pub const fn corners(self) -> u32 {
        match self {
            Self::Points => 1,
            Self::LineList | Self::LineStrip => 2,
            Self::TriangleList | Self::TriangleStrip => 3,
        }
    }
}

/// The vertex of a primitive whose value a flat attribute takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Provoking {
    /// The first vertex: WebGPU's and Vulkan's convention.
    First,
    /// The last vertex: OpenGL's default.
    Last,
}

impl Provoking {
    /// Both conventions.
    pub const ALL: [Self; 2] = [Self::First, Self::Last];

    /// The name used in case ids, JSON and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Last => "last",
        }
    }
}
