//! Inputs close to where a formula decides or degenerates: a number near 0, near 1 or beyond its domain, two that are nearly the same,
//! vectors nearly at right angles, parallel or opposite, a light in the surface, a point on the edge of a cone.
//!
//! A shortcut that is taken near such a place (`if abs(l·n) < 1e-4`) is seldom seen by inputs drawn evenly. So each way in which the inputs
//! of a formula can come close to one is found from their shapes, domains, units and names. It is drawn at distances from ½ to 2⁻²⁴, at a
//! distance of 0, and together with another of the ways.

use super::draw::Drawing;
use super::fit::Fitted;
use super::program::Program;
use super::spec::{Domain, Input, Kind, Spec, ValueShape};
use near::Near;
use std::ops::Range;

mod near;

/// How many cases are drawn of each way: 32 at distances from ½ to 2⁻²⁴, which are eight steps of three octaves with four in each, then
/// 4 at a distance of 0 and 12 at any of these distances after another of the ways was taken.
pub const DRAWN: u64 = 48;
const IN_EACH_STEP: u64 = 4;
const OF_ONE_WAY: u64 = 32;
const OF_ONE_WAY_OR_AT_0: u64 = 36;
/// What the numbers are drawn with: the same in every run, as those of other hard cases are.
const SEED: u64 = 0xb0da;

/// A way to come close to a boundary. Places are those of numbers in a row.
#[derive(Clone, Debug)]
enum Approach {
    /// A number near 0.
    Zero(usize),
    /// A number near 1.
    One(usize),
    /// A number above 1.
    AboveOne(usize),
    /// A number below 0.
    BelowZero(usize),
    /// A number far above its domain. In half of the cases the places are scaled down to match.
    Great(usize),
    /// The second number near the first, or near its negative.
    Equal([usize; 2], f64),
    /// Three numbers that are nearly the same.
    AllEqual(Range<usize>),
    /// A whole number, near the least of its domain or near the greatest.
    End(usize, u32),
    /// A colour near black.
    Dark(Range<usize>),
    /// A colour's components above 1, or below 0.
    Beyond(Range<usize>, f64),
    /// A vector near the origin.
    Short(Range<usize>),
    /// A place of up to 256 times its distance.
    Far(Range<usize>),
    /// A place on the other side of the origin.
    Turned(Range<usize>),
    /// All lengths and places in a unit, scaled by the distance.
    Small(&'static str),
    /// All inputs but directions and matrices, scaled by the distance.
    AllSmall,
    /// A vector of up to four times its length.
    Long(Range<usize>),
    /// A vector of a length near 1.
    UnitLength(Range<usize>),
    /// The vector's component of this place near 0.
    Level(Range<usize>, usize),
    /// A place near the axis of depth.
    OnAxis(Range<usize>),
    /// An exponent near a power of two, for which a shader may multiply and not take a power.
    PowerOfTwo(usize),
    /// The second vector near a right angle to the first.
    Perpendicular([Range<usize>; 2]),
    /// The second vector nearly parallel to the first, or nearly opposite.
    Parallel([Range<usize>; 2], f64),
    /// Three vectors that nearly cancel.
    Cancel([Range<usize>; 3]),
    /// The second point close to the first.
    Close([Range<usize>; 2]),
    /// The third point close to the line through the others.
    Line([Range<usize>; 3]),
    /// A point's depth, or its distance, near a number.
    Depth(Range<usize>, usize),
    Distance(Range<usize>, usize),
    /// A matrix near 0.
    Shrunk(Range<usize>),
    /// A matrix that nearly flattens along a column.
    Flat(Range<usize>),
    /// A matrix of which some columns, or the last line, are near the identity's.
    Identity(Range<usize>),
    /// A normal near a right angle to the light, or to the viewer.
    Grazing {
        normal: &'static str,
        point: &'static str,
        light: bool,
    },
    /// A normal near the middle of the highlight.
    Mirroring {
        normal: &'static str,
        point: &'static str,
    },
    /// The light nearly behind the eye's line: nothing is left of the halfway vector.
    Against(&'static str),
    /// The edge of a cone near the direction.
    Cone,
    /// A cone that reaches all round.
    AllRound,
}

/// How many cases are drawn near the boundaries of a formula.
#[must_use]
pub fn boundary_cases(spec: &Spec) -> u64 {
    approaches(spec).len() as u64 * DRAWN
}

/// What the cases near the boundaries of a formula have in common, worked out once for all of them.
#[derive(Debug)]
pub struct Boundaries<'a> {
    spec: &'a Spec,
    drawing: Drawing<'a>,
    ways: Vec<Approach>,
}

impl<'a> Boundaries<'a> {
    /// Of a formula.
    #[must_use]
    pub fn new(spec: &'a Spec) -> Self {
        Self { spec, drawing: Drawing::new(spec, SEED), ways: approaches(spec) }
    }

    /// The inputs of the `k`-th case, appended to a row.
    pub fn inputs(&self, k: u64, row: &mut Vec<f32>) {
        let start = row.len();
        self.drawing.inputs(k, row);
        if let Some(approach) = usize::try_from(k / DRAWN).ok().and_then(|way| self.ways.get(way)) {
            bring(self.spec, &self.ways, approach, k, &mut row[start..]);
        }
    }
}

/// Brings the inputs of the `k`-th case close to a boundary, or to another one besides.
fn bring(spec: &Spec, all: &[Approach], approach: &Approach, k: u64, row: &mut [f32]) {
    let mut near = Near { fitted: Fitted::new(spec, row), distance: 1.0, side: 1.0 };
    let drawn = k % DRAWN;
    if drawn < OF_ONE_WAY {
        near.go_to(Some(drawn / IN_EACH_STEP));
    } else if drawn < OF_ONE_WAY_OR_AT_0 {
        near.go_to(None);
    } else {
        let others = all.len() as u64 - 1;
        if others > 0 {
            near.go_anywhere();
            let another = (k / DRAWN + 1 + near.fitted.below(others)) % (others + 1);
            usize::try_from(another).ok().and_then(|way| all.get(way)).inspect(|approach| near.take(approach));
        }
        near.go_anywhere();
    }
    near.take(approach);
    if let Some(within) = spec.within {
        within(row);
    }
}

/// What the `k`-th of them comes close to, in words.
#[must_use]
pub fn boundary_name(spec: &Spec, k: u64) -> Option<String> {
    let all = approaches(spec);
    usize::try_from(k / DRAWN).ok().and_then(|way| all.get(way)).map(|approach| approach.told(spec))
}

/// What all of them come close to, in their order: [`DRAWN`] cases each.
#[must_use]
pub fn boundary_names(spec: &Spec) -> Vec<String> {
    approaches(spec).iter().map(|approach| approach.told(spec)).collect()
}

impl Approach {
    /// Whether it moves vectors or places so that one of them, or the difference of two, may come to a length of 0.
    const fn is_of_vectors(&self) -> bool {
        matches!(
            self,
            Self::Short(_)
                | Self::Small(_)
                | Self::AllSmall
                | Self::Cancel(_)
                | Self::Parallel(..)
                | Self::Close(_)
                | Self::Depth(..)
                | Self::Distance(..)
                | Self::Against(_)
        )
    }

    fn told(&self, spec: &Spec) -> String {
        let number = |place: &usize| spec.input_name(*place);
        let whole = |places: &Range<usize>| {
            let is_there = |input: &&Input| spec.place(input.name).as_ref() == Some(places);
            spec.inputs.iter().find(is_there).map_or("", |input| input.name)
        };
        match self {
            Self::Zero(place) => format!("{} near 0", number(place)),
            Self::One(place) => format!("{} near 1", number(place)),
            Self::AboveOne(place) => format!("{} above 1", number(place)),
            Self::BelowZero(place) => format!("{} below 0", number(place)),
            Self::Great(place) => format!("a great {}", number(place)),
            Self::Equal([a, b], sign) => {
                format!("{} near {}{}", number(b), if *sign < 0.0 { "−" } else { "" }, number(a))
            }
            Self::AllEqual(places) => format!("the components of {} nearly equal", whole(places)),
            Self::Far(places) => format!("{} far away", whole(places)),
            Self::Turned(places) => format!("{} on the other side of the origin", whole(places)),
            Self::Small(unit) => format!("all lengths and places in {unit}s small"),
            Self::End(place, end) => format!("{} near {end}", number(place)),
            Self::AllSmall => "all numbers and places small".into(),
            Self::Dark(places) => format!("{} nearly black", whole(places)),
            Self::Beyond(places, side) => {
                format!("{} {}", whole(places), if *side < 0.0 { "below 0" } else { "above 1" })
            }
            Self::Short(places) => format!("a short {}", whole(places)),
            Self::Long(places) => format!("a long {}", whole(places)),
            Self::UnitLength(places) => format!("{} of a length near 1", whole(places)),
            Self::OnAxis(places) => format!("{} near the z axis", whole(places)),
            Self::PowerOfTwo(place) => format!("{} near a power of two", number(place)),
            Self::Identity(places) => format!("a part of {} near the identity's", whole(places)),
            Self::Level(_, place) => format!("{} near 0", number(place)),
            Self::Perpendicular([a, b]) => format!("{} and {} nearly at right angles", whole(a), whole(b)),
            Self::Parallel([a, b], sign) => {
                format!("{} and {} nearly {}", whole(a), whole(b), if *sign < 0.0 { "opposite" } else { "parallel" })
            }
            Self::Cancel([a, b, c]) => format!("{}, {} and {} nearly cancel", whole(a), whole(b), whole(c)),
            Self::Close([a, b]) => format!("{} close to {}", whole(b), whole(a)),
            Self::Line([a, b, p]) => format!("{} close to the line from {} to {}", whole(p), whole(a), whole(b)),
            Self::Depth(place, x) => format!("{}.z near −{}", whole(place), number(x)),
            Self::Distance(place, x) => format!("the length of {} near {}", whole(place), number(x)),
            Self::Shrunk(places) => format!("a small {}", whole(places)),
            Self::Flat(places) => format!("a nearly flat {}", whole(places)),
            Self::Grazing { normal, light: true, .. } => format!("{normal} nearly at right angles to the light"),
            Self::Grazing { normal, .. } => format!("{normal} nearly at right angles to the viewer"),
            Self::Mirroring { normal, .. } => format!("{normal} near the middle of the highlight"),
            Self::Against(_) => "the light nearly opposite to the viewer".into(),
            Self::Cone => "near the edge of the cone".into(),
            Self::AllRound => "a cone that reaches all round".into(),
        }
    }
}

impl Input {
    const fn is_vec3(&self) -> bool {
        matches!(self.shape, ValueShape::Vec3)
    }

    /// Whether it is a direction, of length 1 or of any.
    const fn is_direction(&self) -> bool {
        matches!(self.domain, Domain::Direction | Domain::Vector(..))
    }

    /// Whether it is a place in space or on the screen.
    fn is_place(&self) -> bool {
        let has_unit = matches!(self.unit, "unit" | "pixel");
        has_unit && matches!(self.shape, ValueShape::Vec2 | ValueShape::Vec3) && !matches!(self.domain, Domain::Pixel)
    }

    /// Whether it is made of numbers that each stand for themselves.
    fn is_numbers(&self) -> bool {
        let is_drawn =
            matches!(self.domain, Domain::Uniform(..) | Domain::LogUniform(..) | Domain::Unit | Domain::Weights);
        is_drawn && !self.is_color() && !self.is_place()
    }

    /// Whether it is still a valid input when it is scaled down.
    fn is_scalable(&self) -> bool {
        self.is_numbers() || self.is_color() || self.is_place() || matches!(self.domain, Domain::Vector(..))
    }

    /// Whether a number may be given outside of its domain at the end: below 0 and above 1.
    fn is_share(&self) -> bool {
        matches!(self.domain, Domain::Unit | Domain::Weights) || self.unit == "color"
    }
}

/// The ways in which a formula's inputs come close to a boundary.
fn approaches(spec: &Spec) -> Vec<Approach> {
    // The corners of a blend state stand among its random cases, and a rasteriser has none but its edges, which random cases look for.
    if matches!(spec.kind, Kind::Raster(_) | Kind::Blend(Program::Draw(..) | Program::Special(_) | Program::Layers(_)))
    {
        return vec![];
    }
    let mut all = vec![];
    for input in spec.inputs {
        let place = spec.place(input.name).unwrap_or_default();
        alone(input, place, &mut all);
    }
    among_vectors(spec, &mut all);
    among_places(spec, &mut all);
    among_numbers(spec, &mut all);
    let has_places = |unit: &&&str| spec.inputs.iter().any(|input| input.is_place() && input.unit == **unit);
    all.extend(["unit", "pixel"].iter().filter(has_places).map(|unit| Approach::Small(unit)));
    if spec.inputs.iter().filter(|input| input.is_scalable()).count() > 1 {
        all.push(Approach::AllSmall);
    }
    of_light(spec, &mut all);
    all
}

/// Those of an input of numbers that each stand for themselves.
fn of_numbers(input: &Input, place: &Range<usize>, all: &mut Vec<Approach>) {
    for number in place.clone() {
        all.push(Approach::Zero(number));
        if input.is_share() {
            all.extend([Approach::AboveOne(number), Approach::BelowZero(number)]);
        }
        match input.domain {
            Domain::LogUniform(..) => {
                all.push(Approach::Great(number));
                if matches!(input.name, "shininess" | "exponent") {
                    all.push(Approach::PowerOfTwo(number));
                }
            }
            Domain::Uniform(low, high) if low >= 0.0 && high > 1.0 => {
                all.extend([Approach::Great(number), Approach::One(number)]);
                if input.unit == "unit" {
                    all.push(Approach::BelowZero(number));
                }
            }
            Domain::Uniform(low, high) if !input.is_share() && (low > 1.0 || high < 1.0) => {}
            _ => all.push(Approach::One(number)),
        }
    }
    if place.len() == 3 {
        all.push(Approach::AllEqual(place.clone()));
    }
    for a in place.clone() {
        for b in a + 1..place.end {
            all.push(Approach::Equal([a, b], 1.0));
            if input.shape == ValueShape::Vec4 {
                all.push(Approach::Equal([b, a], -1.0));
            }
        }
    }
}

/// Those of one input.
fn alone(input: &Input, place: Range<usize>, all: &mut Vec<Approach>) {
    if input.is_numbers() {
        of_numbers(input, &place, all);
    } else if input.is_color() {
        if input.shape == ValueShape::Vec4 {
            let alpha = place.end - 1;
            all.extend([Approach::Zero(alpha), Approach::One(alpha)]);
            all.extend([Approach::AboveOne(alpha), Approach::BelowZero(alpha)]);
        }
        all.extend([1.0, -1.0].map(|side| Approach::Beyond(place.clone(), side)));
        all.push(Approach::Dark(place));
    } else if input.is_direction() {
        all.extend(place.clone().map(|number| Approach::Level(place.clone(), number)));
        // A direction is a unit vector: whoever normalises it does nothing wrong.
        if input.domain != Domain::Direction {
            all.extend([Approach::Short(place.clone()), Approach::Long(place.clone()), Approach::UnitLength(place)]);
        }
    } else if input.is_place() {
        if matches!(input.domain, Domain::Uniform(0.0, _)) {
            all.push(Approach::Turned(place.clone()));
        }
        if input.is_vec3() {
            all.extend(place.clone().map(|number| Approach::Level(place.clone(), number)));
            all.push(Approach::OnAxis(place.clone()));
        }
        all.extend([Approach::Short(place.clone()), Approach::Far(place)]);
    } else if input.shape == ValueShape::Mat3 {
        all.extend([Approach::Shrunk(place.clone()), Approach::Flat(place.clone()), Approach::Identity(place)]);
    } else if input.shape == ValueShape::Mat4 {
        all.push(Approach::Identity(place));
    } else if let Domain::Whole(low, high) = input.domain {
        all.extend(place.flat_map(|number| [low, high].map(|end| Approach::End(number, end))));
    }
}

/// Those of pairs and triples of vectors.
fn among_vectors(spec: &Spec, all: &mut Vec<Approach>) {
    let vectors: Vec<Range<usize>> = spec
        .inputs
        .iter()
        .filter(|input| input.is_vec3() && input.is_direction())
        .filter_map(|input| spec.place(input.name))
        .collect();
    for (k, a) in vectors.iter().enumerate() {
        for b in &vectors[k + 1..] {
            let pair = [a.clone(), b.clone()];
            all.push(Approach::Perpendicular(pair.clone()));
            all.extend([1.0, -1.0].map(|side| Approach::Parallel(pair.clone(), side)));
        }
    }
    if let [a, b, c] = &vectors[..] {
        all.push(Approach::Cancel([a.clone(), b.clone(), c.clone()]));
    }
}

/// Those of points: two close to each other, one close to the line through two.
fn among_places(spec: &Spec, all: &mut Vec<Approach>) {
    let places: Vec<Range<usize>> =
        spec.inputs.iter().filter(|input| input.is_place()).filter_map(|input| spec.place(input.name)).collect();
    for (k, a) in places.iter().enumerate() {
        for (m, b) in places.iter().enumerate().skip(k + 1) {
            if a.len() != b.len() {
                continue;
            }
            all.push(Approach::Close([a.clone(), b.clone()]));
            if a.len() == 2 {
                all.extend((0..2).map(|axis| Approach::Equal([a.start + axis, b.start + axis], 1.0)));
            }
            if let Some(c) = places[m + 1..].last().filter(|c| c.len() == a.len()) {
                all.push(Approach::Line([a.clone(), b.clone(), c.clone()]));
            }
        }
    }
}

/// Those of two numbers of one unit, and of a place and a number.
fn among_numbers(spec: &Spec, all: &mut Vec<Approach>) {
    let scalars: Vec<(&Input, usize)> = spec
        .inputs
        .iter()
        .filter(|input| input.shape == ValueShape::Scalar && input.is_numbers())
        .filter_map(|input| Some((input, spec.place(input.name)?.start)))
        .collect();
    for (k, (a, first)) in scalars.iter().enumerate() {
        for (b, second) in &scalars[k + 1..] {
            if a.unit == b.unit && !matches!(a.unit, "color" | "1") {
                all.push(Approach::Equal([*first, *second], 1.0));
            }
        }
    }
    for input in spec.inputs.iter().filter(|input| input.is_place() && input.is_vec3()) {
        let Some(place) = spec.place(input.name) else { continue };
        for (_, number) in scalars.iter().filter(|(scalar, _)| scalar.unit == input.unit) {
            all.extend([Approach::Depth(place.clone(), *number), Approach::Distance(place.clone(), *number)]);
        }
    }
}

/// Those of a surface under a light.
fn of_light(spec: &Spec, all: &mut Vec<Approach>) {
    let has = |name: &str| spec.place(name).is_some();
    let is_lit = has("position") || has("direction");
    for [normal, point] in [["normal", "p"], ["na", "pa"], ["nb", "pb"]] {
        if is_lit && has(normal) {
            all.extend([true, false].map(|light| Approach::Grazing { normal, point, light }));
            all.push(Approach::Mirroring { normal, point });
        }
    }
    if is_lit && (has("p") || has("a")) {
        all.push(Approach::Against(if has("p") { "p" } else { "a" }));
    }
    if has("cutoff_cosine") {
        all.extend([Approach::Cone, Approach::AllRound]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::select::{Member, catalogue};

    fn row(spec: &Spec, k: u64) -> Vec<f32> {
        let mut row = vec![];
        Boundaries::new(spec).inputs(k, &mut row);
        row
    }

    #[test]
    fn every_formula_has_boundaries_and_each_of_them_moves_its_inputs() {
        for member in &catalogue() {
            let spec = &member.spec;
            let names = boundary_names(spec);
            if spec.kind != Kind::Arithmetic && names.is_empty() {
                continue;
            }
            let is_whole = |input: &Input| matches!(input.domain, Domain::Whole(..) | Domain::Transform(..));
            assert!(!names.is_empty() || spec.inputs.iter().all(is_whole), "{}", spec.id);
            assert_eq!(boundary_cases(spec), names.len() as u64 * DRAWN);
            for (name, way) in names.iter().zip(0..) {
                let first = way * DRAWN;
                let is_moved = |k: &u64| {
                    let mut drawn = vec![];
                    Drawing::new(spec, SEED).inputs(*k, &mut drawn);
                    let moved = row(spec, *k);
                    assert!(moved.iter().all(|x| x.is_finite()), "{} {k}: {moved:?}", spec.id);
                    drawn != moved
                };
                let moved = (first..first + DRAWN).filter(is_moved).count();
                assert!(moved >= 36, "{}: {name} moves {moved} of {DRAWN}", spec.id);
            }
        }
    }

    #[test]
    fn numbers_come_as_close_to_each_other_as_two_to_the_minus_24() {
        let catalogue = catalogue();
        let of = |id: &str| catalogue.iter().find(|member| member.spec.id == id).expect("it is there");
        let spec = &of("interpolation/perspective-line").spec;
        let place = boundary_names(spec).iter().position(|name| name == "w.y near w.x").expect("a boundary");
        let first = place as u64 * DRAWN;
        let apart_in = |cases: Range<u64>| {
            let apart = cases.map(|k| {
                let row = row(spec, first + k);
                let (x, y) = (f64::from(row[1]), f64::from(row[2]));
                if x.to_bits() == y.to_bits() { 0.0 } else { (y / x - 1.0).abs() }
            });
            apart.collect::<Vec<f64>>()
        };
        let apart = apart_in(0..OF_ONE_WAY);
        assert!(apart.iter().all(|&x| x <= 0.51), "{apart:?}");
        for octave in 0..8 {
            let high = core_math::exp2(f64::from(-3 * octave - 1)) * 1.1;
            let inside = apart.iter().filter(|&&x| x < high && x > high / 10.0).count();
            assert!(inside >= 1, "none near {high}: {apart:?}");
        }
        let on_it = apart_in(OF_ONE_WAY..OF_ONE_WAY_OR_AT_0);
        assert!(on_it.iter().all(|&x| x <= 0.0), "{on_it:?}");
        let with_another = apart_in(OF_ONE_WAY_OR_AT_0..DRAWN);
        assert!(with_another.iter().all(|&x| x <= 0.51), "{with_another:?}");
        assert!(with_another.iter().any(|&x| x <= 0.0) && with_another.iter().any(|&x| x > 0.0), "{with_another:?}");
    }

    /// The rows of a formula's way whose distance is 0.
    fn rows_at_0(id: &str, way: &str) -> (Member, Vec<Vec<f32>>) {
        let member = catalogue().into_iter().find(|member| member.spec.id == id).expect("it is there");
        let names = boundary_names(&member.spec);
        let place = names.iter().position(|name| name == way).unwrap_or_else(|| panic!("{names:?}"));
        let first = place as u64 * DRAWN;
        let rows = (OF_ONE_WAY..OF_ONE_WAY_OR_AT_0).map(|k| row(&member.spec, first + k)).collect();
        (member, rows)
    }

    fn numbers(spec: &Spec, row: &[f32], name: &str) -> Vec<f64> {
        let places = spec.place(name).expect("an input");
        row[places].iter().copied().map(f64::from).collect()
    }

    fn product(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    #[test]
    fn a_direction_lies_exactly_on_the_edge_of_a_cone() {
        let (member, rows) = rows_at_0("attenuation/spot-cutoff", "near the edge of the cone");
        for row in &rows {
            let of = |name: &str| numbers(&member.spec, row, name);
            let off = product(&of("l"), &of("axis")) + of("cutoff_cosine")[0];
            assert!(off.abs() <= 0.0, "{row:?}");
        }
        let (member, rows) = rows_at_0("lighting/spot", "near the edge of the cone");
        for row in &rows {
            let of = |name: &str| numbers(&member.spec, row, name);
            let to: Vec<f64> = of("position").iter().zip(of("p")).map(|(to, from)| to - from).collect();
            assert!(product(&to, &of("axis")).abs() <= 0.0 && of("cutoff_cosine")[0].abs() <= 0.0, "{row:?}");
        }
    }

    #[test]
    fn a_light_lies_exactly_in_the_surface() {
        let (member, rows) = rows_at_0("lighting/phong", "normal nearly at right angles to the light");
        for row in &rows {
            let of = |name: &str| numbers(&member.spec, row, name);
            assert!(product(&of("direction"), &of("normal")).abs() <= 0.0, "{row:?}");
        }
    }
}
