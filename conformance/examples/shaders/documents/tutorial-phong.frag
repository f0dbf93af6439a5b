// The same in every fragment, from vectors that the vertex shader hands over.
// lightmeter run lighting/scalar-material --shader tutorial-phong.frag
#version 330

in vec3 N1;
in vec3 L1;
in vec3 V1;

uniform vec3 light_color = vec3(0.75);
uniform vec3 ambient_color = vec3(0.1);
uniform float ka = 0.10;
uniform float kd = 0.55;
uniform float ks = 0.70;
uniform float n = 32.0;

out vec4 color;

void main()
{
    vec3 N = normalize(N1);
    vec3 L = normalize(L1);
    vec3 V = normalize(V1);
    vec3 R = reflect(-L, N);
    vec3 ambient = ka * ambient_color;
    vec3 diffuse = kd * light_color * max(0.0, dot(N, L));
    vec3 specular = ks * light_color * pow(max(0.0, dot(R, V)), n);
    color = vec4(ambient + diffuse + specular, 1.0);
}
