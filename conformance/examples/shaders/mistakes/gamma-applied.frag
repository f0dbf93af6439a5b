// lighting/blinn, written for a target that is not sRGB: the result is encoded, which the formula's is not.
#version 330 core

in vec3 Normal;
in vec3 FragPos;
out vec4 FragColor;

struct Light { vec3 direction, ambient, diffuse, specular; };
struct Material { vec3 ambient, diffuse, specular; float shininess; };
uniform Light light;
uniform Material material;

void main() {
    vec3 norm = normalize(Normal);
    vec3 lightDir = normalize(-light.direction);
    vec3 halfwayDir = normalize(lightDir + normalize(-FragPos));
    vec3 color = light.ambient * material.ambient
        + light.diffuse * material.diffuse * max(dot(norm, lightDir), 0.0)
        + light.specular * material.specular * pow(max(dot(norm, halfwayDir), 0.0), material.shininess);
    FragColor = vec4(pow(color, vec3(1.0 / 2.2)), 1.0);
}
