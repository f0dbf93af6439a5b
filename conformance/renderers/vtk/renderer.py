#!/usr/bin/env python3
"""VTK, off-screen on Mesa's llvmpipe, as a renderer that speaks lightmeter.protocol/1."""
import sys
from pathlib import Path

here = Path(__file__).resolve().parent
sys.path.insert(0, str(here.parents[2] / "clients/python"))

from blending import Blending
from lightmeter_client import Renderer
from scenes import EFFECTS, draw
from stage import capabilities
from surfaces import Surfaces
from vtkmodules.vtkCommonCore import vtkVersion

opengl = capabilities()
renderer = Renderer(
    "vtk",
    vtkVersion.GetVTKVersion(),
    device=opengl["OpenGL renderer string"],
    driver=opengl["OpenGL version string"],
    profile="opengl",
    effects=EFFECTS,
    skips=[
        {"id": "lighting", "reason": "the specular power is 128 at most, a spotlight's cone is narrower than 90 degrees and its exponent 128 at most"},
        {"id": "attenuation/spot-*", "reason": "a spotlight's cone is narrower than 90 degrees and its exponent 128 at most"},
        {"id": "blend", "reason": "a fragment whose alpha is 0 or less is not drawn, and VTK's state sets no constant to blend by"},
        {"id": "depth/test", "reason": "the clip space of VTK, from -1 to 1, does not hold every depth between 0 and 1"},
        {"id": "scene", "reason": "no viewer at infinity, normals by the inverse transpose alone, no cone as wide as 90 degrees, no ambient light that weakens, no constant to blend by, no colours of vertices that are lit"},
    ],
)
renderer.batches({**Surfaces().functions, **Blending().functions})
renderer.scene("scene")(draw)
renderer.serve()
