"""Blend states, which follow from their ids, and the blending that has a formula of its own."""
from functools import partial

import numpy as np

from arithmetic import Array, Formula, by_id, clamp, difference_of_products

# An equation and the factors of the source and of the destination.
State = list[str]

OVER: State = ["add", "src-alpha", "one-minus-src-alpha"]
MULTIPLY: State = ["add", "dst-color", "zero"]
ADD: State = ["add", "src-alpha", "one"]
LAYERS = {"alpha": [OVER], "mixed": [OVER, MULTIPLY, ADD]}


def factor(name: str, src: Array, dst: Array, constant: Array | None) -> Array:
    """What a factor is, for each of the four components."""
    match name.removeprefix("one-minus-"):
        case "zero":
            value = np.zeros_like(src)
        case "one":
            value = np.ones_like(src)
        case "src-color":
            value = src
        case "dst-color":
            value = dst
        case "constant-color":
            value = constant
        case "src-alpha":
            value = np.broadcast_to(src[3], src.shape)
        case "dst-alpha":
            value = np.broadcast_to(dst[3], dst.shape)
        case "constant-alpha":
            value = np.broadcast_to(constant[3], constant.shape)
        case "src-alpha-saturate":
            value = np.ones_like(src)
            value[:3] = np.minimum(src[3], 1 - dst[3])
        case _:
            raise ValueError(f"no factor is named {name}")
    return 1 - value if name.startswith("one-minus-") else value


def blend(state: State, src: Array, dst: Array, constant: Array | None = None) -> Array:
    """What one state leaves; the numbers are not clamped."""
    equation, *factors = state
    if equation == "min":
        return np.minimum(src, dst)
    if equation == "max":
        return np.maximum(src, dst)
    source, destination = (factor(name, src, dst, constant) for name in factors)
    match equation:
        case "add":
            return src * source + dst * destination
        case "subtract":
            return src * source - dst * destination
        case "reverse-subtract":
            return dst * destination - src * source
        case _:
            raise ValueError(f"no equation is named {equation}")


def blend_native(src: Array, dst: Array, constant: Array, *, state: State) -> Array:
    return blend(state, src, dst, constant)


def blend_separate(src: Array, dst: Array, constant: Array, *, color: State, alpha: State) -> tuple[Array, Array]:
    return blend(color, src, dst, constant)[:3], blend(alpha, src, dst, constant)[3]


def blend_masked(src: Array, dst: Array, constant: Array, *, mask: str) -> Array:
    written = np.array([[letter in mask] for letter in "rgba"]) & (mask != "none")
    return np.where(written, blend(OVER, src, dst), dst)


def blend_without_alpha(src: Array, dst: Array, *, state: State) -> Array:
    return blend(state, src, np.concatenate((dst, np.ones_like(dst[:1]))))[:3]


def blend_layers(dst: Array, count: Array, *, states: list[State], **sources: Array) -> Array:
    for layer in range(len(sources)):
        left = blend(states[layer % len(states)], sources[f"src_{layer + 1}"], dst)
        dst = np.where(layer < count, left, dst)
    return dst


def by_state(formula: str) -> Formula:
    """The formula of a blend state, from its id."""
    match formula.split("/")[1:]:
        case ["separate", color, alpha]:
            return partial(blend_separate, color=color.split("."), alpha=alpha.split("."))
        case ["write-mask", mask]:
            return partial(blend_masked, mask=mask)
        case ["without-alpha", state]:
            return partial(blend_without_alpha, state=state.split("."))
        case ["special", state]:
            return partial(blend_native, state=state.split("."))
        case ["layers", modes]:
            return partial(blend_layers, states=LAYERS[modes])
        case [equation, source, destination]:
            return partial(blend_native, state=[equation, source, destination])
        case _:
            raise ValueError(f"no formula has the id {formula}")


def mode_solid(src: Array, dst: Array) -> Array:
    return src[:3]


def mode_alpha(src: Array, dst: Array) -> Array:
    return blend_without_alpha(src, dst, state=OVER)


def mode_mul(src: Array, dst: Array) -> Array:
    return blend_without_alpha(src, dst, state=MULTIPLY)


def mode_add(src: Array, dst: Array) -> Array:
    return blend_without_alpha(src, dst, state=ADD)


def saturate_source_only(src: Array, dst: Array) -> tuple[Array, Array]:
    return src[:3] * np.minimum(src[3], 1 - src[3]) + dst[:3], src[3] + dst[3]


def alpha_clamped(src: Array, dst: Array) -> Array:
    return clamp(blend(OVER, clamp(src), clamp(dst)))


def min_factors_ignored(src: Array, dst: Array, constant: Array) -> Array:
    return np.minimum(src, dst)


def max_factors_ignored(src: Array, dst: Array, constant: Array) -> Array:
    return np.maximum(src, dst)


def over(src: Array, dst: Array) -> Array:
    return src[:3] * src[3] + dst * (1 - src[3])


def over_incremental(src: Array, dst: Array) -> Array:
    return dst + src[3] * (src[:3] - dst)


def opacity_of_layers(alpha: Array, layers: Array) -> Array:
    return 1 - (1 - alpha) ** layers


def opacity_of_layers_expm1(alpha: Array, layers: Array) -> Array:
    return -np.expm1(layers * np.log1p(-alpha))


def unpremultiply(color: Array, alpha: Array) -> Array:
    return color / alpha


def unpremultiply_guarded(color: Array, alpha: Array) -> Array:
    return np.where(alpha < 2.0**-126, 0, color / alpha)


def subtract_products(src: Array, s: Array, dst: Array, d: Array) -> Array:
    return src * s - dst * d


def subtract_compensated(src: Array, s: Array, dst: Array, d: Array) -> Array:
    return difference_of_products(src, s, dst, d)


FORMULAS = by_id(
    "blend",
    mode_solid, mode_alpha, mode_mul, mode_add, saturate_source_only, alpha_clamped, min_factors_ignored,
    max_factors_ignored, over, over_incremental, opacity_of_layers, opacity_of_layers_expm1, unpremultiply,
    unpremultiply_guarded, subtract_products, subtract_compensated,
)  # fmt: skip

# The groups of ids that are blend states.
STATES = [
    "blend/add", "blend/subtract", "blend/reverse-subtract", "blend/min", "blend/max", "blend/separate",
    "blend/write-mask", "blend/without-alpha", "blend/layers", "blend/special",
]  # fmt: skip
