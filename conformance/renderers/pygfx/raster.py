"""What only a rasteriser can answer, drawn 256 pixels square and looked at in one pixel; the depth test; and stored bytes."""
import numpy as np
from lightmeter_client import Skip
from stage import Camera, Stage, mesh, scene_of, unlit

# pygfx has no "never".
COMPARES = {"less": "<", "less-equal": "<=", "equal": "==", "not-equal": "!=", "greater-equal": ">=", "greater": ">"}
ADD = {"method": "blended", "color_src": "one", "color_dst": "one", "alpha_src": "one", "alpha_dst": "one"}


def tested(compare, write):
    """Settings of a depth test."""
    if compare == "always":
        return {"depth_test": False, "depth_write": write}
    return {"depth_test": True, "depth_compare": COMPARES[compare], "depth_write": write}


def gray(x):
    return np.repeat(np.atleast_1d(np.float32(x))[:, None], 4, axis=1)


class Raster:
    def __init__(self, places):
        self.places = places
        self.stage, self.small, self.bytes = Stage(256, 256), Stage(), Stage(format="rgba8unorm")
        self.camera, self.still = Camera(), Camera()
        compares = [*COMPARES, "always"]
        self.functions = {
            "interpolation/raster-attributes": self.attributes,
            "interpolation/raster-clip": lambda cases: self.drawn(cases, "both"),
            "interpolation/raster-facing": lambda cases: self.drawn(cases, "front"),
            "interpolation/cull-back-ccw": lambda cases: self.drawn(cases, "front"),
            "interpolation/cull-front-ccw": lambda cases: self.drawn(cases, "back"),
            "interpolation/raster-top-left": self.quad,
            "interpolation/raster-shared-edge": self.quad,
            **{f"depth/same-geometry-{compare}": self.again for compare in compares},
            **{f"depth/test/{compare}/*": self.depth_test for compare in compares},
            "color/to-unorm8": self.to_unorm8,
        }

    def pixels(self, cases, build):
        """The red of the pixel of each case, drawn by itself: `build` makes meshes and the camera."""
        values = []
        for k in range(cases.total):
            case = cases.case(k)
            meshes, camera = build(case)
            self.stage.begin()
            self.stage.draw(scene_of(*meshes), camera)
            values.append(self.stage.read(rect=(*map(int, case.pixel), 1, 1))[0, 0, :1])
        return np.array(values)

    def triangle(self, c, colors, materials, divided=False):
        """A triangle of clip coordinates, drawn once with each material: its vertices are the unit vectors, which the projection
        takes there."""
        corners = [c.a, c.b, c.c]
        if divided:
            corners = [corner / corner[3] for corner in corners]
        projection = np.zeros((4, 4))
        projection[:, :3] = np.float64(corners).T
        self.camera.set(projection)
        return [mesh(np.eye(3), color, material) for color, material in zip(colors, materials)], self.camera

    def attributes(self, cases):
        """Perspective-correct, and linear: the same with the vertices divided by w beforehand."""
        sides = [
            self.pixels(cases, lambda c: self.triangle(c, [gray(c.attr)], [unlit()], divided))[:, 0] for divided in (False, True)
        ]
        return np.stack(sides, 1)

    def drawn(self, cases, side):
        # One colour of the material: what is interpolated between equal values may differ from them in its last bit.
        return self.pixels(cases, lambda c: self.triangle(c, [gray(1)], [unlit(color_mode="uniform", side=side)]))

    def quad(self, cases):
        """Two triangles, counted by adding."""

        def build(c):
            corners = [[v[0] / 128 - 1, 1 - v[1] / 128, 0] for v in (c.a, c.b, c.c, c.d)]
            return [mesh(corners, gray(1), unlit(ADD), triangles=[[0, 1, 2], [0, 2, 3]])], self.still

        return self.pixels(cases, build)

    def again(self, cases):
        """White, and white once more that is added to it."""
        compare = cases.formula.removeprefix("depth/same-geometry-")
        first = unlit(color_mode="uniform", **tested("always", True))
        second = unlit(ADD, color_mode="uniform", **tested(compare, True))
        return self.pixels(cases, lambda c: self.triangle(c, [gray(1), gray(1)], [first, second]))

    def at(self, depths, color, material):
        """A triangle a case, at its depth."""
        places = self.places[: len(depths)].copy()
        places[..., 2] = depths[:, None]
        return mesh(places.reshape(-1, 3), gray(color), material)

    def depth_test(self, cases):
        _, _, compare, write = cases.formula.split("/")
        old = self.at(cases.old, 1, unlit(**tested("always", True)))
        new = self.at(cases.new, 2, unlit(**tested(compare, write == "write")))
        self.small.begin()
        self.small.draw(scene_of(old, new), self.still)
        seen = self.small.colors(cases.total)[:, 0]
        left = self.small.read("depth").reshape(-1)[: cases.total]
        beyond = (np.minimum(cases.old, cases.new) < 0) | (np.maximum(cases.old, cases.new) > 1)
        clipped = Skip("depth is not clamped: what lies before the near or behind the far plane is not drawn")
        return [clipped if out else pair for out, pair in zip(beyond, np.stack([seen, left], 1))]

    def to_unorm8(self, cases):
        places = self.places[: cases.total].reshape(-1, 3)
        self.bytes.begin()
        self.bytes.draw(scene_of(mesh(places, np.repeat(gray(cases.c), 3, axis=0), unlit())), self.still)
        return self.bytes.colors(cases.total)[:, :1]
