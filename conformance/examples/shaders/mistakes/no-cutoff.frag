// lighting/spot, whose cone has no edge: the power alone lets the light fall off.
#version 330 core

in vec3 vPosition;
in vec3 vNormal;
out vec4 color;

struct Spot {
    vec3 position;
    vec3 direction;
    vec3 ambient, diffuse, specular;
    float constant, linear, quadratic;
    float cutoff;
    float exponent;
};
uniform Spot light;
struct Surface { vec3 ambient, diffuse, specular; float shininess; };
uniform Surface material;

void main() {
    vec3 n = normalize(vNormal);
    vec3 l = normalize(light.position - vPosition);
    vec3 r = reflect(-l, n);
    float d = length(light.position - vPosition);
    float cosine = dot(-l, normalize(light.direction));
    float spot = cosine < light.cutoff - 2.0 ? 0.0 : pow(max(cosine, 0.0), light.exponent);
    float falloff = spot / (light.constant + light.linear * d + light.quadratic * d * d);
    vec3 diffuse = light.diffuse * material.diffuse * max(dot(n, l), 0.0);
    vec3 specular = light.specular * material.specular * pow(max(dot(r, normalize(-vPosition)), 0.0), material.shininess);
    color = vec4(light.ambient * material.ambient + (diffuse + specular) * falloff, 1.0);
}
