"""Scenes by the documents' programs: composed for each draw of what it calls for."""
from pathlib import Path

import numpy as np
from formulas import LIBRARY, program
from frames import bind_texture, column_matrix, draw_frame, set_state
from OpenGL.GL import *
from lightmeter_client import Skip

# What the documents have a program or a formula for: no gate of the highlight, no light's ambient term that weakens, no
# exponent of a spotlight, no fog of the radial distance and none of OpenGL's own square.
EFFECTS = """
    flat gouraud phong inverse_transpose emissive ambient_product ambient_constant light_ambient diffuse specular_phong
    specular_blinn specular_unnormalised local_viewer directional directional_unit point spot attenuation vertex_color
    texture_nearest texture_bilinear texture_replace lightmap_nearest lightmap_bilinear cutout
    fog_linear fog_exp fog_exp2_document
""".split()

HERE = Path(__file__).parent
VERTEX, FRAGMENT, LIGHTING = (HERE.joinpath(name).read_text() for name in ("scene.vert", "scene.frag", "lighting.glsl"))
HIGHLIGHTS = {"phong": "phong", "blinn": "blinn", "blinn-unnormalised": "blinnOf000"}
FOGS = {
    "linear": "fogLinear(eyePosition.z, fogRange.x, fogRange.y)",
    "exp": "fogExp(eyePosition.z, fogRange.x)",
    "exp2-document": "fogExp2(eyePosition.z, fogRange.x)",
}
KINDS = {"directional": 0, "point": 2, "spot": 3}
ATTRIBUTES = ("positions", "normals", "uvs", "lightmap_uvs", "colors")


def definitions(scene, draw):
    """What a draw calls for, as names for the preprocessor."""
    names = {"INTERPOLATION": "smooth", "LIGHTS": max(len(scene["lights"]), 1), "HIGHLIGHT": "phong"}
    shading = draw["shading"]
    if shading:
        names["AT_FRAGMENT" if shading["frequency"] == "phong" else "AT_VERTEX"] = ""
        names["INTERPOLATION"] = "flat" if shading["frequency"] == "flat" else "smooth"
        names["HIGHLIGHT"] = HIGHLIGHTS[shading["specular"]]
        if shading["viewer"] == "local":
            names["LOCAL_VIEWER"] = ""
        if shading["normals"] == "modelview":
            names["MODELVIEW_NORMALS"] = ""
    if draw["vertex_colors"]:
        names["VERTEX_COLORS"] = ""
    if draw["texture"]:
        names["TEXTURE_REPLACES" if draw["texture"]["replaces"] else "TEXTURE_MODULATES"] = ""
    if draw["lightmap"]:
        names["LIGHTMAP"] = ""
    if draw["cutout"] is not None:
        names["CUTOUT"] = ""
    if scene["fog"]:
        names["FOG"] = FOGS[scene["fog"]["form"]["kind"]]
    return "".join(f"#define {name} {value}\n" for name, value in names.items())


class Uniforms:
    """The uniforms of the program in use, by name; those that it does not read are passed over."""

    def __init__(self, name):
        self.name = name

    def set(self, name, value):
        place = glGetUniformLocation(self.name, name)
        value = np.float32(value).ravel()
        (glUniform1f, glUniform2f, glUniform3f)[len(value) - 1](place, *map(float, value))

    def set_number(self, name, value):
        glUniform1i(glGetUniformLocation(self.name, name), value)

    def set_matrix(self, name, columns):
        glUniformMatrix4fv(glGetUniformLocation(self.name, name), 1, GL_FALSE, column_matrix(columns))


def set_lights(uniforms, scene):
    for k, light in enumerate(scene["lights"]):
        place, of = light["place"], f"lights[{k}]."
        for term in ("ambient", "diffuse", "specular"):
            uniforms.set(of + term, light[term])
        uniforms.set_number(of + "kind", 1 if place.get("unit") else KINDS[place["kind"]])
        uniforms.set(of + "place", place["toward"] if place["kind"] == "directional" else place["position"])
        uniforms.set(of + "falloff", place.get("falloff", (1, 0, 0)))
        if place["kind"] == "spot":
            if place["exponent"]:
                raise Skip("the documents' spotlight is evenly lit")
            uniforms.set(of + "axis", place["axis"])
            uniforms.set(of + "cutoffCosine", place["cutoff_cosine"])


def set_surface(uniforms, scene, draw):
    of = draw["material"]
    product = scene["ambient_form"] == "product"
    uniforms.set("ambient", np.float32(scene["ambient"]) * (np.float32(of["ambient"]) if product else 1))
    uniforms.set("ambientOfMaterial", of["ambient"])
    for term in ("emissive", "diffuse", "specular", "shininess"):
        uniforms.set(term, of[term])
    uniforms.set("plain", of["diffuse"])
    uniforms.set("alpha", draw["alpha"])
    uniforms.set("cutout", draw["cutout"] or 0)
    uniforms.set_number("lightmap", 1)
    if scene["fog"]:
        form = scene["fog"]["form"]
        uniforms.set("fogColor", scene["fog"]["color"])
        uniforms.set("fogRange", [form["dmin"], form["dmax"]] if form["kind"] == "linear" else [form["density"], 0])


def draw_mesh(mesh):
    kept = []
    for place, name in enumerate(ATTRIBUTES):
        if mesh[name]:
            kept.append(np.ascontiguousarray(mesh[name], np.float32))
            glVertexAttribPointer(place, kept[-1].shape[1], GL_FLOAT, GL_FALSE, 0, kept[-1])
            glEnableVertexAttribArray(place)
    triangles = np.ascontiguousarray(mesh["triangles"], np.uint32)
    glDrawElements(GL_TRIANGLES, triangles.size, GL_UNSIGNED_INT, triangles)
    for place in range(len(ATTRIBUTES)):
        glDisableVertexAttribArray(place)


def draw(scene):
    """The image of a scene."""
    programs = {}

    def draw_all(textures):
        for one in scene["draws"]:
            names = definitions(scene, one)
            if names not in programs:
                head = "#version 400 compatibility\n" + names + LIBRARY + LIGHTING
                programs[names] = program(head + VERTEX, head + FRAGMENT)
            glUseProgram(programs[names])
            uniforms = Uniforms(programs[names])
            uniforms.set_matrix("projection", scene["projection"])
            uniforms.set_matrix("modelview", one["modelview"])
            set_lights(uniforms, scene)
            set_surface(uniforms, scene, one)
            for unit, sampled in enumerate((one["texture"], one["lightmap"])):
                if sampled:
                    bind_texture(unit, textures, sampled)
            set_state(one)
            first = one["shading"] and one["shading"]["provoking"] == "first"
            glProvokingVertex(GL_FIRST_VERTEX_CONVENTION if first else GL_LAST_VERTEX_CONVENTION)
            draw_mesh(scene["meshes"][one["mesh"]])

    try:
        return draw_frame(scene, draw_all)
    finally:
        glUseProgram(0)
        glProvokingVertex(GL_LAST_VERTEX_CONVENTION)
        for name in programs.values():
            glDeleteProgram(name)
