// lighting/diffuse-toward as a function: the cosine is taken from −1 to 1, as one engine does to soften the shadow's edge.
#version 450

vec3 halfLambert(vec3 N, vec3 L, vec3 lightColor, vec3 diffuseColor) {
    float wrapped = dot(N, L) * 0.5 + 0.5;
    return lightColor * diffuseColor * wrapped * wrapped;
}
