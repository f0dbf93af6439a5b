// lighting/blinn as it is, in GLSL.
#version 330 core

in vec3 vPosition;
in vec3 vNormal;
out vec4 color;

struct Light { vec3 direction, ambient, diffuse, specular; };
struct Material { vec3 ambient, diffuse, specular; float shininess; };
uniform Light light;
uniform Material material;

void main() {
    vec3 n = normalize(vNormal);
    vec3 l = normalize(-light.direction);
    vec3 h = normalize(normalize(-vPosition) + l);
    vec3 diffuse = light.diffuse * material.diffuse * max(dot(l, n), 0.0);
    vec3 specular = light.specular * material.specular * pow(max(dot(n, h), 0.0), material.shininess);
    color = vec4(light.ambient * material.ambient + diffuse + specular, 1.0);
}
