// Phong's model at the vertices, as a tutorial has it. Its exponent is a whole number, which the formula's is not.
// lightmeter run lighting/scalar-material --shader tutorial-gouraud.vert
#version 330

layout (location = 0) in vec4 position;
layout (location = 1) in vec2 texture;
layout (location = 2) in vec3 normal;

uniform mat4 mv_matrix;
uniform mat4 proj_matrix;
uniform vec3 light_pos = vec3(100.0, 100.0, 100.0);
uniform vec3 light_color = vec3(0.75);
uniform vec3 ambient_color = vec3(0.0);
uniform float ka = 0.0;
uniform float kd = 0.7;
uniform float ks = 0.35;
uniform int n = 32;

out vec3 color;

void main()
{
    vec4 P = mv_matrix * position;
    vec3 N = normalize(mat3(mv_matrix) * normal);
    vec3 L = normalize(light_pos - P.xyz);
    vec3 V = normalize(-P.xyz);
    vec3 R = reflect(-L, N);
    color = ka * ambient_color + kd * light_color * max(0.0, dot(N, L)) + ks * light_color * pow(max(0.0, dot(R, V)), float(n));
    gl_Position = proj_matrix * P;
}
