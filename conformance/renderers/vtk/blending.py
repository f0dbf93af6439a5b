"""What becomes of a fragment's colour and depth, by the states of vtkOpenGLState: blending, masks and the depth test. One pixel a
case."""
import numpy as np
from lightmeter_client import Skip
from stage import GL_BLEND, GL_DEPTH_CLAMP, GL_DEPTH_TEST, Target, make_actor, make_texture, polygons, render, set_projection, state, vectors

SIDE = 64

# There is no glBlendColor in VTK's state: the constant and its alpha are not among what can be asked for.
FACTORS = {
    "zero": 0,
    "one": 1,
    "src-color": 0x0300,
    "one-minus-src-color": 0x0301,
    "dst-color": 0x0306,
    "one-minus-dst-color": 0x0307,
    "src-alpha": 0x0302,
    "one-minus-src-alpha": 0x0303,
    "dst-alpha": 0x0304,
    "one-minus-dst-alpha": 0x0305,
    "src-alpha-saturate": 0x0308,
}
EQUATIONS = {"add": 0x8006, "subtract": 0x800A, "reverse-subtract": 0x800B, "min": 0x8007, "max": 0x8008}
COMPARES = {
    "never": 0x0200,
    "less": 0x0201,
    "equal": 0x0202,
    "less-equal": 0x0203,
    "greater": 0x0204,
    "not-equal": 0x0205,
    "greater-equal": 0x0206,
    "always": 0x0207,
}
ALPHA = ("add", "src-alpha", "one-minus-src-alpha")
MODES = {
    "solid": ("add", "one", "zero"),
    "alpha": ALPHA,
    "mul": ("add", "dst-color", "zero"),
    "add": ("add", "src-alpha", "one"),
}
# vtkPolyDataFS.glsl ends a fragment whose alpha is 0 or less before it is blended, and VTK has no way to ask for one.
NO_ALPHA = "a fragment whose alpha is 0 or less is not drawn"
NO_DEPTH = "the clip space of VTK, from -1 to 1, does not hold this depth"
NO_CONSTANT = "VTK's state sets no constant to blend by"


def set_blend(color, alpha):
    """An (equation, source factor, destination factor) for red, green and blue and one for alpha."""
    factors = (*color[1:], *alpha[1:])
    if any(name not in FACTORS for name in factors):
        raise Skip(NO_CONSTANT)
    state.vtkglEnable(GL_BLEND)
    state.vtkglBlendEquationSeparate(EQUATIONS[color[0]], EQUATIONS[alpha[0]])
    state.vtkglBlendFuncSeparate(*(FACTORS[name] for name in factors))


def blend_state(text):
    """`add.one.zero`; `min` and `max` have no factors."""
    equation, *factors = text.split(".")
    return (equation, *(factors or ("one", "one")))


def is_held(depths):
    """Whether depths come through clip space, from -1 to 1, as they are."""
    depths = np.clip(depths, 0, 1)
    half = np.float32(0.5)
    return (2 * depths - np.float32(1)) * half + half == depths


def quad():
    """What covers the viewport, with a texel a pixel."""
    data = polygons([[-1, -1, 0], [3, -1, 0], [-1, 3, 0]], [[0, 1, 2]])
    data.GetPointData().SetTCoords(vectors([[0, 0], [2, 0], [0, 2]]))
    return data


class Blending:
    def __init__(self):
        self.target = Target(SIDE, SIDE)
        self.set = None
        self.actor = make_actor(quad(), self.draws)
        self.actor.GetProperty().SetLighting(False)
        places = np.arange(SIDE * SIDE)
        self.places = np.zeros((SIDE * SIDE, 3), np.float32)
        self.places[:, 0] = (2 * (places % SIDE) + 1) / SIDE - 1
        self.places[:, 1] = (2 * (places // SIDE) + 1) / SIDE - 1
        self.functions = {
            "blend/mode-*": self.mode,
            "blend/over": self.mode,
            "blend/write-mask/*": self.write_mask,
            "blend/layers/*": self.layers,
            "blend/separate/*": self.separate,
            "blend/min": self.same,
            "blend/max": self.same,
            **{
                f"blend/{equation}/{source}/{destination}": self.same
                for equation in ("add", "subtract", "reverse-subtract")
                for source in FACTORS
                for destination in FACTORS
            },
            "depth/test/*": self.depth_test,
        }

    def draws(self):
        state.vtkglDisable(GL_DEPTH_TEST)
        self.set()

    def draw(self, colors, set_state):
        """A colour a case, as texels of a texture: VTK keeps colours of vertices in 8 bits."""
        self.set = set_state
        texels = np.zeros((SIDE * SIDE, 4), np.float32)
        texels[: len(colors)] = colors
        self.actor.SetTexture(make_texture(texels.reshape(SIDE, SIDE, 4)))
        render([self.actor])

    def begin(self, dst):
        self.target.use()
        set_projection(np.eye(4))
        self.target.write(dst)

    def blend(self, cases, color, alpha, mask=(True,) * 4):
        def set_state():
            state.vtkglColorMask(*mask)
            set_blend(color, alpha)

        set_blend(color, alpha)  # Skipped here, where an exception is seen.
        self.begin(cases.dst if cases.dst.shape[1] == 4 else np.pad(cases.dst, ((0, 0), (0, 1)), constant_values=1))
        self.draw(cases.src, set_state)
        return self.target.read().reshape(-1, 4)[: cases.total]

    def where_drawn(self, cases, values):
        return [value if alpha > 0 else Skip(NO_ALPHA) for value, alpha in zip(values, cases.src[:, 3])]

    def same(self, cases):
        both = blend_state(".".join(cases.formula.split("/")[1:]))
        return self.where_drawn(cases, self.blend(cases, both, both))

    def separate(self, cases):
        _, _, color, alpha = cases.formula.split("/")
        return self.where_drawn(cases, self.blend(cases, blend_state(color), blend_state(alpha)))

    def mode(self, cases):
        mode = MODES[cases.formula.removeprefix("blend/mode-").replace("blend/over", "alpha")]
        return self.blend(cases, mode, mode)[:, :3]

    def write_mask(self, cases):
        letters = cases.formula.split("/")[2]
        mask = [letter in letters and letters != "none" for letter in "rgba"]
        return self.where_drawn(cases, self.blend(cases, ALPHA, ALPHA, mask))

    def layers(self, cases):
        self.begin(cases.dst)
        modes = {"alpha": ["alpha"], "mixed": ["alpha", "mul", "add"]}[cases.formula.split("/")[2]]
        for layer in range(16):
            mode = MODES[modes[layer % len(modes)]]
            drawn = cases.count > layer
            if not drawn.any():
                break
            # A case without this layer has a pixel of its own that nothing covers.
            kept = self.target.read().reshape(-1, 4)[: cases.total]
            self.draw(getattr(cases, f"src_{layer + 1}"), lambda: set_blend(mode, mode))
            if not drawn.all():
                blended = self.target.read().reshape(-1, 4)[: cases.total]
                self.target.write(np.where(drawn[:, None], blended, kept))
        return self.target.read().reshape(-1, 4)[: cases.total]

    def depth_test(self, cases):
        _, _, compare, write = cases.formula.split("/")
        self.target.clear()
        # Clip space of VTK has depth from -1 to 1.
        to_clip = np.eye(4)
        to_clip[2, 2:] = 2, -1
        set_projection(to_clip)
        for by, kept, seen, depths in (
            ("always", True, 1, cases.old),
            (compare, write == "write", 2, cases.new),
        ):
            places = self.places[: cases.total].copy()
            places[:, 2] = depths

            def set_state():
                state.vtkglEnable(GL_DEPTH_TEST)
                state.vtkglEnable(GL_DEPTH_CLAMP)
                state.vtkglDepthFunc(COMPARES[by])
                state.vtkglDepthMask(kept)
                state.vtkglDisable(GL_BLEND)

            actor = make_actor(polygons(places), set_state)
            actor.GetProperty().SetLighting(False)
            actor.GetProperty().SetColor(seen, seen, seen)
            render([actor])
        seen = self.target.read().reshape(-1, 4)[: cases.total, 0]
        values = np.stack([seen, self.target.read_depth().reshape(-1)[: cases.total]], 1)
        held = is_held(cases.new) & is_held(cases.old)
        return [value if kept else Skip(NO_DEPTH) for value, kept in zip(values, held)]
