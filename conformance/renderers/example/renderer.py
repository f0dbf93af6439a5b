#!/usr/bin/env python3
"""A renderer of two formulas and no scenes that speaks lightmeter.protocol/1:

    lightmeter gate --exec 'python3 conformance/renderers/example/renderer.py' fog/exp vector/reflect
"""
import json
import math
import sys


def reflect(i, n):
    d = 2 * sum(a * b for a, b in zip(i, n))
    return [a - d * b for a, b in zip(i, n)]


def exponential_fog(p, density, fog, shaded):
    f = min(max(math.exp(-density * abs(p[2])), 0), 1)
    return [f] + [f * s + (1 - f) * c for s, c in zip(shaded, fog)]


FORMULAS = {"vector/reflect": reflect, "fog/exp": exponential_fog}

for line in sys.stdin:
    request = json.loads(line)
    if "hello" in request:
        answer = {
            "hello": "lightmeter.protocol/1",
            "renderer": "example",
            "version": "1.0",
            "formulas": list(FORMULAS),
        }
    elif "batch" in request:  # All that was asked before it is answered by now.
        sys.stdout.flush()
        continue
    else:
        value = FORMULAS[request["formula"]](**request["inputs"])
        answer = {"id": request["id"], "value": value}
    print(json.dumps(answer), flush="hello" in request)
