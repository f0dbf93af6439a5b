"""Formulas by the documents' programs: a fragment a case, its inputs a row of a data texture."""
from pathlib import Path

import numpy as np
from context import Target
from OpenGL.GL import *
from OpenGL.GL import shaders
from pixels import Pixels, identity
from stages import SIDE

LIBRARY = Path(__file__).with_name("library.glsl").read_text()

# What a fragment answers, of inputs by their names. The number stands for the document; several stand where they agree.
EXPRESSIONS = {
    # 000 §6.1, 004.
    "interpolation/line": "weights.x * a + weights.y * b",
    "interpolation/triangle": "weights.x * a + weights.y * b + weights.z * c",
    # 000 §6.2, 002, 004.
    "color/uniform": "vec4(color, 1.0)",
    "color/per-vertex": "vec4(weights.x * a + weights.y * b + weights.z * c, 1.0)",
    "color/modulate": "texel * color",
    "color/replace": "texel",
    # 000 §6.3, 003, 004.
    "vector/reflect": "reflect(i, n)",
    "vector/reflect-toward": "2.0 * dot(l, n) * n - l",
    "vector/halfway": "normalize(v + l)",
    "vector/halfway-unnormalised": "v + l",
    "vector/normalize": "normalize(v)",
    "vector/normal-modelview": "modelview * n",
    "vector/normal-inverse-transpose": "mat3(transpose(inverse(mat4(modelview)))) * n",
    "vector/light-direction": "vec3(view * vec4(direction, 0.0))",
    "vector/light-position": "(modelview * position).xyz / (modelview * position).w",
    "vector/light-with-model": "vec3(view * model * vec4(position, 1.0))",
    "vector/toward": "towardPoint(light, p)",
    "vector/average-normal": "normalize(n0 + n1 + n2)",
    # 000 §6.3.
    "lighting/ambient": "la * ma",
    "lighting/diffuse-travel": "ld * md * incidence(-i, n)",
    "lighting/specular-phong": "ls * ms * pow(max(dot(r, v), 0.0), shininess)",
    "lighting/phong": "sumOf000(la, ld, ls, ma, md, ms, incidence(towardTravel(direction), normalize(normal)),"
    " phong(normalize(normal), towardTravel(direction), normalize(-p), shininess))",
    # 000 §6.4.
    "lighting/specular-nonlocal": "ls * ms * pow(max(r.z, 0.0), shininess)",
    "lighting/phong-unit-light": "sumOf000(la, ld, ls, ma, md, ms, incidence(-direction, normalize(normal)),"
    " phong(normalize(normal), -direction, normalize(-p), shininess))",
    "lighting/phong-nonlocal": "sumOf000(la, ld, ls, ma, md, ms, incidence(-direction, normalize(normal)),"
    " phongNonLocal(normalize(normal), -direction, shininess))",
    "lighting/blinn": "sumOf000(la, ld, ls, ma, md, ms, incidence(towardTravel(direction), normalize(normal)),"
    " blinnOf000(normalize(normal), towardTravel(direction), normalize(-p), shininess))",
    "lighting/blinn-unnormalised": "sumOf000(la, ld, ls, ma, md, ms, incidence(towardTravel(direction), normalize(normal)),"
    " blinnOf000(normalize(normal), towardTravel(direction), normalize(-p), shininess))",
    "lighting/point-phong": "vec4(la * ma + attenuation(kc, kl, kq, distance(position, p)) * ("
    "ld * md * incidence(towardPointOf000(position, p), normalize(normal))"
    " + ls * ms * phong(normalize(normal), towardPointOf000(position, p), normalize(-p), shininess)), 1.0)",
    # 003.
    "lighting/scalar-material": "vec4(surfaceOf003(ambient_color, light_color, ka, kd, ks, shininess, normalize(normal),"
    " normalize(position - p), normalize(-p)), 1.0)",
    "lighting/gouraud": "mix(litVertexOf003(pa, na, position, kd, ks, shininess),"
    " litVertexOf003(pb, nb, position, kd, ks, shininess), t)",
    "lighting/phong-interpolated": "intensityOf003(normalize(mix(na, nb, t)),"
    " normalize(mix(position - pa, position - pb, t)), normalize(mix(-pa, -pb, t)), kd, ks, shininess)",
    # 004.
    "lighting/ambient-constant": "ambient + diffuse",
    "lighting/diffuse-toward": "ld * md * incidence(l, n)",
    "lighting/specular-blinn": "ls * ms * pow(max(dot(n, h), 0.0), shininess)",
    "lighting/two-lights": "ambient"
    " + lightOf004(normalize(direction), color0, normalize(normal), normalize(-p), diffuse, specular, shininess)"
    " + lightOf004(towardPoint(position, p), color1, normalize(normal), normalize(-p), diffuse, specular, shininess)",
    "lighting/point-blinn": "vec4(la * ma + attenuation(kc, kl, kq, distance(position, p)) * ("
    "ld * md * incidence(towardPoint(position, p), normalize(normal))"
    " + ls * ms * blinn(normalize(normal), towardPoint(position, p), normalize(-p), shininess)), 1.0)",
    "lighting/sum": "emissive + ambient + diffuse0 + specular0 + diffuse1 + specular1",
    "lighting/highlight-plastic": "ls * ks * fs",
    "lighting/highlight-metal": "ls * surface * ks * fs",
    "attenuation/polynomial": "attenuation(kc, kl, kq, d)",
    "attenuation/constant": "attenuation(1.0, 0.0, 0.0, d)",
    "attenuation/linear": "attenuation(0.0, 1.0, 0.0, d)",
    "attenuation/square": "attenuation(0.0, 0.0, 1.0, d)",
    "attenuation/point": "attenuation(kc, kl, kq, distance(light, p))",
    "attenuation/spot-cutoff": "cone(l, axis, cutoff_cosine)",
    # 000 §6.5.
    "fog/linear": "fogged(fog, shaded, fogLinear(p.z, dmin, dmax))",
    "fog/exp": "fogged(fog, shaded, fogExp(p.z, density))",
    "fog/exp2-document": "fogged(fog, shaded, fogExp2(p.z, density))",
}
OUTPUTS = {1: "vec4(result, 0.0, 0.0, 0.0)", 2: "vec4(result, 0.0, 0.0)", 3: "vec4(result, 0.0)", 4: "result"}
TYPES = {1: "float", 2: "vec2", 3: "vec3", 4: "vec4", 9: "mat3", 16: "mat4"}


def program(*sources):
    """A program of a vertex and a fragment shader, or of a fragment shader alone."""
    kinds = (GL_VERTEX_SHADER, GL_FRAGMENT_SHADER)[-len(sources) :]
    compiled = [shaders.compileShader(source, kind) for source, kind in zip(sources, kinds)]
    return shaders.compileProgram(*compiled, validate=False)


class Formulas:
    def __init__(self):
        self.target, self.programs = Target(SIDE, SIDE), {}
        self.functions = {formula: self.evaluate for formula in EXPRESSIONS}

    def source(self, formula, inputs, outputs):
        """The fragment shader of a formula; `inputs` are names with their sizes."""
        reads, place = [], 0
        for name, size in inputs:
            values = ", ".join(f"at({place + k})" for k in range(size))
            reads.append(f"    {TYPES[size]} {name} = {TYPES[size]}({values});")
            place += size
        return "\n".join(
            [
                "#version 400 compatibility",
                "uniform sampler2D rows;",
                "out vec4 answer;",
                LIBRARY,
                f"float at(int k) {{ return texelFetch(rows, ivec2(k, int(gl_FragCoord.y) * {SIDE} + int(gl_FragCoord.x)), 0).r; }}",
                "void main() {",
                *reads,
                f"    {TYPES[outputs]} result = {EXPRESSIONS[formula]};",
                f"    answer = {OUTPUTS[outputs]};",
                "}",
            ]
        )

    def evaluate(self, cases):
        inputs = [(name, x.shape[1] if x.ndim > 1 else 1) for name, x in vars(cases).items() if isinstance(x, np.ndarray)]
        rows = np.hstack([getattr(cases, name).reshape(cases.total, -1) for name, _ in inputs])
        if cases.formula not in self.programs:
            self.programs[cases.formula] = self.compile(cases.formula, inputs)
        name, outputs = self.programs[cases.formula]
        texture = glGenTextures(1)
        glBindTexture(GL_TEXTURE_2D, texture)
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, *rows.shape[::-1], 0, GL_RED, GL_FLOAT, np.ascontiguousarray(rows))
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST)
        self.target.bind()
        identity()
        glUseProgram(name)
        # Rows beyond the last case are not read.
        glEnable(GL_SCISSOR_TEST)
        glScissor(0, 0, SIDE, -(-cases.total // SIDE))
        glRectf(-1, -1, 1, 1)
        glDisable(GL_SCISSOR_TEST)
        glUseProgram(0)
        glDeleteTextures([texture])
        return self.target.read().reshape(-1, 4)[: cases.total, :outputs]

    def compile(self, formula, inputs):
        """The program, and how many components its result has: that with which it compiles."""
        for outputs in (4, 3, 1):
            try:
                return program(self.source(formula, inputs, outputs)), outputs
            except shaders.ShaderCompilationError as error:
                last = error
        raise last


TRIANGLE = """#version 400 compatibility
smooth out float perspective;
noperspective out float linear;
void main() {
    perspective = gl_Color.r;
    linear = gl_Color.r;
    gl_Position = gl_Vertex;
}
"""
FLAT = """#version 400 compatibility
flat out vec4 value;
void main() {
    value = gl_Color;
    gl_Position = gl_Vertex;
}
"""


def fragment(inputs, expression):
    return f"#version 400 compatibility\n{inputs}\nout vec4 answer;\nvoid main() {{ {expression} }}\n"


class Raster(Pixels):
    """000 §6.1: interpolated, flat and predefined inputs and outputs of a fragment."""

    def __init__(self):
        super().__init__()
        both = "smooth in float perspective; noperspective in float linear;"
        self.programs = {
            "attributes": program(TRIANGLE, fragment(both, "answer = vec4(perspective, linear, 0.0, 1.0);")),
            "position": program(fragment("", "answer = gl_FragCoord;")),
            "facing": program(fragment("", "answer = vec4(gl_FrontFacing ? 1.0 : 0.0);")),
            "depth": program(TRIANGLE, fragment(both, "gl_FragDepth = perspective; answer = vec4(1.0);")),
            "flat": program(FLAT, fragment("flat in vec4 value;", "answer = value;")),
        }
        self.functions = {
            "interpolation/raster-attributes": lambda cases: self.by("attributes", cases)[:, :2],
            "interpolation/raster-position": lambda cases: self.by("position", cases),
            "interpolation/raster-facing": lambda cases: self.by("facing", cases)[:, :1],
            "interpolation/raster-frag-depth": self.depth,
            "interpolation/raster-flat-*": self.by_flat,
        }

    def by(self, name, cases):
        glUseProgram(self.programs[name])
        values = self.pixels(cases, lambda c: self.primitive(GL_TRIANGLES, [c.a, c.b, c.c], c.attr))
        glUseProgram(0)
        return values

    def by_flat(self, cases):
        glUseProgram(self.programs["flat"])
        values = self.flat(cases)
        glUseProgram(0)
        return values

    def depth(self, cases):
        depths = []

        def draw(c):
            self.primitive(GL_TRIANGLES, np.float32([[-1, -1], [3, -1], [-1, 3]]), [c.depth] * 3)
            x, y, _, _ = glGetIntegerv(GL_SCISSOR_BOX)
            depths.append(self.target.read_depth(x, y, 1, 1)[0])

        glUseProgram(self.programs["depth"])
        glEnable(GL_DEPTH_TEST)
        glDepthFunc(GL_ALWAYS)
        self.pixels(cases, draw)
        glDisable(GL_DEPTH_TEST)
        glUseProgram(0)
        return depths
