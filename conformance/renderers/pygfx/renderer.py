#!/usr/bin/env python3
"""pygfx on wgpu, as a renderer that speaks lightmeter.protocol/1."""
import sys
from pathlib import Path

here = Path(__file__).resolve().parent
sys.path.insert(0, str(here.parents[2] / "clients/python"))

import pygfx as gfx
from blending import DECLARED, Blending
from lightmeter_client import Renderer
from raster import Raster
from scenes import EFFECTS, NO_POLYNOMIAL, draw
from surfaces import Surfaces

info = gfx.renderers.wgpu.get_shared().adapter.info
blending = Blending()
functions = {**Surfaces(blending).functions, **Raster(blending.places).functions}
renderer = Renderer(
    "pygfx",
    gfx.__version__,
    device=info["device"],
    driver=info["description"],
    profile="opengl",
    formulas=[*functions, *DECLARED],
    effects=EFFECTS,
    skips=[
        {"id": "depth/test", "reason": "depth is not clamped: what lies before the near or behind the far plane is not drawn"},
        {"id": "vector/normal-by-determinant/boundary", "reason": "the matrix flattens the triangle that shows the normal"},
        *({"id": f"scene/{name}", "reason": NO_POLYNOMIAL} for name in ("attached-lights", "many-points")),
        {"id": "scene/viewer", "reason": "the viewer is local, but with an orthographic camera"},
    ],
)
renderer.batches({**functions, **blending.functions})
renderer.scene("scene")(draw)
renderer.serve()
