"""Vectors, powers of two and exact products on numpy arrays.

An array holds all cases of a formula. Components come first and cases last: a scalar has the shape (n,),
a vector (3, n), and a matrix (columns, rows, n), so that scalars multiply vectors without more ado.
All arithmetic happens in the type of the arrays.
"""
from collections.abc import Callable

import numpy as np

Array = np.ndarray
Formula = Callable[..., Array | tuple[Array, ...]]


def by_id(family: str, *formulas: Formula) -> dict[str, Formula]:
    """The formulas of a family by their ids, which are their names with hyphens."""
    return {f"{family}/{f.__name__.strip('_').replace('_', '-')}": f for f in formulas}


def dot(a: Array, b: Array) -> Array:
    return (a * b).sum(axis=0)


def cross(a: Array, b: Array) -> Array:
    return np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def length(v: Array) -> Array:
    return np.sqrt(dot(v, v))


def normalize(v: Array) -> Array:
    """The unit vector of the same direction; the zero vector stays what it is."""
    size = length(v)
    return np.where(size > 0, v / size, 0)


def power_of_two_exponents(v: Array) -> Array:
    """The exponents k for which the largest component of v·2ᵏ lies in [½, 1)."""
    return -np.frexp(np.abs(v).max(axis=0))[1]


def scaled(v: Array) -> Array:
    """The vector times the power of two that brings its largest component into [½, 1)."""
    return np.ldexp(v, power_of_two_exponents(v))


def length_scaled(v: Array) -> Array:
    """The length of a vector whose square may overflow or underflow."""
    k = power_of_two_exponents(v)
    return np.ldexp(length(np.ldexp(v, k)), -k)


def normalize_scaled(v: Array) -> Array:
    """The unit vector of a vector whose square may overflow or underflow."""
    return normalize(scaled(v))


def clamp(x: Array, low: float = 0, high: float = 1) -> Array:
    return np.minimum(np.maximum(x, low), high)


def mix(a: Array, b: Array, t: Array) -> Array:
    return a * (1 - t) + b * t


def matrix(numbers: Array, size: int) -> Array:
    """A square matrix of numbers that come column by column, as an array of columns."""
    return numbers.reshape(size, size, -1)


def transform(columns: Array, v: Array) -> Array:
    """The product of a matrix and a vector."""
    return (columns * v[:, None]).sum(axis=0)


def two_product(a: Array, b: Array) -> tuple[Array, Array]:
    """The rounded product and its rounding error, by Veltkamp's splitting and Dekker's product."""

    def split(x: Array) -> tuple[Array, Array]:
        digits = np.finfo(x.dtype).nmant + 1
        shifted = x * float(2 ** ((digits + 1) // 2) + 1)
        high = shifted - (shifted - x)
        return high, x - high

    product = a * b
    (a_high, a_low), (b_high, b_low) = split(a), split(b)
    error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
    return product, error


def difference_of_products(a: Array, b: Array, c: Array, d: Array) -> Array:
    """a·b − c·d to two roundings, by Cornea, Harrison and Tang."""
    (ab, ab_error), (cd, cd_error) = two_product(a, b), two_product(c, d)
    return (ab - cd) + (ab_error - cd_error)
