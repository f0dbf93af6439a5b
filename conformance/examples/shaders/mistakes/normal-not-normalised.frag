// lighting/phong, of whose interpolated normal the length is left as it comes.
#version 300 es
precision highp float;

in vec3 v_normal;
in vec3 v_position;
out vec4 o_color;

layout(std140) uniform Light {
    vec3 direction;
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
} light;

layout(std140) uniform Material {
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    float shininess;
} material;

void main() {
    vec3 n = v_normal;
    vec3 l = normalize(-light.direction);
    vec3 v = normalize(-v_position);
    vec3 r = reflect(-l, n);
    o_color = vec4(light.ambient * material.ambient
        + light.diffuse * material.diffuse * max(dot(n, l), 0.0)
        + light.specular * material.specular * pow(max(dot(r, v), 0.0), material.shininess), 1.0);
}
