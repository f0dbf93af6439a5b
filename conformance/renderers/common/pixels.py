"""What only a rasteriser can answer: drawn 256 pixels square and looked at in one pixel."""
import numpy as np
from context import Target
from OpenGL.GL import *

SIZE = 256
SHAPES = {
    "points": (GL_POINTS, 1, 1),
    "line-list": (GL_LINES, 2, 2),
    "line-strip": (GL_LINE_STRIP, 2, 1),
    "triangle-list": (GL_TRIANGLES, 3, 3),
    "triangle-strip": (GL_TRIANGLE_STRIP, 3, 1),
}


def identity():
    for matrix in (GL_PROJECTION, GL_MODELVIEW):
        glMatrixMode(matrix)
        glLoadIdentity()


class Pixels:
    def __init__(self):
        self.target = Target(SIZE, SIZE)

    def pixels(self, cases, draw):
        """The pixel of each case, after `draw` has drawn the case: RGBA."""
        self.target.bind()
        identity()
        glEnable(GL_SCISSOR_TEST)
        values = []
        for k in range(cases.total):
            case = cases.case(k)
            # Pixels are counted from the upper left.
            x, y = int(case.pixel[0]), SIZE - 1 - int(case.pixel[1])
            glScissor(x, y, 1, 1)
            self.target.clear()
            draw(case)
            values.append(self.target.read(x, y, 1, 1)[0, 0])
        glDisable(GL_SCISSOR_TEST)
        return np.array(values)

    def primitive(self, shape, vertices, values):
        glBegin(shape)
        for vertex, value in zip(vertices, values):
            glColor4f(value, value, value, 1)
            glVertex4fv(np.append(vertex, [0.5, 1][len(vertex) - 2 :]).astype(np.float32))
        glEnd()

    def flat(self, cases):
        """Six vertices as a list or a strip, laid out so that the middle of the asked primitive falls on the pixel."""
        name, provoking = cases.formula.removeprefix("interpolation/raster-flat-").rsplit("-", 1)
        shape, corners, step = SHAPES[name]
        layout = [(8 * v, 24 * (v % 2)) if corners == 3 else (16 * v, 0) for v in range(6)]
        glShadeModel(GL_FLAT)
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION if provoking == "first" else GL_LAST_VERTEX_CONVENTION)

        def draw(c):
            first = int(c.primitive) * step
            middle = np.mean(layout[first : first + corners], axis=0)
            window = [c.pixel + 0.5 + place - middle for place in np.array(layout)]
            clip = [np.array([v[0] / 128 - 1, 1 - v[1] / 128], np.float32) for v in window]
            self.primitive(shape, clip, [c.a0, c.a1, c.a2, c.a3, c.a4, c.a5])

        values = self.pixels(cases, draw)[:, :1]
        glShadeModel(GL_SMOOTH)
        glProvokingVertex(GL_LAST_VERTEX_CONVENTION)
        return values
