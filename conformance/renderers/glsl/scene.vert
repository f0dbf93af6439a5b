// The documents' vertex programs. AT_VERTEX: lit here (003's Gouraud program); otherwise position and normal go on (000, 004).
uniform mat4 projection, modelview;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec2 lightmapUv;
layout(location = 4) in vec4 color;

out vec3 eyePosition, eyeNormal;
out vec2 at, lightmapAt;
out vec4 ownColor;
INTERPOLATION out vec3 litColor;

void main() {
    vec4 p = modelview * vec4(position, 1.0);
    eyePosition = p.xyz;
#ifdef MODELVIEW_NORMALS
    eyeNormal = mat3(modelview) * normal;
#else
    eyeNormal = mat3(transpose(inverse(modelview))) * normal;
#endif
    at = uv;
    lightmapAt = lightmapUv;
    ownColor = color;
    litColor = vec3(0.0);
#ifdef AT_VERTEX
    litColor = lit(eyePosition, normalize(eyeNormal));
#endif
    gl_Position = projection * p;
}
