// Phong's model as lecture slides have it: a directional light, given by the way that it travels, and a material.
// lightmeter run lighting/phong --shader slides-phong.frag --bind 'Light.Ldir=direction'
#version 330

in vec3 Position;
in vec3 Normal;

uniform mat4 ViewMatrix;

struct LightInfo { vec3 Ldir; vec3 La; vec3 Ld; vec3 Ls; };
uniform LightInfo Light;

struct MaterialInfo { vec3 Ka; vec3 Kd; vec3 Ks; float Shininess; };
uniform MaterialInfo Material;

out vec4 FragColor;

vec3 shaded()
{
    vec3 toLight = normalize(-(ViewMatrix * vec4(Light.Ldir, 0.0)).xyz);
    vec3 n = normalize(Normal);
    vec3 toEye = normalize(-Position);
    vec3 mirrored = reflect(-toLight, n);
    float incidence = max(dot(toLight, n), 0.0);
    float highlight = pow(max(dot(mirrored, toEye), 0.0), Material.Shininess);
    return Light.La * Material.Ka + Light.Ld * Material.Kd * incidence + Light.Ls * Material.Ks * highlight;
}

void main()
{
    FragColor = vec4(shaded(), 1.0);
}
