"""Colours: storage, the sRGB curves, and what textures do."""
import numpy as np

from arithmetic import Array, by_id, clamp


def encode(c: Array) -> Array:
    """The sRGB curve; the power gets no base below its own piece."""
    threshold = 0.0031308
    return np.where(c <= threshold, 12.92 * c, srgb_encode_power(np.maximum(c, threshold)))


def decode(e: Array) -> Array:
    threshold = 0.04045
    return np.where(e <= threshold, e / 12.92, ((np.maximum(e, threshold) + 0.055) / 1.055) ** 2.4)


def to_unorm8(c: Array) -> Array:
    return np.rint(255 * clamp(c))


def from_unorm8(byte: Array) -> Array:
    return byte / 255


def srgb_encode(c: Array) -> tuple[Array, Array]:
    return encode(c[:3]), c[3]


def srgb_decode(e: Array) -> tuple[Array, Array]:
    return decode(e[:3]), e[3]


def srgb_encode_component(c: Array) -> Array:
    return encode(c)


def srgb_encode_power(c: Array) -> Array:
    return 1.055 * c ** (1 / 2.4) - 0.055


def gamma_encode(c: Array) -> Array:
    return c ** (1 / 2.2)


def modulate(texel: Array, color: Array) -> Array:
    return texel * color


def replace(texel: Array, color: Array) -> Array:
    return texel


def sum_(a: Array, b: Array) -> Array:
    return clamp(a + b)


def uniform(color: Array) -> tuple[Array, Array]:
    return color, np.ones_like(color[0])


def per_vertex(weights: Array, a: Array, b: Array, c: Array) -> tuple[Array, Array]:
    return uniform(weights[0] * a + weights[1] * b + weights[2] * c)


FORMULAS = by_id(
    "color",
    to_unorm8, from_unorm8, srgb_encode, srgb_decode, srgb_encode_component, srgb_encode_power, gamma_encode,
    modulate, replace, sum_, uniform, per_vertex,
)  # fmt: skip
