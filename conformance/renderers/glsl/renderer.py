#!/usr/bin/env python3
"""The documents' GLSL programs, in words of this project's own, as a renderer that speaks lightmeter.protocol/1."""
import sys
from pathlib import Path

here = Path(__file__).resolve().parent
sys.path[:0] = [str(here.parent / "common"), str(here.parents[2] / "clients/python")]

import context
from lightmeter_client import Renderer, digest

version, device = context.create()

from formulas import Formulas, Raster
from scenes import EFFECTS, draw

renderer = Renderer(
    "documents-glsl",
    version,
    device=device,
    driver=f"Mesa {version}",
    build=digest("library.glsl", "lighting.glsl", "scene.vert", "scene.frag"),
    profile="opengl",
    effects=EFFECTS,
)
renderer.batches({**Formulas().functions, **Raster().functions})
renderer.scene("scene")(draw)
renderer.serve()
