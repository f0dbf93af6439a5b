//! The intermediate results of a fragment, which tell where a wrong image first departs.

use crate::words::words;

words! {
    /// What a fragment may show in place of its colour.
    pub enum Intermediate {
        /// Its position in eye space.
        Position = "position",
        /// Its depth in the window.
        Depth = "depth",
        /// Its unit normal; where it is lit at the vertices, theirs, interpolated.
        Normal = "normal",
        /// `CE + CA + Σ(CAᵢ + CDᵢ)`; without lighting the material's colour.
        Diffuse = "diffuse",
        /// `Σ CSᵢ`.
        Specular = "specular",
        /// Its colour with vertex colours, texture and lightmap.
        Surface = "surface",
        /// The same in the fog, before it is blended and stored.
        Fog = "fog",
    }
}
