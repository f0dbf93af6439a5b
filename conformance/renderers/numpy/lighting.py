"""Local illumination: ambient and diffuse light and highlights, by Phong and by Blinn."""
import numpy as np

from arithmetic import Array, by_id, dot, length, mix, normalize, normalize_scaled
from attenuation import cosine_power, cosine_power_by_chord, polynomial, spot_exponent
from vector import face_normal, reflect


def lambert(l: Array, n: Array) -> Array:
    return np.maximum(dot(l, n), 0)


def phong_highlight(n: Array, l: Array, v: Array, shininess: Array) -> Array:
    return cosine_power(reflect(-l, n), v, shininess)


def blinn_highlight(n: Array, l: Array, v: Array, shininess: Array) -> Array:
    return cosine_power(n, normalize(v + l), shininess)


def gated(highlight: Array, n: Array, l: Array) -> Array:
    """The highlight, and 0 where the light is not in front of the surface."""
    return np.where(dot(l, n) > 0, highlight, 0)


def opaque(color: Array) -> tuple[Array, Array]:
    return color, np.ones_like(color[0])


def ambient_term(*, la: Array, ma: Array, **_: Array) -> Array:
    return la * ma


def direct_terms(
    diffuse: Array, highlight: Array, *, ld: Array, md: Array, ls: Array, ms: Array, **_: Array
) -> Array:
    return ld * md * diffuse + ls * ms * highlight


def lit(diffuse: Array, highlight: Array, **colors: Array) -> tuple[Array, Array]:
    """The colour under one light that does not fade, of colours named la, ld, ls, ma, md and ms."""
    return opaque(ambient_term(**colors) + direct_terms(diffuse, highlight, **colors))


def ambient(la: Array, ma: Array) -> Array:
    return la * ma


def ambient_constant(ambient: Array, diffuse: Array) -> Array:
    return ambient + diffuse


def diffuse_toward(ld: Array, md: Array, l: Array, n: Array) -> Array:
    return ld * md * lambert(l, n)


def diffuse_travel(ld: Array, md: Array, i: Array, n: Array) -> Array:
    return ld * md * lambert(-i, n)


def specular_phong(ls: Array, ms: Array, r: Array, v: Array, shininess: Array) -> Array:
    return ls * ms * cosine_power(r, v, shininess)


def specular_blinn(ls: Array, ms: Array, n: Array, h: Array, shininess: Array) -> Array:
    return ls * ms * cosine_power(n, h, shininess)


def specular_nonlocal(ls: Array, ms: Array, r: Array, shininess: Array) -> Array:
    return ls * ms * np.maximum(r[2], 0) ** shininess


def phong(p: Array, normal: Array, direction: Array, shininess: Array, **colors: Array) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(-direction), normalize(-p)
    return lit(lambert(l, n), phong_highlight(n, l, v, shininess), **colors)


def blinn(p: Array, normal: Array, direction: Array, shininess: Array, **colors: Array) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(-direction), normalize(-p)
    return lit(lambert(l, n), blinn_highlight(n, l, v, shininess), **colors)


def blinn_unnormalised(
    p: Array, normal: Array, direction: Array, shininess: Array, **colors: Array
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(-direction), normalize(-p)
    return lit(lambert(l, n), cosine_power(n, v + l, shininess), **colors)


def phong_gated(
    p: Array, normal: Array, direction: Array, shininess: Array, **colors: Array
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(-direction), normalize(-p)
    return lit(lambert(l, n), gated(phong_highlight(n, l, v, shininess), n, l), **colors)


def phong_unit_light(
    p: Array, normal: Array, direction: Array, shininess: Array, **colors: Array
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), -direction, normalize(-p)
    return lit(lambert(l, n), phong_highlight(n, l, v, shininess), **colors)


def phong_nonlocal(normal: Array, direction: Array, shininess: Array, **colors: Array) -> tuple[Array, Array]:
    n, l = normalize(normal), -direction
    highlight = np.maximum(reflect(-l, n)[2], 0) ** shininess
    return lit(lambert(l, n), highlight, **colors)


def blinn_stable(
    p: Array, normal: Array, direction: Array, shininess: Array, **colors: Array
) -> tuple[Array, Array]:
    n, l, v = normalize_scaled(normal), normalize_scaled(-direction), normalize_scaled(-p)
    highlight = cosine_power_by_chord(n, normalize_scaled(v + l), shininess)
    return lit(lambert(l, n), gated(highlight, n, l), **colors)


def point_phong(
    p: Array, normal: Array, position: Array, kc: Array, kl: Array, kq: Array, shininess: Array, **colors: Array
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(position - p), normalize(-p)
    direct = direct_terms(lambert(l, n), phong_highlight(n, l, v, shininess), **colors)
    return opaque(ambient_term(**colors) + polynomial(kc, kl, kq, length(position - p)) * direct)


def point_blinn(
    p: Array, normal: Array, position: Array, kc: Array, kl: Array, kq: Array, shininess: Array, **colors: Array
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(position - p), normalize(-p)
    direct = direct_terms(lambert(l, n), blinn_highlight(n, l, v, shininess), **colors)
    return opaque(ambient_term(**colors) + polynomial(kc, kl, kq, length(position - p)) * direct)


def point_opengl(
    p: Array,
    normal: Array,
    position: Array,
    kc: Array,
    kl: Array,
    kq: Array,
    shininess: Array,
    alpha: Array,
    **colors: Array,
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(position - p), normalize(-p)
    color, _ = lit(lambert(l, n), gated(blinn_highlight(n, l, v, shininess), n, l), **colors)
    return polynomial(kc, kl, kq, length(position - p)) * color, alpha


def spot(
    p: Array,
    normal: Array,
    position: Array,
    axis: Array,
    kc: Array,
    kl: Array,
    kq: Array,
    cutoff_cosine: Array,
    exponent: Array,
    shininess: Array,
    **colors: Array,
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(position - p), normalize(-p)
    direct = direct_terms(lambert(l, n), phong_highlight(n, l, v, shininess), **colors)
    fading = polynomial(kc, kl, kq, length(position - p))
    cone = spot_exponent(l, normalize(axis), cutoff_cosine, exponent)
    return opaque(ambient_term(**colors) + fading * cone * direct)


def scalar_material(
    ambient_color: Array,
    light_color: Array,
    ka: Array,
    kd: Array,
    ks: Array,
    shininess: Array,
    p: Array,
    normal: Array,
    position: Array,
) -> tuple[Array, Array]:
    n, l, v = normalize(normal), normalize(position - p), normalize(-p)
    diffuse = kd * light_color * lambert(l, n)
    return opaque(ka * ambient_color + diffuse + ks * light_color * phong_highlight(n, l, v, shininess))


def two_lights(
    ambient: Array,
    color0: Array,
    color1: Array,
    diffuse: Array,
    specular: Array,
    shininess: Array,
    p: Array,
    normal: Array,
    direction: Array,
    position: Array,
) -> Array:
    n, v = normalize(normal), normalize(-p)
    color = ambient
    for light, toward in ((color0, direction), (color1, position - p)):
        l = normalize(toward)
        color = color + diffuse * light * lambert(l, n) + specular * light * blinn_highlight(n, l, v, shininess)
    return color


def sum_(
    emissive: Array, ambient: Array, diffuse0: Array, diffuse1: Array, specular0: Array, specular1: Array
) -> Array:
    return emissive + ambient + (diffuse0 + specular0) + (diffuse1 + specular1)


def highlight_plastic(ls: Array, surface: Array, ks: Array, fs: Array) -> Array:
    return ls * ks * fs


def highlight_metal(ls: Array, surface: Array, ks: Array, fs: Array) -> Array:
    return ls * surface * ks * fs


def intensity(n: Array, l: Array, v: Array, kd: Array, ks: Array, shininess: Array) -> Array:
    """The intensity under a white light, of unit vectors."""
    return kd * lambert(l, n) + ks * phong_highlight(n, l, v, shininess)


def intensity_at(p: Array, n: Array, position: Array, kd: Array, ks: Array, shininess: Array) -> Array:
    return intensity(n, normalize(position - p), normalize(-p), kd, ks, shininess)


def gouraud(
    pa: Array, na: Array, pb: Array, nb: Array, t: Array, position: Array, kd: Array, ks: Array, shininess: Array
) -> Array:
    a = intensity_at(pa, normalize(na), position, kd, ks, shininess)
    b = intensity_at(pb, normalize(nb), position, kd, ks, shininess)
    return mix(a, b, t)


def phong_shading(
    pa: Array, na: Array, pb: Array, nb: Array, t: Array, position: Array, kd: Array, ks: Array, shininess: Array
) -> Array:
    return intensity_at(mix(pa, pb, t), normalize(mix(na, nb, t)), position, kd, ks, shininess)


def phong_interpolated(
    pa: Array, na: Array, pb: Array, nb: Array, t: Array, position: Array, kd: Array, ks: Array, shininess: Array
) -> Array:
    n = normalize(mix(na, nb, t))
    l = normalize(mix(position - pa, position - pb, t))
    v = normalize(mix(-pa, -pb, t))
    return intensity(n, l, v, kd, ks, shininess)


def flat(a: Array, b: Array, c: Array, position: Array, kd: Array, ks: Array, shininess: Array) -> Array:
    return intensity_at(a, face_normal(a, b, c), position, kd, ks, shininess)


def cosine_power_unguarded(a: Array, b: Array, exponent: Array) -> Array:
    return dot(a, b) ** exponent


FORMULAS = by_id(
    "lighting",
    ambient, ambient_constant, diffuse_toward, diffuse_travel, specular_phong, specular_blinn,
    specular_nonlocal, phong, blinn, blinn_unnormalised, phong_gated, phong_unit_light, phong_nonlocal,
    point_phong, point_blinn, point_opengl, spot, scalar_material, two_lights, sum_, highlight_plastic,
    highlight_metal, gouraud, phong_shading, phong_interpolated, flat, cosine_power, cosine_power_unguarded,
    cosine_power_by_chord, blinn_stable,
)  # fmt: skip
