//! The moves that bring a row of inputs close to a boundary.

use super::super::draw::narrow;
use super::super::fit::Fitted;
use super::super::spec::{Domain, Input};
use super::Approach;
use lightmeter_reference::vector::halfway;
use lightmeter_reference::{Vec3, Vector};
use std::ops::Range;

/// A row on its way to a boundary.
pub(super) struct Near<'a> {
    pub(super) fitted: Fitted<'a>,
    /// How far from it the row comes to lie.
    pub(super) distance: f64,
    /// On which side of it: 1 or −1.
    pub(super) side: f64,
}

impl Near<'_> {
    /// To a distance of one of the eight steps from 2⁻¹ to 2⁻²⁴, within which it is drawn, or to 0; on either side.
    pub(super) fn go_to(&mut self, step: Option<u64>) {
        self.distance = step.map_or(0.0, |step| {
            let octaves = 3.0 * f64::from(u32::try_from(step).unwrap_or_default());
            core_math::exp2(-octaves - self.fitted.uniform(1.0, 4.0))
        });
        self.side = if self.fitted.below(2) == 0 { 1.0 } else { -1.0 };
    }

    /// To any of these distances, in half of the cases 0.
    pub(super) fn go_anywhere(&mut self) {
        let step = self.fitted.below(16);
        self.go_to((step < 8).then_some(step));
    }

    fn get(&self, place: usize) -> f64 {
        self.fitted.row[place].into()
    }

    fn set(&mut self, place: usize, x: f64) {
        self.fitted.row[place] = narrow(x);
    }

    fn scale(&mut self, places: Range<usize>, by: f64) {
        for place in places {
            let x = self.get(place);
            self.set(place, x * by);
        }
    }

    fn vector(&self, places: &Range<usize>) -> Vec3<f64> {
        Vector(std::array::from_fn(|k| if k < places.len() { self.get(places.start + k) } else { 0.0 }))
    }

    fn put(&mut self, places: &Range<usize>, v: Vec3<f64>) {
        places.clone().zip(v.0).for_each(|(place, x)| self.set(place, x));
    }

    fn domain_of(&self, place: usize) -> Domain {
        let spec = self.fitted.spec;
        let is_there = |input: &&Input| spec.place(input.name).is_some_and(|places| places.contains(&place));
        spec.inputs.iter().find(is_there).map_or(Domain::Unit, |input| input.domain)
    }

    /// Moves the inputs to the boundary. Shading languages leave open what `normalize` gives for a vector of length 0, and shaders for lighting do
    /// not guard against it. So formulas such as `vector/normalize` are asked for it, and those of lighting come no closer to it than 2⁻²⁴.
    pub(super) fn take(&mut self, approach: &Approach) {
        let asked = self.distance;
        if approach.is_of_vectors() && self.fitted.spec.family() == "lighting" {
            self.distance = asked.max(core_math::exp2(-24.0));
        }
        self.go(approach);
        self.distance = asked;
    }

    fn go(&mut self, approach: &Approach) {
        match approach {
            Approach::Zero(place) => self.zero(*place),
            Approach::One(place) => self.set(*place, 1.0 + self.side * self.distance),
            Approach::AboveOne(place) => self.set(*place, 1.0 + 2.0 * self.distance),
            Approach::BelowZero(place) => self.set(*place, 0.0 - 2.0 * self.distance),
            Approach::End(place, end) => self.end(*place, f64::from(*end)),
            Approach::Great(place) => self.great(*place),
            Approach::Equal([from, to], sign) => {
                self.others_small([*from, *to]);
                let x = self.get(*from) * sign * (1.0 + self.side * self.distance);
                self.set(*to, x);
            }
            Approach::Small(unit) => self.small(|input| input.unit == *unit, self.distance),
            Approach::AllSmall => self.small(Input::is_scalable, self.distance),
            Approach::Grazing { .. } | Approach::Mirroring { .. } | Approach::Against(_) => self.light(approach),
            Approach::Cone => self.cone(),
            Approach::PowerOfTwo(place) => {
                let power = core_math::exp2(f64::from(u8::try_from(self.fitted.below(9)).unwrap_or_default()));
                self.set(*place, power * (1.0 + self.side * self.distance));
            }
            Approach::AllRound => self.fitted.put_scalar("cutoff_cosine", -1.0),
            _ => self.of_vectors(approach),
        }
    }

    fn of_vectors(&mut self, approach: &Approach) {
        match approach {
            Approach::Dark(places) | Approach::Short(places) | Approach::Shrunk(places) => {
                self.scale(places.clone(), self.distance);
            }
            Approach::Beyond(places, side) => {
                for place in places.clone().take(3) {
                    let off = 2.0 * self.distance * self.get(place);
                    self.set(place, if *side < 0.0 { 0.0 - off } else { 1.0 + off });
                }
            }
            Approach::AllEqual(places) => {
                let first = self.get(places.start);
                for place in places.clone().skip(1) {
                    let off = self.fitted.uniform(-1.0, 1.0) * self.distance;
                    self.set(place, first * (1.0 + off));
                }
            }
            Approach::Far(places) => {
                let by = core_math::exp2(self.fitted.uniform(0.0, 8.0));
                self.scale(places.clone(), by);
            }
            Approach::Turned(places) => self.scale(places.clone(), -1.0),
            Approach::Long(places) => {
                let by = 1.0 + self.fitted.uniform(0.0, 3.0);
                self.scale(places.clone(), by);
            }
            Approach::UnitLength(places) => {
                let length = 1.0 + self.side * self.distance;
                let to = self.vector(places).normalize().scale(length);
                self.put(places, to);
            }
            Approach::OnAxis(places) => self.scale(places.start..places.end - 1, self.distance),
            Approach::Identity(places) => self.identity(places),
            Approach::Level(places, place) => {
                let length = self.vector(places).length();
                self.set(*place, self.side * self.distance * length);
                let turned = self.vector(places).normalize().scale(length);
                self.put(places, turned);
            }
            Approach::Flat(places) => {
                // The column that the determinant's sign is of.
                let column = places.start + 3 * usize::from(self.side > 0.0);
                self.scale(column..column + 3, self.distance);
            }
            _ => self.of_places(approach),
        }
    }

    fn of_places(&mut self, approach: &Approach) {
        match approach {
            Approach::Close([a, b]) => {
                let off = self.fitted.jitter().scale(self.distance);
                let at = self.vector(a);
                self.put(b, at + off);
                if self.distance > 0.0 && self.fitted.row[a.clone()] == self.fitted.row[b.clone()] {
                    self.fitted.row[b.start] = self.fitted.row[b.start].next_up();
                }
            }
            Approach::Depth(place, number) => {
                let x = -self.get(*number) * (1.0 + self.side * self.distance);
                self.set(place.end - 1, x);
            }
            // Along an axis no rounding parts the length from the number.
            Approach::Distance(place, number) if self.distance <= 0.0 => {
                let length = self.get(*number);
                self.put(place, Vector([0.0, 0.0, -length]));
            }
            Approach::Distance(place, number) => {
                let length = self.get(*number) * (1.0 + self.side * self.distance);
                let to = self.vector(place).normalize().scale(length);
                self.put(place, to);
            }
            _ if self.distance > 0.0 => self.among_vectors(approach),
            _ => self.among_vectors_exactly(approach),
        }
    }

    /// Exactly at right angles, parallel, opposite, cancelling or on a line, in whatever order it is computed.
    fn among_vectors_exactly(&mut self, approach: &Approach) {
        match approach {
            Approach::Perpendicular([a, b]) => {
                let axis = usize::try_from(self.fitted.below(3)).unwrap_or_default();
                let [mut along, mut across] = [Vector::splat(0.0); 2];
                let (from, to) = (self.vector(a), self.vector(b));
                along.0[axis] = self.side * from.length();
                across.0[(axis + 1) % 3] = to.length();
                self.put(a, along);
                self.put(b, across);
            }
            Approach::Parallel([a, b], sign) => {
                let at = self.vector(a);
                self.put(b, at.scale(*sign));
            }
            Approach::Cancel([a, b, c]) => {
                let (from, to) = (coarse(self.vector(a)), coarse(self.vector(b)));
                self.put(a, from);
                self.put(b, to);
                self.put(c, -(from + to));
            }
            Approach::Line([a, b, p]) => {
                let quarters = f64::from(u8::try_from(self.fitted.below(5)).unwrap_or_default());
                let (from, to) = (coarse(self.vector(a)), coarse(self.vector(b)));
                self.put(a, from);
                self.put(b, to);
                self.put(p, from + (to - from).scale(0.25 * quarters));
            }
            _ => {}
        }
    }

    fn among_vectors(&mut self, approach: &Approach) {
        match approach {
            Approach::Perpendicular([a, b]) => {
                let (a, to) = (self.vector(a).normalize(), self.vector(b));
                let across = (to - a.scale(to.dot(a))).normalize() + a.scale(self.side * self.distance);
                self.put(b, across.normalize().scale(to.length()));
            }
            Approach::Parallel([a, b], sign) => {
                let along = self.vector(a).normalize().scale(*sign) + self.fitted.jitter().scale(self.distance);
                let length = self.vector(b).length();
                self.put(b, along.normalize().scale(length));
            }
            Approach::Cancel([a, b, c]) => {
                let left = self.fitted.jitter().scale(self.distance);
                let sum = self.vector(a) + self.vector(b);
                self.put(c, left - sum);
            }
            Approach::Line([a, b, p]) => self.line([a, b, p]),
            _ => {}
        }
    }

    /// In half of the cases the other numbers of the same input small, so that they decide nothing.
    fn others_small(&mut self, two: [usize; 2]) {
        let spec = self.fitted.spec;
        let mut places = spec.inputs.iter().filter_map(|input| spec.place(input.name));
        let Some(places) = places.find(|places| two.iter().all(|place| places.contains(place))) else {
            return;
        };
        if places.len() == 4 && self.fitted.below(2) == 0 {
            for place in places.filter(|place| !two.contains(place)) {
                self.scale(place..place + 1, 0.125);
            }
        }
    }

    fn small(&mut self, is_made_small: impl Fn(&Input) -> bool, by: f64) {
        let spec = self.fitted.spec;
        for input in spec.inputs.iter().filter(|input| is_made_small(input)) {
            if let Some(places) = spec.place(input.name) {
                self.scale(places, by);
            }
        }
    }

    /// Near 0: of either sign where the domain has both, and below the least of a domain in the logarithm.
    fn zero(&mut self, place: usize) {
        let x = match self.domain_of(place) {
            Domain::LogUniform(low, _) => f64::from(low) * self.distance,
            Domain::Uniform(low, high) if low < 0.0 => self.side * f64::from(high) * self.distance,
            Domain::Uniform(_, high) => f64::from(high) * self.distance,
            _ => self.distance,
        };
        self.set(place, x);
    }

    /// A whole number at an end of its domain, or up to three inside of it.
    fn end(&mut self, place: usize, end: f64) {
        let Domain::Whole(low, high) = self.domain_of(place) else { return };
        let inward = f64::from(u8::try_from(self.fitted.below(4)).unwrap_or_default());
        let inward = if self.distance > 0.0 { inward } else { 0.0 };
        let x = if end > f64::from(low) { end - inward } else { end + inward };
        self.set(place, x.clamp(low.into(), high.into()));
    }

    /// Up to 64 times the greatest of a domain.
    fn great(&mut self, place: usize) {
        if let Domain::LogUniform(_, high) | Domain::Uniform(_, high) = self.domain_of(place) {
            let by = core_math::exp2(self.fitted.uniform(0.0, 6.0));
            // Fog of a great density is nothing but fog, unless its distance is small.
            if self.fitted.below(2) == 0 {
                self.small(|input| input.is_place() && input.unit == "unit", 1.0 / (by * f64::from(high)));
            }
            self.set(place, f64::from(high) * by);
        }
    }

    /// A point between two others, and off their line by a part of a unit.
    fn line(&mut self, [a, b, p]: [&Range<usize>; 3]) {
        // Half of them among points of which none is far from another.
        if self.fitted.below(2) == 0 {
            self.small(|input| input.unit == "pixel", 1.0 / 64.0);
        }
        let t = self.fitted.uniform(0.0, 1.0);
        let (from, to) = (self.vector(a), self.vector(b));
        let mut off = self.fitted.jitter().scale(self.distance);
        if p.len() == 2 {
            off.0[2] = 0.0;
        }
        self.put(p, from + (to - from).scale(t) + off);
    }

    /// Some columns near the identity's, or of a 4 × 4 matrix the last line: the others stay as they are.
    fn identity(&mut self, places: &Range<usize>) {
        let (side, ways) = if places.len() == 16 { (4, 3) } else { (3, 2) };
        let column = usize::try_from(self.fitted.below(side)).unwrap_or_default();
        // All but one column, that one alone, or the last line.
        let way = self.fitted.below(ways);
        let side = usize::try_from(side).unwrap_or_default();
        for (k, place) in places.clone().enumerate() {
            let is_changed = match way {
                0 => k / side != column,
                1 => k / side == column,
                _ => k % side == side - 1,
            };
            if is_changed {
                let off = self.fitted.uniform(-1.0, 1.0) * self.distance;
                self.set(place, if k / side == k % side { 1.0 } else { 0.0 } + off);
            }
        }
    }

    fn light(&mut self, approach: &Approach) {
        let point = match approach {
            Approach::Grazing { point, .. } | Approach::Mirroring { point, .. } | Approach::Against(point) => point,
            _ => return,
        };
        let at = self.fitted.vector(point).unwrap_or_else(|| Vector::splat(0.0));
        let Some([l, v]) = self.fitted.toward(at) else { return };
        let off = self.side * self.distance;
        match approach {
            Approach::Grazing { normal, light, .. } if self.distance <= 0.0 => {
                self.at_right_angles(normal, point, *light)
            }
            Approach::Grazing { normal, light, .. } => {
                let to = if *light { l } else { v };
                let Some(n) = self.fitted.vector(normal) else { return };
                let across = (n - to.scale(n.dot(to))).normalize();
                self.fitted.turn(normal, across + to.scale(off));
            }
            Approach::Mirroring { normal, .. } => {
                let jitter = self.fitted.jitter().scale(self.distance);
                self.fitted.turn(normal, halfway(v, l) + jitter);
            }
            _ => {
                let jitter = self.fitted.jitter().scale(self.distance);
                let away = (jitter - v).normalize();
                self.fitted.put("direction", -away);
                let far = self.fitted.uniform(0.5, 5.0);
                self.fitted.put("position", at + away.scale(far));
            }
        }
    }

    /// A light or a viewer exactly in the surface, whatever rounds: where it is, and the normal, lie along two coordinates' axes.
    fn at_right_angles(&mut self, normal: &str, point: &str, light: bool) {
        let far = self.fitted.uniform(0.5, 5.0);
        let k = if light { self.fitted.below(3) } else { 2 };
        if light {
            let at = self.fitted.vector(point).unwrap_or_else(|| Vector::splat(0.0));
            self.fitted.put("direction", along(k, self.side));
            self.fitted.put("position", at + along(k, self.side * far));
        } else {
            self.fitted.put(point, along(k, -far));
        }
        let turned = if self.fitted.below(2) == 0 { 1.0 } else { -1.0 };
        self.fitted.turn(normal, along((k + 1) % 3, turned));
    }

    /// A cone whose edge is near the direction, by its cosine, or exactly there.
    fn cone(&mut self) {
        if self.distance <= 0.0 {
            self.on_the_cone();
            return;
        }
        let toward = match (self.fitted.vector("l"), self.fitted.vector("position"), self.fitted.vector("p")) {
            (Some(l), ..) => -l,
            (None, Some(position), Some(p)) => (p - position).normalize(),
            _ => return,
        };
        if let Some(axis) = self.fitted.vector("axis") {
            let axis = if self.fitted.has("l") { axis } else { axis.normalize() };
            let cosine = toward.dot(axis) + self.side * self.distance;
            self.fitted.put_scalar("cutoff_cosine", cosine.clamp(-1.0, 1.0));
        }
    }

    /// A direction on the edge of its cone, whatever rounds: the axis is one of the coordinates', so that its product with a direction is a
    /// number of that direction. Where a direction is normalised, it is at right angles to the axis, and the cone is half of all directions.
    fn on_the_cone(&mut self) {
        let k = self.fitted.below(3);
        if let Some(l) = self.fitted.vector("l") {
            let number = -l.dot(along(k, 1.0));
            self.fitted.put("axis", along(k, if number < 0.0 { -1.0 } else { 1.0 }));
            self.fitted.put_scalar("cutoff_cosine", number.abs());
        } else if let Some(p) = self.fitted.vector("p") {
            self.fitted.put("axis", along(k, self.side));
            self.fitted.put_scalar("cutoff_cosine", 0.0);
            let far = self.fitted.uniform(0.5, 5.0);
            self.fitted.put("position", p + along((k + 1) % 3, far));
        }
    }
}

/// A vector along the axis of one coordinate.
fn along(coordinate: u64, length: f64) -> Vec3<f64> {
    Vector(std::array::from_fn(|k| if k as u64 == coordinate { length } else { 0.0 }))
}

/// A vector of few digits, whose sums are exact.
fn coarse(v: Vec3<f64>) -> Vec3<f64> {
    Vector(v.0.map(|x| (x * 256.0).trunc() / 256.0))
}
