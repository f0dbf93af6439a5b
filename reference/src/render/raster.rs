//! Triangles: clipping, the viewport, and the weights of their vertices at a pixel.
//!
//! `x y` window coordinates in pixels, y down; a pixel's middle lies at its whole coordinates plus ½.

use crate::algebra::{Vec4, Vector};
use crate::interpolation::{self, Viewport, edge};
use lightmeter_scene::frame::Cull;

/// Vertices of a draw, those that clipping makes among them, and the triangles between them.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Numbers of a vertex.
    pub stride: usize,
    /// The attributes, vertex after vertex.
    pub numbers: Vec<f64>,
    /// Clip coordinates.
    pub clip: Vec<[f64; 4]>,
    /// Vertices of one identity lie at one place, for certain.
    pub identities: Vec<u64>,
    /// The two vertices that each of the last ones was made between.
    pub made_between: Vec<[usize; 2]>,
    /// What is left after clipping and culling, in the order of the mesh.
    pub triangles: Vec<Triangle>,
}

/// A triangle in the window.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Its vertices, turned so that [`edge`] is positive.
    pub vertices: [usize; 3],
    /// The vertex that gives flat attributes.
    pub provoking: usize,
    /// Which triangle of the mesh it is, or is a part of.
    pub source: usize,
    /// Whether its front is seen.
    pub is_front: bool,
    /// x and y of each vertex.
    pub window: [[f64; 2]; 3],
    /// Depth of each vertex.
    pub depth: [f64; 3],
    /// 1/w of each vertex.
    pub inverse_w: [f64; 3],
    /// Twice the area.
    pub area: f64,
    edges: [Edge; 3],
}

/// A line through two vertices, from the lesser to the greater, so that both triangles at an edge compute the same.
#[derive(Clone, Copy, Debug)]
struct Edge {
    from: [f64; 2],
    along: [f64; 2],
    /// −1 where the triangle goes round it the other way.
    sign: f64,
}

impl Edge {
    fn new(a: [f64; 2], b: [f64; 2]) -> Self {
        let (from, to, sign) = if a <= b { (a, b, 1.0) } else { (b, a, -1.0) };
        Self { from, along: [to[0] - from[0], to[1] - from[1]], sign }
    }
}

impl Geometry {
    /// The numbers of a vertex.
    #[must_use]
    pub fn attributes(&self, vertex: usize) -> &[f64] {
        &self.numbers[vertex * self.stride..(vertex + 1) * self.stride]
    }

    /// The two vertices that clipping made this one between; `None` for a vertex of the mesh.
    #[must_use]
    pub fn ends(&self, vertex: usize) -> Option<[usize; 2]> {
        let given = self.clip.len() - self.made_between.len();
        vertex.checked_sub(given).map(|made| self.made_between[made])
    }

    /// Brings triangles to the window: `triangles` of the vertices that are there, `size` that of the target in pixels.
    pub fn assemble(
        &mut self,
        triangles: &[[u32; 3]],
        provoking: impl Fn([u32; 3]) -> u32,
        size: [u32; 2],
        cull: Cull,
    ) {
        let to = viewport(size);
        for (source, &triangle) in triangles.iter().enumerate() {
            let provoking = provoking(triangle) as usize;
            let corners = triangle.map(|vertex| vertex as usize);
            let polygon = self.clipped(corners);
            for k in 2..polygon.len() {
                let part = [polygon[0], polygon[k - 1], polygon[k]];
                if let Some(made) = self.triangle(part, provoking, source, &to)
                    && match cull {
                        Cull::None => true,
                        Cull::Back => made.is_front,
                        Cull::Front => !made.is_front,
                    }
                {
                    self.triangles.push(made);
                }
            }
        }
    }

    /// `None` without area.
    fn triangle(
        &self,
        mut vertices: [usize; 3],
        provoking: usize,
        source: usize,
        to: &Viewport<f64>,
    ) -> Option<Triangle> {
        let mut corners = vertices.map(|vertex| interpolation::viewport(Vector(self.clip[vertex]), to));
        let [a, b, c] = corners.map(|v| Vector([v.x(), v.y()]));
        let area = edge(a, b, c);
        // Front is counter-clockwise as seen, which with y down is a negative area.
        let is_front = area < 0.0;
        if is_front {
            vertices.swap(1, 2);
            corners.swap(1, 2);
        }
        let window = corners.map(|v| [v.x(), v.y()]);
        let [a, b, c] = window;
        (area != 0.0 && area.is_finite()).then(|| Triangle {
            vertices,
            provoking,
            source,
            is_front,
            window,
            edges: [Edge::new(b, c), Edge::new(c, a), Edge::new(a, b)],
            depth: corners.map(|v| v.z()),
            inverse_w: vertices.map(|vertex| 1.0 / self.clip[vertex][3]),
            area: area.abs(),
        })
    }

    /// The part of a triangle between the near and the far plane, 0 ≤ z ≤ w.
    fn clipped(&mut self, corners: [usize; 3]) -> Vec<usize> {
        let planes: [fn([f64; 4]) -> f64; 2] = [|[_, _, z, _]| z, |[_, _, z, w]| w - z];
        let mut polygon = corners.to_vec();
        for (number, inside) in planes.into_iter().enumerate() {
            if polygon.iter().all(|&vertex| inside(self.clip[vertex]) >= 0.0) {
                continue;
            }
            let mut kept = vec![];
            for (k, &from) in polygon.iter().enumerate() {
                let to = polygon[(k + 1) % polygon.len()];
                let (at_from, at_to) = (inside(self.clip[from]), inside(self.clip[to]));
                if at_from >= 0.0 {
                    kept.push(from);
                }
                if (at_from >= 0.0) != (at_to >= 0.0) {
                    kept.push(self.between(from, to, at_from / (at_from - at_to), number as u64));
                }
            }
            polygon = kept;
        }
        polygon
    }

    /// The vertex `from + t(to − from)`, on a plane.
    fn between(&mut self, from: usize, to: usize, t: f64, plane: u64) -> usize {
        let (a, b) = (self.clip[from], self.clip[to]);
        self.clip.push(std::array::from_fn(|k| a[k] + t * (b[k] - a[k])));
        for k in 0..self.stride {
            let (a, b) = (self.numbers[from * self.stride + k], self.numbers[to * self.stride + k]);
            self.numbers.push(a + t * (b - a));
        }
        // The same edge meets the plane at the same place, whichever triangle is clipped.
        let (low, high) =
            (self.identities[from].min(self.identities[to]), self.identities[from].max(self.identities[to]));
        let mixed = low.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ high.rotate_left(32) ^ (plane + 1).rotate_right(8);
        self.identities.push(mixed);
        self.made_between.push([from, to]);
        self.clip.len() - 1
    }
}

fn viewport(size: [u32; 2]) -> Viewport<f64> {
    Viewport { origin: Vector([0.0, 0.0]), size: Vector(size.map(f64::from)), depth: Vector([0.0, 1.0]) }
}

impl Triangle {
    /// Twice the area that p spans with each edge, the edge opposite each vertex: positive inside. Edges that two triangles
    /// share give the same numbers with the other sign.
    #[must_use]
    pub fn edges(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        self.edges_in(self.row(y), x)
    }

    /// What [`Triangle::edges`] has in common along a row.
    #[must_use]
    pub fn row(&self, y: f64) -> [f64; 3] {
        self.edges.map(|edge| edge.along[0] * (y - edge.from[1]))
    }

    /// [`Triangle::edges`] at a place in a row.
    #[must_use]
    #[inline]
    pub fn edges_in(&self, row: [f64; 3], x: f64) -> [f64; 3] {
        std::array::from_fn(|k| {
            let edge = &self.edges[k];
            edge.sign * (row[k] - edge.along[1] * (x - edge.from[0]))
        })
    }

    /// Whether the pixel whose edges are given belongs to the triangle: inside, or on a top or a left edge.
    #[must_use]
    #[inline]
    pub fn covers(&self, edges: [f64; 3]) -> bool {
        (0..3).all(|k| edges[k] > 0.0 || (edges[k] == 0.0 && self.is_top_or_left(k)))
    }

    #[expect(clippy::float_cmp, reason = "a level edge is level to the last bit")]
    fn is_top_or_left(&self, k: usize) -> bool {
        let (a, b) = (self.window[(k + 1) % 3], self.window[(k + 2) % 3]);
        // Its inside lies to the right of a → b with y down: a left edge goes up, a top edge is level and goes right.
        b[1] < a[1] || (b[1] == a[1] && b[0] > a[0])
    }

    /// Depth, which is linear in the window.
    #[must_use]
    #[inline]
    pub fn depth_at(&self, edges: [f64; 3]) -> f64 {
        interpolation::triangle(edges, self.depth) / self.area
    }

    /// `λᵢ/wᵢ / Σλ/w`: what each vertex's attribute is multiplied by, perspective-correct.
    #[must_use]
    #[inline]
    pub fn weights(&self, edges: [f64; 3]) -> [f64; 3] {
        let over_w: [f64; 3] = std::array::from_fn(|k| edges[k] * self.inverse_w[k]);
        let share = 1.0 / (over_w[0] + over_w[1] + over_w[2]);
        over_w.map(|q| q * share)
    }

    /// The pixels whose middles may lie within: first and last column, first and last row, `by` more on each side.
    #[must_use]
    pub fn pixels(&self, by: f64, size: [u32; 2]) -> [[usize; 2]; 2] {
        std::array::from_fn(|axis| {
            let (low, high) = self
                .window
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v[axis]), high.max(v[axis])));
            let last = f64::from(size[axis]) - 1.0;
            let (first, last) = ((low - by - 0.5).ceil().clamp(0.0, last + 1.0), (high + by - 0.5).floor().min(last));
            if last < first { [1, 0] } else { [whole(first), whole(last)] }
        })
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within a target's size")]
const fn whole(x: f64) -> usize {
    x as usize
}

/// A homogeneous position as plain numbers.
pub(super) fn plain<R: Into<f64>>(clip: Vec4<R>) -> [f64; 4] {
    clip.0.map(Into::into)
}
