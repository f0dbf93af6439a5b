"""What a rasteriser draws on a target of 256 × 256 pixels, by arithmetic at the centre of one pixel.

Clip coordinates are (x, y, z, w) with y up and 0 ≤ z ≤ w; no position is moved to a grid of subpixels.
"""
from functools import partial

import numpy as np

from arithmetic import Array, Formula, clamp, cross, dot
from depth import COMPARISONS
from interpolation import coverage, edge, perspective_line

SIZE = 256


def window(clip: Array) -> Array:
    """Where a vertex lies on the target, y being down."""
    x, y = clip[:2] / clip[3]
    return np.stack(((x + 1) * (SIZE / 2), (1 - y) * (SIZE / 2)))


def homogeneous_weights(a: Array, b: Array, c: Array, pixel: Array) -> Array:
    """Weights of the vertices for which Σ weight·clip lies on the ray through the pixel's centre, in front.

    They need no division by w, so that vertices may lie behind the eye. They do not sum to 1.
    """
    x, y, _, w = np.stack((a, b, c), axis=1)
    across = (pixel[0] + 0.5) / (SIZE / 2) - 1
    up = 1 - (pixel[1] + 0.5) / (SIZE / 2)
    weights = cross(x - across * w, y - up * w)
    return weights * np.sign(dot(weights, w))


def attributes(a: Array, b: Array, c: Array, attr: Array, pixel: Array) -> tuple[Array, Array]:
    weights = homogeneous_weights(a, b, c, pixel)
    on_screen = weights * np.stack((a[3], b[3], c[3]))
    return dot(weights, attr) / weights.sum(axis=0), dot(on_screen, attr) / on_screen.sum(axis=0)


def position(a: Array, b: Array, c: Array, attr: Array, pixel: Array) -> tuple[Array, ...]:
    weights = homogeneous_weights(a, b, c, pixel)
    _, _, z, w = (weights * np.stack((a, b, c), axis=1)).sum(axis=1)
    return pixel + 0.5, z / w, weights.sum(axis=0) / w


def line(a: Array, b: Array, attr_a: Array, attr_b: Array, pixel: Array) -> tuple[Array, Array]:
    start = window(a)
    along = window(b) - start
    t = clamp(dot(pixel + 0.5 - start, along) / dot(along, along))
    attr = np.stack((attr_a, attr_b))
    return perspective_line(t, np.stack((a[3], b[3])), attr), attr_a * (1 - t) + attr_b * t


def facing(a: Array, b: Array, c: Array, attr: Array, pixel: Array) -> Array:
    return edge(window(a), window(b), window(c)) < 0


def cull(a: Array, b: Array, c: Array, attr: Array, pixel: Array, *, side: str, front: str) -> Array:
    """Whether a triangle is left whose front or back faces are culled."""
    area = edge(window(a), window(b), window(c))
    is_front = area < 0 if front == "ccw" else area > 0
    return is_front if side == "back" else ~is_front


def clip(a: Array, b: Array, c: Array, attr: Array, pixel: Array) -> Array:
    weights = homogeneous_weights(a, b, c, pixel)
    _, _, z, w = (weights * np.stack((a, b, c), axis=1)).sum(axis=1)
    return (weights >= 0).all(axis=0) & (w > 0) & (0 <= z) & (z <= w)


def two_triangles(a: Array, b: Array, c: Array, d: Array, pixel: Array) -> Array:
    """How many of the triangles a b c and a c d cover the pixel."""
    centre = pixel + 0.5
    return coverage(a, b, c, centre).astype(int) + coverage(a, c, d, centre)


def frag_depth(depth: Array, pixel: Array) -> Array:
    return clamp(depth)


def flat(primitive: Array, pixel: Array, *, stride: int, offset: int, **attributes: Array) -> Array:
    """The attribute of a primitive's provoking vertex, by its place among the vertices of the primitive."""
    vertices = np.stack([attributes[f"a{n}"] for n in range(len(attributes))])
    provoking = primitive.astype(int) * stride + offset
    return np.take_along_axis(vertices, provoking[None], axis=0)[0]


def same_geometry(a: Array, b: Array, c: Array, attr: Array, pixel: Array, *, compare: str) -> Array:
    """1 or 2, whichever drawing is seen of a triangle that is drawn twice: its depths are equal."""
    depth = np.zeros_like(pixel[0])
    return np.where(COMPARISONS[compare](depth, depth), 2, 1)


# From a primitive to the next one, and the number of its vertices.
TOPOLOGIES = {
    "points": (1, 1),
    "line-list": (2, 2),
    "line-strip": (1, 2),
    "triangle-list": (3, 3),
    "triangle-strip": (1, 3),
}

FORMULAS: dict[str, Formula] = {
    "interpolation/raster-attributes": attributes,
    "interpolation/raster-position": position,
    "interpolation/raster-line": line,
    "interpolation/raster-facing": facing,
    "interpolation/raster-clip": clip,
    "interpolation/raster-top-left": two_triangles,
    "interpolation/raster-shared-edge": two_triangles,
    "interpolation/raster-frag-depth": frag_depth,
}
for side in ("back", "front"):
    for front in ("ccw", "cw"):
        FORMULAS[f"interpolation/cull-{side}-{front}"] = partial(cull, side=side, front=front)
for topology, (stride, count) in TOPOLOGIES.items():
    for provoking, offset in (("first", 0), ("last", count - 1)):
        formula = partial(flat, stride=stride, offset=offset)
        FORMULAS[f"interpolation/raster-flat-{topology}-{provoking}"] = formula
for compare in COMPARISONS:
    FORMULAS[f"depth/same-geometry-{compare}"] = partial(same_geometry, compare=compare)
