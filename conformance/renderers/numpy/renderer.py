#!/usr/bin/env python3
"""A renderer of all formulas and no scenes in numpy, which speaks lightmeter.protocol/1:

    lightmeter gate --exec 'python3 conformance/renderers/numpy/renderer.py --dtype f32'

It was written from the published formulas and their rules alone. All cases of a formula within a batch are
computed at once, in f32 or in f64.
"""
import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "clients/python"))

import attenuation
import blend
import color
import depth
import fog
import interpolation
import lighting
import raster
import vector
from arithmetic import Formula
from lightmeter_client import Renderer

FAMILIES = (interpolation, raster, color, vector, lighting, attenuation, fog, depth, blend)
FORMULAS: dict[str, Formula] = {id: f for family in FAMILIES for id, f in family.FORMULAS.items()}
DTYPES = {"f32": np.float32, "f64": np.float64}


def main() -> None:
    parser = argparse.ArgumentParser(description="Answers lightmeter's formulas by numpy")
    parser.add_argument("--dtype", choices=DTYPES, default="f32", help="the type of all arithmetic")
    parser.add_argument("--pack", nargs=2, metavar=("PACK", "ANSWERS"), help="answer a pack of columns by a folder")
    arguments = parser.parse_args()
    name = arguments.dtype
    renderer = Renderer(f"numpy-{name}", np.__version__)
    for formula, function in FORMULAS.items():
        renderer.formula(formula, DTYPES[name])(function)
    for pattern in blend.STATES:
        renderer.formulas(pattern, blend.by_state, DTYPES[name])
    if arguments.pack:
        renderer.answer_pack(*arguments.pack)
    else:
        renderer.serve()


if __name__ == "__main__":
    main()
