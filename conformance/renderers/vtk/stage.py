"""VTK without a window: one renderer of it, and targets of any format that it draws to in the place of its own, which has 8 bits."""
import os

os.environ["LIBGL_ALWAYS_SOFTWARE"] = "1"
os.environ["EGL_PLATFORM"] = "surfaceless"

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import VTK_FLOAT, VTK_UNSIGNED_CHAR, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkTexture
from vtkmodules.vtkRenderingOpenGL2 import vtkEGLRenderWindow, vtkOpenGLFramebufferObject, vtkTextureObject

# What OpenGL calls it. VTK's state takes its numbers and has no names of its own.
GL_COLOR_AND_DEPTH = 0x4100
GL_BLEND, GL_DEPTH_TEST, GL_SCISSOR_TEST = 0x0BE2, 0x0B71, 0x0C11
GL_DEPTH_CLAMP, GL_FRAMEBUFFER_SRGB = 0x864F, 0x8DB9
GL_FUNC_ADD, GL_LEQUAL = 0x8006, 0x0203
GL_ONE, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA = 1, 0x0302, 0x0303
FORMATS = {
    "rgba32float": 0x8814,
    "rgba16float": 0x881A,
    "rgba8unorm": 0x8058,
    "bgra8unorm": 0x8058,
    "rgba8unorm-srgb": 0x8C43,
}
# Every vertex to the middle of the viewport, wherever it is in eye space: lights do not look at it.
TO_THE_MIDDLE = np.diag([0, 0, 0, 1])

window = vtkEGLRenderWindow()
window.SetOffScreenRendering(True)
window.SetMultiSamples(0)
window.SetSize(64, 64)
renderer = vtkRenderer()
window.AddRenderer(renderer)
# What is drawn is what is asked for, in the order in which it was added.
renderer.GetCullers().RemoveAllItems()
renderer.SetAutomaticLightCreation(False)
renderer.EraseOff()
camera = renderer.GetActiveCamera()
camera.SetPosition(0, 0, 0)
camera.SetFocalPoint(0, 0, -1)
camera.SetViewUp(0, 1, 0)
window.Render()
state = window.GetState()
drawn_to = None


def capabilities():
    """What OpenGL says of itself, by VTK's words for it, such as `OpenGL renderer string`."""
    lines = [line.partition(":") for line in window.ReportCapabilities().splitlines()]
    return {name.strip(): value.strip() for name, colon, value in lines if colon}


def bind(*_):
    drawn_to.frame.Bind()
    drawn_to.frame.ActivateDrawBuffer(0)


def reset_state(*_):
    """What vtkOpenGLRenderWindow::Start and OpenGLInitState set, and VTK relies on."""
    state.vtkglEnable(GL_BLEND)
    state.vtkglBlendEquation(GL_FUNC_ADD)
    state.vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA)
    state.vtkglEnable(GL_DEPTH_TEST)
    state.vtkglDepthFunc(GL_LEQUAL)
    state.vtkglDepthMask(True)
    state.vtkglColorMask(True, True, True, True)
    state.vtkglDisable(GL_DEPTH_CLAMP)
    state.vtkglDisable(GL_FRAMEBUFFER_SRGB)


renderer.AddObserver("StartEvent", bind)
renderer.AddObserver("EndEvent", reset_state)


class Target:
    """A colour and a depth texture to draw to. Rows from the bottom, as VTK has them."""

    def __init__(self, width, height, form="rgba32float"):
        self.width, self.height, self.format = width, height, form
        self.color, self.depth = vtkTextureObject(), vtkTextureObject()
        self.frame = vtkOpenGLFramebufferObject()
        for one in (self.color, self.depth, self.frame):
            one.SetContext(window)
        self.kind = VTK_FLOAT if "float" in form else VTK_UNSIGNED_CHAR
        self.color.SetInternalFormat(FORMATS[form])
        self.color.Create2DFromRaw(width, height, 4, self.kind, np.zeros((height, width, 4), self.dtype))
        self.depth.AllocateDepth(width, height, vtkTextureObject.Float32)
        self.frame.Bind()
        self.frame.AddColorAttachment(0, self.color)
        self.frame.AddDepthAttachment(self.depth)
        self.frame.ActivateDrawBuffer(0)

    @property
    def dtype(self):
        return np.float32 if self.kind == VTK_FLOAT else np.uint8

    def use(self):
        """Makes it what is drawn to."""
        global drawn_to
        drawn_to = self
        if tuple(window.GetSize()) != (self.width, self.height):
            window.SetSize(self.width, self.height)
        renderer.SetViewport(0, 0, 1, 1)

    def clear(self, color=(0, 0, 0, 0), depth=1):
        self.use()
        bind()
        state.vtkglDisable(GL_SCISSOR_TEST)  # The last viewport's.
        if self.format.endswith("srgb"):
            state.vtkglEnable(GL_FRAMEBUFFER_SRGB)
        state.vtkglClearColor(*color)
        state.vtkglClearDepth(depth)
        state.vtkglClear(GL_COLOR_AND_DEPTH)
        state.vtkglDisable(GL_FRAMEBUFFER_SRGB)

    def write(self, pixels):
        """Puts colours into the first pixels, row after row."""
        filled = np.zeros((self.height * self.width, 4), np.float32)
        filled[: len(pixels)] = pixels
        self.color.Create2DFromRaw(self.width, self.height, 4, VTK_FLOAT, filled)

    def read(self):
        return self._read(self.color, 4, self.kind)

    def read_depth(self):
        return self._read(self.depth, 1, VTK_FLOAT)[..., 0]

    def _read(self, texture, count, kind):
        pixels = np.zeros((self.height, self.width, count), np.float32 if kind == VTK_FLOAT else np.uint8)
        buffer = texture.Download()
        buffer.Download2D(kind, pixels, [self.width, self.height], count, [0, 0])
        return pixels

    def delete(self):
        for one in (self.color, self.depth):
            one.ReleaseGraphicsResources(window)
        self.frame.ReleaseGraphicsResources(window)


def matrix(rows):
    made = vtkMatrix4x4()
    made.DeepCopy(np.float64(rows).ravel().tolist())
    return made


def set_projection(rows):
    camera.SetExplicitProjectionTransformMatrix(matrix(rows))
    camera.UseExplicitProjectionTransformMatrixOn()


def vectors(values):
    return numpy_to_vtk(np.ascontiguousarray(values, np.float32), deep=True)


def polygons(positions, cells=None):
    """A vtkPolyData: triangles, or a point each vertex where there are none."""
    data = vtkPolyData()
    points = vtkPoints()
    points.SetData(vectors(positions))
    data.SetPoints(points)
    cells = np.arange(len(positions))[:, None] if cells is None else np.array(cells)
    array = vtkCellArray()
    array.SetData(cells.shape[1], numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells, np.int64).ravel(), deep=True))
    (data.SetVerts if cells.shape[1] == 1 else data.SetPolys)(array)
    return data


def make_actor(data, draws=None):
    """An actor of it; `draws` is called when its state is set and nothing drawn yet."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetVBOShiftScaleMethod(0)  # Vertices go to the shader as they are.
    if draws:
        mapper.AddObserver("UpdateShaderEvent", lambda *_: draws())
    actor = vtkActor()
    actor.SetMapper(mapper)
    # In the order of the scene: VTK would draw what is translucent last. Depth masks are set by `draws`.
    actor.ForceOpaqueOn()
    return actor


def make_texture(texels, linear=False, repeat=False):
    """A texture of f32, (height, width, 4). Its first row is the one that v = 0 reads."""
    height, width, _ = texels.shape
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(vectors(texels.reshape(-1, 4)))
    texture = vtkTexture()
    texture.SetInputData(image)
    texture.SetColorModeToDirectScalars()
    texture.SetInterpolate(linear)
    texture.SetWrap(vtkTexture.Repeat if repeat else vtkTexture.ClampToEdge)
    return texture


def make_light(color=(1, 1, 1)):
    light = vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetDiffuseColor(*map(float, color))
    light.SetSpecularColor(*map(float, color))
    return light


def directional(travel, color=(1, 1, 1)):
    """Light that travels a way."""
    light = make_light(color)
    light.SetPosition(*(-np.float64(travel)))
    light.SetFocalPoint(0, 0, 0)
    return light


def positional(position, color=(1, 1, 1), falloff=(1, 0, 0), axis=(0, 0, -1)):
    light = make_light(color)
    light.PositionalOn()
    light.SetPosition(*map(float, position))
    light.SetFocalPoint(*(np.float64(position) + np.float64(axis)))
    light.SetAttenuationValues(*map(float, falloff))
    light.SetConeAngle(90)
    return light


def render(actors=(), lights=()):
    """Draws actors into the target that is in use, lit by lights."""
    renderer.RemoveAllLights()
    for light in lights:
        renderer.AddLight(light)
    for actor in actors:
        renderer.AddActor(actor)
    window.Render()
    for actor in actors:
        renderer.RemoveActor(actor)
