"""What only a rasteriser can answer, drawn 256 pixels square and looked at in one pixel; the vertices' way to the window;
and what textures and targets do to a colour."""
import numpy as np
from context import Target
from frames import column_matrix
from OpenGL.GL import *
from pixels import Pixels, identity
from lightmeter_client import Skip
from stages import COMPARES, SIDE
from surfaces import lights_off


class Raster(Pixels):
    def __init__(self):
        super().__init__()
        self.bytes = Target(SIDE, SIDE, GL_RGBA8)
        self.small = Target(SIDE, SIDE)
        self.functions = {
            "interpolation/raster-attributes": self.attributes,
            "interpolation/raster-line": self.line,
            "interpolation/raster-facing": self.facing,
            "interpolation/raster-clip": self.covered,
            "interpolation/cull-*": self.culled,
            "interpolation/raster-top-left": self.quad,
            "interpolation/raster-shared-edge": self.quad,
            "interpolation/raster-flat-*": self.flat,
            "interpolation/viewport-opengl": self.viewport,
            "interpolation/clip-volume-opengl": self.clip_volume,
            "depth/same-geometry-*": self.again,
            "color/modulate": lambda cases: self.textured(cases.texel, cases.color, GL_MODULATE),
            "color/replace": lambda cases: self.textured(cases.texel, cases.color, GL_REPLACE),
            "color/sum": self.color_sum,
            "color/uniform": self.uniform,
            "color/to-unorm8": self.to_unorm8,
            "color/from-unorm8": self.from_unorm8,
            "vector/light-direction": self.light_direction,
            "vector/light-with-model": self.light_with_model,
        }

    def both(self, cases, shape, draw):
        """Perspective-correct, and linear: the same with the vertices divided by w beforehand."""
        correct = self.pixels(cases, lambda c: self.primitive(shape, *draw(c)))
        linear = self.pixels(cases, lambda c: self.primitive(shape, [v / v[3] for v in draw(c)[0]], draw(c)[1]))
        return np.stack([correct[:, 0], linear[:, 0]], 1)

    def attributes(self, cases):
        return self.both(cases, GL_TRIANGLES, lambda c: ([c.a, c.b, c.c], c.attr))

    def line(self, cases):
        return self.both(cases, GL_LINES, lambda c: ([c.a, c.b], [c.attr_a, c.attr_b]))

    def triangle(self, c):
        self.primitive(GL_TRIANGLES, [c.a, c.b, c.c], [1, 1, 1])

    def covered(self, cases):
        # One colour a face: what is interpolated between equal values may differ from them in its last bit.
        glShadeModel(GL_FLAT)
        values = self.pixels(cases, self.triangle)[:, :1]
        glShadeModel(GL_SMOOTH)
        return values

    def culled(self, cases):
        _, face, front = cases.formula.split("/")[1].split("-")
        glEnable(GL_CULL_FACE)
        glCullFace(GL_BACK if face == "back" else GL_FRONT)
        glFrontFace(GL_CCW if front == "ccw" else GL_CW)
        values = self.covered(cases)
        glFrontFace(GL_CCW)
        glDisable(GL_CULL_FACE)
        return values

    def facing(self, cases):
        """Two-sided lighting: the front emits light and the back none."""
        glEnable(GL_LIGHTING)
        lights_off()
        glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, GL_TRUE)
        glMaterialfv(GL_FRONT, GL_EMISSION, (1, 1, 1, 1))
        glMaterialfv(GL_BACK, GL_EMISSION, (0, 0, 0, 1))
        values = self.covered(cases)
        glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, GL_FALSE)
        glDisable(GL_LIGHTING)
        return values

    def quad(self, cases):
        """Two triangles, counted by adding."""
        glEnable(GL_BLEND)
        glBlendEquation(GL_FUNC_ADD)
        glBlendFunc(GL_ONE, GL_ONE)

        def draw(c):
            corners = [np.array([v[0] / 128 - 1, 1 - v[1] / 128], np.float32) for v in (c.a, c.b, c.c, c.d)]
            self.primitive(GL_TRIANGLES, [corners[k] for k in (0, 1, 2, 0, 2, 3)], [1] * 6)

        values = self.pixels(cases, draw)[:, :1]
        glDisable(GL_BLEND)
        return values

    def again(self, cases):
        compare = COMPARES[cases.formula.removeprefix("depth/same-geometry-")]
        glEnable(GL_DEPTH_TEST)

        def draw(c):
            for by, seen in ((GL_ALWAYS, 1), (compare, 2)):
                glDepthFunc(by)
                self.primitive(GL_TRIANGLES, [c.a, c.b, c.c], [seen] * 3)

        values = self.pixels(cases, draw)[:, :1]
        glDisable(GL_DEPTH_TEST)
        return values

    def raster_position(self, cases, set_up):
        """Where glRasterPos puts a clip position, and whether it lies in the clip volume."""
        self.target.bind()
        identity()
        # OpenGL's own clip volume, depth from −1.
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE)
        values = []
        for k in range(cases.total):
            case = cases.case(k)
            set_up(case)
            glRasterPos4fv(case.clip)
            valid = bool(glGetBooleanv(GL_CURRENT_RASTER_POSITION_VALID))
            values.append((valid, glGetFloatv(GL_CURRENT_RASTER_POSITION)[:3]))
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE)
        glDepthRangef(0, 1)
        return values

    def viewport(self, cases):
        def set_up(c):
            glViewportIndexedf(0, *c.origin, *np.maximum(c.size, 0))
            glDepthRangef(*c.depth)

        outside = Skip("glRasterPos gives no position outside of the clip volume")
        limited = Skip("the viewport is smaller than 0 or larger than GL_MAX_VIEWPORT_DIMS, or begins beyond GL_VIEWPORT_BOUNDS_RANGE; or its depths lie beyond [0, 1]")
        low, high = glGetFloatv(GL_VIEWPORT_BOUNDS_RANGE)
        size, origin = cases.size, cases.origin
        # glDepthRange limits depths to [0, 1].
        depth = cases.depth
        fits = (size <= glGetIntegerv(GL_MAX_VIEWPORT_DIMS)).all(axis=1) & (origin >= low).all(axis=1) & (origin <= high).all(axis=1)
        fits &= (size >= 0).all(axis=1) & ((depth >= 0) & (depth <= 1)).all(axis=1)
        places = self.raster_position(cases, set_up)
        return [(place if valid else outside) if fits[k] else limited for k, (valid, place) in enumerate(places)]

    def clip_volume(self, cases):
        return [[float(valid)] for valid, _ in self.raster_position(cases, lambda c: None)]

    def points(self, target, count, draw):
        """A point a case; `draw(k)` gives it its colour."""
        target.bind()
        target.clear()
        identity()
        for k in range(count):
            glViewport(k % SIDE, k // SIDE, 1, 1)
            glBegin(GL_POINTS)
            draw(k)
            glVertex3f(0, 0, 0)
            glEnd()
        return target.read().reshape(-1, 4)[:count]

    def textured(self, texels, colors, mode, internal=GL_RGBA32F):
        """A texel a case by one texture unit."""
        texture = glGenTextures(1)
        glBindTexture(GL_TEXTURE_2D, texture)
        texels = np.ascontiguousarray(texels, np.float32)
        glTexImage2D(GL_TEXTURE_2D, 0, internal, len(texels), 1, 0, GL_RGBA, GL_FLOAT, texels)
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST)
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST)
        glEnable(GL_TEXTURE_2D)
        glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, mode)

        def draw(k):
            glColor4fv(colors[k])
            glTexCoord2f((k + 0.5) / len(texels), 0.5)

        values = self.points(self.small, len(texels), draw)
        glDisable(GL_TEXTURE_2D)
        glBindTexture(GL_TEXTURE_2D, 0)
        glDeleteTextures([texture])
        return values

    def color_sum(self, cases):
        """GL_ADD, clamped as a fragment's colour is where clamping is on."""
        glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_TRUE)
        opaque = [np.pad(x, ((0, 0), (0, 1)), constant_values=1) for x in (cases.a, cases.b)]
        values = self.textured(*opaque, GL_ADD)[:, :3]
        glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE)
        return values

    def uniform(self, cases):
        return self.points(self.small, cases.total, lambda k: glColor3fv(cases.color[k]))

    def to_unorm8(self, cases):
        values = self.points(self.bytes, cases.total, lambda k: glColor4f(cases.c[k], 0, 0, 1))
        return np.round(values[:, :1] * 255)

    def from_unorm8(self, cases):
        texels = np.repeat(cases.byte[:, None] / np.float32(255), 4, 1)
        return self.textured(texels, texels, GL_REPLACE, GL_RGBA8)[:, :1]

    def lights(self, cases, place):
        """A light's place in eye space, as OpenGL keeps it."""
        values = []
        glMatrixMode(GL_MODELVIEW)
        for k in range(cases.total):
            glLightfv(GL_LIGHT0, GL_POSITION, place(cases.case(k)))
            values.append(np.array(glGetLightfv(GL_LIGHT0, GL_POSITION))[:3])
        return values

    def light_direction(self, cases):
        def place(c):
            glLoadMatrixf(column_matrix(c.view))
            return np.append(c.direction, 0).astype(np.float32)

        return self.lights(cases, place)

    def light_with_model(self, cases):
        def place(c):
            glLoadMatrixf(column_matrix(c.view))
            glMultMatrixf(column_matrix(c.model))
            return np.append(c.position, 1).astype(np.float32)

        return self.lights(cases, place)
