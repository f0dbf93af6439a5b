"""Lighting, attenuation, textures and normals by pygfx's materials."""
import math

import numpy as np
import pygfx as gfx
from lightmeter_client import Skip
from stage import REPLACE, Camera, Stage, directional, linear, mesh, point, scene_of, spot, unlit

PI = math.pi
BLACK, WHITE, WHITE_WITH_ALPHA = (0, 0, 0), (1, 1, 1), (1, 1, 1, 1)
PRIMARIES = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
CORNERS = np.array([[-1, -1, 0], [3, -1, 0], [-1, 3, 0]], np.float64)
AHEAD = np.array([0, 0, 1], np.float32)
BEFORE = np.array([0, 0, -1], np.float32)
# An element of a projection that makes it no orthographic one for pygfx, and is nothing beside 1.
PERSPECTIVE = 1e-30


LIT = {"alpha_config": REPLACE, "color_mode": "vertex", "side": "both", "depth_test": False, "depth_write": False}


def texture(texels, colorspace="physical"):
    """A texture of one row."""
    data = np.array(texels, np.float32).reshape(1, -1, 4)
    return gfx.TextureMap(gfx.Texture(data, dim=2, colorspace=colorspace), filter="nearest", wrap="clamp")


def matte():
    """A material without a highlight, by a map of none: one whose specular colour is black has one."""
    return gfx.MeshPhongMaterial(specular_map=texture([0, 0, 0, 0]), **LIT)


def shiny():
    material = gfx.MeshPhongMaterial(**LIT)
    # 1 by its documentation, 0 in fact.
    material.emissive_intensity = 1
    return material


def place(light, position):
    light.local.position = np.float64(position)


class Primaries:
    """A linear colour of light as three lights of sRGB's primaries, of which nothing is decoded but 0 and 1."""

    def __init__(self, make):
        self.lights = [make(primary) for primary in PRIMARIES]

    def set(self, rgb, position=None):
        for light, x in zip(self.lights, rgb):
            light.intensity = PI * float(x)
            if position is not None:
                place(light, position)


class Triangle:
    """A triangle that covers the only pixel and has a point in its middle."""

    def __init__(self, material, normal=AHEAD, p=BEFORE):
        self.material = material
        self.mesh = mesh(CORNERS, WHITE_WITH_ALPHA, material, texcoords=np.full((3, 2), 0.5, np.float32))
        self.camera = Camera()
        self.set(WHITE, normal, p)

    def set(self, color, normal=AHEAD, p=BEFORE):
        geometry = self.mesh.geometry
        # How far it reaches: little beside the point.
        largest = float(np.max(np.abs(p)))
        spread = 2.0 ** (math.frexp(largest)[1] - 7) if largest > 0 else 2.0**-7
        geometry.positions.data[:] = np.float64(p) + CORNERS * spread
        geometry.normals.data[:] = normal
        geometry.colors.data[:, : len(color)] = color
        for buffer in (geometry.positions, geometry.normals, geometry.colors):
            buffer.update_full()
        p, scale = np.float64(p), 1 / spread
        self.camera.set(
            [[scale, 0, 0, -p[0] * scale], [0, scale, 0, -p[1] * scale], [0, 0, 0, 0], [0, 0, PERSPECTIVE, 1]]
        )


class Surfaces:
    def __init__(self, blending):
        # Always the same pixel, so that the rasteriser's rounding is the same wherever a case stands among others.
        self.stage = Stage(1, 1)
        self.blending = blending
        self.functions = {
            "lighting/ambient": self.each(self.ambient, 3),
            "lighting/ambient-constant": self.each(self.ambient_constant, 3),
            "lighting/diffuse-toward": self.each(lambda: self.diffuse(lambda c: c.l), 3),
            "lighting/diffuse-travel": self.each(lambda: self.diffuse(lambda c: -c.i), 3),
            "lighting/specular-blinn": self.each(self.highlight, 3),
            "lighting/blinn": self.each(self.blinn, 4),
            "lighting/two-lights": self.each(self.two_lights, 4),
            "attenuation/constant": self.each(lambda: self.weakened(0), 1),
            "attenuation/linear": self.each(lambda: self.weakened(1), 1),
            "attenuation/square": self.each(lambda: self.weakened(2), 1),
            "attenuation/spot-cutoff": self.each(self.in_cone, 1),
            "vector/normalize": lambda cases: self.normals(cases, cases.v),
            "vector/normal-by-determinant": lambda cases: self.normals(cases, cases.n),
            "color/uniform": self.each(self.uniform, 4),
            "color/modulate": lambda cases: self.textured(cases.color, cases.texel, "auto"),
            "color/replace": lambda cases: self.textured(cases.color, cases.texel, "vertex_map"),
            "color/srgb-decode": lambda cases: self.textured(cases.e, cases.e, "vertex_map", "srgb"),
        }

    def draw(self, scene, camera):
        self.stage.begin()
        self.stage.draw(scene, camera)
        return self.stage.read()[0, 0]

    def each(self, prepare, outputs):
        """A function of cases that draws each: `prepare` makes a triangle, lights, and what sets them as a case has them."""

        def function(cases):
            triangle, lights, update = prepare()
            scene = scene_of(triangle.mesh, *lights)
            values = []
            for k in range(cases.total):
                update(cases.case(k))
                values.append(self.draw(scene, triangle.camera)[:outputs])
            return values

        return function

    def ambient(self):
        triangle, light = Triangle(matte()), Primaries(gfx.AmbientLight)

        def update(c):
            triangle.set(c.ma)
            light.set(c.la)

        return triangle, light.lights, update

    def ambient_constant(self):
        triangle, ambient, light = Triangle(matte()), Primaries(gfx.AmbientLight), Primaries(lambda rgb: directional(AHEAD, rgb))

        def update(c):
            ambient.set(c.ambient)
            light.set(c.diffuse)

        return triangle, [*ambient.lights, *light.lights], update

    def diffuse(self, toward):
        triangle, light = Triangle(matte()), Primaries(lambda rgb: directional(AHEAD, rgb))

        def update(c):
            triangle.set(c.md, c.n)
            light.set(c.ld, toward(c))

        return triangle, light.lights, update

    def set_phong(self, material, specular, shininess, emissive=BLACK):
        material.specular = linear(specular)
        material.emissive = linear(emissive)
        material.shininess = shininess

    def highlight(self):
        triangle, light = Triangle(shiny()), Primaries(lambda rgb: directional(AHEAD, rgb))

        def update(c):
            # Light and eye in the direction h: the halfway vector between them is h.
            triangle.set(BLACK, c.n, -c.h)
            light.set(c.ls, c.h)
            self.set_phong(triangle.material, c.ms, c.shininess)

        return triangle, light.lights, update

    def blinn(self):
        triangle, light = Triangle(shiny()), directional(AHEAD)

        def update(c):
            # One light has one colour, and the material no ambient one: products are formed beforehand.
            triangle.set(c.ld * c.md, c.normal, c.p)
            place(light, -c.direction)
            self.set_phong(triangle.material, c.ls * c.ms, c.shininess, c.la * c.ma)

        return triangle, [light], update

    def two_lights(self):
        triangle = Triangle(shiny())
        far, near = Primaries(lambda rgb: directional(AHEAD, rgb)), Primaries(lambda rgb: point(AHEAD, rgb))

        def update(c):
            triangle.set(c.diffuse, c.normal, c.p)
            far.set(c.color0[:3], c.direction)
            near.set(c.color1[:3], c.position)
            self.set_phong(triangle.material, c.specular[:3], c.shininess, c.ambient[:3])

        return triangle, [*far.lights, *near.lights], update

    def weakened(self, decay):
        triangle, light = Triangle(matte(), p=np.zeros(3)), point(AHEAD, WHITE, decay)
        return triangle, [light], lambda c: place(light, AHEAD * c.d)

    def in_cone(self):
        # The light ahead of a surface at the origin of which the cone is tested, turned so that it stands at l.
        triangle, light = Triangle(matte()), spot(AHEAD, AHEAD, 0)

        def update(c):
            triangle.set(WHITE, c.l, np.zeros(3))
            place(light, c.l)
            place(light.target, np.float64(c.l) + np.float64(c.axis))
            light.angle = math.acos(max(-1, min(1, c.cutoff_cosine)))

        return triangle, [light], update

    def normals(self, cases, normals):
        """A normal in eye space, read as the diffuse light of three lights along the axes, and of three opposite ones."""
        one, camera = mesh(np.eye(3), WHITE, matte(), texcoords=np.zeros((3, 2), np.float32)), Camera()
        one.local.state_basis = "matrix"
        sides = []
        for sign in (1, -1):
            scene = scene_of(one, *(directional(sign * np.array(axis), axis) for axis in PRIMARIES))
            values = []
            for k in range(cases.total):
                one.geometry.normals.data[:] = normals[k]
                one.geometry.normals.update_full()
                if hasattr(cases, "modelview"):
                    self.transform(one, camera, np.float64(cases.modelview[k].reshape(3, 3).T))
                else:
                    self.transform(one, camera, np.eye(3))
                values.append(self.draw(scene, camera)[:3])
            sides.append(np.array(values))
        sums = sides[0] - sides[1]
        if not hasattr(cases, "modelview"):
            return sums
        flat = np.linalg.cond(cases.modelview.reshape(-1, 3, 3).astype(np.float64)) > 2**24
        edge_on = Skip("the matrix flattens the triangle that shows the normal: f32 holds no digit of its third dimension")
        return [edge_on if flat[k] else total for k, total in enumerate(sums)]

    def transform(self, one, camera, matrix):
        """Puts a mesh under a matrix, and turns the camera to its front wherever that has come to be."""
        model = np.eye(4)
        model[:3, :3] = matrix
        one.local.matrix = model
        # pygfx turns the faces of what is mirrored round, so that they run as they did.
        corners = np.vstack([CORNERS.T, np.ones(3)])[:, :: 1 if np.linalg.det(matrix) >= 0 else -1]
        projection = np.zeros((4, 4))
        projection[:, :3] = corners @ np.linalg.pinv(matrix)
        camera.set(projection)

    def uniform(self):
        triangle = Triangle(unlit(color_mode="uniform"))

        def update(c):
            triangle.material.color = linear(c.color)

        return triangle, [], update

    def textured(self, colors, texels, color_mode, colorspace="physical"):
        """A texel a case, all of them a frame."""
        material = unlit(color_mode=color_mode, map=texture(texels, colorspace))
        places = np.repeat((np.arange(len(texels)) + 0.5) / len(texels), 3)
        texcoords = np.stack([places, np.full_like(places, 0.5)], 1).astype(np.float32)
        return self.blending.draw(len(texels), [self.blending.triangles(colors, material, texcoords=texcoords)])
