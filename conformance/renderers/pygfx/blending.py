"""pygfx's alpha modes, and the states of `alpha_config`. A triangle a case, which covers its pixel; all of them a frame."""
import numpy as np
from lightmeter_client import Skip
from stage import REPLACE, SIDE, Camera, Stage, mesh, scene_of, unlit

FACTORS = {
    "zero": "zero",
    "one": "one",
    "src-color": "src",
    "one-minus-src-color": "one-minus-src",
    "dst-color": "dst",
    "one-minus-dst-color": "one-minus-dst",
    "src-alpha": "src-alpha",
    "one-minus-src-alpha": "one-minus-src-alpha",
    "dst-alpha": "dst-alpha",
    "one-minus-dst-alpha": "one-minus-dst-alpha",
    "src-alpha-saturate": "src-alpha-saturated",
}
CONSTANTS = {
    "constant-color": "constant",
    "one-minus-constant-color": "one-minus-constant",
    "constant-alpha": "constant",
    "one-minus-constant-alpha": "one-minus-constant",
}
EQUATIONS = ("add", "subtract", "reverse-subtract")
# Of the states that read the constant a few: each of their cases is a pipeline of its own.
OF_CONSTANTS = ("blend/add/constant-color/zero", "blend/add/constant-alpha/zero", "blend/add/one/one-minus-constant-color")
# What is declared: states without the blend constant.
ANY = "{" + ",".join(FACTORS) + "}"
EITHER = f"{{min,max,{{{','.join(EQUATIONS)}}}.{ANY}.{ANY}}}"
DECLARED = (
    "blend/mode-*",
    "blend/over",
    "blend/write-mask/rgba",
    "blend/layers",
    "blend/{min,max}/*",
    f"blend/{{{','.join(EQUATIONS)}}}/{ANY}/{ANY}",
    f"blend/separate/{EITHER}/{EITHER}",
    *OF_CONSTANTS,
)
MODES = {"solid": "solid", "alpha": "blend", "mul": "multiply", "add": "add"}
ALPHA = ("add", "src-alpha", "one-minus-src-alpha")
LAYERS = {"alpha": ALPHA, "mul": ("add", "dst-color", "zero"), "add": ("add", "src-alpha", "one")}


def component(name, state, constant):
    """The part of an `alpha_config` that an (equation, source factor, destination factor) is, for colour or for alpha."""
    equation, *factors = state
    if equation in ("min", "max"):
        factors = ("one", "one")
    src, dst = ({**FACTORS, **CONSTANTS}[factor] for factor in factors)
    config = {f"{name}_op": equation, f"{name}_src": src, f"{name}_dst": dst}
    of_alpha = any("constant-alpha" in factor for factor in factors)
    if name == "alpha":
        return {**config, "alpha_constant": float(constant[3])}
    if of_alpha and any("constant-color" in factor for factor in factors):
        raise Skip("one constant for colour, and none for its alpha beside it")
    return {**config, "color_constant": tuple(float(x) for x in (constant[[3, 3, 3]] if of_alpha else constant[:3]))}


def custom(color, alpha, constant=np.zeros(4)):
    return {"method": "blended", **component("color", color, constant), **component("alpha", alpha, constant)}


def state(text):
    return tuple(text.split("."))


class Blending:
    def __init__(self):
        self.stage, self.camera = Stage(), Camera()
        k = np.arange(SIDE * SIDE)
        middles = np.stack([(2 * (k % SIDE) + 1) / SIDE - 1, 1 - (2 * (k // SIDE) + 1) / SIDE, 0 * k], 1)
        corners = np.array([[-0.5, -0.5, 0], [1, -0.5, 0], [-0.5, 1, 0]]) / SIDE
        self.places = (middles[:, None] + corners).astype(np.float32)
        self.functions = {
            "blend/mode-*": self.mode,
            "blend/over": self.mode,
            "blend/write-mask/*": lambda cases: self.blend(cases, custom(ALPHA, ALPHA)),
            "blend/layers/*": self.layers,
            "blend/separate/*": self.separate,
            "blend/*": self.same,
        }

    def triangles(self, colors, material, chosen=slice(None), **attributes):
        """The triangles of the cases `chosen`, or of all."""
        places = self.places[: len(colors)][chosen]
        return mesh(places.reshape(-1, 3), np.repeat(colors[chosen], 3, axis=0), material, **attributes)

    def draw(self, count, meshes):
        self.stage.begin()
        self.stage.draw(scene_of(*meshes), self.camera)
        return self.stage.colors(count)

    def under(self, cases):
        dst = cases.dst if cases.dst.shape[1] == 4 else np.pad(cases.dst, ((0, 0), (0, 1)), constant_values=1)
        return self.triangles(dst, unlit(REPLACE))

    def blend(self, cases, config):
        return self.draw(cases.total, [self.under(cases), self.triangles(cases.src, unlit(config))])

    def mode(self, cases):
        mode = MODES[cases.formula.removeprefix("blend/mode-").replace("blend/over", "alpha")]
        over = self.triangles(cases.src, unlit(None, alpha_mode=mode))
        return self.draw(cases.total, [self.under(cases), over])[:, :3]

    def of_state(self, cases, color, alpha):
        if not any("constant" in factor for factor in (*color, *alpha)):
            return self.blend(cases, custom(color, alpha))
        over = [
            self.triangles(cases.src, unlit(custom(color, alpha, cases.constant[k])), slice(k, k + 1)) for k in range(cases.total)
        ]
        return self.draw(cases.total, [self.under(cases), *over])

    def same(self, cases):
        both = cases.formula.split("/")[1:]
        return self.of_state(cases, both, both)

    def separate(self, cases):
        _, _, color, alpha = cases.formula.split("/")
        return self.of_state(cases, state(color), state(alpha))

    def layers(self, cases):
        modes = {"alpha": ["alpha"], "mixed": ["alpha", "mul", "add"]}[cases.formula.split("/")[2]]
        over = []
        for layer in range(16):
            drawn = np.flatnonzero(cases.count > layer)
            if len(drawn):
                mode = LAYERS[modes[layer % len(modes)]]
                over.append(self.triangles(getattr(cases, f"src_{layer + 1}"), unlit(custom(mode, mode)), drawn))
        return self.draw(cases.total, [self.under(cases), *over])
