#!/usr/bin/env python3
"""OpenGL's fixed-function pipeline, Mesa's compatibility profile, as a renderer that speaks lightmeter.protocol/1."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "common"))

import context
from protocol import serve
from raster import Raster
from scenes import EFFECTS, draw
from stages import Stages
from surfaces import Surfaces

version = context.create()
functions = {**Surfaces().functions, **Raster().functions, **Stages().functions}
hello = {
    "renderer": "opengl-fixed-function",
    "version": version,
    "profile": "opengl",
    "scenes": ["scene"],
    "effects": EFFECTS,
}
serve(hello, functions, draw)
