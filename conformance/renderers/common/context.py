"""OpenGL without a window: Mesa's compatibility profile through EGL, and targets that are drawn to and read back."""
import os

os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
os.environ["PYOPENGL_PLATFORM"] = "egl"
os.environ["EGL_PLATFORM"] = "surfaceless"

import ctypes

import numpy as np
import OpenGL
from OpenGL import EGL

# A query after every call would be most of the time. PyOpenGL's EGL does not load without its own.
OpenGL.ERROR_CHECKING = False
OpenGL.ERROR_LOGGING = False

from OpenGL.GL import *

FORMATS = {
    "rgba32float": GL_RGBA32F,
    "rgba16float": GL_RGBA16F,
    "rgba8unorm": GL_RGBA8,
    "bgra8unorm": GL_RGBA8,
    "rgba8unorm-srgb": GL_SRGB8_ALPHA8,
}


def create():
    """Makes a context of OpenGL 4.5, compatibility profile, current; returns Mesa's version and the device's name."""
    display = EGL.eglGetDisplay(EGL.EGL_DEFAULT_DISPLAY)
    EGL.eglInitialize(display, ctypes.c_long(), ctypes.c_long())
    EGL.eglBindAPI(EGL.EGL_OPENGL_API)
    config, found = (EGL.EGLConfig * 1)(), ctypes.c_long()
    EGL.eglChooseConfig(display, [EGL.EGL_RENDERABLE_TYPE, EGL.EGL_OPENGL_BIT, EGL.EGL_NONE], config, 1, found)
    # Major version, minor version, profile mask: compatibility.
    wanted = [0x3098, 4, 0x30FB, 5, 0x30FD, 2, EGL.EGL_NONE]
    context = EGL.eglCreateContext(display, config[0], EGL.EGL_NO_CONTEXT, wanted)
    EGL.eglMakeCurrent(display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, context)
    for clamped in (GL_CLAMP_VERTEX_COLOR, GL_CLAMP_FRAGMENT_COLOR, GL_CLAMP_READ_COLOR):
        glClampColor(clamped, GL_FALSE)
    # Clip space with depth from 0 to 1, so that no depth is rounded on its way through [-1, 1].
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE)
    glPixelStorei(GL_PACK_ALIGNMENT, 1)
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1)
    # "4.5 (Compatibility Profile) Mesa 22.3.6"
    version = glGetString(GL_VERSION).decode().split("Mesa ")[1].split("-")[0].split()[0]
    return version, glGetString(GL_RENDERER).decode()


class Target:
    """A colour and a depth texture to draw to. Rows from the bottom, as OpenGL has them."""

    def __init__(self, width, height, internal=GL_RGBA32F):
        self.width, self.height = width, height
        self.color, self.depth = glGenTextures(2)
        for name, kind, base in (
            (self.color, internal, GL_RGBA),
            (self.depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT),
        ):
            glBindTexture(GL_TEXTURE_2D, name)
            glTexImage2D(GL_TEXTURE_2D, 0, kind, width, height, 0, base, GL_FLOAT, None)
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST)
        glBindTexture(GL_TEXTURE_2D, 0)
        self.frame = glGenFramebuffers(1)
        self.bind()
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, self.color, 0)
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, self.depth, 0)
        status = glCheckFramebufferStatus(GL_FRAMEBUFFER)
        assert status == GL_FRAMEBUFFER_COMPLETE, f"framebuffer status {status:#x}"

    def bind(self):
        glBindFramebuffer(GL_FRAMEBUFFER, self.frame)
        glViewport(0, 0, self.width, self.height)

    def clear(self, color=(0, 0, 0, 0), depth=1):
        glClearColor(*color)
        glClearDepth(depth)
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT)

    def write(self, pixels):
        """Puts colours into the first pixels, row after row."""
        filled = np.zeros((self.height * self.width, 4), np.float32)
        filled[: len(pixels)] = pixels
        glBindTexture(GL_TEXTURE_2D, self.color)
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, self.width, self.height, GL_RGBA, GL_FLOAT, filled)
        glBindTexture(GL_TEXTURE_2D, 0)

    def read(self, x=0, y=0, width=None, height=None, kind=GL_FLOAT):
        """Colours: (height, width, 4)."""
        shape = (height or self.height, width or self.width, 4)
        pixels = np.empty(shape, np.uint8 if kind == GL_UNSIGNED_BYTE else np.float32)
        glReadPixels(x, y, shape[1], shape[0], GL_RGBA, kind, pixels)
        return pixels

    def read_depth(self, x=0, y=0, width=None, height=None):
        pixels = np.empty((height or self.height, width or self.width), np.float32)
        glReadPixels(x, y, pixels.shape[1], pixels.shape[0], GL_DEPTH_COMPONENT, GL_FLOAT, pixels)
        return pixels

    def delete(self):
        glDeleteFramebuffers(1, [self.frame])
        glDeleteTextures([self.color, self.depth])
