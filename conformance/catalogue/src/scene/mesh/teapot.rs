//! Martin Newell's teapot (1975): 32 bicubic patches `P(u, v) = Σᵢ Σⱼ Bᵢ(v) Bⱼ(u) Pᵢⱼ`.
//!
//! Rim, body, lid and bottom are turned from profiles, each quarter of a circle by the cubic arc whose tangents are
//! 0.56 of its radius; the lid's top has 0.45 at 0.8 in the published figures. Handle and spout have one half given,
//! and the other mirrored. The figures have z up and stand on z = 0; here y is up.
//!
//! The normal is `∂P/∂v × ∂P/∂u`. At the middle of the lid and of the bottom ∂P/∂u is 0; there its limit's direction is
//! that of the mixed derivative ∂²P/∂u∂v.

use super::grid::Vertex;
use glam::DVec3;

/// A profile's control points: radius, tangent, height.
type Profile = [[f64; 3]; 4];

/// Turned profiles, from the lid's middle down to the bottom's.
const PROFILES: [Profile; 6] = [
    // Lid.
    [[0.0, 0.0, 3.15], [0.8, 0.45, 3.15], [0.0, 0.0, 2.85], [0.2, 0.112, 2.7]],
    [[0.2, 0.112, 2.7], [0.4, 0.224, 2.55], [1.3, 0.728, 2.55], [1.3, 0.728, 2.4]],
    // Rim.
    [[1.4, 0.784, 2.4], [1.3375, 0.749, 2.53125], [1.4375, 0.805, 2.53125], [1.5, 0.84, 2.4]],
    // Body.
    [[1.5, 0.84, 2.4], [1.75, 0.98, 1.875], [2.0, 1.12, 1.35], [2.0, 1.12, 0.9]],
    [[2.0, 1.12, 0.9], [2.0, 1.12, 0.45], [1.5, 0.84, 0.225], [1.5, 0.84, 0.15]],
    // Bottom.
    [[1.5, 0.84, 0.15], [1.5, 0.84, 0.075], [1.425, 0.798, 0.0], [0.0, 0.0, 0.0]],
];

/// The halves of handle and spout at y ≤ 0: each row goes around the tube, x and z at y = 0, the two off it, and y = 0
/// again; the row's y is that of the two in the middle.
struct Section {
    y: f64,
    xz: [[f64; 2]; 4],
}

const fn section(y: f64, xz: [[f64; 2]; 4]) -> Section {
    Section { y, xz }
}

const TUBES: [[Section; 4]; 4] = [
    // Handle.
    [
        section(-0.3, [[-1.6, 2.025], [-1.6, 2.025], [-1.5, 2.25], [-1.5, 2.25]]),
        section(-0.3, [[-2.3, 2.025], [-2.3, 2.025], [-2.5, 2.25], [-2.5, 2.25]]),
        section(-0.3, [[-2.7, 2.025], [-2.7, 2.025], [-3.0, 2.25], [-3.0, 2.25]]),
        section(-0.3, [[-2.7, 1.8], [-2.7, 1.8], [-3.0, 1.8], [-3.0, 1.8]]),
    ],
    [
        section(-0.3, [[-2.7, 1.8], [-2.7, 1.8], [-3.0, 1.8], [-3.0, 1.8]]),
        section(-0.3, [[-2.7, 1.575], [-2.7, 1.575], [-3.0, 1.35], [-3.0, 1.35]]),
        section(-0.3, [[-2.5, 1.125], [-2.5, 1.125], [-2.65, 0.9375], [-2.65, 0.9375]]),
        section(-0.3, [[-2.0, 0.9], [-2.0, 0.9], [-1.9, 0.6], [-1.9, 0.6]]),
    ],
    // Spout.
    [
        section(-0.66, [[1.7, 1.425], [1.7, 1.425], [1.7, 0.6], [1.7, 0.6]]),
        section(-0.66, [[2.6, 1.425], [2.6, 1.425], [3.1, 0.825], [3.1, 0.825]]),
        section(-0.25, [[2.3, 2.1], [2.3, 2.1], [2.4, 2.025], [2.4, 2.025]]),
        section(-0.25, [[2.7, 2.4], [2.7, 2.4], [3.3, 2.4], [3.3, 2.4]]),
    ],
    [
        section(-0.25, [[2.7, 2.4], [2.7, 2.4], [3.3, 2.4], [3.3, 2.4]]),
        section(-0.25, [[2.8, 2.475], [2.8, 2.475], [3.525, 2.49375], [3.525, 2.49375]]),
        section(-0.15, [[2.9, 2.475], [2.9, 2.475], [3.45, 2.5125], [3.45, 2.5125]]),
        section(-0.15, [[2.8, 2.4], [2.8, 2.4], [3.2, 2.4], [3.2, 2.4]]),
    ],
];

/// A bicubic patch: rows along v, points of a row along u, z up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    points: [[DVec3; 4]; 4],
    /// Where its texture begins along u, and how much of it there is.
    across: [f64; 2],
}

/// All 32.
pub(super) fn patches() -> Vec<Patch> {
    let turned = PROFILES.iter().flat_map(|profile| (0..4).map(move |quarter| turned(profile, quarter)));
    let halves = TUBES.iter().flat_map(|tube| [half(tube, false), half(tube, true)]);
    turned.chain(halves).collect()
}

/// A quarter of a turned profile, counter-clockwise as seen from above, so that seen from outside u runs right and v
/// down.
fn turned(profile: &Profile, quarter: u8) -> Patch {
    let points = profile.map(|[radius, tangent, z]| {
        [[radius, 0.0], [radius, tangent], [tangent, radius], [0.0, radius]].map(|[x, y]| {
            let (x, y) = match quarter {
                0 => (x, y),
                1 => (-y, x),
                2 => (-x, -y),
                _ => (y, -x),
            };
            DVec3::new(x, y, z)
        })
    });
    Patch { points, across: [f64::from(quarter) / 4.0, 0.25] }
}

/// Half of a tube: as given or mirrored, with the row turned round, so that the outside stays outside.
fn half(tube: &[Section; 4], mirrored: bool) -> Patch {
    let points = std::array::from_fn(|row| {
        let Section { y, xz } = &tube[row];
        let given = [0, 1, 2, 3].map(|k| {
            let y = if k == 1 || k == 2 { *y } else { 0.0 };
            DVec3::new(xz[k][0], if mirrored { -y } else { y }, xz[k][1])
        });
        let [a, b, c, d] = given;
        if mirrored { given } else { [d, c, b, a] }
    });
    Patch { points, across: [0.0, 1.0] }
}

impl Patch {
    /// The point, its normal and its texture coordinates, y up.
    pub(super) fn vertex(&self, u: f64, v: f64) -> Vertex {
        let sum = |of_v: [f64; 4], of_u: [f64; 4]| -> DVec3 {
            (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).map(|(i, j)| of_v[i] * of_u[j] * self.points[i][j]).sum()
        };
        let mut along_u = sum(bernstein(v), slope(u));
        let along_v = sum(slope(v), bernstein(u));
        if along_u.length_squared() < 1e-18 {
            // Beside the edge v = 0 the derivative is v times the mixed one; beside v = 1 it is −(1 − v) times that.
            along_u = sum(slope(v), slope(u)) * (1.0 - 2.0 * v);
        }
        let normal = along_v.cross(along_u).normalize_or_zero();
        let upright = |p: DVec3| DVec3::new(p.x, p.z, -p.y);
        Vertex {
            position: upright(sum(bernstein(v), bernstein(u))),
            normal: upright(normal),
            uv: [self.across[0] + u * self.across[1], v],
        }
    }
}

fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t]
}

/// The derivative of [`bernstein`].
fn slope(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * s - 6.0 * t * s, 6.0 * t * s - 3.0 * t * t, 3.0 * t * t]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_32_patches_whose_normals_are_outward() {
        let patches = patches();
        assert_eq!(patches.len(), 32);
        // Turned ones: away from the axis or from the middle of the pot.
        for (place, patch) in patches.iter().enumerate() {
            for (u, v) in [(0.0, 0.0), (0.3, 0.0), (0.5, 0.5), (0.7, 1.0), (1.0, 1.0)] {
                let Vertex { position, normal, .. } = patch.vertex(u, v);
                assert!((normal.length() - 1.0).abs() < 1e-12, "patch {place} at {u}, {v}: {normal}");
                if (12..20).contains(&place) {
                    let outward = normal.dot(DVec3::new(position.x, 0.0, position.z));
                    assert!(outward > 0.0, "body's patch {place} at {u}, {v}: {normal}");
                }
            }
        }
    }

    #[test]
    fn at_the_poles_normals_are_vertical() {
        let patches = patches();
        for (patches, v, y) in [(0..4, 0.0, 1.0), (20..24, 1.0, -1.0)] {
            for patch in &super::patches()[patches] {
                for u in [0.0, 0.25, 1.0] {
                    assert!((patch.vertex(u, v).normal - DVec3::Y * y).length() < 1e-12);
                }
            }
        }
        assert!((patches[0].vertex(0.0, 0.0).position - DVec3::new(0.0, 3.15, 0.0)).length() < 1e-12);
    }
}
