"""Scenes by the fixed function: lit at the vertices, at most eight lights, two texture units, alpha test, fog."""
import numpy as np
from frames import bind_texture, column_matrix, draw_frame, set_state
from OpenGL.GL import *
from lightmeter_client import Skip
from surfaces import EYE_PLANE_ABSOLUTE, EYE_RADIAL, FOG_DISTANCE_MODE, cone, four, light, lights_off, material, scene_ambient, set_fog_color

# What the fixed function has: not what is lit at the fragments, nor a halfway vector that is not normalised. Its highlight is
# Blinn's, whatever a scene asks for; scenes of Phong's are drawn all the same, and judged.
EFFECTS = """
    flat gouraud inverse_transpose emissive ambient_product ambient_constant light_ambient attenuated_ambient diffuse
    specular_phong specular_blinn local_viewer gate directional point spot spot_exponent attenuation vertex_color
    texture_nearest texture_bilinear texture_replace lightmap_nearest lightmap_bilinear cutout
    fog_linear fog_exp fog_exp2_opengl
""".split()


def set_lights(scene):
    """The lights and what they give everywhere; returns what is added to each surface's emission."""
    lights_off()
    everywhere, added = np.float32(scene["ambient"]), np.zeros(3, np.float32)
    if scene["ambient_form"] == "constant":
        everywhere, added = added, everywhere
    if len(scene["lights"]) > 8:
        raise Skip("OpenGL's fixed function has 8 lights")
    for number, one in enumerate(scene["lights"]):
        place, ambient = one["place"], np.float32(one["ambient"])
        if scene["light_ambient"] == "documents":
            # Distance and cones do not weaken it, so it is the scene's.
            everywhere, ambient = everywhere + ambient, np.zeros(3, np.float32)
        directional = place["kind"] == "directional"
        at = four(place["toward"], 0) if directional else four(place["position"])
        light(number, at, ambient, one["diffuse"], one["specular"], (1, 0, 0) if directional else place["falloff"])
        if place["kind"] == "spot":
            cone(number, np.float32(place["axis"]), place["cutoff_cosine"], place["exponent"])
    scene_ambient(everywhere)
    return added


def set_fog(fog):
    glDisable(GL_FOG)
    if not fog:
        return
    glEnable(GL_FOG)
    form = fog["form"]
    glFogi(GL_FOG_MODE, {"linear": GL_LINEAR, "exp": GL_EXP, "exp2-opengl": GL_EXP2}[form["kind"]])
    if form["kind"] == "linear":
        glFogf(GL_FOG_START, form["dmin"])
        glFogf(GL_FOG_END, form["dmax"])
    else:
        glFogf(GL_FOG_DENSITY, form["density"])
    set_fog_color(fog["color"])
    glFogi(FOG_DISTANCE_MODE, EYE_RADIAL if fog["distance"] == "radial" else EYE_PLANE_ABSOLUTE)


def set_surface(draw, added):
    of, shading = draw["material"], draw["shading"]
    glDisable(GL_LIGHTING)
    glShadeModel(GL_SMOOTH)
    glColor4fv(four(of["diffuse"], draw["alpha"]))
    if shading:
        if draw["vertex_colors"]:
            raise Skip("lit colours are not multiplied by the vertices' own: GL_COLOR_MATERIAL replaces the material")
        if shading["normals"] != "inverse-transpose":
            raise Skip("normals go by the inverse transpose of the modelview")
        glEnable(GL_LIGHTING)
        glEnable(GL_NORMALIZE)
        emissive = np.float32(of["emissive"]) + added
        material(of["ambient"], of["diffuse"], of["specular"], of["shininess"], emissive, draw["alpha"])
        glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, shading["viewer"] == "local")
        if shading["frequency"] == "flat":
            glShadeModel(GL_FLAT)
        first = shading["provoking"] == "first"
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION if first else GL_LAST_VERTEX_CONVENTION)
    glDisable(GL_ALPHA_TEST)
    if draw["cutout"] is not None:
        glEnable(GL_ALPHA_TEST)
        glAlphaFunc(GL_GEQUAL, draw["cutout"])


def set_textures(draw, names):
    sampled = draw["texture"], draw["lightmap"]
    for unit, of in enumerate(sampled):
        glActiveTexture(GL_TEXTURE0 + unit)
        glDisable(GL_TEXTURE_2D)
        if of:
            bind_texture(unit, names, of)
            glActiveTexture(GL_TEXTURE0 + unit)
            glEnable(GL_TEXTURE_2D)
            glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE if of.get("replaces") else GL_MODULATE)
    glActiveTexture(GL_TEXTURE0)


def draw_mesh(mesh, draw):
    """Every array is kept until it is drawn: OpenGL reads it then."""

    def array(name):
        return np.ascontiguousarray(mesh[name], np.float32)

    positions = array("positions")
    glVertexPointer(3, GL_FLOAT, 0, positions)
    glEnableClientState(GL_VERTEX_ARRAY)
    kept = [positions]
    if mesh["normals"]:
        kept.append(array("normals"))
        glNormalPointer(GL_FLOAT, 0, kept[-1])
        glEnableClientState(GL_NORMAL_ARRAY)
    if draw["vertex_colors"]:
        own = four(draw["material"]["diffuse"], draw["alpha"])
        kept.append(np.ascontiguousarray(array("colors") * own))
        glColorPointer(4, GL_FLOAT, 0, kept[-1])
        glEnableClientState(GL_COLOR_ARRAY)
    for unit, name in enumerate(("uvs", "lightmap_uvs")):
        if mesh[name]:
            glClientActiveTexture(GL_TEXTURE0 + unit)
            kept.append(array(name))
            glTexCoordPointer(2, GL_FLOAT, 0, kept[-1])
            glEnableClientState(GL_TEXTURE_COORD_ARRAY)
    triangles = np.ascontiguousarray(mesh["triangles"], np.uint32)
    glDrawElements(GL_TRIANGLES, triangles.size, GL_UNSIGNED_INT, triangles)
    for unit in (1, 0):
        glClientActiveTexture(GL_TEXTURE0 + unit)
        glDisableClientState(GL_TEXTURE_COORD_ARRAY)
    for name in (GL_VERTEX_ARRAY, GL_NORMAL_ARRAY, GL_COLOR_ARRAY):
        glDisableClientState(name)


def draw(scene):
    """The image of a scene."""

    def draw_all(textures):
        glMatrixMode(GL_PROJECTION)
        glLoadMatrixf(column_matrix(scene["projection"]))
        glMatrixMode(GL_MODELVIEW)
        glLoadIdentity()
        added = set_lights(scene)
        set_fog(scene["fog"])
        for one in scene["draws"]:
            set_surface(one, added)
            set_textures(one, textures)
            set_state(one)
            glLoadMatrixf(column_matrix(one["modelview"]))
            draw_mesh(scene["meshes"][one["mesh"]], one)

    try:
        return draw_frame(scene, draw_all)
    finally:
        for unit in (1, 0):
            glActiveTexture(GL_TEXTURE0 + unit)
            glDisable(GL_TEXTURE_2D)
        for capability in (GL_LIGHTING, GL_FOG, GL_ALPHA_TEST, GL_NORMALIZE):
            glDisable(capability)
        glShadeModel(GL_SMOOTH)
        glProvokingVertex(GL_LAST_VERTEX_CONVENTION)
