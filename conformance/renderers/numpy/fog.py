"""Fog by the distance in front of the eye, and by that from the eye."""
import numpy as np

from arithmetic import Array, by_id, clamp, dot, length, length_scaled, mix


def fogged(f: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    """The share of the surface's own colour, clamped, and the colour that is seen."""
    f = clamp(f)
    return f, mix(fog, shaded, f)


def ramp(distance: Array, dmin: Array, dmax: Array) -> Array:
    step = np.where(distance < dmax, 1, 0).astype(distance.dtype)
    return np.where(dmin == dmax, step, (dmax - distance) / (dmax - dmin))


def linear(p: Array, dmin: Array, dmax: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(ramp(np.abs(p[2]), dmin, dmax), fog, shaded)


def linear_radial(p: Array, dmin: Array, dmax: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(ramp(length(p), dmin, dmax), fog, shaded)


def linear_multiply_add(p: Array, dmin: Array, dmax: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    scale, offset = -1 / (dmax - dmin), dmax / (dmax - dmin)
    return fogged(np.abs(p[2]) * scale + offset, fog, shaded)


def exp(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(np.exp(-density * np.abs(p[2])), fog, shaded)


def exp_radial(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(np.exp(-density * length(p)), fog, shaded)


def exp_radial_scaled(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(np.exp(-density * length_scaled(p)), fog, shaded)


def exp2_document(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    """The square of the distance is never formed, since it might overflow."""
    return fogged(np.exp(-(density * p[2]) * p[2]), fog, shaded)


def exp2_document_radial(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(np.exp(-density * dot(p, p)), fog, shaded)


def exp2_document_square(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(np.exp(-density * (p[2] * p[2])), fog, shaded)


def exp2_opengl(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    t = density * p[2]
    return fogged(np.exp(-t * t), fog, shaded)


def exp2_opengl_radial(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    t = density * length(p)
    return fogged(np.exp(-t * t), fog, shaded)


def exp2_opengl_squares(p: Array, density: Array, fog: Array, shaded: Array) -> tuple[Array, Array]:
    return fogged(np.exp(-(density * density) * (p[2] * p[2])), fog, shaded)


def opacity(distance: Array, density: Array) -> Array:
    return 1 - np.exp(-density * distance)


def opacity_expm1(distance: Array, density: Array) -> Array:
    return -np.expm1(-density * distance)


FORMULAS = by_id(
    "fog",
    linear, linear_radial, exp, exp_radial, exp2_document, exp2_document_radial, exp2_opengl,
    exp2_opengl_radial, linear_multiply_add, exp2_document_square, exp2_opengl_squares, exp_radial_scaled,
    opacity, opacity_expm1,
)  # fmt: skip
