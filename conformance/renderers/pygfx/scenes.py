"""Scenes by pygfx's own materials: MeshPhongMaterial for what is lit, MeshBasicMaterial for what is not."""
import math

import numpy as np
import pygfx as gfx
from blending import custom
from lightmeter_client import Skip
from raster import COMPARES, tested
from stage import REPLACE, Camera, Stage, directional, linear, mesh, point, scene_of, spot, unlit

# The highlight is Blinn's; scenes of Phong's are drawn with it all the same, and judged.
EFFECTS = [
    "phong", "inverse_transpose", "emissive", "ambient_product", "ambient_constant", "light_ambient", "diffuse", "specular_phong",
    "specular_blinn", "local_viewer", "gate", "directional", "point", "spot", "attenuation", "vertex_color", "texture_nearest",
    "texture_bilinear", "texture_replace", "lightmap_nearest", "lightmap_bilinear", "cutout",
]
SIDES = {"none": "both", "back": "front", "front": "back"}
POWERS = {(1, 0, 0): 0, (0, 1, 0): 1, (0, 0, 1): 2}
NO_POLYNOMIAL = "light falls off by a power of the distance, not by a polynomial"
COVER = [[-1, -1], [3, -1], [-1, 3]]


def texture_map(scene, sampled, encoded=False, channel=0):
    """A texture of f32, linear; or `encoded` as sRGB, for what decodes whatever it reads."""
    of = scene["textures"][sampled["texture"]]
    texels = np.array(of["texels"], np.float32).reshape(of["height"], of["width"], 4)
    if encoded:
        texels = np.array([[linear(texel[:3], texel[3]).rgba for texel in row] for row in texels], np.float32)
    image = gfx.Texture(texels, dim=2, colorspace="physical")
    wrap = "repeat" if sampled["wrap"] == "repeat" else "clamp"
    by = "nearest" if sampled["filter"] == "nearest" else "linear"
    return gfx.TextureMap(image, uv_channel=channel, filter=by, wrap=wrap)


def make_light(light, rgb):
    place, color = light["place"], linear(rgb)
    if place["kind"] == "directional":
        return directional(place["toward"], color)
    decay = POWERS.get(tuple(place["falloff"]))
    if decay is None:
        raise Skip(NO_POLYNOMIAL)
    if place["kind"] == "point":
        return point(place["position"], color, decay)
    if place["exponent"]:
        raise Skip("a spotlight of pygfx has no exponent")
    return spot(place["position"], place["axis"], place["cutoff_cosine"], color, decay)


def make_lights(scene):
    """A light has one colour in pygfx. Where its diffuse and its specular colour differ and it is alone, it is white and the
    material takes their products. Gives the lights and what the material takes."""
    lights, white = scene["lights"], [1, 1, 1]
    shiny = any(draw["shading"] and any(draw["material"]["specular"]) for draw in scene["draws"])
    if shiny and any(light["diffuse"] != light["specular"] for light in lights):
        if len(lights) > 1:
            raise Skip("a light of pygfx has one colour for both terms")
        return [make_light(lights[0], white)], (np.array(lights[0]["diffuse"]), np.array(lights[0]["specular"]))
    return [make_light(light, light["diffuse"]) for light in lights], (np.ones(3), np.ones(3))


def alpha_config(blend):
    if not blend:
        return REPLACE
    color, alpha = ((blend[part]["equation"], blend[part]["src"], blend[part]["dst"]) for part in ("color", "alpha"))
    return custom(color, alpha, np.array(blend["constant"]))


def depth_test(depth):
    if not depth:
        return tested("always", False)
    if depth["compare"] not in (*COMPARES, "always"):
        raise Skip("pygfx has no depth test that never passes")
    return tested(depth["compare"], depth["write"])


def make_material(scene, draw, tints):
    of, shading = draw["material"], draw["shading"]
    options = {
        "alpha_config": alpha_config(draw["blend"]),
        "opacity": draw["alpha"],
        "alpha_test": draw["cutout"] or 0,
        "side": SIDES[draw["cull"]],
        "render_queue": 3000,
        **depth_test(draw["depth"]),
    }
    if draw["texture"]:
        options["map"] = texture_map(scene, draw["texture"])
        if draw["texture"]["replaces"]:
            return gfx.MeshBasicMaterial(**{**options, "color_mode": "vertex_map", "opacity": 1})
    if not shading:
        material = gfx.MeshBasicMaterial(color=linear(of["diffuse"]), **options)
        if draw["lightmap"]:
            material.light_map = texture_map(scene, draw["lightmap"], encoded=True, channel=1)
            # As diffuse light is, a lightmap is divided by π.
            material.light_map_intensity = math.pi
        return material
    if shading["normals"] != "inverse-transpose":
        raise Skip("normals go by the inverse transpose of the modelview")
    if shading["viewer"] != "local":
        raise Skip("the viewer is local, but with an orthographic camera")
    if draw["lightmap"]:
        raise Skip("a lightmap of pygfx is light and takes part in the sum")
    emissive = np.array(of["emissive"]) + (np.array(scene["ambient"]) if scene["ambient_form"] == "constant" else 0)
    material = gfx.MeshPhongMaterial(
        color=linear(of["diffuse"] * tints[0]),
        specular=linear(of["specular"] * tints[1]),
        shininess=of["shininess"],
        emissive=linear(emissive),
        **options,
    )
    # 1 by its documentation, 0 in fact.
    material.emissive_intensity = 1
    return material


def make_ambient(scene, draw, tints):
    """Light from everywhere that gives a draw its ambient term: the material has no ambient colour of its own, so that the light
    is what the term is over the diffuse one."""
    if not draw["shading"]:
        return gfx.AmbientLight(intensity=0)
    of = draw["material"]
    everywhere = np.array(scene["ambient"]) if scene["ambient_form"] == "product" else np.zeros(3)
    term = sum((np.array(light["ambient"]) for light in scene["lights"]), everywhere) * of["ambient"]
    diffuse = of["diffuse"] * tints[0]
    if (term[diffuse == 0] > 0).any():
        raise Skip("no ambient term where the diffuse colour is black")
    return gfx.AmbientLight(linear(np.divide(term, diffuse, out=np.zeros(3), where=term > 0)), math.pi)


def make_mesh(scene, draw, material):
    of = scene["meshes"][draw["mesh"]]
    attributes = {
        "positions": of["positions"],
        "normals": of["normals"],
        "texcoords": of["uvs"],
        "texcoords1": of["lightmap_uvs"],
        "colors": of["colors"] if draw["vertex_colors"] else [],
    }
    given = {name: np.array(values, np.float32) for name, values in attributes.items() if len(values)}
    one = gfx.Mesh(gfx.Geometry(indices=np.array(of["triangles"], np.int32), **given), material)
    # A matrix as it is: by components a shear would be lost.
    one.local.state_basis = "matrix"
    one.local.matrix = np.array(draw["modelview"]).T
    return one


def draw(scene):
    target = scene["target"]
    stage = Stage(target["width"], target["height"], target["format"])
    lights, tints = make_lights(scene)
    # Colour and depth to begin with are drawn: pygfx clears to black and 1.
    corners = [[x, y, scene["clear_depth"]] for x, y in COVER]
    stage.draw(scene_of(mesh(corners, scene["background"], unlit(depth_write=True))), Camera())
    camera = Camera(np.array(scene["projection"]).T)
    # One after the other, each with an ambient light of its own.
    for one in scene["draws"]:
        material = make_material(scene, one, tints)
        stage.draw(scene_of(make_mesh(scene, one, material), *lights, make_ambient(scene, one, tints)), camera)
    image = stage.read()
    return image.astype(np.float32) if image.dtype == np.float16 else np.ascontiguousarray(image)
