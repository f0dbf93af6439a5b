"""Lighting, attenuation, colours and normals by VTK's own shaders: a vertex a case, drawn as a point into a pixel of its own."""
import math

import numpy as np
from lightmeter_client import Skip
from stage import (
    GL_BLEND,
    TO_THE_MIDDLE,
    Target,
    directional,
    make_actor,
    make_texture,
    matrix,
    polygons,
    positional,
    render,
    renderer,
    set_projection,
    state,
    vectors,
)

SIDE = 64
BLACK, WHITE = (0, 0, 0), (1, 1, 1)
# Before the eye, so that there is a way towards it.
BEFORE = np.array([0, 0, -1], np.float32)
AHEAD = np.array([0, 0, 1], np.float32)
HIGHEST_POWER = 128


def set_cone(light, cutoff_cosine, exponent):
    angle = math.degrees(math.acos(min(max(float(cutoff_cosine), -1), 1)))
    if np.float32(angle) >= 90:
        raise Skip("a cone angle of 90 degrees or more is no cone in VTK")
    if exponent > HIGHEST_POWER:
        raise Skip("the exponent of a light is 128 at most")
    light.SetConeAngle(angle)
    light.SetExponent(float(exponent))


def set_material(of, ambient=BLACK, diffuse=BLACK, specular=BLACK, shininess=1, opacity=1):
    """Colours with coefficients of 1. VTK clamps coefficients to 1, colours not."""
    if shininess > HIGHEST_POWER:
        raise Skip("the specular power of a property is 128 at most")
    of.SetAmbient(1)
    of.SetDiffuse(1)
    of.SetSpecular(1)
    of.SetAmbientColor(*map(float, ambient))
    of.SetDiffuseColor(*map(float, diffuse))
    of.SetSpecularColor(*map(float, specular))
    of.SetSpecularPower(float(shininess))
    of.SetOpacity(float(opacity))


class Surfaces:
    def __init__(self):
        self.target = Target(SIDE, SIDE)
        self.data = polygons([BEFORE])
        self.actor = make_actor(self.data)
        self.property = self.actor.GetProperty()
        lit = self.each
        self.functions = {
            "lighting/ambient-constant": lit(self.ambient_constant),
            "lighting/diffuse-toward": lit(lambda c: self.diffuse(c, -c.l)),
            "lighting/diffuse-travel": lit(lambda c: self.diffuse(c, c.i)),
            "lighting/phong": lit(lambda c: self.phong(c, directional(c.direction)), outputs=4),
            "lighting/phong-gated": lit(lambda c: self.phong(c, directional(c.direction)), outputs=4),
            "lighting/point-phong": lit(lambda c: self.phong(c, positional(c.position, WHITE, (c.kc, c.kl, c.kq))), outputs=4),
            "lighting/spot": lit(self.spot, outputs=4),
            "lighting/scalar-material": lit(self.scalar_material, outputs=4),
            "attenuation/polynomial": lit(lambda c: self.weakened(c, (c.kc, c.kl, c.kq)), outputs=1),
            "attenuation/constant": lit(lambda c: self.weakened(c, (1, 0, 0)), outputs=1),
            "attenuation/linear": lit(lambda c: self.weakened(c, (0, 1, 0)), outputs=1),
            "attenuation/square": lit(lambda c: self.weakened(c, (0, 0, 1)), outputs=1),
            "attenuation/point": lit(self.weakened_between, outputs=1),
            "attenuation/spot-cutoff": lit(lambda c: self.in_cone(c, 0), outputs=1),
            "attenuation/spot-exponent": lit(lambda c: self.in_cone(c, c.exponent), outputs=1),
            "vector/normalize": lambda cases: self.normals(cases, cases.v),
            "vector/normal-by-determinant": lambda cases: self.normals(cases, cases.n),
            "color/uniform": lit(self.uniform, outputs=4),
            "color/modulate": self.modulate,
        }

    def begin(self):
        self.target.clear()
        set_projection(TO_THE_MIDDLE)
        self.actor.SetUserMatrix(None)
        self.property.SetLighting(True)

    def place(self, k):
        x, y = k % SIDE, k // SIDE
        renderer.SetViewport(x / SIDE, y / SIDE, (x + 1) / SIDE, (y + 1) / SIDE)

    def point(self, p, normal, *lights):
        self.data.GetPoints().SetData(vectors([p]))
        self.data.GetPointData().SetNormals(vectors([normal]))
        self.data.Modified()
        render([self.actor], lights)

    def each(self, draw, outputs=3):
        """A function of cases that draws each: `draw` takes a case, with its inputs as fields."""

        def function(cases):
            self.begin()
            skipped = {}
            for k in range(cases.total):
                self.place(k)
                try:
                    draw(cases.case(k))
                except Skip as skip:
                    skipped[k] = skip
            values = self.target.read().reshape(-1, 4)[: cases.total, :outputs]
            return [skipped.get(k, value) for k, value in enumerate(values)]

        return function

    def ambient_constant(self, c):
        set_material(self.property, c.ambient, c.diffuse)
        self.point(BEFORE, AHEAD, directional(-AHEAD))

    def diffuse(self, c, travel):
        set_material(self.property, diffuse=c.md)
        self.point(BEFORE, c.n, directional(travel, c.ld))

    def phong(self, c, light):
        """VTK has one colour of a light for both terms: it is white, and the material has the products."""
        set_material(self.property, c.la * c.ma, c.ld * c.md, c.ls * c.ms, c.shininess)
        self.point(c.p, c.normal, light)

    def spot(self, c):
        light = positional(c.position, WHITE, (c.kc, c.kl, c.kq), c.axis)
        set_cone(light, c.cutoff_cosine, c.exponent)
        self.phong(c, light)

    def scalar_material(self, c):
        set_material(self.property, c.ambient_color, WHITE, WHITE, c.shininess)
        self.property.SetAmbient(float(c.ka))
        self.property.SetDiffuse(float(c.kd))
        self.property.SetSpecular(float(c.ks))
        self.point(c.p, c.normal, positional(c.position, c.light_color))

    def strength(self, p, light):
        """How strong a light is at a point that faces it: a highlight of power 0 is its strength and no more."""
        set_material(self.property, specular=WHITE, shininess=0)
        self.point(p, np.float32(light.GetPosition()) - p, light)

    def weakened(self, c, falloff):
        # To the side, so that the distance is exact.
        self.strength(BEFORE, positional(BEFORE + [c.d, 0, 0], WHITE, falloff))

    def weakened_between(self, c):
        self.strength(c.p, positional(c.light, WHITE, (c.kc, c.kl, c.kq)))

    def in_cone(self, c, exponent):
        light = positional(c.l, axis=c.axis)
        set_cone(light, c.cutoff_cosine, exponent)
        self.strength(np.zeros(3, np.float32), light)

    def normals(self, cases, normals):
        """A normal in eye space, read as the diffuse light of three lights along the axes, and of three opposite ones."""
        set_material(self.property, diffuse=WHITE)
        sides = []
        for sign in (1, -1):
            self.begin()
            lights = [directional(-sign * axis, axis) for axis in np.eye(3)]
            for k in range(cases.total):
                if hasattr(cases, "modelview"):
                    rows = np.eye(4)
                    rows[:3, :3] = cases.modelview[k].reshape(3, 3).T
                    self.actor.SetUserMatrix(matrix(rows))
                self.place(k)
                self.point(BEFORE, normals[k], *lights)
            sides.append(self.target.read().reshape(-1, 4)[: cases.total, :3])
        self.actor.SetUserMatrix(None)
        return sides[0] - sides[1]

    def uniform(self, c):
        self.property.SetLighting(False)
        set_material(self.property, diffuse=c.color)
        self.point(BEFORE, AHEAD)

    def modulate(self, cases):
        """A triangle that covers its pixel: VTK puts no textures on points."""
        self.begin()
        set_projection(np.eye(4))
        data = polygons([[-1, -1, 0], [3, -1, 0], [-1, 3, 0]], [[0, 1, 2]])
        data.GetPointData().SetTCoords(vectors([[0, 0], [2, 0], [0, 2]]))
        actor = make_actor(data, lambda: state.vtkglDisable(GL_BLEND))
        actor.GetProperty().SetLighting(False)
        for k in range(cases.total):
            self.place(k)
            set_material(actor.GetProperty(), diffuse=cases.color[k][:3], opacity=cases.color[k][3])
            actor.SetTexture(make_texture(cases.texel[k].reshape(1, 1, 4)))
            render([actor])
        return self.target.read().reshape(-1, 4)[: cases.total]
