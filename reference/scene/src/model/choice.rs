//! What a scene file chooses by a word, where that is resolved as the scene is loaded. What needs no resolving is the frame's own.

use crate::words::words;

words! {
    /// Where a light is.
    #[derive(Default)]
    pub enum LightKind {
        /// Infinitely far away.
        #[default]
        Directional = "directional",
        /// At a point.
        Point = "point",
        /// At a point, within a cone.
        Spot = "spot",
    }
}

words! {
    /// Where a surface is lit.
    #[derive(Default)]
    pub enum Frequency {
        /// Nowhere: it has the material's diffuse colour.
        Unlit = "unlit",
        /// Once a face, at its provoking vertex.
        Flat = "flat",
        /// At the vertices; the colour is interpolated.
        Gouraud = "gouraud",
        /// At every fragment.
        #[default]
        Phong = "phong",
    }
}

words! {
    /// The alpha of a lit colour (ruling 14).
    #[derive(Default)]
    pub enum Alpha {
        /// 1.
        One = "one",
        /// The material's opacity.
        #[default]
        Material = "material",
    }
}

words! {
    /// What the highlight of a material without `specular` is coloured by (004).
    #[derive(Default)]
    pub enum Highlight {
        /// By the light alone: MS = ks.
        #[default]
        Plastic = "plastic",
        /// By the surface too: MS = ks times its colour.
        Metal = "metal",
    }
}

words! {
    /// What a texture does to the colour.
    #[derive(Default)]
    pub enum TextureMode {
        /// Multiplies it.
        #[default]
        Modulate = "modulate",
        /// Takes its place.
        Replace = "replace",
    }
}

words! {
    /// Where a mesh has its normals from.
    #[derive(Default)]
    pub enum NormalsFrom {
        /// From its description.
        #[default]
        Given = "given",
        /// One a face; vertices are split.
        Face = "face",
        /// The unit normals of the faces around a vertex, averaged (004).
        Averaged = "averaged",
    }
}

words! {
    /// In which order objects are drawn.
    #[derive(Default)]
    pub enum Order {
        /// As they are written.
        #[default]
        Given = "given",
        /// Opaque ones as they are written, then those with a cutout, then blended ones, the farthest from the eye first
        /// (002).
        Sorted = "sorted",
    }
}
