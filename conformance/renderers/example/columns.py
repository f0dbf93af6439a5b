#!/usr/bin/env python3
"""Three formulas in numpy by clients/python/lightmeter_client.py, each for all cases at once:

    lightmeter gate --exec 'python3 conformance/renderers/example/columns.py' fog/exp vector/reflect lighting/diffuse-toward

By files of columns it answers a pack, PACK, by a folder, ANSWERS:

    lightmeter pack PACK --columns fog/exp vector/reflect lighting/diffuse-toward
    python3 conformance/renderers/example/columns.py PACK ANSWERS
    lightmeter gate PACK ANSWERS
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "clients/python"))

from lightmeter_client import Renderer

renderer = Renderer("example-numpy", "1.0")


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@renderer.formula("vector/reflect")
def reflect(i, n):
    return i - 2 * dot(i, n) * n


@renderer.formula("fog/exp")
def exponential_fog(p, density, fog, shaded):
    f = np.clip(np.exp(-density * np.abs(p[2])), 0, 1)
    return f, fog * (1 - f) + shaded * f


@renderer.formula("lighting/diffuse-toward")
def diffuse(ld, md, l, n):
    return ld * md * np.maximum(dot(l, n), 0)


if len(sys.argv) == 3:
    renderer.answer_pack(sys.argv[1], sys.argv[2])
else:
    renderer.serve()
