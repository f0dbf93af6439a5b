"""Scenes by VTK's actors, properties, lights and textures."""
import numpy as np
from blending import COMPARES, set_blend
from lightmeter_client import Skip
from stage import (
    GL_BLEND,
    GL_DEPTH_TEST,
    GL_FRAMEBUFFER_SRGB,
    Target,
    directional,
    make_actor,
    make_texture,
    matrix,
    polygons,
    positional,
    render,
    set_projection,
    state,
    vectors,
)
from surfaces import BLACK, WHITE, set_cone, set_material
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkTexture

# Its highlight is Phong's, gated, whatever a scene asks for; scenes without the gate are drawn all the same, and judged, and so are
# flat and Gouraud ones, which VTK has the names of.
EFFECTS = """
    flat gouraud phong inverse_transpose emissive ambient_product ambient_constant light_ambient diffuse
    specular_phong local_viewer gate directional point spot spot_exponent attenuation vertex_color
    texture_nearest texture_bilinear texture_replace lightmap_nearest lightmap_bilinear
""".split()

FREQUENCIES = {"flat": "SetInterpolationToFlat", "gouraud": "SetInterpolationToGouraud", "phong": "SetInterpolationToPhong"}


def make_light(one, white):
    place = one["place"]
    color = WHITE if white else one["diffuse"]
    if place["kind"] == "directional":
        light = directional(-np.float64(place["toward"]), color)
    else:
        light = positional(place["position"], color, place["falloff"], place.get("axis", (0, 0, -1)))
        if place["kind"] == "spot":
            set_cone(light, place["cutoff_cosine"], place["exponent"])
    if not white:
        light.SetSpecularColor(*one["specular"])
    return light


def make_lights(scene):
    """A light of VTK has one colour for both terms, whatever it is told of a specular one. Where the two differ and the light is
    alone it is white, and the material takes their products."""
    lights = scene["lights"]
    white = len(lights) == 1 and lights[0]["diffuse"] != lights[0]["specular"]
    made = [make_light(one, white) for one in lights]
    tint = lights[0] if white else {"diffuse": WHITE, "specular": WHITE}
    return made, np.float64(tint["diffuse"]), np.float64(tint["specular"])


def everywhere(scene, of):
    """The ambient colour of a surface: VTK has no light from everywhere, so that products are formed here, and no emission."""
    ambient, emissive = np.float64(scene["ambient"]), np.float64(of["emissive"])
    product = scene["ambient_form"] == "product"
    lights = np.zeros(3)
    for light in scene["lights"]:
        lights = lights + light["ambient"]
    if lights.any() and scene["light_ambient"] != "documents":
        raise Skip("a light of VTK has no ambient term to weaken")
    return emissive + (0 if product else ambient) + (lights + (ambient if product else 0)) * of["ambient"]


def sampler(scene, of):
    texture = scene["textures"][of["texture"]]
    texels = np.float32(texture["texels"]).reshape(texture["height"], texture["width"], 4)
    return make_texture(texels, of["filter"] != "nearest", of["wrap"] == "repeat")


def set_textures(scene, draw, data, actor):
    """The first texture, and a lightmap by texture coordinates of its own."""
    mesh = scene["meshes"][draw["mesh"]]
    for name, uvs in (("texture", "uvs"), ("lightmap", "lightmap_uvs")):
        if not draw[name]:
            continue
        array = vectors(mesh[uvs])
        array.SetName(uvs)
        if data.GetPointData().GetTCoords():
            data.GetPointData().AddArray(array)
        else:
            data.GetPointData().SetTCoords(array)
        texture = sampler(scene, draw[name])
        texture.SetBlendingMode(vtkTexture.VTK_TEXTURE_BLENDING_MODE_MODULATE)
        # VTK makes the name a variable of its shader, where `texture` is a function.
        sampler_name = f"{name}_sampler"
        actor.GetProperty().SetTexture(sampler_name, texture)
        actor.GetMapper().MapDataArrayToMultiTextureAttribute(sampler_name, uvs, vtkDataObject.FIELD_ASSOCIATION_POINTS)


def make_draw(scene, draw, tint_diffuse, tint_specular):
    mesh, of, shading = scene["meshes"][draw["mesh"]], draw["material"], draw["shading"]
    data = polygons(mesh["positions"], mesh["triangles"])
    replaces = draw["texture"] and draw["texture"]["replaces"]

    def set_state():
        if scene["target"]["format"].endswith("srgb"):
            state.vtkglEnable(GL_FRAMEBUFFER_SRGB)
        state.vtkglDisable(GL_BLEND)
        if draw["blend"]:
            set_blend(*(tuple(draw["blend"][part][key] for key in ("equation", "src", "dst")) for part in ("color", "alpha")))
        state.vtkglDisable(GL_DEPTH_TEST)
        if draw["depth"]:
            state.vtkglEnable(GL_DEPTH_TEST)
            state.vtkglDepthFunc(COMPARES[draw["depth"]["compare"]])
            state.vtkglDepthMask(draw["depth"]["write"])

    actor = make_actor(data, set_state)
    of_actor = actor.GetProperty()
    # A column a list, and VTK takes rows.
    actor.SetUserMatrix(matrix(np.float64(draw["modelview"]).T))
    if replaces or not shading:
        set_material(of_actor, BLACK, WHITE if replaces else of["diffuse"], opacity=1 if replaces else draw["alpha"])
        of_actor.SetLighting(False)
    else:
        if shading["normals"] != "inverse-transpose":
            raise Skip("normals go by the inverse transpose of the modelview")
        if shading["viewer"] != "local":
            raise Skip("the viewer of VTK is local")
        diffuse, specular = tint_diffuse * of["diffuse"], tint_specular * of["specular"]
        set_material(of_actor, everywhere(scene, of), diffuse, specular, of["shininess"], draw["alpha"])
        getattr(of_actor, FREQUENCIES[shading["frequency"]])()
        data.GetPointData().SetNormals(vectors(mesh["normals"]))
    if draw["vertex_colors"]:
        if shading:
            raise Skip("colours of vertices take the place of the material's, ambient and diffuse")
        colors = vectors(np.float32(mesh["colors"]) * np.float32([*of["diffuse"], draw["alpha"]]))
        data.GetPointData().SetScalars(colors)
        actor.GetMapper().SetColorModeToDirectScalars()
        of_actor.SetAmbient(0)  # Colours of vertices take the place of both colours, which are added where there is no light.
        of_actor.SetOpacity(1)
    set_textures(scene, draw, data, actor)
    of_actor.SetBackfaceCulling(draw["cull"] == "back")
    of_actor.SetFrontfaceCulling(draw["cull"] == "front")
    return actor


def projection(columns):
    """Clip space with depth from 0 to 1 to VTK's, from -1."""
    to_vtk = np.eye(4)
    to_vtk[2, 2:] = 2, -1
    return to_vtk @ np.float64(columns).T


def draw(scene):
    """The image of a scene."""
    shape = scene["target"]
    for one in scene["draws"]:
        if one["blend"]:
            set_blend(*(tuple(one["blend"][part][key] for key in ("equation", "src", "dst")) for part in ("color", "alpha")))
    lights, *tint = make_lights(scene)
    actors = [make_draw(scene, one, *tint) for one in scene["draws"]]
    target = Target(shape["width"], shape["height"], shape["format"])
    try:
        target.clear(scene["background"], scene["clear_depth"])
        set_projection(projection(scene["projection"]))
        render(actors, lights)
        image = target.read()
    finally:
        target.delete()
    return np.ascontiguousarray(image[::-1])
