// Right as many write it: unit vectors normalised once more, cosines held below 1, the power of a cosine of 0 left to pow.

float cone(vec3 l, vec3 axis, float cutoff) {
    return dot(-normalize(l), normalize(axis)) >= cutoff ? 1.0 : 0.0;
}

float coneWithPower(vec3 l, vec3 axis, float cutoff, float exponent) {
    float cosine = dot(-normalize(l), normalize(axis));
    return cosine >= cutoff ? pow(max(cosine, 0.0), exponent) : 0.0;
}

vec3 diffuse(vec3 ld, vec3 md, vec3 l, vec3 n) {
    return ld * md * max(dot(normalize(n), normalize(l)), 0.0);
}

vec3 diffuseSaturated(vec3 ld, vec3 md, vec3 l, vec3 n) {
    return ld * md * clamp(dot(n, l), 0.0, 1.0);
}

vec3 highlight(vec3 ls, vec3 ms, vec3 r, vec3 v, float shininess) {
    return ls * ms * pow(clamp(dot(normalize(r), normalize(v)), 0.0, 1.0), shininess);
}

vec3 eyeNormal(mat4 modelView, vec3 normal) {
    return transpose(inverse(mat3(modelView))) * normal;
}

vec4 sun(vec3 la, vec3 ld, vec3 ls, vec3 ma, vec3 md, vec3 ms, float shininess, vec3 p, vec3 normal, vec3 direction) {
    vec3 n = normalize(normal);
    vec3 l = normalize(-direction);
    float lit = max(dot(n, l), 0.0);
    float bright = pow(max(dot(reflect(-l, n), normalize(-p)), 0.0), shininess);
    return vec4(la * ma + ld * md * lit + ls * ms * bright, 1.0);
}
