//! What is handed from the vertices to the fragments of a draw, and where each attribute stands in a row of numbers.

use lightmeter_scene::frame::Draw;
use lightmeter_scene::shading::Frequency;

/// Where each attribute begins; `None` for those that the draw has no use for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Position in eye space, 3 numbers.
    pub p: Option<usize>,
    /// The unit normal, 3 numbers.
    pub n: Option<usize>,
    /// The colour lit at the vertex, 3 numbers, then its part without highlights and the highlights, 3 each.
    pub lit: Option<usize>,
    /// Texture coordinates, 2 numbers.
    pub uv: Option<usize>,
    /// Texture coordinates of the lightmap, 2 numbers.
    pub lightmap_uv: Option<usize>,
    /// The vertex's colour, 4 numbers.
    pub color: Option<usize>,
    /// Numbers in all.
    pub count: usize,
    /// Those that are the provoking vertex's and not interpolated.
    pub flat: std::ops::Range<usize>,
}

/// Numbers of a lit vertex.
pub(super) const LIT: usize = 9;
/// Numbers of a draw that has every attribute.
pub(super) const MOST: usize = 3 + 3 + LIT + 2 + 2 + 4;

impl Attributes {
    /// What a draw hands on: `with_position` where fog or an intermediate result asks for it, `with_normal` likewise.
    #[must_use]
    pub fn of(draw: &Draw, with_position: bool, with_normal: bool) -> Self {
        let mut attributes = Self::default();
        let frequency = draw.shading.map(|shading| shading.frequency);
        let at_fragments = frequency == Some(Frequency::Phong);
        attributes.p = attributes.place(at_fragments || with_position, 3);
        attributes.n = attributes.place(at_fragments || (with_normal && frequency.is_some()), 3);
        attributes.lit = attributes.place(frequency.is_some() && !at_fragments, LIT);
        attributes.uv = attributes.place(draw.texture.is_some(), 2);
        attributes.lightmap_uv = attributes.place(draw.lightmap.is_some(), 2);
        attributes.color = attributes.place(draw.vertex_colors, 4);
        if let Some(start) = attributes.lit.filter(|_| frequency == Some(Frequency::Flat)) {
            attributes.flat = start..start + LIT;
        }
        attributes
    }

    fn place(&mut self, wanted: bool, numbers: usize) -> Option<usize> {
        let start = self.count;
        self.count += if wanted { numbers } else { 0 };
        wanted.then_some(start)
    }

    /// Whether the number at this place is the provoking vertex's.
    #[must_use]
    pub fn is_flat_at(&self, number: usize) -> bool {
        self.flat.contains(&number)
    }
}
