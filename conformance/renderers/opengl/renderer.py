#!/usr/bin/env python3
"""OpenGL's fixed-function pipeline, Mesa's compatibility profile, as a renderer that speaks lightmeter.protocol/1."""
import sys
from pathlib import Path

here = Path(__file__).resolve().parent
sys.path[:0] = [str(here.parent / "common"), str(here.parents[2] / "clients/python")]

import context
from lightmeter_client import Renderer
from raster import Raster
from scenes import EFFECTS, draw
from stages import Stages
from surfaces import Surfaces

version, device = context.create()
renderer = Renderer(
    "opengl-fixed-function",
    version,
    device=device,
    driver=f"Mesa {version}",
    profile="opengl",
    effects=EFFECTS,
    skips=[
        {"id": "lighting", "reason": "GL_SHININESS and GL_SPOT_EXPONENT are 128 at most, GL_SPOT_CUTOFF is 90 degrees at most, and a triangle without area draws nothing"},
        {"id": "attenuation/spot-*", "reason": "GL_SPOT_CUTOFF is 90 degrees at most, GL_SPOT_EXPONENT 128"},
        {"id": "fog", "reason": "GL_FOG_DENSITY is 0 at least"},
        {"id": "interpolation", "reason": "what has no area or lies outside of the clip volume draws nothing"},
        {"id": "scene", "reason": "no more than 8 lights, no lit colours times vertex colours, normals by the inverse transpose alone"},
    ],
)
renderer.batches({**Surfaces().functions, **Raster().functions, **Stages().functions})
renderer.scene("scene")(draw)
renderer.serve()
