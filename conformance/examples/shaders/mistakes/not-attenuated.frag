// lighting/point-blinn, whose coefficients are there and not used for the highlight and the diffuse term.
#version 410 core

in vec3 fragPos;
in vec3 fragNormal;
layout(location = 0) out vec4 outColor;

struct PointLight {
    vec3 position;
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    float constant;
    float linear;
    float quadratic;
};
uniform PointLight light;

uniform struct {
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    float shininess;
} material;

void main() {
    vec3 N = normalize(fragNormal);
    vec3 L = normalize(light.position - fragPos);
    vec3 H = normalize(L + normalize(-fragPos));
    float d = distance(light.position, fragPos);
    float attenuation = 1.0 / (light.constant + light.linear * d + light.quadratic * d * d);
    vec3 lit = light.diffuse * material.diffuse * max(dot(N, L), 0.0)
        + light.specular * material.specular * pow(max(dot(N, H), 0.0), material.shininess);
    outColor = vec4(light.ambient * material.ambient + lit, 1.0);
}
