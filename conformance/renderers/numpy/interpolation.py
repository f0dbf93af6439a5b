"""Interpolation, window coordinates and coverage."""
import numpy as np

from arithmetic import Array, by_id, clamp, difference_of_products
from arithmetic import mix as weighted


def line(weights: Array, a: Array, b: Array) -> Array:
    return weights[0] * a + weights[1] * b


def triangle(weights: Array, a: Array, b: Array, c: Array) -> Array:
    return weights[0] * a + weights[1] * b + weights[2] * c


def edge(a: Array, b: Array, p: Array) -> Array:
    """Twice the signed area of a b p, positive where they run clockwise as seen, y being down."""
    return cross2(b - a, p - a)


def cross2(a: Array, b: Array) -> Array:
    return a[0] * b[1] - a[1] * b[0]


def edge_from_origin(a: Array, b: Array, p: Array) -> Array:
    return cross2(a, b) + cross2(b, p) + cross2(p, a)


def edge_compensated(a: Array, b: Array, p: Array) -> Array:
    ab, ap = b - a, p - a
    return difference_of_products(ab[0], ap[1], ab[1], ap[0])


def weights(a: Array, b: Array, c: Array, p: Array) -> Array:
    return np.stack((edge(b, c, p), edge(c, a, p), edge(a, b, p))) / edge(a, b, c)


def last_weight(a: Array, b: Array, c: Array, p: Array) -> Array:
    return edge(a, b, p) / edge(a, b, c)


def last_weight_by_difference(a: Array, b: Array, c: Array, p: Array) -> Array:
    alpha, beta, _ = weights(a, b, c, p)
    return 1 - alpha - beta


def scanline(v1: Array, v2: Array, v3: Array, i: Array, p: Array) -> Array:
    def along(end: Array, at_start: Array, at_end: Array) -> Array:
        """A value at the height of p on the edge from v1 to another vertex."""
        return (at_start * (p[1] - end[1]) + at_end * (v1[1] - p[1])) / (v1[1] - end[1])

    ia, xa = along(v2, i[0], i[1]), along(v2, v1[0], v2[0])
    ib, xb = along(v3, i[0], i[2]), along(v3, v1[0], v3[0])
    return (ia * (xb - p[0]) + ib * (p[0] - xa)) / (xb - xa)


def forward_differences(a: Array, b: Array) -> Array:
    step = (b - a) / 16
    for _ in range(16):
        a = a + step
    return a


def perspective(lambda_: Array, w: Array, attr: Array) -> Array:
    return (lambda_ * attr / w).sum(axis=0) / (lambda_ / w).sum(axis=0)


def perspective_line(t: Array, w: Array, attr: Array) -> Array:
    return perspective(np.stack((1 - t, t)), w, attr)


def perspective_scaled(lambda_: Array, w: Array, attr: Array) -> Array:
    least = w.min(axis=0)
    q = np.where(w == least, lambda_, lambda_ * (least / w))
    return (q * attr).sum(axis=0) / q.sum(axis=0)


def flat_first(attr: Array) -> Array:
    return attr[0]


def flat_last(attr: Array) -> Array:
    return attr[-1]


def coverage(a: Array, b: Array, c: Array, p: Array) -> Array:
    """Whether a point is covered, by the top-left rule.

    The edges run clockwise as seen, so that a left edge goes up and a top edge to the right.
    """
    area = edge(a, b, c)
    clockwise = area > 0
    b, c = np.where(clockwise, b, c), np.where(clockwise, c, b)
    covered = area != 0
    for start, end in ((a, b), (b, c), (c, a)):
        side = edge(start, end, p)
        x, y = end - start
        top_or_left = (y < 0) | ((y == 0) & (x > 0))
        covered &= (side > 0) | ((side == 0) & top_or_left)
    return covered


def viewport(clip: Array, origin: Array, size: Array, depth: Array) -> tuple[Array, ...]:
    x, y, z = clip[:3] / clip[3]
    return (
        origin[0] + (x + 1) * size[0] / 2,
        origin[1] + (1 - y) * size[1] / 2,
        depth[0] + z * (depth[1] - depth[0]),
    )


def viewport_opengl(clip: Array, origin: Array, size: Array, depth: Array) -> tuple[Array, ...]:
    x, y, z = clip[:3] / clip[3]
    return (
        origin[0] + (x + 1) * size[0] / 2,
        origin[1] + (y + 1) * size[1] / 2,
        depth[0] + (z + 1) * (depth[1] - depth[0]) / 2,
    )


def clip_volume(clip: Array) -> Array:
    x, y, z, w = clip
    return (-w <= x) & (x <= w) & (-w <= y) & (y <= w) & (0 <= z) & (z <= w)


def clip_volume_opengl(clip: Array) -> Array:
    return (np.abs(clip[:3]) <= clip[3]).all(axis=0)


def front_facing(a: Array, b: Array, c: Array) -> Array:
    return edge(a, b, c) < 0


def frag_depth(depth: Array) -> Array:
    return clamp(depth)


def mix(a: Array, b: Array, t: Array) -> Array:
    return weighted(a, b, t)


def mix_incremental(a: Array, b: Array, t: Array) -> Array:
    return a + t * (b - a)


FORMULAS = by_id(
    "interpolation",
    line, triangle, weights, scanline, forward_differences, perspective, perspective_line, flat_first,
    flat_last, coverage, viewport, viewport_opengl, clip_volume, clip_volume_opengl, front_facing, frag_depth,
    edge, edge_from_origin, edge_compensated, last_weight, last_weight_by_difference, mix, mix_incremental,
    perspective_scaled,
)  # fmt: skip
