"""Depth: the test, and what is stored of a distance and read back."""
from functools import partial

import numpy as np

from arithmetic import Array, by_id, clamp

COMPARISONS = {
    "never": lambda new, old: np.zeros_like(new, bool),
    "less": np.less,
    "equal": np.equal,
    "less-equal": np.less_equal,
    "greater": np.greater,
    "not-equal": np.not_equal,
    "greater-equal": np.greater_equal,
    "always": lambda new, old: np.ones_like(new, bool),
}


def test(new: Array, old: Array, *, compare: str, write: bool) -> tuple[Array, Array]:
    """1 or 2, whichever fragment is seen, and the depth that is left."""
    new, old = clamp(new), clamp(old)
    passes = COMPARISONS[compare](new, old)
    return np.where(passes, 2, 1), np.where(passes & write, new, old)


def stored(near: Array, far: Array, z: Array) -> Array:
    return far * (z - near) / (z * (far - near))


def stored_reversed(near: Array, far: Array, z: Array) -> Array:
    return near * (far - z) / (z * (far - near))


def recovered(near: Array, far: Array, z: Array) -> Array:
    return near * far / (far - stored(near, far, z) * (far - near))


def recovered_reversed(near: Array, far: Array, z: Array) -> Array:
    return near * far / (near + stored_reversed(near, far, z) * (far - near))


FORMULAS = by_id("depth", stored, stored_reversed, recovered, recovered_reversed)
for compare in COMPARISONS:
    FORMULAS[f"depth/test/{compare}/write"] = partial(test, compare=compare, write=True)
    FORMULAS[f"depth/test/{compare}/keep"] = partial(test, compare=compare, write=False)
