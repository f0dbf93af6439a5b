"""How light fades with the distance, and within the cone of a spotlight."""
import numpy as np

from arithmetic import Array, by_id, clamp, dot, length, length_scaled


def polynomial(kc: Array, kl: Array, kq: Array, d: Array) -> Array:
    return 1 / (kc + kl * d + kq * d * d)


def constant(d: Array) -> Array:
    return np.ones_like(d)


def linear(d: Array) -> Array:
    return 1 / d


def square(d: Array) -> Array:
    return 1 / (d * d)


def point(kc: Array, kl: Array, kq: Array, light: Array, p: Array) -> Array:
    return polynomial(kc, kl, kq, length(light - p))


def polynomial_expanded(kc: Array, kl: Array, kq: Array, d: Array) -> Array:
    return 1 / (kc + kl * d + kq * (d * d))


def polynomial_bounded(kc: Array, kl: Array, kq: Array, d: Array) -> Array:
    return 1 / clamp(kc + d * (kl + d * kq), 2.0**-126, 2.0**126)


def point_scaled(kc: Array, kl: Array, kq: Array, light: Array, p: Array) -> Array:
    return polynomial_bounded(kc, kl, kq, length_scaled(light - p))


def cosine_power(a: Array, b: Array, exponent: Array) -> Array:
    """The power of the cosine between two unit vectors, 0 for a negative one."""
    return np.maximum(dot(a, b), 0) ** exponent


def cosine_power_by_chord(a: Array, b: Array, exponent: Array) -> Array:
    """The same by the square of the chord, which has the digits that a cosine near 1 has lost."""
    q = dot(a - b, a - b) / 2
    by_chord = np.exp(exponent * np.log1p(-np.minimum(q, 0.5)))
    return np.where((exponent <= 64) | (q >= 0.5), cosine_power(a, b, exponent), by_chord)


def spot_cutoff(l: Array, axis: Array, cutoff_cosine: Array) -> Array:
    """Whether a point lies in the cone, whose edge belongs to it."""
    return dot(-l, axis) >= cutoff_cosine


def spot_exponent(l: Array, axis: Array, cutoff_cosine: Array, exponent: Array) -> Array:
    return np.where(spot_cutoff(l, axis, cutoff_cosine), cosine_power(-l, axis, exponent), 0)


def spot_exponent_by_chord(l: Array, axis: Array, cutoff_cosine: Array, exponent: Array) -> Array:
    return np.where(spot_cutoff(l, axis, cutoff_cosine), cosine_power_by_chord(-l, axis, exponent), 0)


FORMULAS = by_id(
    "attenuation",
    polynomial, constant, linear, square, point, spot_cutoff, spot_exponent, polynomial_expanded,
    polynomial_bounded, point_scaled, spot_exponent_by_chord,
)  # fmt: skip
