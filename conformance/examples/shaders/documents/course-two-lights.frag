// A directional light and a point light, as a course has them. Its names tell neither light from the other, so that they are bound by hand.
// lightmeter run lighting/two-lights --shader course-two-lights.frag --bind light0dirn=direction --bind light0color=color0
//     --bind 'light1posn=vec4f(position, 1.0)' --bind light1color=color1 --bind 'myvertex=vec4f(p, 1.0)' --bind islight=1
#version 330

in vec4 myvertex;
in vec3 mynormal;

uniform int islight;
uniform vec3 light0dirn;
uniform vec4 light0color;
uniform vec4 light1posn;
uniform vec4 light1color;
uniform vec4 ambient;
uniform vec4 diffuse;
uniform vec4 specular;
uniform float shininess;

out vec4 fragColor;

vec4 lit(const in vec3 toLight, const in vec4 light, const in vec3 normal, const in vec3 halfway)
{
    vec4 lambert = diffuse * light * max(dot(normal, toLight), 0.0);
    vec4 highlight = specular * light * pow(max(dot(normal, halfway), 0.0), shininess);
    return lambert + highlight;
}

void main()
{
    if (islight == 0) {
        fragColor = vec4(1.0);
        return;
    }
    vec3 at = myvertex.xyz / myvertex.w;
    vec3 toEye = normalize(-at);
    vec3 normal = normalize(mynormal);
    vec3 toFirst = normalize(light0dirn);
    vec3 toSecond = normalize(light1posn.xyz / light1posn.w - at);
    fragColor = ambient + lit(toFirst, light0color, normal, normalize(toFirst + toEye))
        + lit(toSecond, light1color, normal, normalize(toSecond + toEye));
}
