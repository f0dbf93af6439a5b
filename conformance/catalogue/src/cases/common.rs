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
    ("h", &[0.963, 0.0, -0.268]),
    ("axis", &[-0.6, 0.0, -0.8]),
    ("pa", &[-0.5, 0.0, 4.95]),
    ("pb", &[-0.4, 0.1, 4.95]),
    ("na", &[0.0, 0.0, 1.0]),
    ("nb", &[0.0, 0.0, 1.0]),
    ("a", &[-0.5, 0.0, 4.95]),
    ("b", &[0.5, 0.0, 4.95]),
    ("c", &[0.0, 1.0, 4.95]),
];

/// What is asked of a surface that is lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// It is lit, and seen from its front.
    Lit,
    /// Its vectors of any length, and its positions, are as short as their squares allow.
    Short,
    /// It is seen from behind.
    Behind,
}

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b, mut k) = (a.as_bytes(), b.as_bytes(), 0);
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    a.len() == b.len() && k == a.len()
}

impl Input {
    /// Where it is, of a surface that is lit.
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
    if is_asked { count } else { 0 }
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

/// The hard cases of a formula: its own, one with colours below black and above white if it takes colours, three with a shininess
/// of 0 and of ½ if it takes a shininess, and one with short vectors if it takes any of any length. `N` is how many there are in all.
#[must_use]
pub const fn and_common<const N: usize>(
    own: &[Hard],
    has_colors: bool,
    [beyond, none, half, behind, short]: [Values; 5],
) -> [Hard; N] {
    let mut all = [Hard::new("beyond-black-and-white", "colours below 0 and above 1 count as they are", beyond); N];
    let mut k = 0;
    while k < own.len() {
        all[k] = own[k];
        k += 1;
    }
    k += has_colors as usize;
    if !none.is_empty() {
        all[k] = Hard::new("shininess-of-0", "1 wherever the cosine is above 0", none);
        all[k + 1] = Hard::new("shininess-of-half", "the square root of the cosine", half);
        all[k + 2] =
            Hard::new("seen-from-behind", "no highlight where its cosine is below 0, however low the exponent", behind);
        k += 3;
    }
    if k < N {
        all[k] = Hard::new("short-vectors", "a vector has its direction, however short it is", short);
    }
    all
}
