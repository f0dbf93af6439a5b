// What the documents' programs compute, each under the document that describes it. Vectors are in eye space.

// 000: a light's direction is the way its light travels; everything is normalised at the fragment.
vec3 towardTravel(vec3 direction) {
    return normalize(-direction);
}

// 003, 004: a point light.
vec3 towardPoint(vec3 light, vec3 p) {
    return normalize(light - p);
}

// 000 §6.4 writes this vector as the one that light travels along, and gives it the wrong sign.
vec3 towardPointOf000(vec3 light, vec3 p) {
    return -normalize(light - p);
}

float incidence(vec3 l, vec3 n) {
    return max(dot(l, n), 0.0);
}

// 000, 003.
float phong(vec3 n, vec3 l, vec3 v, float shininess) {
    return pow(max(dot(reflect(-l, n), v), 0.0), shininess);
}

// 000 §6.4: the viewer at infinity.
float phongNonLocal(vec3 n, vec3 l, float shininess) {
    return pow(max(reflect(-l, n).z, 0.0), shininess);
}

// 004.
float blinn(vec3 n, vec3 l, vec3 v, float shininess) {
    return pow(max(dot(n, normalize(l + v)), 0.0), shininess);
}

// 000 §6.4: the halfway vector is the sum as it is.
float blinnOf000(vec3 n, vec3 l, vec3 v, float shininess) {
    return pow(max(dot(n, v + l), 0.0), shininess);
}

// 000: the three terms of one light.
vec4 sumOf000(vec3 la, vec3 ld, vec3 ls, vec3 ma, vec3 md, vec3 ms, float fi, float fs) {
    return vec4(la * ma + ld * md * fi + ls * ms * fs, 1.0);
}

// 004: one light's diffuse and specular terms, with alpha.
vec4 lightOf004(vec3 l, vec4 color, vec3 n, vec3 v, vec4 diffuse, vec4 specular, float shininess) {
    return diffuse * color * incidence(l, n) + specular * color * blinn(n, l, v, shininess);
}

// 003: a surface of scalar coefficients under one light.
vec3 surfaceOf003(vec3 ambient, vec3 light, float ka, float kd, float ks, float exponent, vec3 n, vec3 l, vec3 v) {
    return ka * ambient + kd * light * incidence(l, n) + ks * light * phong(n, l, v, exponent);
}

// The same in white light without an ambient term.
float intensityOf003(vec3 n, vec3 l, vec3 v, float kd, float ks, float exponent) {
    return surfaceOf003(vec3(0.0), vec3(1.0), 0.0, kd, ks, exponent, n, l, v).r;
}

// 003's Gouraud program at a vertex.
float litVertexOf003(vec3 p, vec3 normal, vec3 light, float kd, float ks, float exponent) {
    return intensityOf003(normalize(normal), normalize(light - p), normalize(-p), kd, ks, exponent);
}

// 004.
float attenuation(float kc, float kl, float kq, float d) {
    return 1.0 / (kc + kl * d + kq * d * d);
}

// 000 §6.4: nothing beyond the angle of the cone.
float cone(vec3 l, vec3 axis, float cutoffCosine) {
    return dot(-l, axis) < cutoffCosine ? 0.0 : 1.0;
}

// 000 §6.5.
float fogLinear(float z, float dmin, float dmax) {
    return clamp((dmax - abs(z)) / (dmax - dmin), 0.0, 1.0);
}

float fogExp(float z, float density) {
    return clamp(exp(-density * abs(z)), 0.0, 1.0);
}

float fogExp2(float z, float density) {
    return clamp(exp(-density * z * z), 0.0, 1.0);
}

vec4 fogged(vec3 fog, vec3 shaded, float f) {
    return vec4(f, mix(fog, shaded, f));
}
