"""What every OpenGL renderer does alike with a scene's file: targets, meshes, textures, and the state of a draw."""
import numpy as np
from context import FORMATS, Target
from OpenGL.GL import *
from stages import COMPARES, set_blend


def column_matrix(columns):
    """A matrix of columns, as OpenGL takes it."""
    return np.ascontiguousarray(np.array(columns, np.float32).reshape(4, 4))


def upload(texture):
    """A texture of f32. Its first row is the one that v = 0 reads, in the file as in OpenGL."""
    name = glGenTextures(1)
    glBindTexture(GL_TEXTURE_2D, name)
    texels = np.ascontiguousarray(texture["texels"], np.float32)
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, texture["width"], texture["height"], 0, GL_RGBA, GL_FLOAT, texels)
    glBindTexture(GL_TEXTURE_2D, 0)
    return name


def bind_texture(unit, names, sampled):
    """The texture of a draw on a unit."""
    glActiveTexture(GL_TEXTURE0 + unit)
    glBindTexture(GL_TEXTURE_2D, names[sampled["texture"]])
    by = GL_NEAREST if sampled["filter"] == "nearest" else GL_LINEAR
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, by)
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, by)
    beyond = GL_REPEAT if sampled["wrap"] == "repeat" else GL_CLAMP_TO_EDGE
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, beyond)
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, beyond)
    glActiveTexture(GL_TEXTURE0)


def state(draw):
    """(equation, source factor, destination factor) of a blend state."""
    return (draw["equation"], draw["src"], draw["dst"])


def set_state(draw):
    """Blending, depth and culling."""
    glDisable(GL_BLEND)
    if draw["blend"]:
        set_blend(state(draw["blend"]["color"]), state(draw["blend"]["alpha"]))
        glBlendColor(*draw["blend"]["constant"])
    glDisable(GL_DEPTH_TEST)
    if draw["depth"]:
        glEnable(GL_DEPTH_TEST)
        glDepthFunc(COMPARES[draw["depth"]["compare"]])
        glDepthMask(draw["depth"]["write"])
    glDisable(GL_CULL_FACE)
    if draw["cull"] != "none":
        glEnable(GL_CULL_FACE)
        glCullFace(GL_BACK if draw["cull"] == "back" else GL_FRONT)


def reset_state():
    for capability in (GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_FRAMEBUFFER_SRGB):
        glDisable(capability)
    glDepthMask(GL_TRUE)


def draw_frame(scene, draw_all):
    """The image of a scene: `draw_all(textures)` draws into a target that is made and cleared for it."""
    shape = scene["target"]
    floats = "float" in shape["format"]
    target = Target(shape["width"], shape["height"], FORMATS[shape["format"]])
    textures = [upload(texture) for texture in scene["textures"]]
    try:
        reset_state()
        if shape["format"].endswith("srgb"):
            glEnable(GL_FRAMEBUFFER_SRGB)
        target.clear(scene["background"], scene["clear_depth"])
        draw_all(textures)
        image = target.read(kind=GL_FLOAT if floats else GL_UNSIGNED_BYTE)
    finally:
        reset_state()
        target.delete()
        if textures:
            glDeleteTextures(textures)
    return np.ascontiguousarray(image[::-1])
