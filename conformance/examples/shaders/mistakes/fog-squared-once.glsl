// fog/exp2-opengl as a function: the density is not squared with the distance.
vec3 applyFog(vec3 color, vec3 fogColor, float fogDensity, float distance) {
    float f = clamp(exp(-fogDensity * distance * distance), 0.0, 1.0);
    return mix(fogColor, color, f);
}
