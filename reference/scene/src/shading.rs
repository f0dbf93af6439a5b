//! How a surface is shaded: where it is lit, which highlight it has, and which dialect of the documents is meant.

use crate::words::words;

words! {
    /// Where a surface is lit.
    pub enum Frequency {
        /// Once a face: the colour lit at the provoking vertex.
        Flat = "flat",
        /// At the vertices; the colour is interpolated.
        Gouraud = "gouraud",
        /// At every fragment, with position and normal interpolated and the normal normalised again.
        Phong = "phong",
    }
}

words! {
    /// Which cosine the highlight is a power of.
    #[derive(Default)]
    pub enum Specular {
        /// r·v.
        #[default]
        Phong = "phong",
        /// n·h.
        Blinn = "blinn",
        /// n·(v + l), the halfway vector left unnormalised: a dialect of document 000.
        BlinnUnnormalised = "blinn-unnormalised",
    }
}

words! {
    /// Whether a surface that faces away from the light can have a highlight.
    #[derive(Default)]
    pub enum SpecularGate {
        /// It can: what the documents write.
        #[default]
        Documents = "documents",
        /// It cannot: the highlight is 0 where n·l ≤ 0, as OpenGL's fixed function has it.
        OpenGl = "opengl",
    }
}

words! {
    /// Where the viewer is.
    #[derive(Default)]
    pub enum Viewer {
        /// At the eye: v = ⟨−p⟩.
        #[default]
        Local = "local",
        /// Infinitely far away: v = (0, 0, 1).
        NonLocal = "non-local",
    }
}

words! {
    /// How a normal is brought to eye space.
    #[derive(Default)]
    pub enum Normals {
        /// By the inverse transpose of the modelview.
        #[default]
        InverseTranspose = "inverse-transpose",
        /// By the modelview itself, right for rigid motion and uniform scale alone: a dialect of documents 000 and 003.
        Modelview = "modelview",
    }
}

words! {
    /// How ambient light and material go together. Ruling 8.
    #[derive(Default)]
    pub enum Ambient {
        /// CA = LA * MA.
        #[default]
        Product = "product",
        /// CA is a constant that nothing multiplies.
        Constant = "constant",
    }
}

words! {
    /// Whether attenuation and a spotlight's cone weaken a light's ambient term too. Ruling 11.
    #[derive(Default)]
    pub enum LightAmbient {
        /// They do not.
        #[default]
        Documents = "documents",
        /// They do.
        OpenGl = "opengl",
    }
}

words! {
    /// Which length the fog's factor is taken of.
    #[derive(Default)]
    pub enum Distance {
        /// |z|: the depth of the point. The document's.
        #[default]
        Planar = "planar",
        /// |p|: the distance from the eye. A dialect.
        Radial = "radial",
    }
}
