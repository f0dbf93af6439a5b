#!/usr/bin/env python3
"""A renderer of all formulas and no scenes in numpy, which speaks lightmeter.protocol/1:

    lightmeter gate --exec 'python3 conformance/renderers/numpy/renderer.py --dtype f32'

It was written from the published formulas and their rules alone. All cases of a formula within a batch are
computed at once, in f32 or in f64.
"""
import argparse
import json
import keyword
import sys
from typing import Any

import numpy as np

import attenuation
import blend
import color
import depth
import fog
import interpolation
import lighting
import raster
import vector
from arithmetic import Array, Formula

FAMILIES = (interpolation, raster, color, vector, lighting, attenuation, fog, depth, blend)
FORMULAS: dict[str, Formula] = {id: f for family in FAMILIES for id, f in family.FORMULAS.items()}
DTYPES = {"f32": np.float32, "f64": np.float64}


def parameter(name: str) -> str:
    """The name of an input as Python can have it."""
    name = name.replace("-", "_")
    return f"{name}_" if keyword.iskeyword(name) else name


def column(values: list[Any], dtype: type) -> Array:
    """One input of all cases, components first; "NaN", "Inf" and "-Inf" are understood."""
    return np.array(values, np.float32).astype(dtype).T


def evaluate(formula: str, cases: list[dict[str, Any]], dtype: type) -> list[list[float]]:
    """The outputs of each case, one after the other, rounded to f32."""
    compute = FORMULAS.get(formula) or blend.by_state(formula)
    inputs = {parameter(name): column([case[name] for case in cases], dtype) for name in cases[0]}
    with np.errstate(all="ignore"):
        outputs = compute(**inputs)
        parts = [np.atleast_2d(part) for part in (outputs if isinstance(outputs, tuple) else (outputs,))]
        if any(part.dtype.kind == "f" and part.dtype != dtype for part in parts):
            raise TypeError(f"{formula} was not computed in {np.dtype(dtype)}")
        return np.concatenate(parts).astype(np.float32).T.tolist()


def answers(requests: list[dict[str, Any]], dtype: type) -> list[dict[str, Any]]:
    by_formula: dict[str, list[dict[str, Any]]] = {}
    for request in requests:
        by_formula.setdefault(request["formula"], []).append(request)
    answered = []
    for formula, group in by_formula.items():
        values = evaluate(formula, [request["inputs"] for request in group], dtype)
        answered += [{"id": request["id"], "value": value} for request, value in zip(group, values)]
    return answered


def main() -> None:
    parser = argparse.ArgumentParser(description="Answers lightmeter's formulas by numpy")
    parser.add_argument("--dtype", choices=DTYPES, default="f32", help="the type of all arithmetic")
    name = parser.parse_args().dtype
    requests: list[dict[str, Any]] = []
    for line in sys.stdin:
        message = json.loads(line)
        if "hello" in message:
            hello = {
                "hello": "lightmeter.protocol/1",
                "renderer": f"numpy-{name}",
                "version": np.__version__,
                "formulas": [*FORMULAS, *blend.STATES],
            }
            print(json.dumps(hello), flush=True)
        elif "batch" in message:
            for answer in answers(requests, DTYPES[name]):
                print(json.dumps(answer))
            sys.stdout.flush()
            requests = []
        else:
            requests.append(message)


if __name__ == "__main__":
    main()
