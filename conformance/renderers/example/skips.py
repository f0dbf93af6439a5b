#!/usr/bin/env python3
"""A renderer of columns that skips a formula as a whole, and single cases of another one; the rest is answered:

    lightmeter pack PACK --columns fog/exp vector/reflect lighting/diffuse-toward
    python3 conformance/renderers/example/skips.py PACK ANSWERS
    lightmeter gate PACK ANSWERS
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[3] / "clients/python"))
from lightmeter_client import Renderer, Skip

SKIPS = [{"id": "fog/exp", "reason": "no fog"}, {"id": "vector/reflect", "reason": "some vectors"}]
renderer = Renderer("example-skips", "1.0", skips=SKIPS)


@renderer.formula("fog/exp")
def exponential_fog(p, density, fog, shaded):
    raise Skip("no fog is built in")


def reflect(cases):
    d = np.sum(cases.i * cases.n, axis=1, keepdims=True, dtype=np.float32)
    values = cases.i - np.float32(2) * d * cases.n
    return [Skip("a case in eight") if k % 8 == 3 else value for k, value in enumerate(values)]


@renderer.formula("lighting/diffuse-toward")
def diffuse(ld, md, l, n):
    return ld * md * np.maximum(l[0] * n[0] + l[1] * n[1] + l[2] * n[2], 0)


renderer.batches({"vector/reflect": reflect})
renderer.answer_pack(*sys.argv[1:])
