"""Normals, reflected and half vectors, and the way into eye space."""
import numpy as np

from arithmetic import (
    Array,
    by_id,
    cross,
    difference_of_products,
    dot,
    length,
    length_scaled,
    matrix,
    mix,
    normalize,
    normalize_scaled,
    power_of_two_exponents,
    scaled,
    transform,
)


def reflect(i: Array, n: Array) -> Array:
    return i - 2 * dot(i, n) * n


def reflect_toward(l: Array, n: Array) -> Array:
    return -l + 2 * dot(l, n) * n


def reflect_any_normal(i: Array, n: Array) -> Array:
    return reflect(i, normalize_scaled(n))


def halfway(v: Array, l: Array) -> Array:
    return normalize(v + l)


def halfway_unnormalised(v: Array, l: Array) -> Array:
    return v + l


def halfway_unguarded(v: Array, l: Array) -> Array:
    return normalize_unguarded(v + l)


def normalize_unguarded(v: Array) -> Array:
    return v / length(v)


def normal_modelview(modelview: Array, n: Array) -> Array:
    return transform(matrix(modelview, 3), n)


def cofactors(columns: Array) -> Array:
    """The columns of the cofactor matrix, which is the inverse transpose times the determinant."""
    a, b, c = columns
    return np.stack((cross(b, c), cross(c, a), cross(a, b)))


def normal_inverse_transpose(modelview: Array, n: Array) -> Array:
    columns = matrix(modelview, 3)
    by_column = cofactors(columns)
    return transform(by_column, n) / dot(columns[0], by_column[0])


def normal_by_determinant(modelview: Array, n: Array) -> Array:
    return normalize(normal_inverse_transpose(modelview, n))


def normal_by_cofactors(modelview: Array, n: Array) -> Array:
    """The normal by columns that are scaled, and the normal's components with them: only its length changes."""
    columns = matrix(modelview, 3)
    k = np.stack([power_of_two_exponents(column) for column in columns])
    columns = np.ldexp(columns, k[:, None])
    by_column = cofactors(columns)
    direction = normalize_scaled(transform(by_column, scaled(np.ldexp(scaled(n), k))))
    return np.where(dot(columns[0], by_column[0]) < 0, -direction, direction)


def light_direction(view: Array, direction: Array) -> Array:
    return transform(matrix(view, 4)[:3], direction)[:3]


def light_position(modelview: Array, position: Array) -> Array:
    p = transform(matrix(modelview, 4), position)
    return np.where(p[3] == 0, p[:3], p[:3] / p[3])


def light_with_model(view: Array, model: Array, position: Array) -> Array:
    point = np.concatenate((position, np.ones_like(position[:1])))
    return transform(matrix(view, 4), transform(matrix(model, 4), point))[:3]


def toward(light: Array, p: Array) -> Array:
    return normalize(light - p)


def average_normal(n0: Array, n1: Array, n2: Array) -> Array:
    return normalize(n0 + n1 + n2)


def face_normal(a: Array, b: Array, c: Array) -> Array:
    return normalize(cross(b - a, c - a))


def face_normal_compensated(a: Array, b: Array, c: Array) -> Array:
    u, v = scaled(b - a), scaled(c - a)
    pairs = ((1, 2), (2, 0), (0, 1))
    return normalize_scaled(np.stack([difference_of_products(u[i], v[j], u[j], v[i]) for i, j in pairs]))


def interpolated_normal(n0: Array, n1: Array, face: Array, t: Array) -> Array:
    return normalize(mix(n0, n1, t))


def interpolated_normal_guarded(n0: Array, n1: Array, face: Array, t: Array) -> Array:
    n = mix(n0, n1, t)
    return np.where(dot(n, n) < 2.0**-20, normalize_scaled(face), normalize(n))


FORMULAS = by_id(
    "vector",
    reflect, reflect_toward, halfway, halfway_unnormalised, normalize, normal_modelview,
    normal_inverse_transpose, light_direction, light_position, light_with_model, toward, average_normal,
    face_normal, normalize_unguarded, normalize_scaled, length, length_scaled, halfway_unguarded,
    reflect_any_normal, normal_by_determinant, normal_by_cofactors, face_normal_compensated,
    interpolated_normal, interpolated_normal_guarded,
)  # fmt: skip
