"""The renderer, its colour buffer in a format of one's own, and the camera whose projection is stated."""
import math

import numpy as np
import pygfx as gfx

# Blending on f32 is a feature that WebGPU has on demand; pygfx itself demands that f32 textures are filtered.
gfx.renderers.wgpu.enable_wgpu_features("float32-blendable")

SIDE = 64
FORMATS = {
    "rgba32float": np.dtype((np.float32, 4)),
    "rgba16float": np.dtype((np.float16, 4)),
    "rgba8unorm": np.dtype((np.uint8, 4)),
    "rgba8unorm-srgb": np.dtype((np.uint8, 4)),
    "bgra8unorm": np.dtype((np.uint8, 4)),
}
DEPTH = np.dtype(np.float32)
# What replaces the colour that is there, alpha too: "solid" would put 1 for it.
REPLACE = {"method": "blended", "color_src": "one", "color_dst": "zero", "alpha_src": "one", "alpha_dst": "zero"}


def device():
    """The device of all renderers."""
    return gfx.renderers.wgpu.get_shared().device


def linear(rgb, alpha=1):
    """The colour in sRGB that pygfx takes for a linear one; its shaders decode it."""
    return gfx.Color.from_physical(*map(float, rgb), alpha)


class Camera(gfx.Camera):
    """A camera at the origin that looks down −z, of a projection as it is given."""

    def __init__(self, projection=np.eye(4)):
        super().__init__()
        self.set(projection)

    def set(self, projection):
        self.projection = np.array(projection, np.float64)
        self.flag_update()

    def _update_projection_matrix(self):
        return self.projection

    @property
    def projection_matrix_inverse(self):
        # No mesh looks at it, and a triangle's projection need not have one.
        return np.linalg.pinv(self.projection)


class Stage:
    """A renderer and its colour buffer, which is what is looked at: the last pass, which copies it to the target, takes it to the
    power of a gamma of 1 and multiplies it by its alpha. pygfx has no setting for the buffer's format, 8 bits of sRGB."""

    def __init__(self, width=SIDE, height=SIDE, format="rgba32float"):
        self.width, self.height, self.format = width, height, format
        target = gfx.Texture(dim=2, size=(width, height, 1), format="rgba8unorm")
        self.renderer = gfx.WgpuRenderer(target, pixel_ratio=1, ppaa="none", sort_objects=False)
        self.blender = self.renderer._blender
        self.blender.texture_info["color"]["format"] = format
        self.cleared = False

    def begin(self):
        """What is drawn next is drawn on transparent black, at depth 1."""
        self.cleared = False

    def draw(self, scene, camera):
        self.renderer.render(scene, camera, clear=not self.cleared, flush=False)
        self.cleared = True

    def read(self, name="color", rect=None):
        """(height, width, 4) of the colour buffer, (height, width) of the depth buffer."""
        x, y, width, height = rect or (0, 0, self.width, self.height)
        if not self.cleared:
            raise ValueError("nothing has been drawn")
        dtype = FORMATS[self.format] if name == "color" else DEPTH
        source = {"texture": self.blender.get_texture(name), "mip_level": 0, "origin": (x, y, 0)}
        layout = {"offset": 0, "bytes_per_row": dtype.itemsize * width, "rows_per_image": height}
        data = device().queue.read_texture(source, layout, (width, height, 1))
        pixels = np.frombuffer(data, dtype.base).reshape(height, width, *dtype.shape)
        return pixels[..., [2, 1, 0, 3]] if name == "color" and self.format == "bgra8unorm" else pixels

    def colors(self, count):
        """The colours of the first cases."""
        return self.read().reshape(-1, 4)[:count]


def mesh(positions, colors, material, normals=None, triangles=None, **attributes):
    """Triangles with a linear colour at each vertex, by which pygfx decodes nothing."""
    positions = np.array(positions, np.float32)
    if triangles is None:
        triangles = np.arange(len(positions)).reshape(-1, 3)
    if normals is None:
        normals = np.broadcast_to([0, 0, 1], positions.shape)
    colors = np.broadcast_to(np.array(colors, np.float32), (len(positions), np.shape(colors)[-1]))
    geometry = gfx.Geometry(
        positions=positions,
        normals=np.array(normals, np.float32),
        colors=np.array(colors, np.float32),
        indices=np.array(triangles, np.int32),
        **attributes,
    )
    return gfx.Mesh(geometry, material)


def unlit(config=REPLACE, **options):
    """The vertices' colours as they are, in the order in which they are added."""
    settings = {"depth_test": False, "depth_write": False, "color_mode": "vertex", "side": "both", "render_queue": 3000}
    return gfx.MeshBasicMaterial(alpha_config=config, **{**settings, **options})


def scene_of(*objects):
    """A scene whose objects are drawn in their order."""
    scene = gfx.Scene()
    for order, one in enumerate(objects):
        one.render_order = order
        scene.add(one)
    return scene


def directional(toward, rgb=(1, 1, 1), intensity=math.pi):
    light = gfx.DirectionalLight(rgb, intensity)
    light.local.position = np.float64(toward)
    return light


def point(position, rgb=(1, 1, 1), decay=0, intensity=math.pi):
    light = gfx.PointLight(rgb, intensity, decay=decay)
    light.local.position = np.float64(position)
    return light


def spot(position, axis, cutoff_cosine, rgb=(1, 1, 1), decay=0):
    light = gfx.SpotLight(rgb, math.pi, decay=decay, angle=math.acos(max(-1, min(1, cutoff_cosine))))
    light.local.position = np.float64(position)
    light.target.local.position = np.float64(position) + np.float64(axis)
    return light
