//! What a rasteriser may make of a triangle.
//!
//! The derivation is that of `cases::rasteriser`, made fit for whole images:
//!
//! * *Place.* A vertex may be off by δ in x and in y: the step of the subpixel grid, and what its clip coordinates and the
//!   viewport lose in binary32. A pixel whose middle lies within δ of an edge may be covered or not. A covered one holds
//!   attributes of a point at most δ away. Among the moved vertices that point lies within the triangle. A rasteriser that
//!   moves vertices to decide what is covered, and interpolates among those that were given, as llvmpipe does, takes it
//!   from up to δ outside, where attributes go beyond those of the vertices.
//! * *Attributes.* With `a = Σgᵢaᵢ/wᵢ / Σgᵢ/wᵢ`, g linear in x and y, the value δ away differs from a by exactly
//!   `((Nx − aDx)dx + (Ny − aDy)dy)/D′`, N and D the numerator and the denominator, D′ the denominator there.
//! * *The plane equation in binary32*, `q₀ + gx(x − x₀) + gy(y − y₀)` however it is arranged, of q = a/w and of 1/w. With
//!   ε = 2⁻²³, W and H the triangle's extent, Q the range of q, A twice the area: each coordinate and value difference errs
//!   by ε, a determinant by 4ε of its products' magnitudes, the quotient by 3ε, so `Δgx ≤ (8εQH + 8ε|gx|WH)/A + 3ε|gx|`;
//!   its effect over the extent is Δgx·W, besides 4ε of the magnitudes that are summed up, measured from the target's corner.
//!   A gradient, a product or a value below 2⁻¹²⁶ may be flushed to 0.
//! * *What came before.* The interval of each vertex's attributes; a convex combination errs by no more than the worst.
//! * *Clipping.* A vertex is made at `a + t(b − a)` with `t = dₐ/(dₐ − d_b)`, d the distances from the plane. With errors Δ of
//!   these, t is off by `Δt = (Δₐ + Δ_b)/(|dₐ − d_b| − Δₐ − Δ_b)`, which moves everything by Δt of the whole edge. A vertex
//!   that lies on the plane within its error leaves open whether its triangle is seen at all.

use lightmeter_arithmetic::{Accept, F32, Format};
use lightmeter_reference::Vec4;
use lightmeter_reference::render::{Attributes, Geometry, Scratch, Shader, Triangle};
use std::sync::OnceLock;

const EPSILON: f64 = F32::EPSILON;
const MIN_NORMAL: f64 = F32::MIN_NORMAL;

/// What each vertex of a draw may be off by: by the profile in force, which is the same for all that asks.
#[derive(Debug, Default)]
pub(super) struct VertexErrors {
    /// x and y in pixels, the subpixel step not counted; depth; 1/w, relatively.
    pub(super) places: Vec<[f64; 4]>,
    /// Clip coordinates, of those behind the eye too.
    pub(super) clips: Vec<[f64; 4]>,
    /// The legal places in eye space of the mesh's vertices.
    pub(super) eyes: Vec<Vec4<Accept>>,
    /// The attributes, of those vertices alone that a pixel has asked for.
    attributes: Vec<OnceLock<Box<[f64]>>>,
}

/// How far legal values may lie from the exact one.
pub(super) fn off(exact: f64, legal: &Accept) -> f64 {
    (legal.high() - exact).max(exact - legal.low())
}

/// More than any target: where nothing is known of a place.
const ANYWHERE: f64 = 1e9;

impl VertexErrors {
    /// What the attributes of a vertex may be off by.
    fn of(&self, vertex: usize, geometry: &Geometry, shader: &Shader<'_, Accept>) -> &[f64] {
        self.attributes[vertex].get_or_init(|| match geometry.ends(vertex) {
            Some(ends) => {
                let along = self.off_along(geometry, vertex, ends);
                let [a, b] = ends.map(|end| geometry.attributes(end));
                let [off_a, off_b] = ends.map(|end| self.of(end, geometry, shader));
                (0..geometry.stride).map(|k| moved([a[k], b[k]], off_a[k].max(off_b[k]), along)).collect()
            }
            None => {
                let mut legal = Vec::with_capacity(geometry.stride);
                shader.vertex_attributes(vertex, self.eyes[vertex], &mut Scratch::default(), &mut legal);
                geometry.attributes(vertex).iter().zip(&legal).map(|(&value, legal)| off(value, legal)).collect()
            }
        })
    }

    /// Places of the vertices that clipping made: what both ends may be off by, and how far that moves the point between them.
    pub(super) fn extend(&mut self, geometry: &Geometry, size: [f64; 2]) {
        for (vertex, &[from, to]) in (self.clips.len()..).zip(&geometry.made_between) {
            let along = self.off_along(geometry, vertex, [from, to]);
            let (a, b) = (geometry.clip[from], geometry.clip[to]);
            let error = |k: usize| self.clips[from][k].max(self.clips[to][k]);
            let off: [f64; 4] = std::array::from_fn(|k| moved([a[k], b[k]], error(k), along));
            self.clips.push(off);
            let [x, y, z, w] = geometry.clip[vertex];
            let least = (w - off[3]).max(0.0);
            let ratio = |x: f64, off_x: f64| ((off_x + (x / w).abs() * off[3]) / least + 8.0 * EPSILON).min(ANYWHERE);
            let inverse_w = (off[3] / least).min(ANYWHERE);
            self.places.push([ratio(x, off[0]) * size[0], ratio(y, off[1]) * size[1], ratio(z, off[2]), inverse_w]);
        }
        self.attributes.resize_with(geometry.clip.len(), OnceLock::new);
    }

    /// The share of an edge by which the point where it meets the plane may be off.
    fn off_along(&self, geometry: &Geometry, vertex: usize, [from, to]: [usize; 2]) -> f64 {
        let distances = |vertex: usize| planes(geometry.clip[vertex]);
        // The plane that it lies on.
        let plane = usize::from(distances(vertex)[0].abs() > distances(vertex)[1].abs());
        let (at_from, at_to) = (distances(from)[plane], distances(to)[plane]);
        let error =
            self.off_planes(from)[plane] + self.off_planes(to)[plane] + 4.0 * EPSILON * (at_from.abs() + at_to.abs());
        let least = (at_from - at_to).abs() - error;
        if least > 0.0 { (error / least).min(1.0) } else { 1.0 }
    }

    /// What a vertex's distances from the near and the far plane may be off by.
    fn off_planes(&self, vertex: usize) -> [f64; 2] {
        let [_, _, z, w] = self.clips[vertex];
        [z, z + w]
    }

    /// Whether a vertex may lie on either side of the near or the far plane.
    fn is_on_a_plane(&self, geometry: &Geometry, vertex: usize) -> bool {
        let (distances, off) = (planes(geometry.clip[vertex]), self.off_planes(vertex));
        geometry.ends(vertex).is_none() && (0..2).any(|k| distances[k].abs() <= off[k])
    }
}

/// What a number between those of two vertices may be off by, where they are off by `error` and the place by a share of the edge.
fn moved([a, b]: [f64; 2], error: f64, along: f64) -> f64 {
    (error + 4.0 * EPSILON * a.abs().max(b.abs()) + along * (b - a).abs()).min(ANYWHERE)
}

/// The distances from the near and the far plane, in clip coordinates.
fn planes([_, _, z, w]: [f64; 4]) -> [f64; 2] {
    [z, w - z]
}

/// Where a triangle may be seen.
#[derive(Debug)]
pub(super) struct Outline {
    /// Below this magnitude the sign of an edge's [`Triangle::edges`] is open.
    pub(super) margins: [f64; 3],
    /// How far the point that is shown may lie from the pixel's middle.
    pub(super) reach: [f64; 2],
    /// Whether it may have no area, or be turned the other way.
    pub(super) may_vanish: bool,
}

impl Outline {
    pub(super) fn new(triangle: &Triangle, geometry: &Geometry, errors: &VertexErrors, step: f64) -> Self {
        let window = triangle.window;
        let off = triangle.vertices.map(|vertex| {
            let [x, y, ..] = errors.places[vertex];
            [x + step, y + step]
        });
        let worst = |axis: usize| off.iter().map(|off| off[axis]).fold(0.0, f64::max);
        let reach = [worst(0), worst(1)];
        let edge = |k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let [dx, dy]: [f64; 2] = std::array::from_fn(|axis| off[i][axis].max(off[j][axis]));
            (window[j][1] - window[i][1]).abs() * dx + (window[j][0] - window[i][0]).abs() * dy
        };
        let margins = std::array::from_fn(edge);
        // Moving each vertex of an edge by δ changes twice the area by at most the two margins beside it and 4δ² more.
        let may_vanish = triangle.area <= margins[0] + margins[1] + margins[2] + 4.0 * reach[0] * reach[1]
            || triangle.vertices.iter().any(|&vertex| errors.is_on_a_plane(geometry, vertex));
        Self { margins, reach, may_vanish }
    }
}

/// What a triangle may show.
#[derive(Debug)]
pub(super) struct Surface {
    /// How far the point that is shown may lie from the pixel's middle.
    reach: [f64; 2],
    /// What each attribute may be off by, besides what the reach of the point makes of it.
    slacks: Box<[f64]>,
    depth_slack: f64,
    /// ∂/∂x and ∂/∂y of each vertex's edge over its w.
    gradients: [[f64; 2]; 3],
    depth_gradient: [f64; 2],
}

impl Surface {
    pub(super) fn new(
        (triangle, outline): (&Triangle, &Outline),
        geometry: &Geometry,
        errors: &VertexErrors,
        shader: &Shader<'_, Accept>,
    ) -> Self {
        let window = triangle.window;
        // ∂/∂x and ∂/∂y of the edge opposite each vertex.
        let slopes: [[f64; 2]; 3] = std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            [-(window[j][1] - window[i][1]), window[j][0] - window[i][0]]
        });
        let plane = Plane::new(triangle, slopes);
        let inverse_w = triangle.inverse_w;
        let least_w = inverse_w.iter().fold(f64::INFINITY, |least, &x| least.min(x));
        let off = triangle.vertices.map(|vertex| &errors.places[vertex]);
        let w_error = off.iter().map(|off| off[3]).fold(3.0 * EPSILON, f64::max);
        let denominator = plane.error(inverse_w);
        let [a, b, c] = triangle.vertices.map(|vertex| geometry.attributes(vertex));
        let [off_a, off_b, off_c] = triangle.vertices.map(|vertex| errors.of(vertex, geometry, shader));
        let provoking = errors.of(triangle.provoking, geometry, shader);
        let slack = |k: usize| {
            if shader.attributes.is_flat_at(k) {
                return provoking[k];
            }
            let at = [a[k], b[k], c[k]];
            let given = [off_a[k], off_b[k], off_c[k]].into_iter().fold(0.0, f64::max);
            let (low, high) = range(at);
            let most = low.abs().max(high.abs());
            let numerator = plane.error(std::array::from_fn(|i| at[i] * inverse_w[i]));
            let quotient = (numerator + most * denominator) / (least_w - denominator).max(0.0) + 3.0 * EPSILON * most;
            given + quotient + 2.0 * w_error * (high - low)
        };
        let given = off.iter().map(|off| off[2]).fold(0.0, f64::max);
        Self {
            reach: outline.reach,
            slacks: (0..geometry.stride).map(slack).collect(),
            depth_slack: given + plane.error(triangle.depth) + EPSILON,
            gradients: std::array::from_fn(|i| slopes[i].map(|slope| slope * inverse_w[i])),
            depth_gradient: plane.gradient(triangle.depth),
        }
    }

    /// The depths that a fragment may have.
    pub(super) fn depth(&self, triangle: &Triangle, edges: [f64; 3]) -> (f64, f64) {
        let depth = triangle.depth_at(edges);
        let [gx, gy] = self.depth_gradient;
        let off = gx.abs() * self.reach[0] + gy.abs() * self.reach[1];
        let (low, high) = range(triangle.depth);
        let (least, most) = ((depth - off).max(low), (depth + off).min(high));
        let clamp = |x: f64| x.clamp(0.0, 1.0);
        (clamp(least.min(high) - self.depth_slack), clamp(most.max(low) + self.depth_slack))
    }

    /// The attributes that a fragment may have.
    pub(super) fn attributes(
        &self,
        (triangle, geometry): (&Triangle, &Geometry),
        flat: &Attributes,
        edges: [f64; 3],
        out: &mut Vec<Accept>,
    ) {
        out.clear();
        let over_w: [f64; 3] = std::array::from_fn(|i| edges[i] * triangle.inverse_w[i]);
        let sum = over_w[0] + over_w[1] + over_w[2];
        let [dx, dy] = self.reach;
        let total = |axis: usize| self.gradients.iter().map(|g| g[axis]).sum::<f64>();
        let least = sum - total(0).abs() * dx - total(1).abs() * dy;
        let [a, b, c] = triangle.vertices.map(|vertex| geometry.attributes(vertex));
        let provoking = geometry.attributes(triangle.provoking);
        for k in 0..geometry.stride {
            let slack = self.slacks[k];
            if flat.is_flat_at(k) {
                out.push(between(provoking[k] - slack, provoking[k] + slack));
                continue;
            }
            let at = [a[k], b[k], c[k]];
            let (low, high) = range(at);
            let value = (over_w[0] * at[0] + over_w[1] * at[1] + over_w[2] * at[2]) / sum;
            let along = |axis: usize| (0..3).map(|i| self.gradients[i][axis] * (at[i] - value)).sum::<f64>().abs();
            let off = if least > 0.0 { (along(0) * dx + along(1) * dy) / least } else { high - low };
            out.push(between(value - off - slack, value + off + slack));
        }
    }
}

fn between(low: f64, high: f64) -> Accept {
    if low.is_finite() && high.is_finite() { Accept::from_bounds(low, high) } else { Accept::ANY }
}

fn range(at: [f64; 3]) -> (f64, f64) {
    (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]))
}

/// What a plane equation through three vertices loses in binary32.
struct Plane {
    slopes: [[f64; 2]; 3],
    area: f64,
    extent: [f64; 2],
    /// The farthest coordinate of each axis.
    farthest: [f64; 2],
}

impl Plane {
    fn new(triangle: &Triangle, slopes: [[f64; 2]; 3]) -> Self {
        let along = |axis: usize| range(triangle.window.map(|v| v[axis]));
        let extent = [0, 1].map(|axis| along(axis).1 - along(axis).0);
        let farthest = [0, 1].map(|axis| along(axis).0.abs().max(along(axis).1.abs()));
        Self { slopes, area: triangle.area, extent, farthest }
    }

    fn gradient(&self, q: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|axis| (0..3).map(|i| self.slopes[i][axis] * (q[i] - q[0])).sum::<f64>() / self.area)
    }

    fn error(&self, q: [f64; 3]) -> f64 {
        let (low, high) = range(q);
        if low.abs().max(high.abs()) <= 0.0 {
            return 0.0;
        }
        let gradient = self.gradient(q);
        let [width, height] = self.extent;
        let of_axis = |axis: usize| {
            let g = gradient[axis].abs();
            let across = self.extent[1 - axis];
            let slope = 8.0 * EPSILON * ((high - low) * across + g * width * height) / self.area + 3.0 * EPSILON * g;
            let flushed = MIN_NORMAL * (self.extent[axis] + self.farthest[axis] + 2.0);
            slope * self.extent[axis] + 4.0 * EPSILON * 2.0 * g * self.farthest[axis] + flushed
        };
        of_axis(0) + of_axis(1) + 4.0 * EPSILON * low.abs().max(high.abs())
    }
}
