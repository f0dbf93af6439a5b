//! The hard cases that formulas have in common, by the names and units of their inputs.

use super::spec::{Domain, Hard, Input, ValueShape, Values};

/// Colours below black and above white in each component, alone and where three are mixed.
const BEYOND: [&[f32]; 3] = [&[-0.5, 1.5, 2.0, 0.75], &[1.5, 2.0, -0.75, 1.25], &[2.5, -0.25, 1.25, 0.75]];

/// A surface that is lit, by the names of what places it. What has none of these names is in the middle of its domain.
const LIT: [(&str, &[f32]); 20] = [
    ("p", &[0.25, -0.5, -4.0]),
    ("position", &[1.0, 1.5, -1.0]),
    ("light", &[1.0, 1.5, -1.0]),
    ("normal", &[0.36, 0.48, 0.8]),
    ("n", &[0.36, 0.48, 0.8]),
    ("l", &[0.48, -0.36, 0.8]),
    ("toward", &[0.48, -0.36, 0.8]),
    ("i", &[-0.48, 0.36, -0.8]),
    ("direction", &[-0.48, 0.36, -0.8]),
    ("v", &[0.0, 0.6, 0.8]),
    ("r", &[0.0, 0.6, 0.8]),
    ("h", &[0.0, 0.6, 0.8]),
    ("axis", &[-0.2, -0.5, -0.8]),
    ("pa", &[-0.5, -0.5, -4.0]),
    ("pb", &[0.5, 0.25, -4.25]),
    ("na", &[0.36, 0.48, 0.8]),
    ("nb", &[0.0, 0.6, 0.8]),
    ("a", &[-0.5, -0.5, -4.0]),
    ("b", &[0.75, -0.5, -4.25]),
    ("c", &[0.0, 0.75, -4.0]),
];

/// The same at 2·10⁻¹⁸: the squares of lengths are just normal numbers. What is normalised is the same there.
const SHORT: [(&str, &[f32]); 10] = [
    ("p", &[0.5e-18, -1.0e-18, -8e-18]),
    ("position", &[2e-18, 3e-18, -2e-18]),
    ("light", &[2e-18, 3e-18, -2e-18]),
    ("normal", &[0.72e-18, 0.96e-18, 1.6e-18]),
    ("n", &[0.72e-18, 0.96e-18, 1.6e-18]),
    ("toward", &[0.96e-18, -0.72e-18, 1.6e-18]),
    ("direction", &[-0.96e-18, 0.72e-18, -1.6e-18]),
    ("axis", &[-0.6e-18, -1.0e-18, -1.6e-18]),
    ("na", &[0.72e-18, 0.96e-18, 1.6e-18]),
    ("nb", &[0.5e-18, 1.2e-18, 1.6e-18]),
];

/// A surface that faces the light and is seen from behind: the mirrored ray and the halfway vector point away from the eye and the normal.
const BEHIND: [(&str, &[f32]); 20] = [
    ("p", &[-0.5, 0.0, 4.95]),
    ("position", &[1.3, 0.0, 7.35]),
    ("light", &[1.3, 0.0, 7.35]),
    ("normal", &[0.0, 0.0, 1.0]),
    ("n", &[0.0, 0.0, 1.0]),
    ("l", &[0.6, 0.0, 0.8]),
    ("toward", &[0.6, 0.0, 0.8]),
    ("i", &[-0.6, 0.0, -0.8]),
    ("direction", &[-0.6, 0.0, -0.8]),
    ("v", &[0.1, 0.0, -0.994_987]),
    ("r", &[-0.6, 0.0, 0.8]),
    ("h", &[0.963_389, 0.0, -0.268_108]),
    ("axis", &[-0.6, 0.0, -0.8]),
    ("pa", &[-0.5, 0.0, 4.95]),
    ("pb", &[-0.4, 0.1, 4.95]),
    ("na", &[0.0, 0.0, 1.0]),
    ("nb", &[0.0, 0.0, 1.0]),
    ("a", &[-0.5, 0.0, 4.95]),
    ("b", &[0.5, 0.0, 4.95]),
    ("c", &[0.0, 1.0, 4.95]),
];

/// A surface that is lit and seen from its front. Each axis lies on the lit side of its normal and of the mirrored ray, so that whatever direction
/// a shader takes in the place of a vector that is missing shows.
const FRONT: [(&str, &[f32]); 12] = [
    ("p", AT),
    ("position", &[1.42, 0.44, 0.2]),
    ("normal", &[0.36, 0.48, 0.8]),
    ("direction", &[-0.48, -0.36, -0.8]),
    ("axis", &[-0.48, -0.36, -0.8]),
    ("pa", AT),
    ("pb", &[-0.25, -0.75, -3.5]),
    ("na", &[0.36, 0.48, 0.8]),
    ("nb", &[0.48, 0.36, 0.8]),
    ("a", AT),
    ("b", &[1.0, -0.5, -3.5]),
    ("c", &[-0.25, 1.0, -3.25]),
];
/// The same surface turned round and lit from behind: it shows an axis that is taken the other way round, and a normal without direction, through
/// which the mirrored ray goes straight on to the eye.
const TURNED: [(&str, &[f32]); 12] = [
    ("p", AT),
    ("position", &[-2.42, -2.44, -6.2]),
    ("normal", &[-0.36, -0.48, -0.8]),
    ("direction", &[0.48, 0.36, 0.8]),
    ("axis", &[0.48, 0.36, 0.8]),
    ("pa", AT),
    ("pb", &[-0.25, -0.75, -3.5]),
    ("na", &[-0.36, -0.48, -0.8]),
    ("nb", &[-0.48, -0.36, -0.8]),
    ("a", AT),
    ("b", &[-0.25, 1.0, -3.25]),
    ("c", &[1.0, -0.5, -3.5]),
];
const AT: &[f32] = &[-0.5, -1.0, -3.0];
const ZERO: &[f32] = &[0.0, 0.0, 0.0];

/// What is asked of a surface that is lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// It is lit, and seen from its front.
    Lit,
    /// Its vectors of any length, and its positions, are as short as their squares allow.
    Short,
    /// It is seen from behind.
    Behind,
    /// A vector of it has length 0, and it is lit from its front or from behind.
    Lacks(Lacking, Side),
}

/// The vector of length 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lacking {
    /// The normal.
    Normal,
    /// The vector to the light.
    Light,
    /// The vector to the viewer.
    View,
}

/// Where the light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The viewer's side.
    Front,
    /// The side that the viewer does not see.
    Behind,
    /// Nearly within the surface: its highlight is dark, and would be brighter of a viewer along any axis.
    Grazing,
}

impl Surface {
    /// No normal, lit from the front.
    pub const NO_NORMAL: Self = Self::Lacks(Lacking::Normal, Side::Front);
    /// No normal, lit from behind.
    pub const NO_NORMAL_BEHIND: Self = Self::Lacks(Lacking::Normal, Side::Behind);
    /// No light, the normal towards the front.
    pub const NO_LIGHT: Self = Self::Lacks(Lacking::Light, Side::Front);
    /// No light, the normal turned away.
    pub const NO_LIGHT_BEHIND: Self = Self::Lacks(Lacking::Light, Side::Behind);
    /// No viewer, lit from the front.
    pub const NO_VIEW: Self = Self::Lacks(Lacking::View, Side::Front);
    /// No viewer, lit from behind.
    pub const NO_VIEW_BEHIND: Self = Self::Lacks(Lacking::View, Side::Behind);
    /// No viewer, lit from the side.
    pub const NO_VIEW_GRAZING: Self = Self::Lacks(Lacking::View, Side::Grazing);

    /// What an input is in whose place a vector of length 0 comes.
    const fn in_place_of(self, input: &Input) -> Option<&'static [f32]> {
        let (name, is_any_length) = (input.name, matches!(input.domain, Domain::Vector(..)));
        let Self::Lacks(vector, side) = self else { return None };
        match vector {
            Lacking::Normal
                if is_any_length && (is_same(name, "normal") || is_same(name, "na") || is_same(name, "nb")) =>
            {
                Some(ZERO)
            }
            // A face without area.
            Lacking::Normal if !is_any_length && is_same(name, "b") => Some(AT),
            Lacking::Light if is_any_length && is_same(name, "direction") => Some(ZERO),
            Lacking::Light if is_same(name, "position") || is_same(name, "pb") => Some(AT),
            Lacking::View if is_same(name, "p") || is_same(name, "pa") || is_same(name, "pb") || is_same(name, "a") => {
                Some(ZERO)
            }
            // The light as it lies from the surface elsewhere.
            Lacking::View if is_same(name, "position") => match side {
                Side::Front => Some(&[1.92, 1.44, 3.2]),
                Side::Behind => Some(&[-1.92, -1.44, -3.2]),
                Side::Grazing => Some(&[3.2, -2.4, 0.4]),
            },
            Lacking::View if matches!(side, Side::Grazing) && (is_same(name, "direction") || is_same(name, "axis")) => {
                Some(&[-0.796_030, 0.597_022, -0.099_503_7])
            }
            _ => None,
        }
    }

    /// Whether the formula normalises the vector that is missing. Where a point light lies at the surface its attenuation may be anything.
    const fn can_be_asked(self, inputs: &[Input]) -> bool {
        let (is_point_light, mut k) = (has(inputs, "kc"), 0);
        while k < inputs.len() {
            let input = &inputs[k];
            k += 1;
            let is_asked = match self {
                Self::Lacks(Lacking::Light, _) => {
                    is_same(input.name, "direction") || is_same(input.name, "position") && !is_point_light
                }
                Self::Lacks(Lacking::View, _) => !is_same(input.name, "position") && !is_same(input.name, "direction"),
                _ => true,
            };
            if is_asked && matches!(input.shape, ValueShape::Vec3) && self.in_place_of(input).is_some() {
                return true;
            }
        }
        false
    }
}

const fn has(inputs: &[Input], name: &str) -> bool {
    let mut k = 0;
    while k < inputs.len() {
        if is_same(inputs[k].name, name) {
            return true;
        }
        k += 1;
    }
    false
}

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b, mut k) = (a.as_bytes(), b.as_bytes(), 0);
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    a.len() == b.len() && k == a.len()
}

impl Input {
    /// Where it is, of a surface that is lit and seen from its front; `None` of what places no surface.
    #[must_use]
    pub const fn lit(&self) -> Option<&'static [f32]> {
        self.placed(Surface::Lit)
    }

    /// Where it is, of a surface.
    const fn placed(&self, surface: Surface) -> Option<&'static [f32]> {
        let is_vector = matches!(self.domain, Domain::Vector(..));
        let is_position = matches!(self.domain, Domain::Uniform(..));
        if !matches!(self.shape, ValueShape::Vec3) {
            return None;
        }
        match surface {
            Surface::Short if is_vector || is_position => match find(&SHORT, self.name) {
                Some(place) => Some(place),
                None => find(&LIT, self.name),
            },
            Surface::Lit | Surface::Short => find(&LIT, self.name),
            Surface::Behind => find(&BEHIND, self.name),
            Surface::Lacks(_, side) => match (surface.in_place_of(self), side) {
                (Some(missing), _) => Some(missing),
                (None, Side::Front | Side::Grazing) => find(&FRONT, self.name),
                (None, Side::Behind) => find(&TURNED, self.name),
            },
        }
    }
}

const fn find(table: &[(&str, &'static [f32])], name: &str) -> Option<&'static [f32]> {
    let mut k = 0;
    while k < table.len() {
        if is_same(table[k].0, name) {
            return Some(table[k].1);
        }
        k += 1;
    }
    None
}

/// The number of colours among inputs.
#[must_use]
pub const fn colors(inputs: &[Input]) -> usize {
    let (mut k, mut count) = (0, 0);
    while k < inputs.len() {
        count += if inputs[k].is_color() { 1 } else { 0 };
        k += 1;
    }
    count
}

/// How many inputs [`beyond`] gives.
#[must_use]
pub const fn given_beyond(inputs: &[Input]) -> usize {
    let (mut k, mut count) = (0, 0);
    while k < inputs.len() {
        count += if inputs[k].is_color() || inputs[k].placed(Surface::Lit).is_some() { 1 } else { 0 };
        k += 1;
    }
    count
}

/// Values beyond black and white for all colours among inputs, of a surface that is lit; `N` is [`given_beyond`].
#[must_use]
pub const fn beyond<const N: usize>(inputs: &[Input]) -> [(&'static str, &'static [f32]); N] {
    let mut values: [(&'static str, &'static [f32]); N] = [("", &[]); N];
    let (mut k, mut given, mut color) = (0, 0, 0);
    while k < inputs.len() {
        if inputs[k].is_color() {
            values[given] = (inputs[k].name, BEYOND[color % 3].split_at(inputs[k].shape.components()).0);
            color += 1;
            given += 1;
        } else if let Some(place) = inputs[k].placed(Surface::Lit) {
            values[given] = (inputs[k].name, place);
            given += 1;
        }
        k += 1;
    }
    values
}

/// How many inputs [`placed`] gives: none where there is no shininess and one is to be given, and none where no vector may be short.
#[must_use]
pub const fn given_placed(inputs: &[Input], surface: Surface, has_shininess: bool) -> usize {
    let (mut k, mut count, mut is_asked) = (0, has_shininess as usize, false);
    while k < inputs.len() {
        let is_placed = inputs[k].placed(surface).is_some();
        count += is_placed as usize;
        is_asked |= if has_shininess {
            is_same(inputs[k].name, "shininess")
        } else {
            is_placed && matches!(inputs[k].domain, Domain::Vector(..))
        };
        k += 1;
    }
    if is_asked && (!matches!(surface, Surface::Lacks(..)) || surface.can_be_asked(inputs)) { count } else { 0 }
}

/// A surface that is lit, with a shininess if one is given; `N` is [`given_placed`].
#[must_use]
pub const fn placed<const N: usize>(
    inputs: &[Input],
    surface: Surface,
    shininess: Option<&'static [f32]>,
) -> [(&'static str, &'static [f32]); N] {
    let mut values: [(&'static str, &'static [f32]); N] = [("", &[]); N];
    let (mut k, mut given) = (0, 0);
    if N > 0
        && let Some(shininess) = shininess
    {
        values[0] = ("shininess", shininess);
        given = 1;
    }
    while k < inputs.len() && N > 0 {
        if let Some(place) = inputs[k].placed(surface) {
            values[given] = (inputs[k].name, place);
            given += 1;
        }
        k += 1;
    }
    values
}

/// The hard cases that a formula has in common with others: values of inputs, none where there is no such case.
#[derive(Clone, Copy, Debug)]
pub struct CommonCases {
    /// Colours below black and above white.
    pub beyond: Values,
    /// A shininess of 0.
    pub no_shininess: Values,
    /// A shininess of ½.
    pub half: Values,
    /// Seen from behind.
    pub behind: Values,
    /// Short vectors.
    pub short: Values,
    /// No normal, no light and no viewer, each lit from the front and from behind.
    pub lacking: [[Values; 2]; 3],
    /// No viewer, lit from the side.
    pub grazing: Values,
}

impl CommonCases {
    const fn all(&self, has_colors: bool) -> [(bool, Hard); 12] {
        const NOT_AN_AXIS: &str = "a vector of length 0 has no direction, and no axis stands in for it";
        let [normal, light, view] = self.lacking;
        [
            (
                has_colors,
                Hard::new("beyond-black-and-white", "colours below 0 and above 1 count as they are", self.beyond),
            ),
            given(Hard::new("shininess-of-0", "1 wherever the cosine is above 0", self.no_shininess)),
            given(Hard::new("shininess-of-half", "the square root of the cosine", self.half)),
            given(Hard::new(
                "seen-from-behind",
                "no highlight where its cosine is below 0, however low the exponent",
                self.behind,
            )),
            given(Hard::new("short-vectors", "a vector has its direction, however short it is", self.short)),
            given(Hard::new("no-normal", NOT_AN_AXIS, normal[0])),
            given(Hard::new("no-normal-lit-from-behind", NOT_AN_AXIS, normal[1])),
            given(Hard::new("no-light", NOT_AN_AXIS, light[0])),
            given(Hard::new("no-light-from-behind", NOT_AN_AXIS, light[1])),
            given(Hard::new("no-view", NOT_AN_AXIS, view[0])),
            given(Hard::new("no-view-lit-from-behind", NOT_AN_AXIS, view[1])),
            given(Hard::new("no-view-lit-from-the-side", NOT_AN_AXIS, self.grazing)),
        ]
    }

    /// How many there are.
    #[must_use]
    pub const fn count(&self, has_colors: bool) -> usize {
        let (all, mut k, mut count) = (self.all(has_colors), 0, 0);
        while k < all.len() {
            count += all[k].0 as usize;
            k += 1;
        }
        count
    }
}

const fn given(hard: Hard) -> (bool, Hard) {
    (!hard.inputs.is_empty(), hard)
}

/// The hard cases of a formula: its own, and those in common with others. `N` is how many there are in all.
#[must_use]
pub const fn and_common<const N: usize>(own: &[Hard], has_colors: bool, common: &CommonCases) -> [Hard; N] {
    let mut all = [Hard::new("beyond-black-and-white", "", common.beyond); N];
    let mut count = 0;
    while count < own.len() {
        all[count] = own[count];
        count += 1;
    }
    let (common, mut k) = (common.all(has_colors), 0);
    while k < common.len() {
        if common[k].0 {
            all[count] = common[k].1;
            count += 1;
        }
        k += 1;
    }
    all
}
