"""What OpenGL does with a fragment's colour and depth: blending, write masks and the depth test. One pixel a case."""
import numpy as np
from context import Target
from OpenGL.GL import *
from lightmeter_client import Skip

SIDE = 64

FACTORS = {
    "zero": GL_ZERO,
    "one": GL_ONE,
    "src-color": GL_SRC_COLOR,
    "one-minus-src-color": GL_ONE_MINUS_SRC_COLOR,
    "dst-color": GL_DST_COLOR,
    "one-minus-dst-color": GL_ONE_MINUS_DST_COLOR,
    "src-alpha": GL_SRC_ALPHA,
    "one-minus-src-alpha": GL_ONE_MINUS_SRC_ALPHA,
    "dst-alpha": GL_DST_ALPHA,
    "one-minus-dst-alpha": GL_ONE_MINUS_DST_ALPHA,
    "constant-color": GL_CONSTANT_COLOR,
    "one-minus-constant-color": GL_ONE_MINUS_CONSTANT_COLOR,
    "constant-alpha": GL_CONSTANT_ALPHA,
    "one-minus-constant-alpha": GL_ONE_MINUS_CONSTANT_ALPHA,
    "src-alpha-saturate": GL_SRC_ALPHA_SATURATE,
}
EQUATIONS = {
    "add": GL_FUNC_ADD,
    "subtract": GL_FUNC_SUBTRACT,
    "reverse-subtract": GL_FUNC_REVERSE_SUBTRACT,
    "min": GL_MIN,
    "max": GL_MAX,
}
COMPARES = {
    "never": GL_NEVER,
    "less": GL_LESS,
    "equal": GL_EQUAL,
    "less-equal": GL_LEQUAL,
    "greater": GL_GREATER,
    "not-equal": GL_NOTEQUAL,
    "greater-equal": GL_GEQUAL,
    "always": GL_ALWAYS,
}
ALPHA = ("add", "src-alpha", "one-minus-src-alpha")
MODES = {
    "solid": ("add", "one", "zero"),
    "alpha": ALPHA,
    "mul": ("add", "dst-color", "zero"),
    "add": ("add", "src-alpha", "one"),
}


def set_blend(color, alpha):
    """An (equation, source factor, destination factor) for red, green and blue and one for alpha."""
    glEnable(GL_BLEND)
    glBlendEquationSeparate(EQUATIONS[color[0]], EQUATIONS[alpha[0]])
    glBlendFuncSeparate(*(FACTORS[name] for name in (*color[1:], *alpha[1:])))


def state(text):
    """`add.one.zero`; `min` and `max` have no factors."""
    equation, *factors = text.split(".")
    return (equation, *(factors or ("one", "one")))


class Stages:
    """Draws a point a case with a colour of its own."""

    def __init__(self):
        self.target = Target(SIDE, SIDE)
        try:
            self.without_alpha = Target(SIDE, SIDE, GL_RGB32F)
        except AssertionError:
            self.without_alpha = None
        places = np.arange(SIDE * SIDE)
        self.places = np.zeros((SIDE * SIDE, 3), np.float32)
        self.places[:, 0] = (2 * (places % SIDE) + 1) / SIDE - 1
        self.places[:, 1] = (2 * (places // SIDE) + 1) / SIDE - 1
        self.functions = {
            "blend/mode-*": self.mode,
            "blend/over": self.mode,
            "blend/write-mask/*": self.write_mask,
            "blend/without-alpha/*": self.ad_is_one,
            "blend/layers/*": self.layers,
            "blend/separate/*": self.separate,
            **{f"blend/{equation}/*": self.same for equation in EQUATIONS},
            "depth/test/*": self.depth_test,
        }

    def draw(self, colors, chosen=None, depths=None):
        """The points of the cases `chosen`, or of all: one draw."""
        places = self.places[: len(colors)].copy()
        if depths is not None:
            places[:, 2] = depths
        if chosen is not None:
            places, colors = places[chosen], colors[chosen]
        places, colors = np.ascontiguousarray(places), np.ascontiguousarray(colors, np.float32)
        glVertexPointer(3, GL_FLOAT, 0, places)
        glColorPointer(4, GL_FLOAT, 0, colors)
        glEnableClientState(GL_VERTEX_ARRAY)
        glEnableClientState(GL_COLOR_ARRAY)
        glDrawArrays(GL_POINTS, 0, len(colors))
        glDisableClientState(GL_VERTEX_ARRAY)
        glDisableClientState(GL_COLOR_ARRAY)

    def begin(self, target, dst):
        for matrix in (GL_PROJECTION, GL_MODELVIEW):
            glMatrixMode(matrix)
            glLoadIdentity()
        target.bind()
        target.write(dst)

    def end(self, target, count):
        glDisable(GL_BLEND)
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE)
        return target.read().reshape(-1, 4)[:count]

    def blend(self, cases, color, alpha, target=None):
        target = target or self.target
        dst = cases.dst if cases.dst.shape[1] == 4 else np.pad(cases.dst, ((0, 0), (0, 1)), constant_values=1)
        self.begin(target, dst)
        set_blend(color, alpha)
        if any("constant" in name for name in (*color, *alpha)):
            for k in range(cases.total):
                glBlendColor(*map(float, cases.constant[k]))
                self.draw(cases.src, slice(k, k + 1))
        else:
            self.draw(cases.src)
        return self.end(target, cases.total)

    def same(self, cases):
        both = state(".".join(cases.formula.split("/")[1:]))
        return self.blend(cases, both, both)

    def separate(self, cases):
        _, _, color, alpha = cases.formula.split("/")
        return self.blend(cases, state(color), state(alpha))

    def mode(self, cases):
        mode = MODES[cases.formula.removeprefix("blend/mode-").replace("blend/over", "alpha")]
        return self.blend(cases, mode, mode)[:, :3]

    def write_mask(self, cases):
        letters = cases.formula.split("/")[2]
        # The destination is put there by an upload, which no mask touches.
        glColorMask(*(letter in letters and letters != "none" for letter in "rgba"))
        return self.blend(cases, ALPHA, ALPHA)

    def ad_is_one(self, cases):
        if not self.without_alpha:
            raise Skip("no buffer without alpha: the driver renders to no RGB32F")
        both = state(cases.formula.split("/")[2])
        return self.blend(cases, both, both, self.without_alpha)[:, :3]

    def layers(self, cases):
        self.begin(self.target, cases.dst)
        modes = {"alpha": ["alpha"], "mixed": ["alpha", "mul", "add"]}[cases.formula.split("/")[2]]
        for layer in range(16):
            mode = MODES[modes[layer % len(modes)]]
            set_blend(mode, mode)
            drawn = cases.count > layer
            if drawn.any():
                self.draw(getattr(cases, f"src_{layer + 1}"), drawn)
        return self.end(self.target, cases.total)

    def depth_test(self, cases):
        _, _, compare, write = cases.formula.split("/")
        self.begin(self.target, np.zeros((0, 4)))
        self.target.clear()
        glEnable(GL_DEPTH_TEST)
        glEnable(GL_DEPTH_CLAMP)
        for by, kept, seen, depths in ((GL_ALWAYS, True, 1, cases.old), (COMPARES[compare], write == "write", 2, cases.new)):
            glDepthFunc(by)
            glDepthMask(kept)
            self.draw(np.full((cases.total, 4), seen, np.float32), depths=depths)
        glDepthMask(GL_TRUE)
        glDisable(GL_DEPTH_TEST)
        glDisable(GL_DEPTH_CLAMP)
        seen = self.target.read().reshape(-1, 4)[: cases.total, 0]
        return np.stack([seen, self.target.read_depth().reshape(-1)[: cases.total]], 1)
