#!/usr/bin/env python3
"""The documents' GLSL programs, in words of this project's own, as a renderer that speaks lightmeter.protocol/1."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "common"))

import context
from protocol import serve

version = context.create()

from formulas import Formulas, Raster
from scenes import EFFECTS, draw

hello = {
    "renderer": "documents-glsl",
    "version": version,
    "profile": "opengl",
    "scenes": ["scene"],
    "effects": EFFECTS,
}
serve(hello, {**Formulas().functions, **Raster().functions}, draw)
