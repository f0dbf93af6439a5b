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

    /// Takes the way to the boundary.
    pub(super) fn take(&mut self, approach: &Approach) {
        match approach {
            Approach::Zero(place) => self.zero(*place),
            Approach::One(place) => self.set(*place, 1.0 + self.side * self.distance),
            Approach::AboveOne(place) => self.set(*place, 1.0 + 2.0 * self.distance),
            Approach::BelowZero(place) => self.set(*place, -2.0 * self.distance),
            Approach::Great(place) => self.great(*place),
            Approach::Equal([from, to], sign) => {
                self.others_small([*from, *to]);
                let x = self.get(*from) * sign * (1.0 + self.side * self.distance);
                self.set(*to, x);
            }
            Approach::Small(unit) => self.small(unit, self.distance),
            Approach::Grazing { .. } | Approach::Mirroring { .. } | Approach::Against(_) => self.light(approach),
            Approach::Cone => self.cone(),
            Approach::AllRound => self.fitted.put_scalar("cutoff_cosine", -1.0),
            _ => self.of_vectors(approach),
        }
    }

    fn of_vectors(&mut self, approach: &Approach) {
        match approach {
            Approach::Dark(places) | Approach::Short(places) | Approach::Shrunk(places) => {
                self.scale(places.clone(), self.distance);
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
            Approach::Level(places, place) => {
                let length = self.vector(places).length();
                self.set(*place, self.side * self.distance * length);
                let turned = self.vector(places).normalize().scale(length);
                self.put(places, turned);
            }
            Approach::Close([a, b]) => {
                let off = self.fitted.jitter().scale(self.distance);
                let at = self.vector(a);
                self.put(b, at + off);
                if self.fitted.row[a.clone()] == self.fitted.row[b.clone()] {
                    self.fitted.row[b.start] = self.fitted.row[b.start].next_up();
                }
            }
            Approach::Line([a, b, p]) => self.line([a, b, p]),
            Approach::Depth(place, number) => {
                let x = -self.get(*number) * (1.0 + self.side * self.distance);
                self.set(place.end - 1, x);
            }
            Approach::Distance(place, number) => {
                let length = self.get(*number) * (1.0 + self.side * self.distance);
                let to = self.vector(place).normalize().scale(length);
                self.put(place, to);
            }
            Approach::Flat(places) => {
                // The column that the determinant's sign is of.
                let column = places.start + 3 * usize::from(self.side > 0.0);
                self.scale(column..column + 3, self.distance);
            }
            _ => self.among_vectors(approach),
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

    /// All that is in a unit.
    fn small(&mut self, unit: &str, by: f64) {
        let spec = self.fitted.spec;
        for input in spec.inputs.iter().filter(|input| input.unit == unit) {
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

    /// Up to 64 times the greatest of a domain.
    fn great(&mut self, place: usize) {
        if let Domain::LogUniform(_, high) | Domain::Uniform(_, high) = self.domain_of(place) {
            let x = f64::from(high) * core_math::exp2(self.fitted.uniform(0.0, 6.0));
            self.set(place, x);
        }
    }

    /// A point between two others, and off their line by a part of a unit.
    fn line(&mut self, [a, b, p]: [&Range<usize>; 3]) {
        // Half of them among points of which none is far from another.
        if self.fitted.below(2) == 0 {
            self.small("pixel", 1.0 / 64.0);
        }
        let t = self.fitted.uniform(0.0, 1.0);
        let (from, to) = (self.vector(a), self.vector(b));
        let mut off = self.fitted.jitter().scale(self.distance);
        if p.len() == 2 {
            off.0[2] = 0.0;
        }
        self.put(p, from + (to - from).scale(t) + off);
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

    /// A cone whose edge is near the direction, by its cosine.
    fn cone(&mut self) {
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
}
