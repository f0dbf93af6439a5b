//! Makes the independently drawn inputs of lights and surfaces fit each other, so that a few cases show every branch.
//!
//! Directions drawn independently seldom meet: most spotlights miss their surface, most highlights are black, and few lights are nearer than
//! one unit. So a part of the cases is moved to where a mistake shows: a light near the surface, a normal in the middle of the highlight, a light
//! that grazes the surface, a cone whose edge passes by the surface, low exponents, bright colours. The other cases stay as they were drawn.
//!
//! What is moved, and how far, follows from the numbers of the row alone.

use super::draw::{mix, narrow};
use super::spec::{Domain, Spec};
use lightmeter_reference::vector::{face_normal, halfway, reflect};
use lightmeter_reference::{Vec3, Vector};

/// A row whose inputs are found by their names.
pub(super) struct Fitted<'a> {
    pub(super) spec: &'a Spec,
    pub(super) row: &'a mut [f32],
    bits: u64,
}

impl<'a> Fitted<'a> {
    pub(super) fn new(spec: &'a Spec, row: &'a mut [f32]) -> Self {
        let bits = row.iter().fold(0, |bits, x| mix(bits ^ u64::from(x.to_bits())));
        Self { spec, row, bits }
    }

    /// A whole number below `count`.
    pub(super) fn below(&mut self, count: u64) -> u64 {
        self.bits = mix(self.bits.wrapping_add(0x9e37_79b9_7f4a_7c15));
        (self.bits >> 32) % count
    }

    /// A number from low to high, evenly in steps of 2⁻²⁰ of their distance.
    pub(super) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let steps = u32::try_from(self.below(1 << 20)).unwrap_or_default();
        low + (high - low) * f64::from(steps) / f64::from(1 << 20)
    }

    /// A vector whose components are each at most 1.
    pub(super) fn jitter(&mut self) -> Vec3<f64> {
        Vector(std::array::from_fn(|_| self.uniform(-1.0, 1.0)))
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.spec.place(name).is_some()
    }

    fn scalar(&self, name: &str) -> Option<f64> {
        self.spec.place(name).map(|place| f64::from(self.row[place.start]))
    }

    pub(super) fn put_scalar(&mut self, name: &str, x: f64) {
        if let Some(place) = self.spec.place(name) {
            self.row[place.start] = narrow(x);
        }
    }

    pub(super) fn vector(&self, name: &str) -> Option<Vec3<f64>> {
        let place = self.spec.place(name)?;
        Some(Vector(std::array::from_fn(|k| f64::from(self.row[place.start + k]))))
    }

    pub(super) fn put(&mut self, name: &str, v: Vec3<f64>) {
        if let Some(place) = self.spec.place(name) {
            self.row[place].iter_mut().zip(v.0).for_each(|(to, x)| *to = narrow(x));
        }
    }

    /// Turns a vector, which keeps its length.
    pub(super) fn turn(&mut self, name: &str, to: Vec3<f64>) {
        if let Some(length) = self.vector(name).map(|v| v.length()) {
            self.put(name, to.normalize().scale(length));
        }
    }

    /// In one case of four an exponent's fourth root, and so a broad highlight or cone.
    fn broaden(&mut self, name: &str) {
        if let Some(exponent) = self.scalar(name)
            && self.below(4) == 0
        {
            self.put_scalar(name, exponent.sqrt().sqrt());
        }
    }

    /// In one case of eight bright colours, whose terms sum to more than 1.
    fn brighten(&mut self) {
        if self.below(8) != 0 {
            return;
        }
        let mut start = 0;
        for input in self.spec.inputs {
            let end = start + input.shape.components();
            // `t` is a place along an edge.
            if input.domain == Domain::Unit && input.name != "t" {
                self.row[start..end].iter_mut().for_each(|x| *x = 1.0 - 0.25 * *x);
            }
            start = end;
        }
    }

    /// In one case of four the light within one unit of a point.
    fn approach(&mut self, light: &str, point: Vec3<f64>) {
        if let Some(position) = self.vector(light)
            && self.below(4) == 0
        {
            let distance = self.uniform(0.02, 1.0);
            self.put(light, point + (position - point).normalize().scale(distance));
        }
    }

    /// The vectors to the light and to the viewer at a point.
    pub(super) fn toward(&self, point: Vec3<f64>) -> Option<[Vec3<f64>; 2]> {
        let l = match self.vector("position") {
            Some(position) => position - point,
            None => -self.vector("direction")?,
        };
        // Formulas without a point have the viewer at infinity.
        let v = if self.has("p") || self.has("pa") || self.has("a") { -point } else { Vector([0.0, 0.0, 1.0]) };
        Some([l.normalize(), v.normalize()])
    }

    /// Turns a normal at a point: in one case of four to the middle of the highlight, in one to where the light grazes the surface.
    fn face(&mut self, normal: &str, point: Vec3<f64>) {
        let (Some([l, v]), Some(n)) = (self.toward(point), self.vector(normal)) else { return };
        match self.below(4) {
            0 => {
                let to = halfway(v, l) + self.jitter().scale(0.3);
                self.turn(normal, to);
            }
            1 => {
                let across = (n - l.scale(n.dot(l))).normalize();
                let to = across + l.scale(self.uniform(-0.3, 0.3));
                self.turn(normal, to);
            }
            _ => {}
        }
    }

    /// Aims three spotlights of four near the point. Of half of those the edge of the cone passes by the point.
    fn aim(&mut self, point: Vec3<f64>) {
        let (Some(position), Some(axis)) = (self.vector("position"), self.vector("axis")) else { return };
        let toward = (point - position).normalize();
        let way = self.below(8);
        if way < 2 {
            return;
        }
        let spread = self.uniform(0.05, 1.0);
        let to = toward + axis.normalize().scale(spread);
        self.turn("axis", to);
        let Some(axis) = self.vector("axis") else { return };
        if way >= 5 {
            let cosine = toward.dot(axis.normalize());
            let edge = cosine + (1.0 - cosine) * self.uniform(-0.75, 0.75);
            self.put_scalar("cutoff_cosine", edge.clamp(-0.5, 0.99));
        }
    }
}

/// A surface under a light: near it, in its highlight, grazed by it, on the edge of its cone.
pub(super) fn surface(spec: &Spec, row: &mut [f32]) {
    let mut fitted = Fitted::new(spec, row);
    let p = fitted.vector("p").unwrap_or_else(|| Vector::splat(0.0));
    fitted.approach("position", p);
    fitted.face("normal", p);
    fitted.aim(p);
    fitted.broaden("shininess");
    fitted.broaden("exponent");
    fitted.brighten();
}

/// An edge between two vertices, each a surface.
pub(super) fn edge(spec: &Spec, row: &mut [f32]) {
    let mut fitted = Fitted::new(spec, row);
    for [point, normal] in [["pa", "na"], ["pb", "nb"]] {
        if let Some(p) = fitted.vector(point) {
            fitted.face(normal, p);
        }
    }
    fitted.broaden("shininess");
    fitted.brighten();
}

/// A face: in half of the cases it faces the viewer and mirrors the light to it.
pub(super) fn face(spec: &Spec, row: &mut [f32]) {
    let mut fitted = Fitted::new(spec, row);
    if let (Some(a), Some(b), Some(c)) = (fitted.vector("a"), fitted.vector("b"), fitted.vector("c"))
        && fitted.below(2) == 0
    {
        let mut n = face_normal(a, b, c);
        if n.dot(a) > 0.0 {
            fitted.put("b", c);
            fitted.put("c", b);
            n = -n;
        }
        let mirrored = reflect(a.normalize(), n) + fitted.jitter().scale(0.3);
        let distance = fitted.uniform(1.0, 10.0);
        fitted.put("position", a + mirrored.normalize().scale(distance));
    }
    fitted.broaden("shininess");
    fitted.brighten();
}

/// A light near a point.
pub(super) fn light(spec: &Spec, row: &mut [f32]) {
    let mut fitted = Fitted::new(spec, row);
    if let Some(p) = fitted.vector("p") {
        fitted.approach("light", p);
    }
}
