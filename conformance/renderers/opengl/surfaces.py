"""Lighting, attenuation, fog and normals by the fixed function: a vertex a case, drawn as a point into a pixel of its own."""
import math

import numpy as np
from context import Target
from OpenGL.GL import *
from lightmeter_client import Skip

SIDE = 64
# Every vertex to the middle of the viewport, wherever it is in eye space: lights and fog do not look at it.
TO_THE_MIDDLE = np.diag([0, 0, 0, 1]).astype(np.float32)
BLACK = np.zeros(3, np.float32)
WHITE = np.ones(3, np.float32)
ORIGIN = BLACK
AHEAD = np.array([0, 0, 1], np.float32)
NO_FALLOFF = (1, 0, 0)
# NV_fog_distance.
FOG_DISTANCE_MODE, EYE_RADIAL, EYE_PLANE_ABSOLUTE = 0x855A, 0x855B, 0x855C


def four(rgb, last=1):
    return np.append(rgb, last).astype(np.float32)


def set_fog_color(color):
    """Sets the fog's colour. Mesa compares it with the earlier one *clamped* to [0, 1] and leaves that where they are equal, although it
    draws by the unclamped one (_mesa_Fogfv, TEST_EQ_4V(ctx->Fog.Color, params)): black after a negative colour, or white after one above
    1, changes nothing. So a grey is set first, which is the same clamped and unclamped."""
    glFogfv(GL_FOG_COLOR, four((0.5, 0.5, 0.5), 0.5))
    glFogfv(GL_FOG_COLOR, four(color))


def light(number, place, ambient=BLACK, diffuse=BLACK, specular=BLACK, falloff=NO_FALLOFF):
    """A light at `place`, which is a direction towards it where its fourth component is 0."""
    name = GL_LIGHT0 + number
    glEnable(name)
    glLightfv(name, GL_POSITION, place)
    for term, color in ((GL_AMBIENT, ambient), (GL_DIFFUSE, diffuse), (GL_SPECULAR, specular)):
        glLightfv(name, term, four(color))
    for term, value in zip((GL_CONSTANT_ATTENUATION, GL_LINEAR_ATTENUATION, GL_QUADRATIC_ATTENUATION), falloff):
        glLightf(name, term, value)
    glLightf(name, GL_SPOT_CUTOFF, 180)


def cone(number, axis, cutoff_cosine, exponent):
    """Makes a light a spotlight."""
    if cutoff_cosine < 0:
        raise Skip("GL_SPOT_CUTOFF is an angle of 90 degrees at most")
    if exponent > 128:
        raise Skip("GL_SPOT_EXPONENT is 128 at most")
    name = GL_LIGHT0 + number
    glLightfv(name, GL_SPOT_DIRECTION, axis)
    glLightf(name, GL_SPOT_CUTOFF, math.degrees(math.acos(min(cutoff_cosine, 1))))
    glLightf(name, GL_SPOT_EXPONENT, exponent)


def material(ambient=BLACK, diffuse=BLACK, specular=BLACK, shininess=0, emissive=BLACK, alpha=1):
    if shininess > 128:
        raise Skip("GL_SHININESS is 128 at most")
    for term, color in ((GL_AMBIENT, ambient), (GL_SPECULAR, specular), (GL_EMISSION, emissive)):
        glMaterialfv(GL_FRONT_AND_BACK, term, four(color))
    glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, four(diffuse, alpha))
    glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, shininess)


def scene_ambient(color):
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, four(color))


def lights_off():
    for number in range(8):
        glDisable(GL_LIGHT0 + number)
    scene_ambient(BLACK)


def point(p, normal):
    glBegin(GL_POINTS)
    glNormal3fv(normal)
    glVertex3fv(p)
    glEnd()


def head_on(case_diffuse, case_specular=BLACK, number=0):
    """A light whose incidence and highlight are 1 on a surface at the origin that faces it and the eye."""
    light(number, four(AHEAD, 0), diffuse=case_diffuse, specular=case_specular)


def face_normal(a, b, c):
    normal = np.cross(np.float64(b) - a, np.float64(c) - a)
    length = np.linalg.norm(normal)
    return (normal / length if length > 0 else normal).astype(np.float32)


class Surfaces:
    def __init__(self):
        self.target = Target(SIDE, SIDE)
        lit, directional, point_light = self.each, self.directional, self.point_light
        self.functions = {
            "lighting/ambient": lit(self.ambient),
            "lighting/ambient-constant": lit(self.ambient_constant),
            "lighting/diffuse-toward": lit(lambda c: self.diffuse(c, c.l)),
            "lighting/diffuse-travel": lit(lambda c: self.diffuse(c, -c.i)),
            "lighting/specular-blinn": lit(self.highlight),
            "lighting/cosine-power": lit(self.cosine_power, outputs=1),
            "lighting/blinn": lit(directional, normalize=True, outputs=4),
            "lighting/blinn-stable": lit(directional, normalize=True, outputs=4),
            "lighting/point-blinn": lit(lambda c: point_light(c, False), normalize=True, outputs=4),
            "lighting/point-opengl": lit(lambda c: point_light(c, True), normalize=True, outputs=4),
            "lighting/spot": lit(self.spot, normalize=True, outputs=4),
            "lighting/two-lights": lit(self.two_lights, normalize=True, outputs=4),
            "lighting/sum": lit(self.sum),
            "lighting/gouraud": self.gouraud,
            "lighting/flat": lit(self.flat, outputs=1),
            "attenuation/polynomial": lit(lambda c: self.weakened(c, (c.kc, c.kl, c.kq)), outputs=1),
            "attenuation/constant": lit(lambda c: self.weakened(c, (1, 0, 0)), outputs=1),
            "attenuation/linear": lit(lambda c: self.weakened(c, (0, 1, 0)), outputs=1),
            "attenuation/square": lit(lambda c: self.weakened(c, (0, 0, 1)), outputs=1),
            "attenuation/point": lit(self.weakened_between, outputs=1),
            "attenuation/spot-cutoff": lit(lambda c: self.in_cone(c, 0), outputs=1),
            "attenuation/spot-exponent": lit(lambda c: self.in_cone(c, c.exponent), outputs=1),
            "vector/normalize": lambda cases: self.normals(cases, cases.v, True),
            "vector/normal-inverse-transpose": lambda cases: self.normals(cases, cases.n, False),
            "vector/normal-by-determinant": lambda cases: self.normals(cases, cases.n, True),
            "fog/linear": self.fog,
            "fog/linear-radial": self.fog,
            "fog/linear-multiply-add": self.fog,
            "fog/exp": self.fog,
            "fog/exp-radial": self.fog,
            "fog/exp2-opengl": self.fog,
            "fog/exp2-opengl-radial": self.fog,
        }

    def begin(self):
        self.target.bind()
        self.target.clear()
        glMatrixMode(GL_PROJECTION)
        glLoadMatrixf(TO_THE_MIDDLE)
        glMatrixMode(GL_MODELVIEW)
        glLoadIdentity()
        glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, GL_TRUE)

    def place(self, k):
        glViewport(k % SIDE, k // SIDE, 1, 1)

    def read(self, count):
        return self.target.read().reshape(-1, 4)[:count]

    def each(self, draw, normalize=False, outputs=3):
        """A function of cases that draws each lit: `draw` takes a case, with its inputs as fields."""

        def function(cases):
            self.begin()
            glEnable(GL_LIGHTING)
            (glEnable if normalize else glDisable)(GL_NORMALIZE)
            skipped = {}
            for k in range(cases.total):
                lights_off()
                self.place(k)
                try:
                    draw(cases.case(k))
                except Skip as skip:
                    skipped[k] = skip
            glDisable(GL_LIGHTING)
            values = self.read(cases.total)[:, :outputs]
            return [skipped.get(k, value) for k, value in enumerate(values)]

        return function

    def ambient(self, c):
        scene_ambient(c.la)
        material(ambient=c.ma)
        point(ORIGIN, AHEAD)

    def ambient_constant(self, c):
        head_on(c.diffuse)
        material(diffuse=WHITE, emissive=c.ambient)
        point(ORIGIN, AHEAD)

    def diffuse(self, c, toward):
        light(0, four(toward, 0), diffuse=c.ld)
        material(diffuse=c.md)
        point(ORIGIN, c.n)

    def highlight(self, c):
        # Light and eye in the direction h: the halfway vector between them is h.
        light(0, four(c.h, 0), specular=c.ls)
        material(specular=c.ms, shininess=c.shininess)
        point(-c.h, c.n)

    def cosine_power(self, c):
        light(0, four(c.b, 0), specular=WHITE)
        material(specular=WHITE, shininess=c.exponent)
        point(-c.b, c.a)

    def directional(self, c):
        light(0, four(-c.direction, 0), c.la, c.ld, c.ls)
        material(c.ma, c.md, c.ms, c.shininess)
        point(c.p, c.normal)

    def point_light(self, c, weakens_ambient):
        # Of the documents' ambient term nothing is taken off: it is the scene's.
        light(0, four(c.position), c.la if weakens_ambient else BLACK, c.ld, c.ls, (c.kc, c.kl, c.kq))
        scene_ambient(BLACK if weakens_ambient else c.la)
        material(c.ma, c.md, c.ms, c.shininess, alpha=c.alpha if weakens_ambient else 1)
        point(c.p, c.normal)

    def spot(self, c):
        light(0, four(c.position), BLACK, c.ld, c.ls, (c.kc, c.kl, c.kq))
        cone(0, c.axis, c.cutoff_cosine, c.exponent)
        scene_ambient(c.la)
        material(c.ma, c.md, c.ms, c.shininess)
        point(c.p, c.normal)

    def two_lights(self, c):
        light(0, four(c.direction, 0), BLACK, c.color0[:3], c.color0[:3])
        light(1, four(c.position), BLACK, c.color1[:3], c.color1[:3])
        material(BLACK, c.diffuse[:3], c.specular[:3], c.shininess, c.ambient[:3], c.diffuse[3])
        point(c.p, c.normal)

    def sum(self, c):
        scene_ambient(c.ambient)
        head_on(c.diffuse0, c.specular0, 0)
        head_on(c.diffuse1, c.specular1, 1)
        material(WHITE, WHITE, WHITE, 1, c.emissive)
        point(-AHEAD, AHEAD)

    def intensity(self, c):
        light(0, four(c.position), BLACK, WHITE, WHITE)
        material(BLACK, np.full(3, c.kd), np.full(3, c.ks), c.shininess)

    def flat(self, c):
        normal = face_normal(c.a, c.b, c.c)
        if not normal.any():
            raise Skip("a triangle without area draws nothing")
        self.intensity(c)
        # The three vertices to the corners of a triangle about the pixel; the first one lights the face.
        self.spread([c.a, c.b, c.c], [[-1, -1], [3, -1], [-1, 3]])
        glShadeModel(GL_FLAT)
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION)
        glBegin(GL_TRIANGLES)
        glNormal3fv(normal)
        for vertex in (c.a, c.b, c.c):
            glVertex3fv(vertex)
        glEnd()
        glProvokingVertex(GL_LAST_VERTEX_CONVENTION)
        glShadeModel(GL_SMOOTH)

    def spread(self, vertices, places):
        """A projection that takes vertices in eye space to places of the viewport."""
        homogeneous = np.hstack([np.float64(vertices), np.ones((len(vertices), 1))])
        rows = np.linalg.lstsq(homogeneous, np.float64(places), rcond=None)[0].T
        if not np.allclose(homogeneous @ rows.T, places, atol=1e-3):
            raise Skip("vertices that lie in one place draw nothing")
        projection = np.zeros((4, 4), np.float32)
        projection[:2] = rows
        projection[3, 3] = 1
        glMatrixMode(GL_PROJECTION)
        glLoadMatrixf(np.ascontiguousarray(projection.T))

    def gouraud(self, cases):
        """A line of 8192 pixels, lit at its ends, of which the pixel at t is looked at. Always the same pixel, so that the
        rasteriser's rounding is the same wherever a case stands among others."""
        length, values = 8192, []

        def line(c):
            self.intensity(c)
            self.spread([c.pa, c.pb], [[-1, 0], [1, 0]])
            # By 256ths of a pixel, to which the rasteriser snaps anyway.
            glViewportIndexedf(0, 0.5 - round(float(c.t) * length * 256) / 256, 0, length, 1)
            ends = ((c.pa, c.na), (c.pb, c.nb))
            # A line's last pixel is not drawn: it is the first one of the line from there.
            for way in (ends, reversed(ends)):
                self.target.clear()
                glBegin(GL_LINES)
                for p, normal in way:
                    glNormal3fv(normal)
                    glVertex3fv(p)
                glEnd()
                pixel = self.target.read(0, 0, 1, 1)[0, 0]
                if pixel[3]:
                    break
            else:
                raise Skip("the line does not cover the pixel")
            values.append(pixel[0])

        glEnable(GL_SCISSOR_TEST)
        glScissor(0, 0, 1, 1)
        skips = self.each(line, normalize=True, outputs=1)(cases)
        glDisable(GL_SCISSOR_TEST)
        drawn = iter(values)
        return [skip if isinstance(skip, Skip) else next(drawn) for skip in skips]

    def weakened(self, c, falloff):
        light(0, four(AHEAD * c.d), ambient=WHITE, falloff=falloff)
        material(ambient=WHITE)
        point(ORIGIN, AHEAD)

    def weakened_between(self, c):
        light(0, four(c.light), ambient=WHITE, falloff=(c.kc, c.kl, c.kq))
        material(ambient=WHITE)
        point(c.p, AHEAD)

    def in_cone(self, c, exponent):
        light(0, four(c.l), ambient=WHITE)
        cone(0, c.axis, c.cutoff_cosine, exponent)
        material(ambient=WHITE)
        point(ORIGIN, AHEAD)

    def normals(self, cases, normals, normalize):
        """A normal in eye space, read as the diffuse light of three lights along the axes, and of three opposite ones."""
        glEnable(GL_LIGHTING)
        (glEnable if normalize else glDisable)(GL_NORMALIZE)
        sides = []
        for sign in (1, -1):
            self.begin()
            lights_off()
            for number, axis in enumerate(np.eye(3, dtype=np.float32)):
                light(number, four(sign * axis, 0), diffuse=axis)
            material(diffuse=WHITE)
            for k in range(cases.total):
                if hasattr(cases, "modelview"):
                    matrix = np.eye(4, dtype=np.float32)
                    # A list of columns, as OpenGL takes it.
                    matrix[:3, :3] = cases.modelview[k].reshape(3, 3)
                    glLoadMatrixf(matrix)
                self.place(k)
                point(ORIGIN, normals[k])
            sides.append(self.read(cases.total)[:, :3])
        glDisable(GL_LIGHTING)
        return sides[0] - sides[1]

    def fog(self, cases):
        """The factor as white in black fog, then the colour."""
        kind = cases.formula.split("/")[1].removesuffix("-radial").removesuffix("-multiply-add")
        radial = cases.formula.endswith("-radial")
        glEnable(GL_FOG)
        glFogi(GL_FOG_MODE, {"linear": GL_LINEAR, "exp": GL_EXP, "exp2-opengl": GL_EXP2}[kind])
        glFogi(GL_FOG_COORDINATE_SOURCE, GL_FRAGMENT_DEPTH)
        glFogi(FOG_DISTANCE_MODE, EYE_RADIAL if radial else EYE_PLANE_ABSOLUTE)
        drawn, skipped = [], {}
        for fogs, colors in ((np.zeros((cases.total, 3)), np.ones((cases.total, 3))), (cases.fog, cases.shaded)):
            self.begin()
            for k in range(cases.total):
                c = cases.case(k)
                self.place(k)
                if kind == "linear":
                    glFogf(GL_FOG_START, c.dmin)
                    glFogf(GL_FOG_END, c.dmax)
                elif c.density < 0:
                    skipped[k] = Skip("GL_FOG_DENSITY is 0 at least")
                    continue
                else:
                    glFogf(GL_FOG_DENSITY, c.density)
                set_fog_color(fogs[k])
                glBegin(GL_POINTS)
                glColor4fv(four(colors[k]))
                glVertex3fv(c.p)
                glEnd()
            drawn.append(self.read(cases.total))
        glDisable(GL_FOG)
        values = np.hstack([drawn[0][:, :1], drawn[1][:, :3]])
        return [skipped.get(k, value) for k, value in enumerate(values)]
