// A surface under all lights: 000's program, with 004's sum over the lights and its attenuation.
struct Light {
    vec3 ambient, diffuse, specular;
    // 0 directional, 1 the same with a vector taken as a unit vector, 2 a point, 3 within a cone.
    int kind;
    // Towards a directional light, or where it stands.
    vec3 place;
    vec3 falloff;
    vec3 axis;
    float cutoffCosine;
};

uniform Light lights[LIGHTS];
uniform vec3 emissive, ambient, ambientOfMaterial, diffuse, specular;
uniform float shininess;

vec3 lit(vec3 p, vec3 n) {
#ifdef LOCAL_VIEWER
    vec3 v = normalize(-p);
#else
    vec3 v = vec3(0.0, 0.0, 1.0);
#endif
    vec3 sum = emissive + ambient;
    for (int k = 0; k < LIGHTS; k++) {
        vec3 l = lights[k].place;
        float weakened = 1.0;
        if (lights[k].kind == 0) {
            l = towardTravel(-l);
        } else if (lights[k].kind > 1) {
            float d = distance(l, p);
            weakened = attenuation(lights[k].falloff.x, lights[k].falloff.y, lights[k].falloff.z, d);
            l = towardPoint(l, p);
            if (lights[k].kind == 3) {
                weakened *= cone(l, normalize(lights[k].axis), lights[k].cutoffCosine);
            }
        }
        sum += lights[k].ambient * ambientOfMaterial;
        sum += weakened * lights[k].diffuse * diffuse * incidence(l, n);
        sum += weakened * lights[k].specular * specular * HIGHLIGHT(n, l, v, shininess);
    }
    return sum;
}
